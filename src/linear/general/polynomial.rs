//! Real polynomials with a bound on the error of every coefficient.

use num_complex::Complex64;

use super::products::{product, sum_of_products};
use crate::linear::rounded::Rounded;
use crate::model::ModelError;

/// The largest degree of a polynomial here.
pub const MOST_DEGREE: usize = 32;
const LENGTH: usize = MOST_DEGREE + 1;

/// The error of a polynomial with a larger degree than [`MOST_DEGREE`].
fn too_large(degree: usize) -> ModelError {
    ModelError {
        parameter: "degree",
        value: degree as f64,
        allowed: "at most 32",
        at_speed: None,
    }
}

/// Σ c_k s^k, each c_k known to within e_k.
///
/// The degree is that of the last coefficient which is not exactly 0. Whether that one is certain
/// to differ from 0 is another question: [`Polynomial::degree_known`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polynomial {
    values: [f64; LENGTH],
    errors: [f64; LENGTH],
    degree: usize,
}

/// A complex value and a bound on its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct At {
    /// The value.
    pub value: Complex64,
    /// A bound on the distance to the exact value.
    pub error: f64,
}

impl Polynomial {
    /// The polynomial that is 0 everywhere.
    pub const ZERO: Self = Self {
        values: [0.0; LENGTH],
        errors: [0.0; LENGTH],
        degree: 0,
    };

    /// The polynomial with these coefficients, from the constant on, each taken for exact.
    ///
    /// # Errors
    /// When there are more of them than [`MOST_DEGREE`] + 1.
    pub fn new(coefficients: &[f64]) -> Result<Self, ModelError> {
        if coefficients.len() > LENGTH {
            return Err(too_large(coefficients.len() - 1));
        }
        let mut all = Self::ZERO;
        all.values[..coefficients.len()].copy_from_slice(coefficients);
        all.trim(coefficients.len().saturating_sub(1));
        Ok(all)
    }

    /// `value` ± `error` everywhere.
    #[must_use]
    pub fn constant(value: f64, error: f64) -> Self {
        let mut all = Self::ZERO;
        (all.values[0], all.errors[0]) = (value, error);
        all
    }

    /// s itself.
    #[must_use]
    pub fn variable() -> Self {
        let mut all = Self::ZERO;
        all.values[1] = 1.0;
        all.degree = 1;
        all
    }

    /// The polynomial of these coefficients with their errors; the highest coefficient may be 0.
    pub(in crate::linear) fn of(degree: usize, coefficient: impl Fn(usize) -> Rounded) -> Self {
        let mut all = Self::ZERO;
        for k in 0..=degree {
            let Rounded { value, error } = coefficient(k);
            (all.values[k], all.errors[k]) = (value, error);
        }
        all.trim(degree);
        all
    }

    /// Sets the degree to what is left without exact zeros, at most `degree`.
    fn trim(&mut self, degree: usize) {
        let nonzero = |&k: &usize| self.values[k] != 0.0 || self.errors[k] != 0.0;
        self.degree = (0..=degree).rev().find(nonzero).unwrap_or(0);
    }

    /// The degree; 0 for constants, 0 itself among them.
    #[inline]
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Whether the highest coefficient is certain to differ from 0, or the polynomial is exactly 0.
    #[must_use]
    pub fn degree_known(&self) -> bool {
        self.is_zero() || self.leading().decided()
    }

