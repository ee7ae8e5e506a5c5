//! The flag `--set`: values of parameters that a system or a formula names.

use crate::text::{Shown, SpecError};

use super::failure::Failure;

#[derive(Debug, clap::Args)]
pub(super) struct SetArgs {
    /// The value of a parameter that --system or the formula of --friction formula names; once for
    /// each
    #[arg(long, value_name = "NAME=VALUE", value_parser = parse_set, allow_hyphen_values = true)]
    set: Vec<Set>,
}

/// A value of a parameter, as given by the flag.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Set {
    pub(super) name: String,
    pub(super) value: f64,
}

fn parse_set(text: &str) -> Result<Set, String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("expected NAME=VALUE, for example zeta=0.02")?;
    let value = value.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    Ok(Set {
        name: name.trim().to_owned(),
        value: value.ok_or("the value after = must be a finite number")?,
    })
}

impl Set {
    /// The failure of a value that is not taken.
    pub(super) fn refused(&self, error: SpecError) -> Failure {
        let Self { name, value } = self;
        let message = format!("--set {name}={}: {}", Shown(*value), error.message);
        Failure::of_input(SpecError { message, ..error })
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
