use super::*;
use crate::linear::Crossings;
use crate::linear::certificate::roots_right_of;
use crate::linear::characteristic::Jet;
use crate::linear::curves::FLATNESS;
use crate::linear::gains::load_gain_breakpoints;
use num_complex::Complex64;

type GroupsAt = fn(f64) -> (Groups, f64);

/// Planes of every kind with a window each.
fn planes() -> Vec<(GroupsAt, Window)> {
    let window = |p: std::ops::RangeInclusive<f64>, tau| Window { p, q: 0.0..=tau };
    vec![
        (
            |p| (Groups::new(-0.1, p, 0.0), 1.0),
            window(-1.6..=0.4, 12.0),
        ),
        (
            |p| (Groups::new(-0.3, p, -0.2), 1.0),
            window(-1.6..=0.4, 12.0),
        ),
        (
            |p| (Groups::new(-0.1, 0.0, p), 1.0),
            window(-8.0..=1.0, 12.0),
        ),
        (
            |p| (Groups::new(-0.02, 0.0, p), 1.0),
            window(-1.0..=1.0, 30.0),
        ),
        (
            |p| (Groups::new(-0.2, -0.3, p), 1.0),
            window(-4.0..=1.0, 15.0),
        ),
        // Sliding is stable without control as well.
        (
            |p| (Groups::new(0.3, p, 0.1), 1.0),
            window(-1.5..=1.5, 20.0),
        ),
        (
            |p| (Groups::new(p, 0.0, -0.4), 1.0),
            window(-1.5..=3.5, 12.0),
        ),
        (
            |p| (Groups::new(p, -0.5, 0.1), 1.0),
            window(-1.0..=3.0, 12.0),
        ),
        // Overdamped: real roots come to the line.
        (|p| (Groups::new(2.5, p, 0.0), 1.0), window(-4.0..=4.0, 8.0)),
        (|p| (Groups::new(2.2, 0.0, p), 1.0), window(-4.0..=6.0, 8.0)),
        // A mass as parameter, so that the unit of time varies.
        (
            |m: f64| {
                (
                    Groups::new(-0.2 / m.sqrt(), -0.4 * m.sqrt(), -0.3),
                    m.sqrt(),
                )
            },
            window(0.2..=4.0, 12.0),
        ),
    ]
}

const SIGMAS: [f64; 5] = [0.01, 0.05, 0.2, 0.45, 1.2];

fn right_of(groups_at: GroupsAt, p: f64, tau: f64, sigma: f64) -> Option<u64> {
    let (groups, unit) = groups_at(p);
    roots_right_of(groups, tau / unit, -sigma * unit)
}

/// Vertices of a piece that are not next to its ends.
fn inner(piece: &CurvePiece) -> impl Iterator<Item = &Vertex> {
    let (first, last) = (piece.vertices[0], piece.vertices[piece.vertices.len() - 1]);
    let apart = |v: &Vertex, w: Vertex| (v.p - w.p).hypot(v.q - w.q) > 1e-4;
    piece
        .vertices
        .iter()
        .filter(move |v| apart(v, first) && apart(v, last))
}

fn check(groups_at: GroupsAt, window: &Window, sigma: f64) -> PlaneCurves {
    let curves = trace(groups_at, sigma, window, &Stop::default()).unwrap();
    for piece in &curves.pieces {
        for v in &piece.vertices {
            let (groups, unit) = groups_at(v.p);
            let lambda = Complex64::new(-sigma, v.omega) * unit;
            let jet = Jet::at(groups, v.q / unit, lambda);
            let error = jet.rounding(groups, v.q / unit, lambda);
            assert!(jet.value.norm() <= 100.0 * error, "{v:?}: {jet:?}");
            assert!(v.omega >= 0.0);
            assert!(window.p.contains(&v.p), "{v:?}");
            assert!(window.q.start() - 1e-9 <= v.q && v.q <= window.q.end() + 1e-9);
        }
        let ps: Vec<f64> = piece.vertices.iter().map(|v| v.p).collect();
        assert!(ps.is_sorted() || ps.iter().rev().is_sorted(), "{ps:?}");
        let side = match piece.stable_side {
            StableSide::Shorter => -1e-7,
            StableSide::Longer => 1e-7,
            _ => unreachable!("every piece bounds the region"),
        };
        for v in inner(piece) {
            let count = |tau: f64| right_of(groups_at, v.p, tau, sigma);
            assert_eq!(count(v.q + side), Some(0), "σ = {sigma} {v:?} {side}");
            let beyond = if v.omega > 0.0 { 2 } else { 1 };
            assert_eq!(count(v.q - side), Some(beyond), "σ = {sigma} {v:?}");
        }
    }
    curves
}

