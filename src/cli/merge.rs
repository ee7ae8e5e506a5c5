//! `slipmap merge`: assembles the map of shards that were computed separately.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::maps::assembly::{Assembled, Missing};
use crate::maps::maker::{self, Merge};
use crate::report::log::Log;
use crate::report::numbers::{bytes, counted, grouped};
use crate::report::picture::Named;
use crate::report::progress::{Both, Progress};
use crate::store::StoreError;
use crate::store::tiles::done::ShardDone;
use crate::store::tiles::{GrowingMap, Survey, shards};
use crate::sweep::events::Attended;
use crate::sweep::{Plan, Shard};

use super::failure::Failure;
use super::output::{check_name, provenance, tell_assembled, tell_no_boundaries};
use super::show::{nothing_to_do, show};
use super::signals::Signals;
use super::{open_files, run, say};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The map that `run --shard` was given, or would have been by default
    #[arg(value_name = "MAP.h5")]
    map: PathBuf,
    /// Folders of shards, where they were computed elsewhere; these stay [default: all in
    /// MAP.h5.tiles]
    #[arg(value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// Write the map here instead
    #[arg(short, long, value_name = "MAP.h5")]
    output: Option<PathBuf>,
    /// Merge the available pieces: missing cells get fill values, and the shards stay
    #[arg(long)]
    partial: bool,
    /// Replace a map that is already there
    #[arg(long)]
    fresh: bool,
}

/// How long another process is waited for that merges the same shards.
const FOR_OTHERS: Duration = Duration::from_millis(200);

/// Shards are merged without their sweep file.
const NAMED: Named = Named::InMap;

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let (flag, target) = match &args.output {
        Some(output) => ("--output ", output),
        None => ("", &args.map),
    };
    check_name(flag, target, "map")?;
    if shards::settle(&args.map, |hash| maker::is_complete(target, Some(hash)))? {
        return nothing_to_do(target, "", NAMED, &signals);
    }
    let folders = folders(args)?;
    if folders.is_empty() {
        return nothing_to_merge(args, target, &signals);
    }
    open_files::as_many_as_allowed();
    let (_, plan) = shards::plan(&folders)?;
    if let Some(remark) = run::already_there(target, &plan, args.fresh)? {
        drop(shards::remove_root(target));
        return nothing_to_do(target, &remark, NAMED, &signals);
    }
    // Folders from elsewhere belong to the user.
    let keep = args.partial || !args.folders.is_empty();
    let asked = Merge {
        folders: &folders,
        map: target,
        missing: match args.partial {
            true => Missing::Leave,
            false => Missing::Refuse,
        },
        replace_complete: args.fresh,
        remove_beside: (!keep).then_some(&*args.map),
    };
    let assembled = assembled(&plan, &asked, &args.map, &signals);
    let assembled = assembled.map_err(|error| failure(error, &args.map, &signals))?;
    tell(target, &plan, &assembled)?;
    show(target, NAMED, &signals);
    Ok(())
}

/// Assembles a map from its shards; progress is shown and logged.
fn assembled(
    plan: &Plan,
    asked: &Merge,
    named: &Path,
    signals: &Signals,
) -> Result<Assembled, StoreError> {
    let (progress, log) = (
        Progress::new(say::is_quiet()),
        Log::beside(asked.map, Shard::WHOLE),
    );
    let observer = Both(&progress, &log);
    let attended = Attended {
        observer: &observer,
        stop: &signals.stop,
    };
    maker::merge(plan, asked, &provenance("merge", named), attended)
}

/// After a shard: merges all `of` shards of a map if none is missing. Of several processes that
/// find so at a time, one merges and the others wait for it.
pub(super) fn after_shard(
    plan: &Plan,
    map: &Path,
    of: u64,
    signals: &Signals,
) -> Result<(), Failure> {
    open_files::as_many_as_allowed();
    let is_complete = || maker::is_complete(map, Some(&plan.hash()));
    while !is_complete()? {
        match merged(plan, map, of, signals) {
            Ok(assembled) => {
                tell(map, plan, &assembled)?;
                show(map, plan.spec.picture.into(), signals);
                return Ok(());
            }
            // Another process merges them, or is still looking whether it should.
            Err(Unmerged::Store(StoreError::Locked { .. })) => std::thread::sleep(FOR_OTHERS),
            // Another process has merged them meanwhile, and removes them.
            Err(_) if is_complete()? => {}
            Err(Unmerged::Waits { missing }) => {
                let missing = counted(missing, "shard");
                let map = map.display();
                return say::result(format_args!("{map}: {missing} of {of} not complete yet"));
            }
            Err(Unmerged::Store(error)) => return Err(failure(error, map, signals)),
        }
        if signals.stop.load(std::sync::atomic::Ordering::Relaxed) {
            return Err(failure(StoreError::Stopped, map, signals));
        }
    }
    nothing_to_do(map, "", plan.spec.picture.into(), signals)
}

