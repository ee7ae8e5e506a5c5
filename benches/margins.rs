//! Margins of random stable settings, one thread, against finding the same limits by bisection on
//! the exact count.
//!
//! `cargo bench --bench margins`. Both ways take turns, five rounds; medians and the slowest
//! setting are shown. Bisection is given the direction and looks for the first change in 64 steps
//! up to twice the limit: it may miss what lies between two of them.
//!
//! Then the same at settings with nothing, memory, latency or lags beyond the letter's feedback, by
//! the way that knows of them.
//!
//! Before all that, margins of loops of degree 4 that are given by P and Q.
//!
//! Then the stability radius over a spread of laws, gains and delays, of which some are hard: the
//! time of each once.

use std::hint::black_box;
use std::time::{Duration, Instant};

use slipmap::linear::general::System;
use slipmap::linear::margins::{
    self, Beyond, Case, Limits, MarginSearch, Setting, SlidingLaw, SystemLoop,
};
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::{Channel, Control, FrictionLaw, Groups, Lags, Oscillator, Table};

const SETTINGS: usize = 2000;
const ROUNDS: usize = 5;
const STEPS: u32 = 64;
const LAW_SETTINGS: usize = 500;
/// Stable settings of each kind beyond the letter.
const BEYOND_SETTINGS: usize = 300;
const LOOPS: usize = 2000;

fn settings() -> Vec<Setting> {
    let mut state = 5_u64;
    let mut between = |from: f64, to: f64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        from + (to - from) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut settings = Vec::new();
    while settings.len() < SETTINGS {
        let load = settings.len() % 2 == 0;
        let (a_v, a_n) = match load {
            true => (0.0, between(-8.0, 1.0)),
            false => (between(-1.0, 0.7), 0.0),
        };
        let setting = Setting {
            groups: Groups::new(-between(0.02, 0.7), a_v, a_n),
            tau: between(0.01, 10.0),
            decay: 0.0,
        };
        if setting.stable() {
            settings.push(setting);
        }
    }
    settings
}

