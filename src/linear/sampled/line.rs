//! All multiples of the sample time as delays.
//!
//! The angles at which |U| = |V| on |z| = 1 are crossing frequencies ωh, and arg(−V/U) their
//! phases: a line over every delay, of which only multiples of h are asked for.

use std::cell::OnceCell;
use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use super::SampledLoop;
use super::circle::{Circle, Junction, slope, value};
use super::outside::Weights;
use crate::linear::count::{Count, MarginalTolerance};
use crate::linear::crossing::{Crossing, Direction};
use crate::linear::general::DelayLine;
use crate::linear::general::stable::Change;
use crate::linear::line::{Intervals, Line};
use crate::linear::real_zeros::TooMany;
use crate::linear::stable_delays::{StableInterval, signed_distance};
use crate::model::elementary::sincos;

/// How near to a multiple of the sample time a delay has to be, relative.
const WHOLE: f64 = 1e-9;
/// How near to the angle of the block without control the angle is at which its pair starts.
const SAME: f64 = 1e-6;
/// The most stable intervals that are listed.
const MOST_INTERVALS: usize = 1 << 17;

/// How many times `sample_time` goes into `delay`, at least once; none where it does not.
///
/// ```
/// use slipmap::linear::sampled::multiple;
///
/// assert_eq!(multiple(4.2, 0.3), Some(14));
/// assert_eq!(multiple(4.3, 0.3), None);
/// ```
#[must_use]
pub fn multiple(delay: f64, sample_time: f64) -> Option<u64> {
    let whole = (delay / sample_time).round();
    let near = (delay - whole * sample_time).abs() <= WHOLE * delay;
    (near && (1.0..=super::MOST_SAMPLES).contains(&whole)).then_some(whole as u64)
}

/// The first and the last whole multiple of `sample_time`, at least one, between two delays; the
/// last is less than the first where there is none.
#[must_use]
pub fn multiples_within(sample_time: f64, (from, to): (f64, f64)) -> (u64, u64) {
    let first = (from * (1.0 - WHOLE) / sample_time).ceil().max(1.0);
    let last = (to * (1.0 + WHOLE) / sample_time).floor();
    (first as u64, last.min(super::MOST_SAMPLES) as u64)
}

/// The stability at all multiples of the sample time.
#[derive(Debug, Clone)]
pub struct SampledLine {
    line: DelayLine,
    sample_time: f64,
    /// Whether each further sample of delay puts one more zero outside.
    grows: bool,
    /// The stable multiples, as delays, and whether some are left out.
    stable: OnceCell<(Vec<StableInterval>, bool)>,
}

impl SampledLoop {
    /// The line of this loop, in units of which √(M/κ) is `time_unit`.
    #[must_use]
    pub fn line(&self, time_unit: f64) -> SampledLine {
        let mut line = DelayLine {
            open_from: f64::INFINITY,
            time_unit: 1.0,
            ..DelayLine::default()
        };
        let b = self.groups.b;
        line.marginal_at_zero = b == 0.0;
        line.without_delay = if b < 0.0 { 2 } else { 0 };
        line.at_zero_delay = line.without_delay;
        let circle = Circle::new(0.0);
        let start = (b == 0.0).then(|| self.open_angle());
        let listed = self.each_junction(&circle, Weights::new(0.0, 1), |junction| {
            let crossing = self.crossing(&junction);
            let starts = start.is_some_and(|angle| (junction.angle - angle).abs() < SAME * angle);
            if starts && crossing.starts_at_zero() {
                line.at_zero_delay = 2 * u64::from(self.grows_at(&junction, &circle));
                let whole_turn = Junction {
                    phase: TAU,
                    ..junction
                };
                line.crossings.push(self.crossing(&whole_turn));
            } else {
                line.crossings.push(crossing);
            }
        });
        line.uncounted = listed == Err(TooMany) || !self.is_told_apart();
        line.crossings
            .sort_by(|one, other| other.omega.total_cmp(&one.omega));
        SampledLine {
            grows: self.grows_outside(&circle, Weights::new(0.0, 1)),
            line: line.in_physical_time(time_unit),
            sample_time: self.sample_time * time_unit,
            stable: OnceCell::new(),
        }
    }

