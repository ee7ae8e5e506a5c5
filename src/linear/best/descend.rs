//! A local minimum of a function with kinks: direct search along ever new directions.

use super::search::{Evaluator, Family, Place, Search};
use crate::linear::roots::golden_section;
use crate::model::elementary::{hypot, sincos};

/// Directions tried at a time, evenly over the circle and turned by the golden angle from one try
/// to the next: the directions tried become dense, so no valley between two kinks is too narrow in
/// the end.
const DIRECTIONS: u32 = 8;
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
/// Growth and shrinkage of the radius on success and failure.
const GROW: f64 = 1.7;
const SHRINK: f64 = 0.55;
/// Tries after which it ends anyhow.
const MOST_TRIES: u32 = 600;

/// The length scales around a start: a step in p, with the change of q that goes along with it, and
/// a step in q.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub p: f64,
    pub slope: f64,
    pub q: f64,
}

impl Frame {
    /// The place at `radius` from `centre`, at `angle` in the frame.
    pub(super) fn around(&self, centre: Place, radius: f64, angle: f64) -> Place {
        let (sin, cos) = sincos(angle);
        let p = self.p * radius * cos;
        Place {
            p: centre.p + p,
            q: centre.q + self.slope * p + self.q * radius * sin,
        }
    }

    /// How far `place` is from `centre`: the radius at which [`Frame::around`] gives it.
    pub(super) fn apart(&self, centre: Place, place: Place) -> f64 {
        let p = place.p - centre.p;
        let q = place.q - centre.q - self.slope * p;
        hypot(p / self.p, q / self.q)
    }
}

/// Goes down from `start` by steps from `largest` to `smallest` times the frame's size; the place
/// reached and the value there. `of` gives the value at a place; where that is above a bound, the
/// second argument, anything above it does.
pub(super) fn descend<F>(
    mut of: impl FnMut(Place, f64) -> f64,
    search: &Search<F>,
    start: Place,
    frame: &Frame,
    (largest, smallest): (f64, f64),
) -> (Place, f64) {
    let mut best = (start, of(start, f64::INFINITY));
    let (mut radius, mut turn) = (largest, 0.0);
    for _ in 0..MOST_TRIES {
        let found = (0..DIRECTIONS)
            .map(|i| turn + f64::from(i) * std::f64::consts::TAU / f64::from(DIRECTIONS))
            .find_map(|angle| {
                let place = search.clamp(frame.around(best.0, radius, angle));
                let value = of(place, best.1);
                (value < best.1).then_some(((place, value), angle))
            });
        if let Some((better, angle)) = found {
            best = better;
            // The way that went down is tried first the next time.
            turn = angle;
            radius = (radius * GROW).min(largest);
        } else {
            turn += GOLDEN_ANGLE;
            radius *= SHRINK;
        }
        if radius < smallest {
            break;
        }
    }
    // Steps grow too small to arrive at an edge that is approached at a slant.
    let edge = search.nearest_edge(best.0, (frame.p, frame.q));
    let there = of(edge, best.1);
    if there <= best.1 { (edge, there) } else { best }
}

/// Golden sections of the bracket in which the best q of a p is looked for.
const SECTIONS: u32 = 40;
/// Steps along a valley.
const MOST_STEPS: u32 = 120;

/// Goes along the valley floor, the best q of each p, from `start`: where a real root is
/// double all along it, the walls rise like a square root, the floor hardly falls, and [`descend`]
/// gets stuck.
pub(super) fn follow_valley(
    evaluator: &mut Evaluator,
    search: &Search<impl Family>,
    start: Place,
    frame: &Frame,
) -> (Place, f64) {
    let mut best = floor(evaluator, search, start, frame);
    let (mut step, mut slope) = (frame.p, frame.slope);
    for _ in 0..MOST_STEPS {
        let at = best.0;
        let p = (at.p + step).clamp(search.p.0, search.p.1);
        let ahead = Place {
            p,
            q: at.q + slope * (p - at.p),
        };
        let there = floor(evaluator, search, ahead, frame);
        if there.1 < best.1 && ahead.p != at.p {
            slope = (there.0.q - at.q) / (ahead.p - at.p);
            best = there;
            step *= GROW;
        } else {
            step *= -SHRINK;
        }
        if step.abs() < 1e-7 * frame.p {
            break;
        }
    }
    best
}

/// The best q near that of `place` at its p, by golden-section search.
fn floor(
    evaluator: &mut Evaluator,
    search: &Search<impl Family>,
    place: Place,
    frame: &Frame,
) -> (Place, f64) {
    let at = |q: f64| search.clamp(Place { q, ..place });
    let range = (place.q - 2.0 * frame.q, place.q + 2.0 * frame.q);
    let (q, abscissa) = golden_section(range, SECTIONS, |q| evaluator.abscissa(search, at(q)));
    (at(q), abscissa)
}
