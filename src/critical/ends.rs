//! Where the orbit of stick-slip ends: a slip grazes ẋ = ẍ = 0, or the load or a stick vanishes.
//! How an end that a climb came to is checked, and what comes after it.

use super::answer::{Critical, End, Method};
use super::beyond::{Beyond, PRECISION, beyond, without_stick};
use super::climb::{Climbed, Place, Ran, Road};
use super::cycle::{Period, Ride, STICK, ride};
use super::orbit::Orbit;
use super::problem::Problem;
use crate::slip::motion::Motion;

/// The end of an orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum RoadEnd {
    /// The first slip of the period grazes.
    Graze(f64, Period),
    /// The stick of the period vanishes.
    Vanish(f64, Period),
    /// N ≤ 0.
    LiftOff(f64),
    /// Another kind of stick-slip goes on beyond it, with so many slips in a period; from the
    /// motion that was tried last.
    Persists(usize),
    /// It becomes of another kind at this v0.
    Changes(f64),
    /// Stick-slip goes on, but does not repeat.
    Irregular,
    /// Not known.
    Unclear,
}

impl RoadEnd {
    /// What it tells, found by `method`; none where it does not.
    pub(super) fn told(&self, method: Method) -> Option<Critical> {
        match self {
            Self::Graze(v0, period) => Some(of_orbit((*v0, End::Grazing), period, method)),
            Self::Vanish(v0, period) => Some(of_orbit((*v0, End::Fold), period, method)),
            Self::LiftOff(v0) => Some(Critical::of_lift_off(*v0, method)),
            Self::Changes(_) | Self::Persists(_) | Self::Irregular | Self::Unclear => None,
        }
    }

    /// The v0 at which stick-slip ends, where that is known.
    pub(super) fn end(&self) -> Option<f64> {
        match self {
            Self::Graze(v0, _) | Self::Vanish(v0, _) | Self::LiftOff(v0) => Some(*v0),
            Self::Changes(_) | Self::Persists(_) | Self::Irregular | Self::Unclear => None,
        }
    }
}

/// The most kinds of stick-slip that are followed one after the other.
pub(super) const MOST_KINDS: usize = 24;
/// The first relative step of v0 with another kind of stick-slip than the first.
pub(super) const FIRST_STEP: f64 = 0.02;

/// How far beyond a change of kind the next one is looked for, relative: forces have to differ by
/// more than their noise.
pub(super) const CHANGED: f64 = 1e-4;
/// How much the slip may lengthen on the last bit of the way, where it grows as a square root.
const SAME_SLIP: f64 = 0.1;

/// Whether the slip `i` of two periods is one.
pub(super) fn same_slip(one: &Period, other: &Period, i: usize) -> bool {
    (one.cycles()[i].slip / other.cycles()[i].slip - 1.0).abs() <= SAME_SLIP
}

fn of_orbit((vc, end): (f64, End), period: &Period, method: Method) -> Critical {
    // At the graze itself, that of the first slip, it lasts until the minimum of ẋ.
    let longer = match end {
        End::Grazing => period.cycles()[0].to_minimum.min(period.stick_time()),
        _ => 0.0,
    };
    Critical {
        stick_time: period.stick_time() - longer,
        slip_time: period.slip_time() + longer,
        n_min: period.n_min(),
        ..Critical::nothing(vc, end, method)
    }
}

/// What the end of a climb comes to. The road's kept motion is just below it.
pub(super) fn finish(problem: &Problem, road: &mut Orbit, climbed: Climbed, at: &Place) -> RoadEnd {
    let end = arrive(road, climbed, at);
    verify(problem, road, end).0
}

/// The end that a climb came to, before it is known what comes after it.
pub(super) fn arrive(road: &mut Orbit, climbed: Climbed, at: &Place) -> RoadEnd {
    match climbed {
        Climbed::Graze { v0, slip } => grazes(road, v0, slip, at),
        Climbed::Vanish(v0) => vanishes(road, v0, at),
        Climbed::Changes(v0) => RoadEnd::Changes(v0),
        Climbed::LiftOff(v0) => RoadEnd::LiftOff(v0),
        Climbed::Unclear => RoadEnd::Unclear,
    }
}

/// What an end that was arrived at is when what comes after it is looked at; and how clearly, as a
/// share of v0 that the block is away from stopping once more.
pub(super) fn verify(problem: &Problem, road: &mut Orbit, end: RoadEnd) -> (RoadEnd, f64) {
    let beyond = match end {
        RoadEnd::Graze(v0, period) if !holds_below(road, v0, &period) => {
            return (RoadEnd::Unclear, 0.0);
        }
        RoadEnd::Graze(v0, period) => beyond(problem, (v0, period.cycles()[0].slip), road),
        RoadEnd::Vanish(v0, period) if attracts(road.motion().clone(), &period, DISTURBED) => {
            without_stick(problem, v0, road)
        }
        RoadEnd::LiftOff(v0) if lifts(road, v0) => return (end, 1.0),
        RoadEnd::Vanish(..) | RoadEnd::LiftOff(_) => return (RoadEnd::Unclear, 0.0),
        _ => return (end, 0.0),
    };
    match beyond {
        Beyond::Ends(clear) => (end, clear),
        Beyond::Persists(slips) => (RoadEnd::Persists(slips), 0.0),
        Beyond::Irregular => (RoadEnd::Irregular, 0.0),
        Beyond::Unknown => (RoadEnd::Unclear, 0.0),
    }
}

