//! A digital loop on |z| = 1: its polynomials at an angle, and bounds on their sizes.
//!
//! With s + ic = i e^(−imφ/2) and w = (1 + R) s − i (1 − R) c, equation (1) of the room is
//!
//! ```text
//! p z^l w = 2 s q,   z = e^(iφ)                                                               (2)
//! ```

use num_complex::Complex64;

use super::SampledLoop;
use super::circle::{Circle, slope, value};
use super::step::Quadratic;
use crate::model::elementary::sincos;

/// Rounding errors that sums of these parts gather.
pub(super) const ROUNDINGS: f64 = 64.0 * f64::EPSILON;

/// p z^l, w and 2 s at an angle, with their slopes.
pub(super) struct Parts {
    pub open: [Complex64; 2],
    pub turn: [Complex64; 2],
    pub twice_sine: [f64; 2],
}

/// A loop at a delay of `multiple` samples, on |z| = 1.
pub(super) struct OnCircle<'l> {
    pub of: &'l SampledLoop,
    circle: Circle,
    pub multiple: f64,
}

impl<'l> OnCircle<'l> {
    pub(super) fn new(of: &'l SampledLoop, multiple: u64) -> Self {
        Self {
            of,
            circle: Circle::new(0.0),
            multiple: multiple as f64,
        }
    }

    pub(super) fn parts(&self, angle: f64) -> Parts {
        let [p, p_slope] = self.value(self.of.step.open, angle);
        let late = self.of.late as f64;
        let (sine, cosine) = sincos(late * angle);
        let turned = Complex64::new(cosine, sine);
        let (s, c) = sincos(0.5 * self.multiple * angle);
        let (more, less) = (1.0 + self.of.memory, 1.0 - self.of.memory);
        Parts {
            open: [turned * p, turned * (p_slope + Complex64::i() * late * p)],
            turn: [
                Complex64::new(more * s, -less * c),
                Complex64::new(more * c, less * s) * (0.5 * self.multiple),
            ],
            twice_sine: [2.0 * s, self.multiple * c],
        }
    }

    /// c(z) at an angle, and its slope.
    pub(super) fn value(&self, c: Quadratic, angle: f64) -> [Complex64; 2] {
        let zeta = self.circle.zeta(angle);
        let turning = Complex64::i() * (zeta + 1.0);
        [value(c, zeta), slope(c, zeta) * turning]
    }

    /// Bounds up to `angle` on the size of c(z) and of its first and second slopes.
    pub(super) fn bounds(&self, c: Quadratic, angle: f64) -> [f64; 3] {
        self.circle.bounds(c, angle)
    }

    /// Bounds up to `angle` on the size of p z^l and of its first and second slopes.
    pub(super) fn open_bounds(&self, angle: f64) -> [f64; 3] {
        let late = self.of.late as f64;
        times(
            self.bounds(self.of.step.open, angle),
            [1.0, late, late * late],
        )
    }

    /// |w|, |w′| and |w″| at most.
    pub(super) fn turn_bounds(&self) -> [f64; 3] {
        self.turns(1.0 + self.of.memory.abs())
    }

    /// |2 s| and the sizes of its first and second slopes at most.
    pub(super) fn sine_bounds(&self) -> [f64; 3] {
        self.turns(2.0)
    }

    fn turns(&self, size: f64) -> [f64; 3] {
        let half = 0.5 * self.multiple;
        [size, size * half, size * half * half]
    }
}

/// Bounds on a product and its slopes, from those of its factors.
pub(super) fn times(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[0] * b[0],
        a[1] * b[0] + a[0] * b[1],
        a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2],
    ]
}
