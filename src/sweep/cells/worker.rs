//! One thread's work: the cells of a tile, line by line, into buffers that are reused.

use std::ops::Range;

use super::any_columns::{self, AnyCells};
use super::buffers::{FEW_FILL, N_UNSTABLE_FILL, TileBuffers, one_zero_and_one_nan};
use super::families::FieldFamily;
use super::general_columns::{GeneralColumns, GeneralLine};
use super::letter_columns::{LetterColumns, LetterLine};
use super::limit_columns;
use super::line::{Numbers, Places, SlowLine};
use super::lines::Lines;
use super::root_columns::RootColumns;
use crate::linear::general::System;
use crate::linear::line::Linear;
use crate::linear::row::Delays;
use crate::linear::status::OUTSIDE_MODEL;
use crate::model::Groups;
use crate::model::stop::Stop;
use crate::setting::parameter::Parameter;
use crate::sweep::plan::Plan;
use crate::sweep::plan::tile::{Tile, for_each_index_along, place_of, strides_of};

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
    /// Lines of the letter's own model.
    letter: LetterColumns,
    /// Follows roots, where a field needs them.
    roots: Option<RootColumns>,
    /// Lines of general systems.
    general: GeneralColumns,
    /// The families of fields whose cells take so long that `stop` is checked between them.
    families: Vec<FieldFamily<'p>>,
    /// Distance between neighbouring cells along each axis in the whole map.
    map_strides: Vec<u64>,
    /// Whether cells have a sliding state.
    slides: bool,
    /// One delay at a time, for systems whose polynomials depend on the delay.
    by_delay: Option<Delays>,
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
            letter: LetterColumns::new(&plan.spec.fields, longest),
            roots: RootColumns::new(&plan.spec.fields),
            general: GeneralColumns::default(),
            families: FieldFamily::all(&plan.spec),
            map_strides: strides_of(plan.shape()),
            slides: plan.spec.has_sliding(),
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
        let Plan {
            tau_axis,
            shared_axis,
            ..
        } = *self.plan;
        for_each_index_along(&tile.extent, tau_axis, shared_axis, |inside| {
            let at = place_of(inside, &self.strides);
            self.lines.move_to(&tile.offset, inside);
            if let Some(mut one) = self.by_delay.take() {
                self.fill_by_delay(&mut one, at, stop);
                self.by_delay = Some(one);
                self.fill_slowly(&tile.offset, inside, at, None, stop);
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
                Ok((of, time_unit)) => {
                    self.fill_any((&of, time_unit), None, at, stop);
                    Some(false)
                }
                Err(_) => return self.refuse_line(at),
            };
            self.fill_slowly(&tile.offset, inside, at, of_letter, stop);
            let slow = of_letter == Some(false) || !self.families.is_empty();
            cut_short |= slow && stop.is_set();
        });
        !cut_short
    }

    /// Computes the cells of a line of the letter's own model.
    #[inline]
    fn fill_line(&mut self, groups: Groups, time_unit: f64, at: usize) {
        let line = LetterLine {
            groups,
            time_unit,
            lines: &self.lines,
            delays: &self.delays,
            first: self.delay_range.start,
            tolerance: self.plan.spec.tolerance,
            places: self.places(at),
        };
        let roots = self.roots.as_mut();
        self.unflagged = self
            .letter
            .fill(&line, self.unflagged, roots, &mut self.buffers);
    }

    fn places(&self, at: usize) -> Places {
        Places {
            at,
            stride: self.stride,
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
            places: self.places(at),
            stop,
        };
        self.general
            .fill(&line, self.roots.as_mut(), &mut self.buffers);
        self.unflagged = false;
    }

    /// Computes the cells of a line of a model without a kernel of its own, or of `one` delay.
    fn fill_any(
        &mut self,
        (of, time_unit): (&Linear, f64),
        one: Option<&Delays>,
        at: usize,
        stop: &Stop,
    ) {
        let cells = AnyCells {
            of,
            time_unit,
            delays: one.unwrap_or(&self.delays).values(),
            tolerance: self.plan.spec.tolerance,
            places: self.places(at),
            fields: &self.plan.spec.fields,
            stop,
        };
        any_columns::fill(&cells, &mut self.buffers);
        self.unflagged = false;
    }

    /// Computes the cells of a line whose polynomials depend on the delay, each as its own line.
    fn fill_by_delay(&mut self, one: &mut Delays, at: usize, stop: &Stop) {
        for i in 0..self.delays.values().len() {
            let (tau, place) = (self.delays.values()[i], at + i * self.stride);
            one.set_one(tau);
            self.lines.setting.set(Parameter::Tau, tau);
            let model = self.lines.model();
            let (system, time_unit) = match model {
                Ok((Linear::General(system), time_unit)) => (system, time_unit),
                Ok((of, time_unit)) => {
                    self.fill_any((&of, time_unit), Some(one), place, stop);
                    continue;
                }
                Err(_) => {
                    self.refuse(place, 1);
                    continue;
                }
            };
            let line = GeneralLine {
                system: &system,
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

    /// Fills a line without a sliding state.
    fn fill_without_sliding(&mut self, at: usize) {
        let len = self.delays.values().len();
        for place in (at..).step_by(self.stride).take(len) {
            self.buffers.status[place] = 0;
        }
    }

    /// Computes what takes long in a line with known statuses.
    fn fill_slowly(
        &mut self,
        offset: &[usize],
        inside: &[usize],
        at: usize,
        of_letter: Option<bool>,
        stop: &Stop,
    ) {
        if self.families.is_empty() {
            return;
        }
        let index = offset.iter().zip(inside).map(|(o, i)| o + i);
        let line = SlowLine {
            setting: &self.lines.setting,
            delays: self.delays.values(),
            places: self.places(at),
            numbers: Numbers {
                first: index
                    .zip(&self.map_strides)
                    .map(|(i, s)| i as u64 * s)
                    .sum(),
                step: self.plan.tau_axis.map_or(1, |axis| self.map_strides[axis]),
            },
            of_letter,
            stop,
        };
        for family in &mut self.families {
            family.fill(&line, &mut self.buffers);
        }
        self.unflagged = false;
    }

    /// A line outside the model's range: its cells have no values, and their status says so.
    fn refuse_line(&mut self, at: usize) {
        self.refuse(at, self.delays.values().len());
    }

    /// The first `len` cells of a line, from `at` on, are outside the model's range.
    fn refuse(&mut self, at: usize, len: usize) {
        self.unflagged = false;
        for place in (at..).step_by(self.stride).take(len) {
            self.buffers.status[place] = OUTSIDE_MODEL;
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
