//! `slipmap best`: the settings of fastest decay.

use std::io::Write;

use clap::ValueEnum;
use serde::Serialize;
use slipmap::linear::best::{Optimum, SearchedGain};
use slipmap::sweep::cells::best::{
    BestRegion, BestSettings, Ranges, best_settings, default_ranges,
};
use slipmap::sweep::{Parameter, Setting};

use super::failure::Failure;
use super::parameters::ParameterArgs;
use super::say;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap best --mu-prime -0.3 --control velocity

Searched where no ranges are given, with b = μ′N0/√(κM): delays from 0 to \
four periods of the free oscillator; gains of
velocity control up to ±2 max(1, |b|) √(κ/M); gains of load \
control from 4(1 + |b|) κ/μ_K below the weakest negative one that
stabilises, -(|b| + b²/2) κ/μ_K, to 4(1 + |b|) κ/μ_K.")]
pub(super) struct Args {
    #[command(flatten)]
    parameters: ParameterArgs,
    /// The gain that is searched; the other one is given as usual
    #[arg(long, value_enum, default_value_t = Control::Velocity)]
    control: Control,
    /// Smallest gain to search
    #[arg(long, allow_hyphen_values = true, value_name = "A")]
    alpha_from: Option<f64>,
    /// Largest gain to search
    #[arg(long, allow_hyphen_values = true, value_name = "A")]
    alpha_to: Option<f64>,
    /// Shortest delay to search
    #[arg(long, allow_hyphen_values = true, value_name = "T")]
    tau_from: Option<f64>,
    /// Longest delay to search
    #[arg(long, allow_hyphen_values = true, value_name = "T")]
    tau_to: Option<f64>,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
}

/// Controls by name.
#[derive(Debug, Clone, Copy, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
enum Control {
    /// α_v: the pulling velocity follows the delayed elongation
    Velocity,
    /// α_N: the normal load does
    Load,
}

impl Control {
    fn parameter(self) -> Parameter {
        match self {
            Self::Velocity => Parameter::AlphaV,
            Self::Load => Parameter::AlphaN,
        }
    }

    fn searched(self) -> SearchedGain {
        match self {
            Self::Velocity => SearchedGain::Velocity,
            Self::Load => SearchedGain::Load,
        }
    }
}

/// The JSON of a search. Infinite numbers are written as null.
#[derive(Debug, Serialize)]
struct BestAnswer {
    mu_prime: f64,
    mu_k: f64,
    control: Control,
    searched: RangesOut,
    best: OptimumOut,
    regions: Vec<RegionOut>,
    regions_left_out: usize,
}

#[derive(Debug, Serialize)]
struct RangesOut {
    alpha: (f64, f64),
    tau: (f64, f64),
}

#[derive(Debug, Serialize)]
struct RegionOut {
    region: RangesOut,
    #[serde(flatten)]
    best: OptimumOut,
}

#[derive(Debug, Serialize)]
struct OptimumOut {
    alpha: f64,
    tau: f64,
    abscissa: f64,
    frequency: f64,
    frequencies: Vec<f64>,
    relaxation_time: Option<f64>,
    kind: &'static str,
    certified: bool,
    margin: f64,
}

impl From<&Ranges> for RangesOut {
    fn from(ranges: &Ranges) -> Self {
        Self {
            alpha: ranges.gain,
            tau: ranges.tau,
        }
    }
}

impl From<&Optimum> for OptimumOut {
    fn from(found: &Optimum) -> Self {
        Self {
            alpha: found.gain,
            tau: found.tau,
            abscissa: found.abscissa,
            frequency: found.frequency(),
            frequencies: found.frequencies.clone(),
            relaxation_time: found.relaxation_time(),
            kind: found.kind.name(),
            certified: found.certified,
            margin: found.margin,
        }
    }
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let gain = args.control.searched();
    let help = "leave it out; --alpha-from, --alpha-to, --tau-from and --tau-to are the ranges of \
        the search";
    let setting = args
        .parameters
        .setting_but(&[args.control.parameter(), Parameter::Tau], help)?;
    setting.sliding_point()?;
    let ranges = ranges(args, &default_ranges(&setting, gain)?)?;
    let found = best_settings(&setting, gain, &ranges)?;
    if args.json {
        return say::json(&json(args, &setting, &ranges, &found)?);
    }
    let mut out = std::io::stdout().lock();
    print(&mut out, args, &setting, &ranges, &found)
}

/// The ranges that the flags give, over those searched by default.
fn ranges(args: &Args, default: &Ranges) -> Result<Ranges, Failure> {
    let gain = args.control.parameter();
    Ok(Ranges {
        gain: range(
            gain,
            [
                ("--alpha-from", args.alpha_from),
                ("--alpha-to", args.alpha_to),
            ],
            default.gain,
        )?,
        tau: range(
            Parameter::Tau,
            [("--tau-from", args.tau_from), ("--tau-to", args.tau_to)],
            default.tau,
        )?,
    })
}

