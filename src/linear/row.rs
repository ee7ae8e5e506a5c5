//! A row of cells: one line's crossings laid over many delays.
//!
//! Between two crossings the count is constant, so a row costs its crossings plus the time to fill
//! memory.

use std::cell::Cell;

use super::count::{Count, MarginalTolerance};
use super::crossing::{Crossing, Crossings};
use super::stable_delays::MarginWalk;
use super::status::{MARGINAL, MOST_COUNTED, SATURATED};

/// Delays of a row: finite, not negative, strictly increasing, in the time unit of the crossings
/// they are used with.
#[derive(Debug, Clone)]
pub struct Delays {
    /// −∞, the delays, ∞: no search runs off an end.
    fenced: Vec<f64>,
    /// 1/step where the delays are equally spaced to rounding, else 0.
    per_step: f64,
}

impl Delays {
    /// At least one delay, in increasing order.
    #[must_use]
    pub fn new(values: &[f64]) -> Self {
        let mut fenced = Vec::with_capacity(values.len() + 2);
        fenced.push(f64::NEG_INFINITY);
        fenced.extend_from_slice(values);
        fenced.push(f64::INFINITY);
        Self {
            fenced,
            per_step: reciprocal_step(values),
        }
    }

    /// Becomes the one delay `tau`, in the memory that it has.
    pub(crate) fn set_one(&mut self, tau: f64) {
        self.fenced.clear();
        self.fenced.extend([f64::NEG_INFINITY, tau, f64::INFINITY]);
        self.per_step = 0.0;
    }

    /// The delays themselves.
    #[inline]
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.fenced[1..self.fenced.len() - 1]
    }

    /// The index of the first delay greater than `tau`; their number if there is none.
    #[inline(always)]
    fn first_above(&self, tau: f64) -> usize {
        let fenced = self.fenced.as_slice();
        let most = fenced.len() - 2;
        if tau >= fenced[most] {
            return most;
        }
        if self.per_step == 0.0 {
            return fenced[1..=most].partition_point(|&v| v <= tau);
        }
        // Exact up to rounding on an evenly spaced grid; the loops make it right for any.
        let guess = (tau - fenced[1]) * self.per_step + 1.0;
        let mut i = (guess as i64).clamp(0, most as i64) as usize;
        while fenced[i] > tau {
            i -= 1;
        }
        while fenced[i + 1] <= tau {
            i += 1;
        }
        i
    }
}

fn reciprocal_step(values: &[f64]) -> f64 {
    let [first, .., last] = values else {
        return 0.0;
    };
    let step = (last - first) / (values.len() - 1) as f64;
    let even = values
        .iter()
        .enumerate()
        .all(|(i, v)| (v - (first + step * i as f64)).abs() < 0.25 * step);
    if even { 1.0 / step } else { 0.0 }
}

/// A line of delays, as far as a row of cells needs it.
pub(super) trait Line {
    /// The count at one delay.
    fn count(&self, tau: f64, tolerance: MarginalTolerance) -> Count;

    /// The distance from `delay`, a delay of `crossing`, up to which other delays are marginal.
    fn marginal_distance(
        &self,
        crossing: &Crossing,
        delay: f64,
        tolerance: MarginalTolerance,
    ) -> f64;
}

impl Line for Crossings {
    #[inline(always)]
    fn count(&self, tau: f64, tolerance: MarginalTolerance) -> Count {
        Crossings::count(self, tau, tolerance)
    }

    #[inline(always)]
    fn marginal_distance(
        &self,
        crossing: &Crossing,
        delay: f64,
        tolerance: MarginalTolerance,
    ) -> f64 {
        Crossings::marginal_distance(self, crossing, delay, tolerance)
    }
}

/// The place of a row in one family of crossings.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cursor<'c> {
    crossing: Option<&'c Crossing>,
    /// Branch of the next crossing.
    branch: u64,
    /// Number of crossings passed.
    passed: u64,
    /// Index of the first delay beyond the next crossing.
    index: usize,
}

