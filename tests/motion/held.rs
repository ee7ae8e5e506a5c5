//! Motions whose feedback is read at equal times and held in between: decay as linear theory says,
//! a second integrator, switching on in stick-slip, outcomes, noise. The referee of `tests/referee`
//! follows such motions by its own means.
//!
//! Units: M = κ = N0 = 1.

use std::sync::Arc;

use crate::chance::Chance;
use crate::signal::{samples, slope};
use slipmap::answers::vc::VcProblem;
use slipmap::critical::switch_on::Phase;
use slipmap::explore::basin::Followed;
use slipmap::model::{Channel, Dashpots, Feedback, FrictionLaw, Readings};
use slipmap::setting::basin::Basin;
use slipmap::setting::law_kind::LawKind;
use slipmap::setting::search::Protocol;
use slipmap::setting::{CaseSpec, Parameter, Setting};
use slipmap::slip::cycle::after_release;
use slipmap::slip::motion::{Accuracy, Event, Integrator, Motion, Parameters};
use slipmap::slip::outcome::{Limits, Outcome, Summary};
use slipmap::slip::watch::{REPEATED, follow};

fn every(sample_time: f64) -> Readings {
    Readings {
        sample_time,
        ..Readings::default()
    }
}

fn letters_law() -> FrictionLaw {
    FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap()
}

/// The letter's Fig. 3 (a) and (b), with this v0 and so many readings in a delay.
fn letter(of_b: bool, v0: f64, in_delay: f64, readings: Readings) -> Parameters {
    let feedback = match of_b {
        true => Feedback::new(0.0, -10.0, 0.5),
        false => Feedback::new(-0.33, 0.0, 4.15),
    };
    let sample_time = feedback.tau / in_delay;
    Parameters {
        law: letters_law(),
        velocity_unit: 1.0,
        dashpots: Dashpots::default(),
        feedback: Feedback {
            readings: Readings {
                sample_time,
                ..readings
            },
            ..feedback
        },
        v0,
        switch_on: 70.0,
    }
}

/// Event times until `end`, with the events.
fn events(motion: &mut Motion, end: f64) -> Vec<(Event, f64)> {
    let mut found = Vec::new();
    while motion.t < end {
        let event = motion.advance(end);
        found.extend(event.map(|event| (event, motion.t)));
        if event == Some(Event::LiftOff) || !motion.u.is_finite() {
            break;
        }
    }
    found
}

/// Sliding decays at the rate −ln|z|/h of the largest root z of the sampled loop; the number is
/// that of its characteristic polynomial, solved elsewhere.
#[test]
fn sliding_decays_as_the_spectral_radius_says() {
    let (sample_time, b) = (0.042_178_701_406_097_11, 0.088_691_648_135_498_79);
    let (mu, alpha_n) = (0.5, -6.535_295_164_994_769 / 0.5);
    let p = Parameters {
        // Coulomb friction and a dashpot to the ground: slip is linear.
        law: FrictionLaw::coulomb(mu, 1.0).unwrap(),
        velocity_unit: 1.0,
        dashpots: Dashpots {
            damping: 0.0,
            viscous: b,
        },
        feedback: Feedback {
            readings: every(sample_time),
            ..Feedback::new(-0.312_770_257_680_003_16, alpha_n, 12.0 * sample_time)
        },
        v0: 5.0,
        switch_on: 0.0,
    };
    for integrator in [Integrator::Taylor, Integrator::Collocation] {
        let accuracy = Accuracy {
            integrator,
            tolerance: 1e-13,
        };
        let mut motion = Motion::new(p.clone(), accuracy, 5.01, mu + b * 5.0);
        let rest = motion.sliding_elongation();
        let apart = 8.0 * sample_time;
        let signal = samples(&mut motion, 10.0, apart, 60);
        // The largest root is real, and the next ones have decayed.
        let point = |(i, a): (usize, &f64)| (apart * i as f64, (a - rest).abs().ln());
        let points: Vec<_> = signal.iter().enumerate().map(point).collect();
        let rate = slope(&points);
        assert!((rate + 0.298_738_79).abs() < 1e-7, "{integrator:?} {rate}");
    }
}

