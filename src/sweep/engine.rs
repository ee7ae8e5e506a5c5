//! The sweep engine: tiles computed over threads, handed one by one to a sink.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::best::{BestSettings, best_of_plane, best_planes};
use super::boundaries::{BoundaryPlane, planes, trace_plane};
use super::events::{Event, Observer};
use super::field::Field;
use super::parameter::{Parameter, Setting};
use super::plan::Plan;
use super::tile::{Tile, for_each_index};
use crate::linear::Crossings;
use crate::linear::row::Delays;
use crate::linear::status::NOT_CONVERGED;
use crate::model::{Groups, ModelError, Oscillator, SlidingPoint};

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

/// The cells of one tile, in memory in the order of its strides. Cells beyond the map hold fill values.
#[derive(Debug, Clone)]
pub struct TileBuffers {
    /// Status of each cell, see [`crate::linear::status`].
    pub status: Vec<u8>,
    /// Number of unstable roots, if asked for.
    pub n_unstable: Option<Vec<u16>>,
    /// Distance to the nearest change of stability, if asked for.
    pub delay_margin: Option<Vec<f64>>,
}

/// Value of `n_unstable` in cells that are not computed.
pub const N_UNSTABLE_FILL: u16 = u16::MAX;
/// Value of `status` in cells that are not computed.
pub const STATUS_FILL: u8 = u8::MAX;

impl TileBuffers {
    /// Buffers for tiles of `plan`, all fill values.
    #[must_use]
    pub fn new(plan: &Plan) -> Self {
        let cells = plan.tiles.tile_cells();
        let wants = |field| plan.spec.fields.contains(&field);
        Self {
            status: vec![STATUS_FILL; cells],
            n_unstable: wants(Field::NUnstable).then(|| vec![N_UNSTABLE_FILL; cells]),
            delay_margin: wants(Field::DelayMargin).then(|| vec![f64::NAN; cells]),
        }
    }

    fn clear(&mut self) {
        self.status.fill(STATUS_FILL);
        if let Some(n) = &mut self.n_unstable {
            n.fill(N_UNSTABLE_FILL);
        }
        if let Some(margin) = &mut self.delay_margin {
            margin.fill(f64::NAN);
        }
    }
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

/// Computes every tile of `plan` on `threads` threads and hands them to `sink`; `stop` ends it at the next tile.
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
                worker.compute(&tile);
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

/// Computes tiles into buffers of its own, which it reuses.
pub struct Worker<'p> {
    plan: &'p Plan,
    lines: Lines<'p>,
    /// The delays of the tile computed last, and which of the plan's they are.
    delays: Delays,
    delay_range: Range<usize>,
    strides: Vec<usize>,
    /// Cells between neighbouring delays.
    stride: usize,
    /// The cells of the tile computed last.
    pub buffers: TileBuffers,
    /// Every status in the buffers is zero.
    unflagged: bool,
    row: RowBuffers,
}

/// The groups of one line after the other. What does not change from line to line is not computed again.
struct Lines<'p> {
    plan: &'p Plan,
    setting: Setting,
    /// Index of the setting along each axis.
    index: Vec<usize>,
    /// What the gains do not change.
    uncontrolled: Option<Result<(Oscillator, SlidingPoint), ModelError>>,
}

impl<'p> Lines<'p> {
    fn new(plan: &'p Plan) -> Self {
        let index = vec![0; plan.spec.axes.len()];
        Self {
            plan,
            setting: plan.setting(&index),
            index,
            uncontrolled: None,
        }
    }

    /// The groups of the line at `offset` + `inside`, and its unit of time.
    #[inline(always)]
    fn groups(&mut self, offset: &[usize], inside: &[usize]) -> Result<(Groups, f64), ModelError> {
        for (axis, known) in self.index.iter_mut().enumerate() {
            let index = offset[axis] + inside[axis];
            if *known != index {
                *known = index;
                let axis = &self.plan.spec.axes[axis];
                self.setting.set(axis.parameter, axis.values[index]);
                if !matches!(
                    axis.parameter,
                    Parameter::AlphaV | Parameter::AlphaN | Parameter::Tau
                ) {
                    self.uncontrolled = None;
                }
            }
        }
        let setting = &self.setting;
        let uncontrolled = self
            .uncontrolled
            .get_or_insert_with(|| Ok((setting.oscillator()?, setting.sliding_point()?)));
        let (oscillator, sliding) = uncontrolled.as_ref().map_err(Clone::clone)?;
        let groups = oscillator.groups(*sliding, setting.control());
        Ok((groups, oscillator.time_unit()))
    }
}

/// One row on its way to a tile whose delays are not next to one another in memory.
struct RowBuffers {
    status: Vec<u8>,
    n_unstable: Vec<u16>,
    delay_margin: Vec<f64>,
}

