//! `slipmap compare`: control by the return map beside the delayed feedback of a case.
//!
//! Longer than most files: its flags, what they may be, and the question that they make.

use std::path::PathBuf;

use clap::ValueEnum;

use crate::explore::comparison::{At, Comparison, Over, Question};
use crate::explore::route::Route;
use crate::letter::{GENERATOR_OF_COMPARE, Sheet};
use crate::model::stop::Stop;
use crate::model::{Control, MapModel, Record};
use crate::report::progress::Progress;
use crate::setting::amount::Amount;
use crate::setting::basin::Basin;
use crate::setting::feedback_table::MODELS;
use crate::setting::parameter::LARGEST;
use crate::setting::{CaseSpec, Parameter};
use crate::slip::case::CaseError;
use crate::store::Output;
use crate::sweep::engine::RunError;
use crate::sweep::events::Attended;
use crate::text::Shown;

use super::case_facts::CaseFacts;
use super::compared_text::{self, Told};
use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::output::provenance;
use super::parameter_values::{amount_of, in_units};
use super::reproduce::page_named;
use super::run::{default_threads, parse_threads};
use super::say;
use super::signals::Signals;
use super::sweep_file::read_case;

/// Starts of each kind.
const STARTS: u32 = 256;
/// For how long they are followed, in √(M/κ).
const HORIZON: f64 = 200.0;
/// Values by default: amplitudes in N0, errors of the slope, noise in the elongation of sliding.
const AMPLITUDES: [f64; 7] = [0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9];
const SLOPES: [f64; 9] = [-0.4, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4];
const NOISES: [f64; 6] = [0.0, 0.0002, 0.0005, 0.001, 0.003, 0.01];
/// The amplitude where it does not vary, in N0.
const AMPLITUDE: f64 = 0.5;
/// The largest error of the slope, as a share of it.
const MOST_WRONG: f64 = 0.99;
/// Sample times of the return map, in √(M/κ).
const SAMPLE_TIMES: [f64; 4] = [0.3, 0.5, 0.9, 1.5];
/// Readings in a delay of feedback that is compared under noise and gives no sample time.
const IN_DELAY: f64 = 10.0;

#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  slipmap compare sweeps/fig3b.toml --over amplitude -o compare.html
  slipmap compare sweeps/fig3b.toml --over slope --amplitude 0.1
  slipmap compare sweeps/return_map_route.toml --over route

Starts near sliding have velocities from 0 to 2 v0 and elongations within v0 √(M/κ) of that of \
sliding; those from stick-slip switch control on at a random phase. A start reaches sliding if it \
has no stop in the last quarter of the time and ends within 0.1 % of v0; where readings are noisy \
or rounded, stops alone count. Delayed feedback has the same largest change of the load.")]
pub(super) struct Args {
    /// The case file, with delayed feedback
    #[arg(value_name = "CASE.toml")]
    case: PathBuf,
    /// What varies
    #[arg(long, value_enum)]
    over: OverName,
    /// Largest changes of the load [default: 0.5 of N0; over amplitude 0.05 to 0.9 of it]
    #[arg(long, value_name = "LOAD,…", value_delimiter = ',',
          value_parser = amount_of(Parameter::NormalLoad))]
    amplitude: Vec<Amount>,
    /// By which share the slope of the model is wrong [default: 0; over slope -0.4 to 0.4]
    #[arg(
        long,
        value_name = "X,…",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    slope: Vec<f64>,
    /// Noise of readings [default: that of the case; over noise 0 to 0.01 N0/κ]
    #[arg(long, value_name = "A,…", value_delimiter = ',',
          value_parser = amount_of(Parameter::Noise))]
    noise: Vec<Amount>,
    /// Sample times of the return map [default: 0.3, 0.5, 0.9, 1.5 √(M/κ)]
    #[arg(long, value_name = "T,…", value_delimiter = ',',
          value_parser = amount_of(Parameter::SampleTime))]
    sample_time: Vec<Amount>,
    /// Where the return map comes from
    #[arg(long, value_name = "MODEL", value_parser = MODELS, default_value = MODELS[0])]
    model: String,
    /// The most readings of a record, from 7 to 100000 [default: 20]
    #[arg(long, value_name = "N", value_parser = parse_record)]
    record: Option<u32>,
    /// How many starts of each kind, a power of two from 64 to 1048576
    #[arg(long, value_name = "N", default_value_t = STARTS, value_parser = parse_starts)]
    starts: u32,
    /// What starts, noise and records are drawn with, a whole number
    #[arg(long, value_name = "N", default_value_t = 0,
          value_parser = clap::value_parser!(u32).range(..1_000_000))]
    seed: u32,
    /// For how long after switch-on starts are followed [default: 200 √(M/κ)]
    #[arg(long, value_name = "T", value_parser = amount_of(Parameter::Tau))]
    horizon: Option<Amount>,
    /// The page to write, of HTML with a picture
    #[arg(short, long, value_name = "PAGE.html")]
    output: Option<PathBuf>,
    /// Threads to compute on [default: as many as the machine offers]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    /// One JSON object on standard output; null where there is no value
    #[arg(long)]
    json: bool,
}

