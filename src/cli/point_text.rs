//! What `slipmap point` prints for people.

use std::io::Write;

use crate::explore::margin_kind::MarginKind;
use crate::explore::point::{BlockPoint, Point, SystemPoint};
use crate::explore::stability::{Spectrum, Stability};
use crate::report::numbers::unit_behind;
use crate::setting::units::Units;
use crate::setting::{Field, Parameter, Setting};
use crate::sweep::relaxation_time;
use crate::text::{Shown, finite};

use super::asked::{Asked, subject};
use super::margins::of_fit;
use super::output::tell_dimensionless;

/// Number of stable intervals printed for people; the JSON output has all, up to a hundred
/// thousand.
const INTERVALS_SHOWN: usize = 12;

/// A number with about twelve digits, for a table.
fn digits(value: f64) -> String {
    match value.abs() {
        f64::INFINITY => "infinity".into(),
        0.0 => "0".into(),
        1e-4..1e6 => format!("{value:.12}"),
        _ => format!("{value:.11e}"),
    }
}

fn print_spectrum(
    spectrum: &Spectrum,
    units: &Units,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let certified = match (spectrum.certified, finite(spectrum.certificate_margin)) {
        (true, Some(margin)) => format!(
            "yes: no root farther right than abscissa + {margin:e} max(1/sqrt(M/kappa), \
            |abscissa|)"
        ),
        _ => "no".into(),
    };
    row("certified", certified)?;
    let head = [
        ("re lambda", units.rate()),
        ("im lambda", units.angular_frequency()),
        ("relaxation time", units.time()),
    ];
    let title = |(title, unit): (&str, String)| {
        let title = format!("{title}{}", unit_behind(&unit));
        format!("{title:>22}")
    };
    row("roots", head.map(title).concat())?;
    for [re, im] in &spectrum.roots {
        let pair = if *im == 0.0 { "" } else { "±" };
        let cells = [
            digits(*re),
            format!("{pair}{}", digits(*im)),
            digits(relaxation_time(*re)),
        ];
        row("", cells.map(|cell| format!("{cell:>22}")).concat())?;
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
        (false, false, _) => "unstable",
    }
}

/// Prints a point for people.
pub(super) fn print(out: &mut impl Write, point: &Point, asked: &Asked) -> std::io::Result<()> {
    let (units, stability) = (&asked.units, point.stability());
    let subject = subject(&asked.setting, "continuous sliding");
    writeln!(out, "{subject} is {}", verdict(stability))?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    match point {
        Point::Block(point) => {
            print_block(point, asked, &mut row)?;
            print_stability(stability, true, units, &mut row)?;
            if let Some(fit) = &point.margins.fit {
                row("fit", of_fit(fit, &point.margins, units))?;
            }
            tell_dimensionless(out, units)
        }
        Point::System(point) => {
            print_system(point, &asked.setting, &mut row)?;
            print_stability(stability, point.line_of_delays, units, &mut row)
        }
    }
}

/// What is told of the block besides its stability.
fn print_block(
    point: &BlockPoint,
    Asked { setting, units, .. }: &Asked,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let given = [
        (Parameter::MuPrime, point.mu_prime),
        (Parameter::MuK, point.mu_k),
        (Parameter::AlphaV, point.alpha_v),
        (Parameter::AlphaN, point.alpha_n),
        (Parameter::Tau, point.tau),
    ];
    let beyond = Parameter::ALL.into_iter().filter(|p| p.absent_by_default());
    let beyond = beyond
        .filter(|parameter| setting.uses(*parameter))
        .map(|parameter| (parameter, setting.get(parameter)));
    for (parameter, value) in given.into_iter().chain(beyond) {
        let unit = unit_behind(&units.of_parameter(parameter));
        row(parameter.name(), format!("{}{unit}", Shown(value)))?;
    }
    match point.stiffness_ratio {
        Some(ratio) => row(Field::StiffnessRatio.name(), Shown(ratio).to_string()),
        None => Ok(()),
    }
}

