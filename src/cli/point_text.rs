//! What `slipmap point` prints for people.

use std::io::Write;

use crate::explore::margin_kind::MarginKind;
use crate::explore::point::{BlockPoint, Point, SystemPoint};
use crate::explore::stability::{Spectrum, Stability};
use crate::report::numbers::unit_behind;
use crate::report::visible::shortened;
use crate::setting::system::{SpeedAxis, SystemModel, Turn};
use crate::setting::units::Units;
use crate::setting::{Field, Parameter};
use crate::text::{Shown, finite};

use super::asked::{Asked, speed_at, subject};
use super::digits::Digits;
use super::inputs_line;
use super::margins::of_fit;
use super::output::tell_dimensionless;

/// Number of stable intervals printed for people; the JSON output has all, up to a hundred
/// thousand.
const INTERVALS_SHOWN: usize = 12;
/// How wide a column of the table of roots is.
const WIDTH: usize = 24;

fn print_spectrum(
    spectrum: &Spectrum,
    (units, digits, scale): (&Units, Digits, &str),
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let certified = match (spectrum.certified, finite(spectrum.certificate_margin)) {
        (true, Some(margin)) => format!(
            "yes: no root farther right than abscissa + {} max({scale}, |abscissa|)",
            digits.of(margin)
        ),
        _ => "no".into(),
    };
    row("certified", certified)?;
    let head = [
        ("re lambda", units.rate()),
        ("im lambda", units.angular_frequency()),
        ("time constant", units.time()),
    ];
    let title = |(title, unit): (&str, String)| {
        let title = format!("{title}{}", unit_behind(&unit));
        format!("{title:>WIDTH$}")
    };
    row("roots", head.map(title).concat())?;
    for [re, im] in &spectrum.roots {
        let pair = if *im == 0.0 { "" } else { "±" };
        let cells = [
            digits.of(*re),
            format!("{pair}{}", digits.of(*im)),
            digits.of(1.0 / re.abs()),
        ];
        let cells = cells.map(|cell| format!("{cell:>WIDTH$}")).concat();
        let grows = if *re > 0.0 { ", growing" } else { "" };
        row("", cells + grows)?;
    }
    match &spectrum.fewer {
        Some(why) => row("", why.clone()),
        None => Ok(()),
    }
}

/// Whether the point is stable, in words.
fn verdict(stability: &Stability) -> &'static str {
    match (stability.stable, stability.marginal, stability.reason) {
        (_, true, _) => "marginal: within rounding of a stability boundary",
        (true, false, _) => "stable",
        (false, false, Some("degree-unknown")) => "not known to be stable or not",
        (false, false, Some("neutral-limit")) if stability.n_unstable.is_none() => {
            "not known to be stable or not"
        }
        (false, false, _) => "unstable",
    }
}

/// How fast disturbances decay or grow, in words; nothing where that is not known or does not go
/// with the verdict.
fn pace(stability: &Stability, units: &Units, digits: Digits) -> String {
    let told = |does: &str, time: f64| {
        let unit = unit_behind(&units.time());
        format!(
            ": disturbances {does} by a factor e in {}{unit}",
            digits.of(time)
        )
    };
    let abscissa = stability.spectrum.abscissa;
    match (stability.stable, stability.marginal) {
        (true, false) if abscissa < 0.0 => told("decay", -1.0 / abscissa),
        (false, false) if abscissa > 0.0 => told("grow", 1.0 / abscissa),
        _ => String::new(),
    }
}

/// Prints a point for people.
pub(super) fn print(
    out: &mut impl Write,
    point: &Point,
    asked: &Asked,
    digits: Digits,
) -> std::io::Result<()> {
    let (units, stability) = (&asked.units, point.stability());
    let subject = subject(&asked.setting, "continuous sliding");
    let pace = pace(stability, units, digits);
    writeln!(out, "{subject} is {}{pace}", verdict(stability))?;
    inputs_line::print(out, &asked.setting, units, &[])?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    match point {
        Point::Block(point) => {
            print_block(point, asked, digits, &mut row)?;
            let with = (units, digits, "1/sqrt(M/kappa)");
            print_stability(stability, true, with, None, &mut row)?;
            if let Some(fit) = &point.margins.fit {
                row("fit", of_fit(fit, &point.margins, units))?;
            }
            tell_dimensionless(out, units)
        }
        Point::System(point) => {
            print_system(point, asked, digits, &mut row)?;
            let with = (units, digits, "1");
            let speed = speed_of(asked);
            print_stability(stability, point.line_of_delays, with, speed, &mut row)
        }
    }
}

