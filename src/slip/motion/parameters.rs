//! What a motion is given: its parameters, and how exactly it is followed.

use crate::model::{Dashpots, Feedback, FrictionLaw};

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
    /// A corner of the programme of v0.
    Programme,
}

/// The parameters of a motion, dimensionless as in the module.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// The friction law.
    pub law: FrictionLaw,
    /// N0/√(κM), the unit of velocity in which the law's speeds are given.
    pub velocity_unit: f64,
    /// d and g, the dashpots beside the spring and to the ground, in units of √(κM).
    pub dashpots: Dashpots,
    /// The feedback, without lags.
    pub feedback: Feedback,
    /// v0 √(κM)/N0.
    pub v0: f64,
    /// When control begins to act.
    pub switch_on: f64,
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