/// What varies, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum OverName {
    /// The largest change of the load
    Amplitude,
    /// The error of the model's slope of friction
    Slope,
    /// The noise of readings
    Noise,
    /// v0 in time, by the programme of the case: how low it may become
    Route,
}

/// Reads the number of a `--starts` flag.
fn parse_starts(text: &str) -> Result<u32, String> {
    let starts = text.parse().map_err(|_| "expected a whole number");
    Basin::check_starts(starts?)
}

/// Reads the number of a `--record` flag.
fn parse_record(text: &str) -> Result<u32, String> {
    let readings = text.parse().map_err(|_| "expected a whole number")?;
    match (Record::LEAST..=Record::MOST).contains(&readings) {
        true => Ok(readings),
        false => Err(format!(
            "{} to {} readings: five numbers are fitted, and two readings come before the first \
             that tells of them",
            Record::LEAST,
            Record::MOST
        )),
    }
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("compare").or::<Comparison>().or::<Route>()
}

/// Runs the subcommand.
pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let page = args.output.as_deref().map(page_named);
    let output = page.transpose()?.map(Output::claim).transpose()?;
    let spec = read_case(&args.case)?;
    let question = args.question(&spec)?;
    if args.over == OverName::Route {
        let found = signals.or_end("there is no answer", || question.route(&Stop::default()));
        let found = found.map_err(|error| refused(&error))?;
        let found = found.ok_or_else(|| signals.interrupted("there is no answer"))?;
        return args.tell(
            &found,
            &spec,
            &compared_text::of_route(&found, &spec),
            output,
        );
    }
    let progress = Progress::new(say::is_quiet() || args.json);
    let attended = Attended {
        observer: &progress,
        stop: &signals.stop,
    };
    let threads = args.threads.unwrap_or_else(default_threads);
    let found = question.answer(threads, attended).map_err(|error| {
        progress.clear();
        match error {
            RunError::Interrupted => signals.interrupted("there is no answer"),
            error => Failure::bad_input(error.to_string()),
        }
    })?;
    let mut told = compared_text::of_shares(&found, &spec);
    if output.is_some() {
        told.svg = Some(compared_text::svg(&found, &spec)?);
    }
    args.tell(&found, &spec, &told, output)
}

fn refused(error: &CaseError) -> Failure {
    Failure::bad_input(error.to_string())
}

impl Args {
    /// The values of a flag in the units of the case, each greater than 0, or at least that for
    /// noise; or by default.
    fn values(
        flag: &str,
        given: &[Amount],
        spec: &CaseSpec,
        by_default: &[f64],
    ) -> Result<Vec<f64>, Failure> {
        if given.is_empty() {
            return Ok(by_default.to_vec());
        }
        let least = if flag == "--noise" {
            0.0
        } else {
            1.0 / LARGEST
        };
        let most = LARGEST;
        let value = |amount: &Amount| {
            let value = in_units(flag, amount, &spec.units)?;
            match least <= value && value <= most {
                true => Ok(value),
                false => Err(Failure::bad_input(format!(
                    "{flag} {} is outside its range: {} to {}",
                    Shown(value),
                    Shown(least),
                    Shown(most)
                ))),
            }
        };
        given.iter().map(value).collect()
    }

