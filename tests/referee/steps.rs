//! How long steps are, and where in a step a number falls below 0.

/// Shares of the times in which a motion changes; halved, they halve every step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    share: f64,
}

/// Shares of 1/rate: of the free oscillation and of what control and friction add to it, in slip
/// and in stick.
const OF_RATE: f64 = 0.02;
const OF_RATE_STUCK: f64 = 0.05;
/// The share of the speed over which the law bends, by which the speed changes in a step.
const OF_BEND: f64 = 0.05;
/// The share of the delay.
const OF_DELAY: f64 = 0.25;
/// The most steps of the past that one step sees at once.
const SEEN: usize = 4;
/// Minima no lower than this are rounding of a number that begins at 0.
const ROUNDING: f64 = 1e-15;

impl Pace {
    /// Of so many times the shares above.
    pub(crate) const fn of(share: f64) -> Self {
        Self { share }
    }

    /// With steps half as long.
    pub(crate) fn halved(self) -> Self {
        Self::of(0.5 * self.share)
    }

    /// A step in slip, by the time unit, rates that add up, and the rate at which the speed crosses
    /// what the law bends over.
    pub(crate) fn slipping(self, time: f64, rates: f64, bend: f64) -> f64 {
        let smooth = OF_RATE / (1.0 / time + rates);
        self.share * smooth.min(OF_BEND / bend)
    }

    /// A step in stick.
    pub(crate) fn stuck(self, time: f64, rates: f64) -> f64 {
        self.share * OF_RATE_STUCK / (1.0 / time + rates)
    }

    /// A step, by the delay.
    pub(crate) fn delayed(self, tau: f64) -> f64 {
        (self.share * OF_DELAY * tau).min(0.5 * tau)
    }

    /// The most steps of the past that one step sees.
    pub(crate) fn seen_at_once() -> usize {
        SEEN
    }
}

/// Where in a step of length `h` a number falls below 0 first, told from its values and rates at
/// both ends; minima inside are looked at. `start` is the time of the step, to whose rounding it is
/// found.
pub(crate) fn first_below(
    h: f64,
    ends: ((f64, f64), (f64, f64)),
    start: f64,
    value: impl Fn(f64) -> f64,
) -> Option<f64> {
    let ((from, fall), (to, rise)) = ends;
    let mut end = (h, to);
    if to >= 0.0 {
        if !(fall < 0.0 && rise > 0.0) {
            return None;
        }
        let s = minimum(h, ends);
        end = (s, value(s));
        if end.1 >= -ROUNDING {
            return None;
        }
    }
    let finest = 2.0 * f64::EPSILON * start.abs().max(h);
    Some(crossing(end, from, finest, value))
}

/// Where the cubic with these values and rates at its ends is least; it falls at one and rises at
/// the other.
fn minimum(h: f64, ((from, fall), (to, rise)): ((f64, f64), (f64, f64))) -> f64 {
    let chord = (to - from) / h;
    // Its slope is fall + b q + c q² at the share q of the step.
    let b = 6.0 * chord - 4.0 * fall - 2.0 * rise;
    let c = 3.0 * (fall + rise) - 6.0 * chord;
    let root = (b * b - 4.0 * c * fall).max(0.0).sqrt();
    h * (-2.0 * fall / (b + root)).clamp(0.0, 1.0)
}

/// Where between 0, where it is `from`, and `end`, where it is below 0, a number falls below 0: the
/// Illinois variant of the regula falsi, every third time a bisection. At the place returned it is
/// below 0.
fn crossing(end: (f64, f64), from: f64, finest: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = ((0.0, from.max(0.0)), end);
    let mut last_below = None;
    for i in 1..200 {
        let width = high.0 - low.0;
        if width <= finest {
            break;
        }
        let mut s = high.0 - high.1 * width / (high.1 - low.1);
        if i % 3 == 0 {
            s = low.0 + 0.5 * width;
        }
        s = s.max(low.0 + 0.5 * finest).min(high.0 - 0.5 * finest);
        let found = value(s);
        let below = found < 0.0;
        let kept = if last_below == Some(below) { 0.5 } else { 1.0 };
        if below {
            high = (s, found);
            low.1 *= kept;
        } else {
            low = (s, found);
            high.1 *= kept;
        }
        last_below = Some(below);
    }
    high.0
}
