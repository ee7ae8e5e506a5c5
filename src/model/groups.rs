//! The dimensionless groups on which linear stability depends, beside the delay, and what they
//! make of λ: the open loop B and the feedback A.
//!
//! ```text
//! D(λ) = B(λ) − A(λ) (1 − e^(−λτ)),   B = λ² + bλ + 1,   A = a_n + a_v (b + λ)
//! ```

use std::ops::{Add, Mul};

use num_complex::Complex64;

/// Dimensionless groups of the controlled oscillator; the time unit is √(M/κ).
///
/// With E = e^(−λτ) the letter's Eq. (3) reads
///
/// ```text
/// D(λ) = λ² + [b − a_v (1 − E)] λ + 1 − [b a_v + a_n] (1 − E)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Groups {
    /// b = μ_K′(v0) N0 / √(κM): damping by the slope of the friction law; negative where friction
    /// weakens.
    pub b: f64,
    /// a_v = α_v √(M/κ): gain of velocity control.
    pub a_v: f64,
    /// a_n = μ_K(v0) α_N / κ: gain of load control.
    pub a_n: f64,
}

impl Groups {
    /// Groups with the given values; for M = κ = N0 = μ_K = 1 they equal μ_K′, α_v and α_N.
    #[must_use]
    pub const fn new(b: f64, a_v: f64, a_n: f64) -> Self {
        Self { b, a_v, a_n }
    }

    /// These groups where a dashpot d = c/√(κM) beside the spring feels the pulling velocity: it
    /// takes d a_v off a_n.
    #[inline]
    #[must_use]
    pub(crate) fn coupled(self, damping: f64) -> Self {
        if damping == 0.0 {
            return self;
        }
        Self {
            a_n: self.a_n - damping * self.a_v,
            ..self
        }
    }

    /// A where b + λ is the real number `moving`, rounded once.
    #[inline]
    #[must_use]
    pub fn feedback(&self, moving: f64) -> f64 {
        self.a_v.mul_add(moving, self.a_n)
    }

    /// True when no control acts: a_v = a_n = 0.
    #[must_use]
    pub fn uncontrolled(&self) -> bool {
        self.a_v == 0.0 && self.a_n == 0.0
    }
}

/// Numbers for which B and A are written: real, complex, enclosures.
pub(crate) trait Ring: Copy + Add<Output = Self> + Mul<Output = Self> {
    /// This number and 1.
    #[must_use]
    fn plus_one(self) -> Self;

    /// This number times a real one.
    #[must_use]
    fn scaled(self, by: f64) -> Self;
}

impl Ring for f64 {
    #[inline]
    fn plus_one(self) -> Self {
        self + 1.0
    }

    #[inline]
    fn scaled(self, by: f64) -> Self {
        self * by
    }
}

impl Ring for Complex64 {
    #[inline]
    fn plus_one(self) -> Self {
        self + 1.0
    }

    #[inline]
    fn scaled(self, by: f64) -> Self {
        self * by
    }
}

/// B = λ² + bλ + 1.
#[inline]
pub(crate) fn open_loop<B, R: Ring + Add<B, Output = R>>(b: B, lambda: R) -> R {
    (lambda * (lambda + b)).plus_one()
}

/// A = a_n + a_v (b + λ), where b + λ is `moving`.
#[inline]
pub(crate) fn feedback<N: Add<R, Output = R>, R: Ring>(a_n: N, a_v: f64, moving: R) -> R {
    a_n + moving.scaled(a_v)
}

/// The coefficients of B, the constant first.
#[must_use]
pub(crate) const fn open_loop_coefficients(b: f64) -> [f64; 3] {
    [1.0, b, 1.0]
}

/// The coefficients of A, the constant first.
#[inline]
#[must_use]
pub(crate) fn feedback_coefficients(groups: Groups) -> [f64; 2] {
    let Groups { b, a_v, a_n } = groups;
    [feedback(a_n, a_v, b), a_v]
}
