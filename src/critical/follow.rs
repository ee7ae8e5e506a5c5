//! The critical velocity by simulation: stick-slip is followed while v0 is raised, carrying the
//! state.

use super::climb::JUMP;
use super::problem::Problem;
use super::stops::{Stops, Waiting};
use super::trend::{expected_way, jumps, vanishes, ways};
use crate::slip::motion::{Accuracy, Motion};
use crate::slip::outcome::{Limits, Outcome, Summary, follow};

/// Where v0 starts, in order, until stick-slip is sustained there; in units of μ_S N0/√(κM).
pub const STARTS: [f64; 6] = [1e-2, 1e-1, 1e-3, 1e-4, 1e-5, 1e-6];

/// How stick-slip is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// The first relative step of v0.
    pub first: f64,
    /// The largest one.
    pub largest: f64,
    /// The largest one where cycles do not show whether stick-slip is of the same kind.
    pub unseen: f64,
    /// The last relative step: v_c is known to it.
    pub last: f64,
    /// Up to this v0, in the units of a motion, v0 glides: it is held for a few cycles only, and
    /// what stick-slip comes to there is not waited for. 0 where every v0 is held.
    pub glide: f64,
    /// The most v0 that are tried.
    pub trials: u32,
    /// v0 up to which stick-slip is followed, in units of μ_S N0/√(κM).
    pub v_max: f64,
    /// How well cycles have to repeat near the end, relative.
    pub repeated: f64,
    /// The most steps of the integrator at one v0.
    pub steps: u64,
    /// The most at all v0 together: some seconds.
    pub total_steps: u64,
    /// Whether the search ends where stick-slip has come to repeat.
    pub until_periodic: bool,
    /// Whether every loss of stick-slip is waited for until the outcome of the motion is known.
    /// Else it counts once the minima of ẋ no longer fall, and only the last one is waited for
    /// longer.
    pub patient: bool,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            first: 0.6,
            largest: 0.6,
            unseen: 0.1,
            repeated: 1e-6,
            last: 1e-6,
            glide: 0.0,
            trials: 400,
            v_max: 100.0,
            steps: 50_000,
            total_steps: 3_000_000,
            until_periodic: false,
            patient: false,
        }
    }
}

/// What stick-slip came to at one v0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fate {
    /// Periodic stick-slip.
    Periodic,
    /// It sticks again and again, in cycles that did not come to repeat.
    Irregular,
    /// N ≤ 0.
    LiftOff,
    /// It slips on and on, and comes no nearer to a stop.
    Slips,
    /// It sticks no more, or something else became of it.
    Lost(Outcome),
}

/// Stick-slip at one v0, followed to its fate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sustained {
    /// v0.
    pub v0: f64,
    /// What it came to.
    pub fate: Fate,
    /// The motion's summary.
    pub summary: Summary,
    /// Time from the shallowest stop of the last period to where it would have gone, see
    /// [`crate::slip::step::Step::minimum_beyond_stop`].
    pub to_minimum: f64,
    /// Depth of that.
    pub depth: f64,
}

impl Sustained {
    /// Whether it and `other` are periodic with as many slips in a period.
    pub(super) fn alike(&self, other: &Self) -> bool {
        let periodic = |s: &Self| s.fate == Fate::Periodic;
        periodic(self) && periodic(other) && self.summary.slips == other.summary.slips
    }

    /// Whether stick-slip persists.
    #[must_use]
    pub fn persists(&self) -> bool {
        matches!(self.fate, Fate::Periodic | Fate::Irregular)
    }
}

/// How a search by simulation ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Followed {
    /// The largest v0 at which stick-slip persists; none where it was not found anywhere.
    pub last: Option<Sustained>,
    /// The smallest v0, above it, at which it does not; none where it persists to the end of the
    /// range.
    pub lost: Option<Sustained>,
    /// Whether the search came to its end: to the end of the range, or to two v0 as near as asked
    /// for.
    pub complete: bool,
    /// Whether stick-slip survived again and again where it had been lost: it is thrown off by
    /// chance.
    pub creeps: bool,
    /// Whether sticks become shorter such that none is left just beyond the last v0.
    pub vanish: bool,
    /// The relative way beyond the last v0 to where the depth of the stops is expected to vanish;
    /// infinite where it is not.
    pub graze_way: f64,
}

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
    let mut motion = Motion::new(problem.at(v0, 0.0), accuracy, 0.0, 0.0);
    motion.release_from(problem.law.mu_s());
    motion
}

