//! Sweeps that wait in the folder: handed in, changed, told, and watched.
//!
//! ```text
//! text → [posted] plan → [changing] queue → a worker, never a child of the server
//!                        [now] the queue as it is → [routes] answers
//!                                                 → [events] revisions → streams
//! ```
//!
//! No file that a text names is opened, and maps are read by processes of their own.
//!
//! - `changing`: what writes into the queue
//! - `cost`: what the map of a sweep would cost
//! - `described`: the types of answers about jobs
//! - `events`: what has changed, as a stream
//! - `now`: the queue as it is
//! - `posted`: sweeps as texts that were sent
//! - `queries`: what addresses say behind the question mark
//! - `refusals`: why something is not done
//! - `routes`: the addresses of requests about jobs
//! - `watching`: the watcher that looks for all streams

mod changing;
mod cost;
mod described;
mod events;
mod now;
mod posted;
mod queries;
mod refusals;
mod routes;
mod watching;

use std::io;
use std::path::Path;
use std::sync::Arc;

use tokio::sync::Semaphore;

use events::Events;
use now::Looking;
pub(super) use routes::routes;

use super::maps::Maps;
use crate::queue::folder::Folder;

/// The most sweeps that are read, timed or put in at the same time.
const MOST_READ: usize = 8;

/// Who may hand in sweeps, and what they are told of their cost.
#[derive(Debug, Clone, Copy)]
pub(super) struct Submission {
    /// The bytes of the disk that stay free; none where no sweep may be handed in.
    pub keep_free: Option<u64>,
    /// The threads that costs are told for.
    pub threads: usize,
}

/// The jobs of a folder.
#[derive(Debug)]
pub(super) struct Jobs {
    folder: Folder,
    submission: Submission,
    /// The maps below the folder.
    pub(super) maps: Arc<Maps>,
    looking: Looking,
    /// Held by the requests that carry sweeps.
    reading: Arc<Semaphore>,
    /// Held by the request that writes into the queue.
    changing: tokio::sync::Mutex<()>,
    events: Events,
}

impl Jobs {
    /// The jobs of the folder at `path`.
    ///
    /// # Errors
    /// When the system gives no random numbers.
    pub(super) fn of(path: &Path, submission: Submission, maps: Arc<Maps>) -> io::Result<Self> {
        let folder = Folder::at(&path.canonicalize().unwrap_or_else(|_| path.to_owned()));
        Ok(Self {
            looking: Looking::at(&folder),
            folder,
            submission,
            maps,
            reading: Arc::new(Semaphore::new(MOST_READ)),
            changing: tokio::sync::Mutex::default(),
            events: Events::new()?,
        })
    }
}
