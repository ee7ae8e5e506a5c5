//! The flag `--set`: values of parameters that a system or a formula names.

use crate::setting::amount::Amount;
use crate::setting::units::Units;
use crate::text::SpecError;

use super::failure::Failure;
use super::parameter_values::named_amount;

#[derive(Debug, clap::Args)]
pub(super) struct SetArgs {
    /// The value of a parameter that --system or the formula of --friction formula names, of a
    /// formula also with its unit, as in "sigma=0.1 s/m"; once for each
    #[arg(long, value_name = "NAME=VALUE", value_parser = parse_set, allow_hyphen_values = true)]
    set: Vec<Set>,
}

/// A value of a parameter, as given by the flag.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Set {
    pub(super) name: String,
    pub(super) amount: Amount,
}

fn parse_set(text: &str) -> Result<Set, String> {
    let (name, amount) = named_amount(text, "NAME=VALUE, for example zeta=0.02")?;
    let name = name.to_owned();
    Ok(Set { name, amount })
}

impl Set {
    /// The failure of a value that is not taken.
    pub(super) fn refused(&self, error: SpecError) -> Failure {
        let Self { name, amount } = self;
        let message = format!("--set {name}={amount}: {}", error.message);
        Failure::of_input(SpecError { message, ..error })
    }

    /// The number in `units`.
    pub(super) fn value(&self, units: &Units) -> Result<f64, Failure> {
        let value = self.amount.value(units);
        value.map_err(|error| self.refused(error))
    }
}

impl SetArgs {
    /// Whether a parameter of that name is given.
    pub(super) fn has(&self, name: &str) -> bool {
        self.set.iter().any(|set| set.name == name)
    }

    /// Whether any parameter is given.
    pub(super) fn any(&self) -> bool {
        !self.set.is_empty()
    }

    /// The values, each of another name.
    pub(super) fn each(&self) -> Result<&[Set], Failure> {
        let twice = (1..self.set.len()).find(|&i| {
            let name = &self.set[i].name;
            self.set[..i].iter().any(|before| before.name == *name)
        });
        match twice {
            Some(i) => Err(given_twice(&self.set[i].name)),
            None => Ok(&self.set),
        }
    }
}

pub(super) fn given_twice(name: &str) -> Failure {
    Failure::bad_input(format!("{name} is given twice"))
}
