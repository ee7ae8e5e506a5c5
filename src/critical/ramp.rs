//! Simulation while v0 is raised: stick-slip is followed to its regime at every v0, the state
//! carried from one to the next, by steps that grow and are halved.
//!
//! A v0 at which stick-slip was lost is no bound: near its end it attracts from less and less far,
//! so the size of the step may have lost it. The same v0 is tried again from closer by
//! ([`StepControl`]), until the last v0 that held and the first that did not are close enough.

use super::continuation::times_jump;
use super::event_functions::{Event, EventFunctions};
use super::options::{ContinuationOptions, RampOptions};
use super::problem::{NoStart, Problem};
use super::regime::{Followed, Observation, Regime, Response, Simulated};
use super::search::{Chance, Ramped, Search};
use super::step_control::{Prediction, Retry, StepControl};
use crate::slip::motion::{Accuracy, Motion};

/// Follows stick-slip of `problem` from low v0 on.
pub(super) fn from_low_velocity(
    problem: &Problem,
    options: &RampOptions,
    accuracy: Accuracy,
) -> Search {
    let mut lost: Option<Response> = None;
    let found = problem.at_first_start(|v0| {
        let search = from(problem, problem.released(v0, accuracy), options);
        let ramped = &search.ramped;
        if ramped.last.is_some() {
            return Ok(search);
        }
        // If a lower start lost stick-slip in another way, lift-off at a larger one is due to that
        // start alone.
        let lowest = lost.as_ref().map_or(f64::INFINITY, |lost| lost.v0);
        let lifts_off = |now: &Response| now.regime == Regime::LiftOff;
        let lower = |now: &Response| lifts_off(now) && now.v0 < lowest;
        if lost.is_none() || ramped.lost.as_ref().is_some_and(lower) {
            lost = ramped.lost;
        }
        match ramped.lost.as_ref().is_some_and(lifts_off) {
            true => Err(NoStart::LiftOff),
            false => Err(NoStart::NotSustained),
        }
    });
    found.unwrap_or_else(|| Search {
        ramped: Ramped::none(lost),
        motion: None,
        step: options.largest,
    })
}

/// Follows a motion in stick-slip of `problem` from the v0 it has.
pub(super) fn from(problem: &Problem, motion: Motion, options: &RampOptions) -> Search {
    let mut block = Simulated { problem, motion };
    let ramped = raise(&mut block, options, &problem.options.continuation);
    let motion = ramped.last.is_some().then_some(block.motion);
    let step = options.largest;
    Search {
        ramped,
        motion,
        step,
    }
}

/// Raises v0 from its present value and follows stick-slip; the block is left in its last state.
pub(super) fn raise<F: Followed>(
    block: &mut F,
    options: &RampOptions,
    continuation: &ContinuationOptions,
) -> Ramped {
    let first = block.response_at(block.v0(), &Observation::new(options, f64::INFINITY));
    if !first.persists() {
        return Ramped::none(Some(first));
    }
    let mut ramp = Ramp {
        options,
        continuation,
        trial: block.clone(),
        block: block.clone(),
        before: None,
        last: first,
        lost: None,
        jump: None,
        control: StepControl::new(
            options.first,
            options.largest,
            Retry::Same(options.nearby),
            continuation,
        ),
        share: options.share,
        passed: (0.0, 0),
        by_chance: false,
        end: f64::NAN,
        vanish: false,
        chance: first.regime == Regime::Irregular,
        spent: first.summary.steps,
    };
    let complete = ramp.run();
    ramp.classify();
    std::mem::swap(block, &mut ramp.block);
    Ramped {
        last: Some(ramp.last),
        lost: ramp.lost.map(|(lost, _)| lost),
        complete,
        chance: match (ramp.by_chance, ramp.chance) {
            (true, _) => Chance::AtEnd,
            (false, true) => Chance::OnTheWay,
            (false, false) => Chance::None,
        },
        vanish: ramp.vanish,
        graze_step: graze_step(ramp.before, &ramp.last),
    }
}

/// A search while v0 is raised.
struct Ramp<'o, F> {
    options: &'o RampOptions,
    continuation: &'o ContinuationOptions,
    /// The block at `last`.
    block: F,
    trial: F,
    before: Option<Response>,
    last: Response,
    /// The smallest v0 above `last` at which stick-slip was lost, and the relative step that lost
    /// it.
    lost: Option<(Response, f64)>,
    /// The smallest v0 above `last` to which a step was too large: it led to another kind of
    /// stick-slip.
    jump: Option<f64>,
    control: StepControl<'o>,
    /// The share of the way to the predicted end of stick-slip that is taken at once.
    share: f64,
    /// The v0 from which on stick-slip survived where it had been lost, and how often it has since.
    passed: (f64, u32),
    /// Whether stick-slip was lost again and again on a short way, and no event is near: steps of
    /// any size throw it off by chance.
    by_chance: bool,
    /// The v0 of the event that was last predicted to be near; NaN where none was.
    end: f64,
    /// Whether any step shortened the sticks so much that none would be left soon.
    vanish: bool,
    /// Whether irregular stick-slip or a jump was on the way.
    chance: bool,
    spent: u64,
}

