//! What is computed: a block with a friction law or with given slopes, or a system.

use std::sync::Arc;

use pyo3::prelude::*;
use slipmap::setting::point_file::{PointOf, PointSpec};
use slipmap::setting::quantity::Quantity;
use slipmap::setting::units::Units;
use slipmap::setting::{Parameter, Setting};
use slipmap::text::SpecError;

use crate::error::of_text;

/// A friction law or a system with its numbers, read once from the text of a setting.
#[pyclass(frozen)]
pub(crate) struct Subject {
    setting: Setting,
    /// The numbers that are given, by their names.
    numbers: Vec<(String, f64)>,
    units: Units,
}

#[pymethods]
impl Subject {
    /// Reads the text of a setting, in which numbers may be missing.
    #[new]
    fn new(py: Python, text: &str) -> PyResult<Self> {
        let read = PointSpec::read(text, PointOf::Subject);
        let PointSpec { setting, units, .. } = read.map_err(|error| of_text(py, error, text))?;
        // A number that is the default need not be given again.
        let given = |p: &Parameter| {
            let (value, default) = (setting.get(*p), p.default_value());
            !value.is_nan() && default.map(f64::to_bits) != Some(value.to_bits())
        };
        let mut numbers: Vec<(String, f64)> = Parameter::ALL
            .into_iter()
            .filter(given)
            .map(|p| (p.name().to_owned(), setting.get(p)))
            .collect();
        if setting.law().is_some() {
            let own = setting.own().filter(|(_, value)| !value.is_nan());
            numbers.extend(own.map(|(own, value)| (own.name.clone(), value)));
        }
        Ok(Self {
            setting,
            numbers,
            units,
        })
    }

    /// The names of the parameters that belong to the friction law.
    fn of_law(&self) -> Vec<String> {
        let own = self.setting.own().map(|(own, _)| own.name.clone());
        let known = Parameter::ALL.into_iter().filter(|p| p.of_friction_law());
        let known = known.map(|p| p.name().to_owned());
        match self.setting.law() {
            Some(_) => known.chain(own).collect(),
            None => Vec::new(),
        }
    }

    /// The names of all parameters that it takes.
    fn parameters(&self) -> Vec<String> {
        if let Some(model) = self.setting.system() {
            let all = model.quantities();
            return all.iter().map(|of| of.name().to_owned()).collect();
        }
        let own = self.setting.own().map(|(own, _)| own.name.clone());
        let known = Parameter::ALL.into_iter();
        known.map(|p| p.name().to_owned()).chain(own).collect()
    }
}

impl Subject {
    /// Its units.
    pub(crate) fn units(&self) -> &Units {
        &self.units
    }

    /// The friction law or system, with those numbers that are given.
    pub(crate) fn setting(&self) -> &Setting {
        &self.setting
    }

    /// The parameter with this name, known or its own.
    pub(crate) fn quantity(&self, name: &str) -> Option<Quantity> {
        if let Some(model) = self.setting.system() {
            return model.quantity(name);
        }
        let own = self.setting.own().find(|(own, _)| own.name == name);
        match own {
            Some((own, _)) => Some(Quantity::Own(Arc::clone(own))),
            None => Parameter::from_name(name).map(Quantity::from),
        }
    }

    /// A setting of these numbers, checked as a file is; those `varied` need no value.
    ///
    /// # Errors
    /// As [`Setting::checked`].
    pub(crate) fn at(
        &self,
        numbers: &[(&str, f64)],
        varied: &[Parameter],
    ) -> Result<Setting, SpecError> {
        if self.setting.system().is_some() {
            return self.at_system(numbers, varied);
        }
        let given = self.numbers.iter().map(|(name, value)| (&**name, *value));
        let all = given.chain(numbers.iter().copied());
        Setting::checked(all, self.setting.law().cloned(), varied)
    }

    fn at_system(
        &self,
        numbers: &[(&str, f64)],
        varied: &[Parameter],
    ) -> Result<Setting, SpecError> {
        let mut setting = self.setting.clone();
        for (name, value) in numbers {
            let of = self.quantity(name).ok_or_else(|| self.unknown(name))?;
            let value = of.check(*value).map_err(SpecError::whole)?;
            setting.vary(&of, value);
        }
        let tau = Parameter::Tau;
        match setting.get(tau).is_nan() && !varied.contains(&tau) {
            true => Err(SpecError::whole("tau is not given")),
            false => Ok(setting),
        }
    }

    fn unknown(&self, name: &str) -> SpecError {
        let known = self.parameters().join(", ");
        SpecError::whole(format!("the system has no parameter {name}"))
            .help(format!("its parameters: {known}"))
    }
}
