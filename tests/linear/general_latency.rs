//! Feedback that comes late: against independently computed tables, and against methods that share
//! nothing with the crossings.

use crate::chance::Chance;
use crate::general_rows::{Row, with_latency, without_latency};
use crate::letter_system::letter;
use slipmap::linear::general::{
    DelayLine, Form, Polynomial, Reason, RightOf, RootCounter, Spectrum, System,
};
use slipmap::linear::{Direction, MarginalTolerance};
use slipmap::model::{Channel, Groups, known_cases};

/// Ends of stable intervals and crossings agree to this, relative.
const ENDS: f64 = 1e-9;

fn same(found: f64, expected: f64, to: f64) -> bool {
    found == expected || (found - expected).abs() <= to * expected.abs().max(1.0)
}

/// The line of delays, or of latencies, against its columns.
fn check_line(
    row: &Row,
    line: &DelayLine,
    columns: [&str; 5],
    (last, most): (f64, usize),
) -> usize {
    let [at_zero, frequencies, first, change, stable] = columns;
    let place = &row.place;
    assert_eq!(
        line.at_zero_delay,
        row.or_zero(at_zero) as u64,
        "{place}\n{line:?}"
    );
    let moving = |c: &&slipmap::linear::Crossing| c.direction != Direction::Touch;
    assert_eq!(
        line.crossings.iter().filter(moving).count(),
        row.or_zero(frequencies) as usize,
        "{place}\n{line:?}"
    );
    let found = line.changes().next();
    assert_eq!(
        found.map(|c| f64::from(c.by)),
        row.number(change),
        "{place}"
    );
    if let Some(found) = found {
        assert!(
            same(found.tau, row.or_zero(first), ENDS),
            "{place}\n{found:?}"
        );
    }
    let expected = row.intervals(stable);
    let found: Vec<_> = line
        .stable_intervals()
        .take(most)
        .take_while(|i| i.from < last)
        .collect();
    assert_eq!(found.len(), expected.len(), "{place}\n{found:?}");
    for (found, (from, to)) in found.iter().zip(expected) {
        let ends = same(found.from, from, ENDS) && same(found.to, to, ENDS);
        assert!(ends, "{place}\n{found:?}");
    }
    found.len()
}

#[test]
fn lines_of_the_table() {
    let (mut intervals, mut latencies, mut worst) = (0, 0, 0.0_f64);
    for (row, system) in with_latency() {
        let tau = row.or_zero("tau");
        let line = DelayLine::of(&system);
        intervals += check_line(
            &row,
            &line,
            [
                "n_at_zero_delay",
                "n_crossing_frequencies",
                "first_crossing",
                "first_change",
                "stable_delays",
            ],
            (60.0, 12),
        );
        let n = row.or_zero("n_unstable") as u64;
        let found = line.count(tau, MarginalTolerance::default());
        assert_eq!(
            (found.n_unstable, found.marginal),
            (n, false),
            "{}",
            row.place
        );
        let late = DelayLine::of_latencies(&system, tau).expect("feedback");
        latencies += check_line(
            &row,
            &late,
            [
                "n_at_zero_latency",
                "n_latency_frequencies",
                "first_latency",
                "first_latency_change",
                "stable_latencies",
            ],
            (20.0, 12),
        );
        let found = late.count(row.or_zero("latency"), MarginalTolerance::default());
        assert_eq!(
            (found.n_unstable, found.marginal),
            (n, false),
            "{}",
            row.place
        );
        let margin = system.latency_margin(tau).expect("feedback");
        let expected = row.or_zero("latency_margin");
        assert!(same(margin, expected, 1e-11), "{} {margin}", row.place);
        if margin.is_finite() {
            worst = worst.max((margin - expected).abs());
        }
    }
    println!("{intervals} intervals of delays, {latencies} of latencies, margins to {worst:e}");
    assert!(intervals > 40 && latencies > 20, "{intervals} {latencies}");
}

#[test]
fn counts_of_the_table_in_both_forms() {
    for (row, system) in with_latency() {
        let tau = row.or_zero("tau");
        let counter = RootCounter::new(&system);
        let n = row.or_zero("n_unstable") as u64;
        let right = row.or_zero("n_right_of_line") as u64;
        for (line, n) in [(0.0, n), (row.or_zero("line"), right)] {
            let expected = RightOf::Roots(n);
            assert_eq!(
                counter.right_of(tau, line),
                expected,
                "{} {line}",
                row.place
            );
            for form in [Form::Delay, Form::Latency] {
                let found = counter.right_of_by(form, tau, line);
                assert_eq!(found, expected, "{} {line} {form:?}", row.place);
            }
        }
    }
}

