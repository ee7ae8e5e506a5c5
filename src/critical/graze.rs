//! The critical velocity as the velocity at which the slip of the stick-slip orbit grazes ẋ = ẍ = 0.
//!
//! Two roads to it. Where the block sticks for longer than a delay under pure load control, all memory is erased and one slip
//! tells: it starts from a = μ_S (1 + α_n v0 τ), which has grown evenly. Else the orbit itself is followed from cycle to
//! cycle while v0 approaches the graze.

use super::climb::{
    Climbed, LARGEST_STEP, Place, Road, SETTLED, climb, come_to_rest, gauges, limit,
};
use super::cycle::{Cycle, Ride, Stop, ride};
use super::follow::{self, Fate};
use super::{Method, Problem};
use crate::slip::motion::{Accuracy, Motion};
use crate::slip::outcome::Outcome;

/// A graze and the orbit there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Graze {
    /// v0.
    pub v0: f64,
    /// The grazing cycle.
    pub cycle: Cycle,
    /// Which of the two roads led there.
    pub method: Method,
}

/// How the search ended.
#[derive(Debug, Clone)]
pub enum Found {
    /// At a graze, beyond which the block slides.
    Graze(Graze),
    /// N ≤ 0 from this v0 on.
    LiftOff(f64, Method),
    /// Otherwise: simulation has to tell, from this motion in stick-slip on, if there is one.
    Unclear(Option<Box<Motion>>),
}

impl Found {
    /// The v0 at which stick-slip ends, where that is known.
    #[must_use]
    pub fn end(&self) -> Option<f64> {
        match self {
            Self::Graze(graze) => Some(graze.v0),
            Self::LiftOff(v0, _) => Some(*v0),
            Self::Unclear(_) => None,
        }
    }
}

/// Where v0 starts, in order, in units of μ_S N0/√(κM).
const STARTS: [f64; 4] = [6e-2, 6e-3, 1e-4, 1e-6];
/// The last trials are this far below and above the graze, relative: v_c is known to it.
const PRECISION: f64 = 1e-5;
/// The most cycles at one v0.
const MOST_CYCLES: u32 = 12;
/// How much the slip may lengthen on the last bit of the way, where it grows as a square root.
const SAME_SLIP: f64 = 0.1;

/// Slips that start without memory.
struct Slips<'p> {
    problem: &'p Problem,
    motion: Motion,
}

impl Road for Slips<'_> {
    fn trial(&mut self, v0: f64, expected: Option<Stop>, _: f64) -> Ride {
        self.release(v0);
        ride(&mut self.motion, expected, true)
    }

    fn keep(&mut self) {}
}

impl Slips<'_> {
    /// At the end of a stick that outlasted the delay.
    fn release(&mut self, v0: f64) {
        let p = self.problem;
        self.motion.set_v0(v0);
        self.motion
            .release_from(p.law.mu_s() * (1.0 + p.alpha_n * v0 * p.tau));
    }
}

/// Cycle after cycle.
#[derive(Debug, Clone)]
struct Orbit {
    kept: Motion,
    tried: Motion,
}

impl Road for Orbit {
    fn trial(&mut self, v0: f64, mut expected: Option<Stop>, settled: f64) -> Ride {
        self.tried.copy_from(&self.kept);
        self.tried.set_v0(v0);
        let mut seen = [[f64::NAN; 3]; 2];
        for _ in 0..MOST_CYCLES {
            let cycle = match ride(&mut self.tried, expected, false) {
                Ride::Cycle(cycle) => cycle,
                other => return other,
            };
            expected = expected.map(|_| cycle.stop());
            for (seen, gauge) in seen.iter_mut().zip(gauges(&cycle)) {
                *seen = [seen[1], seen[2], gauge];
            }
            if settled == f64::INFINITY || seen.iter().all(|seen| come_to_rest(seen, settled)) {
                return Ride::Cycle(Cycle {
                    depth: limit(seen[0]),
                    n_min: -limit(seen[1]),
                    ..cycle
                });
            }
        }
        Ride::Other
    }

    fn keep(&mut self) {
        std::mem::swap(&mut self.kept, &mut self.tried);
    }
}

