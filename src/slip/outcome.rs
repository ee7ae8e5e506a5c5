//! What becomes of a motion: sliding, stick-slip, oscillation, lift-off or another outcome.

use super::motion::{Event, Motion};

/// How a motion ends up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Outcome {
    /// It settles to sliding at v0: sliding is linearly stable, the deviation stayed below 10⁻³ v0
    /// for a whole delay and has decayed since as the abscissa says, for one relaxation time. With
    /// noise or a resolution of readings: it stayed for long within what these keep up.
    Sliding,
    /// Stick and slip follow one another periodically, or with readings that are held for long and
    /// without a trend.
    StickSlip,
    /// A bounded periodic oscillation without sticking.
    Oscillation,
    /// N ≤ 0: the model ends.
    LiftOff,
    /// It grows beyond all bounds.
    Diverged,
    /// No other outcome was reached before the horizon, or within the steps allowed.
    Undecided,
    /// There is no motion: no uncontrolled stick-slip at whose phase control could be switched on.
    NoCycle,
}

impl Outcome {
    /// All outcomes, in the order of their numbers in a map.
    pub const ALL: [Self; 7] = [
        Self::Sliding,
        Self::StickSlip,
        Self::Oscillation,
        Self::LiftOff,
        Self::Diverged,
        Self::Undecided,
        Self::NoCycle,
    ];

    /// The name in maps, files and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sliding => "sliding",
            Self::StickSlip => "stick-slip",
            Self::Oscillation => "oscillation",
            Self::LiftOff => "lift-off",
            Self::Diverged => "diverged",
            Self::Undecided => "undecided",
            Self::NoCycle => "no-cycle",
        }
    }
}

/// Where to stop, and what is known of sliding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The latest time, in units of √(M/κ).
    pub horizon: f64,
    /// The most steps.
    pub steps: u64,
    /// The spectral abscissa of sliding at the last v0 under the control that acts, if all roots
    /// are stable.
    pub stable_abscissa: Option<f64>,
    /// How well cycles have to repeat, relative, to be periodic.
    pub repeated: f64,
    /// The most cycles of stick-slip to wait for a repetition.
    pub cycles: usize,
}

/// A motion that was followed to its outcome. Times, lengths and forces as in [`super::motion`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// The outcome.
    pub outcome: Outcome,
    /// When that was known.
    pub decided: f64,
    /// From switch-on, or from t = 0 without one, until ẋ stays within 1 % of v0, the last one of a
    /// programme; NaN unless the outcome is sliding.
    pub settle_time: f64,
    /// The smallest load since switch-on.
    pub n_min: f64,
    /// The largest force |κa + cȧ| of spring and dashpot since switch-on; of a motion that
    /// diverges, until that was known.
    pub peak: f64,
    /// How long v or N has been at a limit since switch-on; NaN without limits of actuators.
    pub time_at_limit: f64,
    /// The share of the time since switch-on for which v or N has been at a limit.
    pub share_at_limit: f64,
    /// Period of stick-slip, its mean over the last cycles where they do not repeat; NaN for other
    /// outcomes.
    pub period: f64,
    /// Time stuck in one period.
    pub stick_time: f64,
    /// Time in slip in one period.
    pub slip_time: f64,
    /// From switch-on until the last stick ended; 0 where the block does not stick after
    /// switch-on, NaN where sticks go on periodically.
    pub last_release: f64,
    /// Slips in one period of stick-slip; 0 else.
    pub slips: u32,
    /// Steps taken.
    pub steps: u64,
}

impl Summary {
    /// The time from `switch_on`, or from t = 0 without one, to the last release at `last`: 0 if
    /// `last` is NaN, for no release, and NaN for stick-slip, whose releases go on.
    #[must_use]
    pub fn released_after(outcome: Outcome, last: f64, switch_on: f64) -> f64 {
        match outcome {
            Outcome::StickSlip => f64::NAN,
            _ if last.is_nan() => 0.0,
            _ => Self::after(switch_on, last),
        }
    }

    /// The time from `switch_on`, or from t = 0 without one, to `t`; at least 0.
    pub(super) fn after(switch_on: f64, t: f64) -> f64 {
        let since = if switch_on.is_finite() {
            switch_on
        } else {
            0.0
        };
        (t - since).max(0.0)
    }

    /// Where there is no motion to follow: all numbers are NaN.
    #[must_use]
    pub const fn without(outcome: Outcome) -> Self {
        Self {
            outcome,
            decided: f64::NAN,
            settle_time: f64::NAN,
            n_min: f64::NAN,
            peak: f64::NAN,
            time_at_limit: f64::NAN,
            share_at_limit: f64::NAN,
            period: f64::NAN,
            stick_time: f64::NAN,
            slip_time: f64::NAN,
            last_release: f64::NAN,
            slips: 0,
            steps: 0,
        }
    }

    /// Its numbers except the counts of steps and slips, with their names in files and messages.
    /// Numbers that do not exist are NaN.
    #[must_use]
    pub const fn numbers(&self) -> [(&'static str, f64); 10] {
        let Self {
            outcome: _,
            decided,
            settle_time,
            n_min,
            peak,
            time_at_limit,
            share_at_limit,
            period,
            stick_time,
            slip_time,
            last_release,
            slips: _,
            steps: _,
        } = *self;
        [
            ("decided", decided),
            ("settle_time", settle_time),
            ("n_min", n_min),
            ("peak_force", peak),
            ("time_at_limit", time_at_limit),
            ("share_at_limit", share_at_limit),
            ("period", period),
            ("stick_time", stick_time),
            ("slip_time", slip_time),
            ("last_release", last_release),
        ]
    }

    /// The summary whose numbers `number` gives by their names, NaN where one does not exist. The
    /// number of slips in a period is not among them.
    #[must_use]
    pub fn of_numbers(outcome: Outcome, steps: u64, number: impl Fn(&str) -> f64) -> Self {
        Self {
            decided: number("decided"),
            settle_time: number("settle_time"),
            n_min: number("n_min"),
            peak: number("peak_force"),
            time_at_limit: number("time_at_limit"),
            share_at_limit: number("share_at_limit"),
            period: number("period"),
            stick_time: number("stick_time"),
            slip_time: number("slip_time"),
            last_release: number("last_release"),
            steps,
            ..Self::without(outcome)
        }
    }
}

/// Sees every step of a motion.
pub trait Observer {
    /// After each step, with the event that ended it.
    fn step(&mut self, motion: &Motion, event: Option<Event>);

    /// Whether it has seen enough: then the motion is followed no further, and its outcome is
    /// undecided.
    fn enough(&self) -> bool {
        false
    }
}

/// Sees nothing.
impl Observer for () {
    fn step(&mut self, _: &Motion, _: Option<Event>) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_is_that_of_its_numbers() {
        let names = Summary::without(Outcome::Sliding)
            .numbers()
            .map(|(name, _)| name);
        let numbers: Vec<_> = (0..names.len()).map(|i| i as f64 + 0.5).collect();
        let number = |asked: &str| numbers[names.iter().position(|n| *n == asked).unwrap()];
        let made = Summary::of_numbers(Outcome::StickSlip, 7, number);
        assert_eq!(made.numbers().map(|(_, value)| value)[..], numbers);
        assert_eq!((made.outcome, made.steps), (Outcome::StickSlip, 7));
    }
}
