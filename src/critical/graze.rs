//! The critical velocity as the velocity at which the slip of the stick-slip orbit grazes ẋ = ẍ = 0.
//!
//! Two roads to it. Where the block sticks for longer than a delay under pure load control, all memory is erased and one slip
//! tells: it starts from a = μ_S (1 + α_n v0 τ), which has grown evenly. Else the orbit itself is followed from cycle to
//! cycle while v0 approaches the graze.

use super::cycle::{Cycle, Ride, ride};
use super::{Method, Problem};
use crate::slip::motion::{Accuracy, Motion};

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
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Found {
    /// At a graze, beyond which the block slides.
    Graze(Graze),
    /// N ≤ 0 from this v0 on.
    LiftOff(f64, Method),
    /// Otherwise: simulation has to tell.
    Unclear,
}

/// Where v0 starts, in order, in units of μ_S N0/√(κM).
const STARTS: [f64; 4] = [6e-2, 6e-3, 1e-4, 1e-6];
/// The largest relative step of v0.
const LARGEST_STEP: f64 = 1.0;
/// Nearer than this to the graze, relative, the rest of the way is told from the last two trials.
const NEAR: f64 = 1e-4;
/// The last trials are this far below and above the graze, relative: v_c is known to it.
const PRECISION: f64 = 1e-5;
/// The most cycles at one v0.
const MOST_CYCLES: u32 = 12;
/// How much the slip may lengthen on the last bit of the way, where it grows as a square root.
const SAME_SLIP: f64 = 0.1;
/// The most trials.
const MOST_TRIALS: u32 = 80;

/// Trials of stick-slip at one v0 after the other.
trait Road {
    /// What a block released at `v0` does, from where the last trial that was kept ended.
    /// With memory, cycle after cycle until their depths differ by no more than `settled`, relative.
    fn trial(&mut self, v0: f64, expected: Option<f64>, settled: f64) -> Ride;
    /// Goes on from the end of the last trial.
    fn keep(&mut self);
}

/// Slips that start without memory.
struct Slips<'p> {
    problem: &'p Problem,
    motion: Motion,
}

