//! The line with which answers about a block begin: what was asked, as it was understood, with the
//! period and the force that follow from it.

use std::f64::consts::TAU;
use std::io::Write;

use crate::report::numbers::{rounded, unit_behind};
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};

/// Digits after the first one of inputs, and of what follows from them.
const DIGITS: [usize; 2] = [8, 5];

/// Writes the line for a setting, without the parameters `left_out`; nothing for a system from a
/// file. Where there are no units, parameters at their defaults are left out as well.
pub(super) fn print(
    out: &mut impl Write,
    setting: &Setting,
    units: &Units,
    left_out: &[Parameter],
) -> std::io::Result<()> {
    print_with(out, setting, units, left_out, &[])
}

/// The same with inputs `more` that are no parameters, by name.
pub(super) fn print_with(
    out: &mut impl Write,
    setting: &Setting,
    units: &Units,
    left_out: &[Parameter],
    more: &[(&str, String)],
) -> std::io::Result<()> {
    if setting.system().is_some() {
        return Ok(());
    }
    let told = |&p: &Parameter| {
        let usual = units.dimensionless() && p.default_value() == Some(setting.get(p));
        setting.uses(p) && !left_out.contains(&p) && !usual
    };
    let given = Parameter::ALL.into_iter().filter(told);
    let law = setting.law().map(|law| ("friction", law.name().to_owned()));
    let given = given.map(|p| (p.name(), value(setting, units, p)));
    let formula = setting.formula().map(|of| ("mu_k", in_one_line(of.text())));
    let own = setting.own().map(|(own, value)| {
        let value = rounded(value, DIGITS[0]) + &unit_behind(&own.unit);
        (&*own.name, value)
    });
    let inputs: Vec<String> = given
        .chain(law)
        .chain(formula)
        .chain(own)
        .chain(more.iter().map(|(name, value)| (*name, value.clone())))
        .map(|(name, value)| format!("{name} = {value}"))
        .collect();
    let sliding = !left_out.contains(&Parameter::V0);
    let follows = [period(setting, units), force(setting, units, sliding)];
    let follows: Vec<String> = follows.into_iter().flatten().collect();
    writeln!(out, "inputs: {}; {}", inputs.join(", "), follows.join(", "))
}

/// A text without the breaks of its lines.
fn in_one_line(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ")
}

/// The value of a parameter with its unit.
fn value(setting: &Setting, units: &Units, of: Parameter) -> String {
    rounded(setting.get(of), DIGITS[0]) + &unit_behind(&units.of_parameter(of))
}

/// The period of the block on its spring without friction and control.
fn period(setting: &Setting, units: &Units) -> Option<String> {
    let period = TAU * setting.oscillator().ok()?.time_unit();
    let (period, unit) = (rounded(period, DIGITS[1]), unit_behind(&units.time()));
    Some(format!(
        "free period 2 pi sqrt(mass/stiffness) = {period}{unit}"
    ))
}

/// The force of friction while sliding at v0, or else the largest one of sticking.
fn force(setting: &Setting, units: &Units, sliding: bool) -> Option<String> {
    let load = setting.get(Parameter::NormalLoad);
    let (name, mu) = match sliding {
        true => ("friction force mu_k", setting.sliding_point().ok()?.mu_k),
        false => (
            "static friction force mu_s",
            setting.friction_law().ok()??.mu_s(),
        ),
    };
    let unit = unit_behind(&units.of_parameter(Parameter::NormalLoad));
    Some(format!(
        "{name} normal_load = {}{unit}",
        rounded(mu * load, DIGITS[1])
    ))
}
