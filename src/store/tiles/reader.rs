//! Checks and reads the tile files of one folder, without changing anything.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::fs::File;
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use super::super::error::StoreError;
use super::super::regular::{self, NotRead};
use super::super::source::Source;
use super::folder::{is_tile_file, listed};
use super::format::{self, Damage, Entry};
use super::record::{Digest, Record, digest};
use crate::sweep::plan::pieces::{Piece, Pieces};

/// The most bytes of a tile file.
const MOST_BYTES: u64 = 4 << 30;

/// Bytes that are read of a file for its head; the heads of most files have less.
const USUAL_HEAD: u64 = 4 << 10;

/// A tile file that is not as it was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Damaged {
    /// The file.
    pub file: PathBuf,
    /// What is wrong, in words.
    pub why: String,
}

/// A tile file and what it holds.
#[derive(Debug)]
struct TileFile {
    path: PathBuf,
    entries: Vec<Entry>,
}

/// A tile file of which every byte was read and checked.
pub(super) struct Checked {
    pub bytes: Vec<u8>,
    /// Its sound records, all of pieces that the plan has.
    pub sound: Vec<Entry>,
    /// What is wrong with the file, in words.
    pub fault: Option<String>,
}

impl Checked {
    /// Reads a file of a folder whose tiles share `layout`; none where the file is gone.
    pub(super) fn read(
        path: &Path,
        layout: &Digest,
        pieces: Pieces,
    ) -> Result<Option<Self>, StoreError> {
        let useless = |fault: String| {
            Ok(Some(Self {
                bytes: Vec::new(),
                sound: Vec::new(),
                fault: Some(fault),
            }))
        };
        let bytes = match regular::read(path, MOST_BYTES) {
            Ok(bytes) => bytes,
            Err(NotRead::Large(length)) => return useless(format!("it has {length} bytes")),
            Err(NotRead::Foreign) => {
                return Err(StoreError::Foreign {
                    path: path.to_owned(),
                });
            }
            // The file has gone since the folder was listed: its run has just assembled the map.
            Err(NotRead::Refused(error)) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(NotRead::Refused(error)) => return Err(StoreError::io("read", path)(error)),
        };
        let entries = match format::index(&bytes, layout) {
            Ok(entries) => entries,
            Err(damage) => return useless(damage.to_string()),
        };
        let all = entries.len();
        let sound: Vec<Entry> = entries
            .into_iter()
            .filter(|e| pieces.place(e.piece).is_some() && format::is_sound(&bytes, e))
            .collect();
        let lost = all - sound.len();
        let fault = || format!("{}: {lost} of {all} pieces", Damage::Checksum);
        Ok(Some(Self {
            bytes,
            fault: (lost > 0).then(fault),
            sound,
        }))
    }
}

/// The entries in the head of a tile file; empty where the head is not sound, or has more of them
/// than there are pieces.
fn head(path: &Path, layout: &Digest, pieces: Pieces) -> std::io::Result<Vec<Entry>> {
    let mut file = match regular::open(path) {
        Ok(file) => file,
        Err(NotRead::Foreign) => return Ok(Vec::new()),
        Err(other) => return Err(other.into()),
    };
    let found = file.metadata()?;
    let mut head = vec![0; found.len().min(USUAL_HEAD) as usize];
    file.read_exact(&mut head)?;
    let most = found.len().min(format::longest_head(pieces.total()));
    let length = format::length_of_head(&head).filter(|&length| length as u64 <= most);
    let Some(length) = length else {
        return Ok(Vec::new());
    };
    if let Some(more) = length.checked_sub(head.len()) {
        let begun = head.len();
        head.resize(begun + more, 0);
        file.read_exact(&mut head[begun..])?;
    }
    let entries = format::index(&head, layout).unwrap_or_default();
    let whole = |entry: &Entry| entry.at.end as u64 <= found.len();
    Ok(entries.into_iter().filter(whole).collect())
}

/// Whether a tile file has this `layout`; none where its head is unreadable.
pub(super) fn is_of(path: &Path, layout: &Digest) -> Result<Option<bool>, StoreError> {
    match regular::read(path, MOST_BYTES) {
        Ok(bytes) => Ok(match format::index(&bytes, layout) {
            Ok(_) => Some(true),
            Err(Damage::OtherLayout) => Some(false),
            Err(_) => None,
        }),
        Err(NotRead::Refused(error)) => Err(StoreError::io("read", path)(error)),
        Err(NotRead::Foreign | NotRead::Large(_)) => Ok(None),
    }
}

/// The contents of the tile files of a folder.
#[derive(Debug)]
pub struct TileReader {
    path: PathBuf,
    layout: Digest,
    pieces: Pieces,
    files: Vec<TileFile>,
    /// File and entry of each piece, by [`Pieces::place`].
    index: Vec<Option<(u32, u32)>>,
    open: Option<(u32, File)>,
}

impl TileReader {
    /// A reader that has not read any file of its folder yet.
    fn empty(path: &Path, layout: Digest, pieces: Pieces) -> Self {
        Self {
            path: path.to_owned(),
            layout,
            pieces,
            files: Vec::new(),
            index: vec![None; pieces.total() as usize],
            open: None,
        }
    }

