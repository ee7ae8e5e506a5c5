//! The sweep engine: computes the pieces of a sweep on several threads and gives them to a sink.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, channel, sync_channel};
use std::time::{Duration, Instant};

use rayon::iter::{
    IndexedParallelIterator, IntoParallelIterator, IntoParallelRefIterator, ParallelIterator,
};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::cells::boundaries::{plane, trace_plane};
pub use super::cells::buffers::{Column, FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL, TileBuffers};
pub use super::cells::worker::Worker;
use super::events::{Attended, Event, Observer};
use super::plan::Plan;
use super::plan::pieces::{Piece, Todo};
pub use super::sink::{Computed, Encode, Sink};
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::slip::case::CaseError;
use crate::sweep::cells::best_planes::{best_of_plane, best_plane};
use crate::text::SpecError;

/// Pieces that may wait for the sink, per thread.
const PIECES_WAITING: usize = 2;
/// How often the sink's `pause` is called while no piece comes.
const PAUSE: Duration = Duration::from_millis(200);
/// How long pieces in progress may take after a stop; later ones are dropped.
const GRACE: Duration = Duration::from_millis(1200);

/// Why a sweep ended before its last piece.
#[derive(Debug, thiserror::Error)]
pub enum RunError<E> {
    /// The sweep was asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The sink could not write.
    #[error(transparent)]
    Sink(E),
    /// A parameter is outside the model's range.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A field, or a motion, lacks what it needs of its setting.
    #[error(transparent)]
    Needs(#[from] SpecError),
    /// The cells of the sweep do not fit into memory.
    #[error("{cells} cells of {bytes} bytes each do not fit into memory")]
    Memory {
        /// How many cells there are.
        cells: u64,
        /// How many bytes each of them takes.
        bytes: u64,
    },
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// How many threads were asked for.
        threads: usize,
        /// What the system said.
        reason: String,
    },
    /// A thread ended before its work was done, which is a fault of the program.
    #[error("a computing thread ended early; this is a fault of slipmap")]
    ThreadLost,
}

impl<E> From<CaseError> for RunError<E> {
    fn from(error: CaseError) -> Self {
        match error {
            CaseError::Model(error) => Self::Model(error),
            CaseError::NoCycle(_)
            | CaseError::BesideReturnMap { .. }
            | CaseError::SampleTime { .. }
            | CaseError::NoRecursion(_) => Self::Needs(SpecError::whole(error.to_string())),
        }
    }
}

/// Computes the pieces of `plan` that `todo` lists on `threads` threads and gives them to `sink`.
/// After `stop` is set it ends within 1.2 s: pieces that take longer are dropped.
///
/// The contents of a piece depend on the plan alone.
///
/// # Errors
/// See [`RunError`]. The pieces that the sink has written are flushed even then, if possible.
pub fn run<S: Sink>(
    plan: &Arc<Plan>,
    todo: Todo,
    threads: usize,
    sink: &mut S,
    attended: Attended,
) -> Result<(), RunError<S::Error>> {
    let on = match cfg!(target_family = "wasm") {
        true => On::This,
        false => On::Threads(threads),
    };
    conduct(plan, todo, on, sink, attended)
}

/// Computes the pieces of `plan` that `todo` lists on this thread and gives them to `sink`. `stop`
/// is checked between pieces and, where cells take long, between cells.
///
/// # Errors
/// See [`RunError`].
pub(crate) fn run_here<S: Sink>(
    plan: &Arc<Plan>,
    todo: Todo,
    sink: &mut S,
    attended: Attended,
) -> Result<(), RunError<S::Error>> {
    conduct(plan, todo, On::This, sink, attended)
}

/// Where pieces are computed.
#[derive(Clone, Copy)]
enum On {
    /// The calling thread computes the pieces.
    This,
    /// This many other threads compute the pieces.
    Threads(usize),
}

