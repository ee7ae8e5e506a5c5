//! Along the boundary of the decaying region: predictor and corrector, with its corners and ends.

use super::corner::Turn;
use super::plane::{DecayPlane, Family, dot, norm};
use crate::linear::curves::{FLATNESS, Vertex};
use crate::linear::plane::Plane;
use crate::model::elementary::{acos, hypot};

/// Longest step, in units of [`DecayPlane::scales`].
const LONGEST: f64 = 1.0 / 64.0;
/// Below this step the way ends: no curve goes on there.
const SHORTEST: f64 = 1e-9;
/// Largest angle between the tangents at both ends of a step.
const MOST_BEND: f64 = 0.25;
/// A corrected point is at most this part of the step away from its prediction.
const MOST_CORRECTION: f64 = 0.25;
/// A whole curve ends below this part of the scale of frequencies: at 0 it is its own mirror image.
const SLOWEST: f64 = 1e-6;
/// A whole curve that comes no further in so many steps ends: its frequency grows without bound.
const STAGNANT: usize = 512;
/// Halvings that enclose what ends a step.
const HALVINGS: u32 = 40;

/// A stretch of one curve, on which p only grows or only falls.
#[derive(Debug, Clone)]
pub(super) struct Arc {
    pub vertices: Vec<Vertex>,
    pub family: Family,
}

/// A way along the boundary.
#[derive(Default)]
pub(super) struct Way {
    pub arcs: Vec<Arc>,
    pub corners: Vec<Turn>,
    /// The way came back to where it began.
    pub closed: bool,
    /// It was given up for its length.
    pub too_long: bool,
}

/// Where a way stands.
#[derive(Clone, Copy)]
struct Place {
    v: Vertex,
    family: Family,
    tangent: [f64; 3],
}

enum End {
    /// The way goes on.
    On,
    /// It left the window, or no curve goes on.
    Over,
    Corner(Turn),
}

