//! `slipmap best`: the settings of fastest decay.

use std::io::Write;
use std::path::PathBuf;

use clap::ValueEnum;
use serde::Serialize;
use slipmap::linear::best::{Optimum, SearchedGain};
use slipmap::report::numbers::unit_behind;
use slipmap::sweep::cells::best::{
    BestRegion, BestSettings, Ranges, best_settings, default_ranges,
};
use slipmap::sweep::input::units::Units;
use slipmap::sweep::{Field, Parameter, Setting};
use utoipa::ToSchema;

use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::output::tell_dimensionless;
use super::parameters::{AtAnyDelay, ParameterArgs};
use super::say;
use super::setting;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap best --mu-prime -0.3 --control velocity

Searched where no ranges are given, with b = μ′N0/√(κM): delays from 0 to \
four periods of the free oscillator; gains of
velocity control up to ±2 max(1, |b|) √(κ/M); gains of load \
control from 4(1 + |b|) κ/μ_K below the weakest negative one that
stabilises, -(|b| + b²/2) κ/μ_K, to 4(1 + |b|) κ/μ_K.")]
pub(super) struct Args {
    #[command(flatten)]
    parameters: ParameterArgs<AtAnyDelay>,
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
    /// Write the best setting, if one is stable, to a file that point takes with --setting and,
    /// with a friction law, vc too, and simulate as a case file
    #[arg(long, value_name = "SETTING.toml")]
    save: Option<PathBuf>,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
}

/// Controls by name.
#[derive(Debug, Clone, Copy, ValueEnum, Serialize, ToSchema)]
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
#[derive(Debug, Serialize, ToSchema)]
struct BestAnswer {
    mu_prime: f64,
    mu_k: f64,
    control: Control,
    searched: RangesOut,
    best: OptimumOut,
    regions: Vec<RegionOut>,
    regions_left_out: usize,
}

#[derive(Debug, Serialize, ToSchema)]
struct RangesOut {
    #[schema(value_type = [f64; 2])]
    alpha: (f64, f64),
    #[schema(value_type = [f64; 2])]
    tau: (f64, f64),
}

#[derive(Debug, Serialize, ToSchema)]
struct RegionOut {
    region: RangesOut,
    #[serde(flatten)]
    best: OptimumOut,
}

#[derive(Debug, Serialize, ToSchema)]
struct OptimumOut {
    alpha: f64,
    tau: f64,
    abscissa: f64,
    frequency: f64,
    frequencies: Vec<f64>,
    /// −1/abscissa; null where the setting is not stable.
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
    if let Some(path) = &args.save {
        setting::check_save(path)?;
    }
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
        let inputs = args.inputs(&setting, &ranges);
        json::print(&inputs, &answer(args, &setting, &ranges, &found)?)?;
    } else {
        let mut out = std::io::stdout().lock();
        print(&mut out, args, &setting, &ranges, &found)?;
    }
    let Some(path) = &args.save else {
        return Ok(());
    };
    if found.overall.relaxation_time().is_none() {
        let message = format!("{} is not written: no setting is stable", path.display());
        let help = "other ranges (--alpha-from, --tau-to, …) or the other --control may hold one";
        return Err(Failure::failed_with_help(message, help));
    }
    let mut best = setting;
    best.set(args.control.parameter(), found.overall.gain);
    best.set(Parameter::Tau, found.overall.tau);
    setting::save(&best, &args.parameters.units(), path)?;
    match args.json {
        true => Ok(()),
        false => say::result(path.display()),
    }
}

/// What its JSON looks like.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("best").or::<BestAnswer>()
}

impl Args {
    fn inputs(&self, setting: &Setting, ranges: &Ranges) -> Inputs {
        let searched = [self.control.parameter(), Parameter::Tau];
        let given = |parameter| !searched.contains(&parameter);
        let inputs = Inputs::of_setting(setting, &self.parameters.units(), given);
        let inputs = inputs.and("control", self.control);
        let inputs = inputs.and("alpha_from", ranges.gain.0);
        let inputs = inputs.and("alpha_to", ranges.gain.1);
        let inputs = inputs.and("tau_from", ranges.tau.0);
        inputs.and("tau_to", ranges.tau.1)
    }
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

fn answer(
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
    let units = args.parameters.units();
    let best = &found.overall;
    let time = unit_behind(&units.time());
    match best.relaxation_time() {
        Some(relaxation) => writeln!(
            out,
            "sliding relaxes fastest, with the relaxation time {}{time}, at",
            short(relaxation)
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
    let of = |parameter: Parameter| unit_behind(&units.of_parameter(parameter));
    let with = |parameter: Parameter, value: f64| format!("{}{}", short(value), of(parameter));
    row(searched.name(), with(searched, best.gain))?;
    row("tau", with(Parameter::Tau, best.tau))?;
    for (field, value) in [
        (Field::Abscissa, best.abscissa),
        (Field::Frequency, best.frequency()),
    ] {
        let unit = unit_behind(&field.unit(&units));
        row(field.name(), format!("{}{unit}", short(value)))?;
    }
    row("kind", best.kind.name().into())?;
    row(
        "certified",
        if best.certified { "yes" } else { "no" }.into(),
    )?;
    row("mu_prime", with(Parameter::MuPrime, sliding.mu_prime))?;
    row("mu_k", short(sliding.mu_k))?;
    row(other.name(), with(other, setting.get(other)))?;
    let range = |(from, to): (f64, f64), unit: &str| {
        format!("{}{unit} to {}{unit}", short(from), short(to))
    };
    row(
        "searched",
        format!(
            "{} {}, tau {}",
            searched.name(),
            range(ranges.gain, &of(searched)),
            range(ranges.tau, &time)
        ),
    )?;
    tell_dimensionless(out, &units)?;
    print_regions(out, searched, found, &units)
}

/// One line for each stable region.
fn print_regions(
    out: &mut impl Write,
    searched: Parameter,
    found: &BestSettings,
    units: &Units,
) -> Result<(), Failure> {
    if found.regions.is_empty() {
        return Ok(());
    }
    writeln!(out, "the best setting of every stable region, by delay")?;
    let mut line = |cells: [&str; 6]| {
        let [gain, tau, time, frequency, certified, kind] = cells;
        let text =
            format!("  {gain:>14} {tau:>14} {time:>15} {frequency:>14} {certified:>9}  {kind}");
        writeln!(out, "{}", text.trim_end())
    };
    line([
        searched.name(),
        "tau",
        "relaxation_time",
        "frequency",
        "certified",
        "kind",
    ])?;
    if !units.dimensionless() {
        let gain = units.of_parameter(searched);
        let (time, frequency) = (units.time(), units.angular_frequency());
        line([&gain, &time, &time, &frequency, "", ""])?;
    }
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
