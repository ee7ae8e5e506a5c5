//! The crate differential-equations on the problems of slipmap's `benches/motion.rs`.
//!
//! `slipmap-peers FOLDER` prints one line for every problem, method and tolerance, `program problem
//! setting µs-per-unit error-of-a`; `FOLDER` holds the reference that `cargo bench --bench motion
//! -- --write-reference FOLDER` writes. The smooth problem is one call of the crate's solver; the
//! hybrid ones use a driver around it, since the crate knows neither kinks nor what comes after an
//! event.

mod history;
mod hybrid;
mod problem;
mod segment;

use std::hint::black_box;
use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use differential_equations::prelude::{ExplicitRungeKutta, IVP};

use problem::{END, HYBRID, Parameters, Regime, SMOOTH};
use segment::Method;

const EVERY: f64 = 0.1;

/// A measurement lasts at least as long.
const LONG_ENOUGH: Duration = Duration::from_millis(5);

fn main() {
    let Some(folder) = std::env::args().nth(1) else {
        eprintln!("usage: slipmap-peers FOLDER (of the reference)");
        std::process::exit(2);
    };
    for (name, method) in Method::ALL {
        for exponent in 6..=12 {
            let setting = (method, 10.0_f64.powi(-exponent));
            let tell = |problem: &str, values: Vec<f64>, run: &dyn Fn()| {
                let error = largest_difference(&values, &reference(&folder, problem));
                let time = time(run);
                println!("crate {problem} {name}/1e-{exponent} {time:.5} {error:.3e}");
            };
            tell("smooth", smooth(setting, true), &|| {
                black_box(smooth(black_box(setting), false));
            });
            for (problem, p) in HYBRID {
                tell(problem, hybrid(p, setting), &|| {
                    black_box(hybrid::run(p, black_box(setting)));
                });
            }
        }
    }
}

/// a at multiples of [`EVERY`], or where `sampled` is false at the steps.
fn smooth((method, tolerance): (Method, f64), sampled: bool) -> Vec<f64> {
    let regime = Regime {
        parameters: SMOOTH,
        controlled: true,
        direction: 1.0,
    };
    let start = SMOOTH.sliding();
    let problem = IVP::dde(&regime, 0.0, END, start, move |_| start);
    macro_rules! solve {
        ($method:ident) => {{
            let method = ExplicitRungeKutta::$method().max_delay(SMOOTH.tau);
            let method = method.rtol(tolerance).atol(tolerance);
            if sampled {
                problem.even(EVERY).method(method).solve()
            } else {
                problem.method(method).solve()
            }
        }};
    }
    let solved = match method {
        Method::Dopri5 => solve!(dopri5),
        Method::Dop853 => solve!(dop853),
        Method::Rkv878e => solve!(rkv878e),
    };
    let solution = solved.unwrap_or_else(|e| panic!("{method:?} at {tolerance:e}: {e:?}"));
    let mut values = Vec::new();
    for (t, state) in solution.iter() {
        // The crate repeats the last sample.
        if !sampled || (t - EVERY * values.len() as f64).abs() < 1e-9 {
            values.push(state[0]);
        }
    }
    values
}

fn hybrid(p: Parameters, setting: (Method, f64)) -> Vec<f64> {
    let history = hybrid::run(p, setting);
    let samples = (END / EVERY).round() as usize;
    (0..samples)
        .map(|k| history.at(EVERY * k as f64)[0])
        .collect()
}

fn reference(folder: &str, problem: &str) -> Vec<f64> {
    let path = format!("{folder}/{problem}.csv");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let first = |line: &str| line.split(',').next().and_then(|a| a.parse().ok());
    let values: Option<Vec<f64>> = text.lines().map(first).collect();
    values.unwrap_or_else(|| panic!("{path}: numbers only"))
}

/// Infinite where one of them ends early.
fn largest_difference(values: &[f64], reference: &[f64]) -> f64 {
    if values.len() < reference.len() {
        return f64::INFINITY;
    }
    let pairs = values.iter().zip(reference);
    pairs.map(|(v, r)| (v - r).abs()).fold(0.0, f64::max)
}

/// Microseconds of the processor per unit of simulated time, the median of runs: on a busy machine
/// a long run is set aside more often than a short one.
fn time(run: &dyn Fn()) -> f64 {
    let begin = Instant::now();
    let mut times = Vec::new();
    while times.len() < 3 || begin.elapsed() < LONG_ENOUGH {
        let start = ThreadTime::now();
        run();
        times.push(start.elapsed().as_secs_f64() * 1e6 / END);
    }
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