/// Why the shards of a map were not merged.
enum Unmerged {
    /// So many of them are not complete.
    Waits {
        missing: u64,
    },
    Store(StoreError),
}

impl From<StoreError> for Unmerged {
    fn from(error: StoreError) -> Self {
        Self::Store(error)
    }
}

/// Merges the `of` shards of a map if all are complete, and removes them.
fn merged(plan: &Plan, map: &Path, of: u64, signals: &Signals) -> Result<Assembled, Unmerged> {
    let missing = missing_of(map, of)?;
    if missing > 0 {
        return Err(Unmerged::Waits { missing });
    }
    let present = shards::present(map)?;
    let folders: Vec<PathBuf> = present.into_iter().map(|(_, path)| path).collect();
    let asked = Merge {
        folders: &folders,
        map,
        missing: Missing::Refuse,
        replace_complete: false,
        remove_beside: Some(map),
    };
    Ok(assembled(plan, &asked, map, signals)?)
}

/// How many of the `of` shards of a map are not complete.
fn missing_of(map: &Path, of: u64) -> Result<u64, StoreError> {
    let Some(tiles) = GrowingMap::of(map)? else {
        return Ok(of);
    };
    let shards = tiles.shards();
    let complete = shards
        .iter()
        .filter(|s| s.shard.numbers().1 == of && s.pieces_done == s.pieces);
    Ok(of.saturating_sub(complete.count() as u64))
}

fn folders(args: &Args) -> Result<Vec<PathBuf>, Failure> {
    if !args.folders.is_empty() {
        let mut folders = Vec::new();
        for folder in &args.folders {
            let same = |other: &PathBuf| other.canonicalize().ok() == folder.canonicalize().ok();
            if !folders.iter().any(same) {
                folders.push(folder.clone());
            }
        }
        return Ok(folders);
    }
    let present = shards::present(&args.map)?;
    Ok(present.into_iter().map(|(_, path)| path).collect())
}

/// An error, unless the shards are gone because their map is complete. A merge that is run again
/// then has nothing to do, even with --fresh.
fn nothing_to_merge(args: &Args, target: &Path, signals: &Signals) -> Result<(), Failure> {
    if maker::is_complete(target, None)? {
        drop(shards::remove_root(&args.map));
        let remark = match args.fresh {
            true => "; there are no shards that could replace it",
            false => "",
        };
        return nothing_to_do(target, remark, NAMED, signals);
    }
    Err(Failure::bad_input_with_help(
        format!(
            "there are no shards in {}",
            shards::root(&args.map).display()
        ),
        "`slipmap run SWEEP.toml -o MAP.h5 --shard I/N` computes one; folders from elsewhere are \
        named after MAP.h5",
    ))
}

fn tell(target: &Path, plan: &Plan, assembled: &Assembled) -> Result<(), Failure> {
    tell_assembled(assembled);
    tell_no_boundaries(plan);
    let size = bytes(std::fs::metadata(target).map_or(0, |m| m.len()));
    let cells = grouped(plan.cells());
    let missing = match assembled.cells_missing {
        0 => String::new(),
        missing => format!(", {} of them missing", grouped(missing)),
    };
    say::result(format_args!(
        "{}: {cells} cells{missing}, {size}",
        target.display()
    ))
}

fn failure(error: StoreError, map: &Path, signals: &Signals) -> Failure {
    match error {
        StoreError::Incomplete { .. } => {}
        StoreError::Stopped => {
            return signals
                .interrupted("no map is written, the shards stay; the same command goes on");
        }
        StoreError::WouldLose { .. } => {
            let help = "--fresh replaces it all the same; -o writes elsewhere";
            return Failure::bad_input_with_help(error.to_string(), help);
        }
        _ => return error.into(),
    }
    let mut unfinished = Vec::new();
    if let Ok(Some(survey)) = Survey::of(map) {
        let shards: Vec<&ShardDone> = survey.shards.iter().map(|s| &s.done).collect();
        let short = shards.iter().filter(|s| s.pieces_done < s.pieces);
        unfinished.extend(short.map(|s| s.shard.to_string()));
        for of in shards.iter().map(|s| s.shard.numbers().1).take(1) {
            let there = |n: &u64| shards.iter().any(|s| s.shard.numbers() == (*n, of));
            let absent = (1..=of).filter(|n| !there(n));
            unfinished.extend(absent.map(|number| format!("{number}/{of}")));
        }
    }
    let help = match unfinished.is_empty() {
        true => "run the shards that are missing; --partial puts together what there is".to_owned(),
        false => format!(
            "run these shards again: {}; --partial puts together what there is",
            unfinished.join(", ")
        ),
    };
    Failure::failed_with_help(error.to_string(), help)
}
