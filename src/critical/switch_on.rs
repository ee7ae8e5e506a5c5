//! The critical velocity by the protocol `switch-on`: control is switched on at a phase of
//! uncontrolled stick-slip. The velocities v0 at which stick-slip survives this form windows.

use super::observers::Sticking;
use super::problem::Problem;
use super::regime::Regime;
use crate::model::elementary::pow;
use crate::slip::cycle::{NoCycle, UncontrolledCycle, restart_after_release};
use crate::slip::motion::{Accuracy, Motion};
use crate::slip::outcome::{Limits, Outcome};
use crate::slip::watch::follow;

/// How many times as many steps a motion may take whose readings are held.
const STEPS_OF_READINGS: u64 = 20;

/// When control is switched on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Phase {
    /// Control is switched on at this time after a release, modulo the uncontrolled period; in
    /// units of √(M/κ).
    After(f64),
    /// Control is switched on at this number of phases, evenly over the uncontrolled period:
    /// stick-slip survives if it does at one of them.
    Worst(u32),
}

/// The velocities that are tried, and how exactly edges are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scan {
    /// The smallest v0, in units of μ_S N0/√(κM).
    pub v_min: f64,
    /// The largest v0, in units of μ_S N0/√(κM).
    pub v_max: f64,
    /// The number of v0 that are tried before edges are refined, evenly spaced in logarithms.
    /// Windows narrower than the spacing can be missed.
    pub points: u32,
    /// The relative precision of edges.
    pub precision: f64,
    /// The most steps of the integrator at one v0.
    pub steps: u64,
    /// The most steps at all v0 together, some seconds: the scan ends there, undecided.
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

impl Scan {
    /// This scan without velocities beyond the limits of v of `problem`, and with more steps where
    /// every reading takes one.
    #[must_use]
    pub fn within(self, problem: &Problem) -> Self {
        let [least, most] = problem.feedback.limits.velocity;
        let unit = problem.law.mu_s();
        let more = match problem.feedback.is_sampled() {
            true => STEPS_OF_READINGS,
            false => 1,
        };
        Self {
            v_min: self.v_min.max(least / unit),
            v_max: self.v_max.min(most / unit),
            steps: more * self.steps,
            total_steps: more * self.total_steps,
            ..self
        }
    }
}

/// Where stick-slip survives.
#[derive(Debug, Clone, PartialEq)]
pub struct Windows {
    /// Windows of v0, from and to, increasing. The first begins at `v_min` if stick-slip survives
    /// there, the last ends at `v_max` likewise.
    pub survives: Vec<[f64; 2]>,
    /// The largest v0 at which stick-slip survived, and the smallest above it from which on it did
    /// not: both are the topmost edge where that is certain, else the velocities tried beside it.
    /// The first is 0 where it survives nowhere, the second NaN where there is none.
    pub top_within: [f64; 2],
    /// The smallest v0 at which N ≤ 0 occurs; none where it does not.
    pub v_liftoff: Option<f64>,
    /// Whether every v0 had an answer, and no edge is one of irregular stick-slip.
    pub decided: bool,
    /// Whether every v0 was tried within the steps allowed.
    pub complete: bool,
}

impl Windows {
    /// The topmost edge: above it, as far as v0 was tried, stick-slip does not survive. None where
    /// it survives nowhere.
    #[must_use]
    pub fn top(&self) -> Option<f64> {
        self.survives.last().map(|window| window[1])
    }
}

/// Tries one v0 after the other in the memory of one motion.
pub struct Trials<'p> {
    problem: &'p Problem,
    motion: Motion,
    accuracy: Accuracy,
    phase: Phase,
    steps: u64,
    /// Steps taken, with an estimate for uncontrolled cycles.
    spent: u64,
}

