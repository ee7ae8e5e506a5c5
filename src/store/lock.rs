//! Locks on files, which end with the process that holds them, however it ends.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::Path;

/// Locks the file `path`, creating it if needed; none where another process holds the lock. A lock
/// file left by a run that died is no obstacle.
pub(super) fn acquire(path: &Path) -> Result<Option<File>, Error> {
    loop {
        if path.symlink_metadata().is_ok_and(|m| !m.is_file()) {
            return Err(Error::from(ErrorKind::AlreadyExists));
        }
        let lock = OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(path)?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(error)) => return Err(error),
        }
        // Another run may have removed the file between opening and locking. The lock then protects
        // nothing.
        if still_there(&lock, path) {
            return Ok(Some(lock));
        }
    }
}

/// Whether another process holds the lock `path` at this moment.
pub(super) fn is_held(path: &Path) -> bool {
    let lock = File::open(path);
    lock.is_ok_and(|lock| matches!(lock.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

#[cfg(unix)]
fn still_there(lock: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (lock.metadata(), std::fs::metadata(path)) {
        (Ok(held), Ok(named)) => held.ino() == named.ino() && held.dev() == named.dev(),
        _ => false,
    }
}

#[cfg(not(unix))]
fn still_there(_: &File, path: &Path) -> bool {
    path.exists()
}
