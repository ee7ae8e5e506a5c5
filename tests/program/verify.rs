//! `slipmap verify`: sound maps pass, and whatever is changed in one is found.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]

use std::path::Path;
use std::str::FromStr;

use crate::map::{self, edit};
use crate::program::{self, Folder, expect, out};
use slipmap::linear::status::{DISAGREE, MARGINAL, NOT_CONVERGED};
use slipmap::maps::check::{Effort, Program, check};
use slipmap::setting::Field;
use slipmap::store::MapFile;
use slipmap::sweep::Plan;
use slipmap::sweep::cells::second_look::{Answer, Question, Stored, second_look};

const DECAY: &str = "fields = [\"n_unstable\", \"abscissa\", \"frequency\"]\n[axes]\nmu_prime = [-0.3, -0.1]\n\
                     alpha_n = { from = -3, to = 1, points = 23 }\ntau = { from = 0, to = 9, points = 31 }\n\
                     [fixed]\nmass = 2.5\n";
const VC: &str = "fields = [\"n_unstable\", \"vc\", \"outcome\", \"v_liftoff\"]\n[axes]\ntau = [0.5, 2]\nalpha_n = [-10, -1]\n\
                  [fixed]\nv0 = 0.2\nnormal_load = 2\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
const OUTCOME: &str = "fields = [\"outcome\"]\n[axes]\ntau = [0.5, 1.5, 2.5]\n[fixed]\nv0 = 0.2\nalpha_n = -2\nx_dot0 = 0\n\
                       [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
const SWITCH_ON: &str = "protocol = \"switch-on\"\nfields = [\"vc\", \"outcome\"]\n[axes]\ntau = [0.4, 0.5]\nalpha_n = [-10]\n\
                         [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
const STRONG_LOAD: &str = "fields = [\"vc\", \"outcome\", \"v_liftoff\"]\n[axes]\nalpha_n = [-89.27022408427234]\n\
                           tau = [0.3169786384922227]\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n";
const LIMIT: &str = "protocol = \"limit\"\nfields = [\"vc_over_vtilde\"]\n[axes]\ngamma = { from = 0.1, to = 0.9, points = 10 }\n\
                     [fixed]\nmu_ratio = 0.5\n";

#[test]
fn sound_maps_pass() {
    for (text, questions) in [
        (DECAY, &["abscissa, by", "n_unstable, by"][..]),
        (
            VC,
            &[
                "vc, by simulation with collocation 4 agree, 0 differ",
                "n_unstable, by",
            ],
        ),
        (OUTCOME, &["outcome, by collocation 3 agree, 0 differ"]),
        (
            SWITCH_ON,
            &["vc of switch-on, by collocation below and above it 2 agree, 0 differ"],
        ),
        (LIMIT, &[]),
    ] {
        let folder = Folder::with(&[("map.toml", text)]);
        expect(&folder.run(&["run", "map.toml"]), 0, "map.h5: ");
        let verified = folder.run(&["verify", "map.h5"]);
        expect(&verified, 0, "computed again are the same, bit by bit");
        for question in questions {
            expect(&verified, 0, question);
        }
        let json = folder.run(&["verify", "map.h5", "--json"]);
        let json = program::json(&json);
        assert_eq!(json["sound"], true, "{json}");
        assert_eq!(json["faults"], serde_json::json!([]));
    }
}

