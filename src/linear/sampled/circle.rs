//! A circle |z| = r, and the angles on it at which two polynomials are of the same size.
//!
//! With X = |ζ|² the size |c(ζ)|² of a quadratic is a quadratic in X, since 2 Re ζ = r² − 1 − X on
//! the circle.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use super::step::Quadratic;
use crate::model::elementary::{arg, atan2, exp, expm1, sincos};

/// Rounding errors that the numbers of a junction gather.
const ROUNDINGS: f64 = 16.0 * f64::EPSILON;

/// A circle about 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Circle {
    /// ln r.
    pub growth: f64,
    /// r − 1.
    beyond: f64,
    /// r² − 1.
    square: f64,
    radius: f64,
}

/// An angle at which z^m U and V are of the same size, with what happens there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Junction {
    /// The angle, in (0, π).
    pub angle: f64,
    /// A bound on its error.
    pub angle_error: f64,
    /// arg(−V/U), in [0, 2π).
    pub phase: f64,
    /// A bound on its error.
    pub phase_error: f64,
    /// Half of what the number of zeros outside the circle changes by where a pair passes it; 0
    /// where |U| and |V| only come near to one another.
    pub sign: i8,
}

impl Junction {
    /// How many pairs pass the circle here while the exponent grows from 0 to `exponent`, one at
    /// `exponent` itself left out.
    pub(super) fn passed(&self, exponent: f64) -> i64 {
        let turns = (exponent * self.angle - self.phase) / TAU;
        turns.ceil().max(0.0) as i64
    }
}

/// An angle in (−π, π] as one in [0, 2π).
pub(super) fn turned(angle: f64) -> f64 {
    if angle < 0.0 { angle + TAU } else { angle }
}

impl Circle {
    /// The circle with ln r = `growth`.
    pub(super) fn new(growth: f64) -> Self {
        let beyond = expm1(growth);
        Self {
            growth,
            beyond,
            square: beyond * (2.0 + beyond),
            radius: exp(growth),
        }
    }

    /// c(ζ) at z = −r.
    pub(super) fn opposite(&self, [c0, c1, c2]: Quadratic) -> f64 {
        let zeta = -2.0 - self.beyond;
        c0 + zeta * (c1 + zeta * c2)
    }

    /// ζ = z − 1 at an angle.
    pub(super) fn zeta(&self, angle: f64) -> Complex64 {
        let (sine, cosine) = sincos(0.5 * angle);
        let imaginary = 2.0 * self.radius * sine * cosine;
        Complex64::new(self.beyond - 2.0 * self.radius * sine * sine, imaginary)
    }

    /// Bounds up to `angle` on |c| and on its first and second derivative with respect to the
    /// angle.
    pub(super) fn bounds(&self, c: Quadratic, angle: f64) -> [f64; 3] {
        let [c0, c1, c2] = c.map(f64::abs);
        let r = self.radius;
        let far = self.beyond.abs() + r * angle.min(PI);
        let slope = c1 + 2.0 * c2 * far;
        [
            c0 + c1 * far + c2 * far * far,
            slope * r,
            slope * r + 2.0 * c2 * r * r,
        ]
    }

    /// The coefficients of |c(ζ)|² in X, the constant first, and the sizes of their terms.
    fn size(&self, [c0, c1, c2]: Quadratic) -> [[f64; 2]; 3] {
        let s = self.square;
        let sum = |terms: &[f64]| {
            let size = terms.iter().map(|term| term.abs()).sum();
            [terms.iter().sum(), size]
        };
        [
            sum(&[c0 * c0, c2 * c0 * s * s, c1 * c0 * s]),
            sum(&[c1 * c1, c2 * c1 * s, -2.0 * c2 * c0 * (1.0 + s), -c1 * c0]),
            sum(&[c2 * c2, -c2 * c1, c2 * c0]),
        ]
    }

