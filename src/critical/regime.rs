//! The regime of stick-slip at one v0, by simulation.

use super::event_functions::{EventFunctions, MOST_SLIPS};
use super::observers::{Stops, Waiting};
use super::options::RampOptions;
use super::problem::Problem;
use crate::slip::motion::{Event, Motion};
use crate::slip::outcome::{Limits, Outcome, Summary};
use crate::slip::watch::follow;

/// What becomes of stick-slip at one v0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Stick-slip goes on, periodically.
    Periodic,
    /// Stick-slip went on for the whole waiting time, in cycles that do not repeat. It may still be
    /// lost by chance.
    Irregular,
    /// N ≤ 0.
    LiftOff,
    /// The block slips on and on, and comes no nearer to a stop.
    Slips,
    /// Stick-slip is lost: the block slides, oscillates or diverges.
    Ended,
    /// There is no stick-slip to begin with.
    NoStickSlip,
    /// Not known within the steps allowed, or too many cycles in a delay.
    Undecided,
}

impl Regime {
    /// Whether stick-slip persists.
    #[must_use]
    pub(crate) const fn persists(self) -> bool {
        matches!(self, Self::Periodic | Self::Irregular)
    }

    /// The regime of a motion with this outcome.
    pub(super) const fn of(outcome: Outcome) -> Self {
        match outcome {
            Outcome::StickSlip => Self::Periodic,
            Outcome::LiftOff => Self::LiftOff,
            Outcome::NoCycle => Self::NoStickSlip,
            Outcome::Sliding | Outcome::Oscillation | Outcome::Diverged => Self::Ended,
            Outcome::Undecided => Self::Undecided,
        }
    }
}

/// Stick-slip at one v0, followed until its regime is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Response {
    /// v0.
    pub v0: f64,
    /// The regime.
    pub regime: Regime,
    /// The motion's summary.
    pub summary: Summary,
    /// Time from the shallowest stop of the last period to the minimum of ẋ that it cut off, see
    /// [`crate::slip::step::Step::minimum_beyond_stop`].
    pub to_minimum: f64,
    /// How far below 0 the minimum of ẋ is that the shallowest stop cut off, ≥ 0.
    pub depth: f64,
}

impl Response {
    /// Whether this response and `other` are periodic, with the same number of slips in a period.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let periodic = |response: &Self| response.regime == Regime::Periodic;
        periodic(self) && periodic(other) && self.summary.slips == other.summary.slips
    }

    /// Whether stick-slip persists.
    pub(super) fn persists(&self) -> bool {
        self.regime.persists()
    }

    /// The event functions of this response, as far as simulation sees them: the depth of the
    /// shallowest stop, the smallest load, and the time of all sticks of a period together.
    pub(super) fn event_functions(&self) -> EventFunctions {
        let mut depth = [f64::NAN; MOST_SLIPS];
        depth[0] = self.depth;
        EventFunctions {
            depth,
            load: self.summary.n_min,
            stick_time: self.summary.stick_time,
            ..EventFunctions::UNKNOWN
        }
    }

    /// The durations of the mean cycle and slip of this response.
    pub(super) fn mean_times(&self) -> [f64; 2] {
        let slips = f64::from(self.summary.slips.max(1));
        [self.summary.period / slips, self.summary.slip_time / slips]
    }
}

/// How long a motion is followed at one v0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observation<'o> {
    pub options: &'o RampOptions,
    pub repeated: f64,
    pub waiting: Waiting,
}

impl<'o> Observation<'o> {
    /// The observation at `v0`, reached by a relative `step`.
    pub(super) fn after(options: &'o RampOptions, v0: f64, step: f64) -> Self {
        let how = Self::new(options, step);
        Self {
            waiting: match how.waiting {
                Waiting::Short if step <= options.final_step => Waiting::Lasting,
                Waiting::Short if v0 < options.glide => Waiting::Brief,
                waiting => waiting,
            },
            ..how
        }
    }

    /// The observation after a relative `step` of v0.
    pub(super) fn new(options: &'o RampOptions, step: f64) -> Self {
        let careful = step <= options.careful || !step.is_finite();
        Self {
            options,
            repeated: match careful || options.patient {
                true => options.repeated,
                false => options.roughly.max(options.repeated),
            },
            waiting: match options.patient {
                true => Waiting::Patient,
                false => Waiting::Short,
            },
        }
    }

    /// The observation after a relative `step` of v0, for as long as at the end of a search.
    pub(super) fn at_length(options: &'o RampOptions, step: f64) -> Self {
        Self {
            waiting: Waiting::Long,
            ..Self::new(options, step)
        }
    }
}

/// Stick-slip that can be followed at one v0 after the other: by simulation, or by a map in its
/// place.
pub(super) trait Followed: Clone {
    /// v0.
    fn v0(&self) -> f64;

    /// μ_S, the unit of start velocities and of the largest v0.
    fn unit(&self) -> f64;

    /// Becomes a copy of `other` in the memory that it has.
    fn copy_from(&mut self, other: &Self);

    /// Follows stick-slip at `v0` until its regime is known.
    fn response_at(&mut self, v0: f64, how: &Observation) -> Response;

    /// Goes on at its present v0 to the next phase of its cycle, a release or a stop. False where
    /// it reaches none within so many steps.
    fn next_phase(&mut self, steps: u32) -> bool;
}

/// A motion of a problem.
#[derive(Debug, Clone)]
pub(super) struct Simulated<'p> {
    pub problem: &'p Problem,
    pub motion: Motion,
}

