//! The folders of all shards of a map.

use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind::{NotADirectory, NotFound};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use super::super::durable::{sync_name, write_synced};
use super::super::error::StoreError;
use super::super::regular::{self, NotRead};
use super::super::source::Source;
use super::folder::{self, Belongs, TileFolder};
use super::manifest::{self, Manifest};
use super::reader::Damaged;
use crate::sweep::plan::Plan;
use crate::sweep::plan::pieces::{Piece, Pieces, Shard};

/// What the name of a map's folder of tiles has behind that of the map.
pub(crate) const ROOT_ENDING: &str = ".tiles";

/// The folder beside `map` that contains the folders of its shards.
#[must_use]
pub fn root(map: &Path) -> PathBuf {
    let mut name = map.file_name().unwrap_or_default().to_owned();
    name.push(ROOT_ENDING);
    map.with_file_name(name)
}

/// The folder of a shard of `map`.
#[must_use]
pub fn folder_of(map: &Path, shard: Shard) -> PathBuf {
    let (number, of) = shard.numbers();
    root(map).join(format!("{number}-of-{of}"))
}

/// A file in the folder of shards. It marks that the map of all shards is complete and that they
/// are being removed, and holds the hash of the plan.
const MERGED: &str = "merged";
/// The most bytes of this file.
const MOST_OF_MARK: u64 = 1024;

fn marker(map: &Path) -> PathBuf {
    root(map).join(MERGED)
}

/// Marks the map of the shards of `map` as complete, before the first shard is removed.
///
/// # Errors
/// When the system refuses.
pub(crate) fn mark_merged(map: &Path, plan_hash: &str) -> Result<(), StoreError> {
    let path = marker(map);
    if path.exists() {
        return Ok(());
    }
    write_synced(&path, |out| out.write_all(plan_hash.as_bytes()))?;
    sync_name(&path)
}

/// Continues a removal of shards that was interrupted; true if there was one. `is_complete` says
/// whether the map with a plan's hash is complete. If it is not, the map has gone since, and the
/// remaining shards count as any others.
///
/// # Errors
/// As [`clear`], and those of `is_complete`. The shards are then neither removed nor taken for half
/// a map.
pub(crate) fn settle(
    map: &Path,
    is_complete: impl FnOnce(&str) -> Result<bool, StoreError>,
) -> Result<bool, StoreError> {
    let path = marker(map);
    let hash = match regular::read(&path, MOST_OF_MARK) {
        Ok(hash) => hash,
        Err(NotRead::Refused(error)) if [NotFound, NotADirectory].contains(&error.kind()) => {
            return Ok(false);
        }
        Err(NotRead::Refused(error)) => return Err(StoreError::io("read", &path)(error)),
        Err(NotRead::Large(_) | NotRead::Foreign) => return Err(StoreError::Foreign { path }),
    };
    if is_complete(&String::from_utf8_lossy(&hash))? {
        return clear(map).map(|()| true);
    }
    let removed = fs::remove_file(&path).map_err(StoreError::io("remove", &path));
    removed.map(|()| false)
}

fn shard_of(name: &str) -> Option<Shard> {
    let (number, of) = name.split_once("-of-")?;
    format!("{number}/{of}").parse().ok()
}

/// The shards of `map` that have a folder, by number.
///
/// # Errors
/// When the system refuses. A missing folder of shards is no error.
pub fn present(map: &Path) -> Result<Vec<(Shard, PathBuf)>, StoreError> {
    let mut shards = all(map)?;
    // A folder that was just made, or is all but removed, has nothing of interest.
    shards.retain(|(_, path)| !folder::is_bare(path));
    Ok(shards)
}

/// The shards of `map` that have a manifest. One that a run has only just begun has none yet.
///
/// # Errors
/// As [`present`].
pub(crate) fn begun(map: &Path) -> Result<Vec<(Shard, PathBuf)>, StoreError> {
    let mut shards = present(map)?;
    shards.retain(|(_, path)| path.join(manifest::NAME).exists());
    Ok(shards)
}

