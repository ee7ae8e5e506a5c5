//! A window that is being read: its pixels, and the chunks that are still to be read.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use super::canvas::{BEYOND, Canvas, NOT_COMPUTED, SEVERAL, UNREAD, Under};
use super::cells::{Cell, Slab};
use super::jobs::Jobs;
use super::pixels::Pixels;
use super::reading::amiss;
use super::shelf::Plane;
use super::source::Facts;
use super::window::{Asked, Columns, Numbers, Shot, Shown};
use crate::sweep::engine::STATUS_FILL;

/// The pixels of a field, in one of three types.
#[derive(Debug)]
pub(super) enum AnyCanvas {
    U8(Canvas<u8>),
    U16(Canvas<u16>),
    U64(Canvas<u64>),
}

impl AnyCanvas {
    fn new(element: usize, pixels: usize) -> Self {
        match element {
            1 => Self::U8(Canvas::new(pixels)),
            2 => Self::U16(Canvas::new(pixels)),
            _ => Self::U64(Canvas::new(pixels)),
        }
    }

    fn bits(&self) -> &[u8] {
        match self {
            Self::U8(canvas) => &canvas.bits,
            Self::U16(canvas) => &canvas.bits,
            Self::U64(canvas) => &canvas.bits,
        }
    }
}

/// A window that is being read.
#[derive(Debug)]
pub(crate) struct View {
    pub(super) asked: Asked,
    pub(super) version: u64,
    /// Increases from view to view.
    pub(super) number: u64,
    pub(super) plane: std::sync::Arc<Plane>,
    pub(super) column: usize,
    pub(super) slow: Pixels,
    pub(super) fast: Pixels,
    /// Whether pixels may hide cells.
    pub(super) crowded: bool,
    pub(super) field: Mutex<AnyCanvas>,
    pub(super) status: Mutex<Canvas<u8>>,
    /// The pixels that hide flagged cells; none while no such cells were found.
    amiss: Mutex<Option<Canvas<u8>>>,
    pub(super) jobs: Mutex<Jobs>,
    /// Nobody waits for it any longer than this, unless it is requested again.
    until: Mutex<Instant>,
    total: usize,
    done: AtomicUsize,
    damage: Mutex<Option<String>>,
}

