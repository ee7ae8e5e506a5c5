//! Linear systems with one delay that are given as matrices, of any rank.
//!
//! What is fed back after the delay τ are K signals:
//!
//! ```text
//! ẋ = A x + B w(t − τ),   w = C x + D w(t − τ),   z = e^(−λτ)
//! G(λ) = D + C (λ − A)⁻¹ B,   det M(λ, z) = det(λ − A) det(1 − z G(λ)),
//! M(λ, z) = [λ − A, −z B; −C, 1 − z D]                                                       (1)
//! ```
//!
//! ẋ(t) − E₁ ẋ(t − τ) = A₀ x(t) + A₁ x(t − τ) with [E₁ A₁] of rank K is of this kind, and so is
//! Σ p_k(λ) z^k. λ = iω is a root where an eigenvalue μ of G(iω) has the modulus 1, at the delays
//! τ_k = (arg μ + 2πk)/ω. These ω are the imaginary eigenvalues of a real matrix of 2nK rows, that
//! of the closed loop of G(λ) ⊗ 1 and 1 ⊗ G(−λ): it maps a matrix U to G(λ) U G(−λ)ᵀ.
//! Determinants are expanded in powers of λ only where no digit is lost. Elsewhere each frequency
//! is made sharp on det M itself, and what rounding of the numbers of M does to it is carried.
//!
//! - `balance`: units of states, signals and time that keep digits
//! - `dense`: real matrices
//! - `expanded`: P and Q of one delayed signal, where that loses no digits
//! - `line`: all delays: crossings and counts
//! - `on_axis`: where eigenvalues of G on an axis have the modulus 1
//! - `pattern`: which powers of λ a determinant has by its zeros alone
//! - `rightmost`: the rightmost roots, with their number counted
//! - `roots`: what is told of the roots
//! - `singular`: complex matrices that are nearly singular
//! - `start`: the roots without delay
//! - `walk`: the number of roots by the argument of det M, a second method for every count

mod balance;
mod dense;
mod expanded;
mod line;
mod on_axis;
mod pattern;
mod rightmost;
mod roots;
mod singular;
mod start;
mod walk;

use num_complex::Complex64;

pub use dense::Matrix;
pub use roots::MatrixRoots;
use singular::Square;

use crate::model::elementary::exp;

/// The most rows of a system.
pub const MOST_ROWS: usize = 32;
/// The most rows of the matrix of which the crossing frequencies are eigenvalues.
const MOST_OF_BOTH: usize = 512;

/// How far beside a point at which M is singular twice over its slopes are taken, relative.
const BESIDE: f64 = 1e-10;

/// Why matrices make no system.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MatrixError {
    /// Sizes that do not go together.
    #[error("{what} has {rows} rows and {columns} columns, and needs {wanted}")]
    Size {
        /// The name of the matrix.
        what: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// What it needs.
        wanted: String,
    },
    /// Too many rows.
    #[error("{rows} rows: at most {MOST_ROWS} are allowed")]
    TooLarge {
        /// How many there are.
        rows: usize,
    },
    /// Too many rows times signals.
    #[error(
        "{rows} rows with {signals} delayed signals: their product may be {} at most",
        MOST_OF_BOTH / 2
    )]
    TooManySignals {
        /// n.
        rows: usize,
        /// K.
        signals: usize,
    },
    /// A number that is not finite.
    #[error("a number of {what} is not finite")]
    NotFinite {
        /// The name of the matrix.
        what: &'static str,
    },
    /// Powers that make no system.
    #[error("{0}")]
    Powers(&'static str),
}

/// A system in the form (1) of the module.
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixSystem {
    a: Matrix,
    b: Matrix,
    c: Matrix,
    d: Matrix,
}