/// The graze of `problem`'s stick-slip; and, where the orbit itself was followed to its end, from where to go on to the next
/// cell of a line.
#[must_use]
pub fn find(problem: &Problem, accuracy: Accuracy) -> (Found, Option<Track>) {
    if problem.alpha_v == 0.0
        && let Some(found) = by_one_slip(problem, accuracy)
    {
        return (found, None);
    }
    by_orbit(problem, accuracy)
}

fn motion(problem: &Problem, accuracy: Accuracy) -> Motion {
    Motion::new(problem.at(1e-3, 0.0), accuracy, 0.0, 0.0)
}

/// The first road; none where it does not lead to the end.
fn by_one_slip(problem: &Problem, accuracy: Accuracy) -> Option<Found> {
    let mut road = Slips {
        problem,
        motion: motion(problem, accuracy),
    };
    let (v0, start) = STARTS.iter().find_map(|start| {
        let v0 = start * problem.law.mu_s();
        match road.trial(v0, None, 0.2) {
            Ride::Cycle(cycle) => Some((v0, cycle)),
            _ => None,
        }
    })?;
    let from = Place {
        v0,
        cycle: start,
        settled: f64::INFINITY,
        slopes: [f64::NAN; 2],
        expected: f64::NAN,
    };
    let (v0, slip) = match climb(&mut road, from, LARGEST_STEP).0 {
        Climbed::Graze { v0, slip } => (v0, Some(slip)),
        Climbed::LiftOff(v0) => (v0, None),
        Climbed::Unclear => return None,
    };
    // The stick after this slip, and so the one before it, outlast the delay; and beyond it the block slides.
    road.release(v0 * (1.0 - PRECISION));
    let Ride::Cycle(cycle) = ride(&mut road.motion, None, false) else {
        return None;
    };
    if cycle.stick < problem.tau {
        return None;
    }
    let Some(slip) = slip else {
        return Some(Found::LiftOff(v0, Method::GrazeSlip));
    };
    if (cycle.slip / slip - 1.0).abs() > SAME_SLIP {
        return None;
    }
    let graze = Graze {
        v0,
        cycle,
        method: Method::GrazeSlip,
    };
    let kept = road.motion.clone();
    match beyond(problem, &kept, &mut road.motion, slip, &graze) {
        Beyond::Ends => Some(Found::Graze(graze)),
        Beyond::Persists => Some(Found::Unclear(Some(Box::new(road.motion)))),
        Beyond::Unknown => None,
    }
}

/// An orbit at its end, from which the next cell of a line starts.
#[derive(Debug, Clone)]
pub struct Track {
    road: Orbit,
    at: Place,
    /// Delays and ends of the cells before, the last ones.
    ends: Vec<(f64, f64)>,
    /// Whether it ends by lift-off.
    lifts: bool,
    /// How far off the end was last expected, relative.
    off: f64,
}

/// How far off an end is taken to be before anything is known.
const FIRST_OFF: f64 = 0.02;
/// The least and the largest distance from the expected end at which a cell starts, relative.
const NEAREST: f64 = 3e-4;
const FARTHEST: f64 = 0.1;
/// The least one from lift-off, which the transient of a new start can bring about too early.
const NEAREST_LIFT: f64 = 3e-3;
/// The largest change of the delay from cell to cell, relative.
const LARGEST_CHANGE: f64 = 0.5;
/// How far from the last end, in its logarithm, the next one is looked for.
const FARTHEST_LOG: f64 = 0.5;
/// Ends that an expectation is made of.
const KNOWN_ENDS: usize = 3;

impl Track {
    /// The end of stick-slip of `problem`, which differs by its delay alone from the one before; none where the orbit before
    /// does not lead to a graze or to lift-off. After that the track is of no more use.
    pub fn next(&mut self, problem: &Problem) -> Option<Found> {
        let before = self.ends[self.ends.len() - 1].0;
        if (problem.tau / before - 1.0).abs() > LARGEST_CHANGE {
            return None;
        }
        let expected = self.expected(problem.tau);
        self.road.kept.set_delay(problem.tau);
        let nearest = if self.lifts { NEAREST_LIFT } else { NEAREST };
        // An orbit that has to change starts with a transient.
        let change = (expected / self.ends[self.ends.len() - 1].1 - 1.0).abs();
        let off = (2.0 * self.off).max(0.15 * change).clamp(nearest, FARTHEST);
        let from = [off, 4.0 * off, 2.0 * FARTHEST]
            .into_iter()
            .find_map(|off| {
                let v0 = expected * (1.0 - off);
                match self.road.trial(v0, Some(self.at.cycle.stop()), SETTLED) {
                    Ride::Cycle(cycle) => Some(Place {
                        v0,
                        cycle,
                        settled: SETTLED,
                        slopes: self.at.slopes,
                        expected: f64::NAN,
                    }),
                    _ => None,
                }
            })?;
        self.road.keep();
        let (climbed, at) = climb(&mut self.road, from, FARTHEST);
        let found = finish(problem, &mut self.road, climbed);
        let end = found.end()?;
        self.off = (end / expected - 1.0).abs();
        self.at = at;
        self.lifts = matches!(found, Found::LiftOff(..));
        if self.ends.len() == KNOWN_ENDS {
            self.ends.remove(0);
        }
        self.ends.push((problem.tau, end));
        Some(found)
    }

