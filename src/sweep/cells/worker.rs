//! One thread's work: the cells of a tile, line by line, into buffers that are reused.
//!
//! Longer than most files: each kind of line, of the letter and beyond, is filled from here.

use std::ops::Range;

use super::basin_columns::BasinColumns;
use super::buffers::{Column, FEW_FILL, N_UNSTABLE_FILL, TileBuffers, one_zero_and_one_nan};
use super::general_columns::{GeneralColumns, GeneralLine};
use super::limit_columns;
use super::line::{Numbers, Places, SlowLine};
use super::lines::Lines;
use super::margin_columns::MarginColumns;
use super::root_columns::{Line, RootColumns};
use super::slip_columns::SlipColumns;
use super::vc_columns::VcColumns;
use crate::linear::Crossings;
use crate::linear::general::{Reason, System};
use crate::linear::line::Linear;
use crate::linear::row::Delays;
use crate::linear::sensitivity::Sensitivity;
use crate::linear::status::NOT_CONVERGED;
use crate::model::Groups;
use crate::model::stop::Stop;
use crate::setting::field::Field;
use crate::setting::parameter::Parameter;
use crate::setting::source::{Cost, OfLinear, Source};
use crate::sweep::plan::Plan;
use crate::sweep::plan::tile::{Tile, for_each_index, place_of, strides_of};

/// The column of delay margins.
fn delay_margins(columns: &mut [Column]) -> Option<&mut Vec<f64>> {
    let column = columns.iter_mut().find(|c| c.field == Field::DelayMargin);
    column.map(|c| &mut c.cells)
}

/// Computes tiles into its own buffers, which it reuses.
pub struct Worker<'p> {
    plan: &'p Plan,
    lines: Lines<'p>,
    /// The delays of the last tile, with their range in the plan.
    delays: Delays,
    delay_range: Range<usize>,
    strides: Vec<usize>,
    /// Distance between cells of neighbouring delays.
    stride: usize,
    /// The cells of the last tile.
    pub buffers: TileBuffers,
    /// Whether every status in the buffers is zero.
    unflagged: bool,
    row: RowBuffers,
    /// Follows roots, where a field needs them.
    roots: Option<RootColumns>,
    /// Lines of general systems.
    general: GeneralColumns,
    /// Whether a field is about the linear model itself.
    tells_linear: bool,
    /// Computes margins, where a field needs them.
    margins: Option<MarginColumns>,
    /// Follows motions, where a field needs them.
    slip: Option<SlipColumns<'p>>,
    /// Follows many starts, where a field needs them.
    basin: Option<BasinColumns<'p>>,
    /// Computes critical velocities, where a field needs them.
    vc: Option<VcColumns>,
    /// Distance between neighbouring cells along each axis in the whole map.
    map_strides: Vec<u64>,
    /// Whether cells have a sliding state.
    slides: bool,
    /// Whether cells take so long that `stop` is checked between them.
    slow: bool,
    /// One delay at a time, for systems whose polynomials depend on the delay.
    by_delay: Option<Delays>,
}

/// A row on its way to a tile whose delays are not contiguous in memory.
struct RowBuffers {
    status: Vec<u8>,
    n_unstable: Vec<u16>,
    delay_margin: Vec<f64>,
}

impl<'p> Worker<'p> {
    /// A worker with buffers for the tiles of `plan`.
    #[must_use]
    pub fn new(plan: &'p Plan) -> Self {
        let delay_range = plan.delay_range(&plan.tiles.tile(0));
        let longest = delay_range.len();
        let strides = plan.tiles.strides();
        Self {
            plan,
            lines: Lines::new(plan),
            delays: Delays::new(&plan.delays(delay_range.clone())),
            delay_range,
            stride: plan.tau_axis.map_or(1, |axis| strides[axis]),
            strides,
            buffers: TileBuffers::new(plan),
            unflagged: false,
            row: RowBuffers {
                status: vec![0; longest],
                n_unstable: vec![0; longest],
                delay_margin: vec![0.0; longest],
            },
            roots: RootColumns::new(&plan.spec.fields),
            general: GeneralColumns::default(),
            tells_linear: plan
                .spec
                .fields
                .iter()
                .any(|f| matches!(f.source(), Source::Linear(_))),
            margins: MarginColumns::new(&plan.spec.fields),
            slip: SlipColumns::new(&plan.spec),
            basin: BasinColumns::new(&plan.spec),
            vc: VcColumns::new(&plan.spec),
            map_strides: strides_of(plan.shape()),
            slides: plan.spec.has_sliding(),
            slow: plan.spec.cost() > Cost::Rooted,
            by_delay: (!plan.spec.fixed.has_lines()).then(|| Delays::new(&[0.0])),
        }
    }

