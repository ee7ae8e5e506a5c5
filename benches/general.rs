//! Maps of general systems beside the letter's own, one thread: counts and certified abscissas.
//!
//! `cargo bench --bench general`. All take turns, fifteen rounds; the least times are shown, as
//! the machine may be busy, and their ratios to the letter's. The letter: b = −0.3, a_n in [−3, 1], a_v = −0.2,
//! τ in [0.01, 10]. Beside it the same with lags of the load and of the sensor, which makes degrees
//! 3 and 4, the letter itself written as a general system, four modes of a machine tool (degree 8),
//! a neutral system (memory) and the letter with latency. Counts take 1000 lines of 1000 delays,
//! and 100 lines of 10⁴; abscissas 20 lines of 1000.

use std::time::Instant;

use slipmap::linear::general::{DelayLine, Polynomial, RootCounter, System};
use slipmap::linear::row::Delays;
use slipmap::linear::status::CERTIFIED;
use slipmap::linear::track::{RootTracker, Work};
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::{Channel, Groups};

const ROUNDS: usize = 15;
const LONGEST: f64 = 10.0;

fn even(from: f64, to: f64, points: usize) -> Vec<f64> {
    let step = (to - from) / (points - 1) as f64;
    (0..points).map(|i| from + step * i as f64).collect()
}

fn polynomial(coefficients: &[f64]) -> Polynomial {
    Polynomial::new(coefficients).expect("a small degree")
}

fn product(factors: &[Polynomial]) -> Polynomial {
    factors[1..]
        .iter()
        .fold(factors[0], |p, q| p.times(q).expect("a small degree"))
}

/// B and A of a line, from which a system is made for each line anew, with memory and latency.
struct Line {
    open: Polynomial,
    gain: Polynomial,
    memory: f64,
    latency: f64,
}

impl Line {
    fn system(&self) -> System {
        System::feedback(
            self.open,
            self.gain,
            Channel {
                memory: self.memory,
                latency: self.latency,
            },
        )
    }
}

/// The letter's damping and velocity gain.
const B: f64 = -0.3;
const A_V: f64 = -0.2;

/// The letter's feedback at the load gain `a_n`, with lags of the load and of the sensor.
fn lagging(a_n: f64, load_lag: f64, sensor_lag: f64) -> Line {
    let [load, sensor] = [load_lag, sensor_lag].map(|lag| polynomial(&[1.0, lag]));
    let velocity = polynomial(&[A_V * B, A_V]);
    Line {
        open: product(&[polynomial(&[1.0, B, 1.0]), load, sensor]),
        gain: polynomial(&[a_n]).plus(&product(&[velocity, load]), 1.0),
        memory: 0.0,
        latency: 0.0,
    }
}

/// Four modes of a machine tool with chips of the given width.
fn four_modes(width: f64) -> Line {
    let modes = [(1.0, 0.05), (1.7, 0.03), (2.6, 0.02), (4.1, 0.04)]
        .map(|(w, zeta)| polynomial(&[w * w, 2.0 * zeta * w, 1.0]));
    let mut sum = Polynomial::ZERO;
    for i in 0..4 {
        let others: Vec<_> = (0..4).filter(|&j| j != i).map(|j| modes[j]).collect();
        sum = sum.plus(&product(&others), -width);
    }
    Line {
        open: product(&modes),
        gain: sum,
        memory: 0.0,
        latency: 0.0,
    }
}

/// A way to make a line of a map from where it lies, from 0 to 1.
type Make = fn(f64) -> Line;

const KINDS: [(&str, Make); 6] = [
    ("n = 2", |t| lagging(4.0 * t - 3.0, 0.0, 0.0)),
    ("n = 3", |t| lagging(4.0 * t - 3.0, 0.3, 0.0)),
    ("n = 4", |t| lagging(4.0 * t - 3.0, 0.3, 0.1)),
    ("n = 8", |t| four_modes(0.01 + 0.5 * t)),
    ("memory", |t| Line {
        memory: 0.3,
        ..lagging(4.0 * t - 3.0, 0.0, 0.0)
    }),
    ("latency", |t| Line {
        latency: 0.5,
        ..lagging(4.0 * t - 3.0, 0.0, 0.0)
    }),
];

fn of_letter(t: f64) -> Groups {
    Groups::new(B, A_V, 4.0 * t - 3.0)
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// The letter and all kinds.
fn names() -> Vec<&'static str> {
    let kinds = KINDS.iter().map(|(name, _)| *name);
    std::iter::once("letter").chain(kinds).collect()
}

/// Shows the least times of all columns and their ratios to the first.
fn show(names: &[&str], rounds: &[Vec<f64>], cells: f64, unit: (f64, &str)) {
    for (i, name) in names.iter().enumerate() {
        let least = |i: usize| rounds.iter().map(|r| r[i]).fold(f64::INFINITY, f64::min);
        let ratio = least(i) / least(0);
        println!(
            "  {name:<10} {:10.3} {}   {ratio:7.2}",
            least(i) / cells * unit.0,
            unit.1
        );
    }
}

