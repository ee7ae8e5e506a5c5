//! Losses of power: a recorded trace of what a command does to files is replayed up to any place
//! without all or some of what was not synced until there. Afterwards the old or the new map is
//! whole, what was told as saved is there, and the same command succeeds with the same bytes in
//! every dataset.
//!
//! `SLIPMAP_FAULTS=all` asks for states at every place of the traces; by default some are tried.
//! `SLIPMAP_SEED` for others.
#![cfg(target_os = "linux")]

mod disk;
mod trace;

use std::collections::{BTreeMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};

use crate::chance::Chance;
use crate::interposer::{SWEEP, copy, interposed};
use crate::map::datasets;
use crate::program::{self, Folder, err, output};
use disk::{Change, Disk, Name, Number, lasting};
use slipmap::store::tiles::{Manifest, format};
use slipmap::sweep::Piece;
use trace::Trace;

const OLD: &str = "[axes]\nmu_prime = [-0.3]\nalpha_n = { from = -3.0, to = 1.0, points = 9 }\ntau = [1.0, 2.0, 3.0]\n";

/// States of a case that the test command tries.
const SOME: usize = 10;
/// States by chance at each place.
const BY_CHANCE: u64 = 6;

/// What is tried.
struct Case {
    args: &'static [&'static str],
    /// What has to be done before.
    before: &'static [&'static [&'static str]],
    /// A byte of the first tile file is changed before.
    damage: bool,
    /// A map of another sweep is there before.
    replaces: bool,
    /// What then makes the map, where the command itself does not.
    then: &'static [&'static [&'static str]],
}

const RUN: &[&str] = &["run", "map.toml", "--threads", "1", "--save-every", "0"];
const FRESH: &[&str] = &[
    "run",
    "map.toml",
    "--threads",
    "1",
    "--save-every",
    "0",
    "--fresh",
];
const SHARD: &[&str] = &["run", "map.toml", "--threads", "1", "--shard", "1/2"];
const OTHER_SHARD: &[&str] = &["run", "map.toml", "--shard", "2/2", "-q"];
const MERGE: &[&str] = &["merge", "map.h5"];
const BEFORE: &[&str] = &["run", "old.toml", "-o", "map.h5", "-q"];

const CASES: [Case; 5] = [
    Case {
        args: RUN,
        before: &[],
        damage: false,
        replaces: false,
        then: &[],
    },
    Case {
        args: FRESH,
        before: &[BEFORE],
        damage: false,
        replaces: true,
        then: &[],
    },
    Case {
        args: SHARD,
        before: &[SHARD],
        damage: true,
        replaces: false,
        then: &[OTHER_SHARD, MERGE],
    },
    Case {
        args: MERGE,
        before: &[SHARD, OTHER_SHARD],
        damage: false,
        replaces: false,
        then: &[],
    },
    Case {
        args: &["merge", "map.h5", "--fresh"],
        before: &[
            BEFORE,
            &["run", "map.toml", "--fresh", "--shard", "1/2"],
            &["run", "map.toml", "--fresh", "--shard", "2/2"],
        ],
        damage: false,
        replaces: true,
        then: &[],
    },
];

/// What there is of changes that were not synced.
#[derive(Debug, Clone, Copy)]
enum Unsynced {
    Nothing,
    Everything,
    Names,
    Bytes,
    ByChance(u64),
}

/// What is left after the first changes of a trace.
fn crashed(trace: &Trace, place: usize, unsynced: Unsynced) -> Disk {
    let changes = &trace.changes[..place];
    let mut disk = trace.before.clone();
    let seed = match unsynced {
        Unsynced::ByChance(seed) => seed,
        _ => 0,
    };
    let mut chance = Chance(seed);
    // Rarely most of it, rarely next to nothing.
    let [names, bytes] = [0; 2].map(|_| chance.below(101));
    for (change, lasts) in changes.iter().zip(lasting(changes)) {
        let there = match unsynced {
            _ if lasts => true,
            Unsynced::Nothing => false,
            Unsynced::Everything => true,
            Unsynced::Names => !change.is_of_data(),
            Unsynced::Bytes => change.is_of_data(),
            Unsynced::ByChance(_) if change.is_of_data() => chance.below(100) < bytes,
            Unsynced::ByChance(_) => chance.below(100) < names,
        };
        match (change, unsynced) {
            _ if there => disk.apply(change),
            (Change::Write { node, at, data }, Unsynced::ByChance(_)) => {
                tear(&mut disk, (*node, *at, data), &mut chance);
            }
            _ => {}
        }
    }
    disk
}

/// Some blocks of a write, its length alone, or nothing.
fn tear(disk: &mut Disk, (node, at, data): (Number, usize, &[u8]), chance: &mut Chance) {
    let block = match chance.below(4) {
        0 => 512,
        1 => 4096,
        2 => {
            let length = disk.bytes(node).len().max(at + data.len());
            return disk.bytes(node).resize(length, 0);
        }
        _ => return,
    };
    let mut from = 0;
    while from < data.len() {
        let to = data.len().min(from + block - (at + from) % block);
        if chance.below(2) == 0 {
            disk.write(node, at + from, &data[from..to]);
        }
        from = to;
    }
}

/// What a command had told until some place of its trace.
#[derive(Clone, Default)]
struct Told {
    /// Pieces in tile files whose names were synced.
    saved: u64,
    /// The map had its name.
    complete: bool,
}

/// What had been told before each change, and after the last.
fn told(trace: &Trace) -> Vec<Told> {
    let mut now = trace.before.clone();
    let mut saved = saved_pieces(&mut now, None);
    let mut map = now.at(&Name(Disk::ROOT, "map.h5".into()));
    let old = map;
    let mut told = Vec::new();
    let mut complete = false;
    for change in trace
        .changes
        .iter()
        .chain([&Change::Sync { node: usize::MAX }])
    {
        told.push(Told { saved, complete });
        now.apply(change);
        let Change::Sync { node } = change else {
            continue;
        };
        if *node == Disk::ROOT {
            map = now.at(&Name(Disk::ROOT, "map.h5".into()));
            complete |= map != old;
        } else if *node != usize::MAX && !complete {
            saved = saved.max(saved_pieces(&mut now, Some(*node)));
        }
    }
    told
}

/// Pieces in the tile files of a folder of tiles, or of all.
fn saved_pieces(disk: &mut Disk, of: Option<Number>) -> u64 {
    let mut pieces: HashSet<Piece> = HashSet::new();
    let Some(tiles) = disk.at(&Name(Disk::ROOT, "map.h5.tiles".into())) else {
        return 0;
    };
    let shards: Vec<Number> = disk.entries(tiles).values().copied().collect();
    for shard in shards {
        if of.is_some_and(|of| of != shard) || !disk.is_folder(shard) {
            continue;
        }
        let files = disk.entries(shard).clone();
        let Some(&manifest) = files.get("manifest.json") else {
            continue;
        };
        let text = String::from_utf8(disk.bytes(manifest).clone()).unwrap();
        let layout = Manifest::unseal(&text).unwrap().layout();
        for (_, &file) in files.iter().filter(|(name, _)| name.starts_with("tiles-")) {
            let bytes = disk.bytes(file);
            let entries = format::index(bytes, &layout).unwrap_or_default();
            let sound = entries.iter().filter(|e| format::is_sound(bytes, e));
            pieces.extend(sound.map(|e| e.piece));
        }
    }
    pieces.len() as u64
}

/// A folder in which everything is done that a case needs.
fn prepared(case: &Case) -> Folder {
    let folder = Folder::with(&[("map.toml", SWEEP), ("old.toml", OLD)]);
    for args in case.before {
        let done = folder.run(args);
        assert!(done.status.success(), "{args:?}: {}", err(&done));
    }
    if case.damage {
        let file = folder
            .path()
            .join("map.h5.tiles/1-of-2/tiles-0000000000.bin");
        let mut bytes = std::fs::read(&file).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        std::fs::write(&file, bytes).unwrap();
    }
    folder
}

type Datasets = BTreeMap<String, Vec<u8>>;

/// What is known of a case before anything is lost.
struct Known {
    trace: Trace,
    told: Vec<Told>,
    /// Of the map that was there before.
    old: Option<Datasets>,
    new: Datasets,
}

impl Known {
    fn of(case: &Case) -> Self {
        let original = prepared(case);
        let map = |folder: &Folder| folder.path().join("map.h5");
        let old = case.replaces.then(|| datasets(&map(&original)));
        let folder = Folder::new();
        copy(original.path(), folder.path());
        let record = tempfile::tempdir().unwrap();
        let record = record.path().join("trace");
        let trace = Trace::of(folder.path(), &record, || {
            let mut command = interposed(&folder, case.args);
            let done = output(command.env("FAULTS_TRACE", &record));
            assert!(done.status.success(), "{:?}: {}", case.args, err(&done));
        });
        for args in case.then {
            let done = folder.run(args);
            assert!(done.status.success(), "{args:?}: {}", err(&done));
        }
        Self {
            told: told(&trace),
            trace,
            old,
            new: datasets(&map(&folder)),
        }
    }

    /// Places of the trace and what there is of what was not synced, without those that leave the
    /// same.
    fn states(&self, every: bool, seed: u64) -> Vec<(usize, Unsynced)> {
        let changes = &self.trace.changes;
        let is_data = |i: usize| changes.get(i).is_none_or(Change::is_of_data);
        let mut seen = HashSet::new();
        let mut states = Vec::new();
        for place in 0..=changes.len() {
            // Between two writes to a file little happens.
            if !every && place > 0 && is_data(place) && is_data(place - 1) {
                continue;
            }
            let chances = (0..BY_CHANCE).map(|i| {
                let mut chance = Chance(seed ^ (place as u64 * BY_CHANCE + i));
                Unsynced::ByChance(chance.below(u64::MAX))
            });
            let fixed = [
                Unsynced::Nothing,
                Unsynced::Everything,
                Unsynced::Names,
                Unsynced::Bytes,
            ];
            for unsynced in fixed.into_iter().chain(chances) {
                let mut hasher = DefaultHasher::new();
                crashed(&self.trace, place, unsynced)
                    .listing()
                    .hash(&mut hasher);
                let told = &self.told[place];
                (told.saved, told.complete).hash(&mut hasher);
                if seen.insert(hasher.finish()) {
                    states.push((place, unsynced));
                }
            }
        }
        states
    }
}

fn asked(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

#[test]
fn a_loss_of_power_loses_nothing_that_was_saved() {
    let every = asked("SLIPMAP_FAULTS").is_some_and(|asked| asked == "all");
    let seed = asked("SLIPMAP_SEED").and_then(|seed| seed.parse().ok());
    let mut tried = 0;
    for case in &CASES {
        let known = Known::of(case);
        let states = known.states(every, seed.unwrap_or(14));
        let wanted = if every { states.len() } else { SOME };
        let some: Vec<_> = (0..wanted.min(states.len()))
            .map(|i| states[i * states.len() / wanted.min(states.len())])
            .collect();
        let changes = known.trace.changes.len();
        println!(
            "{:?}: {changes} changes, {} states, {} tried",
            case.args,
            states.len(),
            some.len()
        );
        for (place, unsynced) in some {
            check(case, &known, place, unsynced);
            tried += 1;
        }
    }
    println!("{tried} states");
    assert!(tried >= SOME * CASES.len(), "{tried}");
}

fn check(case: &Case, known: &Known, place: usize, unsynced: Unsynced) {
    let what = format!(
        "{:?} before change {place}, {unsynced:?}: {:?}",
        case.args,
        known.trace.changes.get(place).map(Change::in_short)
    );
    let folder = Folder::new();
    crashed(&known.trace, place, unsynced).put(folder.path(), known.trace.new);
    let told = &known.told[place];
    check_map(&folder, known, told, &what);
    let left = check_kept(&folder, told, &what);
    // Where tiles are kept, --fresh drops them as it was asked to; without it they are gone on
    // with.
    let goes_on = left.is_some() && case.args.contains(&"run");
    let args: Vec<&str> = case
        .args
        .iter()
        .copied()
        .filter(|arg| !goes_on || *arg != "--fresh")
        .collect();
    let again = folder.run(&args);
    assert!(again.status.success(), "{what}: again: {}", err(&again));
    if let Some(left) = left.filter(|_| goes_on && !told.complete) {
        assert_eq!(cells_computed(&folder), Some(left), "{what}");
    }
    for args in case.then {
        let done = folder.run(args);
        assert!(done.status.success(), "{what}: {args:?}: {}", err(&done));
    }
    let map = folder.path().join("map.h5");
    assert!(datasets(&map) == known.new, "{what}: again");
    let left: Vec<String> = folder
        .files()
        .into_iter()
        .filter(|name| name.contains("slipmap-part") || name.contains(".tiles"))
        .collect();
    assert!(left.is_empty(), "{what}: {left:?} is left");
}

/// What has the map's name is the old or the new map, whole; or there is none and nobody says so.
fn check_map(folder: &Folder, known: &Known, told: &Told, what: &str) {
    let map = folder.path().join("map.h5");
    let verified = folder.run(&["verify", "map.h5", "--cells", "4", "--tiles", "1"]);
    assert_eq!(
        verified.status.success(),
        map.exists(),
        "{what}: {}",
        err(&verified)
    );
    let info = folder.run(&["info", "map.h5"]);
    assert!(
        matches!(info.status.code(), Some(0..=2)),
        "{what}: {}",
        err(&info)
    );
    if !map.exists() {
        assert!(!told.complete && known.old.is_none(), "{what}: no map");
        return;
    }
    let found = datasets(&map);
    let is_old = known.old.as_ref() == Some(&found) && !told.complete;
    assert!(is_old || found == known.new, "{what}: another map");
}

/// What was saved is there. The cells of the first shard that are not, where there are tiles.
fn check_kept(folder: &Folder, told: &Told, what: &str) -> Option<u64> {
    let status = folder.run(&["status", "map.h5", "--json"]);
    let status: serde_json::Value = if status.status.success() {
        program::json(&status)
    } else {
        assert!(
            told.saved == 0 && !told.complete,
            "{what}: {}",
            err(&status)
        );
        return None;
    };
    let shards = status["shards"].as_array().unwrap();
    let pieces: u64 = shards
        .iter()
        .map(|s| s["pieces_done"].as_u64().unwrap())
        .sum();
    assert!(
        told.complete || pieces >= told.saved,
        "{what}: {pieces} of {} pieces that were saved",
        told.saved
    );
    let is_told = status["complete"].as_bool().unwrap();
    assert_eq!(is_told, folder.path().join("map.h5").exists(), "{what}");
    let cells = |shard: &serde_json::Value, key: &str| shard[key].as_u64().unwrap();
    let first = shards.first()?;
    Some(cells(first, "cells") - cells(first, "cells_done"))
}

/// The cells that the last run had to compute, as its log says; the lines before may be torn.
fn cells_computed(folder: &Folder) -> Option<u64> {
    let logs = ["map.h5.log", "map.h5.1-of-2.log"];
    let log = logs
        .iter()
        .find_map(|log| std::fs::read(folder.path().join(log)).ok())?;
    let text = String::from_utf8_lossy(&log);
    let (_, last) = text.rsplit_once("\"cells_left\":")?;
    let digits: String = last.chars().take_while(char::is_ascii_digit).collect();
    digits.parse().ok()
}
