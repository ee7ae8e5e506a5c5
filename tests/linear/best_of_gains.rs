//! Settings of fastest decay over two parameters at one delay, and with the delay as a third: the
//! triple root of a pendulum in closed form, loops by chance against a walk of the argument over a
//! grid that shares nothing with the crate, the command line. `SLIPMAP_CASES` says how many,
//! `SLIPMAP_GRID` how many places each way.

use crate::chance::{Chance, asked};
use crate::program::{self, Folder, err};
use crate::walk::Walk;
use serde_json::Value;
use slipmap::linear::best::{Across, Best, General, Kind, Search, best};
use slipmap::linear::general::System;
use slipmap::model::stop::Stop;

/// P + (k₁ + k₂ s) Q e^(−sτ) over k₁ and k₂.
#[derive(Debug)]
struct Loop {
    p: Vec<f64>,
    q: Vec<f64>,
    tau: f64,
    ranges: [(f64, f64); 2],
}

impl Loop {
    /// An upright pendulum, s² − 1, at this delay.
    fn pendulum(tau: f64, ranges: [(f64, f64); 2]) -> Self {
        Self {
            p: vec![-1.0, 0.0, 1.0],
            q: vec![1.0],
            tau,
            ranges,
        }
    }

    fn by_chance(chance: &mut Chance) -> Self {
        let (stiffness, damping) = (chance.between(-1.0, 1.5), chance.between(-0.4, 0.8));
        let lag = [0.0, chance.log(0.05, 0.5)][chance.of(2)];
        let mut p = vec![
            stiffness,
            damping + lag * stiffness,
            1.0 + lag * damping,
            lag,
        ];
        if lag == 0.0 {
            p.pop();
        }
        Self {
            p,
            q: vec![1.0],
            tau: chance.log(0.05, 1.5),
            ranges: [(-3.0, 6.0), (-3.0, 4.0)],
        }
    }

    fn fed(&self, k: [f64; 2]) -> Vec<f64> {
        let mut fed = vec![0.0; self.q.len() + 1];
        for (i, c) in self.q.iter().enumerate() {
            fed[i] += k[0] * c;
            fed[i + 1] += k[1] * c;
        }
        fed
    }

    fn walk(&self, k: [f64; 2]) -> Walk {
        Walk {
            terms: vec![(self.p.clone(), 0.0), (self.fed(k), self.tau)],
        }
    }

    fn best(&self) -> Best {
        let at = |k1: f64, k2: f64| System::of_coefficients(&self.p, &self.fed([k1, k2])).ok();
        let width = |(from, to): (f64, f64)| to - from;
        let [p, q] = self.ranges;
        let search = Search {
            family: General {
                system_at: &at,
                across: Across::Parameter {
                    tau: self.tau,
                    width: width(q),
                },
                width: width(p),
            },
            p,
            q,
        };
        best(&search, &Stop::default())
    }
}

/// (s² − 1) e^(sτ) = −(k_p + k_d s) has a triple root where the second derivative of the left side
/// vanishes: s = (√(2 + τ²) − 2)/τ. There the pendulum is fastest.
#[test]
fn a_pendulum_is_fastest_at_its_triple_root() {
    for tau in [0.1_f64, 0.3, 0.7, 1.1] {
        let root = ((2.0 + tau * tau).sqrt() - 2.0) / tau;
        let grown = (root * tau).exp();
        let k_d = -(2.0 * root + tau * (root * root - 1.0)) * grown;
        let k_p = -(root * root - 1.0) * grown - k_d * root;
        let found = Loop::pendulum(tau, [(0.0, 12.0), (0.0, 12.0)])
            .best()
            .overall;
        assert_eq!(
            (found.kind, found.certified),
            (Kind::TripleReal, true),
            "{tau} {found:?}"
        );
        assert!(
            (found.abscissa - root).abs() <= found.margin.max(1e-9),
            "{root} {found:?}"
        );
        let apart = (found.p / k_p - 1.0).abs().max((found.q / k_d - 1.0).abs());
        assert!(apart < 1e-7, "{k_p} {k_d} {found:?}");
    }
}

/// Where the triple root leaves the box, a double root and a pair that came to the real axis beside
/// it were told as an optimum, with another root 0.5 farther right, and lines as far away as that
/// certified it.
#[test]
fn what_is_certified_beside_the_edge_holds() {
    let mut certified = 0;
    for i in 0..40 {
        let tau = 0.138_64 + 1e-6 * f64::from(i);
        let pendulum = Loop::pendulum(tau, [(0.0, 5.0), (0.0, 5.0)]);
        let found = pendulum.best().overall;
        if found.certified {
            let walk = pendulum.walk([found.p, found.q]);
            assert_eq!(
                walk.right_of(found.abscissa + 0.1),
                Some(0),
                "{tau} {found:?}"
            );
            certified += 1;
        }
    }
    assert!(certified > 0, "{certified}");
}

/// No root lies right of a certified optimum, and nowhere on a grid are all roots farther left.
#[test]
fn nothing_on_a_grid_is_better() {
    let mut chance = Chance(asked("SLIPMAP_SEED", 47));
    let (cases, grid) = (asked("SLIPMAP_CASES", 6), asked("SLIPMAP_GRID", 16));
    let (mut certified, mut stable, mut places) = (0, 0, 0);
    for _ in 0..cases {
        let problem = Loop::by_chance(&mut chance);
        let found = problem.best().overall;
        let beside = found.margin + 1e-6 * (1.0 + found.abscissa.abs());
        certified += u64::from(found.certified);
        stable += u64::from(found.abscissa < 0.0);
        let walk = problem.walk([found.p, found.q]);
        if let Some(right) = walk.right_of(found.abscissa + beside) {
            assert_eq!(right, 0, "{problem:?} {found:?}");
        }
        let along = |(from, to): (f64, f64), i: u64| from + (to - from) * i as f64 / grid as f64;
        for i in 0..(grid + 1) * (grid + 1) {
            let [p, q] = problem.ranges;
            let k = [along(p, i / (grid + 1)), along(q, i % (grid + 1))];
            let Some(right) = problem.walk(k).right_of(found.abscissa - beside) else {
                continue;
            };
            places += 1;
            assert!(right > 0, "{problem:?} {found:?}: {k:?} is better");
        }
    }
    println!("{cases} loops: {certified} certified, {stable} stable, {places} places walked");
    assert!(
        certified * 10 >= cases * 8 && places >= 30 * cases,
        "{certified} {places}"
    );
}

