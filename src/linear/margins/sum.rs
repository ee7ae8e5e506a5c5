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

use crate::linear::feedback_loop::{polynomial, times};
use crate::linear::general::{Polynomial, product};
use crate::linear::real_zeros::{At, RealFunction};
use crate::linear::rounded::Rounded;
use crate::model::elementary::{exp, sincos};

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

/// A term of a function (1).
#[derive(Debug, Clone, Copy)]
struct Term {
    /// Z, the constant first.
    z: [Rounded; LENGTH],
    degree: usize,
    t: f64,
}

/// The terms of a function (1).
#[derive(Debug)]
pub(super) struct Terms {
    part: Part,
    list: [Term; MOST_TERMS],
    count: usize,
}

impl Terms {
    pub(super) fn new(part: Part) -> Self {
        let none = Term {
            z: [exactly(0.0); LENGTH],
            degree: 0,
            t: 0.0,
        };
        Self {
            part,
            list: [none; MOST_TERMS],
            count: 0,
        }
    }

    /// Adds `weight` · Z e^(−iωt), t of either sign; at most five sizes of t.
    pub(super) fn add(&mut self, z: &Polynomial, weight: Rounded, t: f64) {
        if weight.value == 0.0 && weight.error == 0.0 {
            return;
        }
        let term = self.with(t.abs());
        let imaginary = self.part == Part::Imaginary;
        let Term { z: sum, degree, .. } = &mut self.list[term];
        *degree = z.degree().max(*degree);
        for (k, sum) in sum[..=z.degree()].iter_mut().enumerate() {
            let mut c = product(z.coefficient(k), weight);
            // Z e^(iω|t|) is the conjugate of Z* e^(−iω|t|).
            if t < 0.0 && (k % 2 == 1) != imaginary {
                c.value = -c.value;
            }
            *sum = plus(*sum, c);
        }
    }

    /// The number of the term that turns with `t` ≥ 0.
    fn with(&mut self, t: f64) -> usize {
        let known = self.list[..self.count].iter().position(|term| term.t == t);
        known.unwrap_or_else(|| {
            self.list[self.count].t = t;
            self.count += 1;
            self.count - 1
        })
    }

    fn all(&self) -> &[Term] {
        &self.list[..self.count]
    }

    /// Σ (|c_k| + e_k) of all terms, for every power of ω: |f| is at most that polynomial.
    pub(super) fn sizes(&self) -> Polynomial {
        let degree = self.all().iter().map(|term| term.degree).max();
        let size = |k: usize| {
            let of = self.all().iter().map(|term| term.z[k]);
            of.map(|c| c.value.abs() + c.error).sum()
        };
        let sizes: [f64; LENGTH] = std::array::from_fn(size);
        polynomial(&sizes[..=degree.unwrap_or(0)])
    }

    /// The function of ω whose zeros are searched for.
    pub(super) fn sum(&self) -> Sum {
        let mut sum = Sum {
            part: self.part,
            waves: [Waves::NONE; MOST_TERMS],
            count: self.count,
            errors: [[0.0; 2]; LENGTH + 1],
            bend: [0.0; LENGTH],
            length: 0,
        };
        for (term, waves) in self.all().iter().zip(&mut sum.waves) {
            sum.length = sum.length.max(term.degree + 1);
            *waves = Waves::of(term);
        }
        for term in self.all() {
            sum.bound(term);
        }
        sum
    }
}

/// The sum with its error; exact where one of both is 0.
fn plus(a: Rounded, b: Rounded) -> Rounded {
    let value = a.value + b.value;
    let exact = a.value == 0.0 || b.value == 0.0;
    let rounding = if exact { 0.0 } else { 0.5 * f64::EPSILON };
    Rounded {
        value,
        error: a.error + b.error + rounding * value.abs(),
    }
}

/// A number that is known.
pub(super) const fn exactly(value: f64) -> Rounded {
    Rounded { value, error: 0.0 }
}

/// 1 and a number.
pub(super) fn one_and(number: Rounded) -> Rounded {
    plus(exactly(1.0), number)
}

/// e^x, x being a rounded product.
pub(super) fn growth(x: f64) -> Rounded {
    let value = exp(x);
    Rounded {
        value,
        error: if x == 0.0 {
            0.0
        } else {
            f64::EPSILON * value * (2.0 + 2.0 * x.abs())
        },
    }
}

/// The product of `one` and the conjugate of `other`, polynomials in λ, on the line Re λ = `line`
/// as a polynomial in iω.
pub(super) fn on_line(line: f64, one: &Polynomial, other: &Polynomial) -> Polynomial {
    times(&one.shifted(line), &conjugate(&other.shifted(line)))
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

    fn of(term: &Term) -> Self {
        let t = term.t;
        let mut waves = Self {
            t,
            length: term.degree / 2 + 1,
            ..Self::NONE
        };
        // i² = −1.
        let signed = |k: usize| match k {
            k if k > term.degree => 0.0,
            k if (k / 2) % 2 == 1 => -term.z[k].value,
            k => term.z[k].value,
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
    /// Bounds on the errors of f and f′.
    errors: [[f64; 2]; LENGTH + 1],
    bend: [f64; LENGTH],
    /// Coefficients of the last bound; the others have one more.
    length: usize,
}

#[inline]
fn horner(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

impl Sum {
    /// Adds what a term adds to the bounds.
    fn bound(&mut self, term: &Term) {
        let Term { z, degree, t } = term;
        let unit = (ROUNDINGS + 2.0 * *degree as f64) * f64::EPSILON;
        for (k, c) in z[..=*degree].iter().enumerate() {
            let (size, error) = (c.value.abs() + c.error, c.error + unit * c.value.abs());
            let n = k as f64;
            // The angle ωt is rounded as well, t itself among it.
            let turned = 2.0 * f64::EPSILON * t * size;
            self.errors[k][0] += error;
            self.errors[k + 1][0] += turned;
            self.errors[k][1] += t * error + n * turned;
            self.errors[k + 1][1] += t * turned;
            self.bend[k] += t * t * size;
            if k > 0 {
                self.errors[k - 1][1] += n * error;
                self.bend[k - 1] += 2.0 * n * t * size;
            }
            if k > 1 {
                self.bend[k - 2] += n * (n - 1.0) * size;
            }
        }
    }
}

impl RealFunction for Sum {
    #[inline]
    fn at(&self, omega: f64) -> At {
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
        let mut errors = [0.0; 2];
        for of in self.errors[..=self.length].iter().rev() {
            for (sum, c) in errors.iter_mut().zip(of) {
                *sum = *sum * omega + c;
            }
        }
        let [value, slope] =
            [(value, errors[0]), (slope, errors[1])].map(|(value, error)| Rounded { value, error });
        At {
            omega,
            value,
            slope,
        }
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
                terms.add(z, exactly(1.0), *t);
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
                let at = sum.at(omega);
                let (Rounded { value, error }, slope) = (at.value, at.slope.value);
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
