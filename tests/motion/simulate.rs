//! `slipmap simulate`: what it says, what it writes, and the events of the letter's Fig. 3.

use crate::program::{self, Folder, err, expect, out};
use serde_json::Value;

const FIG3A: &str = include_str!("../../sweeps/fig3a.toml");
const FIG3B: &str = include_str!("../../sweeps/fig3b.toml");
const PLAIN: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n[fixed]\nv0 = 0.1\n";

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(&[&["simulate", "--json"], args].concat());
    assert_eq!(err(&output), "");
    assert_eq!(output.status.code(), Some(0));
    program::json(&output)
}

/// (t, a) of all events of a kind.
fn events(value: &Value, kind: &str) -> Vec<(f64, f64)> {
    let events = value["events"].as_array().unwrap().iter();
    let number = |event: &Value, name: &str| event[name].as_f64().unwrap();
    events
        .filter(|event| event["kind"] == kind)
        .map(|event| (number(event, "t"), number(event, "a")))
        .collect()
}

#[test]
fn figure_3_has_its_events() {
    let folder = Folder::with(&[("fig3a.toml", FIG3A), ("fig3b.toml", FIG3B)]);
    for (name, slip, stick, last, at) in [
        ("fig3a.toml", 3.97549563, 4.92001175, 97.029009396, 1.0),
        ("fig3b.toml", 3.44600138, 15.85555061, 76.277483031, 0.5),
    ] {
        let value = json(&folder, &[name]);
        let near = |found: f64, expected: f64| {
            assert!(
                (found - expected).abs() < 1e-8,
                "{name}: {found} {expected}"
            );
        };
        assert_eq!(value["outcome"], "sliding");
        assert!(value["period"].is_null() && value["settle_time"].as_f64().unwrap() > 5.0);
        assert_eq!(events(&value, "switch_on")[0].0, 70.0);
        let (releases, stops) = (events(&value, "release"), events(&value, "stick"));
        let before = |at: &&(f64, f64)| at.0 < 62.0;
        let from = releases.iter().rfind(before).unwrap().0;
        let to = stops.iter().find(|stop| stop.0 > from).unwrap().0;
        near(to - from, slip);
        let stopped = stops.iter().rfind(|stop| stop.0 < from).unwrap().0;
        near(from - stopped, stick);
        let (t, a) = releases[releases.len() - 1];
        near(t, last);
        near(a, at);
        near(value["last_release"].as_f64().unwrap(), t - 70.0);
    }
}

/// Events, `settle_time`, `n_min` and `peak_force` of the snapshot are those of Runge–Kutta steps
/// of 0.001, of a program of its own: to all digits shown, to 0.001, 3e-12 and 2e-8.
#[test]
fn the_summary_for_people() {
    let folder = Folder::with(&[("fig3b.toml", FIG3B)]);
    let output = folder.run(&["simulate", "fig3b.toml"]);
    assert_eq!(err(&output), "");
    insta::assert_snapshot!("simulate", out(&output));
    assert_eq!(folder.files(), ["fig3b.h5", "fig3b.png", "fig3b.toml"]);
}

#[test]
fn every_outcome_is_told() {
    let start = "[start]\nx_dot0 = 0.101\n";
    let lift_off = "alpha_n = -10.0\ntau = 0.9\n[start]\nx_dot0 = 0.5\n";
    let folder = Folder::with(&[
        ("free.toml", &format!("{PLAIN}{start}")),
        (
            "never.toml",
            &format!("switch_on = false\n{PLAIN}alpha_v = 1\ntau = 1\n{start}"),
        ),
        (
            "lift.toml",
            &format!("{}{lift_off}", PLAIN.replace("0.1", "1.5")),
        ),
        (
            "short.toml",
            &format!("horizon = 0.5\n{PLAIN}[start]\na0 = 0.2\n"),
        ),
    ]);
    let free = json(&folder, &["free.toml"]);
    let never = json(&folder, &["never.toml"]);
    assert_eq!(free["outcome"], "stick-slip");
    assert!((free["slip_time"].as_f64().unwrap() - 3.44600138).abs() < 1e-8);
    assert_eq!(free["events"], never["events"]);
    let lift = json(&folder, &["lift.toml"]);
    assert_eq!(lift["outcome"], "lift-off");
    assert_eq!(events(&lift, "liftoff").len(), 1);
    assert!(lift["n_min"].as_f64().unwrap() <= 1e-9);
    expect(
        &folder.run(&["simulate", "lift.toml"]),
        0,
        "the block lifts off",
    );
    let short = json(&folder, &["short.toml"]);
    assert_eq!(short["outcome"], "undecided");
    let said = folder.run(&["simulate", "short.toml"]);
    expect(&said, 0, "undecided at the horizon, t = 0.5");
}

