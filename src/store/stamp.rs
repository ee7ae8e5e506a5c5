//! The state of a file as the system reports it, to detect that it has changed or been replaced.

use std::fs::Metadata;
use std::path::Path;
use std::time::SystemTime;

/// The state of a file. It stays equal until the file is replaced or written to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Stamp {
    /// Length in bytes.
    pub length: u64,
    /// Time of the last write, where the system knows it.
    pub modified: Option<SystemTime>,
    /// Its inode number; 0 on systems without one.
    node: u64,
}

impl Stamp {
    /// The state of the file at `path`; none where there is no file.
    #[must_use]
    pub(crate) fn of(path: &Path) -> Option<Self> {
        path.metadata().ok().map(|found| Self::told(&found))
    }

    /// The state in what the system tells of a file.
    pub(crate) fn told(found: &Metadata) -> Self {
        #[cfg(unix)]
        let node = std::os::unix::fs::MetadataExt::ino(found);
        #[cfg(not(unix))]
        let node = 0;
        Self {
            length: found.len(),
            modified: found.modified().ok(),
            node,
        }
    }
}
