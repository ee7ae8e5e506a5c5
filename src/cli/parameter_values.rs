//! The numbers that flags give, with their units, and the values of parameters.

use crate::setting::Parameter;
use crate::setting::amount::Amount;
use crate::setting::parameter::Group;
use crate::setting::quantity::Quantity;
use crate::setting::units::Units;
use crate::text::SpecError;
use clap::error::ErrorKind;
use clap::{Arg, ArgMatches};

use super::failure::Failure;

/// The values that flags give to parameters; each parameter has a flag in its row.
#[derive(Debug, Clone)]
pub(super) struct Values(Box<[Option<f64>; Parameter::ALL.len()]>);

impl Values {
    /// The flags of the parameters in `wanted` groups.
    pub(super) fn flags(wanted: impl Fn(Group) -> bool) -> impl Iterator<Item = Arg> {
        let wanted = Parameter::ALL
            .into_iter()
            .filter(move |p| wanted(p.group()));
        wanted.filter_map(|parameter| {
            let flag = parameter.flag()?;
            let arg = Arg::new(parameter.name())
                .long(parameter.long_flag()?)
                .value_name(flag.value)
                .help(flag.help)
                .allow_hyphen_values(true);
            Some(match parameter {
                // The number of a coefficient, or the expression of a formula.
                Parameter::MuK => arg,
                _ => arg.value_parser(amount_of(parameter)),
            })
        })
    }

    /// The values in `units`.
    pub(super) fn of(
        matches: &ArgMatches,
        wanted: impl Fn(Group) -> bool,
        units: &Units,
    ) -> Result<Self, clap::Error> {
        Self::those(matches, |parameter| wanted(parameter.group()), units)
    }

    /// The values of the `wanted` parameters in `units`.
    pub(super) fn those(
        matches: &ArgMatches,
        wanted: impl Fn(Parameter) -> bool,
        units: &Units,
    ) -> Result<Self, clap::Error> {
        let mut values = Self(Box::new([None; Parameter::ALL.len()]));
        for (parameter, amount) in amounts(matches, wanted) {
            let flag = parameter.name().replace('_', "-");
            let value = amount.value(units).map_err(|error| {
                let text = format!("--{flag} {amount}: {}\n", on_one_line(&error));
                clap::Error::raw(ErrorKind::ValueValidation, text)
            })?;
            values.0[parameter as usize] = Some(value);
        }
        Ok(values)
    }

    /// The text of the flag of [`Parameter::MuK`].
    pub(super) fn text(matches: &ArgMatches) -> Option<&String> {
        matches.get_one::<String>(Parameter::MuK.name())
    }

    /// Leaves the value of a parameter aside.
    pub(super) fn forget(&mut self, parameter: Parameter) {
        self.0[parameter as usize] = None;
    }

    pub(super) fn get(&self, parameter: Parameter) -> Option<f64> {
        self.0[parameter as usize]
    }
}

/// The numbers of the flags of the `wanted` parameters.
pub(super) fn amounts(
    matches: &ArgMatches,
    wanted: impl Fn(Parameter) -> bool,
) -> impl Iterator<Item = (Parameter, Amount)> {
    let asked = Parameter::ALL
        .into_iter()
        .filter(move |p| wanted(*p) && p.flag().is_some());
    asked.filter_map(|p| {
        let amount = match p {
            // What is no number is the expression of a formula.
            Parameter::MuK => parse_amount(Values::text(matches)?).ok(),
            _ => matches.get_one::<Amount>(p.name()).cloned(),
        };
        Some((p, amount?))
    })
}

/// A reader of the number of a flag with the unit of a parameter; the range is checked later.
pub(super) fn amount_of(
    parameter: Parameter,
) -> impl Fn(&str) -> Result<Amount, String> + Clone + Send + Sync + 'static {
    move |text| {
        let amount = parse_amount(text)?;
        let checked = amount.check(parameter.dimension());
        checked
            .map(|()| amount)
            .map_err(|error| on_one_line(&error))
    }
}

/// Reads the number of a flag, whatever its unit.
pub(super) fn parse_amount(text: &str) -> Result<Amount, String> {
    let amount = Amount::read(text)
        .ok_or("expected a number, such as -0.3 or 1e-2, or one with its unit, such as 2.5mm/s")?;
    amount.map_err(|error| on_one_line(&error))
}

/// Reads a name and the finite number behind its =, whatever its unit.
pub(super) fn named_amount<'t>(text: &'t str, expected: &str) -> Result<(&'t str, Amount), String> {
    let named = text.split_once('=');
    let (name, value) = named.ok_or_else(|| format!("expected {expected}"))?;
    let value = Amount::read(value).transpose();
    let value = value
        .map_err(|error| on_one_line(&error))?
        .filter(Amount::is_finite);
    let value = value.ok_or("the value after = must be a finite number")?;
    Ok((name.trim(), value))
}

/// A time, or a word in its place.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum TimeOr {
    /// The word.
    Word,
    /// The time.
    Time(Amount),
}

impl TimeOr {
    /// A reader of a time or of `word`.
    pub(super) fn word(
        word: &'static str,
    ) -> impl Fn(&str) -> Result<Self, String> + Clone + Send + Sync + 'static {
        move |text| match text.trim() == word {
            true => Ok(Self::Word),
            false => amount_of(Parameter::Tau)(text)
                .map(Self::Time)
                .map_err(|error| format!("{error}, or {word}")),
        }
    }

    pub(super) fn time(&self) -> Option<&Amount> {
        match self {
            Self::Word => None,
            Self::Time(time) => Some(time),
        }
    }
}

/// The number of `flag` in `units`.
pub(super) fn in_units(flag: &str, amount: &Amount, units: &Units) -> Result<f64, Failure> {
    amount
        .value(units)
        .map_err(|error| refused(flag, amount, error))
}

/// The number that `flag` gives to a quantity, in `units`; its unit is checked.
pub(super) fn quantity_in_units(
    flag: &str,
    amount: &Amount,
    of: &Quantity,
    units: &Units,
) -> Result<f64, Failure> {
    let dimension = of.dimension();
    let fits = amount.check(dimension);
    fits.map_err(|error| refused(flag, amount, error))?;
    in_units(flag, amount, units)
}

/// The failure for a number of `flag` whose unit does not fit.
fn refused(flag: &str, amount: &Amount, error: SpecError) -> Failure {
    let message = format!("{flag} {amount}: {}", error.message);
    match error.help {
        Some(help) => Failure::bad_input_with_help(message, help),
        None => Failure::bad_input(message),
    }
}

/// An error with its advice, on one line.
pub(super) fn on_one_line(error: &SpecError) -> String {
    match &error.help {
        Some(help) => format!("{error}; {help}"),
        None => error.to_string(),
    }
}