fn conduct<S: Sink>(
    plan: &Arc<Plan>,
    todo: Todo,
    on: On,
    sink: &mut S,
    attended: Attended,
) -> Result<(), RunError<S::Error>> {
    let Attended { observer, stop } = attended;
    let left = todo.left().fold((0, 0), |(pieces, cells), piece| {
        (pieces + 1, cells + plan.cells_of(piece))
    });
    observer.event(&Event::Started {
        cells: plan.cells(),
        left: left.1,
        threads: match on {
            On::This => 1,
            On::Threads(threads) => threads,
        },
    });
    let received = match on {
        _ if left.0 == 0 => Ok(0),
        On::This => here(plan, &todo, sink, attended),
        On::Threads(threads) => {
            let receiver = start(plan, todo, threads, sink, stop)?;
            receive(plan, &receiver, sink, observer, stop)
        }
    };
    let flushed = sink.flush().map_err(RunError::Sink);
    if received? < left.0 {
        let stopped = stop.load(Ordering::Relaxed);
        flushed?;
        return Err(match stopped {
            true => RunError::Interrupted,
            false => RunError::ThreadLost,
        });
    }
    flushed?;
    observer.event(&Event::Finished);
    Ok(())
}

/// Items that a thread takes at a time.
const TOGETHER: usize = 16;

/// Does `work` on each of `items`, on `threads` threads, and returns the results in order. Each
/// thread has a memory made by `begin`; no result may depend on it.
///
/// # Errors
/// When the threads cannot be started.
pub fn each<I: Send, M, T: Send>(
    items: Vec<I>,
    threads: usize,
    begin: impl Fn() -> M + Sync + Send,
    work: impl Fn(&mut M, I) -> T + Sync + Send,
) -> Result<Vec<T>, RunError<Infallible>> {
    if cfg!(target_family = "wasm") {
        let mut memory = begin();
        return Ok(items.into_iter().map(|i| work(&mut memory, i)).collect());
    }
    let pool = pool(ThreadPoolBuilder::new(), threads)?;
    let items = items.into_par_iter().with_min_len(TOGETHER);
    Ok(pool.install(|| items.map_init(begin, work).collect()))
}

/// Does `work` on each of `items`, on `threads` threads or on this one where `threads` is at most
/// 1, and returns the results in order. The observer is told the number of `cells` of an item. Work
/// that a stop cuts short has no result.
///
/// # Errors
/// When it is stopped, or the threads cannot be started.
pub(crate) fn each_attended<I: Sync, T: Send>(
    items: &[I],
    threads: usize,
    attended: Attended,
    cells: impl Fn(&I) -> u64 + Sync,
    work: impl Fn(&I, &Stop) -> Option<T> + Sync,
) -> Result<Vec<T>, RunError<Infallible>> {
    let Attended { observer, stop } = attended;
    let all = items.iter().map(&cells).sum();
    observer.event(&Event::Started {
        cells: all,
        left: all,
        threads: threads.max(1),
    });
    let stop = Stop::when(stop);
    let one = |item: &I, done: &dyn Fn(u64)| {
        let result = (!stop.is_set()).then(|| work(item, &stop)).flatten()?;
        done(cells(item));
        Some(result)
    };
    let done = |cells| observer.event(&Event::PieceDone { cells });
    let results: Option<Vec<T>> = if threads <= 1 || cfg!(target_family = "wasm") {
        items.iter().map(|item| one(item, &done)).collect()
    } else {
        let pool = pool(ThreadPoolBuilder::new(), threads)?;
        let (sender, receiver) = channel();
        let mut results = None;
        pool.in_place_scope(|scope| {
            let (results, one) = (&mut results, &one);
            scope.spawn(move |_| {
                // The receiver stays until all is sent.
                let send = |cells| sender.send(cells).unwrap_or_default();
                *results = items.par_iter().map(|item| one(item, &send)).collect();
            });
            receiver.into_iter().for_each(done);
        });
        results
    };
    let results = results.ok_or(RunError::Interrupted)?;
    observer.event(&Event::Finished);
    Ok(results)
}

/// A pool of `threads` threads.
fn pool<E>(builder: ThreadPoolBuilder, threads: usize) -> Result<ThreadPool, RunError<E>> {
    let pool = builder.num_threads(threads).build();
    pool.map_err(|error| RunError::Threads {
        threads,
        reason: error.to_string(),
    })
}

/// A computed piece, encoded.
type Sent<E> = (Piece, E);
/// The channel on which pieces for a sink arrive.
type Arrivals<S> = Receiver<Sent<<<S as Sink>::Encoder as Encode>::Encoded>>;

