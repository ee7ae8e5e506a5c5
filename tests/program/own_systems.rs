//! Systems of one's own as people write them, through the real program: Greek names, expressions of
//! tens of kilobytes, roots at 0 that come from the form.

use crate::program::{self, Folder, err, expect, out};
use serde_json::Value;

const PLAIN: &str = "P = \"s^2 + 2*zeta*w_0*s + w_0^2\"\nQ = \"-mu*cos(0.785398163397448279)\"\n\
    [parameters]\nzeta = 0.05\nw_0 = 2\nmu = 0.1\n";
const GREEK: &str = "P = \"s^2 + 2*ζ*ω*s + ω^2\"\nQ = \"-\u{b5}*cos(π/4)\"\n\
    [parameters]\n\"ζ\" = 0.05\n\"ω\" = 2\n\"\u{3bc}\" = 0.1\n";
const SWEEP: &str = "system = \"SYSTEM\"\nfields = [\"n_unstable\", \"abscissa\", \"delay_margin\"]\n\
    [axes]\nOMEGA = { from = 1, to = 3, points = 5 }\ntau = { from = 0.5, to = 9.5, points = 10 }\n\
    [fixed]\nMU = 0.4\n";

fn sweep(system: &str, [omega, mu]: [&str; 2]) -> String {
    let text = SWEEP.replace("SYSTEM", system).replace("OMEGA", omega);
    text.replace("MU", mu)
}

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(args);
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", err(&output));
    program::json(&output)
}