fn counts(lines: usize, delays: usize) {
    let values = even(0.01, LONGEST, delays);
    let row = Delays::new(&values);
    let tolerance = MarginalTolerance::default();
    let (mut n, mut status) = (vec![0; delays], vec![0; delays]);
    let places = even(0.0, 1.0, lines);
    let made: Vec<Vec<Line>> = KINDS
        .iter()
        .map(|(_, make)| places.iter().map(|&t| make(t)).collect())
        .collect();
    let groups: Vec<Groups> = places.iter().map(|&t| of_letter(t)).collect();
    let mut rounds = Vec::new();
    for round in 0..=ROUNDS {
        let mut times = vec![seconds(|| {
            for &groups in &groups {
                status.fill(0);
                Crossings::of(groups).fill_counts(&row, tolerance, &mut n, &mut status);
                std::hint::black_box((&n, &status));
            }
        })];
        let mut line = DelayLine::default();
        for made in &made {
            times.push(seconds(|| {
                for of in made {
                    status.fill(0);
                    line.find(&of.system());
                    line.fill_counts(&row, tolerance, &mut n, &mut status);
                    std::hint::black_box((&n, &status));
                }
            }));
        }
        if round > 0 {
            rounds.push(times);
        }
    }
    println!(
        "counts, {lines} lines of {delays} delays, microseconds a line, ratio to the letter's"
    );
    let names = names();
    show(&names, &rounds, lines as f64, (1e6, "us"));
}

/// What a kind of map came to.
struct Certified {
    cells: usize,
    work: Work,
}

/// The cells of a line of delays, counted and with their rightmost root.
struct Cells<'a> {
    delays: &'a [f64],
    row: Delays,
    n: Vec<u16>,
    status: Vec<u8>,
    tracker: RootTracker,
    certified: usize,
}

impl<'a> Cells<'a> {
    fn new(delays: &'a [f64]) -> Self {
        Self {
            delays,
            row: Delays::new(delays),
            n: vec![0; delays.len()],
            status: vec![0; delays.len()],
            tracker: RootTracker::new(1),
            certified: 0,
        }
    }

    fn follow(
        &mut self,
        equation: impl slipmap::linear::equation::Equation,
        counts: impl FnOnce(&Delays, &mut [u16], &mut [u8]),
    ) {
        self.status.fill(0);
        counts(&self.row, &mut self.n, &mut self.status);
        let line = (self.delays, 1.0);
        self.tracker
            .follow(equation, line, 0, &self.n, &mut self.status, |_, cell| {
                std::hint::black_box(cell.roots);
            });
        let certified = |&&s: &&u8| s & CERTIFIED != 0;
        self.certified += self.status.iter().filter(certified).count();
    }

    fn done(self) -> Certified {
        Certified {
            cells: self.certified,
            work: self.tracker.work,
        }
    }
}

/// The times of the letter and of all kinds, and what they came to.
fn abscissas_of_all(places: &[f64], delays: &[f64]) -> (Vec<f64>, Vec<Certified>) {
    let tolerance = MarginalTolerance::default();
    let mut cells = Cells::new(delays);
    let mut times = vec![seconds(|| {
        for &t in places {
            let groups = of_letter(t);
            cells.follow(groups, |row, n, status| {
                Crossings::of(groups).fill_counts(row, tolerance, n, status);
            });
        }
    })];
    let mut all = vec![cells.done()];
    let mut line = DelayLine::default();
    for (_, make) in KINDS {
        let mut cells = Cells::new(delays);
        times.push(seconds(|| {
            for &t in places {
                let system = make(t).system();
                cells.follow(&RootCounter::new(&system), |row, n, status| {
                    line.find(&system);
                    line.fill_counts(row, tolerance, n, status);
                });
            }
        }));
        all.push(cells.done());
    }
    (times, all)
}

fn abscissas(lines: usize, delays: usize) {
    let (values, places) = (even(0.01, LONGEST, delays), even(0.0, 1.0, lines));
    let (_, found) = abscissas_of_all(&places, &values);
    let rounds: Vec<Vec<f64>> = (0..ROUNDS)
        .map(|_| abscissas_of_all(&places, &values).0)
        .collect();
    let cells = lines * delays;
    println!(
        "certified abscissas, {lines} lines of {delays} delays, microseconds a cell, ratio to the letter's"
    );
    let names = names();
    show(&names, &rounds, cells as f64, (1e6, "us"));
    for (name, Certified { cells: sum, work }) in names.iter().zip(&found) {
        println!(
            "  {name:<10} {sum} of {cells} certified, lines found anew {} times, {:.2} evaluations a cell",
            work.reseeded,
            work.evaluations as f64 / work.cells as f64
        );
    }
}

fn main() {
    println!("one thread, least of {ROUNDS} rounds");
    counts(1000, 1000);
    counts(100, 10_000);
    abscissas(20, 1000);
}
