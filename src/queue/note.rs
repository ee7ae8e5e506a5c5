//! The lock of a job, and the note in it: what a worker has to know of earlier ones.

use std::fs::{self, File};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

use super::folder::Folder;
use super::name::Name;
use crate::store::{StoreError, lock, regular};

/// The most bytes of a note that are read.
const MOST_BYTES: u64 = 1 << 20;
/// The longest time between two tries.
const LONGEST_PAUSE: Duration = Duration::from_secs(600);

/// What a worker notes of a job.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Note {
    /// Starts since there was progress.
    pub tries: u32,
    /// Pieces that were computed at the last start.
    pub pieces: u64,
    /// Seconds since 1970 before which it is not started again.
    pub not_before: u64,
    /// The machine of the worker that has it.
    pub host: String,
    /// What the last try ended with.
    pub why: String,
    /// The name of the array of Slurm that computes it; empty without one.
    pub array: String,
}

/// Seconds since 1970, by the clock of the machine.
fn now() -> u64 {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    since.map_or(0, |since| since.as_secs())
}

impl Note {
    /// The note in the lock of a job, as far as it can be read.
    pub(crate) fn beside(lock: &Path) -> Self {
        let bytes = regular::read(lock, MOST_BYTES).unwrap_or_default();
        serde_json::from_slice(&bytes).unwrap_or_default()
    }

    /// Puts off the next try, by about this time.
    pub(crate) fn put_off(&mut self, pause: Duration) {
        let pause = pause.min(LONGEST_PAUSE);
        self.not_before = match pause.is_zero() {
            true => 0,
            false => now() + pause.as_secs().max(1),
        };
    }

    /// The time until the next try. A time that is farther off than any pause is of a clock that
    /// was set back since, and counts as over.
    pub(crate) fn pause(&self) -> Duration {
        let left = Duration::from_secs(self.not_before.saturating_sub(now()));
        match left > LONGEST_PAUSE + Duration::from_secs(1) {
            true => Duration::ZERO,
            false => left,
        }
    }
}

/// The lock of a job, held by this process and by the run that it starts.
#[derive(Debug)]
pub(crate) struct JobLock {
    path: PathBuf,
    file: File,
}

impl JobLock {
    /// Takes the lock of a job; none if another process holds it.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn take(folder: &Folder, name: &Name) -> Result<Option<Self>, StoreError> {
        let path = folder.lock(name);
        let taken = lock::acquire(&path).map_err(StoreError::io("lock", &path))?;
        Ok(taken.map(|file| Self { path, file }))
    }

    /// Removes the locks that nobody holds of jobs that are nowhere, as kills leave them.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn remove_strays(folder: &Folder) -> Result<(), StoreError> {
        let nowhere = |name: &Name| folder.find(name).is_none();
        let remove = |name: &Name| match Self::take(folder, name)? {
            // A job of this name may have come meanwhile.
            Some(lock) if nowhere(name) => lock.remove(),
            _ => Ok(()),
        };
        let strays = folder.names_of_locks()?.into_iter().filter(nowhere);
        let removed: Vec<_> = strays.map(|name| remove(&name)).collect();
        removed.into_iter().collect()
    }

    /// Its file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Its file, for a process that shares the lock.
    pub(crate) fn shared(&self) -> &File {
        &self.file
    }

    /// The note in it.
    pub(crate) fn note(&self) -> Note {
        Note::beside(&self.path)
    }

    /// Replaces the note. The file stays the same one, since it is the lock; a note that was half
    /// written counts as none.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn write(&mut self, note: &Note) -> Result<(), StoreError> {
        write(&mut self.file, note).map_err(StoreError::io("write", &self.path))
    }

    /// Removes the lock, and with it the note: the job is over.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn remove(self) -> Result<(), StoreError> {
        fs::remove_file(&self.path).map_err(StoreError::io("remove", &self.path))
    }
}

fn write(file: &mut File, note: &Note) -> std::io::Result<()> {
    let mut text = serde_json::to_vec(note)?;
    text.push(b'\n');
    file.rewind()?;
    file.write_all(&text)?;
    file.set_len(text.len() as u64)?;
    file.sync_data()
}

/// Takes back a try that a run began, at the end of that run: it was stopped and did not fail.
/// Whoever started it holds the lock, or has died.
pub(crate) fn take_back_try(lock: &Path) {
    // A note that cannot be written is a try too many, no more.
    let taken_back = || -> std::io::Result<()> {
        let mut note: Note = serde_json::from_slice(&regular::read(lock, MOST_BYTES)?)?;
        note.tries = note.tries.saturating_sub(1);
        write(&mut regular::lock_file(lock)?, &note)
    };
    drop(taken_back());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_outlasts_its_writer_and_may_be_damaged() {
        let parent = tempfile::tempdir().unwrap();
        let (folder, name) = (Folder::at(parent.path()), Name::of_stem("100000-a"));
        folder.make().unwrap();
        let mut lock = JobLock::take(&folder, &name).unwrap().unwrap();
        assert!(JobLock::take(&folder, &name).unwrap().is_none());
        assert_eq!(lock.note(), Note::default());
        let long = Note {
            tries: 3,
            why: "x".repeat(1000),
            ..Note::default()
        };
        let short = Note {
            tries: 2,
            pieces: 7,
            ..Note::default()
        };
        for note in [&long, &short] {
            lock.write(note).unwrap();
            assert_eq!(lock.note(), *note);
        }
        take_back_try(lock.path());
        drop(lock);
        let lock = JobLock::take(&folder, &name).unwrap().unwrap();
        assert_eq!(lock.note(), Note { tries: 1, ..short });
        for damaged in ["", "{", "{\"tries\": -1}", "\u{0}\u{0}\u{0}"] {
            fs::write(lock.path(), damaged).unwrap();
            assert_eq!(lock.note(), Note::default());
            take_back_try(lock.path());
        }
        let path = lock.path().to_owned();
        lock.remove().unwrap();
        assert!(!path.exists());
    }

    #[test]
    fn a_clock_that_was_set_back_puts_nothing_off() {
        let mut note = Note::default();
        assert_eq!(note.pause(), Duration::ZERO);
        note.put_off(Duration::from_secs(100));
        assert!(note.pause() > Duration::from_secs(95));
        note.put_off(Duration::from_secs(10_000));
        assert!(note.pause() + Duration::from_secs(5) > LONGEST_PAUSE);
        for set_back in [now() + 3600, u64::MAX] {
            note.not_before = set_back;
            assert_eq!(note.pause(), Duration::ZERO);
        }
        note.put_off(Duration::ZERO);
        assert_eq!(note.pause(), Duration::ZERO);
    }
}
