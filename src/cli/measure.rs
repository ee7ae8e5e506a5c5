//! `slipmap measure`: friction measured through control.

use std::cell::Cell;
use std::convert::Infallible;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::explore::measure::{Foretold, Measurement};
use crate::report::table::write_measured;
use crate::setting::{ExperimentSpec, Parameter};
use crate::sweep::engine::RunError;
use crate::sweep::events::Attended;
use crate::sweep::{Event, Observer};

use super::digits::DigitsArgs;
use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::measure_text;
use super::output::warn_beyond_curve;
use super::run::{default_threads, parse_threads};
use super::say;
use super::signals::Signals;
use super::sweep_file::read_experiment;
use super::text_output::{Claimed, To};

/// Time between two notes of how far it is.
const BETWEEN_NOTES: Duration = Duration::from_secs(10);
/// The message after a signal.
const NONE: &str = "there is no measurement";

#[derive(Debug, clap::Args)]
#[command(
    after_help = "Each v0 is pulled under its setting until sliding has settled; then the \
elongation is averaged: its mean is mu_k, beside the law that was put in and beside the mean \
without control. v0 below v_c, or without a setting, are named before it begins.

Examples:
  slipmap measure sweeps/experiments/measure.toml
  slipmap measure sweeps/experiments/measure.toml -o measured.csv
  slipmap fit measured.csv --v0 0.1"
)]
pub(super) struct Args {
    /// The experiment: a case file without v0, with the table [experiment]
    #[arg(value_name = "EXPERIMENT.toml")]
    experiment: PathBuf,
    /// Write v0, mu_k, mu_k_error and settled as text, which `slipmap fit` and --table read; - for
    /// that on standard output, and nothing else there
    #[arg(short, long, value_name = "OUT.csv")]
    output: Option<PathBuf>,
    /// Replace a text that is already there
    #[arg(long, requires = "output")]
    fresh: bool,
    /// Threads to compute on [default: as many as the machine offers]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    #[command(flatten)]
    digits: DigitsArgs,
    /// One JSON object on standard output; null where there is no value
    #[arg(long)]
    json: bool,
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("measure").or::<Measurement>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let to = args.to()?;
    // Before the work, so that a name that cannot be written fails at once.
    let to = to.map(To::claim).transpose()?;
    let spec = read_experiment(&args.experiment)?;
    warn_beyond_curve(spec.setting.found_beyond_curve("v0", &spec.v0, &spec.units));
    let threads = args.threads.unwrap_or_else(default_threads);
    let failed = |error| failure(error, &signals);
    let settings = HowFar::of("settings chosen");
    let attended = Attended {
        observer: &settings,
        stop: &signals.stop,
    };
    let foretold = Foretold::of(spec, threads, attended).map_err(failed)?;
    for warning in measure_text::warnings(&foretold) {
        say::remark(format_args!("warning: {warning}"));
    }
    let means = HowFar::of("v0 measured");
    let attended = Attended {
        observer: &means,
        stop: &signals.stop,
    };
    let measured = foretold.measured(threads, attended).map_err(failed)?;
    if let Some(to) = to {
        let plain = matches!(to, Claimed::StandardOutput);
        let units = &foretold.spec().units;
        let rows = to.write(&signals, NONE, |out, _| {
            write_measured(&measured, units, out)
        })?;
        if plain {
            return Ok(());
        }
        args.tell(&foretold, &measured)?;
        return args.tell_path(rows);
    }
    args.tell(&foretold, &measured)
}

impl Args {
    /// Where the text is written, if anywhere.
    fn to(&self) -> Result<Option<To<'_>>, Failure> {
        let Some(path) = self.output.as_deref() else {
            return Ok(None);
        };
        match To::named(Some(path), Some(&self.experiment), self.fresh)? {
            To::StandardOutput if self.json => Err(Failure::bad_input(
                "--json and --output - both write to standard output",
            )),
            to => Ok(Some(to)),
        }
    }

    fn tell(&self, foretold: &Foretold, measured: &Measurement) -> Result<(), Failure> {
        if self.json {
            return json::print(&inputs(foretold.spec()), measured);
        }
        let (out, digits) = (&mut say::ForPeople::begin(), self.digits.get());
        Ok(measure_text::print(out, foretold, measured, digits)?)
    }

    fn tell_path(&self, rows: u64) -> Result<(), Failure> {
        match &self.output {
            Some(path) if !self.json => say::result(format_args!("{}: {rows} v0", path.display())),
            _ => Ok(()),
        }
    }
}

fn inputs(spec: &ExperimentSpec) -> Inputs {
    let searched = [Parameter::AlphaV, Parameter::AlphaN, Parameter::Tau];
    let given = spec.setting.control().act();
    let wanted = |p| p != Parameter::V0 && (given || !searched.contains(&p));
    Inputs::of_setting(&spec.setting, &spec.units, wanted)
        .and("control", measure_text::control(spec))
        .and("wait", spec.wait)
        .and("average", spec.average)
        .and("drift", spec.drift)
        .and("seed", spec.simulation.seed)
        .and("steps", spec.simulation.steps)
        .and("tolerance", spec.simulation.tolerance)
}

fn failure(error: RunError<Infallible>, signals: &Signals) -> Failure {
    match error {
        RunError::Interrupted => signals.interrupted(NONE),
        RunError::Model(error) => error.into(),
        other => Failure::failed(other.to_string()),
    }
}

/// Tells from time to time how far it is.
struct HowFar {
    what: &'static str,
    all: Cell<u64>,
    done: Cell<u64>,
    last: Cell<Instant>,
}

impl HowFar {
    fn of(what: &'static str) -> Self {
        Self {
            what,
            all: Cell::new(0),
            done: Cell::new(0),
            last: Cell::new(Instant::now()),
        }
    }
}

impl Observer for HowFar {
    fn event(&self, event: &Event) {
        match event {
            Event::Started { cells, .. } => self.all.set(*cells),
            Event::PieceDone { cells } => {
                self.done.set(self.done.get() + cells);
                if self.last.get().elapsed() >= BETWEEN_NOTES {
                    self.last.set(Instant::now());
                    let (done, all) = (self.done.get(), self.all.get());
                    say::note(format_args!("{done} of {all} {}", self.what));
                }
            }
            Event::Damaged { .. } | Event::Finished => {}
        }
    }
}
