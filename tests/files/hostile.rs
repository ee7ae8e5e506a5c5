//! Maps that somebody made to do harm, through every command that opens one: each ends soon, with a
//! message, with little memory, and shows nothing of another file.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]
#![cfg(unix)]

use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::limited::{self, End};
use crate::map;
use crate::program::{self, Folder, err, expect, out};
use crate::server::Serving;
use hdf5::types::FixedUnicode;
use hdf5::{File, Group};
use hdf5_sys::h5a::{H5Aclose, H5Acreate2, H5Awrite};
use hdf5_sys::h5d::{H5Dclose, H5Dcreate2, H5Dwrite_chunk};
use hdf5_sys::h5p::{H5P_CLS_DATASET_CREATE, H5P_DEFAULT, H5Pclose, H5Pcreate};
use hdf5_sys::h5p::{H5Pset_chunk, H5Pset_deflate, H5Pset_external, H5Pset_filter, H5Pset_virtual};
use hdf5_sys::h5s::{H5S_class_t, H5Sclose, H5Screate, H5Screate_simple};
use hdf5_sys::h5t::{H5T_class_t, H5Tclose, H5Tcreate};

/// The most memory that a command may take for any of these, bytes.
const MOST_MEMORY: u64 = 500 << 20;

const SWEEP: &str = "title = \"Hostile\"\nfields = [\"n_unstable\", \"abscissa\"]\nbest = true\n\
    [axes]\nmu_prime = [-0.2, -0.1]\nalpha_v = { from = -1.2, to = 0.0, points = 7 }\n\
    tau = { from = 0.5, to = 6.0, points = 9 }\n[fixed]\nalpha_n = 0.0\n";
const CASE: &str = "horizon = 50.0\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n[fixed]\nv0 = 0.1\n[trace]\nuntil = 20.0\n";
/// What is in the file that nobody is to see: eight bytes are a number, too.
const SECRET: &[u8; 72] =
    b"SECRETs@SECRETt@SECRETu@SECRETv@SECRETw@SECRETx@SECRETy@SECRETz@SECRET{@";

/// The commands that open a map, with the exit codes that they may end with where it is refused.
const COMMANDS: [(&[&str], &[i32]); 8] = [
    (&["info", "map.h5"], &[1, 2]),
    (&["plot", "map.h5", "-o", "drawn.png"], &[1, 2]),
    (
        &["verify", "map.h5", "--cells", "3", "--tiles", "1"],
        &[1, 2],
    ),
    (&["verify", "map.h5", "--json"], &[1, 2]),
    (&["status", "map.h5"], &[1, 2]),
    (&["merge", "map.h5"], &[0, 1, 2]),
    (
        &["run", "sweep.toml", "-o", "map.h5", "--threads", "2", "-q"],
        &[0, 1, 2],
    ),
    (&["simulate", "case.toml", "-o", "map.h5"], &[1, 2]),
];

/// How much of a map is still read.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Reach {
    /// No command reads it.
    Nothing,
    /// What is wrong is where only some commands look.
    Some,
    /// It is a map with something beside it: `verify` alone refuses it.
    AllButVerify,
}

type Edit = fn(&File, &Path) -> hdf5::Result<()>;

