//! `slipmap verify`: whether a map is as it was written, and what other methods give for a sample
//! of its cells; whether a trace follows from its case.

use std::path::{Path, PathBuf};

use crate::maps::check::{Effort, Program, Report, check};
use crate::maps::check_trace::{TraceReport, check_trace};
use crate::report::numbers::grouped;
use crate::store::tiles::Survey;
use crate::store::{MapFile, TraceFile, trace_reader};
use crate::sweep::cells::second_look::Question;
use serde::Serialize;
use utoipa::ToSchema;

use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::say::Rows;
use super::signals::Signals;

/// The most cells or tiles that may be computed again.
const MOST: u64 = 100_000_000;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The map, or the trace of a motion
    #[arg(value_name = "FILE.h5")]
    map: PathBuf,
    /// Cells of a map to check by a second method, spread over the map
    #[arg(long, value_name = "N", default_value_t = 100,
          value_parser = clap::value_parser!(u64).range(..=MOST))]
    cells: u64,
    /// Tiles of a map that are computed again, to be equal bit by bit
    #[arg(long, value_name = "N", default_value_t = 2,
          value_parser = clap::value_parser!(u64).range(..=MOST))]
    tiles: u64,
    /// Print one JSON object instead
    #[arg(long)]
    json: bool,
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("verify")
        .or::<MapAnswer>()
        .or::<TraceAnswer>()
}

impl Args {
    fn inputs(&self) -> Inputs {
        let inputs = Inputs::default().and("file", &self.map);
        inputs.and("cells", self.cells).and("tiles", self.tiles)
    }
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let program = Program {
        version: crate::VERSION,
        revision: crate::REVISION,
    };
    if trace_reader::is_trace(&args.map) {
        return verify_trace(args, program);
    }
    refuse_unfinished(&args.map)?;
    let map = MapFile::open_to_check(&args.map)?;
    let effort = Effort {
        cells: args.cells,
        tiles: args.tiles,
    };
    let report = check(&map, program, effort)?;
    let told = match args.json {
        true => json::print(&args.inputs(), &MapAnswer::from(&report)),
        false => print(&report),
    };
    verdict(&args.map, report.faults.len(), told)
}

/// The result of a check. It does not depend on whether the output could be written.
fn verdict(path: &Path, faults: usize, told: Result<(), Failure>) -> Result<(), Failure> {
    let path = path.display();
    match faults {
        0 => told,
        1 => Err(Failure::failed(format!("{path}: 1 fault"))),
        n => Err(Failure::failed(format!("{path}: {n} faults"))),
    }
}

/// Refuses a map that has tiles but no file: it is not complete, so there is nothing to verify.
fn refuse_unfinished(path: &Path) -> Result<(), Failure> {
    if path.exists() {
        return Ok(());
    }
    let Some(survey) = Survey::of(path)? else {
        return Ok(());
    };
    let (done, cells) = (grouped(survey.cells_done), grouped(survey.plan.cells()));
    let path = path.display();
    Err(Failure::bad_input_with_help(
        format!("{path} is not complete: {done} of {cells} cells are in its tiles"),
        format!(
            "the `slipmap run` that began it goes on, and checks every tile as it reads it; \
             `slipmap merge --partial {path}` makes a map of what is there"
        ),
    ))
}

fn verify_trace(args: &Args, program: Program) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let report = signals.or_end("nothing is verified", || {
        TraceFile::open(&args.map).map(|file| check_trace(&file, program))
    })?;
    let told = match args.json {
        true => json::print(
            &Inputs::default().and("file", &args.map),
            &TraceAnswer::from(&report),
        ),
        false => print_trace(&report),
    };
    verdict(&args.map, report.faults.len(), told)
}

/// What was found out about a trace.
#[derive(Serialize, ToSchema)]
struct TraceAnswer {
    /// `trace`.
    kind: &'static str,
    sound: bool,
    faults: Vec<String>,
    remarks: Vec<String>,
    /// Samples of the motion that was computed again, and those that are in the trace, bit by bit.
    samples: u64,
    samples_equal: u64,
    /// Events likewise.
    events: u64,
    events_equal: u64,
}

