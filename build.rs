//! Puts the revision of the source into the program, so that every map can name it.

use std::path::Path;

#[path = "src/revision.rs"]
mod revision;

fn main() {
    // A path that is not there would make every build a new one.
    let versions = [".git/HEAD", ".git/refs", ".cargo_vcs_info.json"];
    for path in versions.into_iter().chain(revision::SOURCE) {
        if Path::new(path).exists() {
            println!("cargo:rerun-if-changed={path}");
        }
    }
    let manifest = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_else(|_| ".".to_owned());
    let revision = revision::of(Path::new(&manifest));
    println!("cargo:rustc-env=SLIPMAP_GIT_REVISION={revision}");
}
