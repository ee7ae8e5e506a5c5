//! The real program by its command line: what users type, read and find on disk.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]

use std::process::Command;

use crate::map::{self, edit, settle};
use crate::program::{self, Folder, err, expect, out, output, pixels};

const SMALL: &str = "title = \"small\"\n[axes]\nmu_prime = [-0.1, -0.3]\nalpha_n = { from = -3, to = 1, points = 41 }\ntau = { from = 0, to = 12, points = 61 }\n";
/// Large enough to be interrupted on any machine.
const LARGE: &str = "boundaries = false\n[axes]\nmu_prime = { from = -1, to = 1, points = 5000 }\nalpha_n = { from = -3, to = 1, points = 5000 }\ntau = { from = 0, to = 12, points = 2000 }\n";

#[test]
fn run_makes_a_map_and_a_picture_and_goes_on_from_there() {
    let folder = Folder::with(&[
        ("small.toml", SMALL),
        ("other.toml", &SMALL.replace("41", "42")),
    ]);
    expect(
        &folder.run(&["run", "small.toml"]),
        0,
        "small.h5: 5 002 cells",
    );
    assert_eq!(
        folder.files(),
        [
            "other.toml",
            "small.h5",
            "small.h5.log",
            "small.png",
            "small.toml"
        ]
    );
    let first = std::fs::metadata(folder.path().join("small.h5"))
        .unwrap()
        .modified()
        .unwrap();
    expect(&folder.run(&["run", "small.toml"]), 0, "already complete");
    let again = std::fs::metadata(folder.path().join("small.h5"))
        .unwrap()
        .modified()
        .unwrap();
    assert_eq!(first, again);
    expect(
        &folder.run(&["run", "other.toml", "-o", "small.h5"]),
        2,
        "the map of another sweep",
    );
    expect(
        &folder.run(&["run", "small.toml", "-o", "new.png"]),
        2,
        "a map is written as HDF5, not as png",
    );
    std::fs::write(
        folder.path().join("re.titled.toml"),
        SMALL.replace("small", "tall"),
    )
    .unwrap();
    expect(
        &folder.run(&["run", "re.titled.toml", "-o", "small.h5"]),
        0,
        "the sweep file has changed otherwise",
    );
    expect(
        &folder.run(&["run", "re.titled.toml"]),
        0,
        "re.titled.h5: 5 002 cells",
    );
    expect(
        &folder.run(&["run", "other.toml", "-o", "small.h5", "--fresh"]),
        0,
        "5 124 cells",
    );
    expect(&folder.run(&["info", "small.h5"]), 0, "42 points, -3 to 1");
    // A picture that somebody else made is not drawn over.
    std::fs::write(folder.path().join("small.png"), "a photograph").unwrap();
    expect(
        &folder.run(&["run", "small.toml", "--fresh"]),
        0,
        "small.png is there and not by slipmap",
    );
    assert_eq!(
        std::fs::read_to_string(folder.path().join("small.png")).unwrap(),
        "a photograph"
    );
    expect(
        &folder.run(&["run", "other.toml", "-o", "small.h5", "--fresh"]),
        0,
        "5 124 cells",
    );
    assert_eq!(
        out(&folder.run(&["info", "small.h5", "--sweep"])),
        SMALL.replace("41", "42")
    );
}

