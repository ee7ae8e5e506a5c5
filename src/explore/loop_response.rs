//! The frequency response of a loop: L(iω) at as many frequencies as its curve needs.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use crate::linear::margins::SystemLoop;
use crate::model::elementary::{arg, exp, ln, norm};
use crate::setting::no_answer::NoAnswer;
use crate::setting::{Parameter, Setting};

/// How far beyond the lowest and the highest frequency of interest the curve goes.
const BEYOND: f64 = 30.0;
/// Intervals in the first place, evenly over the logarithm of the frequency.
const FIRST: usize = 240;
/// Between two samples L turns by at most this angle, and grows by at most this factor, as a
/// logarithm.
const TURN: f64 = 0.06;
const GROWTH: f64 = 0.08;
/// Halvings of one of the first intervals at most.
const MOST_HALVINGS: u32 = 12;
/// Turns of the delay up to the highest frequency at most, where that is not one of interest.
const MOST_TURNS: f64 = 40.0;

/// L(iω) of a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopResponse {
    /// ω > 0, in rad/time, and L(iω), by rising ω.
    pub samples: Vec<(f64, Complex64)>,
}

impl LoopResponse {
    /// The loop of a setting with all its parameters: what is delayed over what is not, with the
    /// delay as it is. None where nothing is fed back, and of models that are no loop of this kind:
    /// digital ones, and matrices with several signals. The curve holds the frequencies
    /// `of_interest` too, in rad/time.
    ///
    /// # Errors
    /// When a parameter is outside the model's range, or an expression has no value.
    pub fn of(setting: &Setting, of_interest: &[f64]) -> Result<Option<Self>, NoAnswer> {
        let (linear, time_unit) = setting.answered()?;
        let tau = setting.get(Parameter::Tau) / time_unit;
        let of = linear
            .system()
            .and_then(|system| SystemLoop::new(&system, tau));
        let Some(of) = of.filter(|of| !of.idle()) else {
            return Ok(None);
        };
        let known = of_interest.iter().map(|omega| omega * time_unit);
        let mut frequencies: Vec<f64> = known.chain(of.frequencies()).collect();
        frequencies.retain(|omega| *omega > 0.0 && omega.is_finite());
        let mut samples = sampled(&|omega| of.value(omega), range(&frequencies, tau));
        for (omega, _) in &mut samples {
            *omega /= time_unit;
        }
        Ok(Some(Self { samples }))
    }

    /// The angle of L at every sample, in degrees, without jumps; it begins between −270 and 90.
    #[must_use]
    pub fn phases(&self) -> Vec<f64> {
        let mut phases = Vec::with_capacity(self.samples.len());
        let mut before: Option<(Complex64, f64)> = None;
        for &(_, value) in &self.samples {
            let phase = match before {
                None if arg(value) > 0.5 * PI => arg(value) - TAU,
                None => arg(value),
                Some((last, phase)) => phase + arg(value / last),
            };
            before = Some((value, phase));
            phases.push(phase.to_degrees());
        }
        phases
    }
}

/// The lowest and the highest frequency of the curve, from those of interest.
fn range(frequencies: &[f64], tau: f64) -> (f64, f64) {
    let fold = |of: fn(f64, f64) -> f64| frequencies.iter().copied().reduce(of).unwrap_or(1.0);
    let (lowest, highest) = (fold(f64::min), fold(f64::max));
    let most = match tau > 0.0 {
        true => (MOST_TURNS * TAU / tau).max(3.0 * highest),
        false => f64::INFINITY,
    };
    (lowest / BEYOND, (highest * BEYOND).min(most))
}

/// A function of ω > 0 at so many places that it turns and grows little between them. Places where
/// it is not finite are left out.
fn sampled(of: &impl Fn(f64) -> Complex64, (from, to): (f64, f64)) -> Vec<(f64, Complex64)> {
    let (low, high) = (ln(from), ln(to));
    let at = |x: f64| (exp(x), of(exp(x)));
    let mut samples = vec![at(low)];
    let mut left = low;
    for i in 1..=FIRST {
        let right = low + (high - low) * (i as f64 / FIRST as f64);
        refine(&at, (left, right), MOST_HALVINGS, &mut samples);
        left = right;
    }
    samples.retain(|(_, value)| value.is_finite() && *value != Complex64::ZERO);
    samples
}

/// Adds samples behind the last one up to the right end of an interval.
fn refine(
    at: &impl Fn(f64) -> (f64, Complex64),
    (left, right): (f64, f64),
    halvings: u32,
    samples: &mut Vec<(f64, Complex64)>,
) {
    let there = at(right);
    let before = samples.last().map_or(there.1, |sample| sample.1);
    let step = there.1 / before;
    let near = arg(step).abs() <= TURN && ln(norm(step)).abs() <= GROWTH;
    if near || halvings == 0 || !step.is_finite() {
        samples.push(there);
        return;
    }
    let middle = 0.5 * (left + right);
    refine(at, (left, middle), halvings - 1, samples);
    refine(at, (middle, right), halvings - 1, samples);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// e^(−2iω)/(iω): its size is 1/ω and its angle −π/2 − 2ω, through many turns.
    #[test]
    fn phases_have_no_jumps() {
        let of = |omega: f64| Complex64::new(0.0, -2.0 * omega).exp() / Complex64::new(0.0, omega);
        let response = LoopResponse {
            samples: sampled(&of, (0.01, 40.0)),
        };
        assert!(response.samples.len() < 20_000);
        for ((omega, value), phase) in response.samples.iter().zip(response.phases()) {
            let expected = -90.0 - (2.0 * omega).to_degrees();
            assert!(
                (phase - expected).abs() < 1e-8,
                "{omega} {phase} {expected}"
            );
            assert!((norm(*value) * omega - 1.0).abs() < 1e-12);
        }
        let turns = response
            .samples
            .windows(2)
            .map(|pair| arg(pair[1].1 / pair[0].1).abs());
        assert!(turns.fold(0.0, f64::max) < 0.07);
    }

    #[test]
    fn the_range_holds_what_is_of_interest() {
        assert_eq!(range(&[0.5, 2.0], 0.0), (0.5 / 30.0, 60.0));
        let (_, to) = range(&[0.5, 2.0], 1000.0);
        assert_eq!(to, 6.0);
    }
}