    /// Computes every cell of `tile`, but begins no further slow cell once `stop` is set. False if
    /// the tile is not complete.
    pub fn compute(&mut self, tile: &Tile, stop: &Stop) -> bool {
        let complete = self.fill(tile, stop);
        for column in &mut self.buffers.columns {
            one_zero_and_one_nan(&mut column.cells);
        }
        complete
    }

    fn fill(&mut self, tile: &Tile, stop: &Stop) -> bool {
        if self.plan.spec.limit {
            self.buffers.clear();
            limit_columns::fill(self.plan, tile, &self.strides, &mut self.buffers);
            return true;
        }
        let range = self.plan.delay_range(tile);
        if range != self.delay_range {
            self.delays = Delays::new(&self.plan.delays(range.clone()));
            self.delay_range = range;
        }
        let whole = tile.cells() == self.plan.tiles.tile_cells() as u64;
        if !whole {
            self.buffers.clear();
        } else if !self.unflagged {
            self.buffers.status.fill(0);
        }
        self.unflagged = whole;
        let mut cut_short = false;
        for_each_index(&tile.extent, self.plan.tau_axis, |inside| {
            let at = place_of(inside, &self.strides);
            self.lines.move_to(&tile.offset, inside);
            if let Some(mut one) = self.by_delay.take() {
                self.fill_by_delay(&mut one, at, stop);
                self.by_delay = Some(one);
                cut_short |= stop.is_set();
                return;
            }
            let of_letter = match self.lines.model() {
                _ if !self.slides => {
                    self.fill_without_sliding(at);
                    None
                }
                Ok((Linear::Letter(groups), time_unit)) => {
                    self.fill_line(groups, time_unit, at);
                    Some(true)
                }
                Ok((Linear::General(system), time_unit)) => {
                    self.fill_general(&system, time_unit, at, stop);
                    Some(false)
                }
                Err(_) => return self.refuse_line(at),
            };
            self.fill_slowly(&tile.offset, inside, at, of_letter, stop);
            let slow = of_letter == Some(false) || self.slow;
            cut_short |= slow && stop.is_set();
        });
        !cut_short
    }

    /// Computes the cells of a line into the buffers from place `at` on.
    #[inline]
    fn fill_line(&mut self, groups: Groups, time_unit: f64, at: usize) {
        let mut crossings = Crossings::of(groups);
        // Dimensionless sweeps, the most common ones, need no scaling.
        if time_unit != 1.0 {
            crossings = crossings.in_physical_time(time_unit);
        }
        match self.stride {
            1 => self.fill_in_place(&crossings, at),
            stride => self.fill_by_row(&crossings, at, stride),
        }
        if self.roots.is_some() {
            self.fill_roots(groups, time_unit, at);
        }
        if self.tells_linear {
            self.fill_linear(&crossings, at);
        }
    }

    /// Computes the cells of a line of a general system.
    fn fill_general(&mut self, system: &System, time_unit: f64, at: usize, stop: &Stop) {
        let sensitive = self.roots.as_ref().is_some_and(RootColumns::sensitive);
        let of_loop = sensitive.then(|| self.lines.setting.feedback_loop().ok());
        let of_loop = of_loop.flatten();
        let line = GeneralLine {
            system,
            of_loop: of_loop.as_ref(),
            time_unit,
            stiffness_ratio: self.lines.setting.stiffness_ratio().unwrap_or(f64::NAN),
            per_parameter: self.lines.groups_per_parameter(),
            delays: &self.delays,
            first: self.delay_range.start,
            tolerance: self.plan.spec.tolerance,
            places: Places {
                at,
                stride: self.stride,
            },
            stop,
        };
        self.general
            .fill(&line, self.roots.as_mut(), &mut self.buffers);
        self.unflagged = false;
    }

