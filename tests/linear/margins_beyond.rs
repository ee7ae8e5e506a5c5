//! Margins with memory, latency and lags: against the letter's own where there is none of them,
//! against exact counts along every direction and in whole boxes, and against scans of the loop.

use std::f64::consts::PI;
use std::time::{Duration, Instant};

use crate::congruence::Chance;
use num_complex::Complex64;
use slipmap::linear::MarginalTolerance;
use slipmap::linear::general::{DelayLine, Polynomial, RightOf, RootCounter, System};
use slipmap::linear::margins::{self, Beyond, Case, MarginSearch, Radius, Setting, SlidingLaw};
use slipmap::model::{Channel, Control, Dashpots, FrictionLaw, Groups, Lags, Oscillator};

const NOTHING: Beyond = Beyond {
    damping: 0.0,
    channel: Channel {
        memory: 0.0,
        latency: 0.0,
    },
    lags: Lags {
        load: 0.0,
        velocity: 0.0,
        sensor: 0.0,
    },
};

/// The number of roots right of Re λ = −σ, of a system written down here; none where one is on that
/// line within rounding, and a large number where there are infinitely many.
fn roots(Setting { groups, tau, decay }: Setting, beyond: &Beyond) -> Option<u64> {
    let Groups { b, a_v, a_n } = groups;
    let of = |c: &[f64]| Polynomial::new(c).unwrap();
    let times = |p: &Polynomial, q: &Polynomial| p.times(q).unwrap();
    let [load, velocity, sensor] = beyond.lags.times().map(|time| of(&[1.0, time]));
    let open = times(
        &of(&[1.0, b, 1.0]),
        &times(&load, &times(&velocity, &sensor)),
    );
    // With a dashpot a_n has lost d a_v, which passes with the velocity.
    let d = beyond.damping;
    let moving = of(&[a_v * (b - d), a_v]);
    let gain = times(&of(&[a_n + d * a_v]), &velocity).plus(&times(&moving, &load), 1.0);
    let system = System::feedback(open, gain, beyond.channel);
    if b == 0.0 && decay == 0.0 {
        // Without damping P has zeros on the axis, which the count along it does not like.
        let line = DelayLine::of(&system);
        let count = line.count(tau, MarginalTolerance::default());
        return (!line.uncounted && !count.marginal).then_some(count.n_unstable);
    }
    match RootCounter::new(&system).right_of(tau, -decay) {
        RightOf::Roots(n) => Some(n),
        RightOf::Infinite => Some(u64::MAX),
        RightOf::Undecided => None,
    }
}

fn stable(setting: Setting, beyond: &Beyond) -> bool {
    roots(setting, beyond) == Some(0)
}

/// What feedback has, by number: memory, latency, lags and a damped spring, or all of them.
fn beyond(chance: &mut Chance, kind: usize) -> Beyond {
    let memory = chance.between(-0.9, 0.9);
    let latency = chance.between(0.0, 1.0);
    let [load, velocity, sensor] = [(); 3].map(|()| chance.between(0.0, 0.4));
    let lags = Lags {
        load,
        velocity,
        sensor,
    };
    let through = |memory, latency| Beyond {
        channel: Channel { memory, latency },
        ..NOTHING
    };
    match kind % 5 {
        0 => through(memory, 0.0),
        1 => through(0.0, latency),
        2 => Beyond {
            lags,
            damping: 0.3 * memory.abs(),
            ..NOTHING
        },
        3 => through(memory, 0.3 * latency),
        _ => Beyond {
            lags: Lags {
                sensor: 0.0,
                ..lags
            },
            damping: 0.2 * latency,
            ..through(0.5 * memory, 0.3 * latency)
        },
    }
}

