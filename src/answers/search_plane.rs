//! What is searched for best settings: a parameter and the delay, or two parameters.

use crate::setting::parameter::Parameter;
use crate::setting::quantity::Quantity;

/// The two parameters of a plane in which best settings are searched.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchPlane {
    /// The first one: a gain of the block, or a parameter of a system from a file.
    pub p: Quantity,
    /// The second one: the delay, or another parameter of a system from a file.
    pub q: Quantity,
}

impl SearchPlane {
    /// A parameter and the delay.
    #[must_use]
    pub fn with_delay(p: impl Into<Quantity>) -> Self {
        Self {
            p: p.into(),
            q: Parameter::Tau.into(),
        }
    }

    /// Whether the delay is one of them.
    #[must_use]
    pub fn has_delay(&self) -> bool {
        self.q == Parameter::Tau
    }

    /// The second parameter, where that is not the delay.
    #[must_use]
    pub fn second(&self) -> Option<&Quantity> {
        Some(&self.q).filter(|_| !self.has_delay())
    }

    /// Whether the parameter of this name is one of them.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.p.name() == name || self.q.name() == name
    }
}
