//! The revision of a folder of source. `build.rs` puts it into the program; here it is tested.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use std::process::Command;

/// How git ends the revision of a source that was changed since.
const DIRTY: &str = "-dirty";
/// What the program is made from.
pub(crate) const SOURCE: [&str; 4] = ["Cargo.toml", "Cargo.lock", "build.rs", "src"];

/// Git's revision where the repository is the folder's own, else that which a package carries, else
/// one made of the source's bytes. Where the source is not that of the revision its bytes count
/// too: two programs of different source never have the same one.
pub(crate) fn of(folder: &Path) -> String {
    let own = folder.join(".git").exists().then(|| of_git(folder));
    let known = own.flatten().or_else(|| of_package(folder));
    match known {
        Some(dirty) if dirty.ends_with(DIRTY) => format!("{dirty}-{}", of_source(folder)),
        Some(revision) => revision,
        None => format!("source-{}", of_source(folder)),
    }
}

fn of_git(folder: &Path) -> Option<String> {
    let output = Command::new("git")
        .arg("-C")
        .arg(folder)
        .args([
            "describe",
            "--always",
            "--dirty",
            "--abbrev=12",
            "--exclude=*",
        ])
        .output()
        .ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

/// What `cargo package` writes: `{"git": {"sha1": "…", "dirty": true}, …}`.
fn of_package(folder: &Path) -> Option<String> {
    let text = std::fs::read_to_string(folder.join(".cargo_vcs_info.json")).ok()?;
    let after = text.split("\"sha1\"").nth(1)?;
    let sha1 = after.split('"').nth(1)?;
    let known = sha1.len() >= 12 && sha1.bytes().all(|b| b.is_ascii_hexdigit());
    let dirty = text.contains("\"dirty\": true") || text.contains("\"dirty\":true");
    known.then(|| format!("{}{}", &sha1[..12], if dirty { DIRTY } else { "" }))
}

fn of_source(folder: &Path) -> String {
    let mut hash = DefaultHasher::new();
    for part in SOURCE {
        hash_all(&folder.join(part), &mut hash);
    }
    format!("{:016x}", hash.finish())
}

fn hash_all(path: &Path, hash: &mut DefaultHasher) {
    if let Ok(bytes) = std::fs::read(path) {
        bytes.hash(hash);
        return;
    }
    let mut inside: Vec<_> = std::fs::read_dir(path)
        .map(|entries| entries.flatten().map(|entry| entry.path()).collect())
        .unwrap_or_default();
    inside.sort();
    for path in inside {
        path.file_name().hash(hash);
        hash_all(&path, hash);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(files: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        folder
    }

    fn git(folder: &Path, arguments: &[&str]) {
        let identity = ["-c", "user.name=n", "-c", "user.email=e@x"];
        let status = Command::new("git")
            .arg("-C")
            .arg(folder)
            .args(identity)
            .args(arguments)
            .output();
        assert!(status.unwrap().status.success(), "git {arguments:?}");
    }

    /// A folder inside of another repository does not have that one's revision.
    #[test]
    fn a_repository_around_it_is_not_its_own() {
        let outer = written(&[("inner/src/lib.rs", "one"), ("inner/Cargo.toml", "")]);
        git(outer.path(), &["init", "-q"]);
        git(outer.path(), &["add", "."]);
        git(outer.path(), &["commit", "-qm", "all"]);
        let inner = outer.path().join("inner");
        let first = of(&inner);
        assert!(first.starts_with("source-"), "{first}");
        assert_eq!(of(&inner), first);
        std::fs::write(inner.join("src/lib.rs"), "two").unwrap();
        assert_ne!(of(&inner), first);
        let own = of(outer.path());
        assert!(own.contains("-dirty-"), "{own}");
    }

    /// Two sources that were both changed since the same revision are not the same program; one
    /// that was not changed is.
    #[test]
    fn changed_sources_differ_by_what_was_changed() {
        let files = [("src/lib.rs", "one"), ("Cargo.toml", ""), ("notes", "")];
        let folder = written(&files);
        git(folder.path(), &["init", "-q"]);
        git(folder.path(), &["add", "."]);
        git(folder.path(), &["commit", "-qm", "all"]);
        let clean = of(folder.path());
        assert!(!clean.contains(DIRTY), "{clean}");
        let changed = |file: &str, text: &str| {
            std::fs::write(folder.path().join(file), text).unwrap();
            of(folder.path())
        };
        let two = changed("src/lib.rs", "two");
        assert!(two.starts_with(&format!("{clean}{DIRTY}-")), "{two}");
        let three = changed("src/lib.rs", "three");
        assert_ne!(three, two);
        assert_eq!(changed("src/lib.rs", "two"), two);
        assert_eq!(changed("notes", "not of the program"), two);
        assert_ne!(changed("Cargo.toml", "[features]"), two);
    }

    #[test]
    fn a_package_has_the_revision_it_was_made_from() {
        let sha1 = "0123456789abcdef0123456789abcdef01234567";
        let info = format!(r#"{{ "git": {{ "sha1": "{sha1}" }}, "path_in_vcs": "" }}"#);
        let package = written(&[(".cargo_vcs_info.json", &info), ("src/lib.rs", "")]);
        assert_eq!(of(package.path()), "0123456789ab");
        let dirty = info.replace("\" }", "\", \"dirty\": true }");
        let package = written(&[(".cargo_vcs_info.json", &dirty)]);
        let found = of(package.path());
        assert!(found.starts_with("0123456789ab-dirty-"), "{found}");
        std::fs::write(package.path().join("Cargo.lock"), "other").unwrap();
        assert_ne!(of(package.path()), found);
        let damaged = written(&[(".cargo_vcs_info.json", "{\"git\": 3}"), ("src/lib.rs", "")]);
        assert!(of(damaged.path()).starts_with("source-"));
    }
}
