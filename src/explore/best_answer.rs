//! The best settings as plain data.

use serde::Serialize;

use super::best::{Control, Recommended};
use super::margins::Margins;
use super::point::{Point, SystemPoint};
use super::robust::MayBeOff;
use super::vc::CriticalVelocity;
use crate::answers::best::{BestRegion, Ranges, RobustSetting};
use crate::linear::best::Optimum;
use crate::setting::Parameter;
use crate::sweep::relaxation_time;

/// What a search found.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub enum BestSetting {
    /// Of the block on its spring.
    Block(Box<BestAnswer>),
    /// Of a system from a file.
    System(Box<SystemBest>),
}

/// What a search in a plane found.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct BestInPlane {
    #[serde(flatten)]
    #[cfg_attr(feature = "serve", schema(value_type = BestAnswer))]
    found: BestSetting,
    /// Where is searched if nobody says where.
    usual: UsualRanges,
}

impl BestInPlane {
    /// The answer for what was found in a plane of which these ranges are the usual ones.
    #[must_use]
    pub fn of(told: &Recommended, usual: Ranges) -> Self {
        let Ranges { p, q } = usual;
        Self {
            found: BestSetting::of(told),
            usual: UsualRanges {
                gain: p.into(),
                tau: q.into(),
            },
        }
    }
}

/// The ranges of a search where none are given.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct UsualRanges {
    /// Of the gain or, of a system, of what is searched beside the delay.
    gain: [f64; 2],
    tau: [f64; 2],
}

/// What a search of the block found. Infinite numbers are written as null.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct BestAnswer {
    mu_prime: f64,
    mu_k: f64,
    control: Control,
    searched: RangesOut,
    best: OptimumOut,
    regions: Vec<RegionOut>,
    /// Regions that are not among these: not searched, or with decay within rounding.
    regions_left_out: usize,
    /// The setting whose slowest decay is fastest within a spread; null where none is asked for,
    /// and where no setting stays stable.
    #[cfg_attr(feature = "serve", schema(required))]
    robust: Option<RobustOut>,
    /// How far the recommended setting, the robust one where there is one, is from the boundary of
    /// stability.
    margins: Margins,
    /// The critical velocity of the recommended setting; null without a friction law.
    #[cfg_attr(feature = "serve", schema(required))]
    vc: Option<CriticalVelocity>,
}

/// What a search of a system from a file.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct SystemBest {
    /// The first parameter that is searched.
    search: String,
    /// The second one; null where that is the delay.
    #[cfg_attr(feature = "serve", schema(required))]
    second: Option<String>,
    searched: SystemRanges,
    best: SystemOptimum,
    regions: Vec<SystemRegion>,
    /// Regions that are not among these: not searched, or with decay within rounding.
    regions_left_out: usize,
    /// All about the best setting.
    point: SystemPoint,
}

/// A robust setting.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct RobustOut {
    /// The largest of `spreads`.
    spread: f64,
    /// The relative spreads of gain, delay and μ′.
    spreads: [f64; 3],
    /// How many standard errors of the fit of the friction law these are; null where it is not by a
    /// fit that they were asked for.
    #[cfg_attr(feature = "serve", schema(required))]
    standard_errors: Option<f64>,
    alpha: f64,
    tau: f64,
    /// The spectral abscissa of the setting itself.
    abscissa: f64,
    /// The largest spectral abscissa within the spread.
    worst_abscissa: f64,
    /// The relaxation time where the spectral abscissa is largest within the spread.
    worst_relaxation_time: f64,
    /// The relative changes of gain, delay and μ′ at which the decay is slowest.
    worst_at: [f64; 3],
    /// Whether it is proved that no spectral abscissa within the spread is larger.
    certified: bool,
    /// The largest spectral abscissa within the same spread around the best setting.
    worst_abscissa_of_best: f64,
}

impl RobustOut {
    fn of(of: &RobustSetting, may_be_off: Option<MayBeOff>) -> Self {
        let found = &of.robust;
        Self {
            spread: of.spread.into_iter().fold(0.0, f64::max),
            spreads: of.spread,
            standard_errors: match may_be_off {
                Some(MayBeOff::Errors(errors, _)) => Some(errors),
                _ => None,
            },
            alpha: found.gain,
            tau: found.tau,
            abscissa: found.abscissa,
            worst_abscissa: found.worst_abscissa,
            worst_relaxation_time: relaxation_time(found.worst_abscissa),
            worst_at: found.worst_at,
            certified: found.certified,
            worst_abscissa_of_best: of.worst_of_best.0,
        }
    }
}

/// Ranges of a gain of the block and of the delay.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct RangesOut {
    #[cfg_attr(feature = "serve", schema(value_type = [f64; 2]))]
    alpha: (f64, f64),
    #[cfg_attr(feature = "serve", schema(value_type = [f64; 2]))]
    tau: (f64, f64),
}

