//! Raising v0 towards where a number vanishes that is seen in every period of stick-slip: the depth
//! of a stop, the load, or a stick.
//!
//! Longer than most files: one way up, whose steps, places and ends make sense together alone.

use crate::model::elementary::power;
use crate::slip::motion::{Accuracy, Motion};

use super::cycle::{DIP, GAUGES, LOAD, Period, STICK, TURN};

/// Error allowed in a step on the way to a graze.
pub(super) const GRAZE_TOLERANCE: f64 = 1e-6;
/// The largest relative step of v0.
pub(super) const LARGEST_STEP: f64 = 1.0;
/// Nearer than this to the end, relative, the rest of the way is told from the last two trials.
const NEAR: f64 = 1e-4;
/// Within this of an end, relative, the last two trials tell it if they agree on it to [`AGREES`].
const QUITE_NEAR: f64 = 3e-3;
const AGREES: f64 = 3e-6;
/// Within this of an end, relative, slopes of a problem like this one tell it.
const AT_ONCE: f64 = 3e-5;
/// The most trials.
const MOST_TRIALS: u32 = 60;
/// Periods that have not come to rest after a step larger than this may do so after a smaller one.
const UNSETTLED: f64 = 0.02;

/// What a trial came to.
#[expect(
    clippy::large_enum_variant,
    reason = "nothing is allocated for a trial"
)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ran {
    /// Periods that came to rest: the last one, and its gauges, which may be those of a limit.
    Period(Period, [f64; GAUGES]),
    /// A stop that was expected did not come.
    Pass,
    /// N ≤ 0.
    LiftOff,
    /// Periods did not come to rest, or something else happened.
    Other,
    /// The road leads no further.
    Over,
}

/// Trials of stick-slip at one v0 after the other.
pub(super) trait Road {
    /// A block that is released at `v0`, with a past like that of the trials that were kept.
    fn place(&mut self, v0: f64) -> &mut Motion;
    /// What a block released at `v0` does, from where the last trial that was kept ended. With
    /// memory, period after period until their gauges differ by no more than `settled`, relative.
    fn trial(&mut self, v0: f64, expected: Option<&Period>, settled: f64) -> Ran;
    /// Goes on from the end of the last trial.
    fn keep(&mut self);
    /// Goes on with another accuracy.
    fn refine(&mut self, accuracy: Accuracy);
}

/// How a climb ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Climbed {
    /// By a graze of the slip of this number.
    Graze { v0: f64, slip: usize },
    /// By lift-off.
    LiftOff(f64),
    /// By a stick that vanishes.
    Vanish(f64),
    /// It becomes of another kind: it turns back where it stopped, or stops where it had not.
    Changes(f64),
    /// Not known.
    Unclear,
}

/// Whether the last members of a sequence differ by no more than `settled`, relative, and by less
/// and less: else the orbit that they seem to reach may be unstable. Or by no more than `noise`.
fn come_to_rest([first, second, third]: &[f64; 3], settled: f64, noise: f64) -> bool {
    let (before, last) = ((second - first).abs(), (third - second).abs());
    let falls = settled > SETTLED || last <= CONTRACTION * before || last <= NOISE * third.abs();
    third.is_nan() || last <= noise || last <= settled * third.abs() && falls
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

/// The gauges of the last three periods, the oldest first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen([[f64; 3]; GAUGES]);

impl Seen {
    /// Before the first period.
    pub(super) fn none() -> Self {
        Self([[f64::NAN; 3]; GAUGES])
    }

    /// Whether there is none yet.
    pub(super) fn none_yet(&self) -> bool {
        self.0[LOAD][2].is_nan()
    }

    /// One more period.
    pub(super) fn push(&mut self, period: &Period) {
        for (seen, gauge) in self.0.iter_mut().zip(period.gauges()) {
            *seen = [seen[1], seen[2], gauge];
        }
    }

    /// Whether they have come to rest, at `v0`.
    pub(super) fn settled(&self, settled: f64, v0: f64) -> bool {
        let speed = |gauge: usize| gauge < LOAD || gauge == DIP;
        let mut seen = self.0.iter().enumerate();
        !self.0[LOAD][0].is_nan()
            && seen.all(|(i, seen)| {
                let noise = if speed(i) { NOISE * v0 } else { NOISE };
                come_to_rest(seen, settled, noise)
            })
    }

    /// What they come to.
    pub(super) fn limits(&self) -> [f64; GAUGES] {
        self.0.map(limit)
    }
}

/// A kept trial on the way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub v0: f64,
    pub period: Period,
    /// What vanishes at the end.
    pub gauges: [f64; GAUGES],
    /// How settled it is, see [`Road::trial`].
    pub settled: f64,
    /// The gauges' derivatives with respect to v0; NaN before they are known.
    pub slopes: [f64; GAUGES],
    /// Whether they are of this problem, not of one like it.
    pub own: bool,
    /// Where the end was expected before this place was reached; NaN where it was not.
    pub expected: f64,
}

