//! Roots, tracking and certificate against independent methods and reference values.

use crate::cases::cases;
use crate::winding;
use num_complex::Complex64;
use proptest::prelude::*;
use slipmap::linear::certificate::{UnstableCount, roots_right_of};
use slipmap::linear::rightmost::Rightmost;
use slipmap::linear::row::Delays;
use slipmap::linear::spectrum::RootFinder;
use slipmap::linear::status::{CERTIFIED, DISAGREE, MARGINAL, NOT_CONVERGED};
use slipmap::linear::track::{BLOCK, MARGIN, RootTracker};
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::{FrictionLaw, Groups, Table};

/// What the tracker tells of a line: all roots of each cell, its margin and its status.
#[derive(Debug)]
struct Line {
    roots: Vec<Vec<Complex64>>,
    margins: Vec<f64>,
    status: Vec<u8>,
    reseeded: u64,
}

fn follow(groups: Groups, delays: &[f64], first: usize, wanted: usize) -> Line {
    let (mut counts, mut status) = (vec![0; delays.len()], vec![0; delays.len()]);
    Crossings::of(groups).fill_counts(
        &Delays::new(delays),
        MarginalTolerance::default(),
        &mut counts,
        &mut status,
    );
    let mut tracker = RootTracker::new(wanted);
    let (mut roots, mut margins) = (Vec::new(), Vec::new());
    tracker.follow(
        groups,
        (delays, 1.0),
        first,
        &counts,
        &mut status,
        |i, cell| {
            assert_eq!(i, roots.len());
            roots.push(cell.roots.iter().map(|r| r.lambda).collect());
            margins.push(cell.margin);
        },
    );
    Line {
        roots,
        margins,
        status,
        reseeded: tracker.work.reseeded,
    }
}

fn even(from: f64, to: f64, points: usize) -> Vec<f64> {
    (0..points)
        .map(|i| from + (to - from) * i as f64 / (points - 1) as f64)
        .collect()
}

/// A stream of numbers in [0, 1), the same every time.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Every row of the table, as its own cell and at the end of a line that comes from afar.
#[test]
fn reference_rows_to_eleven_digits() {
    let table = include_str!("../reference/linear_points.csv");
    for row in table.lines().skip(1) {
        let v: Vec<f64> = row.split(',').map(|x| x.parse().unwrap()).collect();
        let groups = Groups::new(v[0], v[1], v[2]);
        for delays in [
            vec![v[3]],
            even(0.01 * v[3], v[3], 700),
            even(0.0, v[3], 12),
        ] {
            let line = follow(groups, &delays, 0, 1);
            let rightmost = line.roots.last().unwrap()[0];
            assert!((rightmost.re - v[5]).abs() < 1e-11, "{row}: {rightmost}");
            assert!(
                (rightmost.im - v[6].abs()).abs() < 1e-11,
                "{row}: {rightmost}"
            );
            assert!(line.status.iter().all(|&s| s == CERTIFIED), "{row}");
        }
    }
    assert_eq!(table.lines().count(), 151);
}

proptest! {
    #![proptest_config(cases(50_000, "proptest-regressions/linear_roots.txt"))]

    /// The closed form of the argument principle agrees with following the argument step by step.
    #[test]
    fn the_certificate_is_a_winding_number(
        b in prop_oneof![4 => -2.5..1.0_f64, 1 => Just(0.0)],
        a_v in prop_oneof![4 => -3.0..3.0_f64, 1 => Just(0.0)],
        a_n in prop_oneof![4 => -15.0..5.0_f64, 1 => Just(0.0)],
        tau in prop_oneof![4 => 0.001..12.0_f64, 1 => Just(0.0)],
        line in prop_oneof![4 => -2.0..2.5_f64, 1 => Just(0.0)],
    ) {
        // Far left of the axis D is too large to be followed in small steps.
        let line = line.max(-4.0 / tau);
        let groups = Groups::new(b, a_v, a_n);
        let found = roots_right_of(groups, tau, line);
        if let Some(expected) = winding::roots_right_of(b, a_v, a_n, tau, line) {
            prop_assert_eq!(found, Some(expected));
        }
        if line == 0.0 {
            prop_assert_eq!(UnstableCount::new(groups).at(tau), found);
        }
    }
}

