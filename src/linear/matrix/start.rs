//! The roots without delay: how many are unstable, and which lie on the axis.

use num_complex::Complex64;

use super::MatrixSystem;
use super::dense::Matrix;
use super::on_axis::inverse;
use super::singular::Square;
use crate::linear::collocation::eigenvalues_of_real;
use crate::linear::newton::Root;
use crate::model::elementary::norm;

/// How near two roots are that are not made sharp one by one, over the largest row.
const SAME: f64 = 1e-6;
/// So many times the rounding of eigenvalues are allowed for.
const UNCERTAIN: f64 = 16.0;
/// A delay factor on the unit circle that is neither 1 nor a root of unity of low order.
const ELSEWHERE: Complex64 = Complex64::new(0.540_302_305_868_139_8, -0.841_470_984_807_896_5);

/// The roots without delay: those right of the imaginary axis, and those on it.
#[derive(Debug, Clone, Default)]
pub(super) struct Start {
    /// Roots right of the axis.
    pub right: u64,
    /// Whether 0 is a simple root.
    pub origin: bool,
    /// Frequencies of pairs on the axis that the delay may move.
    pub moving: Vec<f64>,
    /// Frequencies of pairs on the axis that stay there at every delay.
    pub resting: Vec<f64>,
    /// Whether it is not known what becomes of some of them.
    pub unknown: bool,
}

impl MatrixSystem {
    /// The roots without delay, by where they are; none where they are not found.
    ///
    /// An eigenvalue of the closed loop counts by its real part where no change of the size of
    /// rounding makes one cross the axis beside it, however many are equal. Others are made sharp
    /// one by one.
    pub(super) fn start(&self) -> Option<Start> {
        let mut start = Start::default();
        let closed = self.closed_loop()?;
        let near = eigenvalues_of_real(self.states(), |i, j| closed.at(i, j))?;
        for (place, &lambda) in near.iter().enumerate() {
            if is_clear(&closed, lambda.im) {
                let number = if lambda.im > 0.0 { 2 } else { 1 };
                start.right += if lambda.re > 0.0 { number } else { 0 };
                continue;
            }
            let others = near.iter().enumerate().filter(|(other, _)| *other != place);
            let mut apart = others.map(|(_, other)| norm(other - lambda));
            let alone = apart.all(|apart| apart > SAME * self.bound()) && {
                lambda.im == 0.0 || lambda.im > SAME * self.bound()
            };
            let polished = self
                .polish(0.0, lambda)
                .filter(|root| alone && norm(root.lambda - lambda) <= 0.1 * SAME * self.bound());
            match polished {
                Some(root) => self.place(root, &mut start),
                None => start.unknown = true,
            }
        }
        Some(start)
    }

    /// Adds a single root to those without delay.
    fn place(&self, root: Root, start: &mut Start) {
        let Root { lambda, error } = root;
        let error = error.max(8.0 * f64::EPSILON * self.bound());
        if lambda.re.abs() > error {
            let number = if lambda.im > 0.0 { 2 } else { 1 };
            start.right += if lambda.re > 0.0 { number } else { 0 };
        } else if lambda.im <= error {
            start.unknown |= start.origin;
            start.origin = true;
        } else if self.stays(lambda, error) {
            start.resting.push(lambda.im);
        } else {
            start.moving.push(lambda.im);
        }
    }

    /// Approximate roots without delay, Im λ ≥ 0.
    pub(super) fn without_delay(&self) -> Option<Vec<Complex64>> {
        let closed = self.closed_loop()?;
        eigenvalues_of_real(self.states(), |i, j| closed.at(i, j))
    }

    /// A + B (1 − D)⁻¹ C, the matrix of the system without delay.
    pub(in crate::linear) fn closed_loop(&self) -> Option<Matrix> {
        let k = self.signals();
        if k == 0 {
            return Some(self.a.clone());
        }
        let fed = inverse(&Matrix::unit(k).plus(&self.d, -1.0))?.times(&self.c);
        Some(self.a.plus(&self.b.times(&fed), 1.0))
    }

    /// Whether the root λ on the axis without delay is one whatever the delay.
    fn stays(&self, lambda: Complex64, error: f64) -> bool {
        let Some(slopes) = self.slopes(lambda, ELSEWHERE) else {
            return false;
        };
        let step = 1.0 / norm(slopes.along_lambda);
        let rounding = slopes.rounding * step;
        self.signals() == 0 || step <= error + rounding
    }
}

impl Start {
    /// Whether something lies on the axis.
    pub(super) fn is_marginal(&self) -> bool {
        !(self.moving.is_empty() && self.resting.is_empty())
    }
}

/// Whether no change of the numbers of `closed` by rounding makes iω an eigenvalue.
fn is_clear(closed: &Matrix, omega: f64) -> bool {
    let n = closed.rows();
    let resolvent = Square::of(n, |i, j| {
        Complex64::new(-closed.at(i, j), if i == j { omega } else { 0.0 })
    });
    let Some(inverse) = resolvent.inverse() else {
        return false;
    };
    let size = (0..n).map(|i| (0..n).map(|j| closed.at(i, j).abs()).sum::<f64>());
    let size = size.fold(0.0, f64::max);
    let row = |i: usize| (0..n).map(|j| inverse.at(i, j).l1_norm()).sum::<f64>();
    let largest = (0..n).map(row).fold(0.0, f64::max);
    inverse.vanished == 0 && largest * size * UNCERTAIN * n as f64 * f64::EPSILON < 1.0
}
