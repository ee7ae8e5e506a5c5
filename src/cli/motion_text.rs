//! The outcome of a motion, in words and numbers for people.

use std::io::Write;

use crate::answers::Trace;
use crate::report::numbers::{grouped, unit_behind};
use crate::setting::units::Units;
use crate::setting::{CaseSpec, Field};
use crate::slip::motion::MOST_KEPT;
use crate::slip::outcome::{Outcome, Summary};
use crate::text::Shown;

use super::case_facts::CaseFacts;
use super::digits::Digits;
use super::inputs_line;
use super::output::tell_dimensionless;

/// Number of events printed for people, the last ones; the JSON output and the trace have all.
const EVENTS_SHOWN: usize = 12;

/// Writes the outcome of a motion, its numbers and its last events.
pub(super) fn print(
    out: &mut impl Write,
    spec: &CaseSpec,
    trace: &Trace,
    digits: Digits,
) -> std::io::Result<()> {
    let (summary, units) = (&trace.summary, &spec.units);
    writeln!(out, "{}", verdict(summary, spec, digits))?;
    let control = CaseFacts::of(spec).return_map_inputs();
    inputs_line::print_with(out, &spec.setting, units, &[], &control)?;
    for (name, value) in numbers(summary, units, digits) {
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
        let (t, a) = (digits.of(event.t), digits.of(event.a));
        writeln!(out, "{t:>18}{a:>18}  {}", event.name())?;
    }
    Ok(())
}

/// The finite numbers of a motion, by name, with their units.
pub(super) fn numbers(
    summary: &Summary,
    units: &Units,
    digits: Digits,
) -> Vec<(&'static str, String)> {
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
        (name, format!("{}{unit}", digits.of(value)))
    });
    told.collect()
}

/// From when on the velocity stays near v0, in words.
fn settled(summary: &Summary, spec: &CaseSpec, digits: Digits) -> String {
    let since = match spec.case.switch_on.is_finite() {
        true => "switch-on",
        false => "the start",
    };
    match summary.settle_time {
        // What rounding leaves of 0.
        t if t <= 1e-9 * summary.decided => format!("from {since} on"),
        t => {
            let unit = unit_behind(&spec.units.time());
            format!("{}{unit} after {since}", digits.of(t))
        }
    }
}

/// The outcome of the motion, in words.
fn verdict(summary: &Summary, spec: &CaseSpec, digits: Digits) -> String {
    let time = |value: f64| digits.of(value) + &unit_behind(&spec.units.time());
    match summary.outcome {
        Outcome::Sliding => format!(
            "the block comes to slide continuously: within 1 % of v0 {}",
            settled(summary, spec, digits)
        ),
        Outcome::StickSlip => format!(
            "the block sticks and slips periodically, every {}",
            time(summary.period)
        ),
        Outcome::Oscillation => "the block oscillates periodically without sticking".into(),
        Outcome::LiftOff => "the block lifts off: the load reaches 0, where the model ends".into(),
        Outcome::Diverged => "the motion grows beyond all bounds".into(),
        Outcome::Undecided if summary.steps >= spec.case.steps => {
            format!("undecided after {} steps", grouped(summary.steps))
        }
        Outcome::Undecided if summary.decided < spec.case.horizon => format!(
            "undecided at t = {}: two delays take more than {MOST_KEPT} steps, the most that are \
             kept, or friction has no coefficient at a speed of the block",
            digits.of(summary.decided)
        ),
        Outcome::Undecided => format!("undecided at the horizon, t = {}", Shown(spec.case.horizon)),
        Outcome::NoCycle => "there is no uncontrolled stick-slip to start from".into(),
    }
}
