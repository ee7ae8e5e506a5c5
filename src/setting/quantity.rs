//! The quantity of an axis: a parameter of slipmap, or one of a system's own.

use std::sync::Arc;

use super::parameter::Parameter;
use super::system::SystemModel;
use super::system::parameter::OwnParameter;
use super::units::Units;
use crate::text::{Shown, words};

/// The quantity of an axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// A parameter that every sweep of its kind has.
    Known(Parameter),
    /// A parameter of the sweep's own system.
    Own(Arc<OwnParameter>),
}

impl From<Parameter> for Quantity {
    fn from(parameter: Parameter) -> Self {
        Self::Known(parameter)
    }
}

impl From<&Quantity> for Quantity {
    fn from(quantity: &Quantity) -> Self {
        quantity.clone()
    }
}

impl PartialEq<Parameter> for Quantity {
    fn eq(&self, other: &Parameter) -> bool {
        self.known() == Some(*other)
    }
}

impl SystemModel {
    /// Everything that can vary in the system: its own parameters, and those of every such system.
    #[must_use]
    pub fn quantities(&self) -> Vec<Quantity> {
        let own = self.parameters.iter().cloned().map(Quantity::Own);
        let others = Parameter::of_systems(self.is_feedback()).iter();
        own.chain(others.map(|p| Quantity::Known(*p))).collect()
    }

    /// The quantity with this name, in any of its spellings.
    #[must_use]
    pub fn quantity(&self, name: &str) -> Option<Quantity> {
        let mut all = self.quantities().into_iter();
        all.find(|of| words::same(of.name(), name))
    }
}

impl Quantity {
    /// The parameter, unless it is one of a system's own.
    #[must_use]
    pub fn known(&self) -> Option<Parameter> {
        match self {
            Self::Known(parameter) => Some(*parameter),
            Self::Own(_) => None,
        }
    }

    /// The name, the same word everywhere.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Known(parameter) => parameter.name(),
            Self::Own(own) => &own.name,
        }
    }

    /// The letter's symbol; for a system's own parameter, its name.
    #[must_use]
    pub fn symbol(&self) -> &str {
        match self {
            Self::Known(parameter) => parameter.symbol(),
            Self::Own(own) => &own.name,
        }
    }

    /// Its meaning, for `long_name` in maps and labels in pictures.
    #[must_use]
    pub fn long_name(&self) -> &str {
        match self {
            Self::Known(parameter) => parameter.long_name(),
            Self::Own(own) => &own.long_name,
        }
    }

    /// Powers of force, length and time of numbers with units; of a system's own parameter none.
    #[must_use]
    pub fn dimension(&self) -> [i32; 3] {
        match self {
            Self::Known(parameter) => parameter.dimension(),
            Self::Own(own) => own.dimension,
        }
    }

    /// Its unit; "1" where it has none.
    #[must_use]
    pub fn unit(&self, units: &Units) -> String {
        match self {
            Self::Known(parameter) => units.of_parameter(*parameter),
            Self::Own(own) => own.unit.clone(),
        }
    }

    /// The default value; none for a required parameter.
    #[must_use]
    pub fn default_value(&self) -> Option<f64> {
        match self {
            Self::Known(parameter) => parameter.default_value(),
            Self::Own(own) => Some(own.default),
        }
    }

    /// The smallest and the largest value.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Known(parameter) => parameter.range(),
            Self::Own(own) => [own.minimum, own.maximum],
        }
    }

    /// The allowed range, in words.
    #[must_use]
    pub fn allowed(&self) -> String {
        match self {
            Self::Known(parameter) => parameter.allowed().into(),
            Self::Own(own) => own.allowed(),
        }
    }

    /// `value` if it is in range.
    ///
    /// # Errors
    /// Names the parameter, the value and the allowed range.
    pub fn check(&self, value: f64) -> Result<f64, String> {
        let [from, to] = self.range();
        if (from..=to).contains(&value) {
            return Ok(value);
        }
        let (name, allowed) = (self.name(), self.allowed());
        Err(format!(
            "{name} = {} is outside its range: {allowed}",
            Shown(value)
        ))
    }
}
