//! The delays at which a general system is stable: the crossings of its line, merged in order.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;
use std::f64::consts::{PI, TAU};

use super::line::{DelayLine, Passage};
use crate::linear::crossing::{Crossing, Direction};
use crate::linear::stable_delays::{StableInterval, signed_distance};

/// A change of the number of unstable roots along the delays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The delay.
    pub tau: f64,
    /// The change of the number of unstable roots: ±2 for a pair, ±1 for a real root.
    pub by: i8,
}

/// All changes of a line by growing delay, without end where there are crossings.
#[derive(Debug, Clone)]
pub struct Changes<'l> {
    /// The next delay of each crossing.
    next: BinaryHeap<Reverse<Next<'l>>>,
    /// The passage of a real root, as long as it lies ahead.
    passage: Option<Passage>,
}

/// The next delay of one of a line's crossings.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Next<'l> {
    tau: f64,
    /// The place of the crossing among those of the line.
    place: usize,
    crossing: &'l Crossing,
    branch: u64,
}

impl Eq for Next<'_> {}

impl Ord for Next<'_> {
    /// By delay. At one delay crossings of higher frequency are first.
    fn cmp(&self, other: &Self) -> Ordering {
        let by_delay = self.tau.total_cmp(&other.tau);
        by_delay.then(self.place.cmp(&other.place))
    }
}

impl PartialOrd for Next<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<'l> Changes<'l> {
    /// The changes at `crossings`, by falling frequency, and at the passage of a real root.
    pub(in crate::linear) fn from(
        crossings: impl Iterator<Item = &'l Crossing>,
        passage: Option<Passage>,
    ) -> Self {
        let moving = crossings
            .enumerate()
            .filter(|(_, c)| c.direction != Direction::Touch);
        let next = moving.map(|(place, crossing)| {
            let branch = crossing.branch_at(0.0);
            Reverse(Next {
                tau: crossing.delay(branch),
                place,
                crossing,
                branch,
            })
        });
        Self {
            next: next.collect(),
            passage: passage.filter(|p| p.tau >= 0.0),
        }
    }
}

impl Iterator for Changes<'_> {
    type Item = Change;

    fn next(&mut self) -> Option<Change> {
        let next = self.next.peek_mut();
        match (next, self.passage) {
            (next, Some(passage)) if next.as_ref().is_none_or(|n| passage.tau <= n.0.tau) => {
                self.passage = None;
                Some(Change {
                    tau: passage.tau,
                    by: passage.change,
                })
            }
            (Some(mut next), _) => {
                let Reverse(Next {
                    tau,
                    crossing,
                    branch,
                    ..
                }) = *next;
                next.0.branch = branch + 1;
                next.0.tau = crossing.delay(branch + 1);
                Some(Change {
                    tau,
                    by: 2 * crossing.direction.sign(),
                })
            }
            (None, _) => None,
        }
    }
}

/// The most changes that are gone through: near a touch there can be any number of them.
const MOST_CHANGES: u64 = 1 << 20;

/// The stable intervals of a line by growing delay.
#[derive(Debug, Clone)]
pub struct StableIntervals<'l> {
    changes: Changes<'l>,
    /// How many changes may still be gone through.
    left: u64,
    n: i64,
    from: f64,
    /// The delay from which on nothing is stable, or wanted.
    last: f64,
}

impl Iterator for StableIntervals<'_> {
    type Item = StableInterval;

    fn next(&mut self) -> Option<StableInterval> {
        while self.from < self.last && self.left > 0 {
            self.left -= 1;
            let change = self.changes.next();
            let (from, stable) = (self.from, self.n == 0);
            let Some(Change { tau, by }) = change else {
                self.from = f64::INFINITY;
                return stable.then_some(StableInterval {
                    from,
                    to: f64::INFINITY,
                });
            };
            self.n += i64::from(by);
            self.from = tau;
            if stable && from < tau {
                return Some(StableInterval { from, to: tau });
            }
        }
        None
    }
}

impl StableIntervals<'_> {
    /// Whether there were too many changes to go through: further intervals may have been left out.
    #[must_use]
    pub fn gave_up(&self) -> bool {
        self.left == 0
    }
}