impl<F: Followed> Ramp<'_, F> {
    /// Raises v0 until two v0 are as near as required, and stick-slip persists at the lower one
    /// alone. False where that takes too long.
    fn run(&mut self) -> bool {
        let end = self.options.v_max * self.block.unit();
        for _ in 0..self.options.trials {
            let repeats = self.options.until_periodic && self.last.regime == Regime::Periodic;
            if self.last.v0 >= end || repeats {
                return true;
            }
            let step = self.next_step();
            if self.lost.is_some() && step < self.options.near_enough * self.precision() {
                if self.is_lost() {
                    return true;
                }
                continue;
            }
            let v0 = (self.last.v0 * (1.0 + step)).min(end);
            // A v0 that is tried once more is exactly the same.
            let again = self.lost.map(|(lost, _)| lost.v0);
            let again = again.filter(|lost| (v0 / lost - 1.0).abs() < 1e-12);
            self.attempt(again.unwrap_or(v0), step);
            if self.spent > self.options.total_steps {
                return false;
            }
        }
        false
    }

    /// Follows irregular stick-slip at the last v0 for longer, to see whether it repeats.
    fn classify(&mut self) {
        if self.last.regime == Regime::Irregular && !self.options.patient {
            let how = Observation::at_length(self.options, 0.0);
            let again = self.block.response_at(self.last.v0, &how);
            if again.persists() {
                self.last = again;
            }
        }
    }

    /// The last step, which is longer from irregular stick-slip.
    fn precision(&self) -> f64 {
        match self.last.regime {
            Regime::Irregular => self.options.last.max(self.options.last_irregular),
            _ => self.options.last,
        }
    }

    /// Whether stick-slip was lost again and again on a short way.
    fn passes_again_and_again(&self) -> bool {
        self.passed.1 >= self.options.most_passed
    }

    /// Whether periodic stick-slip is near the event that is predicted. It attracts from less and
    /// less far then, so steps that are too large for the way that is left lose it, not chance.
    fn approaches(&self) -> bool {
        self.end > self.last.v0
    }

    /// Whether steps have to be small compared with the way that is left.
    fn is_gentle(&self) -> bool {
        self.passes_again_and_again() && self.approaches()
    }

    /// The relative step to where stick-slip is predicted to end.
    fn way_left(&self) -> f64 {
        match self.is_gentle() {
            // Secants of steps that small are noise.
            true => self.end / self.last.v0 - 1.0,
            false => predict(self.before, &self.last).step,
        }
    }

    /// Notes the event that is predicted from the last two responses, if it is near.
    fn look_ahead(&mut self, jumped: bool) {
        if jumped {
            self.end = f64::NAN;
        }
        let step = predict(self.before, &self.last).step;
        if step < self.options.near {
            self.end = self.last.v0 * (1.0 + step);
        }
    }

    /// Notes that stick-slip survives at `v0`, where a larger step had lost it.
    fn pass(&mut self, v0: f64) {
        let (from, times) = self.passed;
        self.passed = match v0 > from * (1.0 + self.options.short_way) {
            true => (v0, 1),
            false => (from, times + 1),
        };
        self.by_chance = self.passes_again_and_again() && !self.approaches();
        self.lost = None;
        // Where chance decides, retries would make the search creep on.
        let retry = Retry::Same(self.options.nearby);
        self.control.retry = Some(retry).filter(|_| !self.by_chance);
    }

    /// The next relative step of v0.
    fn next_step(&self) -> f64 {
        let options = self.options;
        let mut wanted = self.share * self.way_left();
        if self.last.regime == Regime::Irregular {
            wanted = wanted.min(options.unseen);
        }
        let step = self.control.step(self.last.v0, wanted, options.last);
        let Some(jump) = self.jump else {
            return step;
        };
        let room = jump / self.last.v0 - 1.0;
        let far = room > 2.0 * self.continuation.jump;
        step.min(if far { 0.5 * room } else { room })
    }

    /// The largest relative step of v0 that is allowed from the last response to `there`, which was
    /// reached by `step`.
    fn largest_step(&self, there: &Response, step: f64) -> f64 {
        let last = &self.last;
        let jumps = self.jumps(there, step);
        match (last.regime, there.regime) {
            (Regime::Periodic, Regime::Periodic) if last.is_like(there) && !jumps => f64::INFINITY,
            // Once chance has a part, smaller steps gain nothing.
            _ if self.chance => self.options.unseen,
            (Regime::Periodic, Regime::Periodic) if jumps => self.continuation.jump,
            (Regime::Periodic, Regime::Irregular) => self.options.careful,
            _ => self.options.unseen,
        }
    }

    /// Whether a relative `step` of v0 threw the block from one kind of stick-slip to another.
    fn jumps(&self, there: &Response, step: f64) -> bool {
        let (before, after) = (self.last.mean_times(), there.mean_times());
        times_jump(before, after, step, self.continuation)
    }

    /// Tries `v0`, a relative `step` away.
    fn attempt(&mut self, v0: f64, step: f64) {
        let options = self.options;
        self.trial.copy_from(&self.block);
        let there = self
            .trial
            .response_at(v0, &Observation::after(options, v0, step));
        self.spent += there.summary.steps;
        if !there.persists() {
            if self.lost.is_none_or(|(lost, _)| v0 <= lost.v0) {
                self.lost = Some((there, step));
            }
            // Near its end stick-slip attracts from less and less far: steps have to shrink with
            // the way that is left.
            let taken = step / self.way_left();
            let least = match self.is_gentle() {
                true => options.gentle_share,
                false => options.least_share,
            };
            if taken > least {
                let share = self.continuation.reduction * taken;
                self.share = share.max(least).min(self.share);
            }
            self.control.failed(v0, step);
        } else if step > self.largest_step(&there, step) {
            self.control.shrink(step);
            self.jump = Some(v0);
        } else {
            let jumped = there.regime == Regime::Irregular || self.jumps(&there, step);
            self.chance |= jumped;
            std::mem::swap(&mut self.block, &mut self.trial);
            self.jump = self.jump.filter(|jump| *jump > v0 && !jumped);
            if self.control.succeeded(v0, step) {
                self.pass(v0);
            }
            self.vanish |= stick_step(&self.last, &there) < options.soon;
            (self.before, self.last) = (Some(self.last), there);
            self.look_ahead(jumped);
        }
    }

    /// Whether stick-slip is really lost at the last v0 that lost it, by a longer wait. If not, the
    /// search goes on from there.
    fn is_lost(&mut self) -> bool {
        let slips = |(lost, _): &(Response, f64)| lost.regime == Regime::Slips;
        let Some((lost, by)) = self.lost.filter(slips).filter(|_| !self.by_chance) else {
            return true;
        };
        self.trial.copy_from(&self.block);
        let how = Observation::at_length(self.options, by);
        let there = self.trial.response_at(lost.v0, &how);
        self.spent += there.summary.steps;
        if !there.persists() {
            self.lost = Some((there, by));
            return true;
        }
        std::mem::swap(&mut self.block, &mut self.trial);
        self.control
            .succeeded(there.v0, there.v0 / self.last.v0 - 1.0);
        self.pass(there.v0);
        (self.before, self.last) = (None, there);
        false
    }
}

