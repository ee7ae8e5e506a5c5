//! What a sweep costs, from a timed sample of its own pieces.

use std::time::{Duration, Instant};

use super::cells::best_planes::{best_of_plane, best_plane};
use super::cells::boundaries::{plane, trace_plane};
use super::cells::worker::Worker;
use super::plan::Plan;
use super::plan::pieces::{Piece, spread};
use super::sink::Computed;
use crate::model::stop::Stop;

/// A sample ends after this time once it has enough pieces, and after the longest time in any case.
const SAMPLE: Duration = Duration::from_millis(500);
const ENOUGH: usize = 12;
const LONGEST_SAMPLE: Duration = Duration::from_secs(6);

/// Measured values of some pieces of one kind, and the number of all pieces of that kind.
pub struct Sample {
    /// The values, in no unit or in seconds or bytes.
    pub values: Vec<f64>,
    of: usize,
}

impl Sample {
    /// Measures pieces spread over all `of` pieces.
    fn take(of: usize, mut measured: impl FnMut(usize) -> f64) -> Self {
        let start = Instant::now();
        let mut values = Vec::new();
        while values.len() < of {
            let elapsed = start.elapsed();
            if elapsed > LONGEST_SAMPLE || (elapsed > SAMPLE && values.len() >= ENOUGH) {
                break;
            }
            let number = (spread(values.len() as u64) * of as f64) as usize;
            values.push(measured(number));
        }
        Self { values, of }
    }

    fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len().max(1) as f64
    }

    /// What all pieces come to.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.mean() * self.of as f64
    }

    /// Twice the standard error of the total. For a single piece, its value stands for the
    /// deviation.
    fn spread(&self) -> f64 {
        let (n, mean) = (self.values.len() as f64, self.mean());
        if self.values.len() == self.of {
            return 0.0;
        }
        let squares: f64 = self.values.iter().map(|v| (v - mean) * (v - mean)).sum();
        let variance = if n > 1.0 {
            squares / (n - 1.0)
        } else {
            mean * mean
        };
        2.0 * self.of as f64 * (variance / n.max(1.0)).sqrt()
    }
}

/// The cost of pieces on one thread: seconds and bytes.
pub struct Costs {
    /// Seconds of tiles.
    pub tiles: Sample,
    curves: Sample,
    best: Sample,
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
        let tiles = Sample::take(plan.tiles.len(), |number| {
            let start = Instant::now();
            worker.compute(&plan.tiles.tile(number), stop);
            let piece = Piece::Tile(number as u64);
            of_tiles.push(stored(piece, Computed::Tile(&worker.buffers)) as f64);
            start.elapsed().as_secs_f64()
        });
        let curves = Sample::take(plan.boundary_planes() as usize, |number| {
            let start = Instant::now();
            let traced = trace_plane(plan, &plane(plan, number as u64), stop);
            let taken = start.elapsed().as_secs_f64();
            let piece = Piece::Curves(number as u64);
            of_curves.push(stored(piece, Computed::Curves(&traced)) as f64);
            taken
        });
        let best = Sample::take(plan.best_planes() as usize, |number| {
            let start = Instant::now();
            std::hint::black_box(best_of_plane(plan, &best_plane(plan, number as u64), stop));
            start.elapsed().as_secs_f64()
        });
        let bytes = Sample {
            values: of_tiles,
            of: plan.tiles.len(),
        };
        let bytes_of_curves = Sample {
            values: of_curves,
            of: plan.boundary_planes() as usize,
        };
        Self {
            tiles,
            curves,
            best,
            bytes,
            bytes_of_curves,
        }
    }

    /// Seconds of all pieces on one thread, with the error of this estimate.
    #[must_use]
    pub fn seconds(&self) -> (f64, f64) {
        let all = [&self.tiles, &self.curves, &self.best];
        let squares: f64 = all.iter().map(|s| s.spread() * s.spread()).sum();
        (all.iter().map(|s| s.total()).sum(), squares.sqrt())
    }
}
