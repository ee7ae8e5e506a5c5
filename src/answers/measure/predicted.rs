//! What noise, rounding and drift make of a mean of the elongation, by linear theory.
//!
//! In units of N0 and of N0/√(κM), with u = ẋ − v0 and n the load beyond 1, a long mean is
//!
//! ```text
//! ⟨a⟩ = ⟨μ_K(ẋ) (1 + n)⟩ + g v0 = μ_K(v0) + g v0 + ½ μ_K″ ⟨u²⟩ + μ_K′ ⟨u n⟩ + …
//! ```
//!
//! Under pure load control without dashpots ⟨u n⟩ = −(μ_K′/μ_K)⟨u²⟩: the bias is (½ μ_K″ −
//! μ_K′²/μ_K)⟨u²⟩, which is 0 where 1/μ_K is linear, as for the letter's law.
//!
//! A drift V of v0 in time makes a rise at the rate A = (μ_K′ + g) V, so S = τ A/(1 − R) and
//! ẋ = v − A, and the spring also has to speed the block up, by V.

use std::f64::consts::{PI, SQRT_2};

use crate::linear::sampled::{SampledLoop, multiple};
use crate::model::elementary::exp;
use crate::slip::averaging::Window;
use crate::slip::case::Case;

/// Panels of the mean over a drift.
const PANELS: u32 = 64;

/// The most terms of the series of rounding: beyond them it is that without noise, to 1e-4.
const MOST_TERMS: u32 = 10_000;

/// What is expected of a mean, as of μ_K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Predicted {
    /// The standard error from noise, and from rounding where noise makes it random; 0 without
    /// readings, NaN where it is not known.
    pub error: f64,
    /// The standard error from rounding that noise does not make random; the same in every repeat.
    pub rounding: f64,
    /// The most by which rounding biases every mean where there is no noise, half a step; NaN with
    /// noise, or without rounding.
    pub rounding_bound: f64,
    /// The bias of second order in noise and rounding.
    pub bias_of_noise: f64,
    /// The bias from the drift of v0.
    pub bias_of_drift: f64,
}

impl Default for Predicted {
    /// Of readings that are exact.
    fn default() -> Self {
        Self {
            error: 0.0,
            rounding: 0.0,
            rounding_bound: f64::NAN,
            bias_of_noise: 0.0,
            bias_of_drift: 0.0,
        }
    }
}

impl Predicted {
    /// Of a `case` that slides under control with this `abscissa` < 0, in 1/time, averaged over
    /// `window`; `drift` in 1/time.
    #[must_use]
    pub(super) fn of(case: &Case, window: &Window, abscissa: f64, drift: f64) -> Self {
        let law = Law::of(case);
        let bias_of_drift = drift_bias(case, &law, window, drift);
        let Some(samples) = window.count() else {
            return Self {
                bias_of_drift,
                ..Self::default()
            };
        };
        let (noise, step) = (window.readings.noise, window.readings.resolution);
        let rounding = rounding_error(noise, step);
        // Of rounding, q²/12 in all, what noise does not make random is no noise.
        let variance = noise * noise + (step * step / 12.0 - rounding * rounding).max(0.0);
        if noise == 0.0 {
            return Self {
                rounding,
                rounding_bound: if step > 0.0 { 0.5 * step } else { f64::NAN },
                bias_of_drift,
                ..Self::default()
            };
        }
        let unit = case.units().time;
        let response = case.sliding().ok().and_then(|sliding| {
            let h = sliding.sample_time;
            let of_loop = SampledLoop::new(sliding.groups, sliding.channel, h)?;
            of_loop.noise(multiple(sliding.tau, h)?, samples, abscissa * unit)
        });
        let alpha_n = case.feedback.dimensionless(&case.oscillator).gains.alpha_n;
        let (error, bias_of_noise) = match response {
            Some(of) => (
                variance.sqrt() * of.of_mean,
                variance * (0.5 * law.curvature * of.u_square + law.slope * alpha_n * of.u_signal),
            ),
            None => (f64::NAN, f64::NAN),
        };
        Self {
            error,
            rounding,
            bias_of_noise,
            bias_of_drift,
            ..Self::default()
        }
    }

    /// The whole bias.
    #[must_use]
    pub fn bias(&self) -> f64 {
        self.bias_of_noise + self.bias_of_drift
    }

