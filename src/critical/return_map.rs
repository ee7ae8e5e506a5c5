//! The return map: one slip and the stick after it, from a release to the next.
//!
//! The state at a release is the elongation over the last delay ([`super`], Eq. 1). The map is that
//! of a [`Motion`]; tests put others with closed forms in its place.

use super::event_functions::{EventFunctions, MOST_SLIPS};
use super::options::ContinuationOptions;
use crate::slip::motion::{Accuracy, Event, Mode, Motion, Stretch};

/// One slip and the stick after it. Times in √(M/κ), velocities in N0/√(κM), forces in N0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cycle {
    /// The depth of the stop, ≥ 0: how far below 0 the minimum of ẋ lies that it cut off, or above
    /// 0 the maximum of a slip backwards. 0 where the stop is a graze.
    pub depth: f64,
    /// Time from the stop to the minimum of ẋ that it cut off, or to the maximum of a slip
    /// backwards.
    pub to_minimum: f64,
    /// Duration of the slip.
    pub slip: f64,
    /// Duration of the stick after the slip.
    pub stick: f64,
    /// The smallest load.
    pub n_min: f64,
    /// The number of reversals on the way to the stop.
    pub reversals: u32,
    /// The force that the block lacks at the stop to slip on, or back.
    pub missing_force: f64,
    /// The lowest minimum of ẋ > 0 before the stop; NaN where there is none.
    pub dip: f64,
}

impl Cycle {
    /// A cycle of which nothing is known.
    pub(super) const NONE: Self = Self {
        depth: f64::NAN,
        to_minimum: f64::NAN,
        slip: f64::NAN,
        stick: f64::NAN,
        n_min: f64::NAN,
        reversals: 0,
        missing_force: f64::NAN,
        dip: f64::NAN,
    };

    /// The stop that is expected after a small step of v0.
    pub(super) fn stop(&self) -> Stop {
        Stop {
            slip: self.slip,
            to_minimum: self.to_minimum,
        }
    }
}

/// A stop that is expected: the slip until then, and the time from there to the minimum of ẋ that
/// it cuts off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stop {
    slip: f64,
    to_minimum: f64,
}

/// One period of stick-slip: one to [`MOST_SLIPS`] cycles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Period {
    slips: usize,
    cycles: [Cycle; MOST_SLIPS],
}

impl Period {
    /// A period of the first `slips` of `cycles`.
    pub(super) fn new(slips: usize, cycles: [Cycle; MOST_SLIPS]) -> Self {
        Self { slips, cycles }
    }

    /// A period of one slip.
    pub(super) fn of(cycle: Cycle) -> Self {
        Self::new(1, [cycle; MOST_SLIPS])
    }

    /// The cycles of the period.
    pub(super) fn cycles(&self) -> &[Cycle] {
        &self.cycles[..self.slips]
    }

    /// The durations of the mean cycle and slip of the period.
    pub(super) fn mean_times(&self) -> [f64; 2] {
        let slips = self.slips as f64;
        [self.slip_time() + self.stick_time(), self.slip_time()].map(|time| time / slips)
    }

    /// Time in slip.
    pub(super) fn slip_time(&self) -> f64 {
        self.cycles().iter().map(|cycle| cycle.slip).sum()
    }

    /// Time stuck.
    pub(super) fn stick_time(&self) -> f64 {
        self.cycles().iter().map(|cycle| cycle.stick).sum()
    }

    /// The smallest load.
    pub(super) fn n_min(&self) -> f64 {
        let loads = self.cycles().iter().map(|cycle| cycle.n_min);
        loads.fold(f64::INFINITY, f64::min)
    }

    /// The number of reversals.
    pub(super) fn reversals(&self) -> u32 {
        self.cycles().iter().map(|cycle| cycle.reversals).sum()
    }

    /// The stops that are expected after a small step of v0.
    pub(super) fn stops(&self) -> [Stop; MOST_SLIPS] {
        self.cycles.map(|cycle| cycle.stop())
    }

    /// This period, begun `by` cycles later.
    pub(super) fn rotated(mut self, by: usize) -> Self {
        self.cycles[..self.slips].rotate_left(by);
        self
    }

    /// The event functions of the period.
    pub(super) fn event_functions(&self) -> EventFunctions {
        let least = |of: fn(&Cycle) -> f64| self.cycles().iter().map(of).fold(f64::NAN, f64::min);
        let mut depth = [f64::NAN; MOST_SLIPS];
        for (depth, cycle) in depth.iter_mut().zip(self.cycles()) {
            *depth = cycle.depth;
        }
        EventFunctions {
            depth,
            load: self.n_min(),
            stick_time: least(|cycle| cycle.stick),
            missing_force: least(|cycle| cycle.missing_force),
            dip: least(|cycle| cycle.dip),
        }
    }
}

