//! A setting as text: the tables `[fixed]`, `[friction]` and `[units]`. Reading them gives the same
//! setting.

use super::fit_errors::{
    BETWEEN_LAWS, CORRELATIONS, COVERAGE_FACTOR, FIT, FitErrors, FittedNumber, PARAMETERS,
    STANDARD_ERRORS,
};
use super::formula_keys::UNITS;
use super::law_kind::LawKind;
use super::parameter::{Group, Parameter};
use super::units::Units;
use super::values::Setting;
use crate::model::table::TableColumn;
use crate::text::toml_reader::{key, quoted};

/// A number as text that is read as the same number.
#[must_use]
pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}

/// A table of the `wanted` parameters.
#[must_use]
pub(crate) fn table(name: &str, setting: &Setting, wanted: impl Fn(Parameter) -> bool) -> String {
    let mut text = format!("\n[{name}]\n");
    for parameter in Parameter::ALL.into_iter().filter(|&p| wanted(p)) {
        let value = number(setting.get(parameter));
        text += &format!("{} = {value}\n", parameter.name());
    }
    text
}

/// Whether a point of this setting has the parameter.
#[must_use]
pub fn of_point(setting: &Setting, parameter: Parameter) -> bool {
    !parameter.of_start() && setting.uses(parameter)
}

/// The tables of a setting, with its `wanted` parameters but without its start.
#[must_use]
pub fn setting_text(
    setting: &Setting,
    units: &Units,
    wanted: impl Fn(Parameter) -> bool,
) -> String {
    let wanted = |parameter| wanted(parameter) && of_point(setting, parameter);
    if let Some(system) = setting.system() {
        let named = format!("system = {}\n", system.to_inline_table());
        let own = setting.own().filter(|(_, value)| !value.is_nan());
        let own = own.map(|(own, value)| format!("{} = {}\n", key(&own.name), number(value)));
        let fixed = table("fixed", setting, wanted) + &own.collect::<String>();
        return named + &fixed + &units_text(units);
    }
    let fixed = |p: Parameter| wanted(p) && p.group() != Group::Law;
    let mut text = table("fixed", setting, fixed);
    if let Some(law) = setting.law() {
        text += &table("friction", setting, |p| {
            wanted(p) && p.group() == Group::Law
        });
        text += &format!("law = \"{}\"\n", law.name());
        if let LawKind::Formula(formula) = law {
            let of_formula = TableColumn::MuK.name();
            text += &format!("{of_formula} = {}\n", quoted(formula.text()));
            for (own, value) in setting.own().filter(|(_, value)| !value.is_nan()) {
                text += &format!("{} = {}\n", key(&own.name), number(value));
            }
            text += &own_units(setting);
        }
        if let LawKind::Table(points) = law {
            for (column, values) in [
                (TableColumn::Speeds, points.speeds()),
                (TableColumn::MuK, points.mu_k()),
            ] {
                let values: Vec<String> = values.iter().map(|&value| number(value)).collect();
                text += &format!("{} = [{}]\n", column.name(), values.join(", "));
            }
        }
        text += &setting.fit_errors().map_or_else(String::new, fit_text);
    }
    text += &units_text(units);
    text.trim_start().to_owned()
}

/// The units of own parameters, as a key of `[friction]`; empty where none has a unit.
fn own_units(setting: &Setting) -> String {
    let measured = setting.own().filter(|(own, _)| own.dimension != [0; 3]);
    let units: Vec<String> = measured
        .map(|(own, _)| format!("{} = {}", key(&own.name), quoted(&own.unit)))
        .collect();
    match units.is_empty() {
        true => String::new(),
        false => format!("{UNITS} = {{ {} }}\n", units.join(", ")),
    }
}

/// What a fit says of the law, as the table `[friction.fit]`.
fn fit_text(of: &FitErrors) -> String {
    let list = |items: Vec<String>| format!("[{}]", items.join(", "));
    let numbers = |of: &[f64]| list(of.iter().map(|&value| number(value)).collect());
    let names = of.errors().filter_map(|(of, _)| match of {
        FittedNumber::Parameter(parameter) => Some(quoted(parameter.name())),
        FittedNumber::Point(_) => None,
    });
    let names: Vec<String> = names.collect();
    let errors: Vec<f64> = of.errors().map(|(_, error)| error).collect();
    let rows = of.correlations().iter().map(|row| numbers(row)).collect();
    let mut text = format!("\n[friction.{FIT}]\n");
    if !names.is_empty() {
        text += &format!("{PARAMETERS} = {}\n", list(names));
    }
    text += &format!("{STANDARD_ERRORS} = {}\n", numbers(&errors));
    text += &format!("{CORRELATIONS} = {}\n", list(rows));
    text += &format!("{COVERAGE_FACTOR} = {}\n", number(of.coverage_factor()));
    if of.between_laws() > 0.0 {
        text += &format!("{BETWEEN_LAWS} = {}\n", number(of.between_laws()));
    }
    text
}

fn units_text(units: &Units) -> String {
    match &units.force_length_time {
        None => String::new(),
        Some(names) => {
            let keys = ["force", "length", "time"].iter().zip(names);
            let lines: String = keys
                .map(|(key, name)| format!("{key} = \"{name}\"\n"))
                .collect();
            format!("\n[units]\n{lines}")
        }
    }
}