#[test]
fn rightmost_roots_of_the_table() {
    let mut worst = 0.0_f64;
    for (row, system) in with_latency() {
        let tau = row.or_zero("tau");
        let counter = RootCounter::new(&system);
        let found = Spectrum::at(&counter, &DelayLine::of(&system), tau, 1);
        assert!(found.certified, "{}\n{found:?}", row.place);
        let root = found.roots[0].lambda;
        let (re, im) = (row.or_zero("re_rightmost"), row.or_zero("im_rightmost"));
        let error = (root.re - re).abs().max((root.im - im).abs()) / re.hypot(im).max(1.0);
        assert!(error < 1e-12, "{}\n{found:?} {error:e}", row.place);
        worst = worst.max(error);
        match row.number("essential_abscissa") {
            Some(expected) if !system.uncontrolled() => {
                let apart = same(found.essential_abscissa, expected, 1e-13);
                assert!(apart, "{}\n{found:?}", row.place);
            }
            _ => assert_eq!(found.essential_abscissa, f64::NEG_INFINITY, "{}", row.place),
        }
    }
    println!("worst error {worst:e}");
}

/// Values of another program, four of them also by bisection on roots.
#[test]
fn latency_margins_are_those_of_another_program() {
    let [a, b] = known_cases::letter_fig3();
    let known = |case: known_cases::LinearCase| {
        let Groups { b, a_v, a_n } = case.groups;
        (b, a_v, a_n, case.tau)
    };
    let mut worst = 0.0_f64;
    for ((b, a_v, a_n, tau), expected) in [
        (known(a), 0.142666885165),
        (known(b), 0.280274481666),
        // The settings of fastest decay that README shows, with its digits.
        ((-0.1, -0.174838541, 0.0, 3.42844561), 0.786515471502),
        ((-0.1, -0.081992941, 0.0, 9.60503427), 0.544215989846),
        ((-0.1, -0.0620222821, 0.0, 15.8717855), 0.310837448092),
        ((-0.1, -0.0545399029, 0.0, 22.1568094), 0.149953279253),
        ((-0.3, 0.0, -3.65, 0.465), 0.432597049595),
        ((-0.7, -0.3174, 0.0, 4.312957), 0.009095994512),
    ] {
        let system = letter(Groups::new(b, a_v, a_n), 0.0, 0.0);
        let margin = system.latency_margin(tau).expect("feedback");
        assert!((margin - expected).abs() < 1e-11, "{b} {margin} {expected}");
        worst = worst.max((margin - expected).abs());
        // Beside it the rightmost root changes sides.
        for (latency, n) in [(margin - 1e-9, 0), (margin + 1e-9, 2)] {
            let late = system.with_latency(latency).expect("feedback");
            let right = RootCounter::new(&late).right_of(tau, 0.0);
            assert_eq!(right, RightOf::Roots(n), "{b} {latency}");
        }
    }
    println!("worst difference {worst:e}");
    assert_eq!(
        letter(Groups::new(-0.3, 0.0, 0.0), 0.4, 0.0).latency_margin(1.0),
        Some(0.0)
    );
    assert_eq!(
        letter(Groups::new(0.3, 0.0, 0.0), 0.4, 0.0).latency_margin(1.0),
        Some(f64::INFINITY)
    );
    // Gains too weak ever to reach the damping.
    assert_eq!(
        letter(Groups::new(0.9, 0.0, 0.1), 0.0, 0.0).latency_margin(3.0),
        Some(f64::INFINITY)
    );
    assert_eq!(
        letter(Groups::new(0.9, 0.0, 0.1), 0.0, 0.0).latency_margin(0.0),
        Some(f64::INFINITY)
    );
    let direct = System::of_coefficients(&[1.0, 0.2, 1.0], &[0.3]).expect("a small degree");
    assert_eq!(direct.latency_margin(1.0), None);
}

