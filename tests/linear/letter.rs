//! The letter's statements about linear stability, and what was derived beyond them, as tests.

use slipmap::linear::lobes::{
    LobeControl, has_stable_delay, minimal_negative_load_gain, minimal_positive_load_gain,
};
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::{Groups, known_cases};

fn velocity_stable_anywhere(b: f64, gains: impl Iterator<Item = f64>) -> bool {
    gains
        .into_iter()
        .any(|a_v| has_stable_delay(Groups::new(b, a_v, 0.0)))
}

fn fine(from: f64, to: f64, points: u32) -> impl Iterator<Item = f64> {
    (0..=points).map(move |i| from + (to - from) * f64::from(i) / f64::from(points))
}

/// "it disappears": the exact limit, confirmed by maps on both sides, very near to it.
#[test]
fn velocity_control_ends_at_the_tangency() {
    let end = LobeControl::Velocity { damping: 0.0 }.lobe_end(0);
    assert!((end.b - -0.725_635_939_603).abs() < 1e-9);
    // Beside the limit the lobe is a sliver at the fold: look there finely, and everywhere
    // coarsely.
    for (distance, width) in [(1e-2, 1e-2), (1e-3, 1e-3), (1e-4, 1e-4)] {
        let fold = |b: f64| 0.5 * b - b * b * b / 8.0;
        let (inside, outside) = (end.b + distance, end.b - distance);
        assert!(velocity_stable_anywhere(
            inside,
            fine(fold(inside) - width, fold(inside), 20_000)
        ));
        assert!(!velocity_stable_anywhere(
            outside,
            fine(fold(outside) - width, fold(outside), 20_000)
        ));
    }
    for beyond in [-0.7257, -0.75, -0.9, -1.3, -2.0, -4.0] {
        assert!(!velocity_stable_anywhere(beyond, fine(-8.0, 8.0, 100_000)));
    }
}

/// The letter's −0.68 is where the lobe gets hard to see, not where it ends.
#[test]
fn velocity_control_outlives_the_letters_limit() {
    for b in [-0.69, -0.70, -0.72] {
        assert!(velocity_stable_anywhere(b, fine(-0.4, -0.2, 20_000)));
    }
}

/// Each further lobe shrinks to a point at its own slope: stable delays near it just inside, none
/// just outside.
#[test]
fn further_velocity_lobes_end_at_their_tangencies() {
    for (lobe, expected) in [(1, -0.369_620_351_789), (2, -0.240_297_356_210)] {
        let end = LobeControl::Velocity { damping: 0.0 }.lobe_end(lobe);
        assert!((end.b - expected).abs() < 1e-9);
        let stable_near = |b: f64| {
            let fold = 0.5 * b - b * b * b / 8.0;
            fine(fold - 1e-3, fold, 20_000).any(|a_v| {
                Crossings::of(Groups::new(b, a_v, 0.0))
                    .stable_delays()
                    .any(|s| (s.from - end.tau).abs() < 0.2)
            })
        };
        assert!(stable_near(end.b + 1e-3));
        assert!(!stable_near(end.b - 1e-3));
    }
}

/// "In pure load control there is always a stable region. Only the minimal value of |α_N| increases
/// with |μ_K′|."
#[test]
fn load_control_always_has_a_stable_region() {
    let mut previous = 0.0;
    for b in [
        -0.01, -0.05, -0.1, -0.3, -0.5, -0.7256, -1.0, -2.0, -3.5, -5.0,
    ] {
        let minimal = minimal_negative_load_gain(b);
        assert!(minimal < previous);
        previous = minimal;
        let stable = |a_n: f64| has_stable_delay(Groups::new(b, 0.0, a_n));
        assert!(
            stable(minimal * (1.0 + 1e-6)),
            "right below the minimal gain at b = {b}"
        );
        for a_n in fine(minimal * (1.0 - 1e-9), 0.0, 2_000) {
            assert!(!stable(a_n), "b {b} a_n {a_n}");
        }
    }
    assert_eq!(minimal_negative_load_gain(-1.0), -1.5);
    assert_eq!(minimal_negative_load_gain(-5.0), -17.5);
}

#[test]
fn positive_load_gain_stabilises_in_lobes_of_its_own() {
    assert!((minimal_positive_load_gain(-0.1) - 0.095).abs() < 1e-15);
    let stable = |b: f64, a_n: f64| has_stable_delay(Groups::new(b, 0.0, a_n));
    for b in [-0.01, -0.1, -0.2, -0.3, -0.35] {
        let minimal = minimal_positive_load_gain(b);
        assert!(
            fine(minimal, minimal + 0.05, 5_000).any(|a_n| stable(b, a_n)),
            "b {b}"
        );
        assert!(
            !fine(0.0, minimal * (1.0 - 1e-9), 5_000).any(|a_n| stable(b, a_n)),
            "b {b}"
        );
    }
    let end = LobeControl::PositiveLoad.lobe_end(0);
    assert!((end.b - -0.356_930_047).abs() < 1e-9);
    let near = |b: f64| {
        let minimal = minimal_positive_load_gain(b);
        fine(minimal, minimal + 1e-3, 20_000).any(|a_n| stable(b, a_n))
    };
    assert!(near(end.b + 1e-3));
    assert!(!near(end.b - 1e-3));
    assert!(!fine(0.0, 5.0, 50_000).any(|a_n| stable(-0.36, a_n)));
    let second = LobeControl::PositiveLoad.lobe_end(1);
    assert!((second.b - -0.167_365_699).abs() < 1e-9);
}

/// τ → 0: velocity control alone never stabilises; load control does if α_N < μ_K′ N0/(μ_K τ), the
/// letter's last equation on linear stability.
#[test]
fn short_delays_follow_the_letters_limit() {
    let tau = 1e-5;
    for b in [-0.05, -0.3, -0.7, -1.5] {
        for a_v in fine(-50.0, 50.0, 2_001) {
            assert_ne!(Crossings::of(Groups::new(b, a_v, 0.0)).n_unstable(tau), 0);
        }
        let limit = b / tau;
        let n = |a_n: f64| Crossings::of(Groups::new(b, 0.0, a_n)).n_unstable(tau);
        assert_eq!(n(limit * 1.001), 0);
        assert_ne!(n(limit * 0.999), 0);
    }
}

#[test]
fn the_parameters_of_fig_3_are_stable() {
    for case in known_cases::letter_fig3() {
        let count = Crossings::of(case.groups).count(case.tau, MarginalTolerance::default());
        assert!(count.stable(), "{}", case.source);
    }
}
