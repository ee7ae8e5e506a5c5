//! From a plan to its map: computes the pieces that are not on disk yet, then assembles the map.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use super::assembly::{Assembled, Missing, assemble};
use crate::store::StoreError;
use crate::store::map_file::MapFile;
use crate::store::output::Output;
use crate::store::source::InMemory;
use crate::store::tiles::folder::BETWEEN_FILES;
use crate::store::tiles::shards::{self, Shards};
use crate::store::tiles::{Damaged, Manifest, TileFolder};
use crate::sweep::described::root::Provenance;
use crate::sweep::described::schema::root;
use crate::sweep::events::{Attended, Event, Observer};
use crate::sweep::plan::Plan;
use crate::sweep::plan::pieces::{Order, Piece, Shard, Todo};
use crate::sweep::{RunError, engine};

/// The options of a run.
#[derive(Debug, Clone)]
pub struct Job<'a> {
    /// The map's name.
    pub map: &'a Path,
    /// Number of computing threads.
    pub threads: usize,
    /// The order of the pieces.
    pub order: Order,
    /// The time between two saves of computed pieces.
    pub save_every: Duration,
    /// Who makes the map.
    pub provenance: &'a Provenance,
}

impl<'a> Job<'a> {
    /// The defaults, on `threads` threads.
    #[must_use]
    pub fn new(map: &'a Path, threads: usize, provenance: &'a Provenance) -> Self {
        Self {
            map,
            threads,
            order: Order::Forward,
            save_every: BETWEEN_FILES,
            provenance,
        }
    }
}

/// How often damage that is found only while a map is assembled is repaired.
const MOST_REPAIRS: u32 = 3;

/// Computes the pieces that the tiles beside the map lack, assembles the map, and removes the
/// tiles.
///
/// # Errors
/// See [`RunError`] and [`StoreError`]. Finished tiles stay, so that the next call continues from
/// there.
pub fn make(
    plan: &Arc<Plan>,
    job: &Job,
    attended: Attended,
) -> Result<Assembled, RunError<StoreError>> {
    let mut output = Output::claim(job.map).map_err(RunError::Sink)?;
    let mut folder = claimed(plan, job, Shard::WHOLE, attended)?;
    let mut repairs = 0;
    loop {
        compute(plan, job, Shard::WHOLE, &mut folder, attended)?;
        let (missing, stop) = (Missing::Refuse, attended.stop);
        match assemble(plan, output, job.provenance, &mut folder, missing, stop) {
            Ok(assembled) => {
                folder
                    .remove()
                    .and_then(|()| shards::remove_root(job.map))
                    .map_err(RunError::Sink)?;
                return Ok(assembled);
            }
            Err(StoreError::Damaged { .. } | StoreError::Incomplete { .. })
                if repairs < MOST_REPAIRS =>
            {
                repairs += 1;
                tell(
                    &folder.scan(attended.stop).map_err(ended)?,
                    attended.observer,
                );
                output = Output::claim(job.map).map_err(RunError::Sink)?;
            }
            Err(error) => return Err(ended(error)),
        }
    }
}

/// Computes the pieces that the tiles of one shard lack.
///
/// # Errors
/// As [`make`].
pub fn make_shard(
    plan: &Arc<Plan>,
    job: &Job,
    shard: Shard,
    attended: Attended,
) -> Result<(), RunError<StoreError>> {
    let mut folder = claimed(plan, job, shard, attended)?;
    compute(plan, job, shard, &mut folder, attended)
}

/// The options of a merge.
#[derive(Debug, Clone, Copy)]
pub struct Merge<'a> {
    /// The folders of shards.
    pub folders: &'a [PathBuf],
    /// The map to write.
    pub map: &'a Path,
    /// What to do when pieces are missing.
    pub missing: Missing,
    /// Whether a complete map may be replaced by one that lacks pieces.
    pub replace_complete: bool,
    /// The map beside which the folders are, if they are to be removed after a complete map is
    /// written.
    pub remove_beside: Option<&'a Path>,
}

