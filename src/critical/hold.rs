//! What stick-slip comes to where v0 is held.

use super::pace::{Fate, Pace, Sustained};
use super::problem::Problem;
use super::stops::{Stops, Waiting};
use crate::slip::motion::Motion;
use crate::slip::outcome::{Limits, Outcome};
use crate::slip::watch::follow;

/// Steps below this, relative, carry a motion along its attractor.
pub(super) const CAREFUL: f64 = 0.02;
/// Relative steps of v0 no larger than this look for an end: irregular stick-slip is held for long.
const FINAL_STEP: f64 = 2e-3;
/// How well cycles have to repeat after a large step of v0.
const ROUGHLY: f64 = 1e-4;

/// How long a motion is followed at one v0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Holding {
    pub repeated: f64,
    pub steps: u64,
    pub waiting: Waiting,
}

impl Holding {
    /// At `v0`, after a relative step to it.
    pub(super) fn after(pace: &Pace, v0: f64, step: f64) -> Self {
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
    pub(super) fn new(pace: &Pace, step: f64) -> Self {
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
pub(super) fn fate(problem: &Problem, motion: &mut Motion, v0: f64) -> Sustained {
    let how = Holding {
        waiting: Waiting::Long,
        ..Holding::new(&Pace::default(), 0.0)
    };
    hold(problem, motion, v0, &how)
}

/// Follows the motion at `v0` until its fate is known.
pub(super) fn hold(problem: &Problem, motion: &mut Motion, v0: f64, how: &Holding) -> Sustained {
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
