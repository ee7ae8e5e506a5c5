//! The exact number of unstable roots, from the crossings of its line.
//!
//! ```text
//! n(τ) = n₀ + 2·#{k: τ_k(ω₊) < τ} − 2·#{k: τ_k(ω₋) < τ}                                    (1)
//! ```

use super::crossing::{Crossing, Crossings};

/// How near to a crossing a delay counts as marginal: |τ − τ_k| ≤ tolerance · max(1, τ_k), τ in
/// units of √(M/κ).
///
/// Where the crossing itself is known less well than that (near a tangency, or for tiny gains), the
/// bound on its rounding error takes the place of the tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarginalTolerance(pub f64);

impl Default for MarginalTolerance {
    /// 64 ε.
    fn default() -> Self {
        Self(64.0 * f64::EPSILON)
    }
}

/// The count of unstable roots at one delay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Count {
    /// Number of characteristic roots with positive real part; always even.
    pub n_unstable: u64,
    /// The delay lies within rounding of a crossing: the count may be the one on its other side.
    pub marginal: bool,
}

impl Count {
    /// Sliding is stable beyond doubt: no unstable root, and not marginal.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.n_unstable == 0 && !self.marginal
    }
}

impl Crossings {
    /// The count of unstable roots at the delay `tau` ≥ 0, in the time unit of these crossings.
    ///
    /// On a crossing itself the pair on the axis is not counted as moved, and the count is
    /// marginal.
    #[must_use]
    pub fn count(&self, tau: f64, tolerance: MarginalTolerance) -> Count {
        Count {
            n_unstable: self.n_unstable(tau),
            marginal: self.marginal(tau, tolerance),
        }
    }

    /// Equation (1) of the module. At τ = 0 this is the count of the open loop B.
    #[inline]
    #[must_use]
    pub fn n_unstable(&self, tau: f64) -> u64 {
        if tau == 0.0 && self.undamped {
            return 0;
        }
        let below = |crossing: &Option<Crossing>| crossing.map_or(0, |c| c.count_below(tau));
        (self.at_zero_delay + 2 * below(&self.upper)).saturating_sub(2 * below(&self.lower))
    }

    /// True where `tau` lies within rounding of a crossing or a touch.
    #[must_use]
    pub fn marginal(&self, tau: f64, tolerance: MarginalTolerance) -> bool {
        self.marginal_everywhere_or_at_zero(tau, tolerance)
            || self.iter().any(|crossing| {
                let allowed = |delay: f64| self.marginal_distance(crossing, delay, tolerance);
                crossing.marginal_at(tau, allowed)
            })
    }

    /// The two cases of b = 0 that no crossing delay marks: no control at all, and τ → 0.
    #[inline]
    #[must_use]
    pub fn marginal_everywhere_or_at_zero(&self, tau: f64, tolerance: MarginalTolerance) -> bool {
        self.always_marginal || (self.undamped && tau <= tolerance.0 * self.time_unit)
    }

    /// The distance from `delay`, a delay of `crossing`, up to which other delays are marginal.
    #[inline]
    #[must_use]
    pub fn marginal_distance(
        &self,
        crossing: &Crossing,
        delay: f64,
        tolerance: MarginalTolerance,
    ) -> f64 {
        (tolerance.0 * delay.max(self.time_unit)).max(crossing.delay_error(delay))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Groups, known_cases};

    fn count(b: f64, a_v: f64, a_n: f64, tau: f64) -> Count {
        Crossings::of(Groups::new(b, a_v, a_n)).count(tau, MarginalTolerance::default())
    }

    #[test]
    fn known_cases_have_their_counts() {
        let [a, b] = known_cases::letter_fig3();
        for case in [
            a,
            b,
            known_cases::beyond_the_letters_limit(),
            known_cases::positive_load_gain(),
        ] {
            let found = Crossings::of(case.groups).count(case.tau, MarginalTolerance::default());
            assert_eq!(found.n_unstable, case.n_unstable, "{}", case.source);
            assert!(!found.marginal, "{}", case.source);
        }
    }

    #[test]
    fn without_control_the_open_loop_decides_at_every_delay() {
        for tau in [0.0, 1e-9, 3.0, 1e6] {
            assert_eq!(count(-0.3, 0.0, 0.0, tau).n_unstable, 2);
            assert_eq!(count(-5.0, 0.0, 0.0, tau).n_unstable, 2);
            assert_eq!(count(0.3, 0.0, 0.0, tau).n_unstable, 0);
            assert!(!count(0.3, 0.0, 0.0, tau).marginal);
        }
    }

