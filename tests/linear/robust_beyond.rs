//! Robust settings with latency, dashpots, memory and lags against a walk of the argument that
//! shares nothing with the crate: many places of the box around each, and a grid of other settings.
//! `SLIPMAP_CASES` says how many problems, `SLIPMAP_PLACES` how many places, `SLIPMAP_GRID` how
//! many settings either way of the grid.

use slipmap::answers::best::{Ranges, RobustSetting, default_ranges, robust_setting};
use slipmap::answers::search_plane::SearchPlane;
use slipmap::linear::best::SearchedGain;
use slipmap::model::stop::Stop;
use slipmap::setting::{Parameter, Setting};

use crate::chance::{Chance, asked};
use crate::walk::Walk;

/// Places of each box, and settings either way of the grid.
const PLACES: u64 = 200;
const POINTS: u64 = 16;

/// A relative change of both gains, the delay and the slope.
type Changes = [f64; 3];

/// A block in its own units, what is searched and how far parameters may be off.
#[derive(Debug)]
struct Problem {
    numbers: Vec<(&'static str, f64)>,
    gain: SearchedGain,
    spread: f64,
}

impl Problem {
    /// One with latency and dashpots; every second one with memory, every third one with lags.
    fn by_chance(chance: &mut Chance, i: u64) -> Self {
        let mut numbers = vec![
            ("mass", chance.log(0.5, 2.0)),
            ("stiffness", chance.log(0.5, 2.0)),
            ("normal_load", chance.log(0.5, 2.0)),
            ("mu_k", chance.between(0.3, 1.0)),
            ("mu_prime", chance.between(-0.6, -0.05)),
            ("damping", chance.between(0.0, 0.4)),
            ("viscous", chance.between(0.0, 0.1)),
            ("latency", chance.log(0.02, 0.5)),
        ];
        if i % 2 == 1 {
            numbers.push(("memory", chance.between(-0.3, 0.7)));
        }
        if i % 3 == 2 {
            let lags = ["load_lag", "velocity_lag", "sensor_lag"];
            numbers.extend(lags.map(|lag| (lag, chance.log(0.02, 0.3))));
        }
        Self {
            numbers,
            gain: [SearchedGain::Load, SearchedGain::Velocity][chance.of(2)],
            spread: [0.02, 0.05, 0.1][chance.of(3)],
        }
    }

    fn searched(&self) -> &'static str {
        match self.gain {
            SearchedGain::Velocity => "alpha_v",
            SearchedGain::Load => "alpha_n",
        }
    }

    /// The setting without a gain, and the ranges that are searched.
    fn asked(&self) -> (Setting, Ranges) {
        let numbers = self.numbers.iter().copied();
        let setting = Setting::checked(numbers.chain([("tau", 1.0)]), None, &[]).unwrap();
        let searched = match self.gain {
            SearchedGain::Velocity => Parameter::AlphaV,
            SearchedGain::Load => Parameter::AlphaN,
        };
        let ranges = default_ranges(&setting, &SearchPlane::with_delay(searched)).unwrap();
        let q = (0.02 * ranges.q.1, 0.4 * ranges.q.1);
        (setting, Ranges { q, ..ranges })
    }

    fn of(&self, name: &str) -> f64 {
        let found = self.numbers.iter().find(|(given, _)| *given == name);
        found.map_or(0.0, |(_, value)| *value)
    }

    /// The equation of motion in physical units: with u the velocity, a the elongation and S the
    /// signal,
    ///
    /// ```text
    /// (M s + F + c_g + c) u = κ a + c v − μ n,   s a = v − u,   v = α_v S/L_v,   n = α_N S/L_a
    /// ```
    fn walk(&self, (gain, tau): (f64, f64), [k, delay, slope]: Changes) -> Walk {
        let gain_of = |name: &str| match name == self.searched() {
            true => gain * (1.0 + k),
            false => 0.0,
        };
        let friction = self.of("mu_prime") * (1.0 + slope) * self.of("normal_load");
        let still = friction + self.of("viscous");
        let own = vec![
            self.of("stiffness"),
            still + self.of("damping"),
            self.of("mass"),
        ];
        let lag = |name: &str| vec![1.0, self.of(name)];
        let lags = ["load_lag", "velocity_lag", "sensor_lag"].map(lag);
        let open = lags.iter().fold(own, |p, lag| times(&p, lag));
        let velocity = times(&[still, self.of("mass")], &lags[0]);
        let fed = plus(
            &scaled(&velocity, gain_of("alpha_v")),
            &scaled(&lags[1], gain_of("alpha_n") * self.of("mu_k")),
        );
        let (tau, latency) = (tau * (1.0 + delay), self.of("latency"));
        let mut terms = vec![
            (open.clone(), 0.0),
            (scaled(&fed, -1.0), latency),
            (fed, latency + tau),
        ];
        if self.of("memory") != 0.0 {
            terms.push((scaled(&open, -self.of("memory")), tau));
        }
        Walk { terms }
    }

