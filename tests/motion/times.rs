//! Times of motions count from switch-on, in traces and maps alike, and motions whose start nobody
//! gives are disturbed: against the events and samples of traces, and against a map from before.

use std::path::Path;

use serde_json::Value;

use crate::program::{self, Folder, err, expect, out};

const FIG3A: &str = include_str!("../../sweeps/fig3a.toml");
const FIG3B: &str = include_str!("../../sweeps/fig3b.toml");
const LAW: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

/// What `simulate` says of a case in this folder, with its trace in `trace.h5`.
fn simulated(folder: &Folder, args: &[&str]) -> Value {
    // Bitmaps take longer.
    let trace = [
        "-o",
        "trace.h5",
        "--fresh",
        "--json",
        "--picture",
        "trace.svg",
    ];
    let output = folder.run(&[&["simulate"], args, &trace].concat());
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    program::json(&output)
}

fn times(told: &Value, kind: &str) -> Vec<f64> {
    let events = told["events"].as_array().unwrap().iter();
    let of_kind = events.filter(|event| event["kind"] == kind);
    of_kind.map(|event| event["t"].as_f64().unwrap()).collect()
}

/// Between which times the velocity is outside of 1 % of v0 for the last time, by the samples;
/// none where it never is.
fn unsettled(folder: &Folder, v0: f64) -> Option<(f64, f64)> {
    let file = hdf5::File::open(folder.path().join("trace.h5")).unwrap();
    let read = |name: &str| file.dataset(name).unwrap().read_raw::<f64>().unwrap();
    let (t, x_dot) = (read("t"), read("x_dot"));
    let last = x_dot.iter().rposition(|u| (u - v0).abs() > 0.01 * v0)?;
    Some((t[last], t[last + 1]))
}

#[test]
fn times_count_from_switch_on() {
    let controlled =
        |start: &str| format!("{start}{LAW}[fixed]\nv0 = 0.35\nalpha_v = -0.33\ntau = 4.15\n");
    let cases = [
        ("fig3a.toml", FIG3A.to_owned(), true),
        ("fig3b.toml", FIG3B.to_owned(), true),
        // Switched on at a phase, 1.5 after the release at t = 0.
        (
            "phase.toml",
            controlled("start.switch_on_phase = 1.5\n"),
            true,
        ),
        // Control that acts from the start, on a block that never sticks.
        ("never.toml", controlled("start.x_dot0 = 0.36\n"), false),
    ];
    let folder = Folder::new();
    for (name, text, sticks) in cases {
        // The trace goes on until the outcome is known.
        let text = text
            .replace("until = 150.0", "")
            .replace("until = 100.0", "");
        let dense = match text.contains("[trace]") {
            true => text.replace("[trace]", "[trace]\nsamples = 64"),
            false => format!("{text}[trace]\nsamples = 64\n"),
        };
        std::fs::write(folder.path().join(name), dense).unwrap();
        let told = simulated(&folder, &[name]);
        assert_eq!(told["outcome"], "sliding", "{name}");
        let switch_on = times(&told, "switch_on").first().copied().unwrap_or(0.0);
        let v0 = if name == "fig3b.toml" { 0.1 } else { 0.35 };
        let releases = times(&told, "release");
        let after = releases.iter().rfind(|t| **t > switch_on);
        assert_eq!(after.is_some(), sticks, "{name}");
        let last_release = told["last_release"].as_f64().unwrap();
        let expected = after.map_or(0.0, |t| t - switch_on);
        assert!((last_release - expected).abs() < 1e-9, "{name} {told}");
        let settle_time = told["settle_time"].as_f64().unwrap() + switch_on;
        let (from, to) = unsettled(&folder, v0).unwrap();
        assert!(
            settle_time >= from && settle_time <= to,
            "{name} {settle_time}"
        );
        assert!(told["settle_time"].as_f64().unwrap() >= last_release);
    }
}

/// Where sticks go on there is no last one; where control is switched on late, what was before does
/// not count.
#[test]
fn what_is_before_switch_on_does_not_count() {
    let folder = Folder::with(&[
        ("free.toml", &format!("{LAW}[fixed]\nv0 = 0.1\n")),
        (
            "settled.toml",
            "switch_on = 90.0\n[friction]\nlaw = \"table\"\nspeeds = [0, 1]\nmu_k = [0.4, 0.6]\n\
             mu_s = 0.4\n[fixed]\nv0 = 0.1\nalpha_n = -0.1\ntau = 1\n\
             [start]\nx_dot0 = 0.0\na0 = 0.0\n",
        ),
    ]);
    let free = simulated(&folder, &["free.toml"]);
    assert_eq!(free["outcome"], "stick-slip");
    assert!(free["last_release"].is_null() && !times(&free, "release").is_empty());
    let settled = simulated(&folder, &["settled.toml"]);
    let last = *times(&settled, "release").last().unwrap();
    assert!(last > 0.0 && last < 90.0, "{settled}");
    assert_eq!(settled["last_release"], 0.0, "{settled}");
}

