//! Exact boundaries over planes of two parameters of general systems: against closed forms, the
//! letter's own curves, and counts right beside every curve.

use std::f64::consts::TAU;

use crate::letter_system::letter;
use num_complex::Complex64;
use slipmap::linear::Crossings;
use slipmap::linear::curves::{
    CurveKind, CurvePiece, PlaneCurves, StableSide, Vertex, Window, trace as trace_letter,
};
use slipmap::linear::gains::{load_gain_breakpoints, velocity_gain_breakpoints};
use slipmap::linear::general::curves::trace;
use slipmap::linear::general::{Polynomial, RootCounter, System, SystemPlane, SystemSetting};
use slipmap::model::stop::Stop;
use slipmap::model::{Channel, Groups};

fn polynomial(coefficients: &[f64]) -> Polynomial {
    Polynomial::new(coefficients).unwrap()
}

fn setting(system: System, tau: f64) -> Option<SystemSetting> {
    (tau >= 0.0).then_some(SystemSetting {
        system,
        tau,
        unit: 1.0,
    })
}

fn turning(zeta: f64, width: f64) -> System {
    System::of_coefficients(&[1.0 + width, 2.0 * zeta, 1.0], &[-width]).unwrap()
}

fn count(setting: SystemSetting, sigma: f64) -> Option<u64> {
    RootCounter::new(&setting.system)
        .right_of(setting.delay(), -sigma * setting.unit)
        .finite()
}

/// Where the curves cross the column p, by growing q, each with the change in the number of roots
/// right of the line.
fn along_column(curves: &PlaneCurves, p: f64) -> Vec<(f64, i64)> {
    let mut at = Vec::new();
    for piece in &curves.pieces {
        for pair in piece.vertices.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            if (a.p <= p) != (b.p <= p) {
                let q = a.q + (b.q - a.q) * (p - a.p) / (b.p - a.p);
                let roots = match piece.kind {
                    CurveKind::Pair => 2,
                    _ => 1,
                };
                at.push((q, roots * i64::from(piece.direction.sign())));
            }
        }
    }
    at.sort_by(|a, b| a.0.total_cmp(&b.0));
    at
}

type At<'a> = &'a dyn Fn(f64, f64) -> Option<SystemSetting>;

/// Along columns off those of the search the counts are what the curves between make of the count
/// at the lower edge.
fn check_counts(name: &str, at: At, window: &Window, curves: &PlaneCurves) -> usize {
    let (width, height) = (
        window.p.end() - window.p.start(),
        window.q.end() - window.q.start(),
    );
    let mut checked = 0;
    for i in 0..90 {
        let p = window.p.start() + (0.5 + 0.618_033_988_75 * f64::from(i)).fract() * width;
        let crossed = along_column(curves, p);
        let mut from: Option<(f64, u64)> = None;
        for j in 0..60 {
            let q = window.q.start() + (f64::from(j) + 0.37) / 60.0 * height;
            // Polylines are exact at their vertices only.
            if crossed.iter().any(|(c, _)| (c - q).abs() < 2e-3 * height) {
                continue;
            }
            let Some(here) = at(p, q).and_then(|s| count(s, 0.0)) else {
                continue;
            };
            if let Some((before, known)) = from {
                let between = crossed.iter().filter(|(c, _)| before < *c && *c < q);
                let change: i64 = between.map(|(_, change)| change).sum();
                assert_eq!(
                    here as i64,
                    known as i64 + change,
                    "{name}: p = {p}, q from {before} to {q}, {crossed:?}"
                );
                checked += 1;
            }
            from = Some((q, here));
        }
    }
    checked
}

