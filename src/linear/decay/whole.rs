//! Whole curves along which a pair lies on the line, cut where another root comes to it: pieces
//! that bound the decaying region, and others.

use super::plane::{DecayPlane, Family};
use super::seeds::Across;
use super::walk::Arc;
use super::{SAME, SAME_FREQUENCY, Traced, Tracer, closed, joined};
use crate::linear::curves::{Corner, PlaneCurves, StableSide, TooManyCurves, Vertex};
use crate::linear::plane::Plane;

/// Steps along all curves of one window.
const MOST_STEPS: usize = 1 << 18;
/// Halvings that enclose a change.
const HALVINGS: u32 = 40;
/// How far to either side of a curve roots are counted, in widths of the window.
const ASIDE: [f64; 2] = [1e-6, 1e-5];

/// A point of a curve on a line across the window.
#[derive(Debug, Clone, Copy)]
pub struct Start {
    /// The line.
    pub across: Across,
    /// The point, exact to rounding.
    pub vertex: Vertex,
}

/// Traces the curves on which a pair lies on the line Re λ = −`sigma` through all `starts`.
///
/// # Errors
/// When there are more curves in the window than can be traced.
pub fn trace_whole(
    plane: &impl Plane,
    sigma: f64,
    starts: &[Start],
) -> Result<PlaneCurves, TooManyCurves> {
    let mut tracer = Tracer {
        found: Traced::default(),
        curves: PlaneCurves::default(),
        steps: MOST_STEPS,
        plane: DecayPlane {
            plane,
            sigma,
            whole: true,
        },
    };
    for start in starts.iter().take_while(|_| !plane.stopped()) {
        if !tracer.knows(start) {
            tracer.follow_whole(start)?;
        }
    }
    Ok(tracer.curves)
}

