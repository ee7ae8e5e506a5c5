//! The critical velocity as the velocity at which the orbit of stick-slip ends: where a slip grazes ẋ = ẍ = 0, where the load
//! or a stick vanishes. How such an end is told and checked, and the road of one slip:
//!
//! where the block sticks for longer than a delay under pure load control, all memory is erased and one slip tells. It starts
//! from a = μ_S (1 + α_n v0 τ), which has grown evenly.

use super::beyond::{Beyond, PRECISION, beyond, without_stick};
use super::climb::{Climbed, LARGEST_STEP, Place, Ran, Road, climb_finely};
use super::cycle::{Period, Ride, ride};
use super::orbit::Orbit;
use super::search::CHANGED;
use super::Problem;
use crate::slip::motion::{Accuracy, Motion};

/// The end of an orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Found {
    /// The first slip of the period grazes.
    Graze(f64, Period),
    /// The stick of the period vanishes.
    Vanish(f64, Period),
    /// N ≤ 0.
    LiftOff(f64),
    /// Another kind of stick-slip goes on beyond it, with so many slips in a period; from the motion that was tried last.
    Persists(usize),
    /// It becomes of another kind at this v0.
    Changes(f64),
    /// Stick-slip goes on, but does not repeat.
    Irregular,
    /// Not known.
    Unclear,
}

impl Found {
    /// The v0 at which stick-slip ends, where that is known.
    pub fn end(&self) -> Option<f64> {
        match self {
            Self::Graze(v0, _) | Self::Vanish(v0, _) | Self::LiftOff(v0) => Some(*v0),
            Self::Changes(_) | Self::Persists(_) | Self::Irregular | Self::Unclear => None,
        }
    }
}

/// Where v0 of one slip starts, in order, in units of μ_S N0/√(κM): what has no memory ends in the same way from anywhere.
const STARTS: [f64; 4] = [6e-2, 6e-3, 1e-4, 1e-6];
/// How much the slip may lengthen on the last bit of the way, where it grows as a square root.
const SAME_SLIP: f64 = 0.1;

/// Slips that start without memory.
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
        match ride(self.place(v0), expected.map(|p| p.stops()[0]), false) {
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
pub(super) fn by_one_slip(problem: &Problem, accuracy: Accuracy) -> Option<Found> {
    if problem.alpha_v != 0.0 {
        return None;
    }
    let motion = Motion::new(problem.at(1e-3, 0.0), accuracy, 0.0, 0.0);
    let mut road = Slips { problem, motion };
    let mut from = road.first_place()?;
    let mut step = LARGEST_STEP;
    for _ in 0..MOST_KINDS {
        let (climbed, at) = climb_finely(&mut road, from, step);
        match climbed {
            Climbed::Graze { v0, .. } => return slip_grazes(&mut road, v0, &at),
            Climbed::LiftOff(v0) => {
                return outlasts(&mut road, v0).map(|_| Found::LiftOff(v0));
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

/// The most kinds of stick-slip that are followed one after the other.
pub(super) const MOST_KINDS: usize = 24;
/// The first relative step of v0 with another kind of stick-slip than the first.
pub(super) const FIRST_STEP: f64 = 0.02;

/// The cycle just below `v0`, if its stick, and so the one before it, outlast the delay.
fn outlasts(road: &mut Slips, v0: f64) -> Option<Period> {
    let tau = road.problem.tau;
    match ride(road.place(v0 * (1.0 - PRECISION)), None, false) {
        Ride::Cycle(cycle) if cycle.stick >= tau => Some(Period::of(cycle)),
        _ => None,
    }
}

/// A graze of one slip.
fn slip_grazes(road: &mut Slips, v0: f64, at: &Place) -> Option<Found> {
    let period = outlasts(road, v0)?;
    if !same_slip(&period, &at.period, 0) {
        return None;
    }
    let slip = period.cycles()[0].slip;
    match beyond(road.problem, (v0, slip), road) {
        Beyond::Ends => Some(Found::Graze(v0, period)),
        // From here on the orbit is followed.
        _ => None,
    }
}

/// Whether the slip `i` of two periods is one.
fn same_slip(one: &Period, other: &Period, i: usize) -> bool {
    (one.cycles()[i].slip / other.cycles()[i].slip - 1.0).abs() <= SAME_SLIP
}

/// What the end of a climb comes to. The road's kept motion is just below it.
pub(super) fn finish(problem: &Problem, road: &mut Orbit, climbed: Climbed, at: &Place) -> Found {
    match climbed {
        Climbed::Graze { v0, slip } => grazes(problem, road, v0, slip, at),
        Climbed::Vanish(v0) => vanishes(problem, road, v0, at),
        Climbed::Changes(v0) => Found::Changes(v0),
        Climbed::LiftOff(v0) if lifts(road, v0) => Found::LiftOff(v0),
        Climbed::LiftOff(_) | Climbed::Unclear => Found::Unclear,
    }
}

fn grazes(problem: &Problem, road: &mut Orbit, v0: f64, slip: usize, at: &Place) -> Found {
    let below = v0 * (1.0 - PRECISION);
    let Ran::Period(period, _) = road.trial(below, Some(&at.period), f64::INFINITY) else {
        return Found::Unclear;
    };
    if !same_slip(&period, &at.period, slip) {
        return Found::Unclear;
    }
    road.keep();
    if slip > 0 && !road.rotate(slip, &period) {
        return Found::Unclear;
    }
    let period = period.rotated(slip);
    let slip = period.cycles()[0].slip;
    told(
        beyond(problem, (v0, slip), road),
        Found::Graze(v0, period),
    )
}

/// A stick that vanishes leaves less than this of it, over √(M/κ), just below its end.
const VANISHING: f64 = 1e-3;

fn vanishes(problem: &Problem, road: &mut Orbit, v0: f64, at: &Place) -> Found {
    let below = v0 * (1.0 - PRECISION);
    let Ran::Period(period, gauges) = road.trial(below, Some(&at.period), CHECKED) else {
        return Found::Unclear;
    };
    if -gauges[super::cycle::STICK] > VANISHING {
        return Found::Unclear;
    }
    road.keep();
    told(without_stick(problem, v0, road), Found::Vanish(v0, period))
}

fn told(beyond: Beyond, end: Found) -> Found {
    match beyond {
        Beyond::Ends => end,
        Beyond::Persists(slips) => Found::Persists(slips),
        Beyond::Irregular => Found::Irregular,
        Beyond::Unknown => Found::Unclear,
    }
}

/// The velocity of lift-off is checked this far below and above it, relative.
const LIFT_PRECISION: f64 = 1e-4;
/// How well periods repeat where an end is checked, relative.
const CHECKED: f64 = 1e-3;

/// Whether periods just below `v0` do not lift off, and just above it do.
fn lifts(road: &mut Orbit, v0: f64) -> bool {
    let [below, above] = [1.0 - LIFT_PRECISION, 1.0 + LIFT_PRECISION].map(|f| f * v0);
    road.trial(below, None, CHECKED) != Ran::LiftOff
        && road.trial(above, None, CHECKED) == Ran::LiftOff
}
