//! Files that outlast a loss of power: written whole and synced, then given their final name.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;

use super::error::StoreError;

/// Writes a new file and makes it durable.
pub(super) fn write_synced(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
) -> Result<(), StoreError> {
    let written = || -> std::io::Result<()> {
        let mut out = BufWriter::with_capacity(1 << 16, File::create(path)?);
        write(&mut out)?;
        let file = out
            .into_inner()
            .map_err(std::io::IntoInnerError::into_error)?;
        file.sync_all()
    };
    written().map_err(|error| {
        // What is half written is of no use, and on a full disk in the way.
        let _ = fs::remove_file(path);
        StoreError::io("write", path)(error)
    })
}

/// Makes a file or a folder durable.
pub(super) fn sync(path: &Path) -> Result<(), StoreError> {
    let synced = File::open(path).and_then(|file| file.sync_all());
    synced.map_err(StoreError::io("sync", path))
}

/// Gives a durable file its final name, durably, replacing what stood there.
pub(super) fn rename_synced(part: &Path, path: &Path) -> Result<(), StoreError> {
    fs::rename(part, path).map_err(StoreError::io("rename to", path))?;
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => sync(folder),
        _ => sync(Path::new(".")),
    }
}