#[test]
fn vertices_are_exact_and_their_sides_hold_what_they_say() {
    let (mut pieces, mut corners, mut real) = (0, 0, 0);
    for (groups_at, window) in planes() {
        for sigma in SIGMAS {
            let curves = check(groups_at, &window, sigma);
            pieces += curves.pieces.len();
            corners += curves.corners.len();
            let on_axis = |p: &&CurvePiece| p.vertices.iter().all(|v| v.omega == 0.0);
            real += curves.pieces.iter().filter(on_axis).count();
        }
    }
    assert!(
        pieces > 100 && corners > 20 && real > 5,
        "{pieces} {corners} {real}"
    );
}

/// Distance of a point from a segment, in widths of the window.
fn distance(window: &Window, (p, tau): (f64, f64), (v, w): (Vertex, Vertex)) -> f64 {
    let scaled = |dp: f64, dtau: f64| (dp / window.p_width(), dtau / window.q_width());
    let (dp, dt) = scaled(w.p - v.p, w.q - v.q);
    let (ep, et) = scaled(p - v.p, tau - v.q);
    let along = ((ep * dp + et * dt) / (dp * dp + dt * dt)).clamp(0.0, 1.0);
    (ep - along * dp).hypot(et - along * dt)
}

/// Every change of "no root right of the line" along lines through the window lies on a piece.
#[test]
fn no_boundary_is_missing() {
    let mut changes = 0;
    for (groups_at, window) in planes() {
        for sigma in SIGMAS {
            let curves = trace(groups_at, sigma, &window, &Stop::default()).unwrap();
            let segments: Vec<(Vertex, Vertex)> = curves
                .pieces
                .iter()
                .flat_map(|piece| piece.vertices.windows(2).map(|w| (w[0], w[1])))
                .collect();
            for i in 0..60 {
                // Irrational steps: off the columns.
                let part = (0.5 + 0.618_033_988_75 * f64::from(i)).fract();
                let p = window.p.start() + part * window.p_width();
                let at = |j: u32| window.q_width() * f64::from(j) / 1500.0;
                let decays = |tau: f64| right_of(groups_at, p, tau, sigma) == Some(0);
                for j in (0..1500).filter(|&j| decays(at(j)) != decays(at(j + 1))) {
                    let tau = at(j) + 0.5 * (at(1) - at(0));
                    let nearest = segments
                        .iter()
                        .map(|&segment| distance(&window, (p, tau), segment))
                        .fold(f64::INFINITY, f64::min);
                    let reach = 0.5 / 1500.0 + 2.0 * FLATNESS;
                    assert!(
                        nearest < reach,
                        "σ = {sigma}, p = {p}, τ = {tau}: {nearest}"
                    );
                    changes += 1;
                }
            }
        }
    }
    assert!(changes > 1000, "{changes}");
}

/// Every vertex is near the crossing curves of the imaginary axis when σ is small, and they are all
/// there.
#[test]
fn small_degrees_of_stability_tend_to_the_crossing_curves() {
    let window = Window {
        p: -3.0..=1.0,
        q: 0.0..=12.0,
    };
    let groups_at = |a_n: f64| (Groups::new(-0.1, 0.0, a_n), 1.0);
    let crossings_at = |a_n: f64| Crossings::of(groups_at(a_n).0);
    let breakpoints = load_gain_breakpoints(-0.1, 0.0);
    let limit =
        super::super::curves::trace(crossings_at, &breakpoints, &window, &Stop::default()).unwrap();
    let bounding: Vec<&CurvePiece> = limit
        .pieces
        .iter()
        .filter(|piece| piece.stable_side != StableSide::Neither)
        .collect();
    let near = |v: &Vertex, pieces: &[&CurvePiece]| {
        pieces.iter().any(|piece| {
            let mut segments = piece.vertices.windows(2);
            segments.any(|w| distance(&window, (v.p, v.q), (w[0], w[1])) < 1e-3)
        })
    };
    let curves = trace(groups_at, 1e-6, &window, &Stop::default()).unwrap();
    let pieces: Vec<&CurvePiece> = curves.pieces.iter().collect();
    assert!(pieces.len() >= bounding.len());
    for v in pieces.iter().flat_map(|piece| &piece.vertices) {
        assert!(near(v, &bounding), "{v:?}");
    }
    for v in bounding.iter().flat_map(|piece| &piece.vertices) {
        assert!(near(v, &pieces), "{v:?}");
    }
}

