//! Limits on memory of the control groups of this process, which containers, batch systems and
//! services set.

use std::path::Path;

use crate::store::regular;

/// The most bytes of a file of the system that are read.
const MOST_READ: u64 = 1 << 16;

/// The files of a control group that tell its memory.
struct Files {
    limits: &'static [&'static str],
    taken: &'static str,
    /// The line of `memory.stat` with what counts as taken and is given up for others: the pages of
    /// files that are not in use.
    given_up: &'static str,
}

const FIRST_VERSION: Files = Files {
    limits: &["memory.limit_in_bytes"],
    taken: "memory.usage_in_bytes",
    given_up: "total_inactive_file",
};
const SECOND_VERSION: Files = Files {
    limits: &["memory.max", "memory.high"],
    taken: "memory.current",
    given_up: "inactive_file",
};

/// The text of a file of the system; none where there is none.
pub(super) fn text(path: &Path) -> Option<String> {
    String::from_utf8(regular::head(path, MOST_READ).ok()?).ok()
}

/// The number behind a word at the begin of a line.
pub(super) fn number_of(word: &str, text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(word))?;
    line.split_whitespace().next()?.parse().ok()
}

/// The bytes that the control groups of this process leave; none without a limit.
pub(super) fn left() -> Option<u64> {
    let own = text(Path::new("/proc/self/cgroup"))?;
    left_by(Path::new("/sys/fs/cgroup"), &own)
}

/// The bytes that the groups in `own`, lines `NUMBER:CONTROLLERS:PATH`, leave, and all groups that
/// hold them. A container that does not see its own path sees its group as the topmost.
fn left_by(root: &Path, own: &str) -> Option<u64> {
    let of_line = |line: &str| {
        let mut parts = line.splitn(3, ':').skip(1);
        let (controllers, path) = (parts.next()?, parts.next()?);
        let (top, files) = match controllers {
            "" => (root.to_owned(), &SECOND_VERSION),
            names if names.split(',').any(|name| name == "memory") => {
                (root.join("memory"), &FIRST_VERSION)
            }
            _ => return None,
        };
        let groups = Path::new(path.trim_start_matches('/')).ancestors();
        groups
            .filter_map(|group| left_in(&top.join(group), files))
            .min()
    };
    own.lines().filter_map(of_line).min()
}

/// The bytes that one group leaves.
fn left_in(group: &Path, files: &Files) -> Option<u64> {
    let number = |name: &str| text(&group.join(name))?.trim().parse::<u64>().ok();
    let limit = files.limits.iter().filter_map(|name| number(name)).min()?;
    let statistics = text(&group.join("memory.stat")).unwrap_or_default();
    let given_up = number_of(&format!("{} ", files.given_up), &statistics).unwrap_or(0);
    let taken = number(files.taken).unwrap_or(0).saturating_sub(given_up);
    Some(limit.saturating_sub(taken))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder with files and their texts, as the system shows control groups.
    fn groups(files: &[(&str, &str)]) -> tempfile::TempDir {
        let root = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = root.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        root
    }

    #[test]
    fn the_narrowest_of_all_groups_above_counts() {
        let root = groups(&[
            ("job/memory.max", "4000\n"),
            ("job/memory.high", "max\n"),
            ("job/memory.current", "1500\n"),
            (
                "job/memory.stat",
                "anon 1000\ninactive_file 300\nactive_file 7\n",
            ),
            ("job/step/memory.max", "max\n"),
            ("job/step/memory.high", "3500\n"),
            ("job/step/memory.current", "100\n"),
            ("other/memory.max", "1\n"),
        ]);
        let left = |own: &str| left_by(root.path(), own);
        assert_eq!(left("0::/job/step\n"), Some(2800));
        assert_eq!(left("0::/job\n"), Some(2800));
        assert_eq!(left("0::/job/step/inner\n"), Some(2800));
        assert_eq!(left("0::/\n"), None);
        assert_eq!(left("0::/elsewhere\n1:cpu:/job\nno line\n"), None);
    }

    #[test]
    fn groups_of_the_first_version_count_too() {
        let root = groups(&[
            ("memory/memory.limit_in_bytes", "9000\n"),
            ("memory/memory.usage_in_bytes", "9500\n"),
            (
                "memory/memory.stat",
                "inactive_file 1\ntotal_inactive_file 2500\n",
            ),
            ("memory/job/memory.limit_in_bytes", "9223372036854771712\n"),
        ]);
        let own = "9:name=systemd:/\n4:cpu,memory:/job\n0::/\n";
        assert_eq!(left_by(root.path(), own), Some(2000));
        // The path is the one outside of the container.
        let own = "4:memory:/docker/0123\n";
        assert_eq!(left_by(root.path(), own), Some(2000));
    }

    #[test]
    fn a_full_group_leaves_nothing() {
        let root = groups(&[("memory.max", "10"), ("memory.current", "11")]);
        assert_eq!(left_by(root.path(), "0::/"), Some(0));
    }
}
