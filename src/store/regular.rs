//! The only way to open files that were named from outside. What is no regular file is refused
//! before it is opened and once more afterwards: opening a pipe, or reading a device, might never
//! end. No more is read than the caller takes.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;
use std::time::{Duration, Instant};

/// How long a file is waited for that another process lets nobody open yet.
const LEASED: Duration = Duration::from_secs(2);

/// Why a file was not read.
#[derive(Debug, thiserror::Error)]
pub enum NotRead {
    /// The system refused.
    #[error("{0}")]
    Refused(io::Error),
    /// It is no regular file.
    #[error("it is no regular file")]
    Foreign,
    /// It has at least this many bytes, too many to read.
    #[error("it has {0} bytes or more")]
    Large(u64),
}

impl From<io::Error> for NotRead {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            // Only what stands for something else has nothing to read yet.
            ErrorKind::WouldBlock => Self::Foreign,
            _ => Self::Refused(error),
        }
    }
}

impl From<NotRead> for io::Error {
    fn from(not: NotRead) -> Self {
        match not {
            NotRead::Refused(error) => error,
            other => Self::other(other.to_string()),
        }
    }
}

/// Opens a regular file to read it.
///
/// # Errors
/// Where there is none, or it is no regular file.
pub(crate) fn open(path: &Path) -> Result<File, NotRead> {
    if !fs::metadata(path)?.is_file() {
        return Err(NotRead::Foreign);
    }
    opened(OpenOptions::new().read(true), path, 0)
}

/// Reads all bytes of a regular file with at most `most` bytes.
///
/// # Errors
/// Where there is none, it is no regular file, or has more bytes.
pub(crate) fn read(path: &Path, most: u64) -> Result<Vec<u8>, NotRead> {
    let file = open(path)?;
    // Some files of the system have more bytes than they say.
    let length = file.metadata()?.len();
    if length > most {
        return Err(NotRead::Large(length));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    match bytes.len() as u64 {
        length if length > most => Err(NotRead::Large(length)),
        _ => Ok(bytes),
    }
}

/// The first bytes of a regular file, `most` or as many as it has.
///
/// # Errors
/// Where [`open`] does not open the file, or it cannot be read.
pub(crate) fn head(path: &Path, most: u64) -> Result<Vec<u8>, NotRead> {
    let mut bytes = Vec::new();
    open(path)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The last bytes of a regular file, `most` or as many as it has.
///
/// # Errors
/// Where [`open`] does not open the file, or it cannot be read.
pub(crate) fn end(path: &Path, most: u64) -> Result<Vec<u8>, NotRead> {
    let mut file = open(path)?;
    let length = file.metadata()?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(most)))?;
    let mut bytes = Vec::new();
    file.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Opens a regular file to append to it. It is created where it is missing; a link is refused.
///
/// # Errors
/// Where something else has this name, or the system refuses.
pub(crate) fn append(path: &Path) -> Result<File, NotRead> {
    own(OpenOptions::new().create(true).append(true), path)
}

/// Opens a regular file to lock it. It is created where it is missing; a link is refused.
pub(crate) fn lock_file(path: &Path) -> Result<File, NotRead> {
    let mut options = OpenOptions::new();
    own(options.create(true).truncate(false).write(true), path)
}

/// Opens a file that slipmap writes beside others.
fn own(options: &mut OpenOptions, path: &Path) -> Result<File, NotRead> {
    if path.symlink_metadata().is_ok_and(|found| !found.is_file()) {
        return Err(NotRead::Foreign);
    }
    #[cfg(unix)]
    let no_link = libc::O_NOFOLLOW;
    #[cfg(not(unix))]
    let no_link = 0;
    opened(options, path, no_link)
}

/// Opens a file without waiting for anybody, and checks what was opened.
fn opened(options: &mut OpenOptions, path: &Path, flags: i32) -> Result<File, NotRead> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags(libc::O_NONBLOCK | flags);
    }
    #[cfg(not(unix))]
    let _ = flags;
    let file = opened_by_all(options, path).map_err(NotRead::Refused)?;
    match file.metadata()?.is_file() {
        true => Ok(file),
        false => Err(NotRead::Foreign),
    }
}

