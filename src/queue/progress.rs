//! The progress of a map, cheap enough for lists of many: from the heads of its tile files and the
//! ends of its logs. A map without tiles is opened. Bytes of cells are not read, so that a tile
//! damaged after it was written still counts as computed here;
//! [`Survey`](crate::store::tiles::Survey) and the next run read them all.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::report::log;
use crate::store::stamp::Stamp;
use crate::store::tiles::GrowingMap;
use crate::store::tiles::Survey;
use crate::store::tiles::done::ShardDone;
use crate::store::{MapFile, StoreError};

/// How far a map is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Progress {
    /// Whether there is a map without missing cells. Tiles beside it are then of another one.
    pub complete: bool,
    pub cells: u64,
    /// Cells that some shard holds, or the map where there are no tiles.
    pub cells_done: u64,
    /// The shards with tiles; none where there is only a map.
    pub shards: Vec<ShardProgress>,
}

/// How far a shard of a map is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShardProgress {
    pub done: ShardDone,
    /// Of the run that works on it; none where none does.
    pub cells_per_second: Option<f64>,
}

impl ShardProgress {
    fn of(map: &Path, done: ShardDone) -> Self {
        let cells_per_second = rate(map, &done);
        Self {
            done,
            cells_per_second,
        }
    }

    /// Seconds until the shard is done; none where that is not known.
    pub(crate) fn seconds_left(&self) -> Option<f64> {
        let rate = self.cells_per_second.filter(|rate| *rate > 0.0)?;
        Some(self.done.cells.saturating_sub(self.done.cells_done) as f64 / rate)
    }
}

/// Cells per second since the current run of a shard started, from its log and its tiles.
fn rate(map: &Path, shard: &ShardDone) -> Option<f64> {
    if !shard.running {
        return None;
    }
    let (start, left) = log::last_start(&log::path(map, shard.shard))?;
    // After the clock was set back, there is no rate.
    let elapsed = SystemTime::now().duration_since(start).ok()?;
    let before = shard.cells.saturating_sub(left);
    let computed = shard.cells_done.saturating_sub(before);
    Some(computed as f64 / elapsed.as_secs_f64().max(1e-3))
}

impl Progress {
    /// The progress of a map with tiles, every byte of which was read.
    pub(crate) fn of_survey(map: &Path, survey: &Survey) -> Self {
        let done = survey.shards.iter().map(|found| found.done.clone());
        Self {
            complete: MapFile::open(map).is_ok_and(|map| !map.is_partial()),
            cells: survey.plan.cells(),
            cells_done: survey.cells_done,
            shards: done.map(|done| ShardProgress::of(map, done)).collect(),
        }
    }

    /// The progress of a map without tiles.
    pub(crate) fn of_file(map: &MapFile) -> Self {
        let missing = map.cells_missing();
        Self {
            complete: missing == 0,
            cells: map.cells(),
            cells_done: map.cells() - missing.min(map.cells()),
            shards: Vec::new(),
        }
    }

    /// Whether a run works on it.
    pub(crate) fn running(&self) -> bool {
        self.shards.iter().any(|shard| shard.done.running)
    }

    /// Cells per second of all runs that work on it; none where none does.
    pub(crate) fn cells_per_second(&self) -> Option<f64> {
        let rates = self.shards.iter().filter_map(|s| s.cells_per_second);
        rates.reduce(|a, b| a + b)
    }

    /// Seconds until the slowest running shard is done; none where that is not known.
    pub(crate) fn seconds_left(&self) -> Option<f64> {
        let left = self.shards.iter().filter_map(ShardProgress::seconds_left);
        left.reduce(f64::max)
    }

    /// The share of cells that are done, in percent.
    pub(crate) fn percent(&self) -> f64 {
        100.0 * self.cells_done as f64 / self.cells.max(1) as f64
    }

