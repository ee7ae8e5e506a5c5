//! How much counting may still be done for a cell: numbers of steps, never time.

use std::cell::Cell;

use crate::linear::real_zeros::MOST_STEPS;

/// Steps along the frequency that all counts of one cell may take together. Where roots are not
/// crowded a cell takes some thousands.
pub(in super::super) const MOST_STEPS_OF_A_CELL: u64 = 1 << 18;

/// The steps that counts may still take; none are counted without latency.
#[derive(Debug, Clone)]
pub(in super::super) struct Budget {
    left: Cell<u64>,
    spent: Cell<u64>,
    most: u64,
}

impl Budget {
    /// A whole budget of `most` steps for each cell.
    pub(in super::super) const fn of(most: u64) -> Self {
        Self {
            left: Cell::new(most),
            spent: Cell::new(0),
            most,
        }
    }

    /// Makes the budget whole again.
    pub(in super::super) fn renew(&self) {
        self.left.set(self.most);
    }

    /// Whether nothing is left: no number of roots is decided any more.
    pub(in super::super) fn is_spent(&self) -> bool {
        self.left.get() == 0
    }

    /// The number of steps taken.
    pub(in super::super) fn spent(&self) -> u64 {
        self.spent.get()
    }

    /// Does `work`, which is told how many steps it may take and takes off those that it took.
    pub(super) fn spend<T>(&self, work: impl FnOnce(&mut u64) -> T) -> T {
        let most = self.left.get().min(MOST_STEPS);
        let mut left = most;
        let done = work(&mut left);
        let taken = most - left;
        self.left.set(self.left.get() - taken);
        self.spent.set(self.spent.get() + taken);
        done
    }
}

/// Without an end.
impl Default for Budget {
    fn default() -> Self {
        Self::of(u64::MAX)
    }
}
