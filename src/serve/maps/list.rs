//! The list of maps below a folder, each with the summary from a process of its own.

use std::collections::hash_map::DefaultHasher;
use std::collections::{HashMap, HashSet};
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use tokio::sync::{Notify, Semaphore};

use super::described::{MapEntry, MapList, MapSummary};
use super::frames::{Ask, Kind};
use super::process::{Held, Place, Reader, ReaderCommand, Trouble};
use super::readers::refused;
use crate::maps::scan::{Found, Mark, Scanned, scan};

/// How long a scan of the folder stays valid.
const BETWEEN_SCANS: Duration = Duration::from_secs(1);
/// How long a list waits for maps that are not known yet.
const PATIENCE: Duration = Duration::from_millis(1500);
/// How long is waited until all maps are known.
const PATIENCE_FOR_ALL: Duration = Duration::from_secs(10);
/// The number of tries after which the time between them stops growing.
const MOST_DOUBLED: u32 = 5;
/// The most maps that are asked for a summary at a time.
const MOST_PROBES: usize = 2;

/// What is known of a map.
#[derive(Debug, Clone)]
enum Told {
    /// The summary from its process.
    Summary(MapSummary),
    /// Why the file is no sound map.
    Damaged(String),
    /// Why it could not be read, though the file may be sound; the time of the last try, and their
    /// number.
    Unread(String, Instant, u32),
}

/// Time limits.
#[derive(Debug, Clone, Copy)]
struct Times {
    /// A process that takes longer for a summary is ended.
    probe: Duration,
    /// The time before a map that could not be read is tried again; it doubles with each try.
    again: Duration,
}

impl Default for Times {
    fn default() -> Self {
        Self {
            probe: Duration::from_secs(5),
            again: Duration::from_secs(4),
        }
    }
}

impl Told {
    /// Whether it is still valid, as long as the file does not change.
    fn holds(&self, times: Times) -> bool {
        match self {
            Self::Summary(_) | Self::Damaged(_) => true,
            Self::Unread(_, at, tries) => {
                at.elapsed() < times.again * (1 << (tries - 1).min(MOST_DOUBLED))
            }
        }
    }
}

#[derive(Debug, Default)]
struct Known {
    scanned: Scanned,
    at: Option<Instant>,
    /// By id: what is known of a map, and the state of its files at that time.
    told: HashMap<String, (Mark, Told)>,
    /// Ids of the maps that are being asked.
    asked: HashSet<String>,
}

/// The maps below a folder.
#[derive(Debug)]
pub(super) struct List {
    folder: PathBuf,
    command: ReaderCommand,
    known: Mutex<Known>,
    scanning: tokio::sync::Mutex<()>,
    probes: Arc<Semaphore>,
    held: Held,
    news: Arc<Notify>,
    times: Times,
}