    /// Computes the cells of a line whose polynomials depend on the delay, each as its own line.
    fn fill_by_delay(&mut self, one: &mut Delays, at: usize, stop: &Stop) {
        for i in 0..self.delays.values().len() {
            let (tau, place) = (self.delays.values()[i], at + i * self.stride);
            one.set_one(tau);
            self.lines.setting.set(Parameter::Tau, tau);
            let Ok((linear, time_unit)) = self.lines.model() else {
                self.refuse(place, 1);
                continue;
            };
            let line = GeneralLine {
                system: &linear.system(),
                of_loop: None,
                time_unit,
                stiffness_ratio: f64::NAN,
                per_parameter: self.lines.groups_per_parameter(),
                delays: one,
                first: 0,
                tolerance: self.plan.spec.tolerance,
                places: Places {
                    at: place,
                    stride: 1,
                },
                stop,
            };
            self.general
                .fill(&line, self.roots.as_mut(), &mut self.buffers);
        }
        self.unflagged = false;
    }

    /// Fills the remaining quantities of the letter's own system. Only b = 0 without control is
    /// special, and roots do not accumulate.
    fn fill_linear(&mut self, crossings: &Crossings, at: usize) {
        let reason = match crossings.always_marginal {
            true => Reason::RootOnAxis.number(),
            false => 0,
        };
        let len = self.delays.values().len();
        for place in (at..).step_by(self.stride).take(len) {
            self.buffers.put(place, |field| match field.source() {
                Source::Linear(OfLinear::Reason) => Some(f64::from(reason)),
                Source::Linear(OfLinear::EssentialAbscissa) => Some(f64::NEG_INFINITY),
                Source::Linear(OfLinear::StiffnessRatio) => Some(f64::NAN),
                _ => None,
            });
        }
    }

    fn fill_in_place(&mut self, crossings: &Crossings, at: usize) {
        let delays = &self.delays;
        let to = at + delays.values().len();
        let tolerance = self.plan.spec.tolerance;
        let status = &mut self.buffers.status[at..to];
        let n = match &mut self.buffers.n_unstable {
            Some(n) => &mut n[at..to],
            None => &mut self.row.n_unstable[..to - at],
        };
        if !self.unflagged {
            status.fill(0);
        }
        let flagged = crossings.fill_counts(delays, tolerance, n, status);
        self.unflagged &= !flagged;
        if let Some(margin) = delay_margins(&mut self.buffers.columns) {
            crossings.fill_delay_margins(delays, &mut margin[at..to]);
        }
    }

    fn fill_by_row(&mut self, crossings: &Crossings, at: usize, stride: usize) {
        let delays = &self.delays;
        let len = delays.values().len();
        let row = &mut self.row;
        let tolerance = self.plan.spec.tolerance;
        let (n, status) = (&mut row.n_unstable[..len], &mut row.status[..len]);
        status.fill(0);
        let flagged = crossings.fill_counts(delays, tolerance, n, status);
        if flagged || !self.unflagged {
            scatter(status, &mut self.buffers.status[at..], stride);
        }
        self.unflagged &= !flagged;
        if let Some(out) = &mut self.buffers.n_unstable {
            scatter(n, &mut out[at..], stride);
        }
        if let Some(out) = delay_margins(&mut self.buffers.columns) {
            crossings.fill_delay_margins(delays, &mut row.delay_margin[..len]);
            scatter(&row.delay_margin[..len], &mut out[at..], stride);
        }
    }

