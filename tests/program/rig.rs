//! From a rig to a setting: a measured friction curve in a file, flags with units, and what one
//! command hands to the next. The same curve in sweep and case files.

#![cfg(unix)]

use serde_json::Value;

use crate::program::{self, Folder, err, expect, out};

const CURVE: &str =
    "speed (m/s), mu_k\n0, 0.5\n0.05, 0.45\n0.1, 0.41\n0.2, 0.36\n0.5, 0.32\n1, 0.3\n";
const RIG: [&str; 12] = [
    "--mass=2",
    "--stiffness=500",
    "--normal-load=30",
    "--friction",
    "table",
    "--table",
    "curve.csv",
    "--mu-s=0.9",
    "--units",
    "SI",
    "--alpha-v=0",
    "--v0=0.1",
];

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(args);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    program::json(&output)
}

/// Numbers and units behind a name of a text.
#[track_caller]
fn assert_row(text: &str, name: &str, unit: &str) {
    let row = text
        .lines()
        .find(|line| line.split_whitespace().next() == Some(name));
    let row = row.unwrap_or_else(|| panic!("no {name} in\n{text}"));
    assert!(row.ends_with(&format!(" {unit}")), "{row:?} has no {unit}");
}

#[test]
fn from_a_rig_to_a_setting() {
    let folder = Folder::with(&[("curve.csv", CURVE)]);
    // The best setting, saved.
    let best = [
        &["best", "--control", "load", "--save", "setting.toml"],
        &RIG[..],
    ]
    .concat();
    let told = out(&folder.run(&best));
    assert!(told.ends_with("setting.toml\n"), "{told}");
    for (name, unit) in [
        ("alpha_n", "N m-1"),
        ("tau", "s"),
        ("abscissa", "s-1"),
        ("frequency", "rad s-1"),
        ("mu_prime", "m-1 s"),
    ] {
        assert_row(&told, name, unit);
    }
    let found = json(&folder, &[&best[..], &["--json"]].concat());
    let (gain, tau) = (&found["best"]["alpha"], &found["best"]["tau"]);
    // The curve is in the setting: nothing else is needed.
    std::fs::remove_file(folder.path().join("curve.csv")).unwrap();
    let of_setting = ["--setting", "setting.toml"];
    let point = json(&folder, &[&["point", "--json"], &of_setting[..]].concat());
    assert_eq!((&point["alpha_n"], &point["tau"]), (gain, tau));
    // A multiple root is known to fewer digits than a simple one.
    let [here, there] = [&point["abscissa"], &found["best"]["abscissa"]];
    let (here, there) = (here.as_f64().unwrap(), there.as_f64().unwrap());
    assert!((here - there).abs() < 1e-3 * there.abs(), "{point}");
    let drawn = folder.run(&[&["point", "--plot", "point.svg"], &of_setting[..]].concat());
    assert_row(&out(&drawn), "delay_margin", "s");
    let svg = std::fs::read_to_string(folder.path().join("point.svg")).unwrap();
    assert!(svg.contains("(rad s⁻¹)"), "{svg}");
    let vc = [&["vc"], &of_setting[..]].concat();
    assert_row(&out(&folder.run(&vc)), "vc", "m s-1");
    let vc = json(&folder, &[&vc[..], &["--json"]].concat());
    let flags = [format!("--alpha-n={gain}"), format!("--tau={tau}")];
    std::fs::write(folder.path().join("curve.csv"), CURVE).unwrap();
    // Its pulling velocity is left aside.
    let rig = RIG.iter().copied();
    let rig: Vec<&str> = rig.chain(flags.iter().map(String::as_str)).collect();
    // JSON is read to the last bit but one.
    let by_flags = json(&folder, &[&["vc", "--json"], &rig[..]].concat());
    let [here, there] = [&vc["vc"], &by_flags["vc"]].map(|vc| vc.as_f64().unwrap());
    assert!(
        here > 0.0 && (here - there).abs() < 1e-9 * there,
        "{by_flags}"
    );
    // A setting is a case file, and the motion there settles within some relaxation times.
    let motion = folder.run(&["simulate", "setting.toml", "--picture", "motion.svg"]);
    expect(&motion, 0, "the block comes to slide continuously");
    for (name, unit) in [("settle_time", "s"), ("last_release", "s"), ("n_min", "N")] {
        assert_row(&out(&motion), name, unit);
    }
    let svg = std::fs::read_to_string(folder.path().join("motion.svg")).unwrap();
    assert!(svg.contains("(m s⁻¹)"), "{svg}");
}

