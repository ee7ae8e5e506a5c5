//! The integrator against known event times, linear theory, closed forms, an energy balance,
//! another integrator, and chance.
//!
//! Units: M = κ = N0 = 1, so that everything is dimensionless as in `slipmap::slip::motion`.

use crate::chance::Chance;
use crate::signal::{exponent, samples, slope};
use slipmap::linear::rightmost::Rightmost;
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::law::Kind;
use slipmap::model::{Dashpots, Feedback, FrictionLaw, Groups, Table};
use slipmap::slip::motion::{Accuracy, Event, Mode, Motion, Parameters};
use slipmap::slip::outcome::{Limits, Observer, Outcome, Summary};
use slipmap::slip::watch::{REPEATED, follow};

fn at_tolerance(tolerance: f64) -> Accuracy {
    Accuracy {
        tolerance,
        ..Accuracy::default()
    }
}

fn case(law: FrictionLaw, v0: f64, gains: (f64, f64), tau: f64, switch_on: f64) -> Parameters {
    Parameters {
        law,
        velocity_unit: 1.0,
        dashpots: Dashpots::default(),
        feedback: Feedback::new(gains.0, gains.1, tau),
        v0,
        switch_on,
    }
}

fn letters_law() -> FrictionLaw {
    FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap()
}

/// The letter's Fig. 3 (a) and (b).
fn fig3() -> [Parameters; 2] {
    [
        case(letters_law(), 0.35, (-0.33, 0.0), 4.15, 70.0),
        case(letters_law(), 0.1, (0.0, -10.0), 0.5, 70.0),
    ]
}

/// Events with their times and elongations until `horizon`, from ẋ = 1.01 v0, a = μ_K(v0).
fn events(p: &Parameters, accuracy: Accuracy, horizon: f64) -> Vec<(Event, f64, f64)> {
    events_from(p, accuracy, (1.01 * p.v0, p.law.mu_k(p.v0)), horizon)
}

/// Events with their times and elongations until `horizon`, from a given ẋ and a.
fn events_from(
    p: &Parameters,
    accuracy: Accuracy,
    (u, a): (f64, f64),
    horizon: f64,
) -> Vec<(Event, f64, f64)> {
    let mut motion = Motion::new(p.clone(), accuracy, u, a);
    let mut events = Vec::new();
    while motion.t < horizon {
        if let Some(event) = motion.advance(horizon) {
            events.push((event, motion.t, motion.a));
        }
    }
    events
}

/// Slip and stick duration of the last full cycle before switch-on, the end of the last stick, the
/// elongation there.
fn landmarks(events: &[(Event, f64, f64)]) -> [f64; 4] {
    let switch = events.iter().position(|e| e.0 == Event::SwitchOn).unwrap();
    let before = &events[..switch];
    let stop = before.iter().rposition(|e| e.0 == Event::Stick).unwrap();
    let release = |from: &[(Event, f64, f64)]| {
        let found = from.iter().rev().find(|e| e.0 == Event::Release);
        let &(_, t, a) = found.expect("released");
        (t, a)
    };
    let (started, _) = release(&before[..stop]);
    let previous_stop = before[..stop].iter().rev().find(|e| e.0 == Event::Stick);
    let stick = started - previous_stop.unwrap().1;
    let (last, elongation) = release(events);
    [before[stop].1 - started, stick, last, elongation]
}

#[test]
fn the_events_of_the_letters_figure_3() {
    let expected = [
        [3.97549563, 4.92001175, 97.029009396],
        [3.44600138, 15.85555061, 76.277483031],
    ];
    for (p, expected) in fig3().into_iter().zip(expected) {
        let found = events(&p, Accuracy::default(), 250.0);
        let marks = landmarks(&found);
        for (mark, expected) in marks.iter().zip(expected) {
            assert!((mark - expected).abs() < 1e-8, "{marks:?}");
        }
        if p.feedback.gains.alpha_n != 0.0 {
            assert!((marks[3] - 0.5).abs() < 1e-10, "{marks:?}");
        }
        // Continuous sliding afterwards.
        assert_eq!(found.last().unwrap().0, Event::Release);
    }
}