    /// Whether all shards are done and only a merge is missing.
    pub(crate) fn to_merge(&self) -> bool {
        let all = self.cells_done == self.cells && self.shards.len() > 1;
        all && !self.complete && !self.running()
    }

    /// The state in a word or two.
    pub(crate) fn state(&self) -> &'static str {
        match (self.complete, self.running()) {
            (true, _) if self.shards.is_empty() => "complete",
            (true, true) => "running again",
            (true, false) => "interrupted again",
            (false, true) => "running",
            (false, false) if self.to_merge() => "to merge",
            (false, false) => "interrupted",
        }
    }
}

/// A map whose progress is asked for again and again. It keeps what it has read: a look reads the
/// heads of new tile files, and a map that has changed.
#[derive(Debug)]
pub(crate) struct Watched {
    map: PathBuf,
    /// Whether the map itself is opened.
    opens: bool,
    tiles: Option<GrowingMap>,
    file: Option<(Stamp, Progress)>,
}

impl Watched {
    /// The map at `map`, there or still to come; nothing is read yet.
    pub(crate) fn new(map: &Path) -> Self {
        Self {
            map: map.to_owned(),
            opens: true,
            tiles: None,
            file: None,
        }
    }

    /// The tiles of the map at `map` alone. The map is not opened, and counts as missing.
    pub(crate) fn tiles_of(map: &Path) -> Self {
        Self {
            opens: false,
            ..Self::new(map)
        }
    }

    /// How far the map is now; none where there is neither a map nor tiles.
    ///
    /// # Errors
    /// When no manifest is sound, shards belong to different sweeps, there are no tiles and the map
    /// is damaged, or the system refuses.
    pub(crate) fn look(&mut self) -> Result<Option<Progress>, StoreError> {
        match self.look_once() {
            // A run has assembled the map meanwhile, and removed its tiles.
            Err(StoreError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
                self.look_once()
            }
            looked => looked,
        }
    }

    fn look_once(&mut self) -> Result<Option<Progress>, StoreError> {
        let Some(tiles) = self.looked_at_tiles()? else {
            return self.of_file();
        };
        let shards = tiles.shards();
        let progress = Progress {
            complete: false,
            cells: tiles.plan().cells(),
            cells_done: tiles.done().1,
            shards: { shards.into_iter() }
                .map(|done| ShardProgress::of(&self.map, done))
                .collect(),
        };
        self.tiles = Some(tiles);
        // While there are tiles, a map that cannot be read is one that is not complete.
        let file = self.of_file().ok().flatten();
        Ok(Some(Progress {
            complete: file.is_some_and(|file| file.complete),
            ..progress
        }))
    }

    /// The tiles as they are now, with their heads read.
    fn looked_at_tiles(&mut self) -> Result<Option<GrowingMap>, StoreError> {
        if let Some(mut kept) = self.tiles.take()
            && kept.refresh(&self.map)?
        {
            return Ok(Some(kept));
        }
        let found = GrowingMap::of(&self.map)?;
        found.iter().try_for_each(GrowingMap::refuse_mixed)?;
        Ok(found)
    }

    /// The progress that the file of the map tells; none without one.
    fn of_file(&mut self) -> Result<Option<Progress>, StoreError> {
        let Some(now) = Stamp::of(&self.map).filter(|_| self.opens) else {
            return Ok(None);
        };
        let progress = match self.file.take() {
            Some((stamp, progress)) if stamp == now => progress,
            _ => Progress::of_file(&MapFile::open(&self.map)?),
        };
        self.file = Some((now, progress.clone()));
        Ok(Some(progress))
    }
}

#[cfg(test)]
mod tests {
    use std::cell::{Cell, RefCell};
    use std::fs;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Duration;

    use super::*;
    use crate::maps::maker::{Job, make, make_shard};
    use crate::report::log::Log;
    use crate::store::tiles::shards;
    use crate::sweep::described::root::Provenance;
    use crate::sweep::events::Attended;
    use crate::sweep::{Event, Observer, Plan, Shard};

