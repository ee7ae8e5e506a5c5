use slipmap::linear::general::{DelayLine, Form, Polynomial, RootCounter, System};
use slipmap::linear::row::Delays;
use slipmap::linear::status::CERTIFIED;
use slipmap::linear::track::RootTracker;
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::Groups;
use std::time::Instant;
const POINTS: usize = 1000;
fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| from + (to - from) * i as f64 / (n - 1) as f64)
        .collect()
}
fn letter(g: Groups, memory: f64, latency: f64) -> System {
    let p = |c: &[f64]| Polynomial::new(c).unwrap();
    System::feedback(
        p(&[1.0, g.b, 1.0]),
        p(&[g.a_n + g.a_v * g.b, g.a_v]),
        memory,
        latency,
    )
}
fn time<T>(name: &str, per: usize, mut f: impl FnMut() -> T) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let s = Instant::now();
        std::hint::black_box(f());
        best = best.min(s.elapsed().as_secs_f64() * 1e9 / per as f64);
    }
    println!("{name:50} {best:12.1} ns");
    best
}
fn main() {
    let quick = std::env::var_os("QUICK").is_some();
    let lines: Vec<Groups> = even(-1.5, 1.0, 500)
        .into_iter()
        .map(|a| Groups::new(-0.3, a, 0.0))
        .collect();
    let lines_n: Vec<Groups> = even(-3.0, 1.0, 500)
        .into_iter()
        .map(|a| Groups::new(-0.3, 0.0, a))
        .collect();
    let all: Vec<Groups> = lines.iter().chain(&lines_n).copied().collect();
    let taus = even(0.01, 12.0, POINTS);
    let delays = Delays::new(&taus);
    let (mut counts, mut status) = (vec![0u16; POINTS], vec![0u8; POINTS]);
    let base = time("letter count line", all.len(), || {
        for &g in &all {
            status.fill(0);
            Crossings::of(g).fill_counts(
                &delays,
                MarginalTolerance::default(),
                &mut counts,
                &mut status,
            );
        }
    });
    if !quick {
        for latency in [0.0, 0.1, 0.5, 3.0] {
            for memory in [0.0, 0.4] {
                let mut line = DelayLine::default();
                let systems: Vec<System> =
                    all.iter().map(|&g| letter(g, memory, latency)).collect();
                let t = time(
                    &format!("line find d={latency} R={memory}"),
                    all.len(),
                    || {
                        for s in &systems {
                            line.find(s);
                        }
                    },
                );
                println!("   ratio to letter line {:.1}", t / base);
                if latency > 0.0 {
                    time("   of_latencies tau=4", all.len(), || {
                        for s in &systems {
                            line.find_latencies(s, 4.0);
                        }
                    });
                }
                let counters: Vec<RootCounter> = systems.iter().map(RootCounter::new).collect();
                time("   RootCounter::new", all.len(), || {
                    for s in &systems {
                        std::hint::black_box(RootCounter::new(s));
                    }
                });
                for tau in [0.5, 4.0, 12.0] {
                    for form in [Form::Delay, Form::Latency] {
                        time(
                            &format!("   right_of {form:?} tau={tau} sigma -0.05"),
                            all.len(),
                            || {
                                counters
                                    .iter()
                                    .map(|c| c.right_of_by(form, tau, -0.05).finite().unwrap_or(0))
                                    .sum::<u64>()
                            },
                        );
                    }
                }
            }
        }
    }
    let thin: Vec<Groups> = all.iter().copied().step_by(20).collect();
    let mut tracker = RootTracker::new(1);
    let base = time("letter abscissa cell", thin.len() * POINTS, || {
        for &g in &thin {
            status.fill(0);
            Crossings::of(g).fill_counts(
                &delays,
                MarginalTolerance::default(),
                &mut counts,
                &mut status,
            );
            tracker.follow(g, (&taus, 1.0), 0, &counts, &mut status, |_, _| {});
        }
    });
    let only: Option<f64> = std::env::var("QUICK").ok().and_then(|q| q.parse().ok());
    for latency in [0.0, 0.1, 0.5, 3.0] {
        for memory in [0.0, 0.4] {
            if only.is_some_and(|o| o != latency + memory) {
                continue;
            }
            let mut tracker = RootTracker::new(1);
            let mut certified = 0;
            let t = time(
                &format!("abscissa d={latency} R={memory}"),
                thin.len() * POINTS,
                || {
                    certified = 0;
                    for &g in &thin {
                        let s = letter(g, memory, latency);
                        let line = DelayLine::of(&s);
                        for (i, &tau) in taus.iter().enumerate() {
                            let c = line.count(tau, MarginalTolerance::default());
                            counts[i] = c.n_unstable as u16;
                            status[i] = if c.marginal { 4 } else { 0 };
                        }
                        let counter = RootCounter::new(&s);
                        tracker.follow(&counter, (&taus, 1.0), 0, &counts, &mut status, |_, _| {});
                        certified += status.iter().filter(|&&s| s & CERTIFIED != 0).count();
                    }
                },
            );
            println!(
                "   ratio {:.1}, certified {} of {}, reseeded {} evals {:.2}",
                t / base,
                certified,
                thin.len() * POINTS,
                tracker.work.reseeded / 5,
                tracker.work.evaluations as f64 / tracker.work.cells as f64
            );
        }
    }
}
