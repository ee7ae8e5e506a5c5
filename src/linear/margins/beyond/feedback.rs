//! What feedback has beyond the letter's own, and which settings of it are stable.

use crate::linear::MarginalTolerance;
use crate::linear::feedback_loop::{FeedbackLoop, Friction, LagPolynomials};
use crate::linear::general::{DelayLine, RightOf, RootCounter};
use crate::model::{Channel, Groups, Lags};

/// What feedback has beyond the letter's own, in dimensionless numbers: (1) and (2) of `beyond`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Beyond {
    /// Memory and latency.
    pub channel: Channel,
    /// Lags.
    pub lags: Lags,
    /// d, the dashpot beside the spring.
    pub damping: f64,
}

impl Beyond {
    pub(super) fn lag_polynomials(&self) -> LagPolynomials {
        LagPolynomials::of(&self.lags)
    }

    /// The loop of these groups, (1) and (2) of `beyond`.
    #[must_use]
    pub(crate) fn of_groups(&self, groups: Groups) -> FeedbackLoop {
        let Groups { b, a_v, .. } = groups;
        let friction = Friction::of_slope(b, self.damping);
        FeedbackLoop::new(
            friction,
            a_v,
            self.load_gain(groups),
            self.channel,
            self.lags,
        )
    }

    /// a_n before the dashpot takes d a_v off it.
    pub(super) fn load_gain(&self, groups: Groups) -> f64 {
        groups.coupled(-self.damping).a_n
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
}
