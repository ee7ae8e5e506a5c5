//! Holds, releases and drops jobs, and puts them first: each is one rename or one removal, also
//! while a worker has the job. The worker sees it within a second, and ends the run.

use std::time::{Duration, SystemTime};

use super::QueueError;
use super::folder::{Folder, Place};
use super::name::Name;
use super::note::JobLock;
use super::states::State;
use super::submit::{Intake, first_name};
use crate::store::durable::remove_if_there;
use crate::store::tiles::shards;
use crate::store::{StoreError, lock};
use crate::text::nearest::nearest;

/// What can be done with a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    /// It is not to begin, or to stop.
    Hold,
    /// It is to wait for a worker again.
    Release {
        /// Whether what is computed of its map is dropped.
        fresh: bool,
    },
    /// It is to be the next.
    First,
    /// It is to go; its tiles too, if so asked.
    Drop {
        /// Whether what is computed of its map goes too.
        tiles: bool,
    },
}

/// Changes a job, and returns its name, which may be a new one.
///
/// # Errors
/// When there is no such job, its state does not allow the change, or the system refuses.
pub(crate) fn change(folder: &Folder, name: &Name, what: Change) -> Result<Name, QueueError> {
    let not_now = |state: &'static str| {
        let name = name.to_string();
        Err(QueueError::NotNow { name, state })
    };
    let Some(place) = folder.find(name) else {
        return match what {
            // Of one that was dropped, or got another name, while it ran.
            Change::Drop { tiles: true } if shards::root(&folder.map(name)).exists() => {
                shards::clear(&folder.map(name))?;
                Ok(name.clone())
            }
            _ if folder.map(name).exists() => not_now("is done"),
            _ => Err(no_such_job(folder, &name.to_string())),
        };
    };
    match (what, place) {
        (Change::Hold, Place::Queue) => shifted(folder, name, place, Place::Held),
        (Change::Hold, Place::Held) | (Change::Release { fresh: false }, Place::Queue) => {
            Ok(name.clone())
        }
        (Change::Release { fresh: true }, Place::Queue) => not_now("waits or runs; hold it first"),
        (Change::Hold, Place::Failed) => not_now("has failed; it does not begin by itself"),
        (Change::Release { fresh }, Place::Held | Place::Failed) => {
            if fresh {
                shards::clear(&folder.map(name))?;
            }
            let released = shifted(folder, name, place, Place::Queue)?;
            remove_if_there(&folder.said(name))?;
            Ok(released)
        }
        (Change::First, Place::Queue) => match State::of(folder, place, name) {
            State::Running => not_now("runs already"),
            _ => first(folder, name),
        },
        (Change::First, Place::Held) => not_now("is held; release it first"),
        (Change::First, Place::Failed) => not_now("has failed; release it first"),
        (Change::Drop { tiles }, place) => drop_job(folder, name, place, tiles),
    }
}

/// The jobs that failed at least this long ago.
///
/// # Errors
/// When the system refuses.
pub(crate) fn failed_before(folder: &Folder, age: Duration) -> Result<Vec<Name>, StoreError> {
    let mut names = folder.names(Place::Failed)?;
    names.retain(|name| {
        // The text beside it was written when it failed; a file that was moved there by hand has
        // none.
        let said = folder.said(name).metadata();
        let told = said.or_else(|_| folder.file(Place::Failed, name).symlink_metadata());
        let since = told.and_then(|told| told.modified());
        let old = since.map(|at| SystemTime::now().duration_since(at).unwrap_or_default());
        old.is_ok_and(|old| old >= age)
    });
    Ok(names)
}

/// Says that no job has this name, and which one is like it. Of a path the last part counts.
pub(crate) fn no_such_job(folder: &Folder, name: &str) -> QueueError {
    let all = Place::ALL
        .iter()
        .flat_map(|place| folder.names(*place).unwrap_or_default());
    let all: Vec<String> = all.map(|name| name.to_string()).collect();
    let last = name.rsplit('/').next().unwrap_or(name);
    let last = Name::given(last).map_or_else(String::new, |name| name.to_string());
    // A number or a word alone is as good, where it is of one job.
    let parts =
        |job: &&String| job.starts_with(&format!("{last}-")) || job.ends_with(&format!("-{last}"));
    let near = all.iter().find(parts).cloned();
    let near = near.or_else(|| nearest(&last, all.iter().map(String::as_str)).map(str::to_owned));
    QueueError::NoSuchJob {
        folder: folder.path().to_owned(),
        name: name.to_owned(),
        near,
    }
}

fn shifted(folder: &Folder, name: &Name, from: Place, to: Place) -> Result<Name, QueueError> {
    folder.shift(name, from, (to, name))?;
    Ok(name.clone())
}

/// Gives a job that waits a name before all others. What is computed of its map follows when it
/// begins.
fn first(folder: &Folder, name: &Name) -> Result<Name, QueueError> {
    if folder.names(Place::Queue)?.first() == Some(name) {
        return Ok(name.clone());
    }
    // No other process gives names meanwhile.
    let _intake = Intake::open(folder)?;
    let text = name.to_string();
    let word = name.parts().map_or(text.as_str(), |(_, word)| word);
    let new = first_name(folder, word)?;
    folder.shift(name, Place::Queue, (Place::Queue, &new))?;
    forget(folder, name)?;
    Ok(new)
}

/// Removes the lock of a job that no worker has, with the note of earlier tries.
fn forget(folder: &Folder, name: &Name) -> Result<(), QueueError> {
    match JobLock::take(folder, name)? {
        Some(lock) => Ok(lock.remove()?),
        None => Ok(()),
    }
}

fn drop_job(folder: &Folder, name: &Name, place: Place, tiles: bool) -> Result<Name, QueueError> {
    let running = place == Place::Queue && State::of(folder, place, name) == State::Running;
    let works = running || lock::is_held(&folder.lock(name));
    if tiles && works {
        let name = name.to_string();
        let state = match running {
            true => "runs; hold it first, then drop its tiles",
            false => "has not ended its run yet; drop its tiles in a moment",
        };
        return Err(QueueError::NotNow { name, state });
    }
    folder.remove(place, name)?;
    if !running {
        forget(folder, name)?;
    }
    remove_if_there(&folder.said(name))?;
    if tiles {
        shards::clear(&folder.map(name))?;
    }
    Ok(name.clone())
}
