//! One shard's folder, claimed by the process that fills it.

use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::super::durable::{rename_synced, sync_name, write_synced};
use super::super::error::StoreError;
use super::super::lock;
use super::super::source::Source;
use super::format;
use super::manifest::{self, Manifest};
use super::reader::{self, Damaged, TileReader};
use super::record::{Digest, Record, RecordEncoder};
use crate::sweep::engine::Sink;
use crate::sweep::plan::pieces::{Piece, Pieces};

/// The usual time between two files.
pub(crate) const BETWEEN_FILES: Duration = Duration::from_secs(2);
/// The most bytes that wait before a file is written.
const BYTES_OF_A_FILE: usize = 16 << 20;

const LOCK: &str = "lock";
const PREFIX: &str = "tiles-";
const SUFFIX: &str = ".bin";
const PART: &str = ".part";
/// Digits of a tile file's number.
const DIGITS: usize = 10;

/// The folder of one shard, claimed by this process.
#[derive(Debug)]
pub struct TileFolder {
    reader: TileReader,
    pieces: Pieces,
    /// Number of the next file, larger than any before.
    next_number: u64,
    waiting: Vec<Record>,
    waiting_bytes: usize,
    last_file: Instant,
    save_every: Duration,
    /// Held as long as the folder is claimed.
    _lock: File,
}

impl TileFolder {
    /// Claims `path` for the tiles that `manifest` describes, checks its contents, and reports what
    /// was damaged. Damaged pieces are removed from the folder; sound ones are kept. A lock left by
    /// a run that died does not block.
    ///
    /// # Errors
    /// When `stop` is set, another run works there, the folder or its manifest belongs to something
    /// else, or the system refuses.
    pub fn claim(
        path: &Path,
        manifest: &Manifest,
        pieces: Pieces,
        stop: &AtomicBool,
    ) -> Result<(Self, Vec<Damaged>), StoreError> {
        make(path)?;
        refuse_foreign(path)?;
        let lock = lock(path)?;
        // Leftovers of a run that died; new files take these names.
        for part in listed(path, is_part)? {
            remove(&part)?;
        }
        let broken = check_manifest(path, manifest)?;
        let (reader, mut damaged) = TileReader::of(path, manifest.layout(), pieces, stop)?;
        let mut folder = Self {
            reader,
            pieces,
            next_number: last_number(path)?.map_or(0, |last| last.saturating_add(1)),
            waiting: Vec::new(),
            waiting_bytes: 0,
            last_file: Instant::now(),
            save_every: BETWEEN_FILES,
            _lock: lock,
        };
        folder.mend(&damaged)?;
        damaged.extend(broken);
        Ok((folder, damaged))
    }

    /// Sets the time between two files, instead of two seconds.
    pub(crate) fn save_every(&mut self, time: Duration) {
        self.save_every = time;
    }

    /// Checks every byte in the folder again.
    ///
    /// # Errors
    /// When `stop` is set, or the system refuses.
    pub fn scan(&mut self, stop: &AtomicBool) -> Result<Vec<Damaged>, StoreError> {
        let (path, layout) = (self.reader.path().to_owned(), *self.reader.layout());
        let (reader, damaged) = TileReader::of(&path, layout, self.pieces, stop)?;
        self.reader = reader;
        self.mend(&damaged)?;
        Ok(damaged)
    }

    /// Writes the sound pieces of damaged files to new files, then removes the damaged ones.
    fn mend(&mut self, damaged: &[Damaged]) -> Result<(), StoreError> {
        for broken in damaged {
            self.waiting.extend(self.reader.records_of(&broken.file)?);
        }
        self.flush()?;
        damaged.iter().try_for_each(|broken| remove(&broken.file))
    }

    /// The pieces in the folder.
    pub fn done(&self) -> impl Iterator<Item = Piece> {
        self.reader.done()
    }

