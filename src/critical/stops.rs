//! What is seen of stick-slip while it is followed: its last stops, and whether a block that slips
//! will stop again.

use crate::slip::motion::{Event, Mode, Motion};
use crate::slip::outcome::Observer;

/// How long a block that slips is waited for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Waiting {
    /// For a few cycles: v0 glides on.
    Brief,
    /// Until the minima of ẋ have not fallen for three windows of time.
    Short,
    /// A short wait, in which stick-slip that does not repeat is followed for many cycles.
    Lasting,
    /// Until the minima of ẋ have not fallen for ten windows of time.
    Long,
    /// Until the outcome of the motion is known.
    Patient,
}

impl Waiting {
    /// Stick-slip that does not repeat within so many cycles under the delay `tau` is irregular.
    #[must_use]
    pub(super) fn cycles(self, tau: f64) -> usize {
        match self {
            Self::Brief => 4 + (0.5 * tau) as usize,
            Self::Short => 12 + tau as usize,
            Self::Long | Self::Patient => 24 + tau as usize,
            Self::Lasting => 60 + (4.0 * tau) as usize,
        }
    }

    fn windows(self) -> u32 {
        match self {
            Self::Brief | Self::Short | Self::Lasting => 3,
            Self::Long => 10,
            Self::Patient => u32::MAX,
        }
    }
}

/// Stops that are remembered: as many as slips in the longest period that is recognised.
const RECENT: usize = 4;
/// A minimum lower than those before by more than this, relative, falls.
const FALLS: f64 = 1e-3;
/// How many times as large as the forces of stick-slip, and the speed of the pull, what grows
/// beyond bounds is.
const FAR: f64 = 100.0;
/// Windows without a fall at the end of a motion, after which it slips on.
const ENOUGH: u32 = 6;

/// Sees the stops of a motion, and the minima of ẋ where it does not stop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stops {
    /// When the last one was.
    pub last: f64,
    /// How many there were.
    pub count: u32,
    /// From the stop to where it would have gone, and the depth there.
    recent: [(f64, f64); RECENT],
    /// Whether sliding is linearly stable: then minima that rise go on rising.
    slides: bool,
    waiting: Waiting,
    window: f64,
    until: f64,
    lowest: f64,
    /// The lowest one of the window before: what has risen after a graze may fall again, to another
    /// kind of stick-slip.
    before: f64,
    windows: u32,
    /// Amplitudes beyond this are far from stick-slip.
    large: f64,
    far: bool,
    /// Windows in a row in which it did not fall.
    calm: u32,
}

impl Stops {
    /// Of a motion from now on; `slides`: whether sliding is linearly stable.
    #[must_use]
    pub(super) fn new(motion: &Motion, slides: bool, waiting: Waiting) -> Self {
        let p = motion.parameters();
        let delay = if p.switch_on.is_finite() { p.tau } else { 0.0 };
        let window = delay + 2.0 * std::f64::consts::TAU;
        Self {
            last: motion.t,
            count: 0,
            recent: [(f64::NAN, f64::NAN); RECENT],
            slides,
            waiting,
            window,
            until: motion.t + window,
            lowest: f64::INFINITY,
            before: f64::INFINITY,
            windows: 0,
            large: FAR * (p.law.mu_s() + p.v0 + motion.a.abs() + motion.u.abs()),
            far: false,
            calm: 0,
        }
    }

    /// The shallowest stop of the last period, of so many `slips`: the time to its minimum, and its
    /// depth.
    #[must_use]
    pub(super) fn shallowest(&self, slips: u32) -> (f64, f64) {
        let recent = (slips.max(1) as usize).min(RECENT).min(self.count as usize);
        let deepest = (f64::NAN, f64::NEG_INFINITY);
        (1..=recent).fold(deepest, |shallowest, back| {
            let stop = self.recent[(self.count as usize - back) % RECENT];
            if stop.1 > shallowest.1 {
                stop
            } else {
                shallowest
            }
        })
    }

    /// Whether the block has slipped for long and come no nearer to a stop.
    #[must_use]
    pub(super) fn slips_on(&self) -> bool {
        self.calm >= self.waiting.windows() || self.calm >= ENOUGH && 2 * self.calm >= self.windows
    }

    /// Whether it has grown far beyond stick-slip.
    #[must_use]
    pub(super) fn far(&self) -> bool {
        self.far
    }

    fn restart(&mut self, now: f64) {
        self.until = now + self.window;
        (self.lowest, self.before) = (f64::INFINITY, f64::INFINITY);
        (self.windows, self.calm) = (0, 0);
    }

    /// A window without a stop has passed.
    fn close(&mut self, now: f64) {
        self.windows += 1;
        let fell = self.lowest < (1.0 - FALLS) * self.before;
        // Where sliding is unstable an oscillation may grow again after it has decayed.
        let rose = !self.slides && self.lowest > (1.0 + FALLS) * self.before;
        self.calm = match fell || rose || self.before == f64::INFINITY {
            true => 0,
            false => self.calm + 1,
        };
        self.before = self.lowest;
        self.lowest = f64::INFINITY;
        self.until = now + self.window;
    }
}

impl Observer for Stops {
    fn step(&mut self, motion: &Motion, event: Option<Event>) {
        self.far = motion.a.abs() + motion.u.abs() > self.large;
        if event == Some(Event::Stick) {
            self.last = motion.t;
            self.recent[self.count as usize % RECENT] = motion.last_step().minimum_beyond_stop();
            self.count += 1;
        }
        if event.is_some() || motion.mode() == Mode::Stick {
            return self.restart(motion.t);
        }
        let inside = motion.last_step().speed_minimum();
        let lowest = inside.map_or(motion.u, |(_, u)| u);
        self.lowest = self.lowest.min(lowest);
        if motion.t >= self.until {
            self.close(motion.t);
        }
    }

    fn enough(&self) -> bool {
        self.calm >= self.waiting.windows() || self.far && self.waiting != Waiting::Patient
    }
}
