//! From the chunks of a map to the pixels of a window.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use super::canvas::{Canvas, Under};
use super::cells::{Cell, Cells, Cut, Slab};
use super::jobs::Job;
use super::shelf::{Key, Plane, Shelf};
use super::short::Short;
use super::source::{Facts, Source};
use super::view::{AnyCanvas, View, locked};
use crate::linear::status::AMISS;
use crate::store::chunk_layout::ChunkLayout;
use crate::sweep::engine::STATUS_FILL;
use crate::sweep::plan::tile::{memory_strides, place_of};

/// A whole chunk is kept as runs if these take at most one such share of its bytes.
const SHARE_OF_CHUNK: usize = 16;
/// The part of a chunk in a plane is kept as runs if these take at most one such share of it.
const SHARE_OF_SLAB: usize = 4;

/// Reads the chunks of a map.
#[derive(Debug)]
pub(super) struct Reading {
    pub source: Mutex<Source>,
    pub version: AtomicU64,
    facts: Arc<Facts>,
    shelf: Mutex<Shelf>,
    short: Mutex<Short>,
}

/// A chunk of a column, and its part in a plane.
struct Part {
    column: usize,
    plane: Arc<Plane>,
    /// Its number, counted row by row.
    number: u64,
    /// Its first cell.
    offset: Vec<usize>,
    /// Ranges of cells along the slower and the faster axis.
    cells: (Range<u32>, Range<u32>),
    cut: Cut,
}

impl Part {
    fn of(layout: &ChunkLayout, column: usize, plane: &Arc<Plane>, chunk: (usize, usize)) -> Self {
        let mut offset: Vec<usize> = plane
            .at
            .iter()
            .zip(&layout.chunk)
            .map(|(at, length)| at / length * length)
            .collect();
        let fast = plane.fast;
        offset[fast] = chunk.1 * layout.chunk[fast];
        if let Some(slow) = plane.slow {
            offset[slow] = chunk.0 * layout.chunk[slow];
        }
        let strides = memory_strides(&layout.chunk);
        let range = |axis: usize| {
            let from = offset[axis];
            let to = (from + layout.chunk[axis]).min(layout.shape[axis]);
            from as u32..to as u32
        };
        let rows = plane.slow.map_or(0..1, range);
        let columns = range(fast);
        let inside = (0..offset.len()).map(|axis| {
            let spanned = axis == fast || Some(axis) == plane.slow;
            if spanned {
                0
            } else {
                plane.at[axis] - offset[axis]
            }
        });
        let inside: Vec<usize> = inside.collect();
        Self {
            column,
            plane: Arc::clone(plane),
            number: number_of(layout, &offset),
            cut: Cut {
                base: place_of(&inside, &strides),
                strides: (plane.slow.map_or(0, |slow| strides[slow]), strides[fast]),
                extent: (rows.len(), columns.len()),
            },
            cells: (rows, columns),
            offset,
        }
    }

    fn key(&self, of_plane: bool) -> Key {
        Key {
            column: self.column,
            chunk: self.number,
            plane: of_plane.then(|| Arc::clone(&self.plane)),
        }
    }

    /// The rows of the plane inside a whole chunk in which each row is contiguous.
    fn in_chunk<T>(&self, cells: &Arc<Cells<T>>) -> Slab<T> {
        Slab {
            cells: Arc::clone(cells),
            base: self.cut.base,
            row: self.cut.strides.0,
        }
    }

    /// The rows of the plane, copied out of a chunk.
    fn taken_out<T>(&self, cells: Cells<T>) -> Slab<T> {
        Slab {
            cells: Arc::new(cells),
            base: 0,
            row: self.cut.extent.1,
        }
    }

    fn has_rows(&self) -> bool {
        self.cut.strides.1 == 1
    }
}

/// The number of the chunk whose first cell is at `offset`, counted row by row.
fn number_of(layout: &ChunkLayout, offset: &[usize]) -> u64 {
    let axes = offset.iter().zip(&layout.chunk).zip(&layout.shape);
    axes.fold(0, |number, ((&at, &length), &whole)| {
        number * whole.div_ceil(length) as u64 + (at / length) as u64
    })
}

