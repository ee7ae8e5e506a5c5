//! Lightly damped chains of masses with delayed feedback, degree 6 to 32, in any unit of time:
//! counts, crossings and abscissae against numbers found with many digits (`reference/chains.csv`
//! and those given here) and against a walk along the argument of D, taken from the recursion over
//! the masses. `SLIPMAP_CASES` says how many.

use crate::chain::Chain;
use crate::chance::{Chance, asked};
use crate::walk;
use slipmap::linear::MarginalTolerance;
use slipmap::linear::general::{DelayLine, RightOf, RootCounter, Spectrum, System};
use slipmap::linear::row::Delays;
use slipmap::linear::status::MARGINAL;

const SIX: Chain = Chain {
    masses: 6,
    spring: 1.0,
    damper: 0.002,
    gain: 0.05,
    rate_gain: 0.01,
    tau: 1.1,
};
const SEVEN: Chain = Chain {
    masses: 7,
    spring: 1.0,
    damper: 0.02,
    gain: 1.0,
    rate_gain: 0.2,
    tau: 1.1,
};

fn spectrum(system: &System, tau: f64) -> Spectrum {
    Spectrum::at(&RootCounter::new(system), &DelayLine::of(system), tau, 1)
}

/// The count at a delay, which must not be marginal.
fn count(system: &System, tau: f64) -> u64 {
    let count = DelayLine::of(system).count(tau, MarginalTolerance::default());
    assert!(!count.marginal, "{tau}: {count:?}");
    let right = RootCounter::new(system).right_of(tau, 0.0);
    assert_eq!(right, RightOf::Roots(count.n_unstable), "{tau}");
    count.n_unstable
}

#[test]
fn counts_and_crossings_known_with_many_digits() {
    assert_eq!(count(&SIX.system(), SIX.tau), 8);
    assert_eq!(count(&SEVEN.system(), SEVEN.tau), 10);
    let line = DelayLine::of(&SEVEN.system());
    for (omega, delay) in [(1.6572, 0.4283), (1.6068, 1.1308)] {
        let crossing = line
            .crossings
            .iter()
            .find(|c| (c.omega - omega).abs() < 5e-5)
            .expect("a crossing");
        let first = crossing.delay(crossing.first_branch);
        assert!((first - delay).abs() < 5e-5, "{crossing:?}");
        assert!(crossing.delay_error(first) < 1e-8, "{crossing:?}");
    }
}

/// Only cells next to a crossing are marginal, not a whole line.
#[test]
fn marginal_cells_are_next_to_a_crossing() {
    for chain in [SIX, SEVEN] {
        let line = DelayLine::of(&chain.system());
        let delays: Vec<f64> = (0..20_000).map(|i| 1e-3 * f64::from(i)).collect();
        let (mut counts, mut status) = (vec![0; delays.len()], vec![0; delays.len()]);
        let delays = Delays::new(&delays);
        line.fill_counts(
            &delays,
            MarginalTolerance::default(),
            &mut counts,
            &mut status,
        );
        let marginal = status.iter().filter(|s| **s & MARGINAL != 0).count();
        assert_eq!(marginal, 0, "{chain:?}");
    }
}

#[test]
fn the_abscissa_does_not_depend_on_the_unit_of_time() {
    for unit in [1.0, 1e3, 1e-3, 2.5e7, 1e-9] {
        let chain = Chain { tau: 0.4, ..SIX }.in_unit(unit);
        let found = spectrum(&chain.system(), chain.tau);
        let expected = 0.001_332_733_047_993_175_4 * unit;
        assert!(found.certified, "{unit}: {found:?}");
        let error = (found.abscissa - expected).abs();
        assert!(error < 1e-11 * expected, "{unit}: {error} {found:?}");
    }
}

#[test]
fn chains_whose_rightmost_roots_are_known_with_many_digits() {
    let table = include_str!("../reference/chains.csv");
    for row in table.lines().skip(1) {
        let numbers: Vec<f64> = row
            .split(',')
            .map(|n| n.parse().expect("a number"))
            .collect();
        let chain = Chain {
            masses: numbers[0] as usize,
            spring: numbers[1],
            damper: numbers[2],
            gain: numbers[3],
            rate_gain: numbers[4],
            tau: numbers[5],
        };
        let system = chain.system();
        assert_eq!(count(&system, chain.tau), numbers[6] as u64, "{row}");
        let found = spectrum(&system, chain.tau);
        assert!(found.certified, "{row}: {found:?}");
        let error = (found.abscissa - numbers[7]).abs();
        assert!(
            error < 1e-9 * chain.spring.sqrt(),
            "{row}: {error} {found:?}"
        );
    }
}

