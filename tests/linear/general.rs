//! Systems with one delay of any degree, against independently computed tables.

use crate::general_rows::{degenerate, without_latency};
use slipmap::linear::general::{DelayLine, Reason, RightOf, RootCounter, System};
use slipmap::linear::rightmost::Rightmost;
use slipmap::linear::stable_delays::StableInterval;
use slipmap::linear::{Direction, MarginalTolerance};

#[test]
fn counts_of_the_tables() {
    let mut checked = 0;
    for (row, system) in without_latency() {
        let tau = row.or_zero("tau");
        let line = DelayLine::of(&system);
        let n = row.or_zero("n_unstable") as u64;
        let found = line.count(tau, MarginalTolerance::default());
        assert_eq!(
            (found.n_unstable, found.marginal),
            (n, false),
            "{}\n{line:?}",
            row.place
        );
        assert_eq!(
            line.at_zero_delay,
            row.or_zero("n_at_zero_delay") as u64,
            "{}",
            row.place
        );
        let counter = RootCounter::new(&system);
        assert_eq!(
            counter.right_of(tau, 0.0),
            RightOf::Roots(n),
            "{}",
            row.place
        );
        let right = row.or_zero("n_right_of_line") as u64;
        assert_eq!(
            counter.right_of(tau, row.or_zero("line")),
            RightOf::Roots(right),
            "{}",
            row.place
        );
        assert_eq!(line.reason, None, "{}", row.place);
        checked += 1;
    }
    assert!(checked > 400, "{checked}");
}

#[test]
fn degenerate_cases_have_their_count_and_their_reason() {
    for (row, system) in degenerate() {
        let tau = row.or_zero("tau");
        let line = DelayLine::of(&system);
        assert_eq!(
            line.reason.map_or("", |r| r.name()),
            row.text("status"),
            "{}",
            row.place
        );
        match row.text("n_unstable") {
            "inf" | "refused" => assert!(line.uncounted, "{}", row.place),
            n => {
                assert!(!line.uncounted, "{}", row.place);
                assert_eq!(
                    line.n_unstable(tau),
                    n.parse::<u64>().expect("a number"),
                    "{}\n{line:?}",
                    row.place
                );
            }
        }
    }
}

/// Where F has a double zero at 0 and D, at τ*, a triple one, a pair comes to the origin with the
/// real root: no count is told. A little beside that the count is that of the other way.
#[test]
fn a_triple_root_at_the_origin_is_not_counted() {
    let system = |off: f64| {
        let p = [1.0, -2.0, 2.0 + off, 3.0, -1.0];
        System::of_coefficients(&p, &[-1.0]).unwrap()
    };
    let exact = DelayLine::of(&system(0.0));
    assert!(exact.uncounted && exact.reason == Some(Reason::RootAtOrigin));
    let three = System::of_coefficients(&[3.0, -1.0, 1.0 / 6.0, 2.0, 1.0], &[-3.0]).unwrap();
    assert!(DelayLine::of(&three).uncounted);
    for off in [-1e-3, 1e-3] {
        let (system, tau) = (system(off), 3.0);
        let line = DelayLine::of(&system);
        assert!(!line.uncounted, "{off}");
        let right = RootCounter::new(&system).right_of(tau, 1e-6);
        assert_eq!(right.finite(), Some(line.n_unstable(tau)), "{off}");
    }
}

#[test]
fn rightmost_roots_of_the_tables() {
    let (mut checked, mut worst) = (0, 0.0_f64);
    for (row, system) in without_latency() {
        let tau = row.or_zero("tau");
        let counter = RootCounter::new(&system);
        let count = DelayLine::of(&system).count(tau, MarginalTolerance::default());
        let found = Rightmost::at(&counter, tau, 1, count);
        assert!(found.certified, "{}\n{found:?}", row.place);
        let root = found.roots[0].lambda;
        let (re, im) = (row.or_zero("re_rightmost"), row.or_zero("im_rightmost"));
        let error = (root.re - re).abs().max((root.im - im).abs()) / re.hypot(im).max(1.0);
        assert!(error < 1e-12, "{}\n{found:?} {error:e}", row.place);
        worst = worst.max(error);
        checked += 1;
    }
    assert!(checked > 400, "{checked}");
    println!("{checked} roots, worst error {worst:e}");
}
/// Ends of stable intervals agree to this, relative.
const ENDS: f64 = 1e-9;

fn same(found: f64, expected: f64) -> bool {
    found == expected || (found - expected).abs() <= ENDS * expected.abs().max(1.0)
}

#[test]
fn crossings_and_stable_delays_of_the_tables() {
    let mut intervals = 0;
    for (row, system) in without_latency() {
        let line = DelayLine::of(&system);
        let moving = line
            .crossings
            .iter()
            .filter(|c| c.direction != Direction::Touch);
        assert_eq!(
            moving.count(),
            row.or_zero("n_crossing_frequencies") as usize,
            "{}",
            row.place
        );
        let first = line.changes().next();
        assert_eq!(
            first.map(|c| f64::from(c.by)),
            row.number("first_change"),
            "{}",
            row.place
        );
        if let Some(first) = first {
            assert!(
                same(first.tau, row.or_zero("first_crossing")),
                "{}\n{first:?}",
                row.place
            );
        }
        let expected = row.intervals("stable_delays");
        let begin_in_time = |i: &StableInterval| i.from < 60.0;
        let found: Vec<_> = line
            .stable_intervals()
            .take(12)
            .take_while(begin_in_time)
            .collect();
        assert_eq!(found.len(), expected.len(), "{}\n{found:?}", row.place);
        for (found, (from, to)) in found.iter().zip(expected) {
            assert!(
                same(found.from, from) && same(found.to, to),
                "{}\n{found:?}",
                row.place
            );
            intervals += 1;
        }
    }
    assert!(intervals > 400, "{intervals}");
}
