//! Damaged HDF5 files through the whole program, each in a process of its own with a limit on its
//! memory: whatever a file holds, the program ends with a message and an exit code.
//!
//! `SLIPMAP_DAMAGED=10000 cargo test --release --test program damaged:: -- --nocapture` tries so
//! many files and prints how they ended.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]

mod checksums;

use std::collections::BTreeMap;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use crate::chance::Chance;
use crate::limited::{self, End};
use crate::map;
use crate::program::{Folder, expect};

/// Files that are tried where nothing else is asked for.
const FILES: u64 = 84;

const SWEEP: &str = "title = \"Damaged\"\nfields = [\"n_unstable\", \"abscissa\"]\nbest = true\ndegree_of_stability = [0.05]\n\
    [axes]\nmu_prime = [-0.2, -0.1]\nalpha_v = { from = -1.2, to = 0.0, points = 7 }\n\
    tau = { from = 0.5, to = 6.0, points = 9 }\n[fixed]\nalpha_n = 0.0\n";
const CASE: &str = "horizon = 50.0\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n[fixed]\nv0 = 0.1\n[trace]\nuntil = 20.0\n";

/// What is done with a damaged file. All of `run`, `merge` and `simulate` look at it because it has
/// their output's name.
const COMMANDS: [(&str, &[&str]); 7] = [
    ("info", &["info", "map.h5"]),
    ("plot", &["plot", "map.h5", "-o", "map.png"]),
    (
        "verify",
        &["verify", "map.h5", "--cells", "3", "--tiles", "1"],
    ),
    ("status", &["status", "map.h5"]),
    ("merge", &["merge", "map.h5", "--partial"]),
    (
        "run",
        &[
            "run",
            "sweep.toml",
            "-o",
            "map.h5",
            "--threads",
            "2",
            "--quiet",
        ],
    ),
    ("simulate", &["simulate", "case.toml", "-o", "trace.h5"]),
];

/// Where metadata begins in an HDF5 file.
const SIGNATURES: [&[u8]; 10] = [
    b"\x89HDF", b"OHDR", b"OCHK", b"TREE", b"HEAP", b"SNOD", b"GCOL", b"FRHP", b"BTHD", b"FADB",
];

/// Places where metadata begins.
fn metadata(bytes: &[u8]) -> Vec<usize> {
    let signed = |at: &usize| SIGNATURES.iter().any(|s| bytes[*at..].starts_with(s));
    (0..bytes.len()).filter(signed).collect()
}

/// The bytes, damaged in one to three places, most of them in metadata.
fn damaged(sound: &[u8], metadata: &[usize], chance: &mut Chance) -> Vec<u8> {
    let mut bytes = sound.to_vec();
    for _ in 0..=chance.of(3) {
        let at = match chance.of(10) {
            0..6 if !metadata.is_empty() => metadata[chance.of(metadata.len())] + chance.of(200),
            0..8 => chance.of(2048),
            _ => chance.of(bytes.len()),
        };
        if bytes.is_empty() {
            break;
        }
        let at = at.min(bytes.len() - 1);
        let end = (at + 1 + chance.of(64)).min(bytes.len());
        match chance.of(12) {
            0..4 => bytes[at] ^= 1 << chance.of(8),
            4..6 => bytes[at] = chance.next() as u8,
            6 => bytes[at..end].fill(0),
            7 => bytes[at..end].fill(0xff),
            8 => bytes[at] = [0, 1, 0x7f, 0x80, 0xfe, 0xff][chance.of(6)],
            9 => {
                let end = (at + 8).min(bytes.len());
                let huge = [u64::MAX, 1 << 40, 1 << 31, 1 << 63, 0][chance.of(5)];
                bytes[at..end].copy_from_slice(&huge.to_le_bytes()[..end - at]);
            }
            10 => {
                let from = chance.of(bytes.len() - (end - at) + 1);
                bytes.copy_within(from..from + (end - at), at);
            }
            _ => bytes.truncate(at),
        }
    }
    bytes
}