/// A motion by chance, with memory and latency, dashpots, and its start.
fn random(chance: &mut Chance) -> (Parameters, (f64, f64)) {
    let law = match chance.of(3) {
        0 => FrictionLaw::coulomb(0.4, 1.0),
        1 => FrictionLaw::weakening(0.7, chance.log(0.05, 1.0), 1.0),
        _ => FrictionLaw::stribeck(0.4, chance.log(0.05, 1.0), 1.0),
    };
    let sample_time = chance.log(0.02, 1.0);
    let latency = [0.0, 3.0, 11.0][chance.of(3)] * sample_time;
    let memory = [0.0, chance.between(-0.6, 0.8)][chance.of(2)];
    let tau = (1 + chance.of(20)) as f64 * sample_time;
    let feedback = Feedback {
        readings: every(sample_time),
        ..Feedback::new(chance.between(-0.5, 0.2), chance.between(-1.5, 0.3), tau)
    };
    let dashpots = [0.0, chance.log(0.02, 0.5)][chance.of(2)];
    let p = Parameters {
        law: law.unwrap(),
        velocity_unit: 1.0,
        dashpots: Dashpots {
            damping: dashpots,
            viscous: 0.0,
        },
        feedback: feedback.through(Channel { memory, latency }),
        v0: chance.log(0.05, 1.0),
        switch_on: [0.0, chance.between(0.0, 9.0)][chance.of(2)],
    };
    (p, (chance.between(-0.5, 1.5), chance.between(-0.9, 0.9)))
}

/// Two integrators that share no step, and a smaller tolerance, tell the same events.
#[test]
fn integrators_agree() {
    let mut chance = Chance(20_261_128);
    let (mut compared, mut motions) = (0, 0);
    for _ in 0..60 {
        let (p, (u, a)) = random(&mut chance);
        let by = |integrator, tolerance| {
            let accuracy = Accuracy {
                integrator,
                tolerance,
            };
            events(&mut Motion::new(p.clone(), accuracy, u, a), 25.0)
        };
        let exact = by(Integrator::Taylor, 1e-14);
        for (found, allowed) in [
            (by(Integrator::Taylor, 1e-10), 1e-7),
            (by(Integrator::Collocation, 1e-12), 1e-8),
        ] {
            assert_eq!(
                found.len(),
                exact.len(),
                "{p:?} {u} {a}\n{found:?}\n{exact:?}"
            );
            for (one, other) in found.iter().zip(&exact) {
                let near = one.0 == other.0 && (one.1 - other.1).abs() < allowed;
                assert!(near, "{one:?} {other:?} {p:?}");
                compared += 1;
            }
        }
        motions += 1;
    }
    assert!(compared > 8 * motions, "{compared}");
}

/// Switched on at a phase of uncontrolled stick-slip: the same as after many of its cycles, which
/// were followed from elsewhere, in every reading of the past.
#[test]
fn cycles_before_switch_on_are_read() {
    for (of_b, v0) in [(false, 0.35), (true, 0.1)] {
        for (memory, latency) in [(0.0, 0.0), (0.0, 3.0), (0.4, 0.0), (-0.5, 7.0)] {
            let mut p = letter(of_b, v0, 12.0, Readings::default());
            let sample_time = p.feedback.readings.sample_time;
            p.feedback.channel = Channel {
                memory,
                latency: latency * sample_time,
            };
            let accuracy = Accuracy::default();
            let (mut motion, cycle) = after_release(&p, accuracy, 1.3).unwrap();
            let found = events(&mut motion, 60.0);
            // From rest at a = 0 the first release is at t = 1/v0.
            let first = 1.0 / v0 + 12.0 * cycle.period();
            p.switch_on = first + 1.3;
            let expected = events(&mut Motion::new(p, accuracy, 0.0, 0.0), first + 60.0);
            let later: Vec<_> = expected.iter().filter(|e| e.1 > first + 1e-6).collect();
            assert_eq!(found.len(), later.len(), "{found:?} {expected:?}");
            for (one, other) in found.iter().zip(later) {
                let near = one.0 == other.0 && (one.1 + first - other.1).abs() < 1e-7;
                assert!(near, "{one:?} {other:?} {first}");
            }
        }
    }
}