/// 10⁶ random cells, each a line of its own: certified or marginal, every one.
#[test]
fn a_million_random_cells_are_certified() {
    let half = |seed| {
        let mut number = numbers(seed);
        let mut between = move |from: f64, to: f64| from + (to - from) * number();
        let mut certified = 0;
        for _ in 0..500_000 {
            let groups = Groups::new(between(-2.5, 1.0), between(-3.0, 3.0), between(-15.0, 5.0));
            let delays = [between(0.001, 50.0)];
            let line = follow(groups, &delays, 0, 1);
            let status = line.status[0];
            assert_eq!(
                status & (DISAGREE | NOT_CONVERGED),
                0,
                "{groups:?} {delays:?}"
            );
            assert_ne!(status & (CERTIFIED | MARGINAL), 0, "{groups:?} {delays:?}");
            certified += u64::from(status & CERTIFIED != 0);
        }
        certified
    };
    let certified: u64 = std::thread::scope(|scope| {
        let other = scope.spawn(|| half(0x9e37_79b9_7f4a_7c15));
        half(0x2545_f491_4f6c_dd1d) + other.join().unwrap()
    });
    assert!(certified > 999_990, "{certified}");
}

/// Strong gains with a short delay leave ordinary roots between terms that nearly cancel.
#[test]
fn strong_gains_with_short_delays_have_their_reference_roots() {
    let table = include_str!("../reference/strong_gains.csv");
    let mut rows = 0;
    for row in table.lines().filter(|line| !line.starts_with(['#', 'b'])) {
        let v: Vec<f64> = row.split(',').map(|x| x.parse().unwrap()).collect();
        let (groups, tau) = (Groups::new(v[0], v[1], v[2]), v[3]);
        let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
        assert_eq!(
            (count.n_unstable as f64, count.marginal),
            (v[4], false),
            "{row}"
        );
        for delays in [vec![tau], even(0.1 * tau, tau, 40)] {
            let line = follow(groups, &delays, 0, 1);
            let (root, margin) = (
                line.roots[delays.len() - 1][0],
                line.margins[delays.len() - 1],
            );
            assert!(
                line.status.iter().all(|&s| s == CERTIFIED),
                "{row} {line:?}"
            );
            // D is a sum of terms of the size of the gains, up to 1e7.
            let size = v[5].hypot(v[6]).max(1.0);
            assert!(margin < 1e-6, "{row} {margin}");
            assert!((root.re - v[5]).abs() < 1e-8 * size, "{row}: {root}");
            assert!((root.im - v[6]).abs() < 1e-8 * size, "{row}: {root}");
        }
        rows += 1;
    }
    assert_eq!(rows, 120);
}

/// 20,000 random cells with gains up to 10⁷ and delays down to 10⁻⁸: certified, every one. Right of
/// the axis, and of two lines next to the abscissa, are as many roots as the argument turns.
#[test]
fn strong_gains_with_short_delays_are_certified() {
    let mut number = numbers(31);
    let mut strong = |from: f64, to: f64| 10_f64.powf(from + (to - from) * number());
    let mut turned = 0;
    for i in 0..20_000_u32 {
        let sign = |bit: u32| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let of = |absent: u32, gain: f64| if i % 3 == absent { 0.0 } else { gain };
        let (b, a_v, a_n) = (
            -2.5 + 3.5 * strong(0.0, 1.0).log10(),
            of(0, sign(2) * strong(3.0, 7.0)),
            of(1, sign(3) * strong(3.0, 7.0)),
        );
        let tau = strong(-8.0, -4.0);
        let line = follow(Groups::new(b, a_v, a_n), &[tau], 0, 1);
        let at = format!("{b} {a_v} {a_n} {tau} {line:?}");
        assert_eq!(line.status, [CERTIFIED], "{at}");
        if i % 20 > 0 {
            continue;
        }
        let root = line.roots[0][0];
        let beside = 1e-3 * root.re.abs().max(1.0);
        for (sigma, expected) in [
            (0.0, Crossings::of(Groups::new(b, a_v, a_n)).n_unstable(tau)),
            (root.re + beside, 0),
            (root.re - beside, if root.im == 0.0 { 1 } else { 2 }),
        ] {
            if let Some(found) = winding::roots_right_of(b, a_v, a_n, tau, sigma) {
                let more = sigma < root.re && found > expected;
                assert!(
                    found == expected || more,
                    "{sigma}: {found} {expected} {at}"
                );
                turned += 1;
            }
        }
    }
    assert!(turned > 2900, "{turned}");
}

/// Where anything may be degenerate: no damping, no control, huge and tiny gains and delays.
#[test]
fn extreme_cells_come_to_an_answer() {
    let mut number = numbers(77);
    let mut pick = |values: &[f64]| {
        let scale = 10_f64.powf(6.0 * number() - 4.0);
        let sign = if number() < 0.5 { -1.0 } else { 1.0 };
        match values.get((number() * (values.len() + 3) as f64) as usize) {
            Some(&value) => value,
            None => sign * scale,
        }
    };
    let mut flagged = 0;
    for _ in 0..20_000 {
        let groups = Groups::new(
            pick(&[0.0, 2.0, -2.0, 1e-12]),
            pick(&[0.0, 1.0, -1e-300]),
            pick(&[0.0, 0.5, -0.625]),
        );
        let delays = [pick(&[0.0, 1e-9, 1.0, 100.0]).abs()];
        let line = follow(groups, &delays, 0, 1);
        let status = line.status[0];
        assert_eq!(
            status & DISAGREE,
            0,
            "{groups:?} {delays:?} {:?}",
            line.roots
        );
        if status & (CERTIFIED | MARGINAL) == 0 {
            assert_ne!(status & NOT_CONVERGED, 0);
            flagged += 1;
        } else {
            let root = line.roots[0][0];
            assert!(root.re.is_finite() && root.im >= 0.0);
        }
    }
    assert!(flagged < 20, "{flagged} of 20000");
}

