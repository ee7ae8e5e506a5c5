//! Nearly flat friction and weak feedback on oscillators with little damping: crossings that lie
//! within rounding of degenerate ones. Against a table computed with 90 digits by mpmath, and
//! against crossings in the distance from the resonance, by chance. `SLIPMAP_CASES` says how many.

mod distance;

use std::f64::consts::{PI, TAU};

use crate::chance::{Chance, asked};
use crate::general_rows::{Row, rows};
use distance::{Line, Oscillator, Weak};
use slipmap::explore::point::Point;
use slipmap::explore::stability::Wanted;
use slipmap::linear::general::{DelayLine, Polynomial, System};
use slipmap::linear::line;
use slipmap::linear::stable_delays::StableInterval;
use slipmap::linear::{Count, MarginalTolerance};
use slipmap::model::Channel;
use slipmap::model::stop::Stop;
use slipmap::setting::system::SystemModel;
use slipmap::setting::{Parameter, Setting};

/// Delays farther from a change than this, relative, are not marginal.
const NEAR: f64 = 1e-8;

fn cases(usual: u64) -> u64 {
    asked("SLIPMAP_CASES", usual)
}

/// Checks a count against what is known of its line; whether it is decided.
fn check(known: &Line, found: Count, tau: f64, place: &dyn std::fmt::Debug) -> bool {
    let (n, distance) = known.count(tau);
    let near = distance <= NEAR * tau.max(1.0);
    if found.marginal {
        assert!(
            near,
            "marginal {distance} from a change: {place:?} {tau}: {known:?}"
        );
        return false;
    }
    assert_eq!(found.n_unstable as i64, n, "{place:?} {tau}: {known:?}");
    true
}

/// A delay: any, or one beside a crossing.
fn delay(chance: &mut Chance, known: &Line) -> f64 {
    let tau = chance.log(0.03, 30.0);
    let crossings = &known.crossings;
    if crossings.is_empty() || chance.unit() < 0.7 {
        return tau;
    }
    let of = crossings[chance.of(crossings.len())];
    let turns = std::f64::consts::TAU * chance.below(4) as f64;
    (of.theta + turns) / of.omega + chance.between(-1.0, 1.0) * chance.log(1e-7, 1e-2)
}

fn setting(of: &Oscillator) -> Setting {
    let mut setting = Setting::new(None);
    let [load, velocity, sensor] = of.lags;
    for (parameter, value) in [
        (Parameter::MuPrime, of.b),
        (Parameter::AlphaV, of.a_v),
        (Parameter::AlphaN, of.a_n),
        (Parameter::Memory, of.memory),
        (Parameter::LoadLag, load),
        (Parameter::VelocityLag, velocity),
        (Parameter::SensorLag, sensor),
        (Parameter::Latency, of.latency),
    ] {
        setting.set(parameter, value);
    }
    setting
}

/// The first three intervals of stable delays of a setting.
fn stable_delays(of: &Oscillator) -> Vec<[f64; 2]> {
    let ends = |of: StableInterval| [of.from, of.to];
    let line = line_of(of);
    line.stable_intervals().take(3).map(ends).collect()
}

/// The line of delays of a setting.
fn line_of(of: &Oscillator) -> Box<dyn line::Line> {
    let (model, _) = setting(of).linear().unwrap();
    model.roots(&Stop::default()).line(1.0)
}

/// The count of a setting by its line of delays.
fn count(of: &Oscillator, tau: f64) -> Count {
    let count = line_of(of).count(tau, MarginalTolerance::default());
    count.expect("a line that is counted")
}

fn gain(chance: &mut Chance) -> f64 {
    let sign = if chance.below(2) == 0 { 1.0 } else { -1.0 };
    sign * chance.log(1e-4, 1.0)
}

/// Nearly flat friction, 1e-30 < |b| < 1e-6, with what `beyond` asks for.
fn flat(chance: &mut Chance, beyond: u64) -> Oscillator {
    let sign = if chance.below(2) == 0 { 1.0 } else { -1.0 };
    let b = sign * chance.log(1e-30, 1e-6);
    let [a_v, a_n] = match chance.below(3) {
        0 => [gain(chance), 0.0],
        1 => [0.0, gain(chance)],
        _ => [gain(chance), gain(chance)],
    };
    let mut lags = [0.0; 3];
    if beyond & 2 != 0 {
        let all = chance.below(7) + 1;
        for (i, lag) in lags.iter_mut().enumerate() {
            if all >> i & 1 == 1 {
                *lag = chance.log(1e-4, 3.0);
            }
        }
    }
    Oscillator {
        b,
        a_v,
        a_n,
        memory: if beyond & 1 == 0 {
            0.0
        } else {
            chance.between(-0.8, 0.8)
        },
        lags,
        latency: if beyond & 4 == 0 {
            0.0
        } else {
            chance.log(0.01, 5.0)
        },
    }
}

