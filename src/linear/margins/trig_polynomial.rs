//! Real functions on the line λ = −σ + iω that are polynomials in ω, sin tω and cos tω.
//!
//! ```text
//! f(ω) = p(ω) + c(ω) cos tω + s(ω) sin tω                                                  (1)
//! f′(ω) = p′ + (c′ + t s) cos tω + (s′ − t c) sin tω                                       (2)
//! ```

use super::zeros::{Bounded, Wave};
use crate::model::elementary::sincos;

/// Coefficients of a polynomial, from the constant on: no equation here has more of them.
const LENGTH: usize = 5;

/// A polynomial in ω.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Polynomial(pub [f64; LENGTH]);

impl Polynomial {
    /// The polynomial with these first coefficients.
    pub(super) fn of<const N: usize>(coefficients: [f64; N]) -> Self {
        let mut all = [0.0; LENGTH];
        all[..N].copy_from_slice(&coefficients);
        Self(all)
    }

    #[inline]
    fn at(&self, omega: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, c| sum * omega + c)
    }

    /// A bound on its size up to `omega` ≥ 0.
    #[inline]
    fn bound(&self, omega: f64) -> f64 {
        self.0
            .iter()
            .rev()
            .fold(0.0, |sum, c| sum * omega + c.abs())
    }

    fn derivative(&self) -> Self {
        let mut of = [0.0; LENGTH];
        for (i, c) in self.0.iter().enumerate().skip(1) {
            of[i - 1] = i as f64 * c;
        }
        Self(of)
    }

    pub(super) fn plus(self, other: Self, times: f64) -> Self {
        let mut sum = self.0;
        for (s, o) in sum.iter_mut().zip(other.0) {
            *s += times * o;
        }
        Self(sum)
    }

    /// The product; its degree must fit.
    pub(super) fn times(self, other: Self) -> Self {
        let mut product = [0.0; LENGTH];
        for (i, a) in self.0.into_iter().enumerate() {
            for (j, b) in other.0.into_iter().enumerate() {
                debug_assert!(i + j < LENGTH || a * b == 0.0);
                if i + j < LENGTH {
                    product[i + j] += a * b;
                }
            }
        }
        Self(product)
    }
}

/// A function (1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TrigPolynomial {
    /// p.
    pub free: Polynomial,
    /// c.
    pub cosine: Polynomial,
    /// s.
    pub sine: Polynomial,
    /// t > 0.
    pub t: f64,
}

impl TrigPolynomial {
    /// The function with its derivatives.
    pub(super) fn jet(self) -> Jet {
        let first = self.derivative();
        let second = first.derivative();
        let f = self;
        Jet { f, first, second }
    }

    /// The derivative (2).
    fn derivative(&self) -> Self {
        let Self {
            free,
            cosine,
            sine,
            t,
        } = *self;
        Self {
            free: free.derivative(),
            cosine: cosine.derivative().plus(sine, t),
            sine: sine.derivative().plus(cosine, -t),
            t,
        }
    }

    /// The value at `omega`, with sin tω and cos tω given.
    #[inline]
    fn at(&self, omega: f64, (sin, cos): (f64, f64)) -> Bounded {
        let value = self.free.at(omega) + self.cosine.at(omega) * cos + self.sine.at(omega) * sin;
        let waves = self.cosine.bound(omega) + self.sine.bound(omega);
        // The angle tω is rounded as well.
        let error = 16.0 * (self.free.bound(omega) + waves) + self.t * omega * waves;
        (value, f64::EPSILON * error)
    }

    /// A bound on its size up to `omega` ≥ 0.
    #[inline]
    fn bound(&self, omega: f64) -> f64 {
        self.free.bound(omega) + self.cosine.bound(omega) + self.sine.bound(omega)
    }
}

/// A function with two derivatives.
pub struct Jet {
    f: TrigPolynomial,
    first: TrigPolynomial,
    second: TrigPolynomial,
}

impl Wave for Jet {
    #[inline]
    fn at(&self, omega: f64) -> [Bounded; 2] {
        let waves = sincos(self.f.t * omega);
        [self.f.at(omega, waves), self.first.at(omega, waves)]
    }

    #[inline]
    fn value(&self, omega: f64) -> Bounded {
        self.f.at(omega, sincos(self.f.t * omega))
    }

    #[inline]
    fn bend(&self, omega: f64) -> f64 {
        self.second.bound(omega)
    }
}