    /// One value of what does not vary.
    fn one(&self, name: OverName, flag: &str, values: &[f64]) -> Result<f64, Failure> {
        let route = self.over == OverName::Route && name == OverName::Amplitude;
        match values {
            [one] => Ok(*one),
            [first, ..] if self.over == name || route => Ok(*first),
            _ => Err(Failure::bad_input_with_help(
                format!("{flag} has {} values, and does not vary", values.len()),
                format!("give one of them, or --over {}", &flag[2..]),
            )),
        }
    }

    /// Checks that there is delayed feedback to compare, and a programme for a route.
    fn check(&self, spec: &CaseSpec) -> Result<(), Failure> {
        let (case, name) = (&spec.case, self.case.display());
        if case.feedback.return_map.is_some() || !case.feedback.gains.act() {
            return Err(Failure::bad_input_with_help(
                format!("{name}: delayed feedback is compared, and there is none"),
                "give alpha_n and tau in [fixed], and no [feedback]",
            ));
        }
        let Control { alpha_v, alpha_n } = case.feedback.gains;
        if alpha_n == 0.0 {
            let message = format!(
                "alpha_v = {}: velocity control does not change the load, whose largest change \
                 both methods are to have in common",
                Shown(alpha_v)
            );
            let error = spec.error_at(Parameter::AlphaV, message).help(
                "compare load control: give alpha_n in the place of alpha_v, for example \
                 alpha_n = -10.0",
            );
            return Err(Failure::in_file(error, &name.to_string(), &spec.text));
        }
        if self.over == OverName::Route && case.programme.0.is_empty() {
            return Err(Failure::bad_input_with_help(
                format!("{name}: v0 has no programme to follow"),
                "begin where sliding is stable and let v0 fall: [[programme]] at = 2000, \
                 v0 = 0.02, ramp = true",
            ));
        }
        Ok(())
    }

    /// Checks that no flag is given that has no effect.
    fn check_flags(&self) -> Result<(), Failure> {
        let exact = self.model == MODELS[0];
        let wrong = self.over == OverName::Slope || !self.slope.is_empty();
        let route = self.over == OverName::Route;
        let found = [
            (
                wrong && !exact,
                "--slope is of an exact model",
                "leave out --model",
            ),
            (
                self.record.is_some() && exact,
                "--record is of a model that is reconstructed",
                "give --model reconstructed as well",
            ),
            (
                route && self.horizon.is_some(),
                "--horizon is not of a route",
                "a route ends with its programme: leave it out",
            ),
            (
                route && self.starts != STARTS,
                "--starts is not of a route",
                "a route begins in sliding: leave it out",
            ),
        ];
        match found.into_iter().find(|(given, ..)| *given) {
            Some((_, message, help)) => Err(Failure::bad_input_with_help(message, help)),
            None => Ok(()),
        }
    }

    /// By which shares the slope of the model is wrong.
    fn slopes(&self) -> Result<Vec<f64>, Failure> {
        let wrong = |slope: &&f64| slope.is_nan() || slope.abs() > MOST_WRONG;
        if let Some(slope) = self.slope.iter().find(wrong) {
            let slope = Shown(*slope);
            return Err(Failure::bad_input(format!(
                "--slope {slope} is outside its range: {} to {MOST_WRONG}",
                -MOST_WRONG
            )));
        }
        Ok(match (self.slope.is_empty(), self.over) {
            (false, _) => self.slope.clone(),
            (true, OverName::Slope) => SLOPES.to_vec(),
            (true, _) => vec![0.0],
        })
    }