/// What is told of a system from a file besides its stability.
fn print_system(
    point: &SystemPoint,
    setting: &Setting,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    for (name, text) in setting.system().iter().flat_map(|s| s.expressions()) {
        row(name, text.split_whitespace().collect::<Vec<_>>().join(" "))?;
    }
    for (own, value) in setting.own() {
        let unit = unit_behind(&own.unit);
        row(&own.name, format!("{}{unit}", Shown(value)))?;
    }
    for parameter in setting.others() {
        row(parameter.name(), Shown(setting.get(*parameter)).to_string())?;
    }
    if !point.line_of_delays {
        row(
            "delays",
            "P or Q depends on tau: this one alone is known".into(),
        )?;
    }
    if point.memory.is_none() {
        return Ok(());
    }
    let margin = finite(point.latency_margin);
    let margin = margin.map_or("infinite, or not known".into(), |m| Shown(m).to_string());
    row("latency_margin", margin)
}

/// Prints the stability of a point; results for other delays only if these are known.
fn print_stability(
    stability: &Stability,
    line_of_delays: bool,
    units: &Units,
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
    let time = unit_behind(&units.time());
    let margin = match finite(stability.delay_margin) {
        Some(margin) => format!("{}{time}", Shown(margin)),
        None if stability.delay_margin_kind == MarginKind::Infinite => {
            "infinite: no delay changes stability".into()
        }
        None => "unknown".into(),
    };
    if line_of_delays {
        row("delay_margin", margin)?;
    }
    let spectrum = &stability.spectrum;
    for (name, value, unit) in [
        (Field::Abscissa.name(), spectrum.abscissa, units.rate()),
        (
            Field::Frequency.name(),
            spectrum.frequency,
            units.angular_frequency(),
        ),
    ] {
        let unit = unit_behind(&unit);
        let text = finite(value).map_or("unknown".into(), |v| format!("{}{unit}", Shown(v)));
        row(name, text)?;
    }
    if let Some(essential) = finite(stability.essential_abscissa) {
        let unit = unit_behind(&units.rate());
        row(
            "essential",
            format!("{}{unit}: roots accumulate there", Shown(essential)),
        )?;
    }
    if line_of_delays {
        print_delays(stability, units, &mut row)?;
    }
    print_spectrum(spectrum, units, &mut row)
}

/// The crossings of the point's line, and its stable delays.
fn print_delays(
    stability: &Stability,
    units: &Units,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let time = unit_behind(&units.time());
    for crossing in stability.crossings.iter().flatten() {
        let direction = match crossing.direction {
            "touch" => "none: a touch".to_owned(),
            side => format!("to the {side}"),
        };
        let text = format!(
            "{direction} at omega = {}{}, tau = {}{time} + k {}{time}",
            Shown(crossing.omega),
            unit_behind(&units.angular_frequency()),
            Shown(crossing.first_delay),
            Shown(std::f64::consts::TAU / crossing.omega)
        );
        row("crossing", text)?;
    }
    let Some(intervals) = &stability.stable_delays else {
        return row("stable delays", "unknown".into());
    };
    if intervals.is_empty() {
        row("stable delays", "none".into())?;
    }
    for interval in intervals.iter().take(INTERVALS_SHOWN) {
        let end =
            finite(interval[1]).map_or("infinity".into(), |to| format!("{}{time}", Shown(to)));
        let from = Shown(interval[0]);
        row("stable delays", format!("{from}{time} < tau < {end}"))?;
    }
    match intervals.len().saturating_sub(INTERVALS_SHOWN) {
        more if stability.stable_delays_truncated => {
            row("", format!("and more than {more} further intervals"))
        }
        0 => Ok(()),
        more => row(
            "",
            format!("and {more} further intervals (--json lists them)"),
        ),
    }
}