/// The speed of the rotation whose period the delay is, and how it follows from the delay.
type Speed<'a> = Option<(&'a SpeedAxis, Turn)>;

/// The speed of a system from a file; none for all else, and without a known unit of time.
fn speed_of(Asked { setting, units, .. }: &Asked) -> Speed<'_> {
    setting.system()?.speed(units)
}

/// What follows from the friction law of the block: the slope and the coefficient at v0, and the
/// stiffness ratio.
fn print_block(
    point: &BlockPoint,
    Asked { setting, units, .. }: &Asked,
    digits: Digits,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let at_v0 = [
        (Parameter::MuPrime, point.mu_prime),
        (Parameter::MuK, point.mu_k),
    ];
    // Without a law they are inputs.
    let at_v0 = at_v0.into_iter().filter(|_| setting.law().is_some());
    for (parameter, value) in at_v0 {
        let unit = unit_behind(&units.of_parameter(parameter));
        row(parameter.name(), format!("{}{unit}", digits.of(value)))?;
    }
    for (field, value) in [
        (Field::StiffnessRatio, point.stiffness_ratio),
        (Field::SpectralRadius, point.spectral_radius),
    ] {
        if let Some(value) = value {
            row(field.name(), digits.of(value))?;
        }
    }
    Ok(())
}

/// What is told of a system from a file besides its stability.
fn print_system(
    point: &SystemPoint,
    asked: &Asked,
    digits: Digits,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let Asked { setting, units, .. } = asked;
    let system = setting.system().into_iter();
    for (name, text) in system.flat_map(SystemModel::expressions) {
        let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
        row(name, shortened(&line).into_owned())?;
    }
    for (own, value) in setting.own() {
        let unit = unit_behind(&own.unit);
        row(&own.name, format!("{}{unit}", Shown(value)))?;
    }
    for parameter in setting.others() {
        let unit = unit_behind(&units.of_parameter(*parameter));
        let value = Shown(setting.get(*parameter));
        row(parameter.name(), format!("{value}{unit}"))?;
    }
    if let Some((name, speed, unit)) = speed_at(setting, units, point.tau) {
        row(name, format!("{} {unit}", digits.of(speed)))?;
    }
    if !point.line_of_delays {
        row(
            "delays",
            "the system depends on tau: this one alone is known".into(),
        )?;
    }
    if point.memory.is_none() {
        return Ok(());
    }
    let margin = finite(point.latency_margin);
    let time = unit_behind(&units.time());
    let margin = margin.map_or("infinite, or not known".into(), |m| digits.of(m) + &time);
    row("latency_margin", margin)
}

/// Prints the stability of a point; results for other delays only if these are known.
fn print_stability(
    stability: &Stability,
    line_of_delays: bool,
    (units, digits, scale): (&Units, Digits, &str),
    speed: Speed,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let or_unknown = |n: Option<u64>| n.map_or("unknown".into(), |n| n.to_string());
    let n_unstable = match (stability.n_unstable, stability.reason) {
        (None, Some("infinite")) => "infinite".into(),
        (n, _) => or_unknown(n),
    };
    row("n_unstable", n_unstable)?;
    if let Some(reason) = stability.reason {
        row("reason", reason.into())?;
    }
    if let Some(line) = stability.line {
        let line = Shown(line);
        let line = format!("{} of {line}", or_unknown(stability.n_right_of_line));
        row(
            "right of line",
            format!("{line}{}", unit_behind(&units.rate())),
        )?;
    }
    let spectrum = &stability.spectrum;
    print_rightmost(spectrum, (units, digits), &mut row)?;
    let time = unit_behind(&units.time());
    let margin = match finite(stability.delay_margin) {
        Some(margin) => format!("{}{time}", digits.of(margin)),
        None if stability.delay_margin_kind == MarginKind::Infinite => {
            "infinite: no delay changes stability".into()
        }
        None => "unknown".into(),
    };
    if line_of_delays {
        row("delay_margin", margin)?;
    }
    if let Some(essential) = finite(stability.essential_abscissa) {
        let unit = unit_behind(&units.rate());
        row(
            "essential",
            format!("{}{unit}: roots accumulate there", digits.of(essential)),
        )?;
    }
    if line_of_delays {
        print_delays(stability, (units, digits), speed, &mut row)?;
    }
    print_spectrum(spectrum, (units, digits, scale), &mut row)
}

