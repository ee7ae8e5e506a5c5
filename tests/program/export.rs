//! `slipmap export` and other text for other programs: every number against the HDF5 file, to the
//! last bit, and nothing half-written.

use std::collections::BTreeMap;
use std::io::Read;
use std::sync::Mutex;

use crate::program::{Folder, err, expect, out, pixels};
use hdf5::File;

/// The delay first, so that rows of the table go across the chunks; an infinite delay margin.
const SWEEP: &str = "title = \"Some #1 map\"\nunits = \"SI\"\n\
    fields = [\"n_unstable\", \"delay_margin\", \"abscissa\"]\n[axes]\n\
    tau = { from = 0, to = 9, points = 7 }\nalpha_v = [-1, -0.5, 0]\nmu_prime = [-0.3, 0.1]\n";
const OUTCOMES: &str = "fields = [\"outcome\", \"settle_time\"]\n[axes]\ntau = [0.5, 1.5, 2.5]\n\
    [fixed]\nv0 = 0.2\nalpha_n = -2\nx_dot0 = 0\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\n\
    v_s = 0.5\n";
const CASE: &str = "title = \"Some motion\"\nhorizon = 40.0\n[friction]\nlaw = \"weakening\"\n\
    mu0 = 0.5\nv_s = 0.5\n[fixed]\nv0 = 0.35\nalpha_v = -0.33\ntau = 4.15\n[start]\nx_dot0 = 0\n";

/// A table with its names.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn of(text: &[u8]) -> Self {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .from_reader(text);
        let names = reader
            .headers()
            .unwrap()
            .iter()
            .map(str::to_owned)
            .collect();
        let row = |row: csv::StringRecord| row.iter().map(str::to_owned).collect();
        let rows = reader.records().map(|found| row(found.unwrap())).collect();
        Self { names, rows }
    }

    fn column(&self, name: &str) -> Vec<&str> {
        let place = self.names.iter().position(|n| n == name).expect(name);
        self.rows.iter().map(|row| row[place].as_str()).collect()
    }

    /// The bits of a column's numbers; those of one NaN where a row has none.
    fn bits(&self, name: &str) -> Vec<u64> {
        let number = |text: &str| match text {
            "" => f64::NAN,
            text => text.parse().unwrap(),
        };
        self.column(name)
            .into_iter()
            .map(|text| bits(number(text)))
            .collect()
    }
}

fn bits(value: f64) -> u64 {
    if value.is_nan() {
        f64::NAN.to_bits()
    } else {
        value.to_bits()
    }
}

#[track_caller]
fn exported(folder: &Folder, args: &[&str]) -> Table {
    let output = folder.run(&[&["export"], args].concat());
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert_eq!(err(&output), "");
    Table::of(&output.stdout)
}

fn numbers(file: &File, name: &str) -> Vec<u64> {
    let values = file.dataset(name).unwrap().read_raw::<f64>().unwrap();
    values.into_iter().map(bits).collect()
}

/// The map of a sweep as `map.h5` in a folder of its own; each sweep is run once.
fn with_map_of(sweep: &str) -> Folder {
    static MADE: Mutex<BTreeMap<String, Vec<u8>>> = Mutex::new(BTreeMap::new());
    let folder = Folder::with(&[("map.toml", sweep)]);
    let map = folder.path().join("map.h5");
    let mut made = MADE.lock().unwrap();
    if let Some(bytes) = made.get(sweep) {
        std::fs::write(map, bytes).unwrap();
        return folder;
    }
    expect(&folder.run(&["run", "map.toml", "-q"]), 0, "map.h5: ");
    made.insert(sweep.to_owned(), std::fs::read(map).unwrap());
    folder
}

fn with_map() -> Folder {
    with_map_of(SWEEP)
}

#[test]
fn cells_are_those_of_the_map() {
    let folder = with_map();
    let table = exported(&folder, &["map.h5"]);
    let axes = ["tau", "alpha_v", "mu_prime"];
    let fields = [
        "n_unstable",
        "delay_margin",
        "abscissa",
        "certificate_margin",
        "status",
    ];
    assert_eq!(table.names, [&axes[..], &fields[..]].concat());
    let file = File::open(folder.path().join("map.h5")).unwrap();
    for name in ["delay_margin", "abscissa", "certificate_margin"] {
        assert_eq!(table.bits(name), numbers(&file, name), "{name}");
    }
    assert!(table.column("delay_margin").contains(&"inf"));
    let counts = file
        .dataset("n_unstable")
        .unwrap()
        .read_raw::<u16>()
        .unwrap();
    let status = file.dataset("status").unwrap().read_raw::<u8>().unwrap();
    let texts = |numbers: Vec<u16>| numbers.iter().map(u16::to_string).collect::<Vec<_>>();
    assert_eq!(table.column("n_unstable"), texts(counts));
    assert_eq!(
        table.column("status"),
        texts(status.into_iter().map(u16::from).collect())
    );
    // The last axis is the fastest one.
    let [tau, alpha_v, mu_prime] = axes.map(|name| numbers(&file, name));
    for (row, place) in (0..42).map(|cell| (cell, [cell / 6, cell / 2 % 3, cell % 2])) {
        assert_eq!(table.bits("tau")[row], tau[place[0]]);
        assert_eq!(table.bits("alpha_v")[row], alpha_v[place[1]]);
        assert_eq!(table.bits("mu_prime")[row], mu_prime[place[2]]);
    }
}

