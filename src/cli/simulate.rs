//! `slipmap simulate`: one motion in time, from a case file to its events, a trace and a picture.

use std::path::{Path, PathBuf};

use crate::answers::Trace;
use crate::answers::trace::TraceError;
use crate::explore::motion::{Followed, MotionSummary};
use crate::model::stop::Stop;
use crate::report::numbers::{grouped, unit_behind};
use crate::report::picture::{self, PictureOptions};
use crate::report::table::write_samples;
use crate::setting::point_file::{PointOf, PointSpec};
use crate::setting::setting_text::setting_text;
use crate::setting::simulation::DISTURBED;
use crate::setting::units::Units;
use crate::setting::{CaseSpec, Parameter, Setting};
use crate::store::{Output, StoreError, trace_file, trace_reader};
use crate::sweep::described::root::Provenance;
use crate::sweep::described::trace::QUANTITIES;
use crate::text::Shown;
use serde::Serialize;
use utoipa::ToSchema;

use super::asks::OfStickSlip;
use super::case_facts::CaseFacts;
use super::cell::{CellArgs, alone};
use super::digits::DigitsArgs;
use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::motion_text;
use super::output::{
    check_picture, output_path, provenance, save_picture, warn_beyond_curve, warn_of_idle_delay,
};
use super::parameters::ParameterArgs;
use super::plot;
use super::response::{ResponseArgs, ResponseOut, Told};
use super::return_map_args::ReturnMapArgs;
use super::say::{self, ForPeople};
use super::setting::SettingArgs;
use super::signals::Signals;
use super::start_args::StartArgs;
use super::sweep_file::read_case;
use super::text_output::{STANDARD_OUTPUT, To, is_csv};

#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  slipmap simulate sweeps/fig3a.toml
  slipmap simulate --setting setting.toml --x-dot0 0 --switch-on 70 --until 150
  slipmap simulate --system pi_loop --tau 1 --step reference --picture step.png")]
pub(super) struct Args {
    /// The case file
    #[arg(value_name = "CASE.toml", conflicts_with_all = ["map", "setting", "system"])]
    case: Option<PathBuf>,
    #[command(flatten)]
    response: ResponseArgs,
    #[command(flatten)]
    parameters: ParameterArgs<OfStickSlip>,
    #[command(flatten)]
    start: StartArgs,
    #[command(flatten)]
    return_map: ReturnMapArgs,
    #[command(flatten)]
    cell: CellArgs,
    #[command(flatten)]
    file: SettingArgs,
    /// The trace to write [default: the name of the file of the case or setting with .h5, in the
    /// current folder; with --map the map's name with -motion.h5, with flags motion.h5]. A name
    /// that ends in .csv: its samples as text; - for those on standard output, and nothing else
    /// there
    #[arg(short, long, value_name = "TRACE.h5")]
    output: Option<PathBuf>,
    /// The picture to draw, .png, .svg or .pdf [default: the trace's name with .png, beside it]
    #[arg(long, value_name = "PICTURE")]
    picture: Option<PathBuf>,
    /// Replace the trace of another case, or a text
    #[arg(long)]
    fresh: bool,
    #[command(flatten)]
    digits: DigitsArgs,
    /// One JSON object on standard output; null where there is no value
    #[arg(long)]
    json: bool,
}

/// The JSON of a motion, with the file of its trace.
#[derive(Debug, Serialize, ToSchema)]
struct MotionOut {
    #[serde(flatten)]
    summary: MotionSummary,
    trace: String,
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    let of = AnswerSchema::of("simulate");
    of.or::<MotionOut>().or::<ResponseOut>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    if args.response.is_given() {
        return args.respond(&signals);
    }
    args.check_alone()?;
    let spec = args.read()?;
    // A cell of a map has a delay whatever its gains are; flags are checked when they are read.
    warn_of_idle_delay(args.case.is_some() && spec.setting.has_idle_delay());
    if args.case.is_some() || args.cell.map.is_some() {
        warn_beyond_curve(spec.setting.beyond_curve(&spec.units));
    }
    if let Some(remark) = spec.resolution_remark() {
        say::remark(format_args!("warning: {remark}"));
    }
    if spec.start_assumed {
        say::note(format_args!(
            "no start is given: the block begins with x_dot0 = {}{}, {} % faster than it is \
             pulled",
            Shown(spec.case.initial_state().0),
            unit_behind(&spec.units.of_parameter(Parameter::XDot0)),
            100.0 * DISTURBED,
        ));
    }
    if let Some(to) = args.text()? {
        return simulate_to_text(args, to, &spec, &signals);
    }
    let path = args.output_path()?;
    if let Some(picture) = &args.picture {
        check_picture("--picture", picture, Some(&path))?;
    }
    check_replaced(&path, &spec, args.fresh)?;
    let trace = args.follow(&spec, &signals)?;
    let output = Output::claim(&path)?;
    trace_file::write(&spec, &trace, output, &args.provenance())?;
    args.tell(&spec, &trace, &path)?;
    args.draw_and_tell(&spec, &trace, &path, &signals)
}

