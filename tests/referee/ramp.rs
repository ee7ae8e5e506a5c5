//! The critical velocity by the protocol `follow`: stick-slip under control is raised in v0 by
//! small steps, carrying the state. A step is halved whenever stick-slip is lost by it.

use std::collections::VecDeque;

use super::block::{Block, Event, Mode};
use super::setting::Setting;
use super::steps::Pace;

/// How a ramp goes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ramp {
    pub pace: Pace,
    /// The largest step of v0, relative.
    pub largest: f64,
    /// The most stops at one v0, while cycles do not repeat.
    pub stops: usize,
    pub begin: Begin,
}

/// How the block begins at the first v0. Where both begin in different stick-slip, v_c is more than
/// one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Begin {
    /// Released from a stick that has gone on for ever.
    Released,
    /// At rest, its spring long stretched to this share of what releases it.
    AtRest,
}

/// The share of what releases a block at rest.
const STRETCHED: f64 = 0.9;

impl Ramp {
    /// The block at the first v0; none where it lifts off.
    fn block(&self, setting: Setting) -> Option<Block> {
        match self.begin {
            Begin::Released => Block::released(setting, self.pace),
            Begin::AtRest => {
                let a = STRETCHED * setting.friction.mu_s * setting.load / setting.stiffness;
                Some(Block::at_rest_or_sliding(setting, self.pace, 0.0, a))
            }
        }
    }
}

/// Steps below this, relative, end a ramp. Towards its end stick-slip attracts from less and less
/// far: steps have to be much smaller than the precision that is wanted.
const PRECISION: f64 = 1e-7;
/// The largest v0, and those from which stick-slip is sought in turn, in units of μ_S N0/√(κM): the
/// protocol's.
const LARGEST: f64 = 100.0;
const STARTS: [f64; 6] = [1e-2, 1e-1, 1e-3, 1e-4, 1e-5, 1e-6];
/// The most v0 of a ramp.
const MOST_TRIALS: usize = 3000;
/// The most steps at one v0.
const MOST_STEPS: usize = 4_000_000;

/// How a ramp ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum End {
    /// Stick-slip is lost at this v0.
    Lost(f64),
    /// The block lifts off at this v0.
    LiftsOff(f64),
    /// Stick-slip persists at the largest v0.
    Persists,
    /// It is sustained at none of the v0 from which it may set out.
    Never,
    /// The ramp took too long.
    Unfinished,
}

impl End {
    /// Whether both end alike, at velocities that differ by no more than `precision`, relative.
    pub(crate) fn is_near(self, other: Self, precision: f64) -> bool {
        let near = |a: f64, b: f64| (a / b - 1.0).abs() <= precision;
        match (self, other) {
            (Self::Lost(a), Self::Lost(b)) | (Self::LiftsOff(a), Self::LiftsOff(b)) => near(a, b),
            _ => self == other,
        }
    }
}

/// What becomes of stick-slip at one v0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Fate {
    Sticks,
    Slips,
    LiftsOff,
    Unfinished,
}

/// Raises v0 until stick-slip ends. What is asked for is the smallest v0 of lift-off: where a start
/// lifts off, larger ones are not tried.
pub(crate) fn critical_velocity(setting: &Setting, ramp: Ramp) -> End {
    let s = setting;
    let unit = s.friction.mu_s * s.load / (s.stiffness * s.mass).sqrt();
    let mut lifted = f64::INFINITY;
    for start in STARTS.map(|start| (start * unit).max(s.of_v[0])) {
        if start > lifted {
            continue;
        }
        let slow = Setting {
            v0: start,
            switch_on: 0.0,
            ..setting.clone()
        };
        // Where a stick that outlasts the delay cannot be, it lifts off.
        let mut released = ramp.block(slow);
        let held = released.as_mut().map(|block| hold(block, ramp.stops));
        match (released, held) {
            (Some(block), Some(Fate::Sticks)) => {
                return raise(block, ramp, (LARGEST * unit).min(s.of_v[1]));
            }
            (None, _) | (_, Some(Fate::LiftsOff)) => lifted = start,
            _ => {}
        }
    }
    match lifted.is_finite() {
        true => End::LiftsOff(lifted),
        false => End::Never,
    }
}