/// The factor of the gains between `stable` and `far` at which the count changes first.
fn bisected(setting: &Setting, far: f64) -> f64 {
    let Groups { b, a_v, a_n } = setting.groups;
    let stable = |k: f64| {
        let crossings = Crossings::of(Groups::new(b, k * a_v, k * a_n));
        crossings
            .count(setting.tau, MarginalTolerance::default())
            .stable()
    };
    let at = |i: u32| 1.0 + (far - 1.0) * f64::from(i) / f64::from(STEPS);
    let Some(first) = (1..=STEPS).find(|i| !stable(at(*i))) else {
        return far;
    };
    let (mut good, mut bad) = (at(first - 1), at(first));
    for _ in 0..50 {
        let middle = 0.5 * (good + bad);
        if stable(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    bad
}

/// The mean time of a setting, and the longest.
fn timed(settings: &[Setting], mut of: impl FnMut(&Setting)) -> (Duration, Duration) {
    let (mut longest, start) = (Duration::ZERO, Instant::now());
    for setting in settings {
        let one = Instant::now();
        of(setting);
        longest = longest.max(one.elapsed());
    }
    (start.elapsed() / settings.len() as u32, longest)
}

/// What is timed, by name.
type Way<'a> = (&'a str, Box<dyn FnMut(&Setting) + 'a>);

fn ways(limits: &[Limits]) -> Vec<Way<'_>> {
    let mut numbered = limits.iter().cycle();
    let bisection = move |s: &Setting| {
        let limits = numbered.next().expect("endless");
        black_box(bisected(s, 0.5 * limits.lower));
        black_box(bisected(s, (2.0 * limits.upper).min(100.0)));
    };
    vec![
        ("gain, by bisection", Box::new(bisection)),
        (
            "gain",
            Box::new(|s| {
                black_box(MarginSearch::default().gain(s));
            }),
        ),
        (
            "slope",
            Box::new(|s| {
                black_box(MarginSearch::default().slope(s));
            }),
        ),
        (
            "delay",
            Box::new(|s| {
                black_box(margins::delay(s));
            }),
        ),
        (
            "phase and latency",
            Box::new(|s| {
                black_box(MarginSearch::default().of_loop(s));
            }),
        ),
        ("all of these at a decay rate of 0.02", Box::new(with_decay)),
        (
            "stability radius",
            Box::new(|s| {
                black_box(margins::radius(s));
            }),
        ),
    ]
}

fn with_decay(setting: &Setting) {
    let with = Setting {
        decay: 0.02,
        ..*setting
    };
    if with.stable() {
        let mut search = MarginSearch::default();
        black_box((
            search.gain(&with),
            search.slope(&with),
            search.of_loop(&with),
        ));
        black_box(margins::delay(&with));
    }
}

/// Mean times of margins beyond the letter.
fn beyond(settings: &[Setting]) {
    let nothing = Beyond::default();
    let through = |memory, latency| Beyond {
        channel: Channel { memory, latency },
        ..nothing
    };
    let (memory, latency) = (through(0.3, 0.0), through(0.0, 0.2));
    let lags = Beyond {
        lags: Lags {
            load: 0.1,
            velocity: 0.2,
            sensor: 0.05,
        },
        ..nothing
    };
    let all = Beyond {
        lags: lags.lags,
        ..through(0.3, 0.2)
    };
    println!("{BEYOND_SETTINGS} stable settings of each kind, mean times");
    for (name, beyond) in [
        ("nothing", nothing),
        ("memory", memory),
        ("latency", latency),
        ("lags", lags),
        ("all of it", all),
    ] {
        let with = |setting: &Setting| Case::beyond(*setting, beyond);
        let stable = settings.iter().filter(|s| with(s).stable());
        let stable: Vec<Setting> = stable.take(BEYOND_SETTINGS).copied().collect();
        let mut search = MarginSearch::default();
        let of = |of: &mut dyn FnMut(Case)| timed(&stable, |s| of(with(s))).0;
        let gain = of(&mut |case| {
            black_box(search.gain(&case));
        });
        let slope = of(&mut |case| {
            black_box(search.slope(&case));
        });
        let delay = of(&mut |case| {
            black_box(margins::delay(&case));
        });
        let phase = of(&mut |case| {
            black_box(search.phase(&case));
        });
        let latency = of(&mut |case| {
            black_box(search.latency(&case));
        });
        let radius = of(&mut |case| {
            black_box(margins::radius(&case));
        });
        println!(
            "{name:>10}: gain {gain:.2?}, slope {slope:.2?}, delay {delay:.2?}, phase {phase:.2?}, \
             latency {latency:.2?}, radius {radius:.2?}"
        );
    }
}

/// The stability radius at stable settings of velocity control, load control and both, for four
/// laws and for none, delays of 0.001 to 1000 and velocities of 0.02 to 10.
fn radii_of_laws() {
    let mut state = 11_u64;
    let mut chance = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let table = Table::new(
        vec![0.05, 0.2, 0.6, 1.0, 4.0],
        vec![0.9, 0.6, 0.45, 0.5, 0.7],
    );
    let laws = [
        FrictionLaw::weakening(0.5, 0.5, 1.0).expect("a law"),
        FrictionLaw::stribeck(0.4, 0.5, 1.0).expect("a law"),
        FrictionLaw::table(table.expect("a table"), 1.0).expect("a law"),
        FrictionLaw::coulomb(0.5, 1.0).expect("a law"),
    ];
    let oscillator = Oscillator::new(1.0, 1.0, 1.0).expect("a block");
    let (mut times, mut loose) = (Vec::new(), 0);
    while times.len() < LAW_SETTINGS {
        let i = times.len();
        let mut between = |from: f64, to: f64| from + (to - from) * chance();
        let (alpha_v, alpha_n) = match i % 3 {
            0 => (between(-1.5, 0.7), 0.0),
            1 => (0.0, between(-20.0, 2.0)),
            _ => (between(-1.0, 0.5), between(-10.0, 2.0)),
        };
        let tau = between(1e-3_f64.ln(), 1e3_f64.ln()).exp();
        let v0 = between(0.02_f64.ln(), 10_f64.ln()).exp();
        let b = between(-0.9, 0.9);
        let law = laws.get(i % 5).map(|law| SlidingLaw {
            law,
            oscillator: &oscillator,
            control: Control { alpha_v, alpha_n },
        });
        let groups = law.map_or(Groups::new(b, alpha_v, alpha_n), |law| law.groups(v0));
        let decay = 0.0;
        let setting = Setting { groups, tau, decay };
        if !setting.stable() {
            continue;
        }
        let start = Instant::now();
        let found = match law {
            Some(law) => margins::radius_with_law(&setting, &law, v0),
            None => margins::radius(&setting),
        };
        times.push(start.elapsed());
        loose += usize::from(!found.tight);
    }
    times.sort();
    let mean = times.iter().sum::<Duration>() / times.len() as u32;
    println!(
        "stability radius of {LAW_SETTINGS} settings with laws: mean {mean:.2?}, median {:.2?}, \
         longest {:.2?}; {loose} given up",
        times[times.len() / 2],
        times[times.len() - 1],
    );
}

/// Stable loops of degree 4, with their delays: two oscillators under a controller of first order.
fn stable_loops() -> Vec<(System, f64)> {
    let mut state = 23_u64;
    let mut between = |from: f64, to: f64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        from + (to - from) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut loops = Vec::new();
    while loops.len() < LOOPS {
        let [a, b] = [0; 2].map(|_| (between(0.2, 5.0), between(0.02, 0.8)));
        let [c, e] = [a, b].map(|(size, damping)| [size * size, 2.0 * damping * size]);
        let p = [
            c[0] * e[0],
            c[0] * e[1] + c[1] * e[0],
            c[0] + e[0] + c[1] * e[1],
            c[1] + e[1],
            1.0,
        ];
        let size = between(-1.0, 1.0) * p[0];
        let system = System::of_coefficients(&p, &[size, between(-1.0, 1.0) * size]);
        let (system, tau) = (system.expect("a small degree"), between(0.05, 3.0));
        let of = SystemLoop::new(&system, tau).expect("a loop");
        if of.stable() {
            loops.push((system, tau));
        }
    }
    loops
}

/// Mean times of their margins.
fn loops() {
    type Way<'w> = (&'w str, &'w dyn Fn(&SystemLoop));
    let loops = stable_loops();
    let made = |(system, tau): &(System, f64)| SystemLoop::new(system, *tau).expect("a loop");
    let gain = |of: &SystemLoop| {
        black_box(MarginSearch::default().gain_margin(of));
    };
    let phase = |of: &SystemLoop| {
        black_box(of.phase());
    };
    let latency = |of: &SystemLoop| {
        black_box(of.latency());
    };
    let modulus = |of: &SystemLoop| {
        black_box(of.modulus());
    };
    let all = |of: &SystemLoop| {
        gain(of);
        phase(of);
        latency(of);
        modulus(of);
    };
    let ways: [Way; 5] = [
        ("gain", &gain),
        ("phase", &phase),
        ("latency", &latency),
        ("modulus", &modulus),
        ("all of it", &all),
    ];
    println!("{LOOPS} stable loops of degree 4");
    for (name, way) in ways {
        let mut times: Vec<Duration> = loops
            .iter()
            .map(|of| {
                let start = Instant::now();
                way(&made(of));
                start.elapsed()
            })
            .collect();
        times.sort();
        let mean = times.iter().sum::<Duration>() / times.len() as u32;
        let [median, longest] = [times.len() / 2, times.len() - 1].map(|i| times[i]);
        println!("{name:>10}: mean {mean:.2?}, median {median:.2?}, longest {longest:.2?}");
    }
}

fn main() {
    loops();
    let settings = settings();
    let mut search = MarginSearch::default();
    let limits: Vec<Limits> = settings.iter().map(|s| search.gain(s)).collect();
    let mut ways = ways(&limits);
    let mut times = vec![Vec::new(); ways.len()];
    for _ in 0..ROUNDS {
        for ((_, way), times) in ways.iter_mut().zip(&mut times) {
            times.push(timed(&settings, way));
        }
    }
    println!("{SETTINGS} random stable settings, median of {ROUNDS} rounds");
    for ((name, _), times) in ways.iter().zip(&mut times) {
        times.sort();
        let (mean, longest) = times[ROUNDS / 2];
        println!("{name:>38}: mean {mean:>10.2?}, longest {longest:>10.2?}");
    }
    beyond(&settings);
    radii_of_laws();
}