impl Road for Slips<'_> {
    fn trial(&mut self, v0: f64, expected: Option<f64>, _: f64) -> Ride {
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
struct Orbit {
    kept: Motion,
    tried: Motion,
}

impl Road for Orbit {
    fn trial(&mut self, v0: f64, mut expected: Option<f64>, settled: f64) -> Ride {
        self.tried.copy_from(&self.kept);
        self.tried.set_v0(v0);
        let mut seen = [[f64::NAN; 3]; 2];
        for _ in 0..MOST_CYCLES {
            let cycle = match ride(&mut self.tried, expected, false) {
                Ride::Cycle(cycle) => cycle,
                other => return other,
            };
            expected = expected.map(|_| cycle.slip);
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

/// The graze of `problem`'s stick-slip.
#[must_use]
pub fn find(problem: &Problem, accuracy: Accuracy) -> Found {
    if problem.alpha_v == 0.0
        && let Some(found) = by_one_slip(problem, accuracy)
    {
        return found;
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
    let (v0, slip) = match climb(&mut road, v0, start) {
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
    Some(if_it_ends(problem, &mut road.motion, slip, graze))
}

/// The second road.
fn by_orbit(problem: &Problem, accuracy: Accuracy) -> Found {
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
        return match climb(&mut road, v0, cycle) {
            Climbed::Graze { v0, slip } => finish(problem, &mut road, v0, slip),
            Climbed::LiftOff(v0) => Found::LiftOff(v0, Method::GrazeOrbit),
            Climbed::Unclear => Found::Unclear,
        };
    }
    Found::Unclear
}

fn finish(problem: &Problem, road: &mut Orbit, v0: f64, slip: f64) -> Found {
    let below = v0 * (1.0 - PRECISION);
    let Ride::Cycle(cycle) = road.trial(below, None, f64::INFINITY) else {
        return Found::Unclear;
    };
    if (cycle.slip / slip - 1.0).abs() > SAME_SLIP {
        return Found::Unclear;
    }
    road.keep();
    let graze = Graze {
        v0,
        cycle,
        method: Method::GrazeOrbit,
    };
    if_it_ends(problem, &mut road.kept, slip, graze)
}

/// The graze, if just beyond it a block that is released now comes to slide.
fn if_it_ends(problem: &Problem, motion: &mut Motion, slip: f64, graze: Graze) -> Found {
    motion.set_v0(graze.v0 * (1.0 + PRECISION));
    if slides(problem, motion, slip) {
        Found::Graze(graze)
    } else {
        Found::Unclear
    }
}

/// How a climb towards a graze ended.
enum Climbed {
    Graze { v0: f64, slip: f64 },
    LiftOff(f64),
    Unclear,
}

/// What changes with v0 and vanishes where stick-slip ends: minus the distance to a graze and to lift-off.
fn gauges(cycle: &Cycle) -> [f64; 2] {
    [cycle.depth, -cycle.n_min]
}

/// Whether the last members of a sequence differ by no more than `settled`, relative, and by less and less: else the orbit
/// that they seem to reach may be unstable.
fn come_to_rest([first, second, third]: &[f64; 3], settled: f64) -> bool {
    let (before, last) = ((second - first).abs(), (third - second).abs());
    let falls = settled > SETTLED || last <= CONTRACTION * before || last <= NOISE * third.abs();
    last <= settled * third.abs() && falls
}

/// What a sequence converges to, as its last three members tell (Aitken).
fn limit([first, second, third]: [f64; 3]) -> f64 {
    let (before, last) = (second - first, third - second);
    let ratio = last / before;
    if ratio.abs() < 0.7 {
        third + last * ratio / (1.0 - ratio)
    } else {
        third
    }
}

/// A kept trial on the way to a graze.
#[derive(Debug, Clone, Copy)]
struct Place {
    v0: f64,
    cycle: Cycle,
    /// How settled it is, see [`Road::trial`].
    settled: f64,
    /// The gauges' derivatives with respect to v0; NaN before they are known.
    slopes: [f64; 2],
}

impl Place {
    /// By how much v0 has to grow for each gauge to vanish, relative; +∞ where it does not come to that.
    fn gaps(&self) -> [f64; 2] {
        [0, 1].map(|i| {
            let gap = -gauges(&self.cycle)[i] / self.slopes[i] / self.v0;
            if gap >= 0.0 { gap } else { f64::INFINITY }
        })
    }

    /// The next one.
    fn moved_to(&self, v0: f64, cycle: Cycle, settled: f64) -> Self {
        let slopes = [0, 1].map(|i| {
            let slope = (gauges(&cycle)[i] - gauges(&self.cycle)[i]) / (v0 - self.v0);
            // At the same v0 only the gauges are better known.
            if v0 > self.v0 { slope } else { self.slopes[i] }
        });
        Self {
            v0,
            cycle,
            settled,
            slopes,
        }
    }
}

/// Where the end is near, cycles have to be settled to this.
const SETTLED: f64 = 0.05;
/// The most by which cycles that come to rest differ from one to the next, compared with the difference before.
const CONTRACTION: f64 = 0.8;
/// Noise of the gauges, relative.
const NOISE: f64 = 1e-6;
/// The share of the way to the expected end that is taken at once.
const SHARE: f64 = 0.97;

/// How settled a trial has to be after a step of v0.
fn needed(step: f64) -> f64 {
    match step {
        0.3.. => 0.2,
        0.02.. => 0.1,
        _ => SETTLED,
    }
}

/// How far the next trial may go, relative.
#[derive(Debug, Clone, Copy)]
struct Reach {
    most: f64,
    /// The v0 of the last trial that failed, unless one beyond it has not; and whether it lifted off.
    failed: Option<(f64, bool)>,
}

impl Reach {
    fn step(&self, v0: f64, gap: f64) -> f64 {
        let ceiling = self
            .failed
            .map_or(f64::INFINITY, |(v, _)| 0.5 * (v / v0 - 1.0));
        (SHARE * gap).min(self.most).min(ceiling)
    }

    fn succeeded(&mut self, v0: f64, step: f64) {
        self.most = (2.0 * self.most).min(LARGEST_STEP);
        if self.failed.is_some_and(|(failed, _)| failed <= v0) {
            // What failed there was the size of the step.
            (self.failed, self.most) = (None, 4.0 * step);
        }
    }
}

/// Raises v0 towards where a gauge vanishes.
fn climb(road: &mut impl Road, start: f64, first: Cycle) -> Climbed {
    let mut at = Place {
        v0: start,
        cycle: first,
        settled: f64::INFINITY,
        slopes: [f64::NAN; 2],
    };
    let mut reach = Reach {
        most: LARGEST_STEP,
        failed: None,
    };
    let mut last = false;
    for _ in 0..MOST_TRIALS {
        let gaps = at.gaps();
        let gap = gaps[0].min(gaps[1]);
        let mut step = reach.step(at.v0, gap);
        let enough = if gaps[0] <= gaps[1] { NEAR } else { PRECISION };
        if step < SHARE * enough {
            if at.settled > SETTLED {
                step = 0.0;
            } else if last || gap < enough {
                return arrived(&at, gaps, reach.failed.is_some_and(|(_, lifted)| lifted));
            } else {
                // Once more, beyond where the last one failed.
                (last, step) = (true, 3.0 * enough);
            }
        }
        let (next, settled) = (at.v0 * (1.0 + step), needed(step));
        match road.trial(next, Some(at.cycle.slip), settled) {
            Ride::Cycle(there) => {
                road.keep();
                at = at.moved_to(next, there, settled);
                reach.succeeded(next, step);
                last = false;
            }
            // A start that is not sustained.
            Ride::Pass | Ride::LiftOff if step == 0.0 => return Climbed::Unclear,
            missed @ (Ride::Pass | Ride::LiftOff) => {
                reach.failed = Some((next, missed == Ride::LiftOff));
            }
            Ride::Other => return Climbed::Unclear,
        }
    }
    Climbed::Unclear
}

/// What vanishes at the end of a climb; `lifted`: the last trial beyond it lifted off.
fn arrived(at: &Place, [graze, lift]: [f64; 2], lifted: bool) -> Climbed {
    let near = 10.0 * NEAR;
    if lift < near && lift < graze {
        Climbed::LiftOff(at.v0 * (1.0 + lift))
    } else if lifted && graze >= near {
        Climbed::LiftOff(at.v0)
    } else if graze < near {
        Climbed::Graze {
            v0: at.v0 * (1.0 + graze),
            slip: at.cycle.slip,
        }
    } else {
        Climbed::Unclear
    }
}

/// The share of v0 above which ẋ stays once the block slides.
const SLIDING: f64 = 0.25;

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