/// Every byte of every chunk is under a checksum, and a changed attribute or axis is noticed too.
#[test]
fn changed_maps_do_not() {
    let folder = Folder::with(&[("map.toml", DECAY)]);
    expect(&folder.run(&["run", "map.toml"]), 0, "map.h5: ");
    let original = std::fs::read(folder.path().join("map.h5")).unwrap();
    let changed = |change: &dyn Fn(&Path)| {
        let path = folder.path().join("changed.h5");
        std::fs::write(&path, &original).unwrap();
        change(&path);
        folder.run(&["verify", "changed.h5"])
    };
    for field in ["n_unstable", "abscissa", "status"] {
        let flipped = changed(&|path| {
            let place = hdf5::File::open(path).unwrap().dataset(field).unwrap();
            let chunk = place.chunk_info(0).unwrap();
            drop(place);
            let mut bytes = std::fs::read(path).unwrap();
            bytes[(chunk.addr + chunk.size / 2) as usize] ^= 8;
            std::fs::write(path, bytes).unwrap();
        });
        expect(&flipped, 1, &format!("{field}: its checksum does not fit"));
    }
    let edited = |change: &dyn Fn(&hdf5::File)| changed(&|path| edit(path, change));
    let written = edited(&|file| {
        file.dataset("abscissa")
            .unwrap()
            .write_slice(
                &[0.5],
                hdf5::Hyperslab::from(vec![
                    hdf5::SliceOrIndex::Index(0),
                    hdf5::SliceOrIndex::Index(3),
                    hdf5::SliceOrIndex::SliceCount {
                        start: 4,
                        step: 1,
                        count: 1,
                        block: 1,
                    },
                ]),
            )
            .unwrap();
    });
    expect(&written, 1, "abscissa: its checksum does not fit");
    let axis = edited(&|file| {
        file.dataset("mu_prime")
            .unwrap()
            .write_raw(&[-0.3, -0.2])
            .unwrap();
    });
    expect(&axis, 1, "the axis mu_prime is not that of the sweep");
    let scalar = edited(&|file| {
        file.dataset("mass").unwrap().write_scalar(&2.0).unwrap();
    });
    expect(&scalar, 1, "mass is not that of the sweep");
    let gone = edited(&|file| {
        file.unlink("frequency").unwrap();
    });
    expect(&gone, 1, "the field frequency is missing");
    let described = edited(&|file| {
        let units = file.dataset("abscissa").unwrap();
        units.delete_attr("units").unwrap();
        let furlong = hdf5::types::FixedUnicode::<8>::from_str("furlong").unwrap();
        units
            .new_attr::<hdf5::types::FixedUnicode<8>>()
            .create("units")
            .unwrap()
            .write_scalar(&furlong)
            .unwrap();
    });
    expect(&described, 1, "a description has changed");
    let curve = edited(&|file| {
        let delays = file.dataset("boundaries/tau").unwrap();
        let longer: Vec<f64> = delays
            .read_raw::<f64>()
            .unwrap()
            .iter()
            .map(|tau| tau * 1.5)
            .collect();
        delays.write_raw(&longer).unwrap();
    });
    expect(&curve, 1, "a curve");
    let unlinked = edited(&|file| {
        let abscissa = file.dataset("abscissa").unwrap();
        abscissa.delete_attr("DIMENSION_LIST").unwrap();
    });
    expect(&unlinked, 1, "abscissa has lost its dimensions");
    for (name, says) in [
        ("/", "the checksum of what is no cell is missing"),
        ("status", "1 datasets have no checksum"),
    ] {
        let bare = edited(&|file| match name {
            "/" => file.delete_attr("contents_sha256").unwrap(),
            _ => file
                .dataset(name)
                .unwrap()
                .delete_attr("chunks_sha256")
                .unwrap(),
        });
        expect(&bare, 1, says);
    }
    // Bytes that readers are told not to inflate.
    let filters = edited(&|file| {
        let dataset = file.dataset("abscissa").unwrap();
        let chunk = dataset.chunk_info(0).unwrap();
        let stored = &original[chunk.addr as usize..(chunk.addr + chunk.size) as usize];
        // The library looks at the mask of a chunk of another length only.
        let bytes = [stored, &[0]].concat();
        let written = hdf5::sync::sync(|| {
            // SAFETY: the dataset is open, the offset has an entry for each of its dimensions, and
            // the slice lives.
            unsafe {
                hdf5_sys::h5d::H5Dwrite_chunk(
                    dataset.id(),
                    hdf5_sys::h5p::H5P_DEFAULT,
                    1,
                    chunk.offset.as_ptr(),
                    bytes.len(),
                    bytes.as_ptr().cast(),
                )
            }
        });
        assert!(written >= 0);
    });
    expect(
        &filters,
        1,
        "abscissa: chunks cannot be read: filters of a chunk are to be skipped",
    );
    // Whoever reads the report may be gone: what was found stays found.
    let mut started = folder.start(&["verify", "changed.h5"]);
    drop(started.child().stdout.take());
    expect(&started.ended(), 1, "changed.h5: 2 faults");
    for (bad, code) in [("map.toml", 2), ("none.h5", 2)] {
        expect(&folder.run(&["verify", bad]), code, bad);
    }
}

fn plan(text: &str) -> Plan {
    Plan::new(text.parse().unwrap()).unwrap()
}

/// What a second look says where `field` of a sound cell is `value` instead.
fn looked(
    plan: &Plan,
    path: &Path,
    change: (Field, f64),
    status: u8,
    question: Question,
) -> Answer {
    let map = MapFile::open(path).unwrap();
    let last = plan.shape().len() - 1;
    let index = vec![0; plan.shape().len()];
    let value = |field: Field| match field {
        field if field == change.0 => change.1,
        _ if !map.fields().contains(&field) => f64::NAN,
        _ => {
            map.plane(field, &index, (last, last), usize::MAX)
                .unwrap()
                .cells[0]
        }
    };
    let stored = Stored {
        status,
        value: &value,
    };
    let answers = second_look(plan, &index, &stored).unwrap();
    answers.iter().find(|(q, _)| *q == question).unwrap().1
}