/// The flags of a status that report a problem, or the fill value if there is no status.
pub(super) fn amiss(status: u8) -> u8 {
    match status {
        STATUS_FILL => STATUS_FILL,
        _ => status & AMISS,
    }
}

/// The cells of a chunk as they were read.
struct Fetched<T> {
    cells: Cells<T>,
    /// The version of the map at which the chunk was missing.
    missing: Option<u64>,
}

impl Reading {
    pub(super) fn new(source: Source, facts: Arc<Facts>) -> Self {
        Self {
            version: AtomicU64::new(source.version),
            source: Mutex::new(source),
            facts,
            shelf: Mutex::default(),
            short: Mutex::default(),
        }
    }

    /// Shows the chunks of a window that are in memory. The others remain to be read.
    pub(super) fn show_kept(&self, view: &View) {
        let mut jobs = std::mem::take(&mut *locked(&view.jobs));
        jobs.retain(|job| {
            let shown = self.show(view, job, true);
            if let Ok(true) = shown {
                view.finish_one(Ok(()));
            }
            !matches!(shown, Ok(true))
        });
        *locked(&view.jobs) = jobs;
    }

    /// Reads a chunk and shows it.
    pub(super) fn read(&self, view: &View, job: Job) -> Result<(), String> {
        self.show(view, job, false).map(drop)
    }

    /// Shows a chunk. With `kept`, only one in memory; false if it is not there.
    fn show(&self, view: &View, job: Job, kept: bool) -> Result<bool, String> {
        let column = match job.status {
            true => self.facts.status(),
            false => view.column,
        };
        let part = Part::of(&self.facts.layouts[column], column, &view.plane, job.chunk);
        let under = Under {
            slow: &view.slow,
            fast: &view.fast,
            cells: part.cells.clone(),
        };
        if job.status {
            let Some(slab) = self.slab::<u8>(&part, view, kept)? else {
                return Ok(false);
            };
            locked(&view.status).paint(&slab, &under, false);
            if view.crowded && slab.cells.any(|status| amiss(status) != 0) {
                let amiss = Slab {
                    cells: Arc::new(slab.cells.map(amiss)),
                    ..slab
                };
                view.mark_amiss(&amiss, &under);
            }
            return Ok(true);
        }
        let several = view.crowded;
        macro_rules! paint {
            ($kind:ty, $name:ident) => {{
                let Some(slab) = self.slab::<$kind>(&part, view, kept)? else {
                    return Ok(false);
                };
                let paint = |canvas: &mut Canvas<$kind>| canvas.paint(&slab, &under, several);
                if let AnyCanvas::$name(canvas) = &mut *locked(&view.field) {
                    paint(canvas);
                }
            }};
        }
        match self.facts.layouts[column].element {
            1 => paint!(u8, U8),
            2 => paint!(u16, U16),
            _ => paint!(u64, U64),
        }
        Ok(true)
    }

    /// The rows of a plane in a chunk. With `kept`, only those in memory; none if they are not
    /// there.
    fn slab<T: Cell>(
        &self,
        part: &Part,
        view: &View,
        kept: bool,
    ) -> Result<Option<Slab<T>>, String> {
        let version = self.version.load(Ordering::Relaxed);
        let (of_plane, of_chunk, missing) = {
            let mut shelf = locked(&self.shelf);
            let key = part.key(false);
            let of_plane = shelf.get(&part.key(true), version, view.number);
            let of_chunk = shelf.get(&key, version, view.number);
            (of_plane, of_chunk, shelf.is_missing(&key))
        };
        if let Some(cells) = of_plane.as_ref().and_then(T::unwrapped) {
            return Ok(Some(Slab {
                cells: Arc::clone(cells),
                base: 0,
                row: part.cut.extent.1,
            }));
        }
        if let Some(cells) = of_chunk.as_ref().and_then(T::unwrapped) {
            return Ok(Some(self.of_chunk(part, cells, missing, view.number)));
        }
        if kept {
            return Ok(None);
        }
        let Fetched { cells, missing } = self.fetch::<T>(part.column, &part.offset)?;
        if cells.is_runs() {
            let cells = Arc::new(cells);
            let wrapped = T::wrapped(Arc::clone(&cells));
            locked(&self.shelf).put(part.key(false), wrapped, missing, view.number);
            return Ok(Some(self.of_chunk(part, &cells, missing, view.number)));
        }
        Ok(Some(self.take_out(part, &cells, missing, view.number)))
    }

