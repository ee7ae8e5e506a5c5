//! The road of one slip: where the block sticks for longer than a delay under pure load control,
//! all memory is erased. Every slip starts from a = μ_S (1 + α_n v0 τ), which has grown evenly, and
//! one tells.

use super::beyond::{Beyond, PRECISION, beyond};
use super::climb::{Climbed, LARGEST_STEP, Place, Ran, Road, climb_finely};
use super::cycle::{Period, Ride, ride};
use super::ends::{CHANGED, FIRST_STEP, MOST_KINDS, RoadEnd, same_slip};
use super::problem::Problem;
use crate::slip::motion::{Accuracy, Motion};

/// Where v0 of one slip starts, in order, in units of μ_S N0/√(κM): what has no memory ends in the
/// same way from anywhere.
const STARTS: [f64; 4] = [6e-2, 6e-3, 1e-4, 1e-6];
/// Slips that start without memory.
#[derive(Clone)]
struct Slips<'p> {
    problem: &'p Problem,
    motion: Motion,
}

impl Road for Slips<'_> {
    fn place(&mut self, v0: f64) -> &mut Motion {
        let p = self.problem;
        self.motion.set_v0(v0);
        // At the end of a stick that outlasted the delay.
        self.motion
            .release_from(p.law.mu_s() * (1.0 + p.alpha_n * v0 * p.tau));
        &mut self.motion
    }

    fn trial(&mut self, v0: f64, expected: Option<&Period>, _: f64) -> Ran {
        let tau = self.problem.tau;
        match ride(self.place(v0), expected.map(|p| p.stops()[0])) {
            Ride::Cycle(cycle) if cycle.stick < tau => Ran::Over,
            Ride::Cycle(cycle) => {
                let period = Period::of(cycle);
                Ran::Period(period, period.gauges())
            }
            Ride::Pass => Ran::Pass,
            Ride::LiftOff => Ran::LiftOff,
            Ride::Other => Ran::Other,
        }
    }

    fn keep(&mut self) {}

    fn refine(&mut self, accuracy: Accuracy) {
        self.motion.refine(accuracy);
    }
}

impl Slips<'_> {
    fn first_place(&mut self) -> Option<Place> {
        STARTS.iter().find_map(|start| {
            let v0 = start * self.problem.law.mu_s();
            match self.trial(v0, None, f64::INFINITY) {
                Ran::Period(period, gauges) => {
                    Some(Place::first(v0, period, gauges, f64::INFINITY))
                }
                _ => None,
            }
        })
    }
}

/// By one slip, under pure load control; none where that does not lead to the end.
pub(super) fn by_one_slip(problem: &Problem, accuracy: Accuracy) -> Option<RoadEnd> {
    if problem.alpha_v != 0.0 {
        return None;
    }
    let motion = problem.at_rest(1e-3, accuracy);
    let mut road = Slips { problem, motion };
    let mut from = road.first_place()?;
    let mut step = LARGEST_STEP;
    for _ in 0..MOST_KINDS {
        let (climbed, at) = climb_finely(&mut road, from, step);
        match climbed {
            Climbed::Graze { v0, .. } => return slip_grazes(&mut road, v0, &at),
            Climbed::LiftOff(v0) => {
                return outlasts(&mut road, v0).map(|_| RoadEnd::LiftOff(v0));
            }
            Climbed::Changes(v0) => {
                let beyond = v0 * (1.0 + CHANGED);
                let Ran::Period(period, gauges) = road.trial(beyond, None, f64::INFINITY) else {
                    return None;
                };
                from = Place::first(beyond, period, gauges, f64::INFINITY);
                step = FIRST_STEP;
            }
            Climbed::Vanish(_) | Climbed::Unclear => return None,
        }
    }
    None
}

/// The cycle just below `v0`, if its stick, and so the one before it, outlast the delay.
fn outlasts(road: &mut Slips, v0: f64) -> Option<Period> {
    let tau = road.problem.tau;
    match ride(road.place(v0 * (1.0 - PRECISION)), None) {
        Ride::Cycle(cycle) if cycle.stick >= tau => Some(Period::of(cycle)),
        _ => None,
    }
}

/// A graze of one slip.
fn slip_grazes(road: &mut Slips, v0: f64, at: &Place) -> Option<RoadEnd> {
    let period = outlasts(road, v0)?;
    if !same_slip(&period, &at.period, 0) {
        return None;
    }
    let slip = period.cycles()[0].slip;
    match beyond(road.problem, (v0, slip), road) {
        Beyond::Ends(_) => Some(RoadEnd::Graze(v0, period)),
        // From here on the orbit is followed.
        _ => None,
    }
}
