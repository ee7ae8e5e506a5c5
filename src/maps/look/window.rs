//! A window on a map: the request and the answer.

use super::pixels::Stretch;
use crate::setting::Field;

/// A window on a map.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Asked {
    /// The field to show.
    pub field: Field,
    /// The axis from left to right.
    pub x: usize,
    /// The axis from bottom to top; none for a line along `x`.
    pub y: Option<usize>,
    /// The index along every axis; the entries of `x` and `y` are not used.
    pub at: Vec<usize>,
    /// The pixels along `x`.
    pub across: Stretch,
    /// The pixels along `y`.
    pub up: Stretch,
}

/// Pixels along an axis: the index of the cell that each shows, and its value there.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Shown {
    /// Indices.
    pub index: Vec<u32>,
    /// Values.
    pub values: Vec<f64>,
}

/// Whether each number is another one than that before it.
pub(crate) fn changes(numbers: &[u32]) -> impl Iterator<Item = bool> {
    (0..numbers.len()).map(|i| i == 0 || numbers[i] != numbers[i - 1])
}

/// Columns of pixels: neighbours are alike where cells are wider than pixels.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Columns {
    /// For every column of pixels, which of the columns that differ it is: 0, 1, 2, …
    pub which: Vec<u32>,
    /// Pixels of one.
    pub height: usize,
}

impl Columns {
    /// The first column of each kind.
    pub(crate) fn firsts(&self) -> impl Iterator<Item = usize> {
        let columns = changes(&self.which).enumerate();
        columns.filter_map(|(column, is_first)| is_first.then_some(column))
    }

    /// All pixels, from those of the columns that differ.
    pub(crate) fn all<T: Copy>(&self, differing: &[T]) -> Vec<T> {
        let mut all = Vec::with_capacity(self.which.len() * self.height);
        for &which in &self.which {
            let begun = which as usize * self.height;
            all.extend_from_slice(&differing[begun..begun + self.height]);
        }
        all
    }
}

/// The numbers of a field, pixel by pixel.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Numbers {
    /// Kinds and small counts.
    U8(Vec<u8>),
    /// Counts.
    U16(Vec<u16>),
    /// Reals.
    F64(Vec<f64>),
}

/// The contents of a window, as far as they are read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Shot {
    /// Whether everything is read.
    pub complete: bool,
    /// The share that is read, 0 to 1.
    pub progress: f64,
    /// Changes when cells are added.
    pub version: u64,
    /// Along x.
    pub x: Shown,
    /// Along y.
    pub y: Option<Shown>,
    /// Which columns of pixels are alike. What follows is of those that differ.
    pub columns: Columns,
    /// The cells nearest to the pixels, those of the first x first; fill values where there is
    /// none.
    pub values: Numbers,
    /// Their status.
    pub status: Vec<u8>,
    /// [`SEVERAL`](super::SEVERAL), [`UNREAD`](super::UNREAD),
    /// [`NOT_COMPUTED`](super::NOT_COMPUTED), [`BEYOND`](super::BEYOND).
    pub bits: Vec<u8>,
    /// Why some cells could not be read, if so.
    pub damage: Option<String>,
}
