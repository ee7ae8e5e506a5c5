//! `slipmap margins` and the fields of margins, by the real program.

use serde_json::Value;

use crate::program::{self, Folder, expect, out};

/// The letter's Fig. 3(a), by its friction law.
const FIG_3A: [&str; 12] = [
    "--friction",
    "weakening",
    "--mu0",
    "0.5",
    "--v-s",
    "0.5",
    "--v0",
    "0.35",
    "--alpha-v",
    "-0.33",
    "--tau",
    "4.15",
];

/// A rig in SI units: a time unit of 2/3 s, slopes in s/m.
const RIG: &str = "[units]
force = \"N\"
length = \"m\"
time = \"s\"
";

fn margins(args: &[&str]) -> Value {
    let folder = Folder::new();
    let output = folder.run(&[&["margins"], args, &["--json"]].concat());
    assert!(output.status.success(), "{}", program::err(&output));
    program::json(&output)
}

#[test]
fn margins_as_text() {
    let folder = Folder::new();
    let beyond = [
        "--memory",
        "0.3",
        "--latency",
        "0.05",
        "--sensor-lag",
        "0.1",
    ];
    for (name, args) in [
        ("beyond_the_letter", [&FIG_3A[..], &beyond].concat()),
        ("with_law", FIG_3A.to_vec()),
        (
            "with_decay",
            vec![
                "--mu-prime",
                "-0.3",
                "--alpha-n",
                "-3.65",
                "--tau",
                "0.465",
                "--decay",
                "0.1",
            ],
        ),
        (
            "unstable",
            vec!["--mu-prime", "-0.3", "--alpha-n", "-0.1", "--tau", "0.465"],
        ),
        (
            "idle",
            vec!["--mu-prime", "0.3", "--alpha-v", "-0.1", "--tau", "0.465"],
        ),
    ] {
        let output = folder.run(&[&["margins"], &*args].concat());
        insta::assert_snapshot!(format!("margins_{name}"), out(&output));
    }
}

#[test]
fn bad_requests_are_answered() {
    let folder = Folder::new();
    for (args, says) in [
        (["--decay", "-1"], "decay rate"),
        (["--decay", "nan"], "decay rate"),
        (["--decay", "inf"], "decay rate"),
        (["--tau", "-1"], "tau"),
    ] {
        let output = folder.run(&[&["margins", "--mu-prime", "-0.3"], &args[..]].concat());
        expect(&output, 2, says);
    }
}

/// The same setting in other units has the same margins in those.
#[test]
fn units_do_not_matter() {
    let plain = margins(&[
        "--mu-prime",
        "-0.3",
        "--alpha-v",
        "-0.1",
        "--alpha-n",
        "-3",
        "--tau",
        "0.5",
    ]);
    // M = 4, κ = 9, N0 = 3, μ_K = 0.5: √(M/κ) = 2/3, √(κM) = 6.
    let scaled = margins(&[
        "--mass",
        "4",
        "--stiffness",
        "9",
        "--normal-load",
        "3",
        "--mu-k",
        "0.5",
        "--mu-prime",
        "-0.6",
        "--alpha-v",
        "-0.15",
        "--alpha-n",
        "-54",
        "--tau",
        "0.3333333333333333",
    ]);
    let number = |of: &Value, path: &str| of.pointer(path).unwrap().as_f64().unwrap();
    for (path, unit) in [
        ("/gain_margin/lower", 1.0),
        ("/gain_margin/upper", 1.0),
        ("/phase_margin", 1.0),
        ("/latency_margin", 2.0 / 3.0),
        ("/tau_margin/lower", 2.0 / 3.0),
        ("/tau_margin/to", 2.0 / 3.0),
        ("/mu_prime_margin/from", 2.0),
        ("/stability_radius", 1.0),
    ] {
        let (a, b) = (number(&plain, path) * unit, number(&scaled, path));
        let allowed = if path == "/stability_radius" {
            1e-2
        } else {
            1e-11
        };
        assert!((a - b).abs() < allowed * a.abs(), "{path}: {a} {b}");
    }
}

#[test]
fn a_point_tells_its_margins() {
    let folder = Folder::new();
    let output = folder.run(&[&["point"], &FIG_3A[..], &["--json"]].concat());
    let point = program::json(&output);
    let alone = margins(&FIG_3A);
    for key in [
        "gain_margin",
        "phase_margin",
        "latency_margin",
        "v0_margin",
        "stability_radius",
    ] {
        assert_eq!(point[key], alone[key], "{key}");
    }
    let latency = point["latency_margin"].as_f64().unwrap();
    assert!((latency - 0.142666885165).abs() < 1e-12, "{latency}");
}

/// Cells of a map as rows of numbers by their names.
struct Rows {
    names: csv::StringRecord,
    rows: Vec<csv::StringRecord>,
}

impl Rows {
    fn read(text: &str) -> Self {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let names = reader.headers().unwrap().clone();
        let rows = reader.records().map(Result::unwrap).collect();
        Self { names, rows }
    }

    fn get(&self, row: &csv::StringRecord, name: &str) -> f64 {
        let column = self.names.iter().position(|n| n.starts_with(name));
        column.map_or(f64::NAN, |column| row[column].parse().unwrap_or(f64::NAN))
    }
}