fn json(folder: &Folder, args: &str) -> Value {
    let output = folder.run(&args.split(' ').collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(0), "{args}: {}", err(&output));
    program::json(&output)
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// What `best` says at one delay is what `point` says there, and with the delay as a third parameter
/// no delay of a fine row is better.
#[test]
fn the_program_searches_two_gains_and_the_delay() {
    let folder = Folder::new();
    let of = |args: &str| {
        json(
            &folder,
            &format!("{args} --json --system pd --set stiffness=-1"),
        )
    };
    let gains = "best --search k_p --search k_d --range k_p=0:5 --range k_d=0:5";
    let at = |tau: f64| number(&of(&format!("{gains} --tau {tau:?}"))["best"]["abscissa"]);

    let found = of(&format!("{gains} --tau 0.3"));
    let best = &found["best"];
    assert_eq!(
        (&found["search"], &found["second"]),
        (&"k_p".into(), &"k_d".into())
    );
    assert_eq!(found["searched"]["second"], serde_json::json!([0.0, 5.0]));
    assert_eq!(found["searched"]["tau"], serde_json::json!([0.3, 0.3]));
    let (k_p, k_d) = (number(&best["value"]), number(&best["second"]));
    let point = of(&format!(
        "point --set k_p={k_p:?} --set k_d={k_d:?} --tau 0.3"
    ));
    let apart = number(&point["abscissa"]) - number(&best["abscissa"]);
    assert!(apart.abs() <= number(&best["margin"]), "{apart} {best}");
    assert_eq!(found["point"]["parameters"]["k_d"], best["second"]);

    // The triple root needs larger gains the shorter the delay is, so the box ends it.
    let found = of(&format!("{gains} --tau-from 0.1 --tau-to 1"));
    let (tau, abscissa) = (
        number(&found["best"]["tau"]),
        number(&found["best"]["abscissa"]),
    );
    assert!(
        abscissa < at(0.3) && (0.138..0.139).contains(&tau),
        "{}",
        found["best"]
    );
    for i in 0..12 {
        let there = 0.1 + 0.008 * f64::from(i);
        assert!(at(there) >= abscissa - 1e-3, "{there} {abscissa}");
    }
    // Where the gains reach far enough the shortest delay is best, at the edge.
    let wide = "best --search k_p --search k_d --range k_p=0:50 --range k_d=0:50";
    let found = of(&format!("{wide} --tau-from 0.2 --tau-to 1"));
    assert_eq!(found["best"]["kind"], "edge of the range");
    assert!(
        (number(&found["best"]["tau"]) - 0.2).abs() < 1e-5,
        "{}",
        found["best"]
    );
}

/// s(4s + 1) e^s = −(k_p s + k_i) has a triple root where 4s² + 17s + 10 = 0. Where k_i is exactly 0
/// the controller has no integrator, and no root near 0: that point alone was told as the best one.
#[test]
fn a_part_of_a_controller_that_vanishes_is_no_best_setting() {
    let folder = Folder::new();
    let root = (-17.0 + 129.0_f64.sqrt()) / 8.0;
    for gains in ["--search k_p --search k_i", "--search k_i --search k_p"] {
        let found = json(
            &folder,
            &format!("best --system pi_loop {gains} --tau 1 --json"),
        );
        let best = &found["best"];
        assert_eq!(best["kind"], "triple real root", "{best}");
        let apart = (number(&best["abscissa"]) - root).abs();
        assert!(apart <= number(&best["margin"]), "{apart} {best}");
    }
}

/// Ranges that nobody searches, or that are given twice, are told with what to type.
#[test]
fn ranges_that_do_not_fit_are_refused() {
    let folder = Folder::new();
    for (args, said) in [
        (
            "--search k_p --search k_p --tau 1",
            "--search k_p is given twice",
        ),
        (
            "--search k_p --search k_d --search k_a",
            "at most two parameters",
        ),
        (
            "--search k_p --search k_d --search-from 1",
            "is it of k_p or of k_d?",
        ),
        (
            "--search k_p --search k_d --range k_a=0:1 --tau 1",
            "k_a is not searched",
        ),
        (
            "--search k_p --search k_d --range k_p=2:1 --tau 1",
            "is above",
        ),
        (
            "--search k_p --search k_d --range k_p=2 --tau 1",
            "NAME=FROM:TO",
        ),
        (
            "--search k_p --search k_d --tau 1 --tau-to 2",
            "a value of tau is given",
        ),
        (
            "--search k_p --search k_d --set k_d=1 --tau 1",
            "a value of k_d is given",
        ),
        (
            "--search k_p --range k_p=0:1 --search-to 2",
            "give the same",
        ),
        (
            "--search k_p --range k_p=0:1 --range k_p=0:2",
            "given twice",
        ),
        ("--search k_p --tau 1", "a value of tau is given"),
    ] {
        let args = format!("best --system pd {args}");
        let output = folder.run(&args.split(' ').collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(2), "{args}");
        assert!(err(&output).contains(said), "{args}: {}", err(&output));
    }
}