    /// What is asked about a case.
    fn question(&self, spec: &CaseSpec) -> Result<Question, Failure> {
        self.check_flags()?;
        self.check(spec)?;
        let mut case = spec.case.clone();
        let units = case.units();
        let times = |of: &[f64], unit: f64| of.iter().map(|x| x * unit).collect::<Vec<_>>();
        let amplitudes = match self.over {
            OverName::Amplitude | OverName::Route => times(&AMPLITUDES, units.force),
            OverName::Slope | OverName::Noise => vec![AMPLITUDE * units.force],
        };
        let noises = match self.over {
            OverName::Noise => times(&NOISES, units.length),
            _ => vec![case.feedback.readings.noise],
        };
        let sample_times = times(&SAMPLE_TIMES, units.time);
        let by_default = [HORIZON * units.time];
        let horizon = self.horizon.as_slice();
        let amplitudes = Self::values("--amplitude", &self.amplitude, spec, &amplitudes)?;
        let noises = Self::values("--noise", &self.noise, spec, &noises)?;
        let sample_times = Self::values("--sample-time", &self.sample_time, spec, &sample_times)?;
        let horizon = Self::values("--horizon", horizon, spec, &by_default)?;
        let readings = &mut case.feedback.readings;
        if noises.iter().any(|noise| *noise > 0.0) && readings.sample_time == 0.0 {
            readings.sample_time = case.feedback.tau / IN_DELAY;
        }
        Ok(Question {
            at: self.places(&amplitudes, &self.slopes()?, &noises)?,
            over: match self.over {
                OverName::Amplitude | OverName::Route => Over::Amplitude,
                OverName::Slope => Over::Slope,
                OverName::Noise => Over::Noise,
            },
            sample_times,
            model: self.model(units.force),
            starts: self.starts,
            seed: self.seed,
            horizon: horizon.first().copied().unwrap_or(by_default[0]),
            case,
        })
    }

    /// Where the return map comes from, with pulses in units of the load `n0`.
    fn model(&self, n0: f64) -> MapModel {
        match self.model == MODELS[0] {
            true => MapModel::EXACT,
            false => MapModel::Reconstructed(Record {
                readings: self.record.unwrap_or(Record::READINGS),
                pulse: Record::PULSE * n0,
            }),
        }
    }

    /// The values of what varies, with one of each of the others.
    fn places(
        &self,
        amplitudes: &[f64],
        slopes: &[f64],
        noises: &[f64],
    ) -> Result<Vec<At>, Failure> {
        let at = At {
            amplitude: self.one(OverName::Amplitude, "--amplitude", amplitudes)?,
            slope: self.one(OverName::Slope, "--slope", slopes)?,
            noise: self.one(OverName::Noise, "--noise", noises)?,
        };
        let places = match self.over {
            OverName::Amplitude | OverName::Route => {
                let of = amplitudes.iter();
                of.map(|&amplitude| At { amplitude, ..at }).collect()
            }
            OverName::Slope => slopes.iter().map(|&slope| At { slope, ..at }).collect(),
            OverName::Noise => noises.iter().map(|&noise| At { noise, ..at }).collect(),
        };
        Ok(places)
    }

    /// Writes the page, if one is asked for, and says what is found.
    fn tell(
        &self,
        found: &impl serde::Serialize,
        spec: &CaseSpec,
        told: &Told,
        output: Option<Output>,
    ) -> Result<(), Failure> {
        if let Some(output) = output {
            let made = provenance("compare", &self.case);
            let by = format!("slipmap {} ({})", made.program_version, made.git_revision);
            let sheet = Sheet {
                generator: GENERATOR_OF_COMPARE,
                title: compared_text::TITLE,
                text: &told.text,
                made: &[by],
                svg: told.svg.as_deref(),
                head: &told.head,
                rows: &told.rows,
            };
            output.fill(sheet.page())?;
        }
        if self.json {
            let inputs = Inputs::default().and("case", CaseFacts::of(spec));
            return json::print(&inputs, found);
        }
        told.print()?;
        match &self.output {
            Some(page) => say::result(page.display()),
            None => Ok(()),
        }
    }
}
