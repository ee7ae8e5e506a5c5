//! What a sweep costs, from a timed sample of its own pieces.
//!
//! Where cells take long, parts of tiles are timed, so that a sample soon has many places of the
//! map. A line of delays takes somewhat longer in parts than as a whole where its searches start
//! from one another.

use std::collections::HashSet;
use std::time::{Duration, Instant};

use super::cells::best_planes::{best_of_plane, best_plane};
use super::cells::boundaries::{plane, trace_plane};
use super::cells::worker::Worker;
use super::plan::Plan;
use super::plan::pieces::{Piece, spread_over};
use super::sink::Computed;
use crate::model::stop::Stop;

/// A sample ends after this time once it has enough pieces or enough parts of tiles, and after the
/// longest time in any case, but not with fewer pieces than have a spread.
const SAMPLE: Duration = Duration::from_millis(500);
const ENOUGH: usize = 12;
const ENOUGH_PARTS: usize = 256;
const LONGEST_SAMPLE: Duration = Duration::from_secs(6);
const FEWEST: usize = 2;

/// Measured values of some pieces of one kind, and the number of all pieces of that kind.
pub struct Sample {
    /// The values, in no unit or in seconds or bytes.
    pub values: Vec<f64>,
    of: usize,
}

impl Sample {
    /// Measures pieces spread over all `of` pieces, until there are `enough`, time is over, or
    /// `stop` is set.
    fn take(of: usize, enough: usize, stop: &Stop, mut measured: impl FnMut(usize) -> f64) -> Self {
        let start = Instant::now();
        let mut values = Vec::new();
        while values.len() < of && !stop.is_set() {
            let (elapsed, taken) = (start.elapsed(), values.len());
            let over = elapsed > LONGEST_SAMPLE || (elapsed > SAMPLE && taken >= enough);
            if over && taken >= FEWEST {
                break;
            }
            values.push(measured(spread_over(of as u64, taken as u64) as usize));
        }
        Self { values, of }
    }

    fn sum(&self) -> f64 {
        self.values.iter().sum()
    }

    fn mean(&self) -> f64 {
        self.sum() / self.values.len().max(1) as f64
    }

    /// What all pieces come to; to the last digit the sum, where all were measured.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.sum() * (self.of as f64 / self.values.len().max(1) as f64)
    }

    /// Twice the standard error of the total.
    fn spread(&self) -> f64 {
        let (n, mean) = (self.values.len(), self.mean());
        if n == self.of || n < FEWEST {
            return 0.0;
        }
        let squares: f64 = self.values.iter().map(|v| (v - mean) * (v - mean)).sum();
        let (n, of) = (n as f64, self.of as f64);
        2.0 * of * (squares / (n - 1.0) / n).sqrt()
    }
}

/// The cost of pieces on one thread: seconds and bytes.
pub struct Costs {
    tiles: Sample,
    curves: Sample,
    best: Sample,
    /// How many tiles were timed, wholly or in part.
    pub tiles_timed: usize,
    /// How many cells were timed.
    pub cells_timed: u64,
    /// Bytes of tiles, as they are stored.
    pub bytes: Sample,
    /// Bytes of planes of curves, as they are stored.
    pub bytes_of_curves: Sample,
}

