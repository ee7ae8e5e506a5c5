//! The processes that read maps: only a few at a time, those that were asked last.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::{Notify, Semaphore};

use super::process::{Held, Place, Reader, ReaderCommand, Trouble};

/// The most maps that are read at a time.
const MOST_READERS: usize = 2;
/// The longest wait for a place.
const FOR_PLACE: Duration = Duration::from_secs(10);

/// The time after which a process that was told to end has usually ended.
const TO_END: Duration = Duration::from_secs(1);

/// The processes that read maps.
#[derive(Debug)]
pub(super) struct Places {
    command: ReaderCommand,
    readers: Mutex<Readers>,
    free: Arc<Semaphore>,
    held: Held,
    /// Signals that a place may be free, or that the process of another map has been started.
    news: Arc<Notify>,
}

#[derive(Debug, Default)]
struct Readers {
    /// In the order in which they were last asked.
    there: Vec<(PathBuf, Arc<Reader>)>,
    /// Maps whose processes are being started.
    starting: HashSet<PathBuf>,
}

/// A process while it is asked.
#[derive(Debug)]
pub(super) struct InUse {
    pub reader: Arc<Reader>,
    /// Dropped after the reader, which is given back first.
    _told: Told,
}

/// When dropped, it signals those who wait for a place.
#[derive(Debug)]
struct Told(Arc<Notify>);

impl Drop for Told {
    fn drop(&mut self) {
        self.0.notify_waiters();
    }
}

impl Readers {
    /// The process that reads the map at `path`, if there is one.
    fn known(&mut self, path: &Path) -> Option<Arc<Reader>> {
        self.there.retain(|(_, reader)| !reader.has_ended());
        let place = self.there.iter().position(|(of, _)| of == path)?;
        let known = self.there.remove(place);
        let reader = Arc::clone(&known.1);
        self.there.push(known);
        Some(reader)
    }

    /// Makes room for another map if the limit is reached or `taken` is set. It ends an idle
    /// process or, at the limit, the one that was asked longest ago, after it has answered.
    fn make_room(&mut self, taken: bool) {
        let full = self.there.len() + self.starting.len() >= MOST_READERS;
        let idle = |(_, reader): &(PathBuf, Arc<Reader>)| Arc::strong_count(reader) == 1;
        let idle = self.there.iter().position(idle);
        match idle.or((full && !self.there.is_empty()).then_some(0)) {
            Some(place) if full || taken => drop(self.there.remove(place)),
            _ => {}
        }
    }
}

impl Places {
    pub(super) fn of(command: ReaderCommand) -> Arc<Self> {
        Arc::new(Self {
            command,
            readers: Mutex::default(),
            free: Arc::new(Semaphore::new(MOST_READERS)),
            held: Held::default(),
            news: Arc::default(),
        })
    }

    fn readers(&self) -> MutexGuard<'_, Readers> {
        self.readers.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The process that reads the map at `path`; a new one if there is a place for it.
    pub(super) async fn reader(self: &Arc<Self>, path: &Path) -> Result<InUse, Trouble> {
        let begun = tokio::time::Instant::now();
        loop {
            let news = self.news.notified();
            if let Some(reader) = self.readers().known(path) {
                return Ok(self.in_use(reader));
            }
            let late = begun.elapsed() >= TO_END;
            if let Some(place) = self.begin(path, late) {
                return Ok(self.in_use(self.start(path, place).await?));
            }
            let until = begun + if late { FOR_PLACE } else { TO_END };
            if tokio::time::timeout_at(until, news).await.is_err() && late {
                return Err(Trouble::NoPlace);
            }
        }
    }

    fn in_use(&self, reader: Arc<Reader>) -> InUse {
        let told = Told(Arc::clone(&self.news));
        InUse {
            reader,
            _told: told,
        }
    }

    /// A place for a process of this map; none if there is no place, or one is being started.
    /// `late`: a process that was told to end has not ended in time, so another one is ended.
    fn begin(&self, path: &Path, late: bool) -> Option<Place> {
        let mut readers = self.readers();
        if readers.starting.contains(path) {
            return None;
        }
        readers.make_room(late && self.free.available_permits() == 0);
        let permit = Arc::clone(&self.free).try_acquire_owned().ok()?;
        let place = self.held.place(path, permit, &self.news)?;
        readers.starting.insert(path.to_owned());
        Some(place)
    }

    /// Starts a process and keeps it, even if the client has gone meanwhile.
    async fn start(self: &Arc<Self>, path: &Path, place: Place) -> Result<Arc<Reader>, Trouble> {
        let (places, path) = (Arc::clone(self), path.to_owned());
        let starting = tokio::task::spawn_blocking(move || {
            let started = Reader::start(&places.command, &path, place).map(Arc::new);
            let mut readers = places.readers();
            readers.starting.remove(&path);
            if let Ok(reader) = &started {
                readers.there.push((path, Arc::clone(reader)));
            }
            drop(readers);
            places.news.notify_waiters();
            started
        });
        starting.await.unwrap_or(Err(Trouble::NotStarted))
    }

    /// Forgets a process: the next request about its map goes to another one.
    pub(super) fn forget(&self, reader: &Arc<Reader>) {
        let mut readers = self.readers();
        readers
            .there
            .retain(|(_, other)| !Arc::ptr_eq(other, reader));
    }
}
