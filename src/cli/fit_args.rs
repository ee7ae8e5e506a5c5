//! The flags of `slipmap fit`: the rig on which was measured, and how the file is to be read.

use clap::{ArgMatches, Args, Command, FromArgMatches};

use crate::model::ModelError;
use crate::setting::measured::{Columns, CurveOptions, SpeedUnit, Spoken};
use crate::setting::parameter::Group;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::text::Shown;

use super::assumed_units::units_of;
use super::failure::Failure;
use super::output::tell_assumed_units;
use super::parameter_values::Values;
use super::parameters::flag;

/// The flags besides those of parameters.
#[derive(Debug, Args)]
struct Reading {
    /// Columns by title or number: speed, and mu or force, and load where a column has it, as in
    /// speed=2,force=4 [default: by titles]
    #[arg(long, value_name = "LIST", value_parser = Columns::read)]
    columns: Option<Columns>,
    /// Unit of the speeds in the file, as in mm/s [default: that of their title, else of --units]
    #[arg(long, value_name = "UNIT", value_parser = SpeedUnit::read)]
    speed_unit: Option<SpeedUnit>,
    /// Units of the numbers given and told: SI, or those of force, length and time, as in N,mm,s
    /// [default: SI if a number has a unit, as in 2.4kg or 3mm/s, else dimensionless]
    #[arg(long, value_name = "UNITS", value_parser = Units::read)]
    units: Option<Units>,
}

/// The rig on which was measured, and how the file is to be read.
#[derive(Debug)]
pub(super) struct FitArgs {
    values: Values,
    reading: Reading,
    /// The units of all numbers.
    pub(super) units: Units,
}

const OF_V0: &str = "Sliding velocity at which the slope is asked for, length/time, > 0";
const OF_MU_S: &str = "Static coefficient of friction, held at this value [default: fitted where \
    the law falls from it, else 1]";

/// Whether a fit takes a parameter of the rig.
fn taken(parameter: Parameter) -> bool {
    let of_law = [Parameter::V0, Parameter::MuS].contains(&parameter);
    of_law || parameter.group() == Group::Model
}

/// Whether some parameter of a group is taken.
fn groups(group: Group) -> bool {
    let mut of_group = Parameter::ALL.into_iter().filter(|p| p.group() == group);
    of_group.any(taken)
}

impl Args for FitArgs {
    fn augment_args(command: Command) -> Command {
        let flags = Values::flags(groups)
            .filter(|arg| Parameter::from_name(arg.get_id().as_str()).is_some_and(taken));
        let flags = flags.map(|arg| match Parameter::from_name(arg.get_id().as_str()) {
            Some(Parameter::V0) => arg.required(true).help(OF_V0),
            Some(Parameter::MuS) => arg.help(OF_MU_S),
            _ => arg,
        });
        Reading::augment_args(command.args(flags))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for FitArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let reading = Reading::from_arg_matches(matches)?;
        let units = units_of(matches, reading.units.as_ref());
        Ok(Self {
            values: Values::those(matches, taken, &units)?,
            reading,
            units,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl FitArgs {
    pub(super) fn given(&self, parameter: Parameter) -> Option<f64> {
        self.values.get(parameter)
    }

    /// How the file is to be read.
    pub(super) fn of_curve(&self) -> CurveOptions {
        CurveOptions {
            columns: self.reading.columns.clone().unwrap_or_default(),
            normal_load: self.given(Parameter::NormalLoad),
            speed_unit: self.reading.speed_unit.clone(),
            units: self.units.clone(),
            spoken: Spoken::Flags,
        }
    }

    /// The rig at its sliding velocity, without a friction law.
    pub(super) fn setting(&self) -> Result<Setting, Failure> {
        tell_assumed_units(&self.units);
        let mut setting = Setting::new(None);
        // Without control the delay does not matter; with it, it is needed when it is asked for.
        setting.set(Parameter::Tau, 0.0);
        for parameter in Parameter::ALL.into_iter().filter(|p| taken(*p)) {
            if let Some(value) = self.given(parameter) {
                let checked = parameter.check(value);
                setting.set(parameter, checked.map_err(|e| refused(parameter, &e))?);
            }
        }
        let moves = setting.get(Parameter::V0) > 0.0;
        let at_rest =
            || Failure::bad_input("--v0 0: the slope is asked for where the block slides");
        moves.then_some(setting).ok_or_else(at_rest)
    }
}

fn refused(parameter: Parameter, error: &ModelError) -> Failure {
    let (flag, value) = (flag(parameter), Shown(error.value));
    Failure::bad_input(format!(
        "{flag} {value} is outside its range: {}",
        error.allowed
    ))
}
