//! P and Q of a system with one delayed signal, where their coefficients keep all digits.
//!
//! With one signal det M of the module is P(λ) + Q(λ) z:
//!
//! ```text
//! P = det(λ − A) = Σ p_k λᵏ,   Q = −(D P + C adj(λ − A) B),   adj(λ − A) = Σ M_k λ^(n−k)     (1)
//! M_1 = 1,   p_{n−k} = −tr(A M_k)/k,   M_{k+1} = A M_k + p_{n−k}                               (2)
//! ```
//!
//! (2) is the method of Faddeev and Leverrier. It cancels, so it has twice the digits here, with
//! a bound on the error of every number, none where nothing was rounded. What vanishes by the
//! zeros of A, B and C alone is exactly 0.

use super::MatrixSystem;
use super::dense::Matrix;
use super::pattern::powers;
use crate::linear::crossing::Crossing;
use crate::linear::double::{Double, UNIT};
use crate::linear::general::{Class, DelayLine, MOST_DEGREE, Polynomial, System, enough};
use crate::linear::rounded::Rounded;

/// A coefficient is known where its error is below this part of it: a few of its last digits.
const KNOWN: f64 = 4.0 * f64::EPSILON;
/// A coefficient smaller than this part of what it is a sum of may be 0 but for the rounding of
/// the numbers of the system.
const CANCELLED: f64 = 64.0 * f64::EPSILON;
/// Products from here on lose no digit to underflow.
const LEAST: f64 = 1e-250;

/// A number of twice the digits with a bound on its error.
#[derive(Debug, Clone, Copy)]
struct Known {
    value: Double,
    error: f64,
}

impl Known {
    const ZERO: Self = Self {
        value: Double::ZERO,
        error: 0.0,
    };

    fn is_zero(self) -> bool {
        self.value == Double::ZERO && self.error == 0.0
    }

    fn plus(self, other: Self) -> Self {
        if other.is_zero() {
            return self;
        }
        if self.is_zero() {
            return other;
        }
        let error = self.error + other.error;
        if self.value.low == 0.0 && other.value.low == 0.0 {
            let value = Double::sum(self.value.high, other.value.high);
            return Self { value, error };
        }
        let value = self.value.plus(other.value);
        Self {
            value,
            error: error + UNIT * value.high.abs(),
        }
    }

    /// The product with an exact number.
    fn by(self, factor: f64) -> Self {
        if factor == 0.0 || self.is_zero() {
            return Self::ZERO;
        }
        let error = self.error * factor.abs();
        let value = self.value.times(factor.into());
        let exact = self.value.low == 0.0 && value.high.abs() >= LEAST;
        Self {
            value,
            error: if exact {
                error
            } else {
                error + UNIT * value.high.abs()
            },
        }
    }

    /// The quotient by a small whole number.
    fn over(self, divisor: f64) -> Self {
        let value = self.value.over(divisor);
        let left = self.value.minus(value.times(divisor.into()));
        let exact = value.low == 0.0 && left == Double::ZERO;
        let error = self.error / divisor;
        Self {
            value,
            error: if exact {
                error
            } else {
                error + UNIT * value.high.abs()
            },
        }
    }

    /// This number, times a power of two, as one of the usual digits; none where too few of them
    /// are known, where it overflows or all but vanishes, and where it is what is left of numbers
    /// of the size `of`.
    fn rounded(self, of: f64, unit: f64) -> Option<Rounded> {
        if self.is_zero() {
            return Some(Rounded {
                value: 0.0,
                error: 0.0,
            });
        }
        let value = self.value.value();
        let left = self.value.plus_number(-value).value();
        let error = 2.0 * self.error + left.abs();
        let (scaled, least) = (value * unit, f64::MIN_POSITIVE / f64::EPSILON);
        let within = scaled.is_finite() && scaled.abs() >= least;
        let known = error <= KNOWN * value.abs() && value.abs() >= CANCELLED * of;
        (within && known).then_some(Rounded {
            value: scaled,
            error: error * unit,
        })
    }
}

const ONE: Known = Known {
    value: Double {
        high: 1.0,
        low: 0.0,
    },
    error: 0.0,
};

/// Σ_j `row`_j `column`_j.
fn sum(terms: impl Iterator<Item = (f64, Known)>) -> Known {
    let products = terms.filter(|(factor, _)| *factor != 0.0);
    products.fold(Known::ZERO, |sum, (factor, of)| sum.plus(of.by(factor)))
}

/// A by what is not 0 in each of its rows.
struct Sparse(Vec<Vec<(usize, f64)>>);

impl Sparse {
    fn of(a: &Matrix) -> Self {
        let row = |i: usize| {
            let all = (0..a.columns()).map(move |j| (j, a.at(i, j)));
            all.filter(|(_, entry)| *entry != 0.0).collect()
        };
        Self((0..a.rows()).map(row).collect())
    }

