//! The critical velocity by the protocol `switch-on`: control is switched on at a phase of uncontrolled stick-slip, and the
//! velocities v0 at which stick-slip survives that form windows.

use super::Problem;
use crate::slip::cycle::{NoCycle, UncontrolledCycle, restart_after_release};
use crate::slip::motion::{Accuracy, Motion};
use crate::slip::outcome::{Limits, Outcome, follow};

/// When control is switched on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Phase {
    /// That long after a release, modulo the uncontrolled period; in units of √(M/κ).
    After(f64),
    /// At each of so many phases, evenly over the uncontrolled period: stick-slip survives if it does for one of them.
    Worst(u32),
}

/// The velocities that are tried, and how exactly edges are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scan {
    /// The smallest v0, in units of μ_S N0/√(κM).
    pub v_min: f64,
    /// The largest one.
    pub v_max: f64,
    /// How many v0 are tried before edges are looked for, evenly in their logarithms: windows narrower than their distance
    /// can be missed.
    pub points: u32,
    /// Edges are known to this, relative.
    pub precision: f64,
    /// The most steps of the integrator at one v0.
    pub steps: u64,
    /// The most at all v0 together, some seconds: the scan ends there, undecided.
    pub total_steps: u64,
}

impl Default for Scan {
    fn default() -> Self {
        Self {
            v_min: 1e-3,
            v_max: 10.0,
            points: 401,
            precision: 1e-7,
            steps: 50_000,
            total_steps: 5_000_000,
        }
    }
}

/// What switching on comes to at one v0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Survival {
    /// Stick-slip goes on.
    Survives,
    /// It does not.
    Ends,
    /// N ≤ 0.
    LiftOff,
    /// There is no uncontrolled stick-slip at this v0.
    NoStickSlip,
    /// Not told within the steps allowed, or too many cycles in a delay.
    Undecided,
}

/// Where stick-slip survives.
#[derive(Debug, Clone, PartialEq)]
pub struct Windows {
    /// From and to, increasing; the first from is `v_min` where it survives there already, the last to `v_max` likewise.
    pub survives: Vec<[f64; 2]>,
    /// The smallest v0 at which N ≤ 0 occurs; none where it does not.
    pub v_liftoff: Option<f64>,
    /// Whether something was told at every v0.
    pub decided: bool,
}

impl Windows {
    /// The topmost edge: above it stick-slip does not survive. None where it does nowhere.
    #[must_use]
    pub fn top(&self) -> Option<f64> {
        self.survives.last().map(|window| window[1])
    }
}

/// About how many steps an uncontrolled cycle takes.
const STEPS_OF_A_CYCLE: u64 = 40;

/// Tries one v0 after the other in the memory of one motion.
pub struct Trials<'p> {
    problem: &'p Problem,
    motion: Motion,
    accuracy: Accuracy,
    phase: Phase,
    steps: u64,
    /// Steps taken, those of uncontrolled cycles at a guess.
    spent: u64,
}

impl<'p> Trials<'p> {
    /// For `problem` and `phase`.
    #[must_use]
    pub fn new(problem: &'p Problem, phase: Phase, accuracy: Accuracy, steps: u64) -> Self {
        Self {
            problem,
            motion: Motion::new(problem.at(1.0, 0.0), accuracy, 0.0, 0.0),
            accuracy,
            phase,
            steps,
            spent: 0,
        }
    }

    /// The uncontrolled cycle at `v0`; none where there is no stick-slip without control.
    pub fn uncontrolled_cycle(&mut self, v0: f64) -> Option<UncontrolledCycle> {
        let parameters = self.problem.at(v0, 0.0);
        restart_after_release(&mut self.motion, &parameters, self.accuracy, 0.0).ok()
    }

    /// What becomes of stick-slip at `v0`.
    pub fn at(&mut self, v0: f64) -> Survival {
        match self.phase {
            Phase::After(phase) => self.once(v0, phase).0,
            Phase::Worst(phases) => self.worst(v0, phases),
        }
    }