    /// Whether the polynomial is exactly 0 everywhere.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.degree == 0 && self.values[0] == 0.0 && self.errors[0] == 0.0
    }

    /// Whether no coefficient is certain to differ from 0.
    pub(super) fn vanishes(&self) -> bool {
        (0..=self.degree).all(|k| !self.coefficient(k).decided())
    }

    /// The coefficients, from the constant on.
    #[inline]
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.values[..=self.degree]
    }

    /// Bounds on the errors of the coefficients, from the constant on.
    #[inline]
    #[must_use]
    pub fn errors(&self) -> &[f64] {
        &self.errors[..=self.degree]
    }

    /// Whether all coefficients and their errors are finite.
    #[inline]
    pub(super) fn is_finite(&self) -> bool {
        let mut all = self.coefficients().iter().chain(self.errors());
        all.all(|number| number.is_finite())
    }

    #[inline]
    pub(in crate::linear) fn coefficient(&self, k: usize) -> Rounded {
        Rounded {
            value: self.values[k],
            error: self.errors[k],
        }
    }

    #[inline]
    pub(super) fn leading(&self) -> Rounded {
        self.coefficient(self.degree)
    }

    /// `self` + `factor` · `other`, `factor` being exact.
    #[must_use]
    pub fn plus(&self, other: &Self, factor: f64) -> Self {
        let degree = self.degree.max(other.degree);
        Self::of(degree, |k| {
            let own = self.coefficient(k);
            let scaled = factor * other.values[k];
            let value = own.value + scaled;
            let sign_alone = factor.abs() == 1.0;
            let of_product = if sign_alone { 0.0 } else { scaled.abs() };
            let rounding = 0.5 * f64::EPSILON * (value.abs() + of_product);
            let exact = scaled == 0.0 || (own.value == 0.0 && sign_alone);
            Rounded {
                value,
                error: own.error
                    + factor.abs() * other.errors[k]
                    + if exact { 0.0 } else { rounding },
            }
        })
    }

    /// `self` times a number.
    #[must_use]
    pub(in crate::linear) fn scaled(&self, by: Rounded) -> Self {
        Self::of(self.degree, |k| product(self.coefficient(k), by))
    }

    /// The product of `self` and `other`.
    ///
    /// # Errors
    /// When its degree would be too large.
    pub fn times(&self, other: &Self) -> Result<Self, ModelError> {
        let degree = self.degree + other.degree;
        if degree > MOST_DEGREE {
            return Err(too_large(degree));
        }
        Ok(Self::of(degree, |k| {
            let from = k.saturating_sub(other.degree);
            let terms = (from..=k.min(self.degree))
                .map(|i| (self.coefficient(i), other.coefficient(k - i)));
            sum_of_products(terms)
        }))
    }

    /// The power `exponent` ≥ 0.
    ///
    /// # Errors
    /// When its degree would be too large.
    pub fn power(&self, exponent: u32) -> Result<Self, ModelError> {
        let degree = self.degree.saturating_mul(exponent as usize);
        if degree > MOST_DEGREE {
            return Err(too_large(degree));
        }
        let mut product = Self::constant(1.0, 0.0);
        for _ in 0..exponent {
            product = product.times(self)?;
        }
        Ok(product)
    }

    /// The polynomial in z for s = `by` + z.
    #[must_use]
    pub(in crate::linear) fn shifted(&self, by: f64) -> Self {
        if by == 0.0 {
            return *self;
        }
        let n = self.degree;
        let (mut values, mut sizes, mut errors) = (self.values, self.values, self.errors);
        for size in &mut sizes {
            *size = size.abs();
        }
        // Synthetic division, again and again; `sizes` is what it gives without cancellation.
        for low in 0..n {
            for k in (low..n).rev() {
                values[k] += by * values[k + 1];
                sizes[k] += by.abs() * sizes[k + 1];
                errors[k] += by.abs() * errors[k + 1];
            }
        }
        let unit = (n as f64 + 1.0) * f64::EPSILON;
        for k in 0..n {
            errors[k] += unit * sizes[k];
        }
        Self {
            values,
            errors,
            degree: n,
        }
    }

    /// The derivative.
    #[must_use]
    pub fn derivative(&self) -> Self {
        if self.degree == 0 {
            return Self::ZERO;
        }
        Self::of(self.degree - 1, |k| {
            let factor = (k + 1) as f64;
            let value = factor * self.values[k + 1];
            Rounded {
                value,
                error: factor * self.errors[k + 1] + 0.5 * f64::EPSILON * value.abs(),
            }
        })
    }

    /// The quotient by s, the constant term being taken for 0.
    pub(super) fn divided_by_variable(&self) -> Self {
        match self.degree {
            0 => Self::ZERO,
            n => Self::of(n - 1, |k| self.coefficient(k + 1)),
        }
    }

    /// This polynomial with another constant term.
    pub(super) fn with_constant(mut self, constant: Rounded) -> Self {
        (self.values[0], self.errors[0]) = (constant.value, constant.error);
        self
    }

    /// This polynomial without the highest coefficients that may be 0.
    pub(super) fn without_open_leading(&self) -> Self {
        let degree = (0..=self.degree)
            .rev()
            .find(|&k| self.coefficient(k).decided());
        Self::of(degree.unwrap_or(0), |k| self.coefficient(k))
    }

    /// The value at s = `at`, without a bound.
    #[inline]
    #[must_use]
    pub fn value(&self, at: Complex64) -> Complex64 {
        let mut sum = Complex64::new(self.values[self.degree], 0.0);
        for &c in self.values[..self.degree].iter().rev() {
            sum = Complex64::new(
                sum.re * at.re - sum.im * at.im + c,
                sum.re * at.im + sum.im * at.re,
            );
        }
        sum
    }

    /// The value with its first and second derivative at s = `at`.
    #[inline]
    #[must_use]
    pub fn jet(&self, at: Complex64) -> [Complex64; 3] {
        let zero = Complex64::new(0.0, 0.0);
        let (mut f, mut first, mut half_second) = (zero, zero, zero);
        for &c in self.coefficients().iter().rev() {
            half_second = half_second * at + first;
            first = first * at + f;
            f = f * at + c;
        }
        [f, first, 2.0 * half_second]
    }

    /// Σ |c_k| `size`^k and Σ e_k `size`^k: bounds on the size and the error of the value where |s|
    /// ≤ `size`.
    #[inline]
    #[must_use]
    pub(in crate::linear) fn bounds(&self, size: f64) -> (f64, f64) {
        let (mut value, mut error) = (0.0, 0.0);
        for (c, e) in self.coefficients().iter().zip(self.errors()).rev() {
            value = value * size + c.abs();
            error = error * size + e;
        }
        (value, error)
    }

    /// The value at iω, `omega` being known to within `error`.
    #[must_use]
    pub(super) fn on_axis(&self, omega: f64, error: f64) -> At {
        let x = omega * omega;
        let (mut even, mut odd) = (0.0, 0.0);
        for (k, c) in self.coefficients().iter().enumerate().rev() {
            let part = if k % 2 == 0 { &mut even } else { &mut odd };
            *part = *c - x * *part;
        }
        let (size, known) = self.bounds(omega.abs());
        let rounding = 2.0 * (self.degree as f64 + 1.0) * f64::EPSILON * size;
        let moved = if error > 0.0 {
            self.slope_bound(omega.abs() + error) * error
        } else {
            0.0
        };
        At {
            value: Complex64::new(even, omega * odd),
            error: known + rounding + moved,
        }
    }

    /// A bound on the size of the derivative where |s| ≤ `size`.
    fn slope_bound(&self, size: f64) -> f64 {
        let mut slope = 0.0;
        for (k, c) in self.coefficients().iter().enumerate().skip(1).rev() {
            slope = slope * size + k as f64 * c.abs();
        }
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_larger_degree_is_refused_with_the_largest() {
        let largest = Polynomial::new(&[1.0; LENGTH]).unwrap();
        let too_long = Polynomial::new(&[1.0; LENGTH + 1]).unwrap_err();
        assert_eq!(too_long.value, LENGTH as f64);
        assert_eq!(too_long.allowed, format!("at most {MOST_DEGREE}"));
        let twice = 2.0 * MOST_DEGREE as f64;
        assert_eq!(largest.power(2).unwrap_err().value, twice);
        assert_eq!(largest.times(&largest).unwrap_err().value, twice);
    }
}
