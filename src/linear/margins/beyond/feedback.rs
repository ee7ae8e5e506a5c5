//! What feedback has beyond the letter's own, and which settings of it are stable.

use crate::linear::MarginalTolerance;
use crate::linear::feedback_loop::{FeedbackLoop, LagPolynomials};
use crate::linear::general::{DelayLine, RightOf, RootCounter};
use crate::linear::stable_delays::StableInterval;
use crate::model::elementary::ln;
use crate::model::{Channel, Groups, Lags};

/// What feedback has beyond the letter's own, in dimensionless numbers: (1) and (2) of `beyond`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Beyond {
    /// Memory and latency.
    pub channel: Channel,
    /// Lags.
    pub lags: Lags,
}

impl Beyond {
    pub(super) fn lag_polynomials(&self) -> LagPolynomials {
        LagPolynomials::of(&self.lags)
    }

    /// The loop of these groups, (1) and (2) of `beyond`.
    #[must_use]
    pub fn of_groups(&self, groups: Groups) -> FeedbackLoop {
        FeedbackLoop::of_letter(groups, self.channel, self.lags)
    }

    /// Whether all roots are left of Re λ = −`decay` at the delay `tau`; none where one is on that
    /// line within rounding. On the imaginary axis the answer comes from the crossings, as in maps.
    pub(in super::super) fn stability(&self, groups: Groups, tau: f64, decay: f64) -> Option<bool> {
        let system = self.of_groups(groups).system();
        if decay == 0.0 {
            let line = DelayLine::of(&system);
            let count = line.count(tau, MarginalTolerance::default());
            let known = !line.uncounted && !count.marginal;
            return known.then_some(count.n_unstable == 0);
        }
        match RootCounter::new(&system).right_of(tau, -decay) {
            RightOf::Roots(roots) => Some(roots == 0),
            RightOf::Infinite => Some(false),
            RightOf::Undecided => None,
        }
    }

    /// The interval of delays around `tau` in which sliding is stable; none where it is not. And
    /// how many frequencies took many digits.
    pub(in super::super) fn stable_interval_at(
        &self,
        groups: Groups,
        tau: f64,
    ) -> (Option<StableInterval>, u32) {
        let line = DelayLine::of(&self.of_groups(groups).system());
        (line.stable_interval_at(tau), line.resolved)
    }

    /// The delay at which infinitely many roots come to the line Re λ = −`decay`: ln(1/|R|)/σ.
    pub(in super::super) fn last_delay(&self, decay: f64) -> f64 {
        match self.channel.memory {
            0.0 => f64::INFINITY,
            memory => -ln(memory.abs()) / decay,
        }
    }
}
