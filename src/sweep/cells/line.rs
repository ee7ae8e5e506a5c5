//! A line of cells: its places in the buffers of a tile and in the map.

use crate::model::stop::Stop;
use crate::setting::parameter::Parameter;
use crate::setting::values::Setting;

/// Places of the cells of a line in the buffers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Places {
    /// Place of the first cell.
    pub at: usize,
    /// Distance between neighbouring cells.
    pub stride: usize,
}

impl Places {
    /// Place of the `i`-th cell.
    #[inline]
    pub(super) const fn of(self, i: usize) -> usize {
        self.at + i * self.stride
    }

    /// Copies the cells of a line to their places.
    #[inline]
    pub(super) fn copy<T: Copy>(self, from: &[T], to: &mut [T]) {
        if self.stride == 1 {
            to[self.at..][..from.len()].copy_from_slice(from);
            return;
        }
        let places = to[self.at..].iter_mut().step_by(self.stride);
        for (value, place) in from.iter().zip(places) {
            *place = *value;
        }
    }

    /// Puts one value into all `len` cells of a line.
    pub(super) fn fill<T: Copy>(self, value: T, len: usize, to: &mut [T]) {
        if self.stride == 1 {
            to[self.at..][..len].fill(value);
            return;
        }
        for i in 0..len {
            to[self.of(i)] = value;
        }
    }
}

/// Numbers of the cells of a line in the whole map, all cells counted row by row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbers {
    /// Number of the first cell.
    pub first: u64,
    /// Difference between neighbouring cells.
    pub step: u64,
}

/// A line whose cells take so long that `stop` is checked between them.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlowLine<'a> {
    /// All parameters but the delay.
    pub setting: &'a Setting,
    pub delays: &'a [f64],
    pub places: Places,
    pub numbers: Numbers,
    /// Whether it is a line of the letter's own model; none without a sliding state.
    pub of_letter: Option<bool>,
    /// Once it is set, no further cells are computed.
    pub stop: &'a Stop,
}

/// A cell of such a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Here<'s> {
    pub setting: &'s Setting,
    /// Its number on the line.
    pub i: usize,
    pub place: usize,
    /// Its number in the whole map.
    pub number: u64,
}

impl SlowLine<'_> {
    pub(super) fn stopped(&self) -> bool {
        self.stop.is_set()
    }

    /// Visits the cells in order, until a stop.
    pub(super) fn each(&self, mut visit: impl FnMut(Here)) {
        let mut setting = self.setting.clone();
        for (i, tau) in self.delays.iter().enumerate() {
            if self.stopped() {
                return;
            }
            setting.set(Parameter::Tau, *tau);
            visit(Here {
                setting: &setting,
                i,
                place: self.places.of(i),
                number: self.numbers.first + i as u64 * self.numbers.step,
            });
        }
    }
}
