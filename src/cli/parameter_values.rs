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
                .value_parser(parse_number)
                .allow_hyphen_values(true);
            Some(arg)
        })
    }

    pub(super) fn of(matches: &ArgMatches, wanted: impl Fn(Group) -> bool) -> Self {
        Self(Box::new(Parameter::ALL.map(|parameter| {
            let asked = wanted(parameter.group()) && parameter.flag().is_some();
            let value = || matches.get_one::<f64>(parameter.name()).copied();
            asked.then(value).flatten()
        })))
    }

    pub(super) fn get(&self, parameter: Parameter) -> Option<f64> {
        self.0[parameter as usize]
    }
}

/// Reads the number of a flag; its range is checked with its parameter.
pub(super) fn parse_number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    number.ok_or_else(|| "expected a number, such as -0.3 or 1e-2".to_owned())
}
