//! The critical velocity by simulation: stick-slip is followed while v0 is raised, carrying the
//! state.

use super::hold::{Holding, hold};
pub use super::pace::{Fate, Followed, Pace, Sustained};
use super::problem::Problem;
use super::raise::raise;
use crate::slip::motion::{Accuracy, Motion};

/// Where v0 starts, in order, until stick-slip is sustained there; in units of μ_S N0/√(κM).
pub const STARTS: [f64; 6] = [1e-2, 1e-1, 1e-3, 1e-4, 1e-5, 1e-6];

/// Follows stick-slip of `problem` from low v0 on.
#[must_use]
pub fn critical_velocity(problem: &Problem, pace: &Pace, accuracy: Accuracy) -> Followed {
    let scale = problem.law.mu_s();
    let mut lost: Option<Sustained> = None;
    for start in STARTS {
        let v0 = start * scale;
        let lifted = |lost: &Sustained| lost.fate == Fate::LiftOff && lost.v0 < v0;
        if lost.as_ref().is_some_and(lifted) {
            // What is asked for is the smallest v0 of lift-off.
            continue;
        }
        let motion = start_sticking(problem, v0, accuracy);
        let followed = from(problem, motion, pace);
        if followed.last.is_some() {
            return followed;
        }
        // Where stick-slip was lost otherwise before, a lift-off at a larger start is that of the
        // start alone.
        let lower = followed.lost.as_ref().is_some_and(|now| {
            let lowest = lost.as_ref().map_or(f64::INFINITY, |lost| lost.v0);
            now.fate == Fate::LiftOff && now.v0 < lowest
        });
        if lost.is_none() || lower {
            lost = followed.lost;
        }
    }
    Followed {
        last: None,
        lost,
        complete: true,
        creeps: false,
        vanish: false,
        graze_way: f64::INFINITY,
    }
}

/// Follows a motion in stick-slip of `problem` from the v0 it has, while v0 is raised.
#[must_use]
pub fn from(problem: &Problem, mut motion: Motion, pace: &Pace) -> Followed {
    carry(problem, &mut motion, pace)
}

/// Follows a motion in stick-slip from the v0 it has, as [`from`] does, and leaves it where it
/// comes to.
pub fn carry(problem: &Problem, motion: &mut Motion, pace: &Pace) -> Followed {
    let v0 = motion.parameters().v0;
    let how = Holding::new(pace, f64::INFINITY);
    let first = hold(problem, motion, v0, &how);
    if first.persists() {
        return raise(problem, motion, first, pace);
    }
    Followed {
        last: None,
        lost: Some(first),
        complete: true,
        creeps: false,
        vanish: false,
        graze_way: f64::INFINITY,
    }
}

/// At the end of a stick without memory, with control.
pub(super) fn start_sticking(problem: &Problem, v0: f64, accuracy: Accuracy) -> Motion {
    let mut motion = problem.at_rest(v0, accuracy);
    motion.release_from(problem.law.mu_s());
    motion
}
