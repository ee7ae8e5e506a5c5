//! `slipmap run`: from a sweep file to a map and its picture, or to one shard of the map.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use crate::maps::maker::{self, Job};
use crate::queue::note::take_back_try;
use crate::report::log::Log;
use crate::report::numbers::{bytes, grouped, prefixed, seconds};
use crate::report::progress::{Both, Progress};
use crate::store::tiles::{Manifest, shards};
use crate::store::{MapFile, StoreError};
use crate::sweep::described::schema::root;
use crate::sweep::events::Attended;
use crate::sweep::{Memory, Plan, RunError, Shard};

use super::failure::Failure;
use super::memory::{self, Allowed, useful};
use super::merge;
use super::output::{self, output_path, provenance, warn_beyond_curve, warn_of_idle_delay};
use super::say;
use super::show::{nothing_to_do, show};
use super::signals::Signals;
use super::sweep_file::read_plan;

/// The most threads; more are taken for a typing error.
const MOST_THREADS: usize = 4096;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The sweep file; - for standard input
    #[arg(value_name = "SWEEP.toml")]
    sweep: PathBuf,
    /// The map to write [default: the sweep file's name with .h5, in the current folder]
    #[arg(short, long, value_name = "MAP.h5")]
    output: Option<PathBuf>,
    /// Threads to compute on [default: as many as the machine offers]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    /// Compute only every N-th piece, from the I-th on; `slipmap merge` puts the shards together
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// After this shard, merge all of them if none is missing
    #[arg(long, requires = "shard")]
    and_merge: bool,
    /// The most memory to take, such as 500MB or 2GiB: fewer threads are used if they would take
    /// more [default: half of what is free, at least 500MB]
    #[arg(long, value_name = "SIZE", value_parser = memory::parse)]
    memory: Option<u64>,
    /// Start over, replacing a map that is already there and dropping what an earlier run, or this
    /// shard, computed
    #[arg(long)]
    fresh: bool,
    /// Seconds between two saves of computed pieces
    #[arg(long, value_name = "SECONDS", default_value = "2", value_parser = parse_seconds)]
    save_every: Duration,
    /// The lock of a job: the run is one of a worker, and ends with it
    #[arg(long, value_name = "LOCK", hide = true)]
    job_lock: Option<PathBuf>,
}

/// Reads the number of a `--threads` flag.
pub(super) fn parse_threads(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|n| (1..=MOST_THREADS).contains(n))
        .ok_or_else(|| format!("expected a whole number from 1 to {MOST_THREADS}"))
}

/// Reads the seconds of a `--save-every` flag.
pub(super) fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds = text
        .parse::<f64>()
        .ok()
        .filter(|s| (0.0..=3600.0).contains(s));
    seconds
        .map(Duration::from_secs_f64)
        .ok_or_else(|| "expected a number of seconds from 0 to 3600".to_owned())
}

/// The number of threads that the machine offers to this process.
pub(super) fn default_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let Some(lock) = &args.job_lock else {
        return compute(args, &signals);
    };
    signals.stop_at_end_of_input()?;
    let ended = compute(args, &signals);
    if let Err(Failure::Interrupted { .. }) = &ended {
        take_back_try(lock);
    }
    ended
}

fn compute(args: &Args, signals: &Signals) -> Result<(), Failure> {
    let plan = read_plan(&args.sweep)?;
    let path = output_path(args.output.as_deref(), &args.sweep, "map")?;
    warn_of_idle_delay(plan.spec.has_idle_delay());
    warn_beyond_curve(plan.spec.curve_remark());
    shards::settle(&path, |hash| maker::is_complete(&path, Some(hash)))?;
    if let Some(remark) = already_there(&path, &plan, args.fresh)? {
        drop(shards::remove_root(&path));
        return nothing_to_do(&path, &remark, plan.spec.picture.into(), signals);
    }
    match args.shard.filter(|_| args.fresh) {
        Some(shard) => shards::clear_shard(&path, shard)?,
        None if args.fresh => shards::clear(&path)?,
        None => {}
    }
    let asked = args.threads.unwrap_or_else(default_threads);
    let allowed = Allowed::of(args.memory, 1);
    let threads = allowed.threads(&plan, asked)?;
    if threads < useful(&plan, asked) {
        let (one, told) = (bytes(Memory::of(&plan).per_thread), allowed.told());
        say::note(format_args!(
            "{threads} of {asked} threads: each may take {one}, and {told}"
        ));
    }
    let progress = Progress::new(say::is_quiet());
    let log = Log::beside(&path, args.shard.unwrap_or(Shard::WHOLE));
    let observers = Both(&progress, &log);
    let provenance = provenance("run", &args.sweep);
    let job = Job {
        save_every: args.save_every,
        ..Job::new(&path, threads, &provenance)
    };
    let plan = Arc::new(plan);
    let watched = Watched {
        observers: &observers,
        signals,
    };
    match args.shard.filter(|shard| !shard.is_whole()) {
        Some(shard) => run_shard(&plan, &job, shard, &watched, args),
        None => run_whole(&plan, &job, &watched, args),
    }
}

/// The observers of a run, and the signals that end it.
struct Watched<'a> {
    observers: &'a Both<'a>,
    signals: &'a Signals,
}

impl Watched<'_> {
    fn attended(&self) -> Attended<'_> {
        Attended {
            observer: self.observers,
            stop: &self.signals.stop,
        }
    }
}