/// The point with a pair on the line Re λ = −`sigma` that Newton's method reaches from `start`,
/// with p held constant on a `column`, else q.
pub fn on_line(plane: &impl Plane, sigma: f64, start: Vertex, column: bool) -> Option<Vertex> {
    let row = if column {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let whole = true;
    DecayPlane {
        plane,
        sigma,
        whole,
    }
    .correct(start, Family::Pair, row)
}

impl<P: Plane> Tracer<'_, P> {
    /// Whether a curve traced so far runs through `start`.
    fn knows(&mut self, start: &Start) -> bool {
        let v = start.vertex;
        let window = self.plane.window();
        let (x, width) = match start.across {
            Across::Column(_) => (v.q, window.q_width()),
            Across::Edge { .. } => (v.p, window.p_width()),
        };
        let scale = self.plane.scales(v)[2];
        let same = |&(y, omega): &(f64, f64)| {
            (x - y).abs() <= SAME * width && (omega - v.omega).abs() <= SAME_FREQUENCY * scale
        };
        self.found.on(start.across).iter().any(same)
    }

    fn follow_whole(&mut self, start: &Start) -> Result<(), TooManyCurves> {
        let mut forward = self.walk(start.vertex, Family::Pair, 1.0)?;
        let arcs = if forward.closed {
            closed(std::mem::take(&mut forward.arcs))
        } else {
            let backward = self.walk(start.vertex, Family::Pair, -1.0)?;
            joined(backward.arcs, forward.arcs)
        };
        for arc in &arcs {
            if self.mark(arc) {
                self.cut(arc);
            }
        }
        // A start on the edge from which the curve leaves at once is no curve.
        self.found.on(start.across).push(match start.across {
            Across::Column(_) => (start.vertex.q, start.vertex.omega),
            Across::Edge { .. } => (start.vertex.p, start.vertex.omega),
        });
        self.check_limits(false)
    }

    /// The pieces of an arc between its corners, in the order of the arc.
    fn cut(&mut self, arc: &Arc) {
        let vertices = &arc.vertices;
        let mut others: Vec<Option<u64>> = vertices.iter().map(|&v| self.others(v)).collect();
        // Within rounding of a corner the count is undecided: that of the vertex before holds.
        for i in 1..others.len() {
            others[i] = others[i].or(others[i - 1]);
        }
        let mut part: Vec<Vertex> = Vec::new();
        for i in 0..vertices.len() {
            part.push(vertices[i]);
            let next = vertices.get(i + 1).copied();
            let Some(next) = next.filter(|_| others[i] != others[i + 1]) else {
                continue;
            };
            self.cut_between((vertices[i], next), (others[i], others[i + 1]), &mut part);
        }
        let last = others.last().copied().flatten();
        self.add(part, last);
    }

    /// The number of roots right of the line besides those on it. Where that is undecided, it is
    /// the smaller of the counts a little to both sides.
    fn others(&self, v: Vertex) -> Option<u64> {
        let window = self.plane.window();
        let count = |dp: f64, dq: f64| {
            let (p, q) = (v.p + dp * window.p_width(), v.q + dq * window.q_width());
            self.plane.plane.right_of(p, q, self.plane.sigma, 0.0)
        };
        let both = |dp: f64, dq: f64| Some(count(dp, dq)?.min(count(-dp, -dq)?));
        let aside = |by: &f64| both(0.0, *by).or_else(|| both(*by, 0.0));
        let own = self.plane.others(v);
        own.or_else(|| ASIDE.iter().find_map(aside))
    }

    /// Cuts where the number of other roots right of the line changes from one vertex to the next.
    fn cut_between(
        &mut self,
        (v, w): (Vertex, Vertex),
        (mut others, after): (Option<u64>, Option<u64>),
        part: &mut Vec<Vertex>,
    ) {
        let corners = self.corners_between(v, w);
        for (k, &(at, omega)) in corners.iter().enumerate() {
            let before = self.end_part(part, at, others);
            // The part up to the next corner has no vertex of its own.
            others = match corners.get(k + 1) {
                Some(&(next, _)) => self.on_curve(middle(at, next)).and_then(|v| self.others(v)),
                None => after,
            };
            self.note(at, omega, before || others == Some(0));
        }
        if corners.is_empty() {
            let at = self.change_between(v, w, others);
            self.end_part(part, at, others);
        }
    }

    fn on_curve(&self, v: Vertex) -> Option<Vertex> {
        self.plane.correct(v, Family::Pair, [1.0, 0.0, 0.0])
    }

    /// Where along the curve from `v` to `w` the number of other roots right of the line is no
    /// longer `others`.
    fn change_between(&self, mut v: Vertex, mut w: Vertex, others: Option<u64>) -> Vertex {
        for _ in 0..HALVINGS {
            let Some(at) = self.on_curve(middle(v, w)) else {
                break;
            };
            match self.others(at) == others {
                true => v = at,
                false => w = at,
            }
        }
        v
    }

    /// Ends the piece `part` at `v`, where the next one begins. Returns whether it bounds the
    /// region.
    fn end_part(&mut self, part: &mut Vec<Vertex>, v: Vertex, others: Option<u64>) -> bool {
        let mut done = std::mem::replace(part, vec![v]);
        done.push(v);
        self.add(done, others)
    }

    /// Adds a piece with `others` roots right of the line besides those on it. Returns whether it
    /// bounds the region.
    fn add(&mut self, vertices: Vec<Vertex>, others: Option<u64>) -> bool {
        let family = Family::Pair;
        let Some(mut piece) = self.piece(&Arc { vertices, family }) else {
            return false;
        };
        let bounds = others == Some(0);
        if !bounds {
            piece.stable_side = StableSide::Neither;
        }
        if piece.vertices.len() > 1 {
            self.curves.pieces.push(piece);
        }
        bounds
    }

    /// The points between two neighbouring vertices where another pair lies on the line as well, in
    /// order, each with the frequency of that pair.
    fn corners_between(&self, v: Vertex, w: Vertex) -> Vec<(Vertex, f64)> {
        let scales = self.plane.scales(v);
        let step = [w.p - v.p, w.q - v.q];
        let along = |c: Vertex| {
            let [a, b] = [step[0] / scales[0], step[1] / scales[1]];
            let from = [(c.p - v.p) / scales[0], (c.q - v.q) / scales[1]];
            (a * from[0] + b * from[1]) / (a * a + b * b)
        };
        let mut corners: Vec<(Vertex, f64)> = Vec::new();
        for omega in self.plane.candidates(v.p, v.q) {
            // Its own pair.
            if (omega - v.omega).abs() < 1e-6 * scales[2] {
                continue;
            }
            for start in [v, w] {
                let turn = self.plane.double_root(start, Family::Pair, omega);
                let Some(turn) = turn else {
                    continue;
                };
                let at = Vertex {
                    p: turn.p,
                    q: turn.q,
                    omega: turn.before,
                };
                let part = along(at);
                let inside = (-1e-6..=1.0 + 1e-6).contains(&part);
                let known = |c: &(Vertex, f64)| (along(c.0) - part).abs() < 1e-6;
                if inside && !corners.iter().any(known) {
                    corners.push((at, turn.after));
                }
            }
        }
        corners.sort_by(|a, b| along(a.0).total_cmp(&along(b.0)));
        corners
    }

    /// Notes a corner, once: both curves pass it.
    fn note(&mut self, at: Vertex, omega: f64, bounds: bool) {
        let scales = self.plane.scales(at);
        let same = |c: &&mut Corner| {
            let frequencies = |a: f64, b: f64| {
                (c.upper.0 - a.max(b)).abs() < 1e-3 * scales[2]
                    && (c.lower.0 - a.min(b)).abs() < 1e-3 * scales[2]
            };
            (c.p - at.p).abs() < SAME * scales[0]
                && (c.q - at.q).abs() < SAME * scales[1]
                && frequencies(at.omega, omega)
        };
        if let Some(known) = self.curves.corners.iter_mut().find(same) {
            known.bounds_stable |= bounds;
            return;
        }
        let delay = self.plane.plane.delay(at.p, at.q);
        let pair = |omega: f64| (omega, super::turns(omega, delay));
        self.curves.corners.push(Corner {
            p: at.p,
            q: at.q,
            upper: pair(at.omega.max(omega)),
            lower: pair(at.omega.min(omega)),
            bounds_stable: bounds,
        });
    }
}

fn middle(v: Vertex, w: Vertex) -> Vertex {
    Vertex {
        p: 0.5 * (v.p + w.p),
        q: 0.5 * (v.q + w.q),
        omega: 0.5 * (v.omega + w.omega),
    }
}
