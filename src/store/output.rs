//! How a map gets its final name: a lock beside it, a temporary name, one rename at the end.

use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::durable::{rename_synced, sync};
use super::error::StoreError;
use super::lock;

/// The place of a map that is being written. If dropped before [`Output::commit`], it leaves
/// nothing behind.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    part: PathBuf,
    lock_path: PathBuf,
    lock: Option<File>,
}

/// A hidden file beside `path`, with a name that no other program uses.
#[must_use]
pub(crate) fn hidden_beside(path: &Path, purpose: &str) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.slipmap-{purpose}"))
}

impl Output {
    /// Claims the final name `path` for this process. A lock left by a run that died does not
    /// block.
    ///
    /// # Errors
    /// When the folder is missing or not writable, `path` is a folder, or another run holds the
    /// claim.
    pub fn claim(path: &Path) -> Result<Self, StoreError> {
        if path.is_dir() {
            let source = std::io::Error::from(std::io::ErrorKind::IsADirectory);
            return Err(StoreError::io("write", path)(source));
        }
        let lock_path = hidden_beside(path, "lock");
        let lock = lock::acquire(&lock_path).map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => StoreError::io("lock", &lock_path)(error),
            _ => StoreError::io("write", path)(error),
        })?;
        let Some(lock) = lock else {
            return Err(StoreError::Locked {
                path: path.to_owned(),
            });
        };
        let part = hidden_beside(path, "part");
        // A leftover of a run that died, or a link: the file to write must be new.
        if part.symlink_metadata().is_ok() {
            fs::remove_file(&part).map_err(StoreError::io("replace", &part))?;
        }
        Ok(Self {
            path: path.to_owned(),
            part,
            lock_path,
            lock: Some(lock),
        })
    }

    /// Removes what a run that died has left beside `path`: a lock and a temporary file. What
    /// another run holds stays.
    pub(crate) fn clear_leftovers(path: &Path) {
        let left = ["lock", "part"].map(|purpose| hidden_beside(path, purpose));
        if left.iter().any(|path| path.symlink_metadata().is_ok()) {
            drop(Self::claim(path));
        }
    }

    /// The final name.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The name to write to.
    #[must_use]
    pub(crate) fn part(&self) -> &Path {
        &self.part
    }

    /// Writes a whole text, and gives it its final name.
    ///
    /// # Errors
    /// As [`Output::commit`], and when the text cannot be written.
    pub(crate) fn fill(self, text: impl AsRef<[u8]>) -> Result<(), StoreError> {
        fs::write(&self.part, text).map_err(StoreError::io("write", &self.path))?;
        self.commit()
    }

    /// Makes the written file durable and gives it its final name. It replaces the file that stood
    /// there and takes over its permissions.
    ///
    /// # Errors
    /// When the system cannot sync or rename; the temporary file is then removed.
    pub fn commit(self) -> Result<(), StoreError> {
        if let Ok(replaced) = self.path.metadata() {
            let mode = replaced.permissions();
            fs::set_permissions(&self.part, mode).map_err(StoreError::io("write", &self.path))?;
        }
        sync(&self.part)?;
        rename_synced(&self.part, &self.path)
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        // Neither removal can fail in a way that matters here: a leftover is overwritten by the
        // next run.
        let _ = fs::remove_file(&self.part);
        let _ = fs::remove_file(&self.lock_path);
        self.lock = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_exclusive_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.h5");
        let first = Output::claim(&path).unwrap();
        assert!(matches!(
            Output::claim(&path),
            Err(StoreError::Locked { .. })
        ));
        fs::write(first.part(), "half").unwrap();
        drop(first);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        let second = Output::claim(&path).unwrap();
        fs::write(second.part(), "whole").unwrap();
        second.commit().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "whole");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_text_is_filled_in_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("page.html");
        Output::claim(&path).unwrap().fill("whole").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "whole");
        let output = Output::claim(&path).unwrap();
        fs::create_dir(output.part()).unwrap();
        let error = output.fill("half").unwrap_err();
        let told = error.to_string();
        assert!(
            told.contains("page.html") && !told.contains("part"),
            "{told}"
        );
        assert_eq!(fs::read_to_string(&path).unwrap(), "whole");
    }

    #[test]
    fn a_dead_runs_lock_does_not_block() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.h5");
        fs::write(hidden_beside(&path, "lock"), "").unwrap();
        fs::write(hidden_beside(&path, "part"), "torn").unwrap();
        assert!(Output::claim(&path).is_ok());
        for purpose in ["lock", "part"] {
            fs::write(hidden_beside(&path, purpose), "").unwrap();
            Output::clear_leftovers(&path);
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        }
        let held = Output::claim(&path).unwrap();
        fs::write(held.part(), "half").unwrap();
        Output::clear_leftovers(&path);
        assert!(held.part().exists() && Output::claim(&path).is_err());
    }
}