/// Right beside every vertex the count changes as the piece says, and is 0 where it says that.
fn check_sides(name: &str, at: At, window: &Window, curves: &PlaneCurves, sigma: f64) -> usize {
    let (width, height) = (
        window.p.end() - window.p.start(),
        window.q.end() - window.q.start(),
    );
    let ends: Vec<Vertex> = curves
        .pieces
        .iter()
        .flat_map(|p| [p.vertices[0], p.vertices[p.vertices.len() - 1]])
        .collect();
    let mut checked = 0;
    for piece in curves.pieces.iter().filter(|p| p.kind == CurveKind::Pair) {
        for (i, v) in piece.vertices.iter().enumerate() {
            let near = |w: &Vertex| ((v.p - w.p) / width).hypot((v.q - w.q) / height) < 1e-3;
            if i == 0 || i + 1 == piece.vertices.len() || ends.iter().any(near) {
                continue;
            }
            let (before, after) = (piece.vertices[i - 1], piece.vertices[i + 1]);
            let slope = ((after.q - before.q) / height) / ((after.p - before.p) / width);
            let by = 1e-6 * (1.0 + slope.abs());
            if !by.is_finite() || by > 1e-4 {
                continue;
            }
            let count = |by: f64| at(v.p, v.q + by * height).and_then(|s| count(s, sigma));
            let both = |by: f64| Some((count(-by)?, count(by)?));
            let Some((below, above)) = both(by).or_else(|| both(10.0 * by)) else {
                // Infinitely many.
                assert_eq!(piece.stable_side, StableSide::Neither, "{name}: {v:?}");
                continue;
            };
            let change = 2 * i64::from(piece.direction.sign());
            assert_eq!(above as i64 - below as i64, change, "{name}: {v:?}");
            let side = match (below, above) {
                (0, _) => StableSide::Shorter,
                (_, 0) => StableSide::Longer,
                _ => StableSide::Neither,
            };
            assert_eq!(piece.stable_side, side, "{name}: {v:?} {below} {above}");
            checked += 1;
        }
    }
    checked
}

fn check(name: &str, at: At, window: &Window, plane: &SystemPlane) -> PlaneCurves {
    let curves = trace(plane, 0.0).unwrap();
    let sides = check_sides(name, at, window, &curves, 0.0);
    let counts = check_counts(name, at, window, &curves);
    println!(
        "{name}: {} pieces, {} corners, {sides} sides, {counts} counts",
        curves.pieces.len(),
        curves.corners.len()
    );
    assert!(sides > 20 && counts > 1000, "{name}: {sides} {counts}");
    curves
}

fn lines(name: &str, window: &Window, system_at: &dyn Fn(f64) -> System) -> PlaneCurves {
    let at = |p: f64, tau: f64| setting(system_at(p), tau);
    check(name, &at, window, &SystemPlane::of_lines(&at, window))
}

fn plane(name: &str, window: &Window, at: At, delays: [bool; 2]) -> PlaneCurves {
    check(name, at, window, &SystemPlane::new(at, window, delays))
}

/// Distance of a point from a curve, in widths of the window.
fn distance(window: &Window, v: &Vertex, piece: &CurvePiece) -> f64 {
    let width = window.p.end() - window.p.start();
    let height = window.q.end() - window.q.start();
    let segments = piece.vertices.windows(2).map(|pair| {
        let scaled = |a: &Vertex, b: &Vertex| ((b.p - a.p) / width, (b.q - a.q) / height);
        let (dp, dq) = scaled(&pair[0], &pair[1]);
        let (ep, eq) = scaled(&pair[0], v);
        let part = ((ep * dp + eq * dq) / (dp * dp + dq * dq)).clamp(0.0, 1.0);
        (ep - part * dp).hypot(eq - part * dq)
    });
    segments.fold(f64::INFINITY, f64::min)
}

