//! The flags for the start and the end of a motion: what case files say by keys of the same names.

use crate::setting::Parameter;
use crate::setting::amount::Amount;
use crate::setting::parameter::{Group, LARGEST};
use crate::setting::setting_text::number;
use crate::setting::units::Units;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::cell::alone;
use super::corners::Corner;
use super::failure::Failure;
use super::parameter_values::{TimeOr, Values, amount_of, amounts, in_units};
use super::parameters::flag;
use crate::text::Shown;

/// The start and the end of a motion.
#[derive(Debug)]
pub(super) struct StartArgs {
    state: Vec<(Parameter, Amount)>,
    times: TimeArgs,
}

/// The flags of times.
#[derive(Debug, Args)]
struct TimeArgs {
    /// When control begins to act, or false: never [default: 0]
    #[arg(long, value_name = "T", allow_hyphen_values = true,
          value_parser = TimeOr::word("false"))]
    switch_on: Option<TimeOr>,
    /// End of the trace [default: when the outcome is known]
    #[arg(long, value_name = "T", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::Tau))]
    until: Option<Amount>,
    /// What the noise of readings is drawn with, a whole number [default: 0]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// v0 in time: from T on it is V; with ramp it comes there on a straight line from the corner
    /// before, or from t = 0. Once for each corner, in the order of time
    #[arg(long, value_name = "at=T,v0=V[,ramp]", value_parser = Corner::read)]
    programme: Vec<Corner>,
}

/// A time of a flag in `units`.
fn time(flag: &str, of: &Amount, units: &Units) -> Result<String, Failure> {
    let time = in_units(flag, of, units)?;
    if (0.0..=LARGEST).contains(&time) {
        return Ok(number(time));
    }
    let time = Shown(time);
    Err(Failure::bad_input(format!(
        "{flag} {time} is outside its range: 0 or more, at most 1e12"
    )))
}

impl StartArgs {
    const fn of_start(group: Group) -> bool {
        matches!(group, Group::Start)
    }

    /// Whether one of the flags is given.
    pub(super) fn any(&self) -> bool {
        self.any_but_until() || self.times.until.is_some()
    }

    /// Whether a flag besides `--until` is given.
    fn any_but_until(&self) -> bool {
        let TimeArgs {
            switch_on,
            until: _,
            seed,
            programme,
        } = &self.times;
        let times = switch_on.is_some() || seed.is_some();
        !self.state.is_empty() || times || !programme.is_empty()
    }

    /// The end of a response > 0, the only of these flags that it takes.
    ///
    /// # Errors
    /// When another one is given, or the end is outside its range.
    pub(super) fn of_response(&self, units: &Units) -> Result<Option<f64>, Failure> {
        alone("--system", self.any_but_until())?;
        let Some(until) = &self.times.until else {
            return Ok(None);
        };
        let end = in_units("--until", until, units)?;
        if end > 0.0 && end <= LARGEST {
            return Ok(Some(end));
        }
        let message = format!("--until {} is outside its range", Shown(end));
        let help = "a time greater than 0, at most 1e12";
        Err(Failure::bad_input_with_help(message, help))
    }

    /// The values of the state at t = 0, in their ranges.
    fn state(&self, units: &Units) -> Result<Vec<(&'static str, String)>, Failure> {
        let value = |(parameter, amount): &(Parameter, Amount)| {
            let flag = flag(*parameter);
            let checked = parameter.check(in_units(&flag, amount, units)?);
            let value = checked.map_err(|error| Failure::out_of_range(&flag, &error))?;
            Ok((parameter.name(), number(value)))
        };
        self.state.iter().map(value).collect()
    }

    /// The text of a case file with these flags as keys, and with the tables `setting`, which have
    /// these units.
    ///
    /// # Errors
    /// When a value is outside its range.
    pub(super) fn case(&self, setting: &str, units: &Units) -> Result<String, Failure> {
        let TimeArgs {
            switch_on,
            until,
            seed,
            programme,
        } = &self.times;
        let state = self.state(units)?;
        let mut text = String::new();
        if let Some(of) = switch_on {
            let switch_on = of.time().map(|of| time("--switch-on", of, units));
            let switch_on = switch_on.unwrap_or_else(|| Ok("false".into()))?;
            text += &format!("switch_on = {switch_on}\n\n");
        }
        text.extend(seed.map(|seed| format!("seed = {seed}\n\n")));
        let until = until.as_ref().map(|of| time("--until", of, units));
        let trace = until.transpose()?.map(|until| ("until", until));
        text += setting;
        for (name, keys) in [("start", state), ("trace", trace.into_iter().collect())] {
            if !keys.is_empty() {
                text += &format!("\n[{name}]\n");
                text.extend(keys.iter().map(|(key, value)| format!("{key} = {value}\n")));
            }
        }
        for corner in programme {
            text += &corner.table(units)?;
        }
        Ok(text)
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
            state: amounts(matches, |p| Self::of_start(p.group())).collect(),
            times: TimeArgs::from_arg_matches(matches)?,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