#[test]
fn a_slice_has_the_fields_and_places_asked_for() {
    let folder = with_map();
    let all = exported(&folder, &["map.h5"]);
    let args = [
        "--field",
        "abscissa",
        "--at",
        "alpha_v=-0.6",
        "--at",
        "tau=8.9",
    ];
    let slice = exported(&folder, &[&["map.h5"], &args[..]].concat());
    assert_eq!(
        slice.names,
        ["tau", "alpha_v", "mu_prime", "abscissa", "status"]
    );
    let expected: Vec<Vec<String>> = (0..42)
        .filter(|&cell| all.column("tau")[cell] == "9" && all.column("alpha_v")[cell] == "-0.5")
        .map(|cell| {
            slice
                .names
                .iter()
                .map(|name| all.column(name)[cell].to_owned())
                .collect()
        })
        .collect();
    assert_eq!(expected.len(), 2);
    assert_eq!(slice.rows, expected);
    for (args, says) in [
        (["--at", "mass=1"], "mass is no axis of this map"),
        (["--at", "tau=10"], "--at tau=10 is outside the axis"),
        (["--field", "abscisa"], "did you mean `abscissa`?"),
        (["--field", "vc"], "the map does not hold vc"),
        (["--table", "events"], "its tables: cells, boundaries"),
        (["-o", "map.xlsx"], "a table is written as CSV"),
        (["-o", "map.h5"], "a table is written as CSV"),
    ] {
        expect(
            &folder.run(&[&["export", "map.h5"], &args[..]].concat()),
            2,
            says,
        );
    }
    let twice = ["export", "map.h5", "--at", "tau=1", "--at", "tau=2"];
    expect(&folder.run(&twice), 2, "--at tau is given twice");
    let twice = [
        "export", "map.h5", "--field", "abscissa", "--field", "abscissa",
    ];
    expect(&folder.run(&twice), 2, "--field abscissa is given twice");
}

#[test]
fn kinds_are_words_and_what_there_is_not_is_empty() {
    let folder = Folder::with(&[("map.toml", OUTCOMES)]);
    expect(
        &folder.run(&["run", "map.toml", "-q"]),
        0,
        "map.h5: 3 cells",
    );
    let table = exported(&folder, &["map.h5"]);
    let file = File::open(folder.path().join("map.h5")).unwrap();
    let kinds = file.dataset("outcome").unwrap().read_raw::<u8>().unwrap();
    let names = slipmap::setting::Field::Outcome.kinds().unwrap();
    let expected: Vec<&str> = kinds.iter().map(|&kind| names[usize::from(kind)]).collect();
    assert_eq!(table.column("outcome"), expected);
    assert_eq!(table.bits("settle_time"), numbers(&file, "settle_time"));
    let settled = table.column("settle_time");
    for (outcome, time) in expected.iter().zip(settled) {
        assert_eq!(*outcome == "sliding", !time.is_empty());
    }
    // Of two shards one is there: the cells of the other have no value.
    let shard = ["run", "map.toml", "-q", "-o", "half.h5", "--shard", "1/2"];
    expect(&folder.run(&shard), 0, "shard 1 of 2 is complete");
    let half = folder.run(&["export", "half.h5"]);
    expect(&half, 0, "is not complete");
    let half = Table::of(&half.stdout);
    assert_eq!(half.rows.len(), 3);
    for (there, whole) in half.rows.iter().zip(&table.rows) {
        let missing = there[3].is_empty();
        assert!(if missing {
            there[1..] == ["", "", ""]
        } else {
            there == whole
        });
    }
}

fn with_curves() -> Folder {
    let sweep = SWEEP.replace(
        "title",
        "boundaries = true\ndegree_of_stability = [0.1]\ntitle",
    );
    with_map_of(&sweep)
}

