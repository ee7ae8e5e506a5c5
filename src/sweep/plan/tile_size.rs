//! The size of tiles, and where lines of delays may be cut.

use crate::setting::search::Protocol;
use crate::setting::source::Cost;
use crate::setting::spec::SweepSpec;

/// Cells in a tile, roughly: few enough for a processor's cache, enough to compress and write well.
const CELLS_PER_TILE: usize = 1 << 18;
/// Cells in a tile where roots are followed from cell to cell. Each cell costs thousands of times
/// as much. Tiles of about equal time keep all threads busy to the end and let a run stop quickly.
const CELLS_PER_ROOT_TILE: usize = 1 << 14;
/// Cells in a tile where motions are followed: about a millisecond per cell.
const CELLS_PER_MOTION_TILE: usize = 1 << 8;
/// Motions in a tile where each cell has many: about a second of work.
const MOTIONS_PER_TILE: usize = 1 << 11;
/// Cells in a tile where critical velocities are searched for: up to a second per cell.
const CELLS_PER_CRITICAL_TILE: usize = 1 << 6;
/// The most delays in a tile, so that memory stays bounded on the longest line.
const DELAYS_PER_TILE: usize = 1 << 17;
/// Lines of delays are cut only at multiples of this. Tracking restarts there, so that no value
/// depends on the tiles.
pub const BLOCK_OF_DELAYS: usize = crate::linear::track::BLOCK;
/// Delays at a multiple of which critical velocities do not start from their neighbours; a divisor
/// of the block of roots.
const BLOCK_OF_VC: usize = crate::critical::along_delay::BLOCK;
const _: () = assert!(BLOCK_OF_DELAYS.is_multiple_of(BLOCK_OF_VC));
/// Cells in a tile, roughly. Tiles take about the same time, whatever is computed.
pub(super) fn cells_per_tile(spec: &SweepSpec) -> usize {
    match spec.cost() {
        Cost::Counted => CELLS_PER_TILE,
        Cost::Rooted | Cost::Searched => CELLS_PER_ROOT_TILE,
        Cost::Proved | Cost::Followed => CELLS_PER_MOTION_TILE,
        Cost::FollowedOften => (MOTIONS_PER_TILE / spec.motions_per_cell() as usize).max(1),
        Cost::Critical => CELLS_PER_CRITICAL_TILE,
    }
}

/// The number of delays at whose multiples lines are cut. Computations that start from the previous
/// delay do so only within a block. Motions, and control switched on in stick-slip, do not depend
/// on the previous delay.
pub(super) fn block(spec: &SweepSpec) -> usize {
    let rooted = spec.fields.iter().any(|f| f.roots_needed() > 0);
    match spec.critical.map(|search| search.protocol) {
        _ if rooted => BLOCK_OF_DELAYS,
        Some(Protocol::Follow) => BLOCK_OF_VC,
        Some(Protocol::SwitchOn(_)) => 1,
        None if spec.cost() > Cost::Rooted => 1,
        None => BLOCK_OF_DELAYS,
    }
}

/// The shape of tiles: whole lines where they fit, else whole blocks of `block` delays; then as
/// many neighbouring lines as fit into `cells`.
pub(super) fn tile_shape(
    shape: &[usize],
    tau_axis: Option<usize>,
    block: usize,
    cells: usize,
) -> Vec<usize> {
    let mut tile = vec![1; shape.len()];
    let mut room = cells;
    if let Some(axis) = tau_axis {
        let blocks = (cells.min(DELAYS_PER_TILE) / block).max(1);
        let delays = part(shape[axis].div_ceil(block), blocks) * block;
        tile[axis] = delays.min(shape[axis]);
        room /= tile[axis];
    }
    for axis in (0..shape.len()).rev().filter(|&a| Some(a) != tau_axis) {
        tile[axis] = part(shape[axis], room);
        room /= tile[axis];
    }
    tile
}