/// The rightmost root: how fast disturbances decay or grow, and how they oscillate.
fn print_rightmost(
    spectrum: &Spectrum,
    (units, digits): (&Units, Digits),
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let abscissa = spectrum.abscissa;
    let constant = match abscissa > 0.0 {
        true => "growth_time",
        false => Field::RelaxationTime.name(),
    };
    for (name, value, unit) in [
        (Field::Abscissa.name(), abscissa, units.rate()),
        (constant, 1.0 / abscissa.abs(), units.time()),
        (
            Field::Frequency.name(),
            spectrum.frequency,
            units.angular_frequency(),
        ),
    ] {
        let unit = unit_behind(&unit);
        let text = match value.is_nan() {
            true => "unknown".into(),
            false => format!("{}{unit}", digits.of(value)),
        };
        row(name, text)?;
    }
    Ok(())
}

/// The stable delays of the point's line, as speeds as well, and its crossings.
fn print_delays(
    stability: &Stability,
    (units, digits): (&Units, Digits),
    speed: Speed,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    print_intervals(stability, (units, digits), &mut row)?;
    if let Some(speed) = speed {
        print_speeds(stability, speed, digits, &mut row)?;
    }
    let time = unit_behind(&units.time());
    for crossing in stability.crossings.iter().flatten() {
        let direction = match crossing.direction {
            "touch" => "none: a touch".to_owned(),
            side => format!("to the {side}"),
        };
        let text = format!(
            "{direction} at omega = {}{}, tau = {}{time} + k {}{time}",
            digits.of(crossing.omega),
            unit_behind(&units.angular_frequency()),
            digits.of(crossing.first_delay),
            digits.of(std::f64::consts::TAU / crossing.omega)
        );
        row("crossing", text)?;
    }
    Ok(())
}

/// The stable delays.
fn print_intervals(
    stability: &Stability,
    (units, digits): (&Units, Digits),
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let time = unit_behind(&units.time());
    let Some(intervals) = &stability.stable_delays else {
        return row("stable delays", "unknown".into());
    };
    if intervals.is_empty() {
        row("stable delays", "none".into())?;
    }
    let text = |[from, to]: [f64; 2]| {
        let unit = if to.is_finite() { &time } else { "" };
        let (from, to) = (digits.of(from), digits.of(to));
        match stability.sample_time {
            Some(_) => format!("{from}{time} <= tau <= {to}{unit}, in whole samples"),
            None => format!("{from}{time} < tau < {to}{unit}"),
        }
    };
    print_each(stability, ("stable delays", "them"), text, row)
}

/// The stable delays as speeds, in the order of the delays.
fn print_speeds(
    stability: &Stability,
    (speed, turn): (&SpeedAxis, Turn),
    digits: Digits,
    row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let (name, unit) = (&speed.name, speed.unit.name());
    let text = |[from, to]: [f64; 2]| {
        let [slowest, fastest] = [to, from].map(|delay| digits.of(turn.over(delay)));
        match (to.is_finite(), from > 0.0) {
            (true, true) => format!("{slowest} {unit} < {name} < {fastest} {unit}"),
            (true, false) => format!("{name} > {slowest} {unit}"),
            (false, true) => format!("{name} < {fastest} {unit}"),
            (false, false) => "all".into(),
        }
    };
    print_each(stability, ("stable speeds", "their delays"), text, row)
}

/// A row of this name for each of the first stable intervals of the delay, and how many more there
/// are. The other word says what of them the JSON lists.
fn print_each(
    stability: &Stability,
    (name, listed): (&str, &str),
    text: impl Fn([f64; 2]) -> String,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let intervals = stability.stable_delays.as_deref().unwrap_or_default();
    for interval in intervals.iter().take(INTERVALS_SHOWN) {
        row(name, text(*interval))?;
    }
    let further = match intervals.len().saturating_sub(INTERVALS_SHOWN) {
        more if stability.stable_delays_truncated => {
            format!("and more than {more} further intervals")
        }
        0 => return Ok(()),
        more => format!("and {more} further intervals (--json lists {listed})"),
    };
    row("", further)
}
