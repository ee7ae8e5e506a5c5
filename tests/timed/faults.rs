//! Commands whose calls of the system fail or are their last, one after the other: afterwards the
//! old or the new file is whole, the exit code is true, and the same command succeeds with the same
//! bytes in every dataset.
//!
//! The calls are those by which files are changed (`tests/faults/interpose.c`, which the tests
//! build). `SLIPMAP_FAULTS=all` asks for every one of them; by default some of each command and
//! kind are tried.
#![cfg(target_os = "linux")]

use std::path::Path;
use std::process::Output;
use std::time::{Duration, Instant};

use crate::alone;
use crate::interposer::{SWEEP, copy, interposed};
use crate::map::datasets;
use crate::program::{Folder, Started, err, expect, output};

const CASE: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n[fixed]\nv0 = 0.1\nalpha_n = -10\ntau = 0.5\n\
                    [trace]\nuntil = 30\n";

/// How a call ends.
const KINDS: [&str; 5] = ["kill", "eio", "enospc", "eintr", "term"];

/// Runs a command; the number of calls it made, where it came to its end, is in `count` beside the
/// folder.
fn faulty(folder: &Folder, args: &[&str], fault: Option<(u64, &str)>, count: &Path) -> Output {
    let mut command = interposed(folder, args);
    command.env("FAULTS_COUNT", count);
    if let Some((at, kind)) = fault {
        command
            .env("FAULTS_AT", at.to_string())
            .env("FAULTS_KIND", kind);
    }
    output(&mut command)
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
fn points(total: u64, kind: &str) -> Vec<u64> {
    let wanted = match kind {
        _ if all_are_asked_for() => total,
        "term" => 4,
        _ => 8,
    };
    let mut points: Vec<u64> = (0..wanted.min(total))
        .map(|i| 1 + i * total / wanted.min(total))
        .collect();
    points.push(total);
    points.dedup();
    points
}

#[test]
fn every_fault_leaves_the_old_or_the_new_file() {
    let _alone = alone();
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
            for at in points(total, kind).into_iter().filter(|at| *at > 0) {
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
        "term" => check_stopped(&done, folder, &what),
        _ => assert!(matches!(done.status.code(), Some(0 | 1)), "{what}: {told}"),
    }
    if fault.1 != "kill" && !done.status.success() {
        // What went wrong is said.
        assert!(
            told.contains("interrupted")
                || told.contains("cannot")
                || told.contains("warning")
                || told.contains("not"),
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
        .filter(|name| name.contains("slipmap-part") || name.contains(".tiles"))
        .collect();
    assert!(left.is_empty(), "{what}: {left:?} is left");
}

/// A command that a signal came to ended in order: what it had begun to write is gone.
fn check_stopped(done: &Output, folder: &Folder, what: &str) {
    let code = done.status.code();
    assert!(matches!(code, Some(0 | 143)), "{what}: {}", err(done));
    let hidden = |name: &String| name.starts_with('.');
    let left: Vec<String> = folder.files().into_iter().filter(hidden).collect();
    assert!(left.is_empty(), "{what}: {left:?} is left");
}

/// A command whose every look into a file takes long gets a signal once `when` is so: it ends soon,
/// with nothing half done.
fn stopped_soon(
    folder: &Folder,
    args: &[&str],
    (name, code): (&str, i32),
    (slow_once, when): (&str, &dyn Fn() -> bool),
    after: u64,
) {
    let mut command = interposed(folder, args);
    let command = command.env("FAULTS_DELAY", "20");
    let mut child = Started::of(command.env("FAULTS_DELAY_ONCE", slow_once));
    let begun = Instant::now();
    while !when() {
        assert!(child.goes_on(), "{args:?} is over");
        assert!(begun.elapsed() < Duration::from_secs(30), "{args:?}");
        std::thread::sleep(Duration::from_millis(5));
    }
    // The work that is under way is slow.
    std::thread::sleep(Duration::from_millis(after));
    assert!(child.goes_on(), "{args:?} is over");
    let sent = Instant::now();
    child.signal(&format!("-{name}"));
    let ended = child.ended();
    let took = sent.elapsed();
    println!("{args:?}: {name}, ended after {took:?}");
    // Opening a map is some fifty looks, after which a signal is heeded.
    assert!(took < Duration::from_secs(2), "{args:?}: {took:?}");
    expect(&ended, code, "interrupted: ");
    let hidden = |name: &String| name.starts_with('.');
    let left: Vec<String> = folder.files().into_iter().filter(hidden).collect();
    assert!(left.is_empty(), "{args:?}: {left:?} is left");
}

#[test]
fn signals_end_merging_and_drawing_soon() {
    let _alone = alone();
    let folder = Folder::with(&[("map.toml", SWEEP)]);
    let [map, picture, tiles, part] = ["map.h5", "map.png", "map.h5.tiles", ".map.h5.slipmap-part"]
        .map(|name| folder.path().join(name));
    for shard in ["1/2", "2/2"] {
        let done = folder.run(&["run", "map.toml", "--shard", shard]);
        assert!(done.status.success(), "{}", err(&done));
    }
    let merge = ["merge", "map.h5"];
    // While tiles are put together, and while the map is hashed and read back.
    for after in [100, 900, 1500, 2100, 2900] {
        let begun = || part.exists();
        stopped_soon(&folder, &merge, ("INT", 130), ("map.toml", &begun), after);
    }
    assert!(!map.exists() && tiles.join("1-of-2/manifest.json").exists());
    let drawing = || map.exists() && !tiles.exists();
    stopped_soon(&folder, &merge, ("HUP", 129), ("map.h5", &drawing), 100);
    assert!(map.exists() && !picture.exists());
    // The same command draws what was not drawn.
    let whole = datasets(&map);
    expect(&folder.run(&merge), 0, "map.h5 is already complete");
    assert!(picture.exists());
    std::fs::remove_file(&map).unwrap();
    let run = ["run", "map.toml", "-q"];
    stopped_soon(&folder, &run, ("TERM", 143), ("map.h5", &drawing), 100);
    assert!(datasets(&map) == whole);
    for (signal, name) in [(("INT", 130), "drawn.png"), (("TERM", 143), "drawn.svg")] {
        let plot = ["plot", "map.h5", "-o", name];
        stopped_soon(&folder, &plot, signal, ("map.h5", &|| true), 100);
        assert!(!folder.path().join(name).exists());
        expect(&folder.run(&plot), 0, name);
    }
    // The picture beside the map is one of its predecessor.
    let older = picture.metadata().unwrap().modified().unwrap();
    expect(&folder.run(&run), 0, "map.h5 is already complete");
    assert!(picture.metadata().unwrap().modified().unwrap() > older);
}
