//! Summaries of a map's values: from its attributes, or from all cells, read piece by piece.

use hdf5::{Dataset, SliceOrIndex};

use super::error::StoreError;
use super::map_file::MapFile;
use super::values::Number;
use crate::setting::Field;
use crate::setting::field::Storage;
use crate::sweep::described::schema::STATUS;
use crate::sweep::described::summary::{FieldSummary, StatusCounts};

impl MapFile {
    /// The summary of a field's values: from the map's attributes, or from all cells where it has
    /// none.
    ///
    /// # Errors
    /// When the map lacks the field or is damaged.
    pub fn summary(&self, field: Field) -> Result<FieldSummary, StoreError> {
        match FieldSummary::told(&self.of_field(field)?, field.storage(), self.cells()) {
            Some(told) => Ok(told),
            None => self.summary_of_cells(field),
        }
    }

    /// The counts of the statuses of all cells, from the attributes or from all cells.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn status_counts(&self) -> Result<StatusCounts, StoreError> {
        match StatusCounts::told(&self.dataset(STATUS)?, self.cells()) {
            Some(told) => Ok(told),
            None => self.statuses_of_cells(),
        }
    }

    /// The summary of a field's values in all cells, read piece by piece.
    pub(crate) fn summary_of_cells(&self, field: Field) -> Result<FieldSummary, StoreError> {
        let dataset = self.of_field(field)?;
        match field.storage() {
            Storage::Count => self.added_up(&dataset, FieldSummary::of_roots),
            Storage::Real => self.added_up(&dataset, FieldSummary::of_reals),
            Storage::Kind | Storage::Few => {
                self.added_up(&dataset, |cells| FieldSummary::of_bytes(field, cells))
            }
        }
    }

    fn added_up<T: Number>(
        &self,
        dataset: &Dataset,
        of: impl Fn(&[T]) -> FieldSummary,
    ) -> Result<FieldSummary, StoreError> {
        let mut sum = FieldSummary::default();
        for_each_chunk(dataset, |slab| {
            sum.add(&of(&self.read(dataset, slab)?));
            Ok(())
        })?;
        Ok(sum)
    }

    /// The counts of the statuses of all cells, read piece by piece.
    pub(crate) fn statuses_of_cells(&self) -> Result<StatusCounts, StoreError> {
        let dataset = self.dataset(STATUS)?;
        let mut counts = StatusCounts::default();
        for_each_chunk(&dataset, |slab| {
            counts.add(&StatusCounts::of(&self.read(&dataset, slab)?));
            Ok(())
        })?;
        Ok(counts)
    }
}

/// The most cells read at once.
const MOST_AT_ONCE: usize = 1 << 22;

/// The shape of the pieces in which a dataset is read: its chunks, or parts of huge ones.
fn piece_shape(dataset: &Dataset) -> Vec<usize> {
    let shape = dataset.shape();
    let chunk = dataset.chunk().filter(|c| c.len() == shape.len());
    let mut piece = chunk.unwrap_or_else(|| shape.clone());
    for (length, &whole) in piece.iter_mut().zip(&shape) {
        *length = (*length).clamp(1, whole.max(1));
    }
    for axis in 0..piece.len() {
        // This product does not overflow: it is at most the number of cells of the map.
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
    for_each_piece(&shape, &piece_shape(dataset), |offset, extent| {
        let slab: Vec<_> = offset
            .iter()
            .zip(extent)
            .map(|(&start, &length)| SliceOrIndex::SliceTo {
                start,
                step: 1,
                end: start + length,
                block: 1,
            })
            .collect();
        visit(&slab)
    })
}

/// Visits the pieces of a box with the lengths `shape`, last axis fastest. `visit` gets the first
/// index and the number of cells inside the box, along every axis.
pub(super) fn for_each_piece<E>(
    shape: &[usize],
    piece: &[usize],
    mut visit: impl FnMut(&[usize], &[usize]) -> Result<(), E>,
) -> Result<(), E> {
    let mut offset = vec![0; shape.len()];
    loop {
        let extent: Vec<usize> = offset
            .iter()
            .zip(piece)
            .zip(shape)
            .map(|((&start, &length), &end)| length.min(end - start))
            .collect();
        visit(&offset, &extent)?;
        let mut axis = shape.len();
        loop {
            if axis == 0 {
                return Ok(());
            }
            axis -= 1;
            offset[axis] += piece[axis];
            if offset[axis] < shape[axis] {
                break;
            }
            offset[axis] = 0;
        }
    }
}