impl List {
    pub(super) fn of(folder: &Path, command: ReaderCommand) -> Self {
        Self {
            folder: folder.canonicalize().unwrap_or_else(|_| folder.to_owned()),
            command,
            known: Mutex::default(),
            scanning: tokio::sync::Mutex::default(),
            probes: Arc::new(Semaphore::new(MOST_PROBES)),
            held: Held::default(),
            news: Arc::default(),
            times: Times::default(),
        }
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Scans the names below the folder, unless that was just done.
    async fn scan(&self) {
        self.scan_unless(|begun| begun.elapsed() < BETWEEN_SCANS)
            .await;
    }

    /// Scans the names below the folder, unless a scan that began at that time will do.
    async fn scan_unless(&self, will_do: impl Fn(Instant) -> bool) {
        let _one = self.scanning.lock().await;
        let at = self.known().at;
        if at.is_some_and(will_do) {
            return;
        }
        let begun = Instant::now();
        let folder = self.folder.clone();
        let scanned = tokio::task::spawn_blocking(move || scan(&folder)).await;
        let mut known = self.known();
        known.scanned = scanned.unwrap_or_default();
        known.at = Some(begun);
        let there: Vec<String> = known.scanned.maps.iter().map(|f| f.id.clone()).collect();
        known.told.retain(|id, _| there.contains(id));
    }

    /// The map with an id.
    pub(super) async fn find(&self, id: &str) -> Option<Found> {
        self.scan().await;
        let known = self.known();
        known
            .scanned
            .maps
            .iter()
            .find(|found| found.id == id)
            .cloned()
    }

    /// All maps, as far as they are known.
    pub(super) async fn all(self: &Arc<Self>) -> MapList {
        self.scan().await;
        let until = tokio::time::Instant::now() + PATIENCE;
        loop {
            let news = self.news.notified();
            if self.ask_unknown() == 0 {
                break;
            }
            if tokio::time::timeout_at(until, news).await.is_err() {
                break;
            }
        }
        self.told()
    }

    /// The state of all files, as a number that changes with it.
    pub(super) async fn fingerprint(&self) -> u64 {
        self.scan().await;
        let mut hasher = DefaultHasher::new();
        for found in &self.known().scanned.maps {
            (&found.id, &found.mark, found.running).hash(&mut hasher);
        }
        hasher.finish()
    }

    /// The map with an id, and whether it is complete, unless that is not known soon.
    pub(super) async fn complete(self: &Arc<Self>, id: &str) -> Option<(Found, Option<bool>)> {
        let found = self.find(id).await?;
        if found.mark.file.is_none() {
            return Some((found, Some(false)));
        }
        self.ask_until_known(PATIENCE, |found| found.id == id).await;
        let known = self.known();
        let state = known
            .told
            .get(id)
            .map(|(_, told)| state(&found, Some(told)).0);
        Some((found, state.map(|state| state == "complete")))
    }

    /// The name of a complete map in the folder itself by the hash of its plan. It is as certain as
    /// the maps can be read; none where some cannot be for too long.
    pub(super) async fn of_plan(self: &Arc<Self>, hash: &str) -> Option<Option<String>> {
        let asked = Instant::now();
        self.scan_unless(|begun| begun >= asked).await;
        let here = |found: &Found| !found.name.contains(std::path::MAIN_SEPARATOR);
        if !self.ask_until_known(PATIENCE_FOR_ALL, here).await {
            return None;
        }
        let known = self.known();
        let same = |found: &&Found| match known.told.get(&found.id) {
            Some((_, told @ Told::Summary(summary))) => {
                let of_plan = summary.plan_hash.as_deref() == Some(hash);
                of_plan && state(found, Some(told)).0 == "complete"
            }
            _ => false,
        };
        let mut maps = known.scanned.maps.iter().filter(|found| here(found));
        Some(maps.find(same).map(|found| found.name.clone()))
    }

    /// Waits until processes have told of the files of these maps; false if that takes too long.
    async fn ask_until_known(
        self: &Arc<Self>,
        patience: Duration,
        which: impl Fn(&Found) -> bool,
    ) -> bool {
        let until = tokio::time::Instant::now() + patience;
        loop {
            let news = self.news.notified();
            self.ask_unknown();
            if !self.is_unknown(&which) {
                return true;
            }
            if tokio::time::timeout_at(until, news).await.is_err() {
                return !self.is_unknown(&which);
            }
        }
    }

    /// Whether nothing is known yet of the file of one of these maps.
    fn is_unknown(&self, which: &impl Fn(&Found) -> bool) -> bool {
        let known = self.known();
        let unknown = |found: &Found| {
            let told = known.told.get(&found.id).map(|(mark, _)| mark.file);
            found.odd.is_none() && found.mark.file.is_some() && told != Some(found.mark.file)
        };
        let mut maps = known.scanned.maps.iter();
        maps.any(|found| which(found) && unknown(found))
    }

    /// Asks processes about maps that are new or have changed; returns how many.
    fn ask_unknown(self: &Arc<Self>) -> usize {
        let mut known = self.known();
        let Known {
            scanned,
            told,
            asked,
            ..
        } = &mut *known;
        let mut unknown = 0;
        for found in scanned.maps.iter().filter(|found| found.odd.is_none()) {
            let of_now = |mark: &Mark| *mark == found.mark;
            let known = told.get(&found.id);
            if known.is_some_and(|(mark, told)| of_now(mark) && told.holds(self.times)) {
                continue;
            }
            unknown += usize::from(!told.contains_key(&found.id));
            if asked.insert(found.id.clone()) {
                tokio::spawn(Arc::clone(self).ask_one(found.clone()));
            }
        }
        unknown
    }

    async fn ask_one(self: Arc<Self>, found: Found) {
        let mut told = self.probe(&found).await;
        let mut known = self.known();
        known.asked.remove(&found.id);
        let before = known.told.get(&found.id);
        if let (Told::Unread(_, _, tries), Some((mark, Told::Unread(_, _, before)))) =
            (&mut told, before)
            && *mark == found.mark
        {
            *tries += before;
        }
        known.told.insert(found.id.clone(), (found.mark, told));
        drop(known);
        self.news.notify_waiters();
    }

    /// A place for a process that reads `path`; none if an ended process keeps it for too long.
    async fn place(&self, path: &Path) -> Option<Place> {
        let until = tokio::time::Instant::now() + self.times.probe;
        loop {
            let news = self.news.notified();
            let permit = Arc::clone(&self.probes).acquire_owned().await.ok()?;
            if let Some(place) = self.held.place(path, permit, &self.news) {
                return Some(place);
            }
            tokio::time::timeout_at(until, news).await.ok()?;
        }
    }

    async fn probe(&self, found: &Found) -> Told {
        let unread = |why: &str| Told::Unread(why.into(), Instant::now(), 1);
        let Some(place) = self.place(&found.path).await else {
            return unread("the process that read it before has not ended yet");
        };
        let (command, path) = (self.command.clone(), found.path.clone());
        let start = move || Reader::start(&command, &path, place);
        let Ok(Ok(reader)) = tokio::task::spawn_blocking(start).await else {
            return unread("the process that reads it could not be started");
        };
        match reader.ask(Ask::Summary, self.times.probe).await {
            Ok(frame) if frame.kind == Kind::Json => match serde_json::from_slice(&frame.bytes) {
                Ok(summary) => Told::Summary(summary),
                Err(error) => unread(&error.to_string()),
            },
            Ok(frame) => {
                let refused = refused(&frame);
                match refused.is_of_file() {
                    true => Told::Damaged(refused.detail),
                    false => unread(&refused.detail),
                }
            }
            Err(Trouble::TooLong) => {
                let seconds = self.times.probe.as_secs_f64();
                unread(&format!("reading it took longer than {seconds} s"))
            }
            Err(_) => unread("the process that read it ended; the file may be damaged"),
        }
    }

    /// Records that the map with this id could be read, whatever was known of it before.
    pub(super) fn was_read(&self, id: &str) {
        let mut known = self.known();
        if !matches!(known.told.get(id), Some((_, Told::Summary(_)))) {
            known.told.remove(id);
        }
    }

    fn told(&self) -> MapList {
        let known = self.known();
        let maps = known.scanned.maps.iter().map(|found| {
            let told = known.told.get(&found.id).map(|(_, told)| told);
            entry(found, told)
        });
        MapList {
            folder: self.folder.to_string_lossy().into(),
            maps: maps.collect(),
            folders_skipped: known.scanned.folders_skipped,
            links_skipped: known.scanned.links_skipped,
            truncated: known.scanned.truncated,
        }
    }
}

/// The state of a map, and why it is damaged or unread, if it is.
fn state(found: &Found, told: Option<&Told>) -> (&'static str, Option<String>) {
    if let Some(odd) = found.odd {
        return ("damaged", Some(odd.into()));
    }
    match told {
        None => ("unknown", None),
        Some(Told::Damaged(why)) => ("damaged", Some(why.clone())),
        Some(Told::Unread(why, ..)) => ("unread", Some(why.clone())),
        Some(Told::Summary(summary)) => {
            let complete = summary.cells == summary.cells_done;
            (found.state(complete), None)
        }
    }
}

fn entry(found: &Found, told: Option<&Told>) -> MapEntry {
    let (state, why) = state(found, told);
    let modified = found.modified();
    let age = modified.and_then(|time| SystemTime::now().duration_since(time).ok());
    let since = modified.and_then(|time| time.duration_since(SystemTime::UNIX_EPOCH).ok());
    let mut summary = match told {
        Some(Told::Summary(summary)) => summary.clone(),
        _ => MapSummary::default(),
    };
    // It was told when the map was written last.
    let left = summary.seconds_left.filter(|_| state == "running");
    let since_told = age.map_or(0.0, |age| age.as_secs_f64());
    summary.seconds_left = left.map(|left| (left - since_told).max(0.0));
    MapEntry {
        id: found.id.clone(),
        name: found.name.clone(),
        state,
        why,
        bytes: found.bytes(),
        modified: since.map(|since| since.as_secs_f64()),
        age_seconds: age.map(|age| age.as_secs_f64()),
        summary,
    }
}

#[cfg(test)]
mod tests {
    #[cfg(unix)]
    use super::super::test_reader::{self, hang};
    #[cfg(unix)]
    use super::*;

