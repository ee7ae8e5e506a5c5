//! When a motion whose readings are held has come to what it goes on as.
//!
//! Readings that drift against the cycle, and their noise, make no two cycles equal, and noise
//! keeps a deviation from sliding alive. Such a motion is told by what lasts:
//!
//! - *Stick-slip*: the last [`LASTING`] cycles, each from release to release with a stop between,
//!   show no trend, and cycles have gone on for [`DELAYS`] times as long as the feedback remembers.
//!   No trend: periods, slips and elongations at release of the newer half are larger than those of
//!   the older half about as often as smaller, to [`ERRORS`] standard deviations.
//! - *Oscillation*: the same of the amplitudes in windows of time without a stop.
//! - *Sliding*: linear theory says that sliding is stable, and the deviation from it has stayed
//!   within [`settled_within`] for long: that is no more than noise and rounding keep up.
//!
//! Noise may end later what has lasted so long: then a verdict of stick-slip is one about this
//! span.

use super::motion::Motion;
use crate::model::Channel;

/// Cycles, or windows, that have to go on without a trend; an even number.
const LASTING: usize = 24;
/// For how many times as long as the feedback remembers they have to go on.
const DELAYS: f64 = 4.0;
/// How many more pairs of values may rise than fall, in standard deviations of that number.
const ERRORS: f64 = 3.0;
/// Differences below this, relative, are rounding.
const ROUNDED: f64 = 1e-9;
/// The largest deviation of settled noise, in standard deviations, and how many times as large a
/// deviation may be as one that decays as the slowest root does.
const DEVIATIONS: f64 = 6.0;
const TRANSIENT: f64 = 2.0;
/// A larger part of v0 is no small deviation.
const LARGEST_PART: f64 = 0.5;

/// How many cycles stick-slip under control by the return map has to go on: by chance a reading
/// falls where the load steers.
const STEERED: usize = 240;

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
        let values = (0..LASTING).map(|cycle| self.at(i, cycle));
        values.sum::<f64>() / LASTING as f64
    }

    /// The test of Mann and Whitney (1947): of all pairs of an older and a newer value, about as
    /// many rise as fall.
    fn is_level(&self, i: usize) -> bool {
        const HALF: usize = LASTING / 2;
        const VARIANCE: usize = HALF * HALF * (2 * HALF + 1) / 3;
        let mut rises = 0.0;
        for older in (0..HALF).map(|cycle| self.at(i, cycle)) {
            for newer in (HALF..LASTING).map(|cycle| self.at(i, cycle)) {
                let rise = newer - older;
                let rounding = ROUNDED * (1.0 + older.abs() + newer.abs());
                rises += match rise.abs() <= rounding {
                    true => 0.0,
                    false => rise.signum(),
                };
            }
        }
        rises * rises <= ERRORS * ERRORS * VARIANCE as f64
    }

    /// The `i`-th number of a cycle, the oldest first.
    fn at(&self, i: usize, cycle: usize) -> f64 {
        self.values[(self.count + cycle) % LASTING][i]
    }
}

/// What lasts of a motion whose readings are held.
pub(super) struct Held {
    /// Period, slip and elongation at release of each cycle, when the first one began, and how many
    /// have to go on.
    pub(super) cycles: Lasting<3>,
    since: f64,
    least: usize,
    /// Amplitudes in windows without a stop.
    pub(super) amplitudes: Lasting<1>,
    pub(super) settled: Option<Settled>,
}

impl Held {
    /// At the beginning of a motion, of which linear theory tells this `abscissa`; none where
    /// nothing is held.
    pub(super) fn of(motion: &Motion, abscissa: Option<f64>) -> Option<Self> {
        let steered = motion.parameters().feedback.return_map.is_some();
        motion.is_sampled().then(|| Self {
            cycles: Lasting::new(),
            since: f64::INFINITY,
            least: if steered { STEERED } else { 0 },
            amplitudes: Lasting::new(),
            settled: settled_within(motion, abscissa),
        })
    }

    /// Whether the return map steers the load: while it does not, cycles are equal, and readings
    /// drift towards one at which it does.
    pub(super) fn is_steered(&self) -> bool {
        self.least > 0
    }

    /// Adds a cycle that `began` and ends now. Whether stick-slip has gone on for long, where the
    /// feedback remembers for `tau`.
    pub(super) fn goes_on(&mut self, cycle: [f64; 3], [began, now]: [f64; 2], tau: f64) -> bool {
        self.since = self.since.min(began);
        self.cycles.add(cycle);
        let for_long = now - self.since >= DELAYS * tau && self.cycles.count >= self.least;
        for_long && self.cycles.has_no_trend()
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
    let of_load = motion.load_of_noise().unwrap_or(gains.alpha_n.abs());
    let gain = gains.alpha_v.abs() * (1.0 + p.dashpots.damping) + of_load * p.law.mu_s();
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
        assert!(!lasting(|cycle| 0.5 * cycle + scattered(cycle), 50));
    }
}
