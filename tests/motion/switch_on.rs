//! Control switched on at a phase of uncontrolled stick-slip, against programs that share nothing
//! with slipmap: fates, uncontrolled cycles, windows.
//!
//! Units: M = κ = N0 = μ_S = 1, so that everything is dimensionless as in `slipmap::slip::motion`.

use std::path::Path;

use slipmap::critical::switch_on::{Phase, Scan, Trials, windows};
use slipmap::critical::{Problem, Regime};
use slipmap::model::{Feedback, FrictionLaw, Oscillator, Table};
use slipmap::setting::Field;
use slipmap::slip::case::{Case, Start};
use slipmap::slip::cycle::{NoCycle, after_release};
use slipmap::slip::motion::Accuracy;
use slipmap::slip::outcome::Outcome;
use slipmap::slip::programme::Programme;
use slipmap::sweep::Plan;

use crate::map::write;

/// The rows of a table, without its head.
fn rows(table: &str) -> impl Iterator<Item = Vec<&str>> {
    table.lines().skip(1).map(|line| line.split(',').collect())
}

fn number(word: &str) -> f64 {
    word.parse().unwrap()
}

fn law(kind: &str, mu0: &str, v_s: &str) -> FrictionLaw {
    let law = match kind {
        "coulomb" => FrictionLaw::coulomb(number(mu0), 1.0),
        "weakening" => FrictionLaw::weakening(number(mu0), number(v_s), 1.0),
        "stribeck" => FrictionLaw::stribeck(number(mu0), number(v_s), 1.0),
        other => panic!("{other}"),
    };
    law.unwrap()
}

/// `tests/reference/switch_on_fate.csv` comes from a program of its own: Runge–Kutta steps of a
/// fixed size that end on every kink of the delayed elongation, events by bisection, two sizes that
/// agree.
const FATES: &str = include_str!("../reference/switch_on_fate.csv");

/// What a fate of that table is called here.
fn fate(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::StickSlip => "survives",
        Outcome::Sliding | Outcome::Oscillation | Outcome::Diverged => "ends",
        Outcome::LiftOff => "lift",
        Outcome::Undecided | Outcome::NoCycle => outcome.name(),
    }
}

#[test]
fn every_fate_of_the_reference_is_met() {
    let mut seen = 0;
    for row in rows(FATES) {
        let [kind, mu0, v_s, alpha_v, alpha_n, tau, v0, phase, expected] = row[..] else {
            panic!("{row:?}");
        };
        let case = Case {
            oscillator: Oscillator::new(1.0, 1.0, 1.0).unwrap(),
            law: law(kind, mu0, v_s),
            feedback: Feedback::new(number(alpha_v), number(alpha_n), number(tau)),
            v0: number(v0),
            programme: Programme::default(),
            switch_on: number(phase),
            start: Start::AfterRelease,
            horizon: 5000.0,
            steps: 1_000_000,
            accuracy: Accuracy::default(),
        };
        let summary = case.run(&mut ()).unwrap();
        assert_eq!(fate(summary.outcome), expected, "{row:?} {summary:?}");
        seen += 1;
    }
    assert!(seen >= 80, "{seen}");
}

#[test]
fn maps_hold_every_fate_of_the_reference() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    for row in rows(FATES) {
        let [kind, mu0, v_s, alpha_v, alpha_n, tau, v0, phase, expected] = row[..] else {
            panic!("{row:?}");
        };
        let of_speed = match v_s {
            "" => String::new(),
            v_s => format!("v_s = {v_s}\n"),
        };
        let text = format!(
            "fields = [\"outcome\"]\n[axes]\nv0 = [{v0}]\nswitch_on_phase = [{phase}]\n[simulation]\nhorizon = 5000\n\
             [fixed]\nalpha_v = {alpha_v}\nalpha_n = {alpha_n}\ntau = {tau}\n\
             [friction]\nlaw = \"{kind}\"\nmu0 = {mu0}\n{of_speed}"
        );
        write(&Plan::new(text.parse().unwrap()).unwrap(), 1, &path);
        let file = hdf5::File::open(&path).unwrap();
        let cell = |name: &str| file.dataset(name).unwrap().read_raw::<u8>().unwrap()[0];
        let outcome = Outcome::ALL[usize::from(cell("outcome"))];
        assert_eq!((fate(outcome), cell("status") & 4), (expected, 0), "{text}");
    }
}

