//! A socket in the file system, for `ssh -L`: only its owner can open it.

use std::fs;
use std::io::{Error, ErrorKind, Result};
use std::os::unix::fs::{FileTypeExt, PermissionsExt};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};

/// The name of a socket that this process listens on. Dropping it removes the socket, so it must
/// outlive the listener.
#[derive(Debug)]
pub(super) struct Socket {
    path: PathBuf,
}

impl Socket {
    /// Listens at `path`. Only a socket whose server has ended is replaced, no other file.
    pub(super) fn listen(path: &Path) -> Result<(Self, UnixListener)> {
        remove_stale(path)?;
        let listener = UnixListener::bind(path)?;
        fs::set_permissions(path, fs::Permissions::from_mode(0o600))?;
        let path = path.to_owned();
        Ok((Self { path }, listener))
    }
}

impl Drop for Socket {
    fn drop(&mut self) {
        // Another server may have taken the name. A socket left behind is replaced by the next
        // server.
        drop(remove_stale(&self.path));
    }
}

/// Removes a socket that nobody listens on.
fn remove_stale(path: &Path) -> Result<()> {
    let found = match path.symlink_metadata() {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        found => found?,
    };
    let refuse = |why| Err(Error::new(ErrorKind::AlreadyExists, why));
    if !found.file_type().is_socket() {
        return refuse("something that is no socket is there");
    }
    match UnixStream::connect(path) {
        Err(error) if error.kind() == ErrorKind::ConnectionRefused => fs::remove_file(path),
        Ok(_) => refuse("another server listens there"),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_stale_sockets_are_replaced_and_own_ones_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s");
        let (socket, listener) = Socket::listen(&path).unwrap();
        let mode = fs::metadata(&path).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
        assert_eq!(
            Socket::listen(&path).unwrap_err().kind(),
            ErrorKind::AlreadyExists
        );
        // Somebody removes the name, and another server takes it.
        fs::remove_file(&path).unwrap();
        let (other, others) = Socket::listen(&path).unwrap();
        drop((listener, socket));
        assert!(path.exists(), "it is another's by now");
        drop(others);
        let left = std::mem::ManuallyDrop::new(other);
        assert!(path.exists(), "left behind as by a server that was killed");
        let (last, listener) = Socket::listen(&left.path).unwrap();
        drop((listener, last));
        assert!(!path.exists());
        fs::write(&path, "text").unwrap();
        assert_eq!(
            Socket::listen(&path).unwrap_err().kind(),
            ErrorKind::AlreadyExists
        );
        assert_eq!(fs::read_to_string(&path).unwrap(), "text");
        let link = folder.path().join("l");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        assert!(Socket::listen(&link).is_err());
    }
}