/// How the program ends that is run with little memory, and what it says.
fn run(folder: &Folder, args: &[&str]) -> (End, String) {
    let ended = limited::run(folder.path(), args, &[("RUST_BACKTRACE", "1")]);
    (ended.end, ended.text())
}

/// A map with one shard of two beside it, and a trace.
struct Sound {
    folder: Folder,
    map: Vec<u8>,
    trace: Vec<u8>,
}

impl Sound {
    fn new() -> Self {
        let folder = Folder::with(&[("sweep.toml", SWEEP), ("case.toml", CASE)]);
        expect(
            &folder.run(&["simulate", "case.toml", "-o", "trace.h5"]),
            0,
            "",
        );
        expect(
            &folder.run(&["run", "sweep.toml", "-o", "map.h5", "--quiet"]),
            0,
            "",
        );
        let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
        let (map, trace) = (read("map.h5"), read("trace.h5"));
        fs::remove_file(folder.path().join("map.h5")).unwrap();
        let shard = [
            "run",
            "sweep.toml",
            "-o",
            "map.h5",
            "--shard",
            "1/2",
            "--quiet",
        ];
        expect(&folder.run(&shard), 0, "");
        fs::rename(
            folder.path().join("map.h5.tiles"),
            folder.path().join("tiles"),
        )
        .unwrap();
        Self { folder, map, trace }
    }

    /// Everything as it was, with other bytes for the map and the trace.
    fn put(&self, command: &str, bytes: &[u8]) {
        let path = |name: &str| self.folder.path().join(name);
        let name = if command == "simulate" {
            "trace.h5"
        } else {
            "map.h5"
        };
        fs::write(path(name), bytes).unwrap();
        let _ = fs::remove_dir_all(path("map.h5.tiles"));
        if command == "merge" {
            copy(&path("tiles"), &path("map.h5.tiles"));
        }
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        match entry.path().is_dir() {
            true => copy(&entry.path(), &target),
            false => drop(fs::copy(entry.path(), target).unwrap()),
        }
    }
}

/// The ways to end that are slipmap's own fault, in words.
fn fault(end: End, said: &str) -> Option<&'static str> {
    match end {
        _ if said.contains("panicked") => Some("it panicked"),
        // The binding makes an enum of the character set of a damaged attribute's name, unchecked.
        End::Signal(_) if said.contains("hdf5-metno") && said.contains("hl/attribute.rs") => None,
        _ if said.contains("memory allocation of") => Some("it asked for too much memory"),
        End::Code(1 | 2) if said.trim().is_empty() => Some("it said nothing"),
        End::Code(0..=2) | End::Signal(_) | End::Hung => None,
        End::Code(_) => Some("no exit code of its own"),
    }
}

fn keep(sound: &Sound, number: u64, name: &str, end: End) {
    let Ok(folder) = std::env::var("SLIPMAP_DAMAGED_KEEP") else {
        return;
    };
    let file = if name == "simulate" {
        "trace.h5"
    } else {
        "map.h5"
    };
    let kept = PathBuf::from(folder).join(format!("{number}-{name}-{end:?}.h5"));
    fs::copy(sound.folder.path().join(file), kept).unwrap();
}