    /// The sum of the sizes of what the trace of A times the square matrix `of` is a sum of.
    fn size_of_trace(&self, of: &[Known], n: usize) -> f64 {
        let rows = self.0.iter().enumerate();
        let row = |(i, row): (usize, &Vec<(usize, f64)>)| -> f64 {
            let sizes = row
                .iter()
                .map(|&(k, entry)| (entry * of[k * n + i].value.high).abs());
            sizes.sum()
        };
        rows.map(row).sum()
    }

    /// A times the square matrix `of`, both of `n` rows.
    fn times(&self, of: &[Known], n: usize, product: &mut [Known]) {
        for (i, row) in self.0.iter().enumerate() {
            for j in 0..n {
                product[i * n + j] = sum(row.iter().map(|&(k, entry)| (entry, of[k * n + j])));
            }
        }
    }
}

/// The coefficients of a polynomial, from the constant on, each with the size of what it is a sum
/// of.
struct Coefficients {
    values: Vec<Known>,
    sizes: Vec<f64>,
}

impl Coefficients {
    fn zeros(degree: usize) -> Self {
        Self {
            values: vec![Known::ZERO; degree + 1],
            sizes: vec![0.0; degree + 1],
        }
    }

    /// Sets to 0 what is not known and has none of the powers that there can be.
    fn keep(&mut self, powers: impl FnOnce() -> Option<[usize; 2]>) {
        let mut all = self.values.iter().zip(&self.sizes);
        if all.all(|(of, size)| of.rounded(*size, 1.0).is_some()) {
            return;
        }
        let [least, largest] = powers().unwrap_or([usize::MAX, 0]);
        for (k, of) in self.values.iter_mut().enumerate() {
            if !(least..=largest).contains(&k) {
                *of = Known::ZERO;
            }
        }
    }

    /// The polynomial in λ where these are of λ in units of 1/`unit`; none where one is not known.
    fn rounded(&self, unit: f64) -> Option<Polynomial> {
        let degree = self.values.len() - 1;
        let mut all = Vec::with_capacity(degree + 1);
        // p(λ u) uⁿ⁻ᵏ of the system in its unit u.
        let mut power = 1.0;
        for (of, size) in self.values.iter().zip(&self.sizes).rev() {
            all.push(of.rounded(*size, power)?);
            power /= unit;
        }
        Some(Polynomial::of(degree, |k| all[degree - k]))
    }
}

impl MatrixSystem {
    /// P + Q e^(−λτ), where there is one delayed signal at most and every coefficient is known to
    /// within a few of its last digits; none elsewhere.
    #[must_use]
    pub fn expanded(&self) -> Option<System> {
        if self.signals() > 1 || self.states() > MOST_DEGREE {
            return None;
        }
        let unit = self.time_unit();
        let [p, q] = self.clone().in_unit(unit).coefficients();
        Some(System::direct(p.rounded(unit)?, q.rounded(unit)?))
    }

    /// [`MatrixSystem::expanded`], where its coefficients leave nothing open of the line of
    /// delays; those of lightly damped chains of many masses do.
    #[must_use]
    pub(in crate::linear) fn as_polynomials(&self) -> Option<System> {
        self.expanded().filter(is_decided)
    }

    /// The coefficients of P and of Q by (1).
    fn coefficients(&self) -> [Coefficients; 2] {
        let n = self.states();
        let a = Sparse::of(&self.a);
        let [mut p, mut q] = [0, 1].map(|_| Coefficients::zeros(n));
        p.values[n] = ONE;
        (p.sizes[n], q.sizes[n]) = (1.0, 0.0);
        let (mut m, mut product) = (vec![Known::ZERO; n * n], vec![Known::ZERO; n * n]);
        for i in 0..n {
            m[i * n + i] = ONE;
        }
        for k in 1..=n {
            (q.values[n - k], q.sizes[n - k]) = self.fed(&m);
            a.times(&m, n, &mut product);
            let trace = (0..n).fold(Known::ZERO, |sum, i| sum.plus(product[i * n + i]));
            p.values[n - k] = trace.by(-1.0).over(k as f64);
            p.sizes[n - k] = a.size_of_trace(&m, n) / k as f64;
            std::mem::swap(&mut m, &mut product);
            for i in 0..n {
                m[i * n + i] = m[i * n + i].plus(p.values[n - k]);
            }
        }
        let is_number = |i: usize, j: usize| (self.a.at(i, j) != 0.0, i == j);
        p.keep(|| powers(n, is_number));
        q.keep(|| {
            powers(n + 1, |i, j| match (i < n, j < n) {
                (true, true) => is_number(i, j),
                (true, false) => (self.signals() > 0 && self.b.at(i, 0) != 0.0, false),
                (false, true) => (self.signals() > 0 && self.c.at(0, j) != 0.0, false),
                (false, false) => (false, false),
            })
        });
        let through = if self.signals() > 0 {
            self.d.at(0, 0)
        } else {
            0.0
        };
        for k in 0..=n {
            q.values[k] = q.values[k].plus(p.values[k].by(through)).by(-1.0);
            q.sizes[k] += through.abs() * p.sizes[k];
        }
        [p, q]
    }

