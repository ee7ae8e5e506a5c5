//! `slipmap status` of several maps and of folders, whatever stands in them.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::program::{self, Folder, err, expect, out};

const SWEEP: &str = "boundaries = false\n[axes]\nmu_prime = [-0.1, -0.3]\n\
    alpha_n = { from = -3, to = 1, points = 400 }\ntau = { from = 0, to = 12, points = 500 }\n";
const CASE: &str = "horizon = 50.0\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n[fixed]\nv0 = 0.1\n[trace]\nuntil = 20.0\n";

fn run(folder: &Folder, map: &str, shard: &[&str]) {
    let args = ["run", "sweep.toml", "--quiet", "-o", map];
    expect(&folder.run(&[&args, shard].concat()), 0, "");
}

/// A folder with a complete map, half of one, and one in two halves.
fn with_maps() -> Folder {
    let folder = Folder::with(&[("sweep.toml", SWEEP), ("case.toml", CASE)]);
    fs::create_dir_all(folder.path().join("maps/of")).unwrap();
    run(&folder, "maps/complete.h5", &[]);
    run(&folder, "maps/half.h5", &["--shard", "2/2"]);
    run(&folder, "maps/of/halves.h5", &["--shard", "1/2"]);
    run(&folder, "maps/of/halves.h5", &["--shard", "2/2"]);
    folder
}

fn mkfifo(path: &Path) {
    let made = Command::new("mkfifo").arg(path).status().unwrap();
    assert!(made.success());
}

/// Puts beside the maps what is none, or can be read only in part.
fn add_hostile(folder: &Folder) {
    let maps = folder.path().join("maps");
    let there = |name: &str| maps.join(name);
    let copy = |name: &str| {
        let (from, to) = (there("half.h5.tiles/2-of-2"), there(name).join("2-of-2"));
        fs::create_dir_all(&to).unwrap();
        for entry in fs::read_dir(from).unwrap() {
            let entry = entry.unwrap();
            fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
        }
        to
    };
    mkfifo(&there("pipe.h5"));
    symlink("/dev/zero", there("device.h5")).unwrap();
    symlink("nothing", there("gone.h5")).unwrap();
    symlink("complete.h5", there("link.h5")).unwrap();
    fs::write(there("text.h5"), "no map").unwrap();
    let bytes = fs::read(there("complete.h5")).unwrap();
    fs::write(there("cut.h5"), &bytes[..bytes.len() / 2]).unwrap();
    expect(
        &folder.run(&["simulate", "case.toml", "-o", "maps/trace.h5"]),
        0,
        "",
    );
    fs::write(copy("unsealed.h5.tiles").join("manifest.json"), "{}").unwrap();
    let manifest = copy("piped.h5.tiles").join("manifest.json");
    fs::remove_file(&manifest).unwrap();
    mkfifo(&manifest);
    // Nothing is waited for: neither a lock, nor a log, nor tiles.
    let odd = copy("odd.h5.tiles");
    fs::remove_file(odd.join("lock")).unwrap();
    for pipe in [odd.join("lock"), there("odd.h5.2-of-2.log")] {
        mkfifo(&pipe);
    }
    mkfifo(&odd.join("tiles-0000000100.bin"));
    symlink("/dev/zero", odd.join("tiles-0000000101.bin")).unwrap();
    fs::create_dir(odd.join("tiles-0000000102.bin")).unwrap();
    fs::write(odd.join("tiles-0000000103.bin"), "slipmap tiles 1\n").unwrap();
}

