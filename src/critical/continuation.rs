//! Continuation of a branch of periodic orbits in v0, to where an event function vanishes.
//!
//! The event functions g(v0) of the last two orbits predict the event ([`Prediction`]). A step
//! takes a share of the way there. The corrector is the return map itself, iterated until periods
//! repeat ([`Branch::orbit_at`]). A step is undone and made smaller where that does not lead to an
//! orbit of the same kind. The rules for step sizes are listed in [`super::step_control`], all
//! numbers in [`ContinuationOptions`].

use crate::model::elementary::power;
use crate::slip::motion::Accuracy;

use super::event_functions::EventFunctions;
use super::options::ContinuationOptions;
use super::return_map::{NoReturn, Period};
use super::step_control::{Prediction, Retry, StepControl};
use super::transition::{Located, Undetermined};

/// A periodic orbit of stick-slip at one v0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Orbit {
    /// The last period that was followed.
    pub period: Period,
    /// The event functions: those of the period, or the limit that periods converge to.
    pub events: EventFunctions,
}

impl Orbit {
    /// The orbit of one period, without a limit.
    pub(super) fn of(period: Period) -> Self {
        let events = period.event_functions();
        Self { period, events }
    }
}

/// A branch of periodic orbits, one at each v0.
pub(super) trait Branch {
    /// The orbit at `v0`, started from the last accepted one; `expected` is the period nearby. With
    /// memory, periods are followed until their event functions differ by no more than `settled`,
    /// relative; one period where `settled` is infinite.
    ///
    /// # Errors
    /// See [`NoReturn`].
    fn orbit_at(
        &mut self,
        v0: f64,
        expected: Option<&Period>,
        settled: f64,
    ) -> Result<Orbit, NoReturn>;

    /// Accepts the last orbit that was found as the start of the next one.
    fn accept(&mut self);

    /// Goes on with another accuracy.
    fn refine(&mut self, accuracy: Accuracy);
}

/// A branch whose blocks can be released at any v0 nearby.
pub(super) trait Releases {
    /// What is released: a motion.
    type Map;

    /// A block that is released at `v0`, with a past like that of the orbits that were accepted.
    fn release_at(&mut self, v0: f64) -> &mut Self::Map;
}

/// An accepted orbit on the way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub v0: f64,
    pub orbit: Orbit,
    /// How settled the orbit is, see [`Branch::orbit_at`].
    pub settled: f64,
    /// The derivatives of the event functions with respect to v0; NaN before they are known.
    pub slopes: EventFunctions,
    /// Whether the slopes are of this problem, not of one with another delay.
    pub own_slopes: bool,
    /// Where the event was predicted before this point was reached; NaN where it was not.
    pub predicted: f64,
}

impl Point {
    /// A first point, whose slopes are not known.
    pub(super) fn first(v0: f64, orbit: Orbit, settled: f64) -> Self {
        Self {
            v0,
            orbit,
            settled,
            slopes: EventFunctions::UNKNOWN,
            own_slopes: true,
            predicted: f64::NAN,
        }
    }

    /// Where the branch is predicted to end.
    pub(super) fn predict(&self) -> Prediction {
        Prediction::first(&self.orbit.events, &self.slopes, self.v0)
    }

    /// The v0 at which the event is predicted; +∞ where none is.
    fn end(&self) -> f64 {
        self.v0 * (1.0 + self.predict().step)
    }

    /// Whether the event is near, and two predictions of it agree.
    fn agrees(&self, options: &ContinuationOptions) -> bool {
        let end = self.end();
        let near = end / self.v0 - 1.0 < options.quite_near;
        near && (end / self.predicted - 1.0).abs() < options.agreement
    }

    /// Whether the slopes are good enough to locate the event: they are of this problem, or the
    /// event is very near.
    fn tells(&self, options: &ContinuationOptions) -> bool {
        let end = self.end();
        let as_predicted = (end / self.predicted - 1.0).abs() < options.borrowed;
        self.own_slopes || as_predicted && end / self.v0 - 1.0 < options.borrowed
    }

