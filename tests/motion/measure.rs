//! Friction measured through control: the law that was put in comes back, and errors are as large
//! as they are predicted to be.

use std::sync::Arc;

use slipmap::answers::measure::Prospect;
use slipmap::explore::measure::{Foretold, MeasuredV0, PredictedErrors};
use slipmap::setting::ExperimentSpec;
use slipmap::sweep::events::Attended;

/// The letter's law of Fig. 3.
const LETTER: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
const EXPONENTIAL: &str =
    "[friction]\nlaw = \"formula\"\nmu_k = \"mu0*exp(-v/v_s)\"\nmu0 = 0.5\nv_s = 0.5\n";

fn foretold(experiment: &str, law: &str, fixed: &str, seed: u64) -> Foretold {
    let text = format!("seed = {seed}\n[experiment]\n{experiment}\n{law}[fixed]\n{fixed}\n");
    let spec: ExperimentSpec = text.parse().unwrap_or_else(|e| panic!("{text}: {e}"));
    let never = Arc::default();
    Foretold::of(spec, 2, Attended::silently(&never)).unwrap()
}

fn measured(experiment: &str, law: &str, fixed: &str, seed: u64) -> Vec<MeasuredV0> {
    let never = Arc::default();
    let foretold = foretold(experiment, law, fixed, seed);
    let found = foretold.measured(2, Attended::silently(&never));
    found.unwrap().points
}

fn one(experiment: &str, law: &str, fixed: &str, seed: u64) -> MeasuredV0 {
    measured(experiment, law, fixed, seed).remove(0)
}

fn predicted(point: &MeasuredV0) -> &PredictedErrors {
    point.predicted.as_ref().expect("sliding is stable")
}

const TEN: &str = "v0 = { from = 0.02, to = 2.0, points = 10, spacing = \"log\" }\n";

/// The law of Fig. 3 comes back at ten v0, each with a setting chosen for it, with v_c below v0;
/// without control something else does.
#[test]
fn the_law_comes_back_under_load_control() {
    for point in measured(TEN, LETTER, "", 0) {
        let v0 = point.v0;
        let law = 0.5 / (1.0 + v0 / 0.5);
        assert!(point.settled && point.prospect == "safe", "{point:?}");
        assert!(point.vc < v0 && point.spread.is_some(), "{point:?}");
        assert!((point.mu_k - law).abs() < 1e-6, "{point:?}");
        assert_eq!((point.mu_k_error, point.law), (0.0, point.law));
        assert!((point.law - law).abs() < 1e-15, "{point:?}");
        assert!(!point.uncontrolled_settled, "{point:?}");
        assert!((point.uncontrolled - law).abs() > 1e-3, "{point:?}");
    }
}

/// The letter's law also from stick-slip, where control has to end it first.
#[test]
fn the_law_comes_back_from_stick_slip() {
    let experiment = "v0 = [0.05, 0.1]\nstart = \"stick-slip\"\nwait = 200\n";
    for point in measured(experiment, LETTER, "", 0) {
        assert!(point.settled, "{point:?}");
        assert!(point.off.abs() < 1e-6, "{point:?}");
    }
}

/// Fig. 3(b)'s setting is stable at v0 = 0.02, below its v_c of 0.02154: it measures right from
/// near sliding and not from stick-slip, as was foreseen.
#[test]
fn below_vc_it_depends_on_the_start() {
    let given = "alpha_n = -10\ntau = 0.5";
    let at = |start: &str| {
        let experiment = format!("v0 = [0.02]\nsetting = \"given\"\nstart = \"{start}\"\n");
        one(&experiment, LETTER, given, 0)
    };
    let (near, far) = (at("sliding"), at("stick-slip"));
    assert_eq!((near.prospect, far.prospect), ("below-vc", "below-vc"));
    assert!((near.vc - 0.021540).abs() < 1e-6, "{}", near.vc);
    assert!((near.abscissa.unwrap() + 0.814).abs() < 1e-3, "{near:?}");
    assert!(near.settled && near.off.abs() < 1e-6, "{near:?}");
    assert_eq!(
        (far.settled, far.unsettled),
        (false, Some("stops")),
        "{far:?}"
    );
    assert!(far.off.abs() > 0.01 && far.mu_k.is_finite(), "{far:?}");
}

