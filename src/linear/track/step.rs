//! One root and its way from a delay to the next.

use num_complex::Complex64;

use crate::linear::characteristic::Jet;
use crate::linear::equation::Equation;
use crate::linear::newton::{divide, halley_step};

/// Evaluations of D after which a root is lost.
const MOST_EVALUATIONS: u32 = 4;
/// The relative error that a step may leave.
const SETTLED: f64 = 2e-16;
/// Steps longer than this part of the distance at which D bends are not trusted.
const FARTHEST_STEP: f64 = 0.3;
/// A root with an imaginary part below this (relative) is real, or nearly double.
const NEARLY_REAL: f64 = 1e-9;

/// A root that is being followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Track {
    pub lambda: Complex64,
    /// dλ/dτ here and one cell earlier.
    pub slope: Complex64,
    pub earlier_slope: Complex64,
    pub error: f64,
}

/// What stands where nothing is followed.
pub(super) const NO_TRACK: Track = Track {
    lambda: Complex64::ZERO,
    slope: Complex64::ZERO,
    earlier_slope: Complex64::ZERO,
    error: 0.0,
};

/// The root near `predicted` at the delay `tau`; none where Halley's method does not settle at
/// once.
#[inline]
pub(super) fn correct(
    equation: impl Equation,
    tau: f64,
    predicted: Complex64,
) -> Option<(Track, u32)> {
    let mut lambda = predicted;
    for evaluation in 1..=MOST_EVALUATIONS {
        let jet = equation.jet(tau, lambda);
        let per_slope = divide(Complex64::ONE, jet.first);
        let bend = jet.second * per_slope;
        let step = halley_step(jet.value * per_slope, bend);
        let next = lambda - step;
        // What Halley's method leaves is of third order in the step, over the square of the
        // distance at which D bends.
        let size = step.l1_norm();
        let turn = size * bend.l1_norm().max(tau);
        if size * turn * turn <= SETTLED * (1.0 + next.l1_norm()) {
            let nearly_real = next.im != 0.0 && next.im.abs() < NEARLY_REAL * (1.0 + next.re.abs());
            if !nearly_real {
                return Some((track_at(equation, tau, next, &jet, per_slope), evaluation));
            }
            lambda = Complex64::new(next.re, 0.0);
        } else if turn < FARTHEST_STEP {
            lambda = next;
        } else {
            return None;
        }
    }
    None
}

/// dλ/dτ at the root `lambda`.
pub(super) fn delay_slope(equation: impl Equation, tau: f64, lambda: Complex64) -> Complex64 {
    let jet = equation.jet(tau, lambda);
    let per_slope = -1.0 / jet.first;
    -jet.feedback * lambda * jet.delayed * per_slope
}

/// The track at `lambda`, with D evaluated next to it.
#[inline]
fn track_at(
    equation: impl Equation,
    tau: f64,
    lambda: Complex64,
    jet: &Jet,
    per_slope: Complex64,
) -> Track {
    let slope = jet.feedback * jet.delayed * lambda * per_slope;
    let error = equation.rounding(jet, tau, lambda) * per_slope.l1_norm();
    let mirrored = |z: Complex64| if lambda.im < 0.0 { z.conj() } else { z };
    Track {
        lambda: mirrored(lambda),
        slope: mirrored(slope),
        earlier_slope: mirrored(slope),
        error,
    }
}
