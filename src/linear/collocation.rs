//! Characteristic roots as eigenvalues: pseudospectral collocation of the infinitesimal generator.
//!
//! After Breda, Maset and Vermiglio (2005). With P = λ² + p₁λ + p₀ and Q = q₁λ + q₀ only u = q₀x +
//! q₁ẋ is fed back, so the history of this one scalar is collocated, on N + 1 Chebyshev points θ_j
//! of [−τ, 0]:
//!
//! ```text
//! d/dt (x, ẋ, u(θ₁), …, u(θ_N)) = (ẋ, −p₀x − p₁ẋ − u(θ_N), Σ_m D_jm u(θ_m))
//! ```
//!
//! a matrix of N + 2 rows instead of the 2N + 2 of the general method. The only file that uses
//! faer: without its feature `std`, with which it picks code by the processor.

use std::f64::consts::PI;

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, evd_real, evd_scratch};
use faer::{Mat, Par, Spec};
use num_complex::Complex64;

use crate::model::Groups;
use crate::model::elementary::{cbrt, cos};

/// Most nodes N: beyond this an eigenvalue problem takes a good part of a second.
pub const MOST_NODES: usize = 384;

/// How many nodes resolve every root λ with |λ| ≤ `radius`.
///
/// The interpolant of e^(λθ) on [−τ, 0] has to be good on all of the region where roots can be (Wu
/// and Michiels, 2012). With |λ|τ/2 as the argument of the Chebyshev expansion its error falls
/// faster than any power once N exceeds that argument.
///
/// None where that takes more than is reasonable.
#[must_use]
pub fn nodes_for(tau: f64, radius: f64) -> Option<usize> {
    let half_angle = 0.5 * tau * radius;
    let nodes = 1.15 * half_angle + 3.0 * cbrt(half_angle) + 6.0;
    (nodes <= MOST_NODES as f64).then_some(nodes as usize)
}

/// Approximate roots with Im λ ≥ 0 from `nodes` nodes, by falling real part; those far left mean
/// nothing.
///
/// Newton's method has to polish them. `tau` > 0 in units of √(M/κ). None if the eigenvalue
/// iteration fails.
#[must_use]
pub fn eigenvalues(groups: Groups, tau: f64, nodes: usize) -> Option<Vec<Complex64>> {
    let size = nodes + 2;
    let matrix = generator(groups, tau, nodes);
    let mut re = Diag::<f64>::zeros(size);
    let mut im = Diag::<f64>::zeros(size);
    let scratch = evd_scratch::<f64>(
        size,
        ComputeEigenvectors::No,
        ComputeEigenvectors::No,
        Par::Seq,
        Spec::default(),
    );
    let mut memory = MemBuffer::new(scratch);
    evd_real(
        matrix.as_ref(),
        re.as_mut(),
        im.as_mut(),
        None,
        None,
        Par::Seq,
        MemStack::new(&mut memory),
        Spec::default(),
    )
    .ok()?;
    let mut values: Vec<Complex64> = (0..size)
        .map(|i| Complex64::new(re[i], im[i]))
        .filter(|z| z.im >= 0.0 && z.re.is_finite() && z.im.is_finite())
        .collect();
    values.sort_by(|p, q| q.re.total_cmp(&p.re).then(p.im.total_cmp(&q.im)));
    Some(values)
}

/// The matrix of the module.
fn generator(groups: Groups, tau: f64, nodes: usize) -> Mat<f64> {
    let Groups { b, a_v, a_n } = groups;
    let (q0, q1) = (a_n + a_v * b, a_v);
    let mut matrix = Mat::<f64>::zeros(nodes + 2, nodes + 2);
    matrix[(0, 1)] = 1.0;
    matrix[(1, 0)] = q0 - 1.0;
    matrix[(1, 1)] = a_v - b;
    matrix[(1, nodes + 1)] -= 1.0;
    for row in 1..=nodes {
        for column in 0..=nodes {
            let entry = differentiation(nodes, row, column) * 2.0 / tau;
            if column == 0 {
                matrix[(row + 1, 0)] += entry * q0;
                matrix[(row + 1, 1)] += entry * q1;
            } else {
                matrix[(row + 1, column + 1)] += entry;
            }
        }
    }
    matrix
}

/// Entry of the differentiation matrix on the Chebyshev points cos(πj/N) (Trefethen, Spectral
/// Methods in MATLAB, ch. 6).
fn differentiation(nodes: usize, row: usize, column: usize) -> f64 {
    let point = |j: usize| cos(PI * j as f64 / nodes as f64);
    let weight = |j: usize| {
        let end = if j == 0 || j == nodes { 2.0 } else { 1.0 };
        if j.is_multiple_of(2) { end } else { -end }
    };
    if row != column {
        return weight(row) / weight(column) / (point(row) - point(column));
    }
    // The rows of the matrix sum to zero: it differentiates constants.
    -(0..=nodes)
        .filter(|&j| j != row)
        .map(|j| weight(row) / weight(j) / (point(row) - point(j)))
        .sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::newton::polish;
    use crate::model::known_cases;

    #[test]
    fn eigenvalues_converge_spectrally_to_roots() {
        let case = known_cases::letter_fig3()[0];
        let error = |nodes| {
            let rightmost = eigenvalues(case.groups, case.tau, nodes).expect("converges")[0];
            let root = polish(case.groups, case.tau, rightmost).expect("near a root");
            (root.lambda - rightmost).norm()
        };
        let errors = [6, 9, 12, 18].map(error);
        assert!(errors[0] < 0.1 && errors[3] < 1e-11, "{errors:?}");
        assert!(errors[2] < 1e-2 * errors[0], "{errors:?}");
    }
}