/// What a picture shows: the field that the sweep names, what is not known hatched and in words,
/// beside the picture of the run and not over it.
#[test]
fn pictures_show_what_they_say_and_replace_no_other() {
    let sweep =
        format!("picture = \"delay_margin\"\nfields = [\"n_unstable\", \"delay_margin\"]\n{SMALL}");
    let folder = Folder::with(&[("small.toml", &sweep)]);
    expect(&folder.run(&["run", "small.toml"]), 0, "small.png");
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    let of_run = read("small.png");
    let draw = |args: &[&str], name: &str| {
        expect(
            &folder.run(&[&["plot", "small.h5"], args].concat()),
            0,
            name,
        );
        read(name)
    };
    let named = draw(&["--field", "delay_margin"], "small.delay_margin.png");
    assert!(
        pixels(&named) == pixels(&of_run),
        "the field that the sweep names"
    );
    let counts = draw(&["--field", "n_unstable"], "small.n_unstable.png");
    assert!(pixels(&counts) != pixels(&of_run) && read("small.png") == of_run);
    draw(
        &["--kind", "heat", "--at", "mu_prime=-0.1"],
        "small.heat.mu_prime=-0.1.png",
    );
    assert!(read("small.png") == of_run);
    std::fs::write(folder.path().join("small.n_unstable.png"), "a photograph").unwrap();
    let args = ["plot", "small.h5", "--field", "n_unstable"];
    expect(&folder.run(&args), 2, "is there and not by slipmap");
    assert_eq!(read("small.n_unstable.png"), b"a photograph");
    let wide = [
        "plot", "small.h5", "-o", "wide.svg", "--size", "2000x700", "--title", "Mine",
    ];
    expect(&folder.run(&wide), 0, "wide.svg");
    let text = String::from_utf8(read("wide.svg")).unwrap();
    assert!(text.starts_with("<svg width=\"2000\" height=\"700\"") && text.contains("Mine"));
    let large = folder.run(&["plot", "small.h5", "-o", "x.png", "--size", "9000x10"]);
    expect(
        &large,
        2,
        "--size: a picture of 9000 × 10 pixels is outside the range",
    );
    let svg = || {
        let args = ["plot", "small.h5", "--field", "n_unstable", "-o", "x.svg"];
        expect(&folder.run(&args), 0, "x.svg");
        String::from_utf8(read("x.svg")).unwrap()
    };
    let clean = svg();
    assert!(clean.contains("Number of characteristic roots") && clean.contains("dimensionless"));
    assert!(!clean.contains("marginal") && !clean.contains("not computed"));
    edit(&folder.path().join("small.h5"), |file| {
        let status = file.dataset("status").unwrap();
        let mut cells = status.read_raw::<u8>().unwrap();
        cells[..500].fill(slipmap::linear::status::MARGINAL);
        cells[500..900].fill(u8::MAX);
        status.write_raw(&cells).unwrap();
    });
    let text = svg();
    assert!(text.contains("marginal") && text.contains("not computed"));
    let lines = |text: &str| text.matches("<polyline").count();
    assert!(lines(&text) > lines(&clean) + 10, "hatched");
}

#[test]
fn an_output_that_is_no_map_is_not_touched() {
    let folder = Folder::with(&[("small.toml", SMALL), ("thesis.h5", "years of work")]);
    std::fs::create_dir(folder.path().join("folder.h5")).unwrap();
    for fresh in [&["--fresh"][..], &[]] {
        for (name, says) in [
            ("thesis.h5", "no map of slipmap"),
            ("small.toml", "a map is written as HDF5, not as toml"),
            ("folder.h5", "it is a folder"),
        ] {
            let args = [&["run", "small.toml", "-o", name], fresh].concat();
            expect(&folder.run(&args), 2, says);
        }
    }
    assert_eq!(
        std::fs::read_to_string(folder.path().join("thesis.h5")).unwrap(),
        "years of work"
    );
    assert_eq!(
        std::fs::read_to_string(folder.path().join("small.toml")).unwrap(),
        SMALL
    );
    assert_eq!(folder.files(), ["folder.h5", "small.toml", "thesis.h5"]);
}

#[test]
fn places_that_cannot_be_written_are_named() {
    let folder = Folder::with(&[("small.toml", SMALL)]);
    for place in ["nowhere/map.h5", "small.toml/map.h5"] {
        let output = folder.run(&["run", "small.toml", "-o", place]);
        expect(&output, 1, &format!("cannot write {place}"));
    }
    expect(
        &folder.run(&["run", "small.toml", "-o", ".."]),
        2,
        "does not name a file",
    );
    assert_eq!(folder.files(), ["small.toml"]);
}

