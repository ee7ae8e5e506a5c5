//! What a newcomer runs into: names that are nearly right, files of another kind, formats that a
//! name promises, and facts for other programs.

use std::io::Write;
use std::process::Stdio;

use serde_json::Value;

use crate::program::{self, Folder, Started, err, expect, out};

const SMALL: &str =
    "title = \"small\"\n[axes]\nalpha_v = [-1, -0.5]\ntau = [1, 2, 3]\n[fixed]\nmu_prime = -0.3\n";
const CASE: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n[fixed]\nv0 = 0.35\n\
                    alpha_v = -0.33\ntau = 4.15\n";

/// Every message but its frame, on one line.
fn said(folder: &Folder, args: &[&str]) -> String {
    let output = folder.run(args);
    assert_eq!(output.status.code(), Some(2), "{args:?} {}", err(&output));
    err(&output)
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

#[test]
fn names_that_are_nearly_right_are_understood() {
    let folder = Folder::with(&[
        ("key.toml", &SMALL.replace("tau", "taw")),
        ("field.toml", &format!("fields = [\"abscisa\"]\n{SMALL}")),
        ("law.toml", &format!("{SMALL}mu_s = 1\n")),
        ("small.toml", SMALL),
    ]);
    expect(&folder.run(&["run", "small.toml"]), 0, "6 cells");
    for (args, says) in [
        (&["run", "key.toml"][..], "did you mean `tau`?"),
        (&["run", "field.toml"], "did you mean `abscissa`?"),
        (
            &["run", "law.toml"],
            "mu_s belongs in [friction], with a law",
        ),
        (
            &["plot", "small.h5", "--field", "n-unstabel"],
            "did you mean `n_unstable`?",
        ),
        (
            &["plot", "small.h5", "--at", "alphav=1"],
            "did you mean `alpha_v`?",
        ),
        (&["point", "--mu_prime", "1"], "'--mu-prime'"),
        (&["pont"], "'point'"),
        (
            &["point", "--mu-prime", "x", "--tau", "1"],
            "expected a number, such as -0.3 or 1e-2",
        ),
        (
            &["point", "--mu-prime", "1", "--tau", "1", "--roots", "-3"],
            "expected a whole number from 1 to 64",
        ),
        (
            &["vc", "--friction", "coulomb", "--mu0", "0.5", "--v-s", "1"],
            "--v-s is for the laws weakening, stribeck",
        ),
    ] {
        let text = said(&folder, args);
        assert!(text.contains(says), "{args:?}: {text}");
    }
}

/// What is told is what is possible there.
#[test]
fn mistakes_are_answered_where_they_are() {
    let folder = Folder::with(&[
        ("small.toml", SMALL),
        (
            "weak.toml",
            &format!("{SMALL}[friction]\nlaw = \"weakning\"\n"),
        ),
        ("folow.toml", &format!("protocol = \"folow\"\n{SMALL}")),
        ("gama.toml", &CASE.replace("alpha_v", "gama")),
        ("muprime.toml", &CASE.replace("alpha_v", "mu_prim")),
        ("tt.csv", "# measured\n0, 1.5\n1, 0.4\n"),
        ("case.toml", CASE),
    ]);
    expect(&folder.run(&["run", "small.toml"]), 0, "6 cells");
    expect(&folder.run(&["simulate", "case.toml"]), 0, "slide");
    let table = [
        "point",
        "--friction",
        "table",
        "--table",
        "tt.csv",
        "--v0",
        "1",
    ];
    for (args, says) in [
        (&["run", "weak.toml"][..], "did you mean `weakening`?"),
        (&["run", "folow.toml"], "did you mean `follow`?"),
        (&table, "tt.csv:2:4"),
        (
            &["plot", "small.h5", "--field", "nope"],
            "it holds n_unstable",
        ),
        (
            &["plot", "case.h5", "--field", "x"],
            "a trace of one motion",
        ),
        (
            &["export", "case.h5", "--at", "x=1"],
            "a trace of one motion",
        ),
        (
            &["export", "small.h5", "--at", "x=1"],
            "its axes: alpha_v, tau",
        ),
    ] {
        let text = said(&folder, args);
        assert!(text.contains(says), "{args:?}: {text}");
    }
    for file in ["gama.toml", "muprime.toml"] {
        let text = said(&folder, &["simulate", file]);
        assert!(text.contains("known here: alpha_v"), "{file}: {text}");
        assert!(
            !text.contains("gamma") && !text.contains("mu_prime"),
            "{text}"
        );
    }
}

#[test]
fn files_of_another_kind_are_recognised() {
    let folder = Folder::with(&[
        ("small.toml", SMALL),
        ("case.toml", &format!("switch_on = 70.0\n{CASE}")),
        ("setting.toml", CASE),
        ("system.toml", "P = \"s^2 + 1\"\nQ = \"0.1\"\n"),
    ]);
    expect(&folder.run(&["simulate", "case.toml"]), 0, "slide");
    expect(&folder.run(&["run", "small.toml"]), 0, "6 cells");
    for (args, says) in [
        (&["run", "case.toml"][..], "case.toml is a case file, not a"),
        (&["run", "case.toml"], "`slipmap plan` and `simulate` take"),
        (
            &["run", "setting.toml"],
            "setting.toml is a file of a setting",
        ),
        (&["run", "system.toml"], "system.toml is a system file"),
        (&["plan", "system.toml"], "`best` take it with --system"),
        (&["simulate", "system.toml"], "not a case file"),
        (
            &["vc", "--setting", "system.toml"],
            "not a file of a setting",
        ),
        (&["simulate", "small.toml"], "`slipmap run` takes it"),
        (&["status", "case.h5"], "a trace of one motion"),
        (&["point", "--map", "case.h5"], "a trace of one motion"),
        (&["info", "small.toml"], "small.toml is a sweep file"),
        (&["plot", "case.toml"], "case.toml is a case file"),
        (&["export", "case.toml"], "`slipmap plan` and `simulate`"),
        (&["verify", "small.toml"], "`slipmap plan` and `run` take"),
        (&["status", "small.toml"], "small.toml is a sweep file"),
        (&["vc", "--map", "small.toml"], "small.toml is a sweep file"),
        (&["plan", "small.h5"], "small.h5 is a map, not a sweep file"),
        (&["run", "small.h5"], "`slipmap info`, `plot`, `export`"),
        (&["simulate", "small.h5"], "small.h5 is a map, not a case"),
        (&["simulate", "case.h5"], "case.h5 is the trace of one"),
        (&["point", "--setting", "small.h5"], "small.h5 is a map"),
        (&["point", "--setting", "case.toml"], "case.toml is a case"),
        (&["vc", "--setting", "small.toml"], "small.toml is a sweep"),
    ] {
        let text = said(&folder, args);
        assert!(text.contains(says), "{args:?}: {text}");
    }
    // Of a map that was interrupted there are only tiles.
    let shard = ["run", "small.toml", "-o", "half.h5", "--shard", "1/2"];
    expect(&folder.run(&shard), 0, "shard 1 of 2 is complete");
    let cell = ["--map", "half.h5", "--at", "alpha_v=-1", "--at", "tau=1"];
    let point = folder.run(&[&["point"], &cell[..]].concat());
    expect(&point, 0, "half.h5 is not complete: ");
    expect(&point, 0, "continuous sliding is");
}

/// Flags that a command always refuses are not offered; what is missing is told as it is.
#[test]
fn only_what_is_possible_is_offered() {
    let folder = Folder::with(&[("small.toml", SMALL), ("case.toml", CASE)]);
    let help = |command: &str| out(&folder.run(&[command, "--help"]));
    let offers = |command: &str, flag: &str| help(command).contains(&format!("{flag} <"));
    for command in ["vc", "simulate", "basin"] {
        // A formula is given by --mu-k.
        assert!(!offers(command, "--mu-prime") && offers(command, "--mu-k"));
        for flag in ["--load-lag", "--velocity-lag", "--sensor-lag", "--v-star"] {
            assert!(!offers(command, flag), "{command} {flag}");
        }
        assert!(!help(command).contains("rate-and-state"), "{command}");
        assert!(offers(command, "--memory") && offers(command, "--mu-s"));
        assert!(!help(command).contains("--mu-prime and"), "{command}");
        assert!(offers(command, "--v0") && offers(command, "--tau"));
    }
    assert!(offers("point", "--load-lag") && offers("best", "--v-star"));
    assert!(offers("point", "--mu-prime") && offers("best", "--mu-k"));
    assert!(offers("point", "--tau") && offers("best", "--tau"));
    let law = ["--friction", "weakening", "--mu0", "0.5", "--v-s", "0.5"];
    let vc = |more: &[&str]| folder.run(&[&["vc"], &law[..], more].concat());
    // A v0 is no part of the question: the answer says where it stands.
    let (with, without) = (out(&vc(&["--v0", "8.2828"])), out(&vc(&[])));
    let (says, rest) = with.split_once('\n').unwrap();
    assert_eq!(
        says,
        "above 4.14139 no stick-slip survives; v0 = 8.2828 is 2 times that"
    );
    assert_eq!(rest, without.split_once('\n').unwrap().1);
    expect(&vc(&["--v0", "0.3", "--json"]), 0, "--v0 is left aside");
    expect(&folder.run(&["run", "small.toml"]), 0, "6 cells");
    let cell = ["--map", "small.h5", "--at", "alpha_v=-1", "--at", "tau=1"];
    for (command, says) in [
        ("vc", "a cell of this map has no friction law"),
        ("simulate", "a cell of this map has no friction law"),
    ] {
        let text = said(&folder, &[&[command], &cell[..]].concat());
        assert!(text.contains(says) && !text.contains("delay"), "{text}");
    }
    for args in [
        &["vc", "--mu-prime", "-0.3", "--tau", "1"][..],
        &["simulate", "--mu-prime", "-0.3"],
        &["simulate", "--v0", "0.3"],
    ] {
        let text = said(&folder, args);
        assert!(text.contains("--friction weakening"), "{args:?}: {text}");
        assert!(!text.contains("either --mu-prime"), "{args:?}: {text}");
    }
    let idle = CASE.replace("alpha_v = -0.33\n", "");
    std::fs::write(folder.path().join("idle.toml"), idle).unwrap();
    for command in ["plan", "simulate"] {
        let warned = folder.run(&[command, "idle.toml"]);
        expect(&warned, 0, "warning: tau has no effect");
    }
}

/// A file that is there is somebody's.
#[test]
fn texts_replace_nothing_unasked() {
    let folder = Folder::with(&[("small.toml", SMALL), ("thesis.csv", "a life's work")]);
    expect(&folder.run(&["run", "small.toml"]), 0, "6 cells");
    let export = ["export", "small.h5", "-o", "thesis.csv"];
    expect(&folder.run(&export), 2, "thesis.csv is already there");
    let read = || std::fs::read_to_string(folder.path().join("thesis.csv")).unwrap();
    assert_eq!(read(), "a life's work");
    let fresh = [&export[..], &["--fresh"]].concat();
    expect(&folder.run(&fresh), 0, "thesis.csv: 6 rows");
    assert!(read().starts_with("alpha_v,tau"), "{}", read());
}

/// Comments of a map say as much as those of a trace.
#[test]
fn comments_tell_law_and_start() {
    let motions = "fields = [\"outcome\"]\n[axes]\ntau = [0.5, 1]\n[fixed]\nv0 = 0.2\nalpha_n = -7\n\
                   [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    let folder = Folder::with(&[("map.toml", motions), ("case.toml", CASE)]);
    expect(&folder.run(&["run", "map.toml"]), 0, "2 cells");
    expect(&folder.run(&["simulate", "case.toml"]), 0, "slide");
    for file in ["map.h5", "case.h5"] {
        let text = out(&folder.run(&["export", file, "--comments"]));
        for says in ["# friction: weakening", "# start: none is given: each"] {
            assert!(text.contains(says), "{file}: {text}");
        }
    }
}

#[test]
fn the_format_that_a_name_promises_is_kept_or_refused() {
    let folder = Folder::with(&[("small.toml", SMALL), ("case.toml", CASE)]);
    for args in [
        ["run", "small.toml", "-o", "small.csv"],
        ["simulate", "case.toml", "-o", "case.json"],
    ] {
        let text = said(&folder, &args);
        assert!(text.contains("is written as HDF5, not as"), "{text}");
    }
    for other in ["o.tsv", "o.xlsx", "o.zarr", "o.toml", "o.png", "o", "-"] {
        let run = said(&folder, &["run", "small.toml", "-o", other]);
        assert!(run.contains("NAME.h5, NAME.hdf5 or"), "{other}: {run}");
        let merge = said(&folder, &["merge", "small.h5", "-o", other]);
        assert!(merge.contains("NAME.h5, NAME.hdf5 or"), "{other}: {merge}");
        if other != "-" {
            let simulate = said(&folder, &["simulate", "case.toml", "-o", other]);
            assert!(simulate.contains("NAME.nc"), "{other}: {simulate}");
        }
    }
    let text = said(&folder, &["merge", "part.csv"]);
    assert!(
        text.contains("part.csv: a map is written as HDF5"),
        "{text}"
    );
    assert_eq!(folder.files(), ["case.toml", "small.toml"]);
    expect(
        &folder.run(&["run", "small.toml", "-o", "small.nc"]),
        0,
        "small.nc: 6 cells",
    );
    expect(
        &folder.run(&["run", "small.toml", "-o", "small.HDF5"]),
        0,
        "small.HDF5: 6 cells",
    );
}

/// Exactly at its equilibrium a block stays there, stable or not: that says nothing of control.
#[test]
fn a_case_without_a_start_is_disturbed_and_says_so() {
    let folder = Folder::with(&[
        ("stable.toml", CASE),
        ("unstable.toml", &CASE.replace("4.15", "1.0")),
    ]);
    let stable = folder.run(&["simulate", "stable.toml", "--json"]);
    let said = "begins with x_dot0 = 0.3535, 1 % faster than it is pulled";
    expect(&stable, 0, said);
    let told = program::json(&stable);
    assert_eq!(told["outcome"], "sliding");
    assert!(told["settle_time"].as_f64().unwrap() >= 0.0, "{told}");
    let unstable = folder.run(&["simulate", "unstable.toml", "--json"]);
    let told = program::json(&unstable);
    assert_ne!(told["outcome"], "undecided");
    assert_ne!(told["outcome"], "sliding");
}

#[test]
fn a_sweep_may_come_from_standard_input() {
    let folder = Folder::new();
    let given = |args: &[&str], text: &str| {
        let mut command = folder.command(args);
        let mut started = Started::of(command.stdin(Stdio::piped()));
        let mut stdin = started.child().stdin.take().unwrap();
        stdin.write_all(text.as_bytes()).unwrap();
        drop(stdin);
        started.ended()
    };
    expect(&given(&["run", "-", "-o", "map.h5"], SMALL), 0, "6 cells");
    expect(&given(&["plan", "-"], SMALL), 0, "cells        6");
    let nameless = "--output is not given, and standard input has no name";
    expect(&given(&["run", "-"], SMALL), 2, nameless);
    let wrong = SMALL.replace("tau", "taw");
    expect(&given(&["plan", "-"], &wrong), 2, "standard input:4:1");
    assert_eq!(folder.files(), ["map.h5", "map.h5.log", "map.png"]);
}

#[test]
fn facts_come_as_json_with_a_version() {
    let folder = Folder::with(&[("small.toml", SMALL), ("case.toml", CASE)]);
    expect(&folder.run(&["run", "small.toml"]), 0, "6 cells");
    let json = |args: &[&str]| -> Value {
        let output = folder.run(args);
        assert_eq!(output.status.code(), Some(0), "{args:?} {}", err(&output));
        program::json(&output)
    };
    let law = ["--friction", "weakening", "--mu0", "0.5", "--v-s", "0.5"];
    let point = ["--mu-prime", "-0.3", "--tau", "2", "--json"];
    let all = [
        json(&["plan", "small.toml", "--json"]),
        json(&["info", "small.h5", "--json"]),
        json(&["verify", "small.h5", "--json"]),
        json(&["status", "small.h5", "--json"]),
        json(&["simulate", "case.toml", "--json"]),
        json(&[&["point"], &point[..]].concat()),
        json(&["best", "--mu-prime", "-0.3", "--control", "load", "--json"]),
        json(
            &[
                &["vc", "--alpha-v=-0.33", "--tau", "4.15", "--json"],
                &law[..],
            ]
            .concat(),
        ),
        json(
            &[
                &["basin", "--v0", "0.3", "--starts", "64", "--json"],
                &law[..],
            ]
            .concat(),
        ),
    ];
    assert!(
        all.iter().all(|told| told["schema_version"] == 3),
        "{all:?}"
    );
    let [plan, info, ..] = &all;
    assert_eq!((&plan["cells"], &info["cells"]), (&6.into(), &6.into()));
    assert_eq!(plan["axes"], info["axes"]);
    assert_eq!(info["fixed"]["mu_prime"], -0.3);
    assert_eq!(info["fields"][0]["name"], "n_unstable");
    assert_eq!(info["cells_missing"], 0);
    let size = std::fs::metadata(folder.path().join("small.h5"))
        .unwrap()
        .len() as f64;
    let told = plan["bytes_on_disk"].as_f64().unwrap();
    assert!(told < 2.0 * size && size < 2.0 * told, "{told} for {size}");
}

/// Load control so strong that stick-slip lifts off by chance: no number stands as v_c.
#[test]
fn what_is_not_known_is_not_told_as_a_number() {
    let folder = Folder::new();
    let args = [
        "vc",
        "--friction",
        "coulomb",
        "--mu0",
        "0.5",
        "--alpha-n=-1888.095718047965",
    ];
    let output = folder.run(&[&args[..], &["--tau", "0.08933671843919264"]].concat());
    let text = out(&output);
    let says = "it is not known above which velocity no stick-slip survives, between 0.00";
    assert!(text.starts_with(says), "{text}");
    let vc = text.lines().find(|line| line.starts_with("  vc ")).unwrap();
    assert!(vc.contains("not known, between 0.00"), "{text}");
    assert!(
        !text.contains("v_liftoff") && !text.contains("windows"),
        "{text}"
    );
}

#[test]
fn colours_are_as_asked_for() {
    let folder = Folder::new();
    let coloured = |args: &[&str]| {
        let mut command = folder.command(args);
        err(&program::output(command.env_remove("NO_COLOR"))).contains('\u{1b}')
    };
    assert!(!coloured(&["info", "none.h5"]));
    assert!(coloured(&["--color", "always", "info", "none.h5"]));
    assert!(!coloured(&["info", "none.h5", "--color=never"]));
    assert!(coloured(&["--color=always", "sprint"]));
    assert!(!coloured(&["--color=never", "sprint"]));
}

/// Results stay where they are; remarks and progress are left out, warnings and errors are not.
#[test]
fn quiet_leaves_errors_and_warnings() {
    let folder = Folder::with(&[("small.toml", SMALL), ("case.toml", CASE)]);
    let both = |args: &[&str], quiet: &str, remarks: &str| {
        let loud = folder.run(args);
        assert!(err(&loud).contains(remarks), "{args:?} {}", err(&loud));
        let said = folder.run(&[&[quiet], args].concat());
        assert_eq!(said.status.code(), Some(0), "{args:?}");
        assert_eq!(err(&said), "", "{args:?}");
        assert!(!out(&said).is_empty(), "{args:?}");
    };
    both(
        &["run", "small.toml", "--fresh"],
        "--quiet",
        "crossing curves",
    );
    both(&["simulate", "case.toml"], "-q", "no start is given");
    let cell = ["--map", "small.h5", "--at", "alpha_v=-1", "--at", "tau=1"];
    let point = [&["point"], &cell[..]].concat();
    both(&point, "-q", "the cell at alpha_v = -1");
    std::fs::write(folder.path().join("case.png"), "a photograph").unwrap();
    let warned = folder.run(&["simulate", "-q", "case.toml"]);
    assert!(err(&warned).starts_with("warning: no picture: case.png"));
    expect(
        &folder.run(&["info", "-q", "none.h5"]),
        2,
        "cannot open none.h5",
    );
}

#[test]
fn the_version_has_the_revision() {
    let folder = Folder::new();
    let [short, long] = ["-V", "--version"].map(|flag| out(&folder.run(&[flag])));
    assert_eq!(short, long);
    assert!(
        short.starts_with("slipmap ") && short.contains(" ("),
        "{short}"
    );
}

/// A cell of a map in the place of flags and of a case file: the same numbers, the motion from the
/// cell's start.
#[test]
fn a_cell_of_a_map_is_asked_for_by_its_place() {
    let sweep = "title = \"cells\"\nfields = [\"n_unstable\", \"vc\", \"abscissa\"]\n[axes]\n\
                 alpha_v = [-0.5, -0.33]\ntau = [1, 4.15]\n[fixed]\nv0 = 0.35\n[friction]\n\
                 law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    let folder = Folder::with(&[("cells.toml", sweep)]);
    expect(&folder.run(&["run", "cells.toml"]), 0, "4 cells");
    let cell = [
        "--map",
        "cells.h5",
        "--at",
        "alpha_v=-0.34",
        "--at",
        "tau=4.1",
    ];
    let flags = [
        "--friction",
        "weakening",
        "--mu0",
        "0.5",
        "--v-s",
        "0.5",
        "--alpha-v=-0.33",
        "--tau",
        "4.15",
    ];
    let same = |command: &str, more: &[&str]| {
        let by_cell = folder.run(&[&[command], &cell[..], &["--json"]].concat());
        expect(&by_cell, 0, "the cell at alpha_v = -0.33, tau = 4.15");
        let by_flags = folder.run(&[&[command], &flags[..], more, &["--json"]].concat());
        assert_eq!(out(&by_cell), out(&by_flags));
    };
    same("point", &["--v0", "0.35"]);
    same("vc", &[]);
    let motion = folder.run(&[&["simulate"], &cell[..]].concat());
    expect(&motion, 0, "cells-motion.h5");
    std::fs::copy(folder.path().join("cells.h5"), folder.path().join("a.b.h5")).unwrap();
    let dotted = folder.run(&[
        "simulate",
        "--map",
        "a.b.h5",
        "--at",
        "alpha_v=-0.5",
        "--at",
        "tau=1",
    ]);
    expect(&dotted, 0, "a.b-motion.h5");
    let trace = hdf5::File::open(folder.path().join("a.b-motion.h5")).unwrap();
    let history = trace.attr("history").unwrap();
    let history: hdf5::types::FixedUnicode<256> = history.read_scalar().unwrap();
    let says = "slipmap simulate --at alpha_v=-0.5 --at tau=1 --map a.b.h5";
    assert!(history.ends_with(says), "{history}");
    assert!(
        err(&motion).contains("no start is given: the block begins with"),
        "{}",
        err(&motion)
    );
    places_that_are_none_are_answered(&folder, &cell);
}

/// The start, the table of friction and the phase of switching on come from the map too.
#[test]
fn a_cell_brings_its_start_its_table_and_its_phase() {
    let table = "speeds = [0, 0.1, 0.3, 1, 3]\nmu_k = [0.5, 0.42, 0.3, 0.2, 0.18]\n";
    let moving = format!(
        "fields = [\"outcome\", \"settle_time\"]\n[axes]\nalpha_n = [-7, -3]\ntau = [0.5]\n\
         [fixed]\nv0 = 0.118\n[start]\na0 = 0.3\nx_dot0 = 0.05\n[friction]\nlaw = \"table\"\n{table}"
    );
    let switched = "fields = [\"vc\"]\nprotocol = \"switch-on\"\n[axes]\nalpha_n = [-7]\n\
                    tau = [0.5, 1]\n[start]\nswitch_on_phase = 0.25\n[friction]\n\
                    law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    let folder = Folder::with(&[("moving.toml", &moving), ("switched.toml", switched)]);
    expect(&folder.run(&["run", "moving.toml"]), 0, "2 cells");
    expect(&folder.run(&["run", "switched.toml"]), 0, "2 cells");
    let json =
        |args: &str| -> Value { program::json(&folder.run(&args.split(' ').collect::<Vec<_>>())) };
    let map = hdf5::File::open(folder.path().join("moving.h5")).unwrap();
    let settled = map
        .dataset("settle_time")
        .unwrap()
        .read_raw::<f64>()
        .unwrap();
    let found = json("simulate --json --map moving.h5 --at alpha_n=-7");
    assert_eq!(found["outcome"], "sliding");
    assert_eq!(found["settle_time"].as_f64().unwrap(), settled[0]);
    let by_cell = json("vc --json --map switched.h5 --at tau=1");
    let by_flags = json(
        "vc --json --friction weakening --mu0 0.5 --v-s 0.5 --alpha-n=-7 --tau 1 \
         --protocol switch-on --phase 0.25",
    );
    assert_eq!(by_cell, by_flags);
    assert!(by_cell["vc"].as_f64().unwrap() > 0.1, "{by_cell}");
}

/// In the map `cells.h5`.
fn places_that_are_none_are_answered(folder: &Folder, cell: &[&str]) {
    for (args, says) in [
        (
            &["point", "--map", "cells.h5"][..],
            "--at alpha_v=VALUE is not given",
        ),
        (&["point", "--at", "tau=1"], "--map"),
        (
            &[
                "vc",
                "--map",
                "cells.h5",
                "--at",
                "alpha_v=-0.5",
                "--at",
                "tau=9",
            ],
            "--at tau=9 is outside the axis",
        ),
        (
            &["point", "--map", "cells.h5", "--at", "mass=1"],
            "mass is no axis of this map",
        ),
        (&["simulate"], "no case is given"),
    ] {
        let text = said(folder, args);
        assert!(text.contains(says), "{args:?}: {text}");
    }
    let both = said(folder, &[&["point"], cell, &["--tau", "1"]].concat());
    assert!(
        both.contains("the map says everything but the cell"),
        "{both}"
    );
}

/// `units = "SI"` in the place of a table; another name is answered with those that there are.
#[test]
fn units_have_presets() {
    let folder = Folder::with(&[
        ("si.toml", &format!("units = \"SI\"\n{SMALL}")),
        ("si_units.toml", &format!("units = \"S.I.\"\n{SMALL}")),
    ]);
    expect(&folder.run(&["run", "si.toml"]), 0, "6 cells");
    let file = hdf5::File::open(folder.path().join("si.h5")).unwrap();
    let unit = file.dataset("mass").unwrap().attr("units").unwrap();
    let unit: hdf5::types::FixedUnicode<8> = unit.read_scalar().unwrap();
    assert_eq!(unit.as_str(), "kg");
    let info = out(&folder.run(&["info", "si.h5"]));
    for says in [
        "stiffness    1 N m-1",
        "3 points, 1 to 3 s",
        "mass         1 kg",
    ] {
        assert!(info.contains(says), "{info}");
    }
    let text = said(&folder, &["run", "si_units.toml"]);
    assert!(text.contains("unknown units \"S.I.\""), "{text}");
    assert!(text.contains("known: SI, dimensionless"), "{text}");
}

/// Pictures of maps with best settings mark them, and say what the mark means.
#[test]
fn best_settings_are_marked_in_pictures() {
    let sweep = "fields = [\"abscissa\"]\n[axes]\nalpha_n = { from = -4, to = 1, points = 11 }\n\
                 tau = { from = 0, to = 9, points = 11 }\n[fixed]\nmu_prime = -0.3\n";
    let folder = Folder::with(&[
        ("plain.toml", sweep),
        ("best.toml", &format!("best = true\n{sweep}")),
    ]);
    let drawn = |name: &str| {
        expect(
            &folder.run(&["run", &format!("{name}.toml")]),
            0,
            "121 cells",
        );
        let svg = format!("{name}.svg");
        expect(
            &folder.run(&["plot", &format!("{name}.h5"), "-o", &svg]),
            0,
            &svg,
        );
        std::fs::read_to_string(folder.path().join(svg)).unwrap()
    };
    let [plain, best] = ["plain", "best"].map(drawn);
    assert!(best.contains("fastest decay") && !plain.contains("fastest decay"));
    // A diamond in the plane and one in the legend, each with paper around it.
    let lines = |svg: &str| svg.matches("<polyline").count();
    assert_eq!(lines(&best) - lines(&plain), 4);
}

/// Whether a schema allows null.
fn is_nullable(schema: &Value) -> bool {
    let of = |key: &str| schema[key].as_array().into_iter().flatten();
    schema["type"] == "null"
        || of("type").any(|kind| kind == "null")
        || of("oneOf").chain(of("anyOf")).any(is_nullable)
}

/// Every property of a schema, by its name, and whether it is always there.
fn properties(schema: &Value, found: &mut Vec<(String, Value, bool)>) {
    if let Some(of) = schema["properties"].as_object() {
        let required = schema["required"].as_array().into_iter().flatten();
        let required: Vec<&str> = required.filter_map(Value::as_str).collect();
        let always = |name: &String| required.contains(&name.as_str());
        found.extend(
            of.iter()
                .map(|(name, value)| (name.clone(), value.clone(), always(name))),
        );
    }
    match schema {
        Value::Object(parts) => parts.values().for_each(|part| properties(part, found)),
        Value::Array(parts) => parts.iter().for_each(|part| properties(part, found)),
        _ => {}
    }
}

/// Every key is there, and where it may be null its description says what that means.
#[test]
fn schemas_say_of_each_key_what_null_means() {
    let folder = Folder::new();
    let mut nullable = 0;
    for command in [
        "basin",
        "best",
        "info",
        "margins",
        "measure",
        "plan",
        "point",
        "reproduce",
        "simulate",
        "status",
        "vc",
        "verify",
    ] {
        let schema = program::json(&folder.run(&["schema", command]));
        let mut found = Vec::new();
        properties(&schema, &mut found);
        for (name, property, required) in &found {
            assert!(required, "{command}: {name} may be missing");
            if !is_nullable(property) {
                continue;
            }
            // Of what is an object or null, it stands beside the object.
            let kinds = property["oneOf"].as_array().into_iter().flatten();
            let mut told = kinds.chain([property]).map(|of| &of["description"]);
            let says = |of: &Value| {
                of.as_str()
                    .is_some_and(|of| of.to_lowercase().contains("null"))
            };
            assert!(told.any(says), "{command}: {name}: {property}");
            nullable += 1;
        }
    }
    assert!(nullable > 50, "{nullable}");
}

/// What a command on a measured friction law says on standard error; it succeeds.
fn told(folder: &Folder, args: &[&str]) -> String {
    let output = folder.run(args);
    assert_eq!(output.status.code(), Some(0), "{args:?} {}", err(&output));
    err(&output)
}

const CURVE: &str = "0.001 0.5\n0.1 0.45\n0.5 0.4\n";
const CONSTANT: &str = "where it is taken as constant: the slope 0 is an assumption\n";

/// Beyond the points of a measured friction law its slope is 0 by assumption, which is said once
/// for a file.
#[test]
fn velocities_beyond_a_measured_curve_are_warned_of() {
    let law = "[friction]\nlaw = \"table\"\ntable = \"curve.csv\"\nmu_s = 0.6\n";
    let sweep = format!(
        "[axes]\nv0 = [0.3, 0.9, 2]\ntau = [1, 2]\n[fixed]\nalpha_v = 0.1\n{law}\
         [units]\nforce = \"N\"\nlength = \"m\"\ntime = \"s\"\n"
    );
    let case = format!("horizon = 1.0\n[fixed]\nv0 = 2\n{law}");
    let folder = Folder::with(&[
        ("curve.csv", CURVE),
        ("sweep.toml", &sweep),
        ("case.toml", &case),
    ]);
    let part = "warning: v0 from 0.9 to 2 m s-1 lies beyond the curve (0.001 to 0.5 m s-1)";
    let part = format!("{part}, {CONSTANT}");
    assert!(told(&folder, &["plan", "sweep.toml"]).contains(&part));
    assert!(told(&folder, &["run", "-q", "sweep.toml"]).starts_with(&part));
    let cell = ["--map", "sweep.h5", "--at", "tau=1", "--at", "v0=2"];
    let in_units = told(&folder, &[&["point"], &cell[..]].concat());
    assert!(in_units.contains("v0 = 2 m s-1 lies beyond"), "{in_units}");
    let one = format!("warning: v0 = 2 lies beyond the curve (0.001 to 0.5), {CONSTANT}");
    for command in ["plan", "simulate"] {
        let said = told(&folder, &[command, "case.toml"]);
        assert_eq!(said.matches(&one).count(), 1, "{said}");
    }
}

/// The same of flags; and a static coefficient that nobody gave is told where it matters.
#[test]
fn assumptions_on_measured_friction_are_told() {
    let folder = Folder::with(&[("curve.csv", CURVE)]);
    let of =
        |what: &str| format!("warning: {what} lies beyond the curve (0.001 to 0.5), {CONSTANT}");
    let (one, of_vc) = (of("v0 = 2"), of("v_c = 3.28022"));
    let remark = "--mu-s is not given: mu_s is taken as 1; ";
    let table = ["--friction", "table", "--table", "curve.csv"];
    let flags = [&table[..], &["--alpha-v", "0.1", "--tau", "1", "--v0"]].concat();
    let best = [&table[..], &["--control", "load", "--v0"]].concat();
    let basin = [&["--starts", "64"], &flags[..]].concat();
    for (command, flags, warning, unsaid) in [
        ("point", &flags, &one, false),
        ("margins", &flags, &one, false),
        ("best", &best, &one, true),
        ("simulate", &flags, &one, true),
        ("basin", &basin, &one, true),
        ("vc", &flags, &of_vc, true),
    ] {
        let args = [&[command], &flags[..], &["2"]].concat();
        let said = told(&folder, &args);
        assert_eq!(said.matches(warning.as_str()).count(), 1, "{said}");
        assert_eq!(said.contains(remark), unsaid, "{command}: {said}");
        let quiet = told(&folder, &[&args[..], &["-q"]].concat());
        assert!(quiet.contains(warning) && !quiet.contains(remark));
        let given = told(&folder, &[&args[..], &["--mu-s", "1"]].concat());
        assert!(!given.contains(remark), "{command}: {given}");
    }
    let inside = told(&folder, &[&["point"], &flags[..], &["0.5"]].concat());
    assert!(!inside.contains("lies beyond"), "{inside}");
}

/// A block that goes faster than the last point of the law, or slower than the first, is warned of,
/// wherever it is pulled; one that stays between them is not.
#[test]
fn blocks_that_leave_a_measured_curve_are_warned_of() {
    let from_rest = "0 0.5\n0.1 0.45\n0.5 0.4\n";
    let folder = Folder::with(&[("curve.csv", CURVE), ("rest.csv", from_rest)]);
    let said = |curve: &str, words: &[&str]| {
        let law = ["--friction", "table", "--table", curve, "--mu-s", "1"];
        told(&folder, &[words, &law[..]].concat())
    };
    let simulate = |curve: &str, v0: &str| said(curve, &["simulate", "--fresh", "--v0", v0]);
    let stick_slip = simulate("rest.csv", "0.1");
    let up = "warning: the speed of the block up to 0.";
    let ends = format!(" lies beyond the curve (0 to 0.5), {CONSTANT}");
    assert!(
        stick_slip.contains(up) && stick_slip.ends_with(&ends),
        "{stick_slip}"
    );
    let both = simulate("curve.csv", "0.1");
    assert!(
        both.contains("warning: the speed of the block down to 0 and up to 0."),
        "{both}"
    );
    let starts = ["basin", "--v0", "0.1", "--starts", "64"];
    let basin = said("rest.csv", &starts);
    assert!(
        basin.starts_with("warning: the speed of the block up to 1.") && basin.ends_with(&ends),
        "{basin}"
    );
}

/// Where the unstable roots are counted, sliding is unstable beyond doubt.
#[test]
fn no_margins_are_told_with_the_roots_that_forbid_them() {
    let folder = Folder::with(&[]);
    let told = |args: &[&str]| {
        let text = out(&folder.run(args));
        let (inputs, rest) = text.split_once('\n').unwrap();
        assert!(inputs.starts_with("inputs: mu_prime = "), "{text}");
        rest.to_owned()
    };
    let unstable = ["margins", "--mu-prime=-0.5", "--alpha-n=-2", "--tau=5"];
    assert_eq!(
        told(&unstable),
        "continuous sliding is unstable (4 roots): no margins\n"
    );
    assert_eq!(
        told(&[&unstable[..], &["--decay", "0.2"]].concat()),
        "continuous sliding is not left of -0.2 with all its roots (5 roots right of it): no \
         margins\n"
    );
    let marginal = told(&["margins", "--mu-prime=0"]);
    assert!(marginal.contains("is not known to be stable"), "{marginal}");
    let best = told(&["best", "--mu-prime=-3"]);
    assert!(best.contains("is unstable (2 roots): no margins"), "{best}");
    let state = "margins --friction rate-and-state --mu0 0.6 --v-star 1 --direct-effect 0.01 \
                 --evolution-effect 0.02 --slip-distance 1 --v0 1";
    let text = said(&folder, &state.split_whitespace().collect::<Vec<_>>());
    assert!(
        text.contains("slipmap point gives its delay margin"),
        "{text}"
    );
}

/// Every mistake is shown where it is, and long lines only near it.
#[test]
fn mistakes_have_places() {
    let law = "[friction]\nlaw = \"weakening\"\nv_s = 0.5\n";
    let case = |fixed: &str| format!("{law}mu0 = 0.5\n[fixed]\nv0 = 0.1\n{fixed}");
    let long = format!("a = [{}]\n[axes]\ntau = [1]\n", "1, ".repeat(30_000));
    let folder = Folder::with(&[
        (
            "axis.toml",
            &format!("{law}[fixed]\nv0 = 1\n[axes]\nmu0 = [0.5, 1.5]\ntau = [1]\n"),
        ),
        (
            "mu_s.toml",
            &format!("{law}mu0 = 0.5\nmu_s = 0.3\n[fixed]\nv0 = 1\n[axes]\ntau = [1]\n"),
        ),
        ("lag.toml", &case("load_lag = 0.3\n")),
        (
            "trace.toml",
            &case("[trace]\nuntil = 10.0\ninterval = 1e-9\n"),
        ),
        (
            "vc.toml",
            "fields = [\"vc\"]\n[axes]\nmu_prime = [-0.3]\ntau = [1]\n",
        ),
        (
            "both.toml",
            "fields = [\"vc\", \"n_unstable\"]\n[axes]\nmu_prime = [-0.3]\ntau = [1]\n",
        ),
        (
            "points.toml",
            "[axes]\ntau = { from = 0, to = 1, points = 1e9 }\n",
        ),
        ("long.toml", &long),
    ]);
    for (args, says) in [
        (&["plan", "axis.toml"][..], "axis.toml:7:1"),
        (&["plan", "axis.toml"], "at most mu_s = 1 (not given: the"),
        (&["plan", "mu_s.toml"], "mu_s.toml:5:1"),
        (&["plan", "mu_s.toml"], "at most mu_s, else"),
        (&["simulate", "lag.toml"], "lag.toml:7:1"),
        (&["simulate", "trace.toml"], "trace.toml:9:12"),
        (&["plan", "trace.toml"], "trace.toml:9:12"),
        (&["plan", "vc.toml"], "give [friction] instead of"),
        (&["plan", "both.toml"], "give [friction] and v0 instead of"),
        (&["plan", "points.toml"], "write 1000000000"),
        (&["plan", "long.toml"], "long.toml:1:1"),
        (&["point"], "or --friction with --v0"),
        (
            &["best", "--friction", "coulomb", "--mu0", "1.5", "--v0", "1"],
            "at most mu_s = 1 (not given: the default),",
        ),
    ] {
        let text = said(&folder, args);
        assert!(text.contains(says), "{args:?}: {text}");
        assert!(text.chars().count() < 1000, "{args:?}: {text}");
    }
}

/// Very small and very large numbers have powers of ten, and v_c has the digits that are known.
#[test]
fn numbers_are_short() {
    let folder = Folder::with(&[("tiny.toml", &SMALL.replace("tau = [1,", "tau = [1e-300,"))]);
    let point = folder.run(&["point", "--mu-prime=-0.3", "--alpha-v=-0.1", "--tau=1e-300"]);
    expect(&point, 0, "tau = 1e-300");
    expect(
        &folder.run(&["plan", "tiny.toml"]),
        0,
        "3 points, 1e-300 to 3",
    );
    let vc = "vc --friction weakening --mu0 0.5 --v-s 0.5 --alpha-v=-0.33 --tau 4.15";
    let vc: Vec<&str> = vc.split_whitespace().collect();
    let told = folder.run(&vc);
    for says in [
        "above 0.344467 no stick-slip survives",
        "vc 0.344467",
        "windows 0 < v0 <= 0.344467",
    ] {
        expect(&told, 0, says);
    }
    let json = program::json(&folder.run(&[&vc[..], &["--json"]].concat()));
    assert!(json["vc"].to_string().len() > 12, "{json}");
    let digits = |n: &str| out(&folder.run(&[&vc[..], &["--digits", n]].concat()));
    assert!(digits("2").starts_with("above 0.34 no stick-slip survives\n"));
    let all = format!("above {} no stick-slip survives\n", json["vc"]);
    assert!(digits("17").starts_with(&all), "{all}");
    let both = folder.run(&[&vc[..], &["--digits", "3", "--json"]].concat());
    expect(&both, 2, "cannot be used with '--json'");
}