fn outcome(p: Parameters, stable_abscissa: Option<f64>, horizon: f64) -> Summary {
    let limits = Limits {
        horizon,
        steps: 10_000_000,
        stable_abscissa,
        repeated: REPEATED,
        cycles: usize::MAX,
    };
    let rest = p.law.mu_k(p.v0);
    let u = 1.01 * p.v0;
    follow(
        &mut Motion::new(p, Accuracy::default(), u, rest),
        &limits,
        &mut (),
    )
}

/// Well above the critical velocity stick-slip ends, well below it goes on, with and without noise
/// and rounding. Readings do not fit into the cycle, so no two cycles are equal.
#[test]
fn outcomes_are_told_under_readings_and_noise() {
    let inexact = |noise, resolution| Readings {
        noise,
        resolution,
        seed: 5,
        ..Readings::default()
    };
    for readings in [
        inexact(0.0, 0.0),
        inexact(1e-4, 0.0),
        inexact(0.0, 2e-4),
        inexact(1e-4, 2e-4),
    ] {
        // Slower than the roots of sliding under feedback without interruption.
        for (of_b, v0, abscissa) in [(false, 0.45, -0.02), (true, 0.1, -0.2)] {
            let s = outcome(letter(of_b, v0, 23.0, readings), Some(abscissa), 5000.0);
            assert_eq!(s.outcome, Outcome::Sliding, "{readings:?} {s:?}");
        }
        for (of_b, v0) in [(false, 0.25), (true, 0.02)] {
            let s = outcome(letter(of_b, v0, 23.0, readings), None, 9000.0);
            assert_eq!(s.outcome, Outcome::StickSlip, "{readings:?} {s:?}");
            assert!(
                s.period > 5.0 && s.stick_time > 1.0 && s.slips >= 1,
                "{s:?}"
            );
            assert!((s.period - s.stick_time - s.slip_time).abs() < 1e-12);
        }
    }
}

/// The bits of a noisy motion depend on its seed alone.
#[test]
fn noise_depends_on_the_seed() {
    let run = |seed| {
        let readings = Readings {
            noise: 1e-3,
            seed,
            ..Readings::default()
        };
        let p = letter(true, 0.1, 20.0, readings);
        let mut motion = Motion::new(p, Accuracy::default(), 0.1, 0.4);
        let found = events(&mut motion, 120.0);
        (found, motion.a.to_bits(), motion.u.to_bits())
    };
    let [one, again, other] = [3, 3, 4].map(run);
    assert_eq!(one, again);
    assert_ne!((one.1, one.2), (other.1, other.2));
}

const NOISY: &str = "seed = 9\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n[fixed]\n\
    v0 = 0.1\nalpha_n = -10\ntau = 0.5\nsample_time = 0.05\nnoise = 0.02\n";

/// Shares under noise are the same on any number of threads, and each start has noise of its own.
#[test]
fn starts_of_a_basin_have_noise_of_their_own() {
    let spec: CaseSpec = NOISY.parse().unwrap();
    assert_eq!(spec.case.feedback.readings.seed, 9);
    let simulation = slipmap::setting::simulation::Simulation {
        horizon: Some(60.0),
        seed: 9,
        ..Default::default()
    };
    // All starts are one: what differs is their noise.
    let basin = Basin {
        starts: 64,
        x_dot0: Some([0.1, 0.1 + 1e-15]),
        a0: Some([0.4, 0.4 + 1e-15]),
        ..Basin::default()
    };
    let outcomes = |threads| {
        let followed = Followed::of(
            &spec.setting,
            &simulation,
            &basin,
            (threads, &Arc::default()),
        );
        let starts: Vec<_> = followed.unwrap().starts().map(|start| start.2).collect();
        starts
    };
    let one = outcomes(1);
    assert_eq!(one, outcomes(3));
    assert_eq!(one.len(), 64);
    assert!(one.iter().any(|other| *other != one[0]), "{:?}", one[0]);
}

