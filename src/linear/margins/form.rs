//! Quadratic forms of the two sides of a loop, as functions of ω on the line λ = σ + iω.
//!
//! ```text
//! f(ω) = a |U|² + b |V|² + c Re[V U*] + d Im[V U*]                                          (1)
//! U, V = Z e^(−λt)(1 − r E),   E = e^(−λτ)                                                  (2)
//! ```
//!
//! f is computed from the values of U and V, so nothing is lost in coefficients of products, and
//! the degrees may be any. Bounds on |f″| are made of polynomials in ω with absolute coefficients.

use num_complex::Complex64;

use super::sum::Part;
use crate::linear::characteristic::one_minus_exp;
use crate::linear::general::{LoopSide, Polynomial};
use crate::linear::real_zeros::{At, RealFunction};
use crate::linear::rounded::Rounded;
use crate::model::elementary::{exp, norm, sincos};

/// Rounded operations behind a side, in units of ε of its terms.
const ROUNDINGS: f64 = 24.0;

/// A side (2) of a loop on one line.
#[derive(Debug, Clone, Copy)]
struct Side {
    /// Z, Z′ and Z″ in λ − σ, times e^(−σt).
    jet: [Polynomial; 3],
    /// t, τ, and r e^(−στ).
    late: f64,
    tau: f64,
    memory: f64,
}

/// A side and its derivative by ω, each with a bound on its error.
#[derive(Debug, Clone, Copy)]
struct SideAt {
    value: Complex64,
    slope: Complex64,
    errors: [f64; 2],
}

impl Side {
    fn new(of: &LoopSide, tau: f64, line: f64) -> Self {
        let by = exp(-line * of.late);
        let scaled = Polynomial::ZERO.plus(&of.polynomial.shifted(line), by);
        let first = scaled.derivative();
        Self {
            jet: [scaled, first, first.derivative()],
            late: of.late,
            tau,
            memory: of.memory * exp(-line * tau),
        }
    }

    /// e^(−iωt)(1 − r E) and its derivative by ω.
    fn delayed(&self, omega: f64) -> [Complex64; 2] {
        let turned = |t: f64| match t {
            0.0 => Complex64::ONE,
            t => {
                let (sin, cos) = sincos(-t * omega);
                Complex64::new(cos, sin)
            }
        };
        let late = turned(self.late);
        let slope = |t: f64| Complex64::new(0.0, -t);
        if self.memory == 0.0 {
            return [late, slope(self.late) * late];
        }
        let lost = one_minus_exp(Complex64::new(0.0, -self.tau * omega));
        let kept = 1.0 - self.memory + self.memory * lost;
        let turn = -self.memory * slope(self.tau) * (1.0 - lost);
        [late * kept, late * (turn + slope(self.late) * kept)]
    }

    /// Bounds on e^(−iωt)(1 − r E) and its first two derivatives by ω up to `omega`, on the
    /// imaginary axis of λ − σ.
    fn delayed_bounds(&self, omega: f64) -> [f64; 3] {
        let (t, size) = (self.late, self.memory.abs());
        let kept = (1.0 - self.memory).abs() + size * (self.tau * omega).min(2.0);
        let [turn, bend] = [size * self.tau, size * self.tau * self.tau];
        [kept, t * kept + turn, t * t * kept + 2.0 * t * turn + bend]
    }

    /// Bounds on Z and its first two derivatives up to `omega`.
    fn polynomial_bounds(&self, omega: f64) -> [(f64, f64); 3] {
        self.jet.map(|of| of.bounds(omega))
    }

    fn at(&self, omega: f64) -> SideAt {
        let lambda = Complex64::new(0.0, omega);
        let [z, first] = [&self.jet[0], &self.jet[1]].map(|of| of.value(lambda));
        let [by, turn] = self.delayed(omega);
        let [(z_size, z_error), (first_size, first_error), _] = self.polynomial_bounds(omega);
        let [by_size, turn_size, _] = self.delayed_bounds(omega);
        let degree = self.jet[0].degree() as f64;
        // The angles ωt and ωτ are rounded as well.
        let angles = (self.late + self.memory.abs() * self.tau) * omega;
        let unit = f64::EPSILON * (ROUNDINGS + 2.0 * degree + 2.0 * angles);
        SideAt {
            value: z * by,
            slope: Complex64::I * first * by + z * turn,
            errors: [
                by_size * (z_error + unit * z_size),
                by_size * (first_error + unit * first_size) + turn_size * (z_error + unit * z_size),
            ],
        }
    }