impl<'p> Worker<'p> {
    /// A worker with buffers for the tiles of `plan`.
    #[must_use]
    pub fn new(plan: &'p Plan) -> Self {
        let delay_range = plan.delay_range(&plan.tiles.tile(0));
        let longest = delay_range.len();
        let strides = plan.tiles.strides();
        Self {
            plan,
            lines: Lines::new(plan),
            delays: Delays::new(&plan.delays(delay_range.clone())),
            delay_range,
            stride: plan.tau_axis.map_or(1, |axis| strides[axis]),
            strides,
            buffers: TileBuffers::new(plan),
            unflagged: false,
            row: RowBuffers {
                status: vec![0; longest],
                n_unstable: vec![0; longest],
                delay_margin: vec![0.0; longest],
            },
        }
    }

    /// Computes every cell of `tile`.
    pub fn compute(&mut self, tile: &Tile) {
        let range = self.plan.delay_range(tile);
        if range != self.delay_range {
            self.delays = Delays::new(&self.plan.delays(range.clone()));
            self.delay_range = range;
        }
        let whole = tile.cells() == self.plan.tiles.tile_cells() as u64;
        if !whole {
            self.buffers.clear();
        } else if !self.unflagged {
            self.buffers.status.fill(0);
        }
        self.unflagged = whole;
        for_each_index(&tile.extent, self.plan.tau_axis, |inside| {
            let at: usize = inside.iter().zip(&self.strides).map(|(i, s)| i * s).sum();
            match self.lines.groups(&tile.offset, inside) {
                Ok((groups, time_unit)) => self.fill_line(groups, time_unit, at),
                Err(_) => self.refuse_line(at),
            }
        });
    }

    /// Computes the cells of a line into the buffers from place `at` on.
    #[inline]
    fn fill_line(&mut self, groups: Groups, time_unit: f64, at: usize) {
        let mut crossings = Crossings::of(groups);
        // Dimensionless sweeps, the most common ones, need no scaling.
        if time_unit != 1.0 {
            crossings = crossings.in_physical_time(time_unit);
        }
        match self.stride {
            1 => self.fill_in_place(&crossings, at),
            stride => self.fill_by_row(&crossings, at, stride),
        }
    }

    fn fill_in_place(&mut self, crossings: &Crossings, at: usize) {
        let delays = &self.delays;
        let to = at + delays.values().len();
        let tolerance = self.plan.spec.tolerance;
        let status = &mut self.buffers.status[at..to];
        let n = match &mut self.buffers.n_unstable {
            Some(n) => &mut n[at..to],
            None => &mut self.row.n_unstable[..to - at],
        };
        if !self.unflagged {
            status.fill(0);
        }
        let flagged = crossings.fill_counts(delays, tolerance, n, status);
        self.unflagged &= !flagged;
        if let Some(margin) = &mut self.buffers.delay_margin {
            crossings.fill_delay_margins(delays, &mut margin[at..to]);
        }
    }

    fn fill_by_row(&mut self, crossings: &Crossings, at: usize, stride: usize) {
        let delays = &self.delays;
        let len = delays.values().len();
        let row = &mut self.row;
        let tolerance = self.plan.spec.tolerance;
        let (n, status) = (&mut row.n_unstable[..len], &mut row.status[..len]);
        status.fill(0);
        let flagged = crossings.fill_counts(delays, tolerance, n, status);
        if flagged || !self.unflagged {
            scatter(status, &mut self.buffers.status[at..], stride);
        }
        self.unflagged &= !flagged;
        if let Some(out) = &mut self.buffers.n_unstable {
            scatter(n, &mut out[at..], stride);
        }
        if let Some(out) = &mut self.buffers.delay_margin {
            crossings.fill_delay_margins(delays, &mut row.delay_margin[..len]);
            scatter(&row.delay_margin[..len], &mut out[at..], stride);
        }
    }

    /// A line outside the model's range: its cells keep fill values and say that nothing converged there.
    fn refuse_line(&mut self, at: usize) {
        let len = self.delays.values().len();
        self.unflagged = false;
        for place in (at..).step_by(self.stride).take(len) {
            self.buffers.status[place] = NOT_CONVERGED;
            if let Some(n) = &mut self.buffers.n_unstable {
                n[place] = N_UNSTABLE_FILL;
            }
            if let Some(margin) = &mut self.buffers.delay_margin {
                margin[place] = f64::NAN;
            }
        }
    }
}

fn scatter<T: Copy>(row: &[T], out: &mut [T], stride: usize) {
    for (value, place) in row.iter().zip(out.iter_mut().step_by(stride)) {
        *place = *value;
    }
}
