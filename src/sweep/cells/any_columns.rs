//! The cells of a line of a model without a kernel of its own, by what its `Line` and its `Roots`
//! say: counts, margins in delay, roots.

use super::buffers::{N_UNSTABLE_FILL, TileBuffers};
use super::line::Places;
use super::root_columns::relaxation_time;
use crate::linear::MarginalTolerance;
use crate::linear::general::{Reason, Spectrum};
use crate::linear::line::{Line, Linear};
use crate::linear::status::{
    CERTIFIED, DISAGREE, MARGINAL, MOST_COUNTED, NOT_CONVERGED, OUTSIDE_MODEL, SATURATED,
};
use crate::model::elementary::exp;
use crate::model::stop::Stop;
use crate::setting::field::Field;
use crate::setting::source::{OfLinear, OfRoots, Source};

/// A line of cells, or a part of it.
pub(super) struct AnyCells<'a> {
    pub of: &'a Linear,
    /// √(M/κ).
    pub time_unit: f64,
    pub delays: &'a [f64],
    pub tolerance: MarginalTolerance,
    pub places: Places,
    /// The fields of the map.
    pub fields: &'a [Field],
    /// Once it is set, no further roots are searched for.
    pub stop: &'a Stop,
}

/// Fills the cells of a line. Delays of a digital loop that are no multiples of the sample time are
/// outside the model.
pub(super) fn fill(cells: &AnyCells, buffers: &mut TileBuffers) {
    let roots = cells.of.roots(cells.stop);
    let line = roots.line(cells.time_unit);
    let wanted = cells.fields.iter().map(|field| field.roots_needed()).max();
    let wanted = wanted.unwrap_or(0);
    for (i, &tau) in cells.delays.iter().enumerate() {
        let place = cells.places.of(i);
        let status = count(cells, &*line, (tau, place), buffers);
        buffers.status[place] = status;
        if status & OUTSIDE_MODEL != 0 {
            buffers.put(place, |_| Some(f64::NAN));
            continue;
        }
        fill_line(&*line, (tau, place), buffers);
        let essential = roots.essential_abscissa(tau / cells.time_unit) / cells.time_unit;
        buffers.put(place, |field| match field.source() {
            Source::Linear(OfLinear::EssentialAbscissa) => Some(essential),
            _ => None,
        });
        if line.reason() == Some(Reason::Infinite) && tau > 0.0 {
            buffers.put(place, |field| match field.source() {
                Source::Roots(_) => Some(f64::NAN),
                _ => None,
            });
        } else if wanted > 0 && !cells.stop.is_set() {
            let counted = line.count(tau, MarginalTolerance::default());
            let found = roots.counted(tau / cells.time_unit, wanted, counted);
            fill_roots(cells, (&found, wanted), place, buffers);
        }
    }
}

/// Counts the unstable roots of a cell; its status.
fn count(
    cells: &AnyCells,
    line: &dyn Line,
    (tau, place): (f64, usize),
    buffers: &mut TileBuffers,
) -> u8 {
    let Some(count) = line.count(tau, cells.tolerance) else {
        if let Some(n) = &mut buffers.n_unstable {
            n[place] = N_UNSTABLE_FILL;
        }
        return match line.reason() {
            Some(Reason::Infinite) => SATURATED,
            _ if line.delays_known() => OUTSIDE_MODEL,
            _ => NOT_CONVERGED,
        };
    };
    let mut status = if count.marginal { MARGINAL } else { 0 };
    let most = u64::from(MOST_COUNTED);
    if count.n_unstable > most {
        status |= SATURATED;
    }
    if let Some(n) = &mut buffers.n_unstable {
        n[place] = count.n_unstable.min(most) as u16;
    }
    status
}

/// Fills what is known of the line.
fn fill_line(line: &dyn Line, (tau, place): (f64, usize), buffers: &mut TileBuffers) {
    let mut unknown = false;
    let mut columns = buffers.columns.iter_mut();
    if let Some(column) = columns.find(|column| column.field == Field::DelayMargin) {
        let margin = line.delay_margin(tau);
        unknown |= margin.is_nan();
        column.cells[place] = margin;
    }
    for column in &mut buffers.kinds {
        if matches!(column.field.source(), Source::Linear(OfLinear::Reason)) {
            column.cells[place] = line.reason().map_or(0, Reason::number);
        }
    }
    if unknown {
        buffers.status[place] |= NOT_CONVERGED;
    }
}

/// Fills the fields of roots, and adds to the status what they say.
fn fill_roots(
    cells: &AnyCells,
    (found, wanted): (&Spectrum, usize),
    place: usize,
    buffers: &mut TileBuffers,
) {
    let unit = cells.time_unit;
    let sample_time = match cells.of {
        Linear::Sampled(of) => of.sample_time,
        _ => f64::NAN,
    };
    let accumulate = found.reason == Some(Reason::NoRightmostRoot);
    let missing = !accumulate && (found.missing.is_some() || found.roots.is_empty());
    let beyond = if missing || accumulate {
        f64::NAN
    } else {
        f64::NEG_INFINITY
    };
    let root = |rank: usize| found.roots.get(rank).map(|root| root.lambda / unit);
    let abscissa = found.abscissa / unit;
    for column in &mut buffers.columns {
        let Source::Roots(of) = column.field.source() else {
            continue;
        };
        column.cells[place] = match of {
            OfRoots::RealPart(0) => abscissa,
            OfRoots::RealPart(rank) => root(rank).map_or(beyond, |root| root.re),
            OfRoots::Frequency(rank) => root(rank).map_or(f64::NAN, |root| root.im),
            OfRoots::RelaxationTime if abscissa.is_nan() => f64::NAN,
            OfRoots::RelaxationTime => relaxation_time(abscissa),
            OfRoots::SpectralRadius => exp(found.abscissa * sample_time),
            OfRoots::CertificateMargin => found.margin,
            OfRoots::Derivative(_) => f64::NAN,
        };
    }
    if accumulate {
        for column in &mut buffers.kinds {
            if matches!(column.field.source(), Source::Linear(OfLinear::Reason)) {
                column.cells[place] = Reason::NoRightmostRoot.number();
            }
        }
    }
    buffers.status[place] |= match found {
        _ if found.abscissa.is_nan() || found.roots.len() < wanted && missing => NOT_CONVERGED,
        found if found.certified => CERTIFIED,
        found if found.margin.is_nan() => NOT_CONVERGED,
        _ if buffers.status[place] & MARGINAL != 0 => 0,
        found if found.abscissa.abs() <= found.margin => MARGINAL,
        _ => DISAGREE,
    };
}
