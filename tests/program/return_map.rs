//! Control by the return map from the command line: case files, flags, bad input.

use crate::program::{self, Folder, err, expect, out};

const CASE: &str = include_str!("../../sweeps/return_map.toml");

fn with(key: &str, line: &str) -> String {
    let kept = |old: &&str| old.split(' ').next() != Some(key);
    let lines = CASE.lines().filter(kept).map(|old| match old {
        "[fixed]" if ["alpha_n", "load_min", "memory", "sample_time"].contains(&key) => {
            format!("{old}\n{line}\n")
        }
        "[feedback]" if ["control", "amplitude", "model", "record", "pulse"].contains(&key) => {
            format!("{old}\n{line}\n")
        }
        old => format!("{old}\n"),
    });
    lines.collect()
}

/// The shipped case, and the same by flags, end in sliding with the same last release.
#[test]
fn a_case_and_flags_tell_the_same() {
    let folder = Folder::with(&[("return_map.toml", CASE)]);
    let of_case = folder.run(&["simulate", "return_map.toml", "--json"]);
    expect(&of_case, 0, "");
    let of_case = program::json(&of_case);
    assert_eq!(of_case["outcome"], "sliding");
    let facts = &of_case["inputs"]["case"];
    assert_eq!(facts["control"], "return-map");
    assert_eq!(facts["return_map"]["amplitude"], 0.5);
    assert_eq!(facts["return_map"]["model"], "exact");
    assert_eq!(facts["return_map"]["record"], serde_json::Value::Null);
    let flags = "simulate --friction weakening --mu0 0.5 --v-s 0.5 --v0 0.1 --sample-time 0.9 \
        --control return-map --amplitude 0.5 --switch-on 70 --json";
    let by_flags = folder.run(&flags.split_whitespace().collect::<Vec<_>>());
    expect(&by_flags, 0, "");
    let by_flags = program::json(&by_flags);
    assert_eq!(by_flags["last_release"], of_case["last_release"]);
    let told = out(&folder.run(&["plan", "return_map.toml"]));
    assert!(
        told.contains("return-map") && told.contains("0.5, model exact"),
        "{told}"
    );
}

/// A reconstructed model depends on its seed and tells its record.
#[test]
fn a_reconstructed_model_has_a_record() {
    let text = with(
        "model",
        "model = \"reconstructed\"\nrecord = 12\npulse = 0.005",
    );
    let folder = Folder::with(&[("case.toml", &text)]);
    let run = || program::json(&folder.run(&["simulate", "case.toml", "--json", "--fresh"]));
    let (one, again) = (run(), run());
    assert_eq!(one, again);
    let told = &one["inputs"]["case"]["return_map"];
    assert_eq!(
        (&told["record"], &told["pulse"]),
        (&12.into(), &0.005.into())
    );
    let text = out(&folder.run(&["simulate", "case.toml", "--fresh"]));
    let inputs = text.lines().find(|line| line.starts_with("inputs: "));
    let control = "control = return-map, amplitude = 0.5, model = reconstructed, record = 12, \
        pulse = 0.005;";
    assert!(inputs.is_some_and(|line| line.contains(control)), "{text}");
}

/// A map has no control by the return map: the message says what has.
#[test]
fn a_sweep_file_refuses_the_table() {
    let sweep = "[axes]\ntau = [0.5, 1.0]\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n\
        [fixed]\nv0 = 0.1\nalpha_n = -10\n[feedback]\ncontrol = \"return-map\"\n\
        amplitude = 0.5\n";
    let folder = Folder::with(&[("sweep.toml", sweep)]);
    for command in ["run", "plan"] {
        let output = folder.run(&[command, "sweep.toml"]);
        expect(&output, 2, "`feedback` does not belong here");
        let told = err(&output);
        assert!(
            told.contains("slipmap compare") && told.contains("[feedback]"),
            "{told}"
        );
    }
}

#[test]
fn mistakes_are_shown_in_place() {
    let mut told = String::new();
    for (key, line) in [
        ("sample_time", "sample_time = 3.3"),
        ("sample_time", "sample_time = 0.01"),
        ("sample_time", ""),
        ("amplitude", "amplitude = 1.5"),
        ("amplitude", "amplitude = -0.5"),
        ("amplitude", ""),
        ("control", ""),
        ("control", "control = \"ogy\""),
        ("model", "model = \"fitted\""),
        ("record", "record = 12"),
        ("model", "model = \"reconstructed\"\nrecord = 6"),
        ("model", "model = \"reconstructed\"\npulse = 0.9"),
        ("model", "model = \"reconstructed\"\npulse = 1.9"),
        ("alpha_n", "alpha_n = -10\ntau = 0.9"),
        ("load_min", "load_min = 0.2"),
        ("memory", "memory = 0.2"),
    ] {
        let folder = Folder::with(&[("case.toml", &with(key, line))]);
        let output = folder.run(&["simulate", "case.toml"]);
        expect(&output, 2, "");
        told += &format!("{line}\n{}\n", err(&output));
    }
    let flags = "simulate --friction weakening --mu0 0.5 --v-s 0.5 --v0 0.1 --sample-time 0.9";
    for more in [
        "--amplitude 0.5",
        "--control return-map",
        "--control return-map --amplitude 2",
    ] {
        let all = format!("{flags} {more}");
        let output = Folder::new().run(&all.split_whitespace().collect::<Vec<_>>());
        expect(&output, 2, "");
        told += &format!("{more}\n{}\n", err(&output));
    }
    insta::assert_snapshot!("mistakes", told);
}
