//! All delay intervals on which continuous sliding is stable, in closed form.
//!
//! Let U_0 < U_1 < … be the delays at which pairs cross to the right and L_0 < L_1 < … those at
//! which they cross to the left. The count n₀ + 2 #{U_i < τ} − 2 #{L_i < τ} is zero exactly on
//!
//! ```text
//! n₀ = 2:   (L_i, U_i),                   i = 0, 1, …                                       (1)
//! n₀ = 0:   (0, U_0)  and  (L_{i−1}, U_i), i = 1, 2, …
//! ```
//!
//! as far as these are not empty. Pairs come in more often than they leave (ω₊ > ω₋), so the
//! lengths shrink by the same amount from each to the next, and the first empty one ends the list.

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
    next: u64,
}

impl Iterator for StableDelays {
    type Item = StableInterval;

    fn next(&mut self) -> Option<StableInterval> {
        let first = self.crossings.first_interval();
        if self.next < first {
            self.next = first;
        }
        let interval = self.crossings.stable_interval(self.next)?;
        self.next += 1;
        Some(interval)
    }
}

fn nth_delay(crossing: Option<&Crossing>, i: u64) -> Option<f64> {
    crossing.map(|c| c.delay(c.first_branch + i))
}

impl Crossings {
    /// The stable delay intervals of this line. Without control at b = 0 there is none: every delay
    /// is marginal.
    #[must_use]
    pub fn stable_delays(&self) -> StableDelays {
        StableDelays {
            crossings: *self,
            next: 0,
        }
    }

    /// The stable interval that holds the delay `tau` ≥ 0, if one does.
    #[must_use]
    pub fn stable_interval_at(&self, tau: f64) -> Option<StableInterval> {
        let number = self.interval_below(tau)?;
        let interval = self.stable_interval(number)?;
        (interval.from <= tau && tau < interval.to).then_some(interval)
    }

    /// Signed distance in τ to the nearest change of stability: positive where stable, negative
    /// where not, infinite where stability never changes, and 0 at every delay where all of them
    /// are marginal. Same time unit as the crossings.
    #[must_use]
    pub fn delay_margin(&self, tau: f64) -> f64 {
        MarginWalk::new(self).margin_at(tau)
    }

    /// The interval number `i` of (1), or none where it is empty.
    #[inline]
    fn stable_interval(&self, i: u64) -> Option<StableInterval> {
        let stable_at_once = self.at_zero_delay == 0;
        let from = match (stable_at_once, i) {
            _ if self.always_marginal => None,
            (true, 0) => Some(0.0),
            (true, i) => nth_delay(self.lower.as_ref(), i - 1),
            (false, i) => nth_delay(self.lower.as_ref(), i),
        }?;
        let to = nth_delay(self.upper.as_ref(), i).unwrap_or(f64::INFINITY);
        (from < to).then_some(StableInterval { from, to })
    }

    /// 0, or 1 where the interval from τ = 0 on is empty because a pair comes in right there.
    fn first_interval(&self) -> u64 {
        u64::from(self.at_zero_delay == 0 && self.stable_interval(0).is_none())
    }

    /// The number of the last stable interval, or none where there is none.
    fn last_interval(&self) -> Option<u64> {
        let first = self.first_interval();
        let exists = |i: u64| self.stable_interval(i).is_some();
        if !exists(first) {
            return None;
        }
        // Lengths only shrink: doubling and halving finds the last, however many there are.
        let mut step = 1;
        while step < 1 << 52 && exists(first + step) {
            step *= 2;
        }
        let (mut there, mut gone) = (first + step / 2, first + step);
        while gone - there > 1 {
            let middle = there + (gone - there) / 2;
            if exists(middle) {
                there = middle;
            } else {
                gone = middle;
            }
        }
        Some(there)
    }