impl From<&TraceReport> for TraceAnswer {
    fn from(report: &TraceReport) -> Self {
        Self {
            kind: "trace",
            sound: report.faults.is_empty(),
            faults: report.faults.clone(),
            remarks: report.remarks.clone(),
            samples: report.samples,
            samples_equal: report.samples_equal,
            events: report.events,
            events_equal: report.events_equal,
        }
    }
}

fn print_trace(report: &TraceReport) -> Result<(), Failure> {
    let mut rows = Rows::begin();
    for (name, equal, of) in [
        ("samples", report.samples_equal, report.samples),
        ("events", report.events_equal, report.events),
    ] {
        let (equal, of) = (grouped(equal), grouped(of));
        let text = format!("{equal} of {of} computed again are the same, bit by bit");
        rows.row(name, text)?;
    }
    print_findings(&mut rows, &report.remarks, &report.faults)
}

fn print_findings(rows: &mut Rows, remarks: &[String], faults: &[String]) -> Result<(), Failure> {
    let remarks = remarks.iter().map(|remark| ("remark", remark));
    let faults = faults.iter().map(|fault| ("fault", fault));
    remarks
        .chain(faults)
        .try_for_each(|(name, text)| rows.row(name, text))
}

/// What was found out about a map.
#[derive(Serialize, ToSchema)]
struct MapAnswer {
    /// `map`.
    kind: &'static str,
    sound: bool,
    faults: Vec<String>,
    remarks: Vec<String>,
    /// Checksums that fit.
    checksums: u64,
    /// Cells at which second methods looked.
    cells: u64,
    answers: Vec<MethodAnswer>,
    /// Tiles that were computed again, and how many of them came out with the same bytes.
    tiles: u64,
    tiles_equal: u64,
    /// Tiles that were to be, and are not in a map that is not complete.
    tiles_absent: u64,
}

/// What second methods say about a field: the number of cells at which they agree, differ, and do
/// not know.
#[derive(Serialize, ToSchema)]
struct MethodAnswer {
    question: &'static str,
    agree: u64,
    differ: u64,
    open: u64,
}

impl From<&Report> for MapAnswer {
    fn from(report: &Report) -> Self {
        let answers = report.answers.iter();
        let answer = |(question, [agree, differ, open]): &(Question, [u64; 3])| MethodAnswer {
            question: question.name(),
            agree: *agree,
            differ: *differ,
            open: *open,
        };
        Self {
            kind: "map",
            sound: report.faults.is_empty(),
            faults: report.faults.clone(),
            remarks: report.remarks.clone(),
            checksums: report.checksums,
            cells: report.cells,
            answers: answers.map(answer).collect(),
            tiles: report.tiles,
            tiles_equal: report.tiles_equal,
            tiles_absent: report.tiles_absent,
        }
    }
}

fn print(report: &Report) -> Result<(), Failure> {
    let mut rows = Rows::begin();
    let checksums = report.checksums;
    rows.row("checksums", format!("{checksums} fit"))?;
    if report.cells > 0 {
        let cells = grouped(report.cells);
        rows.row("cells", format!("{cells} looked at by second methods"))?;
    }
    for (question, [agree, differ, open]) in &report.answers {
        let counts = format!("{agree} agree, {differ} differ, {open} open");
        rows.row("", format!("{:<38} {counts}", question.name()))?;
    }
    if report.tiles + report.tiles_absent > 0 {
        let (equal, of) = (report.tiles_equal, report.tiles);
        let absent = match report.tiles_absent {
            0 => String::new(),
            absent => format!("; {absent} more are not in the map"),
        };
        let text = format!("{equal} of {of} computed again are the same, bit by bit{absent}");
        rows.row("tiles", text)?;
    }
    print_findings(&mut rows, &report.remarks, &report.faults)
}
