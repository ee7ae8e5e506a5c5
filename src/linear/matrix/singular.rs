//! Complex matrices that are nearly singular, and where their determinants vanish.

use num_complex::Complex64;

use crate::linear::newton::divide;
use crate::model::elementary::norm;

/// A square complex matrix by rows.
#[derive(Debug, Clone)]
pub(super) struct Square {
    size: usize,
    values: Vec<Complex64>,
}

/// The inverse of a matrix, and what rounding of its numbers does to its determinant.
pub(super) struct Inverse {
    size: usize,
    values: Vec<Complex64>,
    /// A bound on the relative change of the determinant by the rounding of the numbers.
    pub rounding: f64,
    /// How many pivots vanish: with two of them neither the inverse nor its traces mean anything.
    pub vanished: usize,
    /// The argument of the determinant, as a point of the unit circle.
    pub turn: Complex64,
}

impl Square {
    /// The matrix of the numbers that `entry` gives for a row and a column.
    pub(super) fn of(size: usize, entry: impl Fn(usize, usize) -> Complex64) -> Self {
        let places = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
        Self {
            size,
            values: places.map(|(i, j)| entry(i, j)).collect(),
        }
    }

    /// The inverse, by elimination with partial pivoting; where a pivot vanishes it is taken for
    /// the least number that counts. None where numbers are not finite.
    pub(super) fn inverse(&self) -> Option<Inverse> {
        let n = self.size;
        let mut left = self.values.clone();
        let mut inverse = vec![Complex64::ZERO; n * n];
        for i in 0..n {
            inverse[i * n + i] = Complex64::ONE;
        }
        let largest = left.iter().fold(0.0_f64, |most, z| most.max(z.l1_norm()));
        let least = f64::EPSILON * f64::EPSILON * largest.max(1.0);
        let (mut vanished, mut turn) = (0, Complex64::ONE);
        for k in 0..n {
            let size = |i: &usize| left[i * n + k].l1_norm();
            let pivot = (k..n).max_by(|i, j| size(i).total_cmp(&size(j)))?;
            if pivot != k {
                for j in 0..n {
                    left.swap(k * n + j, pivot * n + j);
                    inverse.swap(k * n + j, pivot * n + j);
                }
                turn = -turn;
            }
            if left[k * n + k].l1_norm() <= least {
                left[k * n + k] = Complex64::new(least, 0.0);
                vanished += 1;
            }
            turn *= direction(left[k * n + k]);
            let by = divide_one(left[k * n + k]);
            for j in 0..n {
                left[k * n + j] *= by;
                inverse[k * n + j] *= by;
            }
            for i in (0..n).filter(|&i| i != k) {
                let factor = left[i * n + k];
                if factor == Complex64::ZERO {
                    continue;
                }
                for j in k..n {
                    let part = factor * left[k * n + j];
                    left[i * n + j] -= part;
                }
                for j in 0..n {
                    let part = factor * inverse[k * n + j];
                    inverse[i * n + j] -= part;
                }
            }
        }
        let found = Inverse {
            size: n,
            values: inverse,
            rounding: 0.0,
            vanished,
            turn,
        };
        let sizes = |i: usize, j: usize| self.values[i * n + j].l1_norm();
        let change = found.sum(
            |i, j| Complex64::new(sizes(i, j), 0.0),
            |z| z.l1_norm().into(),
        );
        let rounding = 4.0 * n as f64 * f64::EPSILON * change.re;
        rounding
            .is_finite()
            .then_some(Inverse { rounding, ..found })
    }
}

/// z as a point of the unit circle.
fn direction(z: Complex64) -> Complex64 {
    let scaled = z / z.l1_norm();
    scaled / norm(scaled)
}

/// 1/z, for numbers whose squares may overflow or vanish.
fn divide_one(z: Complex64) -> Complex64 {
    let scale = 1.0 / z.l1_norm();
    divide(Complex64::new(scale, 0.0), z * scale)
}

impl Inverse {
    /// The number in a row and a column.
    pub(super) fn at(&self, row: usize, column: usize) -> Complex64 {
        self.values[row * self.size + column]
    }

    /// The trace of the product of this inverse with the matrix of `entry`: the logarithmic
    /// derivative of the determinant where that is the derivative of the matrix.
    pub(super) fn trace(&self, entry: impl Fn(usize, usize) -> Complex64) -> Complex64 {
        self.sum(entry, |z| z)
    }

    fn sum(
        &self,
        entry: impl Fn(usize, usize) -> Complex64,
        of: impl Fn(Complex64) -> Complex64,
    ) -> Complex64 {
        let n = self.size;
        let places = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        places
            .map(|(i, j)| entry(i, j) * of(self.values[j * n + i]))
            .sum()
    }
}