impl<'p> Trials<'p> {
    /// Trials of `problem` at `phase`.
    #[must_use]
    pub fn new(problem: &'p Problem, phase: Phase, accuracy: Accuracy, steps: u64) -> Self {
        Self {
            problem,
            motion: problem.at_rest(1.0, accuracy),
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
    pub fn at(&mut self, v0: f64) -> Regime {
        match self.phase {
            Phase::After(phase) => {
                let longest = self.problem.options.switch_on.longest;
                self.once(v0, phase, longest).0
            }
            Phase::Worst(phases) => self.worst(v0, phases),
        }
    }

    /// The worst regime of all phases, from worst to best: periodic stick-slip, irregular
    /// stick-slip, lift-off, undecided, ended.
    fn worst(&mut self, v0: f64, phases: u32) -> Regime {
        let long = self.problem.options.switch_on.longest;
        let (mut worst, period) = self.once(v0, 0.0, long);
        if period.is_nan() {
            // Without an uncontrolled cycle there are no phases.
            return worst;
        }
        let rank = |regime: Regime| match regime {
            Regime::Periodic => 4,
            Regime::Irregular => 3,
            Regime::LiftOff => 2,
            Regime::Undecided => 1,
            Regime::Slips | Regime::Ended | Regime::NoStickSlip => 0,
        };
        for i in 1..phases {
            if worst == Regime::Periodic {
                return worst;
            }
            // After an undecided phase the others are not followed for long.
            let longest = match worst {
                Regime::Undecided => 1.0,
                _ => long,
            };
            let phase = period * f64::from(i) / f64::from(phases);
            let (next, _) = self.once(v0, phase, longest);
            if rank(next) > rank(worst) {
                worst = next;
            }
        }
        worst
    }

    /// The regime at one phase, and the uncontrolled period. A slip is followed `longest` times as
    /// long as stick-slip is waited for to repeat.
    fn once(&mut self, v0: f64, phase: f64, longest: f64) -> (Regime, f64) {
        let parameters = self.problem.at(v0, 0.0);
        let restarted = restart_after_release(&mut self.motion, &parameters, self.accuracy, phase);
        let cycle = match restarted {
            Ok(cycle) => cycle,
            Err(NoCycle::NoStickSlip) => return (Regime::NoStickSlip, f64::NAN),
            Err(NoCycle::LongDelay) => return (Regime::Undecided, f64::NAN),
        };
        let patience = cycle.period() + self.problem.patience(v0, &self.problem.options.ramp);
        let limits = Limits {
            horizon: longest * patience,
            steps: self.steps,
            stable_abscissa: self.problem.stable_abscissa(v0),
            repeated: 1e-6,
            cycles: usize::MAX,
        };
        let slides = limits.stable_abscissa.is_some();
        let mut sticking = Sticking::new(patience, slides, &self.problem.options.switch_on);
        let summary = follow(&mut self.motion, &limits, &mut sticking);
        let cycles = 1.0 + self.problem.feedback.remembered() / cycle.period();
        self.spent += summary.steps + self.problem.options.switch_on.steps_of_cycle * cycles as u64;
        let regime = match summary.outcome {
            Outcome::Undecided if self.motion.is_lost() => Regime::Undecided,
            Outcome::Undecided if sticking.goes_on() => Regime::Irregular,
            Outcome::Undecided if sticking.calms_down() => Regime::Ended,
            outcome => Regime::of(outcome),
        };
        (regime, cycle.period())
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
        unit * scan.v_min * pow(scan.v_max / scan.v_min, share)
    };
    let mut walk = Walk::from((v0(0), trials.at(v0(0))));
    for i in 1..points {
        if trials.spent > scan.total_steps {
            walk.found.decided = false;
            walk.found.complete = false;
            walk.found.top_within[1] = f64::NAN;
            break;
        }
        let here = (v0(i), trials.at(v0(i)));
        walk.to(here, &mut trials, scan.precision);
    }
    walk.end()
}

/// A velocity, and the regime after switching on there.
type Tried = (f64, Regime);

/// What is found on the way from one velocity to the next.
struct Walk {
    before: Tried,
    /// Where the present window began.
    open: Option<f64>,
    found: Windows,
}

impl Walk {
    fn from(first: Tried) -> Self {
        let (v0, regime) = first;
        Self {
            before: first,
            open: regime.persists().then_some(v0),
            found: Windows {
                survives: Vec::new(),
                top_within: match regime {
                    _ if regime.persists() => [v0, f64::NAN],
                    Regime::Undecided => [0.0, f64::NAN],
                    _ => [0.0; 2],
                },
                v_liftoff: lifts(regime).then_some(v0),
                decided: regime != Regime::Undecided,
                complete: true,
            },
        }
    }

    /// Goes on to `here`.
    fn to(&mut self, here: Tried, trials: &mut Trials, precision: f64) {
        let before = std::mem::replace(&mut self.before, here);
        self.found.decided &= here.1 != Regime::Undecided;
        let within = &mut self.found.top_within;
        match here.1 {
            regime if regime.persists() => *within = [here.0, f64::NAN],
            Regime::Undecided => within[1] = f64::NAN,
            _ if within[1].is_nan() => within[1] = here.0,
            _ => {}
        }
        if before.1.persists() != here.1.persists() {
            let sides = edge(trials, (before, here), precision, Regime::persists);
            let certain = sides.iter().all(|side| certain(side.1));
            self.found.decided &= certain;
            let edge = between(sides);
            match self.open.take() {
                Some(from) => {
                    self.found.survives.push([from, edge]);
                    if certain && here.1 != Regime::Undecided {
                        self.found.top_within = [edge; 2];
                    }
                }
                None => self.open = Some(edge),
            }
        }
        if self.found.v_liftoff.is_none() && lifts(here.1) {
            let sides = edge(trials, (before, here), precision, lifts);
            self.found.v_liftoff = Some(between(sides));
        }
    }

    fn end(mut self) -> Windows {
        if let Some(from) = self.open {
            self.found.survives.push([from, self.before.0]);
        }
        self.found
    }
}

/// The two velocities on either side of a change of the answer, refined to `precision`.
fn edge(
    trials: &mut Trials,
    (mut low, mut high): (Tried, Tried),
    precision: f64,
    answer: impl Fn(Regime) -> bool,
) -> [Tried; 2] {
    let at_low = answer(low.1);
    while high.0 - low.0 > precision * high.0 {
        let middle = 0.5 * (low.0 + high.0);
        let regime = trials.at(middle);
        if answer(regime) == at_low {
            low = (middle, regime);
        } else {
            high = (middle, regime);
        }
    }
    [low, high]
}

fn between([low, high]: [Tried; 2]) -> f64 {
    0.5 * (low.0 + high.0)
}

const fn lifts(regime: Regime) -> bool {
    matches!(regime, Regime::LiftOff)
}

/// Whether an edge next to this regime is certain. Where stick-slip ends by chance, other rounding
/// errors move the edge.
const fn certain(regime: Regime) -> bool {
    !matches!(regime, Regime::Irregular | Regime::Undecided)
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::letters;
    use super::*;

    /// Without control sticks vanish at v0 = 4.1414.
    #[test]
    fn a_window_ends_where_sticks_vanish() {
        let problem = letters(0.0, 0.0, 1.0);
        let scan = Scan {
            v_min: 1.0,
            v_max: 10.0,
            points: 5,
            ..Scan::default()
        };
        let found = windows(&problem, Phase::After(0.0), &scan, Accuracy::of(1e-9));
        assert!(found.decided && found.complete && found.v_liftoff.is_none());
        assert_eq!((found.survives.len(), found.survives[0][0]), (1, 1.0));
        assert!((found.top().unwrap() - 4.1414).abs() < 1e-4, "{found:?}");
        assert_eq!(found.top_within, [found.top().unwrap(); 2]);
        let few = Scan {
            total_steps: 10,
            ..scan
        };
        let cut_off = windows(&problem, Phase::After(0.0), &few, Accuracy::of(1e-9));
        assert!(!cut_off.complete && !cut_off.decided);
    }

    /// In Fig. 3(a) at v0 = 0.3 some phases keep stick-slip, but switching on at the release does
    /// not.
    #[test]
    fn the_worst_phase_keeps_stick_slip() {
        let problem = letters(-0.33, 0.0, 4.15);
        let at = |phase| Trials::new(&problem, phase, Accuracy::of(1e-9), 50_000).at(0.3);
        assert_eq!(at(Phase::After(0.0)), Regime::Ended);
        assert_eq!(at(Phase::After(1.0)), Regime::Periodic);
        assert_eq!(at(Phase::Worst(8)), Regime::Periodic);
        // There is no uncontrolled stick-slip beyond 4.1414.
        let mut beyond = Trials::new(&problem, Phase::Worst(8), Accuracy::of(1e-9), 50_000);
        assert_eq!(beyond.at(5.0), Regime::NoStickSlip);
        assert!(beyond.uncontrolled_cycle(5.0).is_none());
        assert!(beyond.uncontrolled_cycle(0.35).is_some());
    }

    #[test]
    fn windows_begin_and_end_between_velocities() {
        let mut walk = Walk::from((1.0, Regime::Ended));
        assert!(walk.open.is_none() && walk.found.decided);
        walk.open = Some(1.5);
        walk.before = (2.0, Regime::Periodic);
        assert_eq!(walk.end().survives, [[1.5, 2.0]]);
        assert_eq!(Walk::from((1.0, Regime::Ended)).found.top_within, [0.0; 2]);
        let open = Walk::from((1.0, Regime::Irregular)).found.top_within;
        assert!(open[0] == 1.0 && open[1].is_nan());
        assert!(certain(Regime::Slips) && !certain(Regime::Irregular));
        assert!(lifts(Regime::LiftOff) && !lifts(Regime::Ended));
        assert_eq!(
            Walk::from((1.0, Regime::LiftOff)).found.v_liftoff,
            Some(1.0)
        );
    }
}