impl Followed for Simulated<'_> {
    fn v0(&self) -> f64 {
        self.motion.parameters().v0
    }

    fn unit(&self) -> f64 {
        self.problem.law.mu_s()
    }

    fn copy_from(&mut self, other: &Self) {
        self.motion.copy_from(&other.motion);
    }

    fn response_at(&mut self, v0: f64, how: &Observation) -> Response {
        response_at(self.problem, &mut self.motion, v0, how)
    }

    fn next_phase(&mut self, steps: u32) -> bool {
        for _ in 0..steps {
            match self.motion.advance(f64::INFINITY) {
                Some(Event::Release | Event::Stick) => return true,
                Some(Event::LiftOff) => return false,
                _ if !self.motion.u.is_finite() => return false,
                _ => {}
            }
        }
        false
    }
}

/// Follows a motion at its present v0, for as long as at the end of a search.
pub(super) fn response_at_length(problem: &Problem, motion: &mut Motion) -> Response {
    let v0 = motion.parameters().v0;
    let how = Observation::at_length(&problem.options.ramp, 0.0);
    response_at(problem, motion, v0, &how)
}

/// Follows the motion at `v0` until its regime is known.
fn response_at(problem: &Problem, motion: &mut Motion, v0: f64, how: &Observation) -> Response {
    let options = how.options;
    if v0 != motion.parameters().v0 {
        motion.set_v0(v0);
    }
    let start = motion.t;
    let limits = Limits {
        horizon: start + problem.patience(v0, options),
        steps: (options.steps as f64 * problem.slower()) as u64,
        stable_abscissa: match how.waiting {
            Waiting::Patient => problem.stable_abscissa(v0),
            _ => None,
        },
        repeated: how.repeated,
        cycles: how.waiting.cycles(problem.feedback.remembered(), options),
    };
    let slides = problem.count(v0).stable();
    let mut stops = Stops::new(motion, slides, how.waiting, options);
    let summary = follow(motion, &limits, &mut stops);
    let cycles = stops.count as usize >= limits.cycles;
    let recent = cycles || motion.t - stops.last < options.recent * (motion.t - start);
    let regime = match summary.outcome {
        Outcome::Undecided if motion.is_lost() => Regime::Undecided,
        Outcome::Undecided if stops.count > 2 && recent => Regime::Irregular,
        Outcome::Undecided if stops.far() => Regime::Ended,
        Outcome::Undecided if stops.slips_on() => Regime::Slips,
        outcome => Regime::of(outcome),
    };
    let shallowest = stops.shallowest(summary.slips);
    Response {
        v0,
        regime,
        summary,
        to_minimum: shallowest.to_minimum,
        depth: shallowest.depth,
    }
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::letters;
    use super::*;
    use crate::slip::motion::Accuracy;

    #[test]
    fn outcomes_are_regimes() {
        let persists = Outcome::ALL.map(|outcome| Regime::of(outcome).persists());
        assert_eq!(persists.iter().filter(|persists| **persists).count(), 1);
        assert_eq!(Regime::of(Outcome::StickSlip), Regime::Periodic);
        assert_eq!(Regime::of(Outcome::Undecided), Regime::Undecided);
        assert_eq!(Regime::of(Outcome::Diverged), Regime::Ended);
        assert!(Regime::Irregular.persists() && !Regime::Slips.persists());
    }

    /// The letter's Fig. 3(a), whose stick-slip ends at 0.344467, and 3(b), at 0.021540.
    #[test]
    fn stick_slip_is_held_until_its_regime_is_known() {
        let problem = letters(-0.33, 0.0, 4.15);
        let options = problem.options.ramp;
        let mut block = Simulated {
            problem: &problem,
            motion: problem.released(0.2, Accuracy::of(1e-8)),
        };
        let how = Observation::new(&options, 0.0);
        let below = block.response_at(0.2, &how);
        assert_eq!((below.regime, below.summary.slips), (Regime::Periodic, 1));
        assert!(below.depth > 0.0 && below.to_minimum > 0.0);
        let again = block.response_at(0.21, &how);
        assert!(again.is_like(&below) && again.depth < below.depth);
        assert_eq!(block.v0(), 0.21);
        let beyond = block.response_at(0.4, &how);
        assert_eq!(beyond.regime, Regime::Slips);
        let patient = RampOptions {
            patient: true,
            ..options
        };
        let beyond = block.response_at(0.4, &Observation::new(&patient, 0.0));
        assert_eq!(beyond.regime, Regime::Ended);
        assert!(!beyond.is_like(&below));
        let load = letters(0.0, -10.0, 0.5);
        let mut motion = load.released(0.3, Accuracy::of(1e-8));
        assert_eq!(
            response_at_length(&load, &mut motion).regime,
            Regime::LiftOff
        );
    }

    #[test]
    fn how_long_is_waited_depends_on_the_step() {
        let options = RampOptions::default();
        let waiting = |v0, step| Observation::after(&options, v0, step).waiting;
        assert_eq!(waiting(0.3, 0.1), Waiting::Short);
        assert_eq!(waiting(0.3, 1e-3), Waiting::Lasting);
        let gliding = RampOptions {
            glide: 0.5,
            ..options
        };
        let after = |v0, step| Observation::after(&gliding, v0, step).waiting;
        assert_eq!(
            (after(0.3, 0.01), after(0.6, 0.01)),
            (Waiting::Brief, Waiting::Short)
        );
        let repeated = |step| Observation::new(&options, step).repeated;
        assert!(repeated(0.5) > repeated(0.01));
        assert_eq!(repeated(f64::INFINITY), repeated(0.0));
        assert_eq!(Observation::at_length(&options, 0.5).waiting, Waiting::Long);
    }
}
