//! Where the zeros of a polynomial in x = ω² can be, at no cost of finding them.

use super::super::polynomial::{MOST_DEGREE, Polynomial};
use crate::model::elementary::{power, rough_root};

/// Bounds come nearer to the largest zero of a polynomial in steps of this factor.
const NEARER: f64 = 0.7;
/// The most such steps.
const MOST_STEPS: u32 = 60;

/// A range of frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    pub from: f64,
    pub to: f64,
}

/// A frequency below which `f`, a polynomial in x = ω² that is positive at 0, has no zero by
/// Budan's theorem.
pub(crate) fn before_zeros(f: &Polynomial) -> f64 {
    let n = f.degree();
    1.0 / beyond_zeros(&Polynomial::of(n, |k| f.coefficient(n - k)))
}

/// A frequency beyond which `f`, a polynomial in x = ω² with a positive highest coefficient, has no
/// zero by Budan's theorem.
pub(crate) fn beyond_zeros(f: &Polynomial) -> f64 {
    f.beyond_zeros().sqrt() * (1.0 + 1e-12)
}

impl Polynomial {
    /// An x > 0, or 0, beyond which this polynomial, whose highest coefficient is positive, has no
    /// zero by Budan's theorem.
    pub(in crate::linear) fn beyond_zeros(&self) -> f64 {
        let f = self;
        let n = f.degree();
        let leading = f.leading().value - f.leading().error;
        // Kioustelidis: twice the largest (−c_k/c_n)^(1/(n − k)).
        let bound = (0..n)
            .map(|k| (k, f.coefficient(k)))
            .map(|(k, c)| (n - k, c.error - c.value))
            .filter(|(_, c)| *c > 0.0)
            .map(|(order, c)| rough_root(c / leading, order))
            .fold(0.0, f64::max);
        if bound == 0.0 {
            return 0.0;
        }
        let mut lowest = [0.0; MOST_DEGREE + 1];
        for (k, lowest) in lowest[..=n].iter_mut().enumerate() {
            *lowest = f.coefficient(k).value - f.coefficient(k).error;
        }
        let mut x = 2.0 * bound * (1.0 + 1e-6);
        for _ in 0..MOST_STEPS {
            if !positive_beyond(&lowest[..=n], NEARER * x) {
                break;
            }
            x *= NEARER;
        }
        x
    }
}

/// By Budan's theorem a polynomial has no zero beyond `x` where all its Taylor coefficients are
/// positive there.
fn positive_beyond(coefficients: &[f64], x: f64) -> bool {
    let mut taylor = [0.0; MOST_DEGREE + 1];
    let n = coefficients.len() - 1;
    taylor[..=n].copy_from_slice(coefficients);
    // Rounding is far less than this part of the sizes.
    let size = coefficients
        .iter()
        .rev()
        .fold(0.0, |sum, c| sum * x + c.abs());
    for low in 0..=n {
        for k in (low..n).rev() {
            taylor[k] += x * taylor[k + 1];
        }
        // Times xᵏ all of them are of one size.
        if taylor[low] * power(x, low as i32) <= 1e-12 * size {
            return false;
        }
    }
    true
}
