//! Real functions of ω that swing with several delays.
//!
//! ```text
//! f(ω) = Σ_k Re or Im [Z_k(iω) e^(−iωt_k)],   Z_k a real polynomial, t_k ≥ 0                (1)
//! Z(iω) = C(x) + iω S(x),   x = ω²                                                          (2)
//! Re: f = Σ  C cos ωt + ωS sin ωt,     f′ = Σ  ωU cos ωt + V sin ωt                         (3)
//! Im: f = Σ ωS cos ωt −  C sin ωt,     f′ = Σ   V cos ωt − ωU sin ωt                        (4)
//! U = C′/ω + tS,   V = (ωS)′ − tC
//! ```
//!
//! Bounds on the rounding of f and f′ and on |f″| are polynomials in ω made of absolute
//! coefficients.

use super::super::zeros::{Bounded, Wave};
use crate::linear::general::Polynomial;
use crate::linear::rounded::Rounded;
use crate::model::elementary::sincos;

/// The most delays of one sum.
const MOST_TERMS: usize = 5;
/// Coefficients of Z: none here is of a degree above 10.
const LENGTH: usize = 11;
/// Coefficients in x.
const HALF: usize = LENGTH.div_ceil(2);
/// Rounded operations behind each value, in units of ε of its terms.
const ROUNDINGS: f64 = 16.0;

/// Which part of the terms of (1) is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Real,
    Imaginary,
}

/// The terms of a function (1).
#[derive(Debug, Clone)]
pub(super) struct Terms {
    part: Part,
    list: [(Polynomial, f64); MOST_TERMS],
    count: usize,
}

impl Terms {
    pub(super) fn new(part: Part) -> Self {
        Self {
            part,
            list: [(Polynomial::ZERO, 0.0); MOST_TERMS],
            count: 0,
        }
    }

    /// These terms and `weight` · Z e^(−iωt), t of either sign; at most five sizes of t.
    pub(super) fn plus(mut self, z: &Polynomial, weight: Rounded, t: f64) -> Self {
        let mut scaled = z.scaled(weight);
        if t < 0.0 {
            // Z e^(iω|t|) is the conjugate of Z* e^(−iω|t|).
            scaled = conjugate(&scaled);
            if self.part == Part::Imaginary {
                scaled = Polynomial::ZERO.plus(&scaled, -1.0);
            }
        }
        let list = &mut self.list[..self.count];
        if let Some((sum, _)) = list.iter_mut().find(|(_, other)| *other == t.abs()) {
            *sum = sum.plus(&scaled, 1.0);
        } else {
            self.list[self.count] = (scaled, t.abs());
            self.count += 1;
        }
        self
    }

    /// Σ (|c_k| + e_k) of all terms, for every power of ω: |f| is at most that polynomial.
    pub(super) fn sizes(&self) -> Polynomial {
        let terms = &self.list[..self.count];
        let degree = terms.iter().map(|(z, _)| z.degree()).max().unwrap_or(0);
        let size = |k: usize| {
            let of = terms.iter().map(|(z, _)| z.coefficient(k));
            of.map(|c| c.value.abs() + c.error).sum()
        };
        let sizes: [f64; LENGTH] = std::array::from_fn(size);
        crate::linear::feedback_loop::polynomial(&sizes[..=degree])
    }

    /// The function of ω whose zeros are searched for.
    pub(super) fn sum(&self) -> Sum {
        let mut sum = Sum {
            part: self.part,
            waves: [Waves::NONE; MOST_TERMS],
            count: self.count,
            error: [0.0; LENGTH + 1],
            slope_error: [0.0; LENGTH + 1],
            bend: [0.0; LENGTH],
            length: 0,
        };
        for ((z, t), waves) in self.list[..self.count].iter().zip(&mut sum.waves) {
            sum.length = sum.length.max(z.degree() + 1);
            *waves = Waves::of(z, *t);
        }
        for (z, t) in &self.list[..self.count] {
            sum.bound(z, *t);
        }
        sum
    }
}

/// Z* on the imaginary axis.
pub(super) fn conjugate(z: &Polynomial) -> Polynomial {
    Polynomial::of(z.degree(), |k| {
        let c = z.coefficient(k);
        let value = if k % 2 == 1 { -c.value } else { c.value };
        Rounded { value, ..c }
    })
}

/// One term: C, S, U and V side by side.
#[derive(Debug, Clone, Copy)]
struct Waves {
    coefficients: [[f64; 4]; HALF],
    length: usize,
    t: f64,
}

impl Waves {
    const NONE: Self = Self {
        coefficients: [[0.0; 4]; HALF],
        length: 0,
        t: 0.0,
    };

    fn of(z: &Polynomial, t: f64) -> Self {
        let mut waves = Self {
            t,
            length: z.degree() / 2 + 1,
            ..Self::NONE
        };
        // i² = −1.
        let signed = |k: usize| match k {
            k if k > z.degree() => 0.0,
            k if (k / 2) % 2 == 1 => -z.coefficient(k).value,
            k => z.coefficient(k).value,
        };
        for (j, of) in waves.coefficients[..waves.length].iter_mut().enumerate() {
            let [even, odd, next] = [0, 1, 2].map(|i| signed(2 * j + i));
            let by = (2 * j) as f64;
            *of = [
                even,
                odd,
                (by + 2.0) * next + t * odd,
                (by + 1.0) * odd - t * even,
            ];
        }
        waves
    }

