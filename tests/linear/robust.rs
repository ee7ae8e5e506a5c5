//! `best --robust` against many places of its box, and against a grid of other settings.

use crate::program;
use slipmap::linear::best::{
    Best, Letter, Place, Rig, Robust, Search, SearchedGain, best, robust, worst_around,
};
use slipmap::linear::spectrum::RootFinder;
use slipmap::model::stop::Stop;
use slipmap::model::{Dashpots, Groups};

/// Problems of load and velocity control with slopes and spreads of their own, every third one with
/// dashpots; of some the delay is not off, nor the gain or hardly so.
fn problems(number: u32) -> impl Iterator<Item = (Search<Letter>, [f64; 3])> {
    (0..number).map(move |i| {
        let part = f64::from(i) / f64::from(number);
        let load = i % 2 == 0;
        let b = if load {
            -0.05 - 0.9 * part
        } else {
            -0.05 - 0.4 * part
        };
        let (gain, gains) = match load {
            true => (SearchedGain::Load, (-9.0, 1.0)),
            false => (SearchedGain::Velocity, (-1.0, 0.5)),
        };
        let search = Search {
            family: Letter {
                dashpots: match i % 3 {
                    1 => Dashpots {
                        damping: 0.1,
                        viscous: 0.04,
                    },
                    _ => Dashpots::default(),
                },
                fixed: Groups::new(b, 0.0, 0.0),
                gain,
            },
            p: gains,
            q: (0.05, 10.0),
        };
        let parts = match i % 5 {
            3 => [0.0, 0.0, 2.0],
            4 => [0.3, 0.0, 2.0],
            _ => [1.0; 3],
        };
        (
            search,
            parts.map(|part| part * [0.02, 0.05, 0.1][i as usize % 3]),
        )
    })
}

struct Abscissas(RootFinder);

impl Abscissas {
    fn at(&mut self, search: &Search<Letter>, (gain, tau): (f64, f64), changes: [f64; 3]) -> f64 {
        let [k, delay, slope] = changes.map(|d| 1.0 + d);
        let Groups { b, a_v, a_n } = search.family.groups(gain);
        let still = search.family.dashpots.sum();
        let groups = Groups::new((b - still) * slope + still, a_v * k, a_n * k);
        let roots = self.0.rightmost(groups, tau * delay, 1, f64::NEG_INFINITY);
        roots.unwrap()[0].lambda.re
    }

    /// The largest on a grid of a box, once above `bound` anything above that.
    fn worst(
        &mut self,
        search: &Search<Letter>,
        place: (f64, f64),
        spread: [f64; 3],
        bound: f64,
    ) -> f64 {
        let mut worst = f64::NEG_INFINITY;
        for i in 0..27 {
            let corner = [i / 9, i / 3 % 3, i % 3].map(|n| f64::from(n) - 1.0);
            let changes = std::array::from_fn(|i| spread[i] * corner[i]);
            worst = worst.max(self.at(search, place, changes));
            if worst > bound {
                break;
            }
        }
        worst
    }
}

/// Places all over a box, by an additive recurrence.
fn places(number: u32, spread: [f64; 3]) -> impl Iterator<Item = [f64; 3]> {
    const STEPS: [f64; 3] = [
        0.819_172_513_396_164_5,
        0.671_043_606_703_789_3,
        0.549_700_477_901_970_2,
    ];
    (0..number).map(move |i| {
        let part = |step: f64| 2.0 * (0.5 + f64::from(i) * step).fract() - 1.0;
        std::array::from_fn(|n| spread[n] * part(STEPS[n]))
    })
}

fn check_box(search: &Search<Letter>, spread: [f64; 3], found: &Robust) {
    let mut abscissas = Abscissas(RootFinder::default());
    let place = (found.gain, found.tau);
    let at = |abscissas: &mut Abscissas, changes| abscissas.at(search, place, changes);
    assert!(found.certified, "{search:?} {found:?}");
    let mut largest = at(&mut abscissas, found.worst_at);
    for changes in places(10_000, spread) {
        let abscissa = at(&mut abscissas, changes);
        assert!(
            abscissa <= found.worst_abscissa,
            "{search:?} {found:?} {changes:?} {abscissa}"
        );
        largest = largest.max(abscissa);
    }
    // And it is no more than a per cent above what is there.
    assert!(
        largest <= 0.989 * found.worst_abscissa,
        "{search:?} {found:?} {largest}"
    );
}