/// Writes only the samples, as text.
fn simulate_to_text(
    args: &Args,
    to: To,
    spec: &CaseSpec,
    signals: &Signals,
) -> Result<(), Failure> {
    if let Some(picture) = &args.picture {
        let other = match to {
            To::File(path) => Some(path),
            To::StandardOutput => None,
        };
        check_picture("--picture", picture, other)?;
    }
    let trace = args.follow(spec, signals)?;
    let quantities: Vec<_> = QUANTITIES.iter().collect();
    to.write(signals, "there is no trace", |out, stop| {
        write_samples(spec, &trace, &quantities, false, out, stop)
    })?;
    match to {
        To::File(path) => {
            args.tell(spec, &trace, path)?;
            args.draw_and_tell(spec, &trace, path, signals)
        }
        To::StandardOutput if args.picture.is_some() => {
            let nameless = Path::new(STANDARD_OUTPUT);
            draw(args, spec, &trace, nameless, signals).map(drop)
        }
        To::StandardOutput => Ok(()),
    }
}

impl Args {
    /// The response of a system from a file.
    fn respond(&self, signals: &Signals) -> Result<(), Failure> {
        let others = self.cell.map.is_some() || self.file.is_given() || self.return_map.any();
        let Some(asked) = self.response.asked(&self.parameters, others)? else {
            return Ok(());
        };
        let output = self.output.as_deref();
        let told = Told {
            until: self.start.of_response(&asked.units)?,
            samples: output.map(|path| self.samples(Some(path))).transpose()?,
            picture: self.picture.as_deref(),
            digits: self.digits.get(),
            json: self.json,
        };
        self.response.main(&asked, &told, signals)
    }

    fn follow(&self, spec: &CaseSpec, signals: &Signals) -> Result<Trace, Failure> {
        let followed = signals.or_end("there is no trace", || {
            Followed::whole(spec, &Stop::default())
        });
        let followed = followed.map_err(|error| match error {
            TraceError::TooLong(_) => {
                let from = match &self.case {
                    Some(case) => case.display().to_string(),
                    None => "the case".to_owned(),
                };
                Failure::in_file(spec.too_long(error.to_string()), &from, &spec.text)
            }
            error => failure(&error),
        })?;
        warn_beyond_curve(followed.beyond_curve());
        Ok(followed.trace)
    }

    /// Reads the case.
    fn read(&self) -> Result<CaseSpec, Failure> {
        if let Some(case) = &self.case {
            return read_case(case);
        }
        let (from, text) = match (self.cell.case()?, self.file.point(PointOf::Sliding)?) {
            (Some(text), _) => ("the cell", text),
            (None, Some(PointSpec { setting, units, .. })) => {
                ("the setting", self.case_of(&setting, &units)?)
            }
            (None, None) => ("the flags", self.case_of_flags()?),
        };
        let spec = text.parse();
        spec.map_err(|error| Failure::in_file(error, from, &text))
    }

    /// The text of a case file for the flags, which is stored in the trace.
    fn case_of_flags(&self) -> Result<String, Failure> {
        if !self.parameters.any_but(&[]) {
            return Err(Failure::bad_input_with_help(
                "no case is given",
                "slipmap simulate CASE.toml; or flags, such as --friction weakening --mu0 0.5 \
                 --v-s 0.5 --v0 0.1; or --setting SETTING.toml; or a cell of a map: --map MAP.h5 \
                 --at AXIS=VALUE",
            ));
        }
        let setting = self.parameters.setting()?;
        self.parameters
            .tell_static_friction("when sticks end depends on it");
        self.case_of(&setting, &self.parameters.units())
    }

    /// The text of a case file for a setting, with the start and the end of the flags.
    fn case_of(&self, setting: &Setting, units: &Units) -> Result<String, Failure> {
        let setting = setting_text(setting, units, |_| true);
        let feedback = self.return_map.table(units)?;
        self.start.case(&(setting + &feedback), units)
    }

    /// Checks that no flags that it says itself accompany a case, a map or a setting.
    fn check_alone(&self) -> Result<(), Failure> {
        let flags = self.parameters.any_but(&[]);
        let of_motion = self.start.any() || self.return_map.any();
        match (&self.case, &self.cell.map) {
            (Some(_), _) => alone("CASE.toml", flags || of_motion),
            (None, Some(_)) => alone("--map", flags || of_motion),
            (None, None) if self.file.is_given() => alone("--setting", flags),
            (None, None) => Ok(()),
        }
    }