#[test]
fn corners_have_both_roots_on_the_line() {
    for (groups_at, window) in planes() {
        for sigma in SIGMAS {
            let curves = trace(groups_at, sigma, &window, &Stop::default()).unwrap();
            for corner in &curves.corners {
                let (groups, unit) = groups_at(corner.p);
                for (omega, _) in [corner.upper, corner.lower] {
                    let lambda = Complex64::new(-sigma, omega) * unit;
                    let value = Jet::at(groups, corner.q / unit, lambda).value;
                    assert!(value.norm() < 1e-11, "{corner:?} {value}");
                }
            }
        }
    }
}

/// The ends of pieces inside the window that are not ends of another piece. There should be none.
fn loose_ends(curves: &PlaneCurves, window: &Window) -> Vec<Vertex> {
    let ends: Vec<Vertex> = curves
        .pieces
        .iter()
        .flat_map(|p| [p.vertices[0], p.vertices[p.vertices.len() - 1]])
        .collect();
    let loose = |(i, v): (usize, &Vertex)| {
        let edge = [*window.p.start(), *window.p.end()].contains(&v.p)
            || v.q < 1e-9
            || (v.q - window.q.end()).abs() < 1e-9;
        let mut others = ends.iter().enumerate();
        let met = others.any(|(j, w)| i != j && v.p == w.p && v.q == w.q);
        (!edge && !met).then_some(*v)
    };
    ends.iter().enumerate().filter_map(loose).collect()
}

#[test]
fn boundaries_end_only_at_the_window() {
    for (groups_at, window) in planes() {
        for sigma in SIGMAS {
            let curves = trace(groups_at, sigma, &window, &Stop::default()).unwrap();
            let loose = loose_ends(&curves, &window);
            assert!(loose.is_empty(), "σ = {sigma}, {window:?}: {loose:?}");
        }
    }
}

/// Also in planes across the groups in any direction, boundaries end only at the window.
#[test]
fn boundaries_end_only_at_the_window_of_random_planes() {
    let mut random = 0.5_f64;
    let mut number = |from: f64, to: f64| {
        random = (random + 0.618_033_988_749_895).fract();
        let folded = (random * 7919.0).fract();
        from + (to - from) * folded
    };
    let mut pieces = 0;
    for _ in 0..300 {
        let from = [number(-1.0, 2.5), number(-2.0, 2.0), number(-3.0, 2.0)];
        let to = [number(-1.0, 2.5), number(-2.0, 2.0), number(-3.0, 2.0)];
        let groups_at = |p: f64| {
            let at = [0, 1, 2].map(|i| from[i] + p * (to[i] - from[i]));
            (Groups::new(at[0], at[1], at[2]), 1.0)
        };
        let window = Window {
            p: 0.0..=1.0,
            q: 0.0..=number(1.0, 40.0),
        };
        let sigma = 10f64.powf(number(-3.0, 0.3));
        let curves = trace(groups_at, sigma, &window, &Stop::default()).unwrap();
        let loose = loose_ends(&curves, &window);
        assert!(
            loose.is_empty(),
            "σ = {sigma}, {from:?} {to:?} {window:?}: {loose:?}"
        );
        pieces += curves.pieces.len();
    }
    assert!(pieces > 300, "{pieces}");
}

#[test]
fn nothing_is_traced_twice_or_differently() {
    for (groups_at, window) in planes() {
        let first = trace(groups_at, 0.05, &window, &Stop::default()).unwrap();
        assert_eq!(
            first,
            trace(groups_at, 0.05, &window, &Stop::default()).unwrap()
        );
        let mut middles: Vec<(f64, f64)> = first
            .pieces
            .iter()
            .map(|p| p.vertices[p.vertices.len() / 2])
            .map(|v| (v.p, v.q))
            .collect();
        middles.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in middles.windows(2) {
            assert!((pair[0].0 - pair[1].0).hypot(pair[0].1 - pair[1].1) > 1e-9);
        }
    }
}