#[test]
fn every_map_of_a_folder_has_a_line_whatever_stands_there() {
    let folder = with_maps();
    add_hostile(&folder);
    let begun = Instant::now();
    let listed = folder.run(&["status", "maps"]);
    assert!(begun.elapsed() < Duration::from_secs(20));
    expect(&listed, 0, "complete.h5");
    insta::assert_snapshot!("folder", format!("{}{}", out(&listed), err(&listed)));
    let answer = program::json(&folder.run(&["status", "maps/", "--json"]));
    assert_eq!(answer["inputs"]["maps"][0], "maps/");
    let maps = answer["maps"].as_array().unwrap();
    assert_eq!(maps.len(), out(&listed).lines().count());
    for map in maps {
        assert_eq!(map.as_object().unwrap().len(), 8, "{map}");
        let name = map["map"].as_str().unwrap();
        assert_eq!(map["running"], false);
        assert!(map["cells_per_second"].is_null() && map["seconds_left"].is_null());
        let whole = ["maps/complete.h5", "maps/link.h5"].contains(&name);
        assert_eq!(map["complete"], whole, "{map}");
        // Either there are numbers, or what is wrong.
        assert_eq!(map["cells"].is_u64(), map["why"].is_null(), "{map}");
        assert_eq!(map["cells_done"].is_u64(), map["why"].is_null(), "{map}");
        if whole || name.ends_with("halves.h5") {
            assert_eq!(map["cells_done"], 400_000, "{map}");
        }
    }
}

#[test]
fn several_maps_and_folders_are_told_in_their_order() {
    let folder = with_maps();
    let names = |args: &[&str]| -> Vec<String> {
        let listed = folder.run(&[&["status"], args].concat());
        expect(&listed, 0, "");
        let name = |line: &str| line.split(' ').next().unwrap().to_owned();
        out(&listed).lines().map(name).collect()
    };
    assert_eq!(
        names(&["maps/of", "maps/half.h5", "maps/complete.h5"]),
        ["maps/of/halves.h5", "maps/half.h5", "maps/complete.h5"]
    );
    // One map alone is told at length.
    let one = folder.run(&["status", "maps/half.h5"]);
    expect(
        &one,
        0,
        "map maps/half.h5: not complete, and no run works on it",
    );
    for (args, code, says) in [
        (
            &["maps", "none.h5"][..],
            2,
            "cannot open none.h5: No such file",
        ),
        (&["none"], 2, "cannot open none: No such file"),
        (&["none", "none"], 2, "cannot open none: No such file"),
        (
            &["maps/half.h5.tiles"],
            2,
            "maps/half.h5.tiles holds tiles of maps/half.h5",
        ),
        (
            &["maps/half.h5.tiles/"],
            2,
            "`slipmap status maps/half.h5` says",
        ),
        (
            &["maps/half.h5.tiles/2-of-2"],
            2,
            "`slipmap status maps/half.h5` says",
        ),
        (&[], 2, "slipmap status <MAP.h5|FOLDER>..."),
    ] {
        let refused = folder.run(&[&["status"], args].concat());
        expect(&refused, code, says);
        assert_eq!(out(&refused), "", "{args:?}");
    }
    fs::create_dir(folder.path().join("empty")).unwrap();
    let empty = folder.run(&["status", "empty"]);
    expect(
        &empty,
        0,
        "no maps in empty; `slipmap run SWEEP.toml -o empty/MAP.h5` makes one",
    );
    let empty = program::json(&folder.run(&["status", "empty", "--json"]));
    assert_eq!(empty["maps"].as_array().unwrap().len(), 0);
}

#[test]
fn a_run_is_seen_in_its_folder() {
    let large = SWEEP.replace("400", "400000");
    let folder = Folder::with(&[("large.toml", &large)]);
    let args = ["run", "large.toml", "--save-every", "0", "--quiet"];
    let mut running = folder.start(&args);
    let begun = Instant::now();
    let answer = loop {
        let answer = program::json(&folder.run(&["status", ".", "--json"]));
        let map = &answer["maps"][0];
        if map["seconds_left"].is_f64() {
            break map.clone();
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "{answer}");
        assert!(running.goes_on());
        std::thread::sleep(Duration::from_millis(50));
    };
    assert_eq!(answer["running"], true);
    assert!(answer["cells_per_second"].as_f64() > Some(0.0));
    let listed = folder.run(&["status", "."]);
    expect(&listed, 0, "./large.h5 running");
    assert!(out(&listed).trim_end().ends_with(" left"), "{listed:?}");
    running.signal("-INT");
    running.wait();
    let listed = out(&folder.run(&["status", "."]));
    assert!(listed.contains("interrupted") && !listed.contains("cells/s"));
}
