//! The mean of the elongation over a time, as a sensor reads it.
//!
//! A sensor without a sample time averages the elongation itself. One with readings averages those
//! that a loop with this sample time takes, noise and rounding included: reading k, at t = k h, is
//! the same number in the mean and in the feedback.

use super::motion::{Event, Mode, Motion};
use super::outcome::Observer;
use super::readings::reading;
use super::speeds::Speeds;
use super::steady::settled_within;
use crate::model::Readings;

/// Times this near to that of a reading, in sample times, are its time.
const SAME: f64 = 1e-9;

/// From when to when the elongation is averaged, and how it is read; dimensionless as a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// The beginning of the mean.
    pub from: f64,
    /// The end.
    pub to: f64,
    /// The sensor.
    pub readings: Readings,
}

impl Window {
    /// The first and the last reading of the mean: those after its beginning, up to its end.
    fn numbers(&self) -> [i64; 2] {
        let behind = |t: f64| (t / self.readings.sample_time + SAME).floor() as i64;
        [behind(self.from) + 1, behind(self.to)]
    }

    /// How many readings are averaged; none without a sample time.
    #[must_use]
    pub fn count(&self) -> Option<u64> {
        let [first, last] = self.numbers();
        let acts = self.readings.acts();
        acts.then(|| u64::try_from(last - first + 1).unwrap_or(0))
    }

    fn time(&self, number: i64) -> f64 {
        number as f64 * self.readings.sample_time
    }

    /// The time at which the mean is complete.
    fn end(&self) -> f64 {
        match self.readings.acts() {
            true => self.time(self.numbers()[1]),
            false => self.to,
        }
    }
}

/// What ends a motion before its mean is complete.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cut {
    /// N ≤ 0: the model ends.
    LiftOff,
    /// It takes more steps than are allowed.
    Steps,
    /// Its state is not known, see [`Motion::is_lost`].
    Lost,
}

/// A mean, and what the block did meanwhile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Averaged {
    /// The mean elongation; NaN where nothing was read.
    pub mean: f64,
    /// Whether the block stopped.
    pub stopped: bool,
    /// How far |ẋ| was from v0 at most.
    pub off: f64,
    /// The deviation of ẋ that noise and rounding of readings keep up; 0 without them.
    pub kept_up: f64,
    /// Whether v or N was at a limit of its actuator.
    pub at_limit: bool,
    /// What cut the mean short.
    pub cut: Option<Cut>,
}

/// Follows `motion` from t = 0 and averages its elongation over `window`, in at most `steps` steps.
/// `abscissa` is that of sliding, where it is stable.
pub fn average(
    motion: &mut Motion,
    window: &Window,
    abscissa: Option<f64>,
    steps: u64,
) -> Averaged {
    let kept_up = settled_within(motion, abscissa).map_or(0.0, |settled| settled.within);
    let mut left = steps;
    let mut cut = follow(motion, window.from, &mut left, |_| {});
    let mut mean = Mean::begin(window);
    if cut.is_none() {
        cut = follow(motion, window.end(), &mut left, |motion| mean.see(motion));
    }
    Averaged {
        mean: mean.mean(),
        stopped: mean.stopped,
        off: mean.off(),
        kept_up,
        at_limit: mean.at_limit,
        cut,
    }
}

/// Follows `motion` until `end`, and shows every step; the step that lifts the block off is none.
fn follow(
    motion: &mut Motion,
    end: f64,
    left: &mut u64,
    mut see: impl FnMut(&Motion),
) -> Option<Cut> {
    while motion.t < end {
        if *left == 0 {
            return Some(Cut::Steps);
        }
        *left -= 1;
        let event = motion.advance(end);
        if motion.is_lost() {
            return Some(Cut::Lost);
        }
        if event == Some(Event::LiftOff) {
            return Some(Cut::LiftOff);
        }
        see(motion);
    }
    None
}

/// A mean that is being made.
struct Mean<'w> {
    window: &'w Window,
    /// The number of the next reading.
    next: i64,
    sum: f64,
    /// The readings, or the time, of the sum.
    weight: f64,
    speeds: Speeds,
    /// The smallest and the largest v0.
    pull: [f64; 2],
    stopped: bool,
    at_limit: bool,
}

