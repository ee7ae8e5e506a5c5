//! Sweeps that wait in a folder, and the worker that computes them. The folder is all there is: a
//! sweep waits because its file is in `queue/`, and a change is one rename.
//!
//! ```text
//! FOLDER/queue/100000-fig2a.toml    waits or runs; the order is that of the names
//! FOLDER/queue/.100000-fig2a.lock   held by the worker that has it; in it a [note]
//! FOLDER/held/…  FOLDER/failed/…    stopped; failed, with a .txt that says why
//! FOLDER/100000-fig2a.h5            the map, with its tiles and its log beside it
//! ```
//!
//! A run loses nothing when it is killed, so the queue needs no memory of its own: a worker that
//! dies leaves its lock, and the next one starts the same run again.
//!
//! - `adopt`: unfinished tiles that follow a sweep to its new name
//! - `attempt`: one run of a sweep, as a process that ends with the worker
//! - `beginning`: how a worker begins a job
//! - `change`: holds, releases, drops sweeps, and puts them first
//! - `course`: what computes a job: a process of this machine, or an array of Slurm
//! - `ending`: how a job ends, and what becomes of it
//! - `event`: what a worker tells of itself
//! - `facts`: what programs are told of a job and of a shard
//! - `folder`: the folders of a queue, and the names in them
//! - `logs`: logs beside a map: which files they are, and how they end
//! - `name`: names of jobs
//! - `note`: the lock of a job, and the note in it
//! - `progress`: the progress of a map from the heads of its tile files and its logs
//! - `room`: whether the disk has room for a map
//! - `settled`: whether a file is still being copied
//! - `slurm`: sweeps as job arrays of Slurm
//! - `states`: what is to be told of every job
//! - `submit`: puts a sweep into the queue
//! - `then`: the user's line for the shell after each job
//! - `work`: the worker

#[cfg(feature = "cli")]
mod adopt;
#[cfg(feature = "cli")]
pub(crate) mod attempt;
#[cfg(feature = "cli")]
mod beginning;
pub(crate) mod change;
#[cfg(feature = "cli")]
mod course;
#[cfg(feature = "cli")]
mod ending;
#[cfg(feature = "cli")]
pub(crate) mod event;
pub(crate) mod facts;
pub(crate) mod folder;
pub(crate) mod logs;
pub(crate) mod name;
pub(crate) mod note;
pub(crate) mod progress;
pub(crate) mod room;
mod settled;
#[cfg(feature = "cli")]
pub(crate) mod slurm;
pub(crate) mod states;
pub(crate) mod submit;
#[cfg(feature = "cli")]
mod then;
#[cfg(feature = "cli")]
pub(crate) mod work;

use std::path::PathBuf;

use crate::store::StoreError;

/// Why something could not be done with a queue.
#[derive(Debug, thiserror::Error)]
pub(crate) enum QueueError {
    /// The system refused.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// There is no such job.
    #[error("no sweep of {} has the name {name}", folder.display())]
    NoSuchJob {
        /// The folder of the queue.
        folder: PathBuf,
        /// The name that was given.
        name: String,
        /// A name that is like it.
        near: Option<String>,
    },
    /// The job is in a state that does not allow it.
    #[error("{name} {state}")]
    NotNow {
        /// The job.
        name: String,
        /// Its state, as the rest of a sentence.
        state: &'static str,
    },
    /// Another process puts sweeps into the queue, and takes very long.
    #[error("another process has been putting sweeps into {} for a long time", folder.display())]
    Busy {
        /// The folder of the queue.
        folder: PathBuf,
    },
    /// The program that runs sweeps cannot be started.
    #[error("cannot start {}: {why}", path.display())]
    NoProgram {
        /// Which one.
        path: PathBuf,
        /// What the system said.
        why: std::io::Error,
    },
    /// There is no number before, or after, all others.
    #[error("no number is left {place} all sweeps of {}", folder.display())]
    NoNumber {
        /// `before` or `after`.
        place: &'static str,
        /// The folder of the queue.
        folder: PathBuf,
    },
}
