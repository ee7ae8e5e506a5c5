//! Motions under feedback with memory and latency: S(t) = a(t−δ) − a(t−δ−τ) + R S(t−τ), against
//! the sum that S is, the roots of linear theory, a second integrator, and themselves at smaller
//! tolerances. The referee of `tests/referee` follows such motions by its own means.
//!
//! Units: M = κ = N0 = 1.

use crate::chance::{Chance, asked};
use crate::signal::{exponent, samples, slope};
use slipmap::linear::general::{DelayLine, Polynomial, RootCounter, Spectrum, System};
use slipmap::model::{Channel, Dashpots, Feedback, FrictionLaw, Table};
use slipmap::slip::motion::{Accuracy, Event, Integrator, Motion, Parameters};
use slipmap::slip::step::Step;

fn case(law: FrictionLaw, v0: f64, gains: (f64, f64), tau: f64, echo: (f64, f64)) -> Parameters {
    Parameters {
        law,
        velocity_unit: 1.0,
        dashpots: Dashpots::default(),
        feedback: Feedback::new(gains.0, gains.1, tau).through(Channel {
            memory: echo.0,
            latency: echo.1,
        }),
        v0,
        switch_on: 0.0,
    }
}

fn letters_law() -> FrictionLaw {
    FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap()
}

