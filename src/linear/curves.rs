//! Crossing curves in the plane of one parameter p and the delay τ, cut where they cross one
//! another.
//!
//! Between two breakpoints of p (folds ω₋ = ω₊, and ω₋ = 0) each branch k of ω₊ and of ω₋ is a
//! smooth arc τ_k(p). An arc is parametrised by s in [0, 1] with p = p₀ + (p₁ − p₀)(1 − cos πs)/2,
//! which undoes the square root at a fold. Arcs are cut at corners, where τ_j(ω₊) = τ_k(ω₋): a
//! double Hopf point. On each piece the number of unstable roots to both sides is then constant,
//! and says whether the piece bounds the stable region.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use super::crossing::{Crossing, Crossings, Direction, discriminant, frequency_product};
use super::roots::bisect;
use crate::model::Groups;
use crate::model::elementary::{power, sin};

/// Nodes at which each arc is looked at for corners and for its way through the window.
const NODES: usize = 192;
/// Segments into which a piece is cut before it is refined.
const COARSE_SEGMENTS: usize = 8;
/// A segment is fine enough when its middle is nearer to its chord than this part of the window.
pub(super) const FLATNESS: f64 = 2e-4;
const MOST_HALVINGS: u32 = 12;
/// More arcs than this in one window are refused: no picture could show them.
pub(super) const MOST_ARCS: u64 = 2000;
/// More corners than this in one window are refused, for the same reason.
pub(super) const MOST_CORNERS: u64 = 5000;

/// A point of a crossing curve, exact to rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// The plane's parameter.
    pub p: f64,
    /// Delay.
    pub tau: f64,
    /// Crossing frequency.
    pub omega: f64,
}

/// On which side of a piece sliding is stable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StableSide {
    /// Roots are unstable on both sides: the piece bounds nothing.
    Neither,
    /// At shorter delays.
    Shorter,
    /// At longer delays.
    Longer,
}

/// A piece of a crossing curve between its corners, its folds and the edges of the window.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvePiece {
    /// Branch number k of the letter's Eq. (5).
    pub branch: u64,
    /// What the pair does there as the delay grows.
    pub direction: Direction,
    /// Where the stable region lies.
    pub stable_side: StableSide,
    /// At least two points, by growing arc parameter.
    pub vertices: Vec<Vertex>,
}

/// A point where two curves cross: two pairs lie on the axis at once, on one of ω₊ and on one of
/// ω₋.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// The plane's parameter.
    pub p: f64,
    /// Delay.
    pub tau: f64,
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
    /// Where they meet.
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

/// A window of the (p, τ) plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Range of the parameter.
    pub p: RangeInclusive<f64>,
    /// Range of delays, finite.
    pub tau: RangeInclusive<f64>,
}

impl Window {
    pub(super) fn p_width(&self) -> f64 {
        (self.p.end() - self.p.start()).max(f64::MIN_POSITIVE)
    }

    pub(super) fn tau_width(&self) -> f64 {
        (self.tau.end() - self.tau.start()).max(f64::MIN_POSITIVE)
    }
}

/// Breakpoints of p for a plane without a closed form for them: sign changes of the discriminant,
/// of F(0) and of b.
///
/// Found on a grid of `samples` steps; two changes within one step are missed.
#[must_use]
pub fn scan_breakpoints(
    groups_at: impl Fn(f64) -> Groups,
    p: &RangeInclusive<f64>,
    samples: usize,
) -> Vec<f64> {
    let conditions: [fn(Groups) -> f64; 3] = [discriminant, frequency_product, |g| g.b];
    let at = |i: usize| p.start() + (p.end() - p.start()) * (i as f64 / samples as f64);
    let mut points = Vec::new();
    for condition in conditions {
        let value = |p: f64| condition(groups_at(p));
        for i in 0..samples {
            if (value(at(i)) > 0.0) != (value(at(i + 1)) > 0.0) {
                points.push(bisect(at(i), at(i + 1), value));
            }
        }
    }
    points
}

