//! Observers of stick-slip while it is simulated: its last stops, whether a block that slips will
//! stop again, and whether one whose outcome takes long goes on to stick or calms down.

use super::event_functions::MOST_SLIPS;
use super::options::{RampOptions, SwitchOnOptions};
use crate::slip::motion::{Event, Mode, Motion};
use crate::slip::outcome::Observer;

/// How long to wait for a block that slips.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Waiting {
    /// A wait of a few cycles: v0 glides on.
    Brief,
    /// A wait until the minima of ẋ have not fallen for three windows of time.
    Short,
    /// A short wait, in which stick-slip that does not repeat is followed for many cycles.
    Lasting,
    /// A wait until the minima of ẋ have not fallen for ten windows of time.
    Long,
    /// A wait until the outcome of the motion is known.
    Patient,
}

impl Waiting {
    /// The number of cycles within which stick-slip has to repeat under the delay `tau`. Else it is
    /// irregular.
    pub(super) fn cycles(self, tau: f64, options: &RampOptions) -> usize {
        let [always, of_delay] = match self {
            Self::Brief => options.cycles_gliding,
            Self::Short => options.cycles,
            Self::Long | Self::Patient => options.cycles_at_length,
            Self::Lasting => options.cycles_near_end,
        };
        always as usize + (of_delay * tau) as usize
    }

    fn windows(self, options: &RampOptions) -> u32 {
        match self {
            Self::Brief | Self::Short | Self::Lasting => options.windows,
            Self::Long => options.windows_at_length,
            Self::Patient => u32::MAX,
        }
    }
}

/// The depth of a stop, which is small near a graze.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShallowStop {
    /// Time from the stop to the minimum of ẋ that it cut off.
    pub to_minimum: f64,
    /// How far below 0 that minimum is.
    pub depth: f64,
}

impl ShallowStop {
    const UNKNOWN: Self = Self {
        to_minimum: f64::NAN,
        depth: f64::NAN,
    };
}

/// Observes the stops of a motion, and the minima of ẋ where it does not stop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stops<'o> {
    options: &'o RampOptions,
    /// Time of the last stop.
    pub last: f64,
    /// Number of stops.
    pub count: u32,
    /// The last stops: as many as slips in the longest period that is recognised.
    recent: [ShallowStop; MOST_SLIPS],
    /// Whether sliding is linearly stable: then minima that rise go on rising.
    slides: bool,
    waiting: Waiting,
    window: f64,
    until: f64,
    lowest: f64,
    /// The lowest minimum of the window before. After a graze minima may rise and fall again, to
    /// another kind of stick-slip.
    before: f64,
    windows: u32,
    /// Amplitudes beyond this are far from stick-slip.
    large: f64,
    far: bool,
    /// Windows in a row in which the lowest minimum did not fall.
    calm: u32,
}

impl<'o> Stops<'o> {
    /// An observer of `motion` from now on. `slides` says whether sliding is linearly stable.
    pub(super) fn new(
        motion: &Motion,
        slides: bool,
        waiting: Waiting,
        options: &'o RampOptions,
    ) -> Self {
        let p = motion.parameters();
        let delay = if p.switch_on.is_finite() {
            p.feedback.remembered()
        } else {
            0.0
        };
        let window = delay + 2.0 * std::f64::consts::TAU;
        Self {
            options,
            last: motion.t,
            count: 0,
            recent: [ShallowStop::UNKNOWN; MOST_SLIPS],
            slides,
            waiting,
            window,
            until: motion.t + window,
            lowest: f64::INFINITY,
            before: f64::INFINITY,
            windows: 0,
            large: options.far * (p.law.mu_s() + p.v0 + motion.a.abs() + motion.u.abs()),
            far: false,
            calm: 0,
        }
    }

    /// The shallowest stop of the last period, which has so many `slips`.
    pub(super) fn shallowest(&self, slips: u32) -> ShallowStop {
        let count = self.count as usize;
        let recent = (slips.max(1) as usize).min(MOST_SLIPS).min(count);
        let deepest = ShallowStop {
            depth: f64::INFINITY,
            ..ShallowStop::UNKNOWN
        };
        (1..=recent).fold(deepest, |shallowest, back| {
            let stop = self.recent[(count - back) % MOST_SLIPS];
            match stop.depth < shallowest.depth {
                true => stop,
                false => shallowest,
            }
        })
    }

