//! The critical velocity against reference values, the closed form of the limit, and its methods
//! against one another.
//!
//! Units: M = κ = N0 = 1, so that everything is dimensionless as in `slipmap::slip::motion`.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use slipmap::critical::along_delay::{BLOCK, critical_velocities};
use slipmap::critical::limit::CoulombLimit;
use slipmap::critical::switch_on::{Phase, Scan, Trials, windows};
use slipmap::critical::{
    CriticalVelocity, GRAZE_PRECISION, Method, Problem, RampOptions, Regime, Transition,
    by_simulation, critical_velocity,
};
use slipmap::model::stop::Stop;
use slipmap::model::{Feedback, FrictionLaw, Table};
use slipmap::slip::motion::Accuracy;

use crate::chance::Chance;

fn problem(law: FrictionLaw, alpha_v: f64, alpha_n: f64, tau: f64) -> Problem {
    Problem::new(law, Feedback::new(alpha_v, alpha_n, tau))
}

fn letters(alpha_v: f64, alpha_n: f64, tau: f64) -> Problem {
    let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
    problem(law, alpha_v, alpha_n, tau)
}

fn fig3a() -> Problem {
    letters(-0.33, 0.0, 4.15)
}

fn tolerance(tolerance: f64) -> Accuracy {
    Accuracy {
        tolerance,
        ..Accuracy::default()
    }
}

/// By simulation alone, with steps of its own, every loss of stick-slip waited for.
fn simulated(problem: &Problem) -> CriticalVelocity {
    simulated_by(problem, 0.35)
}

/// The same, with steps of v0 no larger than `first`, relative.
fn simulated_by(problem: &Problem, first: f64) -> CriticalVelocity {
    let pace = RampOptions {
        first,
        largest: first,
        patient: true,
        ..RampOptions::default()
    };
    by_simulation(problem, &pace, tolerance(1e-9))
}

/// The rows of the reference: the problem, v_c and the smallest load there.
fn reference() -> Vec<(Problem, f64, f64)> {
    let table = include_str!("../reference/vc_follow.csv");
    let rows = table.lines().skip(1).map(|line| {
        let words: Vec<&str> = line.split(',').collect();
        let v: Vec<f64> = words[1..].iter().map(|w| w.parse().unwrap()).collect();
        let law = match words[0] {
            "coulomb" => FrictionLaw::coulomb(v[0], 1.0),
            "weakening" => FrictionLaw::weakening(v[0], v[1], 1.0),
            other => panic!("{other}"),
        };
        (problem(law.unwrap(), v[2], v[3], v[4]), v[5], v[7])
    });
    rows.collect()
}

#[test]
fn the_reference_is_met_by_every_method() {
    let rows = reference();
    assert!(rows.len() >= 23);
    for (problem, expected, n_min) in rows {
        for found in [critical_velocity(&problem), simulated(&problem)] {
            if n_min > 0.0 {
                let error = (found.vc / expected - 1.0).abs();
                assert!(error < 2e-4, "{problem:?} {expected} {found:?}");
                assert!((found.n_min - n_min).abs() < 0.02, "{n_min} {found:?}");
                assert!(found.stick_time > 0.0 && found.slip_time > 0.0);
            } else {
                assert_eq!(found.transition, Transition::LiftOff, "{problem:?}");
                assert!(found.vc.is_nan() && found.v_liftoff > 0.0 && found.v_liftoff < expected);
            }
        }
    }
}