#[test]
fn mistakes_in_case_files_are_shown_in_place() {
    let folder = Folder::new();
    for (text, says) in [
        ("[fixed]\nv0 = 1\n", "a case needs a friction law"),
        (&*PLAIN.replace("v0", "v1"), "unknown key `fixed.v1`"),
        (
            &PLAIN.replace("0.1", "nan"),
            "fixed.v0: expected a finite number",
        ),
        (
            &PLAIN.replace("0.1", "-0.1"),
            "v0 = -0.1 is outside its range",
        ),
        (&PLAIN.replace("= 0.5", "= 2.0"), "mu"),
        (&format!("{PLAIN}alpha_n = 1.0\n"), "tau is not given"),
        (
            &format!("{PLAIN}tau = 0\nalpha_n = 1\n"),
            "tau = 0 is outside its range",
        ),
        (
            &format!("{PLAIN}[trace]\ninterval = 1e-9\n"),
            "more than 2000000 samples",
        ),
        ("[axes]\ntau = [1]\n", "`slipmap run` takes it"),
    ] {
        std::fs::write(folder.path().join("case.toml"), text).unwrap();
        expect(&folder.run(&["simulate", "case.toml"]), 2, says);
    }
    std::fs::write(folder.path().join("case.toml"), "[trace]\nsteps = 3\n").unwrap();
    let output = folder.run(&["simulate", "case.toml"]);
    insta::assert_snapshot!("unknown_trace_key", err(&output));
    assert_eq!(folder.files(), ["case.toml"]);
    expect(
        &folder.run(&["simulate", "none.toml"]),
        2,
        "cannot read none.toml",
    );
}

/// The start and the end of a motion as flags, beside a setting from a file or from flags, are those
/// of the keys of a case file.
#[test]
fn flags_of_start_and_end_are_the_keys_of_a_case() {
    let setting = format!("{PLAIN}alpha_v = -0.3\ntau = 4.0\n");
    let keys = "[start]\nx_dot0 = 0.0\na0 = -0.25\n[trace]\nuntil = 30.0\n";
    let case = format!("switch_on = 11.5\n{setting}{keys}");
    let folder = Folder::with(&[("setting.toml", &setting), ("case.toml", &case)]);
    let ends = [
        "--x-dot0",
        "0",
        "--a0=-0.25",
        "--switch-on",
        "11.5",
        "--until",
        "30",
    ];
    let by_file = [&["--setting", "setting.toml"], &ends[..]].concat();
    let law = [
        "--friction",
        "weakening",
        "--mu0",
        "0.5",
        "--v-s",
        "0.5",
        "--v0",
        "0.1",
    ];
    let by_flags = [&law[..], &["--alpha-v=-0.3", "--tau", "4"], &ends[..]].concat();
    let told = |args: &[&str]| {
        let mut value = json(&folder, args);
        value.as_object_mut().unwrap().remove("trace").unwrap();
        value
    };
    let known = told(&["case.toml"]);
    assert_eq!(events(&known, "switch_on")[0].0, 11.5);
    let [one, other] = [by_file, by_flags].map(|args| told(&args));
    assert_eq!((&one, &other), (&known, &known));
    let files = ["case.h5", "setting.h5", "motion.h5"].map(|name| folder.path().join(name));
    let samples = files.map(|path| {
        let file = hdf5::File::open(path).unwrap();
        ["t", "x_dot", "a"].map(|name| file.dataset(name).unwrap().read_raw::<f64>().unwrap())
    });
    assert!(samples[0] == samples[1] && samples[0] == samples[2]);
    assert_eq!(samples[0][0].last(), Some(&30.0));
    let never = told(&[
        "--setting",
        "setting.toml",
        "--switch-on",
        "false",
        "--x-dot0=0.1",
        "--fresh",
    ]);
    assert!(events(&never, "switch_on").is_empty());
}

