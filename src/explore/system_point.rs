//! Linear stability of a system from a file at a point of its parameters.

use std::collections::BTreeMap;

use serde::Serialize;

use super::finite;
use super::margin_kind::MarginKind;
use super::stability::{Stability, Wanted};
use crate::linear::general::Class;
use crate::linear::line::Linear;
use crate::model::stop::Stop;
use crate::sweep::input::system::{Evaluation, SystemModel, Undefined};

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
    #[cfg_attr(feature = "serve", schema(required))]
    pub latency_margin: Option<f64>,
    /// Its stability, with its roots.
    #[serde(flatten)]
    pub stability: Stability,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoAnswer {
    /// An expression has no value.
    #[error(transparent)]
    Undefined(#[from] Undefined),
    /// The system is of a kind that is not answered at any delay.
    #[error("this system is not answered: |P| = |Q| on all of the imaginary axis")]
    Refused,
    /// There is no equation.
    #[error("this system is not answered: P and Q are both 0")]
    Zero,
}

impl SystemPoint {
    /// Linear stability at a setting.
    ///
    /// # Errors
    /// When an expression has no value there, or systems of this kind are refused.
    pub fn at(model: &SystemModel, at: &mut Evaluation, wanted: Wanted) -> Result<Self, NoAnswer> {
        let system = model.at(at)?;
        if system.class() == Class::Refused {
            return Err(match system.is_zero() {
                true => NoAnswer::Zero,
                false => NoAnswer::Refused,
            });
        }
        let own = model.parameters.iter().map(|own| own.name.clone());
        let line_of_delays = !model.depends_on_delay();
        let feedback = model.is_feedback();
        let system = Linear::General(Box::new(system));
        let mut stability = Stability::of(&system, (1.0, at.tau), wanted, &Stop::default());
        if !line_of_delays {
            forget_other_delays(&mut stability);
        }
        Ok(Self {
            system: model.title.clone(),
            parameters: own.zip(at.own.iter().copied()).collect(),
            tau: at.tau,
            memory: feedback.then_some(at.channel.memory),
            latency: feedback.then_some(at.channel.latency),
            line_of_delays,
            latency_margin: stability.latencies.margin.and_then(finite),
            stability,
        })
    }
}

/// Keeps what holds at the delay itself: at other delays P and Q differ.
fn forget_other_delays(stability: &mut Stability) {
    stability.stable_delays = None;
    stability.stable_delays_truncated = false;
    stability.delay_margin = None;
    stability.delay_margin_kind = MarginKind::Unknown;
    stability.delay_margin_sign = 0;
    stability.n_at_zero_delay = None;
    stability.first_crossing = None;
    stability.first_change = None;
    stability.crossings = None;
}
