//! What is said of a law that parameters alone describe, wherever laws are named.

use super::FrictionLaw;
use crate::model::{ModelError, RateAndState};

/// The form of a law that parameters alone describe: its row in lists of laws.
#[derive(Debug)]
pub struct Form {
    /// The name in flags and sweep files.
    pub name: &'static str,
    /// Its formula, for the help.
    pub formula: &'static str,
    /// The names of the parameters that describe it, besides the optional ones.
    pub parameters: &'static [&'static str],
    /// How many of them must be given. If not all, the missing one follows from the others.
    pub needed: usize,
    /// The names of the parameters that need not be given.
    pub optional: &'static [&'static str],
    /// The law of some numbers.
    pub(crate) law: Made,
}

/// The law of the numbers of [`Form::parameters`] and then those of [`Form::optional`], in their
/// order and NaN where one is not given.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Made {
    /// Friction is a function of the velocity.
    OfVelocity(fn(&[f64]) -> Result<FrictionLaw, ModelError>),
    /// Friction depends on a state besides.
    WithState(fn(&[f64]) -> RateAndState),
}

impl Form {
    /// Whether the coefficient depends on a state besides the velocity. There is then no
    /// [`FrictionLaw`], and motions are not followed.
    #[must_use]
    pub const fn has_state(&self) -> bool {
        matches!(self.law, Made::WithState(_))
    }
}

/// Forms are the same where their names are.
impl PartialEq for Form {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
