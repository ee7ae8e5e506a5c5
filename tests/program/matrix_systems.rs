//! Systems of matrices and of powers of the delay, from files through the real program: against the
//! table of matrices, closed forms, and the same systems as polynomials.

use crate::program::{self, Folder, err, expect, out};
use serde_json::Value;
use std::f64::consts::PI;

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(&[&["point", "--json"], args].concat());
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", err(&output));
    program::json(&output)
}

fn point(system: &str, tau: f64) -> Value {
    let folder = Folder::with(&[("system.toml", system)]);
    json(
        &folder,
        &["--system", "system.toml", "--tau", &tau.to_string()],
    )
}

fn near(found: &Value, expected: f64, allowed: f64, what: &str) {
    let number = found.as_f64().unwrap_or(f64::NAN);
    let apart = (number - expected).abs();
    assert!(
        apart <= allowed * expected.abs().max(1.0),
        "{what}: {found}, not {expected}"
    );
}

/// Every fourth row of the table, as a file has it.
#[test]
fn matrices_of_the_table_are_read_from_files() {
    let table = std::fs::read_to_string("tests/reference/matrices.csv").unwrap();
    let rows: Vec<&str> = table.lines().filter(|line| line.contains('[')).collect();
    assert_eq!(rows.len(), 60);
    for row in rows.into_iter().step_by(4) {
        let parts: Vec<&str> = row.split('"').collect();
        let numbers: Vec<f64> = parts[4].split(',').filter_map(|n| n.parse().ok()).collect();
        let [tau, n, re, im] = numbers[..] else {
            panic!("{row}")
        };
        let found = point(&format!("A0 = {}\nA1 = {}\n", parts[1], parts[3]), tau);
        assert_eq!(found["n_unstable"], n as u64, "{row}");
        let root = &found["roots"][0];
        near(&root[0], re, 1e-9, row);
        near(&root[1], im.abs(), 1e-9 * (1.0 + im.abs()), row);
    }
}

/// ω and the delays at which ±iω are roots of cars on a ring, for modes of 2π/3 and −2π/3:
/// λ(λ + α) = α b (e^(iφ) − 1) e^(−λτ).
fn crossings_of_the_ring(alpha: f64, b: f64) -> (f64, [f64; 2]) {
    let square = 0.5 * (-alpha * alpha + (alpha.powi(4) + 12.0 * (alpha * b).powi(2)).sqrt());
    let omega = square.sqrt();
    let late = (omega / alpha).atan();
    let turn = |angle: f64| (angle - late).rem_euclid(2.0 * PI) / omega;
    (omega, [turn(PI / 3.0), turn(2.0 * PI / 3.0)])
}

#[test]
fn cars_on_a_ring_are_those_of_their_modes() {
    let sweep = "system = \"ring_road\"\nfields = [\"n_unstable\", \"abscissa\", \"frequency\", \
        \"delay_margin\", \"essential_abscissa\"]\n[axes]\nb = [0.2, 0.5, 0.9]\n\
        tau = [0.0, 0.4, 1.1, 3.7]\n[fixed]\nalpha = 1.3\n";
    let folder = Folder::with(&[("sweep.toml", sweep)]);
    let run = folder.run(&["run", "sweep.toml", "-o", "map.h5", "--quiet"]);
    assert_eq!(run.status.code(), Some(0), "{}", err(&run));
    expect(&folder.run(&["verify", "map.h5"]), 0, "");
    for b in [0.2, 0.5, 0.9] {
        let (omega, firsts) = crossings_of_the_ring(1.3, b);
        for tau in [0.4, 1.1, 3.7] {
            let (b_at, tau_at) = (format!("b={b}"), format!("tau={tau}"));
            let at = ["--map", "map.h5", "--at", &*b_at, "--at", &*tau_at];
            let of_cell = json(&folder, &at);
            let asked = ["--system", "ring_road", "--set", "alpha=1.3", "--set"];
            let asked = json(
                &folder,
                &[&asked[..], &[&*b_at, "--tau", &tau.to_string()]].concat(),
            );
            let below = |first: f64| ((tau - first) * omega / (2.0 * PI) + 1.0).floor().max(0.0);
            let n = 2.0 * firsts.map(below).iter().sum::<f64>();
            for found in [&of_cell, &asked] {
                assert_eq!(found["n_unstable"].as_f64(), Some(n), "{b} {tau}");
                assert_eq!(found["certified"], true, "{b} {tau}: {found}");
            }
            let first = firsts[0].min(firsts[1]);
            near(&asked["delay_margin"], first - tau, 1e-11, "margin");
            let cell = ["export", "map.h5", "--at", &*b_at, "--at", &*tau_at];
            let rows = out(&folder.run(&cell));
            let cell = rows.lines().last().unwrap();
            assert!(cell.starts_with(&format!("{b},{tau},{n},")), "{rows}");
        }
    }
}

