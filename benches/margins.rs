//! Margins of random stable settings, one thread, against finding the same limits by bisection on
//! the exact count.
//!
//! `cargo bench --bench margins`. Both ways take turns, five rounds; medians and the slowest
//! setting are shown. Bisection is given the direction and looks for the first change in 64 steps
//! up to twice the limit: it may miss what lies between two of them.

use std::hint::black_box;
use std::time::{Duration, Instant};

use slipmap::linear::margins::{self, Limits, Margins, Setting};
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::Groups;

const SETTINGS: usize = 2000;
const ROUNDS: usize = 5;
const STEPS: u32 = 64;

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
                black_box(Margins::default().gain(s));
            }),
        ),
        (
            "slope",
            Box::new(|s| {
                black_box(Margins::default().slope(s));
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
                black_box(Margins::default().of_loop(s));
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
        let mut search = Margins::default();
        black_box((
            search.gain(&with),
            search.slope(&with),
            search.of_loop(&with),
        ));
        black_box(margins::delay(&with));
    }
}

fn main() {
    let settings = settings();
    let mut search = Margins::default();
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
}
