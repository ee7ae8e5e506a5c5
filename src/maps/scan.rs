//! Files below a folder that may be maps, by their names and by what the system reports. No file is
//! opened.

use std::collections::BTreeMap;
use std::fs::{self, DirEntry, Metadata};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use sha2::{Digest, Sha256};

use crate::store::stamp::Stamp;
use crate::store::tiles::shards;
use crate::text::in_hexadecimal;

/// The deepest nesting of folders that are searched.
const DEEPEST: usize = 8;
/// The most names that a scan reads.
const MOST_NAMES: usize = 50_000;
/// The most maps that are listed.
const MOST_MAPS: usize = 2000;
/// Extensions of maps.
const ENDINGS: [&str; 3] = ["h5", "hdf5", "nc"];
/// Digits of an id.
const DIGITS: usize = 16;

/// The state of a map's files; it changes whenever one of them does.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub(crate) struct Mark {
    /// The map itself.
    pub file: Option<Stamp>,
    /// Number of tile files, their bytes, and the time of the last one.
    tiles: Option<(u64, u64, Option<SystemTime>)>,
}

/// A candidate for a map.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    pub id: String,
    /// Its path below the folder.
    pub name: String,
    pub path: PathBuf,
    pub mark: Mark,
    /// Whether a run works on it.
    pub running: bool,
    /// Why it cannot be a map.
    pub odd: Option<&'static str>,
}

impl Found {
    /// A file that is in no folder of maps.
    pub(crate) fn alone(name: String, path: PathBuf) -> Self {
        let mark = Mark {
            file: Stamp::of(&path),
            tiles: None,
        };
        Self {
            id: id_of(&path),
            name,
            path,
            mark,
            running: false,
            odd: None,
        }
    }

    /// Number of bytes of its files.
    pub(crate) fn bytes(&self) -> u64 {
        let file = self.mark.file.map_or(0, |stamp| stamp.length);
        file + self.mark.tiles.map_or(0, |(_, bytes, _)| bytes)
    }

    /// Time of the last write.
    pub(crate) fn modified(&self) -> Option<SystemTime> {
        let tiles = self.mark.tiles.and_then(|(.., modified)| modified);
        tiles.max(self.mark.file.and_then(|stamp| stamp.modified))
    }

    /// The state of a map that can be read: complete or not.
    pub(crate) fn state(&self, complete: bool) -> &'static str {
        match (self.mark.file, self.running) {
            // Even while another one is being computed.
            (Some(_), _) if complete => "complete",
            (_, true) => "running",
            // There are only tiles; no map has been made yet.
            (_, false) => "interrupted",
        }
    }
}

/// The candidates below a folder.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scanned {
    /// Sorted by name.
    pub maps: Vec<Found>,
    /// Folders that were not searched: too deep, or closed to this process.
    pub folders_skipped: u64,
    /// Links that lead out of the folder, to folders, or nowhere.
    pub links_skipped: u64,
    /// Whether there are more than are listed.
    pub truncated: bool,
}

struct Search<'a> {
    root: &'a Path,
    found: BTreeMap<PathBuf, Option<&'static str>>,
    scanned: Scanned,
    names: usize,
}

/// The candidates below `root`, an absolute path without links.
pub(crate) fn scan(root: &Path) -> Scanned {
    let mut search = Search {
        root,
        found: BTreeMap::new(),
        scanned: Scanned::default(),
        names: 0,
    };
    search.folder(root, 0);
    let Search {
        found, mut scanned, ..
    } = search;
    scanned.truncated |= found.len() > MOST_MAPS;
    let maps = found.into_iter().take(MOST_MAPS);
    scanned.maps = maps
        .filter_map(|(path, odd)| look(root, path, odd))
        .collect();
    scanned
}

