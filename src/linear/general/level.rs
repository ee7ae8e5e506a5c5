//! Curves on which a function over a plane vanishes.

use crate::linear::curves::{FLATNESS, Window};
use crate::linear::roots::bisect;
use crate::model::elementary::{acos, hypot};

/// Columns and rows on which changes of sign are looked for.
const GRID: usize = 256;
/// Steps over p where the function depends on p alone.
const STEPS: usize = 4096;
/// Longest and shortest step, in widths of the window.
const LONGEST: f64 = 1.0 / 64.0;
const SHORTEST: f64 = 1e-9;
/// Largest angle between the directions at both ends of a step.
const MOST_BEND: f64 = 0.25;
/// A corrected point is at most this part of the step away from where it was looked for.
const MOST_CORRECTION: f64 = 0.25;
const DIFFERENCE: f64 = 1e-6;
const MOST_ITERATIONS: u32 = 16;
const HALVINGS: u32 = 50;
/// Steps along all curves of one window.
const MOST_STEPS: usize = 1 << 16;

/// A point in parts of the window.
type Point = [f64; 2];

/// A function over a window.
pub(super) struct Level<'a> {
    /// The function's value at (p, q).
    pub value: &'a dyn Fn(f64, f64) -> f64,
    pub window: &'a Window,
    /// Whether the function depends on p alone.
    pub of_p: bool,
    /// Whether nobody waits for the curves any more.
    pub stopped: &'a dyn Fn() -> bool,
}

/// A point of a curve and the direction in which it goes on.
#[derive(Clone, Copy)]
struct Place {
    at: Point,
    towards: Point,
}

