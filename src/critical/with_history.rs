//! The return map with its history: period after period of stick-slip, from one v0 to the next.
//!
//! The past of a block at its release is a function of time, smooth in v0 as long as stick-slip
//! stays of one kind. So a new v0 starts from an extrapolation of the pasts at the last two v0. The
//! transient that is left is of second order in the step of v0; without extrapolation it would be
//! of first order. The map is iterated from there until periods repeat ([`Iterates`]).

use super::continuation::{Branch, Orbit, Point, Releases};
use super::event_functions::{EventFunctions, MOST_SLIPS};
use super::fixed_point::Iterates;
use super::options::ContinuationOptions;
use super::problem::Problem;
use super::return_map::{Cycle, NoReturn, Period, ReturnMap, Stop};
use crate::slip::motion::{Accuracy, Motion, Stretch};

/// A state at the end of a period, and its v0; NaN where the state is meaningless.
#[derive(Debug, Clone)]
pub(super) struct Released<M> {
    map: M,
    period: Period,
    v0: f64,
}

impl<M: ReturnMap> Released<M> {
    /// Becomes the state expected at another v0 and delay: extrapolated from the `last` state and
    /// the one `before`, by `share` of the distance between them; false where that is not possible.
    fn extrapolate(
        &mut self,
        (last, before): (&mut Self, &mut Self),
        share: f64,
        (v0, tau): (f64, f64),
        options: &ContinuationOptions,
    ) -> bool {
        let (one, other) = (last.period.cycles(), before.period.cycles());
        let farthest = options.farthest_extrapolation;
        if !(share.abs() <= farthest && one.len() == other.len() && tau > 0.0) {
            return false;
        }
        let mut stretches = [Stretch {
            lengths: [f64::NAN; 3],
        }; 2 * MOST_SLIPS];
        let pairs = one.iter().zip(other).rev();
        let times = pairs.flat_map(|(p, q)| [(p.stick, q.stick), (p.slip, q.slip)]);
        for (stretch, (last, before)) in stretches.iter_mut().zip(times) {
            stretch.lengths = [last + share * (last - before), last, before];
        }
        let stretches = &stretches[..2 * one.len()];
        let alike = |s: &Stretch| {
            let [next, last, before] = s.lengths;
            next > 0.0 && last.min(before) > 0.0
        };
        if !stretches.iter().all(alike) {
            return false;
        }
        self.v0 = v0;
        let pasts = (&mut last.map, &mut before.map);
        self.map.extrapolate(pasts, share, (v0, tau), stretches)
    }

    /// Becomes the state of `other` at another v0.
    fn moved(&mut self, other: &Self, v0: f64) {
        self.map.copy_from(&other.map);
        self.map.set_v0(v0);
        self.v0 = v0;
    }
}

/// A branch of stick-slip with a fixed number of slips in a period.
#[derive(Debug, Clone)]
pub(super) struct WithHistory<'o, M> {
    options: &'o ContinuationOptions,
    /// v0 up to which the branch is followed.
    v_end: f64,
    slips: usize,
    tried: Released<M>,
    accepted: Released<M>,
    before: Released<M>,
    /// The event functions of the first period of the last trial.
    first: EventFunctions,
}

impl<M: ReturnMap> Releases for WithHistory<'_, M> {
    type Map = M;

    fn release_at(&mut self, v0: f64) -> &mut M {
        let share = (v0 - self.accepted.v0) / (self.accepted.v0 - self.before.v0);
        let tau = self.accepted.map.delay();
        let tried = &mut self.tried;
        let pasts = (&mut self.accepted, &mut self.before);
        if v0 == pasts.0.v0 || !tried.extrapolate(pasts, share, (v0, tau), self.options) {
            tried.moved(&self.accepted, v0);
        }
        &mut tried.map
    }
}

impl<M: ReturnMap> Branch for WithHistory<'_, M> {
    fn orbit_at(
        &mut self,
        v0: f64,
        expected: Option<&Period>,
        settled: f64,
    ) -> Result<Orbit, NoReturn> {
        #[cfg(test)]
        super::work::count_trial();
        if v0 > self.v_end {
            // Simulation does not search there either.
            return Err(NoReturn::OutsideDomain);
        }
        self.release_at(v0);
        self.iterate(expected, settled)
    }

    fn accept(&mut self) {
        if self.accepted.v0 != self.tried.v0 {
            std::mem::swap(&mut self.accepted, &mut self.before);
        }
        std::mem::swap(&mut self.accepted, &mut self.tried);
    }

    fn refine(&mut self, accuracy: Accuracy) {
        for state in [&mut self.accepted, &mut self.before, &mut self.tried] {
            state.map.refine(accuracy);
        }
    }
}

impl<'o> WithHistory<'o, Motion> {
    /// The branch of a `motion` in stick-slip of `problem` that was just released.
    pub(super) fn in_stick_slip(problem: &'o Problem, motion: Motion, slips: usize) -> Self {
        let options = &problem.options;
        let v_end = problem.v_max();
        Self::new(motion, slips, v_end, &options.continuation)
    }