/// Stable settings of velocity control, load control and both, every fifth with friction that grows
/// with velocity.
fn settings(seed: u64, number: usize, decay: f64) -> Vec<(Setting, Beyond)> {
    let mut chance = Chance(seed);
    let mut settings = Vec::new();
    while settings.len() < number {
        let (kind, sign) = (settings.len() % 3, settings.len() % 5);
        let b = match sign {
            0 => chance.between(0.0, 1.0),
            _ => -chance.between(0.01, 0.7),
        };
        let a_v = match kind {
            1 => 0.0,
            _ => chance.between(-1.0, 0.7),
        };
        let a_n = match kind {
            0 => 0.0,
            _ => chance.between(-6.0, 1.5),
        };
        let setting = Setting {
            groups: Groups::new(b, a_v, a_n),
            tau: chance.between(0.05, 10.0),
            decay,
        };
        let kind = (chance.next() * 5.0) as usize;
        let beyond = beyond(&mut chance, kind);
        if stable(setting, &beyond) {
            settings.push((setting, beyond));
        }
    }
    settings
}

fn same(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-9 * b.abs().max(1e-3)
}

/// With nothing beyond the letter both ways to the margins come to the same.
#[test]
fn nothing_beyond_the_letter_is_the_letters_own() {
    let mut chance = Chance(41);
    let mut search = MarginSearch::default();
    let (mut tried, mut with_decay, mut open) = (0, 0, 0);
    while tried < 3000 {
        let (velocity, load) = (tried % 3 != 1, tried % 3 != 0);
        let a_v = f64::from(u8::from(velocity)) * chance.between(-1.0, 0.7);
        let a_n = f64::from(u8::from(load)) * chance.between(-8.0, 1.5);
        let setting = Setting {
            groups: Groups::new(chance.between(-0.8, 0.4), a_v, a_n),
            tau: chance.between(0.01, 8.0),
            decay: if tried % 10 == 9 { 0.03 } else { 0.0 },
        };
        let case = Case::beyond(setting, NOTHING);
        if !setting.stable() {
            assert!(!case.stable(), "{setting:?}");
            continue;
        }
        assert!(case.stable(), "{setting:?}");
        tried += 1;
        with_decay += usize::from(setting.decay > 0.0);
        let (gain, gains) = (search.gain(&setting), search.gain(&case));
        let (slope, slopes) = (search.slope(&setting), search.slope(&case));
        let (delay, delays) = (margins::delay(&setting), margins::delay(&case));
        let (of_loop, of_loops) = (search.of_loop(&setting), search.of_loop(&case));
        for (name, own, other) in [
            ("lower gain", gain.lower, gains.lower),
            ("upper gain", gain.upper, gains.upper),
            ("lower slope", slope.lower, slopes.lower),
            ("upper slope", slope.upper, slopes.upper),
            ("lower delay", delay.lower, delays.lower),
            ("upper delay", delay.upper, delays.upper),
            ("phase", of_loop.phase, of_loops.phase),
            ("latency", of_loop.latency, of_loops.latency),
        ] {
            if own.is_nan() || other.is_nan() {
                println!("{name}: {own} {other} of {setting:?}");
                open += u32::from(other.is_nan());
                continue;
            }
            assert!(same(own, other), "{name}: {own} {other} of {setting:?}");
        }
    }
    assert!(open <= 10, "{open}");
    assert!(with_decay > 100, "{with_decay}");
}

/// Checks a limit of one parameter against exact counts on the way there and on both sides of it.
/// False where the limit is not told.
fn check(
    what: &str,
    from: f64,
    limit: f64,
    far: f64,
    at: &dyn Fn(f64) -> (Setting, Beyond),
) -> bool {
    if limit.is_nan() {
        println!("{what} of {:?} is not told", at(from));
        return false;
    }
    let count = |value: f64| {
        let (setting, beyond) = at(value);
        roots(setting, &beyond)
    };
    let reached = if limit.is_finite() { limit } else { far };
    let base = at(from);
    for i in 0..300 {
        // Closer together towards both ends.
        let part = 0.5 - 0.5 * (PI * (f64::from(i) + 0.5) / 300.0).cos();
        let value = from + part * (reached - from);
        let near = (value - reached).abs() <= 1e-7 * reached.abs();
        // Without gain or delay nothing may damp: next to that no count tells.
        let open = |found: Option<u64>| found.is_none() && value.abs() < 1e-3;
        let found = count(value);
        assert!(
            near || found == Some(0) || open(found),
            "{what} of {base:?}: {found:?} unstable at {value} before {limit}"
        );
    }
    // A gain of 1e-15 is none.
    if limit.is_finite() && (limit - far).abs() > 1e-12 {
        let scale = limit.abs().max((limit - from).abs());
        let step = 1e-7 * scale.copysign(limit - from);
        let inside = (limit - from).abs() < 2.0 * step.abs();
        assert!(
            inside || count(limit - step) == Some(0),
            "{what} of {base:?}: {limit} is too far"
        );
        assert!(
            count(limit + step).is_some_and(|n| n > 0),
            "{what} of {base:?}: {limit} is too near"
        );
    }
    true
}

