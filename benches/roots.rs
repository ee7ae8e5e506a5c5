//! The rightmost root of every cell of two maps, one thread: tracking with its certificate against
//! this project's own collocation run cell by cell.
//!
//! `cargo bench --bench roots`. Both ways take turns, five rounds; medians are shown. The maps are
//! those on which other programs were measured: pure load control b = −0.3, a_n in [−3, 1], τ in
//! [0.01, 10], and pure velocity control b = −0.3, a_v in [−1.5, 1], τ in [0.01, 12], each of 1000
//! × 1000 cells. Collocation takes every tenth line and every tenth delay.

use std::time::Instant;

use slipmap::linear::equation::Equation;
use slipmap::linear::newton::polish;
use slipmap::linear::row::Delays;
use slipmap::linear::status::CERTIFIED;
use slipmap::linear::track::{RootTracker, Work};
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::Groups;

const POINTS: usize = 1000;
/// Collocation looks at every so many-th line and delay.
const THINNED: usize = 10;
const ROUNDS: usize = 5;
/// Nodes of the collocation: the fewest with which every cell of both maps comes out right.
const NODES: usize = 8;
/// Eigenvalues that are polished, from the right.
const POLISHED: usize = 4;

struct Map {
    name: &'static str,
    lines: Vec<Groups>,
    delays: Vec<f64>,
}

fn even(from: f64, to: f64) -> Vec<f64> {
    (0..POINTS)
        .map(|i| from + (to - from) * i as f64 / (POINTS - 1) as f64)
        .collect()
}

fn maps() -> [Map; 2] {
    let lines =
        |from, to, groups: fn(f64) -> Groups| even(from, to).into_iter().map(groups).collect();
    [
        Map {
            name: "load control",
            lines: lines(-3.0, 1.0, |a_n| Groups::new(-0.3, 0.0, a_n)),
            delays: even(0.01, 10.0),
        },
        Map {
            name: "velocity control",
            lines: lines(-1.5, 1.0, |a_v| Groups::new(-0.3, a_v, 0.0)),
            delays: even(0.01, 12.0),
        },
    ]
}

/// Abscissas of all cells, how many are certified, and the work.
fn track(map: &Map) -> (Vec<f64>, usize, Work) {
    let delays = Delays::new(&map.delays);
    let mut tracker = RootTracker::new(1);
    let (mut counts, mut status) = (vec![0; POINTS], vec![0; POINTS]);
    let mut abscissas = Vec::with_capacity(POINTS * POINTS);
    let mut certified = 0;
    for &groups in &map.lines {
        status.fill(0);
        let crossings = Crossings::of(groups);
        crossings.fill_counts(
            &delays,
            MarginalTolerance::default(),
            &mut counts,
            &mut status,
        );
        tracker.follow(
            groups,
            (&map.delays, 1.0),
            0,
            &counts,
            &mut status,
            |_, cell| {
                abscissas.push(cell.roots.first().map_or(f64::NAN, |root| root.lambda.re));
            },
        );
        certified += status.iter().filter(|&&s| s & CERTIFIED != 0).count();
    }
    (abscissas, certified, tracker.work)
}

/// Abscissas of the cells of the thinned map.
fn collocate(map: &Map) -> Vec<f64> {
    let mut abscissas = Vec::with_capacity(POINTS * POINTS / (THINNED * THINNED));
    for &groups in map.lines.iter().step_by(THINNED) {
        for &tau in map.delays.iter().step_by(THINNED) {
            let starts = groups.eigenvalues(tau, NODES).unwrap_or_default();
            let roots = starts
                .iter()
                .take(POLISHED)
                .filter_map(|&z| polish(groups, tau, z));
            abscissas.push(roots.map(|r| r.lambda.re).fold(f64::NEG_INFINITY, f64::max));
        }
    }
    abscissas
}

fn microseconds_per_cell<T>(cells: usize, work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64() * 1e6 / cells as f64, result)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    println!(
        "one thread, {POINTS} x {POINTS} cells, medians of {ROUNDS} rounds, microseconds a cell"
    );
    for map in maps() {
        let (mut tracked, mut collocated) = (Vec::new(), Vec::new());
        for round in 0..=ROUNDS {
            let (t, (abscissas, certified, work)) =
                microseconds_per_cell(POINTS * POINTS, || track(&map));
            let thinned = POINTS * POINTS / (THINNED * THINNED);
            let (c, by_collocation) = microseconds_per_cell(thinned, || collocate(&map));
            if round > 0 {
                tracked.push(t);
                collocated.push(c);
                continue;
            }
            // The first round warms up and compares.
            let of_cell = |i: usize| {
                let per_line = POINTS / THINNED;
                abscissas[(i / per_line) * THINNED * POINTS + (i % per_line) * THINNED]
            };
            let differs = |(i, s): &(usize, &f64)| (of_cell(*i) - **s).abs() > 1e-9;
            let different = by_collocation.iter().enumerate().filter(differs).count();
            println!("{}:", map.name);
            println!(
                "  certified cells                   {certified} of {}",
                abscissas.len()
            );
            println!(
                "  lines found anew                  {} times",
                work.reseeded
            );
            println!(
                "  evaluations of D a cell           {:.2}",
                work.evaluations as f64 / work.cells as f64
            );
            println!("  collocation differs in            {different} of {thinned} cells");
        }
        let (tracked, collocated) = (median(tracked), median(collocated));
        println!("  tracked and certified             {tracked:.3}");
        println!("  collocation with {NODES} nodes, cell by cell {collocated:.1}");
        println!(
            "  ratio                             {:.0}",
            collocated / tracked
        );
    }
}
