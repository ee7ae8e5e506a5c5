//! A case and its trace in every command: told beforehand, told afterwards, drawn, verified.

use crate::map::edit;
use crate::program::{self, Folder, err, expect, out};
use hdf5::File;
use serde_json::{Value, json};

const CASE: &str = "title = \"Some motion\"\nswitch_on = 7.0\nhorizon = 60.0\nunits = \"SI\"\n\
                    [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n[fixed]\nv0 = 0.35\n\
                    alpha_v = -0.33\ntau = 4.15\n[start]\nx_dot0 = 0\n\
                    [trace]\nuntil = 20.0\ninterval = 0.5\n";

/// What is done to a trace.
type Change = fn(&File);

fn folder() -> Folder {
    let folder = Folder::with(&[("case.toml", CASE)]);
    expect(&folder.run(&["simulate", "case.toml"]), 0, "case.h5");
    folder
}

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(&[args, &["--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    program::json(&output)
}

#[test]
fn a_case_is_planned_without_following_its_motion() {
    // So many steps would take hours.
    let long = CASE
        .replace("60.0", "1e9")
        .replace("horizon", "steps = 1000000000\nhorizon");
    let dense = CASE.replace("interval = 0.5", "interval = 1e-6");
    let folder = Folder::with(&[("long.toml", &long), ("dense.toml", &dense)]);
    let text = out(&folder.run(&["plan", "long.toml"]));
    for says in [
        "a case: one motion, which `slipmap simulate` follows",
        "title        Some motion",
        "friction     weakening",
        "control      velocity",
        "fixed        tau          4.15 s",
        "start        x_dot0 = 0 m s-1, a0 = ",
        "switch_on    t = 7 s",
        "t = 1000000000 s, 1 000 000 000 steps at most",
        "samples      41, one every 0.5 s, until t = 20 s",
        "trace        long.h5",
        "picture      long.png",
    ] {
        assert!(text.contains(says), "{says} in\n{text}");
    }
    let too_dense = folder.run(&["plan", "dense.toml"]);
    expect(&too_dense, 2, "2 000 000 are the most");
    let threads = folder.run(&["plan", "long.toml", "--threads", "2"]);
    expect(&threads, 2, "one motion takes one thread");
    assert_eq!(folder.files(), ["dense.toml", "long.toml"]);
}

#[test]
fn a_plan_of_a_case_is_what_its_trace_tells() {
    let never = "switch_on = false\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n[fixed]\nv0 = 0.1\n";
    let folder = Folder::with(&[("case.toml", CASE), ("never.toml", never)]);
    let never = json(&folder, &["plan", "never.toml"]);
    let case = &never["case"];
    assert_eq!(never["kind"], "case");
    assert_eq!(case["control"], "none");
    assert_eq!(case["switch_on"], Value::Null);
    assert_eq!(case["start"]["assumed"], true);
    assert_eq!(never["samples"], Value::Null);
    assert_eq!(never["samples_per_step"], 24);
    let planned = json(&folder, &["plan", "case.toml"]);
    assert_eq!(planned["samples"], 41);
    assert_eq!(planned["bytes"], 41 * 65);
    assert_eq!(folder.files(), ["case.toml", "never.toml"]);
    expect(&folder.run(&["simulate", "case.toml"]), 0, "case.h5");
    let told = json(&folder, &["info", "case.h5"]);
    assert_eq!(told["case"], planned["case"]);
    let events = told["events"].as_object().unwrap().values();
    let events: u64 = events.map(|count| count.as_u64().unwrap()).sum();
    let samples = told["samples"].as_u64().unwrap();
    let least = 41..=41 + 2 * events;
    assert!(least.contains(&samples), "{samples} with {events} events");
}

#[test]
fn a_trace_says_what_it_is() {
    let folder = folder();
    let said = json(&folder, &["simulate", "case.toml"]);
    let told = json(&folder, &["info", "case.h5"]);
    assert_eq!(
        (&told["kind"], &told["schema_version"]),
        (&json!("trace"), &json!(3))
    );
    for name in [
        "outcome",
        "decided",
        "settle_time",
        "n_min",
        "period",
        "last_release",
        "steps",
    ] {
        assert_eq!(told[name], said[name], "{name}");
    }
    let all = said["events"].as_array().unwrap();
    for (kind, count) in told["events"].as_object().unwrap() {
        let those = all.iter().filter(|event| event["kind"] == *kind).count();
        assert_eq!(*count, those, "{kind}");
    }
    assert!(told["events"]["release"].as_u64().unwrap() > 0);
    assert_eq!(told["duration"], 20.0);
    assert_eq!(told["origin"]["title"], "Some motion");
    assert_eq!(told["fields"][4]["unit"], "N");
    let text = out(&folder.run(&["info", "case.h5"]));
    for says in [
        "a trace: one motion",
        "title        Some motion",
        "revision     ",
        "field        x_dot        velocity of the block, ",
        "events       switch_on    1",
        &format!("outcome      {}", said["outcome"].as_str().unwrap()),
    ] {
        assert!(text.contains(says), "{says} in\n{text}");
    }
    assert_eq!(out(&folder.run(&["info", "case.h5", "--sweep"])), CASE);
}

#[test]
fn a_trace_is_drawn_as_simulate_draws_it() {
    let folder = folder();
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    let by_simulate = read("case.png");
    std::fs::remove_file(folder.path().join("case.png")).unwrap();
    expect(&folder.run(&["plot", "case.h5"]), 0, "case.png");
    assert!(read("case.png") == by_simulate, "the same picture");
    let titled = [
        "plot", "case.h5", "--title", "Another", "--size", "800x600", "-o", "a.svg",
    ];
    expect(&folder.run(&titled), 0, "a.svg");
    let svg = String::from_utf8(read("a.svg")).unwrap();
    assert!(svg.contains("Another") && !svg.contains("Some motion"));
    assert!(svg.contains("width=\"800\""), "{}", &svg[..200]);
    for (args, says) in [
        (["--field", "vc"], "--field has no meaning for a trace"),
        (["--at", "tau=1"], "--at has no meaning for a trace"),
        (["-o", "case.gif"], "name the picture like fig.png"),
        (["--size", "1x1"], "300 to 5000 pixels"),
    ] {
        expect(
            &folder.run(&[&["plot", "case.h5"], &args[..]].concat()),
            2,
            says,
        );
    }
    std::fs::copy(folder.path().join("case.h5"), folder.path().join("t.png")).unwrap();
    expect(
        &folder.run(&["plot", "t.png", "-o", "t.png"]),
        2,
        "would replace t.png",
    );
}

#[test]
fn a_changed_trace_is_found() {
    let folder = folder();
    let sound = folder.run(&["verify", "case.h5"]);
    expect(&sound, 0, "computed again are the same, bit by bit");
    let report = json(&folder, &["verify", "case.h5"]);
    assert_eq!(
        (&report["kind"], &report["sound"]),
        (&json!("trace"), &json!(true))
    );
    assert_eq!(report["samples"], report["samples_equal"]);
    assert_eq!(report["events"], report["events_equal"]);
    assert!(report["events"].as_u64() > Some(1) && report["samples"].as_u64() > Some(40));
    let changes: [(Change, &str); 7] = [
        (
            |f| next_up(f, "x_dot", 17),
            "x_dot comes out differently in 1 of 45 samples",
        ),
        (
            |f| next_up(f, "t", 40),
            "t comes out differently in 1 of 45 samples",
        ),
        (
            |f| next_up(f, "event/a", 1),
            "a comes out differently in 1 of 4 events",
        ),
        (
            |f| write(f, "mode", 3, 2_u8),
            "mode comes out differently in 1 of 45 samples",
        ),
        (
            |f| write(f, "event/kind", 0, 2_u8),
            "is called reversal, again it is",
        ),
        (
            |f| f.dataset("tau").unwrap().write_scalar(&4.2).unwrap(),
            "tau is 4.2, in its case 4.15",
        ),
        (
            |f| f.attr("decided").unwrap().write_raw(&[3.0]).unwrap(),
            "its decided is 3, again it is",
        ),
    ];
    let path = folder.path().join("changed.h5");
    for (change, says) in changes {
        std::fs::copy(folder.path().join("case.h5"), &path).unwrap();
        edit(&path, change);
        let found = folder.run(&["verify", "changed.h5"]);
        expect(&found, 1, says);
        expect(&found, 1, "changed.h5: 1 fault");
    }
}

/// The next number after one of a dataset takes its place.
fn next_up(file: &File, name: &str, place: usize) {
    let dataset = file.dataset(name).unwrap();
    let value = dataset.read_raw::<f64>().unwrap()[place];
    write(file, name, place, value.next_up());
}

fn write<T: hdf5::H5Type + Clone>(file: &File, name: &str, place: usize, value: T) {
    let dataset = file.dataset(name).unwrap();
    let mut values = dataset.read_raw::<T>().unwrap();
    values[place] = value;
    dataset.write_raw(&values).unwrap();
}

/// Another revision may round otherwise: that is said, and only what is more is a fault.
#[test]
fn a_trace_of_another_revision_may_differ_by_rounding() {
    let folder = folder();
    let path = folder.path().join("case.h5");
    edit(&path, |file| {
        file.delete_attr("git_revision").unwrap();
        next_up(file, "x_dot", 17);
    });
    let found = folder.run(&["verify", "case.h5"]);
    expect(&found, 0, "another revision of slipmap computed it");
    edit(&path, |file| write(file, "x_dot", 17, 0.3));
    expect(
        &folder.run(&["verify", "case.h5"]),
        1,
        "x_dot comes out differently in 1 of 45",
    );
}

/// A trace of the first version counts the last release from t = 0, and is sound.
#[test]
fn a_trace_of_the_first_version_tells_the_same_times() {
    let folder = folder();
    let path = folder.path().join("case.h5");
    let told = json(&folder, &["info", "case.h5"]);
    let released = told["last_release"].as_f64().unwrap();
    let switch_on = told["case"]["switch_on"].as_f64().unwrap();
    assert!(released > 0.0 && switch_on > 0.0, "{told}");
    edit(&path, |file| {
        let version = file.attr("slipmap_trace_format_version").unwrap();
        version.write_raw(&[1_i32]).unwrap();
        let last = file.attr("last_release").unwrap();
        last.write_raw(&[released + switch_on]).unwrap();
        file.delete_attr("git_revision").unwrap();
    });
    let old = json(&folder, &["info", "case.h5"]);
    let difference = old["last_release"].as_f64().unwrap() - released;
    assert!(difference.abs() < 1e-12, "{difference}");
    expect(&folder.run(&["verify", "case.h5"]), 0, "another revision");
}

/// Whatever stands in a trace, it is drawn or refused in words.
#[test]
fn odd_traces_end_no_command_with_a_panic() {
    let folder = folder();
    let path = folder.path().join("odd.h5");
    let changes: [(Change, i32, &str); 5] = [
        (|f| write(f, "x_dot", 5, f64::NAN), 0, "odd.400x300.png"),
        (|f| write(f, "a", 5, f64::INFINITY), 0, "odd.400x300.png"),
        (|f| write(f, "t", 5, -1e300), 0, "odd.400x300.png"),
        (|f| write(f, "mode", 5, 9_u8), 2, "a kind of number 9"),
        (
            |f| {
                f.unlink("v").unwrap();
                f.new_dataset::<f64>().shape(3).create("v").unwrap();
            },
            2,
            "its v",
        ),
    ];
    for (change, code, says) in changes {
        std::fs::copy(folder.path().join("case.h5"), &path).unwrap();
        edit(&path, change);
        expect(
            &folder.run(&["plot", "odd.h5", "--size", "400x300"]),
            code,
            says,
        );
        expect(&folder.run(&["info", "odd.h5"]), code, "");
        let verified = folder.run(&["verify", "odd.h5"]);
        expect(&verified, code.max(1), "odd.h5");
    }
}

/// A map of which there are only tiles: verify says what to do.
#[test]
fn an_interrupted_map_is_no_map_yet() {
    let sweep = "fields = [\"abscissa\"]\n[axes]\nalpha_v = { from = -1, to = 0, points = 40 }\n\
                 tau = { from = 0, to = 9, points = 500 }\n[fixed]\nmu_prime = -0.3\n";
    let folder = Folder::with(&[("map.toml", sweep)]);
    let shard = folder.run(&["run", "map.toml", "--shard", "1/2", "-o", "map.h5"]);
    expect(&shard, 0, "shard 1 of 2 is complete");
    let found = folder.run(&["verify", "map.h5"]);
    expect(&found, 2, "map.h5 is not complete");
    expect(&found, 2, "`slipmap run` that began it goes on");
    expect(
        &folder.run(&["verify", "none.h5"]),
        2,
        "cannot open none.h5",
    );
}
