//! All delay intervals on which continuous sliding is stable.
//!
//! One setting of (b, a_v, a_n) fixes them all at once: they lie between a crossing to the left and the next one to the
//! right. Pairs come in at ω₊ faster than they leave at ω₋, so there are finitely many.

use std::f64::consts::TAU;

use super::crossing::{Crossing, Crossings};

/// An open interval of delays on which no root is unstable, in the time unit of its [`Crossings`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StableInterval {
    /// Lower end; 0 where sliding is stable from τ = 0⁺ on.
    pub from: f64,
    /// Upper end; infinite where sliding stays stable for every longer delay.
    pub to: f64,
}

/// Iterator over the stable intervals of a line, by growing delay.
#[derive(Debug, Clone)]
pub struct StableDelays {
    crossings: Crossings,
    next_upper: u64,
    next_lower: u64,
    n_unstable: u64,
    from: f64,
    /// No delay above this one is stable.
    last: f64,
    finished: bool,
}

impl Crossings {
    /// The stable delay intervals of this line. Without control at b = 0 there is none: every delay is marginal.
    #[must_use]
    pub fn stable_delays(&self) -> StableDelays {
        StableDelays {
            crossings: *self,
            next_upper: self.upper.map_or(0, |c| c.first_branch),
            next_lower: self.lower.map_or(0, |c| c.first_branch),
            n_unstable: self.at_zero_delay,
            from: 0.0,
            last: last_possible(self),
            finished: self.always_marginal,
        }
    }

    /// Signed distance in τ to the nearest change of stability: positive where stable, negative where not, infinite where
    /// stability never changes, and 0 at every delay where all of them are marginal. Same time unit as the crossings.
    ///
    /// For many delays of one line walk [`StableDelays`] once instead.
    #[must_use]
    pub fn delay_margin(&self, tau: f64) -> f64 {
        let mut walk = MarginWalk::new(self.stable_delays());
        walk.margin_at(tau)
    }
}

/// Beyond this delay pairs have come in for good: the count (1) of [`super::count`] stays above zero there.
fn last_possible(crossings: &Crossings) -> f64 {
    match (&crossings.upper, &crossings.lower) {
        (Some(upper), Some(lower)) => {
            let turns = TAU * 2.0 + upper.theta - lower.theta;
            turns / (upper.omega - lower.omega)
        }
        (Some(upper), None) => upper.delay(upper.first_branch + 1),
        (None, _) => f64::INFINITY,
    }
}

impl Iterator for StableDelays {
    type Item = StableInterval;

    fn next(&mut self) -> Option<StableInterval> {
        while !self.finished {
            let delay = |c: &Option<Crossing>, k| c.map_or(f64::INFINITY, |c: Crossing| c.delay(k));
            let upper = delay(&self.crossings.upper, self.next_upper);
            let lower = delay(&self.crossings.lower, self.next_lower);
            let (from, was_stable) = (self.from, self.n_unstable == 0);
            let here = upper.min(lower);
            self.finished = here == f64::INFINITY || here > self.last;
            // At equal delays the pair that comes in goes first, so that no interval of length zero appears.
            if upper <= lower {
                self.next_upper += 1;
                self.n_unstable += 2;
            } else {
                self.next_lower += 1;
                self.n_unstable = self.n_unstable.saturating_sub(2);
            }
            self.from = here;
            if was_stable && here > from {
                return Some(StableInterval { from, to: here });
            }
        }
        None
    }
}

/// Distances to the nearest change of stability, for delays that do not decrease from call to call.
#[derive(Debug, Clone)]
pub struct MarginWalk {
    always_marginal: bool,
    intervals: StableDelays,
    previous: Option<StableInterval>,
    current: Option<StableInterval>,
}

impl MarginWalk {
    /// Starts before the first of `intervals`.
    #[must_use]
    pub fn new(mut intervals: StableDelays) -> Self {
        let current = intervals.next();
        Self {
            always_marginal: intervals.crossings.always_marginal,
            intervals,
            previous: None,
            current,
        }
    }

