//! How a worker begins a job.

use std::ffi::OsString;
use std::io::ErrorKind;
use std::time::{Duration, Instant};

use super::QueueError;
use super::adopt::adopt;
use super::attempt::Attempt;
use super::course::Course;
use super::event::Event;
use super::folder::Place;
use super::name::Name;
use super::note::{JobLock, Note, take_back_try};
use super::progress::Watched;
use super::submit::plan_of;
use super::work::{FOR_ROOM, MOST_TRIES, UnderWay, Worker};
use crate::model::stop::Stop;
use crate::report::numbers::bytes;
use crate::store::stamp::Stamp;
use crate::store::tiles::GrowingMap;
use crate::store::{StoreError, lock};
use crate::sweep::Plan;

/// Why a job is not begun.
enum Not {
    /// It has failed.
    Ever(String),
    /// It waits for so long.
    Now(String, Duration),
}

impl Worker<'_> {
    /// Begins a job; none where it cannot be begun.
    pub(super) fn begin(
        &mut self,
        name: &Name,
        mut lock: JobLock,
    ) -> Result<Option<UnderWay>, QueueError> {
        let mut note = lock.note();
        let path = self.folder.file(Place::Queue, name);
        let (stamp, plan) = (Stamp::of(&path), plan_of(&path));
        match self.why_not(name, &mut note, plan.as_ref())? {
            Some(Not::Ever(why)) => return self.fail(name, Some(lock), &why).map(|()| None),
            Some(Not::Now(why, pause)) => {
                return self
                    .put_off(name, &mut lock, note, pause, why)
                    .map(|()| None);
            }
            None => {}
        }
        (note.tries, note.not_before) = (note.tries + 1, 0);
        note.host.clone_from(&self.host);
        lock.write(&note)?;
        let course = self.started(name, &lock, plan.as_ref())?;
        let mut how = String::new();
        if let Course::Array(array) = &course {
            // One that an earlier worker submitted is no new try.
            note.tries -= u32::from(array.was_there());
            array.name().clone_into(&mut note.array);
            lock.write(&note)?;
            how = format!("as {} of Slurm", array.name());
        }
        (self.tell)(Some(name), &Event::Starts(&how));
        Ok(Some(UnderWay {
            name: name.clone(),
            lock,
            course,
            stamp,
            map: Watched::new(&self.folder.map(name)),
            told: Instant::now(),
        }))
    }

    /// Why a job is not begun now; none if it is. Tiles that wait for it are given to it, and its
    /// tries are forgotten after progress.
    fn why_not(
        &mut self,
        name: &Name,
        note: &mut Note,
        plan: Option<&Plan>,
    ) -> Result<Option<Not>, QueueError> {
        let path = self.folder.file(Place::Queue, name);
        if !path.symlink_metadata().is_ok_and(|found| found.is_file()) {
            return Ok(Some(Not::Ever("it is no regular file".into())));
        }
        if let Some(plan) = plan {
            let (root, kept) = (self.folder.path(), self.options.keep_free);
            let stop = Stop::when(self.stop);
            if let Some((needed, free)) = self.needs.lacking(plan, root, kept, &stop) {
                let (needed, free) = (bytes(needed), bytes(free));
                let why = format!(
                    "the disk may have no room: its map may take {needed}, {free} are free"
                );
                return Ok(Some(Not::Now(why, FOR_ROOM)));
            }
            adopt(self.folder, name, &plan.hash())?;
        }
        if self.options.slurm.is_none() && !note.array.is_empty() {
            let array = &note.array;
            let why = format!("it is {array} of Slurm: `slipmap work --slurm` goes on with it");
            return Ok(Some(Not::Now(why, FOR_ROOM)));
        }
        let pieces = self.pieces(name);
        if pieces > note.pieces {
            note.tries = 0;
        }
        note.pieces = pieces;
        Ok((note.tries >= MOST_TRIES)
            .then(|| Not::Ever(format!("{}\n{MOST_TRIES} tries without progress", note.why))))
    }

    /// Starts what computes a job.
    fn started(
        &self,
        name: &Name,
        lock: &JobLock,
        plan: Option<&Plan>,
    ) -> Result<Course, QueueError> {
        let program = &self.options.program;
        let begun = match (&self.options.slurm, plan) {
            (Some(slurm), Some(plan)) => {
                let begun = slurm.begin(self.folder, name, plan);
                begun.map(Course::Array)
            }
            // A sweep without a plan is told why by its run.
            _ => Attempt::start(program, &self.arguments(name), lock).map(Course::Here),
        };
        begun.map_err(|error| {
            take_back_try(lock.path());
            let path = match (&self.options.slurm, plan) {
                (Some(_), Some(_)) => "sbatch".into(),
                _ => program.clone(),
            };
            match error.kind() {
                ErrorKind::NotFound | ErrorKind::PermissionDenied => {
                    QueueError::NoProgram { path, why: error }
                }
                _ => StoreError::io("start", &path)(error).into(),
            }
        })
    }

    /// The arguments of the run of a job.
    fn arguments(&self, name: &Name) -> Vec<OsString> {
        let memory = self.options.memory;
        let memory = memory.unwrap_or_else(|| (self.options.default_memory)(self.sharers()));
        let mut arguments: Vec<OsString> = vec!["run".into()];
        arguments.push(self.folder.file(Place::Queue, name).into());
        arguments.extend(["-o".into(), self.folder.map(name).into()]);
        arguments.extend([
            "--quiet".into(),
            "--memory".into(),
            memory.to_string().into(),
        ]);
        if let Some(threads) = self.options.threads {
            arguments.extend(["--threads".into(), threads.to_string().into()]);
        }
        arguments
    }

    /// Workers on this machine that have a job, this one too.
    fn sharers(&self) -> u64 {
        let names = self.folder.names(Place::Queue).unwrap_or_default();
        let here = |name: &&Name| {
            let path = self.folder.lock(name);
            Note::beside(&path).host == self.host && lock::is_held(&path)
        };
        names.iter().filter(here).count().max(1) as u64
    }

    /// Pieces of a job's map that are computed.
    pub(super) fn pieces(&self, name: &Name) -> u64 {
        let tiles = GrowingMap::of(&self.folder.map(name));
        tiles.ok().flatten().map_or(0, |tiles| tiles.done().0)
    }
}
