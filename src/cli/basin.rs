//! `slipmap basin`: the share of starts from which control ends in sliding.

use std::convert::Infallible;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::explore::basin::{BasinShare, Followed, no_law};
use crate::report::numbers::{bound, grouped, unit_behind, with_error};
use crate::report::table::write_starts;
use crate::setting::amount::Amount;
use crate::setting::basin::{Basin, Over};
use crate::setting::point_file::PointOf;
use crate::setting::simulation::Simulation;
use crate::setting::units::Units;
use crate::setting::{Parameter, Setting};
use crate::sweep::RunError;
use crate::text::{Shown, finite};
use clap::ValueEnum;

use super::asks::OfStickSlip;
use super::cell::{CellArgs, alone};
use super::digits::{Digits, DigitsArgs};
use super::failure::Failure;
use super::inputs_line;
use super::json::{self, AnswerSchema, Inputs};
use super::output::{tell_dimensionless, warn_beyond_curve};
use super::parameter_values::{amount_of, in_units};
use super::parameters::ParameterArgs;
use super::run::{default_threads, parse_threads};
use super::say::{self, ForPeople};
use super::setting::SettingArgs;
use super::signals::Signals;
use super::text_output::{To, is_csv};

/// Default number of starts.
const STARTS: u32 = 4096;

#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  slipmap basin --friction weakening --mu0 0.5 --v-s 0.5 --v0 0.35 --alpha-v=-0.33 --tau 4.15
  slipmap basin --friction weakening --mu0 0.5 --v-s 0.5 --v0 0.35 --alpha-v=-0.33 --tau 4.15 \
--over phase

Two questions: over states, a block is found with any velocity and elongation of a box, and \
control acts from then on; over phases, control is switched on at any time of uncontrolled \
stick-slip. By default the box has velocities from 0 to v0 + √(v0² + μ_S² N0²/(κM)), what a block \
at rest can come to, and elongations of ±μ_S N0/κ, at which it stays at rest.
The error is that of 16 independent scramblings of a Sobol sequence. Starts whose end is undecided \
are no part of the share: they widen the interval.")]
pub(super) struct Args {
    #[command(flatten)]
    parameters: ParameterArgs<OfStickSlip>,
    #[command(flatten)]
    cell: CellArgs,
    #[command(flatten)]
    file: SettingArgs,
    /// Kind of starts [default: state, or those of --map]
    #[arg(long, value_enum)]
    over: Option<OverName>,
    /// How many, a power of two from 64 to 1048576 [default: 4096]
    #[arg(long, value_name = "N", value_parser = parse_starts)]
    starts: Option<u32>,
    /// Smallest velocity of the block at t = 0
    #[arg(long, value_name = "V", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::XDot0))]
    x_dot0_from: Option<Amount>,
    /// Largest velocity of the block at t = 0
    #[arg(long, value_name = "V", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::XDot0))]
    x_dot0_to: Option<Amount>,
    /// Smallest elongation of the spring at t = 0 and before
    #[arg(long, value_name = "A", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::A0))]
    a0_from: Option<Amount>,
    /// Largest elongation of the spring at t = 0 and before
    #[arg(long, value_name = "A", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::A0))]
    a0_to: Option<Amount>,
    /// Time after switch-on until which motions are followed [default: 1000 √(M/κ)]
    #[arg(long, value_name = "T", allow_hyphen_values = true,
          value_parser = amount_of(Parameter::Tau))]
    horizon: Option<Amount>,
    /// What the noise of readings is drawn with, a whole number; each start has noise of its own
    /// [default: 0]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Write all starts with their outcomes, as text
    #[arg(short, long, value_name = "STARTS.csv")]
    output: Option<PathBuf>,
    /// Threads to compute on [default: as many as the machine offers]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    #[command(flatten)]
    digits: DigitsArgs,
    /// One JSON object on standard output; null where there is no value
    #[arg(long)]
    json: bool,
}

/// Kinds of starts by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum OverName {
    /// Velocity and elongation in a box, with control on from t = 0
    State,
    /// Control switched on at a phase of uncontrolled stick-slip
    Phase,
}

/// Reads the number of a `--starts` flag.
fn parse_starts(text: &str) -> Result<u32, String> {
    let starts = text.parse().map_err(|_| "expected a whole number");
    Basin::check_starts(starts?)
}

/// The question: a setting and its starts.
struct Question {
    setting: Setting,
    units: Units,
    basin: Basin,
    simulation: Simulation,
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("basin").or::<BasinShare>()
}

