//! Digital loops from the command line: points, margins, maps, motions with noise, bad input.

use serde_json::Value;

use crate::program::{self, Folder, err, expect, out};

const LETTER: [&str; 4] = ["--mu-prime=-0.3", "--alpha-v=-0.33", "--tau", "4.2"];

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(args);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    program::json(&output)
}

fn of_letter<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&[command], &LETTER[..], more].concat()
}

/// A row of `rig_sampled.csv`, and the letter's own point with rare readings.
#[test]
fn a_point_tells_its_spectral_radius() {
    let folder = Folder::new();
    let row = [
        "point",
        "--mu-prime=0.08869164813549879",
        "--alpha-v=-0.31277025768000316",
        "--alpha-n=-6.535311495164769",
        "--tau=0.5061444168731654",
        "--sample-time=0.04217870140609711",
        "--json",
    ];
    let told = json(&folder, &row);
    assert_eq!(told["n_unstable"], 0);
    let radius = told["spectral_radius"].as_f64().unwrap();
    assert!((radius - 0.9874786725).abs() < 1e-9, "{radius}");
    assert_eq!(told["certified"], true);
    let told = json(&folder, &of_letter("point", &["--json"]));
    assert_eq!(told["spectral_radius"], Value::Null);
    let told = out(&folder.run(&of_letter("point", &["--sample-time=0.6"])));
    assert!(told.contains("in whole samples"), "{told}");
}

/// What `margins` tells is where points change.
#[test]
fn margins_are_where_points_change() {
    let folder = Folder::new();
    let told = json(
        &folder,
        &of_letter("margins", &["--sample-time=0.07", "--json"]),
    );
    let count = |gain: f64, tau: f64, latency: f64| {
        let (gain, tau) = (
            format!("--alpha-v={:.17}", -0.33 * gain),
            format!("--tau={tau:.12}"),
        );
        let latency = format!("--latency={latency:.12}");
        let of = ["point", "--mu-prime=-0.3", "--sample-time=0.07", "--json"];
        let all = [&of[..], &[&gain, &tau, &latency]].concat();
        json(&folder, &all)["n_unstable"].as_u64().unwrap()
    };
    let number = |name: &str| told.pointer(name).unwrap().as_f64().unwrap();
    for (name, side) in [("/gain_margin/lower", -1.0), ("/gain_margin/upper", 1.0)] {
        let factor = number(name);
        assert_eq!(count(factor * (1.0 - side * 1e-6), 4.2, 0.0), 0, "{name}");
        assert_ne!(count(factor * (1.0 + side * 1e-6), 4.2, 0.0), 0, "{name}");
    }
    for (name, side) in [("/tau_margin/from", -1.0), ("/tau_margin/to", 1.0)] {
        let tau = number(name);
        assert_eq!(count(1.0, tau - side * 0.07, 0.0), 0, "{name}");
        assert_ne!(count(1.0, tau, 0.0), 0, "{name}");
    }
    let latency = number("/latency_margin");
    assert_eq!(count(1.0, 4.2, latency), 0);
    assert_ne!(count(1.0, 4.2, latency + 0.07), 0);
    let undecided = told["undecided"].as_array().unwrap();
    assert!(undecided.contains(&"stability_radius".into()), "{told}");
}

