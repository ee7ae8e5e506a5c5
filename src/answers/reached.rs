//! Whether a motion reaches sliding by a time: asked where methods of control are compared.

use crate::slip::motion::{Event, Mode, Motion};
use crate::slip::outcome::Outcome;

/// Sliding is within this share of v0.
pub const SLIDING: f64 = 1e-3;
/// The share of the time at its end in which no stop may be.
pub const LAST: f64 = 0.25;
/// The most steps.
const MOST_STEPS: u32 = 10_000_000;

/// What a motion has come to by a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// From when the time counts, and until when, in the time of the motion.
    pub span: [f64; 2],
    /// Whether its readings are exact. Noise and rounding keep up a deviation: then only stops
    /// count.
    pub exact: bool,
}

/// Follows a motion to the end of the time that is asked. Sliding: no stop in the last quarter and
/// |ẋ/v0 − 1| < 10⁻³ at the end. Stick-slip: a stop in the last quarter.
pub fn reached(motion: &mut Motion, asked: Asked) -> Outcome {
    let [from, until] = asked.span;
    let late = until - LAST * (until - from);
    let mut last_stop = f64::NEG_INFINITY;
    for _ in 0..MOST_STEPS {
        if motion.t >= until {
            let off = (motion.u / motion.last_v0() - 1.0).abs();
            return match motion.mode() {
                _ if last_stop >= late => Outcome::StickSlip,
                Mode::Stick => Outcome::StickSlip,
                _ if off < SLIDING || !asked.exact => Outcome::Sliding,
                _ => Outcome::Oscillation,
            };
        }
        match motion.advance(until) {
            Some(Event::Stick | Event::Reversal) => last_stop = motion.t,
            Some(Event::LiftOff) => return Outcome::LiftOff,
            _ => {}
        }
        if motion.is_lost() {
            return Outcome::Undecided;
        }
    }
    Outcome::Undecided
}

/// What becomes of sliding while v0 changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fate {
    /// It lasts to the end.
    Held,
    /// The block first stops, or lifts off, at this v0, in the unit of the motion.
    Lost(f64),
    /// The steps ran out before the end, or the motion was lost.
    Unknown,
}

/// What becomes of a motion that begins in sliding by the time `until`.
pub fn fate(motion: &mut Motion, until: f64) -> Fate {
    for _ in 0..MOST_STEPS {
        if motion.t >= until {
            return Fate::Held;
        }
        if motion.is_lost() {
            return Fate::Unknown;
        }
        if let Some(Event::Stick | Event::Reversal | Event::LiftOff) = motion.advance(until) {
            return Fate::Lost(motion.parameters().v0);
        }
    }
    Fate::Unknown
}
