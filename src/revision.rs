//! The revision of a folder of source. `build.rs` puts it into the program; here it is tested.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use std::process::Command;

/// Git's revision where the repository is the folder's own, else that which a package carries, else one made of the source's bytes: two
/// programs of different source never have the same one.
pub fn of(folder: &Path) -> String {
    let own = folder.join(".git").exists().then(|| of_git(folder));
    own.flatten()
        .or_else(|| of_package(folder))
        .unwrap_or_else(|| of_source(folder))
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
    known.then(|| format!("{}{}", &sha1[..12], if dirty { "-dirty" } else { "" }))
}

fn of_source(folder: &Path) -> String {
    let mut hash = DefaultHasher::new();
    for part in ["Cargo.toml", "Cargo.lock", "src"] {
        hash_all(&folder.join(part), &mut hash);
    }
    format!("source-{:016x}", hash.finish())
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
        assert!(own.ends_with("-dirty"), "{own}");
    }

    #[test]
    fn a_package_has_the_revision_it_was_made_from() {
        let info = r#"{ "git": { "sha1": "0123456789abcdef0123456789abcdef01234567" }, "path_in_vcs": "" }"#;
        let package = written(&[(".cargo_vcs_info.json", info), ("src/lib.rs", "")]);
        assert_eq!(of(package.path()), "0123456789ab");
        let dirty = info.replace("\" }", "\", \"dirty\": true }");
        let package = written(&[(".cargo_vcs_info.json", &dirty)]);
        assert_eq!(of(package.path()), "0123456789ab-dirty");
        let damaged = written(&[(".cargo_vcs_info.json", "{\"git\": 3}"), ("src/lib.rs", "")]);
        assert!(of(damaged.path()).starts_with("source-"));
    }
}