#[test]
fn errors_are_proportional_to_the_tolerance() {
    for p in fig3() {
        let tightest = landmarks(&events(&p, at_tolerance(1e-15), 150.0));
        let error = |accuracy| {
            let marks = landmarks(&events(&p, accuracy, 150.0));
            let pairs = marks.iter().zip(&tightest);
            pairs.map(|(m, t)| (m - t).abs()).fold(0.0, f64::max)
        };
        let mut points = Vec::new();
        for halvings in 0..20 {
            let tolerance = 1e-6 * 0.5_f64.powi(halvings);
            let error = error(at_tolerance(tolerance));
            points.push((tolerance.ln(), error.max(1e-14).ln()));
        }
        for tolerance in [3e-13, 1e-13, 1e-14] {
            let error = error(at_tolerance(tolerance));
            assert!(error < 1e-11, "{error:e} at {tolerance:e}");
        }
        let slope = slope(&points);
        println!("errors grow with the tolerance to the power {slope:.3}");
        assert!((0.8..1.3).contains(&slope), "{slope} {points:?}");
    }
}

/// Under every law, the narrow ones too, and both controls, down to where rounding begins. The
/// referee of `tests/referee` holds the same laws to values of its own.
#[test]
fn errors_are_proportional_to_the_tolerance_under_every_law() {
    let table = Table::new(vec![0.0, 0.02, 0.06, 0.2], vec![1.0, 0.7, 0.5, 0.45]).unwrap();
    let laws = [
        FrictionLaw::coulomb(0.4, 1.0),
        FrictionLaw::weakening(0.9, 0.02, 1.0),
        FrictionLaw::stribeck(0.4, 0.02, 1.0),
        FrictionLaw::table(table, 1.0),
    ];
    for law in laws.map(Result::unwrap) {
        for gains in [(-0.3, 0.0), (0.0, -0.8), (-0.2, 0.3)] {
            let p = case(law.clone(), 0.12, gains, 1.3, 4.0);
            let events = |tolerance| events_from(&p, at_tolerance(tolerance), (0.9, 0.0), 40.0);
            let exact = events(1e-15);
            let mut points = Vec::new();
            for halvings in 0..24 {
                let tolerance = 1e-6 * 0.5_f64.powi(halvings);
                let found = events(tolerance);
                assert_eq!(found.len(), exact.len(), "{p:?} {tolerance}");
                let off = found.iter().zip(&exact).map(|(one, other)| {
                    assert_eq!(one.0, other.0, "{p:?} {tolerance}");
                    (one.1 - other.1).abs()
                });
                let error = off.fold(1e-15, f64::max);
                points.push((tolerance.ln(), error.ln()));
            }
            let slope = slope(&points);
            let last = points[23].1.exp();
            println!(
                "{law:?} {gains:?}: power {slope:.3}, {} events, {last:e}",
                exact.len()
            );
            assert!((0.8..1.3).contains(&slope), "{p:?} {slope} {points:?}");
            assert!(last < 1e-9, "{p:?} {last:e}");
        }
    }
}

