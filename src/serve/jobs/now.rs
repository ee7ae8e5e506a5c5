//! The queue as it is: looked at for all who ask at the same time.

use std::ffi::OsStr;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Instant, SystemTime};

use axum::http::StatusCode;

use super::described::{JobEntry, JobTold};
use crate::queue::QueueError;
use crate::queue::folder::Folder;
use crate::queue::states::{Job, Looks, State, jobs};
use crate::serve::problem::Problem;
use crate::store::regular;

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
        let (folder, entry) = (self.folder.clone(), JobEntry::of(job));
        let map = folder.map(&job.name);
        let log = blocking(move || Ok(end_of_log(&folder, &map))).await?;
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
fn end_of_log(folder: &Folder, map: &Path) -> String {
    let stem = map.file_name().unwrap_or_default().as_encoded_bytes();
    let is_log = |file: &OsStr| {
        let rest = file.as_encoded_bytes().strip_prefix(stem);
        rest.is_some_and(|rest| rest.starts_with(b".") && rest.ends_with(b".log"))
    };
    let entries = std::fs::read_dir(folder.path()).into_iter().flatten();
    let logs = entries
        .flatten()
        .filter(|entry| is_log(&entry.file_name()))
        .map(|entry| entry.path());
    let written = |log: &std::path::PathBuf| {
        let told = log.metadata().and_then(|told| told.modified());
        told.unwrap_or(SystemTime::UNIX_EPOCH)
    };
    let Some(log) = logs.max_by_key(written) else {
        return String::new();
    };
    let end = regular::end(&log, MOST_OF_LOG).unwrap_or_default();
    let whole_lines = match end.len() as u64 {
        // The first line may be cut off.
        MOST_OF_LOG => end
            .iter()
            .position(|&byte| byte == b'\n')
            .map_or(0, |at| at + 1),
        _ => 0,
    };
    String::from_utf8_lossy(&end[whole_lines..]).into_owned()
}

/// What is told of a map that no job of the queue has made.
pub(super) fn done(name: crate::queue::name::Name) -> Job {
    Job {
        name,
        state: State::Done,
        place: None,
        note: crate::queue::note::Note::default(),
        why: None,
        progress: None,
    }
}
