//! The keys of `[friction.fit]`, which `slipmap fit --save` writes.

use super::fit_errors::{
    BETWEEN_LAWS, CORRELATIONS, COVERAGE_FACTOR, FitErrors, FittedNumber, NORMAL_95, PARAMETERS,
    STANDARD_ERRORS,
};
use super::keys::{Key, key, names, needed};
use super::law_kind::LawKind;
use super::parameter::{LARGEST, Parameter};
use crate::text::toml_reader::{Entry, SpecError};

/// The keys of what a fit says, `fit` of `[friction]`.
pub(crate) const FIT: [Key; 5] = [
    key(
        "parameters",
        "a list of names of parameters of the law",
        "the points of a table",
        "what was fitted",
    ),
    needed(
        "standard_errors",
        "as many numbers of 0 or more",
        "their standard errors",
    ),
    needed(
        "correlations",
        "as many lists, the first one empty, each by a number longer",
        "the correlations of each parameter with those before it, from -1 to 1",
    ),
    key(
        "coverage_factor",
        "a number from 1 to 1000",
        "1.96",
        "within so many standard errors lies the true value in 95 of 100 cases",
    ),
    key(
        "mu_prime_between_laws",
        "a number of 0 or more",
        "0",
        "the standard deviation of mu_prime at v0 by the choice of the law",
    ),
];

/// Reads what a fit says of the law.
pub(super) fn read(fit: &Entry, law: &LawKind) -> Result<FitErrors, SpecError> {
    let mut numbers = match law {
        LawKind::Table(table) => (0..table.speeds().len()).map(FittedNumber::Point).collect(),
        _ => Vec::new(),
    };
    let (mut errors, mut correlations) = (None, None);
    let (mut coverage_factor, mut between_laws) = (NORMAL_95, 0.0);
    for entry in fit.table()? {
        match entry.key {
            PARAMETERS => numbers = parameters(&entry, law)?,
            STANDARD_ERRORS => errors = Some((numbers_of(&entry)?, entry.clone())),
            CORRELATIONS => {
                let rows: Result<_, _> = entry.array()?.iter().map(numbers_of).collect();
                correlations = Some((rows?, entry.clone()));
            }
            COVERAGE_FACTOR => coverage_factor = entry.number_within(1.0..=1e3)?,
            BETWEEN_LAWS => between_laws = entry.number_within(0.0..=LARGEST)?,
            _ => return Err(entry.unknown(&names(&FIT))),
        }
    }
    let missing = |key: &str| SpecError::at(fit.key_span.clone(), format!("{key} is not given"));
    let (errors, of_errors) = errors.ok_or_else(|| missing(STANDARD_ERRORS))?;
    let (rows, of_rows) = correlations.ok_or_else(|| missing(CORRELATIONS))?;
    if numbers.is_empty() {
        return Err(missing(PARAMETERS).help("name those of the law that were fitted"));
    }
    let fitted = FitErrors::new(numbers, errors, rows);
    let fitted = fitted.and_then(|of| of.covering(coverage_factor, between_laws));
    fitted.map_err(|(key, why)| match key {
        CORRELATIONS => of_rows.error(why),
        _ => of_errors.error(why),
    })
}

/// The parameters that were fitted, each one of the law.
fn parameters(entry: &Entry, law: &LawKind) -> Result<Vec<FittedNumber>, SpecError> {
    let all = law.parameters().iter().chain(law.optional());
    let known: Vec<&str> = all.map(|parameter| parameter.name()).collect();
    let names = entry.array()?;
    let parameter = |name: &Entry| {
        let text = name.string()?;
        let found = Parameter::from_name(text).filter(|p| law.has(*p));
        found.map(FittedNumber::Parameter).ok_or_else(|| {
            let message = format!("the {} law has no parameter {text}", law.name());
            name.error(message)
                .help(format!("known: {}", known.join(", ")))
        })
    };
    let parameters: Vec<FittedNumber> = names.iter().map(parameter).collect::<Result<_, _>>()?;
    for (i, name) in names.iter().enumerate() {
        if parameters[..i].contains(&parameters[i]) {
            return Err(name.error("this parameter is there already"));
        }
    }
    Ok(parameters)
}

fn numbers_of(entry: &Entry) -> Result<Vec<f64>, SpecError> {
    entry.array()?.iter().map(Entry::number).collect()
}