    /// Learns of the cell before, whose end was found otherwise: an end like its own expects the next one better.
    pub fn recall(&mut self, tau: f64, end: f64) {
        if self.ends.len() < KNOWN_ENDS && tau < self.ends[0].0 {
            self.ends.insert(0, (tau, end));
            self.off = NEAREST.max(0.25 * self.off);
        }
    }

    /// The end at `tau`: its logarithm as the polynomial of that of the delay through the last ones (Neville).
    fn expected(&self, tau: f64) -> f64 {
        let n = self.ends.len();
        let mut logs = [(0.0, 0.0); KNOWN_ENDS];
        for (log, end) in logs.iter_mut().zip(&self.ends) {
            *log = (end.0.ln(), end.1.ln());
        }
        let (x, mut p) = (tau.ln(), logs.map(|log| log.1));
        for k in 1..n {
            for i in 0..n - k {
                let (low, high) = (logs[i].0, logs[i + k].0);
                p[i] = ((x - high) * p[i] + (low - x) * p[i + 1]) / (low - high);
            }
        }
        // Not far from the last one, whatever the polynomial does.
        let last = logs[n - 1].1;
        p[0].clamp(last - FARTHEST_LOG, last + FARTHEST_LOG).exp()
    }
}

/// The second road.
fn by_orbit(problem: &Problem, accuracy: Accuracy) -> (Found, Option<Track>) {
    let kept = motion(problem, accuracy);
    let tried = kept.clone();
    let mut road = Orbit { kept, tried };
    for start in STARTS {
        let v0 = start * problem.law.mu_s();
        road.kept.set_v0(v0);
        road.kept.release_from(problem.law.mu_s());
        let Ride::Cycle(cycle) = road.trial(v0, None, 0.2) else {
            continue;
        };
        road.keep();
        let from = Place {
            v0,
            cycle,
            settled: f64::INFINITY,
            slopes: [f64::NAN; 2],
            expected: f64::NAN,
        };
        let (climbed, at) = climb(&mut road, from, LARGEST_STEP);
        let found = finish(problem, &mut road, climbed);
        let end = found.end();
        let track = end.map(|end| Track {
            road,
            at,
            ends: vec![(problem.tau, end)],
            lifts: matches!(found, Found::LiftOff(..)),
            off: FIRST_OFF,
        });
        return (found, track);
    }
    (Found::Unclear(None), None)
}

/// What the end of a climb comes to. The road's kept motion is just below it.
fn finish(problem: &Problem, road: &mut Orbit, climbed: Climbed) -> Found {
    let unclear = |motion: &Motion| Found::Unclear(Some(Box::new(motion.clone())));
    let (v0, slip) = match climbed {
        Climbed::Graze { v0, slip } => (v0, slip),
        Climbed::LiftOff(v0) if lifts(road, v0) => {
            return Found::LiftOff(v0, Method::GrazeOrbit);
        }
        Climbed::LiftOff(_) => return unclear(&road.kept),
        Climbed::Unclear => return unclear(&road.kept),
    };
    let below = v0 * (1.0 - PRECISION);
    let Ride::Cycle(cycle) = road.trial(below, None, f64::INFINITY) else {
        return unclear(&road.kept);
    };
    if (cycle.slip / slip - 1.0).abs() > SAME_SLIP {
        return unclear(&road.kept);
    }
    let graze = Graze {
        v0,
        cycle,
        method: Method::GrazeOrbit,
    };
    road.keep();
    match beyond(problem, &road.kept, &mut road.tried, slip, &graze) {
        Beyond::Ends => Found::Graze(graze),
        Beyond::Persists => unclear(&road.tried),
        Beyond::Unknown => unclear(&road.kept),
    }
}

