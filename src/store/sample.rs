//! Chooses the cells that are checked by a second method: spread over the map, and equally many of
//! each outcome by each method, however rare.

use std::collections::{BTreeMap, BTreeSet};

use hdf5::{Dataset, SliceOrIndex};

use super::error::StoreError;
use super::map_file::MapFile;
use super::map_summary::for_each_chunk;
use crate::setting::Field;
use crate::sweep::plan::Plan;
use crate::sweep::plan::pieces::{mixed, spread};

/// The fields by which cells are sorted.
const SORTS: [Field; 2] = [Field::Outcome, Field::Method];

/// The numbers of at most `count` cells, counted row by row over the map.
///
/// # Errors
/// When the map cannot be read.
pub(crate) fn sample(map: &MapFile, plan: &Plan, count: u64) -> Result<Vec<u64>, StoreError> {
    let count = count.min(plan.cells());
    let told = SORTS
        .iter()
        .filter(|field| plan.spec.fields.contains(field));
    let datasets = told
        .map(|field| map.of_field(*field))
        .collect::<Result<Vec<_>, _>>()?;
    if datasets.is_empty() {
        let place = |sample| (spread(sample) * plan.cells() as f64) as u64;
        return Ok((0..count).map(place).collect());
    }
    let mut sorts = Sorts {
        most: usize::try_from(count).unwrap_or(usize::MAX),
        cells: BTreeMap::new(),
    };
    let shape = plan.shape();
    for_each_chunk(&datasets[0], |slab| sorts.add(map, &datasets, shape, slab))?;
    Ok(sorts.in_turn())
}

/// The first cells of each sort in a fixed pseudo-random order.
struct Sorts {
    /// The most cells kept of each sort.
    most: usize,
    /// By outcome and method: the place in that order, and the cell's number.
    cells: BTreeMap<[u8; SORTS.len()], BTreeSet<(u64, u64)>>,
}

impl Sorts {
    fn add(
        &mut self,
        map: &MapFile,
        datasets: &[Dataset],
        shape: &[usize],
        slab: &[SliceOrIndex],
    ) -> Result<(), StoreError> {
        let kinds = datasets
            .iter()
            .map(|dataset| map.read::<u8>(dataset, slab))
            .collect::<Result<Vec<_>, _>>()?;
        let (starts, lengths) = extent(slab);
        for cell in 0..kinds[0].len() {
            let mut sort = [0; SORTS.len()];
            for (sort, kinds) in sort.iter_mut().zip(&kinds) {
                *sort = kinds.get(cell).copied().unwrap_or(0);
            }
            let number = number_in_map(cell, (&starts, &lengths), shape);
            let kept = self.cells.entry(sort).or_default();
            kept.insert((mixed(number), number));
            if kept.len() > self.most {
                kept.pop_last();
            }
        }
        Ok(())
    }

    /// The cells in turn: one of each sort, then the next of each.
    fn in_turn(self) -> Vec<u64> {
        let mut sorts: Vec<_> = self.cells.into_values().map(BTreeSet::into_iter).collect();
        let mut numbers = Vec::new();
        while numbers.len() < self.most {
            let before = numbers.len();
            for sort in &mut sorts {
                numbers.extend(sort.next().map(|(_, number)| number));
            }
            if numbers.len() == before {
                break;
            }
        }
        numbers.truncate(self.most);
        numbers
    }
}

/// The first indices of a slab, and its lengths.
fn extent(slab: &[SliceOrIndex]) -> (Vec<usize>, Vec<usize>) {
    let range = |part: &SliceOrIndex| match *part {
        SliceOrIndex::SliceTo { start, end, .. } => (start, end - start),
        SliceOrIndex::Index(start) => (start, 1),
        SliceOrIndex::SliceCount { start, count, .. } => (start, count),
        SliceOrIndex::Unlimited { start, .. } => (start, 0),
    };
    slab.iter().map(range).unzip()
}

/// The number in a map of shape `shape` of the `cell`-th cell of a slab, both counted row by row.
fn number_in_map(mut cell: usize, (starts, lengths): (&[usize], &[usize]), shape: &[usize]) -> u64 {
    let (mut number, mut unit) = (0, 1);
    for ((start, length), whole) in starts.iter().zip(lengths).zip(shape).rev() {
        number += unit * (start + cell % length) as u64;
        cell /= length;
        unit *= *whole as u64;
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_a_slab_have_their_numbers() {
        // Rows 1 and 2, columns 2 to 4 of 4 × 5 cells.
        let slab = (&[1, 2][..], &[2, 3][..]);
        let numbers: Vec<u64> = (0..6)
            .map(|cell| number_in_map(cell, slab, &[4, 5]))
            .collect();
        assert_eq!(numbers, [7, 8, 9, 12, 13, 14]);
    }

    #[test]
    fn rare_sorts_come_as_often_as_others() {
        let sort = |numbers: std::ops::Range<u64>| numbers.map(|n| (mixed(n), n)).collect();
        let sorts = Sorts {
            most: 10,
            cells: BTreeMap::from([([0, 0], sort(0..1000)), ([3, 1], sort(1000..1002))]),
        };
        let numbers = sorts.in_turn();
        assert_eq!(numbers.len(), 10);
        assert_eq!(numbers.iter().filter(|&&n| n >= 1000).count(), 2);
    }
}
