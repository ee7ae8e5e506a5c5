//! The chunks of a window that are still to be read, and their order.

use std::collections::VecDeque;

use super::pixels::Pixels;
use super::shelf::Plane;
use crate::store::chunk_layout::ChunkLayout;
use crate::sweep::plan::MOST_TILES;
use crate::sweep::plan::pieces::mixed;

/// A chunk to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Job {
    /// True for a chunk of the status, false for one of the field.
    pub status: bool,
    /// Number of the chunk along the slower and the faster axis.
    pub chunk: (usize, usize),
}

/// Chunks in order, with four bytes each: there may be millions.
#[derive(Debug, Default)]
pub(super) struct Jobs {
    /// Twice the number of the chunk in the plane, counted row by row; plus 1 for chunks of the
    /// status.
    packed: VecDeque<u32>,
    /// Number of chunks in a row, for the field and for the status.
    row: [u32; 2],
}

// A plane has no more chunks than a map has tiles.
const _: () = assert!(MOST_TILES < 1 << 31);

impl Jobs {
    /// Chunks with cells that pixels show come first, spread over the window, field and status in
    /// turn. Then come those whose cells are all hidden.
    pub(super) fn of(
        plane: &Plane,
        (slow, fast): (&Pixels, &Pixels),
        (field, status): (&ChunkLayout, &ChunkLayout),
    ) -> Self {
        let hidden = slow.is_crowded() || fast.is_crowded();
        let along = |layout: &ChunkLayout, axis: usize| {
            layout.shape[axis].div_ceil(layout.chunk[axis]) as u32
        };
        // Chunks with shown cells, then the others.
        let of = |layout: &ChunkLayout| {
            let row = along(layout, plane.fast);
            let down = match plane.slow {
                Some(axis) => slow.chunks(layout.chunk[axis], hidden),
                None if slow.on_axis.is_empty() => Vec::new(),
                None => vec![(0, true)],
            };
            let across = fast.chunks(layout.chunk[plane.fast], hidden);
            let mut parts = [true, false].map(|wanted| {
                let all = down.iter().flat_map(|&(y, shown)| {
                    across
                        .iter()
                        .map(move |&(x, too)| (y * row + x, shown && too))
                });
                let part = all.filter(|(_, shown)| *shown == wanted);
                part.map(|(number, _)| number).collect::<Vec<u32>>()
            });
            for part in &mut parts {
                part.sort_unstable_by_key(|&number| mixed(number.into()));
            }
            parts
        };
        let row = [field, status].map(|layout| along(layout, plane.fast));
        let [first, then] = of(field);
        let [first_of_status, then_of_status] = of(status);
        let mut packed = VecDeque::new();
        for (mut field, mut status) in [
            (first.into_iter(), first_of_status.into_iter()),
            (then.into_iter(), then_of_status.into_iter()),
        ] {
            packed.reserve_exact(field.len() + status.len());
            loop {
                let next = [field.next(), status.next()];
                packed.extend(next[0].map(|number| number << 1));
                packed.extend(next[1].map(|number| number << 1 | 1));
                if next == [None; 2] {
                    break;
                }
            }
        }
        Self { packed, row }
    }

    /// Number of jobs.
    pub(super) fn len(&self) -> usize {
        self.packed.len()
    }

    fn job(row: [u32; 2], packed: u32) -> Job {
        let status = packed & 1 == 1;
        let (number, row) = ((packed >> 1) as usize, row[usize::from(status)] as usize);
        Job {
            status,
            chunk: (number / row, number % row),
        }
    }

    /// Removes and returns the next job.
    pub(super) fn next(&mut self) -> Option<Job> {
        let packed = self.packed.pop_front()?;
        Some(Self::job(self.row, packed))
    }

    /// Keeps the jobs for which `kept` is true.
    pub(super) fn retain(&mut self, mut kept: impl FnMut(Job) -> bool) {
        let row = self.row;
        self.packed.retain(|&packed| kept(Self::job(row, packed)));
    }
}

#[cfg(test)]
mod tests {
    use super::super::pixels::{Scale, Stretch};
    use super::*;

    #[test]
    fn every_chunk_comes_once_and_those_that_are_shown_first() {
        let layout = |chunk: [usize; 3]| ChunkLayout {
            shape: vec![100, 5, 90],
            chunk: chunk.to_vec(),
            element: 1,
            deflated: true,
            shuffled: false,
        };
        let (field, status) = (layout([3, 5, 4]), layout([10, 1, 20]));
        let plane = Plane {
            slow: Some(0),
            fast: 2,
            at: vec![0; 3],
        };
        let pixels = |cells: usize, pixels| {
            let values: Vec<f64> = (0..cells).map(|i| i as f64).collect();
            let stretch = Stretch {
                from: None,
                to: None,
                pixels,
                scale: Scale::Linear,
            };
            Pixels::along(&values, &stretch).unwrap()
        };
        let (slow, fast) = (pixels(100, 7), pixels(90, 11));
        let mut jobs = Jobs::of(&plane, (&slow, &fast), (&field, &status));
        assert_eq!(jobs.len(), 34 * 23 + 10 * 5);
        let shows = |job: &Job| {
            let layout = if job.status { &status } else { &field };
            let lies = |pixels: &Pixels, axis: usize, chunk: usize| {
                let chunk_of = |&cell: &u32| cell as usize / layout.chunk[axis] == chunk;
                pixels.nearest.iter().any(chunk_of)
            };
            lies(&slow, 0, job.chunk.0) && lies(&fast, 2, job.chunk.1)
        };
        jobs.retain(|job| job.chunk != (0, 0));
        let all: Vec<Job> = std::iter::from_fn(|| jobs.next()).collect();
        let mut chunks: Vec<_> = all.iter().map(|job| (job.status, job.chunk)).collect();
        chunks.sort_unstable();
        chunks.dedup();
        assert_eq!(chunks.len(), 34 * 23 + 10 * 5 - 2);
        assert!(all.iter().all(|job| {
            let most = if job.status { (10, 5) } else { (34, 23) };
            job.chunk.0 < most.0 && job.chunk.1 < most.1
        }));
        assert!(all.is_sorted_by_key(|job| !shows(job)));
        assert!(all[..10].iter().any(|job| job.status) && all[..10].iter().any(|job| !job.status));
    }
}
