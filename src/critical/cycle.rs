//! One cycle of stick-slip: a slip and the stick after it, how far it is from a graze and from
//! lift-off; and periods of some.

use crate::slip::motion::{Event, Mode, Motion};

/// The most steps of a cycle.
const MOST_STEPS: u32 = 5_000;
/// How far from its expected time a minimum of ẋ still is the expected one, relative to the slip.
const SAME_MINIMUM: f64 = 0.25;
/// A minimum of ẋ that much before the expected stop, relative, is another one.
const ANOTHER: f64 = 0.1;
/// A slip that lasts that many times as long as expected has missed its stop.
const MISSED: f64 = 1.6;

/// One slip and the stick after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// Minimum of ẋ that the slip would have reached beyond its stop, ≤ 0 (minus the maximum, if it
    /// came to its stop backwards); 0 where the stop is a graze.
    pub depth: f64,
    /// From the stop until ẋ would have been at that minimum.
    pub to_minimum: f64,
    /// Duration of the slip.
    pub slip: f64,
    /// Duration of the stick after it; NaN where only the slip was followed.
    pub stick: f64,
    /// The smallest load.
    pub n_min: f64,
    /// How often it turns back on the way to its stop.
    pub reversals: u32,
    /// The force that is missing at the stop for the block to slip on, or back.
    pub hold: f64,
    /// The lowest minimum of ẋ > 0 before the stop; NaN where there is none.
    pub dip: f64,
}

impl Cycle {
    /// A period without cycles.
    pub const NONE: Self = Self {
        depth: f64::NAN,
        to_minimum: f64::NAN,
        slip: f64::NAN,
        stick: f64::NAN,
        n_min: f64::NAN,
        reversals: 0,
        hold: f64::NAN,
        dip: f64::NAN,
    };

    /// The stop that is expected after a small step of v0.
    #[must_use]
    pub fn stop(&self) -> Stop {
        Stop {
            slip: self.slip,
            to_minimum: self.to_minimum,
        }
    }
}

/// The most slips in a period that is followed.
pub const MOST_SLIPS: usize = 4;

/// One period of stick-slip: some cycles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Period {
    slips: usize,
    cycles: [Cycle; MOST_SLIPS],
}

/// The number of [`Period::gauges`].
pub const GAUGES: usize = MOST_SLIPS + 4;

impl Period {
    /// Of the first `slips` of `cycles`.
    #[must_use]
    pub fn new(slips: usize, cycles: [Cycle; MOST_SLIPS]) -> Self {
        Self { slips, cycles }
    }

    /// Of one slip.
    #[must_use]
    pub fn of(cycle: Cycle) -> Self {
        Self::new(1, [cycle; MOST_SLIPS])
    }

    /// Its cycles.
    #[must_use]
    pub fn cycles(&self) -> &[Cycle] {
        &self.cycles[..self.slips]
    }

    /// The durations of its mean cycle and slip.
    #[must_use]
    pub fn mean_times(&self) -> [f64; 2] {
        let slips = self.slips as f64;
        [self.slip_time() + self.stick_time(), self.slip_time()].map(|time| time / slips)
    }

    /// Time in slip.
    #[must_use]
    pub fn slip_time(&self) -> f64 {
        self.cycles().iter().map(|cycle| cycle.slip).sum()
    }

    /// Time stuck; NaN where sticks were not followed.
    #[must_use]
    pub fn stick_time(&self) -> f64 {
        self.cycles().iter().map(|cycle| cycle.stick).sum()
    }

    /// The stops that are expected after a small step of v0.
    #[must_use]
    pub fn stops(&self) -> [Stop; MOST_SLIPS] {
        self.cycles.map(|cycle| cycle.stop())
    }

    /// This period, begun `by` cycles later.
    #[must_use]
    pub fn rotated(mut self, by: usize) -> Self {
        self.cycles[..self.slips].rotate_left(by);
        self
    }

    /// The smallest load.
    #[must_use]
    pub fn n_min(&self) -> f64 {
        let loads = self.cycles().iter().map(|cycle| cycle.n_min);
        loads.fold(f64::INFINITY, f64::min)
    }