    /// The number of the last interval that begins below `tau`, whether empty or not.
    fn interval_below(&self, tau: f64) -> Option<u64> {
        let begun = self.lower.map_or(0, |c| c.count_below(tau));
        match self.at_zero_delay {
            0 => Some(begun),
            _ => begun.checked_sub(1),
        }
    }
}

/// The signed distance of `tau` to the nearest change of stability, `below` being the last stable
/// interval that begins below it and `above` the first one beyond.
#[inline(always)]
pub(super) fn signed_distance(
    tau: f64,
    below: Option<StableInterval>,
    above: Option<StableInterval>,
) -> f64 {
    let to_next = above.map_or(f64::INFINITY, |next| next.from - tau);
    match below {
        // Stability does not change at the lower end τ = 0 of all delays.
        Some(StableInterval { from, to }) if tau <= to => match from {
            0.0 => to - tau,
            _ => (to - tau).min(tau - from),
        },
        Some(passed) => 0.0 - to_next.min(tau - passed.to),
        None => 0.0 - to_next,
    }
}

/// Distances to the nearest change of stability on one line. Quick for delays that grow from call
/// to call, right for any.
#[derive(Debug, Clone)]
pub struct MarginWalk<'c> {
    crossings: &'c Crossings,
    last: Option<u64>,
    /// The range of delays in which `below` and `above` hold.
    valid: (f64, f64),
    below: Option<StableInterval>,
    above: Option<StableInterval>,
}

impl<'c> MarginWalk<'c> {
    /// For the line with these crossings.
    #[must_use]
    pub fn new(crossings: &'c Crossings) -> Self {
        Self {
            crossings,
            last: crossings.last_interval(),
            valid: (f64::INFINITY, f64::NEG_INFINITY),
            below: None,
            above: None,
        }
    }

    /// The signed distance at `tau` ≥ 0, see [`Crossings::delay_margin`].
    #[inline]
    pub fn margin_at(&mut self, tau: f64) -> f64 {
        if !(self.valid.0 < tau && tau <= self.valid.1) {
            self.look_around(tau);
        }
        if self.crossings.always_marginal {
            return 0.0;
        }
        signed_distance(tau, self.below, self.above)
    }

    /// Finds the stable intervals that begin below and above `tau`.
    fn look_around(&mut self, tau: f64) {
        let below = self.crossings.interval_below(tau);
        let interval = |i: u64| {
            let exists = self.last.is_some_and(|last| i <= last);
            exists.then(|| self.crossings.stable_interval(i)).flatten()
        };
        let (this, next) = match (below, self.last) {
            (Some(i), Some(last)) => (Some(i.min(last)), i + 1),
            (Some(i), None) => (None, i + 1),
            (None, _) => (None, 0),
        };
        self.below = this.and_then(interval);
        self.above = interval(next);
        let from = self.below.map_or(-1.0, |b| b.from);
        // τ = 0 belongs to the interval that begins there.
        let from = if from == 0.0 { -1.0 } else { from };
        self.valid = (from, self.above.map_or(f64::INFINITY, |a| a.from));
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
            let mut walk = MarginWalk::new(&crossings);
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

    /// ω₋ and ω₊ nearly coincide: the intervals are too many to walk through, and the answers come
    /// at once all the same.
    #[test]
    fn nearly_tangent_lines_are_no_slower() {
        for (b, a_n) in [
            (0.0, 1e-12),
            (0.0, -1e-12),
            (1e-13, 1e-12),
            (-1e-13, -1e-9),
            (-1e-13, 1e-9),
        ] {
            let crossings = Crossings::of(Groups::new(b, 0.0, a_n));
            for tau in [0.5, 7.0, 1e4, 1e9] {
                let margin = crossings.delay_margin(tau);
                assert!(!margin.is_nan());
                let count = crossings.count(tau, MarginalTolerance::default());
                assert!(
                    count.marginal || (margin > 0.0) == (count.n_unstable == 0),
                    "{b} {a_n} {tau}"
                );
            }
            assert!(crossings.stable_delays().take(1000).count() <= 1000);
        }
    }
}
