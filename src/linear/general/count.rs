//! The count of unstable roots at a delay, from the crossings of its line: (5) of
//! [`line`](super::line).

use super::line::{DelayLine, Passage};
use super::reason::Reason;
use crate::linear::count::{Count, MarginalTolerance};
use crate::linear::crossing::Crossing;

impl DelayLine {
    /// 2 Σ s_j #{k: τ_{j,k} < τ} of (5) in `line`, and the passage of the real root.
    #[inline]
    pub(super) fn change_until(&self, tau: f64) -> i64 {
        let mut change = 0;
        for crossing in &self.crossings {
            change += 2 * i64::from(crossing.direction.sign()) * crossing.count_below(tau) as i64;
        }
        match self.passage {
            Some(passage) if passage.tau < tau => change + i64::from(passage.change),
            _ => change,
        }
    }

    /// Why the delay `tau` ≥ 0 is special, if it is. Without delay D is a polynomial and has
    /// finitely many roots.
    #[inline]
    #[must_use]
    pub(crate) fn reason_at(&self, tau: f64) -> Option<Reason> {
        let finite = |&reason: &Reason| tau > 0.0 || reason != Reason::Infinite;
        self.reason.filter(finite)
    }

    /// n(τ) of (5) in `line`, with whether `tau` ≥ 0 lies within rounding of a change.
    #[must_use]
    pub fn count(&self, tau: f64, tolerance: MarginalTolerance) -> Count {
        Count {
            n_unstable: self.n_unstable(tau),
            marginal: self.marginal(tau, tolerance),
        }
    }

    /// n(τ) of (5) in `line`. On a crossing itself the pair on the axis is not counted as moved.
    #[inline]
    #[must_use]
    pub fn n_unstable(&self, tau: f64) -> u64 {
        if tau == 0.0 {
            return self.without_delay;
        }
        let n = self.at_zero_delay as i64 + self.change_until(tau);
        u64::try_from(n).unwrap_or(0)
    }

    /// Whether `tau` lies within rounding of a change, or a root is on the axis at every delay.
    #[must_use]
    pub fn marginal(&self, tau: f64, tolerance: MarginalTolerance) -> bool {
        let allowed =
            |crossing: &Crossing, delay: f64| self.marginal_distance(crossing, delay, tolerance);
        self.always_marginal
            || tau >= self.open_from
            || (self.marginal_at_zero && tau <= tolerance.0 * self.time_unit)
            || self
                .passage
                .is_some_and(|p| self.near_passage(p, tau, tolerance))
            || self
                .crossings
                .iter()
                .any(|crossing| crossing.marginal_at(tau, |delay| allowed(crossing, delay)))
    }

    /// The distance from `delay`, one of the delays of `crossing`, up to which delays are marginal.
    #[inline]
    #[must_use]
    pub(crate) fn marginal_distance(
        &self,
        crossing: &Crossing,
        delay: f64,
        tolerance: MarginalTolerance,
    ) -> f64 {
        (tolerance.0 * delay.max(self.time_unit)).max(crossing.delay_error(delay))
    }

    fn near_passage(&self, passage: Passage, tau: f64, tolerance: MarginalTolerance) -> bool {
        let allowed = tolerance.0 * passage.tau.max(self.time_unit);
        (tau - passage.tau).abs() <= passage.error.max(allowed)
    }
}
