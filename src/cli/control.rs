//! Controls by name, as values of the flag `--control`.

use clap::ValueEnum;
use clap::builder::PossibleValue;

use crate::explore::best::Control;

impl ValueEnum for Control {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self {
            Self::Velocity => (
                "velocity",
                "α_v: the pulling velocity follows the delayed elongation",
            ),
            Self::Load => ("load", "α_N: the normal load does"),
        };
        Some(PossibleValue::new(name).help(help))
    }
}
