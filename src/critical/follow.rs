//! The protocol `follow`: the largest v0 at which stick-slip persists while v0 is raised slowly, by
//! the first method that leads to it.
//!
//! One kind of stick-slip after the other is continued to the event where it ends or changes into
//! the next kind. Irregular stick-slip in between is crossed by simulation.

use super::after_event::sequel;
use super::bracket::bounded;
use super::confirmation::{confirmed, gliding, told};
use super::continuation::{Point, continue_to_checked_event, is_jump};
use super::delay_step::Neighbour;
use super::end_of_branch::{approach, verify};
use super::memoryless::end_without_memory;
use super::options::RampOptions;
use super::problem::{CriticalVelocity, Method, NoStart, Problem};
use super::ramp;
use super::regime::Regime;
use super::return_map::NoReturn;
use super::search::Search;
use super::transition::{Ending, Sequel, Transition};
use super::with_history::WithHistory;
use crate::slip::motion::{Accuracy, Motion};

/// The largest v0 at which stick-slip of `problem` persists while v0 is raised from low values:
/// protocol `follow`.
#[must_use]
pub fn critical_velocity(problem: &Problem) -> CriticalVelocity {
    from_scratch(problem).0.within_limits(problem)
}

/// The critical velocity, and the neighbour from which continuation along the delay may start.
pub(super) fn from_scratch(problem: &Problem) -> Found<'_> {
    if problem.persists_without_control() {
        let persists = Transition::Persists;
        let critical = CriticalVelocity::nothing(f64::NAN, persists, Method::Simulation);
        return (bounded(problem, critical, Vec::new(), &[]), None);
    }
    if problem.feedback.is_sampled() {
        // The return map knows no readings.
        let (critical, searches) = simulated(problem);
        return (bounded(problem, critical, searches, &[]), None);
    }
    let found = problem.at_first_start(|v0| from_start(problem, v0));
    found.unwrap_or_else(|| {
        let (critical, searches) = simulated(problem);
        (bounded(problem, critical, searches, &[]), None)
    })
}

/// The critical velocity of stick-slip that is sustained at the start velocity `v0`.
fn from_start(problem: &Problem, v0: f64) -> Result<Found<'_>, NoStart> {
    let options = &problem.options.continuation;
    let accuracy = Accuracy::of(options.tolerance);
    let larger = v0 > problem.options.ramp.starts[0] * problem.law.mu_s();
    match end_without_memory(problem, v0, accuracy) {
        Ok(Some(ending)) => {
            let critical = ending.critical_velocity(Method::GrazeSlip);
            return Ok((bounded(problem, critical, Vec::new(), &[]), None));
        }
        Err(NoReturn::LiftOff) => return Err(NoStart::LiftOff),
        // Such a start is simulated only where no start leads to stick-slip.
        Err(NoReturn::StopMissed) if !larger => return Err(NoStart::NotSustained),
        Ok(None) | Err(_) => {}
    }
    let [crossing_step, other_step] = problem.options.transition.crossing_steps;
    let mut kinds = Kinds {
        problem,
        crossing_step,
        entry: None,
        searches: Vec::new(),
        way: Vec::new(),
    };
    let mut others = Vec::new();
    // At a larger start velocity than the first the block may stick once and not again.
    let (mut critical, mut neighbour) = match WithHistory::released(problem, v0, accuracy) {
        Ok((branch, first)) if !larger => kinds.end(branch, first, options.largest_step),
        Err(NoReturn::LiftOff) => return Err(NoStart::LiftOff),
        Ok(_) | Err(_) => kinds.start(problem.released(v0, accuracy))?,
    };
    if let Some(entry) = kinds.entry.take()
        && critical.decided
    {
        kinds.crossing_step = other_step;
        let again = kinds.again((*entry).clone());
        let glided = kinds.glide(*entry, &critical);
        critical.decided = critical.ends_like(&again) && critical.ends_like(&glided);
        others = vec![again, glided];
    }
    let bounded = bounded(problem, critical, kinds.searches, &others);
    if let Some(neighbour) = &mut neighbour {
        // Slow searches may have come to another end.
        neighbour.decided = bounded.decided && bounded.ends_like(&critical);
    }
    Ok((bounded, neighbour))
}

/// Stick-slip from which simulation has to go on: motions at lower and lower v0, each used if the
/// one before is not sustained. The first relative steps of v0 are `step` times those of a search
/// from low v0.
struct Handover {
    motions: Vec<Motion>,
    step: f64,
}

