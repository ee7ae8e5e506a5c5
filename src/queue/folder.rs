//! The folders of a queue, and the names in them.

use std::ffi::OsStr;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::QueueError;
use super::name::Name;
use crate::store::StoreError;
use crate::store::durable::{remove_if_there, sync};
use crate::store::lock;
use crate::store::tiles::folder::make;

/// Where the file of a job can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Place {
    /// It waits or runs.
    Queue,
    /// It is stopped, or not to begin.
    Held,
    /// It failed.
    Failed,
}

impl Place {
    /// The folders of files of jobs.
    pub(crate) const ALL: [Self; 3] = [Self::Queue, Self::Held, Self::Failed];

    /// The name of the folder.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Queue => "queue",
            Self::Held => "held",
            Self::Failed => "failed",
        }
    }
}

/// A folder with a queue, whose maps are in it.
#[derive(Debug, Clone)]
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// The folder at `path`. Nothing is made or read.
    pub(crate) fn at(path: &Path) -> Self {
        Self(path.to_owned())
    }

    /// Its name.
    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Whether there is a queue.
    pub(crate) fn exists(&self) -> bool {
        self.place(Place::Queue).is_dir()
    }

    /// Whether a worker is there.
    pub(crate) fn is_attended(&self) -> bool {
        lock::is_shared_or_held(&self.workers())
    }

    /// Makes the folder and those in it, durably, where they are missing.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn make(&self) -> Result<(), StoreError> {
        let missing = self
            .0
            .ancestors()
            .take_while(|path| !path.as_os_str().is_empty() && !path.is_dir());
        let missing: Vec<&Path> = missing.collect();
        missing.into_iter().rev().try_for_each(make)?;
        Place::ALL
            .iter()
            .try_for_each(|place| make(&self.place(*place)))
    }

    /// One of the folders in it.
    pub(crate) fn place(&self, place: Place) -> PathBuf {
        self.0.join(place.name())
    }

    /// The file of a job in one of the folders.
    pub(crate) fn file(&self, place: Place, name: &Name) -> PathBuf {
        self.place(place).join(name.sweep_file())
    }

    /// The file that says why a job failed.
    pub(crate) fn said(&self, name: &Name) -> PathBuf {
        self.place(Place::Failed).join(name.file("", ".txt"))
    }

    /// The lock of a job.
    pub(crate) fn lock(&self, name: &Name) -> PathBuf {
        self.place(Place::Queue).join(name.lock_file())
    }

    /// The file that workers share a lock on, as long as they are there.
    pub(crate) fn workers(&self) -> PathBuf {
        self.place(Place::Queue).join(".workers")
    }

    /// The map of a job.
    pub(crate) fn map(&self, name: &Name) -> PathBuf {
        self.0.join(name.file("", ".h5"))
    }

    /// The names of the jobs in one of the folders, in their order; none if it is missing.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn names(&self, place: Place) -> Result<Vec<Name>, StoreError> {
        self.named(place, Name::of_file)
    }

    /// The names of jobs that have a lock.
    ///
    /// # Errors
    /// When the system refuses.
    pub(super) fn names_of_locks(&self) -> Result<Vec<Name>, StoreError> {
        self.named(Place::Queue, Name::of_lock)
    }

    /// The names that files in one of the folders have, in their order.
    fn named(
        &self,
        place: Place,
        name_of: impl Fn(&OsStr) -> Option<Name>,
    ) -> Result<Vec<Name>, StoreError> {
        let folder = self.place(place);
        let mut names = Vec::new();
        let entries = match fs::read_dir(&folder) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(names),
            entries => entries.map_err(StoreError::io("read", &folder))?,
        };
        for entry in entries {
            let entry = entry.map_err(StoreError::io("read", &folder))?;
            names.extend(name_of(&entry.file_name()));
        }
        names.sort_unstable();
        Ok(names)
    }

    /// The names of all jobs that the maps and tiles in the folder may be of.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn names_of_maps(&self) -> Result<Vec<OfMap>, StoreError> {
        let entries = fs::read_dir(&self.0).map_err(StoreError::io("read", &self.0))?;
        let mut maps = Vec::new();
        for entry in entries {
            let file = entry.map_err(StoreError::io("read", &self.0))?.file_name();
            let Some(file) = file.to_str() else {
                continue;
            };
            let map = file.strip_suffix(".h5").map(|name| (name, true));
            let found = map.or(file.strip_suffix(".h5.tiles").map(|name| (name, false)));
            if let Some((name, is_map)) = found.filter(|(name, _)| !name.starts_with('.')) {
                let name = Name::of_stem(name);
                maps.push(OfMap { name, is_map });
            }
        }
        maps.sort_unstable_by(|one, other| one.name.cmp(&other.name));
        Ok(maps)
    }

    /// Where the file of a job is, if it is in one of the folders.
    pub(crate) fn find(&self, name: &Name) -> Option<Place> {
        let there = |place: &Place| self.file(*place, name).symlink_metadata().is_ok();
        Place::ALL.into_iter().find(there)
    }

    /// Moves the file of a job, durably.
    ///
    /// # Errors
    /// When it is not there any more, or the system refuses.
    pub(crate) fn shift(
        &self,
        name: &Name,
        from: Place,
        to: (Place, &Name),
    ) -> Result<(), QueueError> {
        let (old, new) = (self.file(from, name), self.file(to.0, to.1));
        rename(&old, &new)?;
        sync(&self.place(to.0))?;
        if from != to.0 {
            sync(&self.place(from))?;
        }
        Ok(())
    }

    /// Removes the file of a job, durably; false if it is not there.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn remove(&self, place: Place, name: &Name) -> Result<bool, StoreError> {
        let removed = remove_if_there(&self.file(place, name))?;
        if removed {
            sync(&self.place(place))?;
        }
        Ok(removed)
    }
}

/// Renames a file, never over another where the system can do that.
fn rename(old: &Path, new: &Path) -> Result<(), StoreError> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        use rustix::io::Errno;
        match renameat_with(CWD, old, CWD, new, RenameFlags::NOREPLACE) {
            // File systems that cannot.
            Err(Errno::INVAL | Errno::NOSYS | Errno::NOTSUP) => {}
            renamed => {
                let renamed = renamed.map_err(std::io::Error::from);
                return renamed.map_err(StoreError::io("rename", old));
            }
        }
    }
    let renamed = match new.symlink_metadata() {
        Ok(_) => Err(ErrorKind::AlreadyExists.into()),
        Err(_) => fs::rename(old, new),
    };
    renamed.map_err(StoreError::io("rename", old))
}

/// What a file beside the queue may be of.
#[derive(Debug, Clone)]
pub(crate) struct OfMap {
    /// The job.
    pub name: Name,
    /// Whether it is the map itself, rather than its tiles.
    pub is_map: bool,
}
