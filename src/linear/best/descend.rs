//! A local minimum of a function with kinks: direct search along ever new directions.

use super::search::{Evaluator, Family, Place, Search};
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

/// The length scales around a start: a step in the gain, with the change of delay that goes along
/// with it, and a step in the delay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub gain: f64,
    pub slope: f64,
    pub tau: f64,
}

impl Frame {
    /// The place at `radius` from `centre`, at `angle` in the frame.
    pub(super) fn around(&self, centre: Place, radius: f64, angle: f64) -> Place {
        let (sin, cos) = sincos(angle);
        let gain = self.gain * radius * cos;
        Place {
            gain: centre.gain + gain,
            tau: centre.tau + self.slope * gain + self.tau * radius * sin,
        }
    }

    /// How far `place` is from `centre`: the radius at which [`Frame::around`] gives it.
    pub(super) fn apart(&self, centre: Place, place: Place) -> f64 {
        let gain = place.gain - centre.gain;
        let tau = place.tau - centre.tau - self.slope * gain;
        hypot(gain / self.gain, tau / self.tau)
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
    let edge = search.nearest_edge(best.0, (frame.gain, frame.tau));
    let there = of(edge, best.1);
    if there <= best.1 { (edge, there) } else { best }
}

/// Halvings, about, of the bracket in which the best delay of a gain is looked for.
const HALVINGS: u32 = 40;
/// Steps along a valley.
const MOST_STEPS: u32 = 120;

/// Goes along the valley floor, the best delay of each gain, from `start`: where a real root is
/// double all along it, the walls rise like a square root, the floor hardly falls, and [`descend`]
/// gets stuck.
pub(super) fn follow_valley(
    evaluator: &mut Evaluator,
    search: &Search<impl Family>,
    start: Place,
    frame: &Frame,
) -> (Place, f64) {
    let mut best = floor(evaluator, search, start, frame);
    let (mut step, mut slope) = (frame.gain, frame.slope);
    for _ in 0..MOST_STEPS {
        let at = best.0;
        let gain = (at.gain + step).clamp(search.gains.0, search.gains.1);
        let ahead = Place {
            gain,
            tau: at.tau + slope * (gain - at.gain),
        };
        let there = floor(evaluator, search, ahead, frame);
        if there.1 < best.1 && ahead.gain != at.gain {
            slope = (there.0.tau - at.tau) / (ahead.gain - at.gain);
            best = there;
            step *= GROW;
        } else {
            step *= -SHRINK;
        }
        if step.abs() < 1e-7 * frame.gain {
            break;
        }
    }
    best
}

/// The best delay near that of `place` at its gain, by golden-section search.
fn floor(
    evaluator: &mut Evaluator,
    search: &Search<impl Family>,
    place: Place,
    frame: &Frame,
) -> (Place, f64) {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut at = |tau: f64| {
        let there = search.clamp(Place { tau, ..place });
        (there, evaluator.abscissa(search, there))
    };
    let (mut low, mut high) = (place.tau - 2.0 * frame.tau, place.tau + 2.0 * frame.tau);
    let (mut left, mut right) = (
        at(high - golden * (high - low)),
        at(low + golden * (high - low)),
    );
    for _ in 0..HALVINGS {
        if left.1 <= right.1 {
            high = low + golden * (high - low);
            right = left;
            left = at(high - golden * (high - low));
        } else {
            low = high - golden * (high - low);
            left = right;
            right = at(low + golden * (high - low));
        }
    }
    if left.1 <= right.1 { left } else { right }
}