    /// Minus the distances to where stick-slip ends: the depth of every stop (NaN for slips that it
    /// does not have), the load, and the shortest stick (NaN where sticks were not followed). And
    /// minus those to where it becomes of another kind: the force that is missing for the block to
    /// turn back at a stop, and the lowest minimum of ẋ on the way to one.
    #[must_use]
    pub fn gauges(&self) -> [f64; GAUGES] {
        let mut gauges = [f64::NAN; GAUGES];
        for (gauge, cycle) in gauges.iter_mut().zip(self.cycles()) {
            *gauge = cycle.depth;
        }
        gauges[LOAD] = -self.n_min();
        let least = |of: fn(&Cycle) -> f64| self.cycles().iter().map(of).fold(f64::NAN, f64::min);
        gauges[STICK] = -least(|cycle| cycle.stick);
        gauges[TURN] = -least(|cycle| cycle.hold);
        gauges[DIP] = -least(|cycle| cycle.dip);
        gauges
    }
}

/// Which of the [`Period::gauges`] is the load.
pub const LOAD: usize = MOST_SLIPS;
/// The stick.
pub const STICK: usize = MOST_SLIPS + 1;
/// The force at a stop.
pub const TURN: usize = MOST_SLIPS + 2;
/// The minimum before a stop.
pub const DIP: usize = MOST_SLIPS + 3;

/// A stop that is expected: the slip until then, and the time from there to the minimum of ẋ that
/// it cuts off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    slip: f64,
    to_minimum: f64,
}

/// What became of a block that was released.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ride {
    /// It stopped, and stuck until it was released again.
    Cycle(Cycle),
    /// It passed the minimum of ẋ at which it was expected to stop, or did not stop for much longer
    /// than expected.
    Pass,
    /// N ≤ 0.
    LiftOff,
    /// It was released backwards, or went on for too long.
    Other,
}

/// Follows a block that was just released until its next release.
///
/// `expected` is the stop that is expected, if one is.
pub fn ride(motion: &mut Motion, expected: Option<Stop>) -> Ride {
    let start = motion.t;
    let mut stopped: Option<(f64, Cycle)> = None;
    let (mut n_min, mut reversals, mut dip) = (f64::INFINITY, 0, f64::NAN);
    for _ in 0..MOST_STEPS {
        let before = motion.t;
        let event = motion.advance(f64::INFINITY);
        if !(motion.u + motion.a).is_finite() {
            return Ride::Other;
        }
        n_min = motion.last_step().smallest_load(n_min);
        match (event, stopped) {
            (Some(Event::LiftOff), _) => return Ride::LiftOff,
            (Some(Event::Stick), None) => {
                let (to_minimum, depth) = motion.last_step().minimum_beyond_stop();
                let cycle = Cycle {
                    depth,
                    to_minimum,
                    slip: motion.t - start,
                    stick: f64::NAN,
                    n_min,
                    reversals,
                    hold: motion.hold_now(),
                    dip,
                };
                stopped = Some((motion.t, cycle));
            }
            (Some(Event::Release), Some((stop, cycle))) if motion.mode() == Mode::Forwards => {
                return Ride::Cycle(Cycle {
                    stick: motion.t - stop,
                    n_min,
                    ..cycle
                });
            }
            // It swings back, and may stop later.
            (Some(Event::Reversal), None) => reversals += 1,
            (Some(_), _) => return Ride::Other,
            (None, None) => {
                if let Some((_, u)) = motion.last_step().speed_minimum()
                    && u > 0.0
                {
                    dip = dip.min(u);
                }
                if let Some(expected) = expected
                    && passed(motion, before - start, expected)
                {
                    return Ride::Pass;
                }
            }
            (None, Some(_)) => {}
        }
        if expected.is_none() && stopped.is_none() && motion.t - start > LONGEST_SLIP {
            return Ride::Pass;
        }
    }
    Ride::Other
}

/// Slips last less than this before anything is known of them, in units of √(M/κ).
const LONGEST_SLIP: f64 = 60.0;

/// Whether the last step of a slip, `since` its release, shows that the stop `expected` does not
/// come.
fn passed(motion: &Motion, since: f64, expected: Stop) -> bool {
    let step = motion.last_step();
    let slip = expected.slip;
    let latest = slip + expected.to_minimum + SAME_MINIMUM * slip;
    let at_stop = |t: f64| t > (1.0 - ANOTHER) * slip && t < latest;
    if expected.to_minimum < slip
        && at_stop(since + step.length)
        && let Some((s, u)) = step.speed_minimum()
    {
        return u > 0.0 && at_stop(since + s);
    }
    since + step.length > MISSED * slip
}