const SWEEP: &str = "title = \"Motions\"\n\
    fields = [\"outcome\", \"settle_time\", \"last_release\", \"peak_force\"]\n[axes]\n\
    v0 = [0.35]\ntau = [1.0, 4.15]\n";

/// The one number of a field in a map at a place.
fn at(path: &Path, field: &str, place: usize) -> f64 {
    let file = hdf5::File::open(path).unwrap();
    file.dataset(field).unwrap().read_raw::<f64>().unwrap()[place]
}

/// Every cell is what `simulate` says of the case without a start, which is disturbed as well.
#[test]
fn sweeps_without_a_start_are_disturbed_and_say_so() {
    let sweep = format!("{SWEEP}{LAW}[fixed]\nalpha_v = -0.33\n");
    let started = format!("{sweep}[start]\nx_dot0 = 0.36\n");
    let folder = Folder::with(&[("map.toml", &sweep), ("started.toml", &started)]);
    let said =
        "none is given: each block begins with x_dot0 = 1.01 v0, 1 % faster than it is pulled";
    expect(&folder.run(&["plan", "map.toml"]), 0, said);
    expect(&folder.run(&["run", "map.toml"]), 0, "2 cells");
    expect(&folder.run(&["info", "map.h5"]), 0, said);
    expect(&folder.run(&["verify", "map.h5"]), 0, "agree");
    let map = folder.path().join("map.h5");
    let mut outcomes = Vec::new();
    for (place, tau) in [1.0, 4.15].into_iter().enumerate() {
        let case = format!("{LAW}[fixed]\nalpha_v = -0.33\nv0 = 0.35\ntau = {tau}\n");
        std::fs::write(folder.path().join("case.toml"), case).unwrap();
        let told = simulated(&folder, &["case.toml"]);
        for field in ["settle_time", "last_release", "peak_force"] {
            let (found, expected) = (at(&map, field, place), told[field].as_f64());
            let expected = expected.unwrap_or(f64::NAN);
            let same = (found - expected).abs() <= 1e-15 * expected.abs();
            assert!(
                same || found.is_nan() && expected.is_nan(),
                "{field} {told}"
            );
        }
        let of_map = ["--map", "map.h5", "--at", &format!("tau={tau}")];
        assert_eq!(simulated(&folder, &of_map)["events"], told["events"]);
        outcomes.push(told["outcome"].as_str().unwrap().to_owned());
    }
    assert!(outcomes.iter().any(|o| o == "sliding"), "{outcomes:?}");
    assert!(outcomes.iter().all(|o| o != "undecided"), "{outcomes:?}");
    // With a start nothing is said of it.
    let plan = folder.run(&["plan", "started.toml"]);
    assert!(!out(&plan).contains("start "), "{}", out(&plan));
}

/// A map that was written while motions without a start began on their equilibrium: `outcome`,
/// `settle_time` and `peak_force` over v0 [0.2, 0.35] and tau [1, 4.15]. It means what it meant.
#[test]
fn a_map_of_the_fifth_version_began_on_the_equilibrium() {
    let folder = Folder::new();
    let path = folder.path().join("old.h5");
    std::fs::copy("tests/reference/format_version_5.h5", &path).unwrap();
    let verified = folder.run(&["verify", "old.h5"]);
    expect(&verified, 0, "outcome, by collocation 2 agree, 0 differ");
    let info = out(&folder.run(&["info", "old.h5"]));
    assert!(
        info.contains("2 undecided") && !info.contains("none is given"),
        "{info}"
    );
    let cell = ["--map", "old.h5", "--at", "v0=0.35", "--at", "tau=4.15"];
    let told = simulated(&folder, &cell);
    assert_eq!(
        (&told["outcome"], at(&path, "settle_time", 3)),
        (&"sliding".into(), 0.0)
    );
    assert_eq!(told["settle_time"], 0.0);
    // The same file is another sweep now.
    let sweep = out(&folder.run(&["info", "old.h5", "--sweep"]));
    std::fs::write(folder.path().join("old.toml"), sweep).unwrap();
    expect(
        &folder.run(&["run", "old.toml"]),
        2,
        "the map of another sweep",
    );
    expect(&folder.run(&["run", "old.toml", "--fresh"]), 0, "4 cells");
    assert!(at(&path, "settle_time", 3) > 0.0);
}