/// Where v_c is not decided, ramps that an independent program made by slow steps of v0 end within
/// its bounds; where it is decided, near it.
#[test]
fn slow_ramps_end_within_the_bounds() {
    let table = include_str!("../reference/vc_slow_ramps.csv");
    let (mut open, mut ramps) = (0, 0);
    for line in table.lines().skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let number = |i: usize| words[i].parse::<f64>().unwrap();
        let law = match words[0] {
            "coulomb" => FrictionLaw::coulomb(number(1), 1.0),
            "weakening" => FrictionLaw::weakening(number(1), number(2), 1.0),
            other => panic!("{other}"),
        };
        let (end, v0) = (words[8], number(9));
        let found = critical_velocity(&problem(law.unwrap(), number(3), number(4), number(5)));
        let near = 2.0 * GRAZE_PRECISION;
        assert!(found.vc_lower * (1.0 - near) <= v0, "{line} {found:?}");
        assert!(found.vc_upper * (1.0 + near) >= v0, "{line} {found:?}");
        assert!(found.vc_upper < 2.0 * found.vc_lower, "{line} {found:?}");
        assert_eq!(
            found.transition == Transition::LiftOff,
            end == "lift-off",
            "{line}"
        );
        open += usize::from(!found.decided);
        ramps += 1;
    }
    assert!(ramps >= 20 && 2 * open > ramps, "{open} of {ramps}");
}

/// What is decided is its own bounds.
#[test]
fn decided_velocities_bound_themselves() {
    let fig3 = critical_velocity(&fig3a());
    assert!(fig3.decided);
    assert_eq!([fig3.vc_lower, fig3.vc_upper], [fig3.vc; 2]);
    let lifted = critical_velocity(&letters(0.0, -10.0, 1.0));
    assert_eq!(lifted.transition, Transition::LiftOff);
    assert!(lifted.decided && lifted.sustained);
    assert_eq!([lifted.vc_lower, lifted.vc_upper], [lifted.v_liftoff; 2]);
    let coulomb = FrictionLaw::coulomb(0.5, 1.0).unwrap();
    let persists = critical_velocity(&problem(coulomb.clone(), 0.0, 0.0, 1.0));
    assert_eq!(persists.transition, Transition::Persists);
    assert!(persists.vc_lower == 100.0 && persists.vc_upper.is_nan());
    let never = critical_velocity(&problem(coulomb, 0.0, -100.0, 0.05));
    assert!(never.decided && never.transition == Transition::Never);
    assert_eq!([never.vc_lower, never.vc_upper], [0.0; 2]);
}

#[test]
fn the_letters_figure_3() {
    for (problem, expected) in [(fig3a(), 0.344467), (letters(0.0, -10.0, 0.5), 0.021540)] {
        for found in [critical_velocity(&problem), simulated(&problem)] {
            assert_eq!(found.transition, Transition::Grazing);
            assert!((found.vc - expected).abs() < 2e-6, "{found:?}");
        }
    }
}

/// Coulomb friction and load control at γ, with a delay.
fn coulomb(gamma: f64, mu_ratio: f64, tau: f64) -> Problem {
    let law = FrictionLaw::coulomb(mu_ratio, 1.0).unwrap();
    problem(law, 0.0, -2.0 * gamma / (mu_ratio * tau), tau)
}

#[test]
fn short_delays_come_to_the_closed_form() {
    for mu_ratio in [0.3, 0.5, 0.8] {
        for gamma in [0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85] {
            let limit = CoulombLimit::at(gamma, mu_ratio).unwrap().vc_over_vtilde;
            let difference = |tau: f64| {
                let found = critical_velocity(&coulomb(gamma, mu_ratio, tau));
                assert_eq!(found.method, Method::GrazeSlip, "{gamma} {found:?}");
                found.vc / (1.0 - mu_ratio) - limit
            };
            let [far, near, nearest] = [0.02, 0.01, 0.005].map(difference);
            println!(
                "gamma {gamma} r {mu_ratio}: (vc - limit)/tau {:.4} {:.4} {:.4}",
                far / 0.02,
                near / 0.01,
                nearest / 0.005
            );
            assert!(near.abs() < 1e-3, "{gamma} {mu_ratio} {near}");
            assert!(
                nearest.abs() < 0.6 * near.abs() + 1e-6,
                "{gamma} {near} {nearest}"
            );
            assert!(near.abs() < 0.6 * far.abs() + 1e-6, "{gamma} {far} {near}");
        }
    }
}

