//! The types of answers about jobs, with their descriptions.

use std::path::Path;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::maps::scan::id_of;
use crate::queue::facts::{JobFacts, ShardFacts};
use crate::queue::states::{Job, State};

/// The sweeps of the folder.
#[derive(Serialize, ToSchema)]
pub(super) struct JobList {
    /// Whether a worker is there: `slipmap work`.
    pub attended: bool,
    /// Whether who asks may hand in sweeps, and change them.
    pub may_change: bool,
    /// Those that run or wait in their order, then those held, failed and done.
    pub jobs: Vec<JobEntry>,
}

/// A sweep of the folder.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobEntry {
    /// What there is to say of it.
    #[serde(flatten)]
    pub facts: JobFacts,
    /// The id of its map in the list of maps; null where nothing is computed yet.
    #[schema(required)]
    pub map_id: Option<String>,
    /// How far its shards are; none where nothing is computed yet, or the map is complete.
    pub shards: Vec<ShardFacts>,
}

/// A sweep of the folder, with its log.
#[derive(Serialize, ToSchema)]
pub(super) struct JobTold {
    /// What the list has of it.
    #[serde(flatten)]
    pub entry: JobEntry,
    /// The last lines of its log, each a JSON object; empty where there is none.
    pub log: String,
}

/// What is to become of a sweep.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct JobChange {
    /// `held`: it stops, or does not begin; `waiting`: it waits for a worker, again if it failed.
    pub state: Option<Wanted>,
    /// It is put before all that wait.
    #[serde(default)]
    pub first: bool,
}

/// The states that a sweep can be put into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Wanted {
    /// It waits for a worker.
    Waiting,
    /// It is stopped, or not to begin.
    Held,
}

/// What a sweep would cost.
#[derive(Serialize, ToSchema)]
pub(super) struct SweepCost {
    /// Its cells.
    pub cells: u64,
    /// The pieces that are computed one by one.
    pub pieces: u64,
    /// Bytes of its cells, before compression.
    pub bytes: u64,
    /// Bytes that its map and what is computed of it may take on the disk at the same time.
    pub bytes_needed: u64,
    /// Bytes of the disk that are free for it; null where the system does not say.
    #[schema(required)]
    pub bytes_free: Option<u64>,
    /// The most memory that these threads take, in bytes.
    pub memory: u64,
    /// The threads that memory and seconds are told for.
    pub threads: usize,
    /// What is to be known of its friction law.
    pub remarks: Vec<String>,
    /// Seconds at least, about and at most, and the bytes on the disk; null unless asked for.
    #[schema(required)]
    pub timed: Option<TimedCost>,
}

/// What a timed sample tells of a sweep.
#[derive(Serialize, ToSchema)]
pub(super) struct TimedCost {
    /// Seconds at least, about and at most.
    pub seconds: [f64; 3],
    /// About the bytes of its map.
    pub bytes_on_disk: u64,
    /// How many tiles were timed.
    pub tiles_timed: usize,
}

/// The most bytes of why a sweep failed in the list.
const MOST_OF_WHY: usize = 1000;

impl JobEntry {
    /// What a list tells of a job: why it failed is cut short.
    pub(super) fn in_list(job: &Job) -> Self {
        let mut entry = Self::of(job);
        if let Some(why) = &mut entry.facts.why {
            let mut ends = (0..=MOST_OF_WHY).rev();
            let end = ends.find(|&end| why.is_char_boundary(end));
            why.truncate(end.unwrap_or_default());
        }
        entry
    }

    /// What is told of a job.
    pub(super) fn of(job: &Job) -> Self {
        let map = job.name.file("", ".h5");
        let map = Path::new(&map);
        let progress = job.progress.as_ref();
        let begun = job.state == State::Done || progress.is_some();
        let shards = progress.map_or_else(Vec::new, |progress| {
            progress.shards.iter().map(ShardFacts::of).collect()
        });
        Self {
            facts: JobFacts::of(job, map),
            map_id: begun.then(|| id_of(map)),
            shards,
        }
    }
}
