//! `slipmap status`: the progress of a map, from another terminal.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::linear::status::FLAGS;
use crate::report::log::{self, Entry, LogLine};
use crate::report::numbers::{grouped, prefixed, seconds};
use crate::store::tiles::Survey;
use crate::store::tiles::survey::ShardSurvey;
use crate::store::{MapFile, StatusCounts, regular};
use serde::Serialize;
use utoipa::ToSchema;

use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::say::Rows;

/// The most bytes of a log that are read for the rate of a run.
const MOST_OF_LOG: u64 = 64 << 20;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The map, there or still to come
    #[arg(value_name = "MAP.h5")]
    map: PathBuf,
    /// Print one JSON object instead
    #[arg(long)]
    json: bool,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let status = match Survey::of(&args.map)? {
        Some(survey) => of_tiles(&args.map, &survey),
        None => of_map(&args.map)?,
    };
    if args.json {
        return json::print(&Inputs::default().and("map", &args.map), &status.answer());
    }
    status.print(&args.map)
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("status").or::<StatusAnswer>()
}

/// How far a map is.
#[derive(Serialize, ToSchema)]
struct StatusAnswer {
    complete: bool,
    /// Whether a run works on it.
    running: bool,
    cells: u64,
    cells_done: u64,
    /// Of the runs that work on it; null where none does.
    #[schema(required)]
    cells_per_second: Option<f64>,
    /// Until the slowest of them is done; null where that is not known.
    #[schema(required)]
    seconds_left: Option<f64>,
    /// Cells with each flag, and `unflagged` ones.
    #[schema(value_type = BTreeMap<String, u64>)]
    cells_by_status: BTreeMap<&'static str, u64>,
    shards: Vec<ShardAnswer>,
}

/// How far a shard of a map is.
#[derive(Serialize, ToSchema)]
struct ShardAnswer {
    /// Which of how many: `1/4`.
    shard: String,
    running: bool,
    cells: u64,
    cells_done: u64,
    /// Tiles, planes of curves and of best settings.
    pieces: u64,
    pieces_done: u64,
    damaged_files: u64,
    /// Of the run that works on it; null where none does.
    #[schema(required)]
    cells_per_second: Option<f64>,
    /// Until it is done; null where that is not known.
    #[schema(required)]
    seconds_left: Option<f64>,
}

impl ShardAnswer {
    fn of(shard: &ShardStatus) -> Self {
        Self {
            shard: shard.shard.clone(),
            running: shard.running,
            cells: shard.cells,
            cells_done: shard.cells_done,
            pieces: shard.pieces,
            pieces_done: shard.pieces_done,
            damaged_files: shard.damaged_files,
            cells_per_second: shard.rate,
            seconds_left: shard.seconds_left(),
        }
    }
}

/// The progress of a map, as JSON and for people.
struct Status {
    complete: bool,
    cells: u64,
    cells_done: u64,
    statuses: StatusCounts,
    shards: Vec<ShardStatus>,
}

struct ShardStatus {
    shard: String,
    running: bool,
    cells: u64,
    cells_done: u64,
    pieces: u64,
    pieces_done: u64,
    damaged_files: u64,
    /// Cells per second of the run that works on it.
    rate: Option<f64>,
}

impl ShardStatus {
    fn seconds_left(&self) -> Option<f64> {
        let rate = self.rate.filter(|rate| *rate > 0.0)?;
        Some(self.cells.saturating_sub(self.cells_done) as f64 / rate)
    }
}

fn of_map(path: &Path) -> Result<Status, Failure> {
    let map = MapFile::open(path)?;
    let missing = map.cells_missing();
    Ok(Status {
        complete: missing == 0,
        cells: map.cells(),
        cells_done: map.cells() - missing.min(map.cells()),
        statuses: map.status_counts()?,
        shards: Vec::new(),
    })
}

fn of_tiles(map: &Path, survey: &Survey) -> Status {
    let shard = |found: &ShardSurvey| ShardStatus {
        shard: found.shard.to_string(),
        running: found.running,
        cells: found.cells,
        cells_done: found.cells_done,
        pieces: found.pieces,
        pieces_done: found.pieces_done,
        damaged_files: found.damaged.len() as u64,
        rate: rate(map, found),
    };
    Status {
        complete: MapFile::open(map).is_ok_and(|map| !map.is_partial()),
        cells: survey.plan.cells(),
        cells_done: survey.cells_done,
        statuses: survey.statuses,
        shards: survey.shards.iter().map(shard).collect(),
    }
}