/// Distances to the nearest change of stability along a line, for delays that grow from call to
/// call.
#[derive(Debug, Clone)]
pub struct MarginWalk<'l> {
    line: &'l DelayLine,
    intervals: StableIntervals<'l>,
    /// The last stable interval that began, and the one after it.
    below: Option<StableInterval>,
    above: Option<StableInterval>,
}

impl MarginWalk<'_> {
    /// The signed distance at `tau` ≥ 0: positive where stable, negative where not, infinite where
    /// that never changes, 0 at every delay where all of them are marginal. NaN where it is not
    /// known.
    pub fn margin_at(&mut self, tau: f64) -> f64 {
        if self.line.uncounted {
            return f64::NAN;
        }
        if self.line.always_marginal {
            return 0.0;
        }
        // τ = 0 belongs to the interval that begins there.
        let begun = |next: &StableInterval| next.from < tau || next.from == 0.0;
        while let Some(next) = self.above.filter(begun) {
            self.below = Some(next);
            self.above = self.intervals.next();
        }
        let inside = self.below.is_some_and(|below| tau <= below.to);
        if self.intervals.gave_up() && self.above.is_none() && !inside {
            return f64::NAN;
        }
        signed_distance(tau, self.below, self.above)
    }
}

impl DelayLine {
    /// The changes of the number of unstable roots with τ > 0, by growing delay.
    #[must_use]
    pub fn changes(&self) -> Changes<'_> {
        Changes::from(self.crossings.iter(), self.passage)
    }

    /// The delays at which no root is unstable, by growing delay; none where a root lies on the
    /// axis at every delay, or where roots accumulate there.
    ///
    /// There are finitely many, but near a touch more than anyone wants: take some.
    #[must_use]
    pub fn stable_intervals(&self) -> StableIntervals<'_> {
        self.stable_intervals_until(f64::INFINITY)
    }

    /// Those of [`DelayLine::stable_intervals`] that begin at the delay `until` or below.
    #[must_use]
    pub fn stable_intervals_until(&self, until: f64) -> StableIntervals<'_> {
        let never = self.always_marginal || self.uncounted;
        let last = if never { 0.0 } else { self.last_stable() };
        StableIntervals {
            changes: self.changes(),
            left: MOST_CHANGES,
            n: self.at_zero_delay as i64,
            from: 0.0,
            last: last.min(until.next_up()),
        }
    }

    /// The interval of delays around `tau` in which no root is unstable; none where one is.
    #[must_use]
    pub fn stable_interval_at(&self, tau: f64) -> Option<StableInterval> {
        let around = self.stable_intervals_until(tau).find(|i| tau < i.to);
        around.filter(|i| i.from <= tau)
    }

    /// Distances to the nearest change of stability along the line.
    #[must_use]
    pub fn margins(&self) -> MarginWalk<'_> {
        let mut intervals = self.stable_intervals();
        MarginWalk {
            line: self,
            below: None,
            above: intervals.next(),
            intervals,
        }
    }

    /// The signed distance in τ to the nearest change of stability, see [`MarginWalk::margin_at`].
    #[must_use]
    pub fn delay_margin(&self, tau: f64) -> f64 {
        self.margins().margin_at(tau)
    }

    /// A delay beyond which something is unstable; ∞ where there is none.
    ///
    /// Up to τ at least (ωτ − θ)/2π pairs crossed to the right at each such ω, and at most one more
    /// than that to the left.
    fn last_stable(&self) -> f64 {
        let (mut rate, mut ahead) = (0.0, -(self.at_zero_delay as f64));
        for crossing in &self.crossings {
            let sign = f64::from(crossing.direction.sign());
            rate += sign * crossing.omega / PI;
            ahead += sign * crossing.theta / PI + if sign < 0.0 { 2.0 } else { 0.0 };
        }
        if let Some(passage) = self.passage {
            ahead += f64::from(u8::from(passage.change < 0));
        }
        if rate > 0.0 {
            ((ahead / rate).max(0.0) + TAU / rate) * (1.0 + 1e-9)
        } else {
            f64::INFINITY
        }
    }
}
