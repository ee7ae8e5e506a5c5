//! Polishing of a characteristic root.

use num_complex::Complex64;

use super::characteristic::Jet;
use super::equation::Equation;
use crate::model::elementary::{norm, sqrt};

/// Steps after which a start is given up.
const MOST_STEPS: u32 = 40;

/// A characteristic root, polished until rounding of D is all that is left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Root {
    /// λ with Im λ ≥ 0, in units of √(κ/M); with Im λ > 0 it stands for the pair λ, λ*.
    pub lambda: Complex64,
    /// Estimate of |λ − exact root|: the rounding error of D over |D′|, or the corresponding error
    /// at a double root.
    pub error: f64,
}

impl Root {
    /// Number of roots that this one stands for: 1 if it is real, else 2.
    #[must_use]
    pub fn count(&self) -> u64 {
        if self.lambda.im == 0.0 { 1 } else { 2 }
    }

    /// Whether some other root lies so near that rounding hardly tells them apart.
    #[must_use]
    pub(crate) fn nearly_multiple(&self) -> bool {
        self.error > 1e-10 * (1.0 + norm(self.lambda))
    }
}

/// The step δ of Halley's method, λ − δ being the next iterate: cubic where Newton's is quadratic,
/// at the cost of D″.
///
/// `newton` = D/D′ and `bend` = D″/D′.
#[inline(always)]
#[must_use]
pub(super) fn halley_step(newton: Complex64, bend: Complex64) -> Complex64 {
    divide(newton, 1.0 - 0.5 * newton * bend)
}

/// The step to the nearer zero of the parabola that touches D. It is Halley's step except near a
/// double root, where that one stalls.
fn step_of(jet: &Jet) -> Complex64 {
    let square = jet.first * jet.first;
    let bent = 2.0 * jet.value * jet.second;
    if bent.norm_sqr() < 0.25 * square.norm_sqr() {
        return halley_step(divide(jet.value, jet.first), divide(jet.second, jet.first));
    }
    let root = sqrt(square - bent);
    let denominators = [jet.first + root, jet.first - root];
    let [plus, minus] = denominators.map(|d| d.norm_sqr());
    2.0 * jet.value / denominators[usize::from(minus > plus)]
}

/// p/q, for numbers whose squares neither overflow nor vanish; NaN where they do.
#[inline(always)]
pub(super) fn divide(p: Complex64, q: Complex64) -> Complex64 {
    let scale = 1.0 / (q.re * q.re + q.im * q.im);
    Complex64::new(
        (p.re * q.re + p.im * q.im) * scale,
        (p.im * q.re - p.re * q.im) * scale,
    )
}

/// The root to which Halley's method converges from `start`, or none if it does not.
///
/// A start on the real axis stays on it. A root within its error of the real axis is taken for a
/// real one.
#[must_use]
pub fn polish(equation: impl Equation, tau: f64, start: Complex64) -> Option<Root> {
    let root = iterate(equation, tau, start)?;
    if root.lambda.im != 0.0 && root.lambda.im.abs() <= 4.0 * root.error {
        let real = iterate(equation, tau, Complex64::new(root.lambda.re, 0.0));
        return Some(
            real.filter(|r| norm(r.lambda - root.lambda) <= 16.0 * root.error)
                .unwrap_or(root),
        );
    }
    Some(root)
}

fn iterate(equation: impl Equation, tau: f64, start: Complex64) -> Option<Root> {
    let mut lambda = start;
    let mut last_step = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let jet = equation.jet(tau, lambda);
        let rounding = equation.rounding(&jet, tau, lambda);
        let step = step_of(&jet);
        let size = norm(step);
        let settled = norm(jet.value) <= rounding || size <= f64::EPSILON * norm(lambda);
        // At rounding level steps no longer shrink; the last good one is taken.
        if settled && (size >= 0.25 * last_step || size <= f64::EPSILON * norm(lambda)) {
            return Some(finished(lambda, &jet, rounding));
        }
        if !size.is_finite() {
            return settled.then(|| finished(lambda, &jet, rounding));
        }
        lambda -= step;
        last_step = size;
    }
    None
}

/// `lambda` with its error δ: |D′|δ or |D″|δ²/2 is then as large as `rounding`.
fn finished(lambda: Complex64, jet: &Jet, rounding: f64) -> Root {
    let simple = rounding / norm(jet.first);
    let double = (2.0 * rounding / norm(jet.second)).sqrt();
    Root {
        lambda: Complex64::new(lambda.re, lambda.im.abs()),
        error: simple.min(double) + f64::EPSILON * norm(lambda),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Groups, known_cases};

    #[test]
    fn known_roots_are_reached_from_afar() {
        let case = known_cases::beyond_the_letters_limit();
        let root = polish(case.groups, case.tau, Complex64::new(0.03, 0.8)).expect("converges");
        assert!(
            (root.lambda - Complex64::new(-0.0075, 0.7958)).norm() < 1e-4,
            "{root:?}"
        );
        assert!(root.error < 1e-14);
        assert!(!root.nearly_multiple());
    }

    #[test]
    fn a_double_root_is_told_by_its_error() {
        // b = 2 without control: (λ + 1)².
        let root =
            polish(Groups::new(2.0, 0.0, 0.0), 1.0, Complex64::new(-0.7, 0.0)).expect("converges");
        assert!((root.lambda.re + 1.0).abs() < 4.0 * root.error);
        assert!(root.error < 1e-7 && root.nearly_multiple());
    }
}