/// How many of the limits of a setting are told, of six.
fn check_setting(search: &mut MarginSearch, setting: Setting, beyond: Beyond) -> u32 {
    let Setting { groups, tau, .. } = setting;
    let Groups { b, a_v, a_n } = groups;
    let case = Case::beyond(setting, beyond);
    let with = |groups, tau| {
        let changed = Setting {
            groups,
            tau,
            ..setting
        };
        (changed, beyond)
    };
    let gain = |k: f64| with(Groups::new(b, k * a_v, k * a_n), tau);
    let limits = search.gain(&case);
    let mut told = u32::from(check("lower gain", 1.0, limits.lower, 0.0, &gain));
    told += u32::from(check("upper gain", 1.0, limits.upper, 50.0, &gain));
    let slope = |b: f64| with(Groups::new(b, a_v, a_n), tau);
    let limits = search.slope(&case);
    told += u32::from(check("lower slope", b, limits.lower, -50.0, &slope));
    told += u32::from(check("upper slope", b, limits.upper, 50.0, &slope));
    let delay = |tau: f64| with(groups, tau);
    let limits = margins::delay(&case);
    told += u32::from(check("lower delay", tau, limits.lower, 0.0, &delay));
    told + u32::from(check("upper delay", tau, limits.upper, tau + 30.0, &delay))
}

#[test]
fn limits_are_those_of_exact_counts() {
    let mut search = MarginSearch::default();
    let mut told = 0;
    for (setting, beyond) in settings(19, 400, 0.0) {
        told += check_setting(&mut search, setting, beyond);
    }
    assert!(told >= 6 * 400 - 24, "{told}");
    let mut told = 0;
    for (setting, beyond) in settings(23, 60, 0.05) {
        told += check_setting(&mut search, setting, beyond);
    }
    assert!(told >= 6 * 60 - 18, "{told}");
}

/// Coulomb's friction: nothing damps but the control, and b = 0 cancels terms of the equations.
#[test]
fn limits_without_damping_are_those_of_exact_counts() {
    let mut chance = Chance(53);
    let mut search = MarginSearch::default();
    let (mut tried, mut told) = (0, 0);
    while tried < 60 {
        let (a_v, a_n) = match tried % 3 {
            0 => (chance.between(-1.0, 0.5), 0.0),
            1 => (0.0, chance.between(-6.0, 1.0)),
            _ => (chance.between(-1.0, 0.5), chance.between(-6.0, 1.0)),
        };
        let setting = Setting {
            groups: Groups::new(0.0, a_v, a_n),
            tau: chance.between(0.05, 8.0),
            decay: 0.0,
        };
        let beyond = beyond(&mut chance, tried);
        if stable(setting, &beyond) {
            tried += 1;
            told += check_setting(&mut search, setting, beyond);
        }
    }
    assert!(told >= 6 * 60 - 6, "{told}");
}

/// N/M of the loop L = −N/M, by its formula.
fn negative_loop(setting: Setting, beyond: &Beyond, omega: f64) -> Complex64 {
    let Setting { groups, tau, decay } = setting;
    let Groups { b, a_v, a_n } = groups;
    let lambda = Complex64::new(-decay, omega);
    let delayed = (-lambda * tau).exp();
    let late = (-lambda * beyond.channel.latency).exp();
    let lag = |time: f64| 1.0 + time * lambda;
    let d = beyond.damping;
    let load = (a_n + d * a_v) / lag(beyond.lags.load);
    let velocity = a_v * (b - d + lambda) / lag(beyond.lags.velocity);
    let acting = (load + velocity) / lag(beyond.lags.sensor) * late * (1.0 - delayed);
    acting / ((lambda * (lambda + b) + 1.0) * (1.0 - beyond.channel.memory * delayed))
}

