//! Margins of systems from files through the real program: closed forms, counts on both sides of
//! limits, maps, and bad input; and the frequencies that margins of the block come from.

use std::f64::consts::PI;

use hdf5::File;
use num_complex::Complex64;
use serde_json::Value;

use crate::program::{self, Folder, err, expect, out};

const TANK: &str = "P = \"s*(time*s + 1)\"\nQ = \"k_p*s + k_i\"\n[parameters]\n\
    time = 4\nk_p = 1.5\nk_i = 0.6\n";

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(&[args, &["--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", err(&output));
    program::json(&output)
}

fn number(told: &Value, name: &str) -> f64 {
    let found = told
        .pointer(name)
        .unwrap_or_else(|| panic!("{name} in {told}"));
    found.as_f64().unwrap_or(f64::NAN)
}

fn near(found: f64, expected: f64, allowed: f64) {
    let apart = (found - expected).abs();
    assert!(
        apart <= allowed * expected.abs().max(1.0),
        "{found}, not {expected}"
    );
}

/// k e^(−sτ)/s.
#[test]
fn an_integrator_has_its_closed_form() {
    let folder = Folder::with(&[("tank.toml", "P = \"s\"\nQ = \"k\"\n[parameters]\nk = 0.5\n")]);
    let told = json(
        &folder,
        &["margins", "--system", "tank.toml", "--tau", "0.7"],
    );
    let (k, tau) = (0.5, 0.7);
    for (name, expected) in [
        ("/gain_margin/lower", 0.0),
        ("/gain_margin/upper", PI / (2.0 * k * tau)),
        ("/crossing_frequencies/gain_margin/upper", PI / (2.0 * tau)),
        ("/phase_margin", 0.5 * PI - k * tau),
        ("/crossing_frequencies/phase_margin", k),
        ("/latency_margin", PI / (2.0 * k) - tau),
        ("/tau_margin/upper", PI / (2.0 * k) - tau),
        ("/crossing_frequencies/tau_margin/upper", k),
    ] {
        near(number(&told, name), expected, 1e-12);
    }
    for name in [
        "/mu_prime_margin",
        "/v0_margin",
        "/stability_radius",
        "/tau_margin/from",
    ] {
        assert!(told.pointer(name).unwrap().is_null(), "{name}: {told}");
    }
    assert_eq!(told["undecided"], serde_json::json!(["stability_radius"]));
}

/// What is told is where points change, and where 1 + k L is 0.
#[test]
fn margins_are_where_points_change() {
    let folder = Folder::with(&[("tank.toml", TANK)]);
    let told = json(
        &folder,
        &["margins", "--system", "tank.toml", "--tau", "0.8"],
    );
    let count = |gain: f64, tau: f64| {
        let sets = [("k_p", 1.5), ("k_i", 0.6)].map(|(name, k)| format!("{name}={:e}", gain * k));
        let tau = tau.to_string();
        let args = [
            "--system",
            "tank.toml",
            "--set",
            &sets[0],
            "--set",
            &sets[1],
            "--tau",
            &tau,
        ];
        number(
            &json(&folder, &[&["point"], &args[..]].concat()),
            "/n_unstable",
        )
    };
    let going_round = |omega: f64, tau: f64| {
        let s = Complex64::new(0.0, omega);
        (1.5 * s + 0.6) * (-s * tau).exp() / (s * (4.0 * s + 1.0))
    };
    let upper = number(&told, "/gain_margin/upper");
    assert_eq!(
        (
            count(upper * (1.0 - 1e-8), 0.8),
            count(upper * (1.0 + 1e-8), 0.8)
        ),
        (0.0, 2.0)
    );
    let omega = number(&told, "/crossing_frequencies/gain_margin/upper");
    assert!((1.0 + upper * going_round(omega, 0.8)).norm() < 1e-9);
    let to = number(&told, "/tau_margin/to");
    assert_eq!((count(1.0, to - 1e-8), count(1.0, to + 1e-8)), (0.0, 2.0));
    let omega = number(&told, "/crossing_frequencies/tau_margin/upper");
    assert!((1.0 + going_round(omega, to)).norm() < 1e-9);
    let phase = number(&told, "/phase_margin");
    let omega = number(&told, "/crossing_frequencies/phase_margin");
    near((-going_round(omega, 0.8)).arg(), phase, 1e-9);
    let modulus = number(&told, "/modulus_margin");
    let distances = (1..20_000).map(|k| (1.0 + going_round(1e-3 * f64::from(k), 0.8)).norm());
    near(distances.fold(f64::INFINITY, f64::min), modulus, 1e-6);
    let text = out(&folder.run(&["margins", "--system", "tank.toml", "--tau", "0.8"]));
    let begin = "the system is stable; it stays so\n  gain_margin      up to ";
    assert!(text.starts_with(begin), "{text}");
    assert!(!text.contains("stability_radius"), "{text}");
}

/// Cells of maps are what `margins` tells of them, of P and Q and of B and A.
#[test]
fn cells_of_maps_are_margins() {
    let fields = "fields = [\"gain_margin_lower\", \"gain_margin_upper\", \"phase_margin\", \
        \"latency_margin\", \"modulus_margin\"]\n";
    let late = "B = \"s^2 + 0.3*s + 1\"\nA = \"k\"\n[parameters]\nk = -0.2\n";
    let tank = format!(
        "system = \"tank.toml\"\n{fields}[axes]\nk_p = [0.5, 1.5, 9.0]\n\
        tau = [0.2, 0.8]\n[fixed]\ntime = 4\nk_i = 0.6\n"
    );
    let of_b = format!(
        "system = \"late.toml\"\n{fields}[axes]\nk = [-0.4, -0.1, 0.9]\n\
        tau = [0.5, 2.5]\n[fixed]\nlatency = 0.1\n"
    );
    let folder = Folder::with(&[
        ("tank.toml", TANK),
        ("late.toml", late),
        ("pq.toml", &tank),
        ("of_b.toml", &of_b),
    ]);
    for (sweep, name, values, taus) in [
        ("pq.toml", "k_p", ["0.5", "1.5", "9"], ["0.2", "0.8"]),
        ("of_b.toml", "k", ["-0.4", "-0.1", "0.9"], ["0.5", "2.5"]),
    ] {
        let map = sweep.replace("toml", "h5");
        expect(&folder.run(&["run", sweep, "-o", &map, "--quiet"]), 0, "");
        expect(&folder.run(&["verify", &map]), 0, "");
        let file = File::open(folder.path().join(&map)).unwrap();
        let column = |field: &str| file.dataset(field).unwrap().read_2d::<f64>().unwrap();
        for (i, j) in (0..3).flat_map(|i| (0..2).map(move |j| (i, j))) {
            let at = [format!("{name}={}", values[i]), format!("tau={}", taus[j])];
            let at = ["margins", "--map", &map, "--at", &at[0], "--at", &at[1]];
            let told = json(&folder, &at);
            let stable = told["decays"] == true;
            let cell = |field: &str| column(field)[[i, j]];
            // Infinite where nothing is lost.
            let same = |field: &str, name: &str| {
                let found = number(&told, name);
                let infinite = found.is_nan() && cell(field) == f64::INFINITY;
                assert!(
                    infinite || cell(field) == found,
                    "{field}: {} {told}",
                    cell(field)
                );
            };
            same("latency_margin", "/latency_margin");
            same("phase_margin", "/phase_margin");
            same("modulus_margin", "/modulus_margin");
            match stable {
                true => {
                    same("gain_margin_lower", "/gain_margin/lower");
                    same("gain_margin_upper", "/gain_margin/upper");
                }
                false => assert!(cell("gain_margin_upper").is_nan()),
            }
        }
    }
}

/// Of matrices what their crossings tell: the rest is told as not known.
#[test]
fn matrices_have_phase_and_latency_margins() {
    // k e^(−sτ)/s as matrices, beside a state of its own.
    let system = "A0 = [[0, 0], [0, -1]]\nA1 = [[-0.5, 0], [0, -0.2]]\n";
    let sweep = |field: &str| {
        format!("system = \"two.toml\"\nfields = [\"{field}\"]\n[axes]\ntau = [0.3, 0.7]\n")
    };
    let folder = Folder::with(&[
        ("two.toml", system),
        ("phase.toml", &sweep("phase_margin")),
        ("gain.toml", &sweep("gain_margin_upper")),
    ]);
    let args = ["margins", "--system", "two.toml", "--tau", "0.7"];
    let told = json(&folder, &args);
    near(number(&told, "/phase_margin"), 0.5 * PI - 0.35, 1e-9);
    near(number(&told, "/latency_margin"), PI - 0.7, 1e-9);
    near(
        number(&told, "/crossing_frequencies/latency_margin"),
        0.5,
        1e-9,
    );
    assert!(told["gain_margin"].is_null() && told["modulus_margin"].is_null());
    let undecided = serde_json::json!(["gain_margin", "modulus_margin", "stability_radius"]);
    assert_eq!(told["undecided"], undecided);
    let text = out(&folder.run(&args));
    assert!(
        text.contains("gain_margin      not known of a system of matrices"),
        "{text}"
    );
    assert!(
        text.contains("modulus_margin   not known of a system of matrices"),
        "{text}"
    );
    expect(
        &folder.run(&["run", "phase.toml", "-o", "map.h5", "--quiet"]),
        0,
        "",
    );
    let file = File::open(folder.path().join("map.h5")).unwrap();
    let phases = file
        .dataset("phase_margin")
        .unwrap()
        .read_1d::<f64>()
        .unwrap();
    near(phases[1], number(&told, "/phase_margin"), 1e-12);
    let refused = folder.run(&["plan", "gain.toml"]);
    expect(
        &refused,
        2,
        "gain_margin_upper is not known of a system of matrices",
    );
    expect(
        &refused,
        2,
        "phase_margin, latency_margin and delay_margin are",
    );
}

#[test]
fn what_has_no_margins_is_told() {
    let axis = "P = \"(s^2 + 1)*(s + 1)\"\nQ = \"0.3*(s^2 + 1)\"\n";
    let folder = Folder::with(&[
        ("tank.toml", TANK),
        ("axis.toml", axis),
        ("fast.toml", "P = \"s + 1\"\nQ = \"1 + 2*s\"\n"),
        (
            "open.toml",
            "P = \"(1 - 1/3*3)*s^2 + (0.1 + 0.2 - 0.3)*s + 1\"\nQ = \"0.5\"\n",
        ),
        ("zero.toml", "P = \"s + 1\"\nQ = \"s - 1\"\n"),
    ]);
    let of =
        |file: &str, more: &[&str]| folder.run(&[&["margins", "--system", file], more].concat());
    let late = ["--tau", "9"];
    expect(
        &of("tank.toml", &late),
        0,
        "the system is unstable (2 roots): no margins",
    );
    expect(
        &of("axis.toml", &late),
        0,
        "is not known to be stable: no margins",
    );
    expect(
        &of("fast.toml", &late),
        0,
        "is not known to be stable: no margins",
    );
    expect(
        &of("open.toml", &late),
        0,
        "is not known to be stable: no margins",
    );
    expect(
        &of("zero.toml", &late),
        2,
        "|P| = |Q| on all of the imaginary axis",
    );
    expect(&of("tank.toml", &[]), 2, "--tau is not given");
    let decay = of("tank.toml", &["--tau", "0.8", "--decay", "0.1"]);
    expect(
        &decay,
        2,
        "--decay: margins of a system from a file are those of stability alone",
    );
    expect(&decay, 2, "leave --decay out");
    let told = json(&folder, &["margins", "--system", "tank.toml", "--tau", "9"]);
    assert_eq!(
        (&told["decays"], &told["gain_margin"]),
        (&false.into(), &Value::Null)
    );
    assert!(told["crossing_frequencies"]["gain_margin"]["upper"].is_null());
}

/// The letter's loop is −A (1 − E)/B.
#[test]
fn margins_of_the_block_tell_their_frequencies() {
    let folder = Folder::new();
    let args = [
        "margins",
        "--mu-prime=-0.3",
        "--alpha-v=-0.33",
        "--tau=4.15",
    ];
    let told = json(&folder, &args);
    let going_round = |b: f64, omega: f64, tau: f64| {
        let s = Complex64::new(0.0, omega);
        0.33 * (b + s) * (1.0 - (-s * tau).exp()) / (s * s + b * s + 1.0)
    };
    let omega = |name: &str| number(&told, &format!("/crossing_frequencies/{name}"));
    let zero = |distance: Complex64| assert!(distance.norm() < 1e-8, "{distance} in {told}");
    for side in ["lower", "upper"] {
        let gain = number(&told, &format!("/gain_margin/{side}"));
        let at = omega(&format!("gain_margin/{side}"));
        zero(1.0 + gain * going_round(-0.3, at, 4.15));
        let end = if side == "lower" { "from" } else { "to" };
        let tau = number(&told, &format!("/tau_margin/{end}"));
        zero(1.0 + going_round(-0.3, omega(&format!("tau_margin/{side}")), tau));
    }
    let slope = number(&told, "/mu_prime_margin/from");
    zero(1.0 + going_round(slope, omega("mu_prime_margin/lower"), 4.15));
    let latency = Complex64::new(
        0.0,
        -omega("latency_margin") * number(&told, "/latency_margin"),
    );
    zero(1.0 + going_round(-0.3, omega("latency_margin"), 4.15) * latency.exp());
    let phase = (-going_round(-0.3, omega("phase_margin"), 4.15))
        .arg()
        .abs();
    near(phase, number(&told, "/phase_margin"), 1e-8);
    let modulus = number(&told, "/modulus_margin");
    near(
        (1.0 + going_round(-0.3, omega("modulus_margin"), 4.15)).norm(),
        modulus,
        1e-9,
    );
    let distance = |k: u32| (1.0 + going_round(-0.3, 1e-4 * f64::from(k), 4.15)).norm();
    near(
        (1..100_000).map(distance).fold(f64::INFINITY, f64::min),
        modulus,
        1e-6,
    );
}
