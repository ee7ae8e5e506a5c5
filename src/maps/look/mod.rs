//! Interactive display of a map. Windows are read bit by bit, on threads of their own, as long as
//! they are requested again and again; cells that were read are kept while there is room.
//!
//! ```text
//! window asked → [pixels] the cells under each → [view] chunks in turn → [source] stored bytes
//!   → [cells] runs, or one by one → [shelf] kept → [canvas] nearest cell, several values → shot
//! ```
//!
//! Nothing is averaged: a pixel shows one cell, and is marked if it hides cells with other values.
//!
//! - `as_text`: a cell's setting as a point, a problem of v_c, a case file and a command line
//! - `canvas`: pixels: the nearest cell, and whether others differ
//! - `cells`: cells in memory, as runs of equal cells where that is shorter
//! - `jobs`: the chunks that are still to be read, in a few bytes each
//! - `pixels`: which cells the pixels along an axis show and hide
//! - `reading`: from stored chunks to pixels
//! - `shelf`: cells that were read, kept while there is room
//! - `short`: chunks of equal bytes, inflated once
//! - `source`: where cells come from: the map's file, or the tiles of its run
//! - `view`: a window that is being read, chunk by chunk
//! - `window`: the request for a window, and the answer

pub(crate) mod as_text;
mod canvas;
mod cells;
mod jobs;
mod pixels;
mod reading;
mod shelf;
mod short;
mod source;
mod view;
mod window;

use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::time::{Duration, Instant};

pub(crate) use canvas::{BEYOND, UNREAD};
pub(crate) use pixels::{Scale, Stretch, finite};
pub(crate) use source::Facts;
pub(crate) use window::{Asked, Numbers, Shot, Shown, changes};

use jobs::Job;
use reading::Reading;
use source::{Cells, Source, Still};
pub(crate) use view::View;
use view::locked;

use crate::store::StoreError;
use crate::store::curve_reader::MapCurve;

/// The most windows that are read at a time: those requested last.
const MOST_VIEWS: usize = 2;
/// The most bytes of their pixels; beyond that, only the last window is read.
const MOST_OF_VIEWS: usize = 24 << 20;
/// How long a window is read on after an answer, for its next request.
const UNTIL_NEXT: Duration = Duration::from_millis(200);
/// The most threads that read.
const MOST_THREADS: usize = 4;

/// A map that is displayed.
#[derive(Debug)]
pub(crate) struct Look {
    facts: Arc<Facts>,
    reading: Arc<Reading>,
    desk: Arc<Desk>,
    numbers: AtomicU64,
}

/// The windows being read, the newest first.
#[derive(Debug, Default)]
struct Desk {
    views: Mutex<VecDeque<Arc<View>>>,
    /// Signals that there is something to read.
    work: Condvar,
    /// Signals that something was read.
    news: Condvar,
}

/// The map is no longer the one that was opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct OtherMap;

impl Look {
    /// Opens the map at `path`, or the tiles beside it.
    ///
    /// # Errors
    /// When there is none, or it is damaged.
    pub(crate) fn open(path: &Path) -> Result<Self, StoreError> {
        let (source, facts) = Source::open(path)?;
        let facts = Arc::new(facts);
        let reading = Arc::new(Reading::new(source, Arc::clone(&facts)));
        let desk = Arc::new(Desk::default());
        let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        for _ in 0..threads.min(MOST_THREADS) {
            let (reading, desk) = (Arc::clone(&reading), Arc::clone(&desk));
            std::thread::spawn(move || {
                loop {
                    desk.work(|view, job| reading.read(view, job));
                }
            });
        }
        Ok(Self {
            facts,
            reading,
            desk,
            numbers: AtomicU64::new(1),
        })
    }

    /// The facts about the map that do not change.
    #[must_use]
    pub(crate) fn facts(&self) -> &Facts {
        &self.facts
    }