fn run(folder: &Folder, sweep: &str, map: &str) {
    let output = folder.run(&["run", sweep, "-o", map, "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    expect(&folder.run(&["verify", map]), 0, "");
}

/// What a map says is what it says with the names spelled out, cell by cell and curve by curve.
#[test]
fn greek_names_are_names_everywhere() {
    let plain = sweep("plain.toml", ["w_0", "mu"]);
    let greek = sweep("greek.toml", ["\"ω\"", "\"\u{b5}\""]);
    let folder = Folder::with(&[
        ("plain.toml", PLAIN),
        ("greek.toml", GREEK),
        ("plain_sweep.toml", &*plain),
        ("greek_sweep.toml", &*greek),
    ]);
    run(&folder, "plain_sweep.toml", "plain.h5");
    run(&folder, "greek_sweep.toml", "greek.h5");
    for more in [&[][..], &["--table", "boundaries"]] {
        let rows = |map: &str| out(&folder.run(&[&["export", map], more].concat()));
        let (plain, greek) = (rows("plain.h5"), rows("greek.h5"));
        assert!(plain.lines().count() > 40 && greek.contains('ω'), "{greek}");
        assert_eq!(greek.replace('ω', "w_0"), plain);
    }
    let of_cell = [
        "point", "--json", "--map", "greek.h5", "--at", "ω=2", "--at", "τ=3.5",
    ];
    let of_map = json(&folder, &of_cell);
    let sets = ["--set", "ω=2", "--set", "\u{b5}=0.4", "--set", "τ=3.5"];
    let asked = [&["point", "--json", "--system", "greek.toml"], &sets[..]].concat();
    let found = json(&folder, &asked);
    for key in ["n_unstable", "roots", "parameters"] {
        assert_eq!(of_map[key], found[key], "{key}");
    }
    assert_eq!(found["parameters"]["\u{3bc}"], 0.4);
    let output = folder.run(&["plot", "greek.h5", "-o", "greek.png"]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
}

/// A map of a system whose text is longer than 64 kB in all is written and read back.
#[test]
fn long_expressions_go_through_maps() {
    let terms = vec!["0.001*k*s*(1 - c)"; 3000].join(" + ");
    let system = format!(
        "P = \"s^2 + 1 + {terms}\"\nQ = \"-k + 0*({terms})\"\n[parameters]\nk = 0.05\nc = 0.5\n"
    );
    let sweep = "system = \"long.toml\"\nfields = [\"n_unstable\", \"abscissa\"]\n\
        boundaries = false\n[axes]\nk = [0.05, 0.3]\ntau = [1.0, 2.5]\n";
    let folder = Folder::with(&[("long.toml", &*system), ("sweep.toml", sweep)]);
    run(&folder, "sweep.toml", "map.h5");
    let of_map = [
        "point", "--json", "--map", "map.h5", "--at", "k=0.3", "--at", "tau=2.5",
    ];
    let of_map = json(&folder, &of_map);
    // The sum of 3000 equal terms is 1.5 k s.
    let short = "P = \"s^2 + 1.5*k*s + 1\"\nQ = \"-k\"\n[parameters]\nk = 0.3\n";
    let folder = Folder::with(&[("short.toml", short)]);
    let asked = ["point", "--json", "--system", "short.toml", "--tau", "2.5"];
    let short = json(&folder, &asked);
    assert_eq!(of_map["n_unstable"], short["n_unstable"]);
    let [long, short] = [&of_map, &short].map(|of| of["abscissa"].as_f64().unwrap());
    assert!((long - short).abs() < 1e-10, "{long} {short}");
    let output = folder.run(&["info", "map.h5"]);
    assert!(out(&output).lines().all(|line| line.len() < 5000));
}

/// s + k (1 − e^(−sτ))/s times s, with other systems beside it.
fn distributed_delays() -> Folder {
    let system = |ignored: &str, p: &str, q: &str| {
        format!("{ignored}\nP = \"{p}\"\nQ = \"{q}\"\n[parameters]\nk = 2\n")
    };
    let (p, q) = ("s^2 + k", "-k");
    let shared = ("s^4 + 0.2*s^3 + s^2", "-0.25*k*s^2");
    Folder::with(&[
        ("one.toml", &*system("ignore_roots_at_zero = 1", p, q)),
        ("none.toml", &*system("", p, q)),
        ("two.toml", &*system("ignore_roots_at_zero = 2", p, q)),
        ("other.toml", &*system("ignore_roots_at_zero = 1", p, "-1")),
        ("odd.toml", &*system("ignore_roots_at_zero = 1.5", p, q)),
        (
            "shared.toml",
            &*system("ignore_roots_at_zero = 2", shared.0, shared.1),
        ),
        ("plain.toml", &*system("", "s^2 + 0.2*s + 1", "-0.25*k")),
        (
            "sweep.toml",
            "system = \"one.toml\"\nfields = [\"n_unstable\", \"abscissa\", \"delay_margin\"]\n\
                [axes]\nk = [0.5, 2.0]\ntau = [0.8, 2.0, 5.0]\n",
        ),
    ])
}

fn point_of(folder: &Folder, system: &str, tau: &str) -> Value {
    json(
        folder,
        &["point", "--json", "--system", system, "--tau", tau],
    )
}

/// ±i√(2k) cross at τ = π/√(2k) and at its odd multiples.
#[test]
fn roots_at_zero_of_a_distributed_delay_do_not_count() {
    let folder = distributed_delays();
    let stable = point_of(&folder, "one.toml", "0.8");
    let half_turn = 0.5 * std::f64::consts::PI;
    assert_eq!(
        (&stable["n_unstable"], &stable["stable"]),
        (&0.into(), &true.into())
    );
    assert_eq!(
        (&stable["certified"], &stable["reason"]),
        (&true.into(), &Value::Null)
    );
    let margin = stable["delay_margin"].as_f64().unwrap();
    assert!((margin - (half_turn - 0.8)).abs() < 1e-12, "{margin}");
    assert!(stable["abscissa"].as_f64().unwrap() < -0.1);
    assert_eq!(
        point_of(&folder, "none.toml", "0.8")["reason"],
        "root-at-origin"
    );
    run(&folder, "sweep.toml", "map.h5");
    let rows = out(&folder.run(&["export", "map.h5"]));
    let cell = |k: f64, tau: f64| {
        let crossed = (tau * (2.0 * k).sqrt() / (4.0 * half_turn) + 0.5).floor();
        format!("\n{k},{tau},{}", 2.0 * crossed)
    };
    for (k, tau) in [(0.5, 0.8), (0.5, 5.0), (2.0, 0.8), (2.0, 2.0), (2.0, 5.0)] {
        assert!(rows.contains(&cell(k, tau)), "{} in {rows}", cell(k, tau));
    }
}

#[test]
fn what_polynomials_share_is_divided_out_and_no_more() {
    let folder = distributed_delays();
    let shared = point_of(&folder, "shared.toml", "1.7");
    for key in ["n_unstable", "roots", "stable_delays"] {
        let plain = &point_of(&folder, "plain.toml", "1.7")[key];
        assert_eq!(shared[key], *plain, "{key}");
    }
    for (system, says) in [
        ("two.toml", "of the roots of D, 1 stays at 0 at every delay"),
        ("other.toml", "D has no root at 0 at every delay here"),
        ("odd.toml", "expected a whole number"),
    ] {
        let output = folder.run(&["point", "--system", system, "--tau", "1"]);
        expect(&output, 2, says);
    }
    let best = ["best", "--system", "one.toml", "--search", "k"];
    expect(&folder.run(&best), 2, "best settings are not searched");
}