/// The same rig, by flags in every command; what it says is what the file of the setting gives.
#[test]
fn flags_and_files_say_the_same() {
    let folder = Folder::with(&[("curve.csv", CURVE)]);
    let control = ["--alpha-n=-600", "--tau=0.03"];
    let flags = [&RIG[..], &control].concat();
    let by_flags = json(&folder, &[&["point", "--json"], &flags[..]].concat());
    let case = "[fixed]\nmass = 2\nstiffness = 500\nnormal_load = 30\nv0 = 0.1\nalpha_n = -600\n\
                tau = 0.03\n[friction]\nlaw = \"table\"\ntable = \"curve.csv\"\nmu_s = 0.9\n";
    std::fs::write(
        folder.path().join("case.toml"),
        format!("units = \"SI\"\n{case}"),
    )
    .unwrap();
    let by_file = json(&folder, &["point", "--json", "--setting", "case.toml"]);
    assert_eq!(by_flags, by_file);
    let svg = ["--picture", "motion.svg", "-o", "motion.h5", "--fresh"];
    let motion = |args: &[&str]| out(&folder.run(&[&["simulate"], args, &svg[..]].concat()));
    let (by_flags, by_file) = (motion(&flags), motion(&["case.toml"]));
    assert_row(&by_flags, "peak_force", "N");
    assert_eq!(by_flags, by_file);
    for (args, says) in [
        (&["simulate"][..], "no case is given"),
        (
            &["simulate", "case.toml", "--v0=1"],
            "CASE.toml is given with other flags",
        ),
        (
            &["point", "--setting", "case.toml", "--v0=1"],
            "--setting is given with other flags",
        ),
        (
            &["point", "--setting", "none.toml"],
            "cannot read none.toml",
        ),
        (
            &["vc", "--setting", "case.toml", "--mass=1"],
            "--setting is given with other flags",
        ),
        (
            &["point", "--mu-prime=1", "--units", "N,mm"],
            "the units of force, length and time",
        ),
    ] {
        expect(&folder.run(args), 2, says);
    }
}

/// Only settings by slipmap are replaced.
#[test]
fn what_slipmap_did_not_write_stays() {
    let folder = Folder::with(&[("mine.toml", "years = \"of work\"\n")]);
    let best = ["best", "--mu-prime=-0.3", "--tau-to=3", "--save"];
    let save = |name| folder.run(&[&best[..], &[name]].concat());
    expect(&save("mine.toml"), 2, "is there and not by slipmap");
    expect(&save("mine.json"), 2, "no name for a setting");
    expect(&save("no/setting.toml"), 1, "no/setting.toml");
    assert_eq!(folder.files(), ["mine.toml"]);
    expect(&save("new.toml"), 0, "new.toml");
    expect(&save("new.toml"), 0, "new.toml");
    let mine = std::fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    assert_eq!(mine, "years = \"of work\"\n");
}

/// The points of a file are in the map: it is verified without that file, and is the map of a sweep
/// that says them itself.
#[test]
fn a_sweep_takes_its_curve_from_a_file() {
    let sweep = "fields = [\"n_unstable\", \"abscissa\"]\n[axes]\nalpha_n = [-700, -600]\n\
                 tau = [0.02, 0.03]\n[fixed]\nv0 = 0.1\nmass = 2\nstiffness = 500\n\
                 normal_load = 30\n[friction]\nlaw = \"table\"\nmu_s = 0.55\n";
    let named = format!("{sweep}table = \"curve.csv\"\n");
    let listed = format!(
        "{sweep}speeds = [0, 0.05, 0.1, 0.2, 0.5, 1]\nmu_k = [0.5, 0.45, 0.41, 0.36, 0.32, 0.3]\n"
    );
    let folder = Folder::with(&[("listed.toml", &listed)]);
    std::fs::create_dir(folder.path().join("rig")).unwrap();
    let inside = |name: &str, text: &str| {
        std::fs::write(folder.path().join("rig").join(name), text).unwrap();
    };
    inside("named.toml", &named);
    inside("curve.csv", CURVE);
    expect(&folder.run(&["run", "rig/named.toml"]), 0, "4 cells");
    std::fs::remove_file(folder.path().join("rig/curve.csv")).unwrap();
    expect(&folder.run(&["verify", "named.h5"]), 0, "agree");
    expect(
        &folder.run(&["run", "listed.toml", "-o", "named.h5"]),
        0,
        "already complete",
    );
    // From standard input the file is looked for in the folder that one is in.
    std::fs::write(folder.path().join("curve.csv"), CURVE).unwrap();
    let mut plan = folder.command(&["plan", "-"]);
    plan.stdin(std::fs::File::open(folder.path().join("rig/named.toml")).unwrap());
    expect(&plan.output().unwrap(), 0, "cells 4");
    // Mistakes: at the name, or in the file.
    let refused = |says: &str| {
        let output = folder.run(&["plan", "rig/named.toml"]);
        expect(&output, 2, says);
        let place = named
            .lines()
            .position(|line| line.starts_with("table"))
            .unwrap()
            + 1;
        let at = format!("rig/named.toml:{place}:");
        assert!(err(&output).contains(&at), "{}", err(&output));
    };
    refused("friction.table: cannot read curve.csv: No such file");
    inside("curve.csv", "speed, mu\n0, 0.5\n0.1, -0.4\n");
    let output = folder.run(&["plan", "rig/named.toml"]);
    expect(
        &output,
        2,
        "line 3, column 2 (mu): friction is greater than 0",
    );
    assert!(err(&output).contains("[curve.csv:3:6]"), "{}", err(&output));
    std::fs::remove_file(folder.path().join("rig/curve.csv")).unwrap();
    let pipe = folder.path().join("rig/curve.csv");
    let made = std::process::Command::new("mkfifo").arg(pipe).status();
    assert!(made.unwrap().success());
    refused("it is no regular file");
}

