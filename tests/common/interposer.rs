//! The library that stands between a program and the system, `tests/faults/interpose.c`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use super::program::{Folder, err};

/// Curves, best settings and decay rates in a few tiles.
pub(crate) const SWEEP: &str = "
    fields = [\"n_unstable\", \"abscissa\"]
    best = true
    [axes]
    mu_prime = [-0.5, -0.2]
    alpha_n = { from = -3.0, to = 1.0, points = 31 }
    tau = { from = 0.05, to = 9.0, points = 40 }
";

/// The library, built once.
fn library() -> &'static Path {
    static BUILT: OnceLock<(tempfile::TempDir, PathBuf)> = OnceLock::new();
    let (_, path) = BUILT.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("libfaults.so");
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/faults/interpose.c");
        // Rust links with a C compiler too, so there is one.
        let built = Command::new("cc")
            .args(["-shared", "-fPIC", "-O1", "-o"])
            .arg(&path)
            .args([source, "-ldl"])
            .output()
            .expect("a C compiler");
        assert!(built.status.success(), "{}", err(&built));
        (folder, path)
    });
    path
}

/// A command whose calls on what lies in `folder` go through the library.
pub(crate) fn interposed(folder: &Folder, args: &[&str]) -> Command {
    let mut command = folder.command(args);
    command
        .env("LD_PRELOAD", library())
        .env("FAULTS_FOLDER", folder.path().canonicalize().unwrap());
    command
}

/// Copies all that is in a folder.
pub(crate) fn copy(from: &Path, to: &Path) {
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let place = to.join(entry.file_name());
        match entry.file_type().unwrap().is_dir() {
            true => {
                std::fs::create_dir(&place).unwrap();
                copy(&entry.path(), &place);
            }
            false => drop(std::fs::copy(entry.path(), place).unwrap()),
        }
    }
}
