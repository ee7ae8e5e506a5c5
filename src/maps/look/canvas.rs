//! The pixels of a window, filled from the cells read so far.

use std::ops::Range;

use super::cells::{Cell, Reader, Slab};
use super::pixels::Pixels;

/// The pixel hides cells with different values, or flagged cells although the cell that it shows
/// has no flag.
pub(crate) const SEVERAL: u8 = 1;
/// The cell of the pixel is not read yet.
pub(crate) const UNREAD: u8 = 2;
/// The cell of the pixel is not computed yet.
pub(crate) const NOT_COMPUTED: u8 = 4;
/// The pixel lies beyond the axes and shows no cell.
pub(crate) const BEYOND: u8 = 8;
/// The pixel has the value of a hidden cell for now, because its own cell is not read yet.
const HIDDEN_SEEN: u8 = 128;

/// Pixels, row by row along the slower axis of the map.
#[derive(Debug)]
pub(super) struct Canvas<T> {
    pub values: Vec<T>,
    pub bits: Vec<u8>,
}

/// The pixels along both axes, and the position of a slab under them.
pub(super) struct Under<'a> {
    pub slow: &'a Pixels,
    pub fast: &'a Pixels,
    /// The range of the slab's cells along both axes.
    pub cells: (Range<u32>, Range<u32>),
}

impl<T: Cell> Canvas<T> {
    pub(super) fn new(pixels: usize) -> Self {
        Self {
            values: vec![T::default(); pixels],
            bits: vec![UNREAD; pixels],
        }
    }

    /// Pixels that hold `value` for now: cells with another value mark them.
    pub(super) fn that_saw(value: T, pixels: usize) -> Self {
        Self {
            values: vec![value; pixels],
            bits: vec![UNREAD | HIDDEN_SEEN; pixels],
        }
    }

    /// Shows the cells of a slab that are nearest to pixels. With `several`, it also marks pixels
    /// that hide cells with different values.
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

    /// Records that a pixel hides a cell with this value.
    fn see(&mut self, place: usize, value: T) {
        let bits = &mut self.bits[place];
        if *bits & (UNREAD | HIDDEN_SEEN) == UNREAD {
            *bits |= HIDDEN_SEEN;
            self.values[place] = value;
        } else if self.values[place] != value {
            *bits |= SEVERAL;
        }
    }

    /// Marks pixels that hide cells with different values.
    pub(super) fn compare(&mut self, slab: &Slab<T>, under: &Under) {
        let (rows, _) = &under.cells;
        let mut readers = [slab.cells.reader(), slab.cells.reader()];
        let constant = slab.cells.is_constant();
        for down in under.slow.holding(rows) {
            let inside = &under.slow.inside[down];
            let mut inside = inside.start.max(rows.start)..inside.end.min(rows.end);
            if constant && !inside.is_empty() {
                // All rows are equal, so one is enough.
                inside.end = inside.start + 1;
            }
            for row in inside.clone() {
                let from = slab.base + (row - rows.start) as usize * slab.row;
                match row == inside.start {
                    true => self.compare_within(from, down, under, &mut readers[0]),
                    false => self.compare_rows([from - slab.row, from], down, under, &mut readers),
                }
            }
        }
    }

    /// In one row of pixels, marks those in which cells of one row differ from one another or from
    /// the pixel's value.
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::cells::Cells;
    use super::super::pixels::{Scale, Stretch};
    use super::*;

    /// Pseudo-random numbers, the same in every run.
    struct Chance(u64);

    impl Chance {
        fn of(&mut self, count: usize) -> usize {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 % count as u64) as usize
        }

        fn part(&mut self) -> f64 {
            self.of(1 << 40) as f64 / (1_u64 << 40) as f64
        }

        /// An uneven axis, and pixels on a stretch of it that may extend beyond it.
        fn axis(&mut self, most: usize) -> (usize, Pixels) {
            let mut value = 0.0;
            let count = 1 + self.of(most);
            let values: Vec<f64> = (0..count)
                .map(|_| {
                    value += 0.1 + self.part();
                    value
                })
                .collect();
            let mut end = || Some((1.6 * self.part() - 0.3) * value);
            let stretch = Stretch {
                from: end(),
                to: end(),
                pixels: 1 + self.of(9),
                scale: Scale::Linear,
            };
            (count, Pixels::along(&values, &stretch).unwrap())
        }

