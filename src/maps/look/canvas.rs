//! What the pixels of a window show of the cells that were read so far.

use std::ops::Range;

use super::cells::{Cell, Reader, Slab};
use super::pixels::Pixels;

/// The pixel hides cells of several values.
pub const SEVERAL: u8 = 1;
/// The cell that it shows was not read yet.
pub const UNREAD: u8 = 2;
/// The cell that it shows is not computed yet.
pub const NOT_COMPUTED: u8 = 4;
/// Its value is that of a cell that it hides, until the one that it shows is read.
const HIDDEN_SEEN: u8 = 128;

/// Pixels of cells, the slower axis of the map row by row.
#[derive(Debug)]
pub(super) struct Canvas<T> {
    pub values: Vec<T>,
    pub bits: Vec<u8>,
}

/// The pixels along both axes, and where a slab lies under them.
pub(super) struct Under<'a> {
    pub slow: &'a Pixels,
    pub fast: &'a Pixels,
    /// The cells of the slab along both axes.
    pub cells: (Range<u32>, Range<u32>),
}

impl<T: Cell> Canvas<T> {
    pub(super) fn new(pixels: usize) -> Self {
        Self {
            values: vec![T::default(); pixels],
            bits: vec![UNREAD; pixels],
        }
    }

    /// Shows the cells of a slab that are nearest to pixels and, where `several` is asked for,
    /// marks pixels that hide others.
    pub(super) fn paint(&mut self, slab: &Slab<T>, under: &Under, several: bool) {
        self.show(slab, under);
        if several {
            self.compare(slab, under);
        }
    }

    fn show(&mut self, slab: &Slab<T>, under: &Under) {
        let (rows, cells) = &under.cells;
        let across = under.fast.showing(cells);
        let mut reader = slab.cells.reader();
        for down in under.slow.showing(rows) {
            let row = (under.slow.nearest[down] - rows.start) as usize;
            let from = slab.base + row * slab.row;
            for pixel in across.clone() {
                let cell = (under.fast.nearest[pixel] - cells.start) as usize;
                let value = reader.at(from + cell);
                let place = down * under.fast.len() + pixel;
                let bits = &mut self.bits[place];
                if *bits & HIDDEN_SEEN != 0 && self.values[place] != value {
                    *bits |= SEVERAL;
                }
                *bits &= !(UNREAD | HIDDEN_SEEN);
                self.values[place] = value;
            }
        }
    }

    /// A pixel hides cells of this value.
    fn see(&mut self, place: usize, value: T) {
        let bits = &mut self.bits[place];
        if *bits & (UNREAD | HIDDEN_SEEN) == UNREAD {
            *bits |= HIDDEN_SEEN;
            self.values[place] = value;
        } else if self.values[place] != value {
            *bits |= SEVERAL;
        }
    }

    fn compare(&mut self, slab: &Slab<T>, under: &Under) {
        let (rows, _) = &under.cells;
        let mut readers = [slab.cells.reader(), slab.cells.reader()];
        for down in under.slow.holding(rows) {
            let inside = &under.slow.inside[down];
            let inside = inside.start.max(rows.start)..inside.end.min(rows.end);
            for row in inside.clone() {
                let from = slab.base + (row - rows.start) as usize * slab.row;
                match row == inside.start {
                    true => self.compare_within(from, down, under, &mut readers[0]),
                    false => self.compare_rows([from - slab.row, from], down, under, &mut readers),
                }
            }
        }
    }

    /// Marks the pixels of a row of pixels in which cells of one row differ, or are not what the
    /// pixel has seen.
    fn compare_within(&mut self, from: usize, down: usize, under: &Under, reader: &mut Reader<T>) {
        let cells = &under.cells.1;
        let alone = under.slow.inside[down].len() == 1;
        for pixel in under.fast.holding(cells) {
            let whole = &under.fast.inside[pixel];
            let (low, high) = (whole.start.max(cells.start), whole.end.min(cells.end));
            let place = down * under.fast.len() + pixel;
            if low >= high || alone && whole.len() == 1 || self.bits[place] & SEVERAL != 0 {
                continue;
            }
            let at = |cell: u32| from + (cell - cells.start) as usize;
            match reader.only(at(low), at(high)) {
                Some(value) => self.see(place, value),
                None => self.bits[place] |= SEVERAL,
            }
        }
    }

    /// Marks the pixels in which cells of two neighbouring rows differ.
    fn compare_rows(
        &mut self,
        rows: [usize; 2],
        down: usize,
        under: &Under,
        readers: &mut [Reader<T>; 2],
    ) {
        let cells = &under.cells.1;
        let width = cells.len();
        if let Some(each) = readers[0].each() {
            let [one, other] = rows.map(|from| &each[from..from + width]);
            if one == other {
                return;
            }
            for pixel in under.fast.holding(cells) {
                let whole = &under.fast.inside[pixel];
                let (low, high) = (whole.start.max(cells.start), whole.end.min(cells.end));
                let part = (low - cells.start) as usize..(high.max(low) - cells.start) as usize;
                if one[part.clone()] != other[part] {
                    self.bits[down * under.fast.len() + pixel] |= SEVERAL;
                }
            }
            return;
        }
        let mut at = 0;
        while at < width {
            let [one, other] = [0, 1].map(|i| readers[i].until(rows[i] + at));
            let end = (one.1 - rows[0]).min(other.1 - rows[1]).min(width);
            if one.0 != other.0 {
                let differing = cells.start + at as u32..cells.start + end as u32;
                for pixel in under.fast.holding(&differing) {
                    if !under.fast.inside[pixel].is_empty() {
                        self.bits[down * under.fast.len() + pixel] |= SEVERAL;
                    }
                }
            }
            at = end;
        }
    }
}