/// Traces every crossing curve inside `window`.
///
/// `crossings_at` gives the crossings of the line at p; `breakpoints` are the values of p at which
/// their number changes (others do no harm; those outside the window are passed over).
///
/// # Errors
/// When more curves lie in the window than can be traced.
pub fn trace(
    crossings_at: impl Fn(f64) -> Crossings,
    breakpoints: &[f64],
    window: &Window,
) -> Result<PlaneCurves, TooManyCurves> {
    let mut ends: Vec<f64> = breakpoints
        .iter()
        .copied()
        .filter(|p| window.p.contains(p))
        .chain([*window.p.start(), *window.p.end()])
        .collect();
    // The same breakpoint found by two conditions differs by rounding: the sliver between is no
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
        Stretch::new(&crossings_at, pair[0], pair[1], window).trace(&mut curves)?;
    }
    Ok(curves)
}

/// The arcs between two breakpoints.
struct Stretch<'a, F> {
    crossings_at: &'a F,
    p0: f64,
    p1: f64,
    window: &'a Window,
    /// Arc parameters of the nodes.
    s: Vec<f64>,
    nodes: Vec<Crossings>,
}

#[derive(Clone, Copy, PartialEq)]
enum Arm {
    Upper,
    Lower,
}

/// A corner, by its place on the stretch.
struct Cut {
    s: f64,
    upper: u64,
    lower: u64,
}

fn arm_of(crossings: &Crossings, arm: Arm) -> Option<Crossing> {
    match arm {
        Arm::Upper => crossings.upper,
        Arm::Lower => crossings.lower,
    }
}

impl<'a, F: Fn(f64) -> Crossings> Stretch<'a, F> {
    fn new(crossings_at: &'a F, p0: f64, p1: f64, window: &'a Window) -> Self {
        let mut stretch = Self {
            crossings_at,
            p0,
            p1,
            window,
            s: Vec::new(),
            nodes: Vec::new(),
        };
        let first = stretch.end_node(0.0);
        let last = stretch.end_node(1.0);
        stretch.s = (0..=NODES)
            .map(|i| (i as f64 / NODES as f64).clamp(first, last))
            .collect();
        stretch.nodes = stretch.s.iter().map(|&s| stretch.at(s)).collect();
        stretch
    }

    fn p(&self, s: f64) -> f64 {
        if s <= 0.0 {
            self.p0
        } else if s >= 1.0 {
            self.p1
        } else {
            self.p0 + (self.p1 - self.p0) * power(sin(0.5 * PI * s), 2)
        }
    }

    fn at(&self, s: f64) -> Crossings {
        (self.crossings_at)(self.p(s))
    }

    /// The end `s` (0 or 1), moved inwards as little as needed for the arcs of the middle to exist
    /// there: at a fold the two arms end within the square root of rounding of one another.
    fn end_node(&self, s: f64) -> f64 {
        // At b = 0 itself the numbering of the branches jumps.
        let arms = |c: Crossings| {
            let [upper, lower] = [Arm::Upper, Arm::Lower].map(|arm| arm_of(&c, arm).is_some());
            (upper, lower, c.undamped)
        };
        let wanted = arms(self.at(0.5));
        let inwards = |by: f64| if s == 0.0 { by } else { 1.0 - by };
        let mut by = 1e-9;
        let mut end = s;
        while arms(self.at(end)) != wanted && by < 1e-3 {
            end = inwards(by);
            by *= 2.0;
        }
        end
    }

    fn vertex(&self, s: f64, arm: Arm, branch: u64) -> Option<Vertex> {
        let crossing = arm_of(&self.at(s), arm)?;
        Some(Vertex {
            p: self.p(s),
            tau: crossing.delay(branch),
            omega: crossing.omega,
        })
    }

    /// Delay of a branch, infinite where the arc has none.
    fn delay(&self, s: f64, arm: Arm, branch: u64) -> f64 {
        self.vertex(s, arm, branch).map_or(f64::INFINITY, |v| v.tau)
    }

