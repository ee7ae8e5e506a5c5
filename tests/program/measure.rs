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

/// In the SI the table names the unit of v0, from which `fit` and `--table` convert, and the columns
/// of the text stay apart.
#[test]
fn units_are_told_and_read_back() {
    let text = "units = \"SI\"\n[experiment]\nv0 = [\"1 mm/s\", \"3 mm/s\", \"9 mm/s\", \"30 mm/s\"]\n\
        average = 5.0\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.004\n\
        [fixed]\nmass = 1.3\nstiffness = 1700.0\nnormal_load = 9.81\n";
    let folder = Folder::with(&[("si.toml", text)]);
    let told = folder.run(&["measure", "si.toml", "-o", "si.csv", "--digits", "9"]);
    expect(&told, 0, "");
    let rows: Vec<String> = out(&told).lines().map(str::to_owned).collect();
    let cells = |row: &String| row.split_whitespace().count();
    let settled = rows.iter().filter(|row| row.ends_with("  yes"));
    assert_eq!(settled.map(cells).collect::<Vec<_>>(), [8; 4], "{rows:?}");
    let titles = rows.iter().position(|row| row.contains("relaxation"));
    let titles = titles.unwrap();
    for row in &rows[titles + 1..titles + 5] {
        assert_eq!(cells(row), 9, "{rows:?}");
    }
    assert!(rows[titles].contains(" alpha_n N m-1 "), "{rows:?}");
    let csv = std::fs::read_to_string(folder.path().join("si.csv")).unwrap();
    assert!(
        csv.starts_with("v0 [m s-1],mu_k,mu_k_error,settled\n0.001,0.4"),
        "{csv}"
    );
    // μ_K′ = −μ0/v_s/(1 + v0/v_s)² at 3 mm/s, in s/m, and in s/mm where that is the unit.
    let expected = -0.5 / 0.004 / (1.75 * 1.75);
    for (units, v0, times) in [("SI", "0.003", 1.0), ("N, mm, s", "3", 1e-3)] {
        let line = [
            "fit",
            "si.csv",
            "--units",
            units,
            "--v0",
            v0,
            "--law",
            "weakening",
        ];
        let fitted = program::json(&folder.run(&[&line[..], &["--json"]].concat()));
        let slope = fitted["mu_prime"].as_f64().unwrap() / times;
        assert!((slope / expected - 1.0).abs() < 1e-5, "{units}: {fitted}");
        let point = [
            "point",
            "--friction",
            "table",
            "--table",
            "si.csv",
            "--units",
            units,
        ];
        let block = ["--mass", "1.3", "--tau", "0", "--v0", v0, "--json"];
        let read = program::json(&folder.run(&[&point[..], &block].concat()));
        let mu = read["mu_k"].as_f64().unwrap();
        assert!((mu - 0.5 / 1.75).abs() < 1e-6, "{units}: {read}");
    }
}

/// A file that cannot be written is told before the work begins, even before the experiment is read.
#[test]
fn a_missing_folder_is_told_first() {
    let folder = Folder::new();
    let told = folder.run(&["measure", "none.toml", "-o", "nodir/x.csv"]);
    let error = err(&told);
    assert!(
        error.contains("nodir/x.csv") && !error.contains("none.toml"),
        "{error}"
    );
}

/// Without noise rounding is a bias of at most half a step, and no random error; with noise of a
/// step it is random.
#[test]
fn rounding_without_noise_is_bounded() {
    let readings = |noise: &str| format!("sample_time = 0.1\nresolution = 0.001\n{noise}");
    let keys = "v0 = [0.1, 0.5, 0.9]\naverage = 60\nrepeats = 2";
    let folder = Folder::with(&[
        ("step.toml", &experiment(keys, &readings(""))),
        ("both.toml", &experiment(keys, &readings("noise = 0.001"))),
    ]);
    let json = program::json(&folder.run(&["measure", "step.toml", "--json"]));
    for point in json["points"].as_array().unwrap() {
        let predicted = &point["predicted"];
        assert_eq!(predicted["error"], 0.0, "{point}");
        assert_eq!(predicted["bias_of_noise"], 0.0);
        assert_eq!(predicted["rounding_bound"], 0.0005);
        // All repeats are the same, and off by what is told.
        assert_eq!(point["scatter"], 0.0);
        assert!(point["off"].as_f64().unwrap().abs() <= 0.0005, "{point}");
    }
    let told = out(&folder.run(&["measure", "step.toml"]));
    assert!(
        told.contains("<= 0.0005") && told.contains("off by up to half a step, 0.0005,"),
        "{told}"
    );
    let json = program::json(&folder.run(&["measure", "both.toml", "--json"]));
    for point in json["points"].as_array().unwrap() {
        let predicted = &point["predicted"];
        assert_eq!(predicted["rounding_bound"], Value::Null);
        assert!(predicted["error"].as_f64().unwrap() > 0.0, "{point}");
    }
    let told = out(&folder.run(&["measure", "both.toml"]));
    assert!(
        !told.contains("<=") && !told.contains("half a step"),
        "{told}"
    );
}

/// Settings that stand no spread are not called robust; each has its own.
#[test]
fn what_is_not_robust_is_not_called_so() {
    let keys = "v0 = [0.09, 0.6]\ncontrol = \"velocity\"\naverage = 20\nwait = 20";
    let folder = Folder::with(&[("edge.toml", &experiment(keys, ""))]);
    let json = program::json(&folder.run(&["measure", "edge.toml", "--json"]));
    let spreads: Vec<&Value> = json["points"]
        .as_array()
        .unwrap()
        .iter()
        .map(|point| &point["spread"])
        .collect();
    assert!(spreads[0].is_null() && spreads[1].is_f64(), "{spreads:?}");
    let told = out(&folder.run(&["measure", "edge.toml"]));
    assert!(
        told.contains("each with its best setting, which is robust at 1 of 2\n"),
        "{told}"
    );
    assert!(!told.contains("best robust setting"), "{told}");
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
