//! Replays everything that fuzzing has kept: the smallest set of inputs that reaches all code it
//! ever reached, and every input that once was answered wrongly. `scripts/fuzz.sh` looks for more.

#[path = "fuzz/src/memory.rs"]
mod memory;
#[path = "fuzz/src/targets.rs"]
mod targets;

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use slipmap::setting::{Field, Parameter, SweepSpec};
use slipmap::sweep::Plan;

#[global_allocator]
static ALLOCATOR: memory::Capped = memory::Capped;

/// Choices that make up a sound map; more make no difference.
const CHOICES: usize = 128;
/// Of all odd choices one in so many is tried.
const ONE_IN: usize = 5;

/// The files of a folder that may not be there.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = paths.filter(|path| path.is_file()).collect();
    files.sort();
    files
}

/// The inputs that are kept for a target, by name.
fn kept(name: &str) -> Vec<(String, Vec<u8>)> {
    let archive = fs::File::open(format!("tests/fuzz/corpus/{name}.tar")).unwrap();
    let mut archive = tar::Archive::new(archive);
    let read = |entry: std::io::Result<tar::Entry<fs::File>>| {
        let mut entry = entry.unwrap();
        let file = entry.path().unwrap().display().to_string();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).unwrap();
        (file, bytes)
    };
    archive.entries().unwrap().map(read).collect()
}

fn replay(name: &str) {
    let (_, target) = targets::ALL.into_iter().find(|(n, _)| *n == name).unwrap();
    let kept = kept(name);
    assert!(kept.len() > 60, "{name}: {}", kept.len());
    for (file, bytes) in kept {
        println!("{name}: {file}");
        target(&bytes);
    }
    let wrong = files(Path::new("tests/fuzz/regressions"));
    let wrong = wrong.into_iter().filter(|path| {
        let file = path.file_name().unwrap().to_str().unwrap();
        file.split('-').next() == Some(name)
    });
    for path in wrong {
        println!("{}", path.display());
        target(&fs::read(path).unwrap());
    }
}

#[test]
fn kept_sweeps() {
    replay("sweep");
    for path in files(Path::new("sweeps")) {
        targets::ALL[0].1(&fs::read(path).unwrap());
    }
    // Systems are tables of sweeps.
    for path in files(Path::new("sweeps/systems")) {
        let system = fs::read_to_string(path)
            .unwrap()
            .replace("[param", "[system.param");
        let sweep = format!("axes.tau = [0, 1]\n[system]\n{system}");
        let read: SweepSpec = sweep.parse().unwrap();
        assert!(read.fixed.system().is_some());
        targets::ALL[0].1(sweep.as_bytes());
    }
    for polynomials in [
        "P = [1, 0.04, 1.2], Q = [-0.2]",
        "B = [1, \"2*z\", \"1 + z\"], A = [0, \"-z\"]",
        "P = [\"(z\", \"z)\"], Q = [[], nan, {}]",
    ] {
        let system = format!("{{ {polynomials}, parameters.z = 1 }}");
        targets::ALL[0].1(format!("axes.tau = [0, 1]\nsystem = {system}\n").as_bytes());
    }
}

#[test]
fn kept_cases() {
    replay("case");
}

#[test]
fn kept_manifests() {
    replay("manifest");
}

#[test]
fn kept_tiles() {
    replay("tiles");
}

#[test]
fn kept_rows() {
    replay("rows");
}

#[test]
fn kept_maps() {
    replay("map");
}

/// What can be odd in a map, one thing at a time: fuzzing would take long to find each.
#[test]
fn maps_odd_in_one_place() {
    let (_, target) = targets::ALL.into_iter().find(|(n, _)| *n == "map").unwrap();
    let odd = (0..CHOICES).flat_map(|place| (1..=17_u8).map(move |choice| (place, choice)));
    for (place, choice) in odd.step_by(ONE_IN) {
        let mut choices = vec![0; place];
        choices.push(choice);
        target(&choices);
    }
}

/// Fuzzing passes over long axes. The longest that are taken stay within the allocator's cap, and
/// more of them are refused.
#[test]
fn the_longest_axes_stay_within_the_cap() {
    let axis = |name: &str, points: u64| {
        format!("{name} = {{ from = 1.0, to = 2.0, points = {points} }}\n")
    };
    let fixed = "[fixed]\nmu_prime = -0.1\nalpha_n = 0.0\n";
    let plan = |axes: &[String]| {
        let text = format!("[axes]\n{}{fixed}", axes.concat());
        text.parse::<SweepSpec>().and_then(Plan::new)
    };
    let longest = plan(&[axis("alpha_v", 40_000), axis("tau", 10_000_000)]).unwrap();
    assert_eq!(longest.cells(), 400_000_000_000);
    assert_eq!(longest.hash().len(), 64);
    let names = ["tau", "mass", "stiffness", "normal_load", "alpha_v"];
    let error = plan(&names.map(|name| axis(name, 10_000_000))).unwrap_err();
    assert!(error.message.contains("together"), "{error}");
    let error = plan(&[axis("alpha_v", 1_000_000), axis("tau", 10_000_000)]).unwrap_err();
    assert!(error.message.contains("tiles"), "{error}");
}

#[test]
fn the_dictionary_has_every_name() {
    let words = fs::read_to_string("tests/fuzz/words.dict").unwrap();
    let parameters = Parameter::ALL.map(Parameter::name).into_iter();
    for name in parameters.chain(Field::ALL.into_iter().map(Field::name)) {
        let numbered = name
            .rsplit_once('_')
            .is_some_and(|(_, n)| n.parse::<u8>().is_ok());
        assert!(
            numbered || words.contains(&format!("\"{name}\"")),
            "tests/fuzz/words.dict lacks {name}"
        );
    }
}
