//! `slipmap point`: everything about one point of parameter space.

use std::io::Write;
use std::path::{Path, PathBuf};

use slipmap::explore::along_delay::AlongDelay;
use slipmap::explore::point::{Point, Spectrum};
use slipmap::report::numbers::unit_behind;
use slipmap::report::picture::{self, Picture, PointPicture};
use slipmap::sweep::input::units::Units;
use slipmap::sweep::{Field, Parameter, Setting, relaxation_time};

use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::output::{check_picture, tell_dimensionless};
use super::point_args::PointArgs;
use super::say;

/// Roots in a picture, pairs counted once: enough to see how they lie.
const ROOTS_DRAWN: u8 = 14;

/// Stable intervals printed for people; the JSON output has them all, up to a hundred thousand.
const INTERVALS_SHOWN: usize = 12;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap point --mu-prime -0.7 --alpha-v -0.3174 --tau 4.313")]
pub(super) struct Args {
    #[command(flatten)]
    point: PointArgs,
    /// How many characteristic roots to list, from the right; pairs count once
    #[arg(long, value_name = "K", default_value_t = 4, allow_hyphen_values = true,
          value_parser = parse_roots)]
    roots: u8,
    /// Draw the roots in the complex plane and the stable delays, as .png, .svg or .pdf
    #[arg(long, value_name = "PICTURE")]
    plot: Option<PathBuf>,
    /// One JSON object on standard output; infinities are null
    #[arg(long)]
    json: bool,
}

fn parse_roots(text: &str) -> Result<u8, String> {
    let count = text.parse().ok().filter(|count| (1..=64).contains(count));
    count.ok_or_else(|| "expected a whole number from 1 to 64".to_owned())
}

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
    let certified = match (spectrum.certified, spectrum.certificate_margin) {
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

/// What its JSON looks like.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("point").or::<Point>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    if let Some(plot) = &args.plot {
        check_picture("--plot", plot, args.point.map())?;
    }
    let (setting, units) = args.point.read()?;
    let point = Point::at(&setting, args.roots)?;
    let spectrum = &point.spectrum;
    if let Some(why) = spectrum.fewer.as_ref().filter(|_| spectrum.incomplete) {
        say::remark(format_args!("warning: {why}"));
    }
    if args.json {
        let inputs = Inputs::of_setting(&setting, &units, |_| true).and("roots", args.roots);
        json::print(&inputs, &point)?;
    } else {
        print(&mut std::io::stdout().lock(), &point, &units)?;
    }
    let Some(plot) = &args.plot else {
        return Ok(());
    };
    draw(&setting, &units, &point, plot)?;
    match args.json {
        true => Ok(()),
        false => say::result(plot.display()),
    }
}

/// Draws the point with the roots of a picture; with those of `listed` where some of the others
/// are not found.
fn draw(setting: &Setting, units: &Units, listed: &Point, path: &Path) -> Result<(), Failure> {
    let more = Point::at(setting, ROOTS_DRAWN)?;
    let point = if more.spectrum.incomplete {
        listed
    } else {
        &more
    };
    let along = AlongDelay::of(setting)?;
    let drawn = PointPicture {
        point,
        along: &along,
        units,
    };
    let picture = picture::draw_point(&drawn, path);
    let saved = picture.and_then(Picture::save);
    saved.map_err(|error| Failure::failed(error.to_string()))
}

fn print(out: &mut impl Write, point: &Point, units: &Units) -> std::io::Result<()> {
    let verdict = match (point.stable, point.marginal) {
        (_, true) => "marginal: within rounding of a stability boundary",
        (true, false) => "stable",
        (false, false) => "unstable",
    };
    writeln!(out, "continuous sliding is {verdict}")?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    for (parameter, value) in [
        (Parameter::MuPrime, point.mu_prime),
        (Parameter::MuK, point.mu_k),
        (Parameter::AlphaV, point.alpha_v),
        (Parameter::AlphaN, point.alpha_n),
        (Parameter::Tau, point.tau),
    ] {
        let unit = unit_behind(&units.of_parameter(parameter));
        row(parameter.name(), format!("{value}{unit}"))?;
    }
    row("n_unstable", point.n_unstable.to_string())?;
    let time = unit_behind(&units.time());
    let margin = match point.delay_margin {
        Some(margin) => format!("{margin}{time}"),
        None => "infinite: no delay changes stability".into(),
    };
    row("delay_margin", margin)?;
    let spectrum = &point.spectrum;
    for (field, value) in [
        (Field::Abscissa, spectrum.abscissa),
        (Field::Frequency, spectrum.frequency),
    ] {
        let unit = unit_behind(&field.unit(units));
        let text = value.map_or("unknown".into(), |v| format!("{v}{unit}"));
        row(field.name(), text)?;
    }
    print_delays(point, units, &mut row)?;
    print_spectrum(spectrum, units, &mut row)?;
    tell_dimensionless(out, units)
}

/// The crossings of the point's line, and its stable delays.
fn print_delays(
    point: &Point,
    units: &Units,
    mut row: impl FnMut(&str, String) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let time = unit_behind(&units.time());
    for crossing in &point.crossings {
        let text = format!(
            "to the {} at omega = {}{}, tau = {}{time} + k {}{time}",
            crossing.direction,
            crossing.omega,
            unit_behind(&units.angular_frequency()),
            crossing.first_delay,
            std::f64::consts::TAU / crossing.omega
        );
        row("crossing", text)?;
    }
    if point.stable_delays.is_empty() {
        row("stable delays", "none".into())?;
    }
    for interval in point.stable_delays.iter().take(INTERVALS_SHOWN) {
        let end = interval[1].map_or("infinity".into(), |to| format!("{to}{time}"));
        let from = interval[0].unwrap_or(0.0);
        row("stable delays", format!("{from}{time} < tau < {end}"))?;
    }
    let more = point.stable_delays.len().saturating_sub(INTERVALS_SHOWN);
    match more {
        _ if point.stable_delays_truncated => {
            row("", format!("and more than {more} further intervals"))
        }
        0 => Ok(()),
        _ => row(
            "",
            format!("and {more} further intervals (--json lists them)"),
        ),
    }
}