/// Zeros of `f` on a grid that is dense at low frequencies, by halvings.
fn scanned(f: &dyn Fn(f64) -> f64) -> Vec<f64> {
    const POINTS: u32 = 40_000;
    let grid = |i: u32| 40.0 * (f64::from(i) / f64::from(POINTS)).powi(2);
    let mut zeros = Vec::new();
    for i in 1..POINTS {
        let (mut low, mut high) = (grid(i), grid(i + 1));
        let rising = f(high) > 0.0;
        if (f(low) > 0.0) == rising {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (f(middle) > 0.0) == rising {
                high = middle;
            } else {
                low = middle;
            }
        }
        zeros.push(low);
    }
    zeros
}

/// Gain limits are the least and greatest 1/(N/M) where that is real, on either side of 1; the
/// phase margin is the least angle of N/M where its size is 1.
#[test]
fn gain_and_phase_are_those_of_a_scan_of_the_loop() {
    let mut search = MarginSearch::default();
    for (setting, beyond) in settings(29, 100, 0.0)
        .into_iter()
        .chain(settings(31, 40, 0.05))
    {
        let case = Case::beyond(setting, beyond);
        let at = |omega: f64| negative_loop(setting, &beyond, omega);
        let phase = scanned(&|omega| at(omega).norm() - 1.0)
            .into_iter()
            .map(|omega| at(omega).arg().abs())
            .fold(f64::INFINITY, f64::min);
        let found = search.phase(&case);
        let near = |a: f64, b: f64| a == b || (a - b).abs() < 1e-8 * b.abs().max(1e-3);
        assert!(near(found, phase), "{case:?}: {found} {phase}");
        // Poles of 1/L change the sign as well: there it is small, not real.
        let crossings = scanned(&|omega| at(omega).im);
        let of = crossings.iter().map(|omega| at(*omega).re);
        let mut factors: Vec<f64> = of.filter(|re| *re > 0.0).map(|re| 1.0 / re).collect();
        if setting.decay > 0.0 {
            factors.push(1.0 / at(0.0).re);
        }
        let Groups { b, a_v, a_n } = setting.groups;
        let count = |k: f64| {
            let groups = Groups::new(b, k * a_v, k * a_n);
            roots(Setting { groups, ..setting }, &beyond)
        };
        let limits = search.gain(&case);
        for (limit, sign) in [(limits.lower, -1.0), (limits.upper, 1.0)] {
            if limit.is_nan() {
                continue;
            }
            // The nearest factor beyond which the count is not 0.
            let ahead = factors
                .iter()
                .copied()
                .filter(|k| sign * (k - 1.0) > 0.0 && *k > 0.0);
            let lost = ahead.filter(|k| count(k * (1.0 + sign * 1e-6)) != Some(0));
            let scanned = lost.min_by(|x, y| (sign * x).total_cmp(&(sign * y)));
            match scanned {
                Some(k) if k < 200.0 => assert!(near(limit, k), "{case:?}: {limit} {k}"),
                _ => assert!(limit == 0.0 || limit > 100.0, "{case:?}: {limit}"),
            }
        }
    }
}

/// The latency margin counts from no latency, with everything else as it is.
#[test]
fn latency_margins_with_a_required_decay_are_where_roots_come_in() {
    let mut search = MarginSearch::default();
    let (mut finite, mut none) = (0, 0);
    for (setting, beyond) in settings(37, 60, 0.05) {
        let margin = search.latency(&Case::beyond(setting, beyond));
        let late = |latency: f64| Beyond {
            channel: Channel {
                latency,
                ..beyond.channel
            },
            ..beyond
        };
        let with = |latency: f64| roots(setting, &late(latency));
        assert!(!margin.is_nan(), "{setting:?} {beyond:?}");
        if margin == 0.0 {
            none += 1;
            assert_ne!(with(0.0), Some(0), "{setting:?} {beyond:?}");
            continue;
        }
        let until = margin.min(8.0);
        for i in 0..200 {
            let latency = until * (1.0 - 1e-8) * f64::from(i) / 199.0;
            assert_eq!(
                with(latency),
                Some(0),
                "{setting:?} {beyond:?}: {latency} {margin}"
            );
        }
        if margin < 8.0 {
            finite += 1;
            let beyond_it = with(margin * (1.0 + 1e-7));
            assert!(
                beyond_it.is_some_and(|n| n > 0),
                "{setting:?} {beyond:?} {margin}"
            );
        }
    }
    assert!(finite > 30 && none < 30, "{finite} {none}");
}

