//! Characteristic roots as eigenvalues: pseudospectral collocation of the infinitesimal generator.
//!
//! After Breda, Maset and Vermiglio (2005). With P = Σ p_i λⁱ and Q = Σ q_i λⁱ only u = Σ q_i x⁽ⁱ⁾
//! is fed back, so the history of this one scalar is collocated, on N + 1 Chebyshev points θ_j of
//! [−τ, 0]. For the controlled oscillator
//!
//! ```text
//! d/dt (x, ẋ, u(θ₁), …, u(θ_N)) = (ẋ, −p₀x − p₁ẋ − u(θ_N), Σ_m D_jm u(θ_m))
//! ```
//!
//! a matrix of N + 2 rows instead of the 2N + 2 of the general method; N + n rows for degree n. In
//! a neutral equation u(0) holds x⁽ⁿ⁾ as well, which the equation itself gives. This is the only
//! file that uses faer. Its feature `std` is off, since with it faer picks code by the processor.

use std::f64::consts::PI;

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, evd_cplx, evd_real, evd_scratch};
use faer::{Mat, Par, Spec};
use num_complex::Complex64;

use crate::model::Channel;
use crate::model::elementary::{cbrt, cos};

/// Most nodes N: beyond this an eigenvalue problem takes a good part of a second.
pub(crate) const MOST_NODES: usize = 384;

/// How many nodes resolve every root λ with |λ| ≤ `radius`.
///
/// The interpolant of e^(λθ) on [−τ, 0] has to be good on all of the region where roots can be (Wu
/// and Michiels, 2012). With |λ|τ/2 as the argument of the Chebyshev expansion its error falls
/// faster than any power once N exceeds that argument.
///
/// None where that takes more than `MOST_NODES`.
#[must_use]
pub(crate) fn nodes_for(tau: f64, radius: f64) -> Option<usize> {
    let half_angle = 0.5 * tau * radius;
    let nodes = 1.15 * half_angle + 3.0 * cbrt(half_angle) + 6.0;
    (nodes <= MOST_NODES as f64).then_some(nodes as usize)
}

/// Approximate roots with Im λ ≥ 0 from `nodes` nodes, by falling real part; those far left are
/// meaningless.
///
/// `p` and `q` are the coefficients of P and Q, the constants first; the last of P is not 0, and Q
/// has no higher degree. Newton's method has to polish the roots. `tau` > 0 in units of √(M/κ).
/// None if the eigenvalue iteration fails.
#[must_use]
pub(crate) fn eigenvalues(p: &[f64], q: &[f64], tau: f64, nodes: usize) -> Option<Vec<Complex64>> {
    eigenvalues_of(&generator(p, q, tau, nodes))
}

/// Feedback that comes late, B(1 − R E) = A e^(−λδ)(1 − E), by the coefficients of B and A.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Late<'c> {
    /// B; its last coefficient is not 0.
    pub open: &'c [f64],
    /// A, of lower degree.
    pub gain: &'c [f64],
    /// R and δ.
    pub channel: Channel,
    /// τ > 0.
    pub tau: f64,
}

/// The eigenvalues of [`eigenvalues`] for feedback with latency.
///
/// With z = (1 − R E) x only s = A x is fed back: B z = s(t − δ) − s(t − δ − τ), and s = A z +
/// R s(t − τ). Its history over τ + δ is collocated, with barycentric values inside.
#[must_use]
pub(crate) fn late_eigenvalues(of: &Late<'_>, nodes: usize) -> Option<Vec<Complex64>> {
    eigenvalues_of(&late_generator(of, nodes))
}

/// The eigenvalues with Im λ ≥ 0 of the real matrix of `size` rows with these entries, by falling
/// real part. None if the iteration fails.
#[must_use]
pub(crate) fn eigenvalues_of_real(
    size: usize,
    entry: impl Fn(usize, usize) -> f64,
) -> Option<Vec<Complex64>> {
    if size == 0 {
        return Some(Vec::new());
    }
    eigenvalues_of(&Mat::from_fn(size, size, entry))
}

/// The eigenvalues of the complex matrix of `size` rows with these entries, in no order. None if
/// the iteration fails.
#[must_use]
pub(crate) fn eigenvalues_of_complex(
    size: usize,
    entry: impl Fn(usize, usize) -> Complex64,
) -> Option<Vec<Complex64>> {
    if size <= 1 {
        return Some((0..size).map(|i| entry(i, i)).collect());
    }
    let matrix = Mat::from_fn(size, size, entry);
    let mut values = Diag::<Complex64>::zeros(size);
    let none = ComputeEigenvectors::No;
    let scratch = evd_scratch::<Complex64>(size, none, none, Par::Seq, Spec::default());
    let mut memory = MemBuffer::new(scratch);
    evd_cplx(
        matrix.as_ref(),
        values.as_mut(),
        None,
        None,
        Par::Seq,
        MemStack::new(&mut memory),
        Spec::default(),
    )
    .ok()?;
    let found: Vec<Complex64> = (0..size).map(|i| values[i]).collect();
    found.iter().all(|z| z.is_finite()).then_some(found)
}

