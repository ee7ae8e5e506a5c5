//! The argument of a sum of two terms along a line, continuous in ω.
//!
//! Where one of the two is the larger, the argument of the sum keeps within a right angle of its
//! own. Where they change places, the two readings differ by a whole number of turns, which is
//! carried on:
//!
//! ```text
//! arg(X + Y) = arg X + Arg(1 + Y/X) + 2πc    where |X| > |Y|,
//!            = arg Y + Arg(1 + X/Y) + 2πc    where |Y| > |X|,
//! c grows by ±m,   m = round[(arg X − arg Y)/2π],   + where Y becomes the larger one          (1)
//! ```
//!
//! A zero of X + Y on the line itself may be read as left or right of it: the number of zeros that
//! comes from the same m is then read alike.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use super::super::polynomial::{MOST_DEGREE, Polynomial};
use super::super::switches::Switches;
use crate::linear::newton::divide;
use crate::model::elementary::arg;

/// Frequencies at which the larger term changes must be known to this part of them.
const CERTAIN: f64 = 1e-3;

/// Where the larger one of two terms X and Y changes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sum {
    /// The frequencies, rising, with c beyond each.
    changes: [(f64, f64); MOST_DEGREE],
    count: usize,
    /// Whether X is the larger one at ω = 0.
    first_at_zero: bool,
    /// How many more zeros right of the line X + Y has than X, by (7) of
    /// [`right_of`](super::super::right_of).
    more_zeros: i64,
}

impl Sum {
    /// The sum of X and Y, where `difference` is |X|² − |Y|² and `arguments` tells the arguments of
    /// X and Y at a frequency. None where too little is known of `difference`.
    pub(super) fn new(
        difference: &Polynomial,
        switches: &mut Switches,
        arguments: impl Fn(f64) -> [f64; 2],
    ) -> Option<Self> {
        if !switches.find(difference, None) {
            return None;
        }
        let at_zero = switches.at_zero;
        let mut sum = Self {
            changes: [(0.0, 0.0); MOST_DEGREE],
            count: 0,
            first_at_zero: at_zero.unwrap_or(difference.coefficient(0).value > 0.0),
            more_zeros: 0,
        };
        if !sum.first_at_zero {
            let [first, second] = arguments(0.0);
            sum.more_zeros = ((second - first) / PI).round() as i64;
        }
        let mut turns = 0.0;
        for switch in switches.list.iter().rev().filter(|s| s.sign != 0) {
            if switch.error > CERTAIN * switch.omega {
                return None;
            }
            let [first, second] = arguments(switch.omega);
            let passed = ((first - second) / TAU).round();
            let sign = f64::from(switch.sign);
            turns -= sign * passed;
            sum.more_zeros += 2 * (sign * passed) as i64;
            sum.changes[sum.count] = (switch.omega, turns);
            sum.count += 1;
        }
        Some(sum)
    }

    /// How many more zeros right of the line X + Y has than X.
    pub(super) fn more_zeros(&self) -> i64 {
        self.more_zeros
    }

    /// The argument of X + Y at `omega`, from those of X and Y and their values there.
    pub(super) fn argument(&self, omega: f64, arguments: [f64; 2], values: [Complex64; 2]) -> f64 {
        let changes = &self.changes[..self.count];
        let passed = changes.iter().take_while(|(at, _)| *at <= omega).count();
        let turns = passed.checked_sub(1).map_or(0.0, |i| changes[i].1);
        let first = self.first_at_zero == passed.is_multiple_of(2);
        let (large, small) = if first { (0, 1) } else { (1, 0) };
        let ratio = divide(values[small], values[large]);
        arguments[large] + arg(1.0 + ratio) + TAU * turns
    }
}
