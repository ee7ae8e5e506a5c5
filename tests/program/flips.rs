//! Single bits of maps, tiles and manifests that are flipped: `verify` finds every one in a map,
//! and none in what a run has left makes another map than there would have been.
//!
//! `SLIPMAP_FLIPS=2500` flips more bits of maps than 150, `SLIPMAP_TILE_FLIPS=1000` more of tiles
//! and manifests than 30.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::chance::{Chance, asked};
use crate::limited::{self, End};
use crate::map;
use crate::program::{Folder, err, expect};
use slipmap::sweep::Plan;

/// Counts with curves and a fixed value; decay rates with best settings; critical velocities.
const SWEEPS: [&str; 3] = [
    "fields = [\"n_unstable\", \"delay_margin\"]\ndegree_of_stability = [0.05]\n[axes]\nmu_prime = [-0.2, -0.1]\n\
     alpha_v = { from = -1.2, to = 0.0, points = 31 }\ntau = { from = 0.5, to = 6.0, points = 70 }\n[fixed]\nalpha_n = 0.0\n",
    "title = \"Flips\"\nfields = [\"n_unstable\", \"abscissa\", \"frequency\"]\nbest = true\n[axes]\nmu_prime = [-0.2, -0.1]\n\
     alpha_n = { from = -3.0, to = 0.9, points = 13 }\ntau = { from = 0.5, to = 6.0, points = 12 }\n",
    "fields = [\"n_unstable\", \"vc\", \"outcome\", \"v_liftoff\"]\n[axes]\ntau = [0.5, 2]\nalpha_n = [-10, -1]\n\
     [fixed]\nv0 = 0.2\nnormal_load = 2\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n",
];

/// Flips another bit in one place, and tells which.
fn flip(chance: &mut Chance, bytes: &mut [u8]) -> usize {
    let bit = chance.below(8 * bytes.len() as u64) as usize;
    bytes[bit / 8] ^= 1 << (bit % 8);
    bit
}

/// The command that computes a shard of the map.
fn run(shard: &str) -> Vec<&str> {
    let shard = ["--shard", shard, "-q", "--save-every", "0"];
    ["run", "sweep.toml", "-o", "map.h5"]
        .into_iter()
        .chain(shard)
        .collect()
}

/// The command that computes a shard and drops what is there first.
fn run_fresh(shard: &str) -> Vec<&str> {
    run(shard).into_iter().chain(["--fresh"]).collect()
}

#[test]
fn every_flipped_bit_of_a_map_is_found() {
    let folder = Folder::new();
    let path = folder.path().join("map.h5");
    let maps = SWEEPS.map(|text| {
        map::write(&Plan::new(text.parse().unwrap()).unwrap(), 2, &path);
        fs::read(&path).unwrap()
    });
    let verify = ["verify", "map.h5", "--cells", "0", "--tiles", "0"];
    for map in &maps {
        fs::write(&path, map).unwrap();
        expect(&folder.run(&verify), 0, "");
    }
    let mut chance = Chance(asked("SLIPMAP_SEED", 14));
    let mut ends: BTreeMap<(usize, End), u64> = BTreeMap::new();
    for number in 0..asked("SLIPMAP_FLIPS", 150) as usize {
        let kind = number % maps.len();
        let mut bytes = maps[kind].clone();
        let bit = flip(&mut chance, &mut bytes);
        fs::write(&path, &bytes).unwrap();
        let ended = limited::run(folder.path(), &verify, &[]);
        let text = ended.text();
        assert!(
            ended.end == End::Code(1) && !text.contains("panicked"),
            "bit {bit} of map {kind}: {:?}: {text}",
            ended.end
        );
        *ends.entry((kind, ended.end)).or_default() += 1;
    }
    println!("{ends:?}");
}

/// Copies all of a folder.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        match path.is_dir() {
            true => copy(&path, &target),
            false => drop(fs::copy(path, target).unwrap()),
        }
    }
}

/// All files below a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => all.extend(files(&path)),
            false => all.push(path),
        }
    }
    all.sort();
    all
}

