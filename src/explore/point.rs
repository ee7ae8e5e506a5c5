//! Linear stability of continuous sliding at a point of parameter space.

use serde::Serialize;

use super::finite;
use super::margins::Margins;
use super::stability::{Stability, Wanted};
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::sweep::{Parameter, Setting};

/// Linear stability at a point, in the units of its setting.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Point {
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
    /// Its stability, with its roots.
    #[serde(flatten)]
    pub stability: Stability,
    /// How far it is from the boundary of stability.
    #[serde(flatten)]
    pub margins: Margins,
}

impl Point {
    /// Linear stability of a setting with all its parameters. Once `stop` is set, the answer comes
    /// soon but is meaningless.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn at(setting: &Setting, wanted: Wanted, stop: &Stop) -> Result<Self, ModelError> {
        let sliding = setting.sliding_point()?;
        let (model, time_unit) = setting.linear()?;
        let tau = setting.get(Parameter::Tau);
        let stability = Stability::of(&model, (time_unit, tau), wanted, stop);
        let margins = match setting.has_state() {
            true => Margins::of_stability(&stability, tau),
            false => Margins::at(setting, 0.0, stop)?,
        };
        Ok(Self {
            mu_prime: sliding.mu_prime,
            mu_k: sliding.mu_k,
            alpha_v: setting.get(Parameter::AlphaV),
            alpha_n: setting.get(Parameter::AlphaN),
            tau,
            stiffness_ratio: setting.stiffness_ratio().and_then(finite),
            stability,
            margins,
        })
    }
}
