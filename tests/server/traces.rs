//! Traces in a folder over real connections: what is listed and told of them, and their motion
//! against the file and against the motion computed again.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]

use std::fs;

use crate::program::{self, Folder, expect};
use crate::server::{Serving, decoded};
use serde_json::Value;
use slipmap::store::TraceFile;

const CASE: &str = include_str!("../../sweeps/fig3a.toml");

/// Numbers of an array of an answer.
fn array(head: &Value, bytes: &[u8], name: &str) -> Vec<f64> {
    let of = &head["arrays"][name];
    let number = |key: &str| of[key].as_u64().unwrap() as usize;
    let begun = number("offset");
    let bytes = &bytes[begun..begun + 8 * number("length")];
    let numbers = bytes.chunks_exact(8);
    numbers
        .map(|eight| f64::from_le_bytes(eight.try_into().unwrap()))
        .collect()
}

#[test]
fn a_trace_is_listed_and_shown_as_it_is_stored() {
    let long = CASE.replace("until = 150.0", "until = 9000.0\ninterval = 0.1");
    let folder = Folder::with(&[("case.toml", CASE), ("long.toml", &long)]);
    expect(
        &folder.run(&["simulate", "case.toml", "-o", "trace.h5"]),
        0,
        "",
    );
    expect(
        &folder.run(&["simulate", "long.toml", "-o", "long.h5"]),
        0,
        "",
    );
    let serving = Serving::new(&folder);
    let list = serving.get("/api/v1/maps").json();
    let found = |name: &str| {
        let mut all = list["maps"].as_array().unwrap().iter();
        all.find(|map| map["name"] == name).unwrap()
    };
    let (trace, long) = (found("trace.h5"), found("long.h5"));
    assert_eq!(
        (&trace["state"], &trace["why"]),
        (&"complete".into(), &Value::Null)
    );
    let stored = |name: &str| TraceFile::open(&folder.path().join(name)).unwrap();
    let file = stored("trace.h5");
    assert_eq!(trace["title"], file.spec.title);
    assert_eq!(trace["trace"]["samples"], file.trace.samples.len());
    assert_eq!(
        [&trace["trace"]["until"], &trace["trace"]["outcome"]],
        [&Value::from(150.0), &"sliding".into()]
    );
    let id = trace["id"].as_str().unwrap();
    let about = serving.get(&format!("/api/v1/maps/{id}")).json();
    assert_eq!(
        (&about["trace"], &about["case"]),
        (&trace["trace"], &CASE.into())
    );
    let scalars = about["scalars"].as_array().unwrap();
    let v0 = scalars
        .iter()
        .find(|scalar| scalar["name"] == "v0")
        .unwrap();
    assert_eq!((&v0["value"], &v0["unit"]), (&0.35.into(), &"1".into()));
    let text = serving.get(&format!("/api/v1/maps/{id}/sweep"));
    assert_eq!(text.body, CASE.as_bytes());
    // All samples, as they are stored.
    let motion = serving.get(&format!("/api/v1/maps/{id}/motion"));
    let (head, bytes) = decoded(&motion.body);
    let samples = &file.trace.samples;
    assert!(
        array(&head, bytes, "t")
            .into_iter()
            .eq(samples.iter().map(|s| s.t))
    );
    assert!(
        array(&head, bytes, "a")
            .into_iter()
            .eq(samples.iter().map(|s| s.a))
    );
    assert!(
        array(&head, bytes, "N")
            .into_iter()
            .eq(samples.iter().map(|s| s.n))
    );
    // And the outcome of the motion computed now.
    let again = decoded(&serving.ask("motion", CASE).body).0;
    for (key, value) in again.as_object().unwrap() {
        assert!(key == "arrays" || head[key] == *value, "{key}: {value}");
    }
    // A long one is thinned, but not at its events.
    let file = stored("long.h5");
    assert!(file.trace.samples.len() > 50_000);
    let motion = serving.get(&format!(
        "/api/v1/maps/{}/motion",
        long["id"].as_str().unwrap()
    ));
    let (head, bytes) = decoded(&motion.body);
    let times = array(&head, bytes, "t");
    assert!((10_000..=20_000).contains(&times.len()), "{}", times.len());
    assert_eq!([times[0], times[times.len() - 1]], [0.0, 9000.0]);
    let mut events = file.trace.events.iter().filter(|event| event.t <= 9000.0);
    assert!(events.all(|event| times.contains(&event.t)));
    assert_eq!(
        head["events"].as_array().unwrap().len(),
        file.trace.events.len()
    );
}

/// What a trace has not is refused, a damaged one is told as such, and one that was replaced is
/// read anew.
#[test]
fn a_trace_has_no_cells_and_a_map_no_motion() {
    let sweep = "[axes]\nalpha_v = [-0.3, -0.1]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.3\n";
    let folder = Folder::with(&[("case.toml", CASE), ("sweep.toml", sweep)]);
    expect(
        &folder.run(&["simulate", "case.toml", "-o", "trace.h5"]),
        0,
        "",
    );
    expect(&folder.run(&["run", "sweep.toml", "-o", "map.h5"]), 0, "");
    let path = folder.path().join("trace.h5");
    let mut bytes = fs::read(&path).unwrap();
    let renamed = bytes
        .windows(7)
        .position(|seven| seven == b"sliding")
        .unwrap();
    bytes[renamed] = b'g';
    fs::write(folder.path().join("bad.h5"), &bytes).unwrap();
    let serving = Serving::new(&folder);
    let list = serving.get("/api/v1/maps").json();
    let entry = |name: &str| {
        let mut all = list["maps"].as_array().unwrap().iter();
        all.find(|map| map["name"] == name).unwrap().clone()
    };
    let bad = entry("bad.h5");
    assert_eq!(bad["state"], "damaged", "{bad}");
    assert!(
        bad["why"]
            .as_str()
            .unwrap()
            .starts_with("it is a damaged trace"),
        "{bad}"
    );
    let ask = |name: &str, what: &str| {
        let id = entry(name)["id"].as_str().unwrap().to_owned();
        serving.get(&format!("/api/v1/maps/{id}{what}"))
    };
    for (name, what, says) in [
        (
            "trace.h5",
            "/window?field=n_unstable&x=tau",
            "it is a trace",
        ),
        ("trace.h5", "/cell?at=tau:0", "it is a trace"),
        ("trace.h5", "/curves?x=tau&y=alpha_v", "it is a trace"),
        ("map.h5", "/motion", "it is a map"),
    ] {
        let refused = ask(name, what);
        assert_eq!(refused.status, 422, "{name}{what}");
        let detail = refused.json()["detail"].clone();
        assert!(detail.as_str().unwrap().starts_with(says), "{detail}");
    }
    assert_eq!(ask("bad.h5", "/motion").status, 502);
    let file = ask("trace.h5", "/file");
    assert_eq!((file.status, file.body), (200, fs::read(&path).unwrap()));
    assert_eq!(ask("trace.h5", "").json()["trace"]["outcome"], "sliding");
    let other = CASE.replace("alpha_v = -0.33", "alpha_v = 0");
    fs::write(folder.path().join("case.toml"), other).unwrap();
    expect(
        &folder.run(&["simulate", "case.toml", "-o", "trace.h5", "--fresh"]),
        0,
        "",
    );
    let again = program::json(&folder.run(&["info", "trace.h5", "--json"]));
    assert_ne!(again["outcome"], "sliding");
    assert_eq!(
        ask("trace.h5", "").json()["trace"]["outcome"],
        again["outcome"]
    );
}
