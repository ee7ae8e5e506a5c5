//! Maps that visit: handed over to be looked at. They are in no list and in no folder of maps; the
//! last few are kept, and none when the server has ended in order.

use std::collections::VecDeque;
use std::fs::File;
use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tempfile::{TempDir, TempPath};
use tokio::sync::Semaphore;

use crate::maps::scan::Found;

/// The most maps that are kept, and that are being sent.
const MOST: usize = 4;

/// A map with its file, which goes with it.
#[derive(Debug)]
pub(super) struct Visitor {
    pub(super) found: Found,
    _file: TempPath,
}

impl Visitor {
    /// The map in a file.
    pub(super) fn of(name: String, file: TempPath) -> Self {
        Self {
            found: Found::alone(name, file.to_path_buf()),
            _file: file,
        }
    }
}

/// Where visitors are: in a folder that only the user of the server can look into.
#[derive(Debug, Default)]
struct House {
    folder: Option<TempDir>,
    /// The oldest one first.
    kept: VecDeque<Visitor>,
    closed: bool,
}

/// The maps that visit.
#[derive(Debug)]
pub(super) struct Visiting {
    house: Mutex<House>,
    /// Places for maps that are being sent.
    pub(super) doors: Arc<Semaphore>,
}

impl Default for Visiting {
    fn default() -> Self {
        Self {
            house: Mutex::default(),
            doors: Arc::new(Semaphore::new(MOST)),
        }
    }
}

impl Visiting {
    fn house(&self) -> MutexGuard<'_, House> {
        self.house.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The map with an id.
    pub(super) fn find(&self, id: &str) -> Option<Found> {
        let house = self.house();
        let with_id = house.kept.iter().find(|visitor| visitor.found.id == id);
        with_id.map(|visitor| visitor.found.clone())
    }

    /// A new file for a map.
    pub(super) fn file(&self) -> io::Result<(File, TempPath)> {
        let mut house = self.house();
        if house.closed {
            return Err(io::Error::other("the server ends"));
        }
        let folder = match house.folder.take() {
            Some(folder) => folder,
            None => folder()?,
        };
        let file = tempfile::Builder::new().tempfile_in(folder.path());
        house.folder = Some(folder);
        Ok(file?.into_parts())
    }

    /// Keeps a map; the oldest one goes where there are too many.
    pub(super) fn keep(&self, visitor: Visitor) {
        let mut house = self.house();
        house.kept.push_back(visitor);
        let gone = (house.kept.len() > MOST).then(|| house.kept.pop_front());
        drop(house);
        drop(gone);
    }

    /// Lets all maps go, and takes no more.
    pub(super) fn close(&self) {
        let mut house = self.house();
        *house = House {
            closed: true,
            ..House::default()
        };
    }
}

/// A folder among those of the system that do not last.
fn folder() -> io::Result<TempDir> {
    let mut folder = tempfile::Builder::new();
    folder.prefix("slipmap-");
    #[cfg(unix)]
    folder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
    folder.tempdir()
}
