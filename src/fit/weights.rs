//! The standard deviations s_i of points, up to a common factor.
//!
//! One reading has the standard deviation s of all. The readings of an average have their own
//! spread, of which few of them tell little: it is averaged with s as if that were known from
//! [`PRIOR`] readings more.

use crate::setting::measured::MeasuredPoint;

/// How many degrees of freedom the spread of all readings counts for in that of one point.
const PRIOR: f64 = 4.0;

/// A standard deviation for every point, relative to that of one reading.
pub(super) fn deviations(points: &[MeasuredPoint]) -> Vec<f64> {
    let freedom = |point: &MeasuredPoint| point.readings.saturating_sub(1) as f64;
    let sum_of_squares = |point: &MeasuredPoint| freedom(point) * point.spread * point.spread;
    let all: f64 = points.iter().map(freedom).sum();
    let pooled = points.iter().map(sum_of_squares).sum::<f64>() / all.max(1.0);
    let of = |point: &MeasuredPoint| {
        let own = match pooled > 0.0 {
            true => (PRIOR + sum_of_squares(point) / pooled) / (PRIOR + freedom(point)),
            false => 1.0,
        };
        (own / point.readings as f64).sqrt()
    };
    points.iter().map(of).collect()
}
