//! The flags for the start and the end of a motion: what case files say by keys of the same names.

use crate::setting::Parameter;
use crate::setting::parameter::Group;
use crate::setting::setting_text::number;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::failure::Failure;
use super::parameter_values::{Values, parse_number};
use super::parameters::flag;
use crate::text::Shown;

/// The latest time that a case file takes.
const LATEST: f64 = 1e12;

/// The start and the end of a motion.
#[derive(Debug)]
pub(super) struct StartArgs {
    state: Values,
    times: TimeArgs,
}

/// The flags of times.
#[derive(Debug, Args)]
struct TimeArgs {
    /// When control begins to act, or false: never [default: 0]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = parse_switch_on)]
    switch_on: Option<String>,
    /// End of the trace [default: when the outcome is known]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = parse_number)]
    until: Option<f64>,
}

/// Reads a time or `false`, as the value of the key.
fn parse_switch_on(text: &str) -> Result<String, String> {
    match text.trim() {
        never @ "false" => Ok(never.to_owned()),
        time => parse_number(time)
            .map(value)
            .map_err(|error| format!("{error}, or false")),
    }
}

/// A number as the value of a key.
fn value(of: f64) -> String {
    number(of).to_lowercase()
}

impl StartArgs {
    const fn of_start(group: Group) -> bool {
        matches!(group, Group::Start)
    }

    /// Whether one of the flags is given.
    pub(super) fn any(&self) -> bool {
        let TimeArgs { switch_on, until } = &self.times;
        let state = Parameter::ALL
            .into_iter()
            .any(|p| self.state.get(p).is_some());
        state || switch_on.is_some() || until.is_some()
    }

    /// Checks that the values are in their ranges.
    pub(super) fn check(&self) -> Result<(), Failure> {
        for parameter in Parameter::ALL {
            if let Some(value) = self.state.get(parameter) {
                let checked = parameter.check(value);
                checked.map_err(|error| Failure::out_of_range(&flag(parameter), &error))?;
            }
        }
        let TimeArgs { switch_on, until } = &self.times;
        let switch_on = switch_on.as_ref().and_then(|time| time.parse().ok());
        for (flag, time) in [("--switch-on", switch_on), ("--until", *until)] {
            if let Some(time) = time.filter(|time| !(0.0..=LATEST).contains(time)) {
                let time = Shown(time);
                return Err(Failure::bad_input(format!(
                    "{flag} {time} is outside its range: 0 or more, at most 1e12"
                )));
            }
        }
        Ok(())
    }

    /// The text of a case file with these flags as keys, and with the tables `setting`.
    pub(super) fn case(&self, setting: &str) -> String {
        let TimeArgs { switch_on, until } = &self.times;
        let given = |p: Parameter| Some((p.name(), value(self.state.get(p)?)));
        let state: Vec<_> = Parameter::ALL.into_iter().filter_map(given).collect();
        let trace: Vec<_> = until.iter().map(|until| ("until", value(*until))).collect();
        let mut text = String::new();
        if let Some(time) = switch_on {
            text += &format!("switch_on = {time}\n\n");
        }
        text += setting;
        for (name, keys) in [("start", state), ("trace", trace)] {
            if !keys.is_empty() {
                text += &format!("\n[{name}]\n");
                text.extend(keys.iter().map(|(key, value)| format!("{key} = {value}\n")));
            }
        }
        text
    }
}

impl Args for StartArgs {
    fn augment_args(command: Command) -> Command {
        TimeArgs::augment_args(command.args(Values::flags(Self::of_start)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for StartArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self {
            state: Values::of(matches, Self::of_start),
            times: TimeArgs::from_arg_matches(matches)?,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