/// From a block in stick-slip on.
fn raise(mut held: Block, ramp: Ramp, largest: f64) -> End {
    let (mut step, mut held_in_a_row) = (ramp.largest, 0);
    let mut last = Fate::Sticks;
    for _ in 0..MOST_TRIALS {
        let good = held.setting.v0;
        if good >= largest {
            return End::Persists;
        }
        if step < PRECISION {
            // It was lost by the step before, twice as long.
            let end = good * (1.0 + step);
            return match last {
                Fate::LiftsOff => End::LiftsOff(end),
                _ => End::Lost(end),
            };
        }
        let mut trial = held.clone();
        trial.set_v0((good * (1.0 + step)).min(largest));
        match hold(&mut trial, ramp.stops) {
            Fate::Sticks => {
                held = trial;
                held_in_a_row += 1;
                if held_in_a_row >= 3 {
                    step = (1.6 * step).min(ramp.largest);
                }
            }
            Fate::Unfinished => return End::Unfinished,
            fate => {
                (last, held_in_a_row) = (fate, 0);
                step *= 0.5;
            }
        }
    }
    End::Unfinished
}

/// Follows a block at its v0 until it has stuck so often, or so often that its cycles repeat; or
/// sticks no more.
pub(crate) fn hold(block: &mut Block, stops: usize) -> Fate {
    let mut seen = Stops::new();
    let mut swing = Swing::new(block);
    for _ in 0..MOST_STEPS {
        let event = block.advance(f64::INFINITY);
        if event == Some(Event::LiftOff) {
            return Fate::LiftsOff;
        }
        if event == Some(Event::Stick) && (seen.add(block.t) || seen.count >= stops) {
            return Fate::Sticks;
        }
        if block.mode == Mode::Stick {
            swing = Swing::new(block);
        } else if swing.see(block) {
            return Fate::Slips;
        }
    }
    Fate::Unfinished
}

/// The times of the last stops.
struct Stops {
    times: VecDeque<f64>,
    count: usize,
}

/// Periods of so many slips are recognised, and how well and how often they have to repeat.
const MOST_SLIPS: usize = 4;
const REPEATS: f64 = 1e-8;
const IN_A_ROW: usize = 4;

impl Stops {
    fn new() -> Self {
        Self {
            times: VecDeque::new(),
            count: 0,
        }
    }

    /// Says whether cycles have come to repeat.
    fn add(&mut self, t: f64) -> bool {
        self.times.push_front(t);
        self.times.truncate(2 * MOST_SLIPS + IN_A_ROW);
        self.count += 1;
        (1..=MOST_SLIPS).any(|slips| self.repeats(slips))
    }

    fn repeats(&self, slips: usize) -> bool {
        let period = |i: usize| Some(self.times.get(i)? - self.times.get(i + slips)?);
        let equal = |i: usize| {
            let (one, before) = (period(i)?, period(i + slips)?);
            Some((one - before).abs() <= REPEATS * one)
        };
        (0..IN_A_ROW).all(|i| equal(i) == Some(true))
    }
}

/// How far ẋ swings below v0 while a block slips on, window by window.
struct Swing {
    window: f64,
    until: f64,
    now: f64,
    /// The largest swings of the last windows, the last one first.
    windows: VecDeque<f64>,
    count: usize,
    far: f64,
}

/// A slip is waited for so many windows, and for as long after that as its swings grow, up to so
/// many.
const PATIENCE: usize = 24;
const MOST_WINDOWS: usize = 600;
const COMPARED: usize = 4;

impl Swing {
    fn new(block: &Block) -> Self {
        let s = &block.setting;
        let window = std::f64::consts::TAU * s.time() + s.tau;
        Self {
            window,
            until: block.t + window,
            now: 0.0,
            windows: VecDeque::new(),
            count: 0,
            far: 1e3 * (s.v0 + s.friction.mu_s * s.load / (s.stiffness * s.mass).sqrt()),
        }
    }

    /// Says whether the block slips for good.
    fn see(&mut self, block: &Block) -> bool {
        self.now = self.now.max(block.setting.v0 - block.u);
        if block.u.abs() > self.far {
            return true;
        }
        if block.t < self.until {
            return false;
        }
        self.windows.push_front(std::mem::take(&mut self.now));
        self.windows.truncate(2 * COMPARED);
        self.until = block.t + self.window;
        self.count += 1;
        self.count >= MOST_WINDOWS || self.count >= PATIENCE && !self.grows()
    }

    fn grows(&self) -> bool {
        let most =
            |windows: &mut dyn Iterator<Item = &f64>| windows.fold(0.0, |m: f64, w| m.max(*w));
        let late = most(&mut self.windows.iter().take(COMPARED));
        late > 1.0001 * most(&mut self.windows.iter().skip(COMPARED))
    }
}