    /// The number of roots right of `line`; none where the walk does not tell it.
    fn right_of(&self, place: (f64, f64), changes: Changes, line: f64) -> Option<u64> {
        // Roots accumulate at the real part at which |R e^(−sτ)| = 1.
        let kept = self.of("memory").abs() * (-line * place.1 * (1.0 + changes[1])).exp();
        match kept > 1.0 {
            true => Some(u64::MAX),
            false => self.walk(place, changes).right_of(line),
        }
    }
}

fn times(p: &[f64], q: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; p.len() + q.len() - 1];
    for (i, a) in p.iter().enumerate() {
        for (j, b) in q.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    while product.len() > 1 && product.last() == Some(&0.0) {
        product.pop();
    }
    product
}

fn scaled(p: &[f64], by: f64) -> Vec<f64> {
    p.iter().map(|c| by * c).collect()
}

fn plus(p: &[f64], q: &[f64]) -> Vec<f64> {
    let at = |p: &[f64], i: usize| p.get(i).copied().unwrap_or(0.0);
    let sums = (0..p.len().max(q.len())).map(|i| at(p, i) + at(q, i));
    sums.collect()
}

/// Corners and middles of a box, the former first.
fn corners(spread: f64) -> Vec<Changes> {
    let all = (0..27).map(|i| [i / 9, i / 3 % 3, i % 3].map(|n| f64::from(n) - 1.0));
    let mut all: Vec<Changes> = all.map(|changes| changes.map(|d| spread * d)).collect();
    all.sort_by_key(|changes| changes.iter().filter(|d| **d == 0.0).count());
    all
}

/// At every place of the box all roots decay as told. Returns how many of them were decided.
fn check_box(problem: &Problem, found: &RobustSetting, chance: &mut Chance) -> u64 {
    let (robust, spread) = (&found.robust, problem.spread);
    let line = robust.worst_abscissa + 1e-9 * (1.0 + robust.worst_abscissa.abs());
    let (mut decided, place) = (0, (robust.gain, robust.tau));
    let by_chance = (0..asked("SLIPMAP_PLACES", PLACES))
        .map(|_| [0; 3].map(|_| chance.between(-spread, spread)));
    for changes in by_chance.chain(corners(spread)).chain([robust.worst_at]) {
        let Some(right) = problem.right_of(place, changes, line) else {
            continue;
        };
        decided += 1;
        assert_eq!(right, 0, "{problem:?} {found:?} {changes:?}");
    }
    // And at the worst of them no faster than by another per cent.
    let right = problem.right_of(place, robust.worst_at, 1.02 * robust.worst_abscissa);
    assert_ne!(right, Some(0), "{problem:?} {found:?}");
    decided
}

/// No setting of a grid decays faster in all of its box by more than a per cent. Returns how many
/// of them were decided.
fn check_grid(problem: &Problem, ranges: &Ranges, found: Option<&RobustSetting>) -> u64 {
    let rate = (problem.of("stiffness") / problem.of("mass")).sqrt();
    let told = found.map_or(0.0, |found| found.robust.worst_abscissa);
    let line = 1.012 * told - 1e-4 * rate;
    let points = asked("SLIPMAP_GRID", POINTS);
    let along =
        |(from, to): (f64, f64), i: u64| from + (to - from) * i as f64 / (points - 1) as f64;
    let (mut decided, mut corners) = (0, corners(problem.spread));
    for i in 0..points * points {
        let place = (along(ranges.p, i / points), along(ranges.q, i % points));
        let right = |changes: &Changes| problem.right_of(place, *changes, line);
        if let Some(slower) = corners.iter().position(|changes| right(changes) > Some(0)) {
            decided += 1;
            // What told against this setting is asked first of the next one.
            corners[..=slower].rotate_right(1);
        } else {
            let undecided = corners.iter().any(|changes| right(changes).is_none());
            assert!(undecided, "{problem:?}: {place:?} is better than {found:?}");
        }
    }
    decided
}

#[test]
fn robust_settings_keep_what_they_promise_by_a_walk() {
    let mut chance = Chance(asked("SLIPMAP_SEED", 45));
    let cases = asked("SLIPMAP_CASES", 20);
    let (mut told, mut certified, mut decided, mut settings) = (0, 0, 0, 0);
    for i in 0..cases {
        let problem = Problem::by_chance(&mut chance, i);
        let (setting, ranges) = problem.asked();
        let stop = Stop::default();
        let found = robust_setting(&setting, problem.gain, &ranges, [problem.spread; 3], &stop);
        let found = found.unwrap().1;
        settings += check_grid(&problem, &ranges, found.as_ref());
        if let Some(found) = found {
            told += 1;
            certified += u64::from(found.robust.certified);
            decided += check_box(&problem, &found, &mut chance);
        }
    }
    println!(
        "{cases} problems: {told} robust, {certified} certified, {decided} places and {settings} \
         settings walked"
    );
    assert!(
        told * 2 >= cases && certified * 10 >= told * 9,
        "{told} {certified}"
    );
    let [places, points] =
        [("SLIPMAP_PLACES", PLACES), ("SLIPMAP_GRID", POINTS)].map(|(n, o)| asked(n, o));
    assert!(decided * 10 >= told * 9 * places, "{decided}");
    assert!(settings * 10 >= cases * 9 * points * points, "{settings}");
}