#[test]
fn every_form_of_one_system_is_that_system() {
    let parameters = "[parameters]\nk = 0.4\ng = -0.3\n";
    let of = |text: &str| point(&format!("{text}\n{parameters}"), 1.3);
    let expected = of("P = \"s^2 + 0.1*s + k + 1\"\nQ = \"-g*s + k\"");
    let a0 = "A0 = [[0, 1], [\"-1 - k\", -0.1]]";
    for text in [
        format!("{a0}\nA1 = [[0, 0], [\"-k\", \"g\"]]"),
        format!("{a0}\nfeedback = {{ B = [[0], [1]], C = [[\"-k\", \"g\"]] }}"),
        format!("{a0}\nfeedback = {{ B = [[0], [2]], K = [[0.5]], C = [[\"-k\", \"g\"]] }}"),
        "D = [[1, 0.1, \"1 + k\"], \"k - g*s\"]".to_owned(),
    ] {
        let found = of(&text);
        for key in [
            "n_unstable",
            "n_at_zero_delay",
            "stable",
            "reason",
            "certified",
        ] {
            assert_eq!(found[key], expected[key], "{key} of {text}");
        }
        for key in ["abscissa", "delay_margin", "first_crossing"] {
            near(&found[key], expected[key].as_f64().unwrap(), 1e-10, &text);
        }
    }
    // (s + z)(s + k z): ±i at odd quarters of a turn, ±ik where k τ is.
    let powers = "D = [\"s^2\", \"(1 + k)*s\", \"k\"]\n[parameters]\nk = 2\n";
    for (tau, n) in [(0.3, 0), (1.0, 2), (2.0, 4), (5.0, 6)] {
        let found = point(powers, tau);
        assert_eq!(found["n_unstable"], n, "{tau}");
        near(&found["delay_margin"], PI / 4.0 - tau, 1e-11, "powers");
    }
}

/// x'(t) − e x'(t − τ) = −x(t): roots accumulate at ln |e|/τ.
#[test]
fn delayed_rates_have_where_their_roots_accumulate() {
    let system = |e: f64| format!("A0 = [[-1]]\nA1 = [[0]]\nE1 = [[{e}]]\n");
    let found = point(&system(0.5), 2.0);
    near(
        &found["essential_abscissa"],
        0.5_f64.ln() / 2.0,
        1e-12,
        "essential",
    );
    assert_eq!(found["n_unstable"], 0);
    let found = point(&system(1.5), 2.0);
    assert_eq!(
        (&found["reason"], &found["n_unstable"]),
        (&"infinite".into(), &Value::Null)
    );
}

#[test]
fn what_is_not_known_of_matrices_is_refused() {
    let best = ["best", "--system", "ring_road", "--search", "b"];
    expect(
        &Folder::new().run(&best),
        2,
        "best settings are not searched of a system of matrices that is no exact P",
    );
    let sweep = "system = \"ring_road\"\nboundaries = true\n[axes]\nb = [0.1, 0.2]\ntau = [1, 2]\n";
    let folder = Folder::with(&[("sweep.toml", sweep)]);
    let run = folder.run(&["run", "sweep.toml", "-o", "map.h5"]);
    expect(
        &run,
        2,
        "boundaries: of a system of matrices that is no exact P + Q exp(-s tau)",
    );
    let odd = "A0 = [[\"1/k\"]]\nA1 = [[1]]\n[parameters]\nk = 0\n";
    let folder = Folder::with(&[("odd.toml", odd)]);
    let asked = folder.run(&["point", "--system", "odd.toml", "--tau", "1"]);
    expect(&asked, 2, "A0[0][0]: `1/k` has no finite value");
}