#[test]
fn curves_are_those_of_the_map() {
    let folder = with_curves();
    let table = exported(&folder, &["map.h5", "--table", "boundaries"]);
    let file = File::open(folder.path().join("map.h5")).unwrap();
    let group = file.group("boundaries").unwrap();
    let of_vertex = |name: &str| {
        let values = group.dataset(name).unwrap().read_raw::<f64>().unwrap();
        values.into_iter().map(bits).collect::<Vec<_>>()
    };
    let counts = group
        .dataset("vertex_count")
        .unwrap()
        .read_raw::<i32>()
        .unwrap();
    for name in ["tau", "omega"] {
        assert_eq!(table.bits(name), of_vertex(name), "{name}");
    }
    let curves = || counts.iter().enumerate();
    let spread = |values: Vec<u64>| -> Vec<u64> {
        curves()
            .flat_map(|(i, &n)| vec![values[i]; n as usize])
            .collect()
    };
    assert!(counts.len() > 2);
    assert_eq!(
        table.bits("degree_of_stability"),
        spread(of_vertex("degree_of_stability"))
    );
    let number = |name: &str| -> Vec<i8> { group.dataset(name).unwrap().read_raw().unwrap() };
    let sides = ["shorter_delays", "neither", "longer_delays"];
    for (name, first, words) in [
        ("direction", -1, ["to_the_left", "touch", "to_the_right"]),
        ("stable_side", -1, sides),
        ("kind", 0, ["pair", "real_root", "leading_coefficient"]),
    ] {
        let kinds = number(name);
        let word = |i: usize| words[(kinds[i] - first) as usize];
        let expected: Vec<&str> = curves()
            .flat_map(|(i, &n)| vec![word(i); n as usize])
            .collect();
        assert_eq!(table.column(name), expected, "{name}");
    }
    let plane = group.attr("plane").unwrap();
    let plane: hdf5::types::FixedUnicode<64> = plane.read_scalar().unwrap();
    let (across, _) = plane.split_once(' ').unwrap();
    assert_eq!(table.bits(across), of_vertex(across));
    let outer = if across == "alpha_v" {
        "mu_prime"
    } else {
        "alpha_v"
    };
    assert_eq!(table.bits(outer), spread(of_vertex(outer)));
}

#[test]
fn curves_of_a_held_axis_are_some_of_them() {
    let folder = with_curves();
    let boundaries = ["map.h5", "--table", "boundaries"];
    let all = exported(&folder, &boundaries);
    // The number of the curve comes first.
    let outer = all.names[1].as_str();
    let value = all.column(outer)[0];
    let held = format!("{outer}={value}");
    let some = exported(&folder, &[&boundaries[..], &["--at", &held]].concat());
    let those = all.column(outer).iter().filter(|v| **v == value).count();
    assert!(some.rows.len() == those && those < all.rows.len());
    assert!(some.column(outer).iter().all(|v| *v == value));
    let along = ["export", "map.h5", "--table", "boundaries", "--at", "tau=1"];
    expect(&folder.run(&along), 2, "the curves go along tau");
    let none = with_large_map().run(&["export", "map.h5", "--table", "boundaries"]);
    expect(&none, 2, "this map holds no crossing curves");
}

#[test]
fn samples_and_events_are_those_of_the_trace() {
    let folder = Folder::with(&[("case.toml", CASE)]);
    expect(&folder.run(&["simulate", "case.toml"]), 0, "case.h5");
    let file = File::open(folder.path().join("case.h5")).unwrap();
    let samples = exported(&folder, &["case.h5"]);
    let real = [
        "t",
        "x",
        "x_dot",
        "a",
        "v",
        "N",
        "pulling_force",
        "friction_force",
    ];
    assert_eq!(samples.names, [&real[..], &["mode"]].concat());
    for name in real {
        assert_eq!(samples.bits(name), numbers(&file, name), "{name}");
    }
    let modes = file.dataset("mode").unwrap().read_raw::<u8>().unwrap();
    let words = ["stick", "forwards", "backwards"];
    let expected: Vec<&str> = modes.iter().map(|&mode| words[usize::from(mode)]).collect();
    assert_eq!(samples.column("mode"), expected);
    let events = exported(&folder, &["case.h5", "--table", "events"]);
    for name in ["t", "a"] {
        assert_eq!(
            events.bits(name),
            numbers(&file, &format!("event/{name}")),
            "{name}"
        );
    }
    assert!(events.column("kind").contains(&"release"));
    let some = exported(&folder, &["case.h5", "--field", "N", "--field", "a"]);
    assert_eq!(some.names, ["t", "N", "a", "mode"]);
    assert_eq!(some.column("a"), samples.column("a"));
    for (args, says) in [
        (["--field", "abscissa"], "a trace has no abscissa"),
        (["--at", "tau=1"], "--at tau=1 has no meaning for a trace"),
        (["--table", "cells"], "its tables: samples, events"),
    ] {
        expect(
            &folder.run(&[&["export", "case.h5"], &args[..]].concat()),
            2,
            says,
        );
    }
}