/// A line and the same line ten times finer agree where they meet, over swaps of the rightmost
/// root, roots that come in from the left and pairs that merge on the real axis.
#[test]
fn refining_a_line_changes_nothing() {
    let mut number = numbers(5);
    for _ in 0..60 {
        let groups = Groups::new(
            -1.5 + 2.0 * number(),
            -1.5 + 2.5 * number(),
            -6.0 + 8.0 * number(),
        );
        let coarse = follow(groups, &even(0.0, 14.0, 281), 0, 3);
        let fine = follow(groups, &even(0.0, 14.0, 2801), 0, 3);
        for i in 0..281 {
            let (p, q) = (&coarse.roots[i], &fine.roots[10 * i]);
            assert_eq!(p.len(), q.len());
            for (p, q) in p.iter().zip(q) {
                assert!((p - q).norm() < 1e-11, "{groups:?} {i}: {p} {q}");
            }
        }
        for line in [&coarse, &fine] {
            assert!(
                line.status.iter().all(|s| s & (CERTIFIED | MARGINAL) != 0),
                "{groups:?}"
            );
        }
    }
}

/// Where hundreds of roots crowd within 1e-9 of the axis, the rightmost one is still the rightmost
/// one.
#[test]
fn crowded_roots_are_told_apart() {
    for (groups, to) in [
        (
            Groups::new(0.0, -1.7783250925984304, -2.317224734333381),
            500.0,
        ),
        (Groups::new(0.0, -2.8733669155000525, 0.0), 1920.0),
    ] {
        let coarse = follow(groups, &even(0.0, to, 751), 0, 1);
        let fine = follow(groups, &even(0.0, to, 7501), 0, 1);
        for i in 1..751 {
            if coarse.status[i] & fine.status[10 * i] & CERTIFIED != 0 {
                let (p, q) = (coarse.roots[i][0], fine.roots[10 * i][0]);
                assert!((p.re - q.re).abs() < 1e-11, "{groups:?} {i}: {p} {q}");
            }
        }
        let certified = coarse
            .status
            .iter()
            .filter(|&&s| s & CERTIFIED != 0)
            .count();
        assert!(certified > 700, "{certified}");
    }
}

/// With gains at rounding level the further roots are far away: a cell has them, or says that it
/// has not.
#[test]
fn roots_that_are_not_found_are_not_certified() {
    for gain in [-1.1102230246251565e-16, 1.5641393157423528e-12, 1e-300] {
        let line = follow(Groups::new(-0.3, gain, 0.0), &even(0.0, 10.0, 101), 0, 3);
        for (roots, status) in line.roots.iter().zip(&line.status).skip(1) {
            assert!((roots[0].re - 0.15).abs() < 1e-9);
            assert_eq!(
                status & CERTIFIED != 0,
                roots.len() == 3,
                "{gain} {roots:?}"
            );
            assert_eq!(status & NOT_CONVERGED != 0, roots.len() < 3);
        }
    }
}

/// The optima of both controls are a double pair and a triple real root: found, and certified with
/// a wider margin. Settings and abscissas solve D = D′ = 0 and D = D′ = D″ = 0 in 30-digit
/// arithmetic (mpmath); as rounded here the roots lie 1e-5 apart.
#[test]
fn multiple_roots_are_found() {
    for (groups, tau, abscissa) in [
        (
            Groups::new(-0.3, 0.0, -3.6525473882693595),
            0.46473703404347766,
            -2.00175449,
        ),
        (
            Groups::new(-0.1, -0.174838541, 0.0),
            3.42844561,
            -0.30505944,
        ),
    ] {
        let line = follow(groups, &[tau], 0, 2);
        assert_eq!(line.status, [CERTIFIED], "{groups:?}");
        assert!((line.roots[0][0].re - abscissa).abs() < 1e-4);
        assert!(line.margins[0] > MARGIN && line.margins[0] < 0.03);
    }
}

