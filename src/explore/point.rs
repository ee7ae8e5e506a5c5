//! Linear stability at a point of parameter space: of continuous sliding of the block, or of a
//! system from a file.

use std::collections::BTreeMap;

use serde::Serialize;

use super::margin_kind::MarginKind;
use super::margins::Margins;
use super::stability::{Stability, Wanted};
use crate::model::elementary::exp;
use crate::model::stop::Stop;
use crate::setting::no_answer::NoAnswer;
use crate::setting::system::SystemModel;
use crate::setting::{Parameter, Setting};
use crate::text::finite;

/// Linear stability at a point.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum Point {
    /// Of the block on its spring.
    Block(Box<BlockPoint>),
    /// Of a system from a file.
    System(Box<SystemPoint>),
}

/// Linear stability at a point, in the units of its setting.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema), schema(as = Point))]
pub struct BlockPoint {
    /// μ_K′(v0).
    pub mu_prime: f64,
    /// μ_K(v0).
    pub mu_k: f64,
    /// α_v.
    pub alpha_v: f64,
    /// α_N.
    pub alpha_n: f64,
    /// τ.
    pub tau: f64,
    /// Stiffness over the critical one of rate-and-state friction, below which steady sliding
    /// without control is unstable; null where it is stable at every stiffness, and under other
    /// laws.
    #[cfg_attr(feature = "serve", schema(required))]
    pub stiffness_ratio: Option<f64>,
    /// The factor by which a small disturbance changes from one reading to the next; null without a
    /// sample time, and where no root converged.
    #[cfg_attr(feature = "serve", schema(required))]
    pub spectral_radius: Option<f64>,
    /// Its stability, with its roots.
    #[serde(flatten)]
    pub stability: Stability,
    /// How far it is from the boundary of stability.
    #[serde(flatten)]
    pub margins: Margins,
}

/// Linear stability of a system at a point.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct SystemPoint {
    /// What the system is, by its file; may be empty.
    pub system: String,
    /// Its own parameters by their names.
    pub parameters: BTreeMap<String, f64>,
    /// τ.
    pub tau: f64,
    /// R; null for P and Q, which have no memory.
    #[cfg_attr(feature = "serve", schema(required))]
    pub memory: Option<f64>,
    /// δ; null for P and Q, which have no latency.
    #[cfg_attr(feature = "serve", schema(required))]
    pub latency: Option<f64>,
    /// Whether all delays are covered. They are not where P or Q depends on the delay: then only
    /// `n_unstable` and the roots are given, and all values about other delays are null.
    pub line_of_delays: bool,
    /// The largest latency of the feedback, counted from none, at which the setting stays stable; 0
    /// where it is unstable without latency. Null where it is infinite or unknown, and for P and Q,
    /// which have no latency.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub latency_margin: f64,
    /// Its stability, with its roots.
    #[serde(flatten)]
    pub stability: Stability,
}

impl Point {
    /// Linear stability at a setting with all its parameters. Once `stop` is set, the answer comes
    /// soon but is meaningless.
    ///
    /// # Errors
    /// When a parameter is outside the model's range, or nothing is known of such a model.
    pub fn at(setting: &Setting, wanted: Wanted, stop: &Stop) -> Result<Self, NoAnswer> {
        let (model, time_unit) = setting.answered()?;
        let tau = setting.get(Parameter::Tau);
        let stability = Stability::of(&model, (time_unit, tau), wanted, stop);
        Ok(match setting.system() {
            Some(model) => Self::System(Box::new(SystemPoint::of(setting, model, stability))),
            None => Self::Block(Box::new(BlockPoint::of(setting, stability, stop)?)),
        })
    }

    /// Its stability, with its roots.
    #[must_use]
    pub fn stability(&self) -> &Stability {
        match self {
            Self::Block(point) => &point.stability,
            Self::System(point) => &point.stability,
        }
    }
}

impl BlockPoint {
    fn of(setting: &Setting, stability: Stability, stop: &Stop) -> Result<Self, NoAnswer> {
        let sliding = setting.sliding_point()?;
        let margins = Margins::at(setting, 0.0, stop)?;
        let tau = setting.get(Parameter::Tau);
        Ok(Self {
            mu_prime: sliding.mu_prime,
            mu_k: sliding.mu_k,
            alpha_v: setting.get(Parameter::AlphaV),
            alpha_n: setting.get(Parameter::AlphaN),
            tau,
            stiffness_ratio: setting.stiffness_ratio().and_then(finite),
            spectral_radius: spectral_radius(setting, stability.spectrum.abscissa),
            margins: margins.unwrap_or_else(|| Margins::of_stability(&stability, tau)),
            stability,
        })
    }
}

/// e^(abscissa h) of a digital loop.
fn spectral_radius(setting: &Setting, abscissa: f64) -> Option<f64> {
    let feedback = setting.feedback();
    let sampled = feedback.is_sampled();
    finite(exp(abscissa * feedback.readings.sample_time)).filter(|_| sampled)
}

impl SystemPoint {
    fn of(setting: &Setting, model: &SystemModel, mut stability: Stability) -> Self {
        let line_of_delays = setting.has_lines();
        if !line_of_delays {
            forget_other_delays(&mut stability);
        }
        let of_feedback = |parameter| model.is_feedback().then(|| setting.get(parameter));
        Self {
            system: model.title.clone(),
            parameters: setting
                .own()
                .map(|(own, value)| (own.name.clone(), value))
                .collect(),
            tau: setting.get(Parameter::Tau),
            memory: of_feedback(Parameter::Memory),
            latency: of_feedback(Parameter::Latency),
            line_of_delays,
            latency_margin: stability.latencies.margin.unwrap_or(f64::NAN),
            stability,
        }
    }
}

/// Keeps what holds at the delay itself: at other delays P and Q differ.
fn forget_other_delays(stability: &mut Stability) {
    stability.stable_delays = None;
    stability.stable_delays_truncated = false;
    stability.delay_margin = f64::NAN;
    stability.delay_margin_kind = MarginKind::Unknown;
    stability.delay_margin_sign = 0;
    stability.n_at_zero_delay = None;
    stability.first_crossing = None;
    stability.first_change = None;
    stability.crossings = None;
}