impl Level<'_> {
    /// The curves, each as points (p, q) near enough together to draw straight lines between. They
    /// are found by changes of sign along 257 columns and the edges of the window.
    pub(super) fn curves(&self) -> Vec<Vec<(f64, f64)>> {
        let curves = if self.of_p {
            self.upright()
        } else if self.constant() {
            Vec::new()
        } else {
            self.walked()
        };
        let point = |[u, v]: Point| (self.p(u), self.q(v));
        let points = |curve: Vec<Point>| curve.into_iter().map(point).collect();
        curves.into_iter().map(points).collect()
    }

    /// The point of a curve next to (p, q), which is near one.
    pub(super) fn onto(&self, (p, q): (f64, f64)) -> (f64, f64) {
        if self.of_p {
            return (p, q);
        }
        let part = |x: f64, from: f64, width: f64| (x - from) / width;
        let u = part(p, *self.window.p.start(), self.window.p_width());
        let v = part(q, *self.window.q.start(), self.window.q_width());
        match self.corrected([u, v]).filter(|&at| inside(at)) {
            Some([u, v]) => (self.p(u), self.q(v)),
            None => (p, q),
        }
    }

    fn p(&self, u: f64) -> f64 {
        let (from, to) = (self.window.p.start(), self.window.p.end());
        if u == 1.0 {
            *to
        } else {
            from + u * (to - from)
        }
    }

    fn q(&self, v: f64) -> f64 {
        let (from, to) = (self.window.q.start(), self.window.q.end());
        if v == 1.0 {
            *to
        } else {
            from + v * (to - from)
        }
    }

    fn at(&self, [u, v]: Point) -> f64 {
        (self.value)(self.p(u.clamp(0.0, 1.0)), self.q(v.clamp(0.0, 1.0)))
    }

    /// Whether the function has the same value at all points of a coarse grid.
    fn constant(&self) -> bool {
        let first = self.at([0.0, 0.0]);
        let parts = || (0..=32).map(|i| f64::from(i) / 32.0);
        parts().all(|u| parts().all(|v| self.at([u, v]) == first))
    }

    fn upright(&self) -> Vec<Vec<Point>> {
        let at = |u: f64| self.at([u, 0.0]);
        let u = |i: usize| i as f64 / STEPS as f64;
        let changes = (0..STEPS).filter(|&i| (at(u(i)) > 0.0) != (at(u(i + 1)) > 0.0));
        changes
            .map(|i| bisect(u(i), u(i + 1), at))
            .map(|u| vec![[u, 0.0], [u, 1.0]])
            .collect()
    }

    fn walked(&self) -> Vec<Vec<Point>> {
        let mut curves: Vec<Vec<Point>> = Vec::new();
        let mut steps = MOST_STEPS;
        for seed in self.seeds() {
            if (self.stopped)() {
                break;
            }
            let near = |curve: &Vec<Point>| {
                let mut segments = curve.windows(2);
                segments.any(|s| distance(seed, s[0], s[1]) < 3.0 * FLATNESS)
            };
            if curves.iter().any(near) {
                continue;
            }
            let Some(start) = self.corrected(seed) else {
                continue;
            };
            let (forward, closed) = self.walk(start, 1.0, &mut steps);
            let mut curve = if closed {
                vec![start]
            } else {
                let mut backward = self.walk(start, -1.0, &mut steps).0;
                backward.reverse();
                backward.push(start);
                backward
            };
            curve.extend(forward);
            if curve.len() > 1 {
                curves.push(curve);
            }
        }
        curves
    }

    /// Points between which the sign changes, along columns and the two edges across them.
    fn seeds(&self) -> Vec<Point> {
        let part = |i: usize| i as f64 / GRID as f64;
        let mut seeds = Vec::new();
        let mut along = |line: &dyn Fn(f64) -> Point| {
            let at = |x: f64| self.at(line(x));
            let mut before = at(0.0) > 0.0;
            for i in 1..=GRID {
                let here = at(part(i)) > 0.0;
                if here != before {
                    seeds.push(line(bisect(part(i - 1), part(i), at)));
                }
                before = here;
            }
        };
        along(&|u| [u, 0.0]);
        along(&|u| [u, 1.0]);
        for i in (0..=GRID).take_while(|_| !(self.stopped)()) {
            along(&|v| [part(i), v]);
        }
        seeds
    }

    fn gradient(&self, [u, v]: Point) -> Point {
        let across = |x: f64, line: &dyn Fn(f64) -> Point| {
            let x = x.clamp(0.0, 1.0);
            let (low, high) = ((x - DIFFERENCE).max(0.0), (x + DIFFERENCE).min(1.0));
            (self.at(line(high)) - self.at(line(low))) / (high - low)
        };
        [across(u, &|u| [u, v]), across(v, &|v| [u, v])]
    }

    /// The point of the curve that Newton's method reaches across it.
    fn corrected(&self, mut at: Point) -> Option<Point> {
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let [a, b] = self.gradient(at);
            let factor = self.beyond(at) / (a * a + b * b);
            let size = factor.abs() * hypot(a, b);
            if !size.is_finite() || size > 1.0 {
                return None;
            }
            at = [at[0] - factor * a, at[1] - factor * b];
            if size < 1e-15 || (size < 1e-9 && size >= 0.25 * last) {
                return Some(at);
            }
            last = size;
        }
        (last < 1e-9).then_some(at)
    }

    /// The value, continued linearly beyond the window.
    fn beyond(&self, at: Point) -> f64 {
        let here = at.map(|x| x.clamp(0.0, 1.0));
        let inside = self.at(here);
        if here == at {
            return inside;
        }
        let [a, b] = self.gradient(here);
        inside + a * (at[0] - here[0]) + b * (at[1] - here[1])
    }

    fn place(&self, at: Point, sense: f64) -> Option<Place> {
        let [a, b] = self.gradient(at);
        let size = sense * hypot(a, b);
        let towards = [-b / size, a / size];
        towards[0].is_finite().then_some(Place { at, towards })
    }

    fn ahead(&self, from: Place, h: f64, sense: f64) -> Option<Place> {
        let [a, b] = from.towards;
        let predicted = [from.at[0] + h * a, from.at[1] + h * b];
        let at = self.corrected(predicted)?;
        let off = hypot(at[0] - predicted[0], at[1] - predicted[1]);
        (off <= MOST_CORRECTION * h).then(|| self.place(at, sense))?
    }

    /// The points after `start`, and whether the curve comes back to it.
    fn walk(&self, start: Point, sense: f64, steps: &mut usize) -> (Vec<Point>, bool) {
        let mut points = Vec::new();
        let Some(origin) = self.place(start, sense) else {
            return (points, false);
        };
        let (mut place, mut h) = (origin, LONGEST);
        while *steps > 0 && !(self.stopped)() {
            *steps -= 1;
            let Some((next, taken)) = self.step(place, h, sense) else {
                return (points, false);
            };
            h = (2.0 * taken).min(LONGEST);
            if points.len() > 2 && passes(place, next, origin) {
                points.push(start);
                return (points, true);
            }
            if !inside(next.at) {
                points.push(self.edge(place, taken, sense));
                return (points, false);
            }
            points.push(next.at);
            place = next;
        }
        (points, false)
    }

    fn step(&self, from: Place, mut h: f64, sense: f64) -> Option<(Place, f64)> {
        while h > SHORTEST {
            if let Some(next) = self.ahead(from, h, sense) {
                let turned = from.towards[0] * next.towards[0] + from.towards[1] * next.towards[1];
                let bend = acos(turned.clamp(-1.0, 1.0));
                if bend < MOST_BEND && bend * h / 8.0 < FLATNESS {
                    return Some((next, h));
                }
            }
            h *= 0.5;
        }
        None
    }

    /// Where a step of `h` leaves the window.
    fn edge(&self, from: Place, h: f64, sense: f64) -> Point {
        let (mut low, mut high, mut last) = (0.0, h, from.at);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match self.ahead(from, middle, sense) {
                Some(place) if inside(place.at) => (low, last) = (middle, place.at),
                _ => high = middle,
            }
        }
        last
    }
}

fn inside(at: Point) -> bool {
    at.iter().all(|x| (0.0..=1.0).contains(x))
}

/// Whether the step from `from` to `to` leads past `origin`, in the direction of `origin`.
fn passes(from: Place, to: Place, origin: Place) -> bool {
    let step = [to.at[0] - from.at[0], to.at[1] - from.at[1]];
    let there = [origin.at[0] - from.at[0], origin.at[1] - from.at[1]];
    let length = hypot(step[0], step[1]);
    let along = (step[0] * there[0] + step[1] * there[1]) / length;
    let off = (step[0] * there[1] - step[1] * there[0]) / length;
    let turned = from.towards[0] * origin.towards[0] + from.towards[1] * origin.towards[1];
    0.0 < along && along <= length && off.abs() < MOST_CORRECTION * length && turned > 0.5
}

/// The distance of a point from a segment.
fn distance(at: Point, from: Point, to: Point) -> f64 {
    let (step, there) = (
        [to[0] - from[0], to[1] - from[1]],
        [at[0] - from[0], at[1] - from[1]],
    );
    let square = step[0] * step[0] + step[1] * step[1];
    let along = ((step[0] * there[0] + step[1] * there[1]) / square).clamp(0.0, 1.0);
    hypot(there[0] - along * step[0], there[1] - along * step[1])
}