impl From<&Ranges> for RangesOut {
    fn from(ranges: &Ranges) -> Self {
        Self {
            alpha: ranges.p,
            tau: ranges.q,
        }
    }
}

/// A stable region of the block, with its best setting.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct RegionOut {
    region: RangesOut,
    #[serde(flatten)]
    best: OptimumOut,
}

impl From<&BestRegion> for RegionOut {
    fn from(region: &BestRegion) -> Self {
        Self {
            region: (&region.ranges).into(),
            best: (&region.best).into(),
        }
    }
}

/// A best setting of the block.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct OptimumOut {
    alpha: f64,
    tau: f64,
    #[serde(flatten)]
    numbers: OptimumNumbers,
}

impl From<&Optimum> for OptimumOut {
    fn from(found: &Optimum) -> Self {
        Self {
            alpha: found.p,
            tau: found.q,
            numbers: found.into(),
        }
    }
}

/// Ranges of the parameters of a system.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct SystemRanges {
    /// Of the first parameter.
    #[cfg_attr(feature = "serve", schema(value_type = [f64; 2]))]
    value: (f64, f64),
    /// Of the second one; null where that is the delay.
    #[cfg_attr(feature = "serve", schema(value_type = Option<[f64; 2]>, required))]
    second: Option<(f64, f64)>,
    /// Of the delay; both ends are the same where it is not searched.
    #[cfg_attr(feature = "serve", schema(value_type = [f64; 2]))]
    tau: (f64, f64),
}

/// A stable region of a system, with its best setting.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct SystemRegion {
    region: SystemRanges,
    #[serde(flatten)]
    best: SystemOptimum,
}

/// A best setting of a system.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct SystemOptimum {
    /// Of the first parameter.
    value: f64,
    /// Of the second one; null where that is the delay.
    #[cfg_attr(feature = "serve", schema(required))]
    second: Option<f64>,
    tau: f64,
    #[serde(flatten)]
    numbers: OptimumNumbers,
}

impl SystemBest {
    fn of(told: &Recommended, point: &SystemPoint) -> Self {
        let (of, found) = (&told.searched, &told.found);
        let tau = told.setting.get(Parameter::Tau);
        let ranges = |of_them: &Ranges, delays: (f64, f64)| match of.has_delay() {
            true => SystemRanges {
                value: of_them.p,
                second: None,
                tau: of_them.q,
            },
            false => SystemRanges {
                value: of_them.p,
                second: Some(of_them.q),
                tau: delays,
            },
        };
        let optimum = |best: &Optimum| SystemOptimum {
            value: best.p,
            second: of.second().map(|_| best.q),
            tau: if of.has_delay() { best.q } else { tau },
            numbers: best.into(),
        };
        let region = |region: &BestRegion| SystemRegion {
            region: ranges(&region.ranges, (tau, tau)),
            best: optimum(&region.best),
        };
        Self {
            search: of.p.name().to_owned(),
            second: of.second().map(|second| second.name().to_owned()),
            searched: ranges(&told.ranges, told.delays.unwrap_or((tau, tau))),
            best: optimum(&found.overall),
            regions: found.regions.iter().map(region).collect(),
            regions_left_out: found.regions_left_out,
            point: point.clone(),
        }
    }
}

/// What is told of a best setting besides the values of what is searched.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct OptimumNumbers {
    abscissa: f64,
    frequency: f64,
    frequencies: Vec<f64>,
    /// −1/abscissa; null where the setting is not stable.
    #[cfg_attr(feature = "serve", schema(required))]
    relaxation_time: Option<f64>,
    kind: &'static str,
    certified: bool,
    margin: f64,
}

impl From<&Optimum> for OptimumNumbers {
    fn from(found: &Optimum) -> Self {
        Self {
            abscissa: found.abscissa,
            frequency: found.frequency(),
            frequencies: found.frequencies.clone(),
            relaxation_time: found.relaxation_time(),
            kind: found.kind.name(),
            certified: found.certified,
            margin: found.margin,
        }
    }
}

impl BestSetting {
    /// The answer for what was found.
    #[must_use]
    pub fn of(told: &Recommended) -> Self {
        let found = &told.found;
        match &told.point {
            Point::Block(point) => Self::Block(Box::new(BestAnswer {
                mu_prime: point.mu_prime,
                mu_k: point.mu_k,
                control: Control::of(&told.searched.p),
                searched: (&told.ranges).into(),
                best: (&found.overall).into(),
                regions: found.regions.iter().map(Into::into).collect(),
                regions_left_out: found.regions_left_out,
                robust: told
                    .robust
                    .as_ref()
                    .map(|of| RobustOut::of(of, told.may_be_off)),
                margins: point.margins.clone(),
                vc: told.vc.clone(),
            })),
            Point::System(point) => Self::System(Box::new(SystemBest::of(told, point))),
        }
    }
}
