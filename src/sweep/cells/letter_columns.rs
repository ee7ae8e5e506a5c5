//! The cells of a line of the letter's own model: counts, delay margins, roots.

use super::buffers::{Column, TileBuffers};
use super::line::Places;
use super::lines::Lines;
use super::root_columns::{Line, RootColumns};
use crate::linear::general::Reason;
use crate::linear::row::Delays;
use crate::linear::sensitivity::Sensitivity;
use crate::linear::{Crossings, MarginalTolerance};
use crate::model::Groups;
use crate::setting::field::Field;
use crate::setting::source::{OfLinear, Source};

/// A line of cells, or the part of it in a tile.
pub(super) struct LetterLine<'a> {
    pub groups: Groups,
    /// √(M/κ).
    pub time_unit: f64,
    pub lines: &'a Lines<'a>,
    /// The delays, increasing, in the units of the sweep.
    pub delays: &'a Delays,
    /// The index of the first delay on the whole line.
    pub first: usize,
    pub tolerance: MarginalTolerance,
    pub places: Places,
}

/// Fills the columns of one thread's tiles and reuses its memory, which holds a row on its way to
/// a tile whose delays are not contiguous.
pub(super) struct LetterColumns {
    status: Vec<u8>,
    n_unstable: Vec<u16>,
    delay_margin: Vec<f64>,
    /// Whether a field is about the linear model itself.
    tells_linear: bool,
}

impl LetterColumns {
    /// The columns for these fields and lines of at most `longest` delays.
    pub(super) fn new(fields: &[Field], longest: usize) -> Self {
        Self {
            status: vec![0; longest],
            n_unstable: vec![0; longest],
            delay_margin: vec![0.0; longest],
            tells_linear: fields
                .iter()
                .any(|f| matches!(f.source(), Source::Linear(_))),
        }
    }

    /// Computes the cells of a line. `unflagged` says whether every status in the buffers is zero;
    /// returns whether this holds afterwards.
    #[inline]
    pub(super) fn fill(
        &mut self,
        line: &LetterLine,
        unflagged: bool,
        roots: Option<&mut RootColumns>,
        buffers: &mut TileBuffers,
    ) -> bool {
        let mut crossings = Crossings::of(line.groups);
        // Dimensionless sweeps, the most common ones, need no scaling.
        if line.time_unit != 1.0 {
            crossings = crossings.in_physical_time(line.time_unit);
        }
        let flagged = match line.places.stride {
            1 => self.fill_in_place(line, &crossings, unflagged, buffers),
            _ => self.fill_by_row(line, &crossings, unflagged, buffers),
        };
        let rooted = roots.is_some();
        if let Some(roots) = roots {
            self.fill_roots(line, roots, buffers);
        }
        if self.tells_linear {
            fill_linear(line, &crossings, buffers);
        }
        unflagged && !flagged && !rooted
    }

    /// Fills contiguous cells. Returns whether a status is not zero.
    fn fill_in_place(
        &mut self,
        line: &LetterLine,
        crossings: &Crossings,
        unflagged: bool,
        buffers: &mut TileBuffers,
    ) -> bool {
        let (at, delays) = (line.places.at, line.delays);
        let to = at + delays.values().len();
        let status = &mut buffers.status[at..to];
        let n = match &mut buffers.n_unstable {
            Some(n) => &mut n[at..to],
            None => &mut self.n_unstable[..to - at],
        };
        if !unflagged {
            status.fill(0);
        }
        let flagged = crossings.fill_counts(delays, line.tolerance, n, status);
        if let Some(margin) = delay_margins(&mut buffers.columns) {
            crossings.fill_delay_margins(delays, &mut margin[at..to]);
        }
        flagged
    }

    /// Fills cells that are not contiguous. Returns whether a status is not zero.
    fn fill_by_row(
        &mut self,
        line: &LetterLine,
        crossings: &Crossings,
        unflagged: bool,
        buffers: &mut TileBuffers,
    ) -> bool {
        let (places, delays) = (line.places, line.delays);
        let len = delays.values().len();
        let (n, status) = (&mut self.n_unstable[..len], &mut self.status[..len]);
        status.fill(0);
        let flagged = crossings.fill_counts(delays, line.tolerance, n, status);
        if flagged || !unflagged {
            places.copy(status, &mut buffers.status);
        }
        if let Some(out) = &mut buffers.n_unstable {
            places.copy(n, out);
        }
        if let Some(out) = delay_margins(&mut buffers.columns) {
            let margin = &mut self.delay_margin[..len];
            crossings.fill_delay_margins(delays, margin);
            places.copy(margin, out);
        }
        flagged
    }

    /// Computes the fields that need roots, in a line with known counts and statuses.
    fn fill_roots(
        &mut self,
        line: &LetterLine,
        roots: &mut RootColumns,
        buffers: &mut TileBuffers,
    ) {
        let (places, len) = (line.places, line.delays.values().len());
        let in_place = places.stride == 1;
        let counts = match &buffers.n_unstable {
            Some(n) if in_place => &n[places.at..places.at + len],
            _ => &self.n_unstable[..len],
        };
        let status = match in_place {
            true => &mut buffers.status[places.at..places.at + len],
            false => &mut self.status[..len],
        };
        let damping = line.lines.damping();
        let of_roots = Line {
            equation: line.groups,
            sensitivity: |tau, lambda| Sensitivity::of(line.groups, tau, lambda).coupled(damping),
            time_unit: line.time_unit,
            unit: 1.0,
            per_parameter: line.lines.groups_per_parameter(),
            delays: line.delays.values(),
            first: line.first,
        };
        roots.fill(&of_roots, counts, status, &mut buffers.columns, places);
        if !in_place {
            places.copy(&self.status[..len], &mut buffers.status);
        }
    }
}

/// Fills the quantities of the model besides counts and roots. Only b = 0 without control is
/// special, and roots do not accumulate.
fn fill_linear(line: &LetterLine, crossings: &Crossings, buffers: &mut TileBuffers) {
    let reason = match crossings.always_marginal {
        true => Reason::RootOnAxis.number(),
        false => 0,
    };
    for i in 0..line.delays.values().len() {
        buffers.put(line.places.of(i), |field| match field.source() {
            Source::Linear(OfLinear::Reason) => Some(f64::from(reason)),
            Source::Linear(OfLinear::EssentialAbscissa) => Some(f64::NEG_INFINITY),
            Source::Linear(OfLinear::StiffnessRatio) => Some(f64::NAN),
            _ => None,
        });
    }
}

/// The column of delay margins.
fn delay_margins(columns: &mut [Column]) -> Option<&mut Vec<f64>> {
    let column = columns.iter_mut().find(|c| c.field == Field::DelayMargin);
    column.map(|c| &mut c.cells)
}
