//! The gains at which a digital loop of a given delay is stable.
//!
//! The gains enter q alone: q = q₀ + k q₁ along a line of gains k. By (2) of `on_circle` a zero
//! lies on |z| = 1, at an angle φ, where
//!
//! ```text
//! k = (p z^l w − 2 s q₀) q₁* / (2 s |q₁|²)                                                    (3)
//! ```
//!
//! is real. All such angles are found, none is stepped over; the count decides which of them
//! matter.

use std::f64::consts::PI;

use super::SampledLoop;
use super::on_circle::{OnCircle, ROUNDINGS, times};
use super::step::Quadratic;
use crate::linear::margins::Limits;
use crate::linear::real_zeros::{At, RealFunction, TooMany, zeros};
use crate::linear::rounded::Rounded;

/// Loops along a line of gains, everything else being the same.
#[derive(Debug, Clone, Copy)]
pub struct GainLine {
    /// The loop at k = 0.
    fixed: SampledLoop,
    /// What one unit of k adds to its gains and to q.
    gains: [f64; 2],
    held: Quadratic,
}

impl GainLine {
    /// The line on which `fixed` has the gain 0 and `one` the gain 1: loops that differ in their
    /// gains alone.
    #[must_use]
    pub fn through(fixed: SampledLoop, one: &SampledLoop) -> Self {
        let [of_fixed, of_one] = [fixed.step.held, one.step.held];
        Self {
            gains: [
                one.groups.a_v - fixed.groups.a_v,
                one.groups.a_n - fixed.groups.a_n,
            ],
            held: std::array::from_fn(|k| of_one[k] - of_fixed[k]),
            fixed,
        }
    }

    /// The loop of a gain.
    #[must_use]
    pub fn at(&self, gain: f64) -> SampledLoop {
        let mut of = self.fixed;
        of.groups.a_v += gain * self.gains[0];
        of.groups.a_n += gain * self.gains[1];
        of.step.held = std::array::from_fn(|k| of.step.held[k] + gain * self.held[k]);
        of
    }

    /// The gains at which a zero lies on |z| = 1 at a delay of `multiple` samples, rising.
    ///
    /// # Errors
    /// When they are too many.
    fn boundaries(&self, multiple: u64) -> Result<Vec<f64>, TooMany> {
        let real = RealGain {
            on_circle: OnCircle::new(&self.fixed, multiple),
            fixed: self.fixed.step.held,
            held: self.held,
        };
        let mut found = Vec::new();
        let mut take = |angle: f64| {
            let parts = real.on_circle.parts(angle);
            let [[fixed, _], [held, _]] =
                [real.fixed, real.held].map(|c| real.on_circle.value(c, angle));
            let sine = parts.twice_sine[0];
            let along = (parts.open[0] * parts.turn[0] - fixed * sine) * held.conj();
            let gain = along.re / (sine * held.norm_sqr());
            if gain.is_finite() {
                found.push(gain);
            }
        };
        zeros(&real, PI, |angle, _| take(angle.min(PI)))?;
        if !multiple.is_multiple_of(2) {
            take(PI);
        }
        found.sort_by(f64::total_cmp);
        Ok(found)
    }

    /// The stable gains from `from` to `to` at a delay of `multiple` ≥ 1 samples, rising; none
    /// where the gains at which zeros pass |z| = 1 are too many.
    #[must_use]
    pub fn stable(&self, multiple: u64, (from, to): (f64, f64)) -> Option<Vec<(f64, f64)>> {
        let mut ends = self.boundaries(multiple).ok()?;
        ends.retain(|gain| from < *gain && *gain < to);
        ends.insert(0, from);
        ends.push(to);
        let mut found: Vec<(f64, f64)> = Vec::new();
        for pair in ends.windows(2) {
            let (low, high) = (pair[0], pair[1]);
            if self.at(0.5 * (low + high)).n_unstable(multiple) != 0 {
                continue;
            }
            match found.last_mut() {
                Some(before) if before.1 == low => before.1 = high,
                _ => found.push((low, high)),
            }
        }
        Some(found)
    }
}

/// Im((p z^l w − 2 s q₀) q₁*): 0 where k of (3) is real.
struct RealGain<'l> {
    on_circle: OnCircle<'l>,
    fixed: Quadratic,
    held: Quadratic,
}

impl RealGain<'_> {
    /// Bounds on the size of its terms, and on their slopes.
    fn bounds(&self, angle: f64) -> [f64; 3] {
        let on = &self.on_circle;
        let [fixed, held] = [self.fixed, self.held].map(|c| on.bounds(c, angle));
        let open = times(on.open_bounds(angle), on.turn_bounds());
        let fixed = times(fixed, on.sine_bounds());
        times(std::array::from_fn(|k| open[k] + fixed[k]), held)
    }
}

impl RealFunction for RealGain<'_> {
    fn at(&self, angle: f64) -> At {
        let parts = self.on_circle.parts(angle);
        let [fixed, held] = [self.fixed, self.held].map(|c| self.on_circle.value(c, angle));
        let ([p, p_slope], [w, w_slope]) = (parts.open, parts.turn);
        let [s, s_slope] = parts.twice_sine;
        let gap = p * w - fixed[0] * s;
        let gap_slope = p_slope * w + p * w_slope - fixed[1] * s - fixed[0] * s_slope;
        let value = gap * held[0].conj();
        let slope = gap_slope * held[0].conj() + gap * held[1].conj();
        let sizes = self.bounds(angle);
        let turns = (self.on_circle.multiple + self.on_circle.of.late as f64) * angle;
        let rounding = ROUNDINGS * (1.0 + turns);
        At {
            omega: angle,
            value: Rounded::sum([value.im]).plus_error(rounding * sizes[0]),
            slope: Rounded::sum([slope.im]).plus_error(rounding * sizes[1]),
        }
    }

    fn bend(&self, angle: f64) -> f64 {
        self.bounds(angle)[2]
    }
}

impl SampledLoop {
    /// The loops with both gains k times as large.
    fn scaled_gains(&self) -> GainLine {
        let mut without = *self;
        [without.groups.a_v, without.groups.a_n] = [0.0; 2];
        without.step.held = [0.0; 3];
        GainLine::through(without, self)
    }

    /// The loop with both gains `factor` times as large.
    #[must_use]
    pub fn with_gains(&self, factor: f64) -> Self {
        self.scaled_gains().at(factor)
    }

    /// The factors of both gains between which the loop stays stable at a delay of `multiple`
    /// samples, where it is stable; NaN where that is not known.
    #[must_use]
    pub fn gain_margin(&self, multiple: u64) -> Limits {
        let line = self.scaled_gains();
        let Ok(mut factors) = line.boundaries(multiple) else {
            return Limits::UNDECIDED;
        };
        factors.retain(|factor| *factor > 0.0);
        let stable = |factor: f64| line.at(factor).n_unstable(multiple) == 0;
        let above = factors.partition_point(|factor| *factor <= 1.0);
        let upper = (above..factors.len()).find(|&i| {
            let next = factors.get(i + 1).map_or(2.0 * factors[i], |next| *next);
            !stable(0.5 * (factors[i] + next))
        });
        let lower = (0..above).rev().find(|&i| {
            let before = i.checked_sub(1).map_or(0.0, |i| factors[i]);
            !stable(0.5 * (factors[i] + before))
        });
        Limits {
            lower: lower.map_or(0.0, |i| factors[i]),
            upper: upper.map_or(f64::INFINITY, |i| factors[i]),
        }
    }
}
