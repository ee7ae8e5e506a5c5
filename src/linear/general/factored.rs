//! The zeros of F = |P|² − |κQ|² from the values of P and Q themselves.
//!
//! Lightly damped modes leave |P| and |Q| small beside what their coefficients add up to, and the
//! coefficients of F cancel to the square of that. So F is evaluated as a difference of products,
//!
//! ```text
//! F(x) = p(s) p(−s) − κ² q(s) q(−s),   s² = −x                                               (1)
//! ```
//!
//! for complex x as well, the values of p and q with twice the digits. What the errors of their
//! coefficients, δ, come to is then |p(s)|δ + |p(−s)|δ, and the discs of
//! [`zeros`](super::zeros) become as small as these errors allow.

use num_complex::Complex64;

use super::polynomial::{MOST_DEGREE, Polynomial};
use super::shifted::Shifted;
use super::zeros::Zeros;
use crate::linear::double::{DoubleComplex, UNIT};
use crate::linear::newton::divide;
use crate::linear::rounded::Rounded;
use crate::model::elementary::{norm, sqrt};

/// The most sweeps of Aberth's iteration.
const MOST_SWEEPS: usize = 30;
/// Steps below this part of the size are the last.
const LAST_STEP: f64 = 0.25 * f64::EPSILON;

/// Approximate zeros are kept so far apart, relative: discs about one point tell nothing.
const APART: f64 = 1e-12;

/// F on a line, by (1).
pub(super) struct Factored {
    /// P and Q, or B and A, in units of time in which they are of the order of 1.
    first: Polynomial,
    second: Polynomial,
    unit: f64,
    /// The factors of p(s) p(−s), of p(s) q(−s) + q(s) p(−s), and of q(s) q(−s).
    factors: [Rounded; 3],
}

/// A polynomial at s and at −s.
#[derive(Clone, Copy)]
struct Mirrored {
    value: [Complex64; 2],
    /// The derivatives by s.
    slope: [Complex64; 2],
    /// A bound on the errors of both values.
    error: f64,
}

impl Mirrored {
    fn of(p: &Polynomial, s: Complex64) -> Self {
        let square = DoubleComplex::from(s).times(s.into());
        let (mut even, mut odd) = (DoubleComplex::ZERO, DoubleComplex::ZERO);
        for (k, &c) in p.coefficients().iter().enumerate().rev() {
            let part = if k % 2 == 0 { &mut even } else { &mut odd };
            *part = part.times(square);
            part.re = part.re.plus_number(c);
        }
        let odd = odd.times(s.into());
        let value = [even.plus(odd).value(), even.minus(odd).value()];
        let (size, known) = p.bounds(norm(s));
        let unit = 4.0 * (p.degree() as f64 + 2.0) * UNIT;
        let rounding = f64::EPSILON * value[0].norm_sqr().max(value[1].norm_sqr()).sqrt();
        Self {
            value,
            slope: [p.jet(s)[1], -p.jet(-s)[1]],
            error: known * (1.0 + 1e-12) + unit * size + rounding,
        }
    }
}

/// The product a(s) b(−s), its derivative by s, and a bound on its error.
fn across(a: &Mirrored, b: &Mirrored) -> (Complex64, Complex64, f64) {
    let value = a.value[0] * b.value[1];
    let slope = a.slope[0] * b.value[1] + a.value[0] * b.slope[1];
    let [x, y] = [norm(a.value[0]), norm(b.value[1])];
    let error = x * b.error + y * a.error + a.error * b.error + 4.0 * f64::EPSILON * x * y;
    (value, slope, error)
}

/// F, F′ and a bound on the error of F.
struct Evaluated {
    value: Complex64,
    slope: Complex64,
    error: f64,
}

impl Factored {
    pub(super) fn new(line: &Shifted) -> Self {
        let [first, second] = line.polynomials();
        let unit = first.time_unit();
        let n = line.degree();
        Self {
            first: first.in_unit(unit, n),
            second: second.in_unit(unit, n),
            unit,
            factors: line.factors(),
        }
    }