    /// Where samples are written as text; none if the trace is written as HDF5.
    fn text(&self) -> Result<Option<To<'_>>, Failure> {
        let Some(path) = &self.output else {
            return Ok(None);
        };
        if path != Path::new(STANDARD_OUTPUT) && !is_csv(path) {
            return Ok(None);
        }
        self.samples(Some(path)).map(Some)
    }

    /// Where samples go as text.
    fn samples<'p>(&self, path: Option<&'p Path>) -> Result<To<'p>, Failure> {
        match To::named(path, self.case.as_deref(), self.fresh)? {
            To::StandardOutput if self.json => Err(Failure::bad_input(
                "--json and --output - both write to standard output",
            )),
            to => Ok(to),
        }
    }

    /// Reports the outcome of the motion, and the path of its trace.
    fn tell(&self, spec: &CaseSpec, trace: &Trace, path: &Path) -> Result<(), Failure> {
        if self.json {
            let inputs = Inputs::default().and("case", CaseFacts::of(spec));
            let answer = MotionOut {
                summary: MotionSummary::of(trace),
                trace: path.display().to_string(),
            };
            return json::print(&inputs, &answer);
        }
        motion_text::print(&mut ForPeople::begin(), spec, trace, self.digits.get())?;
        let samples = grouped(trace.samples.len() as u64);
        say::result(format_args!("{}: {samples} samples", path.display()))
    }

    fn draw_and_tell(
        &self,
        spec: &CaseSpec,
        trace: &Trace,
        path: &Path,
        signals: &Signals,
    ) -> Result<(), Failure> {
        let drawn = draw(self, spec, trace, path, signals)?;
        match drawn.filter(|_| !self.json) {
            Some(picture) => say::result(picture.display()),
            None => Ok(()),
        }
    }

    /// The path of the trace: from the name of the case, the setting or the map.
    fn output_path(&self) -> Result<PathBuf, Failure> {
        let map = self.cell.map.as_deref().and_then(Path::file_stem);
        let of_map = map.map(|stem| {
            let mut name = stem.to_owned();
            name.push("-motion.h5");
            PathBuf::from(name)
        });
        let given = self.output.as_deref().or(of_map.as_deref());
        let case = self.case.as_deref().or(self.file.path());
        let case = case.unwrap_or(Path::new("motion"));
        output_path(given, case, "trace")
    }

    /// The provenance of the trace.
    fn provenance(&self) -> Provenance {
        match (&self.case, &self.cell.map, self.file.path()) {
            (Some(case), ..) => provenance("simulate", case),
            (_, Some(map), _) => provenance(&format!("simulate{} --map", self.cell.words()), map),
            (.., Some(setting)) => provenance("simulate --setting", setting),
            (None, None, None) => provenance("simulate", Path::new("(flags)")),
        }
    }
}

/// An error if the file at `path` must not be replaced: only traces may be, and those of other
/// cases only with `fresh`.
fn check_replaced(path: &Path, spec: &CaseSpec, fresh: bool) -> Result<(), Failure> {
    if !path.exists() {
        return Ok(());
    }
    let name = path.display();
    match trace_reader::case_of(path) {
        Ok(text) if fresh || text == spec.text => Ok(()),
        Ok(_) => Err(Failure::bad_input_with_help(
            format!(
                "{name} is already there: the trace of another case, or of this one before it \
                changed"
            ),
            "--fresh replaces it; -o writes elsewhere",
        )),
        Err(StoreError::NotATrace { why, .. }) => Err(Failure::bad_input_with_help(
            format!("{name} is already there and no trace of slipmap: {why}"),
            "it is left as it is; remove it first, or write elsewhere with -o",
        )),
        Err(error @ (StoreError::DamagedFile { .. } | StoreError::DamagedMap { .. })) => {
            Err(Failure::failed_with_help(
                error.to_string(),
                "it is left as it is; remove it first, or write elsewhere with -o",
            ))
        }
        Err(error) => Err(error.into()),
    }
}

/// Draws the picture. Under a default name it replaces only files of slipmap, and a failure is only
/// a warning.
fn draw(
    args: &Args,
    spec: &CaseSpec,
    trace: &Trace,
    path: &Path,
    signals: &Signals,
) -> Result<Option<PathBuf>, Failure> {
    let draw = |picture: &Path| {
        let complete = format!("{} is complete, its picture is not drawn", path.display());
        let options = PictureOptions::default();
        signals.or_end(complete, || {
            picture::draw_trace(spec, trace, path, picture, &options)
        })
    };
    save_picture(args.picture.as_deref(), plot::beside(path), draw)
}

fn failure(error: &TraceError) -> Failure {
    match error {
        TraceError::Case(_)
        | TraceError::TooLong(_)
        | TraceError::TooManyEvents(_)
        | TraceError::TooManySteps(_) => Failure::bad_input(error.to_string()),
        TraceError::Stopped => Failure::failed(error.to_string()),
        TraceError::NoFriction(_) => Failure::bad_input_with_help(
            error.to_string(),
            "mu_k has to be positive and finite at every speed of the block; [trace] until = … \
             ends the motion before",
        ),
        TraceError::OutgrowsPast => Failure::bad_input_with_help(
            error.to_string(),
            "a larger tolerance takes fewer steps, [trace] until = … ends it earlier",
        ),
    }
}
