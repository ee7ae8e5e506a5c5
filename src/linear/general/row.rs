//! A row of cells of a general system: one line's crossings laid over many delays.

use super::line::DelayLine;
use super::reason::Reason;
use crate::linear::count::{Count, MarginalTolerance};
use crate::linear::crossing::{Crossing, Direction};
use crate::linear::row::{Cursor, Delays, Line, Row, saturated};
use crate::linear::status::{MARGINAL, NOT_CONVERGED, NOT_COUNTED, SATURATED};

/// More crossing frequencies than this take memory from the heap, once a line.
const USUALLY_ENOUGH: usize = 16;

impl Line for DelayLine {
    #[inline(always)]
    fn count(&self, tau: f64, tolerance: MarginalTolerance) -> Count {
        DelayLine::count(self, tau, tolerance)
    }

    #[inline(always)]
    fn marginal_distance(
        &self,
        crossing: &Crossing,
        delay: f64,
        tolerance: MarginalTolerance,
    ) -> f64 {
        DelayLine::marginal_distance(self, crossing, delay, tolerance)
    }
}

impl DelayLine {
    /// The count of unstable roots and the status at every delay of a row: as [`DelayLine::count`]
    /// says, cell by cell.
    ///
    /// `n_unstable` and `status` have the length of `delays`, in the time unit of this line. Every
    /// element of `n_unstable` is written. `status` holds zeros to begin with, and flags are added
    /// where there are any: true is returned if so. Cells without a count hold [`NOT_COUNTED`] and
    /// are saturated where infinitely many roots are unstable, not converged where the number is
    /// not known; [`DelayLine::reason`] says why.
    pub fn fill_counts(
        &self,
        delays: &Delays,
        tolerance: MarginalTolerance,
        n_unstable: &mut [u16],
        status: &mut [u8],
    ) -> bool {
        let row = Row::new(self, delays, tolerance);
        if self.uncounted {
            self.without_counts(&row, delays, n_unstable, status);
            return row.flagged();
        }
        let fastest = self.crossings.first().map_or(0.0, |c| c.omega);
        // A real root's passage is no family of crossings.
        if self.passage.is_some() || row.is_dense(fastest) {
            row.by_cells(n_unstable, status);
            return row.flagged();
        }
        let mut few = [Cursor::IDLE; USUALLY_ENOUGH];
        let mut many;
        let cursors = if self.crossings.len() <= USUALLY_ENOUGH {
            &mut few[..]
        } else {
            many = vec![Cursor::IDLE; self.crossings.len()];
            &mut many[..]
        };
        let mut moving = 0;
        for crossing in &self.crossings {
            if crossing.direction == Direction::Touch {
                row.mark_touch(crossing, status);
            } else {
                cursors[moving] = row.cursor(Some(crossing), status);
                moving += 1;
            }
        }
        row.by_crossings(
            self.at_zero_delay,
            &mut cursors[..moving],
            n_unstable,
            status,
        );
        self.special_cells(&row, delays, n_unstable, status);
        row.flagged()
    }

    /// Fills the cells that no crossing tells of.
    fn special_cells(
        &self,
        row: &Row<Self>,
        delays: &Delays,
        n_unstable: &mut [u16],
        status: &mut [u8],
    ) {
        let values = delays.values();
        if self.always_marginal {
            row.flag(status, MARGINAL);
        } else {
            let at_zero = row.tolerance().0 * self.time_unit;
            if self.marginal_at_zero && values[0] <= at_zero {
                let first_ones = values.partition_point(|&tau| tau <= at_zero);
                row.flag(&mut status[..first_ones], MARGINAL);
            }
            if values[values.len() - 1] >= self.open_from {
                let open = values.partition_point(|&tau| tau < self.open_from);
                row.flag(&mut status[open..], MARGINAL);
            }
        }
        if values[0] == 0.0 {
            n_unstable[0] = saturated(self.without_delay);
        }
    }

    fn without_counts(
        &self,
        row: &Row<Self>,
        delays: &Delays,
        n_unstable: &mut [u16],
        status: &mut [u8],
    ) {
        n_unstable.fill(NOT_COUNTED);
        if self.reason != Some(Reason::Infinite) {
            row.flag(status, NOT_CONVERGED);
            return;
        }
        let (first, rest) = status.split_at_mut(usize::from(delays.values()[0] == 0.0));
        row.flag(rest, SATURATED);
        if let [first] = first {
            // Without delay there are as many roots as P + Q has zeros.
            n_unstable[0] = saturated(self.without_delay);
            if self.marginal_at_zero {
                row.flag(std::slice::from_mut(first), MARGINAL);
            }
        }
    }

    /// The signed distance to the nearest change of stability at every delay of a row, see
    /// [`DelayLine::delay_margin`].
    pub fn fill_delay_margins(&self, delays: &Delays, margins: &mut [f64]) {
        let mut walk = self.margins();
        for (tau, margin) in delays.values().iter().zip(margins) {
            *margin = walk.margin_at(*tau);
        }
    }
}