    /// If a process exceeds its time, the file may still be sound; it is tried again.
    #[cfg(unix)]
    #[test]
    fn what_could_not_be_read_is_tried_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.h5");
        std::fs::write(&path, "held").unwrap();
        let list = List {
            times: Times {
                probe: Duration::from_millis(200),
                again: Duration::from_millis(400),
            },
            ..List::of(folder.path(), test_reader::command())
        };
        let list = Arc::new(list);
        let runtime = tokio::runtime::Builder::new_multi_thread();
        let runtime = { runtime }.worker_threads(2).enable_all().build().unwrap();
        runtime.block_on(async {
            let held = hang(&path);
            let until = |wanted: &'static str| {
                let list = Arc::clone(&list);
                async move {
                    let begun = Instant::now();
                    loop {
                        let mut all = list.all().await;
                        let entry = all.maps.remove(0);
                        if entry.state == wanted {
                            return entry;
                        }
                        assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", entry.why);
                        tokio::time::sleep(Duration::from_millis(20)).await;
                    }
                }
            };
            let told = until("unread").await;
            assert_eq!(told.why.unwrap(), "reading it took longer than 0.2 s");
            drop(held);
            assert_eq!(until("complete").await.summary.cells, Some(4));
            assert!(test_reader::started(&path) > 1);
        });
    }
}
