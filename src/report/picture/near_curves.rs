//! The points of all curves of a panel, found by place.

use std::collections::HashMap;

use super::scene::Point;

/// Step along a curve, in units of the picture.
pub(super) const STEP: f64 = 4.0;
/// Side of the squares in which points are stored.
const SQUARE: f64 = 40.0;
/// Distance beyond which more room does not matter.
const ENOUGH_ROOM: f64 = 60.0;
/// The least distance of a text from any curve, as a share of its height.
const CLEAR: f64 = 0.3;
/// The nearest other curve is farther from a text than its own by at least this factor, so that it
/// is clear to which one the text belongs.
const CLEARLY: f64 = 1.8;

/// A width and a height.
pub(super) type Size = (f64, f64);

/// Points along a curve, at most a step apart, its last one among them.
pub(super) fn stepped(curve: &[Point]) -> Vec<Point> {
    let mut points = Vec::new();
    for pair in curve.windows(2) {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        let steps = ((x1 - x0).hypot(y1 - y0) / STEP).ceil().clamp(1.0, 1e4) as usize;
        points.extend((0..steps).map(|i| {
            let part = i as f64 / steps as f64;
            (x0 + part * (x1 - x0), y0 + part * (y1 - y0))
        }));
    }
    points.extend(curve.last());
    points
}

/// The points of all curves by square, each with the number of its set.
pub(super) struct Points(HashMap<(i64, i64), Vec<(usize, Point)>>);

impl Points {
    /// The points of these sets of curves.
    pub(super) fn of<'a>(sets: impl Iterator<Item = &'a [Vec<Point>]>) -> Self {
        let mut squares: HashMap<_, Vec<_>> = HashMap::new();
        for (i, curves) in sets.enumerate() {
            for point in curves.iter().flat_map(|curve| stepped(curve)) {
                squares.entry(square(point)).or_default().push((i, point));
            }
        }
        Self(squares)
    }

    /// The points at most `reach` from a place each way, with their sets.
    fn around(&self, at: Point, reach: Size) -> impl Iterator<Item = (usize, Point)> {
        let (low, high) = (
            square((at.0 - reach.0, at.1 - reach.1)),
            square((at.0 + reach.0, at.1 + reach.1)),
        );
        let squares = (low.0..=high.0).flat_map(move |x| (low.1..=high.1).map(move |y| (x, y)));
        let there = squares.filter_map(|key| self.0.get(&key)).flatten();
        there.copied()
    }

    /// The distance of a text at `at` from the curves of other sets, up to [`ENOUGH_ROOM`]; none
    /// where any curve is too near, or another one is about as near as its own.
    pub(super) fn room(&self, own: usize, at: Point, (width, height): Size) -> Option<f64> {
        let reach = (0.5 * width + ENOUGH_ROOM, 0.5 * height + ENOUGH_ROOM);
        let (mut others, mut mine) = (ENOUGH_ROOM, f64::INFINITY);
        for (set, (x, y)) in self.around(at, reach) {
            let away = (
                ((x - at.0).abs() - 0.5 * width).max(0.0),
                ((y - at.1).abs() - 0.5 * height).max(0.0),
            );
            let distance = away.0.hypot(away.1);
            let nearest = if set == own { &mut mine } else { &mut others };
            *nearest = nearest.min(distance);
        }
        let clear = mine.min(others) > CLEAR * height && others > CLEARLY * mine;
        clear.then_some(others)
    }

    /// Whether no curve is near a text.
    pub(super) fn is_clear(&self, at: Point, (width, height): Size) -> bool {
        let half = (
            0.5 * width + CLEAR * height + STEP,
            0.5 * height + CLEAR * height + STEP,
        );
        let near = |(x, y): Point| (x - at.0).abs() <= half.0 && (y - at.1).abs() <= half.1;
        !self.around(at, half).any(|(_, point)| near(point))
    }

    /// Whether a curve, but of the set `but`, is within a distance of a place.
    pub(super) fn is_near(&self, at: Point, distance: f64, but: Option<usize>) -> bool {
        let near = |(x, y): Point| (x - at.0).hypot(y - at.1) <= distance;
        let mut around = self.around(at, (distance, distance));
        around.any(|(set, point)| Some(set) != but && near(point))
    }
}

fn square((x, y): Point) -> (i64, i64) {
    ((x / SQUARE).floor() as i64, (y / SQUARE).floor() as i64)
}
