//! Frequencies beyond which no root lies on the line, over ranges of what a setting can be.

use super::super::enclosure::root_bound;
use super::super::equations::UpTo;
use super::feedback::Beyond;
use crate::model::elementary::exp;

/// Bounds come nearer to the highest frequency in steps of this factor.
const NEARER: f64 = 0.8;
/// The most such steps.
const MOST_STEPS: u32 = 60;

impl Beyond {
    /// The ω beyond which no root lies on λ = −σ + iω, σ = `decay`; infinite where roots accumulate
    /// on that line.
    ///
    /// |B₀| ≤ c |A₀|, c = e^(σδ)(1 + e^(στ))/(1 − |R| e^(στ)), where every part of A₀ is divided by
    /// the lags that it does not pass. |1 + Tλ|² = (1 − Tσ)² + T²ω² grows with ω, so what holds
    /// beyond one frequency makes the next, lower one.
    pub(super) fn highest(&self, up_to: UpTo, decay: f64) -> f64 {
        let UpTo { groups, factor, .. } = up_to;
        let delayed = exp(decay * (up_to.tau * factor)) * (1.0 + 1e-12);
        let kept = 1.0 - self.channel.memory.abs() * delayed;
        if kept.is_nan() || kept <= 0.0 {
            return f64::INFINITY;
        }
        let control = exp(decay * up_to.latency) * (1.0 + delayed) / kept;
        let beyond = |omega: f64| {
            let lag = |time: f64| {
                let (re, im) = (1.0 - time * decay, time * omega);
                (re * re + im * im).sqrt()
            };
            let sensor = lag(self.lags.sensor);
            let a_v = (groups.a_v * factor).abs() / (lag(self.lags.velocity) * sensor);
            let plain = groups.a_n.abs() + self.damping * groups.a_v.abs();
            let a_n = (plain * factor).abs() / (lag(self.lags.load) * sensor);
            let a_n = a_n + self.damping * a_v;
            root_bound(groups.b, a_v, a_n, control) * (1.0 + 1e-12)
        };
        // A lag of exactly 1/σ is 0 at ω = 0 alone.
        let mut highest = beyond(1.0).max(1.0);
        for _ in 0..MOST_STEPS {
            let lower = NEARER * highest;
            if beyond(lower) > lower {
                break;
            }
            highest = lower;
        }
        highest
    }
}