fn in_box(chance: &mut Chance, radius: f64) -> [f64; 3] {
    let mut at = [0; 3].map(|_| chance.between(-radius, radius));
    // Every other one on a side of the box.
    let number = (chance.next() * 6.0) as usize;
    if number < 3 {
        at[number] = radius.copysign(at[number]);
    }
    at
}

/// D over the size of its terms.
fn relative(setting: Setting, beyond: &Beyond, omega: f64) -> f64 {
    let lambda = Complex64::new(-setting.decay, omega);
    let kept = 1.0 - beyond.channel.memory * (-lambda * setting.tau).exp();
    let own = (lambda * (lambda + setting.groups.b) + 1.0) * kept;
    let acting = negative_loop(setting, beyond, omega) * own;
    (own - acting).norm() / (1.0 + own.norm() + acting.norm())
}

/// Whether a root is on the line Re λ = −σ, within rounding, though the count does not change there.
fn touches(setting: Setting, beyond: &Beyond) -> bool {
    let size = |omega: f64| relative(setting, beyond, omega);
    let at = |i: u32| f64::from(i) / 1000.0;
    let start = (0..40_000)
        .map(at)
        .min_by(|a, b| size(*a).total_cmp(&size(*b)));
    let mut omega = start.unwrap();
    let mut step = 1e-3;
    while step > 1e-13 {
        let near = [omega - step, omega, omega + step];
        omega = near
            .into_iter()
            .min_by(|a, b| size(*a).total_cmp(&size(*b)))
            .unwrap();
        step *= 0.7;
    }
    // Where |P| and |Q| nearly touch, rounding moves roots by its square root.
    size(omega) < 2e-7
}

/// Nothing in the box is unstable, and the place beyond it is.
fn check_box(found: &Radius, changed: &dyn Fn([f64; 3]) -> (Setting, Beyond), samples: u32) {
    let mut chance = Chance(7);
    let base = changed([0.0; 3]);
    for _ in 0..samples {
        let change = in_box(&mut chance, found.proved * (1.0 - 1e-12));
        let (setting, beyond) = changed(change);
        assert!(stable(setting, &beyond), "{base:?} {found:?} {change:?}");
    }
    match found.unstable {
        Some(at) => {
            let largest = at.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
            let tight = largest <= 1.01 * found.proved;
            assert!(tight || !found.tight, "{base:?} {found:?}");
            let (setting, beyond) = changed(at);
            assert!(
                !stable(setting, &beyond) || touches(setting, &beyond),
                "{base:?} {found:?}"
            );
        }
        None => assert!(found.proved >= 0.99 || !found.tight, "{base:?} {found:?}"),
    }
}

#[test]
fn every_setting_of_a_box_is_stable_and_not_far_beyond_one_is_not() {
    let (mut loose, mut longest) = (0, Duration::ZERO);
    let on_axis = settings(43, 60, 0.0).into_iter();
    for (setting, beyond) in on_axis.chain(settings(47, 15, 0.05)) {
        let Setting { groups, tau, decay } = setting;
        let Groups { b, a_v, a_n } = groups;
        let start = Instant::now();
        let still = beyond.damping;
        let found = margins::radius_within(&Case::beyond(setting, beyond), [1.0; 3], still);
        longest = longest.max(start.elapsed());
        loose += u32::from(!found.tight);
        let changed = |[gain, delay, slope]: [f64; 3]| {
            let k = 1.0 + gain;
            let changed = Setting {
                groups: Groups::new((b - still) * (1.0 + slope) + still, k * a_v, k * a_n),
                tau: tau * (1.0 + delay),
                decay,
            };
            (changed, beyond)
        };
        check_box(&found, &changed, 1000);
    }
    println!("{loose} of 75 not tight, the longest took {longest:?}");
    assert!(loose <= 4, "{loose}");
}

