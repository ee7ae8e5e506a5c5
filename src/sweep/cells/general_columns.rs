//! The cells of a line of a general system: counts, roots, and the reasons of special cells.

use std::ops::Range;

use num_complex::Complex64;

use super::buffers::TileBuffers;
use super::line::Places;
use super::root_columns::{Line, RootColumns};
use crate::linear::MarginalTolerance;
use crate::linear::feedback_loop::{FeedbackLoop, PerGroup};
use crate::linear::general::rightmost::{beside_accumulation, nothing_beyond_accumulation};
use crate::linear::general::{Class, DelayLine, Reason, RootCounter, System};
use crate::linear::row::Delays;
use crate::linear::sensitivity::Sensitivity;
use crate::linear::status::{CERTIFIED, DISAGREE, MARGINAL, NOT_CONVERGED};
use crate::model::Groups;
use crate::model::stop::Stop;
use crate::setting::field::Field;
use crate::setting::source::{OfLinear, OfRoots, Source};

use crate::sweep::cells::root_columns::relaxation_time;

/// A line of cells, or a part of it.
pub(super) struct GeneralLine<'a> {
    pub system: &'a System,
    /// The feedback loop with known gains, if there is one.
    pub of_loop: Option<&'a FeedbackLoop>,
    /// √(M/κ).
    pub time_unit: f64,
    /// κ/κ_c, NaN where friction has no state.
    pub stiffness_ratio: f64,
    /// The derivative of each group with respect to its parameter.
    pub per_parameter: Groups,
    /// The delays, increasing, in the units of the sweep.
    pub delays: &'a Delays,
    /// The index of the first delay on the whole line.
    pub first: usize,
    pub tolerance: MarginalTolerance,
    pub places: Places,
    /// Once it is set, no further slow cells are computed.
    pub stop: &'a Stop,
}

/// Fills the columns of one thread's tiles and reuses its memory.
#[derive(Debug, Default)]
pub(super) struct GeneralColumns {
    crossings: DelayLine,
    counts: Vec<u16>,
    status: Vec<u8>,
    /// Whether no root lies to the right of the line at which roots accumulate.
    no_rightmost: Vec<bool>,
}

impl GeneralColumns {
    /// Computes the cells of a line.
    pub(super) fn fill(
        &mut self,
        line: &GeneralLine,
        roots: Option<&mut RootColumns>,
        buffers: &mut TileBuffers,
    ) {
        let mut crossings = std::mem::take(&mut self.crossings);
        crossings.find(line.system);
        self.crossings = crossings.in_physical_time(line.time_unit);
        self.count(line);
        self.fill_margins(line, buffers);
        self.fill_latency_margins(line, buffers);
        self.no_rightmost.clear();
        self.no_rightmost.resize(line.delays.values().len(), false);
        if let Some(roots) = roots {
            self.fill_roots(line, roots, buffers);
        }
        self.fill_linear(line, buffers);
        line.places.copy(&self.status, &mut buffers.status);
        if let Some(out) = &mut buffers.n_unstable {
            line.places.copy(&self.counts, out);
        }
    }

    /// Counts unstable roots, with their statuses.
    fn count(&mut self, line: &GeneralLine) {
        let len = line.delays.values().len();
        self.counts.resize(len, 0);
        self.status.clear();
        self.status.resize(len, 0);
        let (n, status) = (&mut self.counts, &mut self.status);
        self.crossings
            .fill_counts(line.delays, line.tolerance, n, status);
    }

    fn fill_margins(&mut self, line: &GeneralLine, buffers: &mut TileBuffers) {
        let column = buffers
            .columns
            .iter_mut()
            .find(|c| c.field == Field::DelayMargin);
        let Some(column) = column else { return };
        let mut walk = self.crossings.margins();
        for (i, (&tau, status)) in line
            .delays
            .values()
            .iter()
            .zip(&mut self.status)
            .enumerate()
        {
            let margin = walk.margin_at(tau);
            if margin.is_nan() && !self.crossings.uncounted {
                *status |= NOT_CONVERGED;
            }
            column.cells[line.places.of(i)] = margin;
        }
    }

    fn fill_latency_margins(&mut self, line: &GeneralLine, buffers: &mut TileBuffers) {
        let mut columns = buffers.columns.iter_mut();
        let Some(column) = columns.find(|c| c.field == Field::LatencyMargin) else {
            return;
        };
        for (i, (&tau, status)) in line
            .delays
            .values()
            .iter()
            .zip(&mut self.status)
            .enumerate()
        {
            if line.stop.is_set() {
                return;
            }
            // P and Q have none of their own: theirs is told with the other margins.
            let Some(margin) = line.system.latency_margin(tau / line.time_unit) else {
                return;
            };
            if margin.is_nan() {
                *status |= NOT_CONVERGED;
            }
            column.cells[line.places.of(i)] = margin * line.time_unit;
        }
    }

