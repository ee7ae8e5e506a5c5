//! `slipmap measure` from the command line: its text, JSON and CSV, what reads that, bad input.

use serde_json::Value;

use crate::program::{self, Folder, err, expect, out};

const LAW: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

fn experiment(keys: &str, fixed: &str) -> String {
    format!("[experiment]\n{keys}\n{LAW}[fixed]\n{fixed}\n")
}

/// `fit` and `--table` read what it writes, without the v0 that did not settle.
#[test]
fn what_it_writes_is_read() {
    let six = "v0 = [0.05, 0.1, 0.2, 0.4, 0.8, 1.6]\ncontrol = \"velocity\"\naverage = 20";
    let folder = Folder::with(&[
        ("six.toml", &experiment(six, "")),
        (
            "load.toml",
            &experiment(&six.replace("velocity", "load"), ""),
        ),
    ]);
    let told = folder.run(&["measure", "load.toml", "-o", "load.csv"]);
    expect(&told, 0, "");
    assert!(
        out(&told).contains("mu_k is measured at all 6 v0"),
        "{}",
        out(&told)
    );
    assert!(out(&told).ends_with("load.csv: 6 v0\n"), "{}", out(&told));
    let written = std::fs::read_to_string(folder.path().join("load.csv")).unwrap();
    assert!(
        written.starts_with("v0,mu_k,mu_k_error,settled\n0.05,0.4545"),
        "{written}"
    );
    let fitted = folder.run(&[
        "fit",
        "load.csv",
        "--v0",
        "0.1",
        "--law",
        "weakening",
        "--json",
    ]);
    let fitted = program::json(&fitted);
    assert_eq!(fitted["points"], 6);
    let slope = fitted["mu_prime"].as_f64().unwrap();
    assert!((slope / -0.694_444_444_444 - 1.0).abs() < 1e-6, "{fitted}");
    // 0.05 has no setting under velocity control.
    let told = folder.run(&["measure", "six.toml", "-o", "six.csv"]);
    assert!(
        err(&told).contains("warning: v0 = 0.05: no setting"),
        "{}",
        err(&told)
    );
    let law = ["point", "--friction", "table", "--table", "six.csv"];
    let table = [
        &law[..],
        &["--v0=0.8", "--alpha-n=-10", "--tau=0.5", "--json"],
    ]
    .concat();
    let read = folder.run(&table);
    expect(&read, 0, "did not settle");
    let mu = program::json(&read)["mu_k"].as_f64().unwrap();
    assert!((mu - 0.5 / 2.6).abs() < 1e-6, "{mu}");
}

/// The same numbers as JSON, as text on standard output and in a file, which is not replaced.
#[test]
fn answers_agree_and_files_stay() {
    let noisy = "sample_time = 0.1\nnoise = 0.001";
    let text = experiment("v0 = [0.1, 0.5]\naverage = 30\nrepeats = 4", noisy);
    let folder = Folder::with(&[("noisy.toml", &text)]);
    let json: Value = program::json(&folder.run(&["measure", "noisy.toml", "--json"]));
    let points = json["points"].as_array().unwrap();
    assert_eq!((points.len(), &json["settled"]), (2, &Value::from(2)));
    let told = out(&folder.run(&["measure", "noisy.toml"]));
    assert!(
        told.contains("standard deviation of one of 4 repeats\n"),
        "{told}"
    );
    let plain = folder.run(&["measure", "noisy.toml", "-o", "-"]);
    let rows = out(&plain);
    let rows: Vec<&str> = rows.lines().collect();
    assert_eq!(rows.len(), 3, "{rows:?}");
    for (row, point) in rows[1..].iter().zip(points) {
        let cells: Vec<&str> = row.split(',').collect();
        for (cell, key) in cells.iter().zip(["v0", "mu_k", "mu_k_error"]) {
            assert_eq!(cell.parse::<f64>().ok(), point[key].as_f64(), "{row}");
        }
        assert_eq!(cells[3], "true");
        let predicted = point["predicted"]["error"].as_f64().unwrap();
        assert_eq!(point["mu_k_error"].as_f64().unwrap(), predicted / 2.0);
    }
    expect(
        &folder.run(&["measure", "noisy.toml", "-o", "a.csv"]),
        0,
        "",
    );
    let again = ["measure", "noisy.toml", "-o", "a.csv"];
    expect(&folder.run(&again), 2, "a.csv is already there");
    expect(&folder.run(&[&again[..], &["--fresh"]].concat()), 0, "");
    expect(
        &folder.run(&["measure", "noisy.toml", "-o", "a.txt"]),
        2,
        "NAME.csv",
    );
    let both = ["measure", "noisy.toml", "-o", "-", "--json"];
    expect(&folder.run(&both), 2, "standard output");
    // Each file of slipmap is known for what it is.
    expect(
        &folder.run(&["simulate", "noisy.toml"]),
        2,
        "`slipmap measure` takes it",
    );
    expect(
        &folder.run(&["run", "noisy.toml"]),
        2,
        "`slipmap measure` takes it",
    );
}

/// What is wrong is underlined, with what to type.
#[test]
fn mistakes_are_told() {
    let case = "[fixed]\nv0 = 0.1\nalpha_n = -10\ntau = 0.5\n".to_owned() + LAW;
    let texts = [
        ("case.toml", case),
        ("lawless.toml", "[experiment]\nv0 = [0.1]\n".to_owned()),
        ("empty.toml", experiment("v0 = []", "")),
        ("average.toml", experiment("v0 = [0.1]\naverage = 0", "")),
        ("noise.toml", experiment("v0 = [0.1]", "noise = 0.001")),
        (
            "given.toml",
            experiment("v0 = [0.1]\nsetting = \"given\"", ""),
        ),
        ("searched.toml", experiment("v0 = [0.1]", "alpha_n = -10")),
        ("typo.toml", experiment("v0 = [0.1]\naverag = 3", "")),
        ("drift.toml", experiment("v0 = [0.1]\ndrift = \"3 mm\"", "")),
    ];
    let texts: Vec<(&str, &str)> = texts.iter().map(|(name, text)| (*name, &**text)).collect();
    let folder = Folder::with(&texts);
    let mut told = String::new();
    for (name, _) in &texts {
        let output = folder.run(&["measure", name]);
        assert_eq!(output.status.code(), Some(2), "{name}: {}", err(&output));
        told += &format!("{}\n", err(&output));
    }
    insta::assert_snapshot!(told);
}

/// A signal ends it soon, and leaves no file.
#[test]
fn a_signal_ends_it() {
    let noisy = "sample_time = 0.01\nnoise = 0.001";
    let long = "v0 = [0.1, 0.2, 0.3, 0.5]\naverage = 5000\nrepeats = 100000";
    let folder = Folder::with(&[("long.toml", &experiment(long, noisy))]);
    let started = folder.start(&["measure", "long.toml", "-o", "long.csv"]);
    std::thread::sleep(std::time::Duration::from_secs(2));
    started.signal("-INT");
    let ended = started.ended();
    expect(&ended, 130, "interrupted: there is no measurement");
    assert!(!folder.path().join("long.csv").exists());
}
