//! v0 is raised to where stick-slip ends, by steps that grow and are halved.

use super::climb::JUMP;
use super::hold::{CAREFUL, Holding, hold};
use super::pace::{Fate, Followed, Pace, Sustained};
use super::problem::Problem;
use super::stops::Waiting;
use super::trend::{expected_way, jumps, vanishes, ways};
use crate::slip::motion::Motion;

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

pub(super) fn raise(
    problem: &Problem,
    motion: &mut Motion,
    first: Sustained,
    pace: &Pace,
) -> Followed {
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