/// Velocity control has no setting below v0 = 0.0869628463, where b = b*.
#[test]
fn velocity_control_names_what_has_no_setting() {
    let experiment = "v0 = [0.02, 0.05, 0.0869, 0.08696, 0.08697, 0.0875]\ncontrol = \"velocity\"\n\
        wait = 1\naverage = 1\n";
    let foretold = foretold(experiment, LETTER, "", 0);
    let found = foretold.foreseen().iter().map(|of| of.prospect);
    let (none, below) = (Prospect::NoSetting, Prospect::BelowVc);
    assert_eq!(
        found.collect::<Vec<_>>(),
        [none, none, none, none, below, below]
    );
    let never = Arc::default();
    let found = foretold.measured(2, Attended::silently(&never)).unwrap();
    for point in &found.points[..4] {
        assert_eq!(point.unsettled, Some("no-setting"));
        assert!(point.mu_k.is_nan() && !point.settled && point.uncontrolled.is_finite());
    }
}

/// Dashpots are taken off: κa = μ_K N0 + c_g v0, in units of the block.
#[test]
fn dashpots_and_units_are_taken_off() {
    let fixed = "mass = 2\nstiffness = 8\nnormal_load = 5\nviscous = 0.4\ndamping = 0.3";
    let law = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.6\n";
    for control in ["load", "velocity"] {
        let experiment = format!("v0 = [0.7, 1.5]\ncontrol = \"{control}\"\n");
        for point in measured(&experiment, law, fixed, 0) {
            let expected = 0.5 / (1.0 + point.v0 / 0.6);
            assert!(point.settled, "{point:?}");
            assert!((point.mu_k - expected).abs() < 1e-6, "{point:?}");
        }
    }
}

/// Ten settings: the standard deviation over 200 seeds is 0.85 to 1.15 of the standard error that
/// is predicted.
#[test]
fn errors_over_200_seeds_are_as_predicted() {
    let given = "setting = \"given\"\nwait = 40\n";
    let load = "alpha_n = -10\ntau = 0.5\nsample_time = 0.05\nnoise = 0.0005";
    let velocity = "alpha_v = -0.24\ntau = 3.4\nsample_time = 0.1\nnoise = 0.001";
    let coulomb = "[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n";
    for (number, (v0, average, law, fixed)) in [
        (0.2, 50.0, LETTER, load.to_owned()),
        (0.2, 1.0, LETTER, load.to_owned()),
        (0.5, 20.0, EXPONENTIAL, load.to_owned()),
        (1.0, 30.0, coulomb, load.to_owned()),
        (
            0.5,
            50.0,
            LETTER,
            format!("{load}\nmemory = 0.3\nlatency = 0.1"),
        ),
        (0.5, 50.0, LETTER, format!("{load}\nresolution = 0.001")),
        (
            0.5,
            50.0,
            LETTER,
            format!("{load}\ndamping = 0.1\nviscous = 0.05"),
        ),
        (1.0, 60.0, LETTER, velocity.to_owned()),
        (1.0, 10.0, LETTER, format!("{velocity}\ndamping = 0.2")),
        (1.0, 60.0, LETTER, format!("{velocity}\nalpha_n = -0.1")),
    ]
    .into_iter()
    .enumerate()
    {
        let experiment = format!("v0 = [{v0}]\naverage = {average}\nrepeats = 200\n{given}");
        let point = one(&experiment, law, &fixed, 1000 * number as u64);
        assert!(point.settled, "{number} {point:?}");
        let share = point.scatter / predicted(&point).error;
        println!("{number}: {share:.3} of {:.3e}", predicted(&point).error);
        assert!(
            (0.85..=1.15).contains(&share),
            "{number}: {share} {point:?}"
        );
        // The mean over all of them is as sure as is told.
        let off = (point.off - point.bias()).abs();
        assert!(off < 4.0 * point.mu_k_error, "{number}: {off} {point:?}");
    }
}

/// The bias from noise, freed from the noise of the mean itself: Coulomb friction has none under
/// this control, and the same readings have the same noise.
fn bias(law: &str, fixed: &str, v0: f64) -> (f64, f64) {
    let experiment = format!("v0 = [{v0}]\nsetting = \"given\"\nwait = 60\naverage = 20000\n");
    let coulomb = "[friction]\nlaw = \"coulomb\"\nmu0 = 0.4\n";
    let (found, without) = (
        one(&experiment, law, fixed, 5),
        one(&experiment, coulomb, fixed, 5),
    );
    assert!(found.settled && without.settled, "{found:?} {without:?}");
    assert_eq!(predicted(&without).bias_of_noise, 0.0);
    (found.off - without.off, predicted(&found).bias_of_noise)
}