/// Relative steps of v0 no larger than this look for an end: irregular stick-slip is held for long.
const FINAL_STEP: f64 = 2e-3;
/// How well cycles have to repeat after a large step of v0.
const ROUGHLY: f64 = 1e-4;

/// How long a motion is followed at one v0.
#[derive(Debug, Clone, Copy)]
struct Holding {
    repeated: f64,
    steps: u64,
    waiting: Waiting,
}

impl Holding {
    /// At `v0`, after a relative step to it.
    fn after(pace: &Pace, v0: f64, step: f64) -> Self {
        let how = Self::new(pace, step);
        Self {
            waiting: match how.waiting {
                Waiting::Short if step <= FINAL_STEP => Waiting::Lasting,
                Waiting::Short if v0 < pace.glide => Waiting::Brief,
                waiting => waiting,
            },
            ..how
        }
    }

    /// After a relative step of v0.
    fn new(pace: &Pace, step: f64) -> Self {
        Self {
            repeated: match step > CAREFUL && step.is_finite() && !pace.patient {
                true => ROUGHLY.max(pace.repeated),
                false => pace.repeated,
            },
            steps: pace.steps,
            waiting: match pace.patient {
                true => Waiting::Patient,
                false => Waiting::Short,
            },
        }
    }
}

/// What becomes of a motion at `v0`, waited for as long as at the end of a search.
pub fn fate(problem: &Problem, motion: &mut Motion, v0: f64) -> Sustained {
    let how = Holding {
        waiting: Waiting::Long,
        ..Holding::new(&Pace::default(), 0.0)
    };
    hold(problem, motion, v0, &how)
}

/// Follows the motion at `v0` until its fate is known.
fn hold(problem: &Problem, motion: &mut Motion, v0: f64, how: &Holding) -> Sustained {
    if v0 != motion.parameters().v0 {
        motion.set_v0(v0);
    }
    let start = motion.t;
    let limits = Limits {
        horizon: start + problem.patience(v0),
        steps: how.steps,
        stable_abscissa: match how.waiting {
            Waiting::Patient => problem.stable_abscissa(v0),
            _ => None,
        },
        repeated: how.repeated,
        cycles: how.waiting.cycles(problem.tau),
    };
    let slides = problem.count(v0).stable();
    let mut stops = Stops::new(motion, slides, how.waiting);
    let summary = follow(motion, &limits, &mut stops);
    let cycles = stops.count as usize >= limits.cycles;
    let recent = cycles || motion.t - stops.last < 0.25 * (motion.t - start);
    let fate = match summary.outcome {
        Outcome::StickSlip => Fate::Periodic,
        Outcome::Undecided if motion.outgrows_its_past() => Fate::Lost(Outcome::Undecided),
        Outcome::Undecided if stops.count > 2 && recent => Fate::Irregular,
        Outcome::Undecided if stops.far() => Fate::Lost(Outcome::Diverged),
        Outcome::Undecided if stops.slips_on() => Fate::Slips,
        Outcome::LiftOff => Fate::LiftOff,
        outcome => Fate::Lost(outcome),
    };
    let (to_minimum, depth) = stops.shallowest(summary.slips);
    Sustained {
        v0,
        fate,
        summary,
        to_minimum,
        depth,
    }
}

/// A search while v0 is raised.
struct Climb<'p> {
    problem: &'p Problem,
    pace: Pace,
    /// The motion at `last`.
    motion: Motion,
    trial: Motion,
    before: Option<Sustained>,
    last: Sustained,
    /// The smallest v0 above `last` at which stick-slip was lost, and the relative step that lost
    /// it.
    lost: Option<(Sustained, f64)>,
    /// The smallest v0 above `last` to which the step was too large for what it led to.
    jump: Option<f64>,
    /// The largest relative step for now.
    most: f64,
    /// The share of the way to where stick-slip is expected to end that is taken at once.
    share: f64,
    /// From where on, and how often since, stick-slip survived where it had been lost.
    passed: (f64, u32),
    /// Whether the last steps shortened the sticks as if none were left soon.
    vanish: bool,
    /// Whether irregular stick-slip or a jump was on the way.
    chance: bool,
    spent: u64,
}