impl MatrixSystem {
    /// ẋ(t) − E₁ ẋ(t − τ) = A₀ x(t) + A₁ x(t − τ), E₁ = 0 where it is not given.
    ///
    /// ```
    /// use slipmap::linear::line::{Linear};
    /// use slipmap::linear::matrix::{Matrix, MatrixSystem};
    /// use slipmap::model::stop::Stop;
    ///
    /// // ẋ = −x(t − τ) is stable for τ < π/2.
    /// let one = |value| Matrix::new(1, 1, vec![value]);
    /// let system = MatrixSystem::of_matrices(&one(0.0), &one(-1.0), None)?;
    /// let line = Linear::Matrix(Box::new(system)).roots(&Stop::default()).line(1.0);
    /// let stable = line.stable_intervals().next().unwrap();
    /// assert!((stable.to - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
    /// # Ok::<(), slipmap::linear::matrix::MatrixError>(())
    /// ```
    ///
    /// # Errors
    /// When they are not square, of one size and finite, or too large.
    pub fn of_matrices(a0: &Matrix, a1: &Matrix, e1: Option<&Matrix>) -> Result<Self, MatrixError> {
        let n = a0.rows();
        let square = format!("{n} of each");
        sized("A0", a0, [n, n], &square)?;
        sized("A1", a1, [n, n], &square)?;
        let none = Matrix::zeros(n, n);
        let e1 = e1.unwrap_or(&none);
        sized("E1", e1, [n, n], &square)?;
        let both = Matrix::of(
            n,
            2 * n,
            |i, j| {
                if j < n { e1.at(i, j) } else { a1.at(i, j - n) }
            },
        );
        let (b, rows) = both.factors();
        let k = rows.rows();
        let e = Matrix::of(k, n, |i, j| rows.at(i, j));
        let a = Matrix::of(k, n, |i, j| rows.at(i, j + n));
        Self::checked(a0.clone(), a.plus(&e.times(a0), 1.0), e.times(&b), b)
    }

    /// ẋ(t) = A₀ x(t) + B K C x(t − τ), K = 1 where it is not given.
    ///
    /// # Errors
    /// When sizes do not fit, numbers are not finite, or there are too many.
    pub fn of_feedback(
        a0: &Matrix,
        b: &Matrix,
        k: Option<&Matrix>,
        c: &Matrix,
    ) -> Result<Self, MatrixError> {
        let n = a0.rows();
        sized("A0", a0, [n, n], &format!("{n} of each"))?;
        let inputs = b.columns();
        sized("B", b, [n, inputs], &format!("{n} rows"))?;
        let outputs = k.map_or(inputs, Matrix::columns);
        if let Some(k) = k {
            sized("K", k, [inputs, outputs], &format!("{inputs} rows"))?;
        }
        let wanted = format!("{outputs} rows and {n} columns");
        sized("C", c, [outputs, n], &wanted)?;
        let c = k.map_or_else(|| c.clone(), |k| k.times(c));
        // Fewer signals where the product has a lower rank than its factors have columns.
        let (u, v) = b.times(&c).factors();
        if v.rows() < inputs {
            let none = Matrix::zeros(v.rows(), v.rows());
            return Self::checked(a0.clone(), v, none, u);
        }
        Self::checked(a0.clone(), c, Matrix::zeros(inputs, inputs), b.clone())
    }

    /// Σ p_k(λ) e^(−kλτ), the coefficients of each p_k from the constant on; p₀ has the highest
    /// degree, or one of the highest.
    ///
    /// # Errors
    /// When p₀ vanishes or has a lower degree than another, and as for the other forms.
    pub fn of_powers(powers: &[Vec<f64>]) -> Result<Self, MatrixError> {
        let Self { a, b, c, d } = Self::observer(powers)?;
        Self::checked(a, c, d, b)
    }

    /// [`MatrixSystem::of_powers`] in the units of the polynomials: the first signal is y, of which
    /// D y = 0, and the last state what is not delayed of it.
    pub(in crate::linear) fn observer(powers: &[Vec<f64>]) -> Result<Self, MatrixError> {
        let degree = |p: &Vec<f64>| p.iter().rposition(|c| *c != 0.0);
        let Some((p0, rest)) = powers.split_first() else {
            return Err(MatrixError::Powers("no polynomials are given"));
        };
        let n = degree(p0).ok_or(MatrixError::Powers("the first polynomial vanishes"))?;
        if rest.iter().any(|p| degree(p) > Some(n)) {
            let lower = "the first polynomial has a lower degree than another: infinitely many \
                         roots are unstable";
            return Err(MatrixError::Powers(lower));
        }
        let k = rest.iter().rposition(|p| degree(p).is_some());
        let k = k.map_or(0, |last| last + 1);
        let at = |p: &Vec<f64>, i: usize| p.get(i).copied().unwrap_or(0.0) / p0[n];
        // The observer form: the last column has p₀, and each signal its own column of B.
        let a = Matrix::of(n, n, |i, j| {
            let below = if i == j + 1 { 1.0 } else { 0.0 };
            below - if j + 1 == n { at(p0, i) } else { 0.0 }
        });
        let b = Matrix::of(n, k, |i, j| at(&rest[j], n) * at(p0, i) - at(&rest[j], i));
        let c = Matrix::of(k, n, |i, j| if i == 0 && j + 1 == n { 1.0 } else { 0.0 });
        let d = Matrix::of(k, k, |i, j| match i {
            0 => -at(&rest[j], n),
            _ if i == j + 1 => 1.0,
            _ => 0.0,
        });
        Ok(Self { a, b, c, d })
    }