#[test]
fn mistakes_in_sweep_files_are_shown_in_place() {
    let folder = Folder::with(&[
        (
            "reversed.toml",
            "[axes]\nmu_prime = [-0.1]\ntau = { from = 12, to = 0, points = 5 }\n",
        ),
        (
            "unknown.toml",
            "[axes]\nmu_prime = [-0.1]\ntau = [1]\n\n[fixed]\nalpha_w = 3\n",
        ),
        (
            "field.toml",
            "fields = [\"n_unstable\", \"abscissa_9\"]\n\n[axes]\nmu_prime = [-0.1]\ntau = [1]\n",
        ),
    ]);
    let reversed = folder.run(&["run", "reversed.toml"]);
    assert_eq!(reversed.status.code(), Some(2));
    insta::assert_snapshot!("reversed_range", err(&reversed));
    let unknown = folder.run(&["run", "unknown.toml"]);
    assert_eq!(unknown.status.code(), Some(2));
    insta::assert_snapshot!("unknown_key", err(&unknown));
    let field = folder.run(&["run", "field.toml"]);
    assert_eq!(field.status.code(), Some(2));
    insta::assert_snapshot!("unknown_field", err(&field));
    std::fs::write(folder.path().join("latin.toml"), b"# \xe9\n").unwrap();
    expect(&folder.run(&["run", "latin.toml"]), 2, "not UTF-8");
    expect(
        &folder.run(&["run", "missing.toml"]),
        2,
        "cannot read missing.toml",
    );
    expect(&folder.run(&["run", "."]), 2, "it is no regular file");
    expect(
        &folder.run(&["plan", "missing.toml"]),
        2,
        "cannot read missing.toml",
    );
    assert_eq!(
        folder.files(),
        ["field.toml", "latin.toml", "reversed.toml", "unknown.toml"]
    );
}

#[test]
fn usage_mistakes_have_exit_code_2() {
    let folder = Folder::with(&[("small.toml", SMALL)]);
    for args in [
        &["run"][..],
        &["run", "small.toml", "--threads", "0"],
        &["run", "small.toml", "--threads", "-1"],
        &["run", "small.toml", "--threads", "1000000"],
        &["run", "small.toml", "--quick"],
        &["sprint"],
        &[],
        &["point", "--tau", "x", "--mu-prime", "1"],
        &["point", "--tau", "1"],
        &["point", "--mu-prime", "1", "--alpha-v", "1"],
        &["point", "--mu-prime", "nan", "--tau", "1"],
        &["point", "--mu-prime", "inf", "--tau", "1"],
        &["point", "--mu-prime", "1", "--tau", "-1"],
        &["point", "--mu-prime", "1", "--tau", "1", "--roots", "0"],
        &["point", "--mu-prime", "1", "--tau", "1", "--roots", "65"],
        &["point", "--mu-prime", "1", "--tau", "1", "--mass", "0"],
        &["point", "--mu-prime", "1", "--tau", "1", "--v0", "1"],
        &[
            "point",
            "--mu-prime",
            "1",
            "--tau",
            "1",
            "--friction",
            "coulomb",
        ],
        &[
            "point",
            "--friction",
            "weakening",
            "--mu0",
            "2",
            "--v-s",
            "1",
            "--v0",
            "1",
            "--tau",
            "1",
        ],
        &["point", "--friction", "glue", "--tau", "1"],
    ] {
        let output = folder.run(args);
        assert_eq!(output.status.code(), Some(2), "{args:?}\n{}", err(&output));
        assert!(
            !err(&output).is_empty() && out(&output).is_empty(),
            "{args:?}"
        );
        assert!(!err(&output).contains("panicked"), "{}", err(&output));
    }
    assert_eq!(folder.files(), ["small.toml"]);
}

#[test]
fn files_that_are_no_maps_are_answered() {
    let folder = Folder::with(&[
        ("text.h5", "hello"),
        ("empty.h5", ""),
        ("small.toml", SMALL),
    ]);
    expect(&folder.run(&["run", "small.toml"]), 0, "cells");
    let whole = std::fs::read(folder.path().join("small.h5")).unwrap();
    std::fs::write(folder.path().join("half.h5"), &whole[..whole.len() / 2]).unwrap();
    let bare = folder.path().join("bare.h5");
    hdf5::File::create(&bare).unwrap().close().unwrap();
    settle(&bare);
    for command in ["info", "plot", "verify"] {
        for name in ["text.h5", "empty.h5", "bare.h5"] {
            expect(&folder.run(&[command, name]), 2, "is not a slipmap map");
        }
        let damaged = "half.h5 is a damaged HDF5 file";
        expect(&folder.run(&[command, "half.h5"]), 1, damaged);
    }
    for name in ["missing.h5", "."] {
        assert_eq!(folder.run(&["info", name]).status.code(), Some(2), "{name}");
    }
    edit(&folder.path().join("small.h5"), |_| {
        let busy = "another program has small.h5 open for writing";
        expect(&folder.run(&["info", "small.h5"]), 1, busy);
    });
    expect(&folder.run(&["info", "small.h5"]), 0, "title        small");
}