/// Every cell of a map has what `margins` says at its setting, whatever the number of threads.
#[test]
fn maps_hold_the_margins_of_their_cells() {
    let sweep = format!(
        "fields = [\"n_unstable\", \"gain_margin_lower\", \"gain_margin_upper\", \
         \"phase_margin\", \"latency_margin\", \"stability_radius\"]\n{RIG}\
         [axes]\nalpha_n = {{ from = -60, to = 10, points = 8 }}\n\
         tau = {{ from = 0, to = 3, points = 7 }}\n\
         [fixed]\nmass = 4\nstiffness = 9\nnormal_load = 3\nmu_k = 0.5\nmu_prime = -0.2\n"
    );
    let folder = Folder::with(&[("margins.toml", &sweep)]);
    let cells = |threads: &str| {
        let run = folder.run(&["run", "margins.toml", "--fresh", "--threads", threads]);
        assert!(run.status.success(), "{}", program::err(&run));
        out(&folder.run(&["export", "margins.h5", "-o", "-"]))
    };
    let (one, four) = (cells("1"), cells("4"));
    assert_eq!(one, four);
    let cells = Rows::read(&one);
    let is_stable = |row: &&csv::StringRecord| cells.get(row, "n_unstable") == 0.0;
    let stable = cells.rows.iter().filter(is_stable).count();
    assert!((8..48).contains(&stable), "{stable}");
    for row in &cells.rows {
        check_cell(&|name| cells.get(row, name));
    }
}

/// The same with memory and latency, of the fields that do not take long.
#[test]
fn maps_hold_the_margins_of_their_cells_with_memory_and_latency() {
    let sweep = format!(
        "fields = [\"n_unstable\", \"gain_margin_lower\", \"gain_margin_upper\", \
         \"phase_margin\", \"latency_margin\", \"stability_radius\"]\n{RIG}\
         [axes]\nmemory = [-0.4, 0.0, 0.3]\nalpha_n = {{ from = -60, to = 10, points = 4 }}\n\
         tau = {{ from = 0, to = 1.5, points = 4 }}\n\
         [fixed]\nmass = 4\nstiffness = 9\nnormal_load = 3\nmu_k = 0.5\nmu_prime = -0.2\n\
         latency = 0.05\n"
    );
    let folder = Folder::with(&[("margins.toml", &sweep)]);
    let run = folder.run(&["run", "margins.toml", "--fresh"]);
    assert!(run.status.success(), "{}", program::err(&run));
    let cells = Rows::read(&out(&folder.run(&["export", "margins.h5", "-o", "-"])));
    let get = |row: &csv::StringRecord, name: &str| cells.get(row, name);
    let with_memory = |row: &&csv::StringRecord| {
        get(row, "n_unstable") == 0.0 && get(row, "memory") != 0.0 && get(row, "tau") > 0.0
    };
    let stable: Vec<_> = cells.rows.iter().filter(with_memory).collect();
    assert!((3..24).contains(&stable.len()), "{}", stable.len());
    for row in &stable {
        // Control keeps it stable that is unstable without.
        let [lower, upper] = ["gain_margin_lower", "gain_margin_upper"].map(|n| get(row, n));
        assert!(0.0 < lower && lower < 1.0 && 1.0 < upper, "{lower} {upper}");
        let rest = ["phase_margin", "latency_margin", "stability_radius"].map(|n| get(row, n));
        assert!(rest.iter().all(|margin| *margin > 0.0), "{rest:?}");
    }
    for row in &cells.rows {
        check_cell(&|name| cells.get(row, name));
    }
}

fn check_cell(held: &dyn Fn(&str) -> f64) {
    let [alpha_n, tau] = ["alpha_n", "tau"].map(|name| held(name).to_string());
    let memory = held("memory");
    let beyond = match memory.is_nan() {
        true => Vec::new(),
        false => vec![
            "--latency".to_owned(),
            "0.05".to_owned(),
            format!("--memory={memory}"),
        ],
    };
    let beyond: Vec<&str> = beyond.iter().map(String::as_str).collect();
    let plain = [
        "--units",
        "SI",
        "--mass",
        "4",
        "--stiffness",
        "9",
        "--normal-load",
        "3",
        "--mu-k",
        "0.5",
        "--mu-prime",
        "-0.2",
        "--alpha-n",
        &alpha_n,
        "--tau",
        &tau,
    ];
    let found = margins(&[&plain[..], &beyond].concat());
    let none = match held("n_unstable") {
        0.0 => f64::INFINITY,
        _ => f64::NAN,
    };
    for (name, path) in [
        ("gain_margin_lower", "/gain_margin/lower"),
        ("gain_margin_upper", "/gain_margin/upper"),
        ("phase_margin", "/phase_margin"),
        ("latency_margin", "/latency_margin"),
        ("stability_radius", "/stability_radius"),
    ] {
        let told = found.pointer(path).and_then(Value::as_f64).unwrap_or(none);
        let held = held(name);
        let equal = held == told || (held.is_nan() && told.is_nan());
        assert!(equal, "{name} at {alpha_n}, {tau}: {held} {told}");
    }
}