    fn checked(a: Matrix, c: Matrix, d: Matrix, b: Matrix) -> Result<Self, MatrixError> {
        let (rows, signals) = (a.rows(), b.columns());
        if rows > MOST_ROWS {
            return Err(MatrixError::TooLarge { rows });
        }
        if 2 * rows * signals > MOST_OF_BOTH {
            return Err(MatrixError::TooManySignals { rows, signals });
        }
        for (what, matrix) in [("A0", &a), ("A1", &b), ("A1", &c), ("E1", &d)] {
            if !matrix.is_finite() {
                return Err(MatrixError::NotFinite { what });
            }
        }
        Ok(Self { a, b, c, d }.balanced())
    }

    /// A, B, C and D.
    pub(in crate::linear) fn parts(&self) -> [&Matrix; 4] {
        [&self.a, &self.b, &self.c, &self.d]
    }

    /// n, the number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.a.rows()
    }

    /// K, the number of delayed signals.
    #[must_use]
    pub fn signals(&self) -> usize {
        self.b.columns()
    }

    /// This system with its roots shifted by −`line` at the delay `tau`: those right of the axis
    /// are those of this one right of Re λ = `line`. None where e^(−στ) overflows.
    fn shifted(&self, line: f64, tau: f64) -> Option<Self> {
        let by = exp(-line * tau);
        let unit = Matrix::unit(self.states());
        let moved = Self {
            a: self.a.plus(&unit, -line),
            b: self.b.mapped(|value| by * value),
            c: self.c.clone(),
            d: self.d.mapped(|value| by * value),
        };
        let finite = by.is_finite() && moved.b.is_finite() && moved.d.is_finite();
        finite.then_some(moved)
    }

    /// M(λ, z) of the module.
    fn pencil(&self, lambda: Complex64, z: Complex64) -> Square {
        let n = self.states();
        Square::of(n + self.signals(), |i, j| match (i < n, j < n) {
            (true, true) if i == j => lambda - self.a.at(i, j),
            (true, true) => Complex64::new(-self.a.at(i, j), 0.0),
            (true, false) => -z * self.b.at(i, j - n),
            (false, true) => Complex64::new(-self.c.at(i - n, j), 0.0),
            (false, false) if i == j => 1.0 - z * self.d.at(i - n, j - n),
            (false, false) => -z * self.d.at(i - n, j - n),
        })
    }

    /// d ln det M/dλ with z held, z d ln det M/dz, and a bound on the relative error of det M by
    /// rounding. Where M is singular twice over they are those of a point beside it. None where
    /// numbers are not finite.
    fn slopes(&self, lambda: Complex64, z: Complex64) -> Option<Slopes> {
        let n = self.states();
        let mut inverse = self.pencil(lambda, z).inverse()?;
        if inverse.vanished > 1 {
            let beside = lambda + BESIDE * self.bound() * Complex64::new(1.0, 1.0);
            inverse = self.pencil(beside, z).inverse()?;
        }
        let state = |i: usize, j: usize| if i == j && i < n { 1.0 } else { 0.0 };
        let along_lambda = inverse.trace(|i, j| state(i, j).into());
        let along_z = inverse.trace(|i, j| match (i < n, j < n) {
            (_, true) => Complex64::ZERO,
            (true, false) => -z * self.b.at(i, j - n),
            (false, false) => -z * self.d.at(i - n, j - n),
        });
        Some(Slopes {
            along_lambda,
            along_z,
            rounding: inverse.rounding,
            turn: inverse.turn,
        })
    }
}

/// Derivatives of ln det M.
#[derive(Debug, Clone, Copy)]
struct Slopes {
    along_lambda: Complex64,
    /// Times z.
    along_z: Complex64,
    rounding: f64,
    /// The argument of det M, as a point of the unit circle.
    turn: Complex64,
}

fn sized(
    what: &'static str,
    matrix: &Matrix,
    [rows, columns]: [usize; 2],
    wanted: &str,
) -> Result<(), MatrixError> {
    if (matrix.rows(), matrix.columns()) == (rows, columns) {
        return Ok(());
    }
    Err(MatrixError::Size {
        what,
        rows: matrix.rows(),
        columns: matrix.columns(),
        wanted: wanted.to_owned(),
    })
}