/// Steps outlast a short delay, since the polynomial of the last one goes on to be the motion;
/// errors stay in proportion.
#[test]
fn steps_longer_than_the_delay_are_as_exact() {
    for (gains, tau) in [
        ((0.0, -8.0), 0.02),
        ((0.0, -200.0), 0.005),
        ((-3.0, 0.0), 0.05),
        ((-0.5, -2.0), 1e-3),
    ] {
        let p = case(letters_law(), 0.5, gains, tau, 0.0);
        let run = |tolerance: f64| {
            let mut motion = Motion::new(p.clone(), at_tolerance(tolerance), 0.0, 0.9);
            let mut steps = 0.0;
            while motion.t < 25.0 {
                motion.advance(25.0);
                steps += 1.0;
            }
            (motion.a, steps)
        };
        let (exact, _) = run(1e-14);
        let tolerances = [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11];
        let mut points = Vec::new();
        for tolerance in tolerances {
            let (a, steps) = run(tolerance);
            points.push((tolerance.ln(), (a - exact).abs().max(1e-15).ln()));
            assert!(
                tolerance < 1e-6 || steps * tau < 0.7 * 25.0,
                "{gains:?} {steps}"
            );
        }
        let slope = slope(&points);
        println!("{gains:?} {tau}: power {slope:.3} {points:?}");
        assert!(
            (0.75..1.35).contains(&slope),
            "{gains:?} {slope} {points:?}"
        );
    }
}

#[test]
fn small_deviations_grow_and_decay_as_linear_theory_says() {
    let mut chance = Chance(3);
    // By control (velocity, load, both), decaying and growing.
    let mut seen = [[0; 2]; 3];
    while seen.as_flattened().iter().any(|&n| n < 4) {
        let control = chance.of(3);
        let v0 = chance.between(0.2, 1.5);
        let law = match chance.of(2) {
            0 => FrictionLaw::weakening(0.5, chance.between(0.3, 1.0), 1.0),
            _ => FrictionLaw::stribeck(0.4, chance.between(0.4, 1.5), 1.0),
        };
        let law = law.unwrap();
        let gains = (
            [1.0, 0.0, 1.0][control] * chance.between(-0.6, 0.3),
            [0.0, 1.0, 1.0][control] * chance.between(-5.0, 0.5),
        );
        let p = case(law, v0, gains, chance.between(0.2, 5.0), 0.0);
        if let Some(growing) = deviation_follows_linear_theory(&p) {
            seen[control][usize::from(growing)] += 1;
        }
    }
    println!("{seen:?}");
}

