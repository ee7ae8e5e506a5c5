//! The referee itself, where there is a closed form or another source: its curve through points,
//! slips, sticks, orders of error, critical velocities.

use std::f64::consts::PI;

use super::block::{Block, Event, Mode};
use super::law::{Friction, Law};
use super::pchip::Curve;
use super::ramp::{self, End, Ramp};
use super::setting::Setting;
use super::steps::Pace;
use super::switch_on::{self, Fate};

fn setting(law: Law, gains: (f64, f64), tau: f64, v0: f64) -> Setting {
    Setting::plain(Friction { law, mu_s: 1.0 }, gains, tau, v0)
}

fn never(setting: Setting) -> Setting {
    Setting {
        switch_on: f64::INFINITY,
        ..setting
    }
}

const LETTERS: Law = Law::LETTERS;

/// Events with times and elongations until `end`.
fn events(block: &mut Block, end: f64) -> Vec<(Event, f64, f64)> {
    let mut events = Vec::new();
    while block.t < end {
        let event = block.advance(end);
        events.extend(event.map(|event| (event, block.t, block.a)));
    }
    events
}

/// Values and slopes are those of SciPy 1.17.1: `PchipInterpolator(x, y)` and its `derivative()`.
#[test]
fn the_curve_is_scipys() {
    let measured = Curve::through(
        &[0.05, 0.15, 0.3, 0.55, 0.9, 1.4],
        &[0.52, 0.44, 0.33, 0.27, 0.29, 0.36],
    );
    let turned = Curve::through(&[0.0, 0.1, 0.3], &[0.9, 0.4, 0.5]);
    let held_back = Curve::through(&[0.0, 1.0, 1.1], &[0.9, 0.8, 1.2]);
    let flat_at_the_end = Curve::through(&[0.0, 1.0, 1.1, 1.3], &[0.9, 0.8, 0.3, 0.31]);
    let straight = Curve::through(&[0.1, 0.4], &[0.9, 0.6]);
    for (curve, x, value, slope) in [
        (&measured, 0.1, 0.47925968992248064, -0.8014728682170545),
        (&measured, 0.25, 0.3583823283327123, -0.7219638242894054),
        (&measured, 0.5, 0.2732192610250298, -0.12467413587604292),
        (&measured, 0.6, 0.2706229656112505, 0.024202616630203223),
        (&measured, 1.3, 0.3419078935667445, 0.1726202659433159),
        (&turned, 0.02, 0.7605333333333335, -6.986666666666666),
        (&turned, 0.2, 0.4125, 0.375),
        (&held_back, 0.3, 0.8343, -0.147),
        (&held_back, 1.05, 0.9453409090909092, 4.906818181818176),
        (
            &flat_at_the_end,
            0.3,
            0.8951391304347825,
            -0.03831884057971015,
        ),
        (
            &flat_at_the_end,
            1.07,
            0.4063260869565219,
            -6.212318840579705,
        ),
        (&straight, 0.2, 0.8, -1.0),
    ] {
        let piece = curve.piece(x);
        let errors = [curve.value(piece, x) - value, curve.slope(piece, x) - slope];
        assert!(errors.iter().all(|e| e.abs() < 1e-14), "{x} {errors:?}");
    }
    // Constant outside.
    assert_eq!(measured.value(0, 0.01), 0.52);
    assert_eq!(measured.value(measured.piece(2.0), 2.0), 0.36);
    assert_eq!(measured.slope(measured.piece(2.0), 2.0), 0.0);
}

/// A slip from a = μ_S goes along ẋ = v0 (1 − cos t) + (μ_S − μ0) sin t until tan(t/2) = −(μ_S −
/// μ0)/v0, and ends at a = 2 μ0 − μ_S; the stick lasts 2 (μ_S − μ0)/v0.
#[test]
fn uncontrolled_coulomb_friction_has_its_closed_form() {
    for (mu0, v0) in [(0.4, 0.1), (0.7, 1.3)] {
        let free = never(setting(Law::Coulomb { mu0 }, (0.0, 0.0), 1.0, v0));
        let mut block = Block::at_rest_or_sliding(free, Pace::of(0.25), 0.0, 0.9);
        let slip = 2.0 * (PI - ((1.0 - mu0) / v0).atan());
        let stick = 2.0 * (1.0 - mu0) / v0;
        let found = events(&mut block, 3.0 * (slip + stick));
        let mut t = 0.1 / v0;
        for (i, (event, at, a)) in found.into_iter().enumerate() {
            let (expected, elongation) = match i % 2 {
                0 => (Event::Release, 1.0),
                _ => (Event::Stick, 2.0 * mu0 - 1.0),
            };
            assert_eq!(event, expected);
            assert!((at - t).abs() < 1e-9 && (a - elongation).abs() < 1e-9);
            t += if i % 2 == 0 { slip } else { stick };
        }
    }
}

