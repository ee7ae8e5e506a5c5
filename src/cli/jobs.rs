//! `slipmap jobs`: the sweeps of a queue, and changes of them.

use std::path::PathBuf;
use std::time::Duration;

use serde::Serialize;
use utoipa::ToSchema;

use crate::queue::change::{Change, change, failed_before, no_such_job};
use crate::queue::facts::JobFacts;
use crate::queue::folder::Folder;
use crate::queue::name::Name;
use crate::queue::progress::Progress;
use crate::queue::states::{Job, Looks, State, jobs};
use crate::report::numbers::grouped;

use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::say::{self, Rows};
use super::status::speed;

/// The most failed and the most done jobs that are listed for people.
const MOST_OVER: usize = 20;
/// The widest column of names.
const WIDEST: usize = 40;

#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(super) struct Args {
    /// The folder of the queue and of its maps
    #[arg(value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    /// Print one JSON object instead
    #[arg(long)]
    json: bool,
    #[command(subcommand)]
    change: Option<Asked>,
}

#[derive(Debug, clap::Subcommand)]
enum Asked {
    /// Stop a sweep, or let it not begin
    Hold(Of),
    /// Let a sweep that is held, or failed, wait for a worker again
    Release(ReleaseArgs),
    /// Put a sweep before all that wait
    First(Of),
    /// Take a sweep out; its map stays
    Drop(DropArgs),
}

/// The jobs to change.
#[derive(Debug, clap::Args)]
struct Of {
    /// The names of the sweeps, as `slipmap jobs` lists them
    #[arg(value_name = "NAME", required = true)]
    names: Vec<String>,
    /// The folder of the queue
    #[arg(long = "in", value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
}

#[derive(Debug, clap::Args)]
struct ReleaseArgs {
    #[command(flatten)]
    of: Of,
    /// Start over, dropping what is computed of their maps
    #[arg(long)]
    fresh: bool,
}

#[derive(Debug, clap::Args)]
struct DropArgs {
    /// The names of the sweeps, as `slipmap jobs` lists them
    #[arg(value_name = "NAME", required_unless_present = "failed")]
    names: Vec<String>,
    /// The folder of the queue
    #[arg(long = "in", value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    /// All sweeps that failed
    #[arg(long, conflicts_with = "names")]
    failed: bool,
    /// Only those that failed so long ago, such as 30d or 12h
    #[arg(long, value_name = "AGE", requires = "failed", value_parser = parse_age)]
    older: Option<Duration>,
    /// What is computed of their maps goes too, unless the map is complete
    #[arg(long)]
    tiles: bool,
}

/// Reads the time of an `--older` flag.
fn parse_age(text: &str) -> Result<Duration, String> {
    humantime::parse_duration(text).map_err(|_| "expected a time such as 30d or 12h".to_owned())
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("jobs").or::<JobsAnswer>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let Some(asked) = &args.change else {
        return list(args);
    };
    let (folder, names, what) = match asked {
        Asked::Hold(of) => (&of.folder, &of.names, Change::Hold),
        Asked::Release(ReleaseArgs { of, fresh }) => {
            (&of.folder, &of.names, Change::Release { fresh: *fresh })
        }
        Asked::First(of) => (&of.folder, &of.names, Change::First),
        Asked::Drop(of) => (&of.folder, &of.names, Change::Drop { tiles: of.tiles }),
    };
    let folder = Folder::at(folder);
    check(&folder)?;
    let names: Vec<Name> = match asked {
        Asked::Drop(of) if of.failed => failed_before(&folder, of.older.unwrap_or_default())?,
        _ => {
            let given = |name: &String| named(&folder, name);
            names.iter().map(given).collect::<Result<_, _>>()?
        }
    };
    if names.is_empty() {
        return say::result("no sweep is to be dropped");
    }
    for name in &names {
        let now = change(&folder, name, what)?;
        let became = match what {
            Change::Hold => "is held",
            Change::Release { .. } => "waits",
            Change::First => "is the first",
            Change::Drop { .. } => "is dropped",
        };
        match now == *name {
            true => say::result(format_args!("{name}: {became}"))?,
            false => say::result(format_args!("{name}: {became}, as {now}"))?,
        }
    }
    Ok(())
}