/// The velocity of lift-off is checked this far below and above it, relative.
const LIFT_PRECISION: f64 = 1e-4;

/// Whether cycles just below `v0` do not lift off, and just above it do.
fn lifts(road: &mut Orbit, v0: f64) -> bool {
    let [below, above] = [1.0 - LIFT_PRECISION, 1.0 + LIFT_PRECISION].map(|f| f * v0);
    let lifted = |ride: Ride| ride == Ride::LiftOff;
    !lifted(road.trial(below, None, CHECKED)) && lifted(road.trial(above, None, CHECKED))
}

/// How well cycles repeat where lift-off is checked, relative.
const CHECKED: f64 = 1e-3;

/// What becomes of stick-slip just beyond a graze.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Beyond {
    /// It ends.
    Ends,
    /// It is stick-slip of another kind.
    Persists,
    Unknown,
}

/// Steps of v0 past the graze, from below it to beyond it, relative. The first one is taken from where the last kept cycle was.
const STEPS: [[f64; 2]; 3] = [[PRECISION, PRECISION], [PRECISION, 1e-4], [2e-6, 2e-6]];

/// What becomes, just beyond the graze, of the block of `kept`, released just below it; in `tried`. Where steps of different
/// sizes lead to different ends, that is not known.
fn beyond(
    problem: &Problem,
    kept: &Motion,
    tried: &mut Motion,
    slip: f64,
    graze: &Graze,
) -> Beyond {
    let mut step = |[below, above]: [f64; 2]| {
        tried.copy_from(kept);
        if below < PRECISION {
            tried.set_v0(graze.v0 * (1.0 - below));
            let Ride::Cycle(_) = ride(tried, Some(graze.cycle.stop()), false) else {
                // The graze is not known to that.
                return None;
            };
        }
        Some(outcome(problem, tried, slip, graze.v0 * (1.0 + above)))
    };
    let first = step(STEPS[0]).unwrap_or(Beyond::Unknown);
    let ends = |steps: &[f64; 2]| step(*steps).is_none_or(|beyond| beyond == Beyond::Ends);
    match first {
        Beyond::Ends if !STEPS[1..].iter().all(ends) => Beyond::Unknown,
        first => first,
    }
}

/// What becomes of a block that is released now, at `v0`.
fn outcome(problem: &Problem, motion: &mut Motion, slip: f64, v0: f64) -> Beyond {
    motion.set_v0(v0);
    if slides(problem, motion, slip) {
        return Beyond::Ends;
    }
    match follow::fate(problem, motion, v0) {
        Fate::Slips => Beyond::Ends,
        Fate::Lost(Outcome::Undecided) | Fate::LiftOff => Beyond::Unknown,
        Fate::Lost(_) => Beyond::Ends,
        Fate::Periodic | Fate::Irregular => Beyond::Persists,
    }
}

/// The share of v0 above which ẋ stays once the block slides. Minima that only rise to half of v0 may fall again: an unstable
/// oscillation about stable sliding can be on either side.
const SLIDING: f64 = 0.8;

/// Whether a block released just beyond a graze slides from then on: its velocity's minima after the graze rise.
fn slides(problem: &Problem, motion: &mut Motion, slip: f64) -> bool {
    let v0 = motion.parameters().v0;
    if !problem.count(v0).stable() {
        return false;
    }
    let start = motion.t;
    let mut lowest = f64::NEG_INFINITY;
    let mut risen = 0;
    for _ in 0..20_000 {
        if motion.advance(f64::INFINITY).is_some() || !motion.u.is_finite() {
            return false;
        }
        let Some((_, u)) = motion.last_step().speed_minimum() else {
            continue;
        };
        if motion.t - start < 0.75 * slip {
            continue;
        }
        if u < lowest {
            // Beats: what comes after the lowest one counts.
            risen = 0;
        } else {
            risen += 1;
        }
        lowest = u;
        if risen >= 2 && u > SLIDING * v0 && motion.t - start > slip + problem.tau {
            return true;
        }
        if motion.t - start > 20.0 * slip + 20.0 * problem.tau {
            return false;
        }
    }
    false
}
