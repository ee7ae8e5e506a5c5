//! `slipmap fit`: laws fitted to noisy points whose true law is known, what follows from their
//! errors, and what is refused.

use serde_json::Value;

use slipmap::answers::best::default_ranges;
use slipmap::answers::robust_to_fit::{error_of_fit, robust_to_fit};
use slipmap::answers::search_plane::SearchPlane;
use slipmap::fit::{FitError, FittedLaw, Wanted, fit};
use slipmap::linear::best::SearchedGain;
use slipmap::model::stop::Stop;
use slipmap::setting::measured::{CurveOptions, Measured};
use slipmap::setting::{Parameter, Setting};

use crate::chance::{Chance, asked};
use crate::program::{self, Folder, err, expect, out};

/// The velocity at which the slope is asked for.
const V0: f64 = 0.1;

fn truth(v: f64) -> f64 {
    0.3 + 0.2 * (-v / 0.05).exp()
}

/// μ_K′ of [`truth`] at [`V0`].
fn true_slope() -> f64 {
    -4.0 * (-2.0_f64).exp()
}

/// 60 points of a law between two velocities, with relative noise.
fn points(law: impl Fn(f64) -> f64, seed: u64, noise: f64, (from, to): (f64, f64)) -> String {
    let mut chance = Chance(seed);
    let mut text = "v,mu\n".to_owned();
    for i in 0..60 {
        let v = from + (to - from) * f64::from(i) / 59.0;
        text += &format!("{v},{}\n", law(v) * (1.0 + noise * chance.normal()));
    }
    text
}

/// The points of the issue: 1 % of noise.
fn noisy(seed: u64) -> String {
    points(truth, seed, 0.01, (0.005, 0.3))
}

fn fitted(text: &str, law: Option<&'static str>) -> Result<FittedLaw, FitError> {
    let curve = Measured::read(text, &CurveOptions::default()).expect("a curve");
    let mut setting = Setting::new(None);
    setting.set(Parameter::V0, V0);
    fit(&curve.points, Wanted { law, mu_s: None }, setting)
}

/// The 95 % interval of the slope holds the true one in about 95 of 100 cases, and a setting that
/// is robust against the errors is stable on the true curve.
#[test]
fn errors_of_the_slope_are_as_large_as_they_say() {
    let seeds = asked("SLIPMAP_CASES", 150);
    let first = asked("SLIPMAP_SEED", 0);
    let (mut held, mut stable) = (0, 0);
    for seed in first..first + seeds {
        let found = fitted(&noisy(seed), None).expect("a fit");
        let of = found.setting.fitted_sliding().unwrap().expect("errors");
        let off = (of.at.mu_prime - true_slope()).abs();
        held += u64::from(off <= found.errors_in_interval() * of.mu_prime_error);
        stable += u64::from(is_stable_in_truth(&found.setting));
    }
    println!("{held} intervals hold, {stable} settings are stable, of {seeds}");
    let share = held as f64 / seeds as f64;
    // Three standard deviations of a count, about the shares that are asked for.
    let chance = 3.0 * (0.05 * 0.95 / seeds as f64).sqrt();
    assert!((0.94 - chance..=0.96 + chance).contains(&share), "{held}");
    assert!(stable as f64 >= 0.995 * seeds as f64 - 1.0, "{stable}");
}

/// Whether the setting that `--robust fit` finds is stable on the true curve.
fn is_stable_in_truth(setting: &Setting) -> bool {
    let (gain, alpha, stop) = (SearchedGain::Velocity, Parameter::AlphaV, Stop::default());
    let error = error_of_fit(setting, gain).unwrap().expect("errors");
    let ranges = default_ranges(setting, &SearchPlane::with_delay(alpha)).unwrap();
    let found = robust_to_fit(setting, gain, &ranges, error, &stop).unwrap();
    let Some(found) = found.robust else {
        return false;
    };
    let mut at_truth = Setting::new(None);
    for (parameter, value) in [
        (Parameter::MuK, truth(V0)),
        (Parameter::MuPrime, true_slope()),
        (alpha, found.robust.gain),
        (Parameter::Tau, found.robust.tau),
    ] {
        at_truth.set(parameter, value);
    }
    let (linear, unit) = at_truth.linear().unwrap();
    let count = linear.roots(&stop).count(found.robust.tau, unit);
    count.is_some_and(|count| count.n_unstable == 0 && !count.marginal)
}

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = folder.run(args);
    expect(&output, 0, "");
    program::json(&output)
}