    /// C M B, and the size of what it is a sum of.
    fn fed(&self, m: &[Known]) -> (Known, f64) {
        let n = self.states();
        let (mut value, mut size) = (Known::ZERO, 0.0);
        if self.signals() == 0 {
            return (value, size);
        }
        for i in (0..n).filter(|&i| self.c.at(0, i) != 0.0) {
            let (of, row) = (self.c.at(0, i), &m[i * n..][..n]);
            let inputs = || (0..n).map(|j| self.b.at(j, 0));
            value = value.plus(sum(inputs().zip(row.iter().copied())).by(of));
            let sizes = inputs().zip(row).map(|(b, m)| (b * m.value.high).abs());
            size += of.abs() * sizes.sum::<f64>();
        }
        (value, size)
    }
}

/// Whether nothing about the line of `system` is left open by its coefficients.
fn is_decided(system: &System) -> bool {
    match system.class() {
        Class::Retarded | Class::Neutral { .. } => {}
        Class::Infinite => return true,
        Class::NeutralLimit | Class::DegreeUnknown | Class::Refused => return false,
    }
    let line = DelayLine::of(system);
    let on_axis = line.always_marginal || line.marginal_at_zero || line.reason.is_some();
    let all_delays = line.open_from == f64::INFINITY && !line.uncounted;
    let degree = system.polynomials().map(Polynomial::degree);
    let allowed = enough(degree[0].max(degree[1]));
    let sharp = |of: &Crossing| of.delay_error(of.period()) <= allowed * of.period();
    !on_axis && all_delays && line.crossings.iter().all(sharp)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn system(a: &[f64], b: &[f64], c: &[f64]) -> MatrixSystem {
        let n = b.len();
        let a0 = Matrix::new(n, n, a.to_vec());
        let [b, c] = [Matrix::new(n, 1, b.to_vec()), Matrix::new(1, n, c.to_vec())];
        MatrixSystem::of_feedback(&a0, &b, None, &c).unwrap()
    }

    /// A rate that is fed back: Q has the factor λ, which cancels but for the zeros of matrices.
    #[test]
    fn rates_leave_no_constant() {
        let a = [
            0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, -2.1, 1.1, -0.03, 0.01, 1.1, -1.1, 0.01, -0.01,
        ];
        let found = system(&a, &[0.0, 0.0, 0.0, 1.0], &[0.0, 0.0, 0.0, -0.3]).expanded();
        let [_, q] = found.as_ref().expect("it is known").polynomials();
        assert_eq!((q.coefficients()[0], q.errors()[0]), (0.0, 0.0));
        // 0.3 λ (λ² + 0.03 λ + 2.1).
        for (found, expected) in q.coefficients()[1..].iter().zip([0.63, 0.009, 0.3]) {
            assert!((found - expected).abs() < 1e-15, "{q:?}");
        }
    }

    /// (λ² + 0.25 λ + 3)(λ + 2) and −(λ + 2)(5λ − 7), all of it exact in binary.
    #[test]
    fn exact_numbers_have_exact_coefficients() {
        let a = [0.0, 1.0, 0.0, -3.0, -0.25, 0.0, 0.0, 0.0, -2.0];
        let found = system(&a, &[0.0, 1.0, 0.0], &[-7.0, 5.0, 0.0]);
        let found = found.expanded().expect("it is known");
        let [p, q] = found.polynomials();
        assert_eq!(p.coefficients(), [6.0, 3.5, 2.25, 1.0]);
        assert_eq!(q.coefficients(), [14.0, -3.0, -5.0]);
        for of in [p, q] {
            assert!(of.errors().iter().all(|error| *error < 1e-28), "{of:?}");
        }
    }

    /// The determinant of a singular matrix is 0, which rounding does not tell: (0.1, 0.3) and
    /// three times that, rounded.
    #[test]
    fn what_cancels_is_not_taken_for_known() {
        let a = [0.1, 0.3, 0.1 * 3.0, 0.3 * 3.0];
        let found = system(&a, &[1.0, 0.0], &[1.0, 0.0]).expanded();
        let exact = 0.1_f64.mul_add(0.3 * 3.0, -0.3 * (0.1 * 3.0));
        let constant = found.map(|of| of.polynomials()[0].coefficients()[0]);
        assert!(
            constant.is_none_or(|c| (c - exact).abs() <= 1e-16),
            "{constant:?}"
        );
        // A free chain of springs 0.1 and 0.3, of which 0.4 is not quite the sum.
        let springs = [-0.1, 0.1, 0.0, 0.1, -0.4, 0.3, 0.0, 0.3, -0.3];
        let free = system(&springs, &[1.0, 0.0, 0.0], &[0.0, 0.0, 1.0]);
        assert!(free.expanded().is_none());
        // By a row of zeros it is known.
        let known = system(&[0.0, 0.0, 2.0, -4.0], &[0.0, 1.0], &[1.0, 0.0]);
        let known = known.expanded().expect("it is known");
        let [p, _] = known.polynomials();
        assert_eq!(p.coefficients(), [0.0, 4.0, 1.0]);
        assert_eq!(p.errors()[0], 0.0);
    }
}