#[test]
fn switching_on_at_a_phase() {
    for (phase, expected) in [
        (0.0, 0.233773),
        (0.05, 0.239537),
        (0.2, 0.260146),
        (0.3, 0.276639),
        (1.0, 0.344467),
    ] {
        let problem = fig3a();
        let mut trials = Trials::new(&problem, Phase::After(phase), tolerance(1e-9), 50_000);
        assert_eq!(
            trials.at(expected * (1.0 - 1e-5)),
            Regime::Periodic,
            "{phase}"
        );
        assert_ne!(
            trials.at(expected * (1.0 + 1e-5)),
            Regime::Periodic,
            "{phase}"
        );
    }
    let load = letters(0.0, -10.0, 0.5);
    let scan = Scan {
        points: 41,
        v_max: 1.0,
        ..Scan::default()
    };
    let found = windows(&load, Phase::After(0.0), &scan, tolerance(1e-9));
    assert!((found.top().unwrap() - 0.021540).abs() < 2e-6, "{found:?}");
}

#[test]
fn survival_at_the_stop_is_re_entrant() {
    // The slip before control lasts 3.9755 at v0 = 0.35; the stop phase moves with v0.
    let problem = fig3a();
    let at_stop = |v0: f64| {
        let mut slips = Trials::new(&problem, Phase::After(0.0), tolerance(1e-9), 50_000);
        let slip = slips.uncontrolled_cycle(v0).unwrap().slip_time;
        let mut trials = Trials::new(&problem, Phase::After(slip), tolerance(1e-9), 50_000);
        trials.at(v0) == Regime::Periodic
    };
    for (edge, above) in [(0.26695, false), (0.27661, true), (0.344467, false)] {
        assert_eq!(at_stop(edge - 2e-5), !above, "below {edge}");
        assert_eq!(at_stop(edge + 2e-5), above, "above {edge}");
    }
}

/// A delay of too many cycles has no phases: nothing survives there by default.
#[test]
fn the_worst_phase_of_a_delay_too_long_is_undecided() {
    let problem = letters(0.0, -10.0, 1e8);
    for phase in [Phase::After(0.0), Phase::Worst(4)] {
        let mut trials = Trials::new(&problem, phase, tolerance(1e-9), 50_000);
        assert_eq!(trials.at(0.35), Regime::Undecided, "{phase:?}");
    }
}

/// A search that is cut off says so.
#[test]
fn a_search_of_too_many_trials_is_undecided() {
    let pace = RampOptions {
        first: 1e-3,
        largest: 1e-3,
        patient: true,
        ..RampOptions::default()
    };
    let found = by_simulation(&fig3a(), &pace, tolerance(1e-9));
    assert!(!found.decided, "{found:?}");
}

/// `SLIPMAP_CASES` asks for more than a few.
fn cases(default: usize) -> usize {
    let asked = std::env::var("SLIPMAP_CASES").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(default)
}

#[test]
fn the_methods_agree() {
    let mut chance = Chance(20261121);
    let (mut claimed, mut worst) = (0, 0.0_f64);
    let mut others = Vec::new();
    let total = cases(120);
    for i in 0..total {
        let problem = match i % 4 {
            3 => chance.problem_of_other_laws(),
            _ => chance.problem(),
        };
        let fast = critical_velocity(&problem);
        if fast.method == Method::Simulation {
            continue;
        }
        claimed += u32::from(fast.decided);
        let value = |c: &CriticalVelocity| {
            if c.transition == Transition::LiftOff {
                c.v_liftoff
            } else {
                c.vc
            }
        };
        // Simulation is thrown off by steps of one size or another; what it does not know says
        // nothing.
        let mut differs = None;
        for first in [0.35, 0.6, 0.15] {
            let slow = simulated_by(&problem, first);
            let difference = (value(&fast) / value(&slow) - 1.0).abs();
            if fast.transition == slow.transition && difference < 1e-4 {
                worst = worst.max(difference);
                differs = None;
                break;
            }
            if slow.decided {
                differs = Some(slow);
            }
        }
        if let Some(slow) = differs.filter(|_| fast.decided) {
            others.push((problem, fast, slow));
        }
    }
    println!(
        "{claimed} of {total} by a graze; worst difference {worst:.1e}; {} disagree",
        others.len()
    );
    for (problem, fast, slow) in &others {
        println!("{problem:?}\n  {fast:?}\n  {slow:?}");
    }
    assert!(4 * claimed as usize > 3 * total, "{claimed}");
    assert!(others.len() as u32 * 200 <= claimed, "{}", others.len());
}