/// Runs the subcommand.
pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let output = args.output()?;
    let question = args.read()?;
    let threads = args.threads.unwrap_or_else(default_threads);
    let followed = signals.or_end("there is no share", || {
        let Question {
            setting,
            basin,
            simulation,
            ..
        } = &question;
        let never = Arc::default();
        Followed::of(setting, simulation, basin, (threads, &never))
    });
    let followed = followed.map_err(|error| args.refused(&error))?;
    warn_beyond_curve(followed.beyond_curve(&question.setting, &question.units));
    let share = BasinShare::of(&followed);
    if let Some(to) = output {
        to.write(&signals, "there are no starts", |out, stop| {
            write_starts(&followed, &question.units, out, stop)
        })?;
    }
    if args.json {
        return json::print(&question.inputs(&share), &share);
    }
    let (setting, units) = (&question.setting, &question.units);
    let digits = args.digits.get();
    say::result(sentence(&share))?;
    inputs_line::print(&mut ForPeople::begin(), setting, units, &[])?;
    tell(&share, (units, digits), args.output.as_deref())
}

impl Args {
    /// Reads the question from a map, a file or flags.
    fn read(&self) -> Result<Question, Failure> {
        let by_flags = self.parameters.any_but(&[]);
        let mut basin = Basin {
            starts: STARTS,
            ..Basin::default()
        };
        let mut simulation = Simulation::default();
        let point = match self.cell.point(PointOf::Sliding)? {
            Some(point) => {
                alone("--map", by_flags)?;
                if let Some(of_map) = self.cell.basin()? {
                    (basin, simulation) = of_map;
                }
                Some(point)
            }
            None => self.file.point(PointOf::Sliding)?,
        };
        let (setting, units) = if let Some(point) = point {
            alone("--setting", by_flags)?;
            (point.setting, point.units)
        } else {
            let setting = self.parameters.setting_of_motions()?;
            self.parameters
                .tell_static_friction("the share depends on it");
            (setting, self.parameters.units())
        };
        if setting.law().is_none() {
            return Err(Failure::bad_input(no_law().message));
        }
        self.put_starts(&mut basin, &setting, &units)?;
        if let Some(horizon) = &self.horizon {
            let horizon = in_units("--horizon", horizon, &units)?;
            if !(1e-12..=1e12).contains(&horizon) {
                let message = format!("--horizon {} is outside its range", Shown(horizon));
                let help = "a time greater than 0, between 1e-12 and 1e12";
                return Err(Failure::bad_input_with_help(message, help));
            }
            simulation.horizon = Some(horizon);
        }
        simulation.seed = self.seed.unwrap_or(simulation.seed);
        Ok(Question {
            setting,
            units,
            basin,
            simulation,
        })
    }

    /// Sets what the flags say about the starts.
    fn put_starts(
        &self,
        basin: &mut Basin,
        setting: &Setting,
        units: &Units,
    ) -> Result<(), Failure> {
        if let Some(over) = self.over {
            basin.over = match over {
                OverName::State => Over::State,
                OverName::Phase => Over::Phase,
            };
        }
        basin.starts = self.starts.unwrap_or(basin.starts);
        let ends = [
            ("--x-dot0-from", &self.x_dot0_from),
            ("--x-dot0-to", &self.x_dot0_to),
            ("--a0-from", &self.a0_from),
            ("--a0-to", &self.a0_to),
        ];
        if basin.over == Over::Phase {
            (basin.x_dot0, basin.a0) = (None, None);
            return match ends.iter().find(|(_, end)| end.is_some()) {
                Some((flag, _)) => Err(Failure::bad_input_with_help(
                    format!("{flag} has no meaning over phases"),
                    "it belongs to --over state",
                )),
                None => Ok(()),
            };
        }
        let value = |(flag, end): (&'static str, &Option<Amount>)| {
            let value = end.as_ref().map(|end| in_units(flag, end, units));
            Ok((flag, value.transpose()?))
        };
        let ends: Vec<_> = ends
            .into_iter()
            .map(value)
            .collect::<Result<_, Failure>>()?;
        let velocities = basin.velocities(setting)?;
        let elongations = basin.elongations(setting)?;
        basin.x_dot0 = Some(range(Parameter::XDot0, &ends[..2], velocities)?);
        basin.a0 = Some(range(Parameter::A0, &ends[2..], elongations)?);
        Ok(())
    }

    /// Where starts are written, if requested.
    fn output(&self) -> Result<Option<To<'_>>, Failure> {
        match self.output.as_deref() {
            Some(path) if is_csv(path) => Ok(Some(To::File(path))),
            Some(path) => Err(Failure::bad_input_with_help(
                format!("--output {}: a table is written as CSV", path.display()),
                "name it like NAME.csv",
            )),
            None => Ok(None),
        }
    }

    fn refused(&self, error: &RunError<Infallible>) -> Failure {
        match error {
            RunError::Model(error) => self.parameters.refused(error),
            RunError::Needs(error) => Failure::bad_input(error.to_string()),
            error => Failure::failed(error.to_string()),
        }
    }
}

