//! What the options of a search for a critical velocity do: each is doubled and halved.
//!
//! `cargo bench --bench critical_options`, one core, some twenty minutes; `SLIPMAP_CELLS` asks for
//! more or less than 300 random cells (seed fixed), an argument for options whose names contain it.
//! Options of a line of delays are tried on lines of as many cells together, those of switching on
//! on scans. Prints for every option and factor how many answers change by more than 1e-5 or
//! otherwise, by how much at most, and the ratio of the times; at the end those that change nothing
//! and take the same time. A value outside of its option's range is left out.

use std::time::Instant;

use slipmap::critical::along_delay::critical_velocities;
use slipmap::critical::switch_on::{Phase, Scan, Windows, windows};
use slipmap::critical::{CriticalVelocity, Options, Problem, Transition, critical_velocity};
use slipmap::slip::motion::Accuracy;

#[path = "../tests/common/chance_problem.rs"]
mod chance_problem;
use chance_problem::Chance;

/// Answers that differ by more than this are others.
const SAME: f64 = 1e-5;
/// Times that differ by less than this are the same: noise.
const SAME_TIME: f64 = 0.02;

/// What is looked for with some options.
enum Asked {
    Cells(Vec<Problem>),
    Lines(Vec<Vec<Problem>>),
    Scans(Vec<(Problem, f64)>),
}

/// An answer to be compared: a velocity, and what goes with it.
type Answer = (f64, Option<Transition>, bool);

fn of_cell(found: &CriticalVelocity) -> Vec<Answer> {
    let end = found.end_of_stick_slip();
    vec![(end, Some(found.transition), found.decided)]
}

fn of_scan(found: &Windows) -> Vec<Answer> {
    let edges = found.survives.iter().flatten();
    edges.map(|edge| (*edge, None, found.decided)).collect()
}

fn with(problem: &Problem, options: &Options) -> Problem {
    Problem {
        options: *options,
        ..problem.clone()
    }
}

impl Asked {
    fn new(name: &str, cells: usize) -> Self {
        let mut chance = Chance(11);
        let mut some = |n: usize| -> Vec<Problem> {
            let one = |i: usize| match i % 3 {
                2 => chance.problem_of_other_laws(),
                _ => chance.problem(),
            };
            (0..n).map(one).collect()
        };
        match name.split('.').next() {
            Some("along_delay") => {
                let line = |one: Problem| {
                    let tau = |i: usize| one.tau * (1.0 + 0.004 * i as f64);
                    let at = |i| Problem {
                        tau: tau(i),
                        ..one.clone()
                    };
                    (0..60).map(at).collect()
                };
                Self::Lines(some(cells.div_ceil(60)).into_iter().map(line).collect())
            }
            Some("switch_on") => {
                let problems = some(cells.div_ceil(30));
                let phases = (0..).map(|i| 0.3 * f64::from(i));
                Self::Scans(problems.into_iter().zip(phases).collect())
            }
            _ => Self::Cells(some(cells)),
        }
    }

    /// The answers, those of one cell, line or scan together, each with its time.
    fn answers(&self, options: &Options) -> Vec<(Vec<Answer>, f64)> {
        let timed = |search: &dyn Fn() -> Vec<Answer>| {
            let once = || {
                let start = Instant::now();
                (search(), start.elapsed().as_secs_f64())
            };
            let (first, second) = (once(), once());
            (first.0, first.1.min(second.1))
        };
        match self {
            Self::Cells(problems) => problems
                .iter()
                .map(|one| {
                    let problem = with(one, options);
                    timed(&|| of_cell(&critical_velocity(&problem)))
                })
                .collect(),
            Self::Lines(lines) => lines
                .iter()
                .map(|line| {
                    let line: Vec<Problem> = line.iter().map(|one| with(one, options)).collect();
                    timed(&|| {
                        let found = critical_velocities(&line, || false);
                        found.iter().flatten().flat_map(of_cell).collect()
                    })
                })
                .collect(),
            Self::Scans(scans) => scans
                .iter()
                .map(|(one, phase)| {
                    let problem = with(one, options);
                    let scan = Scan {
                        points: 31,
                        ..Scan::default()
                    };
                    let phase = Phase::After(*phase);
                    timed(&|| of_scan(&windows(&problem, phase, &scan, Accuracy::of(1e-9))))
                })
                .collect(),
        }
    }
}

/// How many answers changed, and by how much at most where both are velocities.
fn changes(before: &[(Vec<Answer>, f64)], after: &[(Vec<Answer>, f64)]) -> (usize, f64) {
    let (mut count, mut most) = (0, 0.0_f64);
    for ((one, _), (other, _)) in before.iter().zip(after) {
        count += one.len().abs_diff(other.len());
        for (a, b) in one.iter().zip(other) {
            let off = (b.0 / a.0 - 1.0).abs();
            let alike = a.0.to_bits() == b.0.to_bits() || a.0.is_nan() && b.0.is_nan();
            if off.is_finite() {
                most = most.max(off);
            }
            let same = (alike || off <= SAME) && (a.1, a.2) == (b.1, b.2);
            count += usize::from(!same);
        }
    }
    (count, most)
}

fn main() {
    let asked = std::env::var("SLIPMAP_CELLS").ok();
    let cells: usize = asked.and_then(|n| n.parse().ok()).unwrap_or(300);
    let wanted = std::env::args().skip(1).find(|one| !one.starts_with('-'));
    let wanted = wanted.unwrap_or_default();
    let names = Options::names().filter(|name| name.contains(&wanted));
    let mut idle = Vec::new();
    let mut table = String::new();
    let mut usual = Vec::new();
    let mut problems = Asked::new("", 0);
    println!("answers that change by more than {SAME:e}, the largest change, and the time's ratio");
    for name in names {
        let of_table = name.split('.').next().unwrap_or_default();
        if of_table != table {
            table = of_table.to_owned();
            problems = Asked::new(&name, cells);
            usual = problems.answers(&Options::default());
        }
        let mut does = false;
        let mut line = format!("{name:<38}");
        for factor in [0.5, 2.0] {
            let mut options = Options::default();
            if !options.scale(&name, factor) {
                line += &format!("  x {factor:<3}                          -");
                continue;
            }
            let found = problems.answers(&options);
            let (count, most) = changes(&usual, &found);
            let time = |answers: &[(Vec<Answer>, f64)]| answers.iter().map(|a| a.1).sum::<f64>();
            let ratio = time(&found) / time(&usual);
            does |= count > 0 || (ratio - 1.0).abs() > SAME_TIME;
            line += &format!("  x {factor:<3} {count:>4} {most:>8.1e} time {ratio:>6.3}");
        }
        println!("{line}");
        if !does {
            idle.push(name);
        }
    }
    println!("without an effect: {}", idle.join(", "));
}
