//! Linear models, and what is told of each of them whatever its kind: all its delays, its roots.
//!
//! The kinds are told apart once, in [`Linear`]; answers about one setting ask a [`Line`] and
//! [`Roots`]. Cells of maps have measured kernels of their own, one dispatch a line.
//!
//! - `general`: any linear system with one delay, and with latency
//! - `letter`: the letter's closed form
//! - `linear`: the kinds of linear models

mod general;
mod letter;
mod linear;

pub use linear::Linear;

use super::count::{Count, MarginalTolerance};
use super::crossing::Crossing;
use super::general::stable::Change;
use super::general::{Reason, RightOf, Spectrum};
use super::stable_delays::StableInterval;

/// The roots of a linear model at any delay, dimensionless.
pub trait Roots {
    /// All delays, in units of which √(M/κ) is `time_unit`.
    fn line(&self, time_unit: f64) -> Box<dyn Line>;

    /// The number of unstable roots at the delay `tau` ≥ 0, in units of which √(M/κ) is
    /// `time_unit`; none where infinitely many are unstable or nothing is known.
    fn count(&self, tau: f64, time_unit: f64) -> Option<Count>;

    /// The `wanted` rightmost roots, at least one, at the delay `tau` ≥ 0.
    fn spectrum(&self, tau: f64, wanted: usize) -> Spectrum;

    /// [`Roots::spectrum`], where the number of unstable roots at that delay was counted before.
    fn counted(&self, tau: f64, wanted: usize, _count: Option<Count>) -> Spectrum {
        self.spectrum(tau, wanted)
    }

    /// The real part at which roots accumulate at the delay `tau` ≥ 0; −∞ where they do not.
    fn essential_abscissa(&self, _tau: f64) -> f64 {
        f64::NEG_INFINITY
    }

    /// The number of roots right of Re λ = `line` at the delay `tau` ≥ 0.
    fn right_of(&self, tau: f64, line: f64) -> RightOf;

    /// Whether there is no feedback: the delay then does not matter.
    fn uncontrolled(&self) -> bool;
}

/// All delays of a linear model.
pub trait Line {
    /// √(M/κ) in the unit of the delays.
    fn time_unit(&self) -> f64;

    /// The number of unstable roots at the delay `tau` ≥ 0; none where infinitely many are unstable
    /// or nothing is known.
    fn count(&self, tau: f64, tolerance: MarginalTolerance) -> Option<Count>;

    /// The number of unstable roots, as [`Line::count`], without asking how near a crossing is.
    fn n_unstable(&self, tau: f64) -> Option<u64> {
        let count = self.count(tau, MarginalTolerance::default());
        count.map(|count| count.n_unstable)
    }

    /// What is special about the line, if anything.
    fn reason(&self) -> Option<Reason> {
        None
    }

    /// The number of unstable roots as the delay goes to 0; none where it is infinite or not known.
    fn n_at_zero_delay(&self) -> Option<u64>;

    /// The crossings and touches.
    fn crossings(&self) -> Box<dyn Iterator<Item = &Crossing> + '_>;

    /// Whether these are all of them.
    fn crossings_known(&self) -> bool {
        true
    }

    /// Whether the stable delays are known. Where infinitely many roots are unstable there are
    /// none.
    fn delays_known(&self) -> bool {
        self.reason() == Some(Reason::Infinite) || self.crossings_known()
    }

    /// The changes of the number of unstable roots with τ > 0, by growing delay.
    fn changes(&self) -> Box<dyn Iterator<Item = Change> + '_>;

    /// The delays at which no root is unstable, by growing delay.
    fn stable_intervals(&self) -> Box<dyn Intervals + '_>;

    /// The signed distance in τ to the nearest change of stability: positive where stable, negative
    /// where not, infinite where that never changes; NaN where it is not known.
    fn delay_margin(&self, tau: f64) -> f64;
}

/// Stable intervals of a line by growing delay.
pub trait Intervals: Iterator<Item = StableInterval> {
    /// Whether there were too many changes to go through: intervals may have been left out.
    fn gave_up(&self) -> bool {
        false
    }
}