#[test]
fn point_says_everything_for_people_and_programs() {
    let folder = Folder::new();
    let args = [
        "point",
        "--mu-prime",
        "-0.7",
        "--alpha-v",
        "-0.3174",
        "--tau",
        "4.312957",
    ];
    insta::assert_snapshot!("point", out(&folder.run(&args)));
    let json = folder.run(&[&args[..], &["--json"]].concat());
    let value = program::json(&json);
    let scientific = folder.run(&[
        "point",
        "--mu-prime",
        "-7e-1",
        "--alpha-v",
        "-.3174",
        "--tau",
        "4.312957",
        "--json",
    ]);
    assert_eq!(out(&scientific), out(&json));
    assert_eq!(
        (value["n_unstable"].as_u64(), value["stable"].as_bool()),
        (Some(0), Some(true))
    );
    assert_eq!(value["marginal"].as_bool(), Some(false));
    let near = |value: &serde_json::Value, expected: f64, by: f64| {
        assert!((value.as_f64().unwrap() - expected).abs() < by, "{value}");
    };
    near(&value["stable_delays"][0][0], 4.29716, 5e-6);
    near(&value["stable_delays"][0][1], 4.32875, 5e-6);
    near(&value["delay_margin"], 4.32875 - 4.312957, 5e-6);
    assert_eq!(value["delay_margin_kind"], "finite");
    let open = folder.run(&["point", "--mu-prime", "0.3", "--tau", "2", "--json"]);
    let value = program::json(&open);
    assert!(value["stable_delays"][0][1].is_null() && value["delay_margin"].is_null());
    assert_eq!(value["delay_margin_kind"], "infinite");
    // Without control b < 0 is unstable at every delay: [] is none.
    let never = folder.run(&["point", "--mu-prime", "-0.3", "--tau", "2", "--json"]);
    let value = program::json(&never);
    assert_eq!(value["stable_delays"], serde_json::json!([]));
    assert_eq!(value["delay_margin_kind"], "infinite");
    assert_eq!(value["delay_margin_sign"], -1);
}

/// The roots of a point: as many as asked for, fewer where there are no more.
#[test]
fn point_lists_the_rightmost_roots() {
    let folder = Folder::new();
    let json = |args: &[&str]| -> serde_json::Value {
        let output = folder.run(&[&["point", "--json", "--mu-prime", "-0.3"], args].concat());
        assert_eq!(err(&output), "");
        program::json(&output)
    };
    for tau in ["1e-9", "0.5", "4", "60", "3000"] {
        let value = json(&["--tau", tau, "--alpha-v", "-0.4", "--roots", "20"]);
        let roots: Vec<[f64; 2]> = serde_json::from_value(value["roots"].clone()).unwrap();
        assert_eq!(
            (roots.len(), &value["certified"]),
            (20, &true.into()),
            "{tau}"
        );
        assert!(
            roots.windows(2).all(|w| w[0][0] >= w[1][0]),
            "{tau} {roots:?}"
        );
        assert!(roots.iter().all(|root| root[1] >= 0.0), "{tau} {roots:?}");
        assert_eq!(value["abscissa"], roots[0][0]);
        assert_eq!(value["frequency"], roots[0][1]);
        let unstable = roots.iter().filter(|root| root[0] > 0.0).count() as u64;
        assert!(unstable == 20 || 2 * unstable == value["n_unstable"].as_u64().unwrap());
    }
    for few in [&["--tau", "0", "--alpha-v", "-0.4"][..], &[]] {
        let value = json(&[few, &["--roots", "20"]].concat());
        let roots: Vec<[f64; 2]> = serde_json::from_value(value["roots"].clone()).unwrap();
        assert!(
            roots.len() == 1 && (roots[0][0] - 0.15).abs() < 1e-15,
            "{roots:?}"
        );
        assert_eq!(value["certified"], true);
    }
    let text = out(&folder.run(&[
        "point",
        "--mu-prime",
        "-0.3",
        "--tau",
        "0",
        "--alpha-v",
        "1",
    ]));
    assert!(
        text.contains("there are no others: the delay is 0"),
        "{text}"
    );
}