/// What is done to a sound map, and what `verify` says then.
const EDITS: [(&str, Edit, &str, Reach); 24] = [
    (
        "a group in itself",
        |f, _| f.link_hard("/", "boundaries/again"),
        "no map holds again",
        Reach::AllButVerify,
    ),
    (
        "the root in itself",
        |f, _| f.link_hard("/", "again"),
        "no map holds again",
        Reach::AllButVerify,
    ),
    (
        "values under many names",
        |f, _| (0..300).try_for_each(|i| f.link_hard("tau", &format!("l{i}"))),
        "stands under several names",
        Reach::Nothing,
    ),
    (
        "many attributes",
        |f, _| {
            let group = f.group("boundaries")?;
            (0..100).try_for_each(|i| {
                let text = format!("a{i}");
                group.new_attr::<f64>().create(&*text).map(drop)
            })
        },
        "attributes",
        Reach::AllButVerify,
    ),
    (
        "nested groups",
        nested,
        "no map holds deep",
        Reach::AllButVerify,
    ),
    (
        "many groups",
        many,
        "more than 1000 members",
        Reach::AllButVerify,
    ),
    (
        "an axis elsewhere in the file",
        |f, _| {
            f.relink("tau", "real")?;
            f.link_soft("/real", "tau")
        },
        "tau is a link",
        Reach::Nothing,
    ),
    (
        "an axis in another file",
        |f, _| linked(f, "tau", "other.h5"),
        "tau is a link",
        Reach::Nothing,
    ),
    (
        "an axis in a pipe",
        |f, _| linked(f, "tau", "pipe"),
        "tau is a link",
        Reach::Nothing,
    ),
    (
        "a field in another file",
        |f, _| linked(f, "abscissa", "other.h5"),
        "abscissa is a link",
        Reach::Nothing,
    ),
    (
        "a group in another file",
        |f, _| linked(f, "best", "other.h5"),
        "best",
        Reach::Nothing,
    ),
    (
        "curves in another file",
        |f, _| linked(f, "boundaries/tau", "other.h5"),
        "tau is a link",
        Reach::Some,
    ),
    (
        "an axis of the bytes of another file",
        |f, _| outside(f, c"secret"),
        "values in another file",
        Reach::Nothing,
    ),
    (
        "an axis of the bytes of a pipe",
        |f, _| outside(f, c"pipe"),
        "values in another file",
        Reach::Nothing,
    ),
    (
        "an axis of datasets in another file",
        |f, _| elsewhere(f, c"other.h5"),
        "values in other datasets",
        Reach::Nothing,
    ),
    (
        "an axis of datasets in a pipe",
        |f, _| elsewhere(f, c"pipe"),
        "values in other datasets",
        Reach::Nothing,
    ),
    (
        "an axis through a plugin",
        plugged,
        "filters that slipmap does not use",
        Reach::Nothing,
    ),
    (
        "an axis deflated twice",
        deflated_twice,
        "filters that slipmap does not use",
        Reach::Nothing,
    ),
    (
        "a chunk that does not end",
        |f, _| endless(f, 1_000_000),
        "does not inflate to its own size",
        Reach::Nothing,
    ),
    (
        "a chunk of more bytes than it can have",
        |f, _| endless(f, 1000),
        "more bytes than it can have",
        Reach::Nothing,
    ),
    (
        "a huge chunk",
        huge_chunk,
        "chunks of more bytes",
        Reach::Nothing,
    ),
    (
        "values of another type",
        of_structures,
        "another type",
        Reach::Nothing,
    ),
    (
        "a curve that claims much",
        |f, _| claims(f, "boundaries/omega"),
        "claims more values",
        Reach::Some,
    ),
    (
        "a best setting that claims much",
        |f, _| claims(f, "best/abscissa"),
        "claims more values",
        Reach::Some,
    ),
];

/// Puts a link to another file in the place of something.
fn linked(file: &File, name: &str, other: &str) -> hdf5::Result<()> {
    file.unlink(name)?;
    file.link_external(other, &format!("/{name}"), name)
}

fn nested(file: &File, _: &Path) -> hdf5::Result<()> {
    let mut group = file.create_group("deep")?;
    for _ in 0..20_000 {
        group = group.create_group("d")?;
    }
    Ok(())
}

fn many(file: &File, _: &Path) -> hdf5::Result<()> {
    (0..1001).try_for_each(|i| file.create_group(&format!("g{i}")).map(drop))
}

/// Makes a dataset of reals in the place of the axis tau, as the properties say that `set` gives
/// it.
fn axis(file: &File, length: usize, set: impl FnOnce(i64) -> i32) -> hdf5::Result<()> {
    file.unlink("tau")?;
    let kind = hdf5::Datatype::from_type::<f64>()?;
    let lengths = [length as u64];
    let made = hdf5::sync::sync(|| {
        // SAFETY: the file is open, the lengths live, and every identifier is closed.
        unsafe {
            let space = H5Screate_simple(1, lengths.as_ptr(), std::ptr::null());
            let plist = H5Pcreate(*H5P_CLS_DATASET_CREATE);
            assert!(set(plist) >= 0);
            let name = c"tau".as_ptr();
            let dataset = H5Dcreate2(
                file.id(),
                name,
                kind.id(),
                space,
                H5P_DEFAULT,
                plist,
                H5P_DEFAULT,
            );
            let made = H5Dclose(dataset);
            H5Pclose(plist);
            H5Sclose(space);
            made
        }
    });
    assert!(made >= 0);
    let units = file
        .dataset("tau")?
        .new_attr::<FixedUnicode<2>>()
        .create("units")?;
    units.write_scalar(&"1".parse::<FixedUnicode<2>>().unwrap())
}

