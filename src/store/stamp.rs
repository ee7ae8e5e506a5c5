//! What the system tells of a file, by which it is seen that it is another one, or has changed.

use std::fs::Metadata;
use std::path::Path;
use std::time::SystemTime;

/// What is told of a file as it is now: equal as long as the file is not replaced or written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp {
    /// Its length in bytes.
    pub length: u64,
    /// When it was written last, where the system knows that.
    pub modified: Option<SystemTime>,
    /// Its number in the file system; 0 where there is none.
    node: u64,
}

impl Stamp {
    /// Of what is at `path`; none where there is nothing.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        path.metadata().ok().map(|found| Self::told(&found))
    }

    fn told(found: &Metadata) -> Self {
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