    /// Computes the fields that need roots, in a line with known counts and statuses.
    fn fill_roots(&mut self, groups: Groups, time_unit: f64, at: usize) {
        let Some(roots) = &mut self.roots else { return };
        let len = self.delays.values().len();
        let (row, buffers) = (&mut self.row, &mut self.buffers);
        let in_place = self.stride == 1;
        let counts = match &buffers.n_unstable {
            Some(n) if in_place => &n[at..at + len],
            _ => &row.n_unstable[..len],
        };
        let status = match in_place {
            true => &mut buffers.status[at..at + len],
            false => &mut row.status[..len],
        };
        let line = Line {
            equation: groups,
            sensitivity: |tau, lambda| Sensitivity::of(groups, tau, lambda),
            time_unit,
            unit: 1.0,
            per_parameter: self.lines.groups_per_parameter(),
            delays: self.delays.values(),
            first: self.delay_range.start,
        };
        let columns = &mut buffers.columns;
        let places = Places {
            at,
            stride: self.stride,
        };
        roots.fill(&line, counts, status, columns, places);
        if !in_place {
            scatter(&row.status[..len], &mut buffers.status[at..], self.stride);
        }
        self.unflagged = false;
    }

    /// Fills a line without a sliding state.
    fn fill_without_sliding(&mut self, at: usize) {
        let len = self.delays.values().len();
        for place in (at..).step_by(self.stride).take(len) {
            self.buffers.status[place] = 0;
        }
    }

    /// Computes margins and the fields of motions and of the critical velocity, in a line with
    /// known statuses. Motions need a sliding state.
    fn fill_slowly(
        &mut self,
        offset: &[usize],
        inside: &[usize],
        at: usize,
        of_letter: Option<bool>,
        stop: &Stop,
    ) {
        if !self.slow {
            return;
        }
        let index = offset.iter().zip(inside).map(|(o, i)| o + i);
        let line = SlowLine {
            setting: &self.lines.setting,
            delays: self.delays.values(),
            places: Places {
                at,
                stride: self.stride,
            },
            numbers: Numbers {
                first: index
                    .zip(&self.map_strides)
                    .map(|(i, s)| i as u64 * s)
                    .sum(),
                step: self.plan.tau_axis.map_or(1, |axis| self.map_strides[axis]),
            },
            stop,
        };
        if let (Some(margins), Some(letter)) = (&mut self.margins, of_letter) {
            margins.fill(&line, letter, &mut self.buffers);
        }
        if let (Some(slip), true) = (&mut self.slip, self.slides) {
            slip.fill(&line, &mut self.buffers);
        }
        if let Some(basin) = &mut self.basin {
            basin.fill(&line, &mut self.buffers);
        }
        if let Some(vc) = &mut self.vc {
            vc.fill(&line, &mut self.buffers);
        }
        self.unflagged = false;
    }

    /// A line outside the model's range: its cells keep fill values and are flagged as not
    /// converged.
    fn refuse_line(&mut self, at: usize) {
        self.refuse(at, self.delays.values().len());
    }

    /// The first `len` cells of a line, from `at` on, keep fill values and are flagged.
    fn refuse(&mut self, at: usize, len: usize) {
        self.unflagged = false;
        for place in (at..).step_by(self.stride).take(len) {
            self.buffers.status[place] = NOT_CONVERGED;
            if let Some(n) = &mut self.buffers.n_unstable {
                n[place] = N_UNSTABLE_FILL;
            }
            for column in &mut self.buffers.kinds {
                column.cells[place] = FEW_FILL;
            }
            for column in &mut self.buffers.columns {
                column.cells[place] = f64::NAN;
            }
        }
    }
}

fn scatter<T: Copy>(row: &[T], out: &mut [T], stride: usize) {
    for (value, place) in row.iter().zip(out.iter_mut().step_by(stride)) {
        *place = *value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_and_nans_have_no_sign() {
        let mut cells = [-0.0, 0.0, -f64::NAN, f64::NAN, -1.5, f64::NEG_INFINITY];
        one_zero_and_one_nan(&mut cells);
        let expected = [0.0, 0.0, f64::NAN, f64::NAN, -1.5, f64::NEG_INFINITY];
        assert_eq!(cells.map(f64::to_bits), expected.map(f64::to_bits));
    }
}
