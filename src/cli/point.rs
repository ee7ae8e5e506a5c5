//! `slipmap point`: everything about one point of parameter space.

use std::io::Write;

use serde::Serialize;
use slipmap::linear::rightmost::Rightmost;
use slipmap::linear::stable_delays::StableInterval;
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::sweep::{Parameter, Setting, relaxation_time};

use super::failure::Failure;
use super::parameters::ParameterArgs;
use super::say;

/// Stable intervals printed for people; the JSON output has them all, up to `MOST_INTERVALS`.
const INTERVALS_SHOWN: usize = 12;
/// Near a tangency there can be millions of stable intervals; more than this are cut, and the
/// output says so.
const MOST_INTERVALS: usize = 100_000;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap point --mu-prime -0.7 --alpha-v -0.3174 --tau 4.313")]
pub(super) struct Args {
    #[command(flatten)]
    parameters: ParameterArgs,
    /// How many characteristic roots to list, from the right; pairs count once
    #[arg(long, value_name = "K", default_value_t = 4,
          value_parser = clap::value_parser!(u8).range(1..=64))]
    roots: u8,
    /// One JSON object on standard output; infinities are null
    #[arg(long)]
    json: bool,
}

/// The JSON of a point. Infinite numbers are written as null.
#[derive(Debug, Serialize)]
struct Point {
    mu_prime: f64,
    mu_k: f64,
    alpha_v: f64,
    alpha_n: f64,
    tau: f64,
    n_unstable: u64,
    stable: bool,
    marginal: bool,
    stable_delays: Vec<[Option<f64>; 2]>,
    stable_delays_truncated: bool,
    delay_margin: Option<f64>,
    crossings: Vec<CrossingOut>,
    #[serde(flatten)]
    spectrum: Spectrum,
}

/// The rightmost roots in physical units; null where nothing converged.
#[derive(Debug, Serialize)]
struct Spectrum {
    abscissa: Option<f64>,
    frequency: Option<f64>,
    roots: Vec<[f64; 2]>,
    certified: bool,
    certificate_margin: Option<f64>,
    /// Why there are fewer roots than asked for.
    #[serde(skip)]
    fewer: Option<String>,
    /// Some were not found that are there.
    #[serde(skip)]
    incomplete: bool,
}

impl Spectrum {
    /// The `wanted` rightmost roots, and a remark where some were not found.
    fn new(setting: &Setting, wanted: u8) -> Result<Self, Failure> {
        let (groups, time_unit) = setting.groups()?;
        let tau = setting.get(Parameter::Tau) / time_unit;
        let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
        let found = Rightmost::at(groups, tau, wanted.into(), count);
        let incomplete = found.missing.is_some();
        let roots: Vec<[f64; 2]> = found
            .roots
            .iter()
            .map(|root| [root.lambda.re / time_unit, root.lambda.im / time_unit])
            .collect();
        let fewer = match found.missing {
            Some(missing) => Some(missing.to_string()),
            None if tau == 0.0 => Some("there are no others: the delay is 0".into()),
            None if groups.uncontrolled() => Some("there are no others without control".into()),
            None => Some("no others can be told from -infinity".into()),
        };
        Ok(Self {
            abscissa: roots.first().map(|root| root[0]),
            frequency: roots.first().map(|root| root[1]),
            fewer: fewer.filter(|_| roots.len() < wanted.into()),
            roots,
            certified: found.certified,
            certificate_margin: finite(found.margin),
            incomplete,
        })
    }