    /// Whether rounding leaves the block its own zeros: not where all is lost in the growth of one
    /// sample, nor where an undamped block makes whole half turns from reading to reading.
    fn is_told_apart(&self) -> bool {
        let mut coefficients = self.step.open.iter().chain(&self.step.held);
        let finite = coefficients.all(|c| (c * c).is_finite());
        let angle = self.open_angle();
        let half_turns = self.groups.b.abs() < SAME && angle.min((PI - angle).abs()) < SAME;
        finite && !(half_turns && self.sample_time > 1.0)
    }

    fn crossing(&self, junction: &Junction) -> Crossing {
        let direction = Direction::of_sign(junction.sign);
        Crossing::with_errors(
            junction.angle / self.sample_time,
            junction.angle_error / self.sample_time,
            junction.phase,
            junction.phase_error,
            direction,
        )
    }

    /// The angle of the zeros of p, where they lie on |z| = 1.
    fn open_angle(&self) -> f64 {
        let turns = self.sample_time / TAU;
        let angle = TAU * (turns - turns.round());
        angle.abs()
    }

    /// Whether a pair that starts on the circle at τ = 0 leaves it outwards.
    fn grows_at(&self, junction: &Junction, circle: &Circle) -> bool {
        let zeta = circle.zeta(junction.angle);
        let z = zeta + 1.0;
        let (sine, cosine) = sincos(self.late as f64 * junction.angle);
        let late = Complex64::new(cosine, sine);
        let [p, q] = [self.step.open, self.step.held].map(|c| value(c, zeta));
        let size = late * p - q;
        let slope = (1.0 - self.memory) * late * slope(self.step.open, zeta);
        let motion = -Complex64::i() * junction.angle * size / slope;
        (motion * z.conj()).re > 0.0
    }
}

impl SampledLine {
    /// The delay as a whole multiple, by rounding's error; none where it is not one.
    fn at(&self, tau: f64) -> Option<f64> {
        multiple(tau, self.sample_time).map(|m| m as f64 * self.sample_time)
    }

    /// The number of zeros outside the circle at a delay of `multiple` samples.
    pub(super) fn n_unstable_at(&self, multiple: u64) -> u64 {
        let tau = multiple as f64 * self.sample_time;
        let crossings = self.line.crossings.iter();
        let passed =
            |of: &Crossing| 2 * i64::from(of.direction.sign()) * of.count_below(tau) as i64;
        let grown = if self.grows { multiple as i64 } else { 0 };
        let count = self.line.at_zero_delay as i64 + grown + crossings.map(passed).sum::<i64>();
        count.max(0) as u64
    }

    /// A number of samples from which on something is always unstable, where each further one puts
    /// a zero outside.
    fn last_stable(&self) -> f64 {
        let (mut rate, mut ahead) = (1.0, 0.0);
        for crossing in &self.line.crossings {
            let sign = f64::from(crossing.direction.sign());
            rate += sign * crossing.omega * self.sample_time / PI;
            ahead += 2.0;
        }
        if rate > 0.0 {
            (ahead / rate).ceil()
        } else {
            f64::INFINITY
        }
    }

    /// The stable multiples where each further sample puts a zero outside: one count each.
    fn counted(&self) -> (Vec<StableInterval>, bool) {
        let (h, last) = (self.sample_time, self.last_stable());
        let mut found: Vec<StableInterval> = Vec::new();
        let most = MOST_INTERVALS as u64;
        for m in 1..=(last as u64).min(most) {
            if self.n_unstable_at(m) != 0 {
                continue;
            }
            let tau = m as f64 * h;
            match found.last_mut() {
                Some(before) if tau - before.to < 1.5 * h => before.to = tau,
                _ => found.push(StableInterval { from: tau, to: tau }),
            }
        }
        (found, last > most as f64)
    }

