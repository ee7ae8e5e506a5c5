//! What the system says of a file: enough to see that it has changed or been replaced.

use std::fs::Metadata;
use std::path::Path;
use std::time::SystemTime;

/// The state of a file: equal as long as the file is neither replaced nor written to.
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
    /// The state of the file at `path`; none where there is no file.
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