/// Every folder of a shard of `map`.
fn all(map: &Path) -> Result<Vec<(Shard, PathBuf)>, StoreError> {
    let root = root(map);
    if !root.exists() {
        return Ok(Vec::new());
    }
    refuse_link(&root)?;
    let paths = folder::listed(&root, |name| shard_of(name).is_some())?;
    paths.iter().try_for_each(|path| refuse_link(path))?;
    let mut shards: Vec<(Shard, PathBuf)> = paths
        .into_iter()
        .filter_map(|path| Some((shard_of(path.file_name()?.to_str()?)?, path)))
        .collect();
    shards.sort_by_key(|(shard, _)| shard.numbers());
    Ok(shards)
}

/// Refuses a link: a folder that is removed later must not lead elsewhere.
fn refuse_link(folder: &Path) -> Result<(), StoreError> {
    match folder.symlink_metadata().is_ok_and(|m| m.is_dir()) {
        true => Ok(()),
        false => Err(StoreError::Foreign {
            path: folder.to_owned(),
        }),
    }
}

/// The first sound manifest of the folders of shards, and its plan.
///
/// # Errors
/// When there is no manifest, or no sound one.
pub fn plan(folders: &[PathBuf]) -> Result<(Manifest, Plan), StoreError> {
    let mut first = None;
    for folder in folders {
        match planned(folder) {
            Err(error @ StoreError::Manifest { .. }) => drop(first.get_or_insert(error)),
            found => return found,
        }
    }
    Err(first.unwrap_or_else(|| StoreError::io("read", Path::new(manifest::NAME))(NotFound.into())))
}

fn planned(folder: &Path) -> Result<(Manifest, Plan), StoreError> {
    let manifest = manifest(folder)?;
    match manifest.read_plan() {
        Ok(plan) => Ok((manifest, plan)),
        Err(error) => Err(StoreError::Manifest {
            path: folder.join(manifest::NAME),
            why: error.message,
        }),
    }
}

/// The hash of the plan whose tiles stand beside `map`, from the first sound manifest; none where
/// there are no tiles. No plan is made and no tile file is read.
///
/// # Errors
/// When no manifest is sound, or the system refuses.
pub(crate) fn plan_hash(map: &Path) -> Result<Option<String>, StoreError> {
    let mut first = Ok(None);
    for (_, folder) in begun(map)? {
        match manifest(&folder) {
            Ok(found) => return Ok(Some(found.plan_hash)),
            Err(error) if first.is_ok() => first = Err(error),
            Err(_) => {}
        }
    }
    first
}

/// Whether tiles of any shard that belong to `asked` stand beside `map`.
#[must_use]
pub(crate) fn hold(map: &Path, asked: &Manifest) -> bool {
    let holds = |folder: &Path| match manifest(folder) {
        Ok(found) => found.plan_hash == asked.plan_hash,
        Err(_) => folder::belongs(folder, &asked.layout()).is_ok_and(|b| b == Belongs::Here),
    };
    present(map)
        .unwrap_or_default()
        .iter()
        .any(|(_, folder)| holds(folder))
}

/// The manifest that a folder must have to belong to `expected`, and whether its own is sound. For
/// an unsound one the folder's name says which shard it is.
///
/// # Errors
/// When its own manifest is of something else, the system refuses, or the shard cannot be told.
pub(super) fn expected_in(
    folder: &Path,
    expected: &Manifest,
) -> Result<(Manifest, bool), StoreError> {
    match manifest(folder) {
        Ok(found) => {
            let expected = expected.of_shard(&found.shard);
            found.refuse_unlike(&expected, folder)?;
            Ok((expected, true))
        }
        Err(StoreError::Manifest { path, why }) => {
            let name = folder.file_name().and_then(|name| shard_of(name.to_str()?));
            let shard = name.ok_or(StoreError::Manifest { path, why })?;
            Ok((expected.of_shard(&shard.to_string()), false))
        }
        Err(error) => Err(error),
    }
}

/// Whether a run works on a shard at this moment.
#[must_use]
pub(crate) fn is_running(folder: &Path) -> bool {
    folder::is_claimed(folder)
}

