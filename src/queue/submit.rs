//! Puts a sweep into the queue: written beside, synced, then linked in, never over another.

use std::cell::RefCell;
use std::collections::HashMap;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::QueueError;
use super::folder::{Folder, Place};
use super::name::{Name, word};
use super::settled::mark_whole;
use super::states::State;
use crate::setting::SweepSpec;
use crate::store::durable::{remove_if_there, sync, write_synced};
use crate::store::{MapFile, StoreError, lock, regular};
use crate::sweep::Plan;
use crate::sweep::described::schema::root;

/// How long another process may take to put sweeps in.
const PATIENCE: Duration = Duration::from_secs(60);
const BETWEEN_LOOKS: Duration = Duration::from_millis(10);
/// The most bytes of a sweep that waits. Its text goes into the map.
const MOST_BYTES: u64 = 16 << 20;
/// The file that shuts others out while one is put in, and the one that is not whole yet.
const LOCK: &str = ".lock";
const PART: &str = ".part";

/// How a sweep is put in.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Options {
    /// Before all that wait.
    pub first: bool,
    /// It does not begin until it is released.
    pub hold: bool,
    /// It becomes a new job, though the same plan is there already.
    pub again: bool,
}

/// What became of a sweep.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Submitted {
    /// The job.
    pub name: Name,
    /// Its state.
    pub state: State,
    /// Whether it was put in now; else it was there.
    pub is_new: bool,
}

/// The queue of a folder, open for sweeps. Nobody else puts any in meanwhile.
#[derive(Debug)]
pub(crate) struct Intake<'a> {
    folder: &'a Folder,
    /// The jobs by the hashes of their plans, once they were read.
    known: RefCell<Option<HashMap<String, Name>>>,
    _lock: File,
}

impl<'a> Intake<'a> {
    /// Opens the queue; the folders are made where they are missing.
    ///
    /// # Errors
    /// When another process keeps it for too long, or the system refuses.
    pub(crate) fn open(folder: &'a Folder) -> Result<Self, QueueError> {
        Self::open_within(folder, PATIENCE)
    }

    /// Opens the queue as [`Intake::open`] does, with this patience.
    ///
    /// # Errors
    /// When another process keeps it for longer, or the system refuses.
    pub(crate) fn open_within(folder: &'a Folder, patience: Duration) -> Result<Self, QueueError> {
        folder.make()?;
        let path = folder.place(Place::Queue).join(LOCK);
        let begun = Instant::now();
        loop {
            if let Some(file) = lock::acquire(&path).map_err(StoreError::io("lock", &path))? {
                let intake = Self {
                    folder,
                    known: RefCell::default(),
                    _lock: file,
                };
                // Left by a process that died: this one has the lock.
                remove_if_there(&intake.part())?;
                return Ok(intake);
            }
            if begun.elapsed() > patience {
                return Err(QueueError::Busy {
                    folder: folder.path().to_owned(),
                });
            }
            std::thread::sleep(BETWEEN_LOOKS);
        }
    }

    /// Puts the sweep of a plan in, under a name made of `title`, the name of its file. The same
    /// plan is the same job, unless it is asked for again. `done` finds the job of a complete map
    /// by the hash of its plan, such as [`done`]; it is asked last, and may refuse a new job.
    ///
    /// # Errors
    /// When no number is left, `done` refuses, or the system does. Then nothing was put in.
    pub(crate) fn put<E: From<QueueError>>(
        &self,
        plan: &Plan,
        title: &str,
        options: Options,
        done: impl FnOnce(&str) -> Result<Option<Name>, E>,
    ) -> Result<Submitted, E> {
        let folder = self.folder;
        let same = match options.again {
            true => None,
            false => self.find(&plan.hash(), done)?,
        };
        if let Some((name, state)) = same {
            return Ok(Submitted {
                name,
                state,
                is_new: false,
            });
        }
        let place = if options.hold {
            Place::Held
        } else {
            Place::Queue
        };
        let name = self.new_name(&word(title), options.first)?;
        let file = folder.file(place, &name);
        let linked = link(&self.part(), &file, &plan.spec.text);
        linked
            .and_then(|()| sync(&folder.place(place)))
            .map_err(QueueError::from)?;
        if let Some(known) = self.known.borrow_mut().as_mut() {
            known.entry(plan.hash()).or_insert_with(|| name.clone());
        }
        let state = if options.hold {
            State::Held
        } else {
            State::Waiting
        };
        Ok(Submitted {
            name,
            state,
            is_new: true,
        })
    }