/// Opens a file. Where somebody holds a lease on it, the system asks them to give it up; that is
/// waited for.
fn opened_by_all(options: &OpenOptions, path: &Path) -> io::Result<File> {
    let begun = Instant::now();
    loop {
        match options.open(path) {
            Err(error) if error.kind() == ErrorKind::WouldBlock && begun.elapsed() < LEASED => {
                std::thread::sleep(Duration::from_millis(10));
            }
            opened => return opened,
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::process::Command;

    #[test]
    fn only_regular_files_are_opened_and_no_more_is_read_than_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("file"), "0123456789").unwrap();
        assert!(
            Command::new("mkfifo")
                .arg(path("pipe"))
                .status()
                .unwrap()
                .success()
        );
        for (name, to) in [("zero", "/dev/zero"), ("link", "file"), ("to pipe", "pipe")] {
            std::os::unix::fs::symlink(to, path(name)).unwrap();
        }
        for name in ["pipe", "zero", "to pipe", "."] {
            assert!(matches!(open(&path(name)), Err(NotRead::Foreign)), "{name}");
            assert!(
                matches!(append(&path(name)), Err(NotRead::Foreign)),
                "{name}"
            );
            assert!(
                matches!(lock_file(&path(name)), Err(NotRead::Foreign)),
                "{name}"
            );
        }
        assert!(matches!(append(&path("link")), Err(NotRead::Foreign)));
        assert_eq!(read(&path("link"), 10).unwrap(), b"0123456789");
        assert!(matches!(read(&path("file"), 9), Err(NotRead::Large(10))));
        assert_eq!(head(&path("file"), 3).unwrap(), b"012");
        assert_eq!(end(&path("file"), 3).unwrap(), b"789");
        assert_eq!(end(&path("file"), 30).unwrap(), b"0123456789");
        assert!(matches!(end(&path("pipe"), 3), Err(NotRead::Foreign)));
        assert!(matches!(read(&path("none"), 9), Err(NotRead::Refused(_))));
        assert!(lock_file(&path("new")).is_ok() && append(&path("new")).is_ok());
    }

    /// Who is asked to give up a lease on a file is waited for, but not for long.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_leased_file_is_waited_for() {
        use std::os::fd::AsRawFd;
        // `F_SETSIG` of <fcntl.h>.
        const SET_SIGNAL: i32 = 10;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        fs::write(&path, "text").unwrap();
        let holder = OpenOptions::new().write(true).open(&path).unwrap();
        let lease = |kind: i32| {
            // SAFETY: the file is open. The signal that asks for the lease is one that is ignored.
            let set = unsafe {
                libc::fcntl(holder.as_raw_fd(), SET_SIGNAL, libc::SIGURG)
                    | libc::fcntl(holder.as_raw_fd(), libc::F_SETLEASE, kind)
            };
            assert_eq!(set, 0, "{}", io::Error::last_os_error());
        };
        lease(libc::F_WRLCK);
        let begun = Instant::now();
        let refused = open(&path).unwrap_err();
        assert!(begun.elapsed() >= LEASED);
        let NotRead::Refused(error) = refused else {
            panic!("{refused}");
        };
        assert_eq!(error.raw_os_error(), Some(libc::EWOULDBLOCK));
        lease(libc::F_UNLCK);
        lease(libc::F_WRLCK);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(Duration::from_millis(200));
                lease(libc::F_UNLCK);
            });
            assert_eq!(read(&path, 9).unwrap(), b"text");
        });
    }

    /// Files of the system say that they have no bytes.
    #[cfg(target_os = "linux")]
    #[test]
    fn files_that_say_nothing_of_their_length_are_bounded_too() {
        let maps = Path::new("/proc/self/maps");
        assert_eq!(maps.metadata().unwrap().len(), 0);
        assert!(matches!(read(maps, 100), Err(NotRead::Large(101))));
        assert!(read(maps, 1 << 24).unwrap().len() > 100);
    }
}
