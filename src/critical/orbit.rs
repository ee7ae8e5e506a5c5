//! The road of the orbit: period after period of stick-slip, with all its memory, from one v0 to
//! the next.
//!
//! The past of a block that is released is a function of the time since then, smooth in v0 as long
//! as stick-slip stays of one kind. So a new v0 starts from the pasts at the last two,
//! extrapolated: what is left of a transient is of the second order in the step of v0, where simply
//! going on would leave one of the first order.

use super::climb::{Place, Ran, Road, SETTLED, Seen};
use super::cycle::{Cycle, GAUGES, MOST_SLIPS, Period, Ride, Stop, ride};
use super::pace::Pace;
use super::problem::Problem;
use crate::slip::motion::{Accuracy, Motion, Stretch};

/// The most periods at one v0; of many slips, the most slips.
const MOST_PERIODS: usize = 12;
const MOST_CYCLES: usize = 24;
/// The farthest that two pasts are extrapolated, in units of what lies between them.
const FARTHEST: f64 = 3.0;

/// A motion at the end of a period, and the v0 it belongs to; NaN where it means nothing.
#[derive(Debug, Clone)]
pub(super) struct At {
    motion: Motion,
    period: Period,
    v0: f64,
}

impl At {
    /// Becomes what is expected at another v0 and delay from the `last` and the one `before`, and
    /// `share` of what lies between them; false where that cannot be told.
    fn extrapolate(
        &mut self,
        (last, before): (&mut Self, &mut Self),
        share: f64,
        (v0, tau): (f64, f64),
    ) -> bool {
        let (one, other) = (last.period.cycles(), before.period.cycles());
        if !(share.abs() <= FARTHEST && one.len() == other.len() && tau > 0.0) {
            return false;
        }
        let mut stretches = [Stretch {
            lengths: [f64::NAN; 3],
        }; 2 * MOST_SLIPS];
        let pairs = one.iter().zip(other).rev();
        let times = pairs.flat_map(|(p, q)| [(p.stick, q.stick), (p.slip, q.slip)]);
        for (stretch, (last, before)) in stretches.iter_mut().zip(times) {
            stretch.lengths = [last + share * (last - before), last, before];
        }
        let stretches = &stretches[..2 * one.len()];
        let alike = |s: &Stretch| {
            s.lengths[0] > LEAST * s.lengths[1] && s.lengths[1].min(s.lengths[2]) > 0.0
        };
        if !stretches.iter().all(alike) {
            return false;
        }
        let motions = (&mut last.motion, &mut before.motion);
        self.v0 = v0;
        self.motion
            .extrapolate(motions, share, (v0, tau), stretches)
    }
}

/// Sticks and slips do not become shorter than this at once, relative.
const LEAST: f64 = 5e-3;

/// Stick-slip of one number of slips in a period.
#[derive(Debug, Clone)]
pub(super) struct Orbit {
    slips: usize,
    tried: At,
    kept: At,
    before: At,
    /// The gauges of the first period of the last trial.
    first: [f64; GAUGES],
}

impl Road for Orbit {
    fn place(&mut self, v0: f64) -> &mut Motion {
        let share = (v0 - self.kept.v0) / (self.kept.v0 - self.before.v0);
        let tau = self.kept.motion.parameters().tau;
        let tried = &mut self.tried;
        let pasts = (&mut self.kept, &mut self.before);
        if v0 == pasts.0.v0 || !tried.extrapolate(pasts, share, (v0, tau)) {
            tried.motion.copy_from(&self.kept.motion);
            tried.motion.set_v0(v0);
            tried.v0 = v0;
        }
        &mut tried.motion
    }

    fn trial(&mut self, v0: f64, expected: Option<&Period>, settled: f64) -> Ran {
        if v0 > Pace::default().v_max * self.kept.motion.parameters().law.mu_s() {
            // Where simulation does not look either.
            return Ran::Over;
        }
        self.place(v0);
        self.run(expected, settled)
    }

    fn keep(&mut self) {
        if self.kept.v0 != self.tried.v0 {
            std::mem::swap(&mut self.kept, &mut self.before);
        }
        std::mem::swap(&mut self.kept, &mut self.tried);
    }

    fn refine(&mut self, accuracy: Accuracy) {
        for at in [&mut self.kept, &mut self.before, &mut self.tried] {
            at.motion.refine(accuracy);
        }
    }
}

/// Where v0 starts, in order, in units of μ_S N0/√(κM): as [`super::follow`] does after lift-off,
/// whose smallest v0 is asked for.
const STARTS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-6];

impl Orbit {
    /// Of a block that is released from a memoryless stick at `v0`, which has one slip in a period.
    fn released(problem: &Problem, v0: f64, accuracy: Accuracy) -> Self {
        let mut motion = problem.at_rest(v0, accuracy);
        motion.release_from(problem.law.mu_s());
        Self::of(motion, 1)
    }

