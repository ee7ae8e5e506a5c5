//! `slipmap point`: everything about one point of parameter space.

use std::io::Write;
use std::path::{Path, PathBuf};

use slipmap::explore::along_delay::AlongDelay;
use slipmap::explore::margin_kind::MarginKind;
use slipmap::explore::point::Point;
use slipmap::explore::stability::{Spectrum, Stability, Wanted};
use slipmap::explore::system_point::SystemPoint;
use slipmap::linear::general::Reason;
use slipmap::model::Shown;
use slipmap::model::stop::Stop;
use slipmap::report::numbers::unit_behind;
use slipmap::report::picture::{self, Picture, PointPicture};
use slipmap::sweep::input::system::{Evaluation, SystemModel};
use slipmap::sweep::input::units::Units;
use slipmap::sweep::{Field, Parameter, Setting, relaxation_time};

use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::output::{check_picture, tell_dimensionless};
use super::point_args::PointArgs;
use super::say::ForPeople;
use super::system_args::{OTHERS, SystemArgs};
use super::{point_system, say};

/// Number of roots in a picture, with pairs counted once: enough to see their pattern.
const ROOTS_DRAWN: u8 = 14;

/// The largest real part of a line to the right of which roots are counted.
const LARGEST_LINE: f64 = 1e12;

/// Number of stable intervals printed for people; the JSON output has all, up to a hundred
/// thousand.
const INTERVALS_SHOWN: usize = 12;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap point --mu-prime -0.7 --alpha-v -0.3174 --tau 4.313")]
pub(super) struct Args {
    #[command(flatten)]
    point: PointArgs,
    #[command(flatten)]
    system: SystemArgs,
    /// How many characteristic roots to list, from the right; pairs count once
    #[arg(long, value_name = "K", default_value_t = 4, allow_hyphen_values = true,
          value_parser = parse_roots)]
    roots: u8,
    /// Count the roots with a real part greater than SIGMA, in 1/time
    #[arg(long, value_name = "SIGMA", allow_hyphen_values = true, value_parser = parse_line)]
    line: Option<f64>,
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