    /// The branches of an arm that have a node inside the window.
    fn branches(&self, arm: Arm) -> std::ops::Range<u64> {
        let (mut from, mut to) = (u64::MAX, 0);
        for crossing in self.nodes.iter().filter_map(|c| arm_of(c, arm)) {
            from = from.min(crossing.branch_at(*self.window.tau.start()));
            to = to.max(crossing.branch_at(self.window.tau.end().next_up()));
        }
        from.min(to)..to
    }

    fn trace(&self, curves: &mut PlaneCurves) -> Result<(), TooManyCurves> {
        let ranges = [Arm::Upper, Arm::Lower].map(|arm| self.branches(arm));
        let arcs = ranges.iter().map(|r| r.end - r.start).sum();
        if arcs > MOST_ARCS {
            return Err(TooManyCurves { arcs, corners: 0 });
        }
        let cuts = self.cuts(ranges[0].clone());
        let corners = (curves.corners.len() + cuts.len()) as u64;
        if corners > MOST_CORNERS {
            return Err(TooManyCurves { arcs, corners });
        }
        for (arm, range) in [Arm::Upper, Arm::Lower].into_iter().zip(ranges) {
            for branch in range {
                self.trace_arc(arm, branch, &cuts, curves);
            }
        }
        curves
            .corners
            .extend(cuts.iter().filter_map(|cut| self.corner(cut)));
        Ok(())
    }

    /// All corners of the stretch, from changes in the order of delays between neighbouring nodes.
    fn cuts(&self, upper_branches: std::ops::Range<u64>) -> Vec<Cut> {
        let mut cuts = Vec::new();
        let (s, nodes) = self.corner_nodes();
        for branch in upper_branches {
            if cuts.len() as u64 > MOST_CORNERS {
                break;
            }
            let places: Vec<Option<u64>> = nodes
                .iter()
                .map(|c| {
                    let tau = arm_of(c, Arm::Upper)?.delay(branch);
                    let inside = tau <= 2.0 * self.window.tau.end() + 1.0;
                    inside.then_some(arm_of(c, Arm::Lower)?.branch_at(tau))
                })
                .collect();
            for (place, s) in places.windows(2).zip(s.windows(2)) {
                let [Some(before), Some(after)] = *place else {
                    continue;
                };
                for lower in before.min(after)..before.max(after) {
                    let gap = |s: f64| {
                        self.delay(s, Arm::Upper, branch) - self.delay(s, Arm::Lower, lower)
                    };
                    let s = bisect(s[0], s[1], gap);
                    if self.window.tau.contains(&self.delay(s, Arm::Upper, branch)) {
                        cuts.push(Cut {
                            s,
                            upper: branch,
                            lower,
                        });
                    }
                }
            }
        }
        cuts
    }

    /// The nodes, with those at a fold moved off it: there both arms of a branch meet without
    /// crossing.
    fn corner_nodes(&self) -> (Vec<f64>, Vec<Crossings>) {
        let (mut s, mut nodes) = (self.s.clone(), self.nodes.clone());
        let folded = |c: &Crossings| match (c.upper, c.lower) {
            (Some(u), Some(l)) => u.omega - l.omega < 1e-5 * u.omega,
            _ => false,
        };
        for (end, inner) in [(0, 1), (NODES, NODES - 1)] {
            if folded(&nodes[end]) {
                s[end] += (s[inner] - s[end]) / 1024.0;
                nodes[end] = self.at(s[end]);
            }
        }
        (s, nodes)
    }

