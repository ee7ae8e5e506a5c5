//! The worker: takes the first sweep that nobody works on, and runs it until its map is complete,
//! it has failed, or it is taken out of the queue.

use std::collections::HashMap;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::QueueError;
use super::course::Course;
use super::event::{Brought, Event};
use super::folder::{Folder, Place};
use super::name::Name;
use super::note::{JobLock, Note};
use super::progress::Watched;
use super::room::Needs;
use super::settled::Changing;
use super::slurm::Slurm;
use super::then::Lines;
use crate::store::stamp::Stamp;
use crate::store::{StoreError, lock};

/// Starts without progress after which a sweep has failed.
pub(super) const MOST_TRIES: u32 = 10;
/// Time between two looks at the queue.
const BETWEEN_LOOKS: Duration = Duration::from_secs(1);
/// Time between two looks at a run, or for a signal.
const MOMENT: Duration = Duration::from_millis(20);
/// Time between two lines of progress.
const BETWEEN_LINES: Duration = Duration::from_secs(60);
/// How long a sweep is put off for which there is no room, or that Slurm has.
pub(super) const FOR_ROOM: Duration = Duration::from_secs(10);

/// The options of a worker.
pub(crate) struct Options<'a> {
    /// The program that runs sweeps.
    pub program: PathBuf,
    /// The threads of a run; all, if not given.
    pub threads: Option<usize>,
    /// The bytes of memory that a run may take, if that is given.
    pub memory: Option<u64>,
    /// What it may take otherwise, of so many runs of which it is one.
    pub default_memory: &'a dyn Fn(u64) -> u64,
    /// Whether it ends when nothing waits that it may take.
    pub until_empty: bool,
    /// A line for the shell, after each sweep that is done or has failed.
    pub then: Option<OsString>,
    /// The bytes of the disk that are to stay free.
    pub keep_free: u64,
    /// The time after the first try without progress; it doubles with each.
    pub first_pause: Duration,
    /// Where sweeps are handed to Slurm.
    pub slurm: Option<Slurm>,
}

/// A worker on a folder.
pub(crate) struct Worker<'a> {
    pub(super) folder: &'a Folder,
    pub(super) options: Options<'a>,
    pub(super) stop: &'a Arc<AtomicBool>,
    pub(super) tell: &'a dyn Fn(Option<&Name>, &Event),
    changing: Changing,
    pub(super) needs: Needs,
    pub(super) brought: Brought,
    pub(super) host: String,
    looked: Instant,
    pub(super) lines: Lines,
    /// Jobs that the system refused something for: when, and what was told of it.
    set_aside: HashMap<Name, (Instant, String)>,
}

/// What a look at the queue finds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Found {
    /// A job that can begin.
    Job,
    /// Nothing that can begin yet.
    Later,
    /// Nothing.
    Nothing,
}

/// A job that this worker has.
#[derive(Debug)]
pub(super) struct UnderWay {
    pub(super) name: Name,
    pub(super) lock: JobLock,
    pub(super) course: Course,
    /// The file of the job when it was begun.
    pub(super) stamp: Option<Stamp>,
    pub(super) map: Watched,
    pub(super) told: Instant,
}

impl<'a> Worker<'a> {
    /// A worker on `folder`, until `stop` is set. `tell` is told of what it does, with the job.
    pub(crate) fn new(
        folder: &'a Folder,
        options: Options<'a>,
        stop: &'a Arc<AtomicBool>,
        tell: &'a dyn Fn(Option<&Name>, &Event),
    ) -> Self {
        Self {
            folder,
            options,
            stop,
            tell,
            changing: Changing::default(),
            needs: Needs::default(),
            brought: Brought::default(),
            host: host(),
            looked: Instant::now(),
            lines: Lines::default(),
            set_aside: HashMap::new(),
        }
    }

    /// Works until it is stopped or, if so asked, until nothing waits that it may take.
    ///
    /// # Errors
    /// When the queue cannot be read, or the program cannot be started.
    pub(crate) fn work(mut self) -> Result<Brought, QueueError> {
        self.folder.make()?;
        let workers = self.folder.workers();
        let _there = lock::share(&workers).map_err(StoreError::io("lock", &workers))?;
        let most = self.options.slurm.as_ref().map_or(1, |slurm| slurm.at_once);
        let (mut under_way, mut was_idle) = (Vec::new(), false);
        loop {
            let mut found = Found::Job;
            while under_way.len() < most && !self.stopped() && found == Found::Job {
                found = self.begin_next(&mut under_way)?;
            }
            let is_idle = under_way.is_empty() && found == Found::Nothing;
            if is_idle
                && !was_idle
                && let Err(trouble) = JobLock::remove_strays(self.folder)
            {
                (self.tell)(None, &Event::Trouble(&trouble.to_string()));
            }
            let ends = match found {
                _ if self.stopped() => under_way.iter().all(|job| job.course.goes_on_alone()),
                Found::Nothing => self.options.until_empty && under_way.is_empty(),
                Found::Job | Found::Later => false,
            };
            if ends && (self.stopped() || self.lines.is_empty()) {
                self.lines.end();
                return Ok(self.brought);
            }
            if is_idle && !was_idle && !self.options.until_empty {
                (self.tell)(None, &Event::Idle);
            }
            was_idle = is_idle;
            match under_way.is_empty() && self.lines.is_empty() {
                true => self.rest(BETWEEN_LOOKS),
                false => std::thread::sleep(MOMENT),
            }
            self.look(&mut under_way)?;
            if let Some((name, trouble)) = self.lines.look() {
                (self.tell)(Some(&name), &Event::Trouble(&trouble));
            }
        }
    }