#[test]
fn damaged_files_end_in_a_message() {
    let files = std::env::var("SLIPMAP_DAMAGED").map_or(FILES, |n| n.parse().unwrap());
    let sound = Sound::new();
    let sources = [&sound.map, &sound.trace].map(|bytes| {
        let places = metadata(bytes);
        let blocks = checksums::blocks(bytes, &places);
        assert!(blocks.len() > 10, "{blocks:?} of {places:?}");
        (bytes, places, blocks)
    });
    let mut ends: BTreeMap<(&str, End), u64> = BTreeMap::new();
    let mut faults = Vec::new();
    for number in 0..files {
        if number % 1000 == 999 {
            println!("{} files: {ends:?}", number + 1);
        }
        let (name, args) = COMMANDS[(number % COMMANDS.len() as u64) as usize];
        let mut chance = Chance(number);
        let (whole, places, blocks) = &sources[usize::from(name == "simulate")];
        let mut bytes = damaged(whole, places, &mut chance);
        // Every other file gets past the library's own checksums.
        if chance.of(2) == 0 {
            checksums::repair(&mut bytes, blocks);
        }
        sound.put(name, &bytes);
        let (end, said) = run(&sound.folder, args);
        *ends.entry((name, end)).or_default() += 1;
        let fault = fault(end, &said);
        if fault.is_some() || !matches!(end, End::Code(_)) {
            sound.put(name, &bytes);
            keep(&sound, number, name, end);
            println!("file {number}, {name}: {end:?}: {said}");
        }
        faults.extend(fault.map(|fault| format!("file {number}, {name}: {fault}: {said}")));
    }
    for ((name, end), count) in &ends {
        println!("{name:<10} {end:<12?} {count}");
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    // What the library does with damaged files is not slipmap's; that it is rare is seen here.
    let abnormal = ends
        .iter()
        .filter(|((_, end), _)| !matches!(end, End::Code(_)));
    let abnormal: u64 = abnormal.map(|(_, count)| count).sum();
    assert!(
        abnormal <= 2 + files / 50,
        "{abnormal} of {files} ended in a signal or not at all: {ends:?}"
    );
}

/// Sound HDF5 files that are odd as maps: each is refused in words.
#[test]
fn odd_maps_are_refused() {
    use hdf5::types::{FixedAscii, FixedUnicode, VarLenUnicode};
    use slipmap::store::MapFile;
    type Edit = fn(&hdf5::File) -> hdf5::Result<()>;
    fn put_axes(file: &hdf5::File, text: &str) -> hdf5::Result<()> {
        file.delete_attr("axes")?;
        let text: FixedUnicode<40> = text.parse().unwrap();
        file.new_attr::<FixedUnicode<40>>()
            .create("axes")?
            .write_scalar(&text)
    }
    let edits: [(Edit, &str); 8] = [
        (
            |file| {
                file.delete_attr("axes")?;
                // Never written: a string without a pointer.
                file.new_attr::<VarLenUnicode>().create("axes").map(drop)
            },
            "does not name its axes",
        ),
        (
            |file| {
                file.delete_attr("axes")?;
                // SAFETY: the bytes are only copied; that they are no text is the point.
                let text = unsafe { FixedAscii::<8>::from_ascii_unchecked(&[0xff_u8; 8]) };
                let attribute = file.new_attr::<FixedAscii<8>>().create("axes")?;
                attribute.write_scalar(&text)
            },
            "does not name its axes",
        ),
        (|file| put_axes(file, ""), "it has 0 axes"),
        (|file| put_axes(file, "mu_prime tau tau"), "tau twice"),
        (
            |file| {
                let counts = file.dataset("boundaries/vertex_count")?;
                let mut values = counts.read_raw::<i32>()?;
                values[0] = -values[0];
                counts.write_raw(&values)
            },
            "lengths do not fit together",
        ),
        (
            |file| file.dataset("boundaries/branch")?.resize(1),
            "lengths do not fit together",
        ),
        (
            |file| {
                file.unlink("tau")?;
                let claimed = file.new_dataset::<f64>().chunk(64).shape(9_000_000);
                claimed.create("tau").map(drop)
            },
            "axis tau is damaged",
        ),
        (
            |file| {
                let tau = file.dataset("tau")?;
                tau.write_raw(&vec![f64::NAN; tau.size()])
            },
            "axis tau is damaged",
        ),
    ];
    let sound = Sound::new();
    for (edit, says) in edits {
        sound.put("info", &sound.map);
        let path = sound.folder.path().join("map.h5");
        map::edit(&path, edit).unwrap();
        let found =
            MapFile::open(&path).and_then(|map| map.for_each_curve(|_| ControlFlow::Continue(())));
        let error = found.expect_err(says).to_string();
        assert!(error.contains(says), "{error}");
    }
}

/// A sealed map that cannot be read any more is damaged where this version made it; where another
/// one did, only `verify` reads all of it to see that bytes have changed.
#[test]
fn a_sealed_map_that_cannot_be_read_is_damaged() {
    use hdf5::types::FixedUnicode;
    let sound = Sound::new();
    let path = sound.folder.path().join("map.h5");
    let seal = sound.map.len()
        - 1
        - sound
            .map
            .iter()
            .rev()
            .skip(1)
            .position(|b| *b == b'\n')
            .unwrap();
    for (version, told) in [
        (
            None,
            (1, "is a damaged map: its bytes have changed, its axis tau"),
        ),
        (Some("0.0.9"), (2, "is not a slipmap map: its axis tau")),
    ] {
        sound.put("info", &sound.map);
        let edited: hdf5::Result<()> = map::edit(&path, |file| {
            if let Some(version) = version {
                file.delete_attr("program_version")?;
                let text: FixedUnicode<8> = version.parse().unwrap();
                file.new_attr::<FixedUnicode<8>>()
                    .create("program_version")?
                    .write_scalar(&text)?;
            }
            file.unlink("tau")
        });
        edited.unwrap();
        let bytes = [&fs::read(&path).unwrap(), &sound.map[seal - 1..]].concat();
        fs::write(&path, bytes).unwrap();
        let folder = &sound.folder;
        expect(&folder.run(&["info", "map.h5"]), told.0, told.1);
        let says = "is a damaged map: its bytes have changed, its axis tau";
        expect(&folder.run(&["verify", "map.h5"]), 1, says);
    }
}

/// An axis that claims to be one value, in chunks of a list, as earlier versions stored them:
/// libhdf5 would read for ever.
#[test]
fn chunks_of_other_dimensions_are_refused() {
    use hdf5::types::FixedUnicode;
    let folder = Folder::new();
    let path = folder.path().join("map.h5");
    // In the oldest format: libraries differ in what they write by themselves.
    let mut with = hdf5::FileBuilder::new();
    with.with_fapl(|access| access.libver_earliest());
    let file = with.create(&path).unwrap();
    let put_text = |at: &hdf5::Location, name: &str, text: &str| {
        let attribute = at.new_attr::<FixedUnicode<4>>().create(name).unwrap();
        let text: FixedUnicode<4> = text.parse().unwrap();
        attribute.write_scalar(&text).unwrap();
    };
    let version = file.new_attr::<i32>().create("slipmap_format_version");
    version.unwrap().write_scalar(&2).unwrap();
    put_text(&file, "axes", "tau");
    let list = file.new_dataset::<f64>().shape(0..).chunk(64).deflate(1);
    let axis = list.create("tau").unwrap();
    drop(list);
    axis.resize(9).unwrap();
    axis.write_raw(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0])
        .unwrap();
    put_text(&axis, "units", "1");
    drop((axis, file));
    map::settle(&path);
    let sound = run(&folder, &["info", "map.h5"]);
    assert!(sound.1.contains("cannot read status"), "{sound:?}");
    let mut bytes = fs::read(&path).unwrap();
    // A dataspace of version 1 with one dimension, its largest length unlimited.
    let is_list = |at: &usize| {
        bytes[*at..].starts_with(&[1, 1, 1, 0, 0, 0, 0, 0])
            && bytes[at + 16..].starts_with(&[0xff; 8])
    };
    let lists: Vec<usize> = (0..bytes.len() - 24).filter(is_list).collect();
    let [at] = lists[..] else {
        panic!("{lists:?}");
    };
    bytes[at + 1..at + 3].fill(0);
    fs::write(&path, bytes).unwrap();
    let (end, said) = run(&folder, &["info", "map.h5"]);
    assert_eq!(end, End::Code(2), "{said}");
    // Newer libraries refuse it themselves.
    let why = [
        "another number of dimensions",
        "number of dimensions cannot be zero",
    ];
    let said = said.replace("\n  │ ", " ");
    assert!(why.iter().any(|why| said.contains(why)), "{said}");
}
