//! The predictor of events and the control of steps in v0, of continuation and of simulation alike.
//!
//! All rules for step sizes, and where they stand:
//!
//! ```text
//! where the next event is          Prediction; slopes: continuation::Point, ramp::secants
//! the share of the way there       continuation::continue_to_event; ramp::next_step
//! after a failure and a success    StepControl
//! which steps fail                 continuation::is_jump; ramp::largest_step
//! the last steps                   continuation::continue_to_event; ramp::precision
//! the first steps                  follow, for each kind of stick-slip
//! steps of the delay               delay_step::approach, set_out; along_delay::segment
//! ```

use super::event_functions::{Event, EventFunctions};
use super::options::ContinuationOptions;

/// Where the first event function vanishes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prediction {
    /// The relative step of v0 that leads there; +∞ where none vanishes.
    pub step: f64,
    /// The event.
    pub event: Event,
}

impl Prediction {
    /// The first zero of an event function beyond `v0`, by lines with these slopes.
    pub(super) fn first(events: &EventFunctions, slopes: &EventFunctions, v0: f64) -> Self {
        let mut first = Self {
            step: f64::INFINITY,
            event: Event::LiftOff,
        };
        for ((event, value), (_, slope)) in events.each().into_iter().zip(slopes.each()) {
            let step = -value / slope / v0;
            if step >= 0.0 && step < first.step {
                first = Self { step, event };
            }
        }
        first
    }
}

/// How far the next step in v0 may go. All steps are relative.
///
/// A step that failed makes the next one half as long. One that succeeded doubles the largest step
/// that is allowed, up to a limit. A v0 that failed is no bound: the size of the step may be the
/// reason. So the next step goes half of the way to it. Once the distance is much smaller than the
/// step that failed, [`Retry`] says what is tried.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepControl<'o> {
    options: &'o ContinuationOptions,
    /// What is tried near a v0 that failed; None where it is not to be passed any more.
    pub retry: Option<Retry>,
    /// The largest step at present, and its upper limit.
    largest: f64,
    limit: f64,
    /// The lowest v0 that failed, or the last one where steps beyond it are tried, and the step
    /// that led there. None once a v0 beyond it has succeeded.
    failed: Option<(f64, f64)>,
}

/// What is tried near a v0 that failed, and how near, as a share of the step that failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Retry {
    /// A step of that size beyond the v0 that failed: for continuation, which needs no bracket.
    Beyond(f64),
    /// The v0 that failed, once more: for simulation, which ends between one v0 that failed and one
    /// that did not.
    Same(f64),
}

impl<'o> StepControl<'o> {
    /// The control before the first step, which is at most `first`. All steps are at most `limit`.
    pub(super) fn new(
        first: f64,
        limit: f64,
        retry: Retry,
        options: &'o ContinuationOptions,
    ) -> Self {
        Self {
            options,
            retry: Some(retry),
            largest: first,
            limit,
            failed: None,
        }
    }

    /// The step from `v0` if `wanted` is asked for; at least `least`.
    pub(super) fn step(&self, v0: f64, wanted: f64, least: f64) -> f64 {
        let step = wanted.clamp(least, self.largest.max(least));
        let Some((failed, by)) = self.failed else {
            return step;
        };
        let room = failed / v0 - 1.0;
        match self.retry {
            Some(Retry::Beyond(share)) if step < room || step <= share * by => step,
            Some(Retry::Beyond(share)) if room <= share * by => share * by,
            Some(Retry::Beyond(_)) => 0.5 * room,
            Some(Retry::Same(share)) if room <= share * by => step.min(room),
            Some(Retry::Same(_)) | None => step.min(0.5 * room),
        }
    }

    /// A step to `v0` failed.
    pub(super) fn failed(&mut self, v0: f64, step: f64) {
        let lowest = self.failed.is_none_or(|(failed, _)| v0 <= failed);
        if lowest || matches!(self.retry, Some(Retry::Beyond(_))) {
            self.failed = Some((v0, step));
        }
        self.shrink(step);
    }

    /// Makes the next step smaller than this one.
    pub(super) fn shrink(&mut self, step: f64) {
        self.largest = self.options.reduction * step;
    }