    /// The stable multiples: intervals from the first to the last of them.
    fn stable(&self) -> &(Vec<StableInterval>, bool) {
        self.stable.get_or_init(|| {
            if self.grows {
                return self.counted();
            }
            let h = self.sample_time;
            let mut found: Vec<StableInterval> = Vec::new();
            let mut intervals = self.line.stable_intervals();
            for StableInterval { from, to } in &mut intervals {
                let (first, last) = ((from / h).ceil().max(1.0), (to / h).floor());
                if first > last {
                    continue;
                }
                let (from, to) = (first * h, if to == f64::INFINITY { to } else { last * h });
                let full = found.len() == MOST_INTERVALS;
                match found.last_mut() {
                    Some(before) if from - before.to < 1.5 * h => before.to = to,
                    _ if full => return (found, true),
                    _ => found.push(StableInterval { from, to }),
                }
            }
            let gave_up = intervals.gave_up();
            (found, gave_up)
        })
    }

    /// The signed distance from the multiple `tau` to the nearest multiple of other stability:
    /// positive where stable, infinite where there is none, NaN where that is not known.
    #[must_use]
    pub fn margin(&self, tau: f64) -> f64 {
        let Some(tau) = self.at(tau).filter(|_| !self.line.uncounted) else {
            return f64::NAN;
        };
        if self.line.always_marginal {
            return 0.0;
        }
        let (stable, gave_up) = self.stable();
        let h = self.sample_time;
        let begun = stable.partition_point(|interval| interval.from < tau + 0.5 * h);
        let below = begun.checked_sub(1).map(|i| stable[i]);
        let above = stable.get(begun).copied();
        if let Some(StableInterval { from, to }) = below.filter(|below| tau < below.to + 0.5 * h) {
            // The first multiple is not the end of a stable interval.
            let down = if from < 1.5 * h {
                f64::INFINITY
            } else {
                tau - from + h
            };
            return down.min(to - tau + h);
        }
        if above.is_none() && *gave_up {
            return f64::NAN;
        }
        signed_distance(tau, below, above)
    }
}

impl Line for SampledLine {
    fn time_unit(&self) -> f64 {
        self.line.time_unit
    }

    fn count(&self, tau: f64, tolerance: MarginalTolerance) -> Option<Count> {
        let multiple = multiple(tau, self.sample_time)?;
        let tau = multiple as f64 * self.sample_time;
        (!self.line.uncounted).then(|| Count {
            n_unstable: self.n_unstable_at(multiple),
            ..self.line.count(tau, tolerance)
        })
    }

    fn n_at_zero_delay(&self) -> Option<u64> {
        (!self.line.uncounted).then_some(self.line.at_zero_delay)
    }

    fn crossings(&self) -> Box<dyn Iterator<Item = &Crossing> + '_> {
        Box::new(self.line.crossings.iter())
    }

    fn crossings_known(&self) -> bool {
        !(self.line.uncounted || self.grows)
    }

    fn delays_known(&self) -> bool {
        !self.line.uncounted
    }

    /// Each at the first multiple that it concerns; none where each of them changes the number.
    fn changes(&self) -> Box<dyn Iterator<Item = Change> + '_> {
        let h = self.sample_time;
        let known = self.line.changes().take_while(|_| !self.grows);
        Box::new(known.map(move |change| Change {
            tau: ((change.tau / h).floor() + 1.0) * h,
            ..change
        }))
    }

    fn stable_intervals(&self) -> Box<dyn Intervals + '_> {
        let (stable, gave_up) = self.stable();
        Box::new(Listed {
            left: stable.iter(),
            gave_up: *gave_up,
        })
    }

    fn delay_margin(&self, tau: f64) -> f64 {
        self.margin(tau)
    }
}

/// Stable intervals that are known.
struct Listed<'l> {
    left: std::slice::Iter<'l, StableInterval>,
    gave_up: bool,
}

impl Iterator for Listed<'_> {
    type Item = StableInterval;

    fn next(&mut self) -> Option<StableInterval> {
        self.left.next().copied()
    }
}

impl Intervals for Listed<'_> {
    fn gave_up(&self) -> bool {
        self.gave_up
    }
}

#[cfg(test)]
mod tests {
    use super::multiple;

    #[test]
    fn multiples_are_whole_but_for_rounding() {
        assert_eq!(multiple(1.2, 0.1), Some(12));
        assert_eq!(multiple(0.0, 0.1), None);
        assert_eq!(multiple(1.2 + 1e-8, 0.1), None);
        assert_eq!(multiple(0.04, 0.1), None);
        assert_eq!(multiple(f64::INFINITY, 0.1), None);
    }
}