/// A chain with a spring of 1.
fn by_chance(chance: &mut Chance) -> Chain {
    let sign = |chance: &mut Chance| if chance.unit() < 0.3 { -1.0 } else { 1.0 };
    Chain {
        masses: 3 + chance.of(6),
        spring: 1.0,
        damper: chance.log(1e-3, 0.1),
        gain: sign(chance) * chance.log(0.003, 1.5),
        rate_gain: sign(chance) * chance.log(0.001, 0.5),
        tau: chance.log(0.05, 10.0),
    }
}

/// Beside the axis by so much the same number of roots: no crossing is near.
const BESIDE: f64 = 1e-9;

#[test]
fn chains_by_chance_are_what_a_walk_says() {
    let cases = asked("SLIPMAP_CASES", 100);
    let mut chance = Chance(asked("SLIPMAP_SEED", 61));
    let (mut walked, mut certified) = (0, 0);
    for _ in 0..cases {
        let chain = by_chance(&mut chance);
        let unit = chance.log(1e-9, 1e9);
        let scaled = chain.in_unit(unit);
        let system = scaled.system();
        let counter = RootCounter::new(&system);
        let place = format!("{chain:?} {unit}");
        let count = DelayLine::of(&system).count(scaled.tau, MarginalTolerance::default());
        let beside = [-BESIDE, BESIDE].map(|line| chain.right_of(line));
        if let (Some(n), true) = (beside[0], beside[0] == beside[1]) {
            walked += 1;
            assert_eq!(count.n_unstable, n, "{place}");
            assert!(!count.marginal, "{place}");
            assert_eq!(
                counter.right_of(scaled.tau, 0.0),
                RightOf::Roots(n),
                "{place}"
            );
        }
        let line = chance.between(-0.05, 0.05);
        if let (Some(n), RightOf::Roots(found)) = (
            chain.right_of(line),
            counter.right_of(scaled.tau, line * unit),
        ) {
            assert_eq!(found, n, "{place} {line}");
        }
        let found = Spectrum::at(&counter, &DelayLine::of(&system), scaled.tau, 1);
        if !found.certified {
            if std::env::var_os("SHOW").is_some() {
                println!("{place} {count:?} {found:?}");
            }
            continue;
        }
        certified += 1;
        let abscissa = found.abscissa / unit;
        for (side, none) in [(1e-8, true), (-1e-8, false)] {
            if let Some(n) = chain.right_of(abscissa + side) {
                assert_eq!(n == 0, none, "{place} {abscissa}: {n}");
            }
        }
    }
    println!("{cases} chains: {walked} walked, {certified} certified");
    assert!(walked >= cases * 19 / 20, "{walked} of {cases}");
    assert!(certified >= cases * 19 / 20, "{certified} of {cases}");
}

/// Nine to sixteen masses, degree 18 to 32, whose coefficients are sums and products of f64.
#[test]
fn chains_of_degree_18_to_32_are_right_or_undecided() {
    let cases = asked("SLIPMAP_CASES", 100).div_ceil(2);
    let mut chance = Chance(asked("SLIPMAP_SEED", 63));
    let (mut walked, mut undecided) = (0, 0);
    for _ in 0..cases {
        let chain = Chain {
            masses: 9 + chance.of(8),
            damper: chance.log(0.01, 0.5),
            ..by_chance(&mut chance)
        };
        let unit = chance.log(1e-3, 1e3);
        let scaled = chain.in_unit(unit);
        let system = scaled.system();
        let place = format!("{chain:?} {unit}");
        let Some(n) = chain.right_of(0.0) else {
            continue;
        };
        walked += 1;
        let count = DelayLine::of(&system).count(scaled.tau, MarginalTolerance::default());
        undecided += u32::from(count.marginal);
        assert!(
            count.marginal || count.n_unstable == n,
            "{place}: {n} {count:?}"
        );
        let right = RootCounter::new(&system).right_of(scaled.tau, 0.0);
        let told = [RightOf::Roots(n), RightOf::Undecided];
        assert!(told.contains(&right), "{place}: {n} {right:?}");
    }
    println!("{cases} chains, {walked} walked, {undecided} undecided");
    assert!(walked >= cases * 9 / 10, "{walked} of {cases}");
    assert!(
        20 * u64::from(undecided) <= cases.max(20),
        "{undecided} of {cases}"
    );
}

