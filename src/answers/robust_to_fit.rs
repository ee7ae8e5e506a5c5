//! The setting that is most robust against what the errors of a fitted friction law leave open.

use super::best::{BestSettings, Ranges};
use super::robust::{RobustSearch, RobustSetting};
use crate::linear::best::SearchedGain;
use crate::linear::margins::Changes;
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::setting::fit_errors::FitErrors;
use crate::setting::no_answer::NoAnswer;
use crate::setting::{Parameter, Setting};

/// How many standard errors of a fit friction may be off at a robust setting, if any setting stands
/// that: beyond lie 3 of 1000 values.
pub const MOST_ERRORS: f64 = 3.0;
/// How many times the number of errors is halved where no setting stands so many.
const HALVINGS: u32 = 7;

/// A search for the setting that is most robust against the errors of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct RobustToFit {
    /// How many standard errors friction may be off there.
    pub errors: f64,
    /// The largest relative changes of gain, delay and μ′ that these are.
    pub spread: Changes,
    /// The best settings, whatever the errors.
    pub best: BestSettings,
    /// The robust setting; none where no setting stays stable.
    pub robust: Option<RobustSetting>,
}

/// The relative changes of gain, delay and μ′ by which friction may be off after a fit: one
/// standard error, as much wider as draws are after few points. None where the law was not fitted.
/// Where the load is controlled, μ_K is part of the gain. Delays are as they are.
///
/// # Errors
/// When the law is ill-posed.
pub fn error_of_fit(setting: &Setting, gain: SearchedGain) -> Result<Option<Changes>, ModelError> {
    let Some(of) = setting.fitted_sliding()? else {
        return Ok(None);
    };
    let wider = setting.fit_errors().map_or(1.0, FitErrors::wider);
    let load = gain == SearchedGain::Load || setting.get(Parameter::AlphaN) != 0.0;
    let of_gain = match load {
        true => of.mu_k_error / of.at.mu_k,
        false => 0.0,
    };
    let of_slope = of.mu_prime_error / of.at.mu_prime.abs();
    Ok(Some([wider * of_gain, 0.0, wider * of_slope]))
}

/// The setting within `ranges` that decays fastest when friction is off by [`MOST_ERRORS`] standard
/// errors of its fit, of which `error` is one; where no setting stands that, by as many as some
/// setting stands. Once `stop` is set, the answer comes soon but is meaningless.
///
/// # Errors
/// As [`super::robust::robust_setting`].
pub fn robust_to_fit(
    setting: &Setting,
    gain: SearchedGain,
    ranges: &Ranges,
    error: Changes,
    stop: &Stop,
) -> Result<RobustToFit, NoAnswer> {
    let search = RobustSearch::of(setting, gain, ranges, stop)?;
    let with = |errors: f64| {
        let spread = error.map(|part| errors * part);
        RobustToFit {
            errors,
            spread,
            best: search.best(),
            robust: search.standing(spread, stop),
        }
    };
    let mut found = with(MOST_ERRORS);
    if found.robust.is_some() {
        return Ok(found);
    }
    let (mut stands, mut not) = (0.0, MOST_ERRORS);
    for _ in 0..HALVINGS {
        let next = with(0.5 * (stands + not));
        match next.robust {
            Some(_) => {
                stands = next.errors;
                found = next;
            }
            None => not = next.errors,
        }
    }
    Ok(found)
}
