//! What programs are told of a job and of a shard, by the command line and by the server alike.

use std::path::Path;

use serde::Serialize;
use utoipa::ToSchema;

use super::progress::{Progress, ShardProgress};
use super::states::{Job, State};

/// A sweep of a queue.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct JobFacts {
    /// Its name.
    pub name: String,
    /// Its state.
    pub state: State,
    /// How many wait before it; null where it does not wait.
    #[schema(required)]
    pub place: Option<usize>,
    /// The file of its map, there or still to come.
    pub map: String,
    /// Null where nothing is computed yet, or the map is complete.
    #[schema(required)]
    pub cells: Option<u64>,
    /// Null where nothing is computed yet, or the map is complete.
    #[schema(required)]
    pub cells_done: Option<u64>,
    /// Of the runs that work on it; null where none does.
    #[schema(required)]
    pub cells_per_second: Option<f64>,
    /// Until the slowest of them is done; null where that is not known.
    #[schema(required)]
    pub seconds_left: Option<f64>,
    /// The machine of the worker that has it; null where none does.
    #[schema(required)]
    pub host: Option<String>,
    /// Starts since there was progress.
    pub tries: u32,
    /// Why it failed, or waits; null where nothing is to be said.
    #[schema(required)]
    pub why: Option<String>,
}

impl JobFacts {
    /// The facts of a job whose map is called `map`.
    pub(crate) fn of(job: &Job, map: &Path) -> Self {
        let progress = job.progress.as_ref();
        Self {
            name: job.name.to_string(),
            state: job.state,
            place: job.place,
            map: map.display().to_string(),
            cells: progress.map(|progress| progress.cells),
            cells_done: progress.map(|progress| progress.cells_done),
            cells_per_second: progress.and_then(Progress::cells_per_second),
            seconds_left: progress.and_then(Progress::seconds_left),
            host: (job.state == State::Running).then(|| job.note.host.clone()),
            tries: job.note.tries,
            why: job.why.clone(),
        }
    }
}

/// How far a shard of a map is.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct ShardFacts {
    /// Which of how many: `1/4`.
    pub shard: String,
    /// Whether a run works on it.
    pub running: bool,
    /// Its cells.
    pub cells: u64,
    /// How many of them are computed.
    pub cells_done: u64,
    /// Of the run that works on it; null where none does.
    #[schema(required)]
    pub cells_per_second: Option<f64>,
    /// Until it is done; null where that is not known.
    #[schema(required)]
    pub seconds_left: Option<f64>,
}

impl ShardFacts {
    /// The facts of a shard.
    pub(crate) fn of(shard: &ShardProgress) -> Self {
        let done = &shard.done;
        Self {
            shard: done.shard.to_string(),
            running: done.running,
            cells: done.cells,
            cells_done: done.cells_done,
            cells_per_second: shard.cells_per_second,
            seconds_left: shard.seconds_left(),
        }
    }
}
