//! The setting that `slipmap best` recommends.

use crate::answers::best::{BestSettings, Ranges, RobustSetting};
use crate::explore::point::Point;
use crate::explore::vc::CriticalVelocity;
use crate::linear::best::SearchedGain;
use crate::setting::Parameter;
use crate::setting::quantity::Quantity;
use clap::ValueEnum;
use serde::Serialize;
use utoipa::ToSchema;

use super::asked::Asked;
use super::robust::MayBeOff;

/// Controls by name.
#[derive(Debug, Clone, Copy, ValueEnum, Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum Control {
    /// α_v: the pulling velocity follows the delayed elongation
    Velocity,
    /// α_N: the normal load does
    Load,
}

/// The best settings, with all about the recommended one.
pub(super) struct Recommended {
    /// The recommended setting: the robust one, if there is one.
    pub(super) asked: Asked,
    /// What is searched beside the delay.
    pub(super) searched: Quantity,
    pub(super) ranges: Ranges,
    /// What may be off at the robust setting, if one is requested.
    pub(super) may_be_off: Option<MayBeOff>,
    pub(super) found: BestSettings,
    /// None if it is not requested, or no setting stays stable.
    pub(super) robust: Option<RobustSetting>,
    /// The recommended setting, with its margins.
    pub(super) point: Point,
    /// v_c, if there is a friction law.
    pub(super) vc: Option<CriticalVelocity>,
}

impl Control {
    pub(super) fn parameter(self) -> Parameter {
        match self {
            Self::Velocity => Parameter::AlphaV,
            Self::Load => Parameter::AlphaN,
        }
    }

    /// The control whose gain is searched.
    pub(super) fn of(searched: &Quantity) -> Self {
        match *searched == Parameter::AlphaN {
            true => Self::Load,
            false => Self::Velocity,
        }
    }

    pub(super) fn searched(self) -> SearchedGain {
        match self {
            Self::Velocity => SearchedGain::Velocity,
            Self::Load => SearchedGain::Load,
        }
    }
}