/// Latency 0 is the system without latency, and so is any latency of no feedback.
#[test]
fn without_latency_nothing_changes() {
    let mut chance = Chance(3);
    for _ in 0..300 {
        let memory = [0.0, chance.between(-0.9, 0.9)][chance.of(2)];
        let b = chance.between(-1.0, 1.0);
        let (a_v, a_n) = (chance.between(-1.0, 1.0), chance.between(-4.0, 2.0));
        let late = letter(Groups::new(b, a_v, a_n), memory, chance.log(0.01, 9.0));
        let (plain, back) = (
            letter(Groups::new(b, a_v, a_n), memory, 0.0),
            late.with_latency(0.0).expect("feedback"),
        );
        assert_eq!(format!("{plain:?}"), format!("{back:?}"));
        let tau = chance.log(0.05, 20.0);
        // A latency that rounding loses: the other path, the same counts.
        let hardly = plain.with_latency(1e-14).expect("feedback");
        let count = |s: &System| DelayLine::of(s).count(tau, MarginalTolerance::default());
        let right = |s: &System, line| RootCounter::new(s).right_of(tau, line);
        assert_eq!(count(&plain), count(&hardly));
        let line = chance.between(0.5 * plain.essential_abscissa(tau).max(-0.5), 0.6);
        assert_eq!(
            right(&plain, line),
            right(&hardly, line),
            "{b} {a_v} {a_n} {tau} {line}"
        );
        let none = letter(Groups::new(b, 0.0, 0.0), memory, late.latency());
        assert_eq!(none.latency(), 0.0);
        assert_eq!(
            format!("{none:?}"),
            format!("{:?}", letter(Groups::new(b, 0.0, 0.0), 0.0, 0.0))
        );
    }
}

/// Roots at the origin and on the axis at every delay, zeros of B on the axis, touches.
#[test]
fn degenerate_cases_say_so() {
    let polynomial = |c: &[f64]| Polynomial::new(c).expect("a small degree");
    let system = |open: &[f64], gain: &[f64], memory, latency| {
        System::feedback(
            polynomial(open),
            polynomial(gain),
            Channel { memory, latency },
        )
    };
    // B(0) = 0: a root at 0 at every delay and latency.
    let origin = system(&[0.0, 1.0, 0.4, 1.0], &[0.5, 0.2], 0.3, 0.7);
    let line = DelayLine::of(&origin);
    assert_eq!(line.reason, Some(Reason::RootAtOrigin));
    let passage = line.passage.expect("a real root passes 0");
    // τ* = (1 − R) B′(0)/A(0).
    assert!((passage.tau - 0.7 / 0.5).abs() < 1e-14, "{passage:?}");
    // B and A have ±i√2 in common.
    let common = [2.0, 0.0, 1.0];
    let times = |c: &[f64]| {
        let mut product = vec![0.0; c.len() + 2];
        for (i, c) in c.iter().enumerate() {
            product[i] += common[0] * c;
            product[i + 2] += c;
        }
        product
    };
    for (open, gain) in [
        ([1.0, 0.4, 1.0], [0.7, 0.2]),
        ([1.0, -0.2, 1.0], [-1.4, 0.1]),
    ] {
        for (memory, latency) in [(0.0, 0.3), (0.4, 1.9), (-0.3, 0.02)] {
            let on_axis = system(&times(&open), &times(&gain), memory, latency);
            let alone = system(&open, &gain, memory, latency);
            let (line, rest) = (DelayLine::of(&on_axis), DelayLine::of(&alone));
            assert_eq!(line.reason, Some(Reason::RootOnAxis));
            for i in 1..60 {
                let tau = 0.213 * f64::from(i);
                let [found, expected] =
                    [&line, &rest].map(|l| l.count(tau, MarginalTolerance::default()));
                assert!(found.marginal);
                assert_eq!(
                    found.n_unstable, expected.n_unstable,
                    "{memory} {latency} {tau}"
                );
            }
            let late = DelayLine::of_latencies(&on_axis, 1.3).expect("feedback");
            assert!(late.always_marginal && on_axis.latency_margin(1.3) == Some(0.0));
        }
    }
    // A, B of the wrong degrees, a memory of 1: no answer.
    for refused in [
        system(&[1.0, 0.2, 1.0], &[0.3, 0.1, 0.4], 0.0, 0.5),
        system(&[1.0, 0.2, 1.0], &[0.3], 1.0, 0.5),
    ] {
        let line = DelayLine::of(&refused);
        assert!(line.uncounted && line.reason == Some(Reason::Refused));
        assert_eq!(
            RootCounter::new(&refused).right_of(1.0, 0.0),
            RightOf::Undecided
        );
    }
    // More memory than 1: infinitely many.
    let infinite = DelayLine::of(&system(&[1.0, 0.2, 1.0], &[0.3], -1.2, 0.5));
    assert!(infinite.uncounted && infinite.reason == Some(Reason::Infinite));
}

/// Zeros of B on the axis: the pair leaves it as the first order of τ says.
#[test]
fn pairs_that_start_on_the_axis() {
    let mut chance = Chance(5);
    let mut unstable = 0;
    for _ in 0..400 {
        let memory = [0.0, chance.between(-0.9, 0.9)][chance.of(2)];
        let latency = chance.log(0.01, 9.0);
        let (a_v, a_n) = (chance.between(-1.0, 1.0), chance.between(-2.0, 2.0));
        let system = letter(Groups::new(0.0, a_v, a_n), memory, latency);
        let line = DelayLine::of(&system);
        assert!(line.marginal_at_zero && !line.always_marginal);
        let counter = RootCounter::new(&system);
        for tau in [1e-4, 0.37, 4.1] {
            let count = line.count(tau, MarginalTolerance::default());
            let right = counter.right_of(tau, 0.0);
            assert_eq!(
                right,
                RightOf::Roots(count.n_unstable),
                "{a_v} {a_n} {memory} {latency}"
            );
            unstable += count.n_unstable;
        }
    }
    assert!(unstable > 100);
}

