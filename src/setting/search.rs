//! The search for critical velocities.

use super::parameter::Parameter;
use super::values::Setting;
use crate::critical::switch_on::{Phase, Scan};
use crate::critical::{GRAZE_PRECISION, RampOptions};

/// Phases over one cycle for the worst case.
pub(crate) const PHASES: u32 = 32;

/// A protocol of its own, for whole sweeps: Coulomb friction and load control as τ → 0, in the
/// closed form of [`crate::critical::limit`].
pub(crate) const LIMIT: &str = "limit";

/// How motions are started and what is asked of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Protocol {
    /// From controlled stick-slip at low v0, raised until stick-slip ends.
    Follow,
    /// Control is switched on at a phase of uncontrolled stick-slip; the phase is in units of the
    /// setting.
    SwitchOn(Phase),
}

impl Protocol {
    /// Names of the protocols.
    pub(crate) const NAMES: [&'static str; 2] = ["follow", "switch-on"];

    /// The name in flags, sweep files and maps.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Follow => Self::NAMES[0],
            Self::SwitchOn(_) => Self::NAMES[1],
        }
    }

    /// The protocol for a setting, whose own phase takes precedence if it has one.
    #[must_use]
    pub fn at(self, setting: &Setting) -> Self {
        match (self, setting.get(Parameter::SwitchOnPhase)) {
            (Self::SwitchOn(Phase::After(_)), phase) if !phase.is_nan() => {
                Self::SwitchOn(Phase::After(phase))
            }
            (protocol, _) => protocol,
        }
    }

    /// The largest v0 of the search, in units of μ_S N0/√(κM).
    #[must_use]
    pub(crate) fn v_max(self) -> f64 {
        match self {
            Self::Follow => RampOptions::default().v_max,
            Self::SwitchOn(_) => Scan::default().v_max,
        }
    }

    /// The relative precision of v_c.
    #[must_use]
    pub fn precision(self) -> f64 {
        match self {
            Self::Follow => GRAZE_PRECISION,
            Self::SwitchOn(_) => Scan::default().precision,
        }
    }
}

/// The search for the critical velocities of a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// The protocol; a setting's own phase of switch-on takes precedence over the one here.
    pub protocol: Protocol,
    /// The share of cells that are recomputed by simulation, 0 to 1.
    pub verify: f64,
}
