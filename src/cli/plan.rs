//! `slipmap plan`: what a sweep would cost.

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use slipmap::report::numbers::{bytes, grouped, prefixed, seconds};
use slipmap::store::map_writer::TileEncoder;
use slipmap::sweep::Plan;
use slipmap::sweep::best::{best_of_plane, best_planes};
use slipmap::sweep::boundaries::{planes, trace_plane};
use slipmap::sweep::engine::{Encode, Worker};

use super::failure::Failure;
use super::run::{default_threads, parse_threads};
use super::sweep_file::read_plan;

/// How long the timed sample takes, about.
const SAMPLE: Duration = Duration::from_millis(300);

#[derive(Debug, clap::Args)]
pub struct Args {
    /// The sweep file
    #[arg(value_name = "SWEEP.toml")]
    sweep: PathBuf,
    /// Threads to plan for [default: as many as the machine offers]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
}

pub fn main(args: &Args) -> Result<(), Failure> {
    let plan = read_plan(&args.sweep)?;
    let threads = args.threads.unwrap_or_else(default_threads);
    let per_cell = sample(&plan);
    let per_plane = sample_planes(&plan)?;
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
    let best = best_planes(&plan);
    if plan.best_plane().is_some() {
        writeln!(out, "best        in {} planes", grouped(best.len() as u64))?;
    }
    let size = plan.cells() * plan.bytes_per_cell();
    writeln!(out, "bytes       {} before compression", bytes(size))?;
    let in_memory = cells * plan.bytes_per_cell() * 4 * threads as u64;
    writeln!(out, "memory      about {}", bytes(in_memory + (30 << 20)))?;
    let curves = per_plane * plan.boundary_planes() as f64 / threads as f64;
    let searches = sample_best(&plan, &best) * best.len() as f64 / threads as f64;
    let total = per_cell * plan.cells() as f64 / threads as f64 + curves + searches;
    writeln!(
        out,
        "time        about {} on {threads} threads ({} cells/s a thread in a timed sample)",
        seconds(total),
        prefixed(1.0 / per_cell),
    )?;
    Ok(())
}

/// Seconds per plane of crossing curves on one thread, from planes spread over the sweep.
fn sample_planes(plan: &Plan) -> Result<f64, Failure> {
    let planes = planes(plan);
    let start = Instant::now();
    let mut done = 0;
    while start.elapsed() < SAMPLE && done < planes.len() {
        let index = (spread(done) * planes.len() as f64) as usize;
        std::hint::black_box(trace_plane(plan, &planes[index])?);
        done += 1;
    }
    Ok(start.elapsed().as_secs_f64() / done.max(1) as f64)
}

/// Seconds per plane whose best settings are looked for, on one thread.
fn sample_best(plan: &Plan, planes: &[Vec<usize>]) -> f64 {
    let start = Instant::now();
    let mut done = 0;
    while start.elapsed() < SAMPLE && done < planes.len() {
        let index = (spread(done) * planes.len() as f64) as usize;
        std::hint::black_box(best_of_plane(plan, &planes[index]));
        done += 1;
    }
    start.elapsed().as_secs_f64() / done.max(1) as f64
}

/// A number in [0, 1) for each sample: multiples of the golden ratio fall evenly, wherever the sampling ends.
fn spread(sample: usize) -> f64 {
    (sample as f64 * 0.618_033_988_749_895).fract()
}

/// Seconds per cell on one thread, from tiles spread over the map: computed and compressed, not written.
fn sample(plan: &Plan) -> f64 {
    let mut worker = Worker::new(plan);
    let mut encoder = TileEncoder::default();
    let start = Instant::now();
    let (mut cells, mut done) = (0, 0);
    let tiles = plan.tiles.len();
    while start.elapsed() < SAMPLE && done < tiles {
        let tile = plan.tiles.tile((spread(done) * tiles as f64) as usize);
        worker.compute(&tile);
        std::hint::black_box(encoder.encode(&worker.buffers));
        cells += tile.cells();
        done += 1;
    }
    start.elapsed().as_secs_f64() / cells as f64
}