/// The critical velocity, and the neighbour from which continuation along the delay may start.
type Found<'p> = (CriticalVelocity, Option<Neighbour<'p>>);

/// The critical velocity by simulation, and the searches that gave it.
type Searched = (CriticalVelocity, Vec<Search>);

/// One kind of stick-slip after the other.
struct Kinds<'p> {
    problem: &'p Problem,
    /// The largest step through irregular stick-slip.
    crossing_step: f64,
    /// The state in which irregular stick-slip was first met.
    entry: Option<Box<Motion>>,
    /// The searches by simulation that came to an end.
    searches: Vec<Search>,
    /// The slips in a period of each kind on the way, and 0 for irregular stick-slip.
    way: Vec<usize>,
}

impl<'p> Kinds<'p> {
    /// The end of stick-slip from a point of a branch on, with this first relative `step` of v0.
    fn end(&mut self, branch: WithHistory<'p, Motion>, at: Point, step: f64) -> Found<'p> {
        match self.follow(branch, at, step) {
            Ok(found) => found,
            Err(handover) => (self.simulated_from(handover), None),
        }
    }

    fn simulated_from(&mut self, handover: Handover) -> CriticalVelocity {
        let (critical, searches) = simulated_from(self.problem, handover);
        self.searches.extend(searches);
        critical
    }

    /// The end of stick-slip from a block that may not be in stick-slip at all.
    fn start(&mut self, mut motion: Motion) -> Result<Found<'p>, NoStart> {
        match sequel(self.problem, &mut motion) {
            Sequel::Ends(_) => Err(NoStart::NotSustained),
            Sequel::Periodic(slips) => Ok(self.end_of(motion, slips)),
            // No branch begins there.
            Sequel::Irregular | Sequel::Undetermined(_) => {
                let (critical, searches) = simulated(self.problem);
                self.searches.extend(searches);
                Ok((critical, None))
            }
        }
    }