/// Two masses with one delayed signal, as matrices and by their polynomials.
const TWO_MASSES: [&str; 2] = [
    "A0 = [[0, 0, 1, 0], [0, 0, 0, 1], [-2, 1, -0.25, 0], [1, -1, 0, -0.25]]\n\
     feedback = { B = [[0], [0], [0], [1]], C = [[0, \"-g\", 0, \"-h\"]] }\n\
     [parameters]\ng = 0.3\nh = 0.25\n",
    "P = \"(s^2 + 0.25*s + 2)*(s^2 + 0.25*s + 1) - 1\"\n\
     Q = \"(g + h*s)*(s^2 + 0.25*s + 2)\"\n\
     [parameters]\ng = 0.3\nh = 0.25\n",
];

#[test]
fn curves_of_one_delayed_signal_are_those_of_polynomials() {
    let sweep = |system: &str| {
        format!(
            "system = \"{system}.toml\"\nfields = [\"n_unstable\", \"abscissa\"]\n\
             boundaries = true\n[axes]\ng = {{ from = 0.0, to = 1.5, points = 6 }}\n\
             tau = {{ from = 0.0, to = 9.0, points = 10 }}\n"
        )
    };
    let (m, p) = (sweep("m"), sweep("p"));
    let [of_m, of_p] = TWO_MASSES;
    let files = [
        ("m.toml", of_m),
        ("p.toml", of_p),
        ("ms.toml", &m),
        ("ps.toml", &p),
    ];
    let folder = Folder::with(&files);
    let tables = ["m", "p"].map(|name| {
        let (sweep, map) = (format!("{name}s.toml"), format!("{name}.h5"));
        expect(&folder.run(&["run", &sweep, "-o", &map, "--quiet"]), 0, "");
        ["boundaries", "cells"].map(|table| {
            let rows = out(&folder.run(&["export", &map, "--table", table]));
            assert!(rows.lines().count() > 60, "{rows}");
            rows
        })
    });
    let [of_matrices, of_polynomials] = tables;
    for (one, other) in of_matrices.iter().zip(&of_polynomials) {
        assert_eq!(one.lines().count(), other.lines().count());
        for (a, b) in one.lines().zip(other.lines()) {
            for (a, b) in a.split(',').zip(b.split(',')) {
                match (a.parse::<f64>(), b.parse::<f64>()) {
                    (Ok(x), Ok(y)) if x.is_finite() => {
                        assert!((x - y).abs() <= 1e-9 * (1.0 + y.abs()), "{a} {b}");
                    }
                    _ => assert_eq!(a, b),
                }
            }
        }
    }
}

#[test]
fn best_settings_of_one_delayed_signal_are_those_of_polynomials() {
    let [of_matrices, of_polynomials] = TWO_MASSES.map(|system| {
        let folder = Folder::with(&[("system.toml", system)]);
        let asked = [
            "best",
            "--json",
            "--system",
            "system.toml",
            "--search",
            "g",
            "--search-from",
            "-1",
            "--search-to",
            "1",
            "--tau-to",
            "8",
        ];
        let found = folder.run(&asked);
        assert_eq!(found.status.code(), Some(0), "{}", err(&found));
        program::json(&found)["best"].clone()
    });
    for key in ["value", "tau", "abscissa"] {
        let expected = of_polynomials[key]
            .as_f64()
            .unwrap_or_else(|| panic!("{of_polynomials}"));
        near(&of_matrices[key], expected, 1e-7, key);
    }
}