    /// Whether the block has slipped for long and come no nearer to a stop.
    pub(super) fn slips_on(&self) -> bool {
        let windows = self.waiting.windows(self.options);
        let at_last = self.calm >= self.options.windows_at_last;
        self.calm >= windows || at_last && 2 * self.calm >= self.windows
    }

    /// Whether the motion has grown far beyond stick-slip.
    pub(super) fn far(&self) -> bool {
        self.far
    }

    fn restart(&mut self, now: f64) {
        self.until = now + self.window;
        (self.lowest, self.before) = (f64::INFINITY, f64::INFINITY);
        (self.windows, self.calm) = (0, 0);
    }

    /// Ends a window without a stop.
    fn close(&mut self, now: f64) {
        let falls = self.options.falls;
        self.windows += 1;
        let fell = self.lowest < (1.0 - falls) * self.before;
        // Where sliding is unstable an oscillation may grow again after it has decayed.
        let rose = !self.slides && self.lowest > (1.0 + falls) * self.before;
        self.calm = match fell || rose || self.before == f64::INFINITY {
            true => 0,
            false => self.calm + 1,
        };
        self.before = self.lowest;
        self.lowest = f64::INFINITY;
        self.until = now + self.window;
    }
}

impl Observer for Stops<'_> {
    fn step(&mut self, motion: &Motion, event: Option<Event>) {
        self.far = motion.a.abs() + motion.u.abs() > self.large;
        if event == Some(Event::Stick) {
            self.last = motion.t;
            let (to_minimum, minimum) = motion.last_step().minimum_beyond_stop();
            self.recent[self.count as usize % MOST_SLIPS] = ShallowStop {
                to_minimum,
                depth: -minimum,
            };
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
        self.calm >= self.waiting.windows(self.options)
            || self.far && self.waiting != Waiting::Patient
    }
}

/// Observes whether the block still sticks from time to time, or comes nearer and nearer to
/// sliding.
pub(super) struct Sticking<'o> {
    options: &'o SwitchOnOptions,
    /// How long to wait for stick-slip to repeat.
    patience: f64,
    /// The time until which to wait for stick-slip to repeat.
    until: f64,
    now: f64,
    released: f64,
    /// How often the block was released after a long slip.
    returns: u32,
    /// Whether sliding is linearly stable.
    slides: bool,
    /// The end of this window, the lowest minimum of ẋ in it and in the one before, and rises in a
    /// row.
    window: f64,
    lowest: f64,
    before: f64,
    rises: u32,
}

impl<'o> Sticking<'o> {
    /// An observer of a motion that has just been released, at t = 0.
    pub(super) const fn new(patience: f64, slides: bool, options: &'o SwitchOnOptions) -> Self {
        Self {
            options,
            patience,
            until: patience,
            now: 0.0,
            released: 0.0,
            returns: 0,
            slides,
            window: patience,
            lowest: f64::INFINITY,
            before: f64::INFINITY,
            rises: 0,
        }
    }

    fn recently(&self) -> bool {
        self.now - self.released < self.options.recent * self.patience
    }

    /// Whether stick-slip goes on: the block still sticks after the time to wait for a repetition,
    /// or has come back to sticking again and again.
    pub(super) fn goes_on(&self) -> bool {
        self.now >= self.until && self.recently() || self.returns >= self.options.returns
    }

    /// Whether the block slips forwards and has come nearer to stable sliding for long. That far
    /// from any stick only the amplitude of its oscillation changes, slowly and in one direction.
    pub(super) fn calms_down(&self) -> bool {
        self.slides && self.rises >= self.options.rises
    }

