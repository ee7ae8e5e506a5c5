//! One cycle of stick-slip: a slip and the stick after it, and how far it is from a graze and from lift-off.

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
    /// Minimum of ẋ that the slip would have reached beyond its stop, ≤ 0; 0 where the stop is a graze.
    pub depth: f64,
    /// From the stop until ẋ would have been at that minimum.
    pub to_minimum: f64,
    /// Duration of the slip.
    pub slip: f64,
    /// Duration of the stick after it; NaN where only the slip was followed.
    pub stick: f64,
    /// The smallest load.
    pub n_min: f64,
}

impl Cycle {
    /// The stop that is expected after a small step of v0.
    #[must_use]
    pub fn stop(&self) -> Stop {
        Stop {
            slip: self.slip,
            to_minimum: self.to_minimum,
        }
    }
}

/// A stop that is expected: the slip until then, and the time from there to the minimum of ẋ that it cuts off.
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
    /// It passed the minimum of ẋ at which it was expected to stop, or did not stop for much longer than expected.
    Pass,
    /// N ≤ 0.
    LiftOff,
    /// It slipped backwards, or went on for too long.
    Other,
}

/// Follows a block that was just released until its next release; or until it stops, if it is `slip_only`.
///
/// `expected` is the stop that is expected, if one is.
pub fn ride(motion: &mut Motion, expected: Option<Stop>, slip_only: bool) -> Ride {
    let start = motion.t;
    let mut stopped: Option<(f64, Cycle)> = None;
    let mut n_min = f64::INFINITY;
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
                };
                if slip_only {
                    return Ride::Cycle(cycle);
                }
                stopped = Some((motion.t, cycle));
            }
            (Some(Event::Release), Some((stop, cycle))) if motion.mode() == Mode::Forwards => {
                return Ride::Cycle(Cycle {
                    stick: motion.t - stop,
                    n_min,
                    ..cycle
                });
            }
            (Some(_), _) => return Ride::Other,
            (None, None) => {
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

/// Whether the last step of a slip, `since` its release, shows that the stop `expected` does not come.
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