    /// F at x = −s².
    fn at(&self, s: Complex64) -> Evaluated {
        let p = Mirrored::of(&self.first, s);
        let q = Mirrored::of(&self.second, s);
        let [own, both, other] = self.factors;
        let terms = [
            (own, across(&p, &p)),
            (both, across(&p, &q)),
            (both, across(&q, &p)),
            (other, across(&q, &q)),
        ];
        let mut sum = Evaluated {
            value: Complex64::ZERO,
            slope: Complex64::ZERO,
            error: 0.0,
        };
        for (by, (value, slope, error)) in terms {
            if by.value == 0.0 && by.error == 0.0 {
                continue;
            }
            sum.value += by.value * value;
            sum.slope += by.value * slope;
            let size = norm(value) + error;
            sum.error += by.value.abs() * (error + 4.0 * f64::EPSILON * size) + by.error * size;
        }
        // dF/dx = −(dF/ds)/2s.
        sum.slope = -0.5 * divide(sum.slope, s);
        sum
    }

    /// The zeros of `f`, the polynomial F with the coefficients of its powers of x.
    pub(super) fn zeros(&self, f: &Polynomial) -> Zeros {
        let square = self.unit * self.unit;
        let f = f.in_unit(square, f.degree());
        let mut at = [Complex64::ZERO; MOST_DEGREE];
        let at = &mut at[..f.degree()];
        Zeros::approximate(&f, at);
        self.refine(at);
        let zeros = Zeros::enclosed(at, |at, i| self.radius(&f, at, i));
        zeros.scaled(1.0 / square)
    }

    /// Aberth's iteration with F by (1).
    fn refine(&self, at: &mut [Complex64]) {
        let mut settled = [false; MOST_DEGREE];
        for _ in 0..MOST_SWEEPS {
            let mut moving = false;
            for i in 0..at.len() {
                if settled[i] {
                    continue;
                }
                let z = at[i];
                let f = self.at(sqrt(-z));
                let newton = divide(f.value, f.slope);
                let pull: Complex64 = at
                    .iter()
                    .enumerate()
                    .filter(|(j, other)| *j != i && **other != z)
                    .map(|(_, other)| divide(Complex64::ONE, z - other))
                    .sum();
                let step = divide(newton, 1.0 - newton * pull);
                if !(step.re.is_finite() && step.im.is_finite()) {
                    settled[i] = true;
                    continue;
                }
                let next = z - step;
                settled[i] = norm(f.value) <= 0.25 * f.error || norm(step) <= LAST_STEP * norm(z);
                at[i] = match beside_another(at, i, next) {
                    Some(place) => {
                        settled[i] = true;
                        place
                    }
                    None => next,
                };
                moving = true;
            }
            if !moving {
                return;
            }
        }
    }

    /// The radius of the disc number `i` by (1) of [`zeros`](super::zeros).
    fn radius(&self, f: &Polynomial, at: &[Complex64], i: usize) -> f64 {
        let z = at[i];
        let own = self.at(sqrt(-z));
        let leading = f.leading();
        let above = norm(own.value) + own.error;
        let mut radius = at.len() as f64 * above / (leading.value.abs() - leading.error);
        // The root of −z is rounded, and so is what it is the root of.
        let shift = |z: Complex64| 4.0 * f64::EPSILON * norm(z);
        for (j, other) in at.iter().enumerate() {
            if j != i {
                radius /= (norm(z - other) - shift(z) - shift(*other)).max(0.0);
            }
        }
        let radius = radius * (1.0 + 64.0 * f64::EPSILON) + shift(z);
        if radius.is_nan() {
            f64::INFINITY
        } else {
            radius
        }
    }
}

/// A place for the point number `i` a little beside the other one at which `next` lies, if there is
/// one.
fn beside_another(at: &[Complex64], i: usize, next: Complex64) -> Option<Complex64> {
    let apart = APART * norm(next);
    let near = |(j, other): &(usize, &Complex64)| *j != i && norm(next - **other) < apart;
    let (_, &other) = at.iter().enumerate().find(near)?;
    let from = at[i] - other;
    let size = norm(from);
    let side = if size > 0.0 {
        from / size
    } else {
        Complex64::I
    };
    Some(other + apart * side)
}