fn range(
    parameter: Parameter,
    [(from_flag, from), (to_flag, to)]: [(&str, Option<f64>); 2],
    default: (f64, f64),
) -> Result<(f64, f64), Failure> {
    for (flag, value) in [(from_flag, from), (to_flag, to)] {
        if let Some(Err(error)) = value.map(|value| parameter.check(value)) {
            return Err(Failure::out_of_range(flag, &error));
        }
    }
    let (low, high) = (from.unwrap_or(default.0), to.unwrap_or(default.1));
    if low <= high {
        return Ok((low, high));
    }
    let origin = |given: Option<f64>| given.map_or(", its default", |_| "");
    Err(Failure::bad_input_with_help(
        format!(
            "{from_flag} {low}{} is above {to_flag} {high}{}",
            origin(from),
            origin(to)
        ),
        format!("{from_flag} must be at most {to_flag}"),
    ))
}

fn json(
    args: &Args,
    setting: &Setting,
    ranges: &Ranges,
    found: &BestSettings,
) -> Result<BestAnswer, Failure> {
    let sliding = setting.sliding_point()?;
    let region = |region: &BestRegion| RegionOut {
        region: (&region.ranges).into(),
        best: (&region.best).into(),
    };
    Ok(BestAnswer {
        mu_prime: sliding.mu_prime,
        mu_k: sliding.mu_k,
        control: args.control,
        searched: ranges.into(),
        best: (&found.overall).into(),
        regions: found.regions.iter().map(region).collect(),
        regions_left_out: found.regions_left_out,
    })
}

/// A number with as many digits as a person can use, the same on every machine.
fn short(value: f64) -> String {
    let rounded = format!("{value:.8e}").parse::<f64>();
    rounded.unwrap_or(value).to_string()
}

fn print(
    out: &mut impl Write,
    args: &Args,
    setting: &Setting,
    ranges: &Ranges,
    found: &BestSettings,
) -> Result<(), Failure> {
    let best = &found.overall;
    match best.relaxation_time() {
        Some(time) => writeln!(
            out,
            "sliding relaxes fastest, with the relaxation time {}, at",
            short(time)
        )?,
        None => writeln!(
            out,
            "no stable setting in the ranges; the least unstable one is"
        )?,
    }
    let (searched, other) = match args.control {
        Control::Velocity => (Parameter::AlphaV, Parameter::AlphaN),
        Control::Load => (Parameter::AlphaN, Parameter::AlphaV),
    };
    let sliding = setting.sliding_point()?;
    let mut row = |name: &str, value: String| writeln!(out, "  {name:<16} {value}");
    row(searched.name(), short(best.gain))?;
    row("tau", short(best.tau))?;
    row("abscissa", short(best.abscissa))?;
    row("frequency", short(best.frequency()))?;
    row("kind", best.kind.name().into())?;
    row(
        "certified",
        if best.certified { "yes" } else { "no" }.into(),
    )?;
    row("mu_prime", short(sliding.mu_prime))?;
    row("mu_k", short(sliding.mu_k))?;
    row(other.name(), short(setting.get(other)))?;
    let range = |(from, to): (f64, f64)| format!("{} to {}", short(from), short(to));
    row(
        "searched",
        format!(
            "{} {}, tau {}",
            searched.name(),
            range(ranges.gain),
            range(ranges.tau)
        ),
    )?;
    print_regions(out, searched, found)
}

/// One line for each stable region.
fn print_regions(
    out: &mut impl Write,
    searched: Parameter,
    found: &BestSettings,
) -> Result<(), Failure> {
    if found.regions.is_empty() {
        return Ok(());
    }
    writeln!(out, "the best setting of every stable region, by delay")?;
    let mut line = |cells: [&str; 6]| {
        let [gain, tau, time, frequency, certified, kind] = cells;
        writeln!(
            out,
            "  {gain:>14} {tau:>14} {time:>15} {frequency:>14} {certified:>9}  {kind}"
        )
    };
    line([
        searched.name(),
        "tau",
        "relaxation_time",
        "frequency",
        "certified",
        "kind",
    ])?;
    for BestRegion { best, .. } in &found.regions {
        let time = best.relaxation_time().map_or("none".into(), short);
        line([
            &short(best.gain),
            &short(best.tau),
            &time,
            &short(best.frequency()),
            if best.certified { "yes" } else { "no" },
            best.kind.name(),
        ])?;
    }
    if found.regions_left_out > 0 {
        let more = found.regions_left_out;
        writeln!(
            out,
            "  and {more} regions at longer delays, which were not searched"
        )?;
    }
    Ok(())
}