fn raise(problem: &Problem, motion: &mut Motion, first: Sustained, pace: &Pace) -> Followed {
    let mut climb = Climb {
        problem,
        pace: *pace,
        trial: motion.clone(),
        motion: motion.clone(),
        before: None,
        last: first,
        lost: None,
        jump: None,
        most: pace.first,
        share: SHARE,
        passed: (0.0, 0),
        vanish: false,
        chance: first.fate == Fate::Irregular,
        spent: first.summary.steps,
    };
    let complete = climb.run();
    climb.classify();
    std::mem::swap(motion, &mut climb.motion);
    Followed {
        last: Some(climb.last),
        lost: climb.lost.map(|(lost, _)| lost),
        complete,
        creeps: climb.creeps(),
        vanish: climb.vanish,
        graze_way: ways(climb.before, &climb.last)[0],
    }
}

impl Climb<'_> {
    /// Raises v0 until two v0 as near as asked for differ in their fate; false where that takes too
    /// long.
    fn run(&mut self) -> bool {
        let end = self.pace.v_max * self.problem.law.mu_s();
        for _ in 0..self.pace.trials {
            let repeats = self.pace.until_periodic && self.last.fate == Fate::Periodic;
            if self.last.v0 >= end || repeats {
                return true;
            }
            let step = self.next_step();
            if self.lost.is_some() && step < 0.75 * self.precision() {
                if self.is_lost() {
                    return true;
                }
                continue;
            }
            let v0 = (self.last.v0 * (1.0 + step)).min(end);
            // To the last bit, where it is tried once more.
            let again = self.lost.map(|(lost, _)| lost.v0);
            let again = again.filter(|lost| (v0 / lost - 1.0).abs() < 1e-12);
            self.attempt(again.unwrap_or(v0), step);
            if self.spent > self.pace.total_steps {
                return false;
            }
        }
        false
    }

    /// Looks longer whether irregular stick-slip repeats where it was last.
    fn classify(&mut self) {
        if self.last.fate == Fate::Irregular && !self.pace.patient {
            let how = Holding {
                waiting: Waiting::Long,
                ..Holding::new(&self.pace, 0.0)
            };
            let again = hold(self.problem, &mut self.motion, self.last.v0, &how);
            if again.persists() {
                self.last = again;
            }
        }
    }

    /// Where cycles do not repeat, one v0 after the other persists and is lost by chance on the
    /// last bit of the way.
    fn precision(&self) -> f64 {
        match self.last.fate {
            Fate::Irregular => self.pace.last.max(LAST_IRREGULAR),
            _ => self.pace.last,
        }
    }

    /// Whether stick-slip was lost again and again on a short way: steps however short throw it off
    /// by chance.
    fn creeps(&self) -> bool {
        self.passed.1 >= MOST_PASSED
    }

    /// Where it had been lost at `v0`, it was not from nearby.
    fn pass(&mut self, v0: f64) {
        let (from, times) = self.passed;
        self.passed = match v0 > from * (1.0 + SHORT_WAY) {
            true => (v0, 1),
            false => (from, times + 1),
        };
        self.lost = None;
    }

    /// How far the next v0 is from the last, relative.
    fn next_step(&self) -> f64 {
        let mut step = self.share * expected_way(self.before, &self.last);
        if self.last.fate == Fate::Irregular {
            step = step.min(self.pace.unseen);
        }
        let mut step = step.clamp(self.pace.last, self.most.max(self.pace.last));
        if let Some(jump) = self.jump {
            let room = jump / self.last.v0 - 1.0;
            step = step.min(if room > 2.0 * JUMP { 0.5 * room } else { room });
        }
        let Some((lost, by)) = &self.lost else {
            return step;
        };
        let room = lost.v0 / self.last.v0 - 1.0;
        if room <= NEARBY * *by && !self.creeps() {
            // Once more from nearby: it may have been the size of the step that lost it.
            return step.min(room);
        }
        step.min(0.5 * room)
    }

    /// The largest relative step of v0 that may lead from the last place to `there`, where it took
    /// `step`.
    fn largest_step(&self, there: &Sustained, step: f64) -> f64 {
        let last = &self.last;
        match (last.fate, there.fate) {
            (Fate::Periodic, Fate::Periodic) if last.alike(there) && !jumps(last, there, step) => {
                f64::INFINITY
            }
            // Once chance has a part in it nothing is gained by that.
            _ if self.chance => self.pace.unseen,
            (Fate::Periodic, Fate::Periodic) if jumps(last, there, step) => JUMP,
            (Fate::Periodic, Fate::Irregular) => CAREFUL,
            _ => self.pace.unseen,
        }
    }

    /// Tries `v0`, a relative `step` away.
    fn attempt(&mut self, v0: f64, step: f64) {
        self.trial.copy_from(&self.motion);
        let how = Holding::after(&self.pace, v0, step);
        let there = hold(self.problem, &mut self.trial, v0, &how);
        self.spent += there.summary.steps;
        if !there.persists() {
            if self.lost.is_none_or(|(lost, _)| v0 <= lost.v0) {
                self.lost = Some((there, step));
            }
            // Near its end stick-slip attracts from less and less far: steps have to shrink with
            // the way that is left.
            let taken = step / expected_way(self.before, &self.last);
            if taken > LEAST_SHARE {
                self.share = (0.5 * taken).clamp(LEAST_SHARE, self.share);
            }
            self.most = 0.5 * step;
        } else if step > self.largest_step(&there, step) {
            self.most = 0.5 * step;
            self.jump = Some(v0);
        } else {
            let jumped = there.fate == Fate::Irregular || jumps(&self.last, &there, step);
            self.chance |= jumped;
            std::mem::swap(&mut self.motion, &mut self.trial);
            self.jump = self.jump.filter(|jump| *jump > v0 && !jumped);
            let passed = self.lost.is_some_and(|(lost, _)| lost.v0 <= v0);
            if passed {
                self.pass(v0);
            }
            self.vanish |= self.last.alike(&there) && vanishes(&self.last, &there);
            (self.before, self.last) = (Some(self.last), there);
            // What failed there was the size of the step: the steps from here on grow slowly.
            self.most = if passed { 2.0 * step } else { 2.0 * self.most };
            self.most = self.most.min(self.pace.largest);
        }
    }

    /// Whether stick-slip really is lost where it was last: waits longer. If not, goes on from
    /// there.
    fn is_lost(&mut self) -> bool {
        let slips = |(lost, _): &(Sustained, f64)| lost.fate == Fate::Slips;
        let Some((lost, by)) = self.lost.filter(slips).filter(|_| !self.creeps()) else {
            return true;
        };
        let how = Holding {
            waiting: Waiting::Long,
            ..Holding::new(&self.pace, by)
        };
        self.trial.copy_from(&self.motion);
        let there = hold(self.problem, &mut self.trial, lost.v0, &how);
        self.spent += there.summary.steps;
        if !there.persists() {
            self.lost = Some((there, by));
            return true;
        }
        std::mem::swap(&mut self.motion, &mut self.trial);
        self.most = 2.0 * (there.v0 / self.last.v0 - 1.0);
        (self.before, self.last) = (None, there);
        self.pass(there.v0);
        false
    }
}

/// Steps below this, relative, carry a motion along its attractor.
const CAREFUL: f64 = 0.02;
/// Where stick-slip was lost is tried once more from this much nearer.
const NEARBY: f64 = 0.15;
/// Surviving so often where it had been lost, on so short a way, stick-slip creeps.
const MOST_PASSED: u32 = 6;
const SHORT_WAY: f64 = 1e-3;
/// The last relative step from irregular stick-slip.
const LAST_IRREGULAR: f64 = 2e-5;

/// The share of the expected way that is taken at first, and at least.
const SHARE: f64 = 0.9;
const LEAST_SHARE: f64 = 0.2;