/// Compares a small deviation of `p` with its rightmost root. Says whether it grows; none where
/// this does not tell apart: where the next root is too near, the rate too slow or too fast.
fn deviation_follows_linear_theory(p: &Parameters) -> Option<bool> {
    let groups = Groups::new(
        p.law.mu_prime(p.v0),
        p.feedback.gains.alpha_v,
        p.law.mu_k(p.v0) * p.feedback.gains.alpha_n,
    );
    let count = Crossings::of(groups).count(p.feedback.tau, MarginalTolerance::default());
    let rightmost = Rightmost::at(groups, p.feedback.tau, 2, count);
    let [root, next] = rightmost.roots[..] else {
        return None;
    };
    let (root, next) = (root.lambda, next.lambda);
    if !rightmost.certified || root.im == 0.0 || root.re.abs() < 0.02 {
        return None;
    }
    let count = 12;
    let every = 0.25 * std::f64::consts::TAU / root.im.abs();
    // The next root's part has fallen by e^−19.
    let late = 19.0 / (root.re - next.re);
    let end = late + f64::from(count) * every;
    if root.re.abs() * end > 8.0 {
        return None;
    }
    // Nonlinear terms stay below 1e-6 of the deviation.
    let start = (3e-7 * (-root.re * end).exp()).clamp(1e-12, 1e-5);
    let mut motion = Motion::new(
        p.clone(),
        at_tolerance(1e-15),
        p.v0 + start,
        p.law.mu_k(p.v0),
    );
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

/// Compares u and a with `exact` (of time) until `end`.
fn agrees(p: Parameters, u: f64, a: f64, end: f64, exact: impl Fn(f64) -> (f64, f64)) {
    let mut motion = Motion::new(p, Accuracy::default(), u, a);
    while motion.t < end {
        let start = motion.t;
        assert_eq!(motion.advance(end), None, "slides on");
        let step = motion.last_step();
        for i in 0..=4 {
            let s = step.length * f64::from(i) / 4.0;
            let ((u, a, _), (u_exact, a_exact)) = (step.state(s), exact(start + s));
            let error = (u - u_exact).abs().max((a - a_exact).abs());
            assert!(error < 1e-10, "{error:e} at {}", start + s);
        }
    }
}

#[test]
fn coulomb_slip_is_its_closed_form() {
    let (mu, v0, u0, a0) = (0.4, 1.0, 1.3, 0.5);
    let law = FrictionLaw::coulomb(mu, 1.0).unwrap();
    // Harmonic without control.
    let free = case(law.clone(), v0, (0.0, 0.0), 1.0, f64::INFINITY);
    agrees(free, u0, a0, 40.0, |t| {
        let (p, q) = (a0 - mu, u0 - v0);
        (
            v0 + p * t.sin() + q * t.cos(),
            mu + p * t.cos() - q * t.sin(),
        )
    });
    // Load control over the first delay: a″ = −(1 − μα)(a − a*), with a constant delayed
    // elongation.
    let (alpha, tau) = (-1.5, 3.0);
    let w2: f64 = 1.0 - mu * alpha;
    let rest = mu * (1.0 - alpha * a0) / w2;
    let w = w2.sqrt();
    let load = case(law.clone(), v0, (0.0, alpha), tau, 0.0);
    agrees(load, u0, a0, tau, |t| {
        let (c, s) = ((w * t).cos(), (w * t).sin());
        let (p, q) = (a0 - rest, (v0 - u0) / w);
        (v0 + w * (p * s - q * c), rest + p * c + q * s)
    });
    // Velocity control over the first delay: y = a − μ obeys y″ = αy′ − y.
    let alpha = -0.3;
    let w = (1.0_f64 - 0.25 * alpha * alpha).sqrt();
    agrees(case(law, v0, (alpha, 0.0), tau, 0.0), u0, a0, tau, |t| {
        let (y0, slope0) = (a0 - mu, v0 - u0);
        let q = (slope0 - 0.5 * alpha * y0) / w;
        let (c, s, growth) = ((w * t).cos(), (w * t).sin(), (0.5 * alpha * t).exp());
        let y = growth * (y0 * c + q * s);
        let slope = 0.5 * alpha * y + growth * w * (q * c - y0 * s);
        (v0 + alpha * (y + mu - a0) - slope, y + mu)
    });
}

/// Nodes and weights of Gauss's rule with eight points on [0, 1].
const GAUSS: [(f64, f64); 4] = [
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.525_532_409_916_329, 0.313_706_645_877_887_27),
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
];

fn integral(f: impl Fn(f64) -> f64, end: f64) -> f64 {
    let sum = GAUSS.iter().map(|&(node, weight)| {
        let half = 0.5 * weight;
        half * (f(0.5 * end * (1.0 - node)) + f(0.5 * end * (1.0 + node)))
    });
    end * sum.sum::<f64>()
}

#[test]
fn energy_is_accounted_for() {
    let stribeck = FrictionLaw::stribeck(0.4, 0.6, 1.0).unwrap();
    for (law, v0, gains, tau) in [
        (letters_law(), 0.1, (0.0, -10.0), 0.5),
        (letters_law(), 0.35, (-0.3, -0.5), 2.0),
        (stribeck.clone(), 0.3, (-0.1, 0.3), 3.0),
        (stribeck, 0.2, (0.1, -2.0), 0.7),
        (coarse_table(), 0.35, (-0.3, -0.5), 2.0),
    ] {
        let p = case(law.clone(), v0, gains, tau, 30.0);
        for tolerance in [1e-9, 1e-13] {
            let mut motion =
                Motion::new(p.clone(), at_tolerance(tolerance), 1.5 * v0, law.mu_k(v0));
            let energy = |m: &Motion| 0.5 * (m.a * m.a + m.u * m.u);
            let start = energy(&motion);
            let (mut pulled, mut lost) = (0.0, 0.0);
            while motion.t < 100.0 {
                if motion.advance(100.0) == Some(Event::LiftOff) {
                    break;
                }
                let step = motion.last_step();
                // n − 1 is α_n times the difference that α_v acts on.
                let power = |s| {
                    let (_, a, n) = step.state(s);
                    a * (v0 + p.feedback.gains.alpha_v * (n - 1.0) / p.feedback.gains.alpha_n)
                };
                let friction = |s| {
                    let (u, _, n) = step.state(s);
                    u.abs() * law.mu_k(u.abs()) * n
                };
                pulled += integral(power, step.length);
                lost += integral(friction, step.length);
            }
            let balance = energy(&motion) - start - pulled + lost;
            println!("{tolerance:e}: {balance:e} of {pulled}");
            assert!(
                balance.abs() < 1e2 * tolerance * (1.0 + pulled),
                "{p:?} {balance:e}"
            );
        }
    }
}

