//! What a block does just beyond an event, by simulation.

use super::continuation::Releases;
use super::observers::{Stops, Waiting};
use super::problem::Problem;
use super::regime::{Regime, response_at_length};
use super::transition::{Sequel, Undetermined};
use crate::slip::motion::{Event, Mode, Motion};
use crate::slip::outcome::Observer;

/// The lowest minimum of ẋ after a graze, and how long after it.
#[derive(Debug, Clone, Copy)]
struct Lowest {
    u: f64,
    since: f64,
}

/// What a motion does in the end, followed for as long as at the end of a search.
pub(super) fn sequel(problem: &Problem, motion: &mut Motion) -> Sequel {
    let response = response_at_length(problem, motion);
    match response.regime {
        Regime::Slips | Regime::Ended | Regime::NoStickSlip => Sequel::Ends(0.0),
        Regime::Undecided | Regime::LiftOff => Sequel::Undetermined(Undetermined::TooClose),
        Regime::Periodic => Sequel::Periodic(response.summary.slips as usize),
        Regime::Irregular => Sequel::Irregular,
    }
}

/// What follows just beyond the graze at `v0` of a slip that took `slip`: `branch` releases a block
/// for that slip, and the block is followed. Where it comes near another stop, it is released again
/// farther and nearer beyond the graze; if the ends then differ, the answer is undetermined.
pub(super) fn after_graze(
    problem: &Problem,
    (v0, slip): (f64, f64),
    branch: &mut impl Releases<Map = Motion>,
) -> Sequel {
    let options = &problem.options.transition;
    let least = slip + problem.feedback.remembered();
    let releases = [options.precision, options.past_graze];
    let mut passed = releases.iter().filter_map(|beyond| {
        let motion = branch.release_at(v0 * (1.0 + beyond));
        passes(problem, motion, slip)
            .then(|| slips_on(problem, motion, least).ok_or_else(|| sequel(problem, motion)))
    });
    let lowest = match passed.next() {
        None => return sequel(problem, branch.release_at(v0 * (1.0 + releases[0]))),
        Some(Err(other)) => return other,
        Some(Ok(lowest)) => lowest,
    };
    if lowest.u > options.clear * v0 {
        return Sequel::Ends(lowest.u / v0);
    }
    let ends = |beyond: &f64| {
        let motion = branch.release_at(v0 * (1.0 + beyond));
        // A block that still stops before the graze does not count.
        !passes(problem, motion, slip)
            || !stops_within(motion, lowest.since + options.after_minimum)
            || matches!(sequel(problem, motion), Sequel::Ends(_))
    };
    match options.past_again.iter().all(ends) {
        true => Sequel::Ends(lowest.u / v0),
        false => Sequel::Undetermined(Undetermined::TooClose),
    }
}

/// What follows stick-slip whose stick has just vanished at `v0`.
pub(super) fn after_stick(
    problem: &Problem,
    v0: f64,
    branch: &mut impl Releases<Map = Motion>,
) -> Sequel {
    let options = &problem.options.transition;
    let motion = branch.release_at(v0 * (1.0 + options.past_vanished_stick));
    let windows = f64::from(options.windows_without_stick);
    let until = motion.t + windows * (problem.feedback.remembered() + 2.0 * std::f64::consts::TAU);
    while motion.t < until {
        let event = motion.advance(f64::INFINITY);
        let sticks = event == Some(Event::Stick) && motion.mode() == Mode::Stick;
        if sticks || event == Some(Event::LiftOff) || !motion.u.is_finite() {
            return sequel(problem, motion);
        }
    }
    Sequel::Ends(1.0)
}

/// Follows a block that was just released past the minimum of ẋ that its stop after `slip` cut off
/// before. False where it still stops there.
fn passes(problem: &Problem, motion: &mut Motion, slip: f64) -> bool {
    let options = &problem.options.transition;
    let start = motion.t;
    for _ in 0..options.steps_of_slip {
        if motion.advance(f64::INFINITY).is_some() || !motion.u.is_finite() {
            return false;
        }
        let passed = motion.t - start > options.earliest_minimum * slip;
        if passed && motion.last_step().speed_minimum().is_some() {
            return true;
        }
    }
    false
}

/// The lowest minimum of ẋ beyond a graze, of a block that slips on: its minima do not fall for
/// long. Where sliding is stable it is enough that they rise nearly to v0, after at least the time
/// `least`. None where the block stops again.
fn slips_on(problem: &Problem, motion: &mut Motion, least: f64) -> Option<Lowest> {
    let options = &problem.options.transition;
    let v0 = motion.parameters().v0;
    let stable = problem.count(v0).stable();
    let mut stops = Stops::new(motion, stable, Waiting::Long, &problem.options.ramp);
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
        let too_long = motion.t - start > options.longest_wait;
        if event.is_some() || !motion.u.is_finite() || too_long {
            return None;
        }
        if let Some((_, u)) = motion.last_step().speed_minimum() {
            if u < lowest.u {
                let since = motion.t - start;
                lowest = Lowest { u, since };
            }
            // Minima beat: only rises after the last fall count.
            risen = if u < last { 0 } else { risen + 1 };
            last = u;
            let slides = u > options.sliding * v0 && motion.t - start > least;
            if stable && risen >= options.rises && slides {
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

#[cfg(test)]
mod tests {
    use super::super::continuation::{Branch, Point};
    use super::super::synthetic::letters;
    use super::super::with_history::WithHistory;
    use super::*;
    use crate::slip::motion::Accuracy;

    /// The letter's Fig. 3(a), whose stick-slip ends at 0.344467.
    #[test]
    fn what_a_block_comes_to_below_and_above_v_c() {
        let problem = letters(-0.33, 0.0, 4.15);
        let at = |v0: f64| sequel(&problem, &mut problem.released(v0, Accuracy::of(1e-8)));
        assert_eq!(at(0.1), Sequel::Periodic(1));
        assert_eq!(at(0.5), Sequel::Ends(0.0));
    }

    /// Released below the graze the block stops as before; released above it, it slips on for good.
    #[test]
    fn a_block_slips_on_beyond_its_graze() {
        let problem = letters(-0.33, 0.0, 4.15);
        let accuracy = Accuracy::of(1e-8);
        let (mut branch, first) = WithHistory::released(&problem, 0.01, accuracy).unwrap();
        let mut period = first.orbit.period;
        for v0 in [0.02, 0.05, 0.1, 0.2, 0.3, 0.34, 0.344] {
            let orbit = branch.orbit_at(v0, Some(&period), 1e-3).unwrap();
            branch.accept();
            period = orbit.period;
        }
        let slip = Point::first(0.344, branch.orbit_at(0.34446, None, 1e-2).unwrap(), 1e-2);
        branch.accept();
        let slip = slip.orbit.period.cycles()[0].slip;
        let Sequel::Ends(clear) = after_graze(&problem, (0.344467, slip), &mut branch) else {
            panic!("stick-slip ends");
        };
        assert!(clear > 0.0 && clear < 1.0, "{clear}");
        let below = after_graze(&problem, (0.3440, slip), &mut branch);
        assert_eq!(below, Sequel::Periodic(1));
    }

    #[test]
    fn a_slip_stops_within_its_time_or_not() {
        let problem = letters(0.0, 0.0, 1.0);
        let released = || problem.released(0.35, Accuracy::of(1e-8));
        // The uncontrolled slip takes 3.975.
        assert!(stops_within(&mut released(), 4.0));
        assert!(!stops_within(&mut released(), 3.9));
        assert!(!passes(&problem, &mut released(), 3.975));
    }
}
