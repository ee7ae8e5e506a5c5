//! The setting that a command is asked about: of the block, or of a system from a file.

use std::collections::BTreeMap;

use crate::setting::Setting;
use crate::setting::amount::Amount;
use crate::setting::quantity::Quantity;
use crate::setting::units::Units;
use crate::text::Shown;

use super::failure::Failure;
use super::json::Inputs;
use super::parameter_values::quantity_in_units;

/// A setting with the units of its numbers.
pub(super) struct Asked {
    pub(super) setting: Setting,
    pub(super) units: Units,
    /// The flag that names a system from a file, with its value; none for the block.
    pub(super) named: Option<(&'static str, String)>,
}

impl Asked {
    /// The setting of a system from a file, which `value` of the flag `flag` names.
    pub(super) fn of_system(
        (setting, units): (Setting, Units),
        flag: &'static str,
        value: String,
    ) -> Self {
        Self {
            setting,
            units,
            named: Some((flag, value)),
        }
    }

    /// The parameters of `wanted` names, and what else is asked about.
    pub(super) fn inputs(&self, wanted: impl Fn(&str) -> bool) -> Inputs {
        let Self { setting, units, .. } = self;
        let Some((flag, value)) = &self.named else {
            return Inputs::of_setting(setting, units, |p| wanted(p.name()));
        };
        let own = setting.own().filter(|(own, _)| wanted(&own.name));
        let set: BTreeMap<&str, f64> = own.map(|(own, value)| (&*own.name, value)).collect();
        let inputs = Inputs::default().and(flag, value).and("set", set);
        let others = setting.others().iter().filter(|p| wanted(p.name()));
        let inputs = others.fold(inputs, |inputs, p| inputs.and(p.name(), setting.get(*p)));
        // A map says its own.
        match *flag != "map" && !units.dimensionless() {
            true => inputs.and("units", &units.force_length_time),
            false => inputs,
        }
    }

    /// The value of a quantity that a flag gives, in its range.
    pub(super) fn value(&self, of: &Quantity, flag: &str, given: &Amount) -> Result<f64, Failure> {
        let value = quantity_in_units(flag, given, of, &self.units)?;
        match of.check(value) {
            Ok(value) => Ok(value),
            Err(_) if self.named.is_none() => Err(Failure::bad_input(format!(
                "{flag} {} is outside its range: {}",
                Shown(value),
                of.allowed()
            ))),
            Err(why) => Err(Failure::bad_input(format!("{flag}: {why}"))),
        }
    }
}

/// The speed of which a delay > 0 is the period, beside its name and its unit; none where a setting
/// has no speed, and without a known unit of time.
pub(super) fn speed_at<'s>(
    setting: &'s Setting,
    units: &Units,
    delay: f64,
) -> Option<(&'s str, f64, &'static str)> {
    let (speed, turn) = setting.system()?.speed(units)?;
    (delay > 0.0).then(|| (&*speed.name, turn.over(delay), speed.unit.name()))
}

/// What is stable or not, in words; `block` for the block.
pub(super) fn subject<'s>(setting: &'s Setting, block: &'s str) -> &'s str {
    match setting.system().map(|model| &*model.title) {
        None => block,
        Some("") => "the system",
        Some(title) => title,
    }
}
