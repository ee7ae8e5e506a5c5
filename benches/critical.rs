//! Time of a critical velocity by each of its methods, one core.
//!
//! `cargo bench --bench critical`. Random problems (seed fixed): weakening and Coulomb friction
//! under load, velocity and mixed control; `SLIPMAP_CELLS` asks for more than 300. Each cell is
//! done from scratch as `slipmap vc` does it, and by simulation alone right after, which waits for
//! every outcome; medians, means and the slowest cell of every method. Then lines of 256 delays as a
//! map does them, where cells start from their neighbours; every block is timed three times, and
//! the least counts: per cell, everything included, and each single visit to a cell.

use std::cell::RefCell;
use std::time::Instant;

use slipmap::critical::along_delay::{BLOCK, critical_velocities};
use slipmap::critical::{
    CriticalVelocity, Method, Problem, RampOptions, Transition, by_simulation, critical_velocity,
};
use slipmap::model::Feedback;
use slipmap::slip::motion::Accuracy;

#[path = "../tests/common/chance.rs"]
mod chance;
#[path = "../tests/common/chance_problem.rs"]
mod chance_problem;
use chance::Chance;

struct Timed {
    problem: Problem,
    found: CriticalVelocity,
    micros: f64,
    simulated_micros: f64,
    simulated: CriticalVelocity,
    agrees: bool,
}

fn timed<T>(what: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = what();
    (result, start.elapsed().as_secs_f64() * 1e6)
}

fn main() {
    let asked = std::env::var("SLIPMAP_CELLS").ok();
    let cells: usize = asked.and_then(|n| n.parse().ok()).unwrap_or(300);
    let mut chance = Chance(7);
    let accuracy = Accuracy {
        tolerance: 1e-9,
        ..Accuracy::default()
    };
    let patient = RampOptions {
        patient: true,
        ..RampOptions::default()
    };
    let mut all = Vec::new();
    for _ in 0..cells {
        let problem = chance.problem();
        let (found, micros) = timed(|| critical_velocity(&problem));
        let (simulated, simulated_micros) = timed(|| by_simulation(&problem, &patient, accuracy));
        let value = |c: &CriticalVelocity| {
            if c.transition == Transition::LiftOff {
                c.v_liftoff
            } else {
                c.vc
            }
        };
        let agrees = found.transition == simulated.transition
            && (value(&found) / value(&simulated) - 1.0).abs() < 1e-4;
        all.push(Timed {
            problem,
            found,
            micros,
            simulated_micros,
            simulated,
            agrees,
        });
    }
    println!("{cells} cells; µs a cell: median, mean, slowest");
    row("all, as in a map", all.iter().map(|t| (t, t.micros)));
    for method in Method::ALL {
        let those = || all.iter().filter(|t| t.found.method == method);
        row(method.name(), those().map(|t| (t, t.micros)));
        if method != Method::Simulation {
            row(
                "  these by simulation",
                those().map(|t| (t, t.simulated_micros)),
            );
            let (count, agree) = (those().count(), those().filter(|t| t.agrees).count());
            println!("  {agree} of {count} agree with simulation to 1e-4");
            for t in those().filter(|t| !t.agrees) {
                println!(
                    "    {:?}\n      {:?}\n      {:?}",
                    t.problem, t.found, t.simulated
                );
            }
        }
    }
    row(
        "all by simulation",
        all.iter().map(|t| (t, t.simulated_micros)),
    );
    lines(cells);
}

/// Delays of a line, from 0.05 to 5.
const DELAYS: usize = 256;

/// Lines as a map does them, with about as many blocks as there are `cells` of the other part.
fn lines(cells: usize) {
    let mut chance = Chance(8);
    let (mut by_orbit, mut all, mut visits) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..cells.div_ceil(DELAYS / BLOCK * 4) {
        let one = chance.problem();
        let line: Vec<Problem> = (0..DELAYS)
            .map(|i| Problem {
                feedback: Feedback {
                    tau: 0.05 + 4.95 * i as f64 / (DELAYS - 1) as f64,
                    ..one.feedback
                },
                ..one.clone()
            })
            .collect();
        for block in line.chunks(BLOCK) {
            let once = || {
                let begun = RefCell::new(Vec::new());
                let (found, micros) = timed(|| {
                    critical_velocities(block, || {
                        begun.borrow_mut().push(Instant::now());
                        false
                    })
                });
                (found, micros, begun.into_inner())
            };
            let mut runs = [once(), once(), once()];
            runs.sort_by(|p, q| p.1.total_cmp(&q.1));
            let (found, micros, begun) = &runs[0];
            let orbit =
                |c: &Option<CriticalVelocity>| c.is_some_and(|c| c.method == Method::GrazeOrbit);
            if found.iter().all(orbit) {
                by_orbit.push(micros / block.len() as f64);
                let each = begun.windows(2).map(|w| (w[1] - w[0]).as_secs_f64() * 1e6);
                visits.extend(each);
            }
            all.push(micros / block.len() as f64);
        }
    }
    for (name, mut micros) in [
        ("all blocks", all),
        ("blocks by the orbit", by_orbit),
        ("visits to their cells", visits),
    ] {
        micros.sort_by(f64::total_cmp);
        let Some(most) = micros.last() else { continue };
        let mean = micros.iter().sum::<f64>() / micros.len() as f64;
        println!(
            "lines, {name:<22} {:>5}: µs a cell: median {:.1}, mean {mean:.1}, slowest {most:.0}",
            micros.len(),
            micros[micros.len() / 2],
        );
    }
}

fn row<'t>(name: &str, times: impl Iterator<Item = (&'t Timed, f64)>) {
    let mut times: Vec<_> = times.collect();
    times.sort_by(|p, q| p.1.total_cmp(&q.1));
    let Some((slowest, most)) = times.last() else {
        return println!("{name:<24} none");
    };
    let mean = times.iter().map(|t| t.1).sum::<f64>() / times.len() as f64;
    let p = &slowest.problem;
    println!(
        "{name:<24} {:>5} cells {:>9.1} {mean:>9.1} {most:>10.0}   {:?} alpha_v {:.3} alpha_n {:.3} tau {:.3}: {}",
        times.len(),
        times[times.len() / 2].1,
        p.law.kind(),
        p.feedback.gains.alpha_v,
        p.feedback.gains.alpha_n,
        p.feedback.tau,
        slowest.found.transition.name(),
    );
}