/// Near its graze stick-slip may attract from a few per cent of the way to it alone, so that it is
/// lost by small steps of v0 again and again. The ends of ramps by an independent program, which
/// begin below the last kind of stick-slip and halve steps down to 1e-7; by two sizes of its steps
/// of time and of v0 they agree to 3e-6. Velocity control, and both controls with gains of either
/// sign.
#[test]
fn stick_slip_that_attracts_from_nearby_alone_is_followed_to_its_end() {
    for (mu0, v_s, alpha_v, alpha_n, tau, expected) in [
        (
            0.4793135720798954,
            1.1225514988405152,
            -0.28130228377367983,
            -0.2619275233702053,
            6.710023100922147,
            9.224260,
        ),
        (
            0.5127834819104801,
            0.8331493268582137,
            -0.4954761684157092,
            0.06047564972084807,
            5.885725566550972,
            15.040942,
        ),
        (
            0.32008506230083184,
            0.5700988270039815,
            -0.3837786447256055,
            0.1666582274574453,
            5.7953063542779635,
            6.344316,
        ),
        (
            0.4374061378755425,
            0.3984718391098064,
            -0.4980562748863179,
            0.0,
            5.971946397287757,
            18.652891,
        ),
        (
            0.44871706342890627,
            0.8668913897260604,
            -0.5184187427575038,
            0.0,
            13.39175735497578,
            13.701306,
        ),
    ] {
        let law = FrictionLaw::weakening(mu0, v_s, 1.0).unwrap();
        let problem = problem(law, alpha_v, alpha_n, tau);
        let found = critical_velocity(&problem);
        let alone = simulated_by(&problem, 0.1);
        assert!(found.decided, "{expected} {found:?}");
        for (found, most) in [(found, 4e-5), (alone, 1e-4)] {
            let error = (found.vc / expected - 1.0).abs();
            assert!(error < most, "{expected} {found:?}");
            assert_eq!(found.transition, Transition::Grazing, "{found:?}");
        }
    }
}

/// Kinds of stick-slip that follow one another as v0 grows: what was there before the graze of the
/// first one, or the doubling of its period, or where it begins to turn back, goes on as another
/// one. Its end by two slow ramps in fixed steps (`tests/referee` is such a program), which agree
/// on the digits given; so are those below.
#[test]
fn the_last_kind_of_stick_slip_counts() {
    let of = |slope: f64, alpha_v: f64, alpha_n: f64, tau: f64| {
        let law = FrictionLaw::weakening(0.5, -0.5 / slope, 1.0).unwrap();
        problem(law, alpha_v, alpha_n, tau)
    };
    for (problem, end, expected) in [
        // A graze at 0.6009, after which the block swings up to 0.53 v0 and then comes to stick
        // again.
        (of(-2.0, -0.5753, 0.0, 4.733), Transition::Grazing, 1.001322),
        // It turns back at its stops from 0.8735 on.
        (
            of(-1.5842, 0.0, -3.0022, 0.0397),
            Transition::Fold,
            3.003350,
        ),
        (
            of(-0.8678, 0.0, -8.224, 0.03405),
            Transition::Grazing,
            3.003046,
        ),
        // Irregular from 0.19 on, periodic again later.
        (
            of(-1.3719, -0.5781, 0.0, 9.5),
            Transition::Grazing,
            1.372641,
        ),
        // Its period is doubled at last.
        (
            of(-0.7522, -1.3936, 0.0, 0.5202),
            Transition::Grazing,
            2.923537,
        ),
    ] {
        let found = critical_velocity(&problem);
        println!("{found:?}");
        assert!(
            found.decided && found.transition == end,
            "{problem:?} {found:?}"
        );
        assert!(
            (found.vc / expected - 1.0).abs() < 1e-4,
            "{problem:?} {found:?}"
        );
    }
}