impl Cursor<'_> {
    /// Without a crossing.
    pub(super) const IDLE: Self = Self {
        crossing: None,
        branch: 0,
        passed: 0,
        index: usize::MAX,
    };

    /// By how much a crossing changes the count.
    #[inline(always)]
    fn change(&self) -> i64 {
        2 * self.crossing.map_or(0, |c| i64::from(c.direction.sign()))
    }
}

/// The parts of a row that do not change along it.
pub(super) struct Row<'a, L> {
    line: &'a L,
    delays: &'a Delays,
    tolerance: MarginalTolerance,
    /// Whether some cell's status was changed.
    flagged: Cell<bool>,
}

impl<'a, L: Line> Row<'a, L> {
    #[inline(always)]
    pub(super) fn new(line: &'a L, delays: &'a Delays, tolerance: MarginalTolerance) -> Self {
        Self {
            line,
            delays,
            tolerance,
            flagged: Cell::new(false),
        }
    }

    /// How near to a crossing a delay is marginal.
    pub(super) fn tolerance(&self) -> MarginalTolerance {
        self.tolerance
    }

    /// Whether some cell's status was changed.
    #[inline(always)]
    pub(super) fn flagged(&self) -> bool {
        self.flagged.get()
    }

    /// Whether crossings of the frequency `fastest` are denser than cells.
    #[inline(always)]
    pub(super) fn is_dense(&self, fastest: f64) -> bool {
        let values = self.delays.values();
        let length = values[values.len() - 1] - values[0];
        fastest * length > 4.0 * values.len() as f64
    }

    #[inline]
    pub(super) fn cursor<'c>(
        &self,
        crossing: Option<&'c Crossing>,
        status: &mut [u8],
    ) -> Cursor<'c> {
        let mut cursor = Cursor {
            index: status.len(),
            crossing,
            ..Cursor::IDLE
        };
        if let Some(crossing) = crossing {
            cursor.branch = crossing.branch_at(self.delays.fenced[1]);
            cursor.passed = cursor.branch - crossing.first_branch;
            if cursor.passed > 0 {
                self.mark(crossing, crossing.delay(cursor.branch - 1), 0, status);
            }
            self.place(&mut cursor, crossing, status);
        }
        cursor
    }

    #[inline(always)]
    fn place(&self, cursor: &mut Cursor, crossing: &Crossing, status: &mut [u8]) {
        let delay = crossing.delay(cursor.branch);
        cursor.index = self.delays.first_above(delay);
        self.mark(crossing, delay, cursor.index, status);
    }

    #[inline(always)]
    fn advance(&self, cursor: &mut Cursor, status: &mut [u8]) {
        cursor.branch += 1;
        if let Some(crossing) = cursor.crossing {
            self.place(cursor, crossing, status);
        }
    }

    /// Marks the cells marginal to the crossing at `delay`, which lies just below the delay number
    /// `index`.
    #[inline(always)]
    fn mark(&self, crossing: &Crossing, delay: f64, index: usize, status: &mut [u8]) {
        let allowed = self.line.marginal_distance(crossing, delay, self.tolerance);
        let (below, above) = (self.delays.fenced[index], self.delays.fenced[index + 1]);
        if delay - below <= allowed || above - delay <= allowed {
            self.mark_within(delay, allowed, index, status);
        }
    }

    #[cold]
    pub(super) fn flag(&self, status: &mut [u8], flag: u8) {
        for s in status {
            *s |= flag;
        }
        self.flagged.set(true);
    }

    #[cold]
    fn mark_within(&self, delay: f64, allowed: f64, index: usize, status: &mut [u8]) {
        let near = |tau: f64| (tau - delay).abs() <= allowed;
        let (below, above) = self.delays.values().split_at(index);
        let marked_below = below.iter().rev().take_while(|&&tau| near(tau)).count();
        let marked_above = above.iter().take_while(|&&tau| near(tau)).count();
        self.flag(
            &mut status[index - marked_below..index + marked_above],
            MARGINAL,
        );
    }

    /// Fills between crossings, from `at_zero_delay` on: the cost is that of the crossings and of
    /// memory.
    #[inline(always)]
    pub(super) fn by_crossings(
        &self,
        at_zero_delay: u64,
        cursors: &mut [Cursor],
        n_unstable: &mut [u16],
        status: &mut [u8],
    ) {
        let len = n_unstable.len();
        let behind = |c: &Cursor| c.change() * c.passed as i64;
        let mut n = at_zero_delay as i64 + cursors.iter().map(behind).sum::<i64>();
        let mut from = 0;
        loop {
            let to = cursors.iter().fold(len, |to, c| to.min(c.index));
            let count = n.max(0) as u64;
            if count > u64::from(MOST_COUNTED) {
                self.flag(&mut status[from..to], SATURATED);
            }
            fill_ahead(&mut n_unstable[from..], to - from, saturated(count));
            if to == len {
                break;
            }
            from = to;
            if let Some(next) = cursors.iter_mut().find(|c| c.index == to) {
                n += next.change();
                self.advance(next, status);
            }
        }
    }

    /// Marks the cells marginal to a touch, which changes no count.
    #[inline(always)]
    pub(super) fn mark_touch(&self, touch: &Crossing, status: &mut [u8]) {
        let mut cursor = self.cursor(Some(touch), status);
        while cursor.index < status.len() {
            self.advance(&mut cursor, status);
        }
    }

    /// Cell by cell: cheaper where crossings are denser than cells.
    pub(super) fn by_cells(&self, n_unstable: &mut [u16], status: &mut [u8]) {
        for ((tau, n), status) in self.delays.values().iter().zip(n_unstable).zip(status) {
            let count = self.line.count(*tau, self.tolerance);
            *n = saturated(count.n_unstable);
            let cell = std::slice::from_mut(status);
            if count.n_unstable > u64::from(MOST_COUNTED) {
                self.flag(cell, SATURATED);
            }
            if count.marginal {
                self.flag(cell, MARGINAL);
            }
        }
    }
}

