//! `slipmap margins`: how far a setting is from the boundary of stability.

use std::io::Write;

use crate::explore::margins::{Margin, Margins, StabilityBox, StableShare};
use crate::explore::point::Point;
use crate::explore::stability::{Stability, Wanted};
use crate::model::stop::Stop;
use crate::report::numbers::{counted, rounded, unit_behind};
use crate::setting::amount::Amount;
use crate::setting::law_kind::LawKind;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::text::{Shown, finite};

use super::failure::Failure;
use super::inputs_line;
use super::json::{self, AnswerSchema};
use super::output::tell_dimensionless;
use super::parameter_values::{amount_of, in_units};
use super::point_args::PointArgs;
use super::say::ForPeople;

#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: slipmap margins --mu-prime -0.3 --alpha-n -3.65 --tau 0.465 --decay 0.1"
)]
pub(super) struct Args {
    #[command(flatten)]
    point: PointArgs,
    /// The decay rate that all roots have to have, 1/time; 0 asks for stability
    #[arg(long, value_name = "RATE", default_value = "0", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::AlphaV))]
    decay: Amount,
    /// One JSON object on standard output; infinities are null
    #[arg(long)]
    json: bool,
}

/// The largest decay rate that can be asked for.
const LARGEST_DECAY: f64 = 1e12;

/// What its JSON looks like.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("margins").or::<Margins>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let asked = args.point.read()?;
    let setting = &asked.setting;
    let decay = args.decay(&asked.units)?;
    let Some(margins) = Margins::at(setting, decay, &Stop::default())? else {
        let of = setting.law().map_or("a system from a file".into(), |law| {
            format!("the {} law", law.name())
        });
        return Err(Failure::bad_input_with_help(
            format!("margins of {of} are not known: a law of the velocity alone is needed"),
            "slipmap point gives its delay margin and, with --json, its latency margin",
        ));
    };
    if args.json {
        let inputs = asked.inputs(|_| true).and("decay", decay);
        return json::print(&inputs, &margins);
    }
    let wanted = Wanted {
        roots: 1,
        line: Some(-decay).filter(|line| *line < 0.0),
    };
    let violations = match margins.decays {
        true => None,
        false => violations(Point::at(setting, wanted, &Stop::default())?.stability()),
    };
    let mut out = ForPeople::begin();
    inputs_line::print(&mut out, setting, &asked.units, &[])?;
    Ok(print(
        &mut out,
        &margins,
        violations,
        setting,
        &asked.units,
    )?)
}

impl Args {
    /// The required decay rate in `units`.
    fn decay(&self, units: &Units) -> Result<f64, Failure> {
        let decay = in_units("--decay", &self.decay, units)?;
        if (0.0..=LARGEST_DECAY).contains(&decay) {
            return Ok(decay);
        }
        let message = format!("--decay {} is outside its range", Shown(decay));
        Err(Failure::bad_input_with_help(
            message,
            "a decay rate, from 0 to 1e12",
        ))
    }
}

/// The number of roots on the wrong side: of the line, where one is asked for, else of the
/// imaginary axis. None where that is not known, or within rounding of a boundary.
pub(super) fn violations(stability: &Stability) -> Option<u64> {
    let known = match stability.line {
        Some(_) => stability.n_right_of_line,
        None => stability.n_unstable.filter(|_| !stability.marginal),
    };
    known.filter(|count| *count > 0)
}

/// Why there are no margins: the number of roots on the wrong side, if it is known.
fn without_margins(margins: &Margins, violations: Option<u64>, rate: &str) -> String {
    let required = margins.required_decay;
    let decay = Shown(required);
    let why = match violations.map(|n| counted(n, "root")) {
        Some(roots) if required == 0.0 => format!("unstable ({roots})"),
        Some(roots) => {
            format!("not left of -{decay}{rate} with all its roots ({roots} right of it)")
        }
        None if required == 0.0 => "not known to be stable".to_owned(),
        None => format!("not known to be left of -{decay}{rate} with all its roots"),
    };
    format!("continuous sliding is {why}: no margins")
}

/// The margins in lines of words and numbers; without margins the number of roots that forbid them.
pub(super) fn print(
    out: &mut impl Write,
    margins: &Margins,
    violations: Option<u64>,
    setting: &Setting,
    units: &Units,
) -> std::io::Result<()> {
    let rate = unit_behind(&units.rate());
    if !margins.decays {
        writeln!(out, "{}", without_margins(margins, violations, &rate))?;
        return match &margins.fit {
            Some(fit) => writeln!(out, "  {:<16} {}", "fit", of_fit(fit, margins, units)),
            None => Ok(()),
        };
    }
    let wanted = match margins.required_decay {
        0.0 => "stable".to_owned(),
        decay => format!("left of -{}{rate} with all its roots", Shown(decay)),
    };
    writeln!(out, "continuous sliding is {wanted}; it stays so")?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    let undecided = |name: &str| margins.undecided.contains(&name);
    let looked = &margins.looked_up_to;
    if let Some(gain) = margins.gain_margin {
        let lower = match gain.lower > 0.0 {
            true => gain.lower,
            false => f64::NAN,
        };
        let text = match (lower, gain.upper) {
            ends if undecided("gain_margin") => known(ends, " times as large"),
            (lower, upper) => between(lower, upper, " times as large"),
        };
        row("gain_margin", text + &up_to(looked.gain_margin, " times"))?;
    }
    for (parameter, margin, last) in [
        (Parameter::Tau, margins.tau_margin, looked.tau_margin),
        (Parameter::MuPrime, margins.mu_prime_margin, f64::NAN),
        (Parameter::V0, margins.v0_margin, looked.v0_margin),
    ] {
        let Some(margin) = margin else { continue };
        let name = format!("{}_margin", parameter.name());
        let unit = unit_behind(&units.of_parameter(parameter));
        let text = match undecided(&name) {
            true => known((margin.from, margin.to), &unit),
            false => along(&margin, setting.get(parameter), &unit),
        };
        row(&name, text + &up_to(last, &unit))?;
    }
    print_loop(&mut row, margins, units)?;
    if let Some(found) = &margins.stability_box {
        let of = of_what_is_given(setting);
        let told = match margins.stability_radius.is_nan() {
            true => "not decided".into(),
            false => radius(margins.stability_radius, found, of),
        };
        row("stability_radius", told)?;
    }
    if let Some(fit) = &margins.fit {
        row("fit", of_fit(fit, margins, units))?;
    }
    tell_dimensionless(out, units)
}