/// One slip grazes below the velocity from which v0 is raised at first, where the block does not
/// stick again; from the next one on stick-slip is sustained, and ends where two slow ramps say.
#[test]
fn an_end_below_the_start_is_none() {
    let speeds = [
        0.011456539572006418,
        0.07872653008174442,
        0.12679126295035642,
        0.19977148249540305,
        0.24000899239066903,
        0.263979012159274,
    ];
    let mu_k = [
        0.701756289838264,
        0.7196939262376849,
        0.5990736733602243,
        0.5902006812582168,
        0.6290045979260035,
        0.3947940229056309,
    ];
    let table = Table::new(speeds.to_vec(), mu_k.to_vec()).unwrap();
    let law = FrictionLaw::table(table, 0.7135913112347158).unwrap();
    let found = critical_velocity(&problem(law, 0.0, -1.9617462012372802, 0.2748415706617039));
    assert!(
        found.decided && (found.vc / 0.53645956 - 1.0).abs() < 1e-4,
        "{found:?}"
    );
}

/// An orbit that has doubled its period, unstable, has a graze of its own above that of the doubled
/// one; and sticks that only seem to be left by a coarse integration vanish later than those of a
/// fine one.
#[test]
fn an_orbit_that_does_not_attract_is_not_followed_to_its_end() {
    let stribeck =
        FrictionLaw::stribeck(0.7669341039205579, 0.04073341361763523, 1.0689229373059184);
    let weakening =
        FrictionLaw::weakening(0.6476693553992492, 0.02161337816929156, 0.7225992620999885);
    for (law, alpha_n, tau, vc) in [
        (stribeck, -1.555856252194365, 0.42221809424097784, 0.1626753),
        (weakening, 0.3206748481190808, 0.422289426655718, 5.712777),
    ] {
        let found = critical_velocity(&problem(law.unwrap(), 0.0, alpha_n, tau));
        assert!(found.decided, "{found:?}");
        assert!((found.vc / vc - 1.0).abs() < 2e-5, "{found:?} {vc}");
    }
}

/// Narrow Stribeck laws, whose flank a slip comes down to from far above: a slow ramp of v0 by
/// Runge–Kutta's classical method in fixed steps, with two step sizes, comes to these velocities
/// (`tests/referee` is such a program).
#[test]
fn narrow_stribeck_laws_have_the_critical_velocity_of_a_slow_ramp() {
    for (law, alpha_v, tau, vc) in [
        (
            [0.6744465137600394, 0.1259700484834986, 1.0],
            -0.20412752854690996,
            0.29285947750679436,
            5.27068,
        ),
        (
            [0.6016119865205055, 0.03797005066539927, 0.7428583234387696],
            -0.05872151539519831,
            0.06775755399378185,
            30.4485,
        ),
        (
            [0.3904715450730206, 0.05780635370605384, 1.0],
            -0.0404761524266833,
            0.27415298454766956,
            18.765388,
        ),
    ] {
        let law = FrictionLaw::stribeck(law[0], law[1], law[2]).unwrap();
        let found = critical_velocity(&problem(law, alpha_v, 0.0, tau));
        assert!(found.decided, "{found:?}");
        assert!((found.vc / vc - 1.0).abs() < 1e-4, "{found:?} {vc}");
    }
}

