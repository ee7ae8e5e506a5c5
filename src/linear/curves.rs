//! Crossing curves in the plane of one parameter p and the delay τ, cut where they cross one
//! another.
//!
//! Between two breakpoints of p (folds ω₋ = ω₊, and ω₋ = 0) each branch k of ω₊ and of ω₋ is a
//! smooth arc τ_k(p). An arc is parametrised by s in [0, 1] with p = p₀ + (p₁ − p₀)(1 − cos πs)/2,
//! which undoes the square root at a fold. Arcs are cut at corners, where τ_j(ω₊) = τ_k(ω₋): a
//! double Hopf point. On each piece the number of unstable roots on both sides is then constant,
//! and shows whether the piece bounds the stable region.

use std::ops::RangeInclusive;

use super::crossing::{Crossings, Direction, discriminant, frequency_product};
use super::roots::bisect;
use super::stretch::Stretch;
use crate::model::Groups;
use crate::model::stop::Stop;

/// A segment is fine enough when its middle is nearer to its chord than this part of the window.
pub(super) const FLATNESS: f64 = 2e-4;
/// More arcs than this in one window are refused: no picture could show them.
pub(super) const MOST_ARCS: u64 = 2000;
/// More corners than this in one window are refused, for the same reason.
pub(super) const MOST_CORNERS: u64 = 5000;

/// A point of a crossing curve, exact to rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// The plane's first parameter.
    pub p: f64,
    /// Its second one: the delay, in planes with it.
    pub q: f64,
    /// Crossing frequency; 0 for real roots, NaN where the leading coefficient vanishes.
    pub omega: f64,
}

/// What lies on the line along a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CurveKind {
    /// A complex pair of roots.
    #[default]
    Pair,
    /// A real root: at the origin, where the line is the imaginary axis.
    RealRoot,
    /// |p_n| = κ|q_n|, κ = e^(στ): roots accumulate at the line, or a root comes from infinity.
    LeadingCoefficient,
}

impl CurveKind {
    /// The kinds of curves.
    pub const ALL: [Self; 3] = [Self::Pair, Self::RealRoot, Self::LeadingCoefficient];

    /// Its place in [`CurveKind::ALL`].
    #[must_use]
    pub const fn number(self) -> i8 {
        self as i8
    }
}

/// On which side of a piece sliding is stable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StableSide {
    /// Roots are unstable on both sides: the piece bounds nothing.
    Neither,
    /// At shorter delays: smaller q.
    Shorter,
    /// At longer delays: larger q.
    Longer,
    /// At smaller p, where p is the same all along the piece.
    Below,
    /// At larger p, where p is the same all along the piece.
    Above,
}

impl StableSide {
    /// −1 at shorter delays, 0 on neither side, 1 at longer ones; ∓2 at smaller and larger p.
    #[must_use]
    pub(crate) const fn sign(self) -> i8 {
        match self {
            Self::Below => -2,
            Self::Shorter => -1,
            Self::Neither => 0,
            Self::Longer => 1,
            Self::Above => 2,
        }
    }

    /// The side with this [`StableSide::sign`]; `Neither` for other numbers.
    #[must_use]
    pub(crate) const fn of_sign(sign: i8) -> Self {
        match sign {
            -2 => Self::Below,
            -1 => Self::Shorter,
            1 => Self::Longer,
            2 => Self::Above,
            _ => Self::Neither,
        }
    }
}

/// A piece of a crossing curve between its corners, its folds and the edges of the window.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvePiece {
    /// What lies on the line along it.
    pub kind: CurveKind,
    /// Branch number k of the letter's Eq. (5).
    pub branch: u64,
    /// How the root moves there as the delay, or q, grows; as p grows where p is the same all along
    /// the piece. A touch where that is not known.
    pub direction: Direction,
    /// Where the stable region lies.
    pub stable_side: StableSide,
    /// At least two points, by growing arc parameter.
    pub vertices: Vec<Vertex>,
}