    /// Survives if it does at one phase; else what is told first of: lift-off, undecided, the end.
    fn worst(&mut self, v0: f64, phases: u32) -> Survival {
        let (mut worst, period) = self.once(v0, 0.0);
        if period.is_nan() {
            // Without an uncontrolled cycle there are no phases.
            return worst;
        }
        for i in 1..phases {
            if matches!(worst, Survival::Survives | Survival::NoStickSlip) {
                return worst;
            }
            let (next, _) = self.once(v0, period * f64::from(i) / f64::from(phases));
            worst = match (worst, next) {
                (_, Survival::Survives) => Survival::Survives,
                (Survival::LiftOff, _) | (_, Survival::LiftOff) => Survival::LiftOff,
                (Survival::Undecided, _) => Survival::Undecided,
                (_, next) => next,
            };
        }
        worst
    }

    /// At one phase, with the uncontrolled period.
    fn once(&mut self, v0: f64, phase: f64) -> (Survival, f64) {
        let parameters = self.problem.at(v0, 0.0);
        let restarted = restart_after_release(&mut self.motion, &parameters, self.accuracy, phase);
        let cycle = match restarted {
            Ok(cycle) => cycle,
            Err(NoCycle::NoStickSlip) => return (Survival::NoStickSlip, f64::NAN),
            Err(NoCycle::LongDelay) => return (Survival::Undecided, f64::NAN),
        };
        let limits = Limits {
            horizon: cycle.period() + self.problem.patience(v0),
            steps: self.steps,
            stable_abscissa: self.problem.stable_abscissa(v0),
            repeated: 1e-6,
            cycles: usize::MAX,
        };
        let summary = follow(&mut self.motion, &limits, &mut ());
        let cycles = 1.0 + self.problem.tau / cycle.period();
        self.spent += summary.steps + STEPS_OF_A_CYCLE * cycles as u64;
        let end = self.motion.t;
        let survival = match summary.outcome {
            Outcome::StickSlip => Survival::Survives,
            Outcome::LiftOff => Survival::LiftOff,
            Outcome::NoCycle => Survival::NoStickSlip,
            Outcome::Sliding | Outcome::Oscillation | Outcome::Diverged => Survival::Ends,
            // It was released not long ago: it still sticks from time to time.
            Outcome::Undecided if end - summary.last_release < 0.25 * end => Survival::Survives,
            Outcome::Undecided if end >= limits.horizon => Survival::Ends,
            Outcome::Undecided => Survival::Undecided,
        };
        (survival, cycle.period())
    }
}

/// The windows of v0 in which stick-slip of `problem` survives switching on at `phase`.
#[must_use]
pub fn windows(problem: &Problem, phase: Phase, scan: &Scan, accuracy: Accuracy) -> Windows {
    let mut trials = Trials::new(problem, phase, accuracy, scan.steps);
    let unit = problem.law.mu_s();
    let points = scan.points.max(2);
    let v0 = |i: u32| {
        let share = f64::from(i) / f64::from(points - 1);
        unit * scan.v_min * (scan.v_max / scan.v_min).powf(share)
    };
    let mut found = Windows {
        survives: Vec::new(),
        v_liftoff: None,
        decided: true,
    };
    let mut before = (v0(0), trials.at(v0(0)));
    found.decided = before.1 != Survival::Undecided;
    let mut open = (before.1 == Survival::Survives).then_some(before.0);
    for i in 1..points {
        if trials.spent > scan.total_steps {
            found.decided = false;
            break;
        }
        let here = (v0(i), trials.at(v0(i)));
        found.decided &= here.1 != Survival::Undecided;
        if (before.1 == Survival::Survives) != (here.1 == Survival::Survives) {
            let survives = |s| s == Survival::Survives;
            let edge = edge(&mut trials, before.0, here.0, scan.precision, survives);
            match open.take() {
                Some(from) => found.survives.push([from, edge]),
                None => open = Some(edge),
            }
        }
        if found.v_liftoff.is_none() {
            let lifts = |s| s == Survival::LiftOff;
            found.v_liftoff = match (lifts(before.1), lifts(here.1)) {
                (true, _) => Some(before.0),
                (false, true) => Some(edge(&mut trials, before.0, here.0, scan.precision, lifts)),
                (false, false) => None,
            };
        }
        before = here;
    }
    if let Some(from) = open {
        found.survives.push([from, before.0]);
    }
    found
}

/// Where between `low` and `high` the answer changes.
fn edge(
    trials: &mut Trials,
    mut low: f64,
    mut high: f64,
    precision: f64,
    answer: impl Fn(Survival) -> bool,
) -> f64 {
    let at_low = answer(trials.at(low));
    while high - low > precision * high {
        let middle = 0.5 * (low + high);
        if answer(trials.at(middle)) == at_low {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