fn parse_line(text: &str) -> Result<f64, String> {
    let line = text
        .trim()
        .parse()
        .ok()
        .filter(|line: &f64| line.abs() <= LARGEST_LINE);
    line.ok_or_else(|| format!("expected a number of size at most {LARGEST_LINE:e}"))
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

impl Args {
    fn wanted(&self, roots: u8) -> Wanted {
        Wanted {
            roots,
            line: self.line,
        }
    }
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("point").or::<Point>().or::<SystemPoint>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    if let Some(named) = &args.system.system {
        args.point.check_alone("--system", &OTHERS)?;
        return match args.system.read(|p| args.point.given(p))? {
            Some((model, at)) => of_system(args, (&model, at), ("system", named)),
            None => Ok(()),
        };
    }
    if let (Some(setting), Some(map)) = (args.point.cell_of_system()?, args.point.map())
        && let Some(system) = setting.evaluation()
    {
        return of_system(args, system, ("map", &map.display().to_string()));
    }
    if let Some(plot) = &args.plot {
        check_picture("--plot", plot, args.point.map())?;
    }
    let (setting, units) = args.point.read()?;
    let point = Point::at(&setting, args.wanted(args.roots), &Stop::default())?;
    if point.stability.reason == Some(Reason::Refused.name()) {
        return Err(Failure::bad_input_with_help(
            "this system is not answered: |P| = |Q| on all of the imaginary axis",
            "D(lambda) = P(lambda) + Q(lambda) exp(-lambda tau) crosses it everywhere or nowhere",
        ));
    }
    let spectrum = &point.stability.spectrum;
    if let Some(why) = spectrum.fewer.as_ref().filter(|_| spectrum.incomplete) {
        say::remark(format_args!("warning: {why}"));
    }
    if args.json {
        let inputs = Inputs::of_setting(&setting, &units, |_| true).and("roots", args.roots);
        let inputs = match args.line {
            Some(line) => inputs.and("line", line),
            None => inputs,
        };
        json::print(&inputs, &point)?;
    } else {
        print(&mut ForPeople::begin(), (&point, &setting), &units)?;
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

/// Answers for a point of a system from a file; `from` is the flag that gave it, with its value.
fn of_system(
    args: &Args,
    (model, mut at): (&SystemModel, Evaluation),
    from: (&str, &str),
) -> Result<(), Failure> {
    if args.plot.is_some() {
        return Err(Failure::bad_input_with_help(
            "--plot has no picture of a point of a system from a file",
            "a sweep of the system draws its stability; --json has its roots",
        ));
    }
    let point = SystemPoint::at(model, &mut at, args.wanted(args.roots));
    let point = point.map_err(|why| Failure::bad_input(why.to_string()))?;
    let spectrum = &point.stability.spectrum;
    if let Some(why) = spectrum.fewer.as_ref().filter(|_| spectrum.incomplete) {
        say::remark(format_args!("warning: {why}"));
    }
    if args.json {
        let inputs = point_system::inputs(from, &point, args.roots, args.line);
        return json::print(&inputs, &point);
    }
    Ok(point_system::print(
        &mut ForPeople::begin(),
        model,
        &at,
        &point,
    )?)
}

/// Draws the point with the number of roots for a picture; with those of `listed` if some of the
/// others are not found.
fn draw(setting: &Setting, units: &Units, listed: &Point, path: &Path) -> Result<(), Failure> {
    let wanted = Wanted {
        roots: ROOTS_DRAWN,
        line: None,
    };
    let more = Point::at(setting, wanted, &Stop::default())?;
    let point = if more.stability.spectrum.incomplete {
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

/// Whether the point is stable, in words.
pub(super) fn verdict(stability: &Stability) -> &'static str {
    match (stability.stable, stability.marginal, stability.reason) {
        (_, true, _) => "marginal: within rounding of a stability boundary",
        (true, false, _) => "stable",
        (false, false, Some("degree-unknown")) => "not known to be stable or not",
        (false, false, _) => "unstable",
    }
}

fn print(
    out: &mut impl Write,
    (point, setting): (&Point, &Setting),
    units: &Units,
) -> std::io::Result<()> {
    let stability = &point.stability;
    writeln!(out, "continuous sliding is {}", verdict(stability))?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    let given = [
        (Parameter::MuPrime, point.mu_prime),
        (Parameter::MuK, point.mu_k),
        (Parameter::AlphaV, point.alpha_v),
        (Parameter::AlphaN, point.alpha_n),
        (Parameter::Tau, point.tau),
    ];
    let beyond = Parameter::BEYOND_LETTER.map(|parameter| (parameter, setting.get(parameter)));
    let beyond = beyond
        .into_iter()
        .filter(|(parameter, _)| setting.uses(*parameter));
    for (parameter, value) in given.into_iter().chain(beyond) {
        let unit = unit_behind(&units.of_parameter(parameter));
        row(parameter.name(), format!("{}{unit}", Shown(value)))?;
    }
    if let Some(ratio) = point.stiffness_ratio {
        row(Field::StiffnessRatio.name(), Shown(ratio).to_string())?;
    }
    print_stability(stability, true, units, &mut row)?;
    tell_dimensionless(out, units)
}

/// Prints the stability of a point; results for other delays only if these are known.
pub(super) fn print_stability(
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
    let margin = match stability.delay_margin {
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
        let text = value.map_or("unknown".into(), |v| format!("{}{unit}", Shown(v)));
        row(name, text)?;
    }
    if let Some(essential) = stability.essential_abscissa {
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
        let end = interval[1].map_or("infinity".into(), |to| format!("{}{time}", Shown(to)));
        let from = Shown(interval[0].unwrap_or(0.0));
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
