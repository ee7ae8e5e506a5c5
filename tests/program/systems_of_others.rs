//! Examples that ship with other programs, as files of systems: `tests/systems_of_others`, against
//! what those programs print, closed forms, and roots that a program of its own computed
//! (`tests/reference/published.csv`).

use crate::general_rows::{Row, rows};
use crate::program::{self, Folder, err};
use serde_json::Value;
use std::collections::BTreeSet;
use std::f64::consts::PI;

fn answer(folder: &Folder, row: &Row) -> Value {
    let file = format!("{}.toml", row.text("file"));
    let mut args = vec!["point", "--json", "--system", &file, "--roots", "12"];
    args.extend(["--tau", row.text("tau")]);
    for set in row.text("set").split_whitespace() {
        args.extend(["--set", set]);
    }
    let output = folder.run(&args);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}: {}",
        row.place,
        err(&output)
    );
    program::json(&output)
}

/// Pairs of numbers: roots as real and imaginary parts.
fn pairs(found: &Value) -> Vec<[f64; 2]> {
    let number = |of: &Value| of.as_f64().unwrap();
    let roots = found.as_array().unwrap();
    roots
        .iter()
        .map(|r| [number(&r[0]), number(&r[1])])
        .collect()
}

/// How many pairs of roots cross within `within` of the delay, at the told frequency, if any.
fn hopf_points(found: &Value, row: &Row, within: f64) -> usize {
    let delay = row.number("second").unwrap();
    let crossings = found["crossings"].as_array().unwrap();
    let hits = crossings.iter().filter(|crossing| {
        let omega = crossing["omega"].as_f64().unwrap();
        let first = crossing["first_delay"].as_f64().unwrap();
        let apart = (delay - first) * omega / (2.0 * PI);
        let near = (apart - apart.round()).abs() * 2.0 * PI / omega <= within;
        near && row
            .number("first")
            .is_none_or(|told| (omega - told).abs() <= within)
    });
    hits.count()
}

fn check(folder: &Folder, row: &Row) {
    let found = answer(folder, row);
    let within = row.number("within").unwrap();
    let near = |found: f64, told: f64| (found - told).abs() <= within;
    let place = format!("{}: {found}", row.place);
    match row.text("what") {
        "root" => {
            let told = ["first", "second"].map(|column| row.number(column).unwrap());
            let roots = pairs(&found["roots"]);
            let seen = |r: &[f64; 2]| near(r[0], told[0]) && near(r[1], told[1]);
            assert!(roots.iter().any(seen), "{place}");
        }
        "hopf" => assert_eq!(hopf_points(&found, row, within), 1, "{place}"),
        "double_hopf" => assert_eq!(hopf_points(&found, row, within), 2, "{place}"),
        "unstable" => assert_eq!(found["n_unstable"].as_f64(), row.number("first"), "{place}"),
        "essential" => {
            let told = row.number("first").unwrap();
            let line = found["essential_abscissa"].as_f64().unwrap();
            assert!(near(line, told), "{place}");
        }
        other => panic!("{other}: {place}"),
    }
}

#[test]
fn examples_of_other_programs_have_their_numbers() {
    let mut files = BTreeSet::new();
    let folder = Folder::new();
    for file in std::fs::read_dir("tests/systems_of_others").unwrap() {
        let path = file.unwrap().path();
        let name = path.file_name().unwrap();
        std::fs::copy(&path, folder.path().join(name)).unwrap();
        files.insert(path.file_stem().unwrap().to_str().unwrap().to_owned());
    }
    let table = include_str!("../reference/published.csv");
    for row in rows("published", table) {
        check(&folder, &row);
        assert!(!row.text("source").is_empty(), "{}", row.place);
        files.remove(row.text("file"));
    }
    assert!(files.is_empty(), "no row of {files:?}");
}