/// The systems of the other tables in feedback form, with lags, memory or a friction state, made
/// late: both lines and both forms say the same, and the rightmost roots are certified.
#[test]
fn lags_memory_and_friction_states_with_latency() {
    let mut chance = Chance(7);
    let (mut systems, mut cells, mut open, mut uncertified) = (0, 0, 0, 0);
    for (row, system) in without_latency() {
        let tau = row.or_zero("tau");
        let Some(late) = system.with_latency(chance.log(0.01, 6.0)) else {
            continue;
        };
        systems += 1;
        let delays = DelayLine::of(&late);
        let latencies = DelayLine::of_latencies(&late, tau).expect("feedback");
        let counter = RootCounter::new(&late);
        cells += 1;
        let by_delay = delays.count(tau, MarginalTolerance::default());
        let by_latency = latencies.count(late.latency(), MarginalTolerance::default());
        if by_delay.marginal || by_latency.marginal {
            open += 1;
            continue;
        }
        assert_eq!(by_delay, by_latency, "{}", row.place);
        for line in [0.0, chance.between(-0.3, 0.5)] {
            let [one, other] =
                [Form::Delay, Form::Latency].map(|form| counter.right_of_by(form, tau, line));
            if one == RightOf::Undecided || other == RightOf::Undecided {
                open += 1;
                continue;
            }
            assert_eq!(one, other, "{} {line}", row.place);
            if line == 0.0 {
                assert_eq!(one, RightOf::Roots(by_delay.n_unstable), "{}", row.place);
            }
        }
        let found = Spectrum::at(&counter, &delays, tau, 1);
        uncertified += u32::from(!found.certified);
        if late.latency_margin(tau).expect("feedback") > late.latency() {
            assert_eq!(by_delay.n_unstable, 0, "{}", row.place);
        }
    }
    println!("{systems} systems, {open} of {cells} cells open, {uncertified} not certified");
    assert!(
        systems > 150 && open <= 2 && uncertified <= 2,
        "{systems} {open} {uncertified}"
    );
}

/// Long latencies: the chain of roots that the feedback makes, and nothing right of the rightmost.
#[test]
fn long_latencies() {
    for (memory, tau) in [(0.0, 3.0), (0.0, 40.0), (0.5, 3.0)] {
        for latency in [20.0, 100.0] {
            let system = letter(Groups::new(-0.2, -0.5, -1.2), memory, latency);
            let counter = RootCounter::new(&system);
            let line = DelayLine::of(&system);
            let found = Spectrum::at(&counter, &line, tau, 4);
            assert!(
                found.certified && found.roots.len() == 4,
                "{memory} {tau} {latency} {found:?}"
            );
            let n = line.count(tau, MarginalTolerance::default()).n_unstable;
            for form in [Form::Delay, Form::Latency] {
                assert_eq!(counter.right_of_by(form, tau, 0.0), RightOf::Roots(n));
            }
            // About (τ + δ)/2π of them for each unit of frequency up to where |B| = 2|A|/(1 + R).
            assert!(n > 10 || latency < 100.0, "{n}");
        }
    }
}

/// With a delay of 10⁵ there are more frequencies than are listed: the margin is open, not 0.
#[test]
fn a_search_that_is_given_up_tells_no_margin() {
    // (b, a_n) = (0.1, 0.1) with the memory 0.3, stable without latency.
    let polynomial = |c: &[f64]| Polynomial::new(c).unwrap();
    let (open, gain) = (polynomial(&[1.0, 0.1, 1.0]), polynomial(&[0.1]));
    let system = System::feedback(
        open,
        gain,
        Channel {
            memory: 0.3,
            latency: 0.0,
        },
    );
    let here = DelayLine::of(&system).count(1e5, MarginalTolerance::default());
    assert!(here.stable());
    let margin = |tau: f64| system.latency_margin(tau).expect("feedback");
    assert!(margin(1e5).is_nan());
    // By |A e^(−iωδ) − R B| = |B − A e^(−iωδ)| somewhere, which a long delay turns to any phase.
    assert!((margin(3e4) - 3.373).abs() < 1e-3, "{}", margin(3e4));
}