/// Why there is no image under the return map, or none within the range that is searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoReturn {
    /// The block passed the minimum of ẋ at which it was expected to stop, or did not stop for much
    /// longer than expected.
    StopMissed,
    /// N ≤ 0.
    LiftOff,
    /// The block was released backwards, or took too many steps.
    Undefined,
    /// Periods did not come to rest.
    NotSettled,
    /// v0 is above the range that is searched, or a stick is too short to erase the memory.
    OutsideDomain,
}

/// A return map with its state: from one release to the next at one v0. That of the oscillator is
/// [`Motion`].
///
/// Dispatch is static.
pub(super) trait ReturnMap: Clone {
    /// v0, in N0/√(κM).
    fn v0(&self) -> f64;

    /// Changes v0 from now on.
    fn set_v0(&mut self, v0: f64);

    /// The delay, in √(M/κ).
    fn delay(&self) -> f64;

    /// Changes the delay from now on.
    fn set_delay(&mut self, tau: f64);

    /// Becomes a copy of `other` in the memory that it has.
    fn copy_from(&mut self, other: &Self);

    /// Goes on with another accuracy.
    fn refine(&mut self, accuracy: Accuracy);

    /// Becomes the state at `v0` and the delay `tau`, extrapolated from two `pasts`, the last one
    /// and the one before: the last one plus `share` of the difference between them. Slips and
    /// sticks are aligned by `stretches`, the last one first. False where that is not possible; the
    /// state is then meaningless.
    fn extrapolate(
        &mut self,
        pasts: (&mut Self, &mut Self),
        share: f64,
        at: (f64, f64),
        stretches: &[Stretch],
    ) -> bool;

    /// Follows the block, which was just released, until its next release. `expected` is the stop
    /// that is expected, if one is.
    ///
    /// # Errors
    /// See [`NoReturn`].
    fn cycle(
        &mut self,
        expected: Option<Stop>,
        options: &ContinuationOptions,
    ) -> Result<Cycle, NoReturn>;
}

impl ReturnMap for Motion {
    fn v0(&self) -> f64 {
        self.parameters().v0
    }

    fn set_v0(&mut self, v0: f64) {
        Self::set_v0(self, v0);
    }

    fn delay(&self) -> f64 {
        self.parameters().feedback.tau
    }

    fn set_delay(&mut self, tau: f64) {
        Self::set_delay(self, tau);
    }

    fn copy_from(&mut self, other: &Self) {
        Self::copy_from(self, other);
    }

    fn refine(&mut self, accuracy: Accuracy) {
        Self::refine(self, accuracy);
    }

    fn extrapolate(
        &mut self,
        pasts: (&mut Self, &mut Self),
        share: f64,
        at: (f64, f64),
        stretches: &[Stretch],
    ) -> bool {
        Self::extrapolate(self, pasts, share, at, stretches)
    }

    fn cycle(
        &mut self,
        expected: Option<Stop>,
        options: &ContinuationOptions,
    ) -> Result<Cycle, NoReturn> {
        let start = self.t;
        let mut stopped: Option<(f64, Cycle)> = None;
        let (mut n_min, mut reversals, mut dip) = (f64::INFINITY, 0, f64::NAN);
        for _ in 0..options.steps_of_cycle {
            #[cfg(test)]
            super::work::count_step();
            let before = self.t;
            let event = self.advance(f64::INFINITY);
            if !(self.u + self.a).is_finite() {
                return Err(NoReturn::Undefined);
            }
            n_min = self.smallest_load(n_min);
            match (event, stopped) {
                (Some(Event::LiftOff), _) => return Err(NoReturn::LiftOff),
                (Some(Event::Stick), None) => {
                    let (to_minimum, minimum) = self.last_step().minimum_beyond_stop();
                    let cycle = Cycle {
                        depth: -minimum,
                        to_minimum,
                        slip: self.t - start,
                        reversals,
                        missing_force: self.hold_now(),
                        dip,
                        ..Cycle::NONE
                    };
                    stopped = Some((self.t, cycle));
                }
                (Some(Event::Release), Some((stop, cycle))) if self.mode() == Mode::Forwards => {
                    return Ok(Cycle {
                        stick: self.t - stop,
                        n_min,
                        ..cycle
                    });
                }
                // The block swings back, and may stop later.
                (Some(Event::Reversal), None) => reversals += 1,
                (Some(_), _) => return Err(NoReturn::Undefined),
                (None, None) => {
                    if let Some((_, u)) = self.last_step().speed_minimum()
                        && u > 0.0
                    {
                        dip = dip.min(u);
                    }
                    let missed = |stop| misses(self, before - start, stop, options);
                    if expected.is_some_and(missed) {
                        return Err(NoReturn::StopMissed);
                    }
                }
                (None, Some(_)) => {}
            }
            let unknown = expected.is_none() && stopped.is_none();
            if unknown && self.t - start > options.longest_slip {
                return Err(NoReturn::StopMissed);
            }
        }
        Err(NoReturn::Undefined)
    }
}