/// A point where two curves cross: two pairs lie on the axis at once; in the letter's planes on one
/// of ω₊ and on one of ω₋.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// The plane's first parameter.
    pub p: f64,
    /// Its second one: the delay, in planes with it.
    pub q: f64,
    /// Larger frequency, with its branch; on the imaginary axis that of the pair that crosses to
    /// the right.
    pub upper: (f64, u64),
    /// Smaller frequency, with its branch; on the imaginary axis that of the pair that crosses to
    /// the left.
    pub lower: (f64, u64),
    /// The stable region has a corner here.
    pub bounds_stable: bool,
}

/// All crossing curves in one window of a plane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlaneCurves {
    /// Pieces of constant direction and constant count on both sides.
    pub pieces: Vec<CurvePiece>,
    /// Points where two curves cross.
    pub corners: Vec<Corner>,
}

/// Too many branches lie in the window to be traced one by one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "{arcs} crossing curves with {corners} corners or more lie in one window; at most {MOST_ARCS} \
    with {MOST_CORNERS} are traced"
)]
pub struct TooManyCurves {
    /// How many curves there are.
    pub arcs: u64,
    /// How many corners were found before giving up.
    pub corners: u64,
}

/// A window of a plane (p, q), q being the delay τ in planes with it.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Range of the first parameter.
    pub p: RangeInclusive<f64>,
    /// Range of the second one, finite.
    pub q: RangeInclusive<f64>,
}

impl Window {
    pub(super) fn p_width(&self) -> f64 {
        (self.p.end() - self.p.start()).max(f64::MIN_POSITIVE)
    }

    pub(super) fn q_width(&self) -> f64 {
        (self.q.end() - self.q.start()).max(f64::MIN_POSITIVE)
    }
}

/// Breakpoints of p for a plane without a closed form for them: sign changes of the discriminant,
/// of F(0) and of b.
///
/// Found on a grid of `samples` steps; two changes within one step are missed.
#[must_use]
pub(crate) fn scan_breakpoints(
    groups_at: impl Fn(f64) -> Groups,
    p: &RangeInclusive<f64>,
    samples: usize,
) -> Vec<f64> {
    let conditions: [fn(Groups) -> f64; 3] = [discriminant, frequency_product, |g| g.b];
    let at = |i: usize| p.start() + (p.end() - p.start()) * (i as f64 / samples as f64);
    let signs = |i: usize| {
        let groups = groups_at(at(i));
        conditions.map(|condition| condition(groups) > 0.0)
    };
    let mut points = Vec::new();
    let mut before = signs(0);
    for i in 0..samples {
        let after = signs(i + 1);
        for (k, condition) in conditions.into_iter().enumerate() {
            if before[k] != after[k] {
                points.push(bisect(at(i), at(i + 1), |p| condition(groups_at(p))));
            }
        }
        before = after;
    }
    points
}

