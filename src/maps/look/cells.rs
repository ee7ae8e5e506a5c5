//! Cells in memory: as runs of equal cells where that is shorter, else one by one.

use std::sync::Arc;

/// A cell of a column, compared by its bits.
pub(super) trait Cell: Copy + Eq + Default + Send + Sync + 'static {
    /// Bytes of a cell.
    const SIZE: usize;
    /// A cell from its bytes, [`Self::SIZE`] of them.
    fn of(bytes: &[u8]) -> Self;
    /// The cells in the common type.
    fn wrapped(cells: Arc<Cells<Self>>) -> AnyCells;
    /// The cells in this type; none where they have another one.
    fn unwrapped(cells: &AnyCells) -> Option<&Arc<Cells<Self>>>;
}

/// Cells of any column.
#[derive(Debug, Clone)]
pub(super) enum AnyCells {
    U8(Arc<Cells<u8>>),
    U16(Arc<Cells<u16>>),
    U64(Arc<Cells<u64>>),
}

impl AnyCells {
    /// Bytes in memory.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::U8(cells) => cells.bytes(),
            Self::U16(cells) => cells.bytes(),
            Self::U64(cells) => cells.bytes(),
        }
    }
}

macro_rules! cell {
    ($kind:ty, $name:ident) => {
        impl Cell for $kind {
            const SIZE: usize = size_of::<$kind>();
            fn of(bytes: &[u8]) -> Self {
                bytes.try_into().map_or(0, <$kind>::from_le_bytes)
            }
            fn wrapped(cells: Arc<Cells<Self>>) -> AnyCells {
                AnyCells::$name(cells)
            }
            fn unwrapped(cells: &AnyCells) -> Option<&Arc<Cells<Self>>> {
                match cells {
                    AnyCells::$name(cells) => Some(cells),
                    _ => None,
                }
            }
        }
    };
}
cell!(u8, U8);
cell!(u16, U16);
cell!(u64, U64);

/// Cells in a row.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Cells<T> {
    /// The end of each run of equal cells, and its value.
    Runs { ends: Vec<u32>, values: Vec<T> },
    /// One by one.
    Each(Vec<T>),
}

impl<T: Cell> Cells<T> {
    /// Stores cells as runs if these take at most one `share`th of the memory, else one by one.
    pub(super) fn of(cells: Vec<T>, share: usize) -> Self {
        let most = cells.len() * T::SIZE / (share * (T::SIZE + 4));
        let (mut ends, mut values) = (Vec::new(), Vec::new());
        let mut from = 0;
        for run in cells.chunk_by(|a, b| a == b) {
            if ends.len() >= most.max(1) {
                return Self::Each(cells);
            }
            from += run.len();
            ends.push(from as u32);
            values.push(run[0]);
        }
        ends.shrink_to_fit();
        values.shrink_to_fit();
        Self::Runs { ends, values }
    }

    /// `count` equal cells.
    pub(super) fn constant(value: T, count: usize) -> Self {
        Self::Runs {
            ends: vec![count as u32],
            values: vec![value],
        }
    }

    /// Whether some cell satisfies `is_so`.
    pub(super) fn any(&self, is_so: impl Fn(T) -> bool) -> bool {
        let (Self::Runs { values: all, .. } | Self::Each(all)) = self;
        all.iter().any(|&cell| is_so(cell))
    }

    /// The cells with `of` applied to each.
    pub(super) fn map(&self, of: impl Fn(T) -> T) -> Self {
        let (ends, values) = match self {
            Self::Each(cells) => return Self::Each(cells.iter().map(|&cell| of(cell)).collect()),
            Self::Runs { ends, values } => (ends, values),
        };
        let (mut new_ends, mut new_values): (Vec<u32>, Vec<T>) = (Vec::new(), Vec::new());
        for (&end, value) in ends.iter().zip(values.iter().map(|&value| of(value))) {
            match (new_ends.last_mut(), new_values.last()) {
                (Some(last), Some(before)) if *before == value => *last = end,
                _ => {
                    new_ends.push(end);
                    new_values.push(value);
                }
            }
        }
        Self::Runs {
            ends: new_ends,
            values: new_values,
        }
    }

    /// Whether all cells are known to be equal.
    pub(super) fn is_constant(&self) -> bool {
        matches!(self, Self::Runs { values, .. } if values.len() == 1)
    }

    /// Whether the cells are stored as runs.
    pub(super) fn is_runs(&self) -> bool {
        matches!(self, Self::Runs { .. })
    }

    /// A copy of cells stored as runs; none for others, which take more memory.
    pub(super) fn copied_runs(&self) -> Option<Self> {
        match self {
            Self::Runs { ends, values } => Some(Self::Runs {
                ends: ends.clone(),
                values: values.clone(),
            }),
            Self::Each(_) => None,
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Runs { ends, values } => size_of_val(&ends[..]) + size_of_val(&values[..]),
            Self::Each(cells) => size_of_val(&cells[..]),
        }
    }

