//! Unfinished tiles that follow a sweep to its new name, such as that of one that was put first.
//! A change of a name is one rename, of the sweep file; its tiles keep the name under which they
//! were begun until a worker starts the sweep.

use std::fs;
use std::path::Path;

use super::folder::Folder;
use super::logs::logs;
use super::name::Name;
use crate::store::durable::sync;
use crate::store::tiles::shards;
use crate::store::{StoreError, lock};

/// Gives a job the tiles of its plan that were begun under another number, if there are such and it
/// has none. Tiles of a job that is there, or on which a run works, stay where they are.
///
/// # Errors
/// When the system refuses.
pub(super) fn adopt(folder: &Folder, name: &Name, plan_hash: &str) -> Result<(), StoreError> {
    let map = folder.map(name);
    let Some((_, word)) = name.parts() else {
        return Ok(());
    };
    if shards::root(&map).exists() || map.exists() {
        return Ok(());
    }
    for other in folder.names_of_maps()? {
        let other = other.name;
        let of_word = other.parts().is_some_and(|(_, its)| its == word) && other != *name;
        if of_word && is_left(folder, &other, plan_hash)? {
            return follow(folder, &other, name);
        }
    }
    Ok(())
}

/// Whether the tiles of a name are of this plan, and of no job that is there.
fn is_left(folder: &Folder, name: &Name, plan_hash: &str) -> Result<bool, StoreError> {
    let map = folder.map(name);
    if folder.find(name).is_some() || map.exists() || lock::is_held(&folder.lock(name)) {
        return Ok(false);
    }
    let found = shards::plan_hash(&map).ok().flatten();
    let ours = found.as_deref() == Some(plan_hash);
    let running = shards::any_is_running(&map)?;
    Ok(ours && !running)
}

/// Renames the tiles of one name to those of another, and then its logs.
fn follow(folder: &Folder, from: &Name, to: &Name) -> Result<(), StoreError> {
    let (map, new_map) = (folder.map(from), folder.map(to));
    let (old, new) = (shards::root(&map), shards::root(&new_map));
    fs::rename(&old, &new).map_err(StoreError::io("rename", &old))?;
    for log in logs(&map) {
        let behind = log.strip_prefix(folder.path()).ok().and_then(Path::to_str);
        let behind = behind.and_then(|file| file.strip_prefix(map.file_name()?.to_str()?));
        if let Some(behind) = behind {
            let mut renamed = new_map.clone().into_os_string();
            renamed.push(behind);
            // The tiles are what counts.
            let _ = fs::rename(&log, renamed);
        }
    }
    sync(folder.path())
}