/// The letter's curves by ω and those of the same system taken for a general one.
#[test]
fn the_letters_curves() {
    for b in [-0.7, -0.2, -0.05, 0.1] {
        for velocity in [false, true] {
            let groups_at = |gain: f64| match velocity {
                true => Groups::new(b, gain, 0.1),
                false => Groups::new(b, -0.1, gain),
            };
            let (p, breakpoints) = match velocity {
                true => (-1.6..=0.4, velocity_gain_breakpoints(b, 0.1, 0.0)),
                false => (-5.0..=1.0, load_gain_breakpoints(b, -0.1)),
            };
            let window = Window { p, q: 0.5..=12.0 };
            let crossings = |p: f64| Crossings::of(groups_at(p));
            let expected =
                trace_letter(crossings, &breakpoints, &window, &Stop::default()).unwrap();
            let name = format!("letter b = {b}, velocity {velocity}");
            let curves = lines(&name, &window, &|p| letter(groups_at(p), 0.0, 0.0));
            let near = |v: &Vertex, side: StableSide, pieces: &[CurvePiece]| {
                let mut same = pieces.iter().filter(|p| p.stable_side == side);
                same.any(|piece| distance(&window, v, piece) < 1e-3)
            };
            for (from, to) in [(&expected, &curves), (&curves, &expected)] {
                for piece in &from.pieces {
                    let inner = &piece.vertices[1..piece.vertices.len() - 1];
                    for v in inner {
                        assert!(near(v, piece.stable_side, &to.pieces), "{name}: {v:?}");
                    }
                }
                for corner in &from.corners {
                    let same = |c: &&slipmap::linear::curves::Corner| {
                        (c.p - corner.p).abs() < 1e-9
                            && (c.q - corner.q).abs() < 1e-9
                            && c.bounds_stable == corner.bounds_stable
                    };
                    assert!(to.corners.iter().any(|c| same(&c)), "{name}: {corner:?}");
                }
            }
        }
    }
}

/// Lobes of turning: their lowest points are 2ζ(1 + ζ) at ω² = 1 + 2ζ.
#[test]
fn lobes_of_turning() {
    for zeta in [0.02, 0.1] {
        let window = Window {
            p: 0.0..=1.0,
            q: 1.0..=25.0,
        };
        let curves = lines("turning", &window, &|width| turning(zeta, width));
        let mut lowest = curves
            .pieces
            .iter()
            .flat_map(|piece| &piece.vertices)
            .filter(|v| (v.p - 2.0 * zeta * (1.0 + zeta)).abs() < 1e-10)
            .peekable();
        assert!(lowest.peek().is_some(), "{zeta}");
        for v in lowest {
            assert!((v.omega * v.omega - 1.0 - 2.0 * zeta).abs() < 1e-5, "{v:?}");
        }
        let least = curves.pieces.iter().flat_map(|piece| &piece.vertices);
        let least = least.map(|v| v.p).fold(f64::INFINITY, f64::min);
        assert!((least - 2.0 * zeta * (1.0 + zeta)).abs() < 1e-12, "{least}");
    }
}

/// The delayed oscillator ẍ + δx = b x(t − 2π): its boundaries are b = (−1)^k (δ − k²/4), k = 0 that
/// of a root at the origin.
#[test]
fn triangles_of_the_delayed_oscillator() {
    let window = Window {
        p: -0.9..=5.2,
        q: -1.3..=1.4,
    };
    let at = |delta: f64, b: f64| {
        let system = System::of_coefficients(&[delta, 0.0, 1.0], &[-b]).unwrap();
        setting(system, TAU)
    };
    let curves = plane("delayed oscillator", &window, &at, [false, false]);
    for piece in &curves.pieces {
        let bounds = piece.stable_side != StableSide::Neither;
        for v in &piece.vertices {
            let on = |k: i32| {
                let sign = f64::from(1 - 2 * (k % 2));
                (v.q - sign * (v.p - f64::from(k * k) / 4.0)).abs()
            };
            let nearest = (0..8).map(on).fold(f64::INFINITY, f64::min);
            // Without feedback, b = 0, the pair is on the axis as well.
            assert!(nearest < 1e-11 || v.q.abs() < 1e-11, "{v:?}");
            if bounds && piece.kind == CurveKind::RealRoot {
                assert!(on(0) < 1e-11, "{v:?}");
            }
        }
    }
    // The corner of the triangle between k = 0 and 1, and that between k = 1 and 2.
    let corner = |k: f64| {
        (
            0.5 * (k * k / 4.0 + (k + 1.0) * (k + 1.0) / 4.0),
            (2.0 * k + 1.0) / 8.0,
        )
    };
    for k in [0.0, 1.0, 2.0] {
        let (delta, b) = corner(k);
        let met = curves.pieces.iter().flat_map(|piece| {
            let last = piece.vertices[piece.vertices.len() - 1];
            [piece.vertices[0], last]
        });
        let met = met.filter(|v| (v.p - delta).abs() < 1e-6 && (v.q.abs() - b).abs() < 1e-6);
        assert!(met.count() >= 2, "{k}");
    }
}

