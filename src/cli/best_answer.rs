//! What `slipmap best` prints with `--json`.

use serde::Serialize;
use slipmap::explore::margins::Margins;
use slipmap::explore::vc::CriticalVelocity;
use slipmap::linear::best::Optimum;
use slipmap::sweep::cells::best::{BestRegion, Ranges, RobustSetting};
use slipmap::sweep::relaxation_time;
use utoipa::ToSchema;

use super::failure::Failure;
use super::recommended::{Control, Recommended};

/// The JSON of a search. Infinite numbers are written as null.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct BestAnswer {
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
    #[schema(required)]
    robust: Option<RobustOut>,
    /// How far the recommended setting, the robust one where there is one, is from the boundary of
    /// stability.
    margins: Margins,
    /// The critical velocity of the recommended setting; null without a friction law.
    #[schema(required)]
    vc: Option<CriticalVelocity>,
}

/// A robust setting.
#[derive(Debug, Serialize, ToSchema)]
struct RobustOut {
    /// The relative spread of gain, delay and μ′.
    spread: f64,
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

impl From<&RobustSetting> for RobustOut {
    fn from(of: &RobustSetting) -> Self {
        let found = &of.robust;
        Self {
            spread: of.spread,
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

#[derive(Debug, Serialize, ToSchema)]
struct RangesOut {
    #[schema(value_type = [f64; 2])]
    alpha: (f64, f64),
    #[schema(value_type = [f64; 2])]
    tau: (f64, f64),
}

#[derive(Debug, Serialize, ToSchema)]
struct RegionOut {
    region: RangesOut,
    #[serde(flatten)]
    best: OptimumOut,
}

#[derive(Debug, Serialize, ToSchema)]
struct OptimumOut {
    alpha: f64,
    #[serde(flatten)]
    numbers: OptimumNumbers,
}

/// What is told of a best setting besides the value of what is searched.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct OptimumNumbers {
    tau: f64,
    abscissa: f64,
    frequency: f64,
    frequencies: Vec<f64>,
    /// −1/abscissa; null where the setting is not stable.
    #[schema(required)]
    relaxation_time: Option<f64>,
    kind: &'static str,
    certified: bool,
    margin: f64,
}

impl From<&Ranges> for RangesOut {
    fn from(ranges: &Ranges) -> Self {
        Self {
            alpha: ranges.gain,
            tau: ranges.tau,
        }
    }
}

impl From<&Optimum> for OptimumOut {
    fn from(found: &Optimum) -> Self {
        Self {
            alpha: found.gain,
            numbers: found.into(),
        }
    }
}

impl From<&Optimum> for OptimumNumbers {
    fn from(found: &Optimum) -> Self {
        Self {
            tau: found.tau,
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

impl BestAnswer {
    /// The answer for what was found.
    ///
    /// # Errors
    /// When a parameter of the setting is outside the model's range.
    pub(super) fn of(told: &Recommended) -> Result<Self, Failure> {
        let sliding = told.setting.sliding_point()?;
        let region = |region: &BestRegion| RegionOut {
            region: (&region.ranges).into(),
            best: (&region.best).into(),
        };
        let found = &told.found;
        Ok(Self {
            mu_prime: sliding.mu_prime,
            mu_k: sliding.mu_k,
            control: told.control,
            searched: (&told.ranges).into(),
            best: (&found.overall).into(),
            regions: found.regions.iter().map(region).collect(),
            regions_left_out: found.regions_left_out,
            robust: told.robust.as_ref().map(Into::into),
            margins: told.margins.clone(),
            vc: told.vc.clone(),
        })
    }
}
