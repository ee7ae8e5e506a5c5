//! The frequencies of the crossings that margins come from.
//!
//! What is not known is NaN here; JSON has null for it.

use serde::Serialize;

use super::margin_range::{Margin, Range};
use super::margins::Margins;
use crate::answers::margins::crossing_of;
use crate::setting::{Parameter, Setting};

/// ω of the crossings that margins come from, rad/time: at a limit a root lies there, on the
/// imaginary axis or the line of the decay rate. 0 for a real root; null where nothing is lost by a
/// crossing, and where it is not known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct CrossingFrequencies {
    /// At both ends of the gain margin.
    pub gain_margin: Range,
    /// Where the loop, of size 1, has the phase margin for its angle; null where that is not known.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub phase_margin: f64,
    /// At the latency margin; null where there is none, and where it is not known.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub latency_margin: f64,
    /// Where the loop is nearest to −1; null as well where that is beyond all frequencies.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub modulus_margin: f64,
    /// At both ends of the delays.
    pub tau_margin: Range,
    /// At both ends of the slopes.
    pub mu_prime_margin: Range,
    /// At both ends of the sliding velocities.
    pub v0_margin: Range,
}

impl CrossingFrequencies {
    /// No crossings.
    pub(super) const NONE: Self = Self {
        gain_margin: Range::NONE,
        phase_margin: f64::NAN,
        latency_margin: f64::NAN,
        modulus_margin: f64::NAN,
        tau_margin: Range::NONE,
        mu_prime_margin: Range::NONE,
        v0_margin: Range::NONE,
    };

    /// The frequencies of the roots on the line at all limits of a block's parameters.
    pub(super) fn of_block(margins: &Margins, setting: &Setting) -> Self {
        let at = |changed: &[(Parameter, f64)]| {
            if changed.iter().any(|(_, value)| !value.is_finite()) {
                return f64::NAN;
            }
            let mut limit = setting.clone();
            for (parameter, value) in changed {
                limit.set(*parameter, *value);
            }
            crossing_of(&limit, margins.required_decay)
        };
        let gain = |factor: f64| match factor > 0.0 {
            true => at(&[Parameter::AlphaV, Parameter::AlphaN]
                .map(|gain| (gain, factor * setting.get(gain)))),
            false => f64::NAN,
        };
        let along = |parameter: Parameter, margin: Option<Margin>| {
            margin.map_or(Range::NONE, |margin| {
                Range::of([margin.from, margin.to].map(|end| at(&[(parameter, end)])))
            })
        };
        let ends = margins
            .gain_margin
            .map_or([f64::NAN; 2], |of| [of.lower, of.upper]);
        Self {
            gain_margin: Range::of(ends.map(gain)),
            latency_margin: at(&[(Parameter::Latency, margins.latency_margin)]),
            tau_margin: along(Parameter::Tau, margins.tau_margin),
            mu_prime_margin: along(Parameter::MuPrime, margins.mu_prime_margin),
            v0_margin: along(Parameter::V0, margins.v0_margin),
            ..Self::NONE
        }
    }
}
