//! The flags for a point of the limit of a short delay.

use crate::setting::Parameter;
use crate::setting::parameter::Group;
use crate::setting::units::Units;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::parameter_values::Values;

/// A point of the limit of a short delay.
#[derive(Debug)]
pub(super) struct LimitArgs(Values);

impl LimitArgs {
    const fn of_limit(group: Group) -> bool {
        matches!(group, Group::Limit)
    }

    /// The given value of a parameter.
    pub(super) fn get(&self, parameter: Parameter) -> Option<f64> {
        self.0.get(parameter)
    }

    /// The first given parameter.
    pub(super) fn any_given(&self) -> Option<Parameter> {
        Parameter::ALL.into_iter().find(|p| self.get(*p).is_some())
    }
}

impl Args for LimitArgs {
    fn augment_args(command: Command) -> Command {
        command.args(Values::flags(Self::of_limit))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for LimitArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Values::of(matches, Self::of_limit, &Units::default()).map(Self)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