/// Ramps by steps of 1, 3, 6 and 10 % end at 0.8756, 0.8756, 16.19 and 16.29 here: no answer is
/// decided.
#[test]
fn what_depends_on_the_ramp_is_not_decided() {
    let law = FrictionLaw::weakening(0.18418667391163734, 0.5843453093116782, 0.5565222639562568);
    let long = problem(
        law.unwrap(),
        -0.5577968761910099,
        -0.42084594777033013,
        30.260736169885853,
    );
    let found = critical_velocity(&long);
    assert!(!found.decided, "{found:?}");
}

/// Where irregular stick-slip ends, ramps by Runge–Kutta's method agree on by steps of 2 and 5 %:
/// 1.085294 and 1.085286, 1.335628 and 1.335625.
#[test]
fn irregular_ends_are_decided_where_ramps_agree() {
    for (law, alpha_v, tau, vc) in [
        (
            [0.692163159123971, 0.045385554833909714],
            -0.11217921072463063,
            2.4305289257366645,
            1.08529,
        ),
        (
            [0.6551298095560387, 0.03933992393435898],
            -0.8291855222783836,
            1.025173709157537,
            1.335626,
        ),
    ] {
        let law = FrictionLaw::weakening(law[0], law[1], 1.0).unwrap();
        let found = critical_velocity(&problem(law, alpha_v, 0.0, tau));
        assert!(
            found.decided && found.transition == Transition::Irregular,
            "{found:?}"
        );
        assert!((found.vc / vc - 1.0).abs() < 1e-4, "{found:?} {vc}");
    }
}

/// The same problem at other delays.
fn along(one: &Problem, delays: impl Iterator<Item = f64>) -> Vec<Problem> {
    let at = |tau| Problem {
        feedback: Feedback {
            tau,
            ..one.feedback
        },
        ..one.clone()
    };
    delays.map(at).collect()
}

/// A cell that starts from its neighbour's orbit is what it is from scratch.
#[test]
fn lines_are_what_their_cells_are() {
    let mut chance = Chance(20261122);
    let (mut continued, mut worst, mut worst_time) = (0, 0.0_f64, 0.0_f64);
    for _ in 0..cases(120) / 20 {
        let one = chance.problem();
        let problems = along(&one, (0..BLOCK).map(|i| 0.3 + 0.05 * i as f64));
        let line = critical_velocities(&problems, || false);
        for (problem, found) in problems.iter().zip(line) {
            let found = found.unwrap();
            let alone = critical_velocity(problem);
            if !(found.decided && alone.decided) {
                continue;
            }
            assert_eq!(
                found.transition, alone.transition,
                "{problem:?}\n{found:?}\n{alone:?}"
            );
            let values = [(found.vc, alone.vc), (found.v_liftoff, alone.v_liftoff)];
            for (a, b) in values.into_iter().filter(|(a, _)| *a > 0.0) {
                worst = worst.max((a / b - 1.0).abs());
            }
            // As many slips in a period.
            if found.transition == Transition::Grazing {
                worst_time = worst_time.max((found.slip_time / alone.slip_time - 1.0).abs());
            }
            continued += u32::from(found.method == Method::GrazeOrbit);
        }
    }
    println!("{continued} cells by the orbit; worst difference {worst:.1e}");
    assert!(
        continued > 10 && worst < GRAZE_PRECISION,
        "{continued} {worst}"
    );
    assert!(worst_time < 0.01, "{worst_time}");
    // A stop leaves cells out.
    let none = critical_velocities(&[fig3a(), fig3a()], || true);
    assert!(none.iter().all(Option::is_none));
}