    /// The signed distance at `tau`, see [`Crossings::delay_margin`]. `tau` must not be smaller than at the call before.
    #[inline]
    pub fn margin_at(&mut self, tau: f64) -> f64 {
        while let Some(interval) = self.current
            && interval.to < tau
        {
            self.previous = self.current;
            self.current = self.intervals.next();
        }
        let since_previous = self.previous.map_or(f64::INFINITY, |p| tau - p.to);
        match self.current {
            Some(interval) if interval.from == 0.0 || interval.from < tau => {
                // Stability does not change at the lower end τ = 0 of all delays.
                let since_from = if interval.from == 0.0 {
                    f64::INFINITY
                } else {
                    tau - interval.from
                };
                (interval.to - tau).min(since_from)
            }
            Some(interval) => -since_previous.min(interval.from - tau),
            None if self.always_marginal => 0.0,
            None => -since_previous,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::MarginalTolerance;
    use crate::model::Groups;

    fn intervals(b: f64, a_v: f64, a_n: f64) -> Vec<StableInterval> {
        Crossings::of(Groups::new(b, a_v, a_n))
            .stable_delays()
            .collect()
    }

    #[test]
    fn the_stated_stable_delays() {
        let velocity = intervals(-0.7, -0.3174, 0.0);
        assert_eq!(velocity.len(), 1);
        assert!((velocity[0].from - 4.29716).abs() < 5e-6);
        assert!((velocity[0].to - 4.32875).abs() < 5e-6);
        let load = intervals(-0.1, 0.0, 0.3);
        assert_eq!(load.len(), 1);
        assert!((load[0].from - 5.2611).abs() < 5e-5);
        assert!((load[0].to - 5.9971).abs() < 5e-5);
    }

    #[test]
    fn open_ends() {
        assert_eq!(
            intervals(0.4, 0.0, 0.0),
            [StableInterval {
                from: 0.0,
                to: f64::INFINITY
            }]
        );
        assert!(intervals(-0.4, 0.0, 0.0).is_empty());
        assert!(intervals(0.0, 0.0, 0.0).is_empty());
        assert_eq!(
            Crossings::of(Groups::new(0.4, 0.0, 0.0)).delay_margin(3.0),
            f64::INFINITY
        );
        assert_eq!(
            Crossings::of(Groups::new(-0.4, 0.0, 0.0)).delay_margin(3.0),
            f64::NEG_INFINITY
        );
    }

    #[test]
    fn intervals_and_counts_say_the_same() {
        let tolerance = MarginalTolerance::default();
        for (b, a_v, a_n) in [
            (-0.05, -0.4, 0.0),
            (-0.1, 0.0, -2.0),
            (0.2, 0.5, 0.3),
            (-0.02, 0.01, 0.2),
            (0.0, 0.1, -0.1),
        ] {
            let crossings = Crossings::of(Groups::new(b, a_v, a_n));
            let stable: Vec<_> = crossings.stable_delays().collect();
            let mut walk = MarginWalk::new(crossings.stable_delays());
            for i in 1..40_000 {
                let tau = f64::from(i) * 0.01;
                let inside = stable.iter().any(|s| s.from < tau && tau < s.to);
                let count = crossings.count(tau, tolerance);
                assert_eq!(inside, count.stable(), "{b} {a_v} {a_n} {tau}");
                let margin = walk.margin_at(tau);
                assert_eq!(margin > 0.0, inside);
                assert_eq!(margin, crossings.delay_margin(tau));
                if margin.is_finite() {
                    let beyond = [tau - margin.abs() - 1e-9, tau + margin.abs() + 1e-9];
                    assert!(
                        beyond
                            .iter()
                            .any(|&t| t > 0.0 && (crossings.n_unstable(t) == 0) != inside)
                    );
                }
            }
        }
    }
}