/// No setting of a grid of 40 × 40 is better.
fn check_grid(search: &Search<Letter>, spread: [f64; 3], found: Option<&Robust>) {
    let mut abscissas = Abscissas(RootFinder::default());
    let lowest = found.map_or(0.0, |f| f.worst_abscissa);
    let along = |(from, to): (f64, f64), i: u32| from + (to - from) * f64::from(i) / 39.0;
    for i in 0..40 {
        for j in 0..40 {
            let place = (along(search.p, i), along(search.q, j));
            if abscissas.at(search, place, [0.0; 3]) >= lowest {
                continue;
            }
            let worst = abscissas.worst(search, place, spread, lowest);
            assert!(
                worst >= lowest,
                "{search:?} {spread:?} {place:?}: {worst} {found:?}"
            );
        }
    }
}

#[test]
fn robust_settings_keep_what_they_promise() {
    let mut found_any = 0;
    for (search, spread) in problems(50) {
        let stop = Stop::default();
        let regions: Best = best(&search, &stop);
        let rigs = Search {
            family: Rig::from(search.family),
            p: search.p,
            q: search.q,
        };
        let found = robust(&rigs, &regions, spread, &stop);
        check_grid(&search, spread, found.as_ref());
        let Some(found) = found else { continue };
        found_any += 1;
        check_box(&search, spread, &found);
        // Never worse than the setting of fastest decay within the same spread.
        let overall = Place {
            p: regions.overall.p,
            q: regions.overall.q,
        };
        let (worst, _) = worst_around(&rigs, overall, spread, &stop);
        assert!(
            found.worst_abscissa <= worst + 0.01 * worst.abs(),
            "{found:?} {worst}"
        );
    }
    assert!(found_any >= 25, "{found_any}");
}

#[test]
fn the_program_recommends_robust_settings() {
    let folder = program::Folder::new();
    let args = [
        "best",
        "--mu-prime",
        "-0.3",
        "--control",
        "load",
        "--robust",
        "0.05",
    ];
    let json = program::json(&folder.run(&[&args[..], &["--json"]].concat()));
    let number = |path: &str| json.pointer(path).unwrap().as_f64().unwrap();
    // The setting of fastest decay loses more than half of it within 5 %, in silence.
    assert!(number("/robust/worst_abscissa_of_best") > 0.5 * number("/best/abscissa"));
    assert!(number("/robust/worst_abscissa") < 1.08 * number("/robust/worst_abscissa_of_best"));
    assert!(number("/margins/stability_radius") > 0.4);
    // With memory, latency and lags too; without a gain of the setting itself.
    let late =
        "best --mu-prime=-0.3 --latency 0.1 --memory 0.3 --sensor-lag 0.1 --robust 0.05 --json";
    let late: Vec<&str> = late.split(' ').collect();
    let late = program::json(&folder.run(&late));
    assert_eq!(late["robust"]["certified"], true, "{late}");
    let worst = late["robust"]["worst_abscissa"].as_f64().unwrap();
    assert!(worst < late["robust"]["worst_abscissa_of_best"].as_f64().unwrap());
    for (spread, says) in [
        ("0", "a part"),
        ("nan", "a part"),
        ("1", "a part"),
        ("-0.1", "a part"),
    ] {
        let args = ["best", "--mu-prime", "-0.3", "--robust", spread];
        program::expect(&folder.run(&args), 2, says);
    }
    let none = ["best", "--mu-prime", "-0.72", "--robust", "0.2"];
    let told = program::out(&folder.run(&none));
    assert!(
        told.contains("\nno setting found in the ranges stays stable"),
        "{told}"
    );
}

/// What `run` tells of a plane is what `best` finds at its slope.
#[test]
fn a_run_tells_the_best_setting_of_every_plane() {
    let sweep = "best = true\n[axes]\nmu_prime = [-0.3, -0.1]\n\
                 alpha_n = { from = -6, to = 2, points = 9 }\n\
                 tau = { from = 0, to = 2, points = 9 }\n";
    let folder = program::Folder::with(&[("sweep.toml", sweep)]);
    let told = program::err(&folder.run(&["run", "sweep.toml"]));
    for slope in ["-0.3", "-0.1"] {
        let found = program::out(&folder.run(&[
            "best",
            "--mu-prime",
            slope,
            "--control",
            "load",
            "--alpha-from",
            "-6",
            "--alpha-to",
            "2",
            "--tau-from",
            "0",
            "--tau-to",
            "2",
        ]));
        let of = |name: &str| {
            let line = found
                .lines()
                .find(|line| line.trim_start().starts_with(name))
                .unwrap();
            line.split_whitespace().nth(1).unwrap().to_owned()
        };
        let line = format!(
            "best setting at mu_prime = {slope}: alpha_n = {}, tau = {}: relaxation time",
            of("alpha_n"),
            of("tau")
        );
        assert!(told.contains(&line), "{line}\n{told}");
    }
    let quiet = folder.run(&["run", "sweep.toml", "--fresh", "--quiet"]);
    assert_eq!(program::err(&quiet), "");
}