    /// The end of the stick-slip of a motion with `slips` slips in a period.
    fn end_of(&mut self, motion: Motion, slips: usize) -> Found<'p> {
        let step = self.problem.options.continuation.first_step;
        let mut branch = WithHistory::in_stick_slip(self.problem, motion, slips);
        if let Some(first) = branch.first_point() {
            return self.end(branch, first, step);
        }
        let motions = vec![branch.map().clone()];
        let handover = Handover { motions, step };
        (self.simulated_from(handover), None)
    }

    fn follow(
        &mut self,
        mut branch: WithHistory<'p, Motion>,
        mut from: Point,
        mut step: f64,
    ) -> Result<Found<'p>, Handover> {
        let options = &self.problem.options.continuation;
        self.pass(from.orbit.period.cycles().len());
        for _ in 0..options.most_kinds {
            let start = branch.map().clone();
            let (located, at) = continue_to_checked_event(&mut branch, from, step, options);
            let ending = located
                .and_then(|located| approach(&mut branch, located, &at, &self.problem.options));
            let seen = ending.map(|ending| (ending, verify(self.problem, &mut branch, &ending)));
            let (sequel, motion, beyond) = match seen {
                Ok((ending, Sequel::Ends(_))) => {
                    return Ok(self.ended(branch, at, &ending));
                }
                Ok((ending, Sequel::Undetermined(_))) if ending.event.may_end() => {
                    look_beyond(self.problem, &branch, &at)
                }
                Ok((_, sequel)) => (sequel, branch.tried().clone(), options.first_step),
                Err(_) => look_beyond(self.problem, &branch, &at),
            };
            let handover = |branch: &WithHistory<'p, Motion>, step| Handover {
                motions: [branch.map().clone(), start.clone()].to_vec(),
                step,
            };
            let next = match sequel {
                Sequel::Irregular => self.cross(motion),
                Sequel::Periodic(slips) => Ok((motion, slips)),
                Sequel::Ends(_) => return Err(handover(&branch, beyond)),
                Sequel::Undetermined(_) => return Err(handover(&branch, options.first_step)),
            };
            let (motion, slips) = match next {
                Ok(next) => next,
                Err(critical) => return Ok((critical, None)),
            };
            let next = WithHistory::in_stick_slip(self.problem, motion, slips);
            let before = std::mem::replace(&mut branch, next);
            let Some(first) = branch.first_point() else {
                return Err(handover(&before, options.first_step));
            };
            let jumps = is_jump(&at.orbit.period, &first.orbit.period, 0.0, options);
            step = match jumps {
                true => options.first_step,
                false => options.step_past_graze,
            };
            if jumps || slips != at.orbit.period.cycles().len() {
                self.pass(slips);
            }
            from = first;
        }
        Err(Handover {
            motions: vec![branch.map().clone()],
            step: options.first_step,
        })
    }

    /// Notes one more kind on the way. Kinds after irregular stick-slip do not count: chance
    /// selects them.
    fn pass(&mut self, slips: usize) {
        if self.entry.is_none() {
            self.way.push(slips);
        }
    }

    /// The critical velocity at an ending of the last kind of stick-slip.
    fn ended(&self, branch: WithHistory<'p, Motion>, at: Point, ending: &Ending) -> Found<'p> {
        let ending = ending.of_stick_slip();
        let critical = ending.critical_velocity(Method::GrazeOrbit);
        let mut neighbour = Neighbour::new(self.problem, branch, at, &ending);
        neighbour.way.clone_from(&self.way);
        (critical, Some(neighbour))
    }

    /// Raises v0 through irregular stick-slip, to where it repeats again or to its end.
    fn cross(&mut self, motion: Motion) -> Result<(Motion, usize), CriticalVelocity> {
        if self.entry.is_none() {
            self.pass(0);
            self.entry = Some(Box::new(motion.clone()));
        }
        let v0 = motion.parameters().v0;
        let usual = &self.problem.options.ramp;
        let options = RampOptions {
            first: self.crossing_step,
            largest: self.crossing_step,
            unseen: self.crossing_step,
            last: self.problem.options.transition.last_crossing_step,
            until_periodic: true,
            ..*usual
        };
        let search = ramp::from(self.problem, motion, &options);
        let ramped = &search.ramped;
        let Some(last) = ramped.last else {
            // It was lost at the v0 at which it was reached.
            let by = Method::Simulation;
            let lost = ramped.lost.filter(|lost| lost.regime == Regime::LiftOff);
            return Err(CriticalVelocity {
                decided: false,
                ..match lost {
                    Some(lost) => CriticalVelocity::of_lift_off(lost.v0, by),
                    None => CriticalVelocity::nothing(v0, Transition::Irregular, by),
                }
            });
        };
        match search.motion {
            Some(motion) if last.regime == Regime::Periodic => {
                Ok((motion, last.summary.slips as usize))
            }
            _ => {
                let critical = told(ramped, usual);
                self.searches.push(search);
                Err(critical)
            }
        }
    }

    /// The end of stick-slip, searched once more from the first irregular stick-slip on.
    fn again(&mut self, entry: Motion) -> CriticalVelocity {
        match self.cross(entry) {
            Ok((motion, slips)) => self.end_of(motion, slips).0,
            Err(critical) => critical,
        }
    }

    /// How stick-slip ends while v0 glides to near the end that was `found`.
    fn glide(&mut self, mut entry: Motion, found: &CriticalVelocity) -> CriticalVelocity {
        let usual = &self.problem.options.ramp;
        let options = gliding(found, usual);
        let v_max = options.v_max.min(options.glide / self.problem.law.mu_s());
        if entry.parameters().v0 < options.glide {
            let options = RampOptions { v_max, ..options };
            let Search { ramped, motion, .. } = ramp::from(self.problem, entry, &options);
            let goes_on = ramped.lost.is_none() && ramped.complete;
            let Some(motion) = motion.filter(|_| goes_on) else {
                return told(&ramped, usual);
            };
            entry = motion;
        }
        self.again(entry)
    }
}

/// What follows stick-slip whose branch was lost at its last point; the motion that showed it; and
/// how far beyond that point it is, relative.
fn look_beyond(
    problem: &Problem,
    branch: &WithHistory<'_, Motion>,
    at: &Point,
) -> (Sequel, Motion, f64) {
    let mut motion = branch.map().clone();
    let from = motion.parameters().v0;
    let same = Sequel::Periodic(at.orbit.period.cycles().len());
    let (mut next, mut beyond) = (same, 0.0);
    for distance in problem.options.transition.past_lost {
        beyond = distance;
        motion.set_v0(from * (1.0 + beyond));
        next = sequel(problem, &mut motion);
        if next != same {
            break;
        }
    }
    (next, motion, beyond)
}

