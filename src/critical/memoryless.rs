//! The return map without memory: under pure load control a stick that outlasts the delay and the
//! latency erases all memory, unless the feedback itself has one.
//!
//! Every slip starts from a = μ_S (1 + α_n v0 τ), which has grown evenly, so the orbit at v0 is one
//! slip and its stick ([`super`], Eq. 5).

use super::after_event::after_graze;
use super::continuation::{Branch, Orbit, Point, Releases, continue_to_checked_event};
use super::event_functions::Event;
use super::problem::Problem;
use super::return_map::{NoReturn, Period, ReturnMap};
use super::transition::{Ending, Sequel, same_slip};
use crate::slip::motion::{Accuracy, Motion};

/// Slips that start without memory.
#[derive(Clone)]
pub(super) struct Memoryless<'p> {
    problem: &'p Problem,
    motion: Motion,
}

impl<'p> Memoryless<'p> {
    /// Slips without memory of `problem`, which has pure load control.
    pub(super) fn new(problem: &'p Problem, accuracy: Accuracy) -> Self {
        let motion = problem.at_rest(1e-3, accuracy);
        Self { problem, motion }
    }

    /// The period just below `v0`, by the relative distance `precision`. None unless its stick, and
    /// so the one before it, outlasts the delay.
    pub(super) fn outlasts(&mut self, v0: f64, precision: f64) -> Option<Period> {
        let problem = self.problem;
        let cycle = self
            .release_at(v0 * (1.0 - precision))
            .cycle(None, &problem.options.continuation);
        let erases = |stick: f64| problem.erasing_stick().is_some_and(|least| stick >= least);
        let cycle = cycle.ok().filter(|cycle| erases(cycle.stick));
        cycle.map(Period::of)
    }

    /// The end of stick-slip from a point on. None where slips without memory do not lead to it.
    fn end(&mut self, mut from: Point) -> Option<Ending> {
        let problem = self.problem;
        let (options, checks) = (&problem.options.continuation, &problem.options.transition);
        let mut step = options.largest_step;
        for _ in 0..options.most_kinds {
            let (located, at) = continue_to_checked_event(self, from, step, options);
            let located = located.ok()?;
            match located.event {
                Event::Graze(_) => return self.graze(located.v0, &at),
                Event::LiftOff => {
                    let period = self.outlasts(located.v0, checks.precision)?;
                    return Some(Ending::new(located, period));
                }
                Event::Reversal | Event::NewStop => {
                    let beyond = located.v0 * (1.0 + checks.past_change);
                    let orbit = self.orbit_at(beyond, None, f64::INFINITY).ok()?;
                    from = Point::first(beyond, orbit, f64::INFINITY);
                    step = options.first_step;
                }
                Event::StickVanishes => return None,
            }
        }
        None
    }

    /// The graze at `v0`, next to the last point, if stick-slip ends there. None where it does not:
    /// the search then starts again with history.
    fn graze(&mut self, v0: f64, at: &Point) -> Option<Ending> {
        let problem = self.problem;
        let options = &problem.options.transition;
        let period = self.outlasts(v0, options.precision)?;
        if !same_slip(&period, &at.orbit.period, 0, options) {
            return None;
        }
        match after_graze(problem, (v0, period.cycles()[0].slip), self) {
            Sequel::Ends(_) => Some(Ending {
                event: Event::Graze(0),
                v0,
                period,
            }),
            _ => None,
        }
    }
}

impl Releases for Memoryless<'_> {
    type Map = Motion;

    fn release_at(&mut self, v0: f64) -> &mut Motion {
        let p = self.problem;
        self.motion.set_v0(v0);
        // At the end of a stick that outlasted the delay.
        let load = 1.0 + p.feedback.gains.alpha_n * v0 * p.feedback.tau;
        let load = p.feedback.limits.load_of(load);
        self.motion
            .release_from(p.law.mu_s() * load - p.dashpots.damping * v0);
        &mut self.motion
    }
}

impl Branch for Memoryless<'_> {
    fn orbit_at(&mut self, v0: f64, expected: Option<&Period>, _: f64) -> Result<Orbit, NoReturn> {
        #[cfg(test)]
        super::work::count_trial();
        let problem = self.problem;
        let stop = expected.map(|period| period.stops()[0]);
        let cycle = self
            .release_at(v0)
            .cycle(stop, &problem.options.continuation)?;
        match problem.erasing_stick() {
            Some(least) if cycle.stick >= least => {}
            _ => return Err(NoReturn::OutsideDomain),
        }
        Ok(Orbit::of(Period::of(cycle)))
    }

    fn accept(&mut self) {}

    fn refine(&mut self, accuracy: Accuracy) {
        self.motion.refine(accuracy);
    }
}

/// The end of stick-slip under pure load control, by slips without memory from `v0` on. None where
/// they do not lead to it.
///
/// # Errors
/// When there is no slip and stick without memory at `v0`.
pub(super) fn end_without_memory(
    problem: &Problem,
    v0: f64,
    accuracy: Accuracy,
) -> Result<Option<Ending>, NoReturn> {
    if problem.erasing_stick().is_none() {
        return Err(NoReturn::OutsideDomain);
    }
    let mut branch = Memoryless::new(problem, accuracy);
    let orbit = branch.orbit_at(v0, None, f64::INFINITY)?;
    Ok(branch.end(Point::first(v0, orbit, f64::INFINITY)))
}

#[cfg(test)]
mod tests {
    use super::super::limit::CoulombLimit;
    use super::super::synthetic::{letters, problem};
    use super::*;
    use crate::model::FrictionLaw;

    /// The letter's Fig. 4: as the delay falls the graze tends to the closed form.
    #[test]
    fn a_short_delay_grazes_where_the_closed_form_says() {
        for gamma in [0.1, 0.3, 0.6] {
            let limit = CoulombLimit::at(gamma, 0.5).unwrap().vc_over_vtilde;
            let off = [0.01, 0.005].map(|tau| {
                let law = FrictionLaw::coulomb(0.5, 1.0).unwrap();
                let problem = problem(law, 0.0, -4.0 * gamma / tau, tau);
                let found = end_without_memory(&problem, 0.01, Accuracy::of(1e-8));
                let found = found.unwrap().unwrap();
                assert_eq!(found.event, Event::Graze(0));
                assert!(found.period.stick_time() > tau);
                (found.v0 / 0.5 - limit).abs()
            });
            assert!(off[0] < 1e-3 && off[1] < 0.6 * off[0], "{gamma} {off:?}");
        }
    }

    #[test]
    fn velocity_control_has_a_memory() {
        let accuracy = Accuracy::of(1e-6);
        let velocity = end_without_memory(&letters(-0.33, 0.0, 4.15), 0.01, accuracy);
        assert_eq!(velocity.unwrap_err(), NoReturn::OutsideDomain);
        // The letter's Fig. 3(b).
        let load = letters(0.0, -10.0, 0.5);
        let found = end_without_memory(&load, 0.01, accuracy).unwrap().unwrap();
        assert!((found.v0 - 0.021540).abs() < 2e-6, "{found:?}");
    }

    #[test]
    fn a_stick_shorter_than_the_delay_is_outside_the_domain() {
        let problem = letters(0.0, -0.1, 6.0);
        let mut branch = Memoryless::new(&problem, Accuracy::of(1e-6));
        let found = branch.orbit_at(0.5, None, f64::INFINITY);
        assert_eq!(found.unwrap_err(), NoReturn::OutsideDomain);
        assert!(branch.outlasts(0.5, 0.0).is_none());
        assert!(branch.orbit_at(0.05, None, f64::INFINITY).is_ok());
    }
}
