//! What holds on both sides of a curve on which something vanishes: pieces of it that bound the
//! stable region, and those that do not.

use super::level::Level;
use super::plane::SystemPlane;
use super::turning::RightOf;
use crate::linear::Direction;
use crate::linear::curves::{CurveKind, CurvePiece, StableSide, Vertex};
use crate::linear::plane::Plane;
use crate::model::elementary::hypot;

/// How far beside a curve roots are counted, in widths of the window.
const BESIDE: f64 = 1e-6;
const HALVINGS: u32 = 40;

type Point = (f64, f64);

/// Counts of the roots right of the line: on the left and on the right of a curve.
type Sides = (RightOf, RightOf);

/// The pieces of the curves of `level`, each cut where p turns back and where what holds beside it
/// changes.
pub(super) fn pieces(
    plane: &SystemPlane,
    sigma: f64,
    kind: CurveKind,
    level: &Level,
) -> Vec<CurvePiece> {
    let cutter = Cutter {
        plane,
        sigma,
        kind,
        level,
    };
    let mut pieces = Vec::new();
    for curve in level.curves() {
        for part in monotone(&curve) {
            cutter.cut(part, &mut pieces);
        }
    }
    pieces
}

/// The parts of a curve on which p only grows or only falls, or stays as it is.
fn monotone(curve: &[Point]) -> Vec<&[Point]> {
    let sense = |i: usize| {
        let step = curve[i + 1].0 - curve[i].0;
        if step == 0.0 { 0.0 } else { step.signum() }
    };
    let mut parts = Vec::new();
    let mut from = 0;
    for i in 1..curve.len().saturating_sub(1) {
        if sense(i) != sense(i - 1) {
            parts.push(&curve[from..=i]);
            from = i;
        }
    }
    parts.push(&curve[from..]);
    parts
}

struct Cutter<'a, 'p> {
    plane: &'a SystemPlane<'p>,
    sigma: f64,
    kind: CurveKind,
    level: &'a Level<'a>,
}

impl Cutter<'_, '_> {
    fn cut(&self, curve: &[Point], pieces: &mut Vec<CurvePiece>) {
        if curve.len() < 2 {
            return;
        }
        // Upright lines have two points only.
        let fine = self.divided(curve);
        let middle = |s: &[Point]| self.sides(s[0], s[1], 0.5);
        let middles: Vec<Sides> = fine.windows(2).map(middle).collect();
        let mut part = vec![fine[0]];
        for (i, &end) in fine.iter().enumerate().skip(1) {
            let (own, next) = (middles[i - 1], middles.get(i));
            if next.is_none_or(|next| told(*next) == told(own)) {
                part.push(end);
                continue;
            }
            let (at, behind) = self.change([fine[i - 1], end, fine[i + 1]], own);
            if behind {
                part.push(end);
            }
            part.push(at);
            self.add(&part, own, pieces);
            part = vec![at];
            if !behind {
                part.push(end);
            }
        }
        if let Some(&last) = middles.last() {
            self.add(&part, last, pieces);
        }
    }

    /// Where on two segments, one behind the other, what holds beside them stops to be `before`,
    /// and whether that is on the second one.
    fn change(&self, [from, middle, to]: [Point; 3], before: Sides) -> (Point, bool) {
        // From the middle of the first, 0, to the middle of the second, 1.
        let at = |s: f64| match s < 0.5 {
            true => (from, middle, 0.5 + s),
            false => (middle, to, s - 0.5),
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let (from, to, part) = at(middle);
            match told(self.sides(from, to, part)) == told(before) {
                true => low = middle,
                false => high = middle,
            }
        }
        let (from, to, part) = at(high);
        (self.on_curve(from, to, part), high >= 0.5)
    }

    /// The point of the curve near a part of the way along a segment.
    fn on_curve(&self, from: Point, to: Point, part: f64) -> Point {
        let along = |a: f64, b: f64| if a == b { a } else { a + part * (b - a) };
        self.level.onto((along(from.0, to.0), along(from.1, to.1)))
    }

    /// Counts beside a place on a segment.
    fn sides(&self, from: Point, to: Point, part: f64) -> Sides {
        let window = self.plane.window();
        let (width, height) = (window.p_width(), window.q_width());
        let at = (
            from.0 + part * (to.0 - from.0),
            from.1 + part * (to.1 - from.1),
        );
        let along = ((to.0 - from.0) / width, (to.1 - from.1) / height);
        let length = hypot(along.0, along.1) / BESIDE;
        let beside = |sign: f64| {
            let p = at.0 - sign * along.1 / length * width;
            let q = at.1 + sign * along.0 / length * height;
            self.plane.count(p, q, self.sigma, 0.0)
        };
        (beside(1.0), beside(-1.0))
    }

    /// At least 64 segments, each from one point of the curve to another.
    fn divided(&self, curve: &[Point]) -> Vec<Point> {
        let parts = 64_usize.div_ceil(curve.len() - 1);
        let mut fine = vec![curve[0]];
        for pair in curve.windows(2) {
            let inner = (1..parts).map(|i| i as f64 / parts as f64);
            fine.extend(inner.map(|part| self.on_curve(pair[0], pair[1], part)));
            fine.push(pair[1]);
        }
        fine
    }

    fn add(&self, points: &[Point], (left, right): Sides, pieces: &mut Vec<CurvePiece>) {
        let (first, last) = (points[0], points[points.len() - 1]);
        if first == last {
            return;
        }
        let omega = match self.kind {
            CurveKind::LeadingCoefficient => f64::INFINITY,
            _ => 0.0,
        };
        // The sides at smaller and larger q, or p where that stays as it is.
        let upright = first.0 == last.0;
        let (lower, upper) = match upright {
            true if last.1 > first.1 => (left, right),
            false if last.0 < first.0 => (left, right),
            _ => (right, left),
        };
        let sides = match upright {
            true => [StableSide::Below, StableSide::Above],
            false => [StableSide::Shorter, StableSide::Longer],
        };
        pieces.push(CurvePiece {
            kind: self.kind,
            branch: 0,
            direction: match (lower.finite(), upper.finite()) {
                (Some(lower), Some(upper)) if lower > upper => Direction::Left,
                (Some(lower), Some(upper)) if lower < upper => Direction::Right,
                _ => Direction::Touch,
            },
            stable_side: match (lower == RightOf::Roots(0), upper == RightOf::Roots(0)) {
                (true, false) => sides[0],
                (false, true) => sides[1],
                _ => StableSide::Neither,
            },
            vertices: points
                .iter()
                .map(|&(p, q)| Vertex { p, q, omega })
                .collect(),
        });
    }
}

/// Which of both sides are stable: all that matters of them.
fn told((left, right): Sides) -> (bool, bool) {
    (left == RightOf::Roots(0), right == RightOf::Roots(0))
}