impl Row<'_, Crossings> {
    /// The cells that b = 0 makes special, see [`Crossings::marginal_everywhere_or_at_zero`].
    fn undamped_cells(&self, n_unstable: &mut [u16], status: &mut [u8]) {
        let crossings = self.line;
        if !crossings.undamped {
            return;
        }
        let marginal = |&&tau: &&f64| crossings.marginal_everywhere_or_at_zero(tau, self.tolerance);
        let first_ones = self.delays.values().iter().take_while(marginal).count();
        if first_ones > 0 {
            self.flag(&mut status[..first_ones], MARGINAL);
        }
        if self.delays.fenced[1] == 0.0 {
            n_unstable[0] = 0;
        }
    }
}

/// Fills at least the first `length` elements, in whole blocks; elements beyond are overwritten by
/// the next stretch.
#[inline]
fn fill_ahead(row: &mut [u16], length: usize, value: u16) {
    const BLOCK: usize = 32;
    let (blocks, rest) = row.as_chunks_mut::<BLOCK>();
    let wanted = length.div_ceil(BLOCK);
    for block in blocks.iter_mut().take(wanted) {
        *block = [value; BLOCK];
    }
    if wanted > blocks.len() {
        rest.fill(value);
    }
}

pub(super) fn saturated(count: u64) -> u16 {
    count.min(u64::from(MOST_COUNTED)) as u16
}

