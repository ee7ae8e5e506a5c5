//! What a robust setting is to stand, `--robust`, and the search for it.

use serde::{Serialize, Serializer};

use crate::answers::best::{BestSettings, Ranges, RobustSetting, robust_setting};
use crate::answers::robust_to_fit::{error_of_fit, robust_to_fit};
use crate::linear::best::SearchedGain;
use crate::linear::margins::Changes;
use crate::model::stop::Stop;
use crate::report::numbers::rounded;
use crate::setting::best_plane::parameter_of;
use crate::setting::no_answer::NoAnswer;
use crate::setting::{Parameter, Setting};

use super::failure::Failure;
use super::say;

/// The largest relative standard errors of a fit: of μ_K, so that gains keep their sign, and of μ′.
const MOST_OF_GAIN: f64 = 0.3;
const MOST_OF_SLOPE: f64 = 3.0;

/// A setting that stands fewer standard errors than this is warned of.
const FEW_ERRORS: f64 = 2.0;

/// What a robust setting is to stand, as asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Spread {
    /// Gain, delay and μ′ are off by this part of them.
    Part(f64),
    /// Friction is off by what its fit leaves open.
    Fit,
}

/// What may be off at a robust setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum MayBeOff {
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

    /// Reads the value of the flag.
    pub(super) fn read(text: &str) -> Result<Self, String> {
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
    ) -> Result<Found, Failure> {
        match self {
            Self::Part(part) => {
                let (best, robust) = robust_setting(setting, gain, ranges, [part; 3], stop)?;
                Ok((best, robust, Some(MayBeOff::Part(part))))
            }
            Self::Fit => {
                let error = one_error(setting, gain)?;
                let found = robust_to_fit(setting, gain, ranges, error, stop)?;
                if found.robust.is_some() && found.errors < FEW_ERRORS {
                    say::remark(format_args!(
                        "warning: no setting stands more than {} standard errors of the fit: \
                         measure more points near v0, or try the other --control",
                        rounded(found.errors, 2)
                    ));
                }
                let off = MayBeOff::Errors(found.errors, found.spread);
                Ok((found.best, found.robust, Some(off)))
            }
        }
    }
}

/// One standard error of the fit of the friction law, as relative changes of gain, delay and μ′.
fn one_error(setting: &Setting, gain: SearchedGain) -> Result<Changes, Failure> {
    let both = |p: Parameter| setting.get(p) != 0.0 && p != parameter_of(gain);
    if let Some(other) = [Parameter::AlphaV, Parameter::AlphaN]
        .into_iter()
        .find(|p| both(*p))
    {
        let message = format!(
            "--robust fit is for one gain, and {} is another",
            other.name()
        );
        return Err(Failure::bad_input_with_help(
            message,
            "leave it out, or --robust 0.05",
        ));
    }
    let of = error_of_fit(setting, gain).map_err(NoAnswer::from)?;
    let of = of.ok_or_else(|| {
        Failure::bad_input_with_help(
            "--robust fit: the friction law was not fitted",
            "slipmap fit DATA.csv --v0 V --save fit.toml, then --setting fit.toml",
        )
    })?;
    let [of_gain, _, of_slope] = of;
    for (name, part, most) in [
        ("mu_k", of_gain, MOST_OF_GAIN),
        ("mu_prime", of_slope, MOST_OF_SLOPE),
    ] {
        if !(0.0..=most).contains(&part) {
            let percent = rounded(100.0 * part, 2);
            return Err(Failure::failed_with_help(
                format!("--robust fit: the standard error of {name} is {percent} % of it"),
                "measure more points near v0",
            ));
        }
    }
    Ok(of)
}