/// A delay that nothing acts on is said once, whatever the command.
#[test]
fn a_delay_without_control_is_warned_of() {
    let law = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    let sweep = "[axes]\nmu_prime = [-0.1, 0.1]\ntau = [1, 2, 3]\n";
    let folder = Folder::with(&[
        ("sweep.toml", sweep),
        (
            "one.toml",
            "[axes]\nmu_prime = [-0.1, 0.1]\n[fixed]\ntau = 3\n",
        ),
        (
            "controlled.toml",
            &format!("{sweep}[fixed]\nalpha_v = 0.1\n"),
        ),
        ("case.toml", &format!("{law}[fixed]\nv0 = 0.1\ntau = 2\n")),
    ]);
    let warning = "warning: tau has no effect: both gains, alpha_v and alpha_n, are 0";
    let said = |args: &[&str]| {
        let output = folder.run(args);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        err(&output).matches(warning).count()
    };
    let flags = ["--friction", "weakening", "--mu0=0.5", "--v-s=0.5"];
    for (args, times) in [
        (&["plan", "sweep.toml"][..], 1),
        (&["run", "sweep.toml"], 1),
        (&["plan", "one.toml"], 1),
        (&["plan", "controlled.toml"], 0),
        (&["simulate", "case.toml", "--picture", "case.svg"], 1),
        (&["point", "--mu-prime=0.1", "--tau=2"], 1),
        (&["point", "--mu-prime=0.1", "--alpha-v=0", "--tau=2"], 1),
        (&["point", "--mu-prime=0.1", "--tau=0"], 0),
        (&["point", "--mu-prime=0.1"], 0),
        (&["point", "--mu-prime=0.1", "--alpha-v=0.1", "--tau=2"], 0),
        (
            &[
                "point",
                "--map",
                "sweep.h5",
                "--at=mu_prime=0.1",
                "--at=tau=2",
            ],
            0,
        ),
    ] {
        assert_eq!(said(args), times, "{args:?}");
    }
    let simulate = ["simulate", "--v0=0.1", "--tau=2", "--picture", "m.svg"];
    assert_eq!(said(&[&simulate[..], &flags].concat()), 1);
}

/// Where nothing is stable there is no best setting to save; without a law a setting is no case.
#[test]
fn only_what_holds_is_saved() {
    let folder = Folder::new();
    let best = |more: &[&str]| folder.run(&[&["best", "--save", "best.toml"], more].concat());
    let nothing = best(&["--mu-prime=-3", "--tau-from=5", "--tau-to=6"]);
    expect(
        &nothing,
        1,
        "best.toml is not written: no setting is stable",
    );
    assert!(folder.files().is_empty());
    expect(&best(&["--mu-prime=-0.1"]), 0, "best.toml");
    let read = || std::fs::read_to_string(folder.path().join("best.toml")).unwrap();
    assert!(!read().contains("simulate"), "{}", read());
    let law = [
        "--friction",
        "weakening",
        "--mu0",
        "0.5",
        "--v-s",
        "0.5",
        "--v0",
        "0.35",
    ];
    expect(&best(&law), 0, "best.toml");
    assert!(
        read().contains("basin and simulate take it with --setting"),
        "{}",
        read()
    );
}

/// What physical units there are stands behind every number that people are told.
#[test]
fn units_stand_behind_numbers() {
    let sweep = "units = \"SI\"\nbest = true\nfields = [\"n_unstable\"]\n[axes]\nalpha_n = { from = -4, \
                 to = 1, points = 5 }\ntau = { from = 0, to = 9, points = 5 }\n[fixed]\nmu_prime = -0.3\n";
    let case = "units = \"SI\"\n[fixed]\nv0 = 0.35\nalpha_v = -0.33\ntau = 4.15\n[friction]\n\
                law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    let folder = Folder::with(&[("map.toml", sweep), ("case.toml", case)]);
    expect(&folder.run(&["run", "map.toml"]), 0, "25 cells");
    let info = out(&folder.run(&["info", "map.h5"]));
    let best = info.lines().find(|line| line.starts_with("best")).unwrap();
    assert!(best.ends_with(" s"), "{best}");
    let cell = [
        "point",
        "--map",
        "map.h5",
        "--at",
        "alpha_n=-4",
        "--at",
        "tau=9",
    ];
    expect(
        &folder.run(&cell),
        0,
        "the cell at alpha_n = -4 N m-1, tau = 9 s",
    );
    let motion = folder.run(&["simulate", "case.toml"]);
    expect(&motion, 0, "begins with x_dot0 = 0.3535 m s-1");
    let info = out(&folder.run(&["info", "case.h5"]));
    for (name, unit) in [("settle_time", "s"), ("n_min", "N"), ("decided", "s")] {
        assert_row(&info, name, unit);
    }
}