    /// The branch of a block that is released from a stick without memory at `v0`, with its first
    /// point. It has one slip in a period.
    ///
    /// # Errors
    /// When the block does not stick again.
    pub(super) fn released(
        problem: &'o Problem,
        v0: f64,
        accuracy: Accuracy,
    ) -> Result<(Self, Point), NoReturn> {
        let motion = problem.released(v0, accuracy);
        let mut branch = Self::in_stick_slip(problem, motion, 1);
        let orbit = branch.orbit_at(v0, None, f64::INFINITY)?;
        branch.accept();
        Ok((branch, Point::first(v0, orbit, f64::INFINITY)))
    }
}

impl<'o, M: ReturnMap> WithHistory<'o, M> {
    /// The branch of a `map` that was just released in stick-slip of so many `slips`, at most
    /// [`MOST_SLIPS`], in a period. It is followed up to `v_end`.
    pub(super) fn new(map: M, slips: usize, v_end: f64, options: &'o ContinuationOptions) -> Self {
        let v0 = map.v0();
        let at = Released {
            map,
            period: Period::of(Cycle::NONE),
            v0,
        };
        Self {
            options,
            v_end,
            slips: slips.clamp(1, MOST_SLIPS),
            tried: at.clone(),
            before: Released {
                v0: f64::NAN,
                ..at.clone()
            },
            accepted: at,
            first: EventFunctions::UNKNOWN,
        }
    }

