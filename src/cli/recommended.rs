//! The setting that `slipmap best` recommends.

use clap::ValueEnum;
use serde::Serialize;
use slipmap::explore::margins::Margins;
use slipmap::explore::vc::CriticalVelocity;
use slipmap::linear::best::SearchedGain;
use slipmap::sweep::cells::best::{BestSettings, Ranges, RobustSetting};
use slipmap::sweep::{Parameter, Setting};
use utoipa::ToSchema;

/// Controls by name.
#[derive(Debug, Clone, Copy, ValueEnum, Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum Control {
    /// α_v: the pulling velocity follows the delayed elongation
    Velocity,
    /// α_N: the normal load does
    Load,
}

/// The best settings, with the margins and v_c of the recommended one.
pub(super) struct Recommended {
    pub(super) control: Control,
    pub(super) ranges: Ranges,
    /// The largest relative error of gain, delay and μ′, if requested.
    pub(super) spread: Option<f64>,
    pub(super) found: BestSettings,
    /// None if it is not requested, or no setting stays stable.
    pub(super) robust: Option<RobustSetting>,
    /// The recommended setting: the robust one, if there is one.
    pub(super) setting: Setting,
    pub(super) margins: Margins,
    /// The number of unstable roots of the recommended setting; none where it is stable, or where
    /// that is not known.
    pub(super) unstable_roots: Option<u64>,
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

    pub(super) fn searched(self) -> SearchedGain {
        match self {
            Self::Velocity => SearchedGain::Velocity,
            Self::Load => SearchedGain::Load,
        }
    }
}
