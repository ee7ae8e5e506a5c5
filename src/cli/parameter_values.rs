//! The values that flags give to parameters.

use crate::setting::Parameter;
use crate::setting::parameter::Group;
use clap::{Arg, ArgMatches};

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
                _ => arg.value_parser(parse_number),
            })
        })
    }

    pub(super) fn of(matches: &ArgMatches, wanted: impl Fn(Group) -> bool) -> Self {
        Self(Box::new(Parameter::ALL.map(|parameter| {
            let asked = wanted(parameter.group()) && parameter.flag().is_some();
            let value = || match parameter {
                Parameter::MuK => Self::text(matches)?.trim().parse().ok(),
                _ => matches.get_one::<f64>(parameter.name()).copied(),
            };
            asked.then(value).flatten()
        })))
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

/// Why a text is no number.
pub(super) const NO_NUMBER: &str = "expected a number, such as -0.3 or 1e-2";

/// Reads the number of a flag; its range is checked with its parameter.
pub(super) fn parse_number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    number.ok_or_else(|| NO_NUMBER.to_owned())
}