    fn see_minimum(&mut self, motion: &Motion) {
        let inside = motion.last_step().speed_minimum();
        self.lowest = self.lowest.min(inside.map_or(motion.u, |(_, u)| u));
        if self.now < self.window {
            return;
        }
        let rises = self.lowest > self.before && self.before > 0.0;
        self.rises = if rises { self.rises + 1 } else { 0 };
        self.before = std::mem::replace(&mut self.lowest, f64::INFINITY);
        self.window = self.now + self.patience / self.options.windows;
    }
}

impl Observer for Sticking<'_> {
    fn step(&mut self, motion: &Motion, event: Option<Event>) {
        self.now = motion.t;
        if event == Some(Event::Release) {
            if !self.recently() {
                // After a long slip the wait for a repetition begins anew.
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

#[cfg(test)]
mod tests {
    use super::super::synthetic::letters;
    use super::*;
    use crate::slip::motion::Accuracy;

    fn seen<'o>(
        motion: &mut Motion,
        waiting: Waiting,
        options: &'o RampOptions,
        until: f64,
    ) -> Stops<'o> {
        let mut stops = Stops::new(motion, true, waiting, options);
        while motion.t < until && !stops.enough() {
            let event = motion.advance(until);
            stops.step(motion, event);
        }
        stops
    }

    /// The letter's Fig. 3(a), whose stick-slip ends at 0.344467.
    #[test]
    fn stops_are_counted_and_their_absence_is_seen() {
        let options = RampOptions::default();
        let problem = letters(-0.33, 0.0, 4.15);
        let mut sticks = problem.released(0.2, Accuracy::of(1e-8));
        let stops = seen(&mut sticks, Waiting::Short, &options, 300.0);
        assert!(stops.count > 10 && stops.last > 270.0 && !stops.slips_on());
        let [one, four] = [1, 4].map(|slips| stops.shallowest(slips));
        assert!(one.depth > 0.0 && four.depth <= one.depth && one.to_minimum > 0.0);

        let mut slides = problem.released(0.5, Accuracy::of(1e-8));
        let stops = seen(&mut slides, Waiting::Short, &options, 1e4);
        let short = slides.t;
        assert!(stops.slips_on() && stops.count == 0 && !stops.far());
        assert!(stops.shallowest(1).to_minimum.is_nan());
        let mut slides = problem.released(0.5, Accuracy::of(1e-8));
        seen(&mut slides, Waiting::Long, &options, 1e4);
        assert!(slides.t > 2.0 * short, "{} {short}", slides.t);
    }

    #[test]
    fn what_grows_beyond_bounds_is_far() {
        let options = RampOptions::default();
        let problem = letters(0.9, 0.0, 2.0);
        let mut motion = problem.released(0.5, Accuracy::of(1e-8));
        let stops = seen(&mut motion, Waiting::Long, &options, 1e4);
        assert!(stops.far() && stops.enough(), "{}", motion.a);
    }

    #[test]
    fn more_cycles_are_waited_for_near_the_end_and_at_long_delays() {
        let options = RampOptions::default();
        let cycles = |waiting: Waiting| waiting.cycles(10.0, &options);
        assert_eq!(cycles(Waiting::Brief), 9);
        assert_eq!(cycles(Waiting::Short), 22);
        assert_eq!(cycles(Waiting::Long), 34);
        assert_eq!(cycles(Waiting::Lasting), 100);
        assert_eq!(cycles(Waiting::Patient), cycles(Waiting::Long));
    }

    #[test]
    fn a_block_sticks_again_and_again_or_calms_down() {
        let options = SwitchOnOptions::default();
        let problem = letters(-0.33, 0.0, 4.15);
        let follow = |v0: f64| {
            let mut motion = problem.released(v0, Accuracy::of(1e-8));
            let mut sticking = Sticking::new(100.0, true, &options);
            while motion.t < 5_000.0 && !sticking.enough() {
                let event = motion.advance(5_000.0);
                sticking.step(&motion, event);
            }
            (sticking.goes_on(), sticking.calms_down(), motion.t)
        };
        let (goes_on, calms_down, t) = follow(0.2);
        assert!(goes_on && !calms_down && t < 200.0, "{t}");
        let (goes_on, calms_down, t) = follow(0.36);
        assert!(!goes_on && calms_down, "{t}");
    }
}
