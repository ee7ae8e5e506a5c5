//! The queue from the command line: what is submitted, computed, held, released, dropped and told,
//! and whatever else may lie in its folders.
#![cfg(unix)]
#![allow(clippy::too_many_lines, reason = "a test tells one story")]

use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::map::datasets;
use crate::processes::{children, is_there, until};
use crate::program::{Folder, err, expect, json, out};
use crate::queue_files::left;

/// A sweep that takes no time.
const SMALL: &str = "
    fields = [\"n_unstable\"]
    [axes]
    alpha_v = { from = -1.0, to = 0.5, points = 31 }
    tau = { from = 0.05, to = 9.0, points = 40 }
    [fixed]
    mu_prime = -0.3
";

/// More than anybody waits for, on a disk with little room.
const LARGE: &str = "
    fields = [\"n_unstable\", \"abscissa_8\"]
    boundaries = false
    [axes]
    alpha_n = { from = -3.0, to = 1.0, points = 3000 }
    tau = { from = 0.05, to = 9.0, points = 10000 }
    [fixed]
    mu_prime = -0.3
";

/// Sweeps of other plans.
fn other(mu_prime: f64) -> String {
    SMALL.replace("-0.3", &format!("{mu_prime:?}"))
}

fn folder() -> Folder {
    Folder::with(&[
        ("a.toml", SMALL),
        ("b.toml", &other(-0.2)),
        ("c.toml", &other(-0.1)),
        ("large.toml", LARGE),
    ])
}

/// The lines of `slipmap jobs` as pairs of state and name.
fn jobs(folder: &Folder) -> Vec<(String, String)> {
    let told = json(&folder.run(&["jobs", "q", "--json"]));
    let text = |job: &serde_json::Value, key: &str| job[key].as_str().unwrap().to_owned();
    let all = told["jobs"].as_array().unwrap().iter();
    all.map(|job| (text(job, "state"), text(job, "name")))
        .collect()
}

fn expect_jobs(folder: &Folder, expected: &[(&str, &str)]) {
    let found = jobs(folder);
    let found: Vec<_> = found
        .iter()
        .map(|(state, name)| (&**state, &**name))
        .collect();
    assert_eq!(found, expected);
}

fn work(folder: &Folder) -> std::process::Output {
    folder.run(&[
        "work",
        "q",
        "--keep-free",
        "1MB",
        "--until-empty",
        "--first-pause",
        "0",
    ])
}

fn failed(folder: &Folder, name: &str) -> String {
    let path = folder.path().join(format!("q/failed/{name}.txt"));
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn sweeps_are_submitted_in_order_and_computed() {
    let folder = folder();
    expect(
        &folder.run(&["jobs", "q"]),
        2,
        "q has no queue help: `slipmap submit SWEEP.toml --to q` makes one",
    );
    expect(
        &folder.run(&["submit", "a.toml", "b.toml", "--to", "q"]),
        0,
        "100000-a: waits 100010-b: waits",
    );
    expect(
        &folder.run(&["submit", "a.toml", "--to", "q"]),
        0,
        "100000-a: the same sweep waits",
    );
    expect(
        &folder.run(&["submit", "c.toml", "--to", "q", "--first"]),
        0,
        "099990-c: waits",
    );
    expect(
        &folder.run(&["submit", "a.toml", "--to", "q", "--again", "--hold"]),
        0,
        "100020-a: is held",
    );
    let waiting = [
        ("waiting", "099990-c"),
        ("waiting", "100000-a"),
        ("waiting", "100010-b"),
    ];
    expect_jobs(&folder, &[&waiting[..], &[("held", "100020-a")]].concat());
    expect(
        &folder.run(&["jobs", "first", "100010-b", "--in", "q"]),
        0,
        "100010-b: is the first, as 099980-b",
    );
    // As a kill leaves a lock: of a job that is nowhere, and of one that is there.
    let locks = [".099000-gone.lock", ".100020-a.lock"]
        .map(|lock| folder.path().join("q/queue").join(lock));
    for lock in &locks {
        fs::write(lock, "{}").unwrap();
    }
    let told = work(&folder);
    assert_eq!(locks.map(|lock| lock.exists()), [false, true]);
    expect(&told, 0, "099980-b: done; q/099980-b.h5: 1 240 cells");
    let order: Vec<usize> = ["099980-b", "099990-c", "100000-a"]
        .iter()
        .map(|name| out(&told).find(name).unwrap())
        .collect();
    assert!(order.is_sorted(), "{order:?}");
    let done = [
        ("held", "100020-a"),
        ("done", "099980-b"),
        ("done", "099990-c"),
        ("done", "100000-a"),
    ];
    expect_jobs(&folder, &done);
    expect(
        &folder.run(&["submit", "c.toml", "--to", "q"]),
        0,
        "099990-c: the same sweep is done: q/099990-c.h5",
    );
    expect(
        &folder.run(&["jobs", "hold", "100000-a", "--in", "q"]),
        2,
        "100000-a is done",
    );
    expect(
        &folder.run(&["jobs", "release", "100020-a", "--in", "q"]),
        0,
        "100020-a: waits",
    );
    expect(&work(&folder), 0, "100020-a: done");
    expect(&folder.run(&["run", "a.toml", "-q"]), 0, "a.h5: ");
    let alone = datasets(&folder.path().join("a.h5"));
    for name in ["100000-a", "100020-a"] {
        assert_eq!(datasets(&folder.path().join(format!("q/{name}.h5"))), alone);
    }
    assert_eq!(left(&folder), [""; 0]);
}

/// Errors are those of `run`, at their place, and nothing is put in.
#[test]
fn bad_sweeps_are_refused_when_they_are_submitted() {
    let folder = folder();
    fs::write(
        folder.path().join("bad.toml"),
        SMALL.replace("alpha_v", "alpha_w"),
    )
    .unwrap();
    let refused = folder.run(&["submit", "a.toml", "bad.toml", "--to", "q"]);
    expect(&refused, 2, "alpha_w");
    assert!(err(&refused).contains("bad.toml:4"), "{}", err(&refused));
    assert!(!folder.path().join("q").exists());
    expect(
        &folder.run(&["submit", "none.toml"]),
        2,
        "cannot read none.toml",
    );
    fs::write(folder.path().join("file"), "").unwrap();
    expect(
        &folder.run(&["submit", "a.toml", "--to", "file"]),
        1,
        "file",
    );
    expect(&folder.run(&["submit", "a.toml", "--to", "q"]), 0, "waits");
    for (args, says) in [
        (
            &["jobs", "hold", "100001-a", "--in", "q"][..],
            "no sweep of q has the name 100001-a",
        ),
        (
            &["jobs", "hold", "a", "--in", "q"],
            "did you mean 100000-a?",
        ),
        (&["jobs", "hold", "--in", "q"], "NAME"),
        (
            &["jobs", "drop", "--older", "3", "--failed", "--in", "q"],
            "30d",
        ),
        (&["work", "q", "--keep-free", "lots"], "500MB"),
    ] {
        expect(&folder.run(args), 2, says);
    }
}

/// A table that a sweep names is put into the text: the job needs no other file.
#[test]
fn what_a_sweep_names_is_put_in() {
    let sweep = SMALL.replace(
        "[fixed]\n    mu_prime = -0.3",
        "[friction]\n law = \"table\"\n table = \"t.csv\"\n[fixed]\n v0 = 0.3",
    );
    let table = "v, mu\n0.1, 0.5\n0.2, 0.45\n0.3, 0.42\n0.4, 0.4\n0.6, 0.39\n";
    let folder = Folder::with(&[("m.toml", &sweep), ("t.csv", table)]);
    expect(&folder.run(&["submit", "m.toml", "--to", "q"]), 0, "waits");
    fs::remove_file(folder.path().join("t.csv")).unwrap();
    expect(&work(&folder), 0, "100000-m: done");
}

/// What can lie in a queue: each is judged by itself and the rest goes on.
#[test]
fn whatever_lies_in_the_queue_is_judged_by_itself() {
    let folder = folder();
    expect(
        &folder.run(&["submit", "a.toml", "b.toml", "--to", "q"]),
        0,
        "waits",
    );
    let queue = folder.path().join("q/queue");
    fs::write(queue.join("0001-bad.toml"), "[axes]\nalpha_w = [1.0]\n").unwrap();
    fs::write(queue.join("0002-empty.toml"), "").unwrap();
    fs::write(queue.join("0003-bytes.toml"), b"\xff\xfe\x00\x01").unwrap();
    std::os::unix::fs::symlink(folder.path().join("c.toml"), queue.join("0004-link.toml")).unwrap();
    fs::create_dir(queue.join("0005-folder.toml")).unwrap();
    let fifo = Command::new("mkfifo")
        .arg(queue.join("0006-fifo.toml"))
        .status()
        .unwrap();
    assert!(fifo.success());
    fs::write(
        queue.join(std::ffi::OsStr::from_bytes(b"0007-\xff.toml")),
        SMALL,
    )
    .unwrap();
    fs::write(queue.join("0008-other.toml"), SMALL).unwrap();
    fs::write(queue.join("0009-twice.toml"), SMALL).unwrap();
    fs::write(queue.join("readme.txt"), "no sweep").unwrap();
    fs::write(
        queue.join("A case.toml"),
        "[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n[fixed]\nv0 = 0.1\n[trace]\nuntil = 3\n",
    )
    .unwrap();
    // The name of a map that is that of another sweep, and one that is damaged.
    expect(
        &folder.run(&["run", "c.toml", "-o", "q/0008-other.h5", "-q"]),
        0,
        "",
    );
    fs::write(
        folder.path().join("q/100010-b.h5"),
        b"\x89HDF\r\n\x1a\n and no more",
    )
    .unwrap();
    let told = work(&folder);
    expect(&told, 1, "10 sweeps failed");
    for (name, why) in [
        ("0001-bad", "alpha_w"),
        ("0002-empty", "axes"),
        ("0003-bytes", "not UTF-8"),
        ("0004-link", "no regular file"),
        ("0005-folder", "no regular file"),
        ("0006-fifo", "no regular file"),
        ("0008-other", "already there: the map of another sweep"),
        ("100010-b", "damaged HDF5 file"),
        ("100010-b", "10 tries without progress"),
    ] {
        assert!(
            failed(&folder, name).contains(why),
            "{name}: {}",
            failed(&folder, name)
        );
    }
    let done: Vec<_> = jobs(&folder)
        .into_iter()
        .filter(|(state, _)| state == "done")
        .collect();
    let done: Vec<_> = done.iter().map(|(_, name)| &**name).collect();
    assert_eq!(done, ["0009-twice", "100000-a"]);
    assert_eq!(left(&folder), ["readme.txt"]);
    // What failed can be mended and tried again.
    fs::remove_file(folder.path().join("q/100010-b.h5")).unwrap();
    expect(
        &folder.run(&["jobs", "release", "100010-b", "--in", "q"]),
        0,
        "waits",
    );
    assert!(!folder.path().join("q/failed/100010-b.txt").exists());
    expect(&work(&folder), 0, "100010-b: done");
    expect(
        &folder.run(&["jobs", "drop", "--failed", "--older", "1h", "--in", "q"]),
        0,
        "",
    );
    assert!(folder.path().join("q/failed/0001-bad.toml").exists());
}

/// A file that is still being copied is not judged.
#[test]
fn a_half_copied_file_is_waited_for() {
    let folder = folder();
    fs::create_dir_all(folder.path().join("q/queue")).unwrap();
    let path = folder.path().join("q/queue/0001-slow.toml");
    fs::write(&path, &SMALL[..60]).unwrap();
    let worker = folder.start(&["work", "q", "--keep-free", "1MB", "--until-empty"]);
    for end in [100, 150, SMALL.len()] {
        std::thread::sleep(Duration::from_millis(900));
        fs::write(&path, &SMALL[..end]).unwrap();
    }
    expect(&worker.ended(), 0, "0001-slow: done");
}

fn the_run_of(worker: u32) -> u32 {
    let mut run = None;
    until(30, "a run", || {
        run = children(worker).first().copied();
        run.is_some()
    });
    run.unwrap()
}

/// Waits until tiles of a job are on disk.
fn until_saved(folder: &Folder, name: &str) {
    let tiles = folder.path().join(format!("q/{name}.h5.tiles/1-of-1"));
    until(60, "tiles", || {
        let entries = fs::read_dir(&tiles).into_iter().flatten().flatten();
        entries
            .filter(|e| e.path().extension().is_some_and(|e| e == "bin"))
            .count()
            > 0
    });
}

/// A run ends with its worker, however that ends, and the next worker goes on.
#[test]
fn a_run_ends_with_its_worker() {
    let folder = folder();
    expect(
        &folder.run(&["submit", "large.toml", "--to", "q"]),
        0,
        "waits",
    );
    for signal in ["-KILL", "-TERM", "-INT", "-HUP"] {
        let mut worker = folder.start(&["work", "q", "--keep-free", "1MB", "--threads", "1"]);
        let run = the_run_of(worker.id());
        if signal == "-KILL" {
            until_saved(&folder, "100000-large");
        }
        worker.signal(signal);
        let begun = Instant::now();
        let status = worker.wait();
        until(20, "the run has ended", || !is_there(run));
        assert!(
            begun.elapsed() < Duration::from_secs(5),
            "{signal}: {:?}",
            begun.elapsed()
        );
        let code = match signal {
            "-KILL" => None,
            "-TERM" => Some(143),
            "-INT" => Some(130),
            _ => Some(129),
        };
        assert_eq!(status.code(), code);
        expect_jobs(&folder, &[("waiting", "100000-large")]);
        let lock = fs::read_to_string(folder.path().join("q/queue/.100000-large.lock")).unwrap();
        assert!(
            lock.contains("\"tries\":0"),
            "a stop of the worker is no try: {signal}: {lock}"
        );
    }
}

/// Holding ends the run within seconds; what is computed stays, and follows to a new name.
#[test]
fn a_sweep_is_held_while_it_runs_and_goes_on_later() {
    let folder = folder();
    expect(
        &folder.run(&["submit", "large.toml", "a.toml", "--to", "q"]),
        0,
        "waits",
    );
    let mut worker = folder.start(&["work", "q", "--keep-free", "1MB", "--threads", "1"]);
    let run = the_run_of(worker.id());
    until_saved(&folder, "100000-large");
    expect_jobs(
        &folder,
        &[("running", "100000-large"), ("waiting", "100010-a")],
    );
    expect(
        &folder.run(&["jobs", "first", "100000-large", "--in", "q"]),
        2,
        "100000-large runs already",
    );
    expect(
        &folder.run(&["jobs", "drop", "100000-large", "--tiles", "--in", "q"]),
        2,
        "hold it first",
    );
    expect(
        &folder.run(&["jobs", "hold", "100000-large", "--in", "q"]),
        0,
        "100000-large: is held",
    );
    until(10, "the run has ended", || !is_there(run));
    // The worker goes on with the next one.
    until(30, "the next is done", || {
        folder.path().join("q/100010-a.h5").exists()
    });
    let tiles = folder.path().join("q/100000-large.h5.tiles");
    assert!(tiles.exists());
    // By hand, as `jobs first` does it: the tiles follow when it begins.
    fs::rename(
        folder.path().join("q/held/100000-large.toml"),
        folder.path().join("q/queue/0001-large.toml"),
    )
    .unwrap();
    let run = the_run_of(worker.id());
    until(20, "its tiles follow", || !tiles.exists());
    assert!(
        folder
            .path()
            .join("q/0001-large.h5.tiles/1-of-1/manifest.json")
            .exists()
    );
    assert!(folder.path().join("q/0001-large.h5.log").exists());
    expect(
        &folder.run(&["jobs", "drop", "0001-large", "--in", "q"]),
        0,
        "is dropped",
    );
    until(10, "the run has ended", || !is_there(run));
    assert!(folder.path().join("q/0001-large.h5.tiles").exists());
    worker.signal("-TERM");
    worker.wait();
    assert_eq!(left(&folder), [""; 0]);
}

/// The user's line has what it needs in its environment.
#[test]
fn a_line_is_run_after_each_sweep() {
    let folder = folder();
    expect(&folder.run(&["submit", "a.toml", "--to", "q"]), 0, "waits");
    fs::write(folder.path().join("q/queue/bad.toml"), "x = 1").unwrap();
    let line =
        "echo \"$SLIPMAP_JOB $SLIPMAP_STATE $SLIPMAP_MAP\" >> told; test -n \"$SLIPMAP_WHY\"";
    let told = folder.run(&[
        "work",
        "q",
        "--keep-free",
        "1MB",
        "--until-empty",
        "--then",
        line,
    ]);
    expect(
        &told,
        1,
        "100000-a: the line of --then ended with exit status: 1",
    );
    let told = fs::read_to_string(folder.path().join("told")).unwrap();
    assert_eq!(told, "100000-a done q/100000-a.h5\nbad failed q/bad.h5\n");
}

/// A sweep that may need more than the disk has waits, is named, and does not hold up others.
#[test]
fn a_sweep_without_room_waits_and_others_go_on() {
    let folder = folder();
    let huge = LARGE.replace("3000", "2000000");
    fs::write(folder.path().join("huge.toml"), huge).unwrap();
    expect(
        &folder.run(&["submit", "huge.toml", "a.toml", "--to", "q"]),
        0,
        "waits",
    );
    let free = Command::new("df")
        .args(["-P", "-B1", "q"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let free: u64 = out(&free)
        .lines()
        .nth(1)
        .unwrap()
        .split_whitespace()
        .nth(3)
        .unwrap()
        .parse()
        .unwrap();
    let kept = free.saturating_sub(5_000_000_000).to_string();
    let mut worker = folder.start(&["work", "q", "--keep-free", &kept]);
    until(30, "the other one is done", || {
        folder.path().join("q/100010-a.h5").exists()
    });
    let told = json(&folder.run(&["jobs", "q", "--json"]));
    assert_eq!(told["jobs"][0]["state"], "waiting");
    let why = told["jobs"][0]["why"].as_str().unwrap();
    assert!(
        why.starts_with("the disk may have no room: its map may take"),
        "{why}"
    );
    worker.signal("-TERM");
    worker.wait();
}

/// A list of very many names takes no time.
#[test]
fn very_many_names_are_listed_soon() {
    let folder = folder();
    expect(&folder.run(&["submit", "a.toml", "--to", "q"]), 0, "waits");
    let queue = folder.path().join("q/queue");
    for number in 0..100_000 {
        fs::write(queue.join(format!("2{number:05}-x.txt")), "").unwrap();
    }
    let begun = Instant::now();
    expect(&work(&folder), 0, "100000-a: done");
    assert!(
        begun.elapsed() < Duration::from_secs(20),
        "{:?}",
        begun.elapsed()
    );
    assert!(Path::new(&folder.path().join("q/100000-a.h5")).exists());
}

/// Names lead nowhere but into the queue.
#[test]
fn names_do_not_lead_out_of_the_queue() {
    let folder = folder();
    expect(&folder.run(&["submit", "a.toml", "--to", "q"]), 0, "waits");
    let own = folder.path().join("b.toml");
    let own = own.to_str().unwrap();
    for name in [
        own,
        "../../b",
        "../b.toml",
        ".lock",
        "",
        "q/queue/100000-a.toml",
    ] {
        for what in ["drop", "hold", "release", "first"] {
            let refused = folder.run(&["jobs", what, name, "--in", "q"]);
            expect(&refused, 2, "no sweep of q has the name");
        }
    }
    let near = folder.run(&["jobs", "drop", "q/queue/100000-a.toml", "--in", "q"]);
    expect(&near, 2, "did you mean 100000-a?");
    assert!(Path::new(own).exists());
    expect_jobs(&folder, &[("waiting", "100000-a")]);
}

/// Many processes that put sweeps first at a time lose none.
#[test]
fn many_are_put_first_at_a_time_and_none_is_lost() {
    let folder = folder();
    let queue = folder.path().join("q/queue");
    expect(&folder.run(&["submit", "a.toml", "--to", "q"]), 0, "waits");
    for number in 0..8 {
        fs::write(
            queue.join(format!("1001{number}0-x.toml")),
            other(-0.11 - 0.01 * f64::from(number)),
        )
        .unwrap();
    }
    let first = |number: u32| {
        let name = format!("1001{number}0-x");
        folder.start(&["jobs", "first", &name, "--in", "q"])
    };
    let all: Vec<_> = (0..8).map(first).collect();
    let said: Vec<String> = all.into_iter().map(|child| out(&child.ended())).collect();
    let mut names: Vec<String> = jobs(&folder).into_iter().map(|(_, name)| name).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), 9, "{said:?}");
}

/// Another file under the name of a sweep that runs is another sweep: it stays and is judged.
#[test]
fn a_file_that_takes_the_name_of_one_that_runs_is_not_lost() {
    let folder = folder();
    let middle = LARGE.replace("3000", "40");
    fs::write(folder.path().join("m.toml"), &middle).unwrap();
    expect(&folder.run(&["submit", "m.toml", "--to", "q"]), 0, "waits");
    let worker = folder.start(&[
        "work",
        "q",
        "--keep-free",
        "1MB",
        "--threads",
        "1",
        "--until-empty",
    ]);
    until_saved(&folder, "100000-m");
    fs::write(folder.path().join("q/queue/100000-m.toml"), SMALL).unwrap();
    let ended = worker.ended();
    expect(&ended, 1, "1 sweep failed");
    let kept = fs::read_to_string(folder.path().join("q/failed/100000-m.toml")).unwrap();
    assert_eq!(kept, SMALL);
}

/// What cannot be judged does not hold up the rest.
#[test]
fn one_job_in_the_way_of_itself_does_not_hold_up_others() {
    let folder = folder();
    expect(&folder.run(&["submit", "a.toml", "--to", "q"]), 0, "waits");
    let queue = folder.path().join("q/queue");
    fs::write(queue.join(format!("0{}.toml", "x".repeat(240))), SMALL).unwrap();
    fs::write(queue.join("0001-locked.toml"), SMALL).unwrap();
    fs::create_dir(queue.join(".0001-locked.lock")).unwrap();
    let mut worker = folder.start(&["work", "q", "--keep-free", "1MB"]);
    until(60, "the other one is done", || {
        jobs(&folder).contains(&("done".into(), "100000-a".into()))
    });
    worker.signal("-TERM");
    worker.wait();
    let states: Vec<String> = jobs(&folder).into_iter().map(|(state, _)| state).collect();
    assert_eq!(states, ["waiting", "failed", "done"]);
}

/// A line of the user that hangs holds up neither sweeps nor the end of the worker.
#[test]
fn a_line_that_hangs_is_in_nobodys_way() {
    let folder = folder();
    expect(
        &folder.run(&["submit", "a.toml", "b.toml", "--to", "q"]),
        0,
        "waits",
    );
    let mut worker = folder.start(&["work", "q", "--keep-free", "1MB", "--then", "sleep 100"]);
    until(60, "both are done", || {
        folder.path().join("q/100010-b.h5").exists()
    });
    let line = { children(worker.id()) };
    worker.signal("-TERM");
    let begun = Instant::now();
    assert_eq!(worker.wait().code(), Some(143));
    assert!(
        begun.elapsed() < Duration::from_secs(8),
        "{:?}",
        begun.elapsed()
    );
    until(5, "the line has ended", || {
        !line.iter().any(|id| is_there(*id))
    });
}

/// Tiles of another revision are never dropped by themselves; `release --fresh` drops them.
#[test]
fn what_was_computed_is_dropped_only_when_asked_for() {
    let folder = folder();
    let middle = LARGE.replace("3000", "40");
    fs::write(folder.path().join("m.toml"), &middle).unwrap();
    expect(&folder.run(&["submit", "m.toml", "--to", "q"]), 0, "waits");
    let mut worker = folder.start(&["work", "q", "--keep-free", "1MB", "--threads", "1"]);
    until_saved(&folder, "100000-m");
    worker.signal("-KILL");
    worker.wait();
    let manifest = folder
        .path()
        .join("q/100000-m.h5.tiles/1-of-1/manifest.json");
    let mut other = folder.start(&["run", "a.toml", "-o", "q/x.h5"]);
    other.wait();
    until(20, "the run has ended", || {
        let args = ["run", "b.toml", "-o", "q/100000-m.h5", "-q"];
        folder.run(&args).status.code() == Some(2)
    });
    assert!(manifest.exists());
    // The tiles of another sweep stand where those of this one go.
    fs::write(folder.path().join("q/queue/100000-m.toml"), SMALL).unwrap();
    std::thread::sleep(Duration::from_millis(2100));
    expect(&work(&folder), 1, "1 sweep failed");
    let why = failed(&folder, "100000-m");
    assert!(
        why.contains("slipmap jobs release 100000-m --fresh --in q"),
        "{why}"
    );
    assert!(manifest.exists());
    expect(
        &folder.run(&["jobs", "release", "100000-m", "--fresh", "--in", "q"]),
        0,
        "waits",
    );
    expect(&work(&folder), 0, "100000-m: done");
}
