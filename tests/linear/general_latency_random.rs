//! Random feedback with memory and latency, degrees 1 to 8: the lines of delays and of latencies,
//! the argument principle in closed form in both its forms, and a walk of the argument that shares
//! nothing with them. `SLIPMAP_CASES` says how many.

use crate::chance::{Chance, asked};
use crate::walk::Walk;
use num_complex::Complex64;
use slipmap::linear::general::{
    DelayLine, Form, Polynomial, Reason, RightOf, RootCounter, Spectrum, System,
};
use slipmap::linear::{Direction, MarginalTolerance};
use slipmap::model::Channel;

fn cases(usual: u64) -> u64 {
    asked("SLIPMAP_CASES", usual)
}

/// D = B(1 − R E) − A e^(−λδ)(1 − E).
#[derive(Debug)]
struct Late {
    open: Vec<f64>,
    gain: Vec<f64>,
    memory: f64,
    latency: f64,
    tau: f64,
}

/// A polynomial of that degree from random zeros.
fn from_zeros(chance: &mut Chance, degree: usize, leading: f64) -> Vec<f64> {
    let mut p = vec![leading];
    let mut times = |factor: &[f64]| {
        let mut product = vec![0.0; p.len() + factor.len() - 1];
        for (i, a) in p.iter().enumerate() {
            for (j, b) in factor.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        p = product;
    };
    let mut left = degree;
    while left > 0 {
        let size = chance.log(0.2, 5.0);
        if left >= 2 && chance.unit() < 0.7 {
            let damping = chance.between(-0.3, 0.9);
            times(&[size * size, 2.0 * damping * size, 1.0]);
            left -= 2;
        } else {
            times(&[chance.between(-0.3, 1.0) * size, 1.0]);
            left -= 1;
        }
    }
    p
}

fn by_chance(chance: &mut Chance) -> Late {
    let degree = 1 + chance.of(8);
    let lower = chance.of(degree);
    let size = chance.log(0.1, 6.0) * [-1.0, 1.0][chance.of(2)];
    Late {
        open: from_zeros(chance, degree, 1.0),
        gain: from_zeros(chance, lower, size),
        memory: [0.0, chance.between(-0.95, 0.95)][chance.of(2)],
        latency: chance.log(0.01, 12.0),
        tau: chance.log(0.03, 20.0),
    }
}

fn value(p: &[f64], z: Complex64) -> Complex64 {
    p.iter().rev().fold(Complex64::ZERO, |sum, c| sum * z + c)
}

impl Late {
    fn system(&self) -> System {
        let polynomial = |c: &[f64]| Polynomial::new(c).expect("a small degree");
        let (open, gain) = (polynomial(&self.open), polynomial(&self.gain));
        System::feedback(
            open,
            gain,
            Channel {
                memory: self.memory,
                latency: self.latency,
            },
        )
    }

    fn at(&self, z: Complex64) -> Complex64 {
        let echo = (-z * self.tau).exp();
        let fed = value(&self.gain, z) * (-z * self.latency).exp();
        value(&self.open, z) * (1.0 - self.memory * echo) - fed * (1.0 - echo)
    }

    /// How many roots lie right of `line`; none where they accumulate near it, and where a walk
    /// takes too long.
    fn walked(&self, line: f64) -> Option<u64> {
        let echo = (-line * self.tau).exp();
        if self.memory.abs() * echo >= 0.98 {
            return None;
        }
        self.walk().right_of(line)
    }

    /// Its terms, written out.
    fn walk(&self) -> Walk {
        let times = |p: &[f64], by: f64| p.iter().map(|c| by * c).collect();
        Walk {
            terms: vec![
                (self.open.clone(), 0.0),
                (times(&self.open, -self.memory), self.tau),
                (times(&self.gain, -1.0), self.latency),
                (self.gain.clone(), self.latency + self.tau),
            ],
        }
    }
}

#[test]
fn both_forms_are_what_a_walk_counts() {
    let mut chance = Chance(asked("SLIPMAP_SEED", 30));
    let (mut walked, mut tried, mut undecided) = (0, 0, 0);
    let cases = cases(2000) / 4;
    for _ in 0..cases {
        let late = by_chance(&mut chance);
        let counter = RootCounter::new(&late.system());
        for line in [0.0, chance.between(-0.5, 0.6)] {
            let Some(expected) = late.walked(line) else {
                continue;
            };
            walked += 1;
            for form in [Form::Delay, Form::Latency] {
                tried += 1;
                match counter.right_of_by(form, late.tau, line) {
                    RightOf::Roots(n) => assert_eq!(n, expected, "{late:?} {line} {form:?}"),
                    RightOf::Undecided => undecided += 1,
                    RightOf::Infinite => panic!("{late:?} {line}"),
                }
            }
        }
    }
    println!(
        "{walked} lines walked of {}, {undecided} of {tried} undecided",
        2 * cases
    );
    assert!(
        walked > cases && undecided <= tried / 500,
        "{walked} {undecided}"
    );
}

#[test]
fn lines_of_delays_and_of_latencies_are_both_forms() {
    let mut chance = Chance(asked("SLIPMAP_SEED", 31));
    let (mut cells, mut open, mut unstable) = (0, 0, 0);
    for _ in 0..cases(2000) {
        let late = by_chance(&mut chance);
        let system = late.system();
        let counter = RootCounter::new(&system);
        let delays = DelayLine::of(&system);
        let latencies = DelayLine::of_latencies(&system, late.tau).expect("feedback");
        cells += 1;
        let by_delay = decided(&delays, late.tau);
        let (Some(n), Some(by_latency)) = (by_delay, decided(&latencies, late.latency)) else {
            open += 1;
            continue;
        };
        assert_eq!(n, by_latency, "{late:?}");
        unstable += u64::from(n > 0);
        for line in [0.0, chance.between(-0.5, 0.6)] {
            let forms = [Form::Delay, Form::Latency];
            let found = forms.map(|form| counter.right_of_by(form, late.tau, line));
            if found.contains(&RightOf::Undecided) {
                open += 1;
                continue;
            }
            assert_eq!(found[0], found[1], "{late:?} {line}");
            let same = line != 0.0 || found[0] == RightOf::Roots(n);
            assert!(same, "{late:?} {found:?} {n}");
        }
        // Every delay of this latency, and every latency of this delay.
        for _ in 0..3 {
            let (tau, latency) = (chance.log(0.03, 40.0), chance.log(0.01, 40.0));
            let at = system.with_latency(latency).expect("feedback");
            let right = counter.right_of(tau, 0.0);
            compare(decided(&delays, tau), right, &(&late, tau));
            let right = RootCounter::new(&at).right_of(late.tau, 0.0);
            compare(decided(&latencies, latency), right, &(&late, latency));
        }
    }
    println!("{cells} cells, {unstable} unstable, {open} open");
    assert!(open <= cells / 200, "{open}");
    assert!(
        unstable > cells / 10 && unstable < cells * 99 / 100,
        "{unstable}"
    );
}

/// The count at a place of a line, none where it is marginal.
fn decided(line: &DelayLine, at: f64) -> Option<u64> {
    let count = line.count(at, MarginalTolerance::default());
    (!count.marginal).then_some(count.n_unstable)
}

fn compare(counted: Option<u64>, right: RightOf, place: &dyn std::fmt::Debug) {
    if let (Some(counted), RightOf::Roots(n)) = (counted, right) {
        assert_eq!(counted, n, "{place:?}");
    }
}

/// No zero of F is missed: each change of its sign on a fine grid has its crossing, and there are
/// no others.
#[test]
fn crossings_are_all_changes_of_sign_of_a_fine_scan() {
    let mut chance = Chance(asked("SLIPMAP_SEED", 32));
    let mut zeros = 0;
    for _ in 0..cases(2000) / 5 {
        let late = by_chance(&mut chance);
        let system = late.system();
        let line = DelayLine::of(&system);
        let of_delays = |omega: f64| {
            let z = Complex64::new(0.0, omega);
            let open = value(&late.open, z);
            let fed = value(&late.gain, z) * Complex64::cis(-omega * late.latency);
            (1.0 + late.memory) * open.norm_sqr() - 2.0 * (open.conj() * fed).re
        };
        let of_latencies = |omega: f64| {
            let z = Complex64::new(0.0, omega);
            let (open, fed) = (value(&late.open, z), value(&late.gain, z));
            let echo = Complex64::cis(-omega * late.tau);
            open.norm_sqr() * (1.0 - late.memory * echo).norm_sqr()
                - fed.norm_sqr() * (1.0 - echo).norm_sqr()
        };
        let latencies = DelayLine::of_latencies(&system, late.tau).expect("feedback");
        zeros += scanned(&late, &line, of_delays);
        zeros += scanned(&late, &latencies, of_latencies);
    }
    println!("{zeros} zeros");
    assert!(zeros > 500, "{zeros}");
}

fn scanned(late: &Late, line: &DelayLine, f: impl Fn(f64) -> f64) -> usize {
    const POINTS: usize = 20_000;
    let moving = |c: &&slipmap::linear::Crossing| c.direction != Direction::Touch;
    let mut found: Vec<f64> = line
        .crossings
        .iter()
        .filter(moving)
        .map(|c| c.omega)
        .collect();
    found.sort_by(f64::total_cmp);
    let last = late.walk().radius(0.0).expect("|R| < 1");
    let place = |i: usize| last * i as f64 / POINTS as f64;
    let mut next = 0;
    for i in 0..POINTS {
        let (from, to) = (place(i), place(i + 1));
        let inside = found[next..].iter().take_while(|w| **w < to).count();
        let changes = (f(from) > 0.0) != (f(to) > 0.0);
        assert_eq!(changes, inside % 2 == 1, "{late:?} {from} {to} {line:?}");
        // Each crossing goes the way that F says.
        next += inside;
    }
    assert_eq!(next, found.len(), "{late:?} {line:?}");
    for crossing in line.crossings.iter().filter(moving) {
        let near = 1e-7 * crossing.omega;
        let rises = f(crossing.omega + near) > f(crossing.omega - near);
        assert_eq!(
            rises,
            crossing.direction == Direction::Right,
            "{late:?} {crossing:?}"
        );
    }
    found.len()
}

/// The abscissa is certified, D vanishes at the root, and a walk finds nothing right of it.
#[test]
fn rightmost_roots_are_found_and_certified() {
    let mut chance = Chance(asked("SLIPMAP_SEED", 33));
    let cases = cases(2000) / 4;
    let (mut certified, mut accumulating, mut missing, mut walked) = (0, 0, 0, 0);
    for case in 0..cases {
        let late = by_chance(&mut chance);
        let system = late.system();
        let counter = RootCounter::new(&system);
        let line = DelayLine::of(&system);
        let found = Spectrum::at(&counter, &line, late.tau, 1);
        if found.reason == Some(Reason::NoRightmostRoot) {
            accumulating += 1;
            continue;
        }
        if !found.certified {
            missing += 1;
            continue;
        }
        certified += 1;
        let root = found.roots[0];
        let near = late.walk().slope(root.lambda, 1e-9) * 1e-9;
        assert!(late.at(root.lambda).norm() <= near, "{late:?} {root:?}");
        if case % 5 == 0 {
            let beside = 1e-4 * root.lambda.re.abs().max(1.0);
            if let Some(n) = late.walked(root.lambda.re + beside) {
                walked += 1;
                assert_eq!(n, 0, "{late:?} {root:?}");
            }
            if let Some(n) = late.walked(root.lambda.re - beside) {
                assert!(n >= root.count(), "{late:?} {root:?} {n}");
            }
        }
    }
    println!(
        "{certified} of {cases} certified, {accumulating} without a rightmost root, {missing} not, \
         {walked} walked"
    );
    assert!(missing <= cases / 100, "{missing}");
    assert!(walked > 20, "{walked}");
}