/// Regime by the protocol tells what the motions do.
#[test]
fn trials_tell_every_fate_of_the_reference() {
    for row in rows(FATES) {
        let [kind, mu0, v_s, alpha_v, alpha_n, tau, v0, phase, expected] = row[..] else {
            panic!("{row:?}");
        };
        let gains = (number(alpha_v), number(alpha_n));
        let problem = problem(law(kind, mu0, v_s), gains, number(tau));
        let told = match survival(&problem, number(phase), number(v0)) {
            Regime::Periodic | Regime::Irregular => "survives",
            Regime::Ended | Regime::Slips => "ends",
            Regime::LiftOff => "lift",
            Regime::NoStickSlip | Regime::Undecided => "not told",
        };
        assert_eq!(told, expected, "{row:?}");
    }
}

fn problem(law: FrictionLaw, (alpha_v, alpha_n): (f64, f64), tau: f64) -> Problem {
    Problem::new(law, Feedback::new(alpha_v, alpha_n, tau))
}

fn survival(problem: &Problem, phase: f64, v0: f64) -> Regime {
    let steps = Scan::default().steps;
    Trials::new(problem, Phase::After(phase), Accuracy::of(1e-9), steps).at(v0)
}

/// `tests/reference/uncontrolled_cycles.csv` comes from SciPy's DOP853, restarted at every zero of
/// ẋ and followed until the block sticks, or for 25 turns, or for 400 units of time without one:
/// two settings that agree. It stops, slides back before it sticks, slides for ever, or turns round
/// without sticking.
#[test]
fn uncontrolled_cycles_are_those_of_another_integrator() {
    let mut seen = [0; 4];
    for row in rows(include_str!("../reference/uncontrolled_cycles.csv")) {
        let [kind, mu0, v_s, speeds, mu_k, v0, slip, stick, fate] = row[..] else {
            panic!("{row:?}");
        };
        let law = law_of([kind, mu0, v_s, speeds, mu_k]);
        let parameters = problem(law, (0.0, 0.0), 0.0).at(number(v0), 0.0);
        for tolerance in [1e-12, 1e-9] {
            match after_release(&parameters, Accuracy::of(tolerance), 0.0) {
                Ok((_, cycle)) => {
                    let off = (cycle.slip_time - number(slip)).abs();
                    let off = off.max((cycle.stick_time - number(stick)).abs());
                    assert!(off < 2e-9 + 1e3 * tolerance, "{row:?} {cycle:?}");
                }
                Err(none) => assert!(none == NoCycle::NoStickSlip && slip.is_empty(), "{row:?}"),
            }
        }
        let kinds = ["stops", "slides-back", "slides", "turns"];
        seen[kinds.iter().position(|kind| *kind == fate).unwrap()] += 1;
    }
    assert!(seen.iter().all(|&n| n >= 7), "{seen:?}");
}

/// The law of a row; tables have points in place of μ0 and v_s.
fn law_of([kind, mu0, v_s, speeds, mu_k]: [&str; 5]) -> FrictionLaw {
    if kind != "table" {
        return law(kind, mu0, v_s);
    }
    let points = |text: &str| text.split(' ').map(number).collect();
    FrictionLaw::table(Table::new(points(speeds), points(mu_k)).unwrap(), 1.0).unwrap()
}

/// `tests/reference/switch_on_edges.csv` holds edges of windows, bisected by the program of
/// `switch_on_fate.csv` with two step sizes, and with motions followed for twice as long. At most
/// of them the uncontrolled block slides back before it sticks; next to some a slip takes thousands
/// of cycles to come to rest, or back to stick-slip.
#[test]
fn windows_end_where_brute_force_says() {
    let mut seen = 0;
    for row in rows(include_str!("../reference/switch_on_edges.csv")) {
        let [
            kind,
            mu0,
            v_s,
            speeds,
            mu_k,
            alpha_v,
            alpha_n,
            tau,
            phase,
            survives,
            edge,
        ] = row[..]
        else {
            panic!("{row:?}");
        };
        let law = law_of([kind, mu0, v_s, speeds, mu_k]);
        let problem = problem(law, (number(alpha_v), number(alpha_n)), number(tau));
        let (phase, edge) = (Phase::After(number(phase)), number(edge));
        let scan = Scan {
            v_min: 0.99 * edge,
            v_max: 1.01 * edge,
            points: 5,
            ..Scan::default()
        };
        let found = windows(&problem, phase, &scan, Accuracy::of(1e-9));
        assert!(found.decided && found.complete && found.survives.len() == 1);
        let told = found.survives[0][usize::from(survives == "below")];
        assert!((told / edge - 1.0).abs() < 2e-6, "{row:?} {found:?}");
        seen += 1;
    }
    assert!(seen >= 20, "{seen}");
}