/// Entry of the matrix that differentiates values at the points of [`eigenvalues`] on [−τ, 0], of
/// which the first is 0 and the last −τ.
#[must_use]
pub(crate) fn derivative(nodes: usize, row: usize, column: usize, tau: f64) -> f64 {
    differentiation(nodes, row, column) * 2.0 / tau
}

fn eigenvalues_of(matrix: &Mat<f64>) -> Option<Vec<Complex64>> {
    let size = matrix.nrows();
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
fn generator(p: &[f64], q: &[f64], tau: f64, nodes: usize) -> Mat<f64> {
    let n = p.len() - 1;
    let size = nodes + n;
    let per_leading = 1.0 / p[n];
    // The coefficient of x⁽ⁿ⁾ in u(0).
    let neutral = q.get(n).copied().unwrap_or(0.0) * per_leading;
    let mut matrix = Mat::<f64>::zeros(size, size);
    for i in 1..n {
        matrix[(i - 1, i)] = 1.0;
    }
    for i in 0..n {
        matrix[(n - 1, i)] = -p[i] * per_leading;
    }
    matrix[(n - 1, size - 1)] -= per_leading;
    for row in 1..=nodes {
        for column in 0..=nodes {
            let entry = differentiation(nodes, row, column) * 2.0 / tau;
            if column > 0 {
                matrix[(row + n - 1, column + n - 1)] += entry;
                continue;
            }
            for i in 0..n {
                let own = q.get(i).copied().unwrap_or(0.0);
                matrix[(row + n - 1, i)] += entry * (own - neutral * p[i]);
            }
            if neutral != 0.0 {
                matrix[(row + n - 1, size - 1)] -= entry * neutral;
            }
        }
    }
    matrix
}

/// The matrix of [`late_eigenvalues`].
fn late_generator(of: &Late<'_>, nodes: usize) -> Mat<f64> {
    let n = of.open.len() - 1;
    let span = of.tau + of.channel.latency;
    let per_leading = 1.0 / of.open[n];
    let late = interpolation(nodes, of.channel.latency / span);
    let delayed = interpolation(nodes, of.tau / span);
    // s(0) as a row over z, ż, … and s at the other nodes. The interpolation at τ contains s(0)
    // itself.
    let per_own = 1.0 / (1.0 - of.channel.memory * delayed[0]);
    let mut now = vec![0.0; nodes + n];
    for (entry, a) in now.iter_mut().zip(of.gain) {
        *entry = a * per_own;
    }
    for (entry, weight) in now[n..].iter_mut().zip(&delayed[1..]) {
        *entry = of.channel.memory * weight * per_own;
    }
    let mut matrix = Mat::<f64>::zeros(nodes + n, nodes + n);
    for i in 1..n {
        matrix[(i - 1, i)] = 1.0;
    }
    for i in 0..nodes + n {
        let own = if i < n { -of.open[i] } else { late[i - n + 1] };
        matrix[(n - 1, i)] = (own + late[0] * now[i]) * per_leading;
    }
    matrix[(n - 1, nodes + n - 1)] -= per_leading;
    for row in 1..=nodes {
        let entry = |column| differentiation(nodes, row, column) * 2.0 / span;
        for column in 1..=nodes {
            matrix[(row + n - 1, column + n - 1)] = entry(column);
        }
        let first = entry(0);
        for (i, now) in now.iter().enumerate() {
            matrix[(row + n - 1, i)] += first * now;
        }
    }
    matrix
}

/// Weights of the values at the Chebyshev points, from 0 back to the longest delay, in the value at
/// the `part` of that delay.
fn interpolation(nodes: usize, part: f64) -> Vec<f64> {
    let at = 1.0 - 2.0 * part;
    let point = |j: usize| cos(PI * j as f64 / nodes as f64);
    if let Some(hit) = (0..=nodes).find(|&j| point(j) == at) {
        let own = |j| if j == hit { 1.0 } else { 0.0 };
        return (0..=nodes).map(own).collect();
    }
    let mut weights: Vec<f64> = (0..=nodes)
        .map(|j| {
            let end = if j == 0 || j == nodes { 0.5 } else { 1.0 };
            let sign = if j.is_multiple_of(2) { end } else { -end };
            sign / (at - point(j))
        })
        .collect();
    let sum: f64 = weights.iter().sum();
    for weight in &mut weights {
        *weight /= sum;
    }
    weights
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
    use crate::model::{Groups, known_cases};

    fn of_groups(groups: Groups, tau: f64, nodes: usize) -> Option<Vec<Complex64>> {
        crate::linear::equation::Equation::eigenvalues(groups, tau, nodes)
    }

    #[test]
    fn eigenvalues_converge_spectrally_to_roots() {
        let case = known_cases::letter_fig3()[0];
        let error = |nodes| {
            let rightmost = of_groups(case.groups, case.tau, nodes).expect("converges")[0];
            let root = polish(case.groups, case.tau, rightmost).expect("near a root");
            (root.lambda - rightmost).norm()
        };
        let errors = [6, 9, 12, 18].map(error);
        assert!(errors[0] < 0.1 && errors[3] < 1e-11, "{errors:?}");
        assert!(errors[2] < 1e-2 * errors[0], "{errors:?}");
    }
}