/// Whether the last step of a slip shows that the `expected` stop is missed. The step begins a time
/// `since` after the release.
fn misses(motion: &Motion, since: f64, expected: Stop, options: &ContinuationOptions) -> bool {
    let step = motion.last_step();
    let slip = expected.slip;
    let latest = slip + expected.to_minimum + options.same_minimum * slip;
    let at_stop = |t: f64| t > (1.0 - options.same_minimum) * slip && t < latest;
    if expected.to_minimum < slip
        && at_stop(since + step.length)
        && let Some((s, u)) = step.speed_minimum()
    {
        return u > 0.0 && at_stop(since + s);
    }
    since + step.length > options.missed_stop * slip
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::letters;
    use super::*;

    fn cycle(slip: f64, stick: f64) -> Cycle {
        Cycle {
            depth: 0.1 * slip,
            slip,
            stick,
            n_min: 1.0 - 0.1 * slip,
            missing_force: stick,
            ..Cycle::NONE
        }
    }

    /// The cycle of the letter's Fig. 3 at v0 = 0.35, under a negligible gain.
    #[test]
    fn one_slip_and_stick() {
        let options = ContinuationOptions::default();
        let problem = letters(1e-12, 0.0, 4.15);
        let mut motion = problem.released(0.35, Accuracy::of(1e-10));
        let first = motion.cycle(None, &options).unwrap();
        assert!((first.slip - 3.97549563).abs() < 1e-7, "{first:?}");
        assert!((first.stick - 4.92001175).abs() < 1e-7, "{first:?}");
        assert!(first.depth > 0.0 && first.missing_force > 0.0);
        assert!((first.n_min - 1.0).abs() < 1e-12 && first.reversals == 0);
        let again = motion.cycle(Some(first.stop()), &options).unwrap();
        assert!((again.slip - first.slip).abs() < 1e-7);
    }

    #[test]
    fn a_stop_that_does_not_come_is_missed() {
        let options = ContinuationOptions::default();
        // Beyond v_c = 0.344467 the slip passes where it was expected to stop.
        let problem = letters(-0.33, 0.0, 4.15);
        let mut motion = problem.released(0.5, Accuracy::of(1e-8));
        let expected = cycle(4.0, 2.0).stop();
        assert_eq!(
            motion.cycle(Some(expected), &options),
            Err(NoReturn::StopMissed)
        );
        let mut motion = problem.released(0.5, Accuracy::of(1e-8));
        assert_eq!(motion.cycle(None, &options), Err(NoReturn::StopMissed));
        // The load reaches 0 while the block slips fast.
        let problem = letters(0.0, -3.0, 2.0);
        let mut motion = problem.released(1.0, Accuracy::of(1e-8));
        assert_eq!(motion.cycle(None, &options), Err(NoReturn::LiftOff));
        let few = ContinuationOptions {
            steps_of_cycle: 3,
            ..options
        };
        let mut motion = letters(0.0, 0.0, 1.0).released(0.35, Accuracy::of(1e-8));
        assert_eq!(motion.cycle(None, &few), Err(NoReturn::Undefined));
    }

    #[test]
    fn a_period_sums_and_compares_its_cycles() {
        let both = [cycle(3.0, 1.0), cycle(4.0, 0.5), Cycle::NONE, Cycle::NONE];
        let period = Period::new(2, both);
        assert_eq!((period.slip_time(), period.stick_time()), (7.0, 1.5));
        assert_eq!(period.mean_times(), [4.25, 3.5]);
        let found = period.event_functions();
        assert!((found.depth[1] - 0.4).abs() < 1e-15 && found.depth[2].is_nan());
        assert_eq!((found.load, found.stick_time), (0.6, 0.5));
        assert!(found.dip.is_nan());
        let rotated = period.rotated(1);
        let slips: Vec<f64> = rotated.cycles().iter().map(|cycle| cycle.slip).collect();
        assert_eq!(slips, [4.0, 3.0]);
    }
}