/// The shape of tiles in which as many cells along `axis` as fit into [`CELLS_PER_TILE`] are
/// together: lines that differ along it alone share what takes longest in them. Otherwise it is as
/// if that axis had one cell.
pub(super) fn shared_along(
    axis: usize,
    shape: &[usize],
    tau_axis: Option<usize>,
    block: usize,
    cells: usize,
) -> Vec<usize> {
    let mut one = shape.to_vec();
    one[axis] = 1;
    let mut tile = tile_shape(&one, tau_axis, block, cells);
    let rest: usize = tile.iter().product();
    tile[axis] = part(shape[axis], CELLS_PER_TILE / rest);
    tile
}

/// The shape of the parts of tiles of shape `tile` in which a sample of cells is timed: tiles, or,
/// where cells take long, lines of delays, or single cells with those that share their work.
pub(super) fn timed_part(
    cost: Cost,
    tile: &[usize],
    [tau, shared]: [Option<usize>; 2],
) -> Vec<usize> {
    let is_whole = |axis: usize| match cost {
        Cost::Counted | Cost::Rooted => true,
        Cost::Searched => [tau, shared].contains(&Some(axis)),
        _ => shared == Some(axis),
    };
    let along = tile.iter().enumerate();
    along
        .map(|(axis, &n)| if is_whole(axis) { n } else { 1 })
        .collect()
}

/// The size of roughly equal parts of `length`, each at most `most` (or 1).
fn part(length: usize, most: usize) -> usize {
    length.div_ceil(length.div_ceil(most.max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// However long the axes and small the tiles, lines are cut only between blocks, and tiles
        /// stay within their size.
        #[test]
        fn delays_are_cut_between_blocks(
            delays in prop_oneof![1_usize..10_000, 1_usize..10_000_000],
            lines in 1_usize..3000,
            place in 0_usize..3,
            cells in prop_oneof![1_usize..100_000, Just(CELLS_PER_TILE), Just(CELLS_PER_ROOT_TILE)],
        ) {
            let mut shape = vec![lines, 7];
            shape.insert(place, delays);
            let tile = tile_shape(&shape, Some(place), BLOCK_OF_DELAYS, cells);
            prop_assert!(tile[place] == delays || tile[place].is_multiple_of(BLOCK_OF_DELAYS));
            prop_assert!(tile.iter().zip(&shape).all(|(t, n)| (1..=*n).contains(t)));
            let block = delays.min(BLOCK_OF_DELAYS);
            prop_assert!(tile.iter().product::<usize>() <= cells.max(block));
        }
    }

    #[test]
    fn tiles_without_delays_hold_as_many_cells() {
        let shape = |shape: &[usize], tau| tile_shape(shape, tau, BLOCK_OF_DELAYS, 1 << 14);
        assert_eq!(shape(&[600, 700], None), [23, 700]);
        assert_eq!(shape(&[5, 1001, 4097], Some(2)), [1, 3, 4097]);
        assert_eq!(shape(&[1001, 20_000], Some(1)), [1, 12_288]);
        assert_eq!(tile_shape(&[300, 1000], Some(1), 1, 256), [1, 250]);
        assert_eq!(tile_shape(&[300, 100], Some(1), 1, 256), [2, 100]);
    }

    #[test]
    fn slow_cells_are_timed_without_their_neighbours() {
        let part = |cost| timed_part(cost, &[2, 30, 8], [Some(1), Some(2)]);
        assert_eq!(part(Cost::Rooted), [2, 30, 8]);
        assert_eq!(part(Cost::Searched), [1, 30, 8]);
        assert_eq!(part(Cost::Critical), [1, 1, 8]);
        assert_eq!(timed_part(Cost::Followed, &[3, 5], [None, None]), [1, 1]);
    }

    /// An axis that is shared is whole in a tile, whatever its place, unless the tile gets too
    /// large; the other axes are cut as in the map without it.
    #[test]
    fn a_shared_axis_is_not_cut() {
        let shared = |axis, shape: &[usize], tau| shared_along(axis, shape, tau, 128, 64);
        assert_eq!(shared(0, &[8, 31, 200], Some(2)), [8, 1, 128]);
        assert_eq!(shared(2, &[31, 200, 8], Some(1)), [1, 128, 8]);
        assert_eq!(shared(1, &[31, 8, 5], Some(2)), [11, 8, 5]);
        assert_eq!(shared(1, &[700, 9], None), [64, 9]);
        assert_eq!(shared(0, &[3000, 128], Some(1)), [1500, 128]);
    }
}
