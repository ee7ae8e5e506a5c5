//! A system from a file, or one that is part of the program, instead of the letter's: `--system
//! FILE|NAME --set NAME=VALUE`.

use std::path::Path;
use std::sync::Arc;

use crate::setting::quantity::Quantity;
use crate::setting::system::{SystemModel, shipped};
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::text::SpecError;
use crate::text::nearest::did_you_mean;

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
    /// The system at its setting, with its own parameters in `sets`; none without a system. `flag`
    /// gives the value of the flag for one of [`OTHERS`].
    pub(super) fn read(
        &self,
        sets: &SetArgs,
        flag: impl Fn(Parameter) -> Option<f64>,
    ) -> Result<Option<Asked>, Failure> {
        let tau = Parameter::Tau;
        match self.read_but_delay(sets, flag)? {
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
        flag: impl Fn(Parameter) -> Option<f64>,
    ) -> Result<Option<Asked>, Failure> {
        let Some(named) = &self.system else {
            return Ok(None);
        };
        let model = Arc::new(system_of(named)?);
        let mut setting = Setting::of_system(Arc::clone(&model));
        let mut others = OTHERS.map(flag);
        for set in sets.each()? {
            // Numbers with units were refused.
            let value = set.value(&Units::default())?;
            let own = model.parameters.iter().find(|own| own.name == set.name);
            let other = OTHERS.into_iter().position(|p| p.name() == set.name);
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
        Ok(Some(Asked::of_system(setting, "system", named.clone())))
    }
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
