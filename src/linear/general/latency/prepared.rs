//! A function that swings with one delay, with all that is evaluated of it at one frequency side by
//! side.

use super::super::polynomial::{MOST_DEGREE, Polynomial};
use crate::linear::real_zeros::{At, RealFunction};
use crate::linear::rounded::Rounded;
use crate::model::elementary::sincos;

/// Rounded operations behind each value, in units of ε of its terms.
const ROUNDINGS: f64 = 4.0;
const VALUES: usize = 6;
const ERRORS: usize = 5;
const BENDS: usize = 2;
const LENGTH: usize = MOST_DEGREE + 1;

/// The coefficients of all that is evaluated at one frequency, side by side.
pub(super) struct Prepared {
    /// u, v, w; u′/ω, v′/ω and (ωw)′.
    values: [[f64; VALUES]; LENGTH],
    /// Bounds on the errors of u, v and w; the even and the odd part of one on the error of f′.
    errors: [[f64; ERRORS]; LENGTH],
    /// The even and the odd part of M.
    bends: [[f64; BENDS]; LENGTH],
    length: usize,
    t: f64,
}

#[inline]
fn horner<const N: usize>(coefficients: &[[f64; N]], x: f64) -> [f64; N] {
    let mut sum = [0.0; N];
    for c in coefficients.iter().rev() {
        for (sum, c) in sum.iter_mut().zip(c) {
            *sum = *sum * x + c;
        }
    }
    sum
}

impl Prepared {
    /// What is evaluated of u, v and w = `parts` at the delay `t`.
    pub(super) fn new(parts: &[Polynomial; 3], t: f64) -> Self {
        let degree = parts.iter().map(Polynomial::degree).max().unwrap_or(0);
        let mut prepared = Self {
            values: [[0.0; VALUES]; LENGTH],
            errors: [[0.0; ERRORS]; LENGTH],
            bends: [[0.0; BENDS]; LENGTH],
            length: degree + 1,
            t,
        };
        let unit = (ROUNDINGS + 2.0 * degree as f64) * f64::EPSILON;
        let coefficient = |part: usize, k: usize| match k {
            k if k <= degree => parts[part].coefficient(k),
            _ => Rounded {
                value: 0.0,
                error: 0.0,
            },
        };
        for k in 0..=degree {
            let [u, v, w] = [0, 1, 2].map(|part| coefficient(part, k));
            let [next_u, next_v, next_w] = [0, 1, 2].map(|part| coefficient(part, k + 1));
            let (even, odd) = (2.0 * (k + 1) as f64, (2 * k + 1) as f64);
            prepared.values[k] = [
                u.value,
                v.value,
                w.value,
                even * next_u.value,
                even * next_v.value,
                odd * w.value,
            ];
            let error = |c: Rounded| c.error + unit * c.value.abs();
            let size = |c: Rounded| c.error + c.value.abs();
            prepared.errors[k] = [
                error(u),
                error(v),
                error(w),
                t * error(v) + odd * error(w),
                even * (error(next_u) + 2.0 * error(next_v)) + t * error(w),
            ];
            prepared.bends[k] = [
                // Of (u + v) − v cos ωt.
                even * odd
                    * ((next_u.value + next_v.value).abs()
                        + next_u.error
                        + next_v.error
                        + size(next_v))
                    + t * (t * size(v) + 2.0 * odd * size(w)),
                2.0 * even * t * size(next_v) + even * (odd + 2.0) * size(next_w) + t * t * size(w),
            ];
        }
        prepared
    }
}

impl RealFunction for Prepared {
    #[inline]
    fn at(&self, omega: f64) -> At {
        let x = omega * omega;
        let [u, v, w, u_slope, v_slope, w_slope] = horner(&self.values[..self.length], x);
        let errors = horner(&self.errors[..self.length], x);
        let angle = omega * self.t;
        let (half_sin, half_cos) = sincos(0.5 * angle);
        let (versine, sin) = (2.0 * half_sin * half_sin, 2.0 * half_sin * half_cos);
        let cos = 1.0 - versine;
        let value = u + v * versine + omega * w * sin;
        let slope = omega * (u_slope + v_slope * versine)
            + (v * self.t + w_slope) * sin
            + omega * w * self.t * cos;
        // The angle is rounded as well.
        let turned = f64::EPSILON * angle;
        let error = errors[0]
            + errors[1] * versine
            + omega * errors[2] * sin.abs()
            + turned * (v.abs() * sin.abs() + omega * w.abs() * cos.abs());
        let slope_error = errors[3] + omega * errors[4] + turned * self.bend(omega);
        At {
            omega,
            value: Rounded { value, error },
            slope: Rounded {
                value: slope,
                error: slope_error,
            },
        }
    }

    #[inline]
    fn bend(&self, omega: f64) -> f64 {
        let [even, odd] = horner(&self.bends[..self.length], omega * omega);
        even + omega * odd
    }
}