        /// These cells, stored in a random form.
        fn stored(&mut self, cells: Vec<u16>) -> Cells<u16> {
            if self.of(2) == 0 {
                return Cells::Each(cells);
            }
            let (mut ends, mut values) = (Vec::new(), Vec::new());
            for run in cells.chunk_by(|a, b| a == b) {
                ends.push(ends.last().unwrap_or(&0) + run.len() as u32);
                values.push(run[0]);
            }
            Cells::Runs { ends, values }
        }
    }

    /// A plane of cells, row by row.
    struct Field {
        width: usize,
        cells: Vec<u16>,
    }

    impl Field {
        fn at(&self, row: u32, column: u32) -> u16 {
            self.cells[row as usize * self.width + column as usize]
        }

        /// The part of the field in a chunk, with a gap between its rows.
        fn slab(
            &self,
            (rows, columns): &(Range<u32>, Range<u32>),
            chance: &mut Chance,
        ) -> Slab<u16> {
            let (base, between) = (chance.of(3), chance.of(3));
            let mut cells = vec![9; base];
            for row in rows.clone() {
                cells.extend(columns.clone().map(|column| self.at(row, column)));
                cells.resize(cells.len() + between, 9);
            }
            Slab {
                cells: Arc::new(chance.stored(cells)),
                base,
                row: columns.len() + between,
            }
        }
    }

    /// The chunks of a plane, in any order.
    fn chunks(shape: [usize; 2], chance: &mut Chance) -> Vec<(Range<u32>, Range<u32>)> {
        let length = shape.map(|length| 1 + chance.of(length));
        let along = |axis: usize| {
            let starts = (0..shape[axis]).step_by(length[axis]);
            starts.map(move |from| from as u32..(from + length[axis]).min(shape[axis]) as u32)
        };
        let mut all: Vec<_> = along(0)
            .flat_map(|rows| along(1).map(move |columns| (rows.clone(), columns)))
            .collect();
        for last in (1..all.len()).rev() {
            all.swap(last, chance.of(last + 1));
        }
        all
    }

    /// Checks a pixel against all its cells: what it shows, and whether it hides different values.
    #[track_caller]
    fn check(canvas: &Canvas<u16>, field: &Field, slow: &Pixels, fast: &Pixels) -> usize {
        let mut several = 0;
        for down in 0..slow.len() {
            for across in 0..fast.len() {
                let place = down * fast.len() + across;
                let bits = canvas.bits[place];
                if !slow.on_axis.contains(&down) || !fast.on_axis.contains(&across) {
                    assert_eq!(bits, UNREAD);
                    continue;
                }
                let (row, column) = (slow.nearest[down], fast.nearest[across]);
                assert_eq!(canvas.values[place], field.at(row, column));
                let rows = slow.inside[down].clone();
                let mut hidden =
                    rows.flat_map(|y| fast.inside[across].clone().map(move |x| field.at(y, x)));
                let first = hidden.next();
                let expected = hidden.any(|value| Some(value) != first);
                assert_eq!(bits, if expected { SEVERAL } else { 0 }, "{down} {across}");
                several += usize::from(expected);
            }
        }
        several
    }

    #[test]
    fn pixels_show_the_nearest_cell_and_say_what_they_hide_however_chunks_come() {
        let mut chance = Chance(0x5eed);
        let mut several = 0;
        for _ in 0..3000 {
            let ((height, slow), (width, fast)) = (chance.axis(12), chance.axis(25));
            let mut value = 0;
            let cells = (0..height * width).map(|_| {
                if chance.of(6) == 0 {
                    value = chance.of(3) as u16;
                }
                value
            });
            let cells = cells.collect();
            let field = Field { width, cells };
            let mut canvas = Canvas::new(slow.len() * fast.len());
            for cells in chunks([height, width], &mut chance) {
                let slab = field.slab(&cells, &mut chance);
                let under = Under {
                    slow: &slow,
                    fast: &fast,
                    cells,
                };
                canvas.paint(&slab, &under, true);
            }
            several += check(&canvas, &field, &slow, &fast);
        }
        assert!(several > 1000, "{several}");
    }
}