#[test]
fn pendulum() {
    let window = Window {
        p: -0.5..=2.0,
        q: 0.05..=6.0,
    };
    // An inverted pendulum held by delayed PD feedback: the root at the origin at k_p = 0.5.
    let curves = lines("pendulum", &window, &|k_p| {
        System::of_coefficients(&[-0.5, 0.1, 1.0], &[k_p, 0.8]).unwrap()
    });
    let upright = curves
        .pieces
        .iter()
        .filter(|p| p.kind == CurveKind::RealRoot);
    for v in upright.flat_map(|p| &p.vertices) {
        assert!((v.p - 0.5).abs() < 1e-15, "{v:?}");
    }
    assert!(
        curves
            .pieces
            .iter()
            .any(|p| p.stable_side == StableSide::Above)
    );
    let at = |k_p: f64, k_d: f64| {
        setting(
            System::of_coefficients(&[-0.5, 0.0, 1.0], &[k_p, k_d]).unwrap(),
            0.6,
        )
    };
    let window = Window {
        p: -0.5..=4.0,
        q: -1.0..=4.0,
    };
    let curves = plane("pendulum, gains", &window, &at, [false, false]);
    assert!(
        curves
            .pieces
            .iter()
            .any(|p| p.stable_side == StableSide::Above)
    );
}

/// Neutral equations: feedback of the acceleration, memory.
#[test]
fn neutral_planes() {
    // Feedback of the acceleration: neutral beyond k_a = 1.
    let at = |k_a: f64, tau: f64| {
        setting(
            System::of_coefficients(&[-0.5, 0.3, 1.0], &[1.2, 1.0, k_a]).unwrap(),
            tau,
        )
    };
    let window = Window {
        p: -1.4..=1.4,
        q: 0.02..=3.0,
    };
    let curves = lines("pendulum, acceleration", &window, &|k_a| {
        at(k_a, 1.0).unwrap().system
    });
    let limit = curves
        .pieces
        .iter()
        .filter(|p| p.kind == CurveKind::LeadingCoefficient);
    assert!(limit.clone().count() > 1);
    for v in limit.flat_map(|p| &p.vertices) {
        assert!((v.p.abs() - 1.0).abs() < 1e-15, "{v:?}");
    }
    // Memory.
    let window = Window {
        p: -1.6..=0.4,
        q: 0.5..=15.0,
    };
    lines("velocity, memory", &window, &|a_v| {
        letter(Groups::new(-0.5, a_v, 0.0), 0.4, 0.0)
    });
    let at = |memory: f64, a_v: f64| setting(letter(Groups::new(-0.5, a_v, 0.0), memory, 0.0), 5.0);
    let window = Window {
        p: -0.95..=0.95,
        q: -2.0..=1.0,
    };
    plane("velocity, memory and gain", &window, &at, [false, false]);
}

