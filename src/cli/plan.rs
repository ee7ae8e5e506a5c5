//! `slipmap plan`: what a sweep would cost, from a timed sample of its own pieces.

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use slipmap::report::numbers::{bytes, grouped, seconds};
use slipmap::store::tiles::RecordEncoder;
use slipmap::sweep::cells::best::{best_of_plane, best_plane};
use slipmap::sweep::cells::boundaries::{plane, trace_plane};
use slipmap::sweep::engine::{Computed, Encode, Worker};
use slipmap::sweep::plan::pieces::spread;
use slipmap::sweep::{Memory, Piece, Plan};

use super::failure::Failure;
use super::run::{MEMORY, default_threads, parse_memory, parse_threads, threads_within};
use super::sweep_file::read_plan;

/// A sample ends after so long, once it has this many pieces; or after the longest time, whatever
/// it has.
const SAMPLE: Duration = Duration::from_millis(500);
const ENOUGH: usize = 12;
const LONGEST_SAMPLE: Duration = Duration::from_secs(6);

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The sweep file
    #[arg(value_name = "SWEEP.toml")]
    sweep: PathBuf,
    /// Threads to plan for [default: as many as the machine offers]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    /// The most memory to plan for, such as 500MB or 2GiB: fewer threads compute where so many
    /// would take more
    #[arg(long, value_name = "SIZE", default_value = MEMORY, value_parser = parse_memory)]
    memory: u64,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let plan = read_plan(&args.sweep)?;
    let asked = args.threads.unwrap_or_else(default_threads);
    let threads = threads_within(&plan, args.memory, asked)?;
    let costs = Costs::of(&plan)?;
    let mut out = std::io::stdout().lock();
    for axis in &plan.spec.axes {
        let (first, last) = (axis.values[0], axis.values[axis.len() - 1]);
        let (name, points) = (axis.parameter.name(), grouped(axis.len() as u64));
        writeln!(
            out,
            "axis        {name:<12} {points:>10} points, {first} to {last}"
        )?;
    }
    let fields: Vec<&str> = plan.spec.fields.iter().map(|f| f.name()).collect();
    writeln!(out, "fields      {}, status", fields.join(", "))?;
    writeln!(out, "cells       {}", grouped(plan.cells()))?;
    let (cells, tiles) = (plan.tiles.tile_cells() as u64, plan.tiles.len() as u64);
    writeln!(
        out,
        "tiles       {} of {} cells",
        grouped(tiles),
        grouped(cells)
    )?;
    writeln!(
        out,
        "boundaries  in {} planes",
        grouped(plan.boundary_planes())
    )?;
    if plan.best_plane().is_some() {
        writeln!(out, "best        in {} planes", grouped(plan.best_planes()))?;
    }
    let size = plan.cells() * plan.bytes_per_cell();
    let stored = costs.bytes.total();
    writeln!(
        out,
        "bytes       {} before compression, about {} on disk, twice that for a moment at the end",
        bytes(size),
        bytes(stored as u64),
    )?;
    let memory = bytes(Memory::of(&plan).on(threads));
    writeln!(out, "memory      up to {memory} on {threads} threads")?;
    let (total, spread) = costs.seconds();
    let threads_told = threads as f64;
    writeln!(
        out,
        "time        about {} on {threads} threads, {} to {}: {} of {} tiles timed",
        seconds(total / threads_told),
        seconds((total - spread).max(0.0) / threads_told),
        seconds((total + spread) / threads_told),
        costs.tiles.values.len(),
        grouped(tiles),
    )?;
    Ok(())
}

/// What was measured of some pieces of a kind, and how many there are of it.
struct Sample {
    values: Vec<f64>,
    of: usize,
}

impl Sample {
    /// Measures pieces spread over all `of`.
    fn take(
        of: usize,
        mut measured: impl FnMut(usize) -> Result<f64, Failure>,
    ) -> Result<Self, Failure> {
        let start = Instant::now();
        let mut values = Vec::new();
        while values.len() < of {
            let elapsed = start.elapsed();
            if elapsed > LONGEST_SAMPLE || (elapsed > SAMPLE && values.len() >= ENOUGH) {
                break;
            }
            let number = (spread(values.len() as u64) * of as f64) as usize;
            values.push(measured(number)?);
        }
        Ok(Self { values, of })
    }

    fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len().max(1) as f64
    }

    fn total(&self) -> f64 {
        self.mean() * self.of as f64
    }

    /// Twice the standard error of the total; that of one piece is its value.
    fn spread(&self) -> f64 {
        let (n, mean) = (self.values.len() as f64, self.mean());
        if self.values.len() == self.of {
            return 0.0;
        }
        let squares: f64 = self.values.iter().map(|v| (v - mean).powi(2)).sum();
        let variance = if n > 1.0 {
            squares / (n - 1.0)
        } else {
            mean * mean
        };
        2.0 * self.of as f64 * (variance / n.max(1.0)).sqrt()
    }
}

/// What pieces cost on one thread: seconds, and bytes of tiles.
struct Costs {
    tiles: Sample,
    curves: Sample,
    best: Sample,
    bytes: Sample,
}

impl Costs {
    fn of(plan: &Plan) -> Result<Self, Failure> {
        let mut worker = Worker::new(plan);
        let mut encoder = RecordEncoder::default();
        let mut stored = Vec::new();
        let tiles = Sample::take(plan.tiles.len(), |number| {
            let start = Instant::now();
            worker.compute(&plan.tiles.tile(number));
            let piece = Piece::Tile(number as u64);
            let record = encoder.encode(piece, Computed::Tile(&worker.buffers));
            stored.push(record.payload.len() as f64);
            Ok(start.elapsed().as_secs_f64())
        })?;
        let curves = Sample::take(plan.boundary_planes() as usize, |number| {
            let start = Instant::now();
            std::hint::black_box(trace_plane(plan, &plane(plan, number as u64))?);
            Ok(start.elapsed().as_secs_f64())
        })?;
        let best = Sample::take(plan.best_planes() as usize, |number| {
            let start = Instant::now();
            std::hint::black_box(best_of_plane(plan, &best_plane(plan, number as u64)));
            Ok(start.elapsed().as_secs_f64())
        })?;
        let bytes = Sample {
            values: stored,
            of: plan.tiles.len(),
        };
        Ok(Self {
            tiles,
            curves,
            best,
            bytes,
        })
    }

    /// Seconds of all pieces on one thread, and how far off that may be.
    fn seconds(&self) -> (f64, f64) {
        let all = [&self.tiles, &self.curves, &self.best];
        let squares: f64 = all.iter().map(|s| s.spread().powi(2)).sum();
        (all.iter().map(|s| s.total()).sum(), squares.sqrt())
    }
}
