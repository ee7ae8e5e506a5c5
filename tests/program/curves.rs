//! Files of measured curves, of every kind that programs write, given by a flag and by keys of
//! sweep, case and setting files: the same points or the same mistake everywhere.

use std::process::Output;

use crate::curve_files::{CURVES, Curve, MU_K, Read, SPEEDS, Said, path, says};
use crate::program::{self, Folder, err, expect, out};

/// The folder of a test with all curves in it.
fn folder() -> Folder {
    let folder = Folder::new();
    for curve in CURVES {
        let to = folder.path().join(curve.file);
        std::fs::copy(path(curve.file), to).unwrap();
    }
    folder
}

fn flags(
    Said {
        columns,
        load,
        speed_unit,
        si,
    }: Said,
) -> Vec<String> {
    let flag = |name: &str, value: Option<&str>| value.map(|value| format!("--{name}={value}"));
    let units = si.then_some("SI");
    [
        flag("columns", columns),
        flag("normal-load", load),
        flag("speed-unit", speed_unit),
        flag("units", units),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Checks the exit code, and what was said on standard error.
#[track_caller]
fn check(output: &Output, of: &Curve, keys: usize) {
    let said = &err(output);
    assert_eq!(output.status.code(), Some(code(of)), "{}: {said}", of.file);
    let file = of.file;
    match of.read {
        Read::Points("") => assert!(!said.contains(file), "{file}: {said}"),
        Read::Points(remark) => {
            let told = says(said, &format!("{file}: ")) && says(said, remark);
            assert!(told, "{file}: {said}");
        }
        Read::Refused(message, advice) => {
            assert!(says(said, message), "{file}: {said}");
            assert!(says(&unframed(said), advice[keys]), "{file}: {said}");
        }
    }
}

/// A message without what frames its lines.
fn unframed(said: &str) -> String {
    said.replace("  │ ", " ").replace('│', " ")
}

fn code(of: &Curve) -> i32 {
    match of.read {
        Read::Points(_) => 0,
        Read::Refused(..) => 2,
    }
}

#[test]
fn a_flag_reads_every_curve() {
    let folder = folder();
    for curve in CURVES {
        let flags = flags(curve.said);
        let usual = ["point", "--json", "--v0=0.1", "--friction=table", "--table"];
        let more: Vec<&str> = flags.iter().map(String::as_str).collect();
        let output = folder.run(&[&usual[..], &[curve.file], &more[..]].concat());
        check(&output, curve, 0);
        if code(curve) == 0 {
            let told = program::json(&output);
            assert_eq!(
                told["inputs"]["speeds"],
                serde_json::json!(SPEEDS),
                "{}",
                curve.file
            );
            assert_eq!(
                told["inputs"]["mu_k"],
                serde_json::json!(MU_K),
                "{}",
                curve.file
            );
        }
    }
}

#[test]
fn a_sweep_reads_every_curve() {
    let folder = folder();
    for curve in CURVES {
        let law = curve.said.keys(&format!("file = \"{}\"", curve.file));
        let text = format!("axes.tau = [1]\nfixed.v0 = 0.1\nfixed.alpha_v = -0.1\n{law}");
        std::fs::write(folder.path().join("sweep.toml"), text).unwrap();
        let output = folder.run(&["run", "--fresh", "sweep.toml"]);
        check(&output, curve, 1);
        if code(curve) == 0 {
            // The map is complete without the file.
            let kept = out(&folder.run(&["info", "--sweep", "sweep.h5"]));
            let points = "table = [[0.0, 0.5], [0.25, 0.4], [0.5, 0.375]]";
            assert!(kept.contains(points), "{}: {kept}", curve.file);
        }
    }
}

/// A plain name is enough where titles tell the rest, and the load of the setting is that of the
/// forces.
#[test]
fn cases_and_settings_read_curves() {
    let folder = folder();
    let case = "horizon = 50\nunits = \"SI\"\n[fixed]\nv0 = 0.1\nnormal_load = 10\n\
        [friction]\nlaw = \"table\"\ntable = \"force.csv\"\n";
    std::fs::write(folder.path().join("case.toml"), case).unwrap();
    expect(&folder.run(&["simulate", "case.toml", "-o", "-"]), 0, "");
    let setting = case
        .replace("horizon = 50\n", "")
        .replace("v0", "tau = 0\nv0");
    std::fs::write(folder.path().join("setting.toml"), setting).unwrap();
    let output = folder.run(&["point", "--setting", "setting.toml", "--json"]);
    let told = program::json(&output);
    assert_eq!(told["inputs"]["mu_k"], serde_json::json!(MU_K), "{told}");
}

#[test]
fn what_has_no_meaning_is_refused() {
    let folder = folder();
    let point = ["point", "--v0=0.1", "--friction=table"];
    for (flags, says) in [
        (&["--columns=speed=1"][..], "--table"),
        (
            &["--table=plain.csv", "--columns=spede=1"],
            "did you mean `speed`?",
        ),
        (
            &["--table=plain.csv", "--columns=speed=3,speed=2"],
            "speed is given twice",
        ),
        (
            &["--table=plain.csv", "--speed-unit=knots"],
            "knots is no known unit of speed",
        ),
        (
            &["--table=plain.csv", "--columns=force=2", "--normal-load=-3"],
            "normal_load = -3",
        ),
    ] {
        expect(&folder.run(&[&point[..], flags].concat()), 2, says);
    }
    std::fs::write(folder.path().join("picture.csv"), b"\x89PNG\r\n\x1a\n\0\0").unwrap();
    let output = folder.run(&[&point[..], &["--table=picture.csv"]].concat());
    expect(&output, 2, "it is not text: save the columns as CSV");
}