impl Place {
    /// Before anything is known of how it changes.
    pub(super) fn first(v0: f64, period: Period, gauges: [f64; GAUGES], settled: f64) -> Self {
        Self {
            v0,
            period,
            gauges,
            settled,
            slopes: [f64::NAN; GAUGES],
            own: true,
            expected: f64::NAN,
        }
    }

    /// By how much v0 has to grow until the first gauge vanishes, relative, and which one; +∞ where
    /// none comes to that.
    pub(super) fn gap(&self) -> (f64, usize) {
        let mut first = (f64::INFINITY, LOAD);
        for (i, (gauge, slope)) in self.gauges.iter().zip(&self.slopes).enumerate() {
            let gap = -gauge / slope / self.v0;
            if gap >= 0.0 && gap < first.0 {
                first = (gap, i);
            }
        }
        first
    }

    /// Where the end is expected; +∞ where none is.
    fn end(&self) -> f64 {
        self.v0 * (1.0 + self.gap().0)
    }

    /// Whether the end is near, and where it was expected before.
    fn agrees(&self) -> bool {
        let end = self.end();
        end / self.v0 - 1.0 < QUITE_NEAR && (end / self.expected - 1.0).abs() < AGREES
    }

    /// Whether it is near enough for slopes that are not its own.
    fn tells(&self) -> bool {
        let end = self.end();
        let as_expected = (end / self.expected - 1.0).abs() < AT_ONCE;
        self.own || as_expected && end / self.v0 - 1.0 < AT_ONCE
    }

    /// The next one.
    fn moved_to(&self, v0: f64, (period, gauges): (Period, [f64; GAUGES]), settled: f64) -> Self {
        let (mut slopes, mut own) = (self.slopes, self.own);
        // At the same v0 only the gauges are better known.
        if v0 > self.v0 {
            slopes = std::array::from_fn(|i| (gauges[i] - self.gauges[i]) / (v0 - self.v0));
            own = true;
        }
        Self {
            v0,
            period,
            gauges,
            settled,
            slopes,
            own,
            expected: self.end(),
        }
    }
}

/// Where the end is near, periods have to be settled to this.
pub(super) const SETTLED: f64 = 0.05;
/// The most by which periods that come to rest differ from one to the next, compared with the
/// difference before.
const CONTRACTION: f64 = 0.8;
/// Noise of the gauges, relative to themselves, and to v0 or to the forces and times of free
/// oscillation.
const NOISE: f64 = 1e-6;
/// The share of the way to the expected end that is taken at once.
const SHARE: f64 = 0.97;
/// The share of the way that is taken at once where slopes are those of a problem like it, and
/// transients are of the first order in the step.
const FIRST_SHARE: f64 = 0.7;

/// How settled a trial has to be after a step of v0.
fn needed(step: f64) -> f64 {
    match step {
        0.3.. => 0.2,
        0.02.. => 0.1,
        2e-3.. => SETTLED,
        _ => 0.4 * SETTLED,
    }
}

/// A trial beyond one that failed is made by a step this much smaller than the one that failed
/// there.
const SMALLER: f64 = 0.3;

/// How far the next trial may go, relative.
#[derive(Debug, Clone, Copy)]
struct Reach {
    most: f64,
    /// The v0 of the last trial that failed, unless one beyond it has not, and the step that led
    /// there.
    failed: Option<(f64, f64)>,
}

impl Reach {
    fn step(&self, v0: f64, wanted: f64) -> f64 {
        let step = wanted.min(self.most);
        let Some((failed, by)) = self.failed else {
            return step;
        };
        let room = failed / v0 - 1.0;
        if step < room || step <= SMALLER * by {
            step
        } else if room <= SMALLER * by {
            // It may have been the size of the step that failed there.
            SMALLER * by
        } else {
            0.5 * room
        }
    }

    fn failed(&mut self, v0: f64, step: f64) {
        self.failed = Some((v0, step));
        self.most = 0.5 * step;
    }

    fn succeeded(&mut self, v0: f64, step: f64) {
        self.most = (2.0 * self.most).min(LARGEST_STEP);
        if self.failed.is_some_and(|(failed, _)| failed <= v0) {
            (self.failed, self.most) = (None, 2.0 * step);
        }
    }
}