/// Starts the threads. They own what they need, so that nobody has to wait for a thread that stops
/// slowly.
fn start<S: Sink>(
    plan: &Arc<Plan>,
    todo: Todo,
    threads: usize,
    sink: &S,
    stop: &Arc<AtomicBool>,
) -> Result<Arrivals<S>, RunError<S::Error>> {
    // A panic shows in the missing work of the thread.
    let pool = pool(ThreadPoolBuilder::new().panic_handler(|_| {}), threads)?;
    let (sender, receiver) = sync_channel(PIECES_WAITING * threads);
    let todo = Arc::new(todo);
    for _ in 0..threads {
        let (plan, todo) = (Arc::clone(plan), Arc::clone(&todo));
        let (stop, sender, encoder) = (Arc::clone(stop), sender.clone(), sink.encoder());
        pool.spawn(move || work(&plan, &todo, encoder, &sender, &stop));
    }
    Ok(receiver)
}

/// The work of one thread: it goes on until no piece is left, `stop` is set, or the receiver is
/// gone.
fn work<C: Encode>(
    plan: &Plan,
    todo: &Todo,
    mut encoder: C,
    sender: &SyncSender<Sent<C::Encoded>>,
    stop: &Arc<AtomicBool>,
) {
    let mut worker = Worker::new(plan);
    let stop = &Stop::when(stop);
    while let Some(sent) = next(plan, todo, &mut worker, &mut encoder, stop) {
        if sender.send(sent).is_err() {
            break;
        }
    }
}

/// Computes the next piece; none when no piece is left, or once `stop` has cut it short.
fn next<C: Encode>(
    plan: &Plan,
    todo: &Todo,
    worker: &mut Worker,
    encoder: &mut C,
    stop: &Stop,
) -> Option<Sent<C::Encoded>> {
    if stop.is_set() {
        return None;
    }
    let piece = todo.next()?;
    let encoded = match piece {
        Piece::Curves(n) => {
            let traced = trace_plane(plan, &plane(plan, n), stop);
            if stop.is_set() {
                return None;
            }
            encoder.encode(piece, Computed::Curves(&traced))
        }
        Piece::Best(n) => {
            let found = best_of_plane(plan, &best_plane(plan, n), stop);
            if stop.is_set() {
                return None;
            }
            encoder.encode(piece, Computed::Best(found.as_ref()))
        }
        Piece::Tile(n) => {
            if !worker.compute(&plan.tiles.tile(n as usize), stop) {
                return None;
            }
            encoder.encode(piece, Computed::Tile(&worker.buffers))
        }
    };
    Some((piece, encoded))
}

/// Computes pieces on this thread; returns how many.
fn here<S: Sink>(
    plan: &Plan,
    todo: &Todo,
    sink: &mut S,
    attended: Attended,
) -> Result<u64, RunError<S::Error>> {
    let Attended { observer, stop } = attended;
    let (mut worker, mut encoder, mut received) = (Worker::new(plan), sink.encoder(), 0);
    let stop = Stop::when(stop);
    while let Some(sent) = next(plan, todo, &mut worker, &mut encoder, &stop) {
        take(plan, sent, sink, observer)?;
        received += 1;
    }
    Ok(received)
}

/// Hands a piece to the sink.
fn take<S: Sink>(
    plan: &Plan,
    (piece, encoded): Sent<<S::Encoder as Encode>::Encoded>,
    sink: &mut S,
    observer: &dyn Observer,
) -> Result<(), RunError<S::Error>> {
    sink.write(piece, encoded).map_err(RunError::Sink)?;
    observer.event(&Event::PieceDone {
        cells: plan.cells_of(piece),
    });
    Ok(())
}

/// Gives pieces to the sink as they arrive; returns how many. After a stop, only those that arrive
/// in time.
fn receive<S: Sink>(
    plan: &Plan,
    receiver: &Arrivals<S>,
    sink: &mut S,
    observer: &dyn Observer,
    stop: &AtomicBool,
) -> Result<u64, RunError<S::Error>> {
    let mut received = 0;
    let mut stopped: Option<Instant> = None;
    loop {
        match receiver.recv_timeout(PAUSE) {
            Ok(sent) => {
                take(plan, sent, sink, observer)?;
                received += 1;
            }
            Err(RecvTimeoutError::Timeout) => sink.pause().map_err(RunError::Sink)?,
            Err(RecvTimeoutError::Disconnected) => return Ok(received),
        }
        if stop.load(Ordering::Relaxed)
            && stopped.get_or_insert_with(Instant::now).elapsed() > GRACE
        {
            return Ok(received);
        }
    }
}