    fn corner(&self, cut: &Cut) -> Option<Corner> {
        let crossings = self.at(cut.s);
        let (upper, lower) = (
            arm_of(&crossings, Arm::Upper)?,
            arm_of(&crossings, Arm::Lower)?,
        );
        let others = crossings.at_zero_delay as i64 + 2 * (cut.upper - upper.first_branch) as i64
            - 2 * (cut.lower - lower.first_branch) as i64;
        Some(Corner {
            p: self.p(cut.s),
            tau: upper.delay(cut.upper),
            upper: (upper.omega, cut.upper),
            lower: (lower.omega, cut.lower),
            // Before and after the corner; on one of its other two sides a pair is out, on one it
            // is in.
            bounds_stable: others == 0 || others == 2,
        })
    }

    /// Adds the pieces of one arc that lie in the window.
    fn trace_arc(&self, arm: Arm, branch: u64, cuts: &[Cut], curves: &mut PlaneCurves) {
        for (from, to) in self.stretches_inside(arm, branch) {
            let own = |cut: &&Cut| match arm {
                Arm::Upper => cut.upper == branch,
                Arm::Lower => cut.lower == branch,
            };
            let mut ends: Vec<f64> = cuts.iter().filter(own).map(|cut| cut.s).collect();
            ends.retain(|&s| from < s && s < to);
            ends.extend([from, to]);
            ends.sort_by(f64::total_cmp);
            for pair in ends.windows(2) {
                curves
                    .pieces
                    .extend(self.piece(arm, branch, pair[0], pair[1]));
            }
        }
    }

    /// The intervals of s on which a branch lies in the window, ends solved for.
    fn stretches_inside(&self, arm: Arm, branch: u64) -> Vec<(f64, f64)> {
        let (lo, hi) = (*self.window.tau.start(), *self.window.tau.end());
        let delays: Vec<f64> = self
            .nodes
            .iter()
            .map(|c| arm_of(c, arm).map_or(f64::INFINITY, |c| c.delay(branch)))
            .collect();
        // −1 below the window, 0 inside, 1 above.
        let side = |tau: f64| i8::from(tau > hi) - i8::from(tau < lo);
        let mut stretches = Vec::new();
        let mut from = (side(delays[0]) == 0).then_some(self.s[0]);
        for i in 0..NODES {
            let (here, next) = (side(delays[i]), side(delays[i + 1]));
            let edge = |bound: f64| {
                bisect(self.s[i], self.s[i + 1], |s| {
                    self.delay(s, arm, branch) - bound
                })
            };
            let bound = |side: i8| if side > 0 { hi } else { lo };
            match (here, next) {
                _ if here == next => {}
                // Right through a window narrower than the distance of the nodes.
                (-1, 1) => stretches.push((edge(lo), edge(hi))),
                (1, -1) => stretches.push((edge(hi), edge(lo))),
                (0, outside) => {
                    stretches.extend(from.take().map(|start| (start, edge(bound(outside)))));
                }
                (outside, _) => from = Some(edge(bound(outside))),
            }
        }
        if let Some(start) = from {
            stretches.push((start, self.s[NODES]));
        }
        stretches
    }

    fn piece(&self, arm: Arm, branch: u64, from: f64, to: f64) -> Option<CurvePiece> {
        let at = |s: f64| self.vertex(s, arm, branch);
        let mut vertices = vec![at(from)?];
        for i in 0..COARSE_SEGMENTS {
            let s = |i: usize| from + (to - from) * (i as f64 / COARSE_SEGMENTS as f64);
            self.refine(arm, branch, (s(i), s(i + 1)), MOST_HALVINGS, &mut vertices);
        }
        let distinct = vertices.first() != vertices.last();
        distinct.then(|| CurvePiece {
            branch,
            direction: match arm {
                Arm::Upper => Direction::Right,
                Arm::Lower => Direction::Left,
            },
            stable_side: self.stable_side(arm, branch, 0.5 * (from + to)),
            vertices,
        })
    }