/// Weak feedback, ε/k² of it lost in rounding: P = s² + 2ζω₀s + ω₀² and Q of the size of ζ.
fn weak(chance: &mut Chance) -> [f64; 5] {
    let k = chance.log(1e-9, 1e-2);
    let of = |chance: &mut Chance| chance.between(-1.0, 1.0) * chance.log(0.01, 1.0);
    let velocity = if chance.below(2) == 0 {
        0.0
    } else {
        k * of(chance)
    };
    [
        k * of(chance),
        chance.log(0.2, 5.0),
        k * of(chance),
        velocity,
        0.0,
    ]
}

const WEAK: &str = r#"
title = "weak feedback on an oscillator"
P = "s^2 + 2*damping*s + stiffness"
Q = "load + velocity*s"

[parameters]
damping = 1e-7
stiffness = 1
load = 1e-6
velocity = 0
"#;

#[test]
fn weak_feedback() {
    let model: SystemModel = WEAK.parse().unwrap();
    let mut at = model.defaults();
    let mut chance = Chance(asked("SLIPMAP_SEED", 32));
    let (total, mut counted, mut open) = (cases(2000), 0, 0);
    for _ in 0..total {
        let [damping, stiffness, load, velocity, _] = weak(&mut chance);
        let of = Weak {
            p: [stiffness, 2.0 * damping],
            q: [load, velocity],
        };
        let Some(known) = of.line() else {
            open += 1;
            continue;
        };
        let tau = delay(&mut chance, &known).abs();
        at.own = vec![damping, stiffness, load, velocity];
        let system = model.at(&mut at).unwrap().system().unwrap();
        let found = DelayLine::of(&system).count(tau, MarginalTolerance::default());
        counted += u64::from(check(&known, found, tau, &of));
        let same = System::of_coefficients(&[of.p[0], of.p[1], 1.0], &of.q).unwrap();
        let again = DelayLine::of(&same).count(tau, MarginalTolerance::default());
        assert_eq!(again, found, "{of:?}");
    }
    println!("{total} cells: {counted} counted, {open} left out");
    assert!(
        counted > total * 97 / 100 && open <= total / 100,
        "{counted} {open}"
    );
}

/// Weak control by the letter's own closed form, or by the general way with a memory of next to
/// nothing.
fn weak_control(chance: &mut Chance, number: u64) -> Oscillator {
    let k = chance.log(1e-9, 1e-2);
    let mut of = || chance.between(-1.0, 1.0) * k;
    let [b, a_v, a_n] = [of(), of(), of()];
    Oscillator {
        b,
        a_v,
        a_n,
        memory: if number.is_multiple_of(2) { 0.0 } else { 1e-3 },
        lags: [0.0; 3],
        latency: 0.0,
    }
}

/// Counts at settings by chance. Of `total` at most `most_open` are too near a degenerate one for
/// the distance from the resonance to tell.
fn counted(
    seed: u64,
    total: u64,
    most_open: u64,
    settings: impl Fn(&mut Chance, u64) -> Oscillator,
) {
    let mut chance = Chance(asked("SLIPMAP_SEED", seed));
    let (mut counted, mut open) = (0, 0);
    for number in 0..total {
        let of = settings(&mut chance, number);
        let Some(known) = of.line() else {
            open += 1;
            continue;
        };
        let tau = delay(&mut chance, &known).abs();
        counted += u64::from(check(&known, count(&of, tau), tau, &of));
    }
    println!("{total} cells: {counted} counted, {open} left out");
    assert!(
        counted > total * 97 / 100 && open <= most_open,
        "{counted} {open}"
    );
}

/// Nearly flat friction under the letter's control, with memory, lags and latency, and with all.
#[test]
fn nearly_flat_friction() {
    let total = cases(1000);
    counted(31, total, total / 200, |chance, number| {
        flat(chance, number % 8)
    });
}

#[test]
fn weak_control_of_the_letter() {
    let total = cases(400);
    counted(33, total, total / 100, weak_control);
}

fn of_row(row: &Row) -> Oscillator {
    let number = |name: &str| row.or_zero(name);
    Oscillator {
        b: number("mu_prime"),
        a_v: number("alpha_v"),
        a_n: number("alpha_n"),
        memory: number("memory"),
        lags: ["load_lag", "velocity_lag", "sensor_lag"].map(number),
        latency: number("latency"),
    }
}

/// Everything that a point says of its line, against numbers of 90 digits.
#[test]
fn points_of_the_table() {
    let table = include_str!("../reference/nearly_flat.csv");
    let mut certified = 0;
    for row in rows("nearly_flat", table) {
        let place = &row.place;
        let mut setting = setting(&of_row(&row));
        setting.set(Parameter::Tau, row.or_zero("tau"));
        let wanted = Wanted {
            roots: 1,
            line: None,
        };
        let point = Point::at(&setting, wanted, &Stop::default()).unwrap();
        let found = point.stability();
        let n = row.number("n_unstable").map(|n| n as u64);
        assert_eq!((found.n_unstable, found.marginal), (n, false), "{place}");
        assert_eq!(
            found.n_at_zero_delay.map(|n| n as f64),
            row.number("n_at_zero_delay"),
            "{place}"
        );
        let expected = row.intervals("stable_delays");
        let delays = found.stable_delays.as_ref().expect("they are known");
        for (ends, (from, to)) in delays.iter().zip(&expected) {
            for (end, known) in [(ends[0], *from), (ends[1], *to)] {
                let apart = (end - known).abs();
                assert!(
                    end == known || apart <= 1e-9 * known.max(1.0),
                    "{place}: {end} {known}"
                );
            }
        }
        assert!(delays.len() >= expected.len(), "{place}");
        if found.spectrum.certified {
            certified += 1;
            let unstable = found.spectrum.abscissa > 0.0;
            assert_eq!(unstable, found.n_unstable > Some(0), "{place}");
        }
    }
    println!("{certified} certified");
    assert!(certified > 150, "{certified}");
}

