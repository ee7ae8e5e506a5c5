//! Values with twice the digits: of polynomials on the imaginary axis, and of D.

use num_complex::Complex64;

use super::composition::Composition;
use super::parts::FeedbackForm;
use super::polynomial::{At, Polynomial};
use super::system::System;
use crate::linear::double::{Double, DoubleComplex, EXPONENTIAL, UNIT};
use crate::linear::equation::Exact;
use crate::model::elementary::norm;

/// Up to here exponents of D are turned into exponentials with all their digits.
const LARGEST_EXPONENT: f64 = 1000.0;

impl Polynomial {
    /// The value at iω with twice the digits, `omega` being known to within `error`.
    pub(super) fn on_axis_exactly(&self, omega: f64, error: f64) -> At {
        let square = Double::product(omega, omega).negative();
        let (mut even, mut odd) = (Double::ZERO, Double::ZERO);
        for (k, &c) in self.coefficients().iter().enumerate().rev() {
            let part = if k % 2 == 0 { &mut even } else { &mut odd };
            *part = part.times(square).plus_number(c);
        }
        let at = Complex64::new(0.0, omega);
        let value = Complex64::new(even.value(), odd.times(omega.into()).value());
        let (size, known) = self.bounds(omega.abs());
        let unit = 4.0 * (self.degree() as f64 + 2.0) * UNIT;
        let mut bound = known * (1.0 + 1e-12) + unit * size + f64::EPSILON * norm(value);
        if error > 0.0 {
            let (slope, bend) = self.derivative_bounds(omega.abs() + error);
            let rounding = 2.0 * (self.degree() as f64 + 1.0) * f64::EPSILON;
            bound += (norm(self.jet(at)[1]) + rounding * slope) * error;
            bound += 0.5 * bend * error * error;
        }
        At {
            value,
            error: bound,
        }
    }

    /// Bounds on the sizes of the first and second derivative where |s| ≤ `size`.
    fn derivative_bounds(&self, size: f64) -> (f64, f64) {
        let (mut value, mut slope, mut half_bend) = (0.0, 0.0, 0.0);
        for (c, e) in self.coefficients().iter().zip(self.errors()).rev() {
            half_bend = half_bend * size + slope;
            slope = slope * size + value;
            value = value * size + c.abs() + e;
        }
        (slope, 2.0 * half_bend)
    }
}

/// A polynomial, its derivative, and a bound on the error of the value.
struct Jet {
    value: DoubleComplex,
    slope: DoubleComplex,
    error: f64,
}

impl Jet {
    fn at(p: &Polynomial, z: Complex64) -> Self {
        let (mut value, mut slope) = (DoubleComplex::ZERO, DoubleComplex::ZERO);
        for &c in p.coefficients().iter().rev() {
            slope = slope.times(z.into()).plus(value);
            value = value.times(z.into());
            value.re = value.re.plus_number(c);
        }
        let (size, known) = p.bounds(norm(z));
        Self {
            value,
            slope,
            error: known * (1.0 + 1e-12) + 8.0 * (p.degree() as f64 + 2.0) * UNIT * size,
        }
    }

    /// `self` + `factor` · `other`.
    fn plus(&self, other: &Self, factor: f64) -> Self {
        let value = other.value.by(factor);
        let size = norm(self.value.value()) + norm(value.value());
        Self {
            value: self.value.plus(value),
            slope: self.slope.plus(other.slope.by(factor)),
            error: self.error + factor.abs() * other.error + 8.0 * UNIT * size,
        }
    }
}

impl System {
    /// D at λ with twice the digits; none with latency, and where the delay turns D by more than
    /// the exponential is known for.
    pub(super) fn exact(&self, tau: f64, lambda: Complex64) -> Option<Exact> {
        if tau * norm(lambda) >= LARGEST_EXPONENT {
            return None;
        }
        let [p, q] = match &self.composition {
            Composition::Late(_) | Composition::BesideOrigin => return None,
            Composition::Feedback(FeedbackForm {
                open,
                gain,
                channel,
            }) => {
                let (b, a) = (Jet::at(open, lambda), Jet::at(gain, lambda));
                [b.plus(&a, -1.0), a.plus(&b, -channel.memory)]
            }
            Composition::Direct => [Jet::at(&self.p, lambda), Jet::at(&self.q, lambda)],
        };
        let exponent = DoubleComplex {
            re: Double::product(-lambda.re, tau),
            im: Double::product(-lambda.im, tau),
        };
        let late = exponent.exp();
        let echo = q.value.times(late);
        let turned = q.slope.plus(q.value.by(-tau)).times(late);
        let (late, size) = (norm(late.value()), norm(echo.value()));
        Some(Exact {
            value: p.value.plus(echo).value(),
            slope: p.slope.plus(turned).value(),
            rounding: p.error
                + q.error * late
                + (2.0 * EXPONENTIAL * size + 8.0 * UNIT * norm(p.value.value())),
        })
    }
}
