//! Reads cells: planes, stored chunks, single cells.

use hdf5::{Dataset, SliceOrIndex};

use super::MapFile;
use crate::setting::Field;
use crate::setting::field::Storage;
use crate::store::error::StoreError;
use crate::store::values::{Chunks, Number, read};
use crate::sweep::described::schema::STATUS;
use crate::sweep::engine::{FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL};

/// A rectangle of cells of one field, as numbers: NaN where a cell has no value.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Values of the row axis at the rows that were read.
    pub rows: Vec<f64>,
    /// Values of the column axis at the columns that were read.
    pub columns: Vec<f64>,
    /// Cells, row by row.
    pub cells: Vec<f64>,
}

impl MapFile {
    /// The plane of `field` spanned by the axes `row_axis` and `column_axis`, at `index` along the
    /// others. It is thinned evenly to at most `most` cells each way. If both axes are the same,
    /// the plane is the line along that axis, as one row.
    ///
    /// # Errors
    /// When the file is damaged there.
    pub fn plane(
        &self,
        field: Field,
        index: &[usize],
        (row_axis, column_axis): (usize, usize),
        most: usize,
    ) -> Result<Plane, StoreError> {
        let slab = self.plane_slab(index, (row_axis, column_axis), most);
        let thinned = |axis: usize| {
            let values = &self.axes[axis].values;
            values
                .iter()
                .copied()
                .step_by(self.step(axis, most))
                .collect::<Vec<_>>()
        };
        let columns = thinned(column_axis);
        let rows = match row_axis == column_axis {
            true => self.axes[row_axis].values[..1].to_vec(),
            false => thinned(row_axis),
        };
        let dataset = self.of_field(field)?;
        let cells = self.read_field(field, &dataset, &slab)?;
        let cells = if row_axis > column_axis {
            transposed(&cells, columns.len(), rows.len())
        } else {
            cells
        };
        Ok(Plane {
            rows,
            columns,
            cells,
        })
    }

    /// The statuses of the cells that [`MapFile::plane`] gives.
    ///
    /// # Errors
    /// When the file is damaged there.
    pub fn status_plane(
        &self,
        index: &[usize],
        (row_axis, column_axis): (usize, usize),
        most: usize,
    ) -> Result<Vec<u8>, StoreError> {
        let slab = self.plane_slab(index, (row_axis, column_axis), most);
        let cells = self.read::<u8>(&self.dataset(STATUS)?, &slab)?;
        let count = |axis: usize| self.axes[axis].values.len().div_ceil(self.step(axis, most));
        Ok(match row_axis > column_axis {
            true => transposed(&cells, count(column_axis), count(row_axis)),
            false => cells,
        })
    }

    /// The step along an axis with which at most `most` cells are read.
    fn step(&self, axis: usize, most: usize) -> usize {
        self.axes[axis].values.len().div_ceil(most).max(1)
    }

    fn plane_slab(
        &self,
        index: &[usize],
        (row_axis, column_axis): (usize, usize),
        most: usize,
    ) -> Vec<SliceOrIndex> {
        let along = |axis: usize| {
            if axis != row_axis && axis != column_axis {
                return SliceOrIndex::Index(index[axis]);
            }
            let step = self.step(axis, most);
            SliceOrIndex::SliceCount {
                start: 0,
                step,
                count: self.axes[axis].values.len().div_ceil(step),
                block: 1,
            }
        };
        (0..self.axes.len()).map(along).collect()
    }

    /// The bytes of the chunk of a dataset whose first cell is at `offset`, as stored in the file;
    /// none where there is no such chunk.
    pub(crate) fn stored_chunk(
        &self,
        name: &str,
        offset: &[usize],
    ) -> Result<Option<Vec<u8>>, StoreError> {
        let dataset = self.dataset(name)?;
        let read = || -> hdf5::Result<Option<Vec<u8>>> {
            let chunks = Chunks::of(&dataset)?.ok_or("it is not stored in chunks")?;
            chunks.stored(offset)
        };
        read().map_err(StoreError::hdf5("read", self.path()))
    }

    /// One cell of a field as a number: NaN where it has no value.
    pub(crate) fn cell(&self, field: Field, index: &[usize]) -> Result<f64, StoreError> {
        let cells = self.read_field(field, &self.of_field(field)?, &at(index))?;
        Ok(cells.first().copied().unwrap_or(f64::NAN))
    }

    /// The status of one cell.
    pub(crate) fn cell_status(&self, index: &[usize]) -> Result<u8, StoreError> {
        let cells = self.read::<u8>(&self.dataset(STATUS)?, &at(index))?;
        Ok(cells.first().copied().unwrap_or(STATUS_FILL))
    }

    /// Cells of a field as numbers: fill values are NaN.
    pub(in crate::store) fn read_field(
        &self,
        field: Field,
        dataset: &Dataset,
        slab: &[SliceOrIndex],
    ) -> Result<Vec<f64>, StoreError> {
        match field.storage() {
            Storage::Real => self.read(dataset, slab),
            Storage::Count => Ok(numbers(self.read::<u16>(dataset, slab)?, N_UNSTABLE_FILL)),
            Storage::Kind | Storage::Few => Ok(numbers(self.read::<u8>(dataset, slab)?, FEW_FILL)),
        }
    }

    pub(in crate::store) fn read<T: Number>(
        &self,
        dataset: &Dataset,
        slab: &[SliceOrIndex],
    ) -> Result<Vec<T>, StoreError> {
        read(dataset, slab).map_err(StoreError::hdf5("read", &self.path))
    }
}

fn at(index: &[usize]) -> Vec<SliceOrIndex> {
    index.iter().map(|&i| SliceOrIndex::Index(i)).collect()
}

/// Whole numbers as reals, NaN for `fill`.
fn numbers<T: Copy + PartialEq + Into<f64>>(cells: Vec<T>, fill: T) -> Vec<f64> {
    let number = |n: T| if n == fill { f64::NAN } else { n.into() };
    cells.into_iter().map(number).collect()
}

fn transposed<T: Copy>(cells: &[T], rows: usize, columns: usize) -> Vec<T> {
    (0..columns)
        .flat_map(|c| (0..rows).map(move |r| cells[r * columns + c]))
        .collect()
}