    /// Removes everything that slipmap put there, and the folder.
    ///
    /// # Errors
    /// When the system refuses, for instance because something else is in the folder.
    pub(crate) fn remove(self) -> Result<(), StoreError> {
        clear_claimed(self.reader.path())
    }

    fn write_file(&mut self) -> Result<(), StoreError> {
        let folder = self.reader.path();
        let name = format!("{PREFIX}{:0DIGITS$}{SUFFIX}", self.next_number);
        let (path, part) = (folder.join(&name), folder.join(format!(".{name}{PART}")));
        let (layout, records) = (self.reader.layout(), &self.waiting);
        write_synced(&part, |out| format::write(out, layout, records))?;
        rename_synced(&part, &path)?;
        let entries = format::entries(records);
        self.reader.add(path, entries);
        self.next_number += 1;
        self.waiting.clear();
        self.waiting_bytes = 0;
        self.last_file = Instant::now();
        Ok(())
    }
}

impl Sink for TileFolder {
    type Encoder = RecordEncoder;
    type Error = StoreError;

    fn encoder(&self) -> RecordEncoder {
        RecordEncoder::default()
    }

    fn write(&mut self, _: Piece, record: Record) -> Result<(), StoreError> {
        self.waiting_bytes += record.payload.len();
        self.waiting.push(record);
        self.pause()
    }

    fn pause(&mut self) -> Result<(), StoreError> {
        let due =
            self.last_file.elapsed() >= self.save_every || self.waiting_bytes >= BYTES_OF_A_FILE;
        if due { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), StoreError> {
        match self.waiting.is_empty() {
            true => Ok(()),
            false => self.write_file(),
        }
    }
}

impl Source for TileFolder {
    fn read(&mut self, piece: Piece) -> Result<Option<Vec<u8>>, StoreError> {
        self.reader.read(piece)
    }
}

/// Claims the folder.
fn lock(folder: &Path) -> Result<File, StoreError> {
    let path = folder.join(LOCK);
    let lock = lock::acquire(&path).map_err(StoreError::io("lock", &path))?;
    lock.ok_or_else(|| StoreError::Locked {
        path: folder.to_owned(),
    })
}

/// Whether a run works in the folder at this moment.
pub(super) fn is_claimed(folder: &Path) -> bool {
    lock::is_held(&folder.join(LOCK))
}

/// Whether a folder has no manifest, and no run works in it: it was just made, or is being removed.
pub(super) fn is_bare(folder: &Path) -> bool {
    !folder.join(manifest::NAME).exists() && !is_claimed(folder)
}

/// Writes the manifest where there is none; else compares it. A damaged manifest is rewritten and
/// reported, unless a tile file says that the folder belongs to something else.
fn check_manifest(folder: &Path, asked: &Manifest) -> Result<Option<Damaged>, StoreError> {
    let path = folder.join(manifest::NAME);
    if !path.exists() {
        return write_manifest(folder, asked).map(|()| None);
    }
    match Manifest::read(&path) {
        Ok(found) => found.refuse_unlike(asked, folder).map(|()| None),
        Err(StoreError::Manifest { path, why }) => {
            if belongs(folder, &asked.layout())? == Belongs::Elsewhere {
                return Err(StoreError::Manifest { path, why });
            }
            write_manifest(folder, asked)?;
            Ok(Some(Damaged { file: path, why }))
        }
        Err(error) => Err(error),
    }
}

fn write_manifest(folder: &Path, manifest: &Manifest) -> Result<(), StoreError> {
    let part = folder.join(format!(".{}{PART}", manifest::NAME));
    let text = manifest.sealed();
    write_synced(&part, |out| std::io::Write::write_all(out, text.as_bytes()))?;
    rename_synced(&part, &folder.join(manifest::NAME))
}

/// What the tile files of a folder say of themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Belongs {
    /// No file says anything.
    Nowhere,
    /// Some files belong to what is asked for, none to anything else.
    Here,
    /// A file is sound and belongs to something else.
    Elsewhere,
}