/// Under load control the bias is 0 for the letter's law, and grows as σ² for an exponential one.
#[test]
fn the_bias_is_that_of_second_order() {
    let load = |noise: f64| format!("alpha_n = -6\ntau = 0.5\nsample_time = 0.05\nnoise = {noise}");
    let (small, expected) = bias(EXPONENTIAL, &load(0.01), 0.4);
    assert!((small / expected - 1.0).abs() < 0.1, "{small} {expected}");
    let (large, expected) = bias(EXPONENTIAL, &load(0.02), 0.4);
    assert!((large / expected - 1.0).abs() < 0.1, "{large} {expected}");
    assert!((large / small / 4.0 - 1.0).abs() < 0.1, "{small} {large}");
    let (letter, expected) = bias(LETTER, &load(0.02), 0.4);
    assert!(expected.abs() < 1e-9 * large.abs(), "{expected}");
    assert!(letter.abs() < 0.1 * large.abs(), "{letter} {large}");
    // Velocity control has a bias with the letter's law too.
    let velocity = "alpha_v = -0.24\ntau = 3.4\nsample_time = 0.1\nnoise = 0.01";
    let (found, expected) = bias(LETTER, velocity, 1.0);
    assert!(
        expected > 0.0 && (found / expected - 1.0).abs() < 0.15,
        "{found} {expected}"
    );
}

/// A drift of v0 moves the mean as predicted, to the first order in it.
#[test]
fn a_drift_moves_the_mean_as_predicted() {
    for (control, fixed) in [
        ("load", ""),
        ("load", "damping = 0.2\nviscous = 0.1"),
        ("velocity", "damping = 0.1"),
        ("load", "sample_time = 0.05\nmemory = 0.2"),
    ] {
        let at = |drift: f64| {
            let experiment = format!(
                "v0 = [0.8]\ncontrol = \"{control}\"\nwait = 120\naverage = 50\ndrift = {drift}\n"
            );
            let point = one(&experiment, LETTER, fixed, 0);
            assert!(point.settled, "{point:?}");
            (point.off, predicted(&point).bias_of_drift)
        };
        for drift in [1e-6, -1e-5] {
            let (found, expected) = at(drift);
            let off = (found - expected).abs() / expected.abs();
            assert!(off < 2e-3, "{control} {fixed} {drift}: {found} {expected}");
        }
        assert_eq!(at(0.0).1, 0.0);
    }
}

/// Rounding without noise: the mean is off by no more than half a step, which is told as a bound, and
/// no error is random; the error that is told is the root mean square of the bias.
#[test]
fn rounding_without_noise_is_told() {
    let fixed = "sample_time = 0.05\nresolution = 0.0001";
    for point in measured("v0 = [0.1, 0.3, 0.7]\n", LETTER, fixed, 0) {
        assert!(point.settled && point.off.abs() < 0.5001e-4, "{point:?}");
        assert!((predicted(&point).rounding / 1e-4 - 0.288675).abs() < 1e-6);
        assert_eq!(predicted(&point).error, 0.0);
        assert_eq!(predicted(&point).rounding_bound, 0.5e-4);
        assert_eq!(point.mu_k_error, predicted(&point).rounding);
    }
}

/// What does not settle says why, and the others are measured.
#[test]
fn it_says_why_and_goes_on() {
    let why = |experiment: &str, fixed: &str| {
        let experiment = format!("v0 = [0.3]\nsetting = \"given\"\n{experiment}");
        let point = one(&experiment, LETTER, fixed, 0);
        (point.unsettled, point.prospect)
    };
    let limited = "alpha_n = -10\ntau = 0.5\nload_min = 0.98\nsample_time = 0.05\nnoise = 0.001";
    assert_eq!(why("", limited).0, Some("at-limit"));
    let unstable = why("", "alpha_n = -0.1\ntau = 0.5");
    assert_eq!(unstable, (Some("stops"), "unstable"));
    let drifting = why("drift = -0.1\naverage = 50\n", "alpha_n = -10\ntau = 0.5");
    assert_eq!(drifting.0, Some("drift"));
    let two = "v0 = [0.01, 0.1]\nsetting = \"given\"\nstart = \"stick-slip\"\nwait = 100";
    let points = measured(two, LETTER, "alpha_n = -10\ntau = 0.5", 0);
    assert_eq!(
        [points[0].settled, points[1].settled],
        [false, true],
        "{points:?}"
    );
}

/// The same numbers on any number of threads.
#[test]
fn threads_do_not_matter() {
    let text = format!(
        "[experiment]\nv0 = [0.1, 0.3, 0.9]\nrepeats = 3\naverage = 20\n{LETTER}[fixed]\n\
         sample_time = 0.1\nnoise = 0.001\n"
    );
    let on = |threads: usize| {
        let never = Arc::default();
        let foretold = Foretold::of(text.parse().unwrap(), threads, Attended::silently(&never));
        let found = foretold
            .unwrap()
            .measured(threads, Attended::silently(&never));
        serde_json::to_string(&found.unwrap()).unwrap()
    };
    assert_eq!(on(1), on(3));
}