    /// The options of continuation.
    pub(super) fn options(&self) -> &'o ContinuationOptions {
        self.options
    }

    /// The state that was accepted last.
    pub(super) fn accepted(&self) -> &Released<M> {
        &self.accepted
    }

    /// The map of the state that was accepted last.
    pub(super) fn map(&self) -> &M {
        &self.accepted.map
    }

    /// The map that was tried last.
    pub(super) fn tried(&self) -> &M {
        &self.tried.map
    }

    /// The event functions of the first period of the last trial, before it came to rest.
    pub(super) fn first_events(&self) -> &EventFunctions {
        &self.first
    }

    /// Begins its period `by` slips later; false where the block does not get there.
    pub(super) fn rotate(&mut self, by: usize, period: &Period) -> bool {
        let stops = period.stops();
        let options = self.options;
        let cycles = |map: &mut M| {
            let mut stops = stops.iter().take(by);
            stops.all(|stop| map.cycle(Some(*stop), options).is_ok())
        };
        if !cycles(&mut self.before.map) {
            self.before.v0 = f64::NAN;
        }
        (self.accepted.period, self.before.period) = (
            self.accepted.period.rotated(by),
            self.before.period.rotated(by),
        );
        cycles(&mut self.accepted.map)
    }

    /// The point to begin with; none where there is no stick-slip.
    pub(super) fn first_point(&mut self) -> Option<Point> {
        let v0 = self.accepted.v0;
        let orbit = self.orbit_at(v0, None, f64::INFINITY).ok()?;
        self.accept();
        Some(Point::first(v0, orbit, f64::INFINITY))
    }

    /// Starts at another delay and `v0` from the state at which the branch ended. With a state
    /// `before` that ended at another delay, both pasts are extrapolated by `share` of the
    /// difference between them. The slopes are those of the point `like`.
    pub(super) fn restart(
        &mut self,
        before: Option<(&mut Released<M>, f64)>,
        (v0, tau): (f64, f64),
        like: &Point,
    ) -> Option<Point> {
        let (tried, accepted, options) = (&mut self.tried, &mut self.accepted, self.options);
        let told = before.is_some_and(|(before, share)| {
            tried.extrapolate((accepted, before), share, (v0, tau), options)
        });
        if !told {
            tried.map.copy_from(&self.accepted.map);
            tried.map.set_delay(tau);
            tried.map.set_v0(v0);
            tried.v0 = v0;
        }
        let settled = options.settled;
        let orbit = self.iterate(Some(&like.orbit.period), settled).ok()?;
        std::mem::swap(&mut self.accepted, &mut self.tried);
        // The state that was accepted before belongs to another delay.
        self.before.v0 = f64::NAN;
        Some(Point {
            slopes: like.slopes,
            own_slopes: false,
            ..Point::first(v0, orbit, settled)
        })
    }

    /// The corrector: iterates the map that is tried, period after period.
    fn iterate(&mut self, expected: Option<&Period>, settled: f64) -> Result<Orbit, NoReturn> {
        let (n, options) = (self.slips, self.options);
        let mut stops: Option<[Stop; MOST_SLIPS]> = expected.map(Period::stops);
        let mut iterates = Iterates::NONE;
        for _ in 0..options.most_periods.min(options.most_cycles / n) {
            let mut cycles = [Cycle::NONE; MOST_SLIPS];
            for (i, cycle) in cycles.iter_mut().enumerate().take(n) {
                let stop = stops.map(|stops| stops[i]);
                *cycle = self.tried.map.cycle(stop, options)?;
            }
            let orbit = Orbit::of(Period::new(n, cycles));
            stops = stops.map(|_| orbit.period.stops());
            self.tried.period = orbit.period;
            if iterates.none_yet() {
                self.first = orbit.events;
            }
            iterates.push(orbit.events);
            if settled == f64::INFINITY {
                return Ok(orbit);
            }
            if iterates.settled(settled, self.tried.v0, options) {
                let events = iterates.limits(options);
                return Ok(Orbit { events, ..orbit });
            }
        }
        Err(NoReturn::NotSettled)
    }
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::{Family, LOGISTIC, Synthetic, logistic_pair};
    use super::*;

    fn branch(family: Family, v0: f64, x: f64, slips: usize) -> WithHistory<'static, Synthetic> {
        static OPTIONS: std::sync::LazyLock<ContinuationOptions> =
            std::sync::LazyLock::new(ContinuationOptions::default);
        WithHistory::new(Synthetic::new(family, v0, x), slips, 100.0, &OPTIONS)
    }

    #[test]
    fn iteration_comes_to_the_orbit() {
        // The multiplier of the logistic map's fixed point is 2 − v0.
        for v0 in [1.7, 2.0, 2.4] {
            let mut branch = branch(LOGISTIC, v0, 1.0 - 1.05 / v0, 1);
            let orbit = branch.orbit_at(v0, None, 1e-3).unwrap();
            let x = 1.0 - 1.0 / v0;
            let error = orbit.events.depth[0] - (2.0 - x);
            assert!(error.abs() < 1e-4, "{v0} {error:e}");
        }
    }

    #[test]
    fn an_orbit_that_does_not_attract_is_not_come_to() {
        let mut one = branch(LOGISTIC, 3.2, 1.0 - 1.0 / 3.2 + 1e-3, 1);
        assert_eq!(
            one.orbit_at(3.2, None, 0.01).unwrap_err(),
            NoReturn::NotSettled
        );
        // The orbit with twice the slips attracts.
        let mut two = branch(LOGISTIC, 3.2, 0.75, 2);
        let orbit = two.orbit_at(3.2, None, 1e-4).unwrap();
        let depth = orbit.events.depth[0].min(orbit.events.depth[1]);
        let x = 2.0 - depth;
        assert!((x - logistic_pair(3.2)).abs() < 1e-4, "{x}");
    }

    /// Pasts at two v0 are extrapolated to a third: the transient is then of second order.
    #[test]
    fn the_past_is_extrapolated() {
        let mut branch = branch(LOGISTIC, 2.0, 0.5, 1);
        branch.first_point().unwrap();
        for v0 in [2.1, 2.2] {
            branch.orbit_at(v0, None, 1e-9).unwrap();
            branch.accept();
        }
        let x = |v0: f64| 1.0 - 1.0 / v0;
        let step = |v0: f64| (x(v0) - x(2.2)).abs();
        let off = (branch.release_at(2.3).x - x(2.3)).abs();
        assert!(off < 0.15 * step(2.3), "{off} {}", step(2.3));
        // Too far to extrapolate: it starts from the last past as it is.
        let off = (branch.release_at(2.6).x - x(2.6)).abs();
        assert!((off / step(2.6) - 1.0).abs() < 0.01, "{off} {}", step(2.6));
    }

    #[test]
    fn a_period_is_rotated() {
        let mut branch = branch(LOGISTIC, 3.2, 0.75, 2);
        let orbit = branch.orbit_at(3.2, None, 1e-4).unwrap();
        branch.accept();
        let before = branch.map().x;
        assert!(branch.rotate(1, &orbit.period));
        let after = branch.map().x;
        assert!((after - 3.2 * before * (1.0 - before)).abs() < 1e-15);
        let [depth, rotated] = [orbit.period, orbit.period.rotated(1)].map(|p| p.cycles()[0].depth);
        assert!((orbit.period.cycles()[1].depth - rotated).abs() < 1e-15 && depth != rotated);
    }

    #[test]
    fn no_v0_is_tried_beyond_the_end_of_the_range() {
        let mut branch = branch(Family::SaddleNode, 0.5, 0.7, 1);
        let found = branch.orbit_at(100.1, None, 0.05);
        assert_eq!(found.unwrap_err(), NoReturn::OutsideDomain);
    }

    #[test]
    fn all_states_are_refined() {
        let mut branch = branch(Family::SaddleNode, 0.5, 0.7, 1);
        branch.refine(Accuracy::of(1e-9));
        assert_eq!(branch.map().tolerance, 1e-9);
        assert_eq!(branch.release_at(0.51).tolerance, 1e-9);
    }

    #[test]
    fn another_delay_starts_from_the_same_past() {
        let mut branch = branch(Family::SaddleNode, 0.5, 0.7, 1);
        let at = branch.first_point().unwrap();
        let point = branch.restart(None, (0.45, 1.2), &at).unwrap();
        assert!(!point.own_slopes && point.v0 == 0.45);
        assert_eq!((branch.map().tau, branch.map().v0), (1.2, 0.45));
    }
}