    /// The next point.
    fn moved_to(&self, v0: f64, orbit: Orbit, settled: f64) -> Self {
        let (mut slopes, mut own_slopes) = (self.slopes, self.own_slopes);
        // At the same v0 the event functions become more exact, and the slopes stay.
        if v0 > self.v0 {
            let step = v0 - self.v0;
            slopes = orbit
                .events
                .with(&self.orbit.events, |now, before| (now - before) / step);
            own_slopes = true;
        }
        Self {
            v0,
            orbit,
            settled,
            slopes,
            own_slopes,
            predicted: self.end(),
        }
    }
}

/// How settled an orbit has to be after a relative step of v0.
fn settled_after(step: f64, options: &ContinuationOptions) -> f64 {
    if step >= options.large_step {
        options.settled_after_large
    } else if step >= options.middling_step {
        options.settled_after_middling
    } else if step >= options.small_step {
        options.settled
    } else {
        options.settled_after_small * options.settled
    }
}

/// Follows `branch` from a point to the first zero of an event function. The first relative step is
/// at most `first_step`. Returns the last point as well.
pub(super) fn continue_to_event(
    branch: &mut impl Branch,
    mut at: Point,
    first_step: f64,
    options: &ContinuationOptions,
) -> (Result<Located, Undetermined>, Point) {
    let retry = Retry::Beyond(options.retry_share);
    let mut control = StepControl::new(first_step, options.largest_step, retry, options);
    let mut last = false;
    for _ in 0..options.most_trials {
        let gap = at.predict().step;
        let share = match at.own_slopes {
            true => options.share,
            false => options.first_share,
        };
        let mut step = control.step(at.v0, share * gap, 0.0);
        if (step < options.share * options.near || at.agrees(options)) && at.tells(options) {
            if at.settled > options.settled {
                step = 0.0;
            } else if last || gap < options.near || at.agrees(options) {
                return (locate(&at, options), at);
            } else {
                // One more step, beyond the v0 that failed.
                (last, step) = (true, options.last_step * options.near);
            }
        }
        let (next, settled) = (at.v0 * (1.0 + step), settled_after(step, options));
        match branch.orbit_at(next, Some(&at.orbit.period), settled) {
            Ok(orbit)
                if step > options.jump
                    && is_jump(&at.orbit.period, &orbit.period, step, options) =>
            {
                control.failed(next, step);
            }
            Ok(orbit) => {
                branch.accept();
                at = at.moved_to(next, orbit, settled);
                control.succeeded(next, step);
                last = false;
            }
            // Stick-slip is not sustained at the start.
            Err(NoReturn::StopMissed | NoReturn::LiftOff) if step == 0.0 => {
                return (Err(Undetermined::NotSustained), at);
            }
            Err(NoReturn::Undefined | NoReturn::NotSettled) if step < options.unsettled_step => {
                return (Err(Undetermined::NotSettled), at);
            }
            Err(NoReturn::OutsideDomain) => return (Err(Undetermined::OutsideDomain), at),
            Err(_) => control.failed(next, step),
        }
    }
    (Err(Undetermined::TooManyTrials), at)
}

/// The event predicted from the last point, if it is near.
fn locate(at: &Point, options: &ContinuationOptions) -> Result<Located, Undetermined> {
    let Prediction { step, event } = at.predict();
    let near = match at.agrees(options) {
        true => options.quite_near,
        false => options.near,
    };
    if step < near {
        let v0 = at.v0 * (1.0 + step);
        Ok(Located { event, v0 })
    } else {
        Err(Undetermined::NoEvent)
    }
}

/// Whether a relative `step` of v0 threw stick-slip from one kind to another: its mean cycle or
/// mean slip changed by more than such a step explains, or the number of its reversals changed.
pub(super) fn is_jump(
    before: &Period,
    after: &Period,
    step: f64,
    options: &ContinuationOptions,
) -> bool {
    let same = before.reversals() == after.reversals();
    !same || times_jump(before.mean_times(), after.mean_times(), step, options)
}

