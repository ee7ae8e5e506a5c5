//! How a job ends, and what becomes of it: done, failed, tried again, or taken out of the queue.

use std::io::{ErrorKind, Write};
use std::time::Duration;

use super::QueueError;
use super::attempt::End;
use super::event::Event;
use super::folder::Place;
use super::logs::last_lines;
use super::name::Name;
use super::note::{JobLock, Note};
use super::states::State;
use super::work::{MOST_TRIES, Worker};
use crate::report::log;
use crate::store::StoreError;
use crate::store::durable::{rename_synced, sync, write_synced};
use crate::store::stamp::Stamp;
use crate::sweep::Shard;

/// How long a sweep is put off that another run works on.
const FOR_OTHERS: Duration = Duration::from_secs(2);
/// Lines of a log that are told of a sweep that failed.
const LAST_LINES: usize = 10;

impl Worker<'_> {
    /// The run of a job has ended, which was begun with a file of this stamp.
    pub(super) fn ended(
        &mut self,
        (name, stamp): (&Name, Option<Stamp>),
        mut lock: JobLock,
        end: End,
    ) -> Result<(), QueueError> {
        let is_there = Stamp::of(&self.folder.file(Place::Queue, name)) == stamp;
        let mut note = lock.note();
        note.array.clear();
        match end {
            End::Done(said) => self.done((name, stamp), lock, &said),
            // It was held or dropped, or another file has its name: that one is a new job.
            _ if !is_there => {
                (self.tell)(Some(name), &Event::TakenOut);
                Ok(lock.remove()?)
            }
            End::BadInput(mut why) => {
                if why.contains("--fresh") {
                    let folder = self.folder.path().display();
                    let advice = "drops what is computed of it, and starts over";
                    why += &format!(
                        "\n  `slipmap jobs release {name} --fresh --in {folder}` {advice}; \
                         the file of a map is left for you to move"
                    );
                }
                self.fail(name, Some(lock), &why)
            }
            End::Stopped { at_once } => {
                note.tries -= u32::from(at_once).min(note.tries);
                if self.stopped() {
                    return Ok(lock.write(&note)?);
                }
                let why = "the run was stopped by a signal".to_owned();
                self.put_off(name, &mut lock, note, self.options.first_pause, why)
            }
            End::Busy => {
                note.tries = note.tries.saturating_sub(1);
                let why = "another run works on its map".to_owned();
                self.put_off(name, &mut lock, note, FOR_OTHERS, why)
            }
            End::Broke(why) => self.broke(name, lock, note, why),
        }
    }

    /// The run of a job failed or was killed: it is tried again, at once after progress.
    fn broke(
        &mut self,
        name: &Name,
        mut lock: JobLock,
        mut note: Note,
        why: String,
    ) -> Result<(), QueueError> {
        if self.pieces(name) > note.pieces {
            note.tries = 0;
        }
        if note.tries >= MOST_TRIES {
            let why = format!("{why}\n{MOST_TRIES} tries without progress");
            return self.fail(name, Some(lock), &why);
        }
        let pause = match note.tries {
            0 => Duration::ZERO,
            tries => self.options.first_pause * 2_u32.pow(tries - 1),
        };
        note.put_off(pause);
        (self.tell)(Some(name), &Event::Again(&why, note.pause()));
        note.why = why;
        Ok(lock.write(&note)?)
    }

    pub(super) fn put_off(
        &self,
        name: &Name,
        lock: &mut JobLock,
        mut note: Note,
        pause: Duration,
        why: String,
    ) -> Result<(), QueueError> {
        if note.why != why {
            (self.tell)(Some(name), &Event::Waits(&why));
        }
        note.put_off(pause);
        note.why = why;
        Ok(lock.write(&note)?)
    }

    /// The map of a job is complete: its file goes, also where it was held or renamed meanwhile,
    /// but no other file of its name.
    fn done(
        &mut self,
        (name, stamp): (&Name, Option<Stamp>),
        lock: JobLock,
        said: &str,
    ) -> Result<(), QueueError> {
        for place in [Place::Queue, Place::Held] {
            let is_its = |found: &Name| Stamp::of(&self.folder.file(place, found)) == stamp;
            let renamed = || {
                self.folder
                    .names(place)
                    .unwrap_or_default()
                    .into_iter()
                    .find(is_its)
            };
            let found = Some(name.clone()).filter(is_its).or_else(renamed);
            if let Some(found) = found.filter(|_| stamp.is_some()) {
                self.folder.remove(place, &found)?;
                break;
            }
        }
        lock.remove()?;
        self.brought.done += 1;
        (self.tell)(Some(name), &Event::Done(said));
        self.then(name, State::Done, "");
        Ok(())
    }

    /// A job has failed: what there is to say of it is written first, then its file is moved.
    pub(super) fn fail(
        &mut self,
        name: &Name,
        lock: Option<JobLock>,
        why: &str,
    ) -> Result<(), QueueError> {
        let said = self.folder.said(name);
        let part = said.with_file_name(format!(".{}.part", std::process::id()));
        let _ = std::fs::remove_file(&part);
        let text = format!("{why}\n{}", self.end_of_log(name));
        write_synced(&part, |out| out.write_all(text.as_bytes()))?;
        rename_synced(&part, &said)?;
        let places = [Place::Queue, Place::Failed];
        let [old, new] = places.map(|place| self.folder.file(place, name));
        match std::fs::rename(&old, &new) {
            // It was taken out of the queue.
            Err(error) if error.kind() == ErrorKind::NotFound => {
                std::fs::remove_file(&said).map_err(StoreError::io("remove", &said))?;
                return Ok(lock.map_or(Ok(()), JobLock::remove)?);
            }
            renamed => renamed.map_err(StoreError::io("rename", &old))?,
        }
        places
            .iter()
            .try_for_each(|place| sync(&self.folder.place(*place)))?;
        lock.map_or(Ok(()), JobLock::remove)?;
        self.brought.failed += 1;
        (self.tell)(Some(name), &Event::Failed(why));
        self.then(name, State::Failed, why);
        Ok(())
    }

    /// The last lines of the log of a job's map.
    fn end_of_log(&self, name: &Name) -> String {
        let path = log::path(&self.folder.map(name), Shard::WHOLE);
        match last_lines(&path, LAST_LINES) {
            last if last.is_empty() => last,
            last => format!("\nthe end of {}:\n{last}\n", path.display()),
        }
    }

    /// The user's line after a job, if there is one.
    fn then(&mut self, name: &Name, state: State, why: &str) {
        if let Some(line) = &self.options.then {
            let map = self.folder.map(name);
            self.lines.add(line, (name, state), &map, why);
        }
    }
}
