//! Opens HDF5 files to read them.

use std::path::Path;

use hdf5::File;

use super::error::StoreError;
use super::lock;

/// Opens the file at `path`; `refuse` says that it is not what is looked for, and why.
pub(super) fn to_read(
    path: &Path,
    refuse: impl Fn(&Path, &'static str) -> StoreError,
) -> Result<File, StoreError> {
    let metadata = std::fs::metadata(path).map_err(StoreError::io("open", path))?;
    if metadata.is_dir() {
        return Err(refuse(path, "it is a folder"));
    }
    if !metadata.is_file() {
        return Err(refuse(path, "it is no regular file"));
    }
    if path.to_str().is_none() {
        return Err(refuse(
            path,
            "its name is not UTF-8, and HDF5 does not open it",
        ));
    }
    std::fs::File::open(path).map_err(StoreError::io("open", path))?;
    File::open(path).map_err(|_| {
        // The library locks what it writes.
        if lock::is_held(path) {
            return StoreError::InUse {
                path: path.to_owned(),
            };
        }
        refuse(path, "it is no HDF5 file, or a damaged one")
    })
}
