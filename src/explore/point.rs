//! Linear stability of continuous sliding at a point of parameter space.

use serde::Serialize;

use super::finite;
use super::margins::Margins;
use crate::linear::certificate::roots_right_of;
use crate::linear::rightmost::Rightmost;
use crate::linear::stable_delays::StableInterval;
use crate::linear::{Crossings, Direction, MarginalTolerance};
use crate::model::ModelError;
use crate::sweep::{Parameter, Setting};

/// Near a tangency there can be millions of stable intervals; more than this are cut, and the
/// answer says so.
const MOST_INTERVALS: usize = 100_000;

/// What there is to know of a point, in the units of its setting.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Point {
    /// μ_K′(v0).
    pub mu_prime: f64,
    /// μ_K(v0).
    pub mu_k: f64,
    /// α_v.
    pub alpha_v: f64,
    /// α_N.
    pub alpha_n: f64,
    /// τ.
    pub tau: f64,
    /// The number of characteristic roots with positive real part.
    pub n_unstable: u64,
    /// Whether sliding is stable.
    pub stable: bool,
    /// Whether that is within rounding of a boundary.
    pub marginal: bool,
    /// All intervals of delays in which sliding is stable, by shortest delay; the end of the last
    /// one is null where it has none.
    pub stable_delays: Vec<[Option<f64>; 2]>,
    /// Some are left out.
    pub stable_delays_truncated: bool,
    /// The distance in τ to the nearest change of stability, positive where stable; null where it
    /// never changes.
    pub delay_margin: Option<f64>,
    /// The sign of that distance, also of an infinite one: 1 where stable, −1 where unstable, 0 on
    /// a boundary.
    pub delay_margin_sign: i8,
    /// Where roots cross the imaginary axis as the delay grows.
    pub crossings: Vec<PointCrossing>,
    /// The rightmost roots.
    #[serde(flatten)]
    pub spectrum: Spectrum,
    /// How far it is from the boundary of stability.
    #[serde(flatten)]
    pub margins: Margins,
}

/// A crossing frequency, with its delays `first_delay` + 2πk/ω.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct PointCrossing {
    /// ω.
    pub omega: f64,
    /// The shortest delay.
    pub first_delay: f64,
    /// Where the pair goes as the delay grows: `left`, `right` or `touch`.
    pub direction: &'static str,
}

/// The rightmost roots in physical units; none where nothing converged.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Spectrum {
    /// The spectral abscissa; null where no root converged.
    pub abscissa: Option<f64>,
    /// |Im λ| of the rightmost root; null where no root converged.
    pub frequency: Option<f64>,
    /// Re λ and Im λ ≥ 0, by falling real part.
    pub roots: Vec<[f64; 2]>,
    /// Whether the argument principle confirms that none is missing.
    pub certified: bool,
    /// No root is farther right than abscissa + this times max(1/√(M/κ), |abscissa|); null where no
    /// root converged.
    pub certificate_margin: Option<f64>,
    /// Re λ of a vertical line, right of the rightmost root, that the argument principle finds no
    /// root right of; null where it does not tell.
    pub certified_line: Option<f64>,
    /// Why there are fewer roots than asked for.
    #[serde(skip)]
    pub fewer: Option<String>,
    /// Some were not found that are there.
    #[serde(skip)]
    pub incomplete: bool,
}

impl Spectrum {
    fn at(setting: &Setting, wanted: u8) -> Result<Self, ModelError> {
        let (groups, time_unit) = setting.groups()?;
        let tau = setting.get(Parameter::Tau) / time_unit;
        let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
        let found = Rightmost::at(groups, tau, wanted.into(), count);
        let incomplete = found.missing.is_some();
        let line = found.roots.first().map(|root| {
            let re = root.lambda.re;
            re + found.margin * re.abs().max(1.0)
        });
        let certified_line = line.filter(|line| roots_right_of(groups, tau, *line) == Some(0));
        let roots: Vec<[f64; 2]> = found
            .roots
            .iter()
            .map(|root| [root.lambda.re / time_unit, root.lambda.im / time_unit])
            .collect();
        let fewer = match found.missing {
            Some(missing) => Some(missing.to_string()),
            None if tau == 0.0 => Some("there are no others: the delay is 0".into()),
            None if groups.uncontrolled() => Some("there are no others without control".into()),
            None => Some("no others can be told from -infinity".into()),
        };
        Ok(Self {
            abscissa: roots.first().map(|root| root[0]),
            frequency: roots.first().map(|root| root[1]),
            fewer: fewer.filter(|_| roots.len() < wanted.into()),
            roots,
            certified: found.certified,
            certificate_margin: finite(found.margin),
            certified_line: certified_line.map(|line| line / time_unit),
            incomplete,
        })
    }
}

impl Point {
    /// At a setting with all its parameters, with the `wanted` rightmost roots, 1 to 64.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn at(setting: &Setting, wanted: u8) -> Result<Self, ModelError> {
        let sliding = setting.sliding_point()?;
        let (groups, time_unit) = setting.groups()?;
        let crossings = Crossings::of(groups).in_physical_time(time_unit);
        let tau = setting.get(Parameter::Tau);
        let count = crossings.count(tau, MarginalTolerance::default());
        let mut intervals = crossings.stable_delays();
        let stable: Vec<StableInterval> = intervals.by_ref().take(MOST_INTERVALS).collect();
        let delay_margin = crossings.delay_margin(tau);
        Ok(Self {
            mu_prime: sliding.mu_prime,
            mu_k: sliding.mu_k,
            alpha_v: setting.get(Parameter::AlphaV),
            alpha_n: setting.get(Parameter::AlphaN),
            tau,
            n_unstable: count.n_unstable,
            stable: count.stable(),
            marginal: count.marginal,
            stable_delays: stable
                .iter()
                .map(|s| [Some(s.from), finite(s.to)])
                .collect(),
            stable_delays_truncated: intervals.next().is_some(),
            delay_margin: finite(delay_margin),
            delay_margin_sign: match delay_margin {
                0.0 => 0,
                margin => margin.signum() as i8,
            },
            crossings: crossings
                .iter()
                .map(|c| PointCrossing {
                    omega: c.omega,
                    first_delay: c.delay(c.first_branch),
                    direction: match c.direction {
                        Direction::Left => "left",
                        Direction::Right => "right",
                        Direction::Touch => "touch",
                    },
                })
                .collect(),
            spectrum: Spectrum::at(setting, wanted)?,
            margins: Margins::at(setting, 0.0)?,
        })
    }
}