/// Whether a step was a jump as [`is_jump`] has it, by the durations of mean cycles and slips
/// alone.
pub(super) fn times_jump(
    before: [f64; 2],
    after: [f64; 2],
    step: f64,
    options: &ContinuationOptions,
) -> bool {
    let [cycle, slip] = [0, 1].map(|i| after[i] / before[i]);
    let shortest = options.shorter_cycle / (1.0 + step);
    // Where the time of a cycle is unknown, slips decide.
    let same_cycle = cycle.is_nan() || (shortest..=options.longer_cycle).contains(&cycle);
    !same_cycle || !(options.shorter_slip..=options.longer_slip).contains(&slip)
}

/// Follows `branch` as [`continue_to_event`] does, and then checks the event by a finer
/// integration. Where that gives another event, the branch is followed once more with it. The same
/// is done where v0 is so low that the coarse integration is not exact enough. An event that only
/// the coarse integration has is undetermined.
pub(super) fn continue_to_checked_event<B: Branch + Clone>(
    branch: &mut B,
    from: Point,
    first_step: f64,
    options: &ContinuationOptions,
) -> (Result<Located, Undetermined>, Point) {
    let (located, at) = continue_to_event(branch, from, first_step, options);
    if located.is_err() {
        return (located, at);
    }
    let finer = |by: f64| Accuracy::of(options.tolerance * by);
    if at.v0 < options.slow {
        branch.refine(finer(at.v0 / options.slow));
        return locate_again(branch, &at, options);
    }
    let roughly = branch.clone();
    let by = options.finer * power(options.fast / at.v0, 2).min(1.0);
    branch.refine(finer(by));
    if !is_same_event(branch, &at, options) {
        let (again, finely) = locate_again(branch, &at, options);
        if again.is_ok() {
            return (again, finely);
        }
        *branch = roughly;
        return (again, at);
    }
    *branch = roughly;
    (located, at)
}

/// Follows the last bit of the way to the event near `at` once more.
fn locate_again(
    branch: &mut impl Branch,
    at: &Point,
    options: &ContinuationOptions,
) -> (Result<Located, Undetermined>, Point) {
    let v0 = at.v0 * (1.0 - options.back);
    let Ok(orbit) = branch.orbit_at(v0, Some(&at.orbit.period), options.settled) else {
        return (Err(Undetermined::NotSustained), *at);
    };
    branch.accept();
    let from = Point {
        slopes: at.slopes,
        ..Point::first(v0, orbit, options.settled)
    };
    continue_to_event(branch, from, options.back, options)
}

