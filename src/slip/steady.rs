//! When a motion whose readings are held has come to what it goes on as.
//!
//! Readings that drift against the cycle, and their noise, make no two cycles equal, and noise
//! keeps a deviation from sliding alive. Such a motion is told by what lasts:
//!
//! - *Stick-slip*: the last [`LASTING`] cycles, each from release to release with a stop between,
//!   show no trend, and cycles have gone on for [`DELAYS`] times as long as the feedback remembers.
//!   No trend: the means of period, slip and elongation at release over the older half and over the
//!   newer half differ by no more than [`ERRORS`] standard errors.
//! - *Oscillation*: the same of the amplitudes in windows of time without a stop.
//! - *Sliding*: linear theory says that sliding is stable, and the deviation from it has stayed
//!   within [`settled_within`] for long: that is no more than noise and rounding keep up.
//!
//! Noise may end later what has lasted so long: then a verdict of stick-slip is one about this
//! span.

use super::motion::Motion;
use crate::model::Channel;

/// Cycles, or windows, that have to go on without a trend; an even number.
pub(super) const LASTING: usize = 24;
/// For how many times as long as the feedback remembers they have to go on.
pub(super) const DELAYS: f64 = 4.0;
/// How far two means may differ, in standard errors of their difference.
const ERRORS: f64 = 3.0;
/// Differences of means below this, relative, are rounding.
const ROUNDED: f64 = 1e-9;
/// The largest deviation of settled noise, in standard deviations, and how many times as large a
/// deviation may be as one that decays as the slowest root does.
const DEVIATIONS: f64 = 6.0;
const TRANSIENT: f64 = 2.0;
/// A larger part of v0 is no small deviation.
const LARGEST_PART: f64 = 0.5;

/// The last values of `W` numbers of each cycle.
#[derive(Debug, Clone)]
pub(super) struct Lasting<const W: usize> {
    values: [[f64; W]; LASTING],
    count: usize,
}

impl<const W: usize> Lasting<W> {
    pub(super) const fn new() -> Self {
        Self {
            values: [[0.0; W]; LASTING],
            count: 0,
        }
    }

    /// Begins anew.
    pub(super) fn forget(&mut self) {
        self.count = 0;
    }

    /// Adds those of another cycle.
    pub(super) fn add(&mut self, values: [f64; W]) {
        self.values[self.count % LASTING] = values;
        self.count += 1;
    }

    /// Whether there are enough of them, and none shows a trend.
    pub(super) fn has_no_trend(&self) -> bool {
        self.count >= LASTING && (0..W).all(|i| self.is_level(i))
    }

    /// The mean of the `i`-th number.
    pub(super) fn mean(&self, i: usize) -> f64 {
        self.of_part(i, 0..LASTING).0
    }

    fn is_level(&self, i: usize) -> bool {
        let half = LASTING / 2;
        let [(older, one), (newer, other)] =
            [0..half, half..LASTING].map(|part| self.of_part(i, part));
        let error = ((one + other) / half as f64).sqrt();
        let rounding = ROUNDED * (1.0 + older.abs() + newer.abs());
        (older - newer).abs() <= ERRORS * error + rounding
    }

    /// Mean and variance of the `i`-th number over a part of the cycles, the oldest first.
    fn of_part(&self, i: usize, part: std::ops::Range<usize>) -> (f64, f64) {
        let number = part.len() as f64;
        let at = |cycle: usize| self.values[(self.count + cycle) % LASTING][i];
        let mean = part.clone().map(at).sum::<f64>() / number;
        let squares: f64 = part
            .map(|cycle| (at(cycle) - mean) * (at(cycle) - mean))
            .sum();
        (mean, squares / (number - 1.0))
    }
}

/// The deviation of ẋ and a from sliding that noise and rounding of readings keep up, and for how
/// long a motion has to stay within it; none where readings are exact or not held, or sliding is
/// not known to be stable with this `abscissa`.
///
/// White noise of a reading with the standard deviation σ reaches a and ẋ through the gains, and
/// goes on for a relaxation time T: √(h T) times as large. Rounding by up to half of the resolution
/// may add up over T.
pub(super) fn settled_within(motion: &Motion, abscissa: Option<f64>) -> Option<Settled> {
    let p = motion.parameters();
    let of = p.feedback.readings;
    let inexact = of.noise > 0.0 || of.resolution > 0.0;
    let relaxation = (-1.0 / abscissa.filter(|_| motion.is_sampled() && inexact)?).max(1.0);
    let feedback = motion.feedback();
    let Channel { memory, .. } = feedback.channel;
    let gains = p.feedback.gains;
    let gain =
        gains.alpha_v.abs() * (1.0 + p.dashpots.damping) + gains.alpha_n.abs() * p.law.mu_s();
    let noise = DEVIATIONS * of.noise * (2.0 * of.sample_time * relaxation).sqrt();
    let kept_up = TRANSIENT * gain / (1.0 - memory.abs()) * (noise + of.resolution * relaxation);
    Some(Settled {
        within: kept_up.min(LARGEST_PART * p.v0),
        lasting: 2.0 * feedback.remembered() + 10.0 * relaxation,
        since: f64::INFINITY,
    })
}

/// A deviation that noise keeps up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settled {
    /// Its bound, and for how long a motion has to stay within it.
    pub(super) within: f64,
    lasting: f64,
    /// Since when it has.
    since: f64,
}

impl Settled {
    /// The block sticks.
    pub(super) fn forget(&mut self) {
        self.since = f64::INFINITY;
    }

    /// Whether the motion has stayed within the bound for long, after a step from `start` to `now`
    /// with this `deviation`; one up to `small` always counts as within.
    pub(super) fn lasts(&mut self, [start, now]: [f64; 2], deviation: f64, small: f64) -> bool {
        if deviation > self.within.max(small) {
            self.forget();
            return false;
        }
        self.since = self.since.min(start);
        now - self.since >= self.lasting
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lasting(value: impl Fn(f64) -> f64, cycles: u32) -> bool {
        let mut series = Lasting::<1>::new();
        for cycle in 0..cycles {
            series.add([value(f64::from(cycle))]);
        }
        series.has_no_trend()
    }

    #[test]
    fn a_trend_is_told_from_what_lasts() {
        let scattered = |cycle: f64| (12.9898 * cycle).sin();
        assert!(lasting(|_| 2.0, 24) && !lasting(|_| 2.0, 23));
        assert!(lasting(scattered, 24) && lasting(scattered, 1000));
        // However slow, an even growth or decay is a trend.
        for rate in [1.0, 1e-3, 1e-6, -1e-6] {
            assert!(!lasting(|cycle| 1.0 + rate * cycle, 100), "{rate}");
            assert!(!lasting(|cycle| (rate * cycle).exp(), 40), "{rate}");
        }
        assert!(!lasting(|cycle| 0.2 * cycle + scattered(cycle), 50));
    }
}
