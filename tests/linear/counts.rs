//! The closed-form count against reference rows and against an independent count.

use crate::cases::cases;
use crate::winding;
use proptest::prelude::*;
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::Groups;

#[test]
fn every_reference_row_has_its_count() {
    let table = include_str!("../reference/linear_points.csv");
    let mut rows = 0;
    for line in table.lines().skip(1) {
        let v: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let crossings = Crossings::of(Groups::new(v[0], v[1], v[2]));
        let count = crossings.count(v[3], MarginalTolerance::default());
        assert_eq!(count.n_unstable as f64, v[4], "{line}");
        assert!(!count.marginal, "{line}");
        assert_eq!(count.stable(), v[5] < 0.0, "{line}");
        rows += 1;
    }
    assert_eq!(rows, 150);
}

fn agree(b: f64, a_v: f64, a_n: f64, tau: f64) {
    let count = Crossings::of(Groups::new(b, a_v, a_n)).count(tau, MarginalTolerance::default());
    if count.marginal {
        return;
    }
    if let Some(expected) = winding::unstable_roots(b, a_v, a_n, tau) {
        assert_eq!(
            count.n_unstable, expected,
            "b {b} a_v {a_v} a_n {a_n} τ {tau}"
        );
    }
}

/// A gain that is sometimes exactly zero, so that pure controls come up as often as mixed ones.
fn gain(range: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    prop_oneof![2 => range, 1 => Just(0.0)]
}

proptest! {
    #![proptest_config(cases(20_000, "proptest-regressions/linear_counts.txt"))]

    #[test]
    fn counts_equal_winding_numbers(
        b in -2.5..1.0_f64,
        a_v in gain(-3.0..3.0),
        a_n in gain(-15.0..5.0),
        tau in 0.001..20.0_f64,
    ) {
        agree(b, a_v, a_n, tau);
    }
}

proptest! {
    #![proptest_config(cases(4_000, "proptest-regressions/linear_counts.txt"))]

    /// Where the closed form has its special cases: b = 0, folds, tiny gains, short delays.
    #[test]
    fn counts_equal_winding_numbers_in_degenerate_places(
        b in prop_oneof![Just(0.0), -1e-6..1e-6_f64, -0.8..0.1_f64],
        a_v in prop_oneof![Just(0.0), -1e-3..1e-3_f64, -1.0..1.0_f64],
        kind in 0..4,
        offset in prop_oneof![-1e-3..1e-3_f64, -1e-6..1e-6_f64],
        tau in prop_oneof![0.0..1e-2_f64, 0.0..15.0_f64],
    ) {
        let fold = (b * (b - 2.0 * a_v)).max(0.0).sqrt();
        let a_n = match kind {
            0 => -0.5 * b * b - fold + offset,
            1 => -0.5 * b * b + fold + offset,
            2 => 0.5 - b * a_v + offset,
            _ => offset,
        };
        agree(b, a_v, a_n, tau);
    }
}

/// The roots at τ = 0⁺ for b = 0, where the sign of the first order decides.
#[test]
fn undamped_counts_equal_winding_numbers() {
    for (a_v, a_n) in [
        (0.0, 0.3),
        (0.0, -0.3),
        (0.5, 0.3),
        (0.5, -0.3),
        (0.4, 0.0),
        (-0.4, 0.0),
    ] {
        for tau in [0.2, 1.0, 3.0, 5.0, 7.5, 11.0] {
            let expected = winding::unstable_roots(0.0, a_v, a_n, tau).expect("off the axis");
            let count = Crossings::of(Groups::new(0.0, a_v, a_n)).n_unstable(tau);
            assert_eq!(count, expected, "a_v {a_v} a_n {a_n} τ {tau}");
        }
    }
}

/// ω → 0: whether the slow crossing exists at all is decided by a sign, however small the frequency
/// is.
#[test]
fn slow_crossings_exist_or_not() {
    for (b, a_n) in [
        (-2.29, 0.500_000_000_000_000_2),
        (-2.29, 0.499_999_999_999_999_9),
        (-0.5, 0.500_000_000_000_000_2),
        (-0.5, 0.499_999_999_999_999_9),
    ] {
        let crossings = Crossings::of(Groups::new(b, 0.0, a_n));
        // x₊ x₋ = 1 − 2 a_n and x₊ + x₋ = 2 − b² − 2 a_n: the slow x is the quotient.
        let slow: f64 = (1.0 - 2.0 * a_n) / (2.0 - b * b - 2.0 * a_n);
        let found = crossings.iter().find(|c| c.omega < 1e-3);
        assert_eq!(found.is_some(), slow > 0.0, "{b} {a_n}");
        if let Some(crossing) = found {
            assert!((crossing.omega / slow.sqrt() - 1.0).abs() < 1e-12);
        }
    }
}

/// Slow crossings among others at very long delays, where every digit of ω₋ counts. Reference
/// counts from the quadratic in 60-digit arithmetic.
#[test]
fn slow_crossings_count_at_long_delays() {
    for (b, a_v, a_n, tau, expected) in [
        (
            0.946_137_786_371_393_1,
            0.0,
            0.499_999_999_999_999_94,
            41_752_384_583.390_144,
            4_302_890_154,
        ),
        (
            -1.274_230_921_471_411_4,
            -0.813_477_601_604_242_7,
            -0.536_558_313_888_527_8,
            9_595_506_249.347_267,
            3_677_222_970,
        ),
        (
            0.853_218_171_164_021_2,
            0.552_824_055_794_832_3,
            0.028_320_470_139_812_37,
            79_655_443_934.941_27,
            27_952_537_676,
        ),
    ] {
        let count =
            Crossings::of(Groups::new(b, a_v, a_n)).count(tau, MarginalTolerance::default());
        assert!(
            count.marginal || count.n_unstable == expected,
            "{b} {a_v} {a_n}: {count:?}"
        );
    }
}

proptest! {
    /// At a tangency in physical units the groups themselves are rounded: it is recognised all the
    /// same, and its cells are marginal rather than wrong.
    #[test]
    fn tangencies_in_physical_units_are_marginal(
        b in -5.0..-0.01_f64,
        mass in 0.1..10.0_f64,
        stiffness in 0.1..10.0_f64,
        load in 0.1..10.0_f64,
        mu_k in 0.1..1.0_f64,
    ) {
        use slipmap::model::{Control, Oscillator, SlidingPoint};
        let oscillator = Oscillator::new(mass, stiffness, load).unwrap();
        let mu_prime = b * (stiffness * mass).sqrt() / load;
        let alpha_n = -(0.5 * b * b - b) * stiffness / mu_k;
        let groups = oscillator.groups(SlidingPoint { mu_k, mu_prime }, Control { alpha_v: 0.0, alpha_n });
        let crossings = Crossings::of(groups).in_physical_time(oscillator.time_unit());
        let touch = crossings.touch.expect("the tangency is recognised");
        prop_assert!(crossings.marginal(touch.delay(0), MarginalTolerance::default()));
    }
}
