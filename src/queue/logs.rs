//! Logs beside a map: which files they are, and how they end.

use std::fs;
use std::path::{Path, PathBuf};

use crate::store::regular;

/// The most bytes that are read for the last lines of a log.
const MOST_BYTES: u64 = 64 << 10;

/// The logs whose paths begin with `begin`, which is the path of a map or the begin of a name.
pub(crate) fn logs(begin: &Path) -> Vec<PathBuf> {
    let stem = begin.file_name().unwrap_or_default().as_encoded_bytes();
    let is_log = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().as_encoded_bytes();
        name.starts_with(stem) && name.ends_with(b".log")
    };
    let entries = begin.parent().and_then(|folder| fs::read_dir(folder).ok());
    let paths = { entries.into_iter().flatten().flatten() }.map(|entry| entry.path());
    paths.filter(is_log).collect()
}

/// The log that was written last.
pub(crate) fn newest(logs: Vec<PathBuf>) -> Option<PathBuf> {
    let written = |log: &PathBuf| log.metadata().and_then(|told| told.modified()).ok();
    logs.into_iter().max_by_key(written)
}

/// The whole lines in the last `most` bytes of a log; empty where it cannot be read.
pub(crate) fn end(log: &Path, most: u64) -> String {
    let end = regular::end(log, most).unwrap_or_default();
    let whole_lines = match end.len() as u64 == most {
        // The first line may be cut off.
        true => end
            .iter()
            .position(|&byte| byte == b'\n')
            .map_or(0, |at| at + 1),
        false => 0,
    };
    String::from_utf8_lossy(&end[whole_lines..]).into_owned()
}

/// The last lines of a log, at most so many.
#[cfg(feature = "cli")]
pub(super) fn last_lines(log: &Path, most: usize) -> String {
    let end = end(log, MOST_BYTES);
    let lines: Vec<&str> = end.lines().collect();
    lines[lines.len().saturating_sub(most)..].join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_of_a_map_are_found_and_end_in_whole_lines() {
        let folder = tempfile::tempdir().unwrap();
        let map = folder.path().join("a.h5");
        let file = |name: &str| folder.path().join(name);
        for name in [
            "a.h5.log",
            "a.h5.1-of-2.log",
            "b.h5.log",
            "a.h5",
            "a.h5.txt",
        ] {
            fs::write(file(name), "first\nsecond\nthird\n").unwrap();
        }
        let mut found = logs(&map);
        found.sort();
        assert_eq!(found, [file("a.h5.1-of-2.log"), file("a.h5.log")]);
        let new = fs::File::options()
            .write(true)
            .open(file("a.h5.log"))
            .unwrap();
        let later = std::time::SystemTime::now() + std::time::Duration::from_secs(60);
        new.set_modified(later).unwrap();
        let log = newest(found).unwrap();
        assert_eq!(log, file("a.h5.log"));
        assert_eq!(end(&log, 100), "first\nsecond\nthird\n");
        assert_eq!(end(&log, 10), "third\n");
        assert_eq!(last_lines(&log, 2), "second\nthird");
        assert_eq!(last_lines(&file("none"), 2), "");
    }
}
