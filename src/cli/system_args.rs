//! A system from a file, or one that is part of the program, instead of the letter's: `--system
//! FILE|NAME --set NAME=VALUE`.

use std::path::Path;
use std::sync::Arc;

use crate::setting::quantity::Quantity;
use crate::setting::system::{SpeedUnit, SystemModel, shipped};
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::text::nearest::did_you_mean;
use crate::text::{Shown, SpecError, words};

use super::asked::Asked;
use super::failure::Failure;
use super::sets::{SetArgs, given_twice};
use super::sweep_file::read_system;

#[derive(Debug, clap::Args)]
pub(super) struct SystemArgs {
    /// A system from a file, or of the program by its name, in the place of the letter's
    #[arg(long, value_name = "FILE|NAME")]
    pub system: Option<String>,
}

/// The system with this name, or in the file at this path.
pub(super) fn system_of(named: &str) -> Result<SystemModel, Failure> {
    if let Some(model) = shipped::system(named) {
        return Ok(model);
    }
    let path = Path::new(named);
    let is_path = path.components().count() > 1 || path.extension().is_some();
    if !is_path && !path.exists() {
        return Err(Failure::bad_input_with_help(
            format!("--system {named} is neither a file nor the name of a system"),
            shipped::meant(named),
        ));
    }
    read_system(path)
}

/// The parameters besides its own that any system may have, each with a flag.
pub(super) const OTHERS: [Parameter; 3] = [Parameter::Tau, Parameter::Memory, Parameter::Latency];

impl SystemArgs {
    /// The system at its setting in `units`, with its own parameters in `sets`; none without a
    /// system. `flag` gives the value of the flag for one of [`OTHERS`]; the delay may be given as
    /// a speed `rpm` > 0.
    pub(super) fn read(
        &self,
        sets: &SetArgs,
        units: &Units,
        rpm: Option<f64>,
        flag: impl Fn(Parameter) -> Option<f64>,
    ) -> Result<Option<Asked>, Failure> {
        let tau = Parameter::Tau;
        let mut found = self.read_but_delay(sets, units, flag)?;
        if let (Some(asked), Some(rpm)) = (&mut found, rpm) {
            put_speed(asked, rpm)?;
        }
        match found {
            Some(asked) if asked.setting.get(tau).is_nan() => Err(Failure::bad_input_with_help(
                "--tau is not given",
                format!("--tau: {}, {}", tau.long_name(), tau.allowed()),
            )),
            found => Ok(found),
        }
    }

    /// The system at a setting whose delay need not be given, and is NaN then; none without a
    /// system. `flag` as in [`SystemArgs::read`].
    pub(super) fn read_but_delay(
        &self,
        sets: &SetArgs,
        units: &Units,
        flag: impl Fn(Parameter) -> Option<f64>,
    ) -> Result<Option<Asked>, Failure> {
        let Some(named) = &self.system else {
            return Ok(None);
        };
        let model = Arc::new(system_of(named)?);
        let mut setting = Setting::of_system(Arc::clone(&model));
        let mut others = OTHERS.map(flag);
        for set in sets.each()? {
            let named = |name: &str| words::same(name, &set.name);
            let own = model.parameters.iter().find(|own| named(&own.name));
            let other = OTHERS.into_iter().position(|p| named(p.name()));
            let of_other = other.map(|other| OTHERS[other].dimension());
            let dimension = own.map(|own| own.dimension).or(of_other);
            let fits = dimension.map_or(Ok(()), |dimension| set.amount.check(dimension));
            fits.map_err(|error| set.refused(error))?;
            let value = set.value(units)?;
            match (own, other) {
                (Some(own), _) => {
                    let value = own.check(value);
                    let value = value.map_err(|why| set.refused(SpecError::whole(why)))?;
                    setting.vary(&Quantity::Own(Arc::clone(own)), value);
                }
                (None, Some(other)) if others[other].is_some() => {
                    return Err(given_twice(&set.name));
                }
                (None, Some(other)) => others[other] = Some(value),
                (None, None) => return Err(unknown(&set.name, &model)),
            }
        }
        for (parameter, value) in OTHERS.into_iter().zip(others) {
            let Some(value) = value else { continue };
            let name = parameter.name();
            if !setting.others().contains(&parameter) {
                return Err(Failure::bad_input_with_help(
                    format!("this system has no {name}"),
                    "a system of B and A has memory and latency, one of P and Q has not",
                ));
            }
            let checked = parameter.check(value);
            let value = checked.map_err(|e| Failure::out_of_range(&format!("--{name}"), &e))?;
            setting.set(parameter, value);
        }
        let of = (setting, units.clone());
        Ok(Some(Asked::of_system(of, "system", named.clone())))
    }
}

/// Sets the delay of a system to the period of the speed `rpm` > 0.
fn put_speed(asked: &mut Asked, rpm: f64) -> Result<(), Failure> {
    let tau = Parameter::Tau;
    let model = asked.setting.system();
    if model.is_none_or(|model| model.speed_axis.is_none()) {
        return Err(Failure::bad_input_with_help(
            "--rpm: the delay of this system is not the period of a rotation",
            "give --tau; a speed_axis in the file of a system says that it is one",
        ));
    }
    if !asked.setting.get(tau).is_nan() {
        return Err(Failure::bad_input_with_help(
            "tau is given twice: --rpm gives it as a speed",
            "give either --tau or --rpm",
        ));
    }
    let turn = SpeedUnit::RevolutionsPerMinute.turn(&asked.units);
    let turn = turn.map_err(|error| {
        Failure::bad_input_with_help(
            format!("--rpm {}: {}", Shown(rpm), error.message),
            "say in which units the system's numbers are, as in --units SI; or give --tau",
        )
    })?;
    let period = tau.check(turn.over(rpm));
    let period = period.map_err(|error| Failure::out_of_range("--rpm", &error))?;
    asked.setting.set(tau, period);
    Ok(())
}

fn unknown(name: &str, model: &SystemModel) -> Failure {
    let quantities = model.quantities();
    let known: Vec<&str> = quantities.iter().map(Quantity::name).collect();
    let meant = did_you_mean(name, known.iter().copied());
    Failure::bad_input_with_help(
        format!("--set: the system has no parameter {name}"),
        format!("{meant}its parameters: {}", known.join(", ")),
    )
}
