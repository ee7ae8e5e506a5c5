//! A process for tests that answers like one that reads a map, unless a file holds it.

use std::fs;
use std::path::{Path, PathBuf};

use super::process::ReaderCommand;

/// Answers every request with the same map, in frames of `frames.rs`; records that it was started.
const SCRIPT: &str = r#"
echo >> "$1.started"
text='{"title":"","cells":4,"cells_done":4,"axes":[],"fields":[]}'
while read -r line; do
    while [ -e "$1.held" ]; do sleep 0.02; done
    n=${line#*:}
    n=${n%%,*}
    printf "\\$(printf %03o $n)\000\000\000\000\000\000\000\000"
    printf "\\$(printf %03o ${#text})\000\000\000%s" "$text"
done
"#;

pub(super) fn command() -> ReaderCommand {
    ReaderCommand {
        program: "/bin/sh".into(),
        arguments: ["-c", SCRIPT, "reader"].map(String::from).into(),
    }
}

fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.to_owned().into_os_string();
    name.push(ending);
    name.into()
}

/// How many processes were started for a map.
pub(super) fn started(path: &Path) -> usize {
    let told = fs::read_to_string(beside(path, ".started"));
    told.unwrap_or_default().lines().count()
}

/// While this exists, the processes do not answer.
pub(super) struct Held(PathBuf);

pub(super) fn hang(path: &Path) -> Held {
    let held = beside(path, ".held");
    fs::write(&held, "").unwrap();
    Held(held)
}

impl Drop for Held {
    fn drop(&mut self) {
        drop(fs::remove_file(&self.0));
    }
}