/// The job of a name that a user gives.
fn named(folder: &Folder, name: &str) -> Result<Name, Failure> {
    Name::given(name).ok_or_else(|| no_such_job(folder, name).into())
}

/// Refuses a folder without a queue.
fn check(folder: &Folder) -> Result<(), Failure> {
    if folder.exists() {
        return Ok(());
    }
    let path = folder.path().display();
    Err(Failure::bad_input_with_help(
        format!("{path} has no queue"),
        format!("`slipmap submit SWEEP.toml --to {path}` makes one"),
    ))
}

fn list(args: &Args) -> Result<(), Failure> {
    let folder = Folder::at(&args.folder);
    check(&folder)?;
    let jobs = jobs(&folder, &mut Looks::default())?;
    if args.json {
        let answer = JobsAnswer {
            attended: folder.is_attended(),
            jobs: { jobs.iter() }
                .map(|job| JobFacts::of(job, &folder.map(&job.name)))
                .collect(),
        };
        return json::print(&Inputs::default().and("folder", &args.folder), &answer);
    }
    tell(&folder, &jobs)
}

/// The sweeps of a queue.
#[derive(Serialize, ToSchema)]
struct JobsAnswer {
    /// Whether a worker is there.
    attended: bool,
    /// Those that run or wait in their order, then those held, failed and done.
    jobs: Vec<JobFacts>,
}

/// Prints a line for each job. Of those that are over, the last are printed.
fn tell(folder: &Folder, jobs: &[Job]) -> Result<(), Failure> {
    if jobs.is_empty() {
        return say::result(format_args!(
            "nothing waits in {0}; `slipmap submit SWEEP.toml --to {0}` puts a sweep in",
            folder.path().display()
        ));
    }
    let widest = jobs
        .iter()
        .map(|job| job.name.to_string().chars().count())
        .max();
    let widest = widest.unwrap_or(0).min(WIDEST);
    let mut rows = Rows::begin();
    for state in [
        State::Running,
        State::Waiting,
        State::Held,
        State::Failed,
        State::Done,
    ] {
        let of_state: Vec<&Job> = jobs.iter().filter(|job| job.state == state).collect();
        let is_over = matches!(state, State::Failed | State::Done);
        let left_out = match is_over {
            true => of_state.len().saturating_sub(MOST_OVER),
            false => 0,
        };
        if left_out > 0 {
            let left_out = grouped(left_out as u64);
            rows.row(state.name(), format!("{left_out} more before these"))?;
        }
        for job in &of_state[left_out..] {
            let name = format!("{:<widest$}", job.name.to_string());
            let text = format!("{name}  {}", said(folder, job));
            rows.row(state.name(), text.trim_end())?;
        }
    }
    drop(rows);
    let waiting = jobs.iter().any(|job| job.state == State::Waiting);
    if waiting && !folder.is_attended() {
        say::note(format_args!(
            "no worker is there: `slipmap work {}` computes what waits",
            folder.path().display()
        ));
    }
    Ok(())
}

/// What is said of a job behind its name.
fn said(folder: &Folder, job: &Job) -> String {
    let first_line = |why: &String| {
        let line = why.lines().next().unwrap_or_default();
        line.trim_start_matches([' ', '×']).trim_end().to_owned()
    };
    let mut parts: Vec<String> = job.progress.iter().map(how_far).collect();
    match job.state {
        State::Done => parts.push(folder.map(&job.name).display().to_string()),
        _ => parts.extend(job.why.as_ref().map(first_line)),
    }
    parts.join(", ")
}

/// How far a map is.
pub(super) fn how_far(progress: &Progress) -> String {
    let (percent, cells) = (progress.percent(), grouped(progress.cells));
    let cells = format!("{percent:.1} % of {cells} cells");
    match speed(progress) {
        Some(speed) => format!("{cells}, {speed}"),
        None => cells,
    }
}