fn outside(file: &File, from: &std::ffi::CStr) -> hdf5::Result<()> {
    // SAFETY: the name ends in a null byte.
    axis(file, 9, |plist| unsafe {
        H5Pset_external(plist, from.as_ptr(), 0, 72)
    })
}

fn elsewhere(file: &File, from: &std::ffi::CStr) -> hdf5::Result<()> {
    // SAFETY: the names end in a null byte, and the space is closed.
    axis(file, 9, |plist| unsafe {
        let space = H5Screate_simple(1, [9].as_ptr(), std::ptr::null());
        let set = H5Pset_virtual(plist, space, from.as_ptr(), c"/tau".as_ptr(), space);
        H5Sclose(space);
        set
    })
}

/// Writes the only chunk of the axis.
fn put_chunk(file: &File, bytes: &[u8]) -> hdf5::Result<()> {
    let dataset = file.dataset("tau")?;
    // SAFETY: the dataset has one dimension, and the slice lives.
    let written = hdf5::sync::sync(|| unsafe {
        H5Dwrite_chunk(
            dataset.id(),
            H5P_DEFAULT,
            0,
            [0].as_ptr(),
            bytes.len(),
            bytes.as_ptr().cast(),
        )
    });
    assert!(written >= 0);
    Ok(())
}

fn plugged(file: &File, _: &Path) -> hdf5::Result<()> {
    // SAFETY: no values are given.
    axis(file, 9, |plist| unsafe {
        H5Pset_chunk(plist, 1, [9].as_ptr());
        H5Pset_filter(plist, 32768 + 77, 1, 0, std::ptr::null())
    })?;
    put_chunk(file, &[0; 72])
}

fn deflated_twice(file: &File, _: &Path) -> hdf5::Result<()> {
    // SAFETY: the list lives.
    axis(file, 9, |plist| unsafe {
        H5Pset_chunk(plist, 1, [9].as_ptr());
        H5Pset_deflate(plist, 9);
        H5Pset_filter(plist, 1, 1, 1, [9].as_ptr())
    })
}

/// An axis of one chunk whose bytes would inflate to 630 MB.
fn endless(file: &File, length: usize) -> hdf5::Result<()> {
    // SAFETY: the list lives.
    axis(file, length, |plist| unsafe {
        H5Pset_chunk(plist, 1, [length as u64].as_ptr());
        H5Pset_deflate(plist, 9)
    })?;
    put_chunk(file, &zeros(4_000_000))
}

/// A stream of deflate's fixed codes: a zero, then copies of it, 258 at a time, without an end.
fn zeros(bytes: usize) -> Vec<u8> {
    let mut stream = vec![0x78, 0x01];
    let (mut bits, mut count) = (0_u32, 0);
    // The last block, of fixed codes; the literal 0; then length 258 and distance 1 in 13 bits.
    let head = [(0b011, 3), (0b0000_1100, 8)];
    let copy = std::iter::repeat((0b0_0000_1010_0011, 13));
    for (code, length) in head.into_iter().chain(copy) {
        bits |= code << count;
        count += length;
        while count >= 8 {
            stream.push(bits as u8);
            bits >>= 8;
            count -= 8;
        }
        if stream.len() >= bytes {
            return stream;
        }
    }
    stream
}

fn huge_chunk(file: &File, _: &Path) -> hdf5::Result<()> {
    // SAFETY: the list lives.
    axis(file, 20_000_000, |plist| unsafe {
        H5Pset_chunk(plist, 1, [20_000_000].as_ptr());
        H5Pset_deflate(plist, 9)
    })?;
    put_chunk(file, &zeros(4_000_000))
}

fn of_structures(file: &File, _: &Path) -> hdf5::Result<()> {
    #[derive(Clone, Copy, hdf5::H5Type)]
    #[repr(C)]
    struct Pair {
        a: f64,
        b: [u8; 8],
    }
    file.unlink("tau")?;
    let pairs = [Pair { a: 1.0, b: [0; 8] }; 9];
    file.new_dataset_builder()
        .with_data(&pairs)
        .create("tau")
        .map(drop)
}

/// A column of as many values as there are bytes for, a thousand times.
fn claims(file: &File, name: &str) -> hdf5::Result<()> {
    let (group, name) = name.split_once('/').unwrap();
    let group: Group = file.group(group)?;
    group.unlink(name)?;
    let builder = group.new_dataset_builder().deflate(9).empty::<f64>();
    builder
        .chunk(1 << 20)
        .shape(1 << 40)
        .create(name)?
        .write_slice(&[1.0], 0..1)
}

/// A folder with a sound map, and other files that it has no business with.
struct Place {
    folder: Folder,
    map: Vec<u8>,
}