/// The critical velocity by simulation, from the first of some motions whose stick-slip is
/// sustained; from low velocities where none is.
fn simulated_from(problem: &Problem, Handover { motions, step }: Handover) -> Searched {
    let usual = &problem.options.ramp;
    for motion in motions {
        let search = |options: &RampOptions, tolerance: f64| {
            let mut motion = motion.clone();
            motion.refine(Accuracy::of(tolerance));
            let first = step * options.first;
            ramp::from(problem, motion, &RampOptions { first, ..*options })
        };
        let patient = RampOptions {
            patient: true,
            ..*usual
        };
        let first = search(&patient, usual.tolerance);
        if first.motion.is_some() {
            return confirmed(first, &patient, usual, search);
        }
    }
    simulated(problem)
}

/// The critical velocity by simulation from low velocities on.
fn simulated(problem: &Problem) -> Searched {
    let usual = &problem.options.ramp;
    let search = |options: &RampOptions, tolerance: f64| {
        ramp::from_low_velocity(problem, options, Accuracy::of(tolerance))
    };
    confirmed(search(usual, usual.tolerance), usual, usual, search)
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::{letters, problem};
    use super::super::work::{self, Work};
    use super::*;
    use crate::model::FrictionLaw;

    /// Known cells, each with the work of its search. Fewer trials and steps are better; more need
    /// a reason.
    #[test]
    fn known_cells_take_no_more_work() {
        let weaker = |slope: f64, alpha_v: f64, tau: f64| {
            let law = FrictionLaw::weakening(0.5, -0.5 / slope, 1.0).unwrap();
            problem(law, alpha_v, 0.0, tau)
        };
        let cells = [
            (letters(-0.33, 0.0, 4.15), 0.344467, Method::GrazeOrbit),
            (letters(0.0, -10.0, 0.5), 0.021540, Method::GrazeSlip),
            (weaker(-2.0, -0.5753, 4.733), 1.001322, Method::Simulation),
            (
                weaker(-0.7522, -1.3936, 0.5202),
                2.923537,
                Method::GrazeOrbit,
            ),
        ];
        let works = cells.map(|(problem, vc, method)| {
            let (found, Work { trials, steps }) = work::of(|| critical_velocity(&problem));
            assert!((found.vc / vc - 1.0).abs() < 1e-4, "{problem:?} {found:?}");
            assert!(found.decided && found.method == method, "{found:?}");
            (trials, steps)
        });
        assert_eq!(works, [(26, 3565), (6, 116), (48, 10228), (24, 2489)]);
    }

    #[test]
    fn without_control_coulomb_friction_persists() {
        let law = FrictionLaw::coulomb(0.5, 1.0).unwrap();
        let found = critical_velocity(&problem(law, 0.0, 0.0, 1.0));
        assert_eq!(found.transition, Transition::Persists);
        assert!(found.vc.is_nan() && found.decided);
    }

    /// Stick-slip whose branch was lost is followed beyond its last point until its kind changes.
    #[test]
    fn a_branch_that_was_lost_is_recognised() {
        let problem = letters(-0.33, 0.0, 4.15);
        let accuracy = Accuracy::of(1e-6);
        let (mut branch, mut at) = WithHistory::released(&problem, 0.01, accuracy).unwrap();
        let options = &problem.options.continuation;
        for v0 in [0.05, 0.2] {
            use super::super::continuation::Branch;
            let orbit = branch.orbit_at(v0, Some(&at.orbit.period), 0.01).unwrap();
            branch.accept();
            at = Point::first(v0, orbit, 0.01);
        }
        let (same, _, beyond) = look_beyond(&problem, &branch, &at);
        assert_eq!((same, beyond), (Sequel::Periodic(1), 2e-2));
        // From just below v_c = 0.344467 it is lost at the first place beyond that.
        let (_, at) = continue_to_checked_event(&mut branch, at, 0.1, options);
        let (next, motion, beyond) = look_beyond(&problem, &branch, &at);
        assert!(matches!(next, Sequel::Ends(_)), "{next:?}");
        assert!(
            motion.parameters().v0 > 0.344467 && beyond < 2e-2,
            "{beyond}"
        );
    }

    /// Where the first of some motions is not sustained, simulation goes on with the next one.
    #[test]
    fn simulation_goes_on_from_what_is_sustained() {
        let problem = letters(-0.33, 0.0, 4.15);
        let motion = |v0: f64| problem.released(v0, Accuracy::of(1e-6));
        let handover = Handover {
            motions: vec![motion(0.5), motion(0.3)],
            step: 0.02,
        };
        let (found, searches) = simulated_from(&problem, handover);
        assert_eq!(searches.len(), 3);
        assert_eq!(found.method, Method::Simulation);
        assert!((found.vc / 0.344467 - 1.0).abs() < 1e-5, "{found:?}");
        assert!(found.decided && found.transition == Transition::Grazing);
    }
}
