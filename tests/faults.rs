//! Commands whose calls of the system fail or are their last, one after the other: afterwards the old or the new file is whole,
//! the exit code is true, and the same command succeeds with the same bytes in every dataset.
//!
//! The calls are those by which files are changed (`tests/faults/interpose.c`, which the tests build). `SLIPMAP_FAULTS=all` asks
//! for every one of them; by default some of each command and kind are tried.
#![cfg(target_os = "linux")]

#[path = "common/map.rs"]
mod map;
#[path = "common/program.rs"]
mod program;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use map::datasets;
use program::{Folder, err};

/// Curves, best settings and decay rates in a few tiles' files.
const SWEEP: &str = "
    fields = [\"n_unstable\", \"abscissa\"]
    best = true
    [axes]
    mu_prime = [-0.5, -0.2]
    alpha_n = { from = -3.0, to = 1.0, points = 31 }
    tau = { from = 0.05, to = 9.0, points = 40 }
";
const CASE: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n[fixed]\nv0 = 0.1\nalpha_n = -10\ntau = 0.5\n\
                    [trace]\nuntil = 30\n";

/// How a call ends.
const KINDS: [&str; 4] = ["kill", "eio", "enospc", "eintr"];

/// The interposed library, built once.
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

/// Runs a command; the number of calls it made, where it came to its end, is in `count` beside the folder.
fn faulty(folder: &Folder, args: &[&str], fault: Option<(u64, &str)>, count: &Path) -> Output {
    let mut command = folder.command(args);
    command
        .env("LD_PRELOAD", library())
        .env("FAULTS_FOLDER", folder.path().canonicalize().unwrap())
        .env("FAULTS_COUNT", count);
    if let Some((at, kind)) = fault {
        command
            .env("FAULTS_AT", at.to_string())
            .env("FAULTS_KIND", kind);
    }
    command.output().unwrap()
}

/// What is tried.
struct Case {
    args: &'static [&'static str],
    /// What has to be done before.
    before: &'static [&'static [&'static str]],
    /// The file that the command makes or keeps.
    output: &'static str,
    /// Whether that file is there before.
    replaces: bool,
}

const CASES: [Case; 7] = [
    Case {
        args: &[
            "run",
            "map.toml",
            "--threads",
            "1",
            "--save-every",
            "0",
            "-q",
        ],
        before: &[],
        output: "map.h5",
        replaces: false,
    },
    Case {
        args: &["run", "map.toml", "--threads", "1", "--fresh", "-q"],
        before: &[&["run", "map.toml", "-q"]],
        output: "map.h5",
        replaces: true,
    },
    Case {
        args: &["merge", "map.h5"],
        before: &[
            &["run", "map.toml", "--shard", "1/3", "-q"],
            &["run", "map.toml", "--shard", "2/3", "-q"],
            &["run", "map.toml", "--shard", "3/3", "-q"],
        ],
        output: "map.h5",
        replaces: false,
    },
    Case {
        args: &["simulate", "case.toml"],
        before: &[],
        output: "case.h5",
        replaces: false,
    },
    Case {
        args: &["plot", "map.h5", "-o", "map.svg"],
        before: &[&["run", "map.toml", "-q"]],
        output: "map.svg",
        replaces: false,
    },
    Case {
        args: &["plot", "map.h5", "-o", "drawn.png"],
        before: &[
            &["run", "map.toml", "-q"],
            &["plot", "map.h5", "-o", "drawn.png"],
        ],
        output: "drawn.png",
        replaces: true,
    },
    Case {
        args: &["verify", "map.h5"],
        before: &[&["run", "map.toml", "-q"]],
        output: "map.h5",
        replaces: true,
    },
];

/// A folder in which everything is done that a case needs.
fn prepared(case: &Case) -> Folder {
    let folder = Folder::with(&[("map.toml", SWEEP), ("case.toml", CASE)]);
    for args in case.before {
        let done = folder.run(args);
        assert!(done.status.success(), "{args:?}: {}", err(&done));
    }
    folder
}

/// A copy of a folder without subfolders' folders.
fn copy(from: &Path, to: &Path) {
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

/// What a file says, whatever else it holds: the datasets of HDF5, or its bytes.
#[derive(PartialEq)]
enum Said {
    Datasets(std::collections::BTreeMap<String, Vec<u8>>),
    Bytes(Vec<u8>),
}

fn said(path: &Path) -> Said {
    match path.extension().is_some_and(|e| e == "h5") {
        true => Said::Datasets(datasets(path)),
        false => Said::Bytes(std::fs::read(path).unwrap()),
    }
}

fn all_are_asked_for() -> bool {
    std::env::var("SLIPMAP_FAULTS").is_ok_and(|asked| asked == "all")
}

/// The calls of `total` at which a kind of fault is tried.
fn points(total: u64) -> Vec<u64> {
    let wanted = if all_are_asked_for() { total } else { 8 };
    let mut points: Vec<u64> = (0..wanted.min(total))
        .map(|i| 1 + i * total / wanted.min(total))
        .collect();
    points.push(total);
    points.dedup();
    points
}

#[test]
fn every_fault_leaves_the_old_or_the_new_file() {
    let counted = tempfile::tempdir().unwrap();
    let count = counted.path().join("count");
    let mut tried = 0;
    for case in &CASES {
        let original = prepared(case);
        let folder = Folder::new();
        copy(original.path(), folder.path());
        let whole = faulty(&folder, case.args, None, &count);
        assert!(whole.status.success(), "{:?}: {}", case.args, err(&whole));
        let expected = said(&folder.path().join(case.output));
        let total: u64 = std::fs::read_to_string(&count)
            .unwrap()
            .trim()
            .parse()
            .unwrap();
        println!("{:?}: {total} calls", case.args);
        // Nothing is changed by looking at a map.
        assert_eq!(total == 0, case.args[0] == "verify", "{total}");
        for kind in KINDS {
            for at in points(total).into_iter().filter(|at| *at > 0) {
                let folder = Folder::new();
                copy(original.path(), folder.path());
                check(case, &folder, (at, kind), &expected, &count);
                tried += 1;
            }
        }
    }
    println!("{tried} faults");
    assert!(tried > 100, "{tried}");
}

fn check(case: &Case, folder: &Folder, fault: (u64, &str), expected: &Said, count: &Path) {
    let what = format!("{:?} {fault:?}", case.args);
    let output = folder.path().join(case.output);
    let done = faulty(folder, case.args, Some(fault), count);
    let told = err(&done);
    match fault.1 {
        "kill" => assert!(done.status.code().is_none(), "{what}: {told}"),
        _ => assert!(matches!(done.status.code(), Some(0 | 1)), "{what}: {told}"),
    }
    if fault.1 != "kill" && !done.status.success() {
        // What went wrong is said.
        assert!(
            told.contains("cannot") || told.contains("warning") || told.contains("not"),
            "{what}: {told}"
        );
    }
    match output.exists() {
        // Whatever has the name is whole: the old one says the same.
        true => assert!(said(&output) == *expected, "{what}: {told}"),
        false => assert!(!case.replaces && !done.status.success(), "{what}: {told}"),
    }
    let again: Vec<&str> = case.args.to_vec();
    let again = folder.run(&again);
    assert!(again.status.success(), "{what}: again: {}", err(&again));
    assert!(said(&output) == *expected, "{what}: again");
    let left: Vec<String> = folder
        .files()
        .into_iter()
        .filter(|name| name.contains("slipmap-part") || name.ends_with(".tiles"))
        .collect();
    assert!(left.is_empty(), "{what}: {left:?} is left");
}
