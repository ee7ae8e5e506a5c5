//! The indices that a hyperslab picks along one axis.

use std::ops::Range;

use hdf5::SliceOrIndex;

/// The indices to read along one axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Picked {
    start: usize,
    pub step: usize,
    pub count: usize,
}

impl Picked {
    /// The indices that a hyperslab asks for; none where it picks blocks.
    pub(super) fn of(slab: &SliceOrIndex) -> Option<Self> {
        let (start, step, count) = match *slab {
            SliceOrIndex::Index(start) => (start, 1, 1),
            SliceOrIndex::SliceTo {
                start,
                step,
                end,
                block: 1,
            } => (start, step, end.saturating_sub(start).div_ceil(step.max(1))),
            SliceOrIndex::SliceCount {
                start,
                step,
                count,
                block: 1,
            } => (start, step, count),
            _ => return None,
        };
        (step > 0).then_some(Self { start, step, count })
    }

    /// The index that is picked as this one, from 0 on.
    pub(super) fn index(&self, number: usize) -> usize {
        self.start + number * self.step
    }

    /// The chunks that hold picked indices: the first index of each chunk, and which of the picked
    /// indices lie in it.
    pub(super) fn by_chunk(&self, chunk: usize) -> Vec<(usize, Range<usize>)> {
        let mut parts = Vec::new();
        let mut number = 0;
        while number < self.count {
            let start = self.index(number) / chunk * chunk;
            let behind = (start + chunk - self.start).div_ceil(self.step);
            let end = behind.min(self.count);
            parts.push((start, number..end));
            number = end;
        }
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each picked index lies in its own chunk, once and in order.
    #[test]
    fn picked_indices_are_cut_by_chunks() {
        for start in 0..7 {
            for step in 1..6 {
                for count in 0..12 {
                    for chunk in 1..8 {
                        let picked = Picked { start, step, count };
                        let mut next = 0;
                        for (first, numbers) in picked.by_chunk(chunk) {
                            assert_eq!((numbers.start, first % chunk), (next, 0));
                            assert!(!numbers.is_empty());
                            for number in numbers.clone() {
                                assert_eq!(picked.index(number) / chunk * chunk, first);
                            }
                            next = numbers.end;
                        }
                        assert_eq!(next, count, "{picked:?} by {chunk}");
                    }
                }
            }
        }
    }
}
