//! A sweep of the limit of a short delay: γ, μ_K/μ_S and its own fields.

use std::ops::Range;

use super::given::GivenParameters;
use super::given_error::GivenError;
use super::needs::no_meaning;
use super::parameter::Parameter;
use super::values::Setting;
use crate::text::toml_reader::SpecError;

/// Keys at the top of a sweep file that are allowed in the limit.
pub(super) const KEYS: [&str; 6] = ["title", "picture", "protocol", "fields", "axes", "fixed"];

/// The parameters of a sweep of the limit that are no axes. A missing one is reported at `axes`.
pub(super) fn check(
    given: &GivenParameters,
    axes: Option<&Range<usize>>,
) -> Result<Setting, SpecError> {
    let mut parameters = given.places();
    if let Some((parameter, place)) = parameters.find(|(parameter, _)| !parameter.of_limit()) {
        return Err(given.unmet(no_meaning(parameter.name()), Some(place)));
    }
    for parameter in Parameter::ALL.into_iter().filter(|p| p.of_limit()) {
        if given.place(parameter).is_none() && parameter.default_value().is_none() {
            let error = GivenError::Missing(parameter);
            return Err(SpecError {
                message: error.message(None, Parameter::key),
                span: axes.cloned(),
                help: Some(error.help(Parameter::key)),
            });
        }
    }
    let mut setting = given.setting();
    setting.set(Parameter::Tau, 0.0);
    Ok(setting)
}