/// What the tile files of a folder belong to, for a folder whose manifest is unreadable.
pub(super) fn belongs(folder: &Path, layout: &Digest) -> Result<Belongs, StoreError> {
    let mut found = Belongs::Nowhere;
    for file in listed(folder, is_tile_file)? {
        match reader::is_of(&file, layout)? {
            Some(true) => found = Belongs::Here,
            Some(false) => return Ok(Belongs::Elsewhere),
            None => {}
        }
    }
    Ok(found)
}

/// The number in a tile file's name.
fn file_number(name: &str) -> Option<u64> {
    let digits = name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?;
    let whole = digits.len() >= DIGITS && digits.bytes().all(|b| b.is_ascii_digit());
    digits.parse().ok().filter(|_| whole)
}

/// The largest number of a tile file in the folder.
fn last_number(folder: &Path) -> Result<Option<u64>, StoreError> {
    let files = listed(folder, is_tile_file)?;
    let number = |path: &PathBuf| file_number(path.file_name()?.to_str()?);
    Ok(files.iter().filter_map(number).max())
}

pub(super) fn is_tile_file(name: &str) -> bool {
    file_number(name).is_some()
}

fn is_part(name: &str) -> bool {
    name.starts_with('.') && name.ends_with(PART)
}

fn is_ours(name: &str) -> bool {
    name == LOCK || name == manifest::NAME || is_part(name) || is_tile_file(name)
}

/// The entries of a folder with names of this sort, sorted.
pub(super) fn listed(
    folder: &Path,
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<PathBuf>, StoreError> {
    let entries = fs::read_dir(folder).map_err(StoreError::io("read", folder))?;
    let mut paths = Vec::new();
    for entry in entries {
        let entry = entry.map_err(StoreError::io("read", folder))?;
        if entry.file_name().to_str().is_some_and(&wanted) {
            paths.push(entry.path());
        }
    }
    // As plain texts, which are compared faster than paths.
    paths.sort_unstable_by(|a, b| a.as_os_str().cmp(b.as_os_str()));
    Ok(paths)
}

/// Makes a folder durably, if it does not exist.
pub(crate) fn make(folder: &Path) -> Result<(), StoreError> {
    match fs::create_dir(folder) {
        // The process that made it may have died before it was durable.
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
        made => made.map_err(StoreError::io("create", folder))?,
    }
    sync_name(folder)
}

fn refuse_foreign(folder: &Path) -> Result<(), StoreError> {
    let all = fs::read_dir(folder).map_err(StoreError::io("read", folder))?;
    for entry in all {
        let entry = entry.map_err(StoreError::io("read", folder))?;
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !is_file || !entry.file_name().to_str().is_some_and(is_ours) {
            return Err(StoreError::Foreign { path: entry.path() });
        }
    }
    Ok(())
}

fn remove(path: &Path) -> Result<(), StoreError> {
    fs::remove_file(path).map_err(StoreError::io("remove", path))
}

/// Removes the folder and all that slipmap put into it.
pub(super) fn clear(folder: &Path) -> Result<(), StoreError> {
    refuse_foreign(folder)?;
    let lock = lock(folder)?;
    clear_claimed(folder)?;
    drop(lock);
    Ok(())
}

/// Removes the contents of a folder that this process has claimed.
fn clear_claimed(folder: &Path) -> Result<(), StoreError> {
    refuse_foreign(folder)?;
    let manifest = folder.join(manifest::NAME);
    if manifest.exists() {
        // The manifest goes first: a folder without one is being removed, and its rest is not taken
        // for half a map.
        let part = folder.join(format!(".{}{PART}", manifest::NAME));
        rename_synced(&manifest, &part)?;
    }
    for path in listed(folder, |name| is_ours(name) && name != LOCK)? {
        remove(&path)?;
    }
    remove(&folder.join(LOCK))?;
    fs::remove_dir(folder).map_err(StoreError::io("remove", folder))
}