    /// Visits the angles in (0, π) at which |U| = |V|, by falling angle.
    pub(super) fn junctions(&self, u: Quadratic, v: Quadratic, mut visit: impl FnMut(Junction)) {
        let (u_size, v_size) = (self.size(u), self.size(v));
        let mut gap = [0.0; 3];
        let mut error = [0.0; 3];
        for k in 0..3 {
            gap[k] = u_size[k][0] - v_size[k][0];
            error[k] = ROUNDINGS * (u_size[k][1] + v_size[k][1]);
        }
        for (x, sign) in zeros(gap).into_iter().flatten() {
            let lifted = x - self.beyond * self.beyond;
            let quarter = 0.25 * lifted / self.radius;
            if !(quarter > 0.0 && quarter < 1.0) {
                continue;
            }
            let sine = quarter.sqrt();
            let cosine = (1.0 - quarter).sqrt();
            let slope = (gap[1] + 2.0 * gap[2] * x).abs();
            let x_error = (error[0] + error[1] * x + error[2] * x * x) / slope + ROUNDINGS * x;
            let zeta = Complex64::new(0.5 * (self.square - x), 2.0 * self.radius * sine * cosine);
            let (at_u, at_v) = (value(u, zeta), value(v, zeta));
            let angle = 2.0 * atan2(sine, cosine);
            let angle_error = x_error / (4.0 * self.radius * sine * cosine) + ROUNDINGS * angle;
            let blur = |c: Quadratic| {
                let steep = c[1].abs() + 2.0 * c[2].abs() * x.sqrt();
                ROUNDINGS * (c[0].abs() + (c[1].abs() + c[2].abs() * x.sqrt()) * x.sqrt())
                    + steep * self.radius * angle_error
            };
            visit(Junction {
                angle,
                angle_error,
                phase: turned(arg(-at_v * at_u.conj())),
                phase_error: (blur(u) + blur(v)) / at_u.norm_sqr().sqrt(),
                sign,
            });
        }
    }

    /// How many zeros of the quadratic lie outside; where its degree is lower, the others are at
    /// infinity.
    pub(super) fn outside(&self, [c0, c1, c2]: Quadratic) -> u64 {
        let out = |zeta: f64| u64::from(zeta > self.beyond || zeta < -2.0 - self.beyond);
        if c2 == 0.0 {
            return 1 + if c1 == 0.0 { 1 } else { out(-c0 / c1) };
        }
        let discriminant = c1 * c1 - 4.0 * c2 * c0;
        if discriminant < 0.0 {
            return 2 * u64::from((c0 - c1) / c2 > self.square);
        }
        let larger = -0.5 * (c1 + discriminant.sqrt().copysign(c1));
        if larger == 0.0 {
            return 2 * out(0.0);
        }
        out(larger / c2) + out(c0 / larger)
    }
}

/// c(ζ).
pub(super) fn value([c0, c1, c2]: Quadratic, zeta: Complex64) -> Complex64 {
    (zeta * c2 + c1) * zeta + c0
}

/// c′(ζ).
pub(super) fn slope([_, c1, c2]: Quadratic, zeta: Complex64) -> Complex64 {
    zeta * (2.0 * c2) + c1
}

/// The zeros of a quadratic, the constant first, by falling size, with the sign of its slope there.
fn zeros([c0, c1, c2]: [f64; 3]) -> [Option<(f64, i8)>; 2] {
    let sign = |slope: f64| if slope > 0.0 { 1 } else { -1 };
    if c2 == 0.0 {
        let zero = (c1 != 0.0).then(|| (-c0 / c1, sign(c1)));
        return [zero, None];
    }
    let discriminant = c1 * c1 - 4.0 * c2 * c0;
    if discriminant <= 0.0 {
        return [None, None];
    }
    let larger = -0.5 * (c1 + discriminant.sqrt().copysign(c1));
    let (one, other) = (larger / c2, c0 / larger);
    let [low, high] = if one < other {
        [one, other]
    } else {
        [other, one]
    };
    [Some((high, sign(c2))), Some((low, sign(-c2)))]
}