/// The end that is known of a margin whose other end is not decided.
fn known((lower, upper): (f64, f64), unit: &str) -> String {
    match (finite(lower), finite(upper)) {
        (Some(lower), None) => format!(
            "from {}{unit} on; the upper end is not decided",
            rounded(lower, 9)
        ),
        (None, Some(upper)) => format!(
            "up to {}{unit}; the lower end is not decided",
            rounded(upper, 9)
        ),
        _ => "not decided".into(),
    }
}

/// The phase margin and the latency margin.
fn print_loop(
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
    margins: &Margins,
    units: &Units,
) -> std::io::Result<()> {
    let time = unit_behind(&units.time());
    let last = margins.looked_up_to.latency_margin;
    for (name, value, unit, endless) in [
        (
            "phase_margin",
            margins.phase_margin,
            " rad",
            "infinite: the loop is nowhere as large as 1",
        ),
        (
            "latency_margin",
            margins.latency_margin,
            &*time,
            "infinite: no latency matters",
        ),
    ] {
        let text = match finite(value) {
            _ if margins.undecided.contains(&name) => "not decided".into(),
            Some(value) => format!("{}{unit}", rounded(value, 8)),
            None if name == "latency_margin" && last.is_finite() => {
                format!("no latency matters{}", up_to(last, unit))
            }
            None => endless.to_owned(),
        };
        row(name, text)?;
    }
    Ok(())
}

/// Up to where an end was looked for that was not found.
fn up_to(last: f64, unit: &str) -> String {
    finite(last).map_or_else(String::new, |last| {
        format!("; looked at up to {}{unit}", rounded(last, 8))
    })
}

fn between(lower: f64, upper: f64, unit: &str) -> String {
    let digits = |end| finite(end).map(|end| rounded(end, 8));
    match (digits(lower), digits(upper)) {
        (None, None) => "whatever it is".into(),
        (None, Some(upper)) => format!("up to {upper}{unit}"),
        (Some(lower), None) => format!("from {lower}{unit} on"),
        (Some(lower), Some(upper)) => format!("from {lower} to {upper}{unit}"),
    }
}

/// The range of a parameter, and how far its ends are.
fn along(margin: &Margin, at: f64, unit: &str) -> String {
    let range = between(margin.from, margin.to, unit);
    let share = |distance: f64| match at {
        0.0 => String::new(),
        at => format!(", {:.1} %", 100.0 * (distance / at).abs()),
    };
    let away = |sign: &str, distance| {
        finite(distance).map(|d| format!("{sign}{}{unit}{}", rounded(d, 5), share(d)))
    };
    let ways: Vec<String> = [away("-", margin.lower), away("+", margin.upper)]
        .into_iter()
        .flatten()
        .collect();
    match ways.is_empty() {
        true => range,
        false => format!("{range} ({})", ways.join("; ")),
    }
}

/// What the errors of a fitted law leave open.
pub(super) fn of_fit(fit: &StableShare, margins: &Margins, units: &Units) -> String {
    let has = match margins.required_decay {
        0.0 => "stable",
        _ => "so",
    };
    let (rate, slope) = (units.rate(), units.of_parameter(Parameter::MuPrime));
    let mut text = format!(
        "{has} for {} % of {} friction laws that the points allow; the worst, with mu_prime = \
         {}{}, has abscissa {}{}",
        rounded(100.0 * fit.share, 3),
        fit.draws,
        rounded(fit.worst_mu_prime, 4),
        unit_behind(&slope),
        rounded(fit.worst_abscissa, 4),
        unit_behind(&rate),
    );
    if fit.unknown > 0 {
        text += &format!("; of {} it is not known", fit.unknown);
    }
    text
}

/// Of what friction something is proved, behind that.
pub(super) fn of_what_is_given(setting: &Setting) -> &'static str {
    match setting.law() {
        None => "",
        Some(LawKind::Table(_)) => " of the curve that was given",
        Some(_) => " of the friction law that was given",
    }
}

fn radius(proved: f64, found: &StabilityBox, of: &str) -> String {
    let names = found.of.join(", ");
    let together = if found.of.len() > 1 { " together" } else { "" };
    // Rounded down: more is not proved.
    let percent = (1.0 - 5e-4) * 100.0 * proved;
    let mut text = format!("{} %: {names}{together}, proved{of}", rounded(percent, 3));
    if !found.tight {
        text += "; there may be more";
    }
    if !found.fixed.is_empty() {
        text += &format!("; 0 stays 0: {}", found.fixed.join(", "));
    }
    text
}