/// Over a few delays a graze opens below the one that a line follows: stick-slip raised from low
/// velocities ends there.
#[test]
fn ends_that_open_below_a_branch_are_found() {
    let law = FrictionLaw::weakening(0.5, 0.44869374168435217, 1.0).unwrap();
    let one = problem(law, -0.3866554997326608, 0.0, 1.0);
    let problems = along(&one, (128..200).map(|i| 1.0 + 4.0 * f64::from(i) / 199.0));
    let found = critical_velocities(&problems, || false);
    let mut below = 0;
    for (problem, found) in problems[24..40].iter().zip(&found[24..40]) {
        let (found, alone) = (found.unwrap(), critical_velocity(problem));
        if found.decided && alone.decided {
            let off = (found.vc / alone.vc - 1.0).abs();
            assert!(off < 5e-5, "{problem:?} {found:?} {alone:?}");
            below += u32::from(found.vc < 0.25);
        }
    }
    assert!(below > 3, "{below}");
}

/// Irregular stick-slip leads to an orbit that ends soon, and another kind goes on above that:
/// steps that are too large for it come to the other one.
#[test]
fn an_end_soon_after_irregular_stick_slip_is_found() {
    let law = FrictionLaw::weakening(0.5, 0.296875, 1.0).unwrap();
    for (tau, end) in [(155, 0.2816684), (156, 0.2746768), (157, 0.2681374)] {
        let tau = 1.0 + 4.0 * f64::from(tau) / 199.0;
        let alone = critical_velocity(&problem(law.clone(), -0.3745728643216081, 0.0, tau));
        assert!(
            alone.decided && (alone.vc / end - 1.0).abs() < 2e-5,
            "{alone:?}"
        );
    }
}

/// Stick-slip goes on just beyond a graze, in a cell of a line whose neighbours end by theirs: the
/// slip is another one there.
#[test]
fn what_changes_along_a_line_is_looked_beyond() {
    let law = FrictionLaw::weakening(0.5, 0.5 / (2.0 - 1.5 * 13.0 / 19.0), 1.0).unwrap();
    let one = problem(law, -1.0 + 0.98 * 128.0 / 199.0, 0.0, 1.0);
    let problems = along(&one, (128..200).map(|i| 1.0 + 4.0 * f64::from(i) / 199.0));
    let found = critical_velocities(&problems, || false)[147 - 128].unwrap();
    let off = (found.vc / 0.2509637 - 1.0).abs();
    assert!(found.decided && off < 1e-4, "{found:?}");
}

/// Stick-slip doubles its period just below its end, and the orbit is lost there.
#[test]
fn an_orbit_that_is_lost_just_below_its_end_is_not_thrown_off() {
    let law = FrictionLaw::weakening(0.5, 0.5 / (2.0 - 1.5 * 3.0 / 19.0), 1.0).unwrap();
    for (alpha_n, tau, end) in [
        (-4.054271356783919, 0.9652926, 0.1508457),
        (-2.631155778894472, 1.1888074, 0.2553220),
    ] {
        let alone = critical_velocity(&problem(law.clone(), 0.0, alpha_n, tau));
        assert!(
            alone.decided && (alone.vc / end - 1.0).abs() < 2e-5,
            "{alone:?}"
        );
    }
}

/// Sticks shorten as a square root towards a graze here, and errors of the integration within a
/// tolerance of 1e-6 move it by 1e-3.
#[test]
fn ends_are_checked_by_a_finer_integration() {
    let law = FrictionLaw::stribeck(0.4244, 0.304, 1.0).unwrap();
    let found = critical_velocity(&problem(law, -0.8625, 0.0, 0.233));
    assert!(found.method == Method::GrazeOrbit && found.decided);
    assert!((found.vc / 6.287593 - 1.0).abs() < 5e-5, "{found:?}");
}