/// A map over the sample time, whose counts the argument principle confirms.
#[test]
fn a_map_has_cells_of_digital_loops() {
    const SWEEP: &str = "
        fields = [\"n_unstable\", \"abscissa\", \"spectral_radius\", \"delay_margin\"]
        [axes]
        sample_time = [0.1, 0.3, 0.35, 0.6, 4.2]
        alpha_v = { from = -1.0, to = 0.2, points = 61 }
        [fixed]
        mu_prime = -0.3
        tau = 4.2
    ";
    let folder = Folder::with(&[("loop.toml", SWEEP)]);
    expect(&folder.run(&["run", "loop.toml", "-o", "loop.h5"]), 0, "");
    expect(&folder.run(&["verify", "loop.h5"]), 0, "");
    let told = json(&folder, &["info", "loop.h5", "--json"]);
    assert_eq!(told["cells"], 305, "{told}");
    for (line, place) in [
        ("fields = [\"gain_margin_lower\"]", "gain_margin_lower"),
        ("best = true\nfields = [\"n_unstable\"]", "best"),
        ("boundaries = true\nfields = [\"n_unstable\"]", "boundaries"),
    ] {
        let fields = SWEEP.lines().nth(1).unwrap().trim();
        let text = SWEEP.replace(fields, line).replace("[0.1,", "[0.14, 0.2, ");
        std::fs::write(folder.path().join("bad.toml"), text).unwrap();
        expect(&folder.run(&["plan", "bad.toml"]), 2, place);
    }
}

/// A plane of whole samples has best settings. Motions whose delay lies between samples are outside
/// the model, as those with noise and without readings.
#[test]
fn planes_and_motions_are_of_whole_samples() {
    const PLANE: &str = "
        best = true
        fields = [\"n_unstable\"]
        [axes]
        alpha_v = { from = -1.0, to = 0.2, points = 31 }
        tau = { from = 0.35, to = 8.4, points = 24 }
        [fixed]
        mu_prime = -0.3
        sample_time = 0.35
    ";
    const MOTIONS: &str = "
        fields = [\"outcome\"]
        [axes]
        sample_time = [0.0, 0.14, 0.35, 0.4]
        [fixed]
        v0 = 0.35
        tau = 4.2
        alpha_v = -0.33
        noise = 1e-4
        [friction]
        law = \"weakening\"
        mu0 = 0.5
        v_s = 0.5
    ";
    let folder = Folder::with(&[("plane.toml", PLANE), ("motions.toml", MOTIONS)]);
    for name in ["plane", "motions"] {
        let [sweep, map] = ["toml", "h5"].map(|ending| format!("{name}.{ending}"));
        expect(&folder.run(&["run", &sweep, "-o", &map]), 0, "");
        expect(&folder.run(&["verify", &map]), 0, "");
    }
    let told = json(&folder, &["info", "plane.h5", "--json"]);
    assert!(told["best"].is_object(), "{told}");
    // Without readings there is no noise, and 4.2 is no multiple of 0.4.
    let told = json(&folder, &["info", "motions.h5", "--json"]);
    assert_eq!(told["status"]["outside_model"], 2, "{told}");
}

/// The same seed gives the same motion, another one another.
#[test]
fn noise_is_that_of_the_seed() {
    let folder = Folder::new();
    let simulate = |seed: &str, noise: &str| {
        let (seed, noise) = (format!("--seed={seed}"), format!("--noise={noise}"));
        let law = [
            "simulate",
            "--friction",
            "weakening",
            "--mu0=0.5",
            "--v-s=0.5",
            "--v0=0.35",
        ];
        let digital = [
            "--alpha-v=-0.33",
            "--tau=4.2",
            "--sample-time=0.14",
            "--json",
            "--fresh",
        ];
        out(&folder.run(&[&law[..], &digital, &[&seed, &noise]].concat()))
    };
    let one = simulate("7", "0.001");
    assert_eq!(one, simulate("7", "0.001"));
    let numbers = |text: &str| serde_json::from_str::<Value>(text).unwrap()["peak_force"].clone();
    assert_ne!(numbers(&one), numbers(&simulate("8", "0.001")));
    assert!(simulate("7", "0").contains("\"sliding\""));
}

#[test]
fn what_cannot_be_sampled_is_told() {
    let folder = Folder::new();
    for (flags, told) in [
        (
            &["--sample-time=5"][..],
            "--tau = 4.2 is shorter than --sample-time = 5",
        ),
        (
            &["--sample-time=0.4"],
            "the nearest ones are 4 and 4.4; --round-delay",
        ),
        (
            &["--sample-time=-1"],
            "--sample-time -1 is outside its range",
        ),
        (&["--noise=0.1"], "give --sample-time as well"),
        (&["--noise=-0.1"], "--noise -0.1 is outside its range"),
        (
            &["--sample-time=0.6", "--load-lag=0.1"],
            "--load-lag = 0.1 does not go with",
        ),
        (
            &["--sample-time=0.6", "--latency=0.7"],
            "the nearest ones are 0.6 and 1.2",
        ),
    ] {
        expect(&folder.run(&of_letter("point", flags)), 2, told);
    }
    let rounded = folder.run(&of_letter("point", &["--sample-time=0.4", "--round-delay"]));
    expect(&rounded, 0, "tau = 4");
    assert!(
        err(&rounded).contains("--tau 4.2 is rounded to 4"),
        "{}",
        err(&rounded)
    );
}

/// Best settings lie on whole samples, and come with a critical velocity where a law is known.
#[test]
fn best_settings_are_of_whole_samples() {
    let folder = Folder::new();
    let law = ["--friction=weakening", "--mu0=0.5", "--v-s=0.5", "--v0=0.5"];
    let best = |more: &[&str]| {
        let of = ["best", "--control=load", "--sample-time=0.1"];
        folder.run(&[&of[..], &law[..], more].concat())
    };
    let found: serde_json::Value = serde_json::from_str(&out(&best(&["--json"]))).unwrap();
    let samples = found["best"]["tau"].as_f64().unwrap() / 0.1;
    assert!(
        (samples - samples.round()).abs() < 1e-9 && samples > 0.5,
        "{samples}"
    );
    assert_eq!(found["best"]["certified"], true);
    assert!(found["vc"]["vc_upper"].as_f64().is_some_and(|vc| vc < 0.5));
    for (flags, told) in [
        (&["--robust=0.05"][..], "a robust setting is searched"),
        (&["--tau-to=0.05"], "a multiple of it is in the range"),
        (&["--tau-to=5000"], "20000 samples at most"),
    ] {
        expect(&best(flags), 2, told);
    }
}

#[test]
fn critical_velocities_are_of_whole_samples() {
    let folder = Folder::new();
    let vc = |more: &[&str]| {
        let of = [
            "vc",
            "--friction=weakening",
            "--mu0=0.5",
            "--v-s=0.5",
            "--alpha-n=-10",
            "--tau=0.5",
        ];
        folder.run(&[&of[..], more].concat())
    };
    let held = vc(&["--sample-time=0.025"]);
    expect(&held, 0, "above 0.0235");
    let between = vc(&["--sample-time=0.2"]);
    expect(&between, 2, "the nearest ones are 0.4 and 0.6");
    expect(&vc(&["--sample-time=0.1", "--load-lag=0.1"]), 2, "load-lag");
}