/// Cut at blocks and followed in any order, a line gives the same bits.
#[test]
fn blocks_are_independent() {
    let groups = Groups::new(-0.3, 0.2, -1.1);
    let delays = even(0.0, 60.0, 3 * BLOCK + 100);
    let whole = follow(groups, &delays, 0, 2);
    for block in (0..=3).rev() {
        let range = block * BLOCK..delays.len().min((block + 1) * BLOCK);
        let part = follow(groups, &delays[range.clone()], range.start, 2);
        assert_eq!(part.status, whole.status[range.clone()]);
        assert_eq!(part.roots, whole.roots[range.clone()]);
        assert_eq!(part.margins, whole.margins[range]);
    }
}

/// Hundreds of roots crowd the axis at long delays.
#[test]
fn a_hundred_thousand_delays_stay_certified() {
    let delays = even(0.005, 500.0, 100_000);
    for groups in [
        Groups::new(-0.3, 0.0, -1.0),
        Groups::new(-0.3, -0.5, 0.0),
        Groups::new(0.5, 2.0, -10.0),
    ] {
        let line = follow(groups, &delays, 0, 1);
        let certified = line.status.iter().filter(|&&s| s & CERTIFIED != 0).count();
        assert!(certified >= 99_990, "{groups:?} {certified}");
        assert!(line.status.iter().all(|s| s & (CERTIFIED | MARGINAL) != 0));
        for (i, m) in line.margins.iter().enumerate() {
            assert!(
                *m <= 1e-7,
                "{groups:?} {i} {m} {:?} {}",
                line.roots[i],
                line.status[i]
            );
        }
        let narrow = line.margins.iter().filter(|&&m| m == MARGIN).count();
        assert!(narrow > 99_000, "{groups:?} {narrow}");
        assert!(line.reseeded < 200, "{}", line.reseeded);
    }
}

/// Through a double root on the real axis: two real roots meet and leave as a pair. Near it the
/// margin widens, or not; the value stays within what rounding of D allows.
#[test]
fn real_roots_merge_into_pairs() {
    // (λ² + bλ + 1) with b = 2 − s: the roots meet at τ-dependent places for weak control.
    let mut merges = 0;
    for i in 0..40 {
        let groups = Groups::new(1.6 + 0.02 * f64::from(i), 0.0, -0.2);
        let line = follow(groups, &even(0.0, 3.0, 3001), 0, 2);
        let real: Vec<bool> = line.roots.iter().map(|r| r[0].im == 0.0).collect();
        merges += real.windows(2).filter(|w| w[0] != w[1]).count();
        assert!(line.status.iter().all(|&s| s == CERTIFIED), "{groups:?}");
    }
    assert!(merges > 10, "{merges}");
}

/// Every root that is reported, with the line just left of the last: as many as the winding number
/// says.
#[test]
fn the_spectrum_is_complete() {
    let mut number = numbers(11);
    let mut finder = RootFinder::default();
    let mut checked = 0;
    for _ in 0..3000 {
        let (b, a_v, a_n) = (
            -2.0 + 3.0 * number(),
            -2.0 + 4.0 * number(),
            -8.0 + 12.0 * number(),
        );
        let tau = 0.05 + 8.0 * number();
        let line = (-2.5 * number()) / tau;
        let Ok(roots) = finder.right_of(Groups::new(b, a_v, a_n), tau, line) else {
            panic!("{b} {a_v} {a_n} {tau} {line}");
        };
        let count: u64 = roots.iter().map(slipmap::linear::newton::Root::count).sum();
        assert!(roots.windows(2).all(|w| w[0].lambda.re >= w[1].lambda.re));
        if let Some(expected) = winding::roots_right_of(b, a_v, a_n, tau, line) {
            assert_eq!(count, expected);
            checked += 1;
        }
    }
    assert!(checked > 2900, "{checked}");
}

#[test]
fn a_dense_table_has_the_roots_of_its_law() {
    let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
    let root = |law: &FrictionLaw, v0: f64| {
        let groups = Groups::new(law.mu_prime(v0), -0.33, -0.1 * law.mu_k(v0));
        let count = Crossings::of(groups).count(4.15, MarginalTolerance::default());
        Rightmost::at(groups, 4.15, 1, count).roots[0].lambda
    };
    let errors = [33, 65, 129, 257].map(|points: u32| {
        let speed = |i: u32| 2.0 * f64::from(i) / f64::from(points - 1);
        let speeds: Vec<_> = (0..points).map(speed).collect();
        let mu_k = speeds.iter().map(|v| law.mu_k(*v)).collect();
        let table = FrictionLaw::table(Table::new(speeds, mu_k).unwrap(), 1.0).unwrap();
        let v0s = (1..40).map(|i| 0.2 + 0.0171 * f64::from(i));
        v0s.map(|v0| (root(&table, v0) - root(&law, v0)).norm())
            .fold(0.0, f64::max)
    });
    println!("{errors:?}");
    // The slope of the table is of second order.
    for pair in errors.windows(2) {
        assert!(pair[1] < pair[0] / 3.0, "{errors:?}");
    }
}