impl<P: Plane> DecayPlane<'_, P> {
    /// Goes along the boundary from `start`, with the decaying side on the left (`sense` = 1) or on
    /// the right (−1), for at most `most_steps`.
    pub(super) fn walk(&self, start: Vertex, family: Family, sense: f64, most_steps: usize) -> Way {
        let origin = self.place(start, family, sense);
        let (mut way, mut place) = (Way::default(), origin);
        way.begin(vec![start], family);
        let mut step = LONGEST;
        let mut then = start;
        for i in 1..=most_steps {
            if self.plane.stopped() {
                return way;
            }
            if self.whole && i % STAGNANT == 0 {
                if self.near_by(then, place.v) {
                    return way;
                }
                then = place.v;
            }
            let Some((ahead, taken)) = self.step(place, sense, step) else {
                return way;
            };
            step = (2.0 * taken).min(LONGEST);
            if self.passes(place, ahead, origin) {
                way.push(start);
                way.closed = true;
                return way;
            }
            let (next, end) = self.checked(place, ahead, taken, sense);
            if next.tangent[0] * place.tangent[0] < 0.0
                && let Some(turn) = self.turning_point(place, taken, sense)
            {
                way.push(turn);
                way.begin(vec![turn], place.family);
            }
            way.push(next.v);
            place = next;
            match end {
                End::On => {}
                End::Over => return way,
                End::Corner(turn) => {
                    place = self.place(turn.next, turn.family, sense);
                    step = LONGEST / 64.0;
                    way.turn(turn);
                }
            }
        }
        way.too_long = true;
        way
    }

    /// Whether two points are too near to one another for a picture to show it.
    fn near_by(&self, v: Vertex, w: Vertex) -> bool {
        let window = self.window();
        let [p, q] = [
            (v.p - w.p) / window.p_width(),
            (v.q - w.q) / window.q_width(),
        ];
        hypot(p, q) < 0.5 * FLATNESS
    }

    fn place(&self, v: Vertex, family: Family, sense: f64) -> Place {
        Place {
            v,
            family,
            tangent: self.tangent(v, family).map(|t| sense * t),
        }
    }

    /// The place on the curve a step of length `h` beyond `from`.
    fn ahead(&self, from: Place, h: f64, sense: f64) -> Option<Place> {
        let scales = self.scales(from.v);
        let t = from.tangent;
        let predicted = Vertex {
            p: from.v.p + h * t[0] * scales[0],
            q: from.v.q + h * t[1] * scales[1],
            omega: from.v.omega + h * t[2] * scales[2],
        };
        let row = [0, 1, 2].map(|i| t[i] / scales[i]);
        let v = self.correct(predicted, from.family, row)?;
        let off = norm(apart(predicted, v, scales));
        (off <= MOST_CORRECTION * h).then(|| self.place(v, from.family, sense))
    }

    /// The longest step up to `h` along which the curve is followed safely and nearly straight.
    fn step(&self, from: Place, sense: f64, mut h: f64) -> Option<(Place, f64)> {
        while h > SHORTEST {
            if let Some(next) = self.ahead(from, h, sense) {
                let bend = acos(dot(from.tangent, next.tangent).clamp(-1.0, 1.0));
                let chord = hypot(
                    (next.v.p - from.v.p) / self.window().p_width(),
                    (next.v.q - from.v.q) / self.window().q_width(),
                );
                if bend < MOST_BEND && bend * chord / 8.0 < FLATNESS {
                    return Some((next, h));
                }
            }
            h *= 0.5;
        }
        None
    }

    /// Whether the step from `from` to `to` leads past `origin`, in its direction.
    fn passes(&self, from: Place, to: Place, origin: Place) -> bool {
        let scales = self.scales(from.v);
        let step = apart(from.v, to.v, scales);
        let there = apart(from.v, origin.v, scales);
        let length = norm(step);
        let along = dot(step, there) / length;
        let off = (dot(there, there) - along * along).max(0.0).sqrt();
        from.family == origin.family
            && 1e-9 * LONGEST < along
            && along <= length
            && off < MOST_CORRECTION * length
            && dot(from.tangent, origin.tangent) > 0.5
    }

    /// Whether the boundary of the decaying region, or the curve as a whole, runs through `place`,
    /// one step beyond a place where it does.
    fn bounds(&self, place: &Place) -> bool {
        let of_family = match place.family {
            Family::Pair if self.whole => place.v.omega > SLOWEST * self.scales(place.v)[2],
            Family::Pair => place.v.omega > 0.0,
            Family::Real { .. } => self.on_own_side(place),
        };
        let alone = || self.whole || self.others(place.v).is_none_or(|n| n == 0);
        of_family && self.inside(place.v) && alone()
    }

    /// Whether no other real root has joined the one on the line.
    fn on_own_side(&self, place: &Place) -> bool {
        match place.family {
            Family::Pair => true,
            Family::Real { slope } => self.local(place.v).by_lambda.re * slope >= 0.0,
        }
    }

    /// `next`, if the whole step belongs to the boundary; else the place where it ends, and how.
    fn checked(&self, from: Place, next: Place, h: f64, sense: f64) -> (Place, End) {
        if self.bounds(&next) {
            return (next, End::On);
        }
        let (mut inside, mut outside) = (from, next);
        let (mut low, mut high) = (0.0, h);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match self.ahead(from, middle, sense) {
                Some(place) if self.bounds(&place) => (inside, low) = (place, middle),
                Some(place) => (outside, high) = (place, middle),
                None => high = middle,
            }
        }
        if !self.inside(outside.v) {
            return (self.at_edge(inside, outside.v, sense), End::Over);
        }
        let end_of_pair = match outside.family {
            Family::Pair if self.whole => true,
            Family::Pair => outside.v.omega <= 0.0,
            Family::Real { .. } => !self.on_own_side(&outside),
        };
        // Next to its end the curve of a pair is hard to tell from one of two real roots, of which
        // one is right of the line.
        let slow =
            from.family == Family::Pair && outside.v.omega <= SLOWEST * self.scales(outside.v)[2];
        let at_end = || self.end_of_pair(inside.v, from.family, sense);
        let turn = if end_of_pair {
            at_end()
        } else {
            let corner = self.corner(inside.v, from.family);
            corner.or_else(|| slow.then(at_end).flatten())
        };
        let Some(turn) = turn else {
            return (inside, End::Over);
        };
        let corner = Place {
            v: Vertex {
                p: turn.p,
                q: turn.q,
                omega: turn.before,
            },
            ..inside
        };
        match self.whole {
            // Where a pair meets on the real axis its curve ends.
            true => (corner, End::Over),
            false => (corner, End::Corner(turn)),
        }
    }

    /// `place`, moved onto the edge of the window that `beyond` has left.
    fn at_edge(&self, place: Place, beyond: Vertex, sense: f64) -> Place {
        let (p, q) = (&self.window().p, &self.window().q);
        let edge = Vertex {
            p: beyond.p.clamp(*p.start(), *p.end()),
            q: beyond.q.clamp(*q.start(), *q.end()),
            omega: beyond.omega,
        };
        let row = if edge.p == beyond.p {
            [0.0, 1.0, 0.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        match self.correct(edge, place.family, row) {
            Some(v) if self.inside(v) => self.place(v, place.family, sense),
            _ => place,
        }
    }

    /// Where, within the step, the curve turns back in p.
    fn turning_point(&self, from: Place, h: f64, sense: f64) -> Option<Vertex> {
        let (mut low, mut high) = (0.0, h);
        let mut turn = None;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let place = self.ahead(from, middle, sense)?;
            if place.tangent[0] * from.tangent[0] < 0.0 {
                high = middle;
            } else {
                low = middle;
            }
            turn = Some(place.v);
        }
        turn
    }
}

impl Way {
    fn begin(&mut self, vertices: Vec<Vertex>, family: Family) {
        self.arcs.push(Arc { vertices, family });
    }

    fn push(&mut self, v: Vertex) {
        if let Some(arc) = self.arcs.last_mut() {
            arc.vertices.push(v);
        }
    }

    /// Goes on along the other curve of a corner.
    fn turn(&mut self, turn: Turn) {
        let corner = Vertex {
            p: turn.p,
            q: turn.q,
            omega: turn.after,
        };
        self.begin(vec![corner], turn.family);
        // The curve of a pair starts a little away from its end at ω = 0.
        if turn.next.omega != turn.after {
            self.push(turn.next);
        }
        self.corners.push(turn);
    }
}

/// From `v` to `w`, each coordinate in its scale.
fn apart(v: Vertex, w: Vertex, scales: [f64; 3]) -> [f64; 3] {
    let difference = [w.p - v.p, w.q - v.q, w.omega - v.omega];
    [0, 1, 2].map(|i| difference[i] / scales[i])
}