impl Costs {
    /// The cost of the pieces of `plan`. `stored` tells the bytes of a piece where it is stored.
    /// Once `stop` is set, the answer comes soon but is meaningless.
    pub fn of(plan: &Plan, mut stored: impl FnMut(Piece, Computed) -> usize, stop: &Stop) -> Self {
        let mut worker = Worker::new(plan);
        let (mut of_tiles, mut of_curves) = (Vec::new(), Vec::new());
        let (mut cells_timed, mut tiles_timed) = (0, HashSet::new());
        let parts = plan.timed_parts();
        let whole = parts.tile_shape() == plan.tiles.tile_shape();
        let enough = if whole { ENOUGH } else { ENOUGH_PARTS };
        if !whole {
            // A tile without values, and all values beside it: few compress little.
            let empty = stored(Piece::Tile(0), Computed::Tile(&worker.buffers)) as f64;
            let values = plan.cells() * plan.bytes_per_cell();
            of_tiles.push(empty + values as f64 / plan.tiles.len() as f64);
        }
        let tiles = Sample::take(parts.len(), enough, stop, |number| {
            let (part, start) = (parts.tile(number), Instant::now());
            worker.compute(&part, stop);
            if whole {
                let piece = Piece::Tile(number as u64);
                of_tiles.push(stored(piece, Computed::Tile(&worker.buffers)) as f64);
            }
            let taken = start.elapsed().as_secs_f64();
            cells_timed += part.cells();
            tiles_timed.insert(plan.tiles.holding(&part.offset));
            taken
        });
        let curves = Sample::take(plan.boundary_planes() as usize, ENOUGH, stop, |number| {
            let start = Instant::now();
            let traced = trace_plane(plan, &plane(plan, number as u64), stop);
            let taken = start.elapsed().as_secs_f64();
            let piece = Piece::Curves(number as u64);
            of_curves.push(stored(piece, Computed::Curves(&traced)) as f64);
            taken
        });
        let best = Sample::take(plan.best_planes() as usize, ENOUGH, stop, |number| {
            let start = Instant::now();
            std::hint::black_box(best_of_plane(plan, &best_plane(plan, number as u64), stop));
            start.elapsed().as_secs_f64()
        });
        Self {
            tiles,
            curves,
            best,
            tiles_timed: tiles_timed.len(),
            cells_timed,
            bytes: Sample {
                values: of_tiles,
                of: plan.tiles.len(),
            },
            bytes_of_curves: Sample {
                values: of_curves,
                of: plan.boundary_planes() as usize,
            },
        }
    }

    /// Seconds of all pieces on one thread: at least, about and at most.
    #[must_use]
    pub fn seconds(&self) -> [f64; 3] {
        let all = [&self.tiles, &self.curves, &self.best];
        let squares: f64 = all.iter().map(|s| s.spread() * s.spread()).sum();
        let (total, spread) = (all.iter().map(|s| s.total()).sum::<f64>(), squares.sqrt());
        let timed = all.iter().map(|s| s.sum()).sum();
        [(total - spread).max(timed), total, total + spread]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::SweepSpec;
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    fn plan(text: &str) -> Plan {
        Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap()
    }

    /// A sweep of a few slow cells has a range from several places, whatever one of them takes.
    #[test]
    fn slow_cells_are_timed_one_by_one() {
        let plan = plan(
            "fields = [\"n_unstable\", \"outcome\"]\n[axes]\nalpha_v = [-0.9, -0.5, -0.1]\n\
             tau = { from = 1.0, to = 5.0, points = 4 }\n[friction]\nlaw = \"weakening\"\n\
             mu0 = 0.5\nv_s = 0.5\n[fixed]\nv0 = 0.35\n",
        );
        assert_eq!(plan.tiles.len(), 1);
        let costs = Costs::of(&plan, |_, _| 100, &Stop::default());
        assert!((FEWEST as u64..=12).contains(&costs.cells_timed));
        let values = plan.cells() * plan.bytes_per_cell();
        assert_eq!(
            (costs.tiles_timed, costs.bytes.total()),
            (1, 100.0 + values as f64)
        );
        let [least, about, most] = costs.seconds();
        assert!(0.0 < least && least <= about && about <= most);
    }

    #[test]
    fn a_sample_has_two_values_at_least_and_each_piece_once() {
        let slow = Sample {
            values: vec![1.0, 3.0],
            of: 10,
        };
        assert_eq!((slow.total(), slow.spread()), (20.0, 20.0));
        let mut seen = Vec::new();
        let all = Sample::take(9, ENOUGH, &Stop::default(), |number| {
            seen.push(number);
            1.0
        });
        seen.sort_unstable();
        assert_eq!(seen, (0..9).collect::<Vec<_>>());
        assert_eq!((all.total(), all.spread()), (9.0, 0.0));
        for of in 1..100 {
            let all = Sample {
                values: vec![0.1; of],
                of,
            };
            assert_eq!(all.total(), all.sum(), "{of}");
        }
        let stop = Stop::when(&Arc::new(AtomicBool::new(true)));
        assert!(Sample::take(9, ENOUGH, &stop, |_| 1.0).values.is_empty());
    }
}