/// Weak feedback at given points; computed with mpmath.
#[test]
fn weak_feedback_at_given_points() {
    let model: SystemModel = WEAK.parse().unwrap();
    let line = |damping: f64, load: f64| {
        let mut at = model.defaults();
        at.own = vec![damping, 1.0, load, 0.0];
        DelayLine::of(&model.at(&mut at).unwrap().system().unwrap())
    };
    let near = |found: f64, known: f64| assert!((found - known).abs() < 1e-8, "{found} {known}");
    let first = line(1e-7, 1e-6).stable_intervals().next().unwrap();
    assert_eq!(first.from, 0.0);
    near(first.to, 0.201_357_922);
    let other = line(3e-8, 3e-7);
    let count = other.count(1.1, MarginalTolerance::default());
    assert_eq!((count.n_unstable, count.marginal), (2, false));
    let mut stable = other.stable_intervals();
    let [first, second] = [(); 2].map(|()| stable.next().unwrap());
    near(first.to, 0.201_357_92);
    near(second.from, 2.940_235_20);
}

/// Four modes of a machine tool with a few per cent of damping are nowhere near a resonance that
/// rounding blurs: no crossing takes many digits.
#[test]
fn ordinary_systems_take_few_digits() {
    let modes = [(1.0, 0.05), (1.7, 0.03), (2.6, 0.02), (4.1, 0.04)]
        .map(|(w, zeta)| Polynomial::new(&[w * w, 2.0 * zeta * w, 1.0]).unwrap());
    let product = |but: Option<usize>| {
        let factors = (0..4).filter(|i| Some(*i) != but).map(|i| modes[i]);
        let all = factors.reduce(|p, q| p.times(&q).unwrap());
        all.unwrap()
    };
    for width in [0.2, 0.3, 0.5] {
        let gain = (0..4).fold(Polynomial::ZERO, |sum, i| {
            sum.plus(&product(Some(i)), -width)
        });
        let system = System::feedback(product(None), gain, Channel::default());
        let line = DelayLine::of(&system);
        assert!(line.crossings.len() >= 2, "{width}");
        assert_eq!(line.resolved, 0, "{width}");
    }
}

/// Without damping, b = 0, load control has closed forms. The crossing frequencies are 1, with
/// e^(−iωτ) = 1, and that of 1 − ω² = 2a_n cos(ωδ)/(1 + R): without latency e^(−iωτ) is −1 there,
/// and without memory −e^(2iωδ). Pairs go to the right at the larger one.
#[test]
fn undamped_oscillators_under_weak_load_control() {
    let mut chance = Chance(20);
    for _ in 0..cases(300) {
        let a_n = chance.log(1e-15, 1e-3) * if chance.below(2) == 0 { 1.0 } else { -1.0 };
        let [mut memory, mut latency] = [0.0; 2];
        match chance.below(3) {
            0 => memory = chance.between(-0.8, 0.8),
            1 => latency = chance.log(1e-3, 1.5),
            _ => {}
        }
        let of = Oscillator {
            b: 0.0,
            a_v: 0.0,
            a_n,
            memory,
            lags: [0.0; 3],
            latency,
        };
        let mut omega = 1.0_f64;
        for _ in 0..50 {
            omega = (1.0 - 2.0 * a_n * (omega * latency).cos() / (1.0 + memory)).sqrt();
        }
        let leaves = PI - 2.0 * omega * latency;
        let expected = [0.0, 1.0, 2.0, 3.0].map(|turn| {
            let [one, other] = [TAU * turn, (leaves + TAU * turn) / omega];
            if a_n > 0.0 {
                [other, one + TAU]
            } else {
                [one, other]
            }
        });
        for pair in expected.windows(2) {
            let ([from, to], [next, _]) = (pair[0], pair[1]);
            for (tau, n) in [(0.5 * (from + to), 0), (0.5 * (to + next), 2)] {
                let found = count(&of, tau);
                assert_eq!(
                    (found.n_unstable, found.marginal),
                    (n, false),
                    "{of:?} {tau}"
                );
            }
        }
        let found = stable_delays(&of);
        assert_eq!(found.len(), 3, "{of:?}");
        for (ends, [from, to]) in found.iter().zip(expected) {
            for (end, known) in [(ends[0], from), (ends[1], to)] {
                assert!((end - known).abs() <= 1e-8, "{of:?}: {end} {known}");
            }
        }
    }
}