/// Traces every crossing curve inside `window`.
///
/// `crossings_at` gives the crossings of the line at p; `breakpoints` are the values of p at which
/// their number changes. Additional values do no harm, and values outside the window are ignored.
/// Once `stop` is set, the answer comes soon but is meaningless.
///
/// # Errors
/// When more curves lie in the window than can be traced.
pub fn trace(
    crossings_at: impl Fn(f64) -> Crossings,
    breakpoints: &[f64],
    window: &Window,
    stop: &Stop,
) -> Result<PlaneCurves, TooManyCurves> {
    let mut ends: Vec<f64> = breakpoints
        .iter()
        .copied()
        .filter(|p| window.p.contains(p))
        .chain([*window.p.start(), *window.p.end()])
        .collect();
    // A breakpoint found by two conditions differs by rounding; the sliver in between is no
    // stretch.
    let sliver = 1e-12 * window.p_width();
    for end in &mut ends {
        if end.abs() <= sliver {
            *end = 0.0;
        }
    }
    ends.sort_by(f64::total_cmp);
    ends.dedup_by(|next, kept| *next - *kept <= sliver);
    let mut curves = PlaneCurves::default();
    for pair in ends.windows(2) {
        Stretch::new(&crossings_at, pair[0], pair[1], window).trace(&mut curves, stop)?;
    }
    Ok(curves)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::characteristic::characteristic;
    use crate::linear::gains::{load_gain_breakpoints, velocity_gain_breakpoints};
    use num_complex::Complex64;

    fn velocity_plane(b: f64, a_n: f64) -> (impl Fn(f64) -> Groups, Vec<f64>) {
        (
            move |a_v| Groups::new(b, a_v, a_n),
            velocity_gain_breakpoints(b, a_n, 0.0),
        )
    }

    fn load_plane(b: f64, a_v: f64) -> (impl Fn(f64) -> Groups, Vec<f64>) {
        (
            move |a_n| Groups::new(b, a_v, a_n),
            load_gain_breakpoints(b, a_v),
        )
    }

    fn check(
        groups_at: &dyn Fn(f64) -> Groups,
        breakpoints: &[f64],
        window: &Window,
    ) -> PlaneCurves {
        let at = |p: f64| Crossings::of(groups_at(p));
        let curves = trace(at, breakpoints, window, &Stop::default()).unwrap();
        for piece in &curves.pieces {
            assert!(piece.vertices.len() >= 2);
            for v in &piece.vertices {
                let residual =
                    characteristic(groups_at(v.p), v.q, Complex64::new(0.0, v.omega)).norm();
                assert!(residual < 1e-6, "{v:?}: {residual}");
                assert!(window.p.contains(&v.p));
                assert!(
                    *window.q.start() - 1e-9 <= v.q && v.q <= window.q.end() + 1e-9,
                    "{:?} {:?} {v:?} {}",
                    groups_at(v.p),
                    piece.direction,
                    piece.branch
                );
            }
            check_sides(piece, &at);
        }
        curves
    }

    /// The counts a little to both sides of each piece agree with its direction and its stable
    /// side.
    fn check_sides(piece: &CurvePiece, at: &dyn Fn(f64) -> Crossings) {
        for v in &piece.vertices[1..piece.vertices.len() - 1] {
            let line = at(v.p);
            let (before, after) = (
                line.n_unstable(v.q - 1e-8) as i64,
                line.n_unstable(v.q + 1e-8) as i64,
            );
            let alone = line
                .iter()
                .map(|c| (c.branch_at(v.q - 1e-7)..c.branch_at(v.q + 1e-7)).count())
                .sum::<usize>()
                == 1;
            if !alone {
                continue;
            }
            let step = if piece.direction == Direction::Right {
                2
            } else {
                -2
            };
            assert_eq!(after - before, step, "{v:?}");
            let side = if before == 0 {
                StableSide::Shorter
            } else if after == 0 {
                StableSide::Longer
            } else {
                StableSide::Neither
            };
            assert_eq!(piece.stable_side, side, "{v:?} of branch {}", piece.branch);
        }
    }

    #[test]
    fn pieces_bound_what_they_say() {
        for b in [-0.7, -0.5, -0.2, -0.05, 0.0, 0.1] {
            for other in [0.0, 0.3, -0.4] {
                let window = Window {
                    p: -1.6..=0.4,
                    q: 0.0..=12.0,
                };
                let (groups_at, breakpoints) = velocity_plane(b, other);
                check(&groups_at, &breakpoints, &window);
                let window = Window {
                    p: -8.0..=1.0,
                    q: 0.0..=12.0,
                };
                let (groups_at, breakpoints) = load_plane(b, other);
                check(&groups_at, &breakpoints, &window);
            }
        }
    }

    #[test]
    fn corners_are_double_roots_on_the_axis() {
        let (groups_at, breakpoints) = velocity_plane(-0.2, 0.0);
        let window = Window {
            p: -1.6..=0.4,
            q: 0.0..=12.0,
        };
        let curves = check(&groups_at, &breakpoints, &window);
        assert!(curves.corners.iter().any(|c| c.bounds_stable));
        for corner in &curves.corners {
            for (omega, _) in [corner.upper, corner.lower] {
                let residual =
                    characteristic(groups_at(corner.p), corner.q, Complex64::new(0.0, omega));
                assert!(residual.norm() < 1e-12, "{corner:?}");
            }
        }
    }

    /// Every change of stability along any line of the plane lies on a bounding piece.
    #[test]
    fn no_boundary_is_missing() {
        for b in [-0.6, -0.3, -0.1, -0.02] {
            let window = Window {
                p: -3.0..=1.0,
                q: 0.0..=20.0,
            };
            let (groups_at, breakpoints) = load_plane(b, 0.0);
            let curves = check(&groups_at, &breakpoints, &window);
            let bounding = curves
                .pieces
                .iter()
                .filter(|p| p.stable_side != StableSide::Neither);
            let segments: Vec<(Vertex, Vertex)> = bounding
                .flat_map(|p| p.vertices.windows(2).map(|w| (w[0], w[1])))
                .collect();
            for i in 0..400 {
                let a_n = -2.99 + 0.01 * f64::from(i) + 1e-5;
                for stable in Crossings::of(groups_at(a_n)).stable_delays() {
                    for tau in [stable.from, stable.to] {
                        if tau == 0.0 || tau > 20.0 {
                            continue;
                        }
                        let hit = segments.iter().any(|(v, w)| {
                            let (dp, dt) = ((w.p - v.p) / 4.0, (w.q - v.q) / 20.0);
                            let (ep, et) = ((a_n - v.p) / 4.0, (tau - v.q) / 20.0);
                            let along = ((ep * dp + et * dt) / (dp * dp + dt * dt)).clamp(0.0, 1.0);
                            (ep - along * dp).hypot(et - along * dt) < 2.0 * FLATNESS
                        });
                        assert!(hit, "b = {b}, a_n = {a_n}, τ = {tau}");
                    }
                }
            }
        }
    }

    /// A plane of b, which the sweep scans for its breakpoints: none of its pieces is a sliver at b
    /// = 0.
    #[test]
    fn the_plane_of_the_slope_crosses_zero_without_slivers() {
        let groups_at = |b: f64| Groups::new(b, 0.0, -0.38);
        let window = Window {
            p: -1.47..=0.53,
            q: 0.0..=20.0,
        };
        let breakpoints = scan_breakpoints(groups_at, &window.p, 4096);
        let curves = check(&groups_at, &breakpoints, &window);
        assert!(curves.pieces.len() > 10);
        for piece in &curves.pieces {
            let ps = || piece.vertices.iter().map(|v| v.p);
            let extent = ps().fold(f64::MIN, f64::max) - ps().fold(f64::MAX, f64::min);
            assert!(extent > 1e-9, "{piece:?}");
        }
        assert!(curves.corners.iter().all(|c| c.p.abs() > 1e-9));
    }

    #[test]
    fn narrow_windows_miss_no_curve() {
        let (groups_at, breakpoints) = velocity_plane(-0.2, 0.0);
        for tau in [4.0, 4.2, 2.0, 9.5] {
            let window = Window {
                p: -1.6..=0.4,
                q: tau..=tau + 1e-4,
            };
            let curves = check(&groups_at, &breakpoints, &window);
            for i in 0..2000 {
                let a_v = -1.6 + 0.001 * f64::from(i);
                let line = Crossings::of(groups_at(a_v));
                let changes = line
                    .iter()
                    .any(|c| c.branch_at(tau) != c.branch_at(tau + 1e-4));
                let near = curves
                    .pieces
                    .iter()
                    .flat_map(|p| &p.vertices)
                    .any(|v| (v.p - a_v).abs() < 0.01);
                assert!(near || !changes, "a_v = {a_v}, τ = {tau}");
            }
        }
    }

    #[test]
    fn scanned_breakpoints_agree_with_the_closed_ones() {
        let (groups_at, closed) = load_plane(-0.4, 0.1);
        let mut scanned = scan_breakpoints(groups_at, &(-3.0..=2.0), 500);
        let mut closed: Vec<f64> = closed
            .into_iter()
            .filter(|p| (-3.0..=2.0).contains(p))
            .collect();
        scanned.sort_by(f64::total_cmp);
        closed.sort_by(f64::total_cmp);
        assert_eq!(scanned.len(), closed.len());
        for (s, c) in scanned.iter().zip(&closed) {
            assert!((s - c).abs() < 1e-12, "{s} {c}");
        }
    }

    #[test]
    fn too_many_curves_are_refused() {
        let (groups_at, breakpoints) = load_plane(-0.4, 0.0);
        let window = Window {
            p: -3.0..=1.0,
            q: 0.0..=1e7,
        };
        let at = |p: f64| Crossings::of(groups_at(p));
        let refused = trace(at, &breakpoints, &window, &Stop::default());
        assert!(refused.unwrap_err().arcs > MOST_ARCS);
    }
}