/// The boundary of the region where all roots decay faster than e^(−σt): as the letter's own, and
/// counts beside it.
#[test]
fn degrees_of_stability() {
    let window = Window {
        p: -1.6..=0.4,
        q: 0.0..=12.0,
    };
    let groups_at = |a_v: f64| (Groups::new(-0.1, a_v, 0.0), 1.0);
    for sigma in [0.01, 0.05, 0.2] {
        let expected =
            slipmap::linear::decay::trace(groups_at, sigma, &window, &Stop::default()).unwrap();
        let at = |p: f64, tau: f64| setting(letter(groups_at(p).0, 0.0, 0.0), tau);
        let curves = trace(&SystemPlane::of_lines(&at, &window), sigma).unwrap();
        assert!(!curves.pieces.is_empty(), "{sigma}");
        for (from, to) in [(&expected, &curves), (&curves, &expected)] {
            for v in from.pieces.iter().flat_map(|piece| &piece.vertices) {
                let near = |piece: &CurvePiece| distance(&window, v, piece) < 1e-3;
                assert!(to.pieces.iter().any(near), "{sigma}: {v:?}");
            }
        }
        check_sides("letter", &at, &window, &curves, sigma);
    }
}

fn check_degree(
    name: &str,
    window: &Window,
    plane: &SystemPlane,
    at: At,
    sigma: f64,
) -> PlaneCurves {
    let curves = trace(plane, sigma).unwrap();
    let sides = check_sides(name, at, window, &curves, sigma);
    println!(
        "{name}, σ = {sigma}: {} pieces, {sides} sides",
        curves.pieces.len()
    );
    assert!(sides > 20, "{name}");
    curves
}

#[test]
fn degrees_of_stability_of_other_systems() {
    let window = Window {
        p: -1.6..=0.4,
        q: 0.0..=12.0,
    };
    let at = |p: f64, tau: f64| setting(letter(Groups::new(-0.1, p, 0.0), 0.3, 0.0), tau);
    let of_memory = SystemPlane::of_lines(&at, &window);
    check_degree("memory", &window, &of_memory, &at, 0.1);
    // Roots accumulate at ln 0.3/τ: right of the line from τ = −ln 0.3/σ on.
    let curves = check_degree("memory", &window, &of_memory, &at, 0.2);
    let limit = curves
        .pieces
        .iter()
        .filter(|p| p.kind == CurveKind::LeadingCoefficient);
    for v in limit.flat_map(|p| &p.vertices) {
        assert!((v.q + 0.3_f64.ln() / 0.2).abs() < 1e-9, "{v:?}");
    }
    // Two modes, degree 4.
    let at = |width: f64, tau: f64| {
        let modes = [polynomial(&[1.0, 0.1, 1.0]), polynomial(&[4.0, 0.3, 1.0])];
        let fed = modes[1].plus(&modes[0], 0.7);
        let own = modes[0].times(&modes[1]).unwrap();
        setting(
            System::direct(own.plus(&fed, width), Polynomial::ZERO.plus(&fed, -width)),
            tau,
        )
    };
    let window = Window {
        p: -0.1..=0.6,
        q: 0.0..=15.0,
    };
    check_degree(
        "two modes",
        &window,
        &SystemPlane::of_lines(&at, &window),
        &at,
        0.02,
    );
    let at = |k_p: f64, k_d: f64| {
        setting(
            System::of_coefficients(&[-0.5, 0.0, 1.0], &[k_p, k_d]).unwrap(),
            0.3,
        )
    };
    let window = Window {
        p: -0.5..=8.0,
        q: -1.0..=6.0,
    };
    check_degree(
        "gains",
        &window,
        &SystemPlane::new(&at, &window, [false, false]),
        &at,
        0.4,
    );
}