    fn fill_roots(
        &mut self,
        line: &GeneralLine,
        roots: &mut RootColumns,
        buffers: &mut TileBuffers,
    ) {
        let len = line.delays.values().len();
        let known = match (self.crossings.uncounted, line.system.class()) {
            (false, _) => len,
            // Without a delay, D is a polynomial and has finitely many roots.
            (true, Class::Infinite) if line.delays.values()[0] == 0.0 => 1,
            (true, _) => 0,
        };
        for i in known..len {
            fill_root(buffers, line.places.of(i), |_| f64::NAN);
        }
        if known == 0 {
            return;
        }
        let counter = RootCounter::new(line.system).bounded().heeding(line.stop);
        self.find_accumulations(line, &counter, known);
        // A loop with known gains is dimensionless anyway.
        let unit = match line.of_loop {
            Some(_) => 1.0,
            None => line.system.time_unit(),
        };
        let scaled = (unit != 1.0).then(|| counter.in_unit(unit));
        let equation = scaled.as_ref().unwrap_or(&counter);
        // Without a loop, derivatives with respect to the groups are NaN.
        let sensitivity = |tau: f64, lambda: Complex64| {
            let jet = equation.system().jet(tau, lambda);
            let per = line.of_loop.map(|of| of.per_group(lambda, jet.difference));
            Sensitivity::by_derivatives(&jet, per.unwrap_or(PerGroup::UNKNOWN), lambda)
        };
        let mut begin = 0;
        while begin < known {
            let kind = self.no_rightmost[begin];
            let same = self.no_rightmost[begin..known]
                .iter()
                .take_while(|k| **k == kind);
            let run = begin..begin + same.count();
            begin = run.end;
            if kind {
                self.fill_accumulations(line, run, buffers);
            } else {
                let part = Line {
                    equation,
                    sensitivity,
                    time_unit: line.time_unit * unit,
                    unit,
                    per_parameter: line.per_parameter,
                    delays: &line.delays.values()[run.clone()],
                    first: line.first + run.start,
                };
                let places = Places {
                    at: line.places.of(run.start),
                    stride: line.places.stride,
                };
                let (counts, status) = (&self.counts[run.clone()], &mut self.status[run]);
                roots.fill(&part, counts, status, &mut buffers.columns, places);
            }
        }
    }

    /// Finds the cells where no root lies to the right of the line at which roots accumulate.
    fn find_accumulations(&mut self, line: &GeneralLine, counter: &RootCounter, known: usize) {
        for (tau, no_rightmost) in line.delays.values()[..known]
            .iter()
            .zip(&mut self.no_rightmost)
        {
            *no_rightmost = nothing_beyond_accumulation(counter, tau / line.time_unit).is_some();
        }
    }

    /// Fills the cells without a rightmost root.
    fn fill_accumulations(
        &mut self,
        line: &GeneralLine,
        run: Range<usize>,
        buffers: &mut TileBuffers,
    ) {
        for i in run {
            let tau = line.delays.values()[i] / line.time_unit;
            let abscissa = line.system.essential_abscissa(tau);
            let beside = beside_accumulation(line.system, tau).unwrap_or(f64::NAN);
            let physical = abscissa / line.time_unit;
            fill_root(buffers, line.places.of(i), |of| match of {
                OfRoots::RealPart(0) => physical,
                OfRoots::RelaxationTime => relaxation_time(physical),
                OfRoots::CertificateMargin => beside - abscissa,
                OfRoots::RealPart(_)
                | OfRoots::Frequency(_)
                | OfRoots::SpectralRadius
                | OfRoots::Derivative(_) => f64::NAN,
            });
            // The line lies left of the imaginary axis: no root is unstable.
            if self.status[i] & MARGINAL == 0 {
                self.status[i] |= if self.counts[i] == 0 {
                    CERTIFIED
                } else {
                    DISAGREE
                };
            }
        }
    }

    /// Fills the quantities of the system besides counts and roots.
    fn fill_linear(&self, line: &GeneralLine, buffers: &mut TileBuffers) {
        let wanted = |field: Field| matches!(field.source(), Source::Linear(_));
        let kinds = buffers.kinds.iter().any(|c| wanted(c.field));
        let numbers = buffers.columns.iter().any(|c| wanted(c.field));
        if !kinds && !numbers {
            return;
        }
        // Every map has the reason, and on most lines it is the same in all cells.
        let same = self.crossings.reason_at(line.delays.values()[0]) == self.crossings.reason;
        if !numbers && same && !self.no_rightmost.contains(&true) {
            let reason = self.crossings.reason.map_or(0, Reason::number);
            let len = line.delays.values().len();
            for column in buffers.kinds.iter_mut().filter(|c| wanted(c.field)) {
                line.places.fill(reason, len, &mut column.cells);
            }
            return;
        }
        for (i, &tau) in line.delays.values().iter().enumerate() {
            let essential = line.system.essential_abscissa(tau / line.time_unit);
            let accumulate = self.no_rightmost[i].then_some(Reason::NoRightmostRoot);
            let reason = self.crossings.reason_at(tau).or(accumulate);
            buffers.put(line.places.of(i), |field| match field.source() {
                Source::Linear(OfLinear::Reason) => {
                    Some(reason.map_or(0.0, |reason| f64::from(reason.number())))
                }
                Source::Linear(OfLinear::EssentialAbscissa) => Some(essential / line.time_unit),
                Source::Linear(OfLinear::StiffnessRatio) => Some(line.stiffness_ratio),
                _ => None,
            });
        }
    }
}

/// Stores what `value` gives for every field of roots in the cell at `place`.
fn fill_root(buffers: &mut TileBuffers, place: usize, value: impl Fn(OfRoots) -> f64) {
    for column in &mut buffers.columns {
        if let Source::Roots(of) = column.field.source() {
            column.cells[place] = value(of);
        }
    }
}
