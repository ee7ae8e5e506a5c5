//! How far the series of a law along a motion holds, by a bound of the law on discs.
//!
//! With M(ρ) its largest absolute value on a disc of radius ρ, the rest of a series of order N at s
//! is at most M(ρ) (s/ρ)^N/(1 − s/ρ) by Cauchy's estimate, whatever its first coefficients are.

use crate::model::elementary::ln;
use crate::model::series::spread;

/// Radii of the discs, in units of the length of a step. Low orders need large ones.
const DISCS: [f64; 8] = [1.25, 2.0, 3.0, 4.5, 10.0, 30.0, 100.0, 300.0];
/// A step on which the series may be inaccurate is shortened by this factor, at most so many times.
const SHORTER: f64 = 0.8;
const MOST_TIMES: u32 = 60;

/// The longest step, at most `length`, at which the rest of the series is at most e^`allowed`.
/// `speed` holds the coefficients of ẋ; `largest` gives ln M where ẋ is off by no more than a
/// number.
pub(super) fn resolved(
    speed: &[f64],
    mut length: f64,
    allowed: f64,
    largest: impl Fn(f64) -> f64,
) -> f64 {
    let order = (speed.len() - 1) as f64;
    let rest = |length: f64, disc: &f64| {
        let off = spread(speed, disc * length);
        largest(off) - order * ln(*disc) - ln(1.0 - 1.0 / disc)
    };
    for _ in 0..MOST_TIMES {
        if DISCS.iter().any(|disc| rest(length, disc) <= allowed) {
            return length;
        }
        length *= SHORTER;
    }
    length
}