    /// The rows of a plane in a chunk that is stored as runs.
    fn of_chunk<T: Cell>(
        &self,
        part: &Part,
        cells: &Arc<Cells<T>>,
        missing: Option<u64>,
        now: u64,
    ) -> Slab<T> {
        match part.has_rows() {
            true => part.in_chunk(cells),
            false => self.take_out(part, cells, missing, now),
        }
    }

    /// Copies the rows of a plane out of a chunk, and keeps them.
    fn take_out<T: Cell>(
        &self,
        part: &Part,
        cells: &Cells<T>,
        missing: Option<u64>,
        now: u64,
    ) -> Slab<T> {
        let slab = part.taken_out(Cells::of(part.cut.of(cells), SHARE_OF_SLAB));
        let wrapped = T::wrapped(Arc::clone(&slab.cells));
        locked(&self.shelf).put(part.key(true), wrapped, missing, now);
        slab
    }

    /// Reads a chunk.
    fn fetch<T: Cell>(&self, column: usize, offset: &[usize]) -> Result<Fetched<T>, String> {
        let layout = &self.facts.layouts[column];
        let (stored, version) = {
            let mut source = locked(&self.source);
            (source.stored(column, offset), source.version)
        };
        let Some(stored) = stored.map_err(|error| error.to_string())? else {
            let bits = self.facts.fill(column).to_le_bytes();
            return Ok(Fetched {
                cells: Cells::constant(T::of(&bits[..T::SIZE]), layout.cells()),
                missing: Some(version),
            });
        };
        let short = Short::key(layout, &stored);
        let known = short.as_ref().and_then(|key| locked(&self.short).get(key));
        let cells = if let Some(cells) = known {
            cells
        } else {
            let bytes = layout.decoded(stored)?;
            let cells: Vec<T> = bytes.chunks_exact(T::SIZE).map(T::of).collect();
            drop(bytes);
            let cells = Cells::of(cells, SHARE_OF_CHUNK);
            if let Some(key) = short {
                locked(&self.short).put(key, &cells);
            }
            cells
        };
        Ok(Fetched {
            cells,
            missing: None,
        })
    }

    /// The bits of one cell.
    pub(super) fn cell(&self, column: usize, index: &[usize]) -> Result<u64, String> {
        let layout = self
            .facts
            .layouts
            .get(column)
            .ok_or("there is no such column")?;
        let inside = index.iter().zip(&layout.shape);
        if index.len() != layout.shape.len() || inside.clone().any(|(i, length)| i >= length) {
            return Err("there is no such cell".into());
        }
        let axes = index.iter().zip(&layout.chunk);
        let offset: Vec<usize> = axes.map(|(i, length)| i / length * length).collect();
        let place: Vec<usize> = index
            .iter()
            .zip(&offset)
            .map(|(i, from)| i - from)
            .collect();
        let place = place_of(&place, &memory_strides(&layout.chunk));
        macro_rules! read {
            ($kind:ty) => {
                u64::from(self.one::<$kind>(column, &offset, place)?)
            };
        }
        Ok(match layout.element {
            1 => read!(u8),
            2 => read!(u16),
            _ => read!(u64),
        })
    }

    fn one<T: Cell>(&self, column: usize, offset: &[usize], place: usize) -> Result<T, String> {
        let layout = &self.facts.layouts[column];
        let key = Key {
            column,
            chunk: number_of(layout, offset),
            plane: None,
        };
        let version = self.version.load(Ordering::Relaxed);
        let kept = locked(&self.shelf).get(&key, version, 0);
        if let Some(cells) = kept.as_ref().and_then(T::unwrapped) {
            return Ok(cells.reader().at(place));
        }
        Ok(self.fetch::<T>(column, offset)?.cells.reader().at(place))
    }
}