/// Coulomb slip under load control over the first delay: a″ = −(1 − μα)(a − a*), with a constant
/// delayed elongation.
#[test]
fn a_controlled_slip_has_its_closed_form() {
    let (mu, alpha, tau, v0, u0, a0) = (0.4_f64, -1.5, 3.0, 1.0, 1.3, 0.5);
    let given = setting(Law::Coulomb { mu0: mu }, (0.0, alpha), tau, v0);
    let mut block = Block::at_rest_or_sliding(given, Pace::of(0.5), u0, a0);
    events(&mut block, 2.5);
    let w2: f64 = 1.0 - mu * alpha;
    let (w, rest) = (w2.sqrt(), mu * (1.0 - alpha * a0) / w2);
    let (c, s) = ((w * block.t).cos(), (w * block.t).sin());
    let exact = rest + (a0 - rest) * c + (v0 - u0) / w * s;
    assert!((block.a - exact).abs() < 1e-10, "{} {exact}", block.a);
}

/// Stick under velocity control: over the first delay a = a0 + v0 (e^(αt) − 1)/α, over the second
/// one, with s = t − τ, a = a0 − 2 v0/α + (C − v0 s) e^(αs).
#[test]
fn a_controlled_stick_has_its_closed_form() {
    let (alpha, tau, v0, a0) = (-0.8_f64, 0.7, 0.1, -0.3);
    let given = setting(LETTERS, (alpha, 0.0), tau, v0);
    let mut block = Block::at_rest_or_sliding(given, Pace::of(0.5), 0.0, a0);
    let first = |t: f64| a0 + v0 * ((alpha * t).exp() - 1.0) / alpha;
    events(&mut block, 0.6);
    assert!((block.a - first(0.6)).abs() < 1e-10);
    events(&mut block, 1.3);
    let rest = a0 - 2.0 * v0 / alpha;
    let s = 1.3 - tau;
    let second = rest + (first(tau) - rest - v0 * s) * (alpha * s).exp();
    assert!((block.a - second).abs() < 1e-10, "{} {second}", block.a);
    assert_eq!(block.mode, Mode::Stick);
}

/// The letter's Fig. 3 (a) and (b), see the project's physics: the ends of the last sticks.
fn fig3(part: usize, pace: Pace) -> f64 {
    let (gains, tau, v0) = [((-0.33, 0.0), 4.15, 0.35), ((0.0, -10.0), 0.5, 0.1)][part];
    let switched = Setting {
        switch_on: 70.0,
        ..setting(LETTERS, gains, tau, v0)
    };
    let rest = 0.5 / (1.0 + v0 / 0.5);
    let mut block = Block::at_rest_or_sliding(switched, pace, 1.01 * v0, rest);
    let found = events(&mut block, 150.0);
    let last = found.last().expect("events");
    assert_eq!(last.0, Event::Release, "it slides on");
    last.1
}

#[test]
fn the_letters_figure_3_has_its_last_release() {
    for (part, expected) in [97.029009396, 76.277483031].into_iter().enumerate() {
        let found = fig3(part, Pace::of(0.5));
        assert!((found - expected).abs() < 1e-8, "{found} {expected}");
    }
}

/// Errors fall with the fourth power of the step.
#[test]
fn steps_are_of_the_fourth_order() {
    let exact = fig3(0, Pace::of(0.125));
    let errors = [4.0, 2.0, 1.0].map(|share| (fig3(0, Pace::of(share)) - exact).abs());
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((3.5..4.8).contains(&order), "{errors:?}");
    }
}

/// Velocities of the project's physics, for the letter's Fig. 3: by `follow`, and by switching on
/// at a phase.
#[test]
fn critical_velocities_of_the_letters_figure_3() {
    let ramp = Ramp {
        pace: Pace::of(2.0),
        largest: 0.05,
        stops: 30,
        begin: ramp::Begin::Released,
    };
    for (gains, tau, expected) in [
        ((-0.33, 0.0), 4.15, 0.344467),
        ((0.0, -10.0), 0.5, 0.021540),
    ] {
        let found = ramp::critical_velocity(&setting(LETTERS, gains, tau, 1.0), ramp);
        assert!(found.is_near(End::Lost(expected), 4e-5), "{found:?}");
    }
    for (phase, edge) in [(0.0, 0.233773), (0.2, 0.260146), (1.0, 0.344467)] {
        for (v0, expected) in [(edge - 1e-5, Fate::Survives), (edge + 1e-5, Fate::Ends)] {
            let given = setting(LETTERS, (-0.33, 0.0), 4.15, v0);
            let found = switch_on::fate(&given, Pace::of(1.0), phase, 60.0);
            assert_eq!(found, Some(expected), "{phase} {v0}");
        }
    }
}
