//! The readings of a motion, and what is held from one of them to the next.

use super::parameters::Parameters;
use crate::model::Channel;
use crate::slip::readings::Sampler;
use crate::slip::return_map::Controller;

/// The lowest order of a step: near sliding it moves next to nothing from one reading to the next.
pub(super) const LEAST: usize = 2;

/// The readings of a motion, and what is held of them.
#[derive(Debug, Clone, Default)]
pub(super) struct Sampled {
    pub sampler: Sampler,
    /// Control by the return map, in the place of the signal of delayed feedback.
    pub controller: Option<Controller>,
    /// S, v and N.
    pub signal: f64,
    pub velocity: f64,
    pub load: f64,
    /// The slope of v on a ramp of v0, and how long v follows it or stays at a limit.
    pub slope: f64,
    pub lasts: f64,
    /// The order that the last step needed.
    pub order: usize,
}

impl Sampled {
    /// Begins anew, with the elongation `known` up to t = 0, which does not vary before `since`.
    /// Takes memory and latency out of the parameters: readings have them.
    pub(super) fn restart(
        &mut self,
        parameters: &mut Parameters,
        since: f64,
        known: impl Fn(f64) -> f64,
    ) {
        let (feedback, switch_on) = (&parameters.feedback, parameters.switch_on);
        self.sampler
            .restart(feedback, switch_on, [since, 0.0], known);
        self.controller = Controller::of(parameters).filter(|_| self.sampler.acts());
        self.order = LEAST;
        (self.signal, self.velocity, self.load) = (0.0, parameters.v0, 1.0);
        (self.slope, self.lasts) = (0.0, f64::INFINITY);
        if self.acts() {
            parameters.feedback.channel = Channel::default();
        }
    }

    /// Whether readings are held.
    pub(super) fn acts(&self) -> bool {
        self.sampler.acts()
    }

    /// Becomes a copy of `other` in the memory that it has.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.sampler.copy_from(&other.sampler);
        self.controller = other.controller;
        (self.signal, self.order) = (other.signal, other.order);
        (self.velocity, self.load) = (other.velocity, other.load);
        (self.slope, self.lasts) = (other.slope, other.lasts);
    }
}
