//! The outcome of a motion, in words and numbers for people.

use std::io::Write;

use crate::answers::Trace;
use crate::report::numbers::{grouped, unit_behind};
use crate::setting::units::Units;
use crate::setting::{CaseSpec, Field};
use crate::slip::motion::MOST_KEPT;
use crate::slip::outcome::{Outcome, Summary};
use crate::text::Shown;

use super::inputs_line;
use super::output::tell_dimensionless;

/// Number of events printed for people, the last ones; the JSON output and the trace have all.
const EVENTS_SHOWN: usize = 12;

/// Writes the outcome of a motion, its numbers and its last events.
pub(super) fn print(out: &mut impl Write, spec: &CaseSpec, trace: &Trace) -> std::io::Result<()> {
    let (summary, units) = (&trace.summary, &spec.units);
    inputs_line::print(out, &spec.setting, units, &[])?;
    writeln!(out, "{}", verdict(summary, spec))?;
    for (name, value) in numbers(summary, units) {
        writeln!(out, "  {name:<16} {value}")?;
    }
    writeln!(out, "  {:<16} {}", "steps", summary.steps)?;
    tell_dimensionless(out, units)?;
    let events = &trace.events;
    let hidden = events.len().saturating_sub(EVENTS_SHOWN);
    if events.is_empty() {
        return Ok(());
    }
    let [t, a] = [("t", [0, 0, 1]), ("a", [0, 1, 0])]
        .map(|(name, dimension)| format!("{name}{}", unit_behind(&units.of(dimension))));
    writeln!(out, "{t:>18}{a:>18}  event")?;
    if hidden > 0 {
        writeln!(
            out,
            "{hidden:>18} earlier ones, in the trace and with --json"
        )?;
    }
    for event in &events[hidden..] {
        let (t, a) = (digits(event.t), digits(event.a));
        writeln!(out, "{t:>18}{a:>18}  {}", event.name())?;
    }
    Ok(())
}

/// The finite numbers of a motion, by name, with their units.
pub(super) fn numbers(summary: &Summary, units: &Units) -> Vec<(&'static str, String)> {
    let finite = summary.numbers().into_iter();
    let finite = finite.filter(|(_, value)| value.is_finite());
    let told = finite.map(|(name, value)| {
        let field = Field::from_name(name).map(|field| field.unit(units));
        let unit = unit_behind(&field.unwrap_or_else(|| units.time()));
        let name = if name == "decided" {
            "decided at"
        } else {
            name
        };
        (name, format!("{}{unit}", digits(value)))
    });
    told.collect()
}

/// A number with ten digits, whatever its size.
fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size @ 1e-4..1e6 => {
            // Digits are counted after rounding: 9.9999999999 becomes a number with two digits
            // before the point.
            let rounded = format!("{size:.9e}");
            let exponent = rounded
                .split('e')
                .nth(1)
                .and_then(|e| e.parse::<i32>().ok());
            let behind = usize::try_from(9 - exponent.unwrap_or(0)).unwrap_or(0);
            format!("{value:.behind$}")
        }
        _ => format!("{value:.9e}"),
    }
}

/// The outcome of the motion, in words.
fn verdict(summary: &Summary, spec: &CaseSpec) -> String {
    match summary.outcome {
        Outcome::Sliding => "the block comes to slide continuously".into(),
        Outcome::StickSlip => "the block sticks and slips periodically".into(),
        Outcome::Oscillation => "the block oscillates periodically without sticking".into(),
        Outcome::LiftOff => "the block lifts off: the load reaches 0, where the model ends".into(),
        Outcome::Diverged => "the motion grows beyond all bounds".into(),
        Outcome::Undecided if summary.steps >= spec.case.steps => {
            format!("undecided after {} steps", grouped(summary.steps))
        }
        Outcome::Undecided if summary.decided < spec.case.horizon => format!(
            "undecided at t = {}: two delays take more than {MOST_KEPT} steps, the most that are \
             kept, or friction has no coefficient at a speed of the block",
            digits(summary.decided)
        ),
        Outcome::Undecided => format!("undecided at the horizon, t = {}", Shown(spec.case.horizon)),
        Outcome::NoCycle => "there is no uncontrolled stick-slip to start from".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_ten_digits() {
        for (value, text) in [
            (0.0, "0"),
            (-0.5, "-0.5000000000"),
            (61.931764, "61.93176400"),
            (9.99999999999, "10.00000000"),
            (0.000123456789012, "0.0001234567890"),
            (123456.7890123, "123456.7890"),
            (1e7, "1.000000000e7"),
        ] {
            assert_eq!(digits(value), text);
        }
    }
}
