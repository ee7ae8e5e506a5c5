//! Raising v0 towards where a number vanishes that is seen in every cycle of stick-slip: the depth of its stops, or the load.

use super::cycle::{Cycle, Ride, Stop};

/// The largest relative step of v0.
pub(super) const LARGEST_STEP: f64 = 1.0;
/// Nearer than this to the graze, relative, the rest of the way is told from the last two trials.
const NEAR: f64 = 1e-4;
/// As near as this the last two trials tell, if they agree to that on where it ends.
const QUITE_NEAR: f64 = 3e-3;
const AGREES: f64 = 3e-6;
/// The most trials.
const MOST_TRIALS: u32 = 40;

/// Trials of stick-slip at one v0 after the other.
pub(super) trait Road {
    /// What a block released at `v0` does, from where the last trial that was kept ended.
    /// With memory, cycle after cycle until their depths differ by no more than `settled`, relative.
    fn trial(&mut self, v0: f64, expected: Option<Stop>, settled: f64) -> Ride;
    /// Goes on from the end of the last trial.
    fn keep(&mut self);
}

/// How a climb towards a graze ended.
pub(super) enum Climbed {
    Graze { v0: f64, slip: f64 },
    LiftOff(f64),
    Unclear,
}

/// What changes with v0 and vanishes where stick-slip ends: minus the distance to a graze and to lift-off.
pub(super) fn gauges(cycle: &Cycle) -> [f64; 2] {
    [cycle.depth, -cycle.n_min]
}

/// Whether the last members of a sequence differ by no more than `settled`, relative, and by less and less: else the orbit
/// that they seem to reach may be unstable.
pub(super) fn come_to_rest([first, second, third]: &[f64; 3], settled: f64) -> bool {
    let (before, last) = ((second - first).abs(), (third - second).abs());
    let falls = settled > SETTLED || last <= CONTRACTION * before || last <= NOISE * third.abs();
    last <= settled * third.abs() && falls
}

/// What a sequence converges to, as its last three members tell (Aitken).
pub(super) fn limit([first, second, third]: [f64; 3]) -> f64 {
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
pub(super) struct Place {
    pub v0: f64,
    pub cycle: Cycle,
    /// How settled it is, see [`Road::trial`].
    pub settled: f64,
    /// The gauges' derivatives with respect to v0; NaN before they are known.
    pub slopes: [f64; 2],
    /// Where the end was expected before this place was reached; NaN where it was not.
    pub expected: f64,
}

impl Place {
    /// By how much v0 has to grow for each gauge to vanish, relative; +∞ where it does not come to that.
    fn gaps(&self) -> [f64; 2] {
        [0, 1].map(|i| {
            let gap = -gauges(&self.cycle)[i] / self.slopes[i] / self.v0;
            if gap >= 0.0 { gap } else { f64::INFINITY }
        })
    }

    /// Where the end is expected; +∞ where none is.
    fn end(&self) -> f64 {
        let [graze, lift] = self.gaps();
        self.v0 * (1.0 + graze.min(lift))
    }

    /// Whether the end is near, and where it was expected before.
    fn agrees(&self) -> bool {
        let end = self.end();
        end / self.v0 - 1.0 < QUITE_NEAR && (end / self.expected - 1.0).abs() < AGREES
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
            expected: self.end(),
        }
    }
}

/// Where the end is near, cycles have to be settled to this.
pub(super) const SETTLED: f64 = 0.05;
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
        2e-3.. => SETTLED,
        _ => 0.4 * SETTLED,
    }
}

/// How far the next trial may go, relative.
#[derive(Debug, Clone, Copy)]
struct Reach {
    most: f64,
    /// The v0 of the last trial that failed, unless one beyond it has not.
    failed: Option<f64>,
}

impl Reach {
    fn step(&self, v0: f64, gap: f64) -> f64 {
        let ceiling = self.failed.map_or(f64::INFINITY, |v| 0.5 * (v / v0 - 1.0));
        (SHARE * gap).min(self.most).min(ceiling)
    }

    fn succeeded(&mut self, v0: f64, step: f64) {
        self.most = (2.0 * self.most).min(LARGEST_STEP);
        if self.failed.is_some_and(|failed| failed <= v0) {
            // What failed there was the size of the step.
            (self.failed, self.most) = (None, 4.0 * step);
        }
    }
}

/// Raises v0 from a place towards where a gauge vanishes, by `most` at first; with the last place.
pub(super) fn climb(road: &mut impl Road, mut at: Place, most: f64) -> (Climbed, Place) {
    let mut reach = Reach { most, failed: None };
    let mut last = false;
    for _ in 0..MOST_TRIALS {
        let gaps = at.gaps();
        let gap = gaps[0].min(gaps[1]);
        let mut step = reach.step(at.v0, gap);
        if step < SHARE * NEAR || at.agrees() {
            if at.settled > SETTLED {
                step = 0.0;
            } else if last || gap < NEAR || at.agrees() {
                return (arrived(&at), at);
            } else {
                // Once more, beyond where the last one failed.
                (last, step) = (true, 3.0 * NEAR);
            }
        }
        let (next, settled) = (at.v0 * (1.0 + step), needed(step));
        match road.trial(next, Some(at.cycle.stop()), settled) {
            Ride::Cycle(there) => {
                road.keep();
                at = at.moved_to(next, there, settled);
                reach.succeeded(next, step);
                last = false;
            }
            // A start that is not sustained.
            Ride::Pass | Ride::LiftOff if step == 0.0 => return (Climbed::Unclear, at),
            Ride::Pass | Ride::LiftOff => reach.failed = Some(next),
            Ride::Other => return (Climbed::Unclear, at),
        }
    }
    (Climbed::Unclear, at)
}

/// What vanishes at the end of a climb.
fn arrived(at: &Place) -> Climbed {
    let [graze, lift] = at.gaps();
    // The load of cycles that have not quite come to rest says less than the depth of their stops.
    let (near_graze, near_lift) = match at.agrees() {
        true => (QUITE_NEAR, QUITE_NEAR),
        false => (10.0 * NEAR, NEAR),
    };
    if lift < near_lift && lift < graze {
        Climbed::LiftOff(at.v0 * (1.0 + lift))
    } else if graze < near_graze {
        Climbed::Graze {
            v0: at.v0 * (1.0 + graze),
            slip: at.cycle.slip,
        }
    } else {
        Climbed::Unclear
    }
}
