//! What is to be told of every job: its state and place, how far its map is, why it failed.

use std::collections::{HashMap, HashSet};

use serde::Serialize;
use utoipa::ToSchema;

use super::folder::{Folder, Place};
use super::name::Name;
use super::note::Note;
use super::progress::{Progress, Watched};
use crate::store::tiles::shards;
use crate::store::{StoreError, lock, regular};

/// The most bytes of the text that says why a job failed.
const MOST_OF_WHY: u64 = 64 << 10;

/// The state of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum State {
    /// It waits for a worker.
    Waiting,
    /// A worker has it.
    Running,
    /// It is stopped, or not to begin.
    Held,
    /// It failed.
    Failed,
    /// Its map is complete.
    Done,
}

impl State {
    /// The word for it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Running => "running",
            Self::Held => "held",
            Self::Failed => "failed",
            Self::Done => "done",
        }
    }

    /// The state of a job whose file is in this folder.
    pub(super) fn of(folder: &Folder, place: Place, name: &Name) -> Self {
        match place {
            Place::Queue if lock::is_held(&folder.lock(name)) => Self::Running,
            // By an array of Slurm, which goes on without a worker, or by a run by hand.
            Place::Queue if shards::any_is_running(&folder.map(name)).unwrap_or(false) => {
                Self::Running
            }
            Place::Queue => Self::Waiting,
            Place::Held => Self::Held,
            Place::Failed => Self::Failed,
        }
    }
}

/// A job, as its files tell it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Job {
    /// Its name.
    pub name: Name,
    /// Its state.
    pub state: State,
    /// How many are to begin before it, from 0 on; none if it does not wait.
    pub place: Option<usize>,
    /// The note of the worker that has it, or had it.
    pub note: Note,
    /// Why it failed, or waits though a worker had it.
    pub why: Option<String>,
    /// How far its map is; none where nothing is computed yet, or that cannot be told.
    pub progress: Option<Progress>,
}

impl Job {
    /// A job whose map is complete; or a map that no job has made.
    pub(crate) fn done(name: Name) -> Self {
        Self {
            name,
            state: State::Done,
            place: None,
            note: Note::default(),
            why: None,
            progress: None,
        }
    }
}

/// What has been read of the tiles of jobs, so that another look is cheap.
#[derive(Debug, Default)]
pub(crate) struct Looks(HashMap<Name, Watched>);

impl Looks {
    /// How far the map of a job is; none where nothing is computed, or that cannot be told.
    fn progress(&mut self, folder: &Folder, name: &Name) -> Option<Progress> {
        let map = folder.map(name);
        if !shards::root(&map).exists() {
            self.0.remove(name);
            return None;
        }
        let kept = self.0.entry(name.clone());
        let watched = kept.or_insert_with(|| Watched::tiles_of(&map));
        watched.look().ok().flatten()
    }
}

/// The jobs of a folder: those of the queue in their order, then held, failed and done ones. No
/// map is opened.
///
/// # Errors
/// When the system refuses.
pub(crate) fn jobs(folder: &Folder, looks: &mut Looks) -> Result<Vec<Job>, StoreError> {
    let mut jobs = Vec::new();
    let mut waiting = 0;
    for place in Place::ALL {
        for name in folder.names(place)? {
            let state = State::of(folder, place, &name);
            let before = (state == State::Waiting).then_some(waiting);
            waiting += usize::from(before.is_some());
            jobs.push(told(folder, looks, name, state, before));
        }
    }
    let files: HashSet<Name> = jobs.iter().map(|job| job.name.clone()).collect();
    for map in folder.names_of_maps()? {
        let is_job = map.is_map && map.name.parts().is_some() && !files.contains(&map.name);
        if is_job {
            jobs.push(Job::done(map.name));
        }
    }
    looks.0.retain(|name, _| files.contains(name));
    Ok(jobs)
}

/// A job whose file is in one of the folders.
fn told(folder: &Folder, looks: &mut Looks, name: Name, state: State, place: Option<usize>) -> Job {
    let note = match place.is_some() || state == State::Running {
        true => Note::beside(&folder.lock(&name)),
        false => Note::default(),
    };
    let why = match state {
        State::Failed => Some(why_failed(folder, &name)),
        State::Waiting => Some(note.why.clone()).filter(|why| !why.is_empty()),
        _ => None,
    };
    let progress = looks.progress(folder, &name);
    Job {
        name,
        state,
        place,
        note,
        why,
        progress,
    }
}

/// What the file beside a failed sweep says.
fn why_failed(folder: &Folder, name: &Name) -> String {
    let said = regular::head(&folder.said(name), MOST_OF_WHY).unwrap_or_default();
    String::from_utf8_lossy(&said).trim_end().to_owned()
}
