//! The queue as it is: looked at for all who ask at the same time.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use axum::http::StatusCode;

use super::described::{JobEntry, JobTold};
use crate::queue::QueueError;
use crate::queue::folder::Folder;
use crate::queue::logs::{end, logs, newest};
use crate::queue::states::{Job, Looks, jobs};
use crate::serve::problem::Problem;

/// The most bytes of the end of a log that are told.
const MOST_OF_LOG: u64 = 4 << 10;

/// The queue at some time.
#[derive(Debug)]
pub(super) struct Now {
    /// When it began to be looked at.
    begun: Instant,
    /// Whether a worker is there.
    pub attended: bool,
    /// Its jobs, as `slipmap jobs` lists them.
    pub jobs: Vec<Job>,
}

impl Now {
    /// The job of this name.
    pub(super) fn job(&self, name: &str) -> Result<&Job, Problem> {
        let mut jobs = self.jobs.iter();
        let job = jobs.find(|job| job.name.to_string() == name);
        job.ok_or_else(|| Problem::of(StatusCode::NOT_FOUND, "there is no sweep of this name"))
    }

    /// A number that changes with what is told, but for what changes with the time alone.
    pub(super) fn fingerprint(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.attended.hash(&mut hasher);
        for job in &self.jobs {
            (&job.name, job.state.name(), job.place).hash(&mut hasher);
            (job.note.tries, &job.note.host, &job.why).hash(&mut hasher);
            let progress = job.progress.as_ref();
            (progress.map(|progress| (progress.cells_done, progress.running()))).hash(&mut hasher);
        }
        hasher.finish()
    }
}

/// Looks at the queue of a folder.
#[derive(Debug)]
pub(super) struct Looking {
    folder: Folder,
    last: tokio::sync::Mutex<Option<Arc<Now>>>,
    looks: Arc<Mutex<Looks>>,
}

impl Looking {
    pub(super) fn at(folder: &Folder) -> Self {
        Self {
            folder: folder.clone(),
            last: tokio::sync::Mutex::default(),
            looks: Arc::default(),
        }
    }

    /// The queue as it is, not as it was before it was asked for.
    pub(super) async fn now(&self) -> Result<Arc<Now>, Problem> {
        let asked = Instant::now();
        let mut kept = self.last.lock().await;
        if let Some(now) = kept.as_ref().filter(|now| now.begun >= asked) {
            return Ok(Arc::clone(now));
        }
        let (folder, looks) = (self.folder.clone(), Arc::clone(&self.looks));
        let now = blocking(move || {
            let begun = Instant::now();
            let mut looks = looks.lock().unwrap_or_else(PoisonError::into_inner);
            let jobs = jobs(&folder, &mut looks).map_err(QueueError::from)?;
            let attended = folder.is_attended();
            Ok(Now {
                begun,
                attended,
                jobs,
            })
        });
        let now = Arc::new(now.await?);
        *kept = Some(Arc::clone(&now));
        Ok(now)
    }

    /// A job with the end of its log.
    pub(super) async fn told(&self, job: &Job) -> Result<JobTold, Problem> {
        let (map, entry) = (self.folder.map(&job.name), JobEntry::of(job));
        let log = blocking(move || Ok(end_of_log(&map))).await?;
        Ok(JobTold { entry, log })
    }
}

/// Runs what waits for files.
pub(super) async fn blocking<T: Send + 'static>(
    what: impl FnOnce() -> Result<T, Problem> + Send + 'static,
) -> Result<T, Problem> {
    let done = tokio::task::spawn_blocking(what).await;
    done.unwrap_or_else(|_| {
        let detail = "looking at the queue failed; this is a fault of slipmap";
        Err(Problem::of(StatusCode::INTERNAL_SERVER_ERROR, detail))
    })
}

/// The last lines of the log of a map that was written last: shards have logs of their own.
fn end_of_log(map: &Path) -> String {
    newest(logs(map)).map_or_else(String::new, |log| end(&log, MOST_OF_LOG))
}
