//! Real polynomials with coefficients of many digits, and their values on the imaginary axis.

use std::array::from_fn;
use std::ops::{Add, Mul};

use super::super::polynomial::{MOST_DEGREE, Polynomial};
use super::number::{Number, UNIT};

const LENGTH: usize = MOST_DEGREE + 1;
/// Derivatives of which bounds are told, the value among them.
pub(super) const BOUNDS: usize = 4;

/// A complex number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Complex {
    pub re: Number,
    pub im: Number,
}

impl Complex {
    pub(super) const ZERO: Self = Self {
        re: Number::ZERO,
        im: Number::ZERO,
    };

    pub(super) fn scaled(self, by: Number) -> Self {
        Self {
            re: self.re * by,
            im: self.im * by,
        }
    }

    /// −i times this.
    pub(super) fn turned_back(self) -> Self {
        Self {
            re: self.im,
            im: -self.re,
        }
    }

    /// The real part of this times the conjugate of `other`.
    pub(super) fn along(self, other: Self) -> Number {
        self.re * other.re + self.im * other.im
    }

    /// The imaginary part of this times the conjugate of `other`.
    pub(super) fn across(self, other: Self) -> Number {
        self.im * other.re - self.re * other.im
    }

    /// A bound on the size that is at most twice as large.
    pub(super) fn size(self) -> f64 {
        self.re.value().abs() + self.im.value().abs()
    }
}

impl Add for Complex {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }
}

impl Mul for Complex {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

/// A value at iω with its first derivative by ω and half of its second one.
pub(super) type Jet = [Complex; 3];

/// Σ c_k s^k, each c_k known to within e_k.
#[derive(Debug, Clone, Copy)]
pub(super) struct Precise {
    values: [Number; LENGTH],
    errors: [f64; LENGTH],
    degree: usize,
}

impl Precise {
    pub(super) const ZERO: Self = Self {
        values: [Number::ZERO; LENGTH],
        errors: [0.0; LENGTH],
        degree: 0,
    };

    /// The polynomial with these coefficients, the constant first, each taken for exact.
    pub(super) fn new<const N: usize>(coefficients: [f64; N]) -> Self {
        let mut all = Self::ZERO;
        for (value, c) in all.values.iter_mut().zip(coefficients) {
            *value = Number::of(c);
        }
        all.degree = N - 1;
        all
    }

    /// A polynomial in f64 with its errors, its numbers with more digits.
    pub(super) fn of(of: &Polynomial) -> Self {
        let mut all = Self::ZERO;
        for (k, (&value, &error)) in of.coefficients().iter().zip(of.errors()).enumerate() {
            (all.values[k], all.errors[k]) = (Number::of(value), error);
        }
        all.degree = of.degree();
        all
    }

    /// `factor` times this.
    pub(super) fn scaled(&self, factor: Number) -> Self {
        let mut all = *self;
        for k in 0..=self.degree {
            all.values[k] = self.values[k] * factor;
            let size = factor.value().abs();
            all.errors[k] = 2.0 * size * (self.errors[k] + UNIT * self.values[k].value().abs());
        }
        all
    }

    /// This plus `other`.
    pub(super) fn plus(&self, other: &Self) -> Self {
        let mut all = *self;
        all.degree = self.degree.max(other.degree);
        for k in 0..=all.degree {
            let (a, b) = (self.values[k], other.values[k]);
            all.values[k] = a + b;
            let rounding = UNIT * (a.value().abs() + b.value().abs());
            all.errors[k] = self.errors[k] + other.errors[k] + rounding;
        }
        all
    }

    /// This less `other`.
    pub(super) fn minus(&self, other: &Self) -> Self {
        let mut negated = *other;
        for value in &mut negated.values[..=other.degree] {
            *value = -*value;
        }
        self.plus(&negated)
    }

    /// The product, of a degree that is small enough.
    pub(super) fn product(&self, other: &Self) -> Self {
        let mut all = Self::ZERO;
        all.degree = self.degree + other.degree;
        for i in 0..=self.degree {
            for j in 0..=other.degree {
                let (a, b) = (self.values[i], other.values[j]);
                let (a_size, b_size) = (a.value().abs(), b.value().abs());
                all.values[i + j] = all.values[i + j] + a * b;
                all.errors[i + j] += a_size * other.errors[j]
                    + b_size * self.errors[i]
                    + self.errors[i] * other.errors[j]
                    + 2.0 * LENGTH as f64 * UNIT * a_size * b_size;
            }
        }
        all
    }

    /// The value at iω with derivatives by ω.
    pub(super) fn jet(&self, omega: Number) -> Jet {
        let mut jet = [Complex::ZERO; 3];
        for (k, &c) in self.values[..=self.degree].iter().enumerate().rev() {
            for order in (1..jet.len()).rev() {
                jet[order] = jet[order].scaled(omega) + jet[order - 1];
            }
            let turned = if k % 4 < 2 { c } else { -c };
            let term = match k % 2 {
                0 => Complex {
                    re: turned,
                    im: Number::ZERO,
                },
                _ => Complex {
                    re: Number::ZERO,
                    im: turned,
                },
            };
            jet[0] = jet[0].scaled(omega) + term;
        }
        jet
    }

    /// Bounds on the errors of the value and of its derivative where |s| ≤ `omega`.
    pub(super) fn errors_at(&self, omega: f64) -> [f64; 2] {
        let unit = (4 * LENGTH) as f64 * UNIT;
        let (mut value, mut slope) = (0.0, 0.0);
        for k in (0..=self.degree).rev() {
            slope = slope * omega + value;
            value = value * omega + self.errors[k] + unit * self.values[k].value().abs();
        }
        [value, slope]
    }

    /// Bounds on the size of the value and of its first three derivatives where |s| ≤ `omega`.
    pub(super) fn bounds(&self, omega: f64) -> [f64; BOUNDS] {
        const FACTORIALS: [f64; BOUNDS] = [1.0, 1.0, 2.0, 6.0];
        let mut taylor = [0.0; BOUNDS];
        for k in (0..=self.degree).rev() {
            for order in (1..BOUNDS).rev() {
                taylor[order] = taylor[order] * omega + taylor[order - 1];
            }
            taylor[0] = taylor[0] * omega + self.values[k].value().abs() + self.errors[k];
        }
        from_fn(|order| FACTORIALS[order] * taylor[order])
    }
}