/// Simulation that tells another end by other steps of v0 or a finer integration decides nothing.
#[test]
fn ends_that_are_not_confirmed_are_not_decided() {
    let fast = FrictionLaw::stribeck(0.3501457278180179, 0.270275760886004, 1.0).unwrap();
    let found = critical_velocity(&problem(fast, -0.7553344615011054, 0.0, 0.01));
    let told = (found.vc / 88.1329 - 1.0).abs() < 1e-4;
    assert!(!found.decided || told, "{found:?}");
    // It lifts off in a transient, by some steps: at 0.81278 by the ramp of another program, from
    // v0 = 0.1 in steps of 1 to 10 %.
    let law = FrictionLaw::weakening(0.7659505970022644, 1.0087382393833446, 1.0).unwrap();
    let lifted = problem(law, 0.10212109734575425, -0.4470567829329153, 15.8);
    let found = critical_velocity(&lifted);
    let told = (found.v_liftoff / 0.812782 - 1.0).abs() < 1e-4;
    assert!(!found.decided || told, "{found:?}");
}

/// One cell ends with two slips in a period, its neighbours at nearly the same v0 with one: none is
/// continued to the other.
#[test]
fn kinds_that_end_alike_are_told_apart() {
    let law = FrictionLaw::weakening(0.954641831528965, 0.5410746973058337, 1.0).unwrap();
    let one = problem(law, -0.1982310607443836, 0.0, 1.0);
    let problems = along(&one, (0..48).map(|i| 0.05 + 4.95 * f64::from(i) / 127.0));
    let found = critical_velocities(&problems, || false);
    for (problem, found) in problems.iter().zip(&found).skip(8) {
        let (found, alone) = (found.unwrap(), critical_velocity(problem));
        let off = (found.slip_time / alone.slip_time - 1.0).abs();
        assert!(off < 0.01, "{problem:?} {found:?} {alone:?}");
    }
}

/// Without control Coulomb friction keeps stick-slip at any v0. Under weakening friction the swing
/// of a slip grows: from some v0 on the block slips backwards where it stuck, sticks become
/// shorter, and at a finite v0 none is left: that one by SciPy's DOP853 from event to event.
#[test]
fn uncontrolled_stick_slip() {
    let coulomb = problem(FrictionLaw::coulomb(0.6, 1.0).unwrap(), 0.0, 0.0, 1.0);
    let found = critical_velocity(&coulomb);
    assert!(found.decided && found.transition == Transition::Persists && found.vc.is_nan());
    let weakening = letters(0.0, 0.0, 1.0);
    let [fast, slow] = [critical_velocity(&weakening), simulated(&weakening)];
    assert!(fast.decided && slow.decided, "{fast:?} {slow:?}");
    for found in [fast, slow] {
        assert!((found.vc / 4.14138767 - 1.0).abs() < 1e-4, "{found:?}");
    }
    assert!(fast.stick_time < 1e-5 && fast.slip_time > 6.0, "{fast:?}");
}

/// Wherever a search is, once it is told to stop it ends soon, and by no panic.
#[test]
fn a_search_stops_anywhere() {
    let mut chance = Chance(20261123);
    let mut stopped = 0;
    for i in 0..600 {
        let mut asked = match i % 2 {
            0 => chance.problem(),
            _ => chance.problem_of_other_laws(),
        };
        // Long delays make long searches.
        asked.feedback.tau *= if i % 3 == 0 { 40.0 } else { 1.0 };
        let flag = Arc::new(AtomicBool::new(i % 10 == 0));
        asked.stop = Stop::when(&flag);
        let wait = Duration::from_micros(chance.below(2000));
        let text = format!("{asked:?}");
        let search = std::thread::spawn(move || {
            match i % 4 {
                3 => drop(by_simulation(
                    &asked,
                    &RampOptions::default(),
                    Accuracy::default(),
                )),
                _ => drop(critical_velocity(&asked)),
            }
            Instant::now()
        });
        std::thread::sleep(wait);
        let told = Instant::now();
        flag.store(true, Ordering::Relaxed);
        let ended = search.join().unwrap_or_else(|_| panic!("{text}"));
        let took = ended.saturating_duration_since(told);
        assert!(took < Duration::from_millis(500), "{took:?}: {text}");
        stopped += u32::from(ended > told);
    }
    assert!(stopped > 100, "{stopped}");
}