impl<'w> Mean<'w> {
    fn begin(window: &'w Window) -> Self {
        Self {
            window,
            next: window.numbers()[0],
            sum: 0.0,
            weight: 0.0,
            speeds: Speeds::default(),
            pull: [f64::INFINITY, f64::NEG_INFINITY],
            stopped: false,
            at_limit: false,
        }
    }

    fn see(&mut self, motion: &Motion) {
        let step = motion.last_step();
        if self.window.readings.acts() {
            self.read(motion);
        } else {
            self.sum += step.integral_of_elongation();
            self.weight += step.length;
        }
        self.speeds.step(motion, None);
        self.stopped |= motion.mode() == Mode::Stick || self.speeds.least == 0.0;
        self.at_limit |= motion.is_at_limit();
        let v0 = motion.parameters().v0;
        self.pull = [self.pull[0].min(v0), self.pull[1].max(v0)];
    }

    /// Takes the readings of the last step of `motion`.
    fn read(&mut self, motion: &Motion) {
        let step = motion.last_step();
        let of = &self.window.readings;
        let last = self.window.numbers()[1];
        while self.next <= last && self.window.time(self.next) <= motion.t {
            let ago = motion.t - self.window.time(self.next);
            let (_, a, _) = step.state((step.length - ago).max(0.0));
            self.sum += reading(of, self.next, a);
            self.weight += 1.0;
            self.next += 1;
        }
    }

    fn mean(&self) -> f64 {
        match self.weight > 0.0 {
            true => self.sum / self.weight,
            false => f64::NAN,
        }
    }

    /// How far |ẋ| was beyond the v0 of the time at most.
    fn off(&self) -> f64 {
        let [slowest, fastest] = self.pull;
        (self.speeds.most - fastest).max(slowest - self.speeds.least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Dashpots, Feedback, FrictionLaw};
    use crate::slip::motion::{Accuracy, Parameters};

    /// A block that swings freely about the elongation of Coulomb friction.
    fn swinging(v0: f64, u: f64) -> Motion {
        let parameters = Parameters {
            law: FrictionLaw::coulomb(0.5, 1.0).unwrap(),
            velocity_unit: 1.0,
            dashpots: Dashpots::default(),
            feedback: Feedback::default(),
            v0,
            switch_on: f64::INFINITY,
        };
        Motion::new(parameters, Accuracy::default(), u, 0.5)
    }

    fn window(from: f64, to: f64, sample_time: f64) -> Window {
        let readings = Readings {
            sample_time,
            ..Readings::default()
        };
        Window { from, to, readings }
    }

    /// u = v0 + 0.1 cos t, so a = 0.5 − 0.1 sin t: the mean is known, with and without readings.
    #[test]
    fn the_mean_is_that_of_a_swing() {
        let (from, to) = (2.0, 9.0);
        let averaged = average(
            &mut swinging(1.0, 1.1),
            &window(from, to, 0.0),
            None,
            10_000,
        );
        let expected = 0.5 + 0.1 * (to.cos() - from.cos()) / (to - from);
        assert!((averaged.mean - expected).abs() < 1e-12, "{averaged:?}");
        assert!((averaged.off - 0.1).abs() < 1e-12 && !averaged.stopped && !averaged.at_limit);
        let coarse = window(from, to, 0.25);
        assert_eq!(coarse.count(), Some(28));
        let averaged = average(&mut swinging(1.0, 1.1), &coarse, None, 10_000);
        let at = |k: i32| 0.5 - 0.1 * (0.25 * f64::from(k)).sin();
        let expected = (9..=36).map(at).sum::<f64>() / 28.0;
        assert!((averaged.mean - expected).abs() < 1e-12, "{averaged:?}");
    }

    #[test]
    fn what_stops_is_told() {
        let averaged = average(
            &mut swinging(0.1, 0.3),
            &window(0.0, 30.0, 0.0),
            None,
            10_000,
        );
        assert!(averaged.stopped && averaged.cut.is_none(), "{averaged:?}");
        let cut = average(&mut swinging(0.1, 0.3), &window(0.0, 30.0, 0.0), None, 3);
        assert_eq!(cut.cut, Some(Cut::Steps));
    }
}
