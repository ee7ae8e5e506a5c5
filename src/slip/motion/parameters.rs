//! What a motion is given: its parameters, and how exactly it is followed.

use crate::model::FrictionLaw;

/// What the block does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// At rest.
    Stick,
    /// ẋ > 0.
    Forwards,
    /// ẋ < 0.
    Backwards,
}

/// What ends a mode, or changes the equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// From stick to slip.
    Release,
    /// From slip to stick.
    Stick,
    /// From slip to slip the other way.
    Reversal,
    /// N ≤ 0: the model ends.
    LiftOff,
    /// Control begins to act.
    SwitchOn,
}

/// The parameters of a motion, dimensionless as in the module.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// The friction law.
    pub law: FrictionLaw,
    /// N0/√(κM), the unit of velocity in which the law's speeds are given.
    pub velocity_unit: f64,
    /// α_v √(M/κ).
    pub alpha_v: f64,
    /// α_N/κ.
    pub alpha_n: f64,
    /// τ √(κ/M), greater than 0 where control acts.
    pub tau: f64,
    /// R, the memory of the feedback, −1 < R < 1; ignored without gains.
    pub memory: f64,
    /// δ √(κ/M) ≥ 0, the latency of the feedback; ignored without gains.
    pub latency: f64,
    /// v0 √(κM)/N0.
    pub v0: f64,
    /// When control begins to act.
    pub switch_on: f64,
}

impl Parameters {
    /// Whether any gain acts.
    #[must_use]
    pub fn controlled(&self) -> bool {
        self.alpha_v != 0.0 || self.alpha_n != 0.0
    }

    /// Whether the feedback has memory or latency: more than the letter's own.
    #[must_use]
    pub fn beyond_letter(&self) -> bool {
        self.controlled() && (self.memory != 0.0 || self.latency != 0.0)
    }

    /// How long the feedback remembers: τ/(1 − |R|) + δ, which is one delay without memory and
    /// latency.
    #[must_use]
    pub fn remembered(&self) -> f64 {
        match self.beyond_letter() {
            true => remembered(self.tau, self.memory, self.latency),
            false => self.tau,
        }
    }
}

/// τ/(1 − |R|) + δ.
pub(crate) fn remembered(tau: f64, memory: f64, latency: f64) -> f64 {
    tau / (1.0 - memory.abs()) + latency
}

/// How steps are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrator {
    /// By Taylor series.
    Taylor,
    /// By collocation, from values of the friction law: a second opinion, some ten times slower.
    Collocation,
}

/// How exact a motion is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// How steps are made.
    pub integrator: Integrator,
    /// Error allowed in a step, relative to the size of the motion; 1e-15 to 1e-3.
    pub tolerance: f64,
}

impl Accuracy {
    /// Taylor's method with this tolerance.
    #[must_use]
    pub fn of(tolerance: f64) -> Self {
        Self {
            tolerance,
            ..Self::default()
        }
    }
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            integrator: Integrator::Taylor,
            tolerance: 1e-12,
        }
    }
}