    /// Bounds on this side and its first two derivatives by ω up to `omega`.
    fn bounds(&self, omega: f64) -> [f64; 3] {
        let [z, first, second] = self
            .polynomial_bounds(omega)
            .map(|(size, error)| size + error);
        let [by, turn, bend] = self.delayed_bounds(omega);
        [
            z * by,
            first * by + z * turn,
            second * by + 2.0 * first * turn + z * bend,
        ]
    }
}

/// U and V of a loop on one line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sides {
    own: Side,
    fed: Side,
}

impl Sides {
    pub(super) fn new([own, fed]: &[LoopSide; 2], tau: f64, line: f64) -> Self {
        Self {
            own: Side::new(own, tau, line),
            fed: Side::new(fed, tau, line),
        }
    }

    /// U and V at `omega`.
    pub(super) fn at(&self, omega: f64) -> [Complex64; 2] {
        [&self.own, &self.fed].map(|side| side.at(omega).value)
    }

    /// Re[V U*] or Im[V U*].
    pub(super) fn both(&self, part: Part) -> Form {
        Form {
            sides: *self,
            squares: [0.0; 2],
            both: match part {
                Part::Real => [1.0, 0.0],
                Part::Imaginary => [0.0, 1.0],
            },
        }
    }

    /// |U + V|² − `level`² |U|².
    pub(super) fn above(&self, level: f64) -> Form {
        Form {
            sides: *self,
            // Without cancellation where the level is near 1.
            squares: [(1.0 - level) * (1.0 + level), 1.0],
            both: [2.0, 0.0],
        }
    }
}

/// A form (1).
#[derive(Debug, Clone, Copy)]
pub struct Form {
    sides: Sides,
    /// a and b.
    squares: [f64; 2],
    /// c and d.
    both: [f64; 2],
}

impl RealFunction for Form {
    fn at(&self, omega: f64) -> At {
        let [u, v] = [&self.sides.own, &self.sides.fed].map(|side| side.at(omega));
        let [a, b] = self.squares;
        let [c, d] = self.both;
        let square = |of: &SideAt| {
            let (size, slope) = (norm(of.value), norm(of.slope));
            let [e, e_slope] = of.errors;
            (
                [size * size, 2.0 * (of.value.conj() * of.slope).re],
                [
                    (2.0 * size + e) * e,
                    2.0 * (size * e_slope + slope * e + e * e_slope),
                ],
                [size * size, 2.0 * size * slope],
            )
        };
        let both = v.value * u.value.conj();
        let both_slope = v.slope * u.value.conj() + v.value * u.slope.conj();
        let sizes = [&u, &v].map(|of| [norm(of.value), norm(of.slope)]);
        let [[u_size, u_slope], [v_size, v_slope]] = sizes;
        let [[u_off, u_slope_off], [v_off, v_slope_off]] = [u.errors, v.errors];
        let both_errors = [
            u_size * v_off + v_size * u_off + u_off * v_off,
            u_size * v_slope_off
                + v_slope * u_off
                + v_size * u_slope_off
                + u_slope * v_off
                + u_off * v_slope_off
                + v_off * u_slope_off,
        ];
        let both_sizes = [u_size * v_size, v_slope * u_size + v_size * u_slope];
        let (own, own_errors, own_sizes) = square(&u);
        let (fed, fed_errors, fed_sizes) = square(&v);
        let mixed = [
            c * both.re + d * both.im,
            c * both_slope.re + d * both_slope.im,
        ];
        let part = c.abs() + d.abs();
        let number = |i: usize| {
            let size = a.abs() * own_sizes[i] + b.abs() * fed_sizes[i] + part * both_sizes[i];
            let error = a.abs() * own_errors[i] + b.abs() * fed_errors[i] + part * both_errors[i];
            Rounded {
                value: a * own[i] + b * fed[i] + mixed[i],
                error: error + 8.0 * f64::EPSILON * size,
            }
        };
        At {
            omega,
            value: number(0),
            slope: number(1),
        }
    }

    fn bend(&self, omega: f64) -> f64 {
        let u = self.sides.own.bounds(omega);
        let v = self.sides.fed.bounds(omega);
        let square = |of: [f64; 3]| 2.0 * (of[1] * of[1] + of[0] * of[2]);
        let both = u[0] * v[2] + 2.0 * u[1] * v[1] + u[2] * v[0];
        let [a, b] = self.squares.map(f64::abs);
        let [c, d] = self.both.map(f64::abs);
        a * square(u) + b * square(v) + (c + d) * both
    }
}
