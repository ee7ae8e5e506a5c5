//! The critical velocity by simulation: stick-slip is followed while v0 is raised, carrying the state.

use super::Problem;
use crate::slip::motion::{Accuracy, Event, Motion};
use crate::slip::outcome::{Limits, Observer, Outcome, Summary, follow};

/// Where v0 starts, in order, until stick-slip is sustained there; in units of μ_S N0/√(κM).
pub const STARTS: [f64; 6] = [1e-2, 1e-1, 1e-3, 1e-4, 1e-5, 1e-6];

/// How stick-slip is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// The first relative step of v0.
    pub first: f64,
    /// The last relative step: v_c is known to it.
    pub last: f64,
    /// v0 up to which stick-slip is followed, in units of μ_S N0/√(κM).
    pub v_max: f64,
    /// How well cycles have to repeat, relative.
    pub repeated: f64,
    /// The most steps of the integrator at one v0.
    pub steps: u64,
    /// The most at all v0 together: some seconds.
    pub total_steps: u64,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            first: 0.6,
            repeated: 1e-6,
            last: 1e-6,
            v_max: 100.0,
            steps: 50_000,
            total_steps: 3_000_000,
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
    /// It sticks no more, or something else became of it.
    Lost(Outcome),
}

/// Sees how deep the last stop went beyond ẋ = 0, and when it was.
#[derive(Debug, Clone, Copy, Default)]
struct LastStop {
    t: f64,
    to_minimum: f64,
    depth: f64,
    stops: u32,
}

impl Observer for LastStop {
    fn step(&mut self, motion: &Motion, event: Option<Event>) {
        if event == Some(Event::Stick) {
            self.t = motion.t;
            (self.to_minimum, self.depth) = motion.last_step().minimum_beyond_stop();
            self.stops += 1;
        }
    }
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
    /// Time from the last stop to where it would have gone, see [`crate::slip::step::Step::minimum_beyond_stop`].
    pub to_minimum: f64,
    /// Depth of that.
    pub depth: f64,
}

impl Sustained {
    /// Whether it is periodic with one slip in a period.
    fn simple(&self) -> bool {
        self.fate == Fate::Periodic && self.summary.slips == 1
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
    /// The smallest v0, above it, at which it does not; none where it persists to the end of the range.
    pub lost: Option<Sustained>,
    /// Whether the search came to its end: to the end of the range, or to two v0 as near as asked for.
    pub complete: bool,
}

/// Follows stick-slip of `problem` from low v0 on.
#[must_use]
pub fn critical_velocity(problem: &Problem, pace: &Pace, accuracy: Accuracy) -> Followed {
    let scale = problem.law.mu_s();
    let mut lost = None;
    for start in STARTS {
        let v0 = start * scale;
        let mut motion = start_sticking(problem, v0, accuracy);
        let sustained = hold(problem, &mut motion, pace);
        if sustained.persists() {
            return raise(problem, motion, sustained, pace);
        }
        lost = lost.or(Some(sustained));
    }
    Followed {
        last: None,
        lost,
        complete: true,
    }
}

/// At the end of a stick without memory, with control.
fn start_sticking(problem: &Problem, v0: f64, accuracy: Accuracy) -> Motion {
    let mut motion = Motion::new(problem.at(v0, 0.0), accuracy, 0.0, 0.0);
    motion.release_from(problem.law.mu_s());
    motion
}

/// Stick-slip that does not repeat within so many cycles, and one more for every unit of the delay, is irregular.
const CYCLES: usize = 24;
/// The most v0 that are tried.
const MOST_TRIALS: u32 = 400;

/// Follows the motion at its v0 until its fate is known.
fn hold(problem: &Problem, motion: &mut Motion, pace: &Pace) -> Sustained {
    let v0 = motion.parameters().v0;
    let start = motion.t;
    let limits = Limits {
        horizon: start + problem.patience(v0),
        steps: pace.steps,
        stable_abscissa: problem.stable_abscissa(v0),
        repeated: pace.repeated,
        cycles: CYCLES + problem.tau as usize,
    };
    let mut last = LastStop::default();
    let summary = follow(motion, &limits, &mut last);
    let cycles = last.stops as usize >= limits.cycles;
    let recent = cycles || motion.t - last.t < 0.25 * (motion.t - start);
    let fate = match summary.outcome {
        Outcome::StickSlip => Fate::Periodic,
        Outcome::Undecided if last.stops > 2 && recent => Fate::Irregular,
        Outcome::LiftOff => Fate::LiftOff,
        outcome => Fate::Lost(outcome),
    };
    Sustained {
        v0,
        fate,
        summary,
        to_minimum: last.to_minimum,
        depth: last.depth,
    }
}

fn raise(problem: &Problem, mut motion: Motion, first: Sustained, pace: &Pace) -> Followed {
    let mut trial = motion.clone();
    let (mut before, mut last) = (None, first);
    let mut lost: Option<Sustained> = None;
    let mut most = pace.first;
    let end = pace.v_max * problem.law.mu_s();
    let mut complete = false;
    let mut spent = first.summary.steps;
    for _ in 0..MOST_TRIALS {
        if last.v0 >= end {
            complete = true;
            break;
        }
        let step = expected_step(before, &last).clamp(pace.last, most.max(pace.last));
        trial.copy_from(&motion);
        trial.set_v0((last.v0 * (1.0 + step)).min(end));
        let there = hold(problem, &mut trial, pace);
        spent += there.summary.steps;
        if spent > pace.total_steps {
            break;
        }
        if there.persists() && jumped(&last, &there, step) {
            most = 0.5 * step;
        } else if there.persists() {
            motion.copy_from(&trial);
            lost = lost.filter(|lost| lost.v0 > there.v0);
            (before, last) = (Some(last), there);
            most = (2.0 * most).min(pace.first);
        } else {
            lost = Some(there);
            most = 0.5 * step;
            if step <= pace.last {
                complete = true;
                break;
            }
        }
    }
    Followed {
        last: Some(last),
        lost,
        complete,
    }
}

/// Steps below this, relative, carry a motion along its attractor.
const CAREFUL: f64 = 0.02;
/// The largest step where cycles do not show whether it is the same attractor.
const LARGEST_UNSEEN: f64 = 0.1;

/// Whether a step of v0 may have thrown the motion from one kind of stick-slip to another: its cycle or its slip changed by more than
/// such a step explains.
fn jumped(last: &Sustained, there: &Sustained, step: f64) -> bool {
    if step <= CAREFUL {
        return false;
    }
    if !(last.simple() && there.simple()) {
        return step > LARGEST_UNSEEN;
    }
    let (before, after) = (&last.summary, &there.summary);
    let period = after.period / before.period;
    let slip = after.slip_time / before.slip_time;
    !(0.8 / (1.0 + step)..=1.25).contains(&period) || !(0.8..=1.4).contains(&slip)
}

/// The relative step to most of the way to where the depth of the stops is expected to vanish.
fn expected_step(before: Option<Sustained>, last: &Sustained) -> f64 {
    let Some(before) = before.filter(|before| before.simple() && last.simple()) else {
        return f64::INFINITY;
    };
    let slope = (last.depth - before.depth) / (last.v0 - before.v0);
    if slope > 0.0 {
        -0.9 * last.depth / slope / last.v0
    } else {
        f64::INFINITY
    }
}