    /// Curves, best settings, and tiles of unequal size.
    const SWEEP: &str = "fields = [\"n_unstable\", \"abscissa\"]\nbest = true\n[axes]\n\
        mu_prime = [-0.3, -0.2, -0.1]\n\
        alpha_v = { from = -1.0, to = 0.0, points = 301 }\n\
        tau = { from = 0.5, to = 6.0, points = 400 }\n[fixed]\nalpha_n = 0.0\n";

    /// What there is to compute in a folder of its own.
    struct Work {
        folder: tempfile::TempDir,
        plan: Arc<Plan>,
    }

    /// Looks at the map after each piece, and stops the run after some of them.
    struct Beside {
        log: Log,
        map: PathBuf,
        watched: RefCell<Watched>,
        left: Cell<u64>,
        stop: Arc<AtomicBool>,
    }

    impl Work {
        fn new() -> Self {
            Self {
                folder: tempfile::tempdir().unwrap(),
                plan: Arc::new(Plan::new(SWEEP.parse().unwrap()).unwrap()),
            }
        }

        fn map(&self) -> PathBuf {
            self.folder.path().join("map.h5")
        }

        /// Computes a shard until so many pieces are done.
        fn shard(&self, shard: Shard, pieces: u64) {
            let (map, stop, by) = (self.map(), Arc::default(), Provenance::default());
            let beside = Beside {
                log: Log::beside(&map, shard),
                watched: RefCell::new(Watched::new(&map)),
                left: Cell::new(pieces),
                stop: Arc::clone(&stop),
                map: map.clone(),
            };
            let job = Job {
                save_every: Duration::ZERO,
                ..Job::new(&map, 1, &by)
            };
            let attended = Attended {
                observer: &beside,
                stop: &stop,
            };
            let made = make_shard(&self.plan, &job, shard, attended);
            assert_eq!(made.is_err(), beside.left.get() == 0);
        }

        fn tile_files(&self, shard: Shard) -> Vec<PathBuf> {
            let entries = fs::read_dir(shards::folder_of(&self.map(), shard)).unwrap();
            let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
            files.retain(|file| file.extension().is_some_and(|ending| ending == "bin"));
            files.sort();
            files
        }
    }

    /// The progress without what depends on the time.
    fn timeless(mut progress: Progress) -> Progress {
        let shards = progress.shards.iter_mut();
        shards.for_each(|shard| shard.cells_per_second = None);
        progress
    }

    /// What was read of every byte.
    fn surveyed(map: &Path) -> Progress {
        timeless(Progress::of_survey(map, &Survey::of(map).unwrap().unwrap()))
    }

    fn looked(watched: &mut Watched) -> Progress {
        timeless(watched.look().unwrap().unwrap())
    }

    impl Observer for Beside {
        fn event(&self, event: &Event) {
            self.log.event(event);
            if let Event::PieceDone { .. } = event {
                let progress = self.watched.borrow_mut().look().unwrap().unwrap();
                let rate = progress.cells_per_second().unwrap();
                assert!(progress.running() && rate >= 0.0);
                assert_eq!(progress.seconds_left().is_some(), rate > 0.0);
                assert_eq!(timeless(progress), surveyed(&self.map));
                self.left.set(self.left.get().saturating_sub(1));
                self.stop.store(self.left.get() == 0, Ordering::Relaxed);
            }
        }
    }