/// Cells per second since the current run of a shard started, from its log and its tiles.
fn rate(map: &Path, found: &ShardSurvey) -> Option<f64> {
    if !found.running {
        return None;
    }
    let path = log::path(map, found.shard);
    // A file of another kind may be one long line.
    let log = regular::open(&path).ok()?.take(MOST_OF_LOG);
    let lines = BufReader::new(log).lines().map_while(Result::ok);
    let lines = lines.filter_map(|line| serde_json::from_str::<LogLine>(&line).ok());
    let started = lines.filter_map(|line| match line.entry {
        Entry::Started { cells_left, .. } => Some((line.time, cells_left)),
        _ => None,
    });
    let (time, left) = started.last()?;
    let since = humantime::parse_rfc3339(&time).ok()?;
    // After the clock was set back, there is no rate.
    let elapsed = SystemTime::now().duration_since(since).ok()?;
    let computed = found
        .cells_done
        .saturating_sub(found.cells.saturating_sub(left));
    Some(computed as f64 / elapsed.as_secs_f64().max(1e-3))
}

impl Status {
    fn running(&self) -> bool {
        self.shards.iter().any(|shard| shard.running)
    }

    fn rate(&self) -> Option<f64> {
        let rates: Vec<f64> = self.shards.iter().filter_map(|s| s.rate).collect();
        (!rates.is_empty()).then(|| rates.iter().sum())
    }

    /// Seconds until the slowest running shard is done.
    fn seconds_left(&self) -> Option<f64> {
        let left = self.shards.iter().filter_map(ShardStatus::seconds_left);
        left.reduce(f64::max)
    }

    fn answer(&self) -> StatusAnswer {
        let flags = FLAGS.iter().zip(self.statuses.flagged);
        let flagged = flags.map(|((_, name), count)| (*name, count));
        let unflagged = [("unflagged", self.statuses.unflagged)];
        StatusAnswer {
            complete: self.complete,
            running: self.running(),
            cells: self.cells,
            cells_done: self.cells_done,
            cells_per_second: self.rate(),
            seconds_left: self.seconds_left(),
            cells_by_status: flagged.chain(unflagged).collect(),
            shards: self.shards.iter().map(ShardAnswer::of).collect(),
        }
    }

    fn print(&self, map: &Path) -> Result<(), Failure> {
        let mut rows = Rows::begin();
        rows.row("map", format!("{}: {}", map.display(), self.state()))?;
        let share = 100.0 * self.cells_done as f64 / self.cells.max(1) as f64;
        let (done, cells) = (grouped(self.cells_done), grouped(self.cells));
        let done = format!("{done} of {cells} are done ({share:.1} %)");
        rows.row("cells", done)?;
        if let Some(rate) = self.rate() {
            let left = self.seconds_left().map_or("unknown".to_owned(), seconds);
            rows.row("rate", format!("{} cells/s, {left} left", prefixed(rate)))?;
        }
        let flagged = FLAGS.iter().map(|(_, name)| *name);
        let flagged = flagged.zip(self.statuses.flagged);
        for (name, count) in flagged.filter(|(_, count)| *count > 0) {
            rows.row("status", format!("{name:<14} {} cells", grouped(count)))?;
        }
        let unflagged = grouped(self.statuses.unflagged);
        rows.row("status", format!("{:<14} {unflagged} cells", "unflagged"))?;
        for s in self.shards.iter().filter(|_| self.shards.len() > 1) {
            let state = if s.running { ", running" } else { "" };
            let (done, pieces) = (grouped(s.pieces_done), grouped(s.pieces));
            let text = format!("{:<8} {done} of {pieces} pieces{state}", s.shard);
            rows.row("shard", text)?;
        }
        for s in self.shards.iter().filter(|s| s.damaged_files > 0) {
            let (files, shard) = (grouped(s.damaged_files), &s.shard);
            let text = format!("{files} files of shard {shard}: the next run mends them");
            rows.row("damaged", text)?;
        }
        Ok(())
    }

    fn state(&self) -> &'static str {
        match (self.complete, self.running()) {
            (true, _) if self.shards.is_empty() => "complete",
            (true, true) => "complete, and being computed again",
            (true, false) => "complete; what is computed of another one is told here",
            (false, true) => "running",
            (false, false) if self.cells_done == self.cells && self.shards.len() > 1 => {
                "all shards are complete; `slipmap merge` makes the map"
            }
            (false, false) => {
                "not complete, and no run works on it; the command that began it goes on"
            }
        }
    }
}
