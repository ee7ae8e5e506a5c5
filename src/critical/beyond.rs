//! What becomes of a block just beyond the velocity at which its stick-slip ends.

use super::climb::Road;
use super::follow::Fate;
use super::hold;
use super::problem::Problem;
use super::stops::{Stops, Waiting};
use crate::slip::motion::{Event, Mode, Motion};
use crate::slip::outcome::{Observer, Outcome};

/// What becomes of stick-slip beyond a graze.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Beyond {
    /// It ends; the minima of ẋ after that, over v0, are not below this, where that is known, else
    /// 0; 1 where the block slides and turns back at once.
    Ends(f64),
    /// It is stick-slip of another kind, with so many slips in a period.
    Persists(usize),
    /// It is stick-slip that does not repeat.
    Irregular,
    /// Not known.
    Unknown,
}

/// The last trials are this far below and above a graze, relative: v_c is known to it.
pub(super) const PRECISION: f64 = 1e-5;
/// The block is released so far past the graze, relative; the first one at which it does not stop
/// counts.
const STEPS: [f64; 2] = [PRECISION, 1e-4];
/// How far past an end the block is released, where that decides on the end; relative.
const OTHER_STEPS: [f64; 2] = [1e-4, 2e-6];
/// The lowest minimum of ẋ after a graze, and how long after it.
#[derive(Debug, Clone, Copy)]
struct Lowest {
    u: f64,
    since: f64,
}

/// For so long after its lowest minimum the block is followed that was released otherwise.
const AFTER: f64 = std::f64::consts::TAU;
/// Minima of ẋ, over v0, that leave no doubt on which side of zero they are after other steps of
/// v0.
const CLEAR: f64 = 0.05;

/// What becomes, just beyond the graze at `v0` of a slip that took `slip`, of the block that `road`
/// releases for that slip. Where the block comes near another stop and steps of different sizes
/// lead to different ends, that is not known.
pub(super) fn beyond(problem: &Problem, (v0, slip): (f64, f64), road: &mut impl Road) -> Beyond {
    let least = slip + problem.tau;
    let mut passed = STEPS.iter().filter_map(|above| {
        let motion = road.place(v0 * (1.0 + above));
        passes(motion, slip)
            .then(|| slips_on(problem, motion, least).ok_or_else(|| kind(problem, motion)))
    });
    let lowest = match passed.next() {
        None => return kind(problem, road.place(v0 * (1.0 + STEPS[0]))),
        Some(Err(other)) => return other,
        Some(Ok(lowest)) => lowest,
    };
    if lowest.u > CLEAR * v0 {
        return Beyond::Ends(lowest.u / v0);
    }
    let ends = |above: &f64| {
        let motion = road.place(v0 * (1.0 + above));
        // Else the graze is not known to that.
        !passes(motion, slip)
            || !stops_within(motion, lowest.since + AFTER)
            || matches!(kind(problem, motion), Beyond::Ends(_))
    };
    match OTHER_STEPS.iter().all(ends) {
        true => Beyond::Ends(lowest.u / v0),
        false => Beyond::Unknown,
    }
}

/// What becomes of a motion in the end.
pub(super) fn kind(problem: &Problem, motion: &mut Motion) -> Beyond {
    let v0 = motion.parameters().v0;
    let sustained = hold::fate(problem, motion, v0);
    match sustained.fate {
        Fate::Slips => Beyond::Ends(0.0),
        Fate::Lost(Outcome::Undecided) | Fate::LiftOff => Beyond::Unknown,
        Fate::Lost(_) => Beyond::Ends(0.0),
        Fate::Periodic => Beyond::Persists(sustained.summary.slips as usize),
        Fate::Irregular => Beyond::Irregular,
    }
}

/// What becomes of stick-slip where its stick has just vanished at `v0`.
pub(super) fn without_stick(problem: &Problem, v0: f64, road: &mut impl Road) -> Beyond {
    let motion = road.place(v0 * (1.0 + VANISHED));
    let until = motion.t + f64::from(PERIODS_WITHOUT) * (problem.tau + 2.0 * std::f64::consts::TAU);
    while motion.t < until {
        let event = motion.advance(f64::INFINITY);
        let sticks = event == Some(Event::Stick) && motion.mode() == Mode::Stick;
        if sticks || event == Some(Event::LiftOff) || !motion.u.is_finite() {
            return kind(problem, motion);
        }
    }
    Beyond::Ends(1.0)
}

/// How far beyond a vanished stick is looked, relative, and for how long, in delays and two periods
/// of free oscillation.
const VANISHED: f64 = 1e-4;
const PERIODS_WITHOUT: u32 = 10;

/// The share of v0 above which ẋ stays once the block slides. Minima that only rise to half of v0
/// may fall again: an unstable oscillation about stable sliding can be on either side.
const SLIDING: f64 = 0.8;

/// The most steps of a slip.
const STEPS_OF_SLIP: u32 = 5_000;

/// Follows a block that was just released past the minimum of ẋ that ended its `slip` before; false
/// where it stops there.
fn passes(motion: &mut Motion, slip: f64) -> bool {
    let start = motion.t;
    for _ in 0..STEPS_OF_SLIP {
        if motion.advance(f64::INFINITY).is_some() || !motion.u.is_finite() {
            return false;
        }
        let passed = motion.t - start > 0.75 * slip;
        if passed && motion.last_step().speed_minimum().is_some() {
            return true;
        }
    }
    false
}

/// The lowest minimum of ẋ beyond a graze, of a block that slips on: its velocity's minima do not
/// fall for long; or, where sliding is stable, rise nearly to v0, for at least the time `least`.
/// None where it stops again.
fn slips_on(problem: &Problem, motion: &mut Motion, least: f64) -> Option<Lowest> {
    let v0 = motion.parameters().v0;
    let stable = problem.count(v0).stable();
    let mut stops = Stops::new(motion, stable, Waiting::Long);
    let start = motion.t;
    let mut lowest = Lowest {
        u: f64::INFINITY,
        since: 0.0,
    };
    let mut last = f64::NEG_INFINITY;
    let mut risen = 0;
    while !stops.enough() {
        let event = motion.advance(f64::INFINITY);
        stops.step(motion, event);
        if event.is_some() || !motion.u.is_finite() || motion.t - start > LONGEST {
            return None;
        }
        if let Some((_, u)) = motion.last_step().speed_minimum() {
            if u < lowest.u {
                let since = motion.t - start;
                lowest = Lowest { u, since };
            }
            // Beats: what comes after the lowest one counts.
            risen = if u < last { 0 } else { risen + 1 };
            last = u;
            if stable && risen >= 2 && u > SLIDING * v0 && motion.t - start > least {
                break;
            }
        }
    }
    Some(lowest)
}

/// Whether a block that slips stops within this time.
fn stops_within(motion: &mut Motion, time: f64) -> bool {
    let until = motion.t + time;
    while motion.t < until {
        if motion.advance(until).is_some() || !motion.u.is_finite() {
            return true;
        }
    }
    false
}

/// The longest time that is waited for, in units of √(M/κ).
const LONGEST: f64 = 5_000.0;