    #[test]
    fn heads_tell_what_all_bytes_tell() {
        let work = Work::new();
        let (map, stop, by) = (work.map(), Arc::default(), Provenance::default());
        let mut watched = Watched::new(&map);
        assert_eq!(watched.look().unwrap(), None);
        assert_eq!(shards::plan_hash(&map).unwrap(), None);
        let [first, second] = ["1/2", "2/2"].map(|shard| shard.parse::<Shard>().unwrap());
        work.shard(first, 4);
        let half = looked(&mut watched);
        assert_eq!(half, surveyed(&map));
        assert_eq!((half.state(), half.shards.len()), ("interrupted", 1));
        assert!(0 < half.cells_done && half.cells_done < half.cells);
        assert_eq!(shards::plan_hash(&map).unwrap(), Some(work.plan.hash()));
        work.shard(second, u64::MAX);
        let more = looked(&mut watched);
        assert_eq!(more, surveyed(&map));
        assert!(more.shards[1].done.cells_done == more.shards[1].done.cells);
        work.shard(first, u64::MAX);
        let all = looked(&mut watched);
        assert_eq!(all, surveyed(&map));
        assert_eq!((all.state(), all.cells_done), ("to merge", all.cells));
        // What was kept is as good as what is read anew.
        assert_eq!(all, looked(&mut Watched::new(&map)));
        shards::clear(&map).unwrap();
        assert_eq!(watched.look().unwrap(), None);
        let job = Job::new(&map, 1, &by);
        make(&work.plan, &job, Attended::silently(&stop)).unwrap();
        for _ in 0..2 {
            let complete = looked(&mut watched);
            assert_eq!((complete.state(), complete.shards.len()), ("complete", 0));
            assert_eq!(
                (complete.cells, complete.cells_done),
                (all.cells, all.cells)
            );
        }
        work.shard(Shard::WHOLE, 3);
        assert_eq!(looked(&mut watched).state(), "interrupted again");
    }

    #[test]
    fn damage_after_a_write_is_not_seen_but_what_has_gone_is() {
        let work = Work::new();
        let map = work.map();
        work.shard(Shard::WHOLE, 9);
        let mut watched = Watched::new(&map);
        let before = looked(&mut watched);
        let files = work.tile_files(Shard::WHOLE);
        let (broken, gone) = (files.last().unwrap(), &files[files.len() - 2]);
        let mut bytes = fs::read(broken).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(broken, bytes).unwrap();
        let anew = || looked(&mut Watched::new(&map));
        assert!(anew() == before && surveyed(&map).cells_done < before.cells_done);
        // The next run removes what it mends, under whatever name it writes the pieces again.
        fs::remove_file(gone).unwrap();
        assert!(looked(&mut watched).cells_done < before.cells_done);
        assert_eq!(looked(&mut watched), anew());
        // A head that is longer than that of all pieces, in a file of no contents.
        let long = gone.with_file_name("tiles-9999999999.bin");
        let head = fs::read(broken).unwrap()[..48].to_vec();
        fs::write(&long, [&head[..], &(1_u64 << 32).to_le_bytes()].concat()).unwrap();
        let opened = fs::File::options().write(true).open(&long).unwrap();
        opened.set_len(1 << 40).unwrap();
        assert_eq!(looked(&mut watched), anew());
        fs::remove_file(long).unwrap();
        fs::write(broken.with_file_name("manifest.json"), "{}").unwrap();
        let damaged = watched.look().unwrap_err().to_string();
        assert!(damaged.contains("manifest.json is damaged"), "{damaged}");
        assert!(shards::plan_hash(&map).is_err());
    }

    #[test]
    fn shards_of_several_sweeps_are_refused() {
        let (work, other) = (Work::new(), SWEEP.replace("301", "302"));
        let [first, second] = ["1/2", "2/2"].map(|shard| shard.parse::<Shard>().unwrap());
        work.shard(first, 1);
        let other = Work {
            plan: Arc::new(Plan::new(other.parse().unwrap()).unwrap()),
            ..Work::new()
        };
        other.shard(second, 1);
        let folder = |work: &Work| shards::folder_of(&work.map(), second);
        fs::rename(folder(&other), folder(&work)).unwrap();
        let mixed = Watched::new(&work.map()).look().unwrap_err().to_string();
        assert_eq!(mixed, Survey::of(&work.map()).unwrap_err().to_string());
        assert!(mixed.contains("tiles of something else"), "{mixed}");
    }
}