impl Crossings {
    /// The count of unstable roots and the status at every delay of a row, the same as
    /// [`Crossings::count`] cell by cell.
    ///
    /// `n_unstable` and `status` have the length of `delays`. Every element of `n_unstable` is
    /// written. `status` has to hold zeros; flags are added to it. Returns whether any were. Counts
    /// above [`MOST_COUNTED`] are cut, and flagged in the status.
    pub fn fill_counts(
        &self,
        delays: &Delays,
        tolerance: MarginalTolerance,
        n_unstable: &mut [u16],
        status: &mut [u8],
    ) -> bool {
        let row = Row::new(self, delays, tolerance);
        let fastest = self.upper.or(self.touch).map_or(0.0, |c| c.omega);
        if row.is_dense(fastest) {
            row.by_cells(n_unstable, status);
        } else {
            let mut cursors =
                [&self.upper, &self.lower].map(|c| row.cursor(c.as_ref(), &mut *status));
            row.by_crossings(self.at_zero_delay, &mut cursors, n_unstable, status);
            if let Some(touch) = &self.touch {
                row.mark_touch(touch, status);
            }
            row.undamped_cells(n_unstable, status);
        }
        row.flagged()
    }

    /// The signed distance to the nearest change of stability at every delay of a row, see
    /// [`Crossings::delay_margin`].
    pub(crate) fn fill_delay_margins(&self, delays: &Delays, margins: &mut [f64]) {
        let mut walk = MarginWalk::new(self);
        for (tau, margin) in delays.values().iter().zip(margins) {
            *margin = walk.margin_at(*tau);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Groups;
    use proptest::prelude::*;

    fn check_row(crossings: &Crossings, values: &[f64]) {
        let tolerance = MarginalTolerance::default();
        let (mut n, mut status) = (vec![9; values.len()], vec![0; values.len()]);
        let flagged = crossings.fill_counts(&Delays::new(values), tolerance, &mut n, &mut status);
        assert_eq!(flagged, status.iter().any(|&s| s != 0));
        for ((tau, n), status) in values.iter().zip(n).zip(status) {
            let count = crossings.count(*tau, tolerance);
            assert_eq!(n, saturated(count.n_unstable), "{crossings:?} {tau}");
            assert_eq!(
                status & MARGINAL != 0,
                count.marginal,
                "{crossings:?} {tau}"
            );
        }
    }

    proptest! {
        /// A row and single cells agree exactly, for even and uneven delays, and for delays that
        /// hit crossings.
        #[test]
        fn rows_are_their_cells(
            b in prop_oneof![-2.5..1.0_f64, Just(0.0), Just(-0.5)],
            a_v in prop_oneof![-3.0..3.0_f64, Just(0.0)],
            a_n in prop_oneof![-15.0..5.0_f64, Just(0.0), Just(-0.625)],
            from in prop_oneof![0.0..20.0_f64, Just(0.0)],
            length in prop_oneof![1e-3..50.0_f64, Just(5e3)],
            points in 1_usize..300,
        ) {
            let crossings = Crossings::of(Groups::new(b, a_v, a_n));
            let even = |i: usize| from + length * i as f64 / points as f64;
            let even: Vec<f64> = (0..points).map(even).collect();
            check_row(&crossings, &even);
            let squared: Vec<f64> = even.iter().map(|t| t * t).collect();
            check_row(&crossings, &squared);
            let mut on_crossings: Vec<f64> = crossings
                .iter()
                .flat_map(|c| (0..40).map(|k| c.delay(k + c.first_branch)))
                .collect();
            on_crossings.sort_by(f64::total_cmp);
            on_crossings.dedup();
            if !on_crossings.is_empty() {
                check_row(&crossings, &on_crossings);
            }
        }
    }

    #[test]
    fn counts_beyond_the_type_saturate_and_say_so() {
        let crossings = Crossings::of(Groups::new(-0.3, 2.0, 4.0));
        for values in [
            vec![1.0, 1e6, 2e6],
            (0..100_000).map(|i| 1e6 + f64::from(i)).collect(),
        ] {
            let (mut n, mut status) = (vec![0; values.len()], vec![0; values.len()]);
            let tolerance = MarginalTolerance::default();
            crossings.fill_counts(&Delays::new(&values), tolerance, &mut n, &mut status);
            let last = values.len() - 1;
            assert_eq!(
                (n[last], status[last] & SATURATED),
                (MOST_COUNTED, SATURATED)
            );
        }
    }
}