/// The name of a law, its curve and its parameters.
type TrueLaw<'a> = (&'a str, &'a dyn Fn(f64) -> f64, &'a [(&'a str, f64)]);

/// Points without noise give back the law they were made of, by its name.
#[test]
fn every_law_is_found_again() {
    let cosh = |v: f64| 0.3 + 0.2 / (v / 0.06).cosh() + 0.02 * v;
    let stribeck = |v: f64| 0.3 + 0.15 * (-(v / 0.08).powf(1.5)).exp() + 0.05 * v;
    let weakening = |v: f64| 0.5 / (1.0 + v / 0.4);
    let dip = |v: f64| 0.3 + 0.1 * (10.0 * v).cos();
    let laws: [TrueLaw; 4] = [
        (
            "hyperbolic",
            &cosh,
            &[
                ("mu0", 0.3),
                ("v_s", 0.06),
                ("mu_s", 0.5),
                ("viscous_coefficient", 0.02),
            ],
        ),
        (
            "stribeck",
            &stribeck,
            &[
                ("mu0", 0.3),
                ("v_s", 0.08),
                ("exponent", 1.5),
                ("viscous_coefficient", 0.05),
            ],
        ),
        ("weakening", &weakening, &[("mu0", 0.5), ("v_s", 0.4)]),
        ("spline", &dip, &[]),
    ];
    for (law, curve, parameters) in laws {
        let text = points(curve, 1, 1e-5, (0.002, 0.4));
        let folder = Folder::with(&[("data.csv", &text)]);
        let answer = json(&folder, &["fit", "data.csv", "--v0", "0.1", "--json"]);
        assert_eq!(answer["law"], law, "{answer}");
        assert_eq!(answer["chosen_by"], "BIC");
        for (name, value) in parameters {
            let found = answer["parameters"][name].as_f64().unwrap();
            let error = answer["standard_errors"][name].as_f64().unwrap();
            assert!(
                (found - value).abs() < 5.0 * error + 1e-9,
                "{law} {name}: {found} +- {error}"
            );
        }
        let slope = (curve(0.1 + 1e-6) - curve(0.1 - 1e-6)) / 2e-6;
        let (found, error) = (&answer["mu_prime"], &answer["mu_prime_error"]);
        let (found, error) = (found.as_f64().unwrap(), error.as_f64().unwrap());
        // A cubic through few points is not the cosine.
        let allowed = if law == "spline" { 0.05 } else { 5.0 * error };
        assert!(
            (found - slope).abs() < allowed,
            "{law}: {found} for {slope}"
        );
        let again = json(
            &folder,
            &["fit", "data.csv", "--v0", "0.1", "--json", "--law", law],
        );
        assert_eq!(again["mu_prime"], answer["mu_prime"]);
        assert_eq!(again["chosen_by"], "--law");
    }
}

/// Every number is a multiple of the decimal place just below a thousandth of its error.
#[test]
fn numbers_end_with_what_the_noise_leaves() {
    let folder = Folder::with(&[("data.csv", &noisy(1))]);
    let answer = json(&folder, &["fit", "data.csv", "--v0", "0.1", "--json"]);
    for (name, error) in answer["standard_errors"].as_object().unwrap() {
        let (value, error) = (
            answer["parameters"][name].as_f64().unwrap(),
            error.as_f64().unwrap(),
        );
        let place = 10_f64.powf((error / 1e3).log10().floor());
        let places = value / place;
        assert!(
            (places - places.round()).abs() < 1e-6,
            "{name}: {value} +- {error}"
        );
    }
    let files = folder.files();
    assert!(files.contains(&"data-fit.png".to_owned()), "{files:?}");
}

/// The saved setting goes through best, margins, point and vc, with the uncertainty of the fit.
#[test]
fn what_is_saved_carries_its_errors() {
    let folder = Folder::with(&[("data.csv", &noisy(3))]);
    let saved = folder.run(&["fit", "data.csv", "--v0", "0.1", "--save", "fit.toml"]);
    expect(&saved, 0, "");
    assert!(out(&saved).contains("fit.toml"), "{}", out(&saved));
    let best = [
        "best",
        "--setting",
        "fit.toml",
        "--control",
        "load",
        "--robust",
        "fit",
    ];
    let answer = json(
        &folder,
        &[&best[..], &["--save", "tuned.toml", "--json"]].concat(),
    );
    let robust = &answer["robust"];
    assert_eq!(robust["standard_errors"], 3.0);
    assert_eq!(robust["certified"], true);
    let told = out(&folder.run(&best));
    assert!(told.contains("3 standard errors of the fit"), "{told}");
    assert!(
        told.contains("of the friction law that was given"),
        "{told}"
    );
    let point = json(&folder, &["point", "--setting", "tuned.toml", "--json"]);
    let fit = &point["fit"];
    assert_eq!(fit["draws"], 1000);
    assert_eq!(fit["share"], 1.0);
    let (worst, here) = (&fit["worst_abscissa"], &point["abscissa"]);
    assert!(worst.as_f64().unwrap() > here.as_f64().unwrap());
    // The worst of 1,000 draws lies a little more than three errors away.
    let off = (fit["worst_mu_prime"].as_f64().unwrap() - point["mu_prime"].as_f64().unwrap()).abs();
    let errors = off / fit["mu_prime_error"].as_f64().unwrap();
    assert!((2.0..5.0).contains(&errors), "{errors}");
    let margins = out(&folder.run(&["margins", "--setting", "tuned.toml"]));
    assert!(
        margins.contains("of 1000 friction laws that the points allow"),
        "{margins}"
    );
    let vc = json(&folder, &["vc", "--setting", "tuned.toml", "--json"]);
    assert!(vc["vc"].as_f64().is_some_and(|vc| vc > 0.0), "{vc}");
}

/// Without control sliding is unstable for all laws that the points allow; with the draws that is
/// told as well.
#[test]
fn an_unstable_setting_has_a_share_too() {
    let folder = Folder::with(&[("data.csv", &noisy(3))]);
    expect(
        &folder.run(&["fit", "data.csv", "--v0", "0.1", "--save", "fit.toml"]),
        0,
        "",
    );
    let point = json(&folder, &["point", "--setting", "fit.toml", "--json"]);
    assert_eq!(
        (&point["n_unstable"], &point["fit"]["share"]),
        (&2.into(), &0.0.into())
    );
    let without = json(&folder, &["point", "--mu-prime=-0.3", "--json"]);
    assert!(without["fit"].is_null());
}

/// Averages of several readings count by their number and their spread.
#[test]
fn averages_count_by_their_readings() {
    let text = noisy(5);
    let again: String = text
        .lines()
        .skip(1)
        .map(|line| format!("{line}\n"))
        .collect();
    let twice = format!("{text}{again}");
    let folder = Folder::with(&[("once.csv", &text), ("twice.csv", &twice)]);
    let of = |file: &str| {
        json(
            &folder,
            &["fit", file, "--v0", "0.1", "--json", "--law", "stribeck"],
        )
    };
    let (once, twice) = (of("once.csv"), of("twice.csv"));
    assert_eq!(
        (&twice["points"], &twice["readings"]),
        (&60.into(), &120.into())
    );
    assert_eq!(once["parameters"], twice["parameters"]);
}

/// Arguments, a part of the message, and a part of the advice.
const REFUSED: &[(&[&str], &str, &str)] = &[
    (
        &["one.csv", "--v0", "0.1"],
        "one velocity",
        "at several velocities",
    ),
    (
        &["two.csv", "--v0", "0.1"],
        "2 velocities do not determine",
        "more velocities",
    ),
    (
        &["few.csv", "--v0", "0.1", "--law", "stribeck"],
        "3 velocities do not determine the 3",
        "more velocities",
    ),
    (
        &["rising.csv", "--v0", "0.1"],
        "no fall of friction",
        "--columns",
    ),
    (
        &["level.csv", "--v0", "0.1"],
        "no fall of friction",
        "--columns",
    ),
    (&["data.csv"], "--v0", ""),
    (&["data.csv", "--v0", "3kg"], "kg", ""),
    (&["data.csv", "--v0", "0"], "--v0 0", ""),
    (
        &["data.csv", "--v0", "0.1", "--law", "stribek"],
        "stribeck",
        "",
    ),
    (
        &["data.csv", "--v0", "0.1", "--columns", "speed=1,mu=7"],
        "7",
        "",
    ),
    (
        &["data.csv", "--v0", "0.1", "--save", "mine.toml"],
        "mine.toml",
        "remove it first",
    ),
    (
        &["data.csv", "--v0", "0.1", "--picture", "a.jpg"],
        "a.jpg",
        "fig.png",
    ),
    (&["none.csv", "--v0", "0.1"], "none.csv", ""),
    (
        &["data.csv", "--v0", "0.5", "--law", "spline"],
        "do not determine the parameters of the spline law",
        "near v0",
    ),
];

#[test]
fn what_determines_no_law_is_refused() {
    let rising = points(|v| 0.3 + 0.1 * v, 1, 0.003, (0.01, 0.5));
    let level = points(|_| 0.4, 2, 0.01, (0.01, 0.5));
    let folder = Folder::with(&[
        ("one.csv", "0.1,0.4\n0.1,0.41\n0.1,0.42\n"),
        ("few.csv", "0.1,0.5\n0.2,0.4\n0.3,0.36\n"),
        ("two.csv", "0.1,0.5\n0.2,0.4\n"),
        ("rising.csv", &rising),
        ("level.csv", &level),
        ("data.csv", &noisy(1)),
        ("mine.toml", "a = 1\n"),
    ]);
    for (args, says, help) in REFUSED {
        let output = folder.run(&[&["fit"], *args].concat());
        let said = err(&output);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
        assert!(
            said.contains(says) && said.contains(help),
            "{args:?}: {said}"
        );
    }
    let untouched = std::fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    assert_eq!(untouched, "a = 1\n");
}

/// After few points errors reach farther than those of many, and the draws with them.
#[test]
fn few_points_leave_more_open() {
    let text = noisy(7);
    let few: Vec<&str> = text.lines().step_by(9).collect();
    let few = format!("v,mu\n{}\n", few[1..].join("\n"));
    let folder = Folder::with(&[("few.csv", &few)]);
    let fit = ["fit", "few.csv", "--v0", "0.1", "--law", "weakening"];
    let answer = json(
        &folder,
        &[&fit[..], &["--json", "--save", "fit.toml"]].concat(),
    );
    let number = |name: &str| answer[name].as_f64().unwrap();
    let [from, to] = [0, 1].map(|i| answer["mu_prime_interval"][i].as_f64().unwrap());
    // 95 % of Student's distribution with four degrees of freedom.
    let factor = (to - from) / 2.0 / number("mu_prime_error");
    assert!((factor / 2.776 - 1.0).abs() < 2e-3, "{factor}");
    let saved = std::fs::read_to_string(folder.path().join("fit.toml")).unwrap();
    assert!(saved.contains("coverage_factor = 2.776"), "{saved}");
    let point = json(&folder, &["point", "--setting", "fit.toml", "--json"]);
    let off = point["fit"]["worst_mu_prime"].as_f64().unwrap() - number("mu_prime");
    let errors = off.abs() / number("mu_prime_error");
    assert!((3.0..7.0).contains(&errors), "{errors}");
    let best = "best --setting fit.toml --control velocity --robust fit --json";
    let best = json(&folder, &best.split(' ').collect::<Vec<_>>());
    let robust = &best["robust"];
    let [errors, of_slope] = [&robust["standard_errors"], &robust["spreads"][2]];
    let spread = errors.as_f64().unwrap() * number("mu_prime_error") / number("mu_prime").abs();
    let wider = of_slope.as_f64().unwrap() / spread;
    assert!((wider / (2.776 / 1.96) - 1.0).abs() < 2e-3, "{wider}");
}

/// Where laws are hardly told apart, the difference of their slopes is in the error, whatever the
/// size of friction; and the rig's two gains are one too many for the box of a fit.
#[test]
fn the_choice_of_a_law_is_part_of_the_error() {
    let law = |v: f64| 0.3 + 0.2 * (-v / 0.05).exp();
    let (once, fivefold) = (
        points(law, 4, 0.03, (0.03, 0.3)),
        points(|v| 5.0 * law(v), 4, 0.03, (0.03, 0.3)),
    );
    let folder = Folder::with(&[("once.csv", &once), ("fivefold.csv", &fivefold)]);
    let fit = |file: &str, more: &[&str]| {
        json(
            &folder,
            &[&["fit", file, "--v0", "0.1", "--json"], more].concat(),
        )
    };
    let (once, fivefold) = (
        fit("once.csv", &["--save", "fit.toml"]),
        fit("fivefold.csv", &["--mu-s", "4", "--law", "stribeck"]),
    );
    let alone = fit("once.csv", &["--law", once["law"].as_str().unwrap()]);
    let error = |of: &Value| of["mu_prime_error"].as_f64().unwrap();
    assert!(error(&once) > 1.05 * error(&alone), "{once} {alone}");
    assert_eq!(once["standard_errors"], alone["standard_errors"]);
    assert!(error(&fivefold) > error(&alone));
    let setting = std::fs::read_to_string(folder.path().join("fit.toml")).unwrap();
    let both = setting.replace("alpha_v = 0.0", "alpha_v = -0.2");
    std::fs::write(folder.path().join("both.toml"), both).unwrap();
    let args = [
        "best",
        "--setting",
        "both.toml",
        "--control",
        "load",
        "--robust",
        "fit",
    ];
    expect(
        &folder.run(&args),
        2,
        "is for one gain, and alpha_v is another",
    );
}

/// Errors in a setting file's fit are told at their place.
#[test]
fn a_fit_that_does_not_fit_is_told_in_its_place() {
    let with = |fit: &str| {
        format!(
            "[fixed]\nv0 = 0.1\ntau = 0\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n\
             [friction.fit]\n{fit}"
        )
    };
    let good = with(
        "parameters = [\"mu0\", \"v_s\"]\nstandard_errors = [0.01, 0.02]\ncorrelations = [[], [0.3]]\n",
    );
    let folder = Folder::with(&[("good.toml", &good)]);
    let point = json(&folder, &["point", "--setting", "good.toml", "--json"]);
    // μ_K = μ0/(1 + v/v_s): to first order by hand.
    let (mu0, v_s, v) = (0.5_f64, 0.5_f64, 0.1_f64);
    let q = 1.0 + v / v_s;
    let (of_mu0, of_v_s) = (0.01 / q, 0.02 * mu0 * v / (v_s * v_s) / (q * q));
    let expected = (of_mu0 * of_mu0 + of_v_s * of_v_s + 2.0 * 0.3 * of_mu0 * of_v_s).sqrt();
    let found = point["fit"]["mu_k_error"].as_f64().unwrap();
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    for (fit, says) in [
        (
            "parameters = [\"mu_0\"]\nstandard_errors = [1]\ncorrelations = [[]]\n",
            "mu0",
        ),
        (
            "parameters = [\"mu0\"]\nstandard_errors = [1, 2]\ncorrelations = [[]]\n",
            "2 numbers for 1",
        ),
        (
            "parameters = [\"mu0\"]\nstandard_errors = [-1]\ncorrelations = [[]]\n",
            "0 or more",
        ),
        (
            "parameters = [\"mu0\"]\nstandard_errors = [1e308]\ncorrelations = [[]]\n",
            "[bad.toml:10:19]",
        ),
        (
            "parameters = [\"mu0\"]\nstandard_errors = [1]\ncorrelations = [[1]]\n",
            "row i has i numbers",
        ),
        (
            "parameters = [\"mu0\"]\nstandard_errors = [1]\n",
            "correlations is not given",
        ),
        (
            "parameters = [\"mu0\"]\nstandard_erors = [1]\n",
            "standard_errors",
        ),
        (
            "parameters = [\"mu0\", \"v_s\"]\nstandard_errors = [1, 1]\ncorrelations = [[], [2]]\n",
            "-1 to 1",
        ),
    ] {
        let text = with(fit);
        let folder = Folder::with(&[("bad.toml", &text)]);
        let output = folder.run(&["point", "--setting", "bad.toml"]);
        assert_eq!(output.status.code(), Some(2), "{fit}");
        assert!(err(&output).contains(says), "{fit}: {}", err(&output));
    }
}

/// A raw curve whose points contradict its slope says so wherever that slope is used.
#[test]
fn the_slope_of_a_raw_curve_is_doubted() {
    let text = noisy(1);
    let rows: Vec<String> = text.lines().skip(1).map(|row| format!("[{row}]")).collect();
    let sweep = format!(
        "[axes]\ntau = [1.0]\nalpha_v = [-0.3]\n[fixed]\nv0 = 0.1\n[friction]\nlaw = \"table\"\ntable = [{}]\n",
        rows.join(", ")
    );
    let smooth = points(truth, 1, 0.0, (0.005, 0.3));
    let folder = Folder::with(&[
        ("data.csv", &text),
        ("smooth.csv", &smooth),
        ("sweep.toml", &sweep),
    ]);
    let of = |command: &str, data: &str| {
        let law = ["--friction", "table", "--table", data, "--v0", "0.1"];
        let extra: &[&str] = if command == "best" {
            &[]
        } else {
            &["--alpha-v=-0.3", "--tau", "4"]
        };
        err(&folder.run(&[&[command], &law[..], extra].concat()))
    };
    for command in ["point", "margins", "best"] {
        let told = of(command, "data.csv");
        assert!(
            told.contains("is not sure") && told.contains("slipmap fit"),
            "{command}: {told}"
        );
        assert!(
            !of(command, "smooth.csv").contains("is not sure"),
            "{command}"
        );
    }
    let told = err(&folder.run(&["run", "sweep.toml", "-o", "map.h5"]));
    assert!(told.contains("is not sure"), "{told}");
    let margins = folder.run(&[
        "margins",
        "--friction",
        "table",
        "--table",
        "smooth.csv",
        "--v0",
        "0.1",
        "--alpha-n=-8",
        "--tau",
        "0.5",
    ]);
    assert!(
        out(&margins).contains("proved of the curve that was given"),
        "{}",
        out(&margins)
    );
}