/// A period this near below its end, relative, is as good as one at the end.
const AT_END: f64 = 2.0 * PRECISION;

fn grazes(road: &mut Orbit, v0: f64, slip: usize, at: &Place) -> RoadEnd {
    let mut period = at.period;
    if v0 > at.v0 * (1.0 + AT_END) {
        let below = v0 * (1.0 - PRECISION);
        let Ran::Period(last, _) = road.trial(below, Some(&at.period), f64::INFINITY) else {
            return RoadEnd::Unclear;
        };
        if !same_slip(&last, &at.period, slip) {
            return RoadEnd::Unclear;
        }
        road.keep();
        period = last;
    }
    if slip > 0 && !road.rotate(slip, &period) {
        return RoadEnd::Unclear;
    }
    let period = period.rotated(slip);
    if !period.cycles()[0].to_minimum.is_finite() {
        return RoadEnd::Unclear;
    }
    RoadEnd::Graze(v0, period)
}

/// A stick that vanishes leaves less than this of it, over √(M/κ), just below its end.
const VANISHING: f64 = 1e-3;

fn vanishes(road: &mut Orbit, v0: f64, at: &Place) -> RoadEnd {
    let below = v0 * (1.0 - PRECISION);
    let Ran::Period(period, gauges) = road.trial(below, Some(&at.period), CHECKED) else {
        return RoadEnd::Unclear;
    };
    if -gauges[STICK] > VANISHING {
        return RoadEnd::Unclear;
    }
    road.keep();
    RoadEnd::Vanish(v0, period)
}

/// A graze ends stick-slip if its orbit attracts this far below it, relative: nearer than v_c is
/// asked for it may not, since what the delayed slip does to the next one grows without bounds
/// there. Disturbed by more it would be thrown over the graze.
const BELOW_GRAZE: f64 = 1e-4;
const DISTURBED_BELOW: f64 = 2e-5;
/// Periods that are as good as at rest, and not asked to come nearer to one another.
const AT_REST: f64 = 0.06;

/// Whether stick-slip comes back to the orbit of a graze at `v0` just below it: one whose period
/// has doubled goes on to a graze of its own.
fn holds_below(road: &mut Orbit, v0: f64, period: &Period) -> bool {
    match road.trial(v0 * (1.0 - BELOW_GRAZE), Some(period), AT_REST) {
        Ran::Period(period, _) => attracts(road.tried().clone(), &period, DISTURBED_BELOW),
        _ => false,
    }
}

/// An orbit is disturbed by v0 being lower by this in one period, relative, and has so many to come
/// back.
const DISTURBED: f64 = 2e-4;
const PERIODS_BACK: usize = 30;
/// It has come back where so many in a row are nearer than this, relative to the first.
const NEAR_IN_A_ROW: u32 = 4;
const BACK: f64 = 0.05;
/// Sticks do not come nearer to one another than this, nor than this share of the last ones: they
/// are there still.
const STICKS_NOISE: f64 = 1e-7;
const STICKS_LEFT: f64 = 0.3;

/// Whether stick-slip comes back to the orbit that a motion is on when it is disturbed: an unstable
/// one, followed from close by, seems to be at rest as well.
fn attracts(mut motion: Motion, period: &Period, disturbed: f64) -> bool {
    let v0 = motion.parameters().v0;
    let stick = period.cycles()[0].stick;
    motion.set_v0(v0 * (1.0 - disturbed));
    let mut distances = (0..=PERIODS_BACK).map_while(|i| {
        let mut first = None;
        for _ in period.cycles() {
            let Ride::Cycle(cycle) = ride(&mut motion, None) else {
                return None;
            };
            first.get_or_insert(cycle.stick);
        }
        if i == 0 {
            motion.set_v0(v0);
        }
        first.map(|first| (first - stick).abs())
    });
    let Some(disturbed) = distances.next() else {
        return false;
    };
    let noise = STICKS_NOISE.min(STICKS_LEFT * stick);
    let mut near = 0;
    for (period, back) in distances.enumerate() {
        near = match back < (BACK * disturbed).max(noise) {
            true => near + 1,
            false => 0,
        };
        if near == NEAR_IN_A_ROW {
            return true;
        }
        if period + 1 == PERIODS_BACK {
            return back < (0.5 * disturbed).max(noise);
        }
    }
    false
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