fn events(p: &Parameters, accuracy: Accuracy, start: (f64, f64), end: f64) -> Vec<(Event, f64)> {
    let mut motion = Motion::new(p.clone(), accuracy, start.0, start.1);
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

/// A motion by chance, with memory and latency of all sizes, and its start.
fn random(chance: &mut Chance) -> (Parameters, (f64, f64)) {
    let table = Table::new(vec![0.0, 0.1, 0.3, 1.0], vec![1.0, 0.7, 0.5, 0.45]).unwrap();
    let law = match chance.of(4) {
        0 => FrictionLaw::coulomb(0.4, 1.0),
        1 => FrictionLaw::weakening(0.7, chance.log(0.05, 1.0), 1.0),
        2 => FrictionLaw::stribeck(0.4, chance.log(0.05, 1.0), 1.0),
        _ => FrictionLaw::table(table, 1.0),
    };
    let gains = [
        (chance.between(-0.6, 0.3), 0.0),
        (0.0, chance.between(-2.0, 0.5)),
        (chance.between(-0.4, 0.2), chance.between(-1.0, 0.3)),
    ][chance.of(3)];
    let memory = [0.0, chance.between(-0.8, 0.9), chance.between(-0.5, 0.7)][chance.of(3)];
    let latency = [0.0, chance.log(1e-3, 5.0), chance.log(0.1, 1.0)][chance.of(3)];
    let mut p = case(
        law.unwrap(),
        chance.log(0.05, 1.0),
        gains,
        chance.log(0.05, 8.0),
        (memory, latency),
    );
    p.switch_on = [0.0, chance.between(0.0, 10.0)][chance.of(2)];
    let start = (
        [0.0, p.v0, chance.between(-0.5, 1.5)][chance.of(3)],
        chance.between(-0.9, 0.9),
    );
    (p, start)
}

/// a at all times, from the steps that made it.
struct Recorded {
    steps: Vec<(f64, Step)>,
    before: f64,
}

impl Recorded {
    fn at(&self, t: f64) -> f64 {
        if t <= 0.0 {
            return self.before;
        }
        let next = self.steps.partition_point(|(start, _)| *start <= t);
        let (start, step) = &self.steps[next - 1];
        step.state(t - start).1
    }

    /// Σ R^k [a(t−δ−kτ) − a(t−δ−(k+1)τ)].
    fn fed_back(&self, p: &Parameters, t: f64) -> f64 {
        let (mut sum, mut share, mut t) = (0.0, 1.0, t - p.feedback.channel.latency);
        while t > 0.0 && share != 0.0 {
            sum += share * (self.at(t) - self.at(t - p.feedback.tau));
            share *= p.feedback.channel.memory;
            t -= p.feedback.tau;
        }
        sum
    }
}

/// What is fed back is the sum that it is said to be, at any time and whatever happens.
#[test]
fn what_is_fed_back_is_its_sum() {
    let mut chance = Chance(11);
    let mut looked_at = 0;
    for _ in 0..asked("SLIPMAP_CASES", 150) {
        let (p, (u, a)) = random(&mut chance);
        let integrator = [Integrator::Taylor, Integrator::Collocation][chance.of(2)];
        let tolerance = [1e-12, 1e-10][chance.of(2)];
        let accuracy = Accuracy {
            integrator,
            tolerance,
        };
        let mut motion = Motion::new(p.clone(), accuracy, u, a);
        let mut recorded = Recorded {
            steps: Vec::new(),
            before: a,
        };
        while motion.t < 40.0 {
            let start = motion.t;
            let event = motion.advance(40.0);
            if event == Some(Event::LiftOff) {
                break;
            }
            assert!(motion.u.is_finite(), "{p:?}");
            recorded.steps.push((start, motion.last_step().clone()));
        }
        for (start, step) in &recorded.steps {
            if *start < p.switch_on || chance.of(20) > 0 {
                continue;
            }
            let s = chance.unit() * step.length;
            let (found, sum) = (step.fed_back(s), recorded.fed_back(&p, start + s));
            let size = 1.0 + recorded.at(start + s).abs();
            assert!(
                (found - sum).abs() <= 2e3 * tolerance * size,
                "{p:?} {accuracy:?} from {u}, {a} at {start} + {s}: {found} {sum} {:e}",
                found - sum
            );
            looked_at += 1;
        }
    }
    println!("{looked_at} times");
    assert!(looked_at > 500);
}

/// By how much events are off those of the smallest tolerance falls with the tolerance.
#[test]
fn errors_are_proportional_to_the_tolerance() {
    let table = Table::new(vec![0.0, 0.02, 0.06, 0.2], vec![1.0, 0.7, 0.5, 0.45]).unwrap();
    let laws = [
        FrictionLaw::coulomb(0.4, 1.0),
        FrictionLaw::weakening(0.9, 0.02, 1.0),
        FrictionLaw::stribeck(0.4, 0.02, 1.0),
        FrictionLaw::table(table, 1.0),
    ];
    let laws = laws.map(Result::unwrap);
    for echo in [(0.6, 0.0), (0.0, 0.4), (-0.4, 0.07), (0.8, 2.0)] {
        let mut worst = [1e-15; 24];
        for law in &laws {
            for gains in [(-0.3, 0.0), (0.0, -0.4), (-0.2, 0.2)] {
                let mut p = case(law.clone(), 0.12, gains, 1.3, echo);
                p.switch_on = 4.0;
                let events = |tolerance| events(&p, Accuracy::of(tolerance), (0.9, 0.0), 40.0);
                let exact = events(1e-15);
                for (halvings, worst) in worst.iter_mut().enumerate() {
                    let tolerance = 1e-6 * 0.5_f64.powi(halvings as i32);
                    let found = events(tolerance);
                    assert_eq!(found.len(), exact.len(), "{p:?} {tolerance}");
                    for (one, other) in found.iter().zip(&exact) {
                        assert_eq!(one.0, other.0, "{p:?} {tolerance}");
                        *worst = f64::max(*worst, (one.1 - other.1).abs());
                    }
                }
            }
        }
        let points = worst.iter().enumerate();
        let points = points.map(|(i, error)| (0.5_f64.ln() * i as f64, error.ln()));
        let points: Vec<_> = points.collect();
        let slope = slope(&points);
        println!(
            "{echo:?}: power {slope:.3}, {:e} to {:e}",
            worst[0], worst[23]
        );
        assert!((0.8..1.3).contains(&slope), "{echo:?} {slope} {worst:?}");
        assert!(worst[23] < 1e-9, "{echo:?} {worst:?}");
    }
}

/// The characteristic roots under memory and latency, by the general engine.
fn spectrum(p: &Parameters) -> Spectrum {
    let b = p.law.mu_prime(p.v0);
    let a_n = p.law.mu_k(p.v0) * p.feedback.gains.alpha_n;
    let open = Polynomial::new(&[1.0, b, 1.0]).unwrap();
    let gain =
        Polynomial::new(&[a_n + p.feedback.gains.alpha_v * b, p.feedback.gains.alpha_v]).unwrap();
    let system = System::feedback(open, gain, p.feedback.channel);
    let (counter, line) = (RootCounter::new(&system), DelayLine::of(&system));
    Spectrum::at(&counter, &line, p.feedback.tau, 2)
}

#[test]
fn small_deviations_grow_and_decay_as_linear_theory_says() {
    let mut chance = Chance(5);
    // With memory, latency, or both; decaying and growing.
    let mut seen = [[0; 2]; 3];
    while seen.as_flattened().iter().any(|&n| n < 4) {
        let (control, kind) = (chance.of(3), chance.of(3));
        let law = match chance.of(2) {
            0 => FrictionLaw::weakening(0.5, chance.between(0.3, 1.0), 1.0),
            _ => FrictionLaw::stribeck(0.4, chance.between(0.4, 1.5), 1.0),
        };
        let gains = (
            [1.0, 0.0, 1.0][control] * chance.between(-0.6, 0.3),
            [0.0, 1.0, 1.0][control] * chance.between(-3.0, 0.5),
        );
        let echo = (
            [1.0, 0.0, 1.0][kind] * chance.between(-0.6, 0.7),
            [0.0, 1.0, 1.0][kind] * chance.log(0.01, 2.0),
        );
        let (v0, tau) = (chance.between(0.2, 1.5), chance.between(0.2, 5.0));
        let p = case(law.unwrap(), v0, gains, tau, echo);
        if let Some(growing) = deviation_follows_linear_theory(&p) {
            seen[kind][usize::from(growing)] += 1;
        }
    }
    println!("{seen:?}");
}

/// Compares a small deviation of `p` with its rightmost root. Says whether it grows; none where
/// this does not tell apart: where the next root is too near, the rate too slow or too fast.
fn deviation_follows_linear_theory(p: &Parameters) -> Option<bool> {
    let spectrum = spectrum(p);
    let [root, next] = spectrum.roots[..] else {
        return None;
    };
    let (root, next) = (root.lambda, next.lambda.re.max(spectrum.essential_abscissa));
    if !spectrum.certified || root.im == 0.0 || root.re.abs() < 0.02 {
        return None;
    }
    let count = 12;
    let every = 0.25 * std::f64::consts::TAU / root.im.abs();
    // The next root's part has fallen by e^−19.
    let late = 19.0 / (root.re - next);
    let end = late + f64::from(count) * every;
    if root.re.abs() * end > 8.0 {
        return None;
    }
    // Nonlinear terms stay below 1e-6 of the deviation.
    let start = (3e-7 * (-root.re * end).exp()).clamp(1e-12, 1e-5);
    let (u, rest) = (p.v0 + start, p.law.mu_k(p.v0));
    let mut motion = Motion::new(p.clone(), Accuracy::of(1e-15), u, rest);
    let rest = motion.sliding_elongation();
    let signal = samples(&mut motion, late, every, count as usize);
    let signal: Vec<_> = signal.iter().map(|a| a - rest).collect();
    let (rate, frequency) = exponent(&signal, every);
    assert!(
        (rate / root.re - 1.0).abs() < 1e-6,
        "{p:?} {root} {next} {rate}"
    );
    assert!(
        (frequency / root.im.abs() - 1.0).abs() < 1e-6,
        "{p:?} {root} {frequency}"
    );
    Some(root.re > 0.0)
}

/// Steps outlast short delays and latencies, and are as exact.
#[test]
fn steps_longer_than_the_latency_are_as_exact() {
    for (gains, tau, echo) in [
        ((0.0, -1.5), 0.5, (0.0, 1e-3)),
        ((-0.4, 0.0), 0.7, (0.0, 3e-3)),
        ((-0.3, -0.5), 0.05, (0.5, 0.01)),
        ((0.0, -2.0), 0.02, (0.7, 0.0)),
    ] {
        let p = case(letters_law(), 0.5, gains, tau, echo);
        let run = |tolerance: f64| {
            let accuracy = Accuracy::of(tolerance);
            let mut motion = Motion::new(p.clone(), accuracy, 0.2, 0.4);
            let mut steps = 0;
            while motion.t < 30.0 {
                assert_ne!(motion.advance(30.0), Some(Event::LiftOff));
                steps += 1;
            }
            ([motion.u, motion.a], steps)
        };
        let (exact, _) = run(1e-14);
        for tolerance in [1e-6, 1e-8, 1e-10] {
            let (found, steps) = run(tolerance);
            let off = (found[0] - exact[0]).abs().max((found[1] - exact[1]).abs());
            println!("{gains:?} {tau} {echo:?} {tolerance:e}: {off:e}, {steps} steps");
            assert!(off < 1e3 * tolerance, "{p:?} {tolerance:e} {off:e}");
        }
    }
}

/// Both integrators come to the same events.
#[test]
fn both_integrators_agree() {
    let mut chance = Chance(7);
    let mut seen = 0;
    for _ in 0..asked("SLIPMAP_CASES", 60) {
        let (p, start) = random(&mut chance);
        let by = |integrator, tolerance| {
            let accuracy = Accuracy {
                integrator,
                tolerance,
            };
            events(&p, accuracy, start, 30.0)
        };
        let found = by(Integrator::Taylor, 1e-12);
        // What depends on the last digits of one method is no matter of the other.
        let rough = by(Integrator::Taylor, 1e-9);
        let apart = |one: &[(Event, f64)], other: &[(Event, f64)]| {
            let alike = one.len() == other.len() && one.iter().zip(other).all(|(p, q)| p.0 == q.0);
            let off = one.iter().zip(other).map(|(p, q)| (p.1 - q.1).abs());
            alike.then(|| off.fold(0.0, f64::max))
        };
        if apart(&found, &rough).is_none_or(|off| off > 1e-6) {
            continue;
        }
        let other = by(Integrator::Collocation, 1e-11);
        let off = apart(&found, &other);
        assert!(off.is_some_and(|off| off < 1e-7), "{p:?} {start:?} {off:?}");
        seen += found.len();
    }
    println!("{seen} events");
    assert!(seen > 300);
}

/// A stuck block under load control stretches its spring evenly: over the first delay S = v0 (t −
/// δ), later v0 τ Σ R^k, and it is released where a = μ_S (1 + α_n S).
#[test]
fn sticks_under_memory_have_their_closed_form() {
    let (tau, latency, v0, alpha_n) = (0.7, 0.3, 0.05, -2.0);
    for memory in [0.0, 0.6, -0.5] {
        let p = case(letters_law(), v0, (0.0, alpha_n), tau, (memory, latency));
        let a0 = -0.9;
        for integrator in [Integrator::Taylor, Integrator::Collocation] {
            let accuracy = Accuracy {
                integrator,
                tolerance: 1e-12,
            };
            let mut motion = Motion::new(p.clone(), accuracy, 0.0, a0);
            let mut steps = 0;
            while motion.advance(f64::INFINITY) != Some(Event::Release) {
                steps += 1;
            }
            let s = v0 * tau / (1.0 - memory);
            let expected = (1.0 + alpha_n * s - a0) / v0;
            assert!(
                (motion.t - expected).abs() < 1e-9,
                "{memory} {integrator:?}: {} {expected}, {steps} steps",
                motion.t
            );
        }
    }
}