    fn print(
        &self,
        mut row: impl FnMut(&str, String) -> std::io::Result<()>,
    ) -> std::io::Result<()> {
        let certified = match (self.certified, self.certificate_margin) {
            (true, Some(margin)) => format!(
                "yes: no root farther right than abscissa + {margin:e} max(1/sqrt(M/kappa), \
                |abscissa|)"
            ),
            _ => "no".into(),
        };
        row("certified", certified)?;
        let head = ["re lambda", "im lambda", "relaxation time"];
        row("roots", head.map(|title| format!("{title:>22}")).concat())?;
        for [re, im] in &self.roots {
            let pair = if *im == 0.0 { "" } else { "±" };
            let cells = [
                digits(*re),
                format!("{pair}{}", digits(*im)),
                digits(relaxation_time(*re)),
            ];
            row("", cells.map(|cell| format!("{cell:>22}")).concat())?;
        }
        match &self.fewer {
            Some(why) => row("", why.clone()),
            None => Ok(()),
        }
    }
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

#[derive(Debug, Serialize)]
struct CrossingOut {
    omega: f64,
    first_delay: f64,
    direction: &'static str,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let setting = args.parameters.setting()?;
    let sliding = setting.sliding_point()?;
    let (groups, time_unit) = setting.groups()?;
    let crossings = Crossings::of(groups).in_physical_time(time_unit);
    let tau = setting.get(Parameter::Tau);
    let count = crossings.count(tau, MarginalTolerance::default());
    let mut intervals = crossings.stable_delays();
    let stable: Vec<StableInterval> = intervals.by_ref().take(MOST_INTERVALS).collect();
    let margin = crossings.delay_margin(tau);
    let point = Point {
        mu_prime: sliding.mu_prime,
        mu_k: sliding.mu_k,
        alpha_v: setting.get(Parameter::AlphaV),
        alpha_n: setting.get(Parameter::AlphaN),
        tau,
        n_unstable: count.n_unstable,
        stable: count.stable(),
        marginal: count.marginal,
        stable_delays: stable
            .iter()
            .map(|s| [Some(s.from), finite(s.to)])
            .collect(),
        stable_delays_truncated: intervals.next().is_some(),
        delay_margin: finite(margin),
        crossings: crossings
            .iter()
            .map(|c| CrossingOut {
                omega: c.omega,
                first_delay: c.delay(c.first_branch),
                direction: match c.direction {
                    slipmap::linear::Direction::Left => "left",
                    slipmap::linear::Direction::Right => "right",
                    slipmap::linear::Direction::Touch => "touch",
                },
            })
            .collect(),
        spectrum: Spectrum::new(&setting, args.roots)?,
    };
    let spectrum = &point.spectrum;
    if let Some(why) = spectrum.fewer.as_ref().filter(|_| spectrum.incomplete) {
        say::remark(format_args!("warning: {why}"));
    }
    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string(&point).map_err(std::io::Error::from)?;
        writeln!(out, "{text}")?;
    } else {
        print(&mut out, &point)?;
    }
    Ok(())
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn print(out: &mut impl Write, point: &Point) -> std::io::Result<()> {
    let verdict = match (point.stable, point.marginal) {
        (_, true) => "marginal: within rounding of a stability boundary",
        (true, false) => "stable",
        (false, false) => "unstable",
    };
    writeln!(out, "continuous sliding is {verdict}")?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    row("mu_prime", point.mu_prime.to_string())?;
    row("mu_k", point.mu_k.to_string())?;
    row("alpha_v", point.alpha_v.to_string())?;
    row("alpha_n", point.alpha_n.to_string())?;
    row("tau", point.tau.to_string())?;
    row("n_unstable", point.n_unstable.to_string())?;
    let margin = match point.delay_margin {
        Some(margin) => margin.to_string(),
        None => "infinite: no delay changes stability".into(),
    };
    row("delay_margin", margin)?;
    let spectrum = &point.spectrum;
    let or_unknown = |value: Option<f64>| value.map_or("unknown".into(), |v| v.to_string());
    row("abscissa", or_unknown(spectrum.abscissa))?;
    row("frequency", or_unknown(spectrum.frequency))?;
    for crossing in &point.crossings {
        let text = format!(
            "to the {} at omega = {}, tau = {} + k {}",
            crossing.direction,
            crossing.omega,
            crossing.first_delay,
            std::f64::consts::TAU / crossing.omega
        );
        row("crossing", text)?;
    }
    if point.stable_delays.is_empty() {
        row("stable delays", "none".into())?;
    }
    for interval in point.stable_delays.iter().take(INTERVALS_SHOWN) {
        let end = interval[1].map_or("infinity".into(), |to| to.to_string());
        row(
            "stable delays",
            format!("{} < tau < {end}", interval[0].unwrap_or(0.0)),
        )?;
    }
    let more = point.stable_delays.len().saturating_sub(INTERVALS_SHOWN);
    if point.stable_delays_truncated {
        row("", format!("and more than {more} further intervals"))?;
    } else if more > 0 {
        row(
            "",
            format!("and {more} further intervals (--json lists them)"),
        )?;
    }
    point.spectrum.print(row)
}
