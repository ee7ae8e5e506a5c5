//! A field, a parameter, a friction law and a command that somebody adds, each by the few lines of
//! a patch in `tests/growth`: a copy of the crate with them makes a map, which is read with the HDF5
//! library and compared with closed forms, and runs the command.

use std::fs;
use std::path::Path;
use std::process::Command;

/// Patches in the order in which they are applied, the files that they touch, and the lines that
/// they add.
const PATCHES: [(&str, usize, usize); 4] = [
    // A row that picks a number which motions have.
    ("field", 1, 10),
    // A row.
    ("parameter", 1, 12),
    // Its file: form, value, slope, bounds and series; its line.
    ("law", 2, 78),
    // Its file; its line in the list, its `mod` and its row.
    ("command", 2, 15),
];

fn run(command: &mut Command) {
    let ended = command.status();
    let ended = ended.unwrap_or_else(|error| panic!("{command:?} cannot be run: {error}"));
    assert!(ended.success(), "{command:?}");
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        match entry.file_type().unwrap().is_dir() {
            true => copy(&entry.path(), &target),
            false => drop(fs::copy(entry.path(), target).unwrap()),
        }
    }
}

/// Benches and tests that the manifest names, empty.
fn named_by_the_manifest(folder: &Path) {
    for (place, names) in [
        (
            "benches",
            &[
                "critical",
                "critical_options",
                "general",
                "margins",
                "motion",
                "roots",
                "throughput",
            ][..],
        ),
        ("tests", &["readers"]),
    ] {
        fs::create_dir(folder.join(place)).unwrap();
        for name in names {
            fs::write(folder.join(place).join(format!("{name}.rs")), "").unwrap();
        }
    }
}

/// A copy of what a build takes, patched.
fn grown(folder: &Path) {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::copy(own.join("build.rs"), folder.join("build.rs")).unwrap();
    // Another version, so that nothing of it is taken for the crate's own.
    let package = format!(
        "name = \"slipmap\"\nversion = \"{}\"",
        env!("CARGO_PKG_VERSION")
    );
    for file in ["Cargo.toml", "Cargo.lock"] {
        let text = fs::read_to_string(own.join(file)).unwrap();
        assert!(text.contains(&package), "{file}");
        let grown = "name = \"slipmap\"\nversion = \"0.0.0-grown\"";
        // The Python package is no part of the copy.
        let alone = text.replace("members = [\"python\"]", "members = []");
        fs::write(folder.join(file), alone.replace(&package, grown)).unwrap();
    }
    // The letter's sweeps are part of the program.
    for place in ["src", "sweeps"] {
        copy(&own.join(place), &folder.join(place));
    }
    named_by_the_manifest(folder);
    fs::create_dir(folder.join("examples")).unwrap();
    fs::copy(
        own.join("tests/growth/grown.rs"),
        folder.join("examples/grown.rs"),
    )
    .unwrap();
    for (name, files, lines) in PATCHES {
        let path = own.join(format!("tests/growth/{name}.patch"));
        let patch = fs::read_to_string(&path).unwrap();
        let added = patch.lines().filter(|l| l.starts_with('+') && l.len() > 1);
        let added = added.filter(|l| !l.starts_with("+++"));
        let touched = patch.lines().filter(|l| l.starts_with("+++"));
        assert_eq!((touched.count(), added.count()), (files, lines), "{name}");
        // Inside a repository git would pass over what is not in it.
        let mut apply = Command::new("git");
        apply.env("GIT_CEILING_DIRECTORIES", folder);
        let first = patch
            .lines()
            .filter_map(|l| l.strip_prefix("+++ b/"))
            .find(|file| folder.join(file).exists())
            .unwrap();
        let before = fs::read_to_string(folder.join(first)).unwrap();
        run(apply.arg("apply").arg("-C1").arg(path).current_dir(folder));
        assert_ne!(
            fs::read_to_string(folder.join(first)).unwrap(),
            before,
            "{name}"
        );
    }
}

/// A block that sticks and slips without control under Coulomb friction: a slip from a = μ_S lasts
/// 2(π − arctan(A/v0)), and the stick after it 2A/v0, with A = μ_S − μ0.
fn period(v0: f64) -> f64 {
    let amplitude = 0.5;
    2.0 * (std::f64::consts::PI - (amplitude / v0).atan()) + 2.0 * amplitude / v0
}

#[test]
fn a_field_a_parameter_a_law_and_a_command_are_a_few_lines_each() {
    let folder = tempfile::tempdir().unwrap();
    grown(folder.path());
    let map = folder.path().join("map.h5");
    // Beside the tested program, whose dependencies are built already.
    let program = Path::new(env!("CARGO_BIN_EXE_slipmap"));
    let profile = program.parent().unwrap();
    let mut build = Command::new(env!("CARGO"));
    build.args(["run", "--quiet", "--offline", "--example", "grown"]);
    // The copy is built once and runs for a moment.
    build.args(["--config", "profile.release.package.slipmap.opt-level=0"]);
    if profile.ends_with("release") {
        build.arg("--release");
    }
    if cfg!(feature = "static-hdf5") {
        build.args(["--features", "static-hdf5"]);
    }
    let target = profile.parent().unwrap();
    build.arg("--target-dir").arg(target).arg("--").arg(&map);
    run(build.current_dir(folder.path()));

    // The example is the command line too.
    let grown = profile.join("examples/grown");
    let laws = Command::new(grown).arg("laws").output().unwrap();
    let laws = String::from_utf8(laws.stdout).unwrap();
    assert!(laws.contains("viscous: μ_K = μ0 + c v\n"), "{laws}");

    let file = hdf5::File::open(&map).unwrap();
    let read = |name: &str| file.dataset(name).unwrap().read_raw::<f64>().unwrap();
    let viscosity = file.dataset("viscosity").unwrap();
    assert_eq!(read("viscosity"), [0.0, 0.3]);
    let meaning = viscosity.attr("long_name").unwrap();
    let meaning = meaning
        .read_scalar::<hdf5::types::FixedUnicode<64>>()
        .unwrap();
    assert_eq!(meaning.as_str(), "viscous part of the friction law");
    // λ² + cλ + 1 = 0.
    for (abscissa, c) in read("abscissa").iter().zip([0.0, 0.3]) {
        assert!((abscissa + 0.5 * c).abs() < 1e-12, "{abscissa}");
    }
    let [without, with] = read("period")[..] else {
        panic!("two cells")
    };
    assert!((without / period(0.2) - 1.0).abs() < 1e-9, "{without}");
    // What is viscous takes from the slip, so that less is to be made up for by the next stick.
    assert!(with < without - 0.1, "{with}");
}
