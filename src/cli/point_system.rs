//! `slipmap point --system`: everything about one point of a system from a file.

use std::io::Write;

use slipmap::explore::system_point::SystemPoint;
use slipmap::model::Shown;
use slipmap::sweep::input::system::{Evaluation, SystemModel};
use slipmap::sweep::input::units::Units;

use super::json::Inputs;
use super::point::{print_stability, verdict};

/// The inputs.
pub(super) fn inputs(
    (flag, named): (&str, &str),
    point: &SystemPoint,
    roots: u8,
    line: Option<f64>,
) -> Inputs {
    let mut inputs = Inputs::default()
        .and(flag, named)
        .and("set", &point.parameters)
        .and("tau", point.tau)
        .and("roots", roots);
    let others = [
        ("memory", point.memory),
        ("latency", point.latency),
        ("line", line),
    ];
    for (name, value) in others {
        if let Some(value) = value {
            inputs = inputs.and(name, value);
        }
    }
    inputs
}

/// Prints a point for people.
pub(super) fn print(
    out: &mut impl Write,
    model: &SystemModel,
    at: &Evaluation,
    point: &SystemPoint,
) -> std::io::Result<()> {
    let title = match &*model.title {
        "" => "the system",
        title => title,
    };
    writeln!(out, "{title} is {}", verdict(&point.stability))?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    for (name, text) in model.expressions() {
        row(name, text.split_whitespace().collect::<Vec<_>>().join(" "))?;
    }
    for (own, value) in model.parameters.iter().zip(&at.own) {
        let unit = match &*own.unit {
            "1" => String::new(),
            unit => format!(" {unit}"),
        };
        row(&own.name, format!("{}{unit}", Shown(*value)))?;
    }
    row("tau", Shown(point.tau).to_string())?;
    for (name, value) in [("memory", point.memory), ("latency", point.latency)] {
        if let Some(value) = value {
            row(name, Shown(value).to_string())?;
        }
    }
    if !point.line_of_delays {
        row(
            "delays",
            "P or Q depends on tau: this one alone is known".into(),
        )?;
    }
    if point.memory.is_some() {
        let none = match point.latency_margin {
            Some(margin) => Shown(margin).to_string(),
            None => "infinite, or not known".into(),
        };
        row("latency_margin", none)?;
    }
    print_stability(
        &point.stability,
        point.line_of_delays,
        &Units::default(),
        &mut row,
    )
}