/// The plane of both delays, τ and the latency δ. Where R = 0 its curves are known by ω:
/// ωτ = ±arccos(1 − |B|²/2|A|²) + 2πu and ωδ = arg[A(1 − E)/B] + 2πv.
#[test]
fn delay_and_latency() {
    let (b, a_v, a_n) = (-0.1, -0.4, -0.2);
    let open = polynomial(&[1.0, b, 1.0]);
    let gain = polynomial(&[a_n + a_v * b, a_v]);
    let groups = Groups::new(b, a_v, a_n);
    let at = |tau: f64, latency: f64| setting(letter(groups, 0.0, latency), tau);
    let window = Window {
        p: 0.05..=9.0,
        q: 0.0..=4.0,
    };
    let curves = plane("delay and latency", &window, &at, [true, true]);
    let (mut known, mut missing) = (0, 0);
    for i in 1..3000 {
        let lambda = Complex64::new(0.0, f64::from(i) * 1e-3);
        let (of_open, of_gain) = (open.value(lambda), gain.value(lambda));
        let cosine = 1.0 - of_open.norm_sqr() / (2.0 * of_gain.norm_sqr());
        if cosine < -1.0 {
            continue;
        }
        for turn in [cosine.acos(), -cosine.acos()] {
            for (u, v) in (0..6).flat_map(|u| (0..6).map(move |v| (u, v))) {
                let tau = (turn + TAU * f64::from(u)) / lambda.im;
                let late = of_gain * (1.0 - (-lambda * tau).exp()) / of_open;
                let latency = (late.arg() + TAU * f64::from(v)) / lambda.im;
                let vertex = Vertex {
                    p: tau,
                    q: latency,
                    omega: lambda.im,
                };
                let within = window.p.contains(&tau) && window.q.contains(&latency);
                if within {
                    let near = |piece: &&CurvePiece| distance(&window, &vertex, piece) < 1e-3;
                    known += 1;
                    missing += usize::from(!curves.pieces.iter().any(|p| near(&p)));
                }
            }
        }
    }
    assert!(known > 500 && missing == 0, "{missing} of {known}");
    // With memory, along the delay at one latency.
    let window = Window {
        p: -1.5..=0.3,
        q: 0.2..=10.0,
    };
    lines("late feedback", &window, &|a_v| {
        let gain = polynomial(&[a_v * -0.5, a_v]);
        System::feedback(
            polynomial(&[1.0, -0.5, 1.0]),
            gain,
            Channel {
                memory: 0.3,
                latency: 0.4,
            },
        )
    });
}

/// Curves of a degree of stability between two gains: each is there once, also where its pair meets
/// on the real axis, and on it λ = −σ + iω solves D by hand. With P = λ² − 1 and Q = k_p + k_d λ the
/// gains are k_p + k_d λ = −(λ² − 1) e^(λτ).
#[test]
fn a_curve_of_a_degree_of_stability_is_there_once() {
    const DELAY: f64 = 0.3;
    let at = |k_d: f64, k_p: f64| {
        let system = System::of_coefficients(&[-1.0, 0.0, 1.0], &[k_p, k_d]);
        setting(system.unwrap(), DELAY)
    };
    let window = Window {
        p: -2.0..=3.0,
        q: -3.0..=4.0,
    };
    for sigma in [0.01, 0.03, 0.1, 0.2, 0.5, 1.0] {
        let curves = trace(&SystemPlane::new(&at, &window, [false; 2]), sigma).unwrap();
        let of_kind = |kind: CurveKind| curves.pieces.iter().filter(move |p| p.kind == kind);
        for kind in [CurveKind::Pair, CurveKind::RealRoot] {
            assert!(of_kind(kind).count() > 0, "{sigma}: {kind:?}");
            let pieces = of_kind(kind).cloned().collect();
            let alone = PlaneCurves {
                pieces,
                ..PlaneCurves::default()
            };
            for column in 0..500 {
                let p = -2.0 + 5.0 * (f64::from(column) + 0.5) / 500.0;
                let met = along_column(&alone, p);
                let apart = met.windows(2).all(|w| w[1].0 - w[0].0 > 1e-3);
                assert!(apart, "{sigma}: {kind:?} at {p}: {met:?}");
            }
        }
        for v in curves.pieces.iter().flat_map(|piece| &piece.vertices) {
            let lambda = Complex64::new(-sigma, v.omega);
            let feedback = -(lambda * lambda - 1.0) * (lambda * DELAY).exp();
            let off = (feedback - v.q - lambda * v.p).norm();
            assert!(off < 1e-9, "{sigma}: {v:?} {off}");
        }
    }
}
