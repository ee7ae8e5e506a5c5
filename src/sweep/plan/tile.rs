//! Tiles: rectangular blocks of cells.

/// How a map is cut into tiles of equal shape. Tiles at the far edges extend beyond the map.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TileGrid {
    shape: Vec<usize>,
    tile_shape: Vec<usize>,
}

/// One tile: the cells from `offset` on, `extent` of them along each axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tile {
    /// First index along each axis.
    pub offset: Vec<usize>,
    /// Number of cells along each axis that lie inside the map.
    pub extent: Vec<usize>,
}

impl Tile {
    /// Number of cells inside the map.
    #[must_use]
    pub fn cells(&self) -> u64 {
        self.extent.iter().map(|&n| n as u64).product()
    }
}

impl TileGrid {
    pub(super) fn new(shape: Vec<usize>, tile_shape: Vec<usize>) -> Self {
        Self { shape, tile_shape }
    }

    /// Length of each axis of the map.
    #[must_use]
    pub(crate) fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Cells of a full tile along each axis.
    #[must_use]
    pub fn tile_shape(&self) -> &[usize] {
        &self.tile_shape
    }

    /// Cells of a full tile.
    #[must_use]
    pub fn tile_cells(&self) -> usize {
        self.tile_shape.iter().product()
    }

    /// Number of tiles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.tiles_along().product()
    }

    /// Always false: a map has at least one cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn tiles_along(&self) -> impl DoubleEndedIterator<Item = usize> {
        self.shape
            .iter()
            .zip(&self.tile_shape)
            .map(|(&n, &t)| n.div_ceil(t))
    }

    /// The tile with number `number`, counted row by row, last axis fastest.
    #[must_use]
    pub fn tile(&self, number: usize) -> Tile {
        let along: Vec<usize> = self.tiles_along().collect();
        let mut offset = index_of(number as u64, &along);
        for (offset, &length) in offset.iter_mut().zip(&self.tile_shape) {
            *offset *= length;
        }
        let extent = offset
            .iter()
            .zip(&self.shape)
            .zip(&self.tile_shape)
            .map(|((&o, &n), &t)| t.min(n - o))
            .collect();
        Tile { offset, extent }
    }

    /// Number of cells inside the map of the tile with number `number`.
    #[must_use]
    pub(super) fn cells_of(&self, number: u64) -> u64 {
        let (mut cells, mut rest) = (1, number);
        for (&n, &t) in self.shape.iter().zip(&self.tile_shape).rev() {
            let along = n.div_ceil(t) as u64;
            let first = (rest % along) as usize * t;
            cells *= t.min(n - first) as u64;
            rest /= along;
        }
        cells
    }

    /// The number of the tile that holds a cell.
    #[must_use]
    pub(crate) fn holding(&self, index: &[usize]) -> u64 {
        let along: Vec<usize> = self.tiles_along().collect();
        let of_tile = index.iter().zip(&self.tile_shape).map(|(i, t)| i / t);
        let strides = strides_of(&along).into_iter();
        of_tile
            .zip(strides)
            .map(|(i, stride)| i as u64 * stride)
            .sum()
    }

    /// Distance between neighbouring cells along each axis in a tile's memory, which has the full
    /// tile shape, last axis fastest.
    #[must_use]
    pub fn strides(&self) -> Vec<usize> {
        memory_strides(&self.tile_shape)
    }
}

/// Distance between neighbouring cells along each axis of a box, last axis fastest.
pub(crate) fn strides_of(shape: &[usize]) -> Vec<u64> {
    let mut strides = vec![1; shape.len()];
    for axis in (1..shape.len()).rev() {
        strides[axis - 1] = strides[axis] * shape[axis] as u64;
    }
    strides
}

/// Distance between neighbouring cells along each axis of a box in memory, last axis fastest.
pub(crate) fn memory_strides(shape: &[usize]) -> Vec<usize> {
    let strides = strides_of(shape).into_iter();
    strides.map(|stride| stride as usize).collect()
}

/// The place in memory of the cell at an index.
#[inline]
pub(crate) fn place_of(index: &[usize], strides: &[usize]) -> usize {
    index.iter().zip(strides).map(|(i, s)| i * s).sum()
}

/// The index of the cell with number `number` in a box of shape `shape`, last axis fastest.
pub(crate) fn index_of(number: u64, shape: &[usize]) -> Vec<usize> {
    let (mut index, mut rest) = (vec![0; shape.len()], number);
    for (place, &length) in index.iter_mut().zip(shape).rev() {
        *place = (rest % length as u64) as usize;
        rest /= length as u64;
    }
    index
}

/// Every index of a box, last axis fastest; `skip` names an axis that stays at 0.
pub(crate) fn for_each_index(extent: &[usize], skip: Option<usize>, visit: impl FnMut(&[usize])) {
    for_each_index_along(extent, skip, None, visit);
}

/// Every index of a box, first along the axis `fastest`, then the last axis fastest; `skip` names
/// an axis that stays at 0.
pub(crate) fn for_each_index_along(
    extent: &[usize],
    skip: Option<usize>,
    fastest: Option<usize>,
    mut visit: impl FnMut(&[usize]),
) {
    let others = (0..extent.len()).rev().filter(|&a| Some(a) != fastest);
    let axes = fastest.into_iter().chain(others);
    let axes: Vec<usize> = axes.filter(|&a| Some(a) != skip).collect();
    let mut index = vec![0; extent.len()];
    loop {
        visit(&index);
        let next = axes.iter().find(|&&axis| {
            index[axis] = (index[axis] + 1) % extent[axis];
            index[axis] > 0
        });
        if next.is_none() {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_cell_once() {
        let grid = TileGrid::new(vec![5, 7, 4], vec![2, 3, 4]);
        let mut seen = vec![0; 5 * 7 * 4];
        for number in 0..grid.len() {
            let tile = grid.tile(number);
            assert_eq!(grid.cells_of(number as u64), tile.cells());
            assert_eq!(grid.holding(&tile.offset), number as u64);
            for_each_index(&tile.extent, None, |i| {
                let cell = ((tile.offset[0] + i[0]) * 7 + tile.offset[1] + i[1]) * 4
                    + tile.offset[2]
                    + i[2];
                seen[cell] += 1;
            });
        }
        assert!(seen.iter().all(|&n| n == 1));
        assert_eq!(grid.strides(), [12, 4, 1]);
    }

    #[test]
    fn a_skipped_axis_stays_at_zero() {
        let mut visited = Vec::new();
        for_each_index(&[2, 9, 2], Some(1), |i| visited.push(i.to_vec()));
        assert_eq!(visited, [[0, 0, 0], [0, 0, 1], [1, 0, 0], [1, 0, 1]]);
        visited.clear();
        for_each_index_along(&[2, 9, 2], Some(1), Some(0), |i| visited.push(i.to_vec()));
        assert_eq!(visited, [[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]]);
    }
}
