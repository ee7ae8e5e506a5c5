//! The files of a queue in the folder `q` of a test.

use super::program::Folder;

/// What is in the queue besides what every queue has.
pub(crate) fn left(folder: &Folder) -> Vec<String> {
    let entries = std::fs::read_dir(folder.path().join("q/queue")).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names
        .filter(|name| ![".lock", ".workers"].contains(&&**name))
        .collect()
}