    /// The orbit from the first start at which the block does not lift off, with its first place;
    /// none where it does not stick again there, or lifts off at all of them.
    pub(super) fn sustained(problem: &Problem, accuracy: Accuracy) -> Option<(Self, Place)> {
        for start in STARTS {
            let v0 = start * problem.law.mu_s();
            let mut road = Self::released(problem, v0, accuracy);
            match road.trial(v0, None, f64::INFINITY) {
                Ran::Period(period, gauges) => {
                    road.keep();
                    let place = Place::first(v0, period, gauges, f64::INFINITY);
                    return Some((road, place));
                }
                Ran::LiftOff => {}
                // A larger start comes next, which may be another stick-slip: simulation tells.
                Ran::Pass | Ran::Other | Ran::Over => return None,
            }
        }
        None
    }

    /// Of a `motion` that is released in stick-slip of so many `slips`, at most [`MOST_SLIPS`], in
    /// a period.
    pub(super) fn of(motion: Motion, slips: usize) -> Self {
        let v0 = motion.parameters().v0;
        let at = At {
            motion,
            period: Period::of(Cycle::NONE),
            v0,
        };
        Self {
            slips: slips.clamp(1, MOST_SLIPS),
            tried: at.clone(),
            before: At {
                v0: f64::NAN,
                ..at.clone()
            },
            kept: at,
            first: [f64::NAN; GAUGES],
        }
    }

    /// The motion that was kept last.
    pub(super) fn motion(&self) -> &Motion {
        &self.kept.motion
    }

    /// The gauges of the first period of the last trial, before it came to rest.
    pub(super) fn first_gauges(&self) -> &[f64; GAUGES] {
        &self.first
    }

    /// Where it was kept last.
    pub(super) fn place_kept(&self) -> &At {
        &self.kept
    }

    /// The motion that was tried last.
    pub(super) fn tried(&self) -> &Motion {
        &self.tried.motion
    }

    /// Begins its period so many slips later; false where it does not come to that.
    pub(super) fn rotate(&mut self, by: usize, period: &Period) -> bool {
        let stops = period.stops();
        let rides = |motion: &mut Motion| {
            let mut stops = stops.iter().take(by);
            stops.all(|stop| matches!(ride(motion, Some(*stop)), Ride::Cycle(_)))
        };
        if !rides(&mut self.before.motion) {
            self.before.v0 = f64::NAN;
        }
        (self.kept.period, self.before.period) =
            (self.kept.period.rotated(by), self.before.period.rotated(by));
        rides(&mut self.kept.motion)
    }

    /// The place to begin with; none where there is no stick-slip.
    pub(super) fn first_place(&mut self) -> Option<Place> {
        let v0 = self.kept.v0;
        let Ran::Period(period, gauges) = self.trial(v0, None, f64::INFINITY) else {
            return None;
        };
        self.keep();
        Some(Place::first(v0, period, gauges, f64::INFINITY))
    }

    /// Starts with another delay and `v0` from where it ended; with a motion that ended likewise at
    /// another delay, from both pasts, extrapolated by `share` of what lies between them. Slopes
    /// are taken to be those of a place `like` it.
    pub(super) fn restart(
        &mut self,
        before: Option<(&mut At, f64)>,
        (v0, tau): (f64, f64),
        like: &Place,
    ) -> Option<Place> {
        let (tried, kept) = (&mut self.tried, &mut self.kept);
        let told = before
            .is_some_and(|(before, share)| tried.extrapolate((kept, before), share, (v0, tau)));
        if !told {
            tried.motion.copy_from(&self.kept.motion);
            tried.motion.set_delay(tau);
            tried.motion.set_v0(v0);
            tried.v0 = v0;
        }
        let Ran::Period(period, gauges) = self.run(Some(&like.period), SETTLED) else {
            return None;
        };
        std::mem::swap(&mut self.kept, &mut self.tried);
        // What was kept before belongs to another delay.
        self.before.v0 = f64::NAN;
        Some(Place {
            slopes: like.slopes,
            own: false,
            ..Place::first(v0, period, gauges, SETTLED)
        })
    }

    /// Follows the tried motion, period after period.
    fn run(&mut self, expected: Option<&Period>, settled: f64) -> Ran {
        let n = self.slips;
        let mut stops: Option<[Stop; MOST_SLIPS]> = expected.map(Period::stops);
        let mut seen = Seen::none();
        for _ in 0..MOST_PERIODS.min(MOST_CYCLES / n) {
            let mut cycles = [Cycle::NONE; MOST_SLIPS];
            for (i, cycle) in cycles.iter_mut().enumerate().take(n) {
                *cycle = match ride(&mut self.tried.motion, stops.map(|stops| stops[i])) {
                    Ride::Cycle(cycle) => cycle,
                    Ride::Pass => return Ran::Pass,
                    Ride::LiftOff => return Ran::LiftOff,
                    Ride::Other => return Ran::Other,
                };
            }
            let period = Period::new(n, cycles);
            stops = stops.map(|_| period.stops());
            self.tried.period = period;
            if seen.none_yet() {
                self.first = period.gauges();
            }
            seen.push(&period);
            if settled == f64::INFINITY {
                return Ran::Period(period, period.gauges());
            }
            if seen.settled(settled, self.tried.v0) {
                return Ran::Period(period, seen.limits());
            }
        }
        Ran::Other
    }
}