#[test]
fn kinks_long_ago_do_not_stop_the_motion() {
    // Events at times of the order of one, known better than times one long delay later are.
    for tau in [40.3, 96.7, 700.0, 12345.6] {
        let law = FrictionLaw::coulomb(0.5, 1.0).unwrap();
        let p = case(law, 1.0, (-0.001, 0.0), tau, 0.0);
        let mut motion = Motion::new(p, Accuracy::default(), 0.0, 0.0);
        let end = 2.2 * tau;
        while motion.t < end {
            let before = motion.t;
            let event = motion.advance(end);
            assert!(motion.t > before || event.is_some(), "{tau}: {before}");
        }
    }
}

/// A table that begins with one of `at_rest`, or below it, and has speeds of the size `v_s`.
fn any_table(chance: &mut Chance, (mu0, mu_s): (f64, f64), v_s: f64) -> Table {
    let points = 2 + chance.of(12);
    let mut speeds = vec![[0.0, v_s * chance.unit().max(1e-3)][chance.of(2)]];
    let mut mu_k = vec![[mu0, mu_s][chance.of(2)]];
    while speeds.len() < points {
        // Now and then very close to one another.
        let step = v_s * [chance.unit(), chance.log(1e-4, 1.0)][chance.of(2)];
        speeds.push(speeds[speeds.len() - 1] + step);
        mu_k.push(mu_s * chance.between(0.1, 1.3));
    }
    Table::new(speeds, mu_k).unwrap()
}

fn any_case(chance: &mut Chance) -> (Parameters, f64, f64) {
    let mu_s = chance.log(0.05, 5.0);
    // Now and then μ_K(0⁺) = μ_S.
    let mu0 = if chance.of(4) == 0 {
        mu_s
    } else {
        mu_s * chance.unit().max(1e-3)
    };
    let v_s = chance.log(1e-4, 1e3);
    let law = match chance.of(5) {
        0 => FrictionLaw::coulomb(mu0, mu_s),
        1 => FrictionLaw::weakening(mu0, v_s, mu_s),
        2 | 3 => FrictionLaw::table(any_table(chance, (mu0, mu_s), v_s), mu_s),
        _ => FrictionLaw::stribeck(mu0, v_s, mu_s),
    }
    .unwrap();
    let mut gain = || {
        let size = chance.log(1e-6, 1e6);
        [0.0, 0.0, size, -size][chance.of(4)]
    };
    let gains = (gain(), gain());
    let tau = chance.log(1e-4, 100.0);
    let mut v0 = chance.log(1e-6, 10.0);
    if let (Kind::Table(table), 0) = (law.kind(), chance.of(3)) {
        // On a point of the table.
        let speeds = table.speeds();
        v0 = speeds[chance.of(speeds.len())].max(1e-6);
    }
    let switch_on = [0.0, chance.between(0.0, 50.0), f64::INFINITY][chance.of(3)];
    let mut p = case(law.clone(), v0, gains, tau, switch_on);
    p.velocity_unit = [1.0, chance.log(0.1, 10.0)][chance.of(2)];
    let u = [0.0, v0, 1.01 * v0, chance.between(-3.0, 3.0)][chance.of(4)];
    let rest = law.mu_k(v0 * p.velocity_unit);
    let a = [0.0, rest, mu_s, -mu_s, chance.between(-3.0, 3.0)][chance.of(5)];
    (p, u, a)
}