fn run_shard(
    plan: &Arc<Plan>,
    job: &Job,
    shard: Shard,
    watched: &Watched,
    args: &Args,
) -> Result<(), Failure> {
    refuse_other_way(job.map, shard)?;
    let made = maker::make_shard(plan, job, shard, watched.attended());
    made.map_err(|error| failure(error, job.map, args.fresh, watched))?;
    let (number, of) = shard.numbers();
    if args.and_merge {
        return merge::after_shard(plan, job.map, of, watched.signals);
    }
    let map = job.map.display();
    say::result(format_args!(
        "shard {number} of {of} is complete; when all are, `slipmap merge {map}` makes the map"
    ))
}

fn run_whole(plan: &Arc<Plan>, job: &Job, watched: &Watched, args: &Args) -> Result<(), Failure> {
    refuse_other_way(job.map, Shard::WHOLE)?;
    let made = maker::make(plan, job, watched.attended());
    let assembled = made.map_err(|error| failure(error, job.map, args.fresh, watched))?;
    let observers = watched.observers;
    let (elapsed, cells) = (observers.0.elapsed(), observers.0.computed());
    output::tell_assembled(&assembled);
    output::tell_no_boundaries(plan);
    let path = job.map;
    let told = say::result(format_args!(
        "{}: {} cells in {} ({} cells/s), {}",
        path.display(),
        grouped(cells),
        seconds(elapsed),
        prefixed(cells as f64 / elapsed),
        bytes(std::fs::metadata(path).map_or(0, |m| m.len())),
    ));
    show(path, plan.spec.picture.into(), watched.signals);
    told
}

/// A map is computed either as a whole or in shards. Refuses to start one way if the other has
/// already computed something.
fn refuse_other_way(map: &Path, asked: Shard) -> Result<(), Failure> {
    let others = shards::present(map)?;
    let is_other = |shard: &Shard| shard.is_whole() != asked.is_whole();
    let Some((shard, _)) = others.iter().find(|(shard, _)| is_other(shard)) else {
        return Ok(());
    };
    let (what, help) = match asked.is_whole() {
        true => (
            format!("shards of this map ({shard})"),
            "`slipmap merge` puts them together; --fresh drops them and starts over",
        ),
        false => (
            "what a run of the whole map has computed".to_owned(),
            "the same command without --shard goes on with it; `--fresh` without --shard drops it; \
             -o writes elsewhere",
        ),
    };
    let root = shards::root(map);
    let message = format!("{} holds {what}", root.display());
    Err(Failure::bad_input_with_help(message, help))
}

/// A remark if the map of this plan exists and `fresh` is not set; an error if the existing file
/// must not be replaced.
///
/// `fresh` replaces only maps: with another file of this name, the user has more likely made a
/// mistake.
pub(super) fn already_there(
    path: &Path,
    plan: &Plan,
    fresh: bool,
) -> Result<Option<String>, Failure> {
    if !path.exists() {
        return Ok(None);
    }
    match MapFile::open(path) {
        Ok(_) if fresh => Ok(None),
        // It is being computed again, by an earlier run with --fresh.
        Ok(_) if has_tiles_of(path, plan) => Ok(None),
        Ok(map) if map.root_text(root::PLAN_HASH).as_deref() == Some(&plan.hash()) => {
            // A partial map is replaced by the complete one.
            Ok((!map.is_partial()).then(|| what_differs(&map, plan)))
        }
        Ok(_) => Err(Failure::bad_input_with_help(
            format!(
                "{} is already there: the map of another sweep",
                path.display()
            ),
            "--fresh replaces it; -o writes elsewhere",
        )),
        Err(StoreError::NotAMap { why, .. }) => Err(Failure::bad_input_with_help(
            format!(
                "{} is already there and no map of slipmap: {why}",
                path.display()
            ),
            "it is left as it is; remove it first, or write elsewhere with -o",
        )),
        Err(error @ (StoreError::DamagedFile { .. } | StoreError::DamagedMap { .. })) => {
            Err(Failure::failed_with_help(
                error.to_string(),
                "it is left as it is; remove it first, or write elsewhere with -o",
            ))
        }
        Err(error) => Err(error.into()),
    }
}

/// Whether tiles of this plan stand beside the map.
fn has_tiles_of(path: &Path, plan: &Plan) -> bool {
    let asked = Manifest::of(plan, Shard::WHOLE, &provenance("run", path));
    shards::hold(path, &asked)
}

/// How a complete map of the same cells would change with `--fresh`.
fn what_differs(map: &MapFile, plan: &Plan) -> String {
    let version = map.root_text(root::PROGRAM_VERSION).unwrap_or_default();
    if version != crate::VERSION {
        format!(", computed by slipmap {version}; --fresh computes it again")
    } else if map.root_text(root::SWEEP).as_deref() != Some(&plan.spec.text) {
        ", with the same cells; the sweep file has changed otherwise: --fresh takes that over"
            .into()
    } else {
        "; --fresh computes it again".into()
    }
}

fn failure(error: RunError<StoreError>, path: &Path, fresh: bool, watched: &Watched) -> Failure {
    let &Watched { observers, signals } = watched;
    observers.0.clear();
    observers.1.ended(&error.to_string());
    let nothing = shards::present(path).unwrap_or_default().is_empty();
    let kept = match fresh {
        _ if nothing => "nothing was computed yet",
        true => "what is computed is kept, the same command without --fresh goes on from there",
        false => "what is computed is kept, the same command goes on from there",
    };
    match error {
        RunError::Interrupted => {
            signals.interrupted(format_args!("{} is not complete; {kept}", path.display()))
        }
        RunError::Sink(error @ (StoreError::Io { .. } | StoreError::Hdf5 { .. })) => {
            Failure::failed_with_help(error.to_string(), kept)
        }
        RunError::Sink(error) => error.into(),
        RunError::Model(error) => error.into(),
        error @ (RunError::Needs(_)
        | RunError::Memory { .. }
        | RunError::Threads { .. }
        | RunError::ThreadLost) => Failure::failed(error.to_string()),
    }
}