    /// Appends the vertices after `s.0` up to and with `s.1`, close enough together to draw
    /// straight lines between.
    fn refine(&self, arm: Arm, branch: u64, s: (f64, f64), halvings: u32, out: &mut Vec<Vertex>) {
        let middle = 0.5 * (s.0 + s.1);
        let at = |s: f64| self.vertex(s, arm, branch);
        let (Some(a), Some(m), Some(b)) = (at(s.0), at(middle), at(s.1)) else {
            return;
        };
        let off = |a: f64, m: f64, b: f64, width: f64| ((0.5 * (a + b) - m) / width).abs();
        let flat = off(a.p, m.p, b.p, self.window.p_width()) < FLATNESS
            && off(a.tau, m.tau, b.tau, self.window.tau_width()) < FLATNESS;
        if flat || halvings == 0 {
            out.push(b);
        } else {
            self.refine(arm, branch, (s.0, middle), halvings - 1, out);
            self.refine(arm, branch, (middle, s.1), halvings - 1, out);
        }
    }

    fn stable_side(&self, arm: Arm, branch: u64, s: f64) -> StableSide {
        let crossings = self.at(s);
        let Some(own) = arm_of(&crossings, arm) else {
            return StableSide::Neither;
        };
        let tau = own.delay(branch);
        let before = branch - own.first_branch;
        let others = |c: Option<Crossing>| c.map_or(0, |c| c.count_below(tau));
        let start = crossings.at_zero_delay;
        match arm {
            Arm::Upper if start + 2 * before == 2 * others(crossings.lower) => StableSide::Shorter,
            Arm::Lower if start + 2 * others(crossings.upper) == 2 * (before + 1) => {
                StableSide::Longer
            }
            _ => StableSide::Neither,
        }
    }
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
            velocity_gain_breakpoints(b, a_n),
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
        let curves = trace(at, breakpoints, window).unwrap();
        for piece in &curves.pieces {
            assert!(piece.vertices.len() >= 2);
            for v in &piece.vertices {
                let residual =
                    characteristic(groups_at(v.p), v.tau, Complex64::new(0.0, v.omega)).norm();
                assert!(residual < 1e-6, "{v:?}: {residual}");
                assert!(window.p.contains(&v.p));
                assert!(
                    *window.tau.start() - 1e-9 <= v.tau && v.tau <= window.tau.end() + 1e-9,
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
                line.n_unstable(v.tau - 1e-8) as i64,
                line.n_unstable(v.tau + 1e-8) as i64,
            );
            let alone = line
                .iter()
                .map(|c| (c.branch_at(v.tau - 1e-7)..c.branch_at(v.tau + 1e-7)).count())
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
                    tau: 0.0..=12.0,
                };
                let (groups_at, breakpoints) = velocity_plane(b, other);
                check(&groups_at, &breakpoints, &window);
                let window = Window {
                    p: -8.0..=1.0,
                    tau: 0.0..=12.0,
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
            tau: 0.0..=12.0,
        };
        let curves = check(&groups_at, &breakpoints, &window);
        assert!(curves.corners.iter().any(|c| c.bounds_stable));
        for corner in &curves.corners {
            for (omega, _) in [corner.upper, corner.lower] {
                let residual =
                    characteristic(groups_at(corner.p), corner.tau, Complex64::new(0.0, omega));
                assert!(residual.norm() < 1e-12, "{corner:?}");
            }
        }
    }

    /// Every change of stability along any line of the plane lies on a bounding piece: none is left
    /// out.
    #[test]
    fn no_boundary_is_missing() {
        for b in [-0.6, -0.3, -0.1, -0.02] {
            let window = Window {
                p: -3.0..=1.0,
                tau: 0.0..=20.0,
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
                            let (dp, dt) = ((w.p - v.p) / 4.0, (w.tau - v.tau) / 20.0);
                            let (ep, et) = ((a_n - v.p) / 4.0, (tau - v.tau) / 20.0);
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
            tau: 0.0..=20.0,
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
                tau: tau..=tau + 1e-4,
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
            tau: 0.0..=1e7,
        };
        let at = |p: f64| Crossings::of(groups_at(p));
        assert!(trace(at, &breakpoints, &window).unwrap_err().arcs > MOST_ARCS);
    }
}