    /// Takes in what was computed since the last call. It is an error if the map is gone or another
    /// one has taken its place: it must then be opened again.
    ///
    /// # Errors
    /// See above.
    pub(crate) fn refresh(&self) -> Result<(), OtherMap> {
        let mut source = locked(&self.reading.source);
        let still = source.look();
        self.reading
            .version
            .store(source.version, Ordering::Relaxed);
        drop(source);
        match still {
            Still::Same => Ok(()),
            Still::Grown => {
                self.desk.views().clear();
                Ok(())
            }
            Still::Gone => Err(OtherMap),
        }
    }

    /// A number that changes when cells are added, and the number of computed cells.
    #[must_use]
    pub(crate) fn version(&self) -> (u64, u64) {
        let source = locked(&self.reading.source);
        (source.version, source.cells_done)
    }

    /// The description of the map, from its file or its tiles.
    pub(crate) fn told<T>(
        &self,
        of_file: impl FnOnce(&crate::store::MapFile) -> T,
        of_tiles: impl FnOnce(&crate::store::tiles::GrowingMap) -> T,
    ) -> T {
        match &locked(&self.reading.source).cells {
            Cells::File(columns) => of_file(columns.map()),
            Cells::Growing(growing) => of_tiles(growing),
        }
    }

    /// A window, once it is read completely or `patience` is over. It is read on for a moment
    /// then, so that the next request for it finds more.
    ///
    /// # Errors
    /// A description of the fault when there is no such window.
    pub(crate) fn window(&self, asked: &Asked, patience: Duration) -> Result<Arc<View>, String> {
        let until = Instant::now() + patience;
        let view = self.view(asked, until + UNTIL_NEXT)?;
        let mut views = self.desk.views();
        while !view.is_complete() {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            let waited = self.desk.news.wait_timeout(views, left);
            views = waited.unwrap_or_else(std::sync::PoisonError::into_inner).0;
        }
        drop(views);
        Ok(view)
    }

    /// The view of a window that is wanted until `until`: the one that is already being read, or a
    /// new one.
    fn view(&self, asked: &Asked, until: Instant) -> Result<Arc<View>, String> {
        let version = self.reading.version.load(Ordering::Relaxed);
        let mut views = self.desk.views();
        let known = |view: &Arc<View>| view.asked == *asked && view.version == version;
        if let Some(place) = views.iter().position(known) {
            let view = views.remove(place).ok_or("it has gone")?;
            view.want(until);
            views.push_front(Arc::clone(&view));
            drop(views);
            self.desk.work.notify_all();
            return Ok(view);
        }
        drop(views);
        let number = self.numbers.fetch_add(1, Ordering::Relaxed);
        let view = View::new(asked.clone(), &self.facts, (version, number), until)?;
        let view = Arc::new(view);
        self.reading.show_kept(&view);
        let mut views = self.desk.views();
        views.push_front(Arc::clone(&view));
        let room = views.iter().map(|view| view.bytes()).sum::<usize>() <= MOST_OF_VIEWS;
        views.truncate(if room { MOST_VIEWS } else { 1 });
        drop(views);
        self.desk.work.notify_all();
        Ok(view)
    }

    /// The bits of a cell of a column; the fill value where it is not computed.
    ///
    /// # Errors
    /// A description of the fault when it cannot be read.
    pub(crate) fn cell(&self, column: usize, index: &[usize]) -> Result<u64, String> {
        self.reading.cell(column, index)
    }

    /// The curves of the plane at `index`.
    ///
    /// # Errors
    /// When the map is damaged.
    pub(crate) fn curves(&self, index: &[usize]) -> Result<Vec<MapCurve>, StoreError> {
        match &mut locked(&self.reading.source).cells {
            Cells::Growing(growing) => growing.curves(index),
            Cells::File(columns) => {
                let map = columns.map();
                let Some((p, tau)) = map.boundary_plane() else {
                    return Ok(Vec::new());
                };
                let outer = map.axes().iter().zip(index).enumerate();
                let outer = outer.filter(|(axis, _)| *axis != p && *axis != tau);
                let outer: Vec<f64> = outer.map(|(_, (axis, &i))| axis.values[i]).collect();
                map.curves_where(|of| of == outer)
            }
        }
    }