/// Every row of the reference: roots from elsewhere, to eleven digits behind the point.
#[test]
fn point_has_the_roots_of_the_reference() {
    let folder = Folder::new();
    let rows = include_str!("../reference/linear_points.csv");
    let mut checked = 0;
    for row in rows.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let flags = ["--mu-prime", "--alpha-v", "--alpha-n", "--tau"];
        let given: Vec<&str> = flags
            .into_iter()
            .zip(cells.iter().copied())
            .flat_map(|(f, c)| [f, c])
            .collect();
        let output = folder.run(&[&["point", "--json", "--roots", "1"], given.as_slice()].concat());
        let value = program::json(&output);
        assert_eq!(value["n_unstable"].to_string(), cells[4], "{row}");
        assert_eq!(value["certified"], true, "{row}");
        for (name, cell) in [("abscissa", cells[5]), ("frequency", cells[6])] {
            let expected: f64 = cell.parse().unwrap();
            let found = value[name].as_f64().unwrap();
            assert!((found - expected).abs() < 1e-11, "{name} {found} {row}");
        }
        checked += 1;
    }
    assert_eq!(checked, 150);
}

/// A map with decay rates: planned, run, drawn as such, and listed with the range of its values.
#[test]
fn decay_rates_go_through_every_command() {
    let sweep = SMALL.replace(
        "[axes]",
        "fields = [\"n_unstable\", \"abscissa\", \"frequency\"]\n[axes]",
    );
    let folder = Folder::with(&[("decay.toml", &sweep)]);
    let plan = folder.run(&["plan", "decay.toml"]);
    expect(
        &plan,
        0,
        "n_unstable, abscissa, frequency, certificate_margin, status",
    );
    // 2 + 3 × 8 + 1 bytes in 5002 cells.
    expect(&plan, 0, "135 kB before compression");
    expect(
        &folder.run(&["run", "decay.toml"]),
        0,
        "decay.h5: 5 002 cells",
    );
    let info = folder.run(&["info", "decay.h5"]);
    expect(&info, 0, "certified 5 002 cells");
    let line = |name: &str| {
        let text = out(&info);
        let found = text.lines().find(|l| l.contains(name)).map(str::to_owned);
        found.unwrap_or_else(|| panic!("{name}: {text}"))
    };
    assert!(line("abscissa").contains(", -") && line("frequency").contains(" to "));
    let default = pixels(&std::fs::read(folder.path().join("decay.png")).unwrap());
    let draw = |args: &[&str]| {
        let output = folder.run(&[&["plot", "decay.h5", "-o", "again.png"], args].concat());
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        pixels(&std::fs::read(folder.path().join("again.png")).unwrap())
    };
    assert!(
        default == draw(&["--field", "abscissa"]),
        "the abscissa is drawn by default"
    );
    for other in [
        &["--field", "n_unstable"][..],
        &["--field", "frequency"],
        &["--kind", "boundaries"],
    ] {
        assert!(default != draw(other), "{other:?}");
    }
    expect(
        &folder.run(&["plot", "decay.h5", "--field", "abscissa_9"]),
        2,
        "it holds n_unstable, abscissa, frequency,",
    );
    expect(
        &folder.run(&["plot", "decay.h5", "--field", "relaxation_time"]),
        2,
        "does not hold relaxation_time",
    );
}

/// Physical units: the same point at another mass, stiffness and load, and by its friction law.
#[test]
fn point_agrees_with_itself_in_other_units() {
    let folder = Folder::new();
    let json = |args: &[&str]| -> serde_json::Value {
        program::json(&folder.run(&[&["point", "--json"], args].concat()))
    };
    let plain = json(&[
        "--mu-prime",
        "-0.2",
        "--alpha-v",
        "-0.3",
        "--alpha-n",
        "-0.8",
        "--tau",
        "3",
    ]);
    // M = 4, κ = 9: time unit 2/3, b = μ′N0/6, a_v = α_v 2/3, a_n = μ_K α_N/9.
    let scaled = json(&[
        "--mass",
        "4",
        "--stiffness",
        "9",
        "--normal-load",
        "3",
        "--mu-k",
        "0.5",
        "--mu-prime",
        "-0.4",
        "--alpha-v",
        "-0.45",
        "--alpha-n",
        "-14.4",
        "--tau",
        "2",
    ]);
    assert_eq!(plain["n_unstable"], scaled["n_unstable"]);
    let margins = [&plain, &scaled].map(|v| v["delay_margin"].as_f64().unwrap());
    assert!(
        (margins[0] * 2.0 / 3.0 - margins[1]).abs() < 1e-12,
        "{margins:?}"
    );
    for name in ["abscissa", "frequency"] {
        let rates = [&plain, &scaled].map(|v| v[name].as_f64().unwrap());
        assert!((rates[0] * 1.5 - rates[1]).abs() < 1e-12, "{rates:?}");
    }
    // The letter's Fig. 3(b).
    let law = json(&[
        "--friction",
        "weakening",
        "--mu0",
        "0.5",
        "--v-s",
        "0.5",
        "--v0",
        "0.1",
        "--alpha-n",
        "-10",
        "--tau",
        "0.5",
    ]);
    assert_eq!(law["stable"].as_bool(), Some(true));
    assert!((law["mu_prime"].as_f64().unwrap() + 1.0 / 1.44).abs() < 1e-12);
}

