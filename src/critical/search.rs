//! The end of stick-slip of one problem, by the first of the roads that leads to it.

use super::beyond::{Beyond, PRECISION, kind};
use super::climb::{LARGEST_STEP, Road, climb, jumps};
use super::follow::{self, Fate, Pace};
use super::graze::{FIRST_STEP, Found, MOST_KINDS, STARTS, by_one_slip, finish};
use super::orbit::Orbit;
use super::track::Track;
use super::{
    Critical, End, FOLLOW_TOLERANCE, GRAZE_TOLERANCE, Method, Problem, confirmed, nothing,
    of_found, persists_without_control,
};
use crate::slip::motion::{Accuracy, Motion};

/// The first one where stick-slip goes on past the graze that was expected.
const LAST_STEP: f64 = 2.0 * PRECISION;

/// The critical velocity, and what a neighbour may start from.
pub(super) fn from_scratch(problem: &Problem) -> (Critical, Option<Track>) {
    if persists_without_control(problem) {
        let critical = nothing(f64::NAN, End::Persists, Method::Simulation);
        return (critical, None);
    }
    let accuracy = Accuracy::of(GRAZE_TOLERANCE);
    let one_slip = by_one_slip(problem, accuracy);
    if let Some(critical) = one_slip.and_then(|found| of_found(&found, Method::GrazeSlip)) {
        return (critical, None);
    }
    match by_orbit(problem, accuracy) {
        Reached::End(found, track) => {
            let critical = of_found(&found, Method::GrazeOrbit);
            (critical.unwrap_or_else(|| simulated(problem)), Some(*track))
        }
        Reached::Motion(motion) => (simulated_from(problem, *motion), None),
        Reached::Nothing => (simulated(problem), None),
    }
}

/// Where the road of the orbit leads.
enum Reached {
    End(Found, Box<Track>),
    /// Stick-slip, from which simulation has to go on.
    Motion(Box<Motion>),
    Nothing,
}

/// By the orbit, of one kind of stick-slip after the other.
fn by_orbit(problem: &Problem, accuracy: Accuracy) -> Reached {
    let start = STARTS.iter().find_map(|start| {
        let mut road = Orbit::released(problem, start * problem.law.mu_s(), accuracy);
        let place = road.first_place()?;
        Some((road, place))
    });
    let Some((mut road, mut place)) = start else {
        return Reached::Nothing;
    };
    let mut step = LARGEST_STEP;
    for _ in 0..MOST_KINDS {
        let (climbed, at) = climb(&mut road, place, step);
        let found = finish(problem, &mut road, climbed, &at);
        let next = match found {
            Found::Persists(slips) => Some((road.tried().clone(), slips)),
            Found::Changes(v0) => match changed(problem, &mut road, v0) {
                (motion, Beyond::Persists(slips)) => Some((motion, slips)),
                // Nothing is left of it.
                (_, Beyond::Ends) => {
                    let found = Found::Vanish(v0, at.period);
                    let track = Track::new(problem, road, at, &found);
                    return Reached::End(found, Box::new(track));
                }
                (motion, Beyond::Irregular) => return Reached::Motion(Box::new(motion)),
                _ => None,
            },
            Found::Irregular => return Reached::Motion(Box::new(road.tried().clone())),
            Found::Unclear => recognised(problem, &road),
            Found::Graze(..) | Found::Vanish(..) | Found::LiftOff(..) => {
                let track = Track::new(problem, road, at, &found);
                return Reached::End(found, Box::new(track));
            }
        };
        let from = road.motion().clone();
        let Some((motion, slips)) = next else {
            return Reached::Motion(Box::new(from));
        };
        road = Orbit::of(motion, slips);
        match road.first_place() {
            Some(first) => {
                step = match jumps(&at.period, &first.period, 0.0) {
                    true => FIRST_STEP,
                    false => LAST_STEP,
                };
                place = first;
            }
            None => return Reached::Motion(Box::new(from)),
        }
    }
    Reached::Motion(Box::new(road.motion().clone()))
}

/// How far beyond its last place a kind of stick-slip that was lost from sight is looked for, relative.
const NEXT: f64 = 1e-4;

/// What became of stick-slip just beyond where it was last: a motion, and how many slips its period has.
fn recognised(problem: &Problem, road: &Orbit) -> Option<(Motion, usize)> {
    let mut motion = road.motion().clone();
    let v0 = motion.parameters().v0 * (1.0 + NEXT);
    let sustained = follow::fate(problem, &mut motion, v0);
    (sustained.fate == Fate::Periodic).then(|| (motion, sustained.summary.slips as usize))
}

/// How far beyond a change of kind the next one is looked for, relative: forces have to differ by more than their noise.
pub(super) const CHANGED: f64 = 1e-4;

/// What becomes of stick-slip beyond `v0`, where it is known to become of another kind, and a motion there.
fn changed(problem: &Problem, road: &mut Orbit, v0: f64) -> (Motion, Beyond) {
    let mut motion = road.place(v0 * (1.0 + CHANGED)).clone();
    let beyond = kind(problem, &mut motion);
    (motion, beyond)
}

/// By simulation from a motion in stick-slip on; from low velocities where it is not sustained.
fn simulated_from(problem: &Problem, mut motion: Motion) -> Critical {
    motion.refine(Accuracy::of(FOLLOW_TOLERANCE));
    let search = |pace: &Pace| follow::from(problem, motion.clone(), pace);
    let followed = search(&Pace::default());
    match followed.last {
        Some(_) => confirmed(&followed, search),
        None => simulated(problem),
    }
}

/// By simulation from low velocities on.
fn simulated(problem: &Problem) -> Critical {
    let accuracy = Accuracy::of(FOLLOW_TOLERANCE);
    let search = |pace: &Pace| follow::critical_velocity(problem, pace, accuracy);
    confirmed(&search(&Pace::default()), search)
}