    /// Reads every byte in the folder `path`, and reports damaged files. The sound pieces of these
    /// are available too.
    ///
    /// # Errors
    /// When `stop` is set, or the system refuses.
    pub fn of(
        path: &Path,
        layout: Digest,
        pieces: Pieces,
        stop: &AtomicBool,
    ) -> Result<(Self, Vec<Damaged>), StoreError> {
        let mut reader = Self::empty(path, layout, pieces);
        let mut damaged = Vec::new();
        for file in listed(path, is_tile_file)? {
            if stop.load(Ordering::Relaxed) {
                return Err(StoreError::Stopped);
            }
            if let Some(why) = reader.take_in(&file)? {
                damaged.push(Damaged { file, why });
            }
        }
        Ok((reader, damaged))
    }

    /// Reads only the heads of the files, and skips files without a sound head. A piece is checked
    /// when it is read.
    ///
    /// # Errors
    /// When the system refuses.
    pub(super) fn of_heads(
        path: &Path,
        layout: Digest,
        pieces: Pieces,
    ) -> Result<Self, StoreError> {
        let mut reader = Self::empty(path, layout, pieces);
        reader.add_new()?;
        Ok(reader)
    }

    /// Adds new files, by their heads. Where files have gone, since a run mends damaged ones, all
    /// are read anew.
    pub(super) fn add_new(&mut self) -> Result<(), StoreError> {
        let mut found = listed(&self.path, is_tile_file)?;
        let all = found.len();
        // As plain texts, which are compared faster than paths.
        let known: HashSet<&OsStr> = self
            .files
            .iter()
            .map(|file| file.path.as_os_str())
            .collect();
        found.retain(|file| !known.contains(file.as_os_str()));
        if all - found.len() < known.len() {
            *self = Self::empty(&self.path, self.layout, self.pieces);
            return self.add_new();
        }
        for file in found {
            let entries = match head(&file, &self.layout, self.pieces) {
                Ok(entries) => entries,
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                Err(error) => return Err(StoreError::io("read", &file)(error)),
            };
            let there = |entry: &Entry| self.pieces.place(entry.piece).is_some();
            let entries = entries.into_iter().filter(there).collect();
            self.add(file, entries);
        }
        Ok(())
    }

    /// Adds the sound pieces of a file. Returns what is wrong with the file, if anything.
    fn take_in(&mut self, path: &Path) -> Result<Option<String>, StoreError> {
        let Some(checked) = Checked::read(path, &self.layout, self.pieces)? else {
            return Ok(None);
        };
        self.add(path.to_owned(), checked.sound);
        Ok(checked.fault)
    }

    /// Adds a file whose entries are known to be sound.
    pub(super) fn add(&mut self, path: PathBuf, entries: Vec<Entry>) {
        let file = self.files.len() as u32;
        for (number, entry) in entries.iter().enumerate() {
            if let Some(place) = self.pieces.place(entry.piece) {
                self.index[place as usize] = Some((file, number as u32));
            }
        }
        self.files.push(TileFile { path, entries });
    }

    /// Where the folder is.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The hash of everything that the folder's tiles have in common.
    pub(super) fn layout(&self) -> &Digest {
        &self.layout
    }

    /// The pieces in the folder.
    pub fn done(&self) -> impl Iterator<Item = Piece> {
        let places = self.index.iter().enumerate();
        places
            .filter(|(_, at)| at.is_some())
            .map(|(place, _)| self.pieces.at(place as u64))
    }

    /// The sound records of a file.
    pub(super) fn records_of(&mut self, path: &Path) -> Result<Vec<Record>, StoreError> {
        let Some(file) = self.files.iter().position(|file| file.path == path) else {
            return Ok(Vec::new());
        };
        let entries = self.files[file].entries.clone();
        let record = |entry: Entry| {
            let payload = self.payload(file as u32, &entry)?;
            Ok(Record::new(entry.piece, payload))
        };
        entries.into_iter().map(record).collect()
    }

    fn payload(&mut self, file: u32, entry: &Entry) -> Result<Vec<u8>, StoreError> {
        let path = &self.files[file as usize].path;
        let open = match &mut self.open {
            Some((number, open)) if *number == file => open,
            other => {
                let opened = regular::open(path).map_err(Into::into);
                let opened = opened.map_err(StoreError::io("open", path))?;
                &mut other.insert((file, opened)).1
            }
        };
        let mut payload = vec![0; entry.at.len()];
        open.seek(SeekFrom::Start(entry.at.start as u64))
            .and_then(|_| open.read_exact(&mut payload))
            .map_err(StoreError::io("read", path))?;
        match digest(&payload) == entry.digest {
            true => Ok(payload),
            false => Err(StoreError::Damaged { path: path.clone() }),
        }
    }
}

impl Source for TileReader {
    fn read(&mut self, piece: Piece) -> Result<Option<Vec<u8>>, StoreError> {
        let place = self.pieces.place(piece);
        let Some((file, number)) = place.and_then(|place| self.index[place as usize]) else {
            return Ok(None);
        };
        let entry = self.files[file as usize].entries[number as usize].clone();
        self.payload(file, &entry).map(Some)
    }
}