/// Raises v0 from a place towards where a gauge vanishes, by `most` at first; with the last place.
pub(super) fn climb(road: &mut impl Road, mut at: Place, most: f64) -> (Climbed, Place) {
    let mut reach = Reach { most, failed: None };
    let mut last = false;
    for _ in 0..MOST_TRIALS {
        let gap = at.gap().0;
        let mut step = reach.step(at.v0, if at.own { SHARE } else { FIRST_SHARE } * gap);
        if (step < SHARE * NEAR || at.agrees()) && at.tells() {
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
        match road.trial(next, Some(&at.period), settled) {
            Ran::Period(period, _) if step > JUMP && jumps(&at.period, &period, step) => {
                reach.failed(next, step);
            }
            Ran::Period(period, gauges) => {
                road.keep();
                at = at.moved_to(next, (period, gauges), settled);
                reach.succeeded(next, step);
                last = false;
            }
            // A start that is not sustained.
            Ran::Pass | Ran::LiftOff if step == 0.0 => return (Climbed::Unclear, at),
            Ran::Other if step < UNSETTLED => return (Climbed::Unclear, at),
            Ran::Over => return (Climbed::Unclear, at),
            Ran::Pass | Ran::LiftOff | Ran::Other => reach.failed(next, step),
        }
    }
    (Climbed::Unclear, at)
}

/// The largest relative step of v0 that may lead from one kind of stick-slip to another: v0 is
/// raised slowly.
pub(super) const JUMP: f64 = 1e-5;

/// Whether a relative `step` of v0 threw stick-slip from one kind to another: the mean cycle or the
/// mean slip of its period changed by more than such a step explains.
pub(super) fn jumps(before: &Period, after: &Period, step: f64) -> bool {
    let turns = |p: &Period| p.cycles().iter().map(|cycle| cycle.reversals).sum::<u32>();
    turns(before) != turns(after) || thrown(before.mean_times(), after.mean_times(), step)
}

/// Whether a relative `step` of v0 threw stick-slip from one kind to another, told from its mean
/// cycles and slips.
pub(super) fn thrown(before: [f64; 2], after: [f64; 2], step: f64) -> bool {
    let [period, slip] = [0, 1].map(|i| after[i] / before[i]);
    // Where sticks are not followed, slips tell.
    let same_period = period.is_nan() || (0.8 / (1.0 + step)..=1.25).contains(&period);
    !same_period || !(0.8..=1.4).contains(&slip)
}

/// Below this v0, over μ_S N0/√(κM), errors of the elongation are felt in the depth of a stop,
/// which is to be known compared with v0.
const SLOW: f64 = 0.03;

/// Above this v0, in the same units, what ends a slip is a difference of forces that falls as 1/v0,
/// of speeds that grow as v0.
const FAST: f64 = 1.0;

/// A finer integration, and how well an end has to be the same by it, relative.
const FINER: f64 = 1e-2;
const SAME_END: f64 = 1e-5;

/// Raises v0 as [`climb`] does, and once more from there with a finer integration where the end is
/// at a low v0, which it is not known at without; or where it is another one by it. An end that
/// only the coarse one has is unclear.
pub(super) fn climb_finely<R: Road + Clone>(
    road: &mut R,
    from: Place,
    most: f64,
) -> (Climbed, Place) {
    let (climbed, at) = climb(road, from, most);
    if matches!(climbed, Climbed::Unclear) {
        return (climbed, at);
    }
    let finer = |by: f64| Accuracy::of(GRAZE_TOLERANCE * by);
    if at.v0 < SLOW {
        road.refine(finer(at.v0 / SLOW));
        return climb_again(road, &at);
    }
    let roughly = road.clone();
    road.refine(finer(FINER * power(FAST / at.v0, 2).min(1.0)));
    if !ends_alike(road, &at) {
        let (again, finely) = climb_again(road, &at);
        if !matches!(again, Climbed::Unclear) {
            return (again, finely);
        }
        *road = roughly;
        return (again, at);
    }
    *road = roughly;
    (climbed, at)
}

/// Climbs the last bit of the way to the end near `at` once more.
fn climb_again(road: &mut impl Road, at: &Place) -> (Climbed, Place) {
    let v0 = at.v0 * (1.0 - BACK);
    let Ran::Period(period, gauges) = road.trial(v0, Some(&at.period), SETTLED) else {
        return (Climbed::Unclear, *at);
    };
    road.keep();
    let from = Place {
        slopes: at.slopes,
        ..Place::first(v0, period, gauges, SETTLED)
    };
    climb(road, from, BACK)
}

/// Whether what vanishes at the end of a climb says by the road as it is now that it ends where it
/// told before.
fn ends_alike(road: &mut impl Road, at: &Place) -> bool {
    let gauge = at.gap().1;
    match road.trial(at.v0, Some(&at.period), SETTLED) {
        Ran::Period(_, gauges) => {
            let moved = (gauges[gauge] - at.gauges[gauge]) / at.slopes[gauge] / at.v0;
            moved.abs() < SAME_END
        }
        _ => false,
    }
}

/// From so far below an end, relative, it is looked for once more.
const BACK: f64 = 2e-3;

/// What vanishes at the end of a climb.
fn arrived(at: &Place) -> Climbed {
    let (gap, gauge) = at.gap();
    let end = at.v0 * (1.0 + gap);
    // The load of periods that have not quite come to rest says less than the depth of their stops.
    let (near_graze, near_other) = match at.agrees() {
        true => (QUITE_NEAR, QUITE_NEAR),
        false => (10.0 * NEAR, NEAR),
    };
    match gauge {
        LOAD if gap < near_other => Climbed::LiftOff(end),
        STICK if gap < near_other => Climbed::Vanish(end),
        TURN | DIP if gap < near_graze => Climbed::Changes(end),
        slip if slip < LOAD && gap < near_graze => Climbed::Graze { v0: end, slip },
        _ => Climbed::Unclear,
    }
}