/// Whether the branch, with its present accuracy, has the event where it was located before.
fn is_same_event(branch: &mut impl Branch, at: &Point, options: &ContinuationOptions) -> bool {
    let event = at.predict().event;
    match branch.orbit_at(at.v0, Some(&at.orbit.period), options.settled) {
        Ok(orbit) => {
            let change = orbit.events.of(event) - at.orbit.events.of(event);
            (change / at.slopes.of(event) / at.v0).abs() < options.same_event
        }
        Err(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::event_functions::Event;
    use super::super::synthetic::{Family, LOGISTIC, Synthetic, logistic_pair};
    use super::super::with_history::WithHistory;
    use super::*;

    /// Continues a branch of a synthetic map from `v0`, where its orbit is near `x`.
    fn continued(
        family: Family,
        (v0, x): (f64, f64),
        slips: usize,
    ) -> (Result<Located, Undetermined>, Point) {
        continued_by(0.1, family, (v0, x), slips)
    }

    /// Continues a branch of a synthetic map from `v0`, where its orbit is near `x`, with steps of
    /// at most `largest_step`.
    fn continued_by(
        largest_step: f64,
        family: Family,
        (v0, x): (f64, f64),
        slips: usize,
    ) -> (Result<Located, Undetermined>, Point) {
        let options = ContinuationOptions {
            largest_step,
            most_trials: 500,
            ..ContinuationOptions::default()
        };
        let map = Synthetic::new(family, v0, x);
        let mut branch = WithHistory::new(map, slips, 100.0, &options);
        let first = branch.first_point().unwrap();
        continue_to_checked_event(&mut branch, first, largest_step, &options)
    }

    #[test]
    fn every_event_is_located_where_its_function_vanishes() {
        for event in [
            Event::Graze(0),
            Event::LiftOff,
            Event::StickVanishes,
            Event::Reversal,
            Event::NewStop,
        ] {
            for v0 in [0.01, 0.3, 0.9] {
                let (found, _) = continued(Family::Vanishing(event), (v0, 0.5), 1);
                let found = found.unwrap();
                assert_eq!(found.event, event);
                assert!((found.v0 - 1.0).abs() < 1e-6, "{v0} {found:?}");
            }
        }
    }

    /// The depth of a stop is smooth where the orbit is a square root of the way to the graze.
    #[test]
    fn a_graze_is_located_although_the_map_is_a_square_root_there() {
        for s in [0.0, 1e-5, 1e-4] {
            let (found, at) = continued(Family::Nordmark(s), (0.2, 0.0), 1);
            let found = found.unwrap();
            assert_eq!(found.event, Event::Graze(0));
            assert!((found.v0 - 1.0).abs() < 1e-5, "{s} {found:?}");
            let depth = ((s * s + 1.0 - at.v0).sqrt() - s).powi(2);
            assert!((at.orbit.events.depth[0] - depth).abs() < 1e-6 * at.v0);
        }
    }

    /// The period doubles before the graze: small steps lose the branch there. Large ones may pass,
    /// since periods need not settle after them. So the end of a branch is checked.
    #[test]
    fn a_branch_that_loses_its_stability_is_not_settled() {
        for s in [0.1, 0.3_f64] {
            let doubles = 1.0 - 7.0 * s * s / 9.0;
            let (found, at) = continued_by(0.01, Family::Nordmark(s), (0.2, -0.1), 1);
            assert_eq!(found, Err(Undetermined::NotSettled), "{s}");
            assert!(at.v0 < doubles && at.v0 > 0.9 * doubles, "{s} {at:?}");
        }
        let (found, at) = continued_by(0.01, LOGISTIC, (2.2, 0.5), 1);
        assert_eq!(found, Err(Undetermined::NotSettled));
        assert!(at.v0 > 2.7 && at.v0 < 3.0, "{at:?}");
    }

    #[test]
    fn a_saddle_node_is_not_passed() {
        let (found, at) = continued_by(0.01, Family::SaddleNode, (0.3, 0.8), 1);
        assert_eq!(found, Err(Undetermined::NotSettled));
        assert!(at.v0 > 0.9 && at.v0 < 1.0, "{at:?}");
    }

    /// In a period of two slips the deeper one grazes; which one is deeper depends on the start.
    #[test]
    fn a_slip_of_a_doubled_period_grazes() {
        const GRAZE: f64 = 0.84;
        let (mut low, mut high) = (3.2, 3.45);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match logistic_pair(middle) < GRAZE {
                true => low = middle,
                false => high = middle,
            }
        }
        let pair = [
            logistic_pair(3.25),
            3.25 * logistic_pair(3.25) * (1.0 - logistic_pair(3.25)),
        ];
        for (slip, x) in pair.into_iter().enumerate() {
            let (found, _) = continued(Family::Logistic(GRAZE), (3.25, x), 2);
            let found = found.unwrap();
            assert_eq!(found.event, Event::Graze(slip));
            assert!((found.v0 - low).abs() < 1e-5, "{found:?} {low}");
        }
    }

    #[test]
    fn small_steps_have_to_settle_better() {
        let options = ContinuationOptions::default();
        let settled = [1.0, 0.1, 0.01, 1e-3].map(|step| settled_after(step, &options));
        assert!(settled.is_sorted_by(|a, b| a > b), "{settled:?}");
    }

    #[test]
    fn a_jump_is_more_than_a_step_explains() {
        let options = ContinuationOptions::default();
        let jumps = |cycle: f64, slip: f64, step| {
            times_jump([10.0, 4.0], [10.0 * cycle, 4.0 * slip], step, &options)
        };
        assert!(!jumps(0.9, 1.1, 0.0) && jumps(0.7, 1.1, 0.0));
        // Sticks shorten in proportion to v0.
        assert!(!jumps(0.5, 1.0, 1.0) && jumps(0.39, 1.0, 1.0));
        assert!(jumps(1.3, 1.0, 0.5) && jumps(1.0, 0.7, 0.5) && jumps(1.0, 1.5, 0.5));
        assert!(!times_jump([f64::NAN, 4.0], [f64::NAN, 4.4], 0.0, &options));
    }
}