/// Whether a run works on some shard of `map`.
///
/// # Errors
/// As [`present`].
pub(crate) fn any_is_running(map: &Path) -> Result<bool, StoreError> {
    let shards = present(map)?;
    Ok(shards.iter().any(|(_, path)| is_running(path)))
}

/// The manifest of a shard's folder.
///
/// # Errors
/// When there is none, or it is damaged.
pub(crate) fn manifest(folder: &Path) -> Result<Manifest, StoreError> {
    Manifest::read(&folder.join(manifest::NAME))
}

/// Removes the tiles of every shard of `map`.
///
/// # Errors
/// When a run works on one of them, something that is not slipmap's is there, or the system
/// refuses.
pub(crate) fn clear(map: &Path) -> Result<(), StoreError> {
    let shards = all(map)?;
    if let Some((_, path)) = shards.iter().find(|(_, path)| is_running(path)) {
        return Err(StoreError::Locked { path: path.clone() });
    }
    for (_, path) in &shards {
        folder::clear(path)?;
    }
    remove_root(map)
}

/// Removes the tiles of one shard of `map`, if there are any.
///
/// # Errors
/// As [`clear`].
pub(crate) fn clear_shard(map: &Path, shard: Shard) -> Result<(), StoreError> {
    let path = folder_of(map, shard);
    if path.exists() {
        folder::clear(&path)
    } else {
        Ok(())
    }
}

/// Makes the folder that contains those of the shards, if it does not exist.
///
/// # Errors
/// When something else stands there or in it, or the system refuses.
pub(crate) fn make_root(map: &Path) -> Result<(), StoreError> {
    let root = root(map);
    folder::make(&root)?;
    refuse_link(&root)?;
    let foreign_name = |name: &str| name != MERGED && shard_of(name).is_none();
    match folder::listed(&root, foreign_name)?.pop() {
        Some(path) => Err(StoreError::Foreign { path }),
        None => Ok(()),
    }
}

/// Removes the folder of shards, which must be empty.
///
/// # Errors
/// When it is not empty, or the system refuses.
pub(crate) fn remove_root(map: &Path) -> Result<(), StoreError> {
    let root = root(map);
    if !root.exists() {
        return Ok(());
    }
    for (_, path) in all(map)? {
        if folder::is_bare(&path) {
            folder::clear(&path)?;
        }
    }
    let marker = marker(map);
    if marker.exists() && all(map)?.is_empty() {
        fs::remove_file(&marker).map_err(StoreError::io("remove", &marker))?;
    }
    fs::remove_dir(&root).map_err(StoreError::io("remove", &root))
}

/// The folders of several shards, all claimed, as one source.
#[derive(Debug)]
pub struct Shards {
    folders: Vec<TileFolder>,
}

impl Shards {
    /// Claims the folders `paths`, whose tiles must all belong to `expected`, apart from the shard.
    ///
    /// # Errors
    /// See [`TileFolder::claim`].
    pub fn claim(
        paths: &[PathBuf],
        expected: &Manifest,
        pieces: Pieces,
        stop: &AtomicBool,
    ) -> Result<(Self, Vec<Damaged>), StoreError> {
        let mut all = Vec::new();
        let mut folders = Vec::new();
        for path in paths {
            let (expected, _) = expected_in(path, expected)?;
            let (folder, damaged) = TileFolder::claim(path, &expected, pieces, stop)?;
            folders.push(folder);
            all.extend(damaged);
        }
        Ok((Self { folders }, all))
    }

    /// How many of `total` pieces are in no folder.
    #[must_use]
    pub fn missing(&self, total: u64) -> u64 {
        let done: BTreeSet<Piece> = self.folders.iter().flat_map(TileFolder::done).collect();
        total.saturating_sub(done.len() as u64)
    }

    /// Removes all the folders.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn remove(self) -> Result<(), StoreError> {
        self.folders.into_iter().try_for_each(TileFolder::remove)
    }
}

impl Source for Shards {
    fn read(&mut self, piece: Piece) -> Result<Option<Vec<u8>>, StoreError> {
        self.folders.read(piece)
    }
}