/// Locks a mutex. A poisoned one is accepted: no holder leaves its data inconsistent.
pub(super) fn locked<T>(of: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    of.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

impl View {
    /// A view of which nothing is read yet, and that somebody waits for until `until`.
    ///
    /// # Errors
    /// A description of the fault when there is no such window.
    pub(super) fn new(
        asked: Asked,
        facts: &Facts,
        (version, number): (u64, u64),
        until: Instant,
    ) -> Result<Self, String> {
        let column = facts.column(asked.field);
        let column = column.ok_or("the map does not hold this field")?;
        let along = |axis: usize, stretch| Pixels::along(&facts.axes[axis].values, stretch);
        let across = along(asked.x, &asked.across)?;
        let (slow, fast, plane) = match asked.y {
            None => (Pixels::one(0), across, (None, asked.x)),
            Some(y) => {
                let up = along(y, &asked.up)?;
                match asked.x < y {
                    true => (across, up, (Some(asked.x), y)),
                    false => (up, across, (Some(y), asked.x)),
                }
            }
        };
        let mut at = asked.at.clone();
        for axis in [plane.0, Some(plane.1)].into_iter().flatten() {
            at[axis] = 0;
        }
        let plane = Plane {
            slow: plane.0,
            fast: plane.1,
            at,
        };
        let crowded = slow.is_crowded() || fast.is_crowded();
        let field = &facts.layouts[column];
        let pixels = slow.len() * fast.len();
        let layouts = (field, &facts.layouts[facts.status()]);
        let jobs = Jobs::of(&plane, (&slow, &fast), layouts);
        Ok(Self {
            field: Mutex::new(AnyCanvas::new(field.element, pixels)),
            status: Mutex::new(Canvas::new(pixels)),
            amiss: Mutex::default(),
            total: jobs.len(),
            jobs: Mutex::new(jobs),
            until: Mutex::new(until),
            done: AtomicUsize::new(0),
            damage: Mutex::default(),
            plane: std::sync::Arc::new(plane),
            asked,
            version,
            number,
            column,
            slow,
            fast,
            crowded,
        })
    }

    /// Bytes of its pixels.
    pub(super) fn bytes(&self) -> usize {
        // Value and bits of the field, and the same for the status and for flagged cells.
        self.slow.len() * self.fast.len() * (self.asked.field.bytes() + 5)
    }

    /// Somebody waits for it until `until`.
    pub(super) fn want(&self, until: Instant) {
        let mut latest = locked(&self.until);
        *latest = until.max(*latest);
    }

    /// Whether somebody waits for it.
    pub(super) fn is_wanted(&self) -> bool {
        Instant::now() < *locked(&self.until)
    }

    pub(super) fn is_complete(&self) -> bool {
        self.done.load(Ordering::Acquire) >= self.total
    }

    /// Counts a finished job. Cells that could not be read stay marked as unread.
    pub(super) fn finish_one(&self, done: Result<(), String>) {
        if let Err(why) = done {
            locked(&self.damage).get_or_insert(why);
        }
        self.done.fetch_add(1, Ordering::Release);
    }

    /// Marks pixels that hide flagged cells of a slab. Such cells are rare.
    pub(super) fn mark_amiss(&self, slab: &Slab<u8>, under: &Under) {
        let mut hiding = locked(&self.amiss);
        let pixels = self.slow.len() * self.fast.len();
        let hiding = hiding.get_or_insert_with(|| Canvas::that_saw(0, pixels));
        hiding.compare(slab, under);
    }

    /// The bits of the pixels, from those of the field and of the status.
    fn marks(&self, of_field: &[u8], status: &Canvas<u8>, places: &[usize]) -> Vec<u8> {
        let marks = |&place: &usize| {
            let (of_field, of_status) = (of_field[place], status.bits[place]);
            let missing = of_status & UNREAD == 0 && status.values[place] == STATUS_FILL;
            let unread = (of_field | of_status) & UNREAD;
            (of_field & SEVERAL) | unread | if missing { NOT_COMPUTED } else { 0 }
        };
        let (rows, columns) = (&self.slow.on_axis, &self.fast.on_axis);
        let (height, width) = (self.slow.len(), self.fast.len());
        let hiding = locked(&self.amiss);
        if hiding.is_none() && *rows == (0..height) && *columns == (0..width) {
            return places.iter().map(marks).collect();
        }
        let hides = |place: usize| match &*hiding {
            Some(hiding) => hiding.bits[place] & SEVERAL != 0 && amiss(status.values[place]) == 0,
            None => false,
        };
        let all = places.iter().map(|&place| {
            match rows.contains(&(place / width)) && columns.contains(&(place % width)) {
                true if hides(place) => marks(&place) | SEVERAL,
                true => marks(&place),
                false => BEYOND,
            }
        });
        all.collect()
    }

    /// The window, as far as it is read.
    #[must_use]
    pub(crate) fn shot(&self, facts: &Facts) -> Shot {
        // This is read before the pixels, so that a window reported as complete is complete.
        let done = self.done.load(Ordering::Acquire);
        let shown = |axis: usize, pixels: &Pixels| {
            let index = (0..pixels.len()).map(|i| pixels.nearest[pixels.place(i)]);
            let index: Vec<u32> = index.collect();
            let values = &facts.axes[axis].values;
            Shown {
                values: index.iter().map(|&i| values[i as usize]).collect(),
                index,
            }
        };
        let x_is_slow = self.plane.slow == Some(self.asked.x);
        let (across, up) = match x_is_slow {
            true => (&self.slow, &self.fast),
            false => (&self.fast, &self.slow),
        };
        let fast = self.fast.len();
        let columns = columns(across, up);
        let mut places = Vec::new();
        for ix in columns.firsts() {
            places.extend(
                (0..up.len()).map(|iy| match (across.place(ix), up.place(iy)) {
                    (ix, iy) if x_is_slow => ix * fast + iy,
                    (ix, iy) => iy * fast + ix,
                }),
            );
        }
        let field = locked(&self.field);
        let status = locked(&self.status);
        let fill = facts.fill(self.column);
        let hidden = |place: usize| field.bits()[place] & UNREAD != 0;
        let values = match &*field {
            AnyCanvas::U8(canvas) => Numbers::U8(picked(canvas, &places, hidden, fill as u8)),
            AnyCanvas::U16(canvas) => Numbers::U16(picked(canvas, &places, hidden, fill as u16)),
            AnyCanvas::U64(canvas) => {
                let bits = picked(canvas, &places, hidden, fill);
                Numbers::F64(bits.into_iter().map(f64::from_bits).collect())
            }
        };
        let unread = |place: usize| status.bits[place] & UNREAD != 0;
        Shot {
            complete: done >= self.total,
            progress: done as f64 / self.total.max(1) as f64,
            version: self.version,
            x: shown(self.asked.x, across),
            y: self.asked.y.map(|y| shown(y, up)),
            columns,
            values,
            status: picked(&status, &places, unread, STATUS_FILL),
            bits: self.marks(field.bits(), &status, &places),
            damage: locked(&self.damage).clone(),
        }
    }
}

/// The columns of pixels. Neighbours are alike where no pixel hides a cell and both show the same.
fn columns(across: &Pixels, up: &Pixels) -> Columns {
    let all = 0..across.len() as u32;
    let hides = across.is_crowded() || up.is_crowded();
    let shown = |column: u32| {
        let place = across.place(column as usize);
        (across.nearest[place], across.on_axis.contains(&place))
    };
    let mut last = 0;
    let which = all.map(|column| {
        last += u32::from(column > 0 && (hides || shown(column) != shown(column - 1)));
        last
    });
    Columns {
        which: which.collect(),
        height: up.len(),
    }
}

/// The values at the given places, `fill` where the pixel shows no cell.
fn picked<T: Cell>(
    canvas: &Canvas<T>,
    places: &[usize],
    hidden: impl Fn(usize) -> bool,
    fill: T,
) -> Vec<T> {
    let value = |&place: &usize| match hidden(place) {
        true => fill,
        false => canvas.values[place],
    };
    places.iter().map(value).collect()
}