    /// A reader of the cells.
    pub(super) fn reader(&self) -> Reader<'_, T> {
        Reader {
            cells: self,
            run: 0,
        }
    }
}

/// Reads cells, fastest in increasing order.
pub(super) struct Reader<'a, T> {
    cells: &'a Cells<T>,
    run: usize,
}

impl<'a, T: Cell> Reader<'a, T> {
    /// The cell at a place.
    pub(super) fn at(&mut self, place: usize) -> T {
        self.until(place).0
    }

    /// The cell at a place, and the end of its run; for cells stored one by one, the next place.
    pub(super) fn until(&mut self, place: usize) -> (T, usize) {
        match self.cells {
            Cells::Each(cells) => (cells[place], place + 1),
            Cells::Runs { ends, values } => {
                let here = |run: usize| {
                    let from = if run == 0 { 0 } else { ends[run - 1] as usize };
                    from <= place && place < ends[run] as usize
                };
                if !here(self.run) {
                    let next = self.run + 1;
                    self.run = match next < ends.len() && here(next) {
                        true => next,
                        false => ends.partition_point(|&end| end as usize <= place),
                    };
                }
                (values[self.run], ends[self.run] as usize)
            }
        }
    }

    /// The common value of all cells of a range, which is not empty; none where they differ.
    pub(super) fn only(&mut self, from: usize, to: usize) -> Option<T> {
        match self.cells {
            Cells::Each(cells) => {
                let cells = &cells[from..to];
                (cells[1..] == cells[..cells.len() - 1]).then_some(cells[0])
            }
            Cells::Runs { .. } => {
                let (value, end) = self.until(from);
                (end >= to).then_some(value)
            }
        }
    }

    /// The cells themselves, if they are stored one by one.
    pub(super) fn each(&self) -> Option<&'a [T]> {
        match self.cells {
            Cells::Each(cells) => Some(cells),
            Cells::Runs { .. } => None,
        }
    }
}

/// A rectangle of cells in rows.
#[derive(Debug, Clone)]
pub(super) struct Slab<T> {
    pub cells: Arc<Cells<T>>,
    /// The place of the first cell.
    pub base: usize,
    /// Distance between neighbouring rows.
    pub row: usize,
}

/// The position of a rectangle in a chunk.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    /// The place of its first cell.
    pub base: usize,
    /// Distances between neighbouring rows, and between neighbouring cells.
    pub strides: (usize, usize),
    /// Number of rows, and of cells in a row.
    pub extent: (usize, usize),
}

impl Cut {
    /// The cells of the rectangle, row by row.
    pub(super) fn of<T: Cell>(&self, cells: &Cells<T>) -> Vec<T> {
        let mut reader = cells.reader();
        let mut out = Vec::with_capacity(self.extent.0 * self.extent.1);
        for row in 0..self.extent.0 {
            let from = self.base + row * self.strides.0;
            out.extend((0..self.extent.1).map(|cell| reader.at(from + cell * self.strides.1)));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_the_cells_that_they_were() {
        let cells: Vec<u16> = (0..1000_u32).map(|i| (i / 97) as u16).collect();
        let runs = Cells::of(cells.clone(), 4);
        assert!(runs.is_runs() && runs.bytes() < 100);
        let mut reader = runs.reader();
        for place in (0..1000).chain((0..1000).rev().step_by(7)) {
            assert_eq!(reader.at(place), cells[place]);
        }
        assert_eq!(reader.only(97, 194), Some(1));
        assert_eq!(reader.only(96, 194), None);
        assert!(
            [&runs, &Cells::Each(cells.clone())]
                .iter()
                .all(|all| { all.any(|value| value == 10) && !all.any(|value| value == 11) })
        );
        let coarse = runs.map(|value| value / 4);
        assert!(coarse.bytes() < runs.bytes() / 3);
        let each = Cells::Each(cells.clone()).map(|value| value / 4);
        for (place, cell) in cells.iter().enumerate() {
            let expected = cell / 4;
            assert_eq!(
                [&coarse, &each].map(|of| of.reader().at(place)),
                [expected; 2]
            );
        }
        let cut = Cut {
            base: 5,
            strides: (10, 2),
            extent: (90, 40),
        };
        let rows = cut.of(&runs);
        assert_eq!(rows[41], cells[5 + 10 + 2]);
        let noisy: Vec<u64> = (0..100).map(|i| i * i).collect();
        let each = Cells::of(noisy.clone(), 4);
        assert!(!each.is_runs());
        assert_eq!(each.reader().at(7), 49);
        assert_eq!(each.reader().only(3, 4), Some(9));
        assert_eq!(each.reader().only(3, 5), None);
    }
}
