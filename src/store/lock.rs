//! Locks on files, which end with the process that holds them, however it ends.

use std::fs::{File, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::Path;
use std::time::{Duration, Instant};

use super::regular::{self, NotRead};

/// How long others may look at a lock, one after the other, before it counts as held.
const LOOKED_AT: Duration = Duration::from_secs(2);

/// Locks the file `path`, creating it if needed; none where another process holds the lock. A lock
/// file left by a run that died is no obstacle, nor is a process that looks whether it is held.
pub(crate) fn acquire(path: &Path) -> Result<Option<File>, Error> {
    let begun = Instant::now();
    loop {
        let lock = regular::lock_file(path).map_err(|not| match not {
            NotRead::Foreign => Error::from(ErrorKind::AlreadyExists),
            other => other.into(),
        })?;
        match lock.try_lock() {
            // Another run may have removed the file between opening and locking. The lock then
            // protects nothing.
            Ok(()) if still_there(&lock, path) => return Ok(Some(lock)),
            Ok(()) => {}
            // Processes that look share the lock for a moment; one that works does not.
            Err(TryLockError::WouldBlock) if begun.elapsed() < LOOKED_AT && is_shared(&lock)? => {
                std::thread::sleep(Duration::from_millis(1));
            }
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(error)) => return Err(error),
        }
    }
}

/// Whether a lock that is taken is shared; it may be free by now.
fn is_shared(lock: &File) -> Result<bool, Error> {
    match lock.try_lock_shared() {
        Ok(()) => lock.unlock().map(|()| true),
        Err(TryLockError::WouldBlock) => Ok(false),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Whether another process holds the lock `path` at this moment. What is no regular file is no
/// lock.
pub(crate) fn is_held(path: &Path) -> bool {
    let lock = regular::open(path);
    lock.is_ok_and(|lock| matches!(lock.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// Shares the lock `path` with others that do so, creating its file if needed.
pub(crate) fn share(path: &Path) -> Result<File, Error> {
    let lock = regular::lock_file(path)?;
    // Somebody may be looking whether it is shared.
    lock.lock_shared().map(|()| lock)
}

/// Whether another process shares the lock `path` at this moment, or holds it.
pub(crate) fn is_shared_or_held(path: &Path) -> bool {
    let lock = regular::open(path);
    lock.is_ok_and(|lock| matches!(lock.try_lock(), Err(TryLockError::WouldBlock)))
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};

    #[test]
    fn looking_at_a_lock_does_not_keep_a_run_from_taking_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lock");
        drop(acquire(&path).unwrap());
        let done = AtomicBool::new(false);
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| {
                    while !done.load(Ordering::Relaxed) {
                        is_held(&path);
                    }
                });
            }
            let taken = (0..500)
                .filter(|_| acquire(&path).unwrap().is_some())
                .count();
            done.store(true, Ordering::Relaxed);
            assert_eq!(taken, 500);
        });
        let held = acquire(&path).unwrap();
        assert!(is_held(&path) && acquire(&path).unwrap().is_none());
        drop(held);
        assert!(!is_held(&path));
        // A lock that somebody keeps sharing counts as held.
        assert!(!is_shared_or_held(&path));
        let shared = [share(&path).unwrap(), share(&path).unwrap()];
        assert!(is_shared_or_held(&path));
        assert!(!is_held(&path) && acquire(&path).unwrap().is_none());
        drop(shared);
        assert!(!is_shared_or_held(&path));
    }
}
