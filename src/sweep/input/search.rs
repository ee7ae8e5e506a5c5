//! How critical velocities are looked for.

use super::parameter::Parameter;
use super::setting::Setting;
use crate::critical::switch_on::{Phase, Scan};
use crate::critical::{GRAZE_PRECISION, RampOptions};

/// Phases over one cycle for the worst case.
pub const PHASES: u32 = 32;

/// The protocol of a sweep that stands for itself: Coulomb friction and load control as τ → 0, the
/// closed form of [`crate::critical::limit`].
pub const LIMIT: &str = "limit";

/// Which question is asked of motions.
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
    pub const NAMES: [&'static str; 2] = ["follow", "switch-on"];

    /// The name in flags, sweep files and maps.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Follow => Self::NAMES[0],
            Self::SwitchOn(_) => Self::NAMES[1],
        }
    }

    /// The protocol for a setting, which may have a phase of its own.
    #[must_use]
    pub fn at(self, setting: &Setting) -> Self {
        match (self, setting.get(Parameter::SwitchOnPhase)) {
            (Self::SwitchOn(Phase::After(_)), phase) if !phase.is_nan() => {
                Self::SwitchOn(Phase::After(phase))
            }
            (protocol, _) => protocol,
        }
    }

    /// The largest v0 at which stick-slip is looked for, in units of μ_S N0/√(κM).
    #[must_use]
    pub fn v_max(self) -> f64 {
        match self {
            Self::Follow => RampOptions::default().v_max,
            Self::SwitchOn(_) => Scan::default().v_max,
        }
    }

    /// To what v_c is known, relative.
    #[must_use]
    pub fn precision(self) -> f64 {
        match self {
            Self::Follow => GRAZE_PRECISION,
            Self::SwitchOn(_) => Scan::default().precision,
        }
    }
}

/// How the critical velocities of a sweep are looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// Which question is asked; a setting's own phase of switch-on comes before the one here.
    pub protocol: Protocol,
    /// The share of cells that are recomputed by simulation, 0 to 1.
    pub verify: f64,
}