fn is_sound(s: &Summary, limits: &Limits) {
    let known = [s.decided, s.peak, s.n_min];
    assert!(known.iter().all(|x| !x.is_nan()), "{s:?}");
    assert!(
        s.decided <= limits.horizon && s.steps <= limits.steps,
        "{s:?}"
    );
    if s.outcome != Outcome::LiftOff {
        assert!(s.n_min > 0.0, "{s:?}");
    }
    if s.outcome == Outcome::StickSlip {
        assert!(
            s.period > 0.0 && s.slip_time > 0.0 && s.stick_time >= 0.0,
            "{s:?}"
        );
    }
    assert_eq!(
        s.settle_time.is_nan(),
        s.outcome != Outcome::Sliding,
        "{s:?}"
    );
}

/// The most events in a row between which no time passes.
#[derive(Default)]
struct Chatter {
    last: f64,
    now: u32,
    most: u32,
}

impl Observer for Chatter {
    fn step(&mut self, motion: &Motion, event: Option<Event>) {
        let passed = motion.t - self.last > 1e-15 * motion.t;
        self.last = motion.t;
        self.now = match event {
            Some(_) if !passed => self.now + 1,
            _ => 0,
        };
        self.most = self.most.max(self.now);
    }
}

/// As many cases as `SLIPMAP_CASES` says, or 20,000.
#[test]
fn nothing_breaks_it() {
    let cases = std::env::var("SLIPMAP_CASES").map_or(20_000, |n| n.parse().unwrap());
    let mut chance = Chance(2024);
    let mut tally = [0_u32; Outcome::ALL.len()];
    for number in 0..cases {
        let (p, u, a) = any_case(&mut chance);
        let groups = Groups::new(
            p.law.mu_prime(p.v0 * p.velocity_unit) * p.velocity_unit,
            p.feedback.gains.alpha_v,
            p.law.mu_k(p.v0 * p.velocity_unit) * p.feedback.gains.alpha_n,
        );
        let stable = number % 2 == 0
            && Crossings::of(groups)
                .count(p.feedback.tau, MarginalTolerance::default())
                .stable();
        let limits = Limits {
            horizon: 2000.0,
            steps: 2000,
            stable_abscissa: stable.then_some(-0.1),
            repeated: REPEATED,
            cycles: usize::MAX,
        };
        let mut chatter = Chatter::default();
        let tolerance = at_tolerance(chance.log(1e-13, 1e-5));
        let mut motion = Motion::new(p.clone(), tolerance, u, a);
        let summary = follow(&mut motion, &limits, &mut chatter);
        assert!(chatter.most <= 3, "{p:?} {u} {a} {summary:?}");
        is_sound(&summary, &limits);
        assert!(motion.mode() != Mode::Stick || motion.u == 0.0 || motion.u.is_nan());
        tally[summary.outcome as usize] += 1;
    }
    for (outcome, count) in Outcome::ALL.iter().zip(tally) {
        println!("{}: {count}", outcome.name());
    }
    assert!(tally.iter().filter(|&&n| n > 0).count() >= 5, "{tally:?}");
}

/// A coarse measured curve: it falls, and rises again.
fn coarse_table() -> FrictionLaw {
    let speeds = vec![0.05, 0.15, 0.3, 0.55, 0.9, 1.4];
    let table = Table::new(speeds, vec![0.52, 0.44, 0.33, 0.27, 0.29, 0.36]);
    FrictionLaw::table(table.unwrap(), 1.0).unwrap()
}

