//! `slipmap status`: the progress of maps, from another terminal.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::linear::status::FLAGS;
use crate::queue::facts::ShardFacts;
use crate::queue::progress::{Progress, ShardProgress};
use crate::report::numbers::{grouped, prefixed, seconds};
use crate::store::tiles::Survey;
use crate::store::{MapFile, StatusCounts};
use serde::Serialize;
use utoipa::ToSchema;

use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::say::Rows;
use super::status_list::{self, ListAnswer};

#[derive(Debug, clap::Args)]
#[command(after_help = "Examples: slipmap status maps/\n          \
    slipmap status a.h5 b.h5")]
pub(super) struct Args {
    /// The map, there or still to come. Of several, and of the maps in folders, a line each
    #[arg(value_name = "MAP.h5|FOLDER", required = true)]
    paths: Vec<PathBuf>,
    /// Print one JSON object instead
    #[arg(long)]
    json: bool,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    match &*args.paths {
        [map] if !map.is_dir() => main_of_one(map, args.json),
        paths => status_list::main(paths, args.json),
    }
}

fn main_of_one(map: &Path, json: bool) -> Result<(), Failure> {
    let status = match Survey::of(map)? {
        Some(survey) => Status::of_tiles(map, &survey),
        None => Status::of_map(map)?,
    };
    if json {
        return json::print(&Inputs::default().and("map", map), &status.answer());
    }
    status.print(map)
}

/// The rate of a map that is computed, and how long it takes; none where no run works on it.
pub(super) fn speed(progress: &Progress) -> Option<String> {
    let rate = progress.cells_per_second()?;
    let left = progress.seconds_left();
    let left = left.map_or("unknown".to_owned(), seconds);
    Some(format!("{} cells/s, {left} left", prefixed(rate)))
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("status")
        .or::<StatusAnswer>()
        .or::<ListAnswer>()
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

/// How far a shard of a map is, and its files.
#[derive(Serialize, ToSchema)]
struct ShardAnswer {
    #[serde(flatten)]
    facts: ShardFacts,
    /// Tiles, planes of curves and of best settings.
    pieces: u64,
    pieces_done: u64,
    damaged_files: u64,
}

impl ShardAnswer {
    fn of((shard, damaged_files): (&ShardProgress, u64)) -> Self {
        Self {
            facts: ShardFacts::of(shard),
            pieces: shard.done.pieces,
            pieces_done: shard.done.pieces_done,
            damaged_files,
        }
    }
}

/// The status of a map, as JSON and for people.
struct Status {
    progress: Progress,
    statuses: StatusCounts,
    /// Number of damaged files of each shard.
    damaged: Vec<u64>,
}

impl Status {
    fn of_map(path: &Path) -> Result<Self, Failure> {
        let map = MapFile::open(path)?;
        Ok(Self {
            progress: Progress::of_file(&map),
            statuses: map.status_counts()?,
            damaged: Vec::new(),
        })
    }

    fn of_tiles(map: &Path, survey: &Survey) -> Self {
        let damaged = survey.shards.iter().map(|found| found.damaged.len() as u64);
        Self {
            progress: Progress::of_survey(map, survey),
            statuses: survey.statuses,
            damaged: damaged.collect(),
        }
    }

    /// The shards, each with its number of damaged files.
    fn shards(&self) -> impl Iterator<Item = (&ShardProgress, u64)> {
        let damaged = self.damaged.iter().copied();
        self.progress.shards.iter().zip(damaged)
    }

    fn answer(&self) -> StatusAnswer {
        let flags = FLAGS.iter().zip(self.statuses.flagged);
        let flagged = flags.map(|((_, name), count)| (*name, count));
        let unflagged = [("unflagged", self.statuses.unflagged)];
        let progress = &self.progress;
        StatusAnswer {
            complete: progress.complete,
            running: progress.running(),
            cells: progress.cells,
            cells_done: progress.cells_done,
            cells_per_second: progress.cells_per_second(),
            seconds_left: progress.seconds_left(),
            cells_by_status: flagged.chain(unflagged).collect(),
            shards: self.shards().map(ShardAnswer::of).collect(),
        }
    }

    fn print(&self, map: &Path) -> Result<(), Failure> {
        let mut rows = Rows::begin();
        rows.row("map", format!("{}: {}", map.display(), self.state()))?;
        let (progress, share) = (&self.progress, self.progress.percent());
        let (done, cells) = (grouped(progress.cells_done), grouped(progress.cells));
        let done = format!("{done} of {cells} are done ({share:.1} %)");
        rows.row("cells", done)?;
        if let Some(speed) = speed(progress) {
            rows.row("rate", speed)?;
        }
        let flagged = FLAGS.iter().map(|(_, name)| *name);
        let flagged = flagged.zip(self.statuses.flagged);
        for (name, count) in flagged.filter(|(_, count)| *count > 0) {
            rows.row("status", format!("{name:<14} {} cells", grouped(count)))?;
        }
        let unflagged = grouped(self.statuses.unflagged);
        rows.row("status", format!("{:<14} {unflagged} cells", "unflagged"))?;
        let shards = progress.shards.iter().map(|shard| &shard.done);
        for s in shards.filter(|_| progress.shards.len() > 1) {
            let state = if s.running { ", running" } else { "" };
            let (done, pieces) = (grouped(s.pieces_done), grouped(s.pieces));
            let text = format!("{:<8} {done} of {pieces} pieces{state}", s.shard);
            rows.row("shard", text)?;
        }
        for (shard, files) in self.shards().filter(|(_, files)| *files > 0) {
            let (files, shard) = (grouped(files), shard.done.shard);
            let text = format!("{files} files of shard {shard}: the next run mends them");
            rows.row("damaged", text)?;
        }
        Ok(())
    }

    fn state(&self) -> &'static str {
        let progress = &self.progress;
        match (progress.complete, progress.running()) {
            (true, _) if progress.shards.is_empty() => "complete",
            (true, true) => "complete, and being computed again",
            (true, false) => "complete; what is computed of another one is told here",
            (false, true) => "running",
            (false, false) if progress.to_merge() => {
                "all shards are complete; `slipmap merge` makes the map"
            }
            (false, false) => {
                "not complete, and no run works on it; the command that began it goes on"
            }
        }
    }
}