    /// C, S, U and V at x.
    #[inline]
    fn at(&self, x: f64) -> [f64; 4] {
        let mut sum = [0.0; 4];
        for of in self.coefficients[..self.length].iter().rev() {
            for (sum, c) in sum.iter_mut().zip(of) {
                *sum = *sum * x + c;
            }
        }
        sum
    }

    #[inline]
    fn sincos(&self, omega: f64) -> (f64, f64) {
        match self.t {
            0.0 => (0.0, 1.0),
            t => sincos(t * omega),
        }
    }
}

/// A function (1), prepared.
#[derive(Debug, Clone)]
pub struct Sum {
    part: Part,
    waves: [Waves; MOST_TERMS],
    count: usize,
    error: [f64; LENGTH + 1],
    slope_error: [f64; LENGTH + 1],
    bend: [f64; LENGTH],
    /// Coefficients of the bounds, of the first two one more.
    length: usize,
}

#[inline]
fn horner(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

impl Sum {
    /// Adds what a term adds to the bounds.
    fn bound(&mut self, z: &Polynomial, t: f64) {
        let unit = (ROUNDINGS + 2.0 * z.degree() as f64) * f64::EPSILON;
        for k in 0..=z.degree() {
            let c = z.coefficient(k);
            let (size, error) = (c.value.abs() + c.error, c.error + unit * c.value.abs());
            let n = k as f64;
            // The angle ωt is rounded as well, t itself among it.
            let turned = 2.0 * f64::EPSILON * t * size;
            self.error[k] += error;
            self.error[k + 1] += turned;
            self.slope_error[k] += t * error + n * turned;
            self.slope_error[k + 1] += t * turned;
            self.bend[k] += t * t * size;
            if k > 0 {
                self.slope_error[k - 1] += n * error;
                self.bend[k - 1] += 2.0 * n * t * size;
            }
            if k > 1 {
                self.bend[k - 2] += n * (n - 1.0) * size;
            }
        }
    }
}

impl Wave for Sum {
    #[inline]
    fn at(&self, omega: f64) -> [Bounded; 2] {
        let x = omega * omega;
        let (mut value, mut slope) = (0.0, 0.0);
        for waves in &self.waves[..self.count] {
            let [c, s, u, v] = waves.at(x);
            let (sin, cos) = waves.sincos(omega);
            match self.part {
                Part::Real => {
                    value += c * cos + omega * s * sin;
                    slope += omega * u * cos + v * sin;
                }
                Part::Imaginary => {
                    value += omega * s * cos - c * sin;
                    slope += v * cos - omega * u * sin;
                }
            }
        }
        [
            (value, horner(&self.error[..=self.length], omega)),
            (slope, horner(&self.slope_error[..=self.length], omega)),
        ]
    }

    #[inline]
    fn value(&self, omega: f64) -> Bounded {
        self.at(omega)[0]
    }

    /// Without damping a double zero at ω = 0 is lost in rounding up to 1e-14.
    fn finest(&self) -> f64 {
        8.0
    }

    #[inline]
    fn bend(&self, omega: f64) -> f64 {
        horner(&self.bend[..self.length], omega)
    }
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;

    const ONE: Rounded = Rounded {
        value: 1.0,
        error: 0.0,
    };

    /// Values against (1) itself, slopes and bounds on the bend against difference quotients.
    #[test]
    fn sums_are_what_they_say() {
        let polynomial = |c: &[f64]| Polynomial::new(c).unwrap();
        let parts = [
            (polynomial(&[1.5, -0.7, 0.3, 2.0]), 0.9),
            (polynomial(&[-0.2, 0.4, 0.0, -1.0, 0.6]), -1.7),
            (polynomial(&[0.5, 0.1, -0.8]), 0.0),
            (polynomial(&[0.3]), 1.7),
        ];
        for part in [Part::Real, Part::Imaginary] {
            let mut terms = Terms::new(part);
            for (z, t) in &parts {
                terms = terms.plus(z, ONE, *t);
            }
            let exact = |omega: f64| {
                let at = Complex64::new(0.0, omega);
                let of = |(z, t): &(Polynomial, f64)| z.value(at) * (-*t * at).exp();
                let sum: Complex64 = parts.iter().map(of).sum();
                match part {
                    Part::Real => sum.re,
                    Part::Imaginary => sum.im,
                }
            };
            let sum = terms.sum();
            for i in 0..200 {
                let omega = 0.03 * f64::from(i);
                let [(value, error), (slope, _)] = sum.at(omega);
                assert!((value - exact(omega)).abs() <= error, "{omega}");
                let h = 1e-5;
                let numeric = (exact(omega + h) - exact(omega - h)) / (2.0 * h);
                assert!(
                    (slope - numeric).abs() < 1e-6 * (1.0 + slope.abs()),
                    "{omega}"
                );
                let bend = (exact(omega + h) - 2.0 * exact(omega) + exact(omega - h)) / (h * h);
                assert!(bend.abs() <= sum.bend(omega + h) + 1e-4, "{omega}");
                let most = horner(terms.sizes().coefficients(), omega);
                assert!(value.abs() <= most * (1.0 + 1e-12), "{omega}");
            }
        }
    }
}
