//! Whether a block goes on to stick from time to time, irregularly, or comes nearer and nearer to
//! sliding: what is seen of a motion whose outcome takes long.

use crate::slip::motion::{Event, Motion};
use crate::slip::outcome::Observer;

/// The part of the time waited within which the block has to be released for stick-slip to go on.
const RECENT: f64 = 0.25;
/// Released so often after long slips, it sticks again and again.
const RETURNS: u32 = 3;
/// Stretches of time in which minima of ẋ are compared, in that time.
const STRETCHES: f64 = 8.0;
/// Stretches in a row in which the lowest minimum has to rise for a slip to calm down.
const RISES: u32 = 16;

/// Sees whether the block still sticks from time to time, or comes nearer and nearer to sliding.
pub(super) struct Sticking {
    /// How long stick-slip is waited for to repeat.
    patience: f64,
    /// Until when it is.
    until: f64,
    now: f64,
    released: f64,
    /// How often it was released after it had slipped for long.
    returns: u32,
    /// Whether sliding is linearly stable.
    slides: bool,
    /// The end of this stretch, the lowest minimum of ẋ in it and in the one before, and rises in a
    /// row.
    stretch: f64,
    lowest: f64,
    before: f64,
    rises: u32,
}

impl Sticking {
    /// Of a motion that has just been released, at t = 0.
    pub(super) const fn new(patience: f64, slides: bool) -> Self {
        Self {
            patience,
            until: patience,
            now: 0.0,
            released: 0.0,
            returns: 0,
            slides,
            stretch: patience,
            lowest: f64::INFINITY,
            before: f64::INFINITY,
            rises: 0,
        }
    }

    fn recently(&self) -> bool {
        self.now - self.released < RECENT * self.patience
    }

    /// Whether it still sticks, for longer than it was waited for to do so periodically, or has
    /// come back to it again and again.
    pub(super) fn goes_on(&self) -> bool {
        self.now >= self.until && self.recently() || self.returns >= RETURNS
    }

    /// Whether it slips forwards, and has come nearer to stable sliding for long. That far from any
    /// stick only the amplitude of its oscillation is left to change, slowly, and goes on as it
    /// does.
    pub(super) fn calms_down(&self) -> bool {
        self.slides && self.rises >= RISES
    }

    fn see_minimum(&mut self, motion: &Motion) {
        let inside = motion.last_step().speed_minimum();
        self.lowest = self.lowest.min(inside.map_or(motion.u, |(_, u)| u));
        if self.now < self.stretch {
            return;
        }
        let rises = self.lowest > self.before && self.before > 0.0;
        self.rises = if rises { self.rises + 1 } else { 0 };
        self.before = std::mem::replace(&mut self.lowest, f64::INFINITY);
        self.stretch = self.now + self.patience / STRETCHES;
    }
}

impl Observer for Sticking {
    fn step(&mut self, motion: &Motion, event: Option<Event>) {
        self.now = motion.t;
        if event == Some(Event::Release) {
            if !self.recently() {
                // It had slipped for long: whether it goes on to stick is to be seen.
                self.until = self.now + self.patience;
                self.returns += 1;
            }
            self.released = self.now;
        }
        if self.slides && self.now > self.patience {
            self.see_minimum(motion);
        }
    }

    fn enough(&self) -> bool {
        self.goes_on() || self.calms_down()
    }
}