    fn part(&self) -> PathBuf {
        self.folder.place(Place::Queue).join(PART)
    }

    /// The job of a plan, and its state. Maps are looked at last: a job leaves the queue after its
    /// map is complete.
    fn find<E: From<QueueError>>(
        &self,
        hash: &str,
        done: impl FnOnce(&str) -> Result<Option<Name>, E>,
    ) -> Result<Option<(Name, State)>, E> {
        let mut known = self.known.borrow_mut();
        if known.is_none() {
            *known = Some(self.read_all()?);
        }
        let found = known.as_ref().and_then(|known| known.get(hash));
        let place = found.and_then(|name| Some((name, self.folder.find(name)?)));
        if let Some((name, place)) = place {
            let state = State::of(self.folder, place, name);
            return Ok(Some((name.clone(), state)));
        }
        Ok(done(hash)?.map(|name| (name, State::Done)))
    }

    /// The jobs by the hashes of their plans; of several with one plan, the first.
    fn read_all(&self) -> Result<HashMap<String, Name>, QueueError> {
        let mut known = HashMap::new();
        for place in Place::ALL {
            for name in self.folder.names(place)? {
                if let Some(plan) = plan_of(&self.folder.file(place, &name)) {
                    known.entry(plan.hash()).or_insert(name);
                }
            }
        }
        Ok(known)
    }

    /// A name for a new job: behind all others or, if it is to be first, before those that wait.
    fn new_name(&self, word: &str, first: bool) -> Result<Name, QueueError> {
        if first {
            return first_name(self.folder, word);
        }
        let all = all_names(self.folder)?;
        Name::behind(all.iter(), word).ok_or_else(|| no_number(self.folder, "after"))
    }
}

/// The job of a complete map, by the hash of its plan. Maps are opened in this process.
///
/// # Errors
/// When the system refuses.
pub(crate) fn done(folder: &Folder, hash: &str) -> Result<Option<Name>, QueueError> {
    let of_plan = |name: &Name| match MapFile::open(&folder.map(name)) {
        Ok(map) => !map.is_partial() && map.root_text(root::PLAN_HASH).as_deref() == Some(hash),
        Err(_) => false,
    };
    let maps = folder.names_of_maps()?.into_iter();
    let mut maps = maps.filter(|map| map.is_map).map(|map| map.name);
    Ok(maps.find(of_plan))
}

/// The names of all jobs there are or were.
fn all_names(folder: &Folder) -> Result<Vec<Name>, QueueError> {
    let maps = folder.names_of_maps()?.into_iter().map(|map| map.name);
    let mut all: Vec<Name> = maps.collect();
    for place in Place::ALL {
        all.extend(folder.names(place)?);
    }
    Ok(all)
}

fn no_number(folder: &Folder, place: &'static str) -> QueueError {
    QueueError::NoNumber {
        place,
        folder: folder.path().to_owned(),
    }
}

/// A name before all jobs that wait.
///
/// # Errors
/// When no number is left, or the system refuses.
pub(super) fn first_name(folder: &Folder, word: &str) -> Result<Name, QueueError> {
    let all = all_names(folder)?;
    let waiting = folder.names(Place::Queue)?;
    if waiting.is_empty() {
        return Name::behind(all.iter(), word).ok_or_else(|| no_number(folder, "after"));
    }
    let taken = |name: &Name| all.contains(name);
    Name::before(waiting.iter(), taken, word).ok_or_else(|| no_number(folder, "before"))
}

/// The plan of a sweep that waits; none where it has none.
pub(super) fn plan_of(path: &Path) -> Option<Plan> {
    let text = String::from_utf8(regular::read(path, MOST_BYTES).ok()?).ok()?;
    Plan::new(text.parse::<SweepSpec>().ok()?).ok()
}

/// Writes a text to `part`, makes it durable, and links it to `path`.
fn link(part: &Path, path: &Path, text: &str) -> Result<(), StoreError> {
    write_synced(part, |out| {
        out.write_all(text.as_bytes())?;
        out.flush()?;
        mark_whole(out.get_ref())
    })?;
    let linked = fs::hard_link(part, path).map_err(StoreError::io("link to", path));
    remove_if_there(part).and(linked)
}