/// Gains, delays, abscissas and frequencies of the snapshot, and the gain of the triple root, solve
/// D = D′ = 0 and D = D′ = D″ = 0 in 30-digit arithmetic (mpmath).
#[test]
fn best_says_where_decay_is_fastest() {
    let folder = Folder::new();
    let args = ["best", "--mu-prime", "-0.1"];
    insta::assert_snapshot!("best", out(&folder.run(&args)));
    let json = |args: &[&str]| -> serde_json::Value {
        let output = folder.run(&[&["best", "--json"], args].concat());
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        program::json(&output)
    };
    let near = |value: &serde_json::Value, expected: f64| {
        let value = value.as_f64().unwrap();
        assert!((value / expected - 1.0).abs() < 1e-8, "{value} {expected}");
    };
    let load = json(&["--mu-prime", "-0.1", "--control", "load"]);
    assert_eq!(load["best"]["kind"], "triple real root");
    assert_eq!(load["best"]["certified"], true);
    assert_eq!(load["regions"].as_array().unwrap().len(), 7);
    near(&load["best"]["alpha"], -3.061_457_594);
    // M = 4, κ = 9: time unit 2/3, b = μ′N0/6, a_n = μ_K α_N/9.
    let scaled = json(&[
        "--mu-prime",
        "-0.2",
        "--mass",
        "4",
        "--stiffness",
        "9",
        "--normal-load",
        "3",
        "--mu-k",
        "0.5",
        "--control",
        "load",
    ]);
    for (name, unit) in [
        ("alpha", 18.0),
        ("tau", 2.0 / 3.0),
        ("abscissa", 1.5),
        ("relaxation_time", 2.0 / 3.0),
    ] {
        near(
            &scaled["best"][name],
            load["best"][name].as_f64().unwrap() * unit,
        );
    }
    // Only a lobe of positive gain is left in these ranges.
    let lobe = json(&[
        "--mu-prime",
        "-0.1",
        "--control",
        "load",
        "--alpha-from",
        "0",
        "--alpha-to",
        "1",
        "--tau-from",
        "4",
        "--tau-to",
        "7",
    ]);
    assert_eq!(lobe["regions"].as_array().unwrap().len(), 1);
    near(
        &lobe["best"]["alpha"],
        load["regions"][1]["alpha"].as_f64().unwrap(),
    );
    assert_eq!(lobe["searched"]["tau"], serde_json::json!([4.0, 7.0]));
    // The other gain acts as given.
    let mixed = json(&["--mu-prime", "-0.1", "--alpha-n", "-0.5"]);
    assert!(mixed["best"]["abscissa"].as_f64().unwrap() < 0.0);
}

#[test]
fn best_without_a_stable_setting_says_so() {
    let folder = Folder::new();
    let args = ["best", "--mu-prime", "-0.8"];
    expect(
        &folder.run(&args),
        0,
        "no stable setting in the ranges; the least unstable one is",
    );
    let json = folder.run(&[&args[..], &["--json"]].concat());
    let value = program::json(&json);
    assert!(value["best"]["relaxation_time"].is_null());
    assert!(value["best"]["abscissa"].as_f64().unwrap() > 0.0);
    assert_eq!(value["regions"].as_array().unwrap().len(), 0);
}

