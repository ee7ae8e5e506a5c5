//! What is given of a block and its control.

use super::law::Friction;

/// What is given, in any units that fit together.
#[derive(Debug, Clone)]
pub(crate) struct Setting {
    pub friction: Friction,
    pub mass: f64,
    pub stiffness: f64,
    pub load: f64,
    pub alpha_v: f64,
    pub alpha_n: f64,
    pub tau: f64,
    pub v0: f64,
    /// When control begins to act; infinite for never.
    pub switch_on: f64,
}

impl Setting {
    /// √(M/κ).
    pub(crate) fn time(&self) -> f64 {
        (self.mass / self.stiffness).sqrt()
    }
}