/// The event functions of a response, and their slopes by secants from the response before. The
/// slopes are unknown where the two are not of one kind.
fn secants(before: Option<Response>, last: &Response) -> (EventFunctions, EventFunctions) {
    let now = last.event_functions();
    let slopes = before.filter(|before| before.is_like(last)).map(|before| {
        let change = last.v0 - before.v0;
        now.with(&before.event_functions(), |now, before| {
            (now - before) / change
        })
    });
    (now, slopes.unwrap_or(EventFunctions::UNKNOWN))
}

/// Where stick-slip is predicted to end.
fn predict(before: Option<Response>, last: &Response) -> Prediction {
    let (now, slopes) = secants(before, last);
    Prediction::first(&now, &slopes, last.v0)
}

/// The relative step to where this event alone is predicted.
fn step_to(event: Event, before: Option<Response>, last: &Response) -> f64 {
    let (now, slopes) = secants(before, last);
    let alone = EventFunctions::alone(event, now.of(event));
    Prediction::first(&alone, &slopes, last.v0).step
}

/// The relative step to where the depth of the stops is predicted to vanish.
fn graze_step(before: Option<Response>, last: &Response) -> f64 {
    step_to(Event::Graze(0), before, last)
}

/// The relative step to where the sticks are predicted to vanish.
fn stick_step(before: &Response, last: &Response) -> f64 {
    step_to(Event::StickVanishes, Some(*before), last)
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::{Family, LOGISTIC, Synthetic};
    use super::*;

    fn raised(family: Family, v0: f64, x: f64, options: &RampOptions) -> Ramped {
        let mut map = Synthetic::new(family, v0, x);
        raise(&mut map, options, &ContinuationOptions::default())
    }

    #[test]
    fn a_saddle_node_is_found_where_the_orbit_vanishes() {
        let found = raised(Family::SaddleNode, 0.1, 0.9, &RampOptions::default());
        let [last, lost] = [found.last, found.lost].map(|response| response.unwrap());
        assert!(found.complete && found.chance == Chance::None);
        assert_eq!(
            (last.regime, lost.regime),
            (Regime::Periodic, Regime::Slips)
        );
        assert!(last.v0 <= 1.0 + 1e-6 && last.v0 > 1.0 - 2e-6, "{found:?}");
        assert!(lost.v0 / last.v0 - 1.0 < 1.5e-6);
        assert!(found.graze_step > 1e-4);
    }

    /// Period after period doubles on the way, and chaos is lost in a crisis at v0 = 4.
    #[test]
    fn a_crisis_ends_irregular_stick_slip() {
        let options = RampOptions {
            largest: 0.05,
            ..RampOptions::default()
        };
        let found = raised(LOGISTIC, 2.5, 0.5, &options);
        let [last, lost] = [found.last, found.lost].map(|response| response.unwrap());
        assert_eq!(
            (last.regime, lost.regime),
            (Regime::Irregular, Regime::Slips)
        );
        assert!((last.v0 - 4.0).abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn a_graze_is_predicted_by_the_depth() {
        let found = raised(Family::Nordmark(0.0), 0.2, 0.0, &RampOptions::default());
        let last = found.last.unwrap();
        assert!((last.v0 - 1.0).abs() < 2e-6, "{found:?}");
        assert!(found.graze_step < 1e-4 && last.depth < 1e-5, "{found:?}");
    }

    /// Near its graze stick-slip attracts from a small share of the way to it alone. That it is
    /// lost by larger steps again and again is no chance.
    #[test]
    fn a_graze_is_come_near_to_where_stick_slip_attracts_from_nearby_alone() {
        let options = RampOptions {
            total_steps: 100_000_000,
            ..RampOptions::default()
        };
        for share in [0.3, 0.1, 0.04] {
            let found = raised(Family::Narrow(share), 0.5, 0.5, &options);
            let last = found.last.unwrap();
            assert_eq!(found.chance, Chance::None, "{share} {found:?}");
            assert!(found.complete && last.v0 < 1.0, "{share} {found:?}");
            assert!(1.0 - last.v0 < 5e-5, "{share} {found:?}");
        }
    }

    #[test]
    fn sticks_that_vanish_are_seen() {
        let family = Family::Vanishing(super::super::event_functions::Event::StickVanishes);
        let found = raised(family, 0.2, 0.1, &RampOptions::default());
        assert!(
            found.vanish && (found.last.unwrap().v0 - 1.0).abs() < 2e-6,
            "{found:?}"
        );
    }

    #[test]
    fn a_search_ends_where_it_is_told_to() {
        let options = RampOptions {
            v_max: 0.5,
            ..RampOptions::default()
        };
        let found = raised(Family::SaddleNode, 0.1, 0.9, &options);
        assert!(found.complete && found.lost.is_none());
        assert_eq!(found.last.unwrap().v0, 0.5);
        let short = RampOptions {
            total_steps: 100,
            ..RampOptions::default()
        };
        assert!(!raised(Family::SaddleNode, 0.1, 0.9, &short).complete);
        let few = RampOptions {
            trials: 2,
            ..RampOptions::default()
        };
        assert!(!raised(Family::SaddleNode, 0.1, 0.9, &few).complete);
        // Nothing is sustained beyond the saddle-node.
        let none = raised(Family::SaddleNode, 1.5, 0.0, &RampOptions::default());
        assert!(none.last.is_none() && none.lost.is_some() && none.complete);
    }

    /// Chaos leads to a window of the logistic map in which three slips repeat, from v0 = 1 + √8.
    #[test]
    fn irregular_stick_slip_is_crossed_to_where_it_repeats() {
        let options = RampOptions {
            first: 2e-3,
            largest: 2e-3,
            unseen: 2e-3,
            until_periodic: true,
            ..RampOptions::default()
        };
        let found = raised(LOGISTIC, 3.8, 0.5, &options);
        let last = found.last.unwrap();
        assert_eq!((last.regime, last.summary.slips), (Regime::Periodic, 3));
        assert!(last.v0 > 1.0 + 8.0_f64.sqrt() && last.v0 < 3.85, "{last:?}");
    }
}
