//! A system from a file with values of its own parameters: a part of a setting.

use std::sync::Arc;

use super::system::parameter::OwnParameter;
use super::system::{Evaluation, SystemModel};
use crate::model::Feedback;

/// A system from a file, with values of its own parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OwnSystem {
    pub model: Arc<SystemModel>,
    values: Vec<f64>,
}

impl OwnSystem {
    /// The system with its parameters at their defaults.
    pub(super) fn new(model: Arc<SystemModel>) -> Self {
        let values = model.parameters.iter().map(|own| own.default).collect();
        Self { model, values }
    }

    /// The parameters with their values.
    pub(super) fn parameters(&self) -> impl Iterator<Item = (&Arc<OwnParameter>, f64)> {
        self.model
            .parameters
            .iter()
            .zip(self.values.iter().copied())
    }

    /// The value of one of its parameters.
    pub(super) fn get(&self, own: &OwnParameter) -> f64 {
        self.values[own.index]
    }

    #[inline]
    pub(super) fn set(&mut self, own: &OwnParameter, value: f64) {
        self.values[own.index] = value;
    }

    /// Copies its values, and those of delay, memory and latency, into `at` for evaluation.
    pub(super) fn put_into(&self, at: &mut Evaluation, feedback: Feedback) {
        at.own.clone_from(&self.values);
        (at.tau, at.channel) = (feedback.tau, feedback.channel);
    }
}
