//! The sweep engine: tiles computed over threads, handed one by one to a sink.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::best::{BestSettings, best_of_plane, best_planes};
use super::boundaries::{BoundaryPlane, planes, trace_plane};
use super::events::{Event, Observer};
use super::plan::Plan;
use super::tile::Tile;
pub use super::worker::{Column, FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL, TileBuffers, Worker};
use crate::model::ModelError;

/// Planes of crossing curves that are held in memory at a time.
const PLANES_AT_ONCE: usize = 16;
/// Tiles that wait for the sink, per thread.
const TILES_WAITING: usize = 2;

/// Where tiles go. Encoding happens on the computing threads, writing on the one that called [`run`].
pub trait Sink {
    /// Turns tiles into what is written; one per thread.
    type Encoder: Encode<Encoded = Self::Encoded>;
    /// A tile ready to be written.
    type Encoded: Send;
    /// Why writing failed.
    type Error;

    /// A new encoder, for one thread.
    fn encoder(&self) -> Self::Encoder;

    /// Takes the next planes of crossing curves, in order.
    ///
    /// # Errors
    /// Ends the sweep.
    fn write_boundaries(&mut self, planes: &[BoundaryPlane]) -> Result<(), Self::Error>;

    /// Takes the best settings of the next planes, in order.
    ///
    /// # Errors
    /// Ends the sweep.
    fn write_best(&mut self, planes: &[Option<BestSettings>]) -> Result<(), Self::Error>;

    /// Takes a tile. Tiles come in no particular order.
    ///
    /// # Errors
    /// Ends the sweep.
    fn write_tile(&mut self, tile: &Tile, encoded: Self::Encoded) -> Result<(), Self::Error>;
}

/// Turns a computed tile into what a sink writes.
pub trait Encode: Send {
    /// A tile ready to be written.
    type Encoded: Send;

    /// Encodes the buffers of a tile.
    fn encode(&mut self, buffers: &TileBuffers) -> Self::Encoded;
}

/// Why a sweep ended before its last tile.
#[derive(Debug, thiserror::Error)]
pub enum RunError<E> {
    /// It was asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The sink could not take what it was given.
    #[error(transparent)]
    Sink(E),
    /// A parameter is outside the model's range.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// What the system said.
        reason: String,
    },
}

/// Computes every tile of `plan` on `threads` threads and hands them to `sink`; `stop` ends it at the next tile, where
/// motions are followed at the next cell.
///
/// What a tile holds depends on the plan alone.
///
/// # Errors
/// See [`RunError`].
pub fn run<S: Sink>(
    plan: &Plan,
    threads: usize,
    sink: &mut S,
    observer: &dyn Observer,
    stop: &AtomicBool,
) -> Result<(), RunError<S::Error>> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| RunError::Threads {
            threads,
            reason: error.to_string(),
        })?;
    observer.event(&Event::Started {
        cells: plan.cells(),
        threads,
    });
    run_boundaries(plan, &pool, sink, observer, stop)?;
    run_best(plan, &pool, sink, observer, stop)?;
    run_tiles(plan, &pool, sink, observer, stop)?;
    observer.event(&Event::Finished);
    Ok(())
}

fn run_boundaries<S: Sink>(
    plan: &Plan,
    pool: &ThreadPool,
    sink: &mut S,
    observer: &dyn Observer,
    stop: &AtomicBool,
) -> Result<(), RunError<S::Error>> {
    let (mut pieces, mut corners, mut planes_left_out) = (0, 0, 0);
    for batch in planes(plan).chunks(PLANES_AT_ONCE) {
        if stop.load(Ordering::Relaxed) {
            return Err(RunError::Interrupted);
        }
        let traced: Result<Vec<BoundaryPlane>, ModelError> = pool.install(|| {
            batch
                .par_iter()
                .filter(|_| !stop.load(Ordering::Relaxed))
                .map(|index| trace_plane(plan, index))
                .collect()
        });
        let traced = traced?;
        if traced.len() < batch.len() {
            return Err(RunError::Interrupted);
        }
        for plane in &traced {
            for curves in plane.curves.iter().filter_map(|of| of.curves.as_ref().ok()) {
                pieces += curves.pieces.len() as u64;
                corners += curves.corners.len() as u64;
            }
            planes_left_out += u64::from(plane.curves.iter().any(|of| of.curves.is_err()));
        }
        sink.write_boundaries(&traced).map_err(RunError::Sink)?;
    }
    if plan.boundary_plane.is_some() {
        observer.event(&Event::BoundariesTraced {
            pieces,
            corners,
            planes_left_out,
        });
    }
    Ok(())
}

fn run_best<S: Sink>(
    plan: &Plan,
    pool: &ThreadPool,
    sink: &mut S,
    observer: &dyn Observer,
    stop: &AtomicBool,
) -> Result<(), RunError<S::Error>> {
    let planes = best_planes(plan);
    for batch in planes.chunks(PLANES_AT_ONCE) {
        let found: Vec<Option<BestSettings>> = pool.install(|| {
            batch
                .par_iter()
                .filter(|_| !stop.load(Ordering::Relaxed))
                .map(|index| best_of_plane(plan, index))
                .collect()
        });
        if found.len() < batch.len() {
            return Err(RunError::Interrupted);
        }
        sink.write_best(&found).map_err(RunError::Sink)?;
    }
    if plan.best_plane().is_some() {
        observer.event(&Event::BestFound {
            planes: planes.len() as u64,
        });
    }
    Ok(())
}

fn run_tiles<S: Sink>(
    plan: &Plan,
    pool: &ThreadPool,
    sink: &mut S,
    observer: &dyn Observer,
    stop: &AtomicBool,
) -> Result<(), RunError<S::Error>> {
    let threads = pool.current_num_threads();
    let (sender, receiver) = sync_channel(TILES_WAITING * threads);
    let encoders: Vec<S::Encoder> = (0..threads).map(|_| sink.encoder()).collect();
    let failed = AtomicBool::new(false);
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        let (next, failed) = (&next, &failed);
        let work = move |mut encoder: S::Encoder, sender: SyncSender<(Tile, S::Encoded)>| {
            let mut worker = Worker::new(plan);
            while !stop.load(Ordering::Relaxed) && !failed.load(Ordering::Relaxed) {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= plan.tiles.len() {
                    break;
                }
                let tile = plan.tiles.tile(number);
                if !worker.compute_until(&tile, stop) {
                    break;
                }
                if sender
                    .send((tile, encoder.encode(&worker.buffers)))
                    .is_err()
                {
                    break;
                }
            }
        };
        scope.spawn(move || {
            pool.scope(|workers| {
                for encoder in encoders {
                    let sender = sender.clone();
                    workers.spawn(move |_| work(encoder, sender));
                }
                drop(sender);
            });
        });
        // Taken by value: when writing fails the channel closes, and no worker waits on it for ever.
        write_all(receiver, sink, observer).inspect_err(|_| failed.store(true, Ordering::Relaxed))
    })
    .map_err(RunError::Sink)?;
    if next.load(Ordering::Relaxed) < plan.tiles.len() || stop.load(Ordering::Relaxed) {
        return Err(RunError::Interrupted);
    }
    Ok(())
}

fn write_all<S: Sink>(
    receiver: Receiver<(Tile, S::Encoded)>,
    sink: &mut S,
    observer: &dyn Observer,
) -> Result<(), S::Error> {
    for (tile, encoded) in receiver {
        sink.write_tile(&tile, encoded)?;
        observer.event(&Event::TileDone {
            cells: tile.cells(),
        });
    }
    Ok(())
}