    /// The axes of the planes of curves, parameter and delay; none without curves.
    #[must_use]
    pub(crate) fn curves_plane(&self) -> Option<(usize, usize)> {
        self.told(crate::store::MapFile::boundary_plane, |growing| {
            growing.plan().boundary_plane
        })
    }
}

impl Desk {
    fn views(&self) -> MutexGuard<'_, VecDeque<Arc<View>>> {
        locked(&self.views)
    }

    /// The next chunk of the newest window that is wanted and has chunks left; waits for one.
    fn next(&self) -> (Arc<View>, Job) {
        let mut views = self.views();
        loop {
            let mut all = views.iter().filter(|view| view.is_wanted());
            let found = all.find_map(|view| {
                let job = locked(&view.jobs).next()?;
                Some((Arc::clone(view), job))
            });
            if let Some(found) = found {
                return found;
            }
            let woken = self.work.wait(views);
            views = woken.unwrap_or_else(std::sync::PoisonError::into_inner);
        }
    }

    /// Reads the next chunk. A chunk that cannot be read still counts towards a complete window.
    fn work(&self, read: impl FnOnce(&View, Job) -> Result<(), String>) {
        let (view, job) = self.next();
        let done = catch_unwind(AssertUnwindSafe(|| read(&view, job)));
        let failed = "a chunk could not be read; this is a fault of slipmap";
        view.finish_one(done.unwrap_or_else(|_| Err(failed.into())));
        if view.is_complete() {
            // Take the lock first, so that a thread between checking and waiting does not miss the
            // signal.
            drop(self.views());
            self.news.notify_all();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::{Field, Parameter};
    use crate::store::chunk_layout::ChunkLayout;
    use crate::store::map_file::MapAxis;

    /// A map of one axis, in chunks of 4 cells.
    fn facts() -> Facts {
        let layout = |element| ChunkLayout {
            shape: vec![20],
            chunk: vec![4],
            element,
            deflated: false,
            shuffled: false,
        };
        Facts {
            axes: vec![MapAxis {
                parameter: Parameter::Tau.into(),
                values: (0..20).map(f64::from).collect(),
                unit: "1".into(),
            }],
            fields: vec![Field::NUnstable],
            plan: None,
            layouts: vec![layout(2), layout(1)],
        }
    }

    fn view(until: Instant) -> Arc<View> {
        let stretch = Stretch {
            from: None,
            to: None,
            pixels: 10,
            scale: Scale::Linear,
        };
        let asked = Asked {
            field: Field::NUnstable,
            x: 0,
            y: None,
            at: vec![0],
            across: stretch,
            up: stretch,
        };
        Arc::new(View::new(asked, &facts(), (1, 1), until).unwrap())
    }

    /// What nobody asks for any more is left, and read on once it is asked for again.
    #[test]
    fn a_window_that_nobody_waits_for_is_not_read() {
        let (desk, gone) = (Desk::default(), view(Instant::now()));
        let wanted = view(Instant::now() + Duration::from_secs(600));
        desk.views().push_front(Arc::clone(&wanted));
        desk.views().push_front(Arc::clone(&gone));
        // The newest one comes first, but not where its client has gone.
        desk.work(|view, _| {
            assert!(std::ptr::eq(view, Arc::as_ptr(&wanted)));
            Ok(())
        });
        gone.want(Instant::now() + Duration::from_secs(600));
        gone.want(Instant::now());
        desk.work(|view, _| {
            assert!(std::ptr::eq(view, Arc::as_ptr(&gone)));
            Ok(())
        });
    }

    #[test]
    fn a_window_is_complete_also_where_a_chunk_fails() {
        let (desk, facts) = (Desk::default(), facts());
        let view = view(Instant::now() + Duration::from_secs(600));
        desk.views().push_front(Arc::clone(&view));
        for number in 0..10 {
            assert!(!view.is_complete(), "{number}");
            desk.work(|_, _| match number {
                3 => panic!("as a fault would"),
                _ => Ok(()),
            });
        }
        assert!(view.is_complete());
        let damage = view.shot(&facts).damage;
        assert!(damage.is_some_and(|why| why.contains("fault of slipmap")));
    }
}
