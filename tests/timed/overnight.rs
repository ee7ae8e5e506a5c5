//! Runs that are killed, stopped, starved of disk or robbed of their folders: nothing that is
//! finished is lost, and what comes out is what an uninterrupted run makes.
//!
//! `SLIPMAP_KILLS=100` kills more often than the 20 times of the suite; `SLIPMAP_DAMAGES=1000`
//! damages more files than 60.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]
#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use crate::alone;
use crate::chance::{Chance, asked};
use crate::map::datasets;
use crate::program::{self, Folder, LONGEST, ends_within, err, expect, out};
use slipmap::maps::assembly::Missing;
use slipmap::maps::maker::{Job, Merge, make, make_in_memory, make_shard, merge};
use slipmap::store::tiles::{Manifest, shards};
use slipmap::sweep::described::root::Provenance;
use slipmap::sweep::events::Attended;
use slipmap::sweep::{Order, Plan, RunError, Shard};

/// Curves, best settings and decay rates: every kind of piece, a second or two of work.
const NIGHT: &str = "
    fields = [\"n_unstable\", \"abscissa\", \"frequency\"]
    best = true
    [axes]
    mu_prime = { from = -0.6, to = -0.1, points = 8 }
    alpha_n = { from = -3.0, to = 1.0, points = 81 }
    tau = { from = 0.05, to = 9.0, points = 600 }
";

/// More than anybody waits for.
const LARGE: &str = "
    fields = [\"n_unstable\", \"abscissa\", \"frequency\"]
    boundaries = false
    [axes]
    alpha_n = { from = -3.0, to = 1.0, points = 100000 }
    tau = { from = 0.05, to = 9.0, points = 10000 }
    [fixed]
    mu_prime = -0.3
";

/// Runs a script in a shell that may mount what nobody else sees, where that is allowed. Where the
/// tests are killed it ends by itself.
fn in_own_mounts(folder: &Folder, script: &str) -> std::io::Result<Output> {
    let mut shell = Command::new("unshare");
    shell.args(["-rm", "sh", "-c", script]);
    ends_within(shell.current_dir(folder.path()), LONGEST).output()
}

fn wait_for(what: &str, mut there: impl FnMut() -> bool) {
    let start = Instant::now();
    while !there() {
        assert!(start.elapsed() < Duration::from_secs(30), "no {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The tile files of a map's folders.
fn tile_files(map: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for (_, folder) in shards::present(map).unwrap() {
        for entry in std::fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            files.extend(path.extension().is_some_and(|e| e == "bin").then_some(path));
        }
    }
    files.sort();
    files
}

fn status(folder: &Folder, map: &str) -> serde_json::Value {
    let output = folder.run(&["status", map, "--json"]);
    program::json(&output)
}

fn cells_done(folder: &Folder, map: &str) -> u64 {
    status(folder, map)["cells_done"].as_u64().unwrap()
}

/// Puts the folders of all shards together.
fn merge_all(plan: &Plan, folders: &[PathBuf], map: &Path, provenance: &Provenance) {
    let asked = Merge {
        folders,
        map,
        missing: Missing::Refuse,
        replace_complete: false,
        remove_beside: Some(map),
    };
    let stop = Arc::new(AtomicBool::new(false));
    merge(plan, &asked, provenance, Attended::silently(&stop)).unwrap();
}

fn uninterrupted() -> (Folder, Arc<Plan>) {
    let folder = Folder::with(&[("night.toml", NIGHT)]);
    let plan = Arc::new(Plan::new(NIGHT.parse().unwrap()).unwrap());
    let path = folder.path().join("whole.h5");
    make_in_memory(&plan, &path, 2, &Provenance::default()).unwrap();
    (folder, plan)
}

#[test]
fn killed_runs_go_on_and_end_as_uninterrupted_ones() {
    let _alone = alone();
    let (folder, _) = uninterrupted();
    let expected = datasets(&folder.path().join("whole.h5"));
    let map = folder.path().join("night.h5");
    let kills = asked("SLIPMAP_KILLS", 20);
    let args = ["run", "night.toml", "--save-every", "0", "--threads", "2"];
    let begun = Instant::now();
    expect(&folder.run(&args), 0, "night.h5: ");
    let whole_run = begun.elapsed().as_millis() as u64;
    std::fs::remove_file(&map).unwrap();
    let (mut killed, mut midway, mut complete, mut chance) = (0, 0, 0, Chance(6));
    while killed < kills {
        let before = done_so_far(&folder);
        let mut child = folder.start(&args);
        std::thread::sleep(Duration::from_millis(1 + chance.below(whole_run)));
        if child.goes_on() {
            child.signal("-KILL");
            killed += 1;
        }
        child.wait();
        if map.exists() {
            complete += 1;
            // Complete; or killed after the map got its name and before its tiles were gone, which
            // are put together once more.
            let again = folder.run(&args);
            let told = [out(&again), err(&again)].concat();
            let nothing = ["already complete", "night.h5: 0 cells"];
            assert!(
                again.status.success() && nothing.iter().any(|t| told.contains(t)),
                "{told}"
            );
            assert_eq!(datasets(&map), expected, "after {killed} kills");
            assert!(shards::present(&map).unwrap().is_empty());
            std::fs::remove_file(&map).unwrap();
        } else {
            let now = done_so_far(&folder);
            assert!(now >= before, "after {killed} kills");
            midway += u64::from(now > before);
        }
    }
    expect(&folder.run(&args), 0, "night.h5: ");
    assert_eq!(datasets(&map), expected);
    println!(
        "{killed} kills, {midway} of them after more was saved, {complete} maps completed on the way"
    );
    assert!(midway > 0);
}

/// Pieces that are saved.
fn done_so_far(folder: &Folder) -> u64 {
    match tile_files(&folder.path().join("night.h5")).is_empty() {
        true => 0,
        false => status(folder, "night.h5")["shards"][0]["pieces_done"]
            .as_u64()
            .unwrap(),
    }
}

#[test]
fn threads_shards_and_order_make_no_difference() {
    let _alone = alone();
    let (folder, plan) = uninterrupted();
    // Without a history, whole files have to be equal.
    let expected = std::fs::read(folder.path().join("whole.h5")).unwrap();
    let provenance = Provenance::default();
    let stop = Arc::new(AtomicBool::new(false));
    let map = folder.path().join("again.h5");
    for (threads, order) in [
        (1, Order::Forward),
        (2, Order::Backward),
        (3, Order::Spread),
        (4, Order::Forward),
    ] {
        let job = Job {
            order,
            ..Job::new(&map, threads, &provenance)
        };
        make(&plan, &job, Attended::silently(&stop)).unwrap();
        assert!(
            std::fs::read(&map).unwrap() == expected,
            "{threads} {order:?}"
        );
        std::fs::remove_file(&map).unwrap();
    }
    for number in [3, 1, 7, 2, 6, 4, 5] {
        let shard: Shard = format!("{number}/7").parse().unwrap();
        let job = Job {
            order: Order::Spread,
            ..Job::new(&map, 2, &provenance)
        };
        make_shard(&plan, &job, shard, Attended::silently(&stop)).unwrap();
    }
    let folders: Vec<PathBuf> = shards::present(&map)
        .unwrap()
        .into_iter()
        .map(|(_, path)| path)
        .collect();
    assert_eq!(folders.len(), 7);
    merge_all(&plan, &folders, &map, &provenance);
    assert!(std::fs::read(&map).unwrap() == expected, "7 shards");
}

#[test]
fn signals_stop_a_run_soon_and_keep_what_is_done() {
    let _alone = alone();
    let folder = Folder::with(&[("large.toml", LARGE)]);
    let map = folder.path().join("large.h5");
    let mut done = 0;
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let child = folder.start(&["run", "large.toml", "--save-every", "0.1"]);
        let before = tile_files(&map).len();
        wait_for("tile file", || tile_files(&map).len() > before);
        expect(
            &folder.run(&["run", "large.toml"]),
            3,
            "another run is writing large.h5",
        );
        let status = folder.run(&["status", "large.h5"]);
        expect(&status, 0, "large.h5: running");
        expect(&status, 0, "cells/s");
        let sent = Instant::now();
        child.signal(signal);
        let output = child.ended();
        assert!(
            sent.elapsed() < Duration::from_secs(2),
            "{:?}",
            sent.elapsed()
        );
        expect(
            &output,
            code,
            "large.h5 is not complete; what is computed is kept",
        );
        let now = cells_done(&folder, "large.h5");
        assert!(now > done);
        done = now;
    }
    assert!(!map.exists());
    expect(
        &folder.run(&["status", "large.h5"]),
        0,
        "no run works on it",
    );
    // What there is can be looked at.
    expect(
        &folder.run(&["plot", "large.h5"]),
        0,
        "large.h5 is not complete",
    );
    expect(&folder.run(&["info", "large.h5"]), 0, "missing");
    expect(
        &folder.run(&["merge", "large.h5"]),
        1,
        "run these shards again: 1/1",
    );
    expect(
        &folder.run(&["merge", "large.h5", "--partial", "-o", "sofar.h5"]),
        0,
        "of them missing",
    );
    assert_eq!(cells_done(&folder, "sofar.h5"), done);
    // Of its integers it is told what stands in the cells that are missing, and how many are.
    let so_far = hdf5::File::open(folder.path().join("sofar.h5")).unwrap();
    let number = |attribute: hdf5::Attribute| attribute.read_raw::<u64>().unwrap()[0];
    let missing = number(so_far.attr("cells_missing").unwrap());
    for name in ["n_unstable", "status"] {
        let dataset = so_far.dataset(name).unwrap();
        let fill = number(dataset.attr("_FillValue").unwrap());
        let cells = dataset.read_raw::<u64>().unwrap();
        let without = cells.iter().filter(|&&value| value == fill).count() as u64;
        let told = number(dataset.attr("cells_without_value").unwrap());
        assert_eq!((without, told), (missing, missing), "{name}");
    }
    drop(so_far);
    assert_eq!(
        folder.files(),
        [
            "large.h5.log",
            "large.h5.tiles",
            "large.png",
            "large.toml",
            "sofar.h5",
            "sofar.h5.log",
            "sofar.png"
        ]
    );
}

/// Motions that go on for ever do not keep a run from stopping.
#[test]
fn slow_cells_do_not_delay_a_stop() {
    let _alone = alone();
    let slow = "fields = [\"outcome\"]\n[axes]\ntau = { from = 13, to = 14.9, points = 400 }\n[fixed]\nv0 = 0.1\nalpha_v = -1.45\n\
                switch_on_phase = 0.0\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n[simulation]\nhorizon = 1e9\n";
    let folder = Folder::with(&[("slow.toml", slow)]);
    let child = folder.start(&["run", "slow.toml"]);
    wait_for("manifest", || {
        folder
            .path()
            .join("slow.h5.tiles/1-of-1/manifest.json")
            .exists()
    });
    std::thread::sleep(Duration::from_millis(300));
    let sent = Instant::now();
    child.signal("-TERM");
    let output = child.ended();
    assert!(
        sent.elapsed() < Duration::from_secs(2),
        "{:?}",
        sent.elapsed()
    );
    expect(&output, 143, "the same command goes on");
}

/// A disk that takes no more: first a limit on the size of files, which fails in the same calls,
/// then a small disk.
#[test]
fn a_full_disk_is_named_and_nothing_is_lost() {
    let _alone = alone();
    let folder = Folder::with(&[("large.toml", LARGE)]);
    let limited = "ulimit -f 60; exec \"$slipmap\" run large.toml --save-every 0.3";
    let ended = folder.start_in_shell(limited).ended();
    expect(&ended, 1, "File too large");
    expect(&ended, 1, "the same command goes on");

    let (folder, _) = uninterrupted();
    std::fs::create_dir(folder.path().join("disk")).unwrap();
    let program = env!("CARGO_BIN_EXE_slipmap");
    let script = format!(
        "mount -t tmpfs -o size=1500k tmpfs disk || exit 77
         '{program}' run night.toml -o disk/night.h5 --save-every 0; echo ended $?
         '{program}' status disk/night.h5
         '{program}' run night.toml -o disk/night.h5 --save-every 0; echo ended $?
         mount -o remount,size=64m disk
         '{program}' run night.toml -o disk/night.h5; echo ended $?
         cp disk/night.h5 ."
    );
    match in_own_mounts(&folder, &script) {
        Ok(output) if output.status.success() => {
            expect(&output, 0, "No space left on device");
            expect(&output, 0, "ended 1");
            expect(&output, 0, "ended 0");
            let whole = datasets(&folder.path().join("whole.h5"));
            assert_eq!(datasets(&folder.path().join("night.h5")), whole);
        }
        other => println!("no small disk can be mounted here, not tried: {other:?}"),
    }
}

#[test]
fn a_folder_that_vanishes_is_named() {
    let _alone = alone();
    let folder = Folder::with(&[("large.toml", LARGE)]);
    let map = folder.path().join("large.h5");
    let child = folder.start(&["run", "large.toml", "--save-every", "0.1"]);
    wait_for("tile file", || !tile_files(&map).is_empty());
    std::fs::rename(shards::root(&map), folder.path().join("gone")).unwrap();
    let output = child.ended();
    expect(&output, 1, "cannot write large.h5.tiles/1-of-1");
    expect(&output, 1, "No such file or directory");
    // Back again, nothing is lost.
    std::fs::rename(folder.path().join("gone"), shards::root(&map)).unwrap();
    assert!(cells_done(&folder, "large.h5") > 0);
}

#[test]
fn a_folder_that_cannot_be_written_to_is_named() {
    let _alone = alone();
    let folder = Folder::with(&[("night.toml", NIGHT)]);
    let program = env!("CARGO_BIN_EXE_slipmap");
    std::fs::create_dir(folder.path().join("disk")).unwrap();
    let script = format!(
        "mount -t tmpfs tmpfs disk || exit 77
         '{program}' run night.toml -o disk/night.h5 --save-every 0 &
         until ls disk/night.h5.tiles/*/*.bin 2>/dev/null; do sleep 0.01; done; kill -KILL $!; wait
         ls disk/night.h5.tiles/*
         mount -o remount,ro disk || exit 77
         '{program}' run night.toml -o disk/night.h5; echo ended $?
         '{program}' status disk/night.h5; echo ended $?
         mount -o remount,rw disk
         '{program}' run night.toml -o disk/night.h5; echo ended $?"
    );
    match in_own_mounts(&folder, &script) {
        Ok(output) if output.status.success() => {
            expect(&output, 0, "Read-only file system");
            expect(&output, 0, "ended 1");
            expect(&output, 0, "ended 0");
        }
        other => println!("nothing can be mounted here, not tried: {other:?}"),
    }
}

/// Tile files and manifests that were cut short, flipped or emptied: all are noticed, and the map
/// is the same.
#[test]
fn damaged_tiles_are_noticed_and_computed_again() {
    let _alone = alone();
    let (folder, plan) = uninterrupted();
    let expected = std::fs::read(folder.path().join("whole.h5")).unwrap();
    let map = folder.path().join("night.h5");
    let (provenance, stop) = (Provenance::default(), Arc::new(AtomicBool::new(false)));
    let one: Shard = "1/2".parse().unwrap();
    let job = Job {
        save_every: Duration::ZERO,
        ..Job::new(&map, 2, &provenance)
    };
    make_shard(&plan, &job, one, Attended::silently(&stop)).unwrap();
    make_shard(
        &plan,
        &job,
        "2/2".parse().unwrap(),
        Attended::silently(&stop),
    )
    .unwrap();
    let kept = folder.path().join("kept");
    copy(&shards::folder_of(&map, one), &kept);
    let folders: Vec<PathBuf> = shards::present(&map)
        .unwrap()
        .into_iter()
        .map(|(_, p)| p)
        .collect();
    let mut chance = Chance(11);
    let (mut tried, mut noticed) = (0, 0);
    let files = std::fs::read_dir(&kept).unwrap().count() as u64 - 2;
    for _ in 0..asked("SLIPMAP_DAMAGES", 60).max(files) {
        let victims = tile_files(&map);
        let manifest = folders[0].join("manifest.json");
        let victims: Vec<&PathBuf> = victims
            .iter()
            .filter(|p| p.starts_with(&folders[0]))
            .chain([&manifest])
            .collect();
        let file = victims[tried % victims.len()];
        damage(file, &mut chance);
        tried += 1;
        let told = Told::default();
        make_shard(
            &plan,
            &job,
            one,
            Attended {
                observer: &told,
                stop: &stop,
            },
        )
        .unwrap();
        noticed += told.0.take();
    }
    println!("{tried} files damaged, {noticed} noticed");
    assert_eq!(noticed, tried);
    merge_all(&plan, &folders, &map, &provenance);
    assert!(std::fs::read(&map).unwrap() == expected);
}

/// Counts damages that are told.
#[derive(Default)]
struct Told(std::cell::Cell<usize>);

impl slipmap::sweep::Observer for Told {
    fn event(&self, event: &slipmap::sweep::Event) {
        if let slipmap::sweep::Event::Damaged { .. } = event {
            self.0.set(self.0.get() + 1);
        }
    }
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        std::fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
    }
}

fn damage(file: &Path, chance: &mut Chance) {
    let mut bytes = std::fs::read(file).unwrap();
    let at = chance.below(bytes.len() as u64) as usize;
    match chance.below(4) {
        0 => bytes.truncate(at),
        1 => bytes[at] ^= 1 << chance.below(8),
        2 => bytes[at..].fill(0xff),
        _ => bytes.fill(0),
    }
    if bytes == std::fs::read(file).unwrap() {
        bytes[at] ^= 1;
    }
    std::fs::write(file, bytes).unwrap();
}

#[test]
fn a_manifest_of_something_else_is_refused_with_the_difference() {
    let _alone = alone();
    let folder = Folder::with(&[
        ("large.toml", LARGE),
        (
            "other.toml",
            &LARGE.replace("points = 10000 }", "points = 9999 }"),
        ),
        ("steeper.toml", &LARGE.replace("-0.3", "-0.4")),
        ("fields.toml", &LARGE.replace(", \"frequency\"", "")),
    ]);
    let map = folder.path().join("large.h5");
    let child = folder.start(&["run", "large.toml", "--save-every", "0.1"]);
    wait_for("tile file", || !tile_files(&map).is_empty());
    child.signal("-KILL");
    child.ended();
    for (sweep, says) in [
        ("other.toml", "tau: 10000 numbers from 0.05 to 9"),
        (
            "steeper.toml",
            "mu_prime: -0.3 in the tiles, -0.4 in the sweep",
        ),
        (
            "fields.toml",
            "frequency: yes in the tiles, none in the sweep",
        ),
    ] {
        let output = folder.run(&["run", sweep, "-o", "large.h5"]);
        expect(&output, 2, says);
        expect(&output, 2, "--fresh starts over");
    }
    let manifest = folder.path().join("large.h5.tiles/1-of-1/manifest.json");
    let text = std::fs::read_to_string(&manifest).unwrap();
    let sound = || Manifest::unseal(&text).unwrap();
    let changed = |change: &dyn Fn(&mut Manifest)| {
        let mut manifest = sound();
        change(&mut manifest);
        manifest.sealed()
    };
    for (text, says) in [
        (changed(&|m| m.tiles_format_version = 1), "format version 1"),
        (changed(&|m| m.git_revision = "0123".into()), "(0123)"),
        (
            changed(&|m| m.shard = "1/2".into()),
            "of shard 1/2, asked for is 1/1",
        ),
        (
            changed(&|m| m.plan_hash.insert_str(0, "00")),
            "the manifest was changed",
        ),
    ] {
        std::fs::write(&manifest, text).unwrap();
        expect(&folder.run(&["run", "large.toml"]), 2, says);
    }
    // Without its manifest a folder is still its own: its files say what they belong to.
    std::fs::remove_file(&manifest).unwrap();
    let before = tile_files(&map).len();
    let child = folder.start(&["run", "large.toml", "--save-every", "0.1"]);
    wait_for("tile file", || tile_files(&map).len() > before);
    // A folder that is being written to is not dropped.
    expect(
        &folder.run(&["run", "large.toml", "--fresh"]),
        3,
        "another run is writing",
    );
    child.signal("-INT");
    child.ended();
    // What is not slipmap's is not touched.
    std::fs::write(
        folder.path().join("large.h5.tiles/1-of-1/notes.txt"),
        "mine",
    )
    .unwrap();
    for args in [
        &["run", "large.toml"][..],
        &["run", "large.toml", "--fresh"],
    ] {
        expect(
            &folder.run(args),
            2,
            "notes.txt stands where the tiles go and is not by slipmap",
        );
    }
    std::fs::remove_file(folder.path().join("large.h5.tiles/1-of-1/notes.txt")).unwrap();
    std::fs::write(folder.path().join("large.toml"), NIGHT).unwrap();
    expect(
        &folder.run(&["run", "large.toml", "--fresh"]),
        0,
        "large.h5: 388 800 cells",
    );
    assert!(!shards::root(&map).exists());
}

/// A manifest that is damaged is written anew where the tiles say what they belong to; nothing is
/// computed again, and no tile of another sweep is dropped.
#[test]
fn a_damaged_manifest_is_written_anew() {
    let _alone = alone();
    let (folder, _) = uninterrupted();
    let other = NIGHT.replace("-0.6", "-0.7");
    std::fs::write(folder.path().join("other.toml"), other).unwrap();
    let map = folder.path().join("night.h5");
    let run = |sweep, shard| folder.run(&["run", sweep, "-o", "night.h5", "--shard", shard]);
    for shard in ["1/2", "2/2"] {
        expect(&run("night.toml", shard), 0, "is complete; when all are");
    }
    let [one, two] = ["1-of-2", "2-of-2"].map(|n| shards::root(&map).join(n).join("manifest.json"));
    let sound = std::fs::read(&one).unwrap();
    let mut flipped = sound.clone();
    flipped[sound.len() / 2] ^= 4;
    std::fs::write(&one, &flipped).unwrap();
    let tiles = tile_files(&map);
    expect(&run("other.toml", "1/2"), 2, "its checksum does not fit");
    expect(
        &run("other.toml", "1/2"),
        2,
        "`slipmap run` that began these tiles",
    );
    assert!(tile_files(&map) == tiles && std::fs::read(&one).unwrap() == flipped);
    expect(
        &folder.run(&["status", "night.h5"]),
        0,
        "1 files of shard 1/2",
    );
    let again = run("night.toml", "1/2");
    expect(&again, 0, "manifest.json: its checksum does not fit");
    expect(&again, 0, " cells, 0 left");
    assert_eq!(std::fs::read(&one).unwrap(), sound);
    // A merge takes the sweep from another shard; without any it says what to do.
    std::fs::write(&one, &flipped).unwrap();
    let kept = std::fs::read(&two).unwrap();
    std::fs::write(&two, "").unwrap();
    expect(
        &folder.run(&["merge", "night.h5"]),
        2,
        "`slipmap run` that began these tiles",
    );
    std::fs::write(&two, kept).unwrap();
    expect(&folder.run(&["merge", "night.h5"]), 0, "night.h5: ");
    let whole = datasets(&folder.path().join("whole.h5"));
    assert_eq!(datasets(&map), whole);
}

/// A map that is being replaced stays until the new one is complete, and the replacement goes on
/// without --fresh.
#[test]
fn a_replacement_that_was_stopped_goes_on() {
    let _alone = alone();
    let folder = Folder::with(&[("night.toml", NIGHT), ("large.toml", LARGE)]);
    let map = folder.path().join("map.h5");
    expect(
        &folder.run(&["run", "night.toml", "-o", "map.h5"]),
        0,
        "map.h5: ",
    );
    let before = datasets(&map);
    let run = ["run", "large.toml", "-o", "map.h5", "--save-every", "0.1"];
    expect(&folder.run(&run), 2, "the map of another sweep");
    let child = folder.start(&[&run[..], &["--fresh"]].concat());
    wait_for("tile file", || !tile_files(&map).is_empty());
    child.signal("-INT");
    let output = child.ended();
    expect(&output, 130, "the same command without --fresh goes on");
    assert_eq!(datasets(&map), before);
    let kept = tile_files(&map).len();
    let child = folder.start(&run);
    wait_for("tile file", || tile_files(&map).len() > kept);
    child.signal("-INT");
    expect(&child.ended(), 130, "the same command goes on");
    // The old map's own sweep does not drop them either.
    expect(
        &folder.run(&["run", "night.toml", "-o", "map.h5"]),
        0,
        "already complete",
    );
    assert!(tile_files(&map).len() > kept);
}

/// What is left where a run or merge is killed between giving the map its name and removing the
/// tiles, or while it removes them.
#[test]
fn leftovers_of_a_complete_map_are_removed() {
    let _alone = alone();
    let folder = Folder::with(&[("night.toml", NIGHT)]);
    let map = folder.path().join("night.h5");
    let (root, first) = (shards::root(&map), shards::root(&map).join("1-of-2"));
    for shard in ["1/2", "2/2"] {
        expect(
            &folder.run(&["run", "night.toml", "--shard", shard]),
            0,
            "is complete",
        );
    }
    let kept = folder.path().join("kept");
    copy(&first, &kept);
    expect(&folder.run(&["merge", "night.h5"]), 0, "night.h5: ");
    let expected = datasets(&map);
    // All but the manifest is left.
    std::fs::create_dir(&root).unwrap();
    copy(&kept, &first);
    std::fs::remove_file(first.join("manifest.json")).unwrap();
    expect(
        &folder.run(&["status", "night.h5"]),
        0,
        "night.h5: complete",
    );
    expect(&folder.run(&["run", "night.toml"]), 0, "already complete");
    assert!(!root.exists());
    // Everything is left: the shards are merged once more, when the other one is there again.
    std::fs::create_dir(&root).unwrap();
    copy(&kept, &first);
    expect(
        &folder.run(&["status", "night.h5"]),
        0,
        "complete; what is computed of another one",
    );
    expect(
        &folder.run(&["merge", "night.h5"]),
        1,
        "run these shards again: 2/2",
    );
    assert_eq!(datasets(&map), expected);
    expect(
        &folder.run(&["run", "night.toml", "--shard", "2/2"]),
        0,
        "is complete",
    );
    expect(
        &folder.run(&["merge", "night.h5"]),
        0,
        "night.h5: 388 800 cells",
    );
    assert_eq!(datasets(&map), expected);
    assert!(!root.exists());
}

/// A complete map can be computed again, as a whole or in shards; what is stopped goes on; and no
/// shard drops another.
#[test]
fn a_complete_map_is_computed_again() {
    let _alone = alone();
    let folder = Folder::with(&[("night.toml", NIGHT), ("large.toml", LARGE)]);
    let map = folder.path().join("night.h5");
    expect(&folder.run(&["run", "night.toml"]), 0, "night.h5: ");
    let expected = datasets(&map);
    let mut child = folder.start(&["run", "night.toml", "--fresh", "--save-every", "0"]);
    wait_for("tile file", || !tile_files(&map).is_empty());
    child.signal("-KILL");
    child.wait();
    assert_eq!(datasets(&map), expected);
    let kept = tile_files(&map).len();
    assert!(kept > 0);
    expect(&folder.run(&["run", "night.toml"]), 0, "night.h5: ");
    assert_eq!(datasets(&map), expected);
    for shard in ["1/3", "2/3", "3/3"] {
        let args = ["run", "night.toml", "--fresh", "--shard", shard];
        expect(&folder.run(&args), 0, "is complete");
    }
    assert_eq!(shards::present(&map).unwrap().len(), 3);
    expect(
        &folder.run(&["merge", "night.h5", "--partial", "-o", "sofar.h5"]),
        0,
        "sofar.h5: ",
    );
    assert_eq!(shards::present(&map).unwrap().len(), 3, "the shards stay");
    let away = folder.path().join("away");
    std::fs::rename(shards::root(&map), &away).unwrap();
    let elsewhere = [
        "merge",
        "there.h5",
        "away/1-of-3",
        "away/2-of-3",
        "away/3-of-3",
        "away/./1-of-3",
    ];
    expect(&folder.run(&elsewhere), 0, "there.h5: ");
    assert!(away.join("1-of-3/manifest.json").exists());
    for name in ["sofar.h5", "there.h5"] {
        assert_eq!(datasets(&folder.path().join(name)), expected, "{name}");
    }
}

/// A log that cannot be written, and other things in the way.
#[test]
fn obstacles_are_named() {
    let _alone = alone();
    let folder = Folder::with(&[("night.toml", NIGHT)]);
    let shell = |script: &str| folder.start_in_shell(script).ended();
    std::fs::write(
        folder.path().join("night.h5.1-of-2.log"),
        vec![b' '; 5 << 20],
    )
    .unwrap();
    let unloggable = shell("ulimit -f 9000; exec \"$slipmap\" run night.toml --shard 1/2");
    expect(&unloggable, 0, "shard 1 of 2 is complete");
    expect(
        &folder.run(&["run", "night.toml", "--shard", "2/2"]),
        0,
        "is complete",
    );
    let small = shell("ulimit -f 60; exec \"$slipmap\" merge night.h5");
    expect(&small, 1, "File too large");
    expect(&folder.run(&["merge", "night.h5"]), 0, "night.h5: ");
    for args in [
        &["run", "night.toml", "-o", "none/night.h5"][..],
        &["run", "night.toml", "-o", "none/night.h5", "--shard", "1/2"],
    ] {
        expect(&folder.run(args), 1, "No such file or directory");
    }
    assert!(!folder.path().join("none").exists());
    std::os::unix::fs::symlink(folder.path(), folder.path().join("other.h5.tiles")).unwrap();
    expect(
        &folder.run(&["run", "night.toml", "-o", "other.h5"]),
        2,
        "other.h5.tiles stands where the tiles go",
    );
}

/// A stop is heeded while the map is put together, and what was computed stays.
#[test]
fn a_stop_while_the_map_is_put_together() {
    let _alone = alone();
    let (folder, plan) = uninterrupted();
    let map = folder.path().join("night.h5");
    let provenance = Provenance::default();
    let job = Job::new(&map, 2, &provenance);
    let stop = Arc::new(AtomicBool::new(false));
    make_shard(&plan, &job, Shard::WHOLE, Attended::silently(&stop)).unwrap();
    stop.store(true, std::sync::atomic::Ordering::Relaxed);
    let stopped = make(&plan, &job, Attended::silently(&stop));
    assert!(matches!(stopped, Err(RunError::Interrupted)));
    assert!(!map.exists() && !tile_files(&map).is_empty());
    stop.store(false, std::sync::atomic::Ordering::Relaxed);
    make(&plan, &job, Attended::silently(&stop)).unwrap();
    let whole = std::fs::read(folder.path().join("whole.h5")).unwrap();
    assert!(std::fs::read(&map).unwrap() == whole);
}

#[test]
fn shards_by_the_program() {
    let _alone = alone();
    let (folder, _) = uninterrupted();
    for shard in ["1/3", "3/3"] {
        let args = ["run", "night.toml", "--shard", shard];
        expect(&folder.run(&args), 0, "is complete; when all are");
    }
    expect(
        &folder.run(&["merge", "night.h5"]),
        1,
        "run these shards again: 2/3",
    );
    expect(
        &folder.run(&["run", "night.toml"]),
        2,
        "holds shards of this map",
    );
    expect(&folder.run(&["status", "night.h5"]), 0, "3/3");
    expect(
        &folder.run(&["run", "night.toml", "--shard", "2/3"]),
        0,
        "shard 2 of 3",
    );
    expect(
        &folder.run(&["status", "night.h5"]),
        0,
        "all shards are complete",
    );
    expect(
        &folder.run(&["merge", "night.h5"]),
        0,
        "night.h5: 388 800 cells",
    );
    assert_eq!(
        datasets(&folder.path().join("night.h5")),
        datasets(&folder.path().join("whole.h5"))
    );
    assert!(!folder.path().join("night.h5.tiles").exists());
    expect(&folder.run(&["merge", "night.h5"]), 0, "already complete");
    expect(
        &folder.run(&["run", "night.toml", "--shard", "2/3"]),
        0,
        "already complete",
    );
    for bad in ["4/3", "0/3", "1", "x"] {
        let args = ["run", "night.toml", "--shard", bad];
        expect(&folder.run(&args), 2, "expected I/N with I from 1 to N");
    }
}

/// The state in which a kill leaves a merge that was removing its shards: the map is complete, some
/// shards have gone.
#[test]
fn a_merge_that_was_killed_while_it_cleaned_up_is_complete() {
    let _alone = alone();
    let (folder, _) = uninterrupted();
    let (map, tiles) = (
        folder.path().join("night.h5"),
        folder.path().join("night.h5.tiles"),
    );
    for shard in ["1/3", "2/3", "3/3"] {
        let args = ["run", "night.toml", "--shard", shard];
        expect(&folder.run(&args), 0, "is complete; when all are");
    }
    let kept = folder.path().join("kept");
    std::fs::create_dir(&kept).unwrap();
    for shard in ["2-of-3", "3-of-3"] {
        copy(&tiles.join(shard), &kept.join(shard));
    }
    expect(&folder.run(&["merge", "night.h5"]), 0, "388 800 cells");
    let complete = std::fs::read(&map).unwrap();
    let killed = |marked: bool| {
        std::fs::create_dir(&tiles).unwrap();
        for shard in ["2-of-3", "3-of-3"] {
            copy(&kept.join(shard), &tiles.join(shard));
        }
        if marked {
            std::fs::write(tiles.join("merged"), "").unwrap();
        }
    };
    for command in [
        &["merge", "night.h5"][..],
        &["run", "night.toml", "--shard", "1/3"],
    ] {
        killed(true);
        expect(&folder.run(command), 0, "already complete");
        assert!(!tiles.exists() && std::fs::read(&map).unwrap() == complete);
    }
    // Where it cannot be told whether the map is complete, nothing goes and the mark stays.
    killed(true);
    let held = hdf5::File::open_rw(&map).unwrap();
    for command in [
        &["merge", "night.h5"][..],
        &["run", "night.toml", "--shard", "1/3"],
    ] {
        expect(&folder.run(command), 1, "open for writing");
        assert!(tiles.join("merged").exists() && tiles.join("2-of-3").exists());
    }
    held.close().unwrap();
    std::fs::write(&map, &complete).unwrap();
    // A mark is about the map of its own plan, not about any that is complete: the shards stay.
    std::fs::write(tiles.join("merged"), "0".repeat(64)).unwrap();
    expect(
        &folder.run(&["merge", "night.h5"]),
        1,
        "run these shards again: 1/3",
    );
    assert!(tiles.join("2-of-3").exists() && std::fs::read(&map).unwrap() == complete);
    std::fs::remove_dir_all(&tiles).unwrap();
    // Without the mark the shards are those of a map that is being computed again; the complete one
    // stays all the same.
    killed(false);
    expect(
        &folder.run(&["merge", "night.h5", "--partial"]),
        2,
        "is complete, and",
    );
    assert!(std::fs::read(&map).unwrap() == complete);
    // The map has gone since: what is left of the shards counts, and the others are to be computed
    // again.
    std::fs::write(tiles.join("merged"), "").unwrap();
    std::fs::remove_file(&map).unwrap();
    expect(
        &folder.run(&["merge", "night.h5"]),
        1,
        "run these shards again: 1/3",
    );
    let args = ["run", "night.toml", "--shard", "1/3"];
    expect(&folder.run(&args), 0, "is complete; when all are");
    expect(&folder.run(&["merge", "night.h5"]), 0, "388 800 cells");
    assert_eq!(datasets(&map), datasets(&folder.path().join("whole.h5")));
}

/// Folders of shards are folders, not links to some that would be emptied elsewhere.
#[cfg(unix)]
#[test]
fn linked_folders_of_tiles_are_refused() {
    use std::os::unix::fs::symlink;
    let folder = Folder::with(&[("night.toml", NIGHT)]);
    for shard in ["1/2", "2/2"] {
        let args = ["run", "night.toml", "--shard", shard, "-q"];
        expect(&folder.run(&args), 0, "is complete; when all are");
    }
    let tiles = folder.path().join("night.h5.tiles");
    let (shard, away) = (tiles.join("1-of-2"), folder.path().join("away"));
    for (what, place) in [("a shard", &shard), ("all of them", &tiles)] {
        std::fs::rename(place, &away).unwrap();
        symlink(&away, place).unwrap();
        let held = |of: &Path| std::fs::read_dir(of).unwrap().count();
        let before = held(&away);
        expect(&folder.run(&["merge", "night.h5"]), 2, "is not by slipmap");
        assert_eq!(held(&away), before, "{what}");
        assert!(!folder.path().join("night.h5").exists());
        std::fs::remove_file(place).unwrap();
        std::fs::rename(&away, place).unwrap();
    }
    expect(&folder.run(&["merge", "night.h5"]), 0, "388 800 cells");
}

/// What does not belong among tiles is neither followed nor read.
#[cfg(unix)]
#[test]
fn links_and_pipes_in_the_place_of_tiles_are_refused() {
    let _alone = alone();
    let folder = Folder::with(&[("night.toml", NIGHT), ("precious.txt", "precious")]);
    let shard = ["run", "night.toml", "--shard", "1/3"];
    expect(&folder.run(&shard), 0, "is complete; when all are");
    let tiles = folder.path().join("night.h5.tiles/1-of-3");
    let precious = folder.path().join("precious.txt");
    let file = tile_files(&folder.path().join("night.h5")).remove(0);
    for (name, what) in [
        ("tiles-0000009999.bin", "link"),
        (".tiles-0000009999.bin.part", "link"),
        ("tiles-0000009999.bin", "pipe"),
        ("tiles-0000009999.bin", "/dev/zero"),
    ] {
        let place = tiles.join(name);
        match what {
            "link" => std::os::unix::fs::symlink(&precious, &place).unwrap(),
            "pipe" => {
                let made = std::process::Command::new("mkfifo").arg(&place).status();
                assert!(made.unwrap().success());
            }
            device => std::os::unix::fs::symlink(device, &place).unwrap(),
        }
        let refused = "stands where the tiles go and is not by slipmap";
        expect(&folder.run(&shard), 2, refused);
        std::fs::remove_file(&place).unwrap();
        assert_eq!(std::fs::read_to_string(&precious).unwrap(), "precious");
    }
    let manifest = tiles.join("manifest.json");
    std::fs::remove_file(&manifest).unwrap();
    std::os::unix::fs::symlink("/dev/zero", &manifest).unwrap();
    expect(&folder.run(&shard), 2, "is not by slipmap");
    expect(&folder.run(&["status", "night.h5"]), 2, "is not by slipmap");
    assert!(file.exists());
}

/// A whole run and shards of one map do not work side by side; a hang-up stops a run in order,
/// unless it was ignored before, as by `nohup`.
#[test]
fn a_hang_up_stops_a_run_unless_it_is_ignored() {
    let _alone = alone();
    let folder = Folder::with(&[("large.toml", LARGE)]);
    let map = folder.path().join("large.h5");
    let child = folder.start(&["run", "large.toml", "--save-every", "0.1"]);
    wait_for("tile file", || !tile_files(&map).is_empty());
    child.signal("-HUP");
    let ended = child.ended();
    expect(&ended, 129, "interrupted: large.h5 is not complete");
    expect(
        &folder.run(&["run", "large.toml", "--shard", "1/2"]),
        2,
        "holds what a run of the whole map has computed",
    );
    let ignoring = "trap '' HUP; exec \"$slipmap\" run large.toml --save-every 0.1";
    let mut child = folder.start_in_shell(ignoring);
    for _ in 0..2 {
        let before = tile_files(&map).len();
        wait_for("tile file", || tile_files(&map).len() > before);
        assert!(child.goes_on());
        child.signal("-HUP");
    }
    child.signal("-TERM");
    expect(&child.ended(), 143, "interrupted: large.h5 is not complete");
}

/// What is started goes by its own signals, not by those that the tests were started with.
#[test]
fn tests_under_nohup_set_the_signals_that_they_test() {
    let _alone = alone();
    let ignoring = "trap '' HUP INT QUIT; exec \"$0\" \"$@\"";
    let mut again = Command::new("sh");
    again
        .args(["-c", ignoring])
        .arg(std::env::current_exe().unwrap());
    again.args([
        "--exact",
        "overnight::a_hang_up_stops_a_run_unless_it_is_ignored",
    ]);
    let ended = ends_within(&mut again, LONGEST).output().unwrap();
    expect(&ended, 0, "1 passed");
}