/// Where stick-slip is irregular its edge is one by chance: it survives at 0.13008 and is lost at
/// 0.1301 by the program of `switch_on_fate.csv`, but cycles do not come to repeat.
#[test]
fn edges_by_chance_are_not_decided() {
    let law = FrictionLaw::weakening(0.7105, 0.6113, 1.0).unwrap();
    let problem = problem(law, (-0.6563, -3.1255), 1.8524);
    let scan = Scan {
        v_min: 0.125,
        v_max: 0.135,
        points: 5,
        precision: 1e-4,
        ..Scan::default()
    };
    let found = windows(&problem, Phase::After(0.0), &scan, Accuracy::of(1e-9));
    assert!(!found.decided, "{found:?}");
    let top = found.top().unwrap();
    assert!((top / 0.13009 - 1.0).abs() < 1e-3, "{found:?}");
}

/// A scan that is cut off tells no critical velocity.
#[test]
fn a_scan_of_too_many_steps_is_not_complete() {
    let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
    let problem = problem(law, (-0.33, 0.0), 4.15);
    let scan = Scan {
        total_steps: 2000,
        ..Scan::default()
    };
    let found = windows(&problem, Phase::After(0.0), &scan, Accuracy::of(1e-9));
    assert!(!found.decided && !found.complete, "{found:?}");
}

const SLIDES_BACK: &str = "[fixed]\nalpha_v = -0.05\ntau = 2.5\n\
                           [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

fn kinds(path: &Path, field: Field) -> Vec<&'static str> {
    let file = hdf5::File::open(path).unwrap();
    let cells = file.dataset(field.name()).unwrap().read_raw::<u8>();
    let (names, cells) = (field.kinds().unwrap(), cells.unwrap());
    cells.into_iter().map(|n| names[usize::from(n)]).collect()
}

/// Without control this block slides back from v0 = 0.956934 on, and sticks up to 4.141388 (SciPy's
/// DOP853 to rounding). With control stick-slip survives up to 2.091742 (`switch_on_edges.csv`);
/// the argument principle on a fine contour counts two unstable roots of sliding at 0.96, and none
/// from 1.5 on.
#[test]
fn a_block_that_slides_back_is_in_stick_slip() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    let motions = format!(
        "fields = [\"outcome\"]\n[axes]\nv0 = [0.9569, 0.957, 1.5, 2.0917, 2.0918, 4.1413, 4.1415]\n\
         switch_on_phase = [0.0]\n{SLIDES_BACK}"
    );
    write(&Plan::new(motions.parse().unwrap()).unwrap(), 1, &path);
    let mut expected = ["stick-slip"; 7];
    expected[4..].copy_from_slice(&["sliding", "sliding", "no-cycle"]);
    assert_eq!(kinds(&path, Field::Outcome), expected);
    let velocities = format!(
        "fields = [\"vc\", \"outcome\", \"regime\", \"v_smooth\", \"windows\"]\nprotocol = \"switch-on\"\n\
         [axes]\nv0 = [0.96, 1.5, 2.0917, 2.0918, 5.0]\ntau = [2.5]\n{}",
        SLIDES_BACK.replace("tau = 2.5\n", "")
    );
    write(&Plan::new(velocities.parse().unwrap()).unwrap(), 1, &path);
    let expected = ["unstable", "bistable", "bistable", "stable", "stable"];
    assert_eq!(kinds(&path, Field::Regime), expected);
    assert_eq!(kinds(&path, Field::Outcome), ["lost"; 5]);
    let file = hdf5::File::open(&path).unwrap();
    let windows = file.dataset("windows").unwrap().read_raw::<u8>().unwrap();
    assert_eq!(windows, [1; 5]);
    for field in ["vc", "v_smooth"] {
        let cells = file.dataset(field).unwrap().read_raw::<f64>().unwrap();
        let near = |v: &f64| (v / 2.091_742_4 - 1.0).abs() < 1e-6;
        assert!(cells.iter().all(near), "{field} {cells:?}");
    }
}