    /// Notes that a step to `v0` succeeded; true where a v0 up to there had failed before.
    pub(super) fn succeeded(&mut self, v0: f64, step: f64) -> bool {
        let passed = self.failed.is_some_and(|(failed, _)| failed <= v0);
        let mut largest = self.largest;
        if passed {
            // The size of the step was the reason, so steps grow slowly from here on.
            (self.failed, largest) = (None, step);
        }
        self.largest = (self.options.growth * largest).min(self.limit);
        passed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_zero_is_predicted() {
        let events = EventFunctions {
            load: 0.8,
            dip: 1.2,
            missing_force: 0.6,
            ..EventFunctions::UNKNOWN
        };
        let unknown = Prediction::first(&events, &EventFunctions::UNKNOWN, 1.1);
        assert_eq!(unknown.step, f64::INFINITY);
        let slopes = EventFunctions {
            load: -2.0,
            dip: -8.0,
            missing_force: 1.0,
            ..EventFunctions::UNKNOWN
        };
        // The load vanishes at 1.5, the dip at 1.25, the missing force grows.
        let found = Prediction::first(&events, &slopes, 1.1);
        assert_eq!(found.event, Event::NewStop);
        assert!((1.1 * (1.0 + found.step) - 1.25).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn steps_grow_and_shrink_within_their_limits() {
        let options = ContinuationOptions::default();
        let mut control = StepControl::new(0.1, 0.6, Retry::Beyond(0.3), &options);
        assert_eq!(control.step(1.0, 5.0, 0.0), 0.1);
        assert_eq!(control.step(1.0, 0.02, 0.0), 0.02);
        assert_eq!(control.step(1.0, 1e-9, 1e-6), 1e-6);
        assert!(!control.succeeded(1.1, 0.1));
        assert_eq!(control.step(1.1, 5.0, 0.0), 0.2);
        control.shrink(0.2);
        assert_eq!(control.step(1.1, 5.0, 0.0), 0.1);
        for _ in 0..10 {
            control.succeeded(1.1, 0.1);
        }
        assert_eq!(control.step(1.1, 5.0, 0.0), 0.6);
    }

    /// The size of the step may be the reason that a v0 failed.
    #[test]
    fn what_failed_is_come_nearer_to_and_passed_by_a_smaller_step() {
        let options = ContinuationOptions::default();
        let mut control = StepControl::new(0.4, 1.0, Retry::Beyond(0.3), &options);
        control.failed(1.4, 0.4);
        // A step shorter than the way is free; the next one goes half of the way.
        assert_eq!(control.step(1.0, 5.0, 0.0), 0.2);
        control.succeeded(1.2, 0.2);
        let room = 1.4 / 1.2 - 1.0;
        assert!((control.step(1.2, 5.0, 0.0) - 0.5 * room).abs() < 1e-15);
        // From nearby the step is 0.3 of the one that failed, and leads beyond.
        let from = 1.4 / 1.05;
        assert!((control.step(from, 5.0, 0.0) - 0.12).abs() < 1e-15);
        assert!((control.step(from, 0.1, 0.0) - 0.1).abs() < 1e-15);
        // Success beyond it forgets the failure, and steps grow from there on.
        assert!(control.succeeded(1.45, 0.12));
        assert_eq!(control.step(1.45, 5.0, 0.0), 0.24);
    }

    #[test]
    fn the_lowest_one_that_failed_is_tried_once_more() {
        let options = ContinuationOptions::default();
        let mut control = StepControl::new(0.4, 1.0, Retry::Same(0.15), &options);
        control.failed(1.4, 0.4);
        control.failed(1.5, 0.4);
        assert!((control.step(1.0, 5.0, 0.0) - 0.2).abs() < 1e-15);
        let from = 1.4 / 1.05;
        assert!((control.step(from, 5.0, 0.0) - 0.05).abs() < 1e-15);
        control.retry = None;
        assert!((control.step(from, 5.0, 0.0) - 0.025).abs() < 1e-15);
        assert!(control.succeeded(1.4, 0.05));
        assert_eq!(control.step(1.4, 5.0, 0.0), 0.1);
    }
}
