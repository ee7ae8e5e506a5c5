//! Why a map or trace could not be written or read, with the file's name and the cause.

use std::io;
use std::path::{Path, PathBuf};

use crate::sweep::plan::pieces::Piece;

/// What went wrong with a file.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The system refused an operation on a file or folder.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// On what.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The HDF5 library refused.
    #[error("cannot {action} {}: {cause}", path.display())]
    Hdf5 {
        /// What was tried.
        action: String,
        /// On what.
        path: PathBuf,
        /// What the library said, in one line.
        cause: String,
    },
    /// The file is no map, or one of another format.
    #[error("{} is not a slipmap map: {why}", path.display())]
    NotAMap {
        /// Which file.
        path: PathBuf,
        /// What is missing or different.
        why: String,
    },
    /// The file is no trace, or one of another format.
    #[error("{} is not a slipmap trace: {why}", path.display())]
    NotATrace {
        /// Which file.
        path: PathBuf,
        /// What is missing or different.
        why: String,
    },
    /// Another run writes the same map.
    #[error("another run is writing {}", path.display())]
    Locked {
        /// The map's final name, or the folder of tiles.
        path: PathBuf,
    },
    /// Another program has the file open to write it.
    #[error("another program has {} open for writing", path.display())]
    InUse {
        /// Which file.
        path: PathBuf,
    },
    /// A folder of tiles belongs to another sweep, program or format.
    #[error("{} has tiles of something else: {difference}", path.display())]
    OtherTiles {
        /// The folder.
        path: PathBuf,
        /// The first difference.
        difference: String,
    },
    /// A manifest cannot be read.
    #[error("the manifest {} is damaged: {why}", path.display())]
    Manifest {
        /// The file.
        path: PathBuf,
        /// Where, in words.
        why: String,
    },
    /// Something that is not slipmap's is where tiles go.
    #[error("{} stands where the tiles go and is not by slipmap", path.display())]
    Foreign {
        /// What it is.
        path: PathBuf,
    },
    /// A tile file is not as it was written.
    #[error("the tile file {} is damaged", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// A piece has the right checksum and makes no sense.
    #[error("{piece:?} cannot be read, though its checksum fits")]
    DamagedPiece {
        /// Which one.
        piece: Piece,
    },
    /// A file that begins as HDF5 does and cannot be opened.
    #[error(
        "{} is a damaged HDF5 file (cut off, changed or not closed), or of a newer kind than the \
         HDF5 library here reads",
        path.display()
    )]
    DamagedFile {
        /// The file.
        path: PathBuf,
    },
    /// A file with the seal of a map, whose bytes have changed so that it is not read as one.
    #[error("{} is a damaged map: its bytes have changed, {why}", path.display())]
    DamagedMap {
        /// The file.
        path: PathBuf,
        /// What is missing or different.
        why: String,
    },
    /// A map that was just written does not hold what was written.
    #[error("{} was not written as it should have been: {why}", path.display())]
    Unsound {
        /// The map's final name.
        path: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// A map with missing cells would take the place of a complete one.
    #[error(
        "{} is complete, and {pieces} pieces of what would replace it are missing",
        path.display()
    )]
    WouldLose {
        /// The map.
        path: PathBuf,
        /// How many.
        pieces: u64,
    },
    /// It was asked to stop.
    #[error("interrupted")]
    Stopped,
    /// Pieces are missing.
    #[error("{pieces} of {of} pieces of the map are missing")]
    Incomplete {
        /// How many.
        pieces: u64,
        /// Of how many.
        of: u64,
    },
}

impl StoreError {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io {
            action,
            path: path.to_owned(),
            source,
        }
    }

    pub(super) fn hdf5(action: impl Into<String>, path: &Path) -> impl FnOnce(hdf5::Error) -> Self {
        move |error| Self::Hdf5 {
            action: action.into(),
            path: path.to_owned(),
            cause: cause(&error),
        }
    }

    pub(super) fn not_a_trace(path: &Path, why: impl Into<String>) -> Self {
        Self::NotATrace {
            path: path.to_owned(),
            why: why.into(),
        }
    }

    pub(super) fn not_a_map(path: &Path, why: impl Into<String>) -> Self {
        Self::NotAMap {
            path: path.to_owned(),
            why: why.into(),
        }
    }
}

/// The system's own words where the library's error stack holds them, else its innermost
/// description.
fn cause(error: &hdf5::Error) -> String {
    let Some(stack) = error.stack() else {
        return error.to_string();
    };
    let mut descriptions: Vec<String> = stack.iter().map(|frame| frame.desc().to_owned()).collect();
    let said = descriptions.iter().find_map(|text| {
        let (_, rest) = text.split_once("error message = '")?;
        Some(rest.split_once('\'')?.0.to_owned())
    });
    said.or_else(|| descriptions.pop())
        .unwrap_or_else(|| error.to_string())
}