#[test]
fn mistakes_in_the_flags_of_best_are_answered() {
    let folder = Folder::new();
    let with = |args: &[&str]| folder.run(&[&["best", "--mu-prime", "-0.1"], args].concat());
    for (args, says) in [
        (
            &["--tau", "3"][..],
            "--tau 3 would fix tau, which is searched",
        ),
        (
            &["--alpha-v", "1"],
            "--alpha-v 1 would fix alpha_v, which is searched",
        ),
        (
            &["--control", "load", "--alpha-n", "1"],
            "--alpha-n 1 would fix alpha_n, which is searched",
        ),
        (&["--control", "both"], "invalid value 'both'"),
        (
            &["--alpha-from", "nan"],
            "--alpha-from NaN is outside its range: a finite number",
        ),
        (
            &["--alpha-to", "inf"],
            "--alpha-to inf is outside its range: a finite number",
        ),
        (
            &["--tau-from", "-1"],
            "--tau-from -1 is outside its range: 0 or more",
        ),
        (
            &["--alpha-from", "2", "--alpha-to", "1"],
            "--alpha-from 2 is above --alpha-to 1",
        ),
        (
            &["--alpha-from", "9"],
            "--alpha-from 9 is above --alpha-to 2, its default",
        ),
        (
            &["--mass", "0"],
            "--mass 0 is outside its range: greater than 0",
        ),
    ] {
        expect(&with(args), 2, says);
    }
    expect(&folder.run(&["best"]), 2, "--mu-prime is not given");
}

#[test]
fn plan_tells_the_cost_without_writing() {
    let folder = Folder::with(&[("large.toml", LARGE)]);
    let output = folder.run(&["plan", "large.toml", "--threads", "3"]);
    expect(&output, 0, "cells 50 000 000 000");
    expect(&output, 0, "on 3 threads");
    assert_eq!(folder.files(), ["large.toml"]);
}

#[test]
fn progress_is_plain_lines_without_a_terminal() {
    let folder = Folder::with(&[("small.toml", SMALL)]);
    let output = folder.run(&["run", "small.toml", "--threads", "2"]);
    expect(&output, 0, "5 002 cells on 2 threads");
    assert!(
        !err(&output).contains('\u{1b}') && !err(&output).contains('\r'),
        "{}",
        err(&output)
    );
    let quiet = folder.run(&["run", "small.toml", "--quiet", "--fresh"]);
    assert_eq!(err(&quiet), "");
}

/// `slipmap … | head -0` and closed streams: no panic, and the map is complete.
#[test]
#[cfg(unix)]
fn a_reader_that_has_gone_is_no_failure() {
    let folder = Folder::with(&[("small.toml", SMALL)]);
    let program = env!("CARGO_BIN_EXE_slipmap");
    for (args, redirect) in [
        ("run small.toml --fresh", "2>err | true"),
        ("run small.toml --fresh", ">&- 2>err"),
        ("run small.toml --fresh", ">/dev/full 2>err"),
        ("run small.toml --fresh", ">err 2>&-"),
        ("info small.h5", "2>err | true"),
        ("point --mu-prime 1 --tau 1", "2>err | true"),
        ("plan small.toml", "2>err | true"),
        ("plot small.h5", "2>err | true"),
        ("info missing.h5", ">err 2>&-"),
    ] {
        let line = format!("sleep 0.05; '{program}' {args} {redirect}");
        let mut shell = Command::new("sh");
        let output = output(shell.args(["-c", &line]).current_dir(folder.path()));
        let said = std::fs::read_to_string(folder.path().join("err")).unwrap();
        assert!(!said.contains("panicked"), "{line}\n{said}");
        assert!(output.status.code().is_some_and(|code| code <= 2), "{line}");
        assert!(folder.path().join("small.h5").exists());
    }
}