/// Corners of v0 as flags are those of the keys, in the JSON of the case too; mistakes are told.
#[test]
fn a_programme_by_flags_is_that_of_a_case() {
    let setting = format!("{PLAIN}alpha_v = -0.3\ntau = 4.0\n");
    let corners = "[[programme]]\nat = 9.0\nv0 = 0.25\n\
                   [[programme]]\nat = 12.5\nv0 = 0.2\nramp = true\n";
    let case = format!("{setting}[start]\nx_dot0 = 0.0\n[trace]\nuntil = 30.0\n{corners}");
    let backwards = case.replace("12.5", "8.5");
    let folder = Folder::with(&[
        ("setting.toml", &setting),
        ("case.toml", &case),
        ("backwards.toml", &backwards),
    ]);
    let file = ["--setting", "setting.toml"];
    let flags = [
        &file[..],
        &["--x-dot0", "0", "--until", "30", "--programme"],
    ]
    .concat();
    let corners = ["at=9,v0=0.25", "--programme", "at=12.5, v0=0.2, ramp"];
    let told = |args: &[&str]| {
        let mut value = json(&folder, args);
        value.as_object_mut().unwrap().remove("trace").unwrap();
        value
    };
    let [one, other] = [told(&["case.toml"]), told(&[&flags[..], &corners].concat())];
    assert_eq!(one, other);
    let times: Vec<f64> = events(&one, "programme").iter().map(|e| e.0).collect();
    assert_eq!(times, [9.0, 12.5]);
    let facts = &one["inputs"]["case"]["programme"];
    assert_eq!(
        (&facts[1]["at"], &facts[1]["ramp"]),
        (&12.5.into(), &true.into())
    );
    // v jumps at the first corner and bends at the second one.
    let file = hdf5::File::open(folder.path().join("case.h5")).unwrap();
    let [t, v] = ["t", "v"].map(|name| file.dataset(name).unwrap().read_raw::<f64>().unwrap());
    let at = t.iter().position(|t| *t == 9.0).unwrap();
    assert!((v[at] - v[at - 1] - 0.15).abs() < 1e-9 && t[at] - t[at - 1] < 1e-9);
    let at = t.iter().position(|t| *t == 12.5).unwrap();
    assert!((v[at] - v[at - 1]).abs() < 1e-9);
    expect(
        &folder.run(&["simulate", "backwards.toml"]),
        2,
        "programme[1].at: 8.5 is outside its range: later than the entry before",
    );
    for (corner, says) in [
        ("at=9", "expected at=T,v0=V"),
        ("at=0,v0=1", "programme[0].at: 0 is outside its range"),
    ] {
        let args = [
            "simulate",
            "--setting",
            "setting.toml",
            "--programme",
            corner,
        ];
        expect(&folder.run(&args), 2, says);
    }
}

/// Mistakes in these flags are told as those of the keys, and none of them stands beside a case.
#[test]
fn mistakes_in_flags_of_start_and_end() {
    let setting = format!("{PLAIN}alpha_v = -0.3\ntau = 4.0\n");
    let lawless = "[fixed]\nmu_prime = -0.3\ntau = 1\n";
    let files = [
        ("setting.toml", &*setting),
        ("case.toml", PLAIN),
        ("slope.toml", lawless),
    ];
    let folder = Folder::with(&files);
    let mut shown = String::new();
    for words in [
        "--setting setting.toml --switch-on=-1",
        "--setting setting.toml --switch-on true",
        "--setting setting.toml --switch-on nan",
        "--setting setting.toml --x-dot0 1e300",
        "--setting setting.toml --until 0",
        "--setting setting.toml --a0 none",
        "--setting setting.toml --tau 3",
        "--setting setting.toml --map map.h5",
        "--setting case.toml case.toml",
        "--setting slope.toml",
        "case.toml --until 3",
        "--until 3",
    ] {
        let args: Vec<&str> = ["simulate"].into_iter().chain(words.split(' ')).collect();
        let said = folder.run(&args);
        assert_eq!((said.status.code(), &*out(&said)), (Some(2), ""), "{words}");
        shown += &format!("simulate {words}\n{}\n", err(&said));
    }
    insta::assert_snapshot!("start_and_end", shown);
}

