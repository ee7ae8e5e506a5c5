//! The settings of fastest decay, with all about the one that is recommended.

use serde::Serialize;

use super::point::Point;
use super::problem::{Problem, Why};
use super::robust::{MayBeOff, NotRobust, Spread};
use super::stability::Wanted;
use super::vc::CriticalVelocity;
use crate::answers::best::{BestSettings, Ranges, RobustSetting, best_settings};
use crate::answers::best_delay::best_over_delays;
use crate::answers::search_plane::SearchPlane;
use crate::linear::best::SearchedGain;
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::setting::axis::Axis;
use crate::setting::best_plane::searched_gain;
use crate::setting::no_answer::NoAnswer;
use crate::setting::quantity::Quantity;
use crate::setting::search::Protocol;
use crate::setting::simulation::NOT_IN_MOTIONS;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting, SweepSpec};
use crate::text::SpecError;

/// How many roots of the best setting of a system are told. The margins of the block need one.
const ROOTS: u8 = 4;

/// Controls by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub enum Control {
    /// α_v: the pulling velocity follows the delayed elongation
    Velocity,
    /// α_N: the normal load does
    Load,
}

impl Control {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Velocity, Self::Load];

    /// Its gain.
    #[must_use]
    pub const fn parameter(self) -> Parameter {
        match self {
            Self::Velocity => Parameter::AlphaV,
            Self::Load => Parameter::AlphaN,
        }
    }

    /// The control whose gain is searched.
    #[must_use]
    pub fn of(searched: &Quantity) -> Self {
        match *searched == Parameter::AlphaN {
            true => Self::Load,
            false => Self::Velocity,
        }
    }
}

/// What is searched, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Searched {
    /// Everything but what is searched, whose values do not matter.
    pub setting: Setting,
    /// Its units.
    pub units: Units,
    /// What is searched.
    pub of: SearchPlane,
    /// The ranges of the search.
    pub ranges: Ranges,
    /// The delays that are searched too, where the delay is none of the plane.
    pub delays: Option<(f64, f64)>,
    /// What the recommended setting is to stand.
    pub robust: Option<Spread>,
}

/// The part of them by which gain, delay and μ′ may be off at the robust setting of a plane.
const OFF: f64 = 0.05;

impl Searched {
    /// The search in the plane of a sweep of two axes, one of them the delay: within their ends,
    /// with the robust setting of the block.
    ///
    /// # Errors
    /// When the axes are others, or nothing is searched along one of them.
    pub fn in_plane(spec: &SweepSpec) -> Result<Self, Problem> {
        let is_tau = |axis: &Axis| axis.parameter == Parameter::Tau;
        let (tau, other) = match &*spec.axes {
            [other, tau] if is_tau(tau) => (tau, other),
            [tau, other] if is_tau(tau) => (tau, other),
            _ => {
                return Err(no_plane(
                    "the best setting is searched over a gain and the delay",
                ));
            }
        };
        let of = other.parameter.clone();
        let of_block = spec.fixed.system().is_none();
        if of_block && of.known().and_then(searched_gain).is_none() {
            let (name, gains) = (of.name(), "alpha_v or alpha_n");
            return Err(no_plane(&format!(
                "{name} is not searched, but {gains} and tau"
            )));
        }
        // Friction with a state and digital loops have best settings, but no robust ones.
        let is_read = spec.fixed.get(Parameter::SampleTime) > 0.0;
        let robust = of_block && !is_read && spec.fixed.rate_and_state().is_none();
        Ok(Self {
            setting: spec.fixed.clone(),
            units: spec.units.clone(),
            ranges: Ranges {
                p: other.range(),
                q: tau.range(),
            },
            of: SearchPlane::with_delay(of),
            delays: None,
            robust: robust.then_some(Spread::Part(OFF)),
        })
    }
}

fn no_plane(why: &str) -> Problem {
    Problem::new(Why::Unprocessable, why)
}

/// The best settings, with all about the recommended one.
#[derive(Debug, Clone)]
pub struct Recommended {
    /// The recommended setting: the robust one, if there is one.
    pub setting: Setting,
    /// Its units.
    pub units: Units,
    /// What was searched.
    pub searched: SearchPlane,
    /// The ranges of the search.
    pub ranges: Ranges,
    /// The delays that were searched too, where the delay is none of the plane.
    pub delays: Option<(f64, f64)>,
    /// What may be off at the robust setting, if one is requested.
    pub may_be_off: Option<MayBeOff>,
    /// The best settings.
    pub found: BestSettings,
    /// None if it is not requested, or no setting stays stable.
    pub robust: Option<RobustSetting>,
    /// The recommended setting, with its margins.
    pub point: Point,
    /// v_c, if there is a friction law.
    pub vc: Option<CriticalVelocity>,
}

/// Why there is no best setting.
#[derive(Debug, Clone, PartialEq)]
pub enum NotFound {
    /// The model has no answer.
    NoAnswer(NoAnswer),
    /// What is asked of a robust setting cannot be had.
    Robust(NotRobust),
}

impl From<NoAnswer> for NotFound {
    fn from(why: NoAnswer) -> Self {
        Self::NoAnswer(why)
    }
}

impl From<ModelError> for NotFound {
    fn from(error: ModelError) -> Self {
        Self::NoAnswer(error.into())
    }
}

impl From<NotFound> for Problem {
    fn from(why: NotFound) -> Self {
        match why {
            NotFound::NoAnswer(why) => why.into(),
            NotFound::Robust(why) => {
                let SpecError { message, help, .. } = why.told();
                Self {
                    help,
                    ..Self::new(Why::Unprocessable, message)
                }
            }
        }
    }
}

impl Recommended {
    /// What a search finds. Once `stop` is set, the answer comes soon but is meaningless.
    ///
    /// # Errors
    /// When a parameter is outside the model's range, nothing is known of such a model, or
    /// robustness is asked for against what is not known.
    pub fn of(asked: Searched, stop: &Stop) -> Result<Self, NotFound> {
        let Searched {
            mut setting,
            units,
            of: searched,
            ranges,
            delays,
            robust,
        } = asked;
        let mut over_delays = None;
        let (found, robust, may_be_off) = match (robust, delays) {
            (None, None) => {
                let found = best_settings(&setting, &searched, &ranges, stop)?;
                (found, None, None)
            }
            (None, Some(delays)) => {
                let found = best_over_delays(&setting, &searched, &ranges, delays, stop)?;
                over_delays = Some(found.0);
                (found.1, None, None)
            }
            (Some(spread), _) => {
                let gain = searched.p.known().and_then(searched_gain);
                let gain = gain.unwrap_or(SearchedGain::Velocity);
                spread.settings(&setting, gain, &ranges, stop)?
            }
        };
        let (p, q) = match &robust {
            Some(of) => (of.robust.gain, of.robust.tau),
            None => (found.overall.p, found.overall.q),
        };
        if let Some(tau) = over_delays {
            setting.set(Parameter::Tau, tau);
        }
        setting.vary(&searched.p, p);
        setting.vary(&searched.q, q);
        let moves = setting.law().is_some() && setting.check_of_letter(NOT_IN_MOTIONS, "").is_ok();
        let vc = moves.then(|| CriticalVelocity::of(&setting, Protocol::Follow, stop));
        let vc = vc.transpose()?;
        let wanted = Wanted {
            roots: if setting.system().is_some() { ROOTS } else { 1 },
            line: None,
        };
        Ok(Self {
            point: Point::at(&setting, wanted, stop)?,
            setting,
            units,
            searched,
            ranges,
            delays,
            may_be_off,
            found,
            robust,
            vc,
        })
    }
}
