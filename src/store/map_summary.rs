//! What values a map holds, all cells of it, read piece by piece.

use hdf5::{Dataset, SliceOrIndex};

use super::error::StoreError;
use super::map_file::MapFile;
use super::schema::STATUS;
use crate::linear::status::FLAGS;
use crate::sweep::Field;
use crate::sweep::engine::STATUS_FILL;

/// What values a field has in a map.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FieldSummary {
    /// The smallest and largest finite value; none where there is none.
    pub range: Option<(f64, f64)>,
    /// Number of infinite values.
    pub infinite: u64,
    /// Number of cells without a value.
    pub missing: u64,
}

/// What the statuses of cells say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StatusCounts {
    /// Cells that are computed.
    pub computed: u64,
    /// Cells without any flag.
    pub unflagged: u64,
    /// Cells with each flag, in the order of [`FLAGS`].
    pub flagged: [u64; FLAGS.len()],
}

impl StatusCounts {
    /// Adds the statuses of more cells.
    pub fn add(&mut self, cells: impl IntoIterator<Item = u8>) {
        for status in cells {
            if status == STATUS_FILL {
                continue;
            }
            self.computed += 1;
            self.unflagged += u64::from(status == 0);
            for (count, (mask, _)) in self.flagged.iter_mut().zip(FLAGS) {
                *count += u64::from(status & mask != 0);
            }
        }
    }
}

impl FieldSummary {
    /// Takes in more cells.
    pub fn add(&mut self, cells: &[f64]) {
        for &value in cells {
            if value.is_finite() {
                let (low, high) = self.range.unwrap_or((value, value));
                self.range = Some((low.min(value), high.max(value)));
            } else if value.is_nan() {
                self.missing += 1;
            } else {
                self.infinite += 1;
            }
        }
    }
}

impl MapFile {
    /// What values a field has, read piece by piece.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn summary(&self, field: Field) -> Result<FieldSummary, StoreError> {
        let dataset = self.of_field(field)?;
        let mut summary = FieldSummary::default();
        for_each_chunk(&dataset, |slab| {
            summary.add(&self.read_field(field, &dataset, slab)?);
            Ok(())
        })?;
        Ok(summary)
    }

    /// Number of cells with each kind of a field that has kinds, in the order of [`Field::kinds`],
    /// read piece by piece. Empty for other fields.
    ///
    /// # Errors
    /// When the map does not hold the field, or is damaged.
    pub fn kind_counts(&self, field: Field) -> Result<Vec<u64>, StoreError> {
        let dataset = self.of_field(field)?;
        let mut counts = vec![0; field.kinds().map_or(0, |kinds| kinds.len())];
        if counts.is_empty() {
            return Ok(counts);
        }
        for_each_chunk(&dataset, |slab| {
            for kind in self.read::<u8>(&dataset, slab)? {
                if let Some(count) = counts.get_mut(usize::from(kind)) {
                    *count += 1;
                }
            }
            Ok(())
        })?;
        Ok(counts)
    }

    /// What the statuses of all cells say, read piece by piece.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn status_counts(&self) -> Result<StatusCounts, StoreError> {
        let dataset = self.dataset(STATUS)?;
        let mut counts = StatusCounts::default();
        for_each_chunk(&dataset, |slab| {
            counts.add(self.read::<u8>(&dataset, slab)?);
            Ok(())
        })?;
        Ok(counts)
    }
}

/// Cells that are read at once, at most.
const MOST_AT_ONCE: usize = 1 << 22;

/// The shape of the pieces in which to read a dataset: its chunks, or parts of them where they are
/// huge.
fn piece_shape(dataset: &Dataset) -> Vec<usize> {
    let shape = dataset.shape();
    let chunk = dataset.chunk().filter(|c| c.len() == shape.len());
    let mut piece = chunk.unwrap_or_else(|| shape.clone());
    for (length, &whole) in piece.iter_mut().zip(&shape) {
        *length = (*length).clamp(1, whole.max(1));
    }
    for axis in 0..piece.len() {
        // The lengths behind are no longer than those of the map, whose cells can be counted.
        let behind: usize = piece[axis + 1..].iter().product();
        piece[axis] = piece[axis].min((MOST_AT_ONCE / behind).max(1));
    }
    piece
}

/// Every piece of a dataset as a hyperslab, cut at the dataset's edges.
pub(super) fn for_each_chunk<E>(
    dataset: &Dataset,
    mut visit: impl FnMut(&[SliceOrIndex]) -> Result<(), E>,
) -> Result<(), E> {
    let shape = dataset.shape();
    let chunk = piece_shape(dataset);
    let mut offset = vec![0; shape.len()];
    loop {
        let slab: Vec<_> = offset
            .iter()
            .zip(&chunk)
            .zip(&shape)
            .map(|((&start, &length), &end)| SliceOrIndex::SliceTo {
                start,
                step: 1,
                end: (start + length).min(end),
                block: 1,
            })
            .collect();
        visit(&slab)?;
        let mut axis = shape.len();
        loop {
            if axis == 0 {
                return Ok(());
            }
            axis -= 1;
            offset[axis] += chunk[axis];
            if offset[axis] < shape[axis] {
                break;
            }
            offset[axis] = 0;
        }
    }
}