/// A block without dashpots, and one with both.
fn oscillators() -> [Oscillator; 2] {
    let undamped = Oscillator::new(1.0, 1.0, 1.0).unwrap();
    let dashpots = Dashpots {
        damping: 0.1,
        viscous: 0.05,
    };
    [undamped, undamped.damped(dashpots).unwrap()]
}

#[test]
fn a_friction_law_leads_from_one_velocity_to_another() {
    let mut chance = Chance(3);
    let [undamped, damped] = oscillators();
    let laws = [
        FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap(),
        FrictionLaw::stribeck(0.4, 0.5, 1.0).unwrap(),
    ];
    let (mut tried, mut loose, mut undecided) = (0, 0, 0);
    while tried < 40 {
        let law = &laws[tried % 2];
        let (alpha_v, alpha_n) = match tried % 3 {
            0 => (chance.between(-0.5, 0.2), 0.0),
            1 => (0.0, chance.between(-12.0, 2.0)),
            _ => (chance.between(-0.5, 0.2), chance.between(-8.0, 2.0)),
        };
        let control = Control { alpha_v, alpha_n };
        let oscillator = if tried % 4 == 0 { &undamped } else { &damped };
        let sliding = SlidingLaw {
            law,
            oscillator,
            control,
        };
        let beyond = Beyond {
            damping: oscillator.dashpot_ratios().damping,
            ..beyond(&mut chance, tried)
        };
        let (v0, tau) = (chance.between(0.1, 0.9), chance.between(0.1, 6.0));
        let at = |v: f64| {
            let setting = Setting {
                groups: sliding.groups(v),
                tau,
                decay: 0.0,
            };
            (setting, beyond)
        };
        let (setting, _) = at(v0);
        if !stable(setting, &beyond) {
            continue;
        }
        tried += 1;
        let case = Case::beyond(setting, beyond);
        let limits = margins::velocity(&case, &sliding, v0);
        let told = check("lower velocity", v0, limits.lower, 0.0, &at);
        undecided += u32::from(!told);
        let told = check("upper velocity", v0, limits.upper, 64.0 * v0, &at);
        undecided += u32::from(!told);
        let found = margins::radius_with_law(&case, &sliding, v0);
        loose += u32::from(!found.tight);
        let changed = |[gain, delay, velocity]: [f64; 3]| {
            let Groups { b, a_v, a_n } = sliding.groups(v0 * (1.0 + velocity));
            let k = 1.0 + gain;
            let changed = Setting {
                groups: Groups::new(b, k * a_v, k * a_n),
                tau: tau * (1.0 + delay),
                decay: 0.0,
            };
            (changed, beyond)
        };
        check_box(&found, &changed, 500);
    }
    assert!(loose <= 3 && undecided <= 2, "{loose} {undecided}");
}

/// Memory is not stable at a decay rate beyond that at which its roots accumulate, and the delay
/// up to there is a limit of the box.
#[test]
fn roots_that_accumulate_end_everything() {
    let beyond = Beyond {
        channel: Channel {
            memory: 0.4,
            latency: 0.0,
        },
        ..NOTHING
    };
    let setting = |tau: f64, decay: f64| Setting {
        groups: Groups::new(0.8, -0.05, 0.0),
        tau,
        decay,
    };
    // ln(1/0.4)/0.3 is 3.054.
    assert!(Case::beyond(setting(2.5, 0.3), beyond).stable());
    assert!(!Case::beyond(setting(3.1, 0.3), beyond).stable());
    let found = margins::radius(&Case::beyond(setting(2.5, 0.3), beyond));
    let last = -0.4_f64.ln() / 0.3 / 2.5 - 1.0;
    assert!(
        found.proved > 0.0 && found.proved <= last,
        "{found:?} {last}"
    );
    let delays = margins::delay(&Case::beyond(setting(2.5, 0.3), beyond));
    let upper = delays.upper;
    assert!(upper.is_nan() || upper <= 3.0544, "{delays:?}");
}
