//! Files that outlast a loss of power: written whole and synced, then given their final name.

use std::fs::{self, File};
use std::io::{BufWriter, ErrorKind};
use std::path::Path;

use super::error::StoreError;

/// Writes a new file and makes it durable. Whatever stands at `path` already, such as a planted
/// link, is not written to.
pub(crate) fn write_synced(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
) -> Result<(), StoreError> {
    let written = || -> std::io::Result<()> {
        let mut out = BufWriter::with_capacity(1 << 16, File::create_new(path)?);
        write(&mut out)?;
        let file = out
            .into_inner()
            .map_err(std::io::IntoInnerError::into_error)?;
        file.sync_all()
    };
    written().map_err(|error| {
        if error.kind() != ErrorKind::AlreadyExists {
            // A half-written file is of no use, and takes up space on a full disk.
            let _ = fs::remove_file(path);
        }
        StoreError::io("write", path)(error)
    })
}

/// Removes a file; false if it is not there.
///
/// # Errors
/// When the system refuses.
pub(crate) fn remove_if_there(path: &Path) -> Result<bool, StoreError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        removed => removed
            .map(|()| true)
            .map_err(StoreError::io("remove", path)),
    }
}

/// Makes a file or a folder durable.
pub(crate) fn sync(path: &Path) -> Result<(), StoreError> {
    let synced = File::open(path).and_then(|file| file.sync_all());
    synced.map_err(StoreError::io("sync", path))
}

/// Gives a durable file its final name, durably, replacing what stood there.
pub(crate) fn rename_synced(part: &Path, path: &Path) -> Result<(), StoreError> {
    fs::rename(part, path).map_err(StoreError::io("rename to", path))?;
    sync_name(path)
}

/// Makes the name of a file or a folder durable by syncing its parent. Without this a folder can be
/// lost with all its contents, however often those were synced.
pub(crate) fn sync_name(path: &Path) -> Result<(), StoreError> {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => sync(folder),
        _ => sync(Path::new(".")),
    }
}