#[test]
fn only_traces_are_replaced() {
    let folder = Folder::with(&[
        ("a.toml", FIG3B),
        ("b.toml", &FIG3B.replace("100.0", "90.0")),
        ("thesis.h5", "years of work"),
        (
            "small.toml",
            "[axes]\nmu_prime = [-0.1]\ntau = [1.0, 2.0]\n",
        ),
    ]);
    let simulate = |args: &[&str]| folder.run(&[&["simulate"], args].concat());
    expect(&simulate(&["a.toml"]), 0, "a.h5: 2 ");
    expect(&simulate(&["a.toml"]), 0, "a.h5: 2 ");
    expect(
        &simulate(&["b.toml", "-o", "a.h5"]),
        2,
        "the trace of another case",
    );
    expect(&simulate(&["b.toml", "-o", "a.h5", "--fresh"]), 0, "a.h5");
    expect(&folder.run(&["run", "small.toml"]), 0, "small.h5");
    for name in ["thesis.h5", "small.h5"] {
        for fresh in [&["--fresh"][..], &[]] {
            let args = [&["a.toml", "-o", name], fresh].concat();
            expect(&simulate(&args), 2, "no trace of slipmap");
        }
    }
    let run = folder.run(&["run", "small.toml", "-o", "a.h5", "--fresh"]);
    expect(&run, 2, "no map of slipmap");
    expect(
        &simulate(&["a.toml", "-o", "a.png"]),
        2,
        "a trace is written as HDF5, not as png",
    );
    expect(
        &simulate(&["a.toml", "-o", "no/a.h5"]),
        1,
        "cannot write no/a.h5",
    );
    expect(
        &simulate(&["a.toml", "--picture", "a.gif"]),
        2,
        "no name for a picture",
    );
    let thesis = std::fs::read_to_string(folder.path().join("thesis.h5")).unwrap();
    assert_eq!(thesis, "years of work");
    std::fs::write(folder.path().join("a.png"), "a photograph").unwrap();
    let warned = simulate(&["a.toml", "--fresh"]);
    expect(&warned, 0, "a.png is there and not by slipmap");
    expect(&simulate(&["a.toml", "--picture", "fig.svg"]), 0, "fig.svg");
    let svg = std::fs::read_to_string(folder.path().join("fig.svg")).unwrap();
    for label in ["velocities", "time t", "load", "the block sticks"] {
        assert!(svg.contains(label), "{label}");
    }
}

#[test]
fn a_trace_holds_samples_events_and_who_made_it() {
    let units = "\n[units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n";
    let text = format!("{FIG3A}{units}");
    let folder = Folder::with(&[("case.toml", &text)]);
    let said = json(&folder, &["case.toml"]);
    let file = hdf5::File::open(folder.path().join("case.h5")).unwrap();
    let read = |name: &str| file.dataset(name).unwrap().read_raw::<f64>().unwrap();
    let t = read("t");
    assert!(t.windows(2).all(|w| w[0] < w[1]));
    assert_eq!((t[0], t[t.len() - 1]), (0.0, 150.0));
    for name in [
        "x",
        "x_dot",
        "a",
        "v",
        "N",
        "pulling_force",
        "friction_force",
    ] {
        let values = read(name);
        assert_eq!(values.len(), t.len());
        assert!(values.iter().all(|v| v.is_finite()), "{name}");
    }
    let mode = file.dataset("mode").unwrap().read_raw::<u8>().unwrap();
    let (x_dot, a) = (read("x_dot"), read("a"));
    assert!(mode.iter().zip(&x_dot).all(|(m, u)| *m != 0 || *u == 0.0));
    let group = file.group("event").unwrap();
    let times = group.dataset("t").unwrap().read_raw::<f64>().unwrap();
    let elongations = group.dataset("a").unwrap().read_raw::<f64>().unwrap();
    assert_eq!(times.len(), said["events"].as_array().unwrap().len());
    for (time, elongation) in times.iter().zip(&elongations) {
        let at = t.iter().position(|t| t == time).unwrap();
        assert!((a[at] - elongation).abs() < 1e-12);
    }
    let attribute = |name: &str| file.attr(name).unwrap().read_raw::<f64>().unwrap()[0];
    let printed = said["last_release"].to_string();
    let last_release = attribute("last_release");
    assert!(
        (last_release - printed.parse::<f64>().unwrap()).abs() < 1e-12,
        "{last_release} {printed}"
    );
    assert!(attribute("period").is_nan());
    assert_eq!(
        file.dataset("v0").unwrap().read_scalar::<f64>().unwrap(),
        0.35
    );
    for name in ["case", "outcome", "git_revision", "history", "Conventions"] {
        assert!(file.attr(name).is_ok(), "{name}");
    }
}