    #[test]
    fn without_delay_control_does_nothing() {
        assert_eq!(count(-0.3, -0.9, 4.0, 0.0).n_unstable, 2);
        assert_eq!(count(0.3, -0.9, 4.0, 0.0).n_unstable, 0);
    }

    #[test]
    fn undamped_and_uncontrolled_is_marginal_everywhere() {
        for tau in [0.0, 0.5, 100.0] {
            assert_eq!(
                count(0.0, 0.0, 0.0, tau),
                Count {
                    n_unstable: 0,
                    marginal: true
                }
            );
        }
    }

    /// To first order in τ the pair ±i leaves the axis with the sign of the load gain, so positive
    /// gain destabilises at b = 0.
    #[test]
    fn undamped_pair_moves_with_the_sign_of_the_load_gain() {
        assert_eq!(count(0.0, 0.0, 0.2, 0.1).n_unstable, 2);
        assert_eq!(count(0.0, 0.0, -0.2, 0.1).n_unstable, 0);
        assert_eq!(count(0.0, 0.7, -0.2, 0.1).n_unstable, 0);
        assert!(count(0.0, 0.0, 0.2, 0.0).marginal);
        assert_eq!(count(0.0, 0.0, 0.2, 0.0).n_unstable, 0);
        assert!(!count(0.0, 0.0, 0.2, 0.1).marginal);
    }

    #[test]
    fn undamped_velocity_control_touches_the_axis_at_full_turns() {
        for (a_v, expected) in [(0.4, 2), (-0.4, 0)] {
            for tau in [0.1, 3.0, 6.0, 6.5, 40.0] {
                let found = count(0.0, a_v, 0.0, tau);
                assert_eq!((found.n_unstable, found.marginal), (expected, false));
            }
            for k in 1..5 {
                assert!(count(0.0, a_v, 0.0, f64::from(k) * std::f64::consts::TAU).marginal);
            }
        }
    }

    #[test]
    fn an_exact_tangency_crosses_nothing_but_is_marginal() {
        // b = -1/2, a_n = -(b²/2 + |b|) = -5/8: ω₋ = ω₊ in exact arithmetic and in binary.
        let crossings = Crossings::of(Groups::new(-0.5, 0.0, -0.625));
        assert!(crossings.upper.is_none() && crossings.lower.is_none());
        let touch = crossings.touch.expect("the tangency is recognised");
        assert!((touch.omega - 1.5_f64.sqrt()).abs() < 1e-15);
        for k in 0..3 {
            let tau = touch.delay(k);
            let found = crossings.count(tau, MarginalTolerance::default());
            assert!(found.marginal && found.n_unstable == 2);
        }
        assert!(!crossings.marginal(touch.delay(0) + 0.01, MarginalTolerance::default()));
    }

    #[test]
    fn a_point_on_a_crossing_is_marginal_and_its_neighbours_differ_by_one_pair() {
        let crossings = Crossings::of(Groups::new(-0.3, 0.0, -1.0));
        let tolerance = MarginalTolerance::default();
        for crossing in crossings.iter() {
            for k in 0..20 {
                let tau = crossing.delay(k);
                assert!(crossings.marginal(tau, tolerance));
                let (below, above) = (tau * (1.0 - 1e-10), tau * (1.0 + 1e-10));
                assert!(!crossings.marginal(below, tolerance));
                assert!(!crossings.marginal(above, tolerance));
                let change =
                    crossings.n_unstable(above) as i64 - crossings.n_unstable(below) as i64;
                let expected = if crossing.direction == super::super::Direction::Right {
                    2
                } else {
                    -2
                };
                assert_eq!(change, expected);
            }
        }
    }

    #[test]
    fn absurdly_long_delays_end_and_are_marginal() {
        let crossings = Crossings::of(Groups::new(-0.3, 0.4, -1.0));
        for tau in [1e15, 1e18, 1e24, 1e300] {
            assert!(crossings.marginal(tau, MarginalTolerance::default()));
        }
    }

    #[test]
    fn phases_just_below_a_turn_cross_a_turn_later() {
        // b → 0⁻ with a_n > 0: θ rounds to 2π, and the pair is unstable from the start.
        let found = count(-1e-300, 0.0, 0.3, 1.0);
        assert_eq!(found.n_unstable, 2);
        // b → 0⁺ with a_n > 0: θ ≈ 0, and the pair crosses at once.
        assert_eq!(count(1e-300, 0.0, 0.3, 1.0).n_unstable, 2);
        assert_eq!(count(1e-300, 0.0, -0.3, 1.0).n_unstable, 0);
    }
}