#[test]
fn a_measured_friction_law_goes_through_every_command() {
    let curve = "speed, mu_k\n# a straight line\n0, 0.5\n0.2, 0.45\n1, 0.25\n";
    let law = "[friction]\nlaw = \"table\"\nspeeds = [0, 0.2, 1]\nmu_k = [0.5, 0.45, 0.25]\n";
    let sweep = format!(
        "fields = [\"n_unstable\", \"abscissa\"]\nboundaries = true\ndegree_of_stability = [0.05]\n\
         [axes]\nv0 = {{ from = 0.1, to = 2, points = 12 }}\ntau = {{ from = 0.1, to = 6, points = 30 }}\n\
         [fixed]\nalpha_v = -0.2\n{law}"
    );
    let case = format!("horizon = 200\n[fixed]\nv0 = 0.3\n[start]\nx_dot0 = 0.0\n{law}");
    let folder = Folder::with(&[
        ("curve.csv", curve),
        ("map.toml", &sweep),
        ("case.toml", &case),
        ("bad.csv", "speed, mu_k\n0, 0.5\n0.2, 0.45\n0.3, -0.4\n"),
        ("fast.csv", "0 1.5\n1 0.5\n"),
    ]);
    let point = ["point", "--tau", "3.4", "--alpha-v", "-0.17", "--json"];
    let friction = ["--friction", "table", "--v0", "0.5", "--table"];
    let json = |args: &[&str]| -> serde_json::Value {
        let output = folder.run(&[&point[..], args].concat());
        program::json(&output)
    };
    let table = json(&[&friction[..], &["curve.csv"]].concat());
    let plain = json(&["--mu-prime", "-0.25", "--mu-k", "0.375"]);
    for name in ["mu_prime", "mu_k", "abscissa", "frequency"] {
        let [one, other] = [&table, &plain].map(|v| v[name].as_f64().unwrap());
        assert!((one - other).abs() < 1e-12, "{name}: {one} {other}");
    }
    for args in [
        &["run", "map.toml"][..],
        &["info", "map.h5"],
        &["simulate", "case.toml", "--json"],
    ] {
        let output = folder.run(args);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    }
    let wrong = |args: &[&str]| folder.run(&[&point[..], args].concat());
    let bad = wrong(&[&friction[..], &["bad.csv"]].concat());
    assert_eq!(bad.status.code(), Some(2));
    insta::assert_snapshot!("bad_table", err(&bad));
    let ill_posed = wrong(&[&friction[..], &["fast.csv"]].concat());
    expect(
        &ill_posed,
        2,
        "mu_k = 1.5 is outside its range: at most mu_s",
    );
    expect(
        &wrong(&[&friction[..], &["none.csv"]].concat()),
        2,
        "cannot read none.csv",
    );
    expect(&wrong(&friction[..4]), 2, "--table is not given");
    let misplaced = ["--mu-prime", "1", "--table", "curve.csv"];
    expect(&wrong(&misplaced), 2, "with --friction table only");
}

/// Names that HDF5 cannot open and folders are refused at once; texts of a map are shown, not
/// obeyed.
#[cfg(unix)]
#[test]
fn odd_names_and_texts_are_answered() {
    type Title = hdf5::types::FixedUnicode<32_000>;
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::with(&[("small.toml", SMALL)]);
    let odd = std::ffi::OsStr::from_bytes(b"\xff.h5");
    let mut command = folder.command(&["run", "small.toml", "-o"]);
    expect(&output(command.arg(odd)), 2, "is not UTF-8");
    let args = ["run", "small.toml", "-o", "newdir/"];
    expect(&folder.run(&args), 2, "does not name a file");
    assert_eq!(folder.files(), ["small.toml"]);
    expect(&folder.run(&["run", "small.toml"]), 0, "5 002 cells");
    let path = folder.path().join("small.h5");
    let entitle = |text: &str| {
        map::edit(&path, |file| {
            file.delete_attr("title").unwrap();
            let title = file.new_attr::<Title>().create("title");
            let text = text.parse::<Title>().unwrap();
            title.unwrap().write_scalar(&text).unwrap();
        });
    };
    entitle(&"long ".repeat(6400));
    let begun = std::time::Instant::now();
    expect(&folder.run(&["plot", "small.h5"]), 0, "small.png");
    let took = begun.elapsed();
    assert!(took < std::time::Duration::from_secs(8), "{took:?}");
    entitle("\u{1b}]0;owned\u{7}\u{1b}[2J\nsecond");
    let shown = folder.run(&["info", "small.h5"]);
    expect(&shown, 0, "\\u{1b}]0;owned");
    assert!(!out(&shown).contains(['\u{1b}', '\u{7}']));
    // A long comment goes into the map and its manifest; one that is too long is refused.
    let comment = "# \"quoted\"\n".repeat(300_000);
    std::fs::write(folder.path().join("long.toml"), format!("{SMALL}{comment}")).unwrap();
    expect(&folder.run(&["run", "long.toml"]), 0, "5 002 cells");
    let sweep = folder.run(&["info", "long.h5", "--sweep"]);
    assert!(out(&sweep).ends_with(&comment));
    let huge = std::fs::File::create(folder.path().join("huge.toml")).unwrap();
    huge.set_len((16 << 20) + 1).unwrap();
    let refused = folder.run(&["run", "huge.toml"]);
    expect(&refused, 2, "a sweep file has 16.8 MB at most");
}