#[test]
fn comments_say_what_the_columns_are() {
    let folder = with_map();
    let commented = folder.run(&["export", "map.h5", "--comments"]);
    let text = out(&commented);
    let comments: Vec<&str> = text
        .lines()
        .take_while(|line| line.starts_with("# "))
        .collect();
    for says in [
        "# title: Some #1 map",
        "# stiffness = 1 [N m-1]",
        "# tau [s]: delay",
        "# delay_margin [s]: ",
        "# status: status of the cell, the sum of 1 certified, 2 marginal, ",
    ] {
        assert!(
            comments.iter().any(|line| line.starts_with(says)),
            "{says} in\n{text}"
        );
    }
    let plain = out(&folder.run(&["export", "map.h5"]));
    let behind: Vec<&str> = text.lines().skip(comments.len()).collect();
    assert_eq!(behind, plain.lines().collect::<Vec<_>>());
    let told = folder.run(&["export", "map.h5", "-o", "map.csv"]);
    assert_eq!(out(&told), "map.csv: 42 rows\n");
    let written = std::fs::read_to_string(folder.path().join("map.csv")).unwrap();
    assert_eq!(written, plain);
}

#[test]
fn simulate_writes_its_samples_as_text() {
    let folder = Folder::with(&[("case.toml", CASE)]);
    let simulate = |args: &[&str]| folder.run(&[&["simulate", "case.toml"], args].concat());
    expect(&simulate(&[]), 0, "case.h5");
    let exported = folder.run(&["export", "case.h5"]).stdout;
    expect(&simulate(&["-o", "text.csv"]), 0, "text.csv: ");
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("text.csv"), exported);
    assert!(pixels(&read("text.png")) == pixels(&read("case.png")));
    let piped = simulate(&["-o", "-", "--picture", "other.png"]);
    assert_eq!(piped.stdout, exported, "nothing but the samples");
    assert!(pixels(&read("other.png")) == pixels(&read("case.png")));
    expect(
        &simulate(&["-o", "text.csv"]),
        2,
        "text.csv is already there",
    );
    expect(&simulate(&["-o", "text.csv", "--fresh"]), 0, "text.csv: ");
    expect(
        &simulate(&["-o", "-", "--json"]),
        2,
        "both write to standard output",
    );
}

#[test]
fn a_picture_goes_through_a_pipe() {
    let folder = with_map();
    let args = ["plot", "map.h5", "--field", "abscissa", "--size", "500x400"];
    expect(
        &folder.run(&[&args[..], &["-o", "map.a.png"]].concat()),
        0,
        "map.a.png",
    );
    let piped = folder.run(&[&args[..], &["-o", "-"]].concat());
    assert_eq!(err(&piped), "");
    let written = std::fs::read(folder.path().join("map.a.png")).unwrap();
    assert!(piped.stdout == written);
    assert!(!folder.files().contains(&"-.png".to_owned()));
}

/// A map of some megabytes of text.
fn with_large_map() -> Folder {
    with_map_of(
        "boundaries = false\n[axes]\nalpha_v = { from = -1, to = 0, points = 200 }\n\
         tau = { from = 0, to = 9, points = 300 }\n[fixed]\nmu_prime = -0.3\n",
    )
}

#[test]
fn a_reader_that_has_read_enough_is_no_failure() {
    let folder = with_large_map();
    let mut started = folder.start(&["export", "map.h5"]);
    let mut first = [0; 10];
    let mut text = started.child().stdout.take().unwrap();
    text.read_exact(&mut first).unwrap();
    drop(text);
    assert_eq!(&first, b"alpha_v,ta");
    let ended = started.ended();
    assert_eq!((ended.status.code(), err(&ended)), (Some(0), String::new()));
}

/// A signal leaves the file that was there before, and nothing beside it.
#[cfg(unix)]
#[test]
fn a_text_is_written_whole_or_not_at_all() {
    let folder = with_large_map();
    std::fs::write(folder.path().join("map.csv"), "an older one").unwrap();
    let before = folder.files();
    let mut child = folder.start(&["export", "map.h5", "-o", "map.csv", "--fresh"]);
    let part = folder.path().join(".map.csv.slipmap-part");
    while !part.metadata().is_ok_and(|part| part.len() > 0) {
        assert!(child.goes_on());
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.signal("-INT");
    let ended = child.ended();
    assert_eq!(ended.status.code(), Some(130), "{}", err(&ended));
    assert!(err(&ended).contains("interrupted: not everything is exported"));
    let kept = std::fs::read_to_string(folder.path().join("map.csv")).unwrap();
    assert_eq!((folder.files(), kept.as_str()), (before, "an older one"));
    let full = folder.run(&["export", "map.h5", "-o", "no/map.csv"]);
    expect(&full, 1, "cannot write no/map.csv");
}