    pub(super) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn rest(&self, time: Duration) {
        let begun = Instant::now();
        while begun.elapsed() < time && !self.stopped() {
            std::thread::sleep(MOMENT.min(time));
        }
    }

    /// Begins the first sweep that nobody works on.
    fn begin_next(&mut self, under_way: &mut Vec<UnderWay>) -> Result<Found, QueueError> {
        let mut later = false;
        for name in self.folder.names(Place::Queue)? {
            if under_way.iter().any(|job| job.name == name) {
                continue;
            }
            if !name.is_short() {
                self.attend(&name, |worker| {
                    worker.fail(&name, None, "its name is too long")
                })?;
                continue;
            }
            let path = self.folder.file(Place::Queue, &name);
            let aside = self.set_aside.get(&name);
            if aside.is_some_and(|(since, _)| since.elapsed() < FOR_ROOM)
                || !Note::beside(&self.folder.lock(&name)).pause().is_zero()
                || !self.changing.is_over(&name, &path)
            {
                later = true;
                continue;
            }
            let mut is_taken = false;
            self.attend(&name, |worker| {
                let Some(lock) = JobLock::take(worker.folder, &name)? else {
                    return Ok(());
                };
                // Another worker may have finished it between the two.
                if path.symlink_metadata().is_err() {
                    return Ok(lock.remove()?);
                }
                is_taken = true;
                under_way.extend(worker.begin(&name, lock)?);
                Ok(())
            })?;
            if is_taken {
                return Ok(Found::Job);
            }
        }
        Ok(if later { Found::Later } else { Found::Nothing })
    }

    /// Does something for a job. If the disk or the system refuses, that is told once, and the job
    /// is set aside for a while: the others go on.
    fn attend(
        &mut self,
        name: &Name,
        what: impl FnOnce(&mut Self) -> Result<(), QueueError>,
    ) -> Result<(), QueueError> {
        let trouble = match what(self) {
            Err(QueueError::Store(trouble)) if self.folder.exists() => trouble.to_string(),
            Ok(()) => return Ok(()),
            other => return other,
        };
        let before = self.set_aside.get(name);
        if before.is_none_or(|(_, told)| *told != trouble) {
            (self.tell)(Some(name), &Event::Trouble(&trouble));
        }
        self.set_aside
            .insert(name.clone(), (Instant::now(), trouble));
        Ok(())
    }

    /// Looks at the jobs under way.
    fn look(&mut self, under_way: &mut Vec<UnderWay>) -> Result<(), QueueError> {
        let is_due = self.looked.elapsed() > BETWEEN_LOOKS;
        if is_due {
            self.looked = Instant::now();
        }
        for mut job in std::mem::take(under_way) {
            let path = self.folder.file(Place::Queue, &job.name);
            let taken_out = is_due && path.symlink_metadata().is_err();
            if taken_out || (self.stopped() && !job.course.goes_on_alone()) {
                job.course.stop();
            }
            match job.course.look() {
                Ok(None) => {
                    self.tell_progress(&mut job);
                    under_way.push(job);
                }
                Ok(Some(end)) => {
                    let UnderWay {
                        name, lock, stamp, ..
                    } = job;
                    self.attend(&name, |worker| worker.ended((&name, stamp), lock, end))?;
                }
                Err(trouble) => {
                    (self.tell)(Some(&job.name), &Event::Trouble(&trouble.to_string()));
                    under_way.push(job);
                }
            }
        }
        Ok(())
    }

    /// Tells how far a job is, if that was not told for a while.
    fn tell_progress(&self, job: &mut UnderWay) {
        if job.told.elapsed() < BETWEEN_LINES {
            return;
        }
        job.told = Instant::now();
        // What cannot be read now is told later, or by the run.
        if let Ok(Some(progress)) = job.map.look() {
            (self.tell)(Some(&job.name), &Event::Goes(&progress));
        }
    }
}

/// The name of this machine.
fn host() -> String {
    #[cfg(unix)]
    {
        rustix::system::uname()
            .nodename()
            .to_string_lossy()
            .into_owned()
    }
    #[cfg(not(unix))]
    {
        String::new()
    }
}