/// Assembles a map from the folders of its shards.
///
/// # Errors
/// When it is stopped, a piece is missing and that is refused, folders do not belong together, or
/// the system refuses.
pub fn merge(
    plan: &Plan,
    asked: &Merge,
    provenance: &Provenance,
    attended: Attended,
) -> Result<Assembled, StoreError> {
    let &Merge {
        folders,
        map,
        missing,
        ..
    } = asked;
    let output = Output::claim(map)?;
    let expected = Manifest::of(plan, Shard::WHOLE, provenance);
    let (mut source, damaged) = Shards::claim(folders, &expected, plan.pieces(), attended.stop)?;
    tell(&damaged, attended.observer);
    let lacking = source.missing(plan.pieces().total());
    if lacking > 0
        && missing == Missing::Leave
        && !asked.replace_complete
        && is_complete(map, None)?
    {
        return Err(StoreError::WouldLose {
            path: map.to_owned(),
            pieces: lacking,
        });
    }
    let assembled = assemble(
        plan,
        output,
        provenance,
        &mut source,
        missing,
        attended.stop,
    )?;
    if let Some(beside) = asked
        .remove_beside
        .filter(|_| assembled.pieces_missing == 0)
    {
        shards::mark_merged(beside, &plan.hash())?;
        source.remove()?;
        shards::remove_root(beside)?;
    }
    Ok(assembled)
}

/// Whether a complete map is at `path`; with a hash, the map of that plan.
///
/// # Errors
/// When the file there cannot be read as a map: it might still be one.
pub(crate) fn is_complete(path: &Path, plan_hash: Option<&str>) -> Result<bool, StoreError> {
    if !path.exists() {
        return Ok(false);
    }
    let map = MapFile::open(path)?;
    let of_plan = plan_hash.is_none_or(|hash| {
        // Earlier programs wrote an empty mark.
        hash.is_empty() || map.root_text(root::PLAN_HASH).as_deref() == Some(hash)
    });
    Ok(of_plan && !map.is_partial())
}

/// Computes a small map without leaving anything beside it.
///
/// # Errors
/// As [`make`].
pub fn make_in_memory(
    plan: &Arc<Plan>,
    map: &Path,
    threads: usize,
    provenance: &Provenance,
) -> Result<Assembled, RunError<StoreError>> {
    let output = Output::claim(map).map_err(RunError::Sink)?;
    let mut pieces = InMemory::default();
    let stop = Arc::new(AtomicBool::new(false));
    engine::run(
        plan,
        Todo::all(plan.pieces()),
        threads,
        &mut pieces,
        Attended::silently(&stop),
    )?;
    let missing = Missing::Refuse;
    assemble(plan, output, provenance, &mut pieces, missing, &stop).map_err(RunError::Sink)
}

fn claimed(
    plan: &Plan,
    job: &Job,
    shard: Shard,
    attended: Attended,
) -> Result<TileFolder, RunError<StoreError>> {
    let manifest = Manifest::of(plan, shard, job.provenance);
    shards::make_root(job.map).map_err(ended)?;
    let path = shards::folder_of(job.map, shard);
    let claimed = TileFolder::claim(&path, &manifest, plan.pieces(), attended.stop);
    let (mut folder, damaged) = claimed.map_err(ended)?;
    folder.save_every(job.save_every);
    tell(&damaged, attended.observer);
    Ok(folder)
}

fn compute(
    plan: &Arc<Plan>,
    job: &Job,
    shard: Shard,
    folder: &mut TileFolder,
    attended: Attended,
) -> Result<(), RunError<StoreError>> {
    let mut todo = Todo::new(plan.pieces(), shard, job.order);
    let done: Vec<Piece> = folder.done().collect();
    for piece in done {
        todo.mark_done(piece);
    }
    engine::run(plan, todo, job.threads, folder, attended)
}

/// The error of a run that ended by an error of the store, or by a stop while files were read or
/// written.
fn ended(error: StoreError) -> RunError<StoreError> {
    match error {
        StoreError::Stopped => RunError::Interrupted,
        error => RunError::Sink(error),
    }
}

fn tell(damaged: &[Damaged], observer: &dyn Observer) {
    for broken in damaged {
        observer.event(&Event::Damaged {
            file: broken.file.clone(),
            why: broken.why.clone(),
        });
    }
}