/// Second methods see wrong values, and keep quiet where the cell itself says that it is in doubt.
#[test]
fn wrong_values_are_seen_by_second_methods() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    for (text, field, wrong, question, doubt) in [
        (DECAY, Field::NUnstable, 4.0, Question::Count, MARGINAL),
        (
            DECAY,
            Field::Abscissa,
            0.19,
            Question::Abscissa,
            NOT_CONVERGED,
        ),
        (
            VC,
            Field::Vc,
            0.0431,
            Question::CriticalVelocity,
            NOT_CONVERGED,
        ),
        (
            VC,
            Field::Outcome,
            0.0,
            Question::CriticalVelocity,
            NOT_CONVERGED,
        ),
        (SWITCH_ON, Field::Vc, 0.02, Question::SwitchOn, DISAGREE),
        (
            OUTCOME,
            Field::Outcome,
            2.0,
            Question::Outcome,
            NOT_CONVERGED,
        ),
    ] {
        let plan = plan(text);
        map::write(&plan, 2, &path);
        // A field that no map of these has: nothing is changed.
        let untouched = (Field::DelayMargin, 0.0);
        assert_eq!(
            looked(&plan, &path, untouched, 0, question),
            Answer::Agrees,
            "{field:?}"
        );
        assert_eq!(
            looked(&plan, &path, (field, wrong), 0, question),
            Answer::Differs,
            "{field:?}"
        );
        assert_eq!(
            looked(&plan, &path, (field, wrong), doubt, question),
            Answer::Open,
            "{field:?}"
        );
    }
}

/// Cells of a system that is no equation, which hold no count, contradict nothing; a count that is
/// missing without a word does.
#[test]
fn refused_cells_are_not_asked_for_their_count() {
    let text = "fields = [\"n_unstable\"]\n[system]\nP = \"b*(s^2 + 1)\"\nQ = \"b\"\n\
                [system.parameters]\nb = 1\n[axes]\nb = [0, 0.5, 2]\n\
                tau = { from = 0.5, to = 9.5, points = 19 }\n";
    let folder = Folder::with(&[("map.toml", text)]);
    expect(&folder.run(&["run", "map.toml", "-q"]), 0, "map.h5");
    let verified = folder.run(&["verify", "map.h5", "--cells", "57"]);
    expect(&verified, 0, "0 differ");
    let json = folder.run(&["export", "map.h5"]);
    let empty = out(&json)
        .lines()
        .filter(|line| line.contains("refused"))
        .count();
    assert_eq!(empty, 19, "{}", out(&json));
    let answer = |status| {
        let value = |_| f64::NAN;
        let stored = Stored {
            status,
            value: &value,
        };
        second_look(&plan(text), &[0, 3], &stored).unwrap()[0].1
    };
    assert_eq!(answer(NOT_CONVERGED), Answer::Open);
    assert_eq!(answer(0), Answer::Differs);
}

/// Where large steps of v0 throw stick-slip to a kind that ends earlier, nothing is contradicted,
/// whether smaller ones come to the right end within their budget or not. v_c by the program of
/// `tests/referee` in four kinds of steps: 0.0288921.
#[test]
fn a_search_that_large_steps_have_thrown_contradicts_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    let plan = plan(STRONG_LOAD);
    map::write(&plan, 2, &path);
    let vc = MapFile::open(&path)
        .unwrap()
        .plane(Field::Vc, &[0, 0], (1, 1), usize::MAX);
    let vc = vc.unwrap().cells[0];
    assert!((vc / 0.0288921 - 1.0).abs() < 1e-4, "{vc}");
    let untouched = (Field::DelayMargin, 0.0);
    let answer = looked(&plan, &path, untouched, 0, Question::CriticalVelocity);
    assert_ne!(answer, Answer::Differs);
}

#[test]
fn a_map_of_another_revision_is_not_compared_bit_by_bit() {
    let program = |version, revision| Program { version, revision };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    map::write(&plan(DECAY), 2, &path);
    let effort = Effort {
        cells: 50,
        tiles: 1,
    };
    let report = check(
        &MapFile::open(&path).unwrap(),
        program("0.0.1", "abc"),
        effort,
    )
    .unwrap();
    assert!(report.faults.is_empty(), "{report:?}");
    assert_eq!((report.tiles, report.cells), (0, 50));
    assert!(report.remarks[0].contains("another revision"));
    let report = check(&MapFile::open(&path).unwrap(), program("", ""), effort).unwrap();
    assert_eq!(report.tiles_equal, 1, "{report:?}");
}

/// Tiles that are not in a map are not computed again, and are not counted as unequal.
#[test]
fn missing_tiles_are_said_to_be_missing() {
    let many = DECAY
        .replace("points = 23", "points = 300")
        .replace("points = 31", "points = 200");
    let folder = Folder::with(&[("many.toml", &many)]);
    let shard = ["run", "many.toml", "--shard", "1/2"];
    expect(&folder.run(&shard), 0, "shard 1 of 2 is complete");
    let merge = ["merge", "many.h5", "--partial", "-o", "part.h5"];
    expect(&folder.run(&merge), 0, "of them missing");
    let verified = folder.run(&["verify", "part.h5", "--tiles", "6", "--json"]);
    expect(&verified, 0, "tiles_absent");
    let told = program::json(&verified);
    let number = |key: &str| told[key].as_u64().unwrap();
    assert_eq!(number("tiles"), number("tiles_equal"), "{told}");
    assert!(number("tiles") > 0 && number("tiles_absent") > 0, "{told}");
    assert_eq!(number("tiles") + number("tiles_absent"), 6, "{told}");
    let shown = folder.run(&["verify", "part.h5", "--tiles", "6"]);
    expect(&shown, 0, "more are not in the map");
}
