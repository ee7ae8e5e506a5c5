//! Reads the cells of a map in the order of its axes, block by block.

use hdf5::SliceOrIndex;

use super::error::StoreError;
use super::map_file::MapFile;
use super::map_summary::for_each_piece;
use crate::setting::Field;
use crate::sweep::described::schema::STATUS;

/// Approximate bytes of numbers in memory at once.
const MOST_BYTES: usize = 32 << 20;

/// Neighbouring cells of a map, row by row, last axis fastest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CellBlock {
    /// Index of the first cell along each axis.
    pub first: Vec<usize>,
    /// Number of cells along each axis.
    pub extent: Vec<usize>,
    /// Values of each field that was asked for; NaN where a cell has none.
    pub fields: Vec<Vec<f64>>,
    /// The statuses, [`STATUS_FILL`](crate::sweep::engine::STATUS_FILL) where a cell is not
    /// computed.
    pub status: Vec<u8>,
}

impl MapFile {
    /// Passes the cells to `visit` block by block, the last axis fastest. `held` has one entry per
    /// axis: an axis with an index there is read at that index alone.
    ///
    /// # Errors
    /// When the map lacks one of the fields or is damaged. Errors of `visit` are passed on.
    pub(crate) fn for_each_block<E: From<StoreError>>(
        &self,
        fields: &[Field],
        held: &[Option<usize>],
        mut visit: impl FnMut(&CellBlock) -> Result<(), E>,
    ) -> Result<(), E> {
        let status = self.dataset(STATUS)?;
        let mut datasets = Vec::new();
        for &field in fields {
            datasets.push((field, self.of_field(field)?));
        }
        let free = self.axes().iter().zip(held);
        let shape: Vec<usize> = free
            .map(|(axis, held)| held.map_or(axis.values.len(), |_| 1))
            .collect();
        let chunk = status.chunk().filter(|chunk| chunk.len() == shape.len());
        let most = MOST_BYTES / (size_of::<f64>() * (fields.len() + 1));
        let block = block_shape(&shape, chunk.as_deref(), most);
        for_each_piece(&shape, &block, |offset, extent| {
            let first: Vec<usize> = offset
                .iter()
                .zip(held)
                .map(|(&start, held)| held.unwrap_or(start))
                .collect();
            let slab: Vec<SliceOrIndex> = first
                .iter()
                .zip(extent)
                .map(|(&start, &count)| SliceOrIndex::SliceCount {
                    start,
                    step: 1,
                    count,
                    block: 1,
                })
                .collect();
            let values = datasets
                .iter()
                .map(|(field, dataset)| self.read_field(*field, dataset, &slab));
            visit(&CellBlock {
                fields: values.collect::<Result<_, _>>()?,
                status: self.read(&status, &slab)?,
                first,
                extent: extent.to_vec(),
            })
        })
    }
}

/// The shape of blocks of about `most` cells: the last axes whole, part of the axis before them,
/// and one cell along the others. That part is a whole number of chunks where at least one fits, so
/// that each chunk is read once.
fn block_shape(shape: &[usize], chunk: Option<&[usize]>, most: usize) -> Vec<usize> {
    let mut block = vec![1; shape.len()];
    let mut behind = 1;
    for axis in (0..shape.len()).rev() {
        let room = (most / behind).max(1);
        if shape[axis] <= room {
            block[axis] = shape[axis];
            behind *= shape[axis];
            continue;
        }
        let of_chunk = chunk.map_or(1, |chunk| chunk[axis]).max(1);
        block[axis] = match room / of_chunk {
            0 => room,
            chunks => chunks * of_chunk,
        };
        break;
    }
    block
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_whole_rows_and_chunks() {
        for (shape, chunk, most, expected) in [
            (&[7, 5, 3][..], None, 1000, &[7, 5, 3][..]),
            (&[7, 5, 3], None, 32, &[2, 5, 3]),
            (&[7, 5, 3], Some(&[3, 5, 3][..]), 64, &[3, 5, 3]),
            (&[7, 5, 3], Some(&[3, 5, 3]), 32, &[2, 5, 3]),
            (&[7, 5, 3], None, 10, &[1, 3, 3]),
            (&[7, 5, 3], None, 2, &[1, 1, 2]),
            (&[7, 5, 3], None, 0, &[1, 1, 1]),
            (&[1, 1, 3], None, 3, &[1, 1, 3]),
        ] {
            assert_eq!(
                block_shape(shape, chunk, most),
                expected,
                "{shape:?} {most}"
            );
        }
    }
}