#[test]
fn points_of_a_table_are_stepped_on() {
    for (v0, gains, tau) in [(0.35, (-0.33, 0.0), 4.15), (0.1, (0.0, -3.0), 1.5)] {
        let p = case(coarse_table(), v0, gains, tau, 30.0);
        let state = |tolerance| {
            let mut motion = Motion::new(p.clone(), at_tolerance(tolerance), 0.0, 0.0);
            let mut found = Vec::new();
            while motion.t < 60.0 {
                if motion.advance(60.0).is_some() {
                    found.push(motion.t);
                }
            }
            found.extend([motion.u, motion.a]);
            found
        };
        let tightest = state(1e-15);
        let mut points = Vec::new();
        for halvings in 0..24 {
            let tolerance = 1e-5 * 0.5_f64.powi(halvings);
            let found = state(tolerance);
            assert_eq!(found.len(), tightest.len());
            let pairs = found.iter().zip(&tightest);
            let error = pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
            points.push((tolerance.ln(), error.max(1e-14).ln()));
        }
        let last = state(1e-14);
        let pairs = last.iter().zip(&tightest);
        let error = pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        let slope = slope(&points);
        println!("errors grow with the tolerance to the power {slope:.3}, {error:e} at 1e-14");
        assert!(error < 1e-11, "{error:e}");
        assert!((0.8..1.3).contains(&slope), "{slope} {points:?}");
    }
}

#[test]
fn a_dense_table_moves_the_block_as_its_law_does() {
    let (v0, gains, tau) = (0.35, (-0.33, 0.0), 4.15);
    let landmarks = |law: FrictionLaw| {
        let p = case(law, v0, gains, tau, 30.0);
        let mut motion = Motion::new(p, Accuracy::default(), 0.0, 0.0);
        let mut x = 0.0;
        while motion.t < 45.0 {
            motion.advance(45.0);
            let step = motion.last_step();
            x += step.displacement(step.length);
        }
        [motion.u, motion.a, x]
    };
    let exact = landmarks(letters_law());
    let errors = [33, 65, 129, 257].map(|points: u32| {
        let speeds: Vec<_> = (0..points)
            .map(|i| 4.0 * f64::from(i) / f64::from(points - 1))
            .collect();
        let mu_k = speeds.iter().map(|v| letters_law().mu_k(*v)).collect();
        let table = Table::new(speeds, mu_k).unwrap();
        let found = landmarks(FrictionLaw::table(table, 1.0).unwrap());
        let pairs = found.iter().zip(&exact);
        pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    });
    println!("{errors:?}");
    for pair in errors.windows(2) {
        // Third order.
        assert!(pair[1] < pair[0] / 5.0, "{errors:?}");
    }
}

/// Sliding at the speed of a point, from rest there and from a little beside it, and grazing one.
#[test]
fn a_motion_that_stays_at_a_point_of_a_table_takes_long_steps() {
    for (v0, gains) in [
        (0.9, (0.0, 0.0)),
        (0.55, (0.0, 0.0)),
        (0.55, (0.0, -0.5)),
        (1.4, (-0.1, 0.0)),
        (0.05, (-0.1, -1.0)),
    ] {
        for start in [0.0, 1e-15, -1e-12, 1e-9, 1e-6, -1e-3] {
            for tolerance in [1e-6, 1e-12] {
                let p = case(coarse_table(), v0, gains, 1.0, 0.0);
                let rest = p.law.mu_k(v0);
                let mut motion = Motion::new(p, at_tolerance(tolerance), v0 + start, rest);
                let mut steps = 0;
                while motion.t < 500.0 && steps < 100_000 {
                    motion.advance(500.0);
                    steps += 1;
                }
                println!(
                    "{v0} {start:e} {tolerance:e}: {steps} steps, {:e}",
                    motion.u - v0
                );
                assert!(steps < 8000, "{v0} {gains:?} {start} {tolerance}: {steps}");
            }
        }
    }
}