impl Search<'_> {
    fn folder(&mut self, folder: &Path, depth: usize) {
        let Ok(entries) = fs::read_dir(folder) else {
            self.scanned.folders_skipped += 1;
            return;
        };
        let mut inner = Vec::new();
        for entry in entries.flatten() {
            self.names += 1;
            if self.names > MOST_NAMES {
                self.scanned.truncated = true;
                return;
            }
            inner.extend(self.entry(&entry));
        }
        inner.sort();
        for folder in inner {
            match depth < DEEPEST {
                true => self.folder(&folder, depth + 1),
                false => self.scanned.folders_skipped += 1,
            }
        }
    }

    /// Adds an entry of a folder. Returns it if it is a folder to search.
    fn entry(&mut self, entry: &DirEntry) -> Option<PathBuf> {
        let (path, kind) = (entry.path(), entry.file_type().ok()?);
        let name = entry.file_name();
        if name.as_encoded_bytes().starts_with(b".") {
            return None;
        }
        if kind.is_dir() {
            let map = name
                .to_str()
                .and_then(|name| name.strip_suffix(shards::ROOT_ENDING));
            let Some(map) = map.filter(|map| !map.is_empty()) else {
                return Some(path);
            };
            let map = path.with_file_name(map);
            if shards::present(&map).is_ok_and(|present| !present.is_empty()) {
                self.found.entry(map).or_default();
            }
            return None;
        }
        let ending = path.extension().and_then(|ending| ending.to_str());
        let ending = ending.map(str::to_ascii_lowercase);
        let is_map = ending.is_some_and(|ending| ENDINGS.contains(&&*ending));
        if kind.is_symlink() {
            if !is_map {
                return None;
            }
            let inside = path
                .canonicalize()
                .is_ok_and(|to| to.starts_with(self.root));
            if !inside || path.is_dir() {
                self.scanned.links_skipped += 1;
                return None;
            }
        }
        if is_map {
            let regular = path.metadata().is_ok_and(|found| found.is_file());
            let odd = (!regular).then_some("it is no regular file");
            self.found.insert(path, odd);
        }
        None
    }
}

/// The id of a map, from its path below the folder.
pub(crate) fn id_of(relative: &Path) -> String {
    let mut hash = Sha256::new();
    hash.update(relative.as_os_str().as_encoded_bytes());
    let mut id = in_hexadecimal(&hash.finalize());
    id.truncate(DIGITS);
    id
}

/// The files of a map as the system reports them; none where they have gone.
fn look(root: &Path, path: PathBuf, odd: Option<&'static str>) -> Option<Found> {
    let relative = path.strip_prefix(root).ok()?;
    let folders = shards::present(&path).unwrap_or_default();
    let tiles = folders.iter().map(|(_, folder)| tiles_in(folder));
    let tiles = tiles.reduce(|a, b| (a.0 + b.0, a.1 + b.1, a.2.max(b.2)));
    let mark = Mark {
        file: Stamp::of(&path),
        tiles,
    };
    if mark == Mark::default() {
        return None;
    }
    Some(Found {
        id: id_of(relative),
        name: relative.to_string_lossy().into_owned(),
        running: folders.iter().any(|(_, folder)| shards::is_running(folder)),
        odd,
        mark,
        path,
    })
}

/// Number of files in a folder, their bytes, and the time of the last write.
fn tiles_in(folder: &Path) -> (u64, u64, Option<SystemTime>) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let entries = entries.filter_map(|entry| entry.metadata().ok());
    entries
        .filter(Metadata::is_file)
        .fold((0, 0, None), |sum, found| {
            let last = sum.2.max(found.modified().ok());
            (sum.0 + 1, sum.1 + found.len(), last)
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn only_what_lies_below_is_found() {
        use std::os::unix::fs::symlink;
        let outside = tempfile::tempdir().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let write = |path: PathBuf| {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "x").unwrap();
        };
        for name in [
            "a.h5",
            "b/c/d.HDF5",
            ".hidden/e.h5",
            "f.txt",
            "g.h5.tiles/h.h5",
        ] {
            write(root.join(name));
        }
        write(outside.path().join("secret.h5"));
        symlink(outside.path().join("secret.h5"), root.join("out.h5")).unwrap();
        symlink(outside.path(), root.join("folder.h5")).unwrap();
        symlink(root.join("a.h5"), root.join("b/in.h5")).unwrap();
        symlink(&root, root.join("b/again")).unwrap();
        symlink("/nowhere/at/all", root.join("broken.nc")).unwrap();
        let scanned = scan(&root);
        let names: Vec<&str> = scanned.maps.iter().map(|found| &*found.name).collect();
        assert_eq!(names, ["a.h5", "b/c/d.HDF5", "b/in.h5"]);
        assert_eq!((scanned.links_skipped, scanned.truncated), (3, false));
        let ids: std::collections::BTreeSet<_> = scanned.maps.iter().map(|f| &f.id).collect();
        assert!(ids.len() == 3 && ids.iter().all(|id| id.len() == DIGITS));
        let mut deep = root.clone();
        for _ in 0..20 {
            deep.push("d");
        }
        write(deep.join("map.h5"));
        let scanned = scan(&root);
        assert_eq!((scanned.maps.len(), scanned.folders_skipped), (3, 1));
    }
}
