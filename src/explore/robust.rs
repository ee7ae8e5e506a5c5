//! What a robust setting is to stand, and the search for it.

use serde::{Serialize, Serializer};

use super::best::NotFound;
use crate::answers::best::{BestSettings, Ranges, RobustSetting, robust_setting};
use crate::answers::robust_to_fit::{error_of_fit, robust_to_fit};
use crate::linear::best::SearchedGain;
use crate::linear::margins::Changes;
use crate::model::stop::Stop;
use crate::setting::best_plane::parameter_of;
use crate::setting::{Parameter, Setting};
use crate::text::{Shown, SpecError, to_digits};

/// The largest relative standard errors of a fit: of μ_K, so that gains keep their sign, and of μ′.
const MOST_OF_GAIN: f64 = 0.3;
const MOST_OF_SLOPE: f64 = 3.0;

/// What a robust setting is to stand, as asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// Gain, delay and μ′ are off by this part of them.
    Part(f64),
    /// Friction is off by what its fit leaves open.
    Fit,
}

/// What may be off at a robust setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MayBeOff {
    /// Gain, delay and μ′ by this part of them.
    Part(f64),
    /// Friction by so many standard errors of its fit, as relative changes of gain, delay and μ′.
    Errors(f64, Changes),
}

/// The best settings, and the robust one with what may be off there.
type Found = (BestSettings, Option<RobustSetting>, Option<MayBeOff>);

/// As in the flag.
impl Serialize for Spread {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Part(part) => to.serialize_f64(*part),
            Self::Fit => to.serialize_str(Self::FIT),
        }
    }
}

impl Spread {
    /// The name of [`Spread::Fit`].
    const FIT: &str = "fit";

    /// Reads a part such as 0.05, or the word `fit`.
    ///
    /// # Errors
    /// Says what is expected.
    pub fn read(text: &str) -> Result<Self, String> {
        if text.trim() == Self::FIT {
            return Ok(Self::Fit);
        }
        let spread = text.trim().parse().ok();
        let spread = spread.filter(|s: &f64| (1e-6..=0.9).contains(s));
        let why = "expected a part, from 1e-6 to 0.9, such as 0.05 for 5 %, or fit";
        spread.map(Self::Part).ok_or_else(|| why.to_owned())
    }

    /// The best settings, and the one that stands this.
    pub(super) fn settings(
        self,
        setting: &Setting,
        gain: SearchedGain,
        ranges: &Ranges,
        stop: &Stop,
    ) -> Result<Found, NotFound> {
        match self {
            Self::Part(part) => {
                let (best, robust) = robust_setting(setting, gain, ranges, [part; 3], stop)?;
                Ok((best, robust, Some(MayBeOff::Part(part))))
            }
            Self::Fit => {
                let error = one_error(setting, gain)?;
                let found = robust_to_fit(setting, gain, ranges, error, stop)?;
                let off = MayBeOff::Errors(found.errors, found.spread);
                Ok((found.best, found.robust, Some(off)))
            }
        }
    }
}

/// Why there is no setting that is robust against the errors of a fit.
#[derive(Debug, Clone, PartialEq)]
pub enum NotRobust {
    /// This gain acts beside the one that is searched.
    TwoGains(Parameter),
    /// The friction law was not fitted.
    NotFitted,
    /// The standard error of this number is so large a part of it.
    TooWide(Parameter, f64),
}

impl NotRobust {
    /// The error in words, with advice.
    #[must_use]
    pub fn told(&self) -> SpecError {
        let (message, help) = match self {
            Self::TwoGains(other) => (
                format!(
                    "robust fit is for one gain, and {} is another",
                    other.name()
                ),
                "leave it out, or take robust 0.05",
            ),
            Self::NotFitted => (
                "robust fit: the friction law was not fitted".to_owned(),
                "slipmap fit DATA.csv --v0 V --save fit.toml writes a setting with a fitted law",
            ),
            Self::TooWide(of, part) => {
                let (name, percent) = (of.name(), Shown(to_digits(100.0 * part, 2)));
                (
                    format!("robust fit: the standard error of {name} is {percent} % of it"),
                    "measure more points near v0",
                )
            }
        };
        SpecError::whole(message).help(help)
    }
}

/// One standard error of the fit of the friction law, as relative changes of gain, delay and μ′.
fn one_error(setting: &Setting, gain: SearchedGain) -> Result<Changes, NotFound> {
    let both = |p: &Parameter| setting.get(*p) != 0.0 && *p != parameter_of(gain);
    let gains = [Parameter::AlphaV, Parameter::AlphaN];
    if let Some(other) = gains.into_iter().find(both) {
        return Err(NotFound::Robust(NotRobust::TwoGains(other)));
    }
    let of = error_of_fit(setting, gain)?.ok_or(NotFound::Robust(NotRobust::NotFitted))?;
    let [of_gain, _, of_slope] = of;
    for (parameter, part, most) in [
        (Parameter::MuK, of_gain, MOST_OF_GAIN),
        (Parameter::MuPrime, of_slope, MOST_OF_SLOPE),
    ] {
        if !(0.0..=most).contains(&part) {
            return Err(NotFound::Robust(NotRobust::TooWide(parameter, part)));
        }
    }
    Ok(of)
}