/// On both sides of a crossing delay, so near that a wrong delay is noticed.
#[test]
fn crossings_by_chance_are_where_a_walk_says() {
    // Up to degree 8 a delay is known to 1e-6 or so, beyond that much better.
    const NEAR: [f64; 4] = [-1e-4, -1e-7, 1e-7, 1e-4];
    let cases = asked("SLIPMAP_CASES", 100);
    let mut chance = Chance(asked("SLIPMAP_SEED", 62));
    let mut walked = 0;
    for _ in 0..cases {
        let chain = by_chance(&mut chance);
        let unit = chance.log(1e-9, 1e9);
        let line = DelayLine::of(&chain.in_unit(unit).system());
        if line.crossings.is_empty() {
            continue;
        }
        let crossing = &line.crossings[chance.of(line.crossings.len())];
        let delay = crossing.delay(crossing.first_branch + chance.below(3)) * unit;
        for near in NEAR {
            let tau = delay * (1.0 + near);
            let Some(n) = (Chain { tau, ..chain }).right_of(0.0) else {
                continue;
            };
            walked += 1;
            let count = line.count(tau / unit, MarginalTolerance::default());
            let place = format!("{chain:?} {unit} {tau}");
            assert!(count.marginal || count.n_unstable == n, "{place} {n}");
            let near_enough = near.abs() < 1e-6 && chain.masses <= 4;
            assert!(!count.marginal || near_enough, "{place}");
        }
    }
    println!("{walked} walked");
    assert!(walked >= cases, "{walked}");
}

/// A root of multiplicity four, taken apart by the rounding of the coefficients: the numbers are
/// those of the coefficients as they stand, with 30 digits.
#[test]
fn the_abscissa_of_a_root_of_multiplicity_four() {
    let p = [3.0, -2.0, 1.0];
    let q = [-2.943_035_529_371_538_7, -0.735_758_882_342_884_7];
    let system = System::of_coefficients(&p, &q).expect("a small degree");
    let found = spectrum(&system, 1.0);
    assert!(
        (found.abscissa - -0.999_777_921_145_054_2).abs() < 1e-8,
        "{found:?}"
    );
    assert!(found.margin < 0.1, "{found:?}");
}

/// P and Q of degrees n and m whose D has a root of multiplicity n + m + 1 at `mu`: from Padé's
/// approximant of e^(−x), x = τ(s − μ).
fn of_high_multiplicity([n, m]: [usize; 2], mu: f64, tau: f64) -> [Vec<f64>; 2] {
    let factorial = |k: usize| (1..=k).map(|i| i as f64).product::<f64>();
    let term = |j: usize, own: usize| {
        factorial(n + m - j) * factorial(own)
            / (factorial(n + m) * factorial(j) * factorial(own - j))
    };
    // A polynomial in x by Horner's scheme as one in s.
    let in_s = |c: Vec<f64>| {
        let mut sum = vec![0.0; c.len()];
        for &c in c.iter().rev() {
            for k in (1..sum.len()).rev() {
                sum[k] = tau * (sum[k - 1] - mu * sum[k]);
            }
            sum[0] = -tau * mu * sum[0] + c;
        }
        sum
    };
    let sign = |j: usize| if j.is_multiple_of(2) { -1.0 } else { 1.0 };
    let p = in_s((0..=n).map(|j| sign(j) * term(j, n)).collect());
    let late = (mu * tau).exp();
    let q = in_s((0..=m).map(|j| late * term(j, m)).collect());
    [p, q]
}

#[test]
fn roots_of_multiplicity_four_to_seven_are_found_or_told() {
    let mut certified = 0;
    for degrees in [[2, 1], [3, 1], [3, 2], [4, 2]] {
        let multiplicity = degrees[0] + degrees[1] + 1;
        for (mu, tau) in [
            (-1.0, 1.0),
            (-0.3, 2.0),
            (0.2, 0.7),
            (-2.5, 0.4),
            (0.4, 1.3),
        ] {
            let [p, q] = of_high_multiplicity(degrees, mu, tau);
            let system = System::of_coefficients(&p, &q).expect("a small degree");
            let place = format!("{multiplicity} {mu} {tau}");
            let walk = walk::Walk {
                terms: vec![(p, 0.0), (q, tau)],
            };
            // Rounding takes the root apart to about ε^(1/m).
            let apart = 6.0 * f64::EPSILON.powf(1.0 / multiplicity as f64) / tau;
            if let Some(n) = walk.right_of(mu + apart) {
                assert_eq!(n, 0, "{place}");
            }
            let found = spectrum(&system, tau);
            if found.abscissa.is_nan() {
                let told = !found.certified && found.missing.is_some();
                assert!(told && multiplicity > 4, "{place}: {found:?}");
                continue;
            }
            certified += u32::from(found.certified);
            assert!((found.abscissa - mu).abs() < apart, "{place}: {found:?}");
        }
    }
    println!("{certified} certified");
    assert!(certified >= 8, "{certified}");
}