    /// The standard error of the mean of so many repeats.
    #[must_use]
    pub fn error_of(&self, repeats: u32) -> f64 {
        let each = self.error * self.error / f64::from(repeats.max(1));
        (each + self.rounding * self.rounding).sqrt()
    }
}

/// The error, root mean square over all elongations, of the mean of readings rounded to multiples
/// of `step` after `noise`: the Fourier series of rounding, whose terms noise damps (Carbone and
/// Petri 1994).
fn rounding_error(noise: f64, step: f64) -> f64 {
    if noise == 0.0 || step == 0.0 {
        return step / 12.0_f64.sqrt();
    }
    let turns = 2.0 * PI * noise / step;
    let mut square = 0.0;
    for k in 1..=MOST_TERMS {
        let k = f64::from(k);
        let term = exp(-turns * turns * k * k) / (k * k);
        square += term;
        if term < f64::EPSILON * square {
            break;
        }
    }
    step / (PI * SQRT_2) * square.sqrt()
}

/// A friction law at v0, in the units of a motion.
struct Law {
    slope: f64,
    curvature: f64,
}

impl Law {
    fn of(case: &Case) -> Self {
        let unit = case.units().velocity;
        let (least, most) = case.law.curvatures_between(case.v0, case.v0);
        Self {
            slope: case.law.mu_prime(case.v0) * unit,
            curvature: 0.5 * (least + most) * unit * unit,
        }
    }
}

/// The bias from a drift, to the first order in it, but for μ_K itself at the v0 of each time.
fn drift_bias(case: &Case, law: &Law, window: &Window, drift: f64) -> f64 {
    if drift == 0.0 {
        return 0.0;
    }
    let units = case.units();
    let rate = drift * units.time;
    let dashpots = case.oscillator.dashpot_ratios();
    let held = |v0: f64| case.law.mu_k(v0) + dashpots.viscous * v0 / units.velocity;
    let mut mean = 0.0;
    for panel in 0..PANELS {
        let part = (f64::from(panel) + 0.5) / f64::from(PANELS);
        let t = window.from + part * (window.to - window.from);
        mean += held(case.v0 * (1.0 + rate * t)) / f64::from(PANELS);
    }
    let feedback = case.feedback.dimensionless(&case.oscillator);
    let pull = case.v0 / units.velocity * rate;
    let slope = law.slope + dashpots.viscous;
    let rise = slope * pull;
    let signal = feedback.tau * rise / (1.0 - feedback.channel.memory);
    let beyond = feedback.gains.alpha_v * signal - rise;
    let load = feedback.gains.alpha_n * signal;
    mean - held(case.v0) + slope * beyond + case.law.mu_k(case.v0) * load + pull
        - dashpots.damping * rise
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_takes_away_what_rounding_does() {
        assert_eq!(rounding_error(0.1, 0.0), 0.0);
        assert_eq!(rounding_error(0.0, 0.6), 0.6 / 12.0_f64.sqrt());
        // The mean of readings of a at noise σ, by the whole sum, over all a.
        let (noise, step) = (0.4, 1.0);
        let normal = |x: f64| (-0.5 * x * x / (noise * noise)).exp();
        let (mut square, mut random, many) = (0.0, 0.0, 200);
        for place in 0..many {
            let a = f64::from(place) / f64::from(many);
            let (mut mean, mut of_squares, mut weight) = (0.0, 0.0, 0.0);
            for i in -4000..=4000 {
                let n = f64::from(i) * 0.001;
                let read = (a + n).round();
                mean += normal(n) * read;
                of_squares += normal(n) * read * read;
                weight += normal(n);
            }
            mean /= weight;
            square += (mean - a) * (mean - a) / f64::from(many);
            random += (of_squares / weight - mean * mean) / f64::from(many);
        }
        // What is random of a reading is the rest of the whole, over all a.
        let whole = noise * noise + step * step / 12.0;
        let rounding = rounding_error(noise, step);
        let rest = whole - rounding * rounding;
        assert!((random / rest - 1.0).abs() < 1e-3, "{random} {rest}");
        let found = rounding_error(noise, step);
        let mean = square.sqrt();
        assert!((mean / found - 1.0).abs() < 1e-3, "{mean} {found}");
        let little = rounding_error(1e-6, 1.0) * 12.0_f64.sqrt();
        assert!((little - 1.0).abs() < 1e-4, "{little}");
    }
}
