//! Whether a file is still being copied: it is judged once it has not changed for a while.

use std::collections::HashMap;
use std::fs::File;
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

use super::name::Name;
use crate::store::stamp::Stamp;

/// How long a file has to be unchanged.
pub(super) const UNCHANGED_FOR: Duration = Duration::from_secs(2);

/// Marks a file that is whole: a worker need not wait for more of it.
///
/// # Errors
/// When the system refuses.
pub(super) fn mark_whole(file: &File) -> std::io::Result<()> {
    file.set_modified(SystemTime::now() - UNCHANGED_FOR)
}

/// The files that were seen changing.
#[derive(Debug, Default)]
pub(super) struct Changing(HashMap<Name, (Stamp, Instant)>);

impl Changing {
    /// Whether the file of a job has not changed for a while: by its own time or, since clocks of
    /// machines differ, by what was seen of it.
    pub(super) fn is_over(&mut self, name: &Name, path: &Path) -> bool {
        let Some(stamp) = Stamp::of(path) else {
            return true;
        };
        let age = stamp
            .modified
            .and_then(|at| SystemTime::now().duration_since(at).ok());
        if age.is_some_and(|age| age >= UNCHANGED_FOR) {
            self.0.remove(name);
            return true;
        }
        let seen = self
            .0
            .entry(name.clone())
            .or_insert((stamp, Instant::now()));
        if seen.0 != stamp {
            *seen = (stamp, Instant::now());
        }
        seen.1.elapsed() >= UNCHANGED_FOR
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn a_file_is_judged_once_it_no_longer_changes() {
        let folder = tempfile::tempdir().unwrap();
        let (path, name) = (folder.path().join("a.toml"), Name::of_stem("a"));
        let mut file = File::create_new(&path).unwrap();
        let mut changing = Changing::default();
        assert!(!changing.is_over(&name, &path));
        mark_whole(&file).unwrap();
        assert!(changing.is_over(&name, &path));
        // Its clock is ahead: what was seen of it decides.
        let ahead = SystemTime::now() + Duration::from_secs(3600);
        file.set_modified(ahead).unwrap();
        assert!(!changing.is_over(&name, &path));
        let begun = Instant::now();
        while !changing.is_over(&name, &path) {
            std::thread::sleep(Duration::from_millis(20));
        }
        assert!(begun.elapsed() + Duration::from_millis(100) >= UNCHANGED_FOR);
        file.write_all(b"more").unwrap();
        assert!(!changing.is_over(&name, &path));
    }
}