/// What a map says of itself, and all its values.
fn told(path: &Path) -> (Vec<Option<String>>, BTreeMap<String, Vec<u8>>) {
    let map = slipmap::store::MapFile::open(path).unwrap();
    let texts = [
        "title",
        "sweep",
        "plan_hash",
        "program_version",
        "git_revision",
        "axes",
    ];
    let texts = texts.iter().map(|name| map.root_text(name)).collect();
    drop(map);
    (texts, map::datasets(path))
}

/// Two shards, of which one bit of one file is flipped before the same commands go on: they make
/// the same map, or say what to do.
#[test]
fn a_flipped_bit_of_tiles_and_manifests_makes_no_other_map() {
    let sweep = SWEEPS[1];
    let shards = ["1/2", "2/2"];
    let folder = Folder::with(&[("sweep.toml", sweep)]);
    let path = |name: &str| folder.path().join(name);
    for shard in shards {
        expect(&folder.run(&run(shard)), 0, "complete");
    }
    let tiles = path("map.h5.tiles");
    copy(&tiles, &path("kept"));
    expect(&folder.run(&["merge", "map.h5"]), 0, "");
    let expected = told(&path("map.h5"));
    let mut chance = Chance(asked("SLIPMAP_SEED", 41));
    let mut ways: BTreeMap<(String, &str), u64> = BTreeMap::new();
    let mut wrong = Vec::new();
    for number in 0..asked("SLIPMAP_TILE_FLIPS", 30) {
        let _ = fs::remove_file(path("map.h5"));
        let _ = fs::remove_dir_all(&tiles);
        copy(&path("kept"), &tiles);
        let all: Vec<PathBuf> = files(&tiles)
            .into_iter()
            .filter(|f| f.metadata().unwrap().len() > 0)
            .collect();
        // Every other time a manifest.
        let wanted = |f: &&PathBuf| number % 2 == 0 || f.ends_with("manifest.json");
        let candidates: Vec<&PathBuf> = all.iter().filter(wanted).collect();
        let file = candidates[chance.below(candidates.len() as u64) as usize];
        let mut bytes = fs::read(file).unwrap();
        let bit = flip(&mut chance, &mut bytes);
        fs::write(file, &bytes).unwrap();
        let what = format!("bit {bit} of {}", file.display());
        // Half of the time the runs go on first, as after a requeue.
        let mut way = "alike";
        let commands: &[&str] = if number % 4 < 2 { &shards } else { &[] };
        for shard in commands {
            let went_on = folder.run(&run(shard));
            if went_on.status.code() != Some(0) {
                way = mend(&folder, &went_on, &what);
            }
        }
        let merged = folder.run(&["merge", "map.h5"]);
        if merged.status.code() != Some(0) {
            way = mend(&folder, &merged, &what);
            for shard in shards {
                let again = folder.run(&run(shard));
                if again.status.code() != Some(0) {
                    expect(&folder.run(&run_fresh(shard)), 0, "complete");
                }
            }
            expect(&folder.run(&["merge", "map.h5"]), 0, "");
        }
        let found = told(&path("map.h5"));
        if found.0 != expected.0 {
            wrong.push(format!("{what}: {:?}", found.0));
        } else if found.1 != expected.1 {
            wrong.push(format!("{what}: values differ"));
        }
        let kind = file
            .extension()
            .map_or("none".into(), |e| e.to_string_lossy().into_owned());
        *ways.entry((kind, way)).or_default() += 1;
    }
    println!("{ways:?}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A command has said which other one mends things; here it is done for shards.
fn mend(folder: &Folder, refused: &std::process::Output, what: &str) -> &'static str {
    let says = err(refused);
    assert!(
        matches!(refused.status.code(), Some(1 | 2)),
        "{what}: {says}"
    );
    assert!(!says.contains("panicked"), "{what}: {says}");
    let words = says.split_whitespace().collect::<Vec<_>>().join(" ");
    let named = [
        "--fresh",
        "run these shards again",
        "run the shards that are missing",
    ];
    assert!(
        named.iter().any(|name| words.contains(name)),
        "{what}: {says}"
    );
    if words.contains("--fresh") {
        for shard in ["1/2", "2/2"] {
            expect(&folder.run(&run_fresh(shard)), 0, "complete");
        }
        return "--fresh";
    }
    "again"
}
