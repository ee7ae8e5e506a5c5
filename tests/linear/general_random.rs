//! Random systems with one delay: the crossings of the whole line against the argument principle in
//! closed form at single delays, with the degrees, the signs and the sizes of the coefficients drawn
//! by chance. `SLIPMAP_CASES` says how many.

use crate::chance::{Chance, asked};
use crate::letter_system::letter;
use crate::walk::Walk;
use slipmap::linear::general::{DelayLine, Reason, RightOf, RootCounter, Spectrum, System};
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::Groups;

fn cases(usual: usize) -> usize {
    asked("SLIPMAP_CASES", usual as u64) as usize
}

/// A polynomial of a degree from random zeros, all left of `rightmost` or not, times `leading`.
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
        let size = chance.log(0.1, 10.0);
        if left >= 2 && chance.between(0.0, 1.0) < 0.7 {
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

/// A system of degree 1 to 8, a third of them neutral, and a delay.
fn system(chance: &mut Chance) -> (System, f64, String) {
    let (p, q, tau) = pair(chance);
    let text = format!("{p:?} {q:?} {tau}");
    let system = System::of_coefficients(&p, &q).expect("a small degree");
    (system, tau, text)
}

/// P, Q and a delay, as [`system`] has them.
fn pair(chance: &mut Chance) -> (Vec<f64>, Vec<f64>, f64) {
    let n = 1 + (chance.between(0.0, 8.0) as usize).min(7);
    let neutral = chance.between(0.0, 1.0) < 1.0 / 3.0;
    let m = if neutral {
        n
    } else {
        (chance.between(0.0, n as f64) as usize).min(n - 1)
    };
    let leading = if chance.between(0.0, 1.0) < 0.5 {
        1.0
    } else {
        chance.between(-3.0, 3.0)
    };
    let p = from_zeros(chance, n, leading);
    let ratio = if neutral {
        chance.between(-0.98, 0.98)
    } else {
        chance.log(0.03, 10.0) * chance.between(-1.0, 1.0)
    };
    let q = from_zeros(chance, m, leading * ratio);
    let tau = chance.log(0.03, 50.0);
    (p, q, tau)
}

#[test]
fn both_counts_agree() {
    let cases = cases(20_000);
    let mut chance = Chance(asked("SLIPMAP_SEED", 20));
    let (mut undecided, mut marginal, mut unstable) = (0, 0, 0);
    for _ in 0..cases {
        let (system, tau, text) = system(&mut chance);
        let count = DelayLine::of(&system).count(tau, MarginalTolerance::default());
        let counter = RootCounter::new(&system);
        match (counter.right_of(tau, 0.0), count.marginal) {
            (RightOf::Roots(n), false) => {
                assert_eq!(n, count.n_unstable, "{text}");
                unstable += usize::from(n > 0);
            }
            (RightOf::Undecided, _) => undecided += 1,
            (RightOf::Roots(_), true) => marginal += 1,
            (RightOf::Infinite, _) => panic!("{text}"),
        }
        // What one line cannot tell is told by what it says of all delays.
        let on_line = counter.unstable().and_then(|u| u.at(tau));
        if let Some(n) = on_line {
            assert!(count.marginal || n == count.n_unstable, "{text}");
        }
    }
    println!("{cases} systems: {unstable} unstable, {undecided} undecided, {marginal} marginal");
    assert!(
        undecided + marginal <= cases / 1000,
        "{undecided} undecided, {marginal} marginal"
    );
    assert!(unstable > cases / 10 && unstable < cases * 9 / 10);
}

/// Right of the axis and of other lines, against a walk that shares nothing with the crate.
#[test]
fn counts_are_what_a_walk_counts() {
    let cases = cases(20_000) / 20;
    let mut chance = Chance(asked("SLIPMAP_SEED", 23));
    let (mut walked, mut undecided) = (0, 0);
    for _ in 0..cases {
        let (p, q, tau) = pair(&mut chance);
        let system = System::of_coefficients(&p, &q).expect("a small degree");
        let counter = RootCounter::new(&system);
        let count = DelayLine::of(&system).count(tau, MarginalTolerance::default());
        let walk = Walk {
            terms: vec![(p, 0.0), (q, tau)],
        };
        for line in [0.0, chance.between(-0.4, 0.6)] {
            let Some(expected) = walk.right_of(line) else {
                continue;
            };
            walked += 1;
            match counter.right_of(tau, line) {
                RightOf::Roots(n) => assert_eq!(n, expected, "{walk:?} {line}"),
                _ => undecided += 1,
            }
            if line == 0.0 && !count.marginal {
                assert_eq!(count.n_unstable, expected, "{walk:?}");
            }
        }
    }
    println!(
        "{walked} lines walked of {}, {undecided} undecided",
        2 * cases
    );
    assert!(
        walked > cases && undecided <= walked / 500 + 1,
        "{walked} {undecided}"
    );
}

/// Without damping P and Q have zeros on the axis itself, which turn by half a turn exactly.
#[test]
fn counts_without_damping_are_what_a_walk_counts() {
    let mut chance = Chance(asked("SLIPMAP_SEED", 24));
    let (mut walked, mut undecided) = (0, 0);
    for _ in 0..cases(20_000) / 20 {
        // Products of s² + ω², some of them with a stable real zero.
        let mut even = |factors: usize, leading: f64| {
            let mut p = vec![leading];
            for _ in 0..factors {
                let square = chance.log(0.1, 4.0);
                let mut next = vec![0.0; p.len() + 2];
                for (k, c) in p.iter().enumerate() {
                    next[k] += square * c;
                    next[k + 2] += c;
                }
                p = next;
            }
            p
        };
        let p = even(1 + (walked % 3) as usize, 1.0);
        let mut q = even((walked % 2) as usize, 1.0);
        let ratio = chance.between(-0.9, 0.9);
        for c in &mut q {
            *c *= ratio;
        }
        let tau = chance.log(0.1, 20.0);
        let system = System::of_coefficients(&p, &q).expect("a small degree");
        let counter = RootCounter::new(&system);
        let count = DelayLine::of(&system).count(tau, MarginalTolerance::default());
        let walk = Walk {
            terms: vec![(p, 0.0), (q, tau)],
        };
        let Some(expected) = walk.right_of(0.0) else {
            continue;
        };
        walked += 1;
        match counter.right_of(tau, 0.0) {
            RightOf::Roots(n) => assert_eq!(n, expected, "{walk:?}"),
            _ => undecided += 1,
        }
        if !count.marginal {
            assert_eq!(count.n_unstable, expected, "{walk:?}");
        }
    }
    println!("{walked} walked, {undecided} undecided");
    assert!(
        walked > 300 && undecided <= walked / 20,
        "{walked} {undecided}"
    );
}

/// Beside a root: the count changes by one root or one pair, or says that it does not know.
#[test]
fn lines_beside_a_root() {
    let cases = cases(20_000) / 20;
    let mut chance = Chance(asked("SLIPMAP_SEED", 21));
    let (mut decided, mut open) = ([0; 10], [0; 10]);
    let (mut missing, mut accumulating) = (0, 0);
    for _ in 0..cases {
        let (system, tau, text) = system(&mut chance);
        let counter = RootCounter::new(&system);
        let found = Spectrum::at(&counter, &DelayLine::of(&system), tau, 1);
        if found.reason == Some(Reason::NoRightmostRoot) {
            accumulating += 1;
            continue;
        }
        let Some(root) = found.roots.first().filter(|_| found.certified) else {
            missing += 1;
            if std::env::var_os("SHOW").is_some() {
                println!("{text}\n  Right {found:?}");
            }
            continue;
        };
        let unit = root.lambda.re.abs().max(1.0);
        for (i, power) in (6..16).enumerate() {
            let beside = 10.0_f64.powi(-power) * unit;
            if beside < 4.0 * root.error {
                continue;
            }
            for (line, expected) in [
                (root.lambda.re + beside, 0),
                (root.lambda.re - beside, root.count()),
            ] {
                match counter.right_of(tau, line) {
                    RightOf::Roots(n) => {
                        // Another root may lie just left of it.
                        let more = line < root.lambda.re && n > expected;
                        assert!(n == expected || more, "{text}\n{root:?} {line} {n}");
                        decided[i] += 1;
                    }
                    _ => open[i] += 1,
                }
            }
        }
    }
    println!(
        "{cases} systems, {missing} not found, {accumulating} without; decided {decided:?}, open {open:?}"
    );
    assert!(missing <= cases / 100, "{missing}");
}

/// D → −4D, λ → 2λ and a stable factor in common leave every count as it is.
#[test]
fn counts_do_not_depend_on_how_a_system_is_written() {
    let mut chance = Chance(asked("SLIPMAP_SEED", 22));
    for _ in 0..cases(20_000) / 20 {
        let n = 1 + (chance.between(0.0, 6.0) as usize).min(5);
        let p = from_zeros(&mut chance, n, 1.0);
        let leading = chance.between(-2.0, 2.0);
        let q = from_zeros(&mut chance, n - 1, leading);
        let tau = chance.log(0.1, 20.0);
        let count = |p: &[f64], q: &[f64], tau: f64| {
            let system = System::of_coefficients(p, q).expect("a small degree");
            let count = DelayLine::of(&system).count(tau, MarginalTolerance::default());
            (!count.marginal).then_some(count.n_unstable)
        };
        let Some(expected) = count(&p, &q, tau) else {
            continue;
        };
        let scaled = |c: &[f64]| c.iter().map(|c| -4.0 * c).collect::<Vec<_>>();
        let faster = |c: &[f64]| {
            let power = |k: usize| 2.0_f64.powi(-(k as i32));
            c.iter()
                .enumerate()
                .map(|(k, c)| c * power(k))
                .collect::<Vec<_>>()
        };
        let factor = |c: &[f64], lag: f64| {
            let mut product = vec![0.0; c.len() + 1];
            for (k, c) in c.iter().enumerate() {
                product[k] += c;
                product[k + 1] += lag * c;
            }
            product
        };
        for (p, q, tau) in [
            (scaled(&p), scaled(&q), tau),
            (faster(&p), faster(&q), 0.5 * tau),
            (factor(&p, 0.7), factor(&q, 0.7), tau),
            (factor(&p, 1e-10), factor(&q, 1e-10), tau),
            // A lag of the feedback alone, too short to matter.
            (factor(&p, 1e-10), q.clone(), tau),
        ] {
            if let Some(found) = count(&p, &q, tau) {
                assert_eq!(found, expected, "{p:?} {q:?} {tau}");
            }
        }
    }
}

/// The letter as a general system: the same counts, and marginal cells that are the same or lie
/// where one of both ways knows the crossing delay less well.
#[test]
fn the_letter_by_both_ways() {
    let mut chance = Chance(20_261_124);
    let (mut line, tolerance) = (DelayLine::default(), MarginalTolerance::default());
    let total = cases(20_000);
    let (mut marginal, mut of_letter_alone, mut of_other_alone) = (0, 0, 0);
    for number in 0..total {
        let b = chance.between(-1.5, 0.7);
        let gains = [
            [chance.between(-2.0, 1.0), 0.0],
            [0.0, chance.between(-8.0, 3.0)],
            [chance.between(-2.0, 1.0), chance.between(-8.0, 3.0)],
        ];
        let [a_v, a_n] = gains[number % 3];
        let groups = Groups::new(b, a_v, a_n);
        let crossings = Crossings::of(groups);
        let tau = chance.log(1e-3, 100.0);
        // Every tenth delay lies on a crossing, to the last digits.
        let tau = match crossings.iter().next().filter(|_| number % 10 == 0) {
            Some(first) => {
                first.delay(first.first_branch) * (1.0 + 1e-15 * chance.below(40) as f64)
            }
            None => tau,
        };
        line.find(&letter(groups, 0.0, 0.0));
        let (one, other) = (crossings.count(tau, tolerance), line.count(tau, tolerance));
        let place = format!("{groups:?} {tau}: {one:?} {other:?}");
        assert_eq!(line.reason, None, "{place}");
        if one.marginal || other.marginal {
            let near = |at: f64| (at - tau).abs() <= 1e-11 * tau.max(1.0);
            let mut delays = crossings.iter().flat_map(|c| {
                let nearest = ((tau - c.delay(0)) / c.period()).round().max(0.0);
                [nearest, nearest + 1.0].map(|k| c.delay(k as u64))
            });
            assert!(delays.any(near), "{place}");
            marginal += 1;
            of_letter_alone += u32::from(!other.marginal);
            of_other_alone += usize::from(!one.marginal);
        } else {
            assert_eq!(one.n_unstable, other.n_unstable, "{place}");
        }
    }
    println!(
        "{total} cells, {marginal} marginal: {of_letter_alone} by the closed form alone, \
         {of_other_alone} by the other way alone"
    );
    // What the closed form of the quadratic knows is known better.
    assert_eq!(of_letter_alone, 0);
    assert!(of_other_alone * 10 <= total, "{of_other_alone}");
}