#[test]
fn mistakes_in_readings_are_named() {
    for (line, says) in [
        (
            "tau = 0.52",
            "tau = 0.52 is no whole multiple of sample_time",
        ),
        (
            "latency = 0.07",
            "latency = 0.07 is no whole multiple of sample_time",
        ),
        (
            "sample_time = 0",
            "noise = 0.02 is of readings, and there are none",
        ),
        ("noise = -1", "noise"),
    ] {
        let key = line.split(' ').next().unwrap();
        let kept = NOISY.lines().filter(|of| !of.starts_with(key));
        let text: String = kept.map(|line| format!("{line}\n")).collect();
        let error = format!("{text}{line}\n").parse::<CaseSpec>().unwrap_err();
        assert!(error.message.contains(says), "{error}");
        assert!(error.span.is_some(), "{error}");
    }
    let error = format!("seed = -1\n{}", &NOISY[9..]).parse::<CaseSpec>();
    assert!(error.unwrap_err().message.contains("seed"));
}

/// The critical velocity of the letter's Fig. 3 (b) with this parameter beside.
fn critical_velocity(beside: (&'static str, f64), protocol: Protocol) -> [f64; 3] {
    let numbers = [
        ("mu0", 0.5),
        ("v_s", 0.5),
        ("alpha_n", -10.0),
        ("tau", 0.5),
        beside,
    ];
    let law = LawKind::named("weakening").unwrap();
    let setting = Setting::checked(numbers, Some(law), &[Parameter::V0]).unwrap();
    let found = VcProblem::of(&setting).unwrap().find(protocol).critical;
    [found.vc_lower, found.vc, found.vc_upper]
}

/// Held readings are a latency of h/2, to second order: critical velocities of held motions, found
/// by simulation, against those of the return map with a latency.
#[test]
fn critical_velocities_are_those_of_half_a_sample_of_latency() {
    let with_latency = |h: f64| critical_velocity(("latency", 0.5 * h), Protocol::Follow)[1];
    let switched_on = Protocol::SwitchOn(Phase::After(0.0));
    let apart = [0.05, 0.025].map(|h| {
        let [_, vc, _] = critical_velocity(("sample_time", h), switched_on);
        (vc / with_latency(h) - 1.0).abs()
    });
    let order = (apart[0] / apart[1]).log2();
    assert!(apart[1] < 1e-3 && (order - 2.0).abs() < 0.4, "{apart:?}");
    // While v0 is raised stick-slip may be lost by chance, since readings drift against its cycle.
    for h in [0.1, 0.025] {
        let [lower, _, upper] = critical_velocity(("sample_time", h), Protocol::Follow);
        let vc = with_latency(h);
        assert!(
            lower < 1.01 * vc && 0.99 * vc < upper,
            "{h}: {lower} {vc} {upper}"
        );
        assert!(upper < 1.12 * lower, "{h}: {lower} {upper}");
    }
}

#[test]
fn a_critical_velocity_needs_whole_samples() {
    let law = LawKind::named("weakening").unwrap();
    let numbers = [
        ("mu0", 0.5),
        ("v_s", 0.5),
        ("alpha_n", -10.0),
        ("tau", 0.5),
        ("sample_time", 0.5),
    ];
    let mut setting = Setting::checked(numbers, Some(law), &[Parameter::V0]).unwrap();
    assert!(VcProblem::of(&setting).is_ok());
    setting.set(Parameter::Tau, 0.7);
    let error = VcProblem::of(&setting).unwrap_err();
    assert_eq!(error.parameter, "tau", "{error}");
}