/// The ends of a range: from the flags, else the defaults.
fn range(
    of: Parameter,
    ends: &[(&str, Option<f64>)],
    by_default: [f64; 2],
) -> Result<[f64; 2], Failure> {
    let mut range = by_default;
    for ((flag, given), end) in ends.iter().zip(&mut range) {
        if let Some(value) = given {
            let checked = of.check(*value);
            *end = checked.map_err(|error| Failure::out_of_range(flag, &error))?;
        }
    }
    Basin::check_range(of, range).map_err(|_| {
        let told = |((flag, given), value): (&(&str, Option<f64>), f64)| match given {
            Some(_) => format!("{flag} {}", Shown(value)),
            None => format!("{flag}, {} by default", Shown(value)),
        };
        let [from, to] = [0, 1].map(|end| told((&ends[end], range[end])));
        Failure::bad_input(format!("{from} is larger than {to}"))
    })
}

impl Question {
    fn inputs(&self, share: &BasinShare) -> Inputs {
        let mut inputs = Inputs::of_setting(&self.setting, &self.units, |_| true)
            .and("over", share.over)
            .and("starts", self.basin.starts)
            .and("horizon", share.horizon);
        let ranges = [("x_dot0", share.x_dot0), ("a0", share.a0)];
        for (name, range) in ranges {
            if let Some([from, to]) = range {
                inputs = inputs.and(&format!("{name}_from"), from);
                inputs = inputs.and(&format!("{name}_to"), to);
            }
        }
        inputs
    }
}

/// The answer as a sentence.
fn sentence(share: &BasinShare) -> String {
    let (Some(least), Some([low, high])) = (finite(share.basin_share), share.interval) else {
        return "there is no share: there is no uncontrolled stick-slip to switch on in".into();
    };
    if share.linearly_unstable {
        return "control ends in sliding from no start: sliding is linearly unstable".into();
    }
    let of = |share: f64, up: bool| bound(100.0 * share, 3, up);
    let (low, high) = (of(low, false), of(high, true));
    let sure = format!("from {low} to {high} % of all, with 95 % confidence");
    let most = finite(share.basin_share_upper).filter(|most| *most > least);
    let from = match (least, most) {
        (_, Some(most)) => format!(
            "from at least {} % and at most {} % of the starts, the end of others being \
             unknown",
            of(least, false),
            of(most, true)
        ),
        (1.0, None) => format!("from all {} starts", grouped(u64::from(share.starts))),
        (least, None) => format!("from {} % of the starts", of(least, false)),
    };
    format!("control ends in sliding {from}: {sure}")
}

fn tell(
    share: &BasinShare,
    (units, digits): (&Units, Digits),
    output: Option<&Path>,
) -> Result<(), Failure> {
    let out = &mut ForPeople::begin();
    let mut row = |name: &str, text: String| writeln!(out, "  {name:<16} {text}");
    let unit = |parameter| unit_behind(&units.of_parameter(parameter));
    if let Some(text) = sliding(share, digits) {
        row("sliding", text)?;
    }
    let others = share.outcomes.iter();
    for of in others.filter(|of| of.outcome != "sliding" && of.starts > 0) {
        let (share, error) = with_error(of.share, of.error);
        row(of.outcome, format!("{share} ± {error} of the starts"))?;
    }
    let (starts, scramblings) = (grouped(u64::from(share.starts)), share.scramblings);
    row("starts", format!("{starts} in {scramblings} scramblings"))?;
    row("over", over(share).into())?;
    for (parameter, range) in [(Parameter::XDot0, share.x_dot0), (Parameter::A0, share.a0)] {
        if let Some([from, to]) = range.map(|range| range.map(|end| digits.of(end))) {
            row(
                parameter.name(),
                format!("{from} to {to}{}", unit(parameter)),
            )?;
        }
    }
    if let Some(period) = share.period {
        let unit = unit(Parameter::SwitchOnPhase);
        row("phase", format!("0 to {}{unit}", digits.of(period)))?;
    }
    tell_dimensionless(out, units)?;
    match output {
        Some(path) => Ok(writeln!(out, "{}: {starts} starts", path.display())?),
        None => Ok(()),
    }
}

/// The kind of starts, in words.
fn over(share: &BasinShare) -> &'static str {
    match share.over {
        "state" => "states of the block, control on from t = 0",
        _ => "phases of uncontrolled stick-slip at which control is switched on",
    }
}

/// The share that ends in sliding with its error; none where the sentence says it all.
fn sliding(share: &BasinShare, digits: Digits) -> Option<String> {
    let least = finite(share.basin_share).filter(|_| !share.linearly_unstable)?;
    let error = finite(share.basin_share_error)?;
    let most = finite(share.basin_share_upper).filter(|most| *most > least);
    let undecided = most.map_or_else(String::new, |most| {
        format!(", {} if all that are undecided slide", digits.of(most))
    });
    let (least, error) = with_error(least, error);
    Some(format!("{least} ± {error} of the starts{undecided}"))
}