impl Place {
    fn new() -> Self {
        let folder = Folder::with(&[("sweep.toml", SWEEP), ("case.toml", CASE)]);
        expect(
            &folder.run(&["run", "sweep.toml", "-o", "map.h5", "-q"]),
            0,
            "map.h5",
        );
        let path = |name: &str| folder.path().join(name);
        let map = fs::read(path("map.h5")).unwrap();
        fs::write(path("secret"), SECRET).unwrap();
        fs::copy(path("map.h5"), path("other.h5")).unwrap();
        map::edit(&path("other.h5"), |file| {
            let values: Vec<f64> = (0..9).map(|i| 7.25e77 + f64::from(i) * 1e77).collect();
            file.dataset("tau").unwrap().write_raw(&values).unwrap();
        });
        let made = Command::new("mkfifo").arg(path("pipe")).status().unwrap();
        assert!(made.success());
        let place = Self { folder, map };
        place.build_plugin();
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn build_plugin(&self) {
        fs::create_dir(self.path("plugins")).unwrap();
        let library = self.path("plugins/libhostile.so");
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hostile/plugin.c");
        let built = Command::new("cc")
            .args(["-shared", "-fPIC", "-o"])
            .arg(library)
            .arg(source)
            .status();
        assert!(built.unwrap().success());
    }

    /// Runs a command and checks what holds of all of them.
    fn run(&self, what: &str, args: &[&str]) -> (i32, String) {
        let (mark, plugins) = (self.path("mark"), self.path("plugins"));
        let variables = [
            ("HOSTILE_MARK", mark.to_str().unwrap()),
            ("HDF5_PLUGIN_PATH", plugins.to_str().unwrap()),
        ];
        let ended = limited::run(self.folder.path(), args, &variables);
        let text = ended.text();
        let End::Code(code) = ended.end else {
            panic!("{what}, {args:?}: {:?}: {text}", ended.end);
        };
        assert!(!text.contains("panicked"), "{what}, {args:?}: {text}");
        assert!(
            code == 0 || !text.trim().is_empty(),
            "{what}, {args:?}: it said nothing"
        );
        assert!(!mark.exists(), "{what}, {args:?}: the plugin was loaded");
        for secret in ["SECRET", "7.25", "72500"] {
            assert!(!text.contains(secret), "{what}, {args:?}: {text}");
        }
        // SECRETs@ as a number.
        assert!(!text.contains("310."), "{what}, {args:?}: {text}");
        assert!(
            ended.peak < MOST_MEMORY,
            "{what}, {args:?}: {} bytes",
            ended.peak
        );
        assert!(is_harmless(&ended.said), "{what}, {args:?}: {text:?}");
        (code, text)
    }
}

/// Whether no byte moves a terminal's cursor or turns its direction.
fn is_harmless(said: &[u8]) -> bool {
    let text = String::from_utf8(said.to_vec()).unwrap();
    text.chars()
        .all(|c| (!c.is_control() || "\n\t".contains(c)) && !"\u{61c}\u{200e}\u{200f}\u{202a}\u{202b}\u{202c}\u{202d}\u{202e}\u{2066}\u{2067}\u{2068}\u{2069}".contains(c))
}

#[test]
fn maps_that_lead_elsewhere_or_swell_are_refused() {
    let place = Place::new();
    for (what, edit, says, reach) in EDITS {
        fs::write(place.path("map.h5"), &place.map).unwrap();
        let path = place.path("map.h5");
        map::edit(&path, |file| edit(file, place.folder.path())).unwrap();
        let bytes = fs::read(&path).unwrap();
        let mut said = String::new();
        for (args, codes) in COMMANDS {
            let (code, text) = place.run(what, args);
            said += &text;
            let verifies = args[0] == "verify";
            let refused = match reach {
                Reach::Nothing => true,
                Reach::Some => verifies,
                Reach::AllButVerify => verifies || args[0] == "simulate",
            };
            let allowed: &[i32] = if refused { codes } else { &[0, 1, 2] };
            assert!(allowed.contains(&code), "{what}, {args:?}: {code}: {text}");
            assert!(
                fs::read(&path).unwrap() == bytes,
                "{what}, {args:?} changed the map"
            );
        }
        let words = said
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
            .replace("│ ", "");
        assert!(words.contains(says), "{what}: {words}");
    }
}

/// A text that clears the screen, in every way, and turns what follows around.
const LOUD: &str = "\u{1b}[2Jloud\u{9b}31m\u{7}\r\u{202e}\u{2066}end";

#[test]
fn control_characters_are_shown_as_such() {
    let place = Place::new();
    let path = place.path("map.h5");
    for name in [
        "title",
        "history",
        "source",
        "plan_hash",
        "friction_law",
        "axes",
        "protocol",
        "git_revision",
    ] {
        fs::write(&path, &place.map).unwrap();
        map::edit(&path, |file| put_loud(file, name)).unwrap();
        for (args, _) in COMMANDS {
            place.run(name, args);
        }
    }
    fs::write(&path, &place.map).unwrap();
    map::edit(&path, |file| file.create_group(LOUD).map(drop)).unwrap();
    let (code, text) = place.run("a name", &["verify", "map.h5"]);
    assert!(code == 1 && text.contains("\\u{1b}[2Jloud"), "{text}");
    // Names of files, arguments, and what stands in files of text.
    let loud = std::ffi::OsStr::from_bytes(LOUD.as_bytes());
    fs::write(place.folder.path().join(loud), "no map").unwrap();
    for args in [
        &["info", LOUD][..],
        &["plot", LOUD],
        &["status", LOUD],
        &["run", "sweep.toml", "-o", LOUD],
        &["plan", LOUD],
        &["info", "map.h5", LOUD],
        &["merge", "map.h5", LOUD],
    ] {
        let (code, text) = place.run("an argument", args);
        // clap drops some of them itself.
        assert!(
            code > 0 && text.contains("loud\\u{9b}31m"),
            "{args:?}: {text}"
        );
    }
    for sweep in [
        format!("title = \"{LOUD}\"\n{SWEEP}"),
        SWEEP.replace(
            "[axes]",
            &format!("[axes]\n\"{}\" = 1 # {LOUD}", "\\u001b[2J"),
        ),
        format!("# {LOUD}\nfields = [\"\\u001b[2J\\u202e\"]\n"),
        format!("\u{1b}[2J = {LOUD}"),
        SWEEP.replace("points = 7", &format!("points = \"{LOUD}\"")),
    ] {
        fs::write(place.path("loud.toml"), sweep).unwrap();
        for command in ["run", "plan", "simulate"] {
            let (code, _) = place.run("a sweep file", &[command, "loud.toml"]);
            assert_eq!(code, 2);
        }
    }
    fs::remove_file(&path).unwrap();
    expect(
        &place
            .folder
            .run(&["run", "sweep.toml", "-o", "map.h5", "--shard", "1/2", "-q"]),
        0,
        "",
    );
    let manifest = place.path("map.h5.tiles/1-of-2/manifest.json");
    let text = fs::read_to_string(&manifest).unwrap();
    for (from, to) in [
        ("\"shard\": \"1/2\"", "\"shard\": \"\\u001b[2J\""),
        ("\"plan_hash\": \"", "\"plan_hash\": \"\\u001b[2J"),
        ("\"plan_hash\"", "\"\\u001b[2J\""),
        (
            "\"git_revision\": \"",
            "\"git_revision\": \"\\u001b[2J\\u202e",
        ),
    ] {
        fs::write(&manifest, text.replacen(from, to, 1)).unwrap();
        for (args, _) in COMMANDS {
            place.run("a manifest", args);
        }
        place.run(
            "a manifest",
            &["run", "sweep.toml", "-o", "map.h5", "--shard", "1/2"],
        );
        place.run("a manifest", &["status", "map.h5", "--json"]);
    }
}

/// Texts of 60 MB: what is shown of them is short, and takes little memory.
#[test]
fn long_texts_are_cut() {
    let place = Place::new();
    for name in ["title", "axes", "sweep"] {
        fs::write(place.path("map.h5"), &place.map).unwrap();
        map::edit(&place.path("map.h5"), |file| put_long(file, name));
        for (args, _) in COMMANDS {
            let (_, text) = place.run(name, args);
            assert!(
                text.len() < 100_000,
                "{name}, {args:?}: {} bytes",
                text.len()
            );
        }
    }
}

/// A text of fixed length, all of it characters that have to be spelled out.
fn put_long(file: &File, name: &str) {
    file.delete_attr(name).unwrap();
    let text = vec![0x1b_u8; 60 << 20];
    let name = std::ffi::CString::new(name).unwrap();
    let written = hdf5::sync::sync(|| {
        // SAFETY: the file is open, the text has the length of its type, and every identifier is
        // closed.
        unsafe {
            let kind = H5Tcreate(H5T_class_t::H5T_STRING, text.len());
            let space = H5Screate(H5S_class_t::H5S_SCALAR);
            let attribute = H5Acreate2(
                file.id(),
                name.as_ptr(),
                kind,
                space,
                H5P_DEFAULT,
                H5P_DEFAULT,
            );
            let written = H5Awrite(attribute, kind, text.as_ptr().cast());
            H5Aclose(attribute);
            H5Sclose(space);
            H5Tclose(kind);
            written
        }
    });
    assert!(written >= 0);
}

fn put_loud(file: &File, name: &str) -> hdf5::Result<()> {
    if file.attr(name).is_ok() {
        file.delete_attr(name)?;
    }
    let attribute = file.new_attr::<FixedUnicode<64>>().create(name)?;
    attribute.write_scalar(&LOUD.parse::<FixedUnicode<64>>().unwrap())
}

fn fifo(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

/// What stands in the place of a file: a pipe that nobody writes to, a device without an end, and a
/// file of the system that waits for its reader.
fn odd_files(path: &Path) -> Vec<&'static str> {
    fifo(&path.join("pipe"));
    for (name, to) in [("zero", "/dev/zero"), ("message", "/proc/kmsg")] {
        std::os::unix::fs::symlink(to, path.join(name)).unwrap();
    }
    let readable = fs::OpenOptions::new().read(true).open("/proc/kmsg").is_ok();
    let all = ["pipe", "zero", "message"].into_iter();
    all.filter(|name| *name != "message" || readable).collect()
}

/// A command ends soon, with little memory, with one of `codes`; what it says.
fn ended(folder: &Path, args: &[&str], codes: &[i32]) -> String {
    let ended = limited::run(folder, args, &[]);
    let text = ended.text();
    let End::Code(code) = ended.end else {
        panic!("{args:?}: {:?}: {text}", ended.end);
    };
    assert!(codes.contains(&code), "{args:?}: {code}: {text}");
    assert!(!text.contains("panicked"), "{args:?}: {text}");
    assert!(ended.peak < MOST_MEMORY, "{args:?}: {} bytes", ended.peak);
    text
}

#[test]
fn what_is_no_regular_file_is_not_read() {
    const TABLE: &str =
        "[axes]\ntau = [1, 2]\n[fixed]\nv0 = 0.1\n[friction]\nlaw = \"table\"\ntable = \"FILE\"\n";
    const SYSTEM: &str = "system = \"FILE\"\n[axes]\ntau = [1, 2]\n";
    let folder = Folder::with(&[("case.toml", CASE), ("sweep.toml", SWEEP)]);
    let path = folder.path();
    for odd in odd_files(path) {
        for args in [
            &["run", odd, "-o", "map.h5"][..],
            &["plan", odd],
            &["simulate", odd, "-o", "trace.h5"],
            &["point", "--system", odd, "--tau", "1"],
            &["best", "--system", odd, "--search", "a"],
            &["point", "--setting", odd],
            &["margins", "--setting", odd],
            &["vc", "--friction", "table", "--table", odd],
            &["info", odd],
            &["plot", odd],
            &["status", odd],
            &["verify", odd],
            &["export", odd],
            &["merge", odd],
            &["point", "--map", odd, "--at", "tau=1"],
        ] {
            let text = ended(path, args, &[2]);
            assert!(!text.trim().is_empty(), "{args:?}");
        }
        for text in [TABLE, SYSTEM] {
            fs::write(path.join("of_odd.toml"), text.replace("FILE", odd)).unwrap();
            for command in ["run", "plan"] {
                let text = ended(path, &[command, "of_odd.toml"], &[2]);
                assert!(text.contains("it is no regular file"), "{text}");
            }
        }
        // What they would replace or append to is left alone.
        fs::create_dir(path.join("kept")).unwrap();
        for name in ["fig2a.toml", "letter.html"] {
            let to = path.join("kept").join(name);
            std::os::unix::fs::symlink(path.join(odd), to).unwrap();
        }
        let keep = ["reproduce", "--quick", "--json", "--keep", "kept"];
        let text = ended(path, &keep, &[2]);
        assert!(text.contains("it is left as it is"), "{text}");
        ended(
            path,
            &["reproduce", "--quick", "-o", "kept/letter.html"],
            &[2],
        );
        fs::remove_dir_all(path.join("kept")).unwrap();
        for name in ["map.png", "map.h5.log"] {
            let _ = fs::remove_file(path.join(name));
            std::os::unix::fs::symlink(path.join(odd), path.join(name)).unwrap();
        }
        let run = ["run", "sweep.toml", "-o", "map.h5", "--fresh"];
        let text = ended(path, &run, &[0]);
        assert!(text.contains("warning: no picture"), "{text}");
    }
}

/// A pipe where a folder of tiles has its lock, manifest or tiles holds up no command, and no
/// server.
#[test]
fn odd_files_among_tiles_hold_up_nobody() {
    let folder = Folder::with(&[("sweep.toml", SWEEP)]);
    let path = folder.path();
    let run = ["run", "sweep.toml", "-o", "map.h5", "--shard", "1/2", "-q"];
    expect(&folder.run(&run), 0, "complete");
    let tiles = path.join("map.h5.tiles/1-of-2");
    let files = fs::read_dir(&tiles).unwrap();
    let names: Vec<_> = files.map(|file| file.unwrap().file_name()).collect();
    assert!(names.len() >= 2, "{names:?}");
    for name in names
        .iter()
        .map(|name| name.to_str().unwrap())
        .chain(["lock"])
    {
        let kept = fs::read(tiles.join(name));
        let _ = fs::remove_file(tiles.join(name));
        fifo(&tiles.join(name));
        for args in [
            &["status", "map.h5"][..],
            &["status", "map.h5", "--json"],
            &["merge", "map.h5"],
            &["merge", "map.h5", "--partial"],
            &["verify", "map.h5"],
            &run,
            &[
                "run",
                "sweep.toml",
                "-o",
                "map.h5",
                "--shard",
                "1/2",
                "--fresh",
            ],
            &["run", "sweep.toml", "-o", "map.h5", "--fresh"],
        ] {
            ended(path, args, &[0, 1, 2]);
        }
        if name == "lock" {
            let text = ended(path, &run, &[2]);
            assert!(text.contains("stands where the tiles go"), "{text}");
        }
        let serving = Serving::with(&folder, &[&path.to_string_lossy()]);
        let begun = std::time::Instant::now();
        for _ in 0..4 {
            let answer = serving.get("/api/v1/maps");
            assert_eq!(answer.status, 200, "{}", answer.head);
        }
        assert!(begun.elapsed().as_secs() < 20);
        drop(serving);
        fs::remove_file(tiles.join(name)).unwrap();
        if let Ok(kept) = kept {
            fs::write(tiles.join(name), kept).unwrap();
        }
        let _ = fs::remove_file(path.join("map.h5"));
    }
}

/// A text of 16 MB, all of it small parts, takes a few hundred megabytes at most.
#[test]
fn texts_of_many_small_parts_take_little_memory() {
    let folder = Folder::new();
    let path = folder.path();
    for (part, before) in [
        ("1,", "[axes]\ntau = ["),
        ("1, ", "[axes]\ntau = ["),
        ("[],", "a = ["),
        ("{},", "a = ["),
        ("\n", ""),
        ("#\n", ""),
        (".a", "a"),
        ("\"\",", "a = ["),
        ("[[a]]\n", ""),
        ("[", "a = "),
        ("{a=", "a = "),
    ] {
        let text = before.to_owned() + &part.repeat(((16 << 20) - before.len()) / part.len());
        fs::write(path.join("sweep.toml"), text).unwrap();
        for args in [
            &["run", "sweep.toml"][..],
            &["plan", "sweep.toml"],
            &["point", "--system", "sweep.toml", "--tau", "1"],
        ] {
            let text = ended(path, args, &[2]);
            assert!(text.len() < 100_000, "{part:?}: {} bytes", text.len());
        }
    }
}

/// Texts that a system's file gives move no cursor and turn no direction.
#[test]
fn texts_of_systems_are_shown_as_such() {
    const UNSEEN: &str = "a\u{202e}b\u{2028}c\u{200b}d\u{ad}e\u{e0041}f";
    let system = format!(
        "title = \"{UNSEEN}\"\nP = \"s^2 + 2*z*s + 1 + w\"\nQ = \"-w\"\n[parameters]\n\
         z = {{ default = 0.02, long_name = \"{UNSEEN}\" }}\n\
         w = {{ default = 0.1, long_name = \"{UNSEEN}\" }}\n\
         [speed_axis]\nname = \"{UNSEEN}\"\nperiod = \"tau\"\n"
    );
    let sweep = format!(
        "title = \"{UNSEEN}\"\nsystem = \"system.toml\"\n[axes]\nw = [0.1, 0.2]\ntau = [1, 2, 3]\n"
    );
    let folder = Folder::with(&[("system.toml", &*system), ("sweep.toml", &*sweep)]);
    let feedback = "title = \"T\"\nB = \"s^2 + 0.2*s + 1\"\nA = \"g\"\n[parameters]\ng = 0\n";
    let feedback = feedback.replace('T', UNSEEN);
    fs::write(folder.path().join("loop.toml"), feedback).unwrap();
    for args in [
        &["point", "--system", "system.toml", "--tau", "1"][..],
        &["point", "--system", "system.toml", "--tau", "1", "--json"],
        &[
            "best",
            "--system",
            "loop.toml",
            "--search",
            "g",
            "--search-from",
            "-0.3",
            "--search-to",
            "0.3",
        ],
        &["plan", "sweep.toml"],
        &["plan", "sweep.toml", "--json"],
        &["run", "sweep.toml", "-o", "map.h5"],
        &["info", "map.h5"],
        &["info", "map.h5", "--json"],
        &["export", "map.h5", "--comments"],
        &["export", "map.h5", "--comments", "--table", "boundaries"],
        &["verify", "map.h5"],
        &["point", "--map", "map.h5", "--at", "tau=1", "--at", "w=0.1"],
    ] {
        let said = folder.run(args);
        let text = out(&said) + &err(&said);
        let unseen = "\u{202e}\u{2028}\u{200b}\u{ad}\u{e0041}";
        assert!(!text.contains(|c| unseen.contains(c)), "{args:?}: {text:?}");
    }
    let said = folder.run(&["point", "--system", "system.toml", "--tau", "1"]);
    expect(
        &said,
        0,
        "a\\u{202e}b\\u{2028}c\\u{200b}d\\u{ad}e\\u{e0041}f is",
    );
}

/// Under every limit on the address space a run ends with a message or with its map, and what it
/// has computed is kept.
#[test]
fn a_run_with_little_address_space_ends_in_order() {
    let text = SWEEP
        .replace("points = 7", "points = 40")
        .replace("points = 9", "points = 300");
    let folder = Folder::with(&[("sweep.toml", &text)]);
    let limited = |limit: u64, args: &[&str]| {
        let script = format!("ulimit -c 0; ulimit -v {limit}; exec \"$0\" \"$@\"");
        let mut command = Command::new("sh");
        command.args(["-c", &script, env!("CARGO_BIN_EXE_slipmap")]);
        command.args(args).current_dir(folder.path());
        program::output(&mut command)
    };
    let runs = |limit: u64| limited(limit, &["--version"]).status.code() == Some(0);
    // The least in which the program starts at all, to 1 MiB.
    let least = (10..2000).find(|mib| runs(mib << 10)).unwrap();
    let mut ends = std::collections::BTreeMap::new();
    for more in (0..30).chain([40, 60, 80, 100, 150, 200, 300, 500, 1000]) {
        for threads in ["1", "8"] {
            let args = [
                "run",
                "sweep.toml",
                "-o",
                "map.h5",
                "--fresh",
                "--threads",
                threads,
            ];
            let output = limited((least + more) << 10, &args);
            let text = out(&output) + &err(&output);
            let code = output.status.code();
            assert!(
                matches!(code, Some(0..=2)),
                "{more} MiB more: {:?}: {text}",
                output.status
            );
            for word in [
                "panicked",
                "backtrace",
                "memory allocation of",
                "fatal runtime",
            ] {
                assert!(!text.contains(word), "{more} MiB more: {text}");
            }
            assert!(code == Some(0) || !text.trim().is_empty());
            *ends.entry(code).or_insert(0) += 1;
        }
    }
    println!("{least} MiB at least: {ends:?}");
    assert!(ends.len() > 1, "{ends:?}");
    expect(
        &folder.run(&["verify", "map.h5", "--cells", "5", "--tiles", "1"]),
        0,
        "",
    );
}

/// What a killed command has left beside its map or picture goes with the next one.
#[test]
fn leftovers_of_a_kill_are_removed() {
    let folder = Folder::with(&[("sweep.toml", SWEEP)]);
    let run = ["run", "sweep.toml", "-o", "map.h5", "-q"];
    expect(&folder.run(&run), 0, "map.h5");
    let clean = folder.files();
    for beside in [".map.h5", ".map.png"] {
        for purpose in ["lock", "part"] {
            let left = folder.path().join(format!("{beside}.slipmap-{purpose}"));
            fs::write(left, "").unwrap();
        }
    }
    assert_eq!(folder.files().len(), clean.len() + 4);
    expect(&folder.run(&run), 0, "already complete");
    assert_eq!(folder.files(), clean);
}
