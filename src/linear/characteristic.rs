//! The characteristic function of continuous sliding and a bound on its unstable roots.

use num_complex::Complex64;

use crate::model::Groups;
use crate::model::elementary::{exp, expm1, sincos};
use crate::model::groups::{feedback, open_loop};

/// D and what Newton's method and the implicit-function theorem need of it, at one λ.
///
/// ```text
/// D(λ) = B(λ) − A(λ) (1 − E),   E = e^(−λτ),   B = λ² + bλ + 1,   A = a_n + a_v (b + λ)     (1)
/// D′   = 2λ + b − a_v (1 − E) − A τ E                                                       (2)
/// D″   = 2 − 2 a_v τ E + A τ² E                                                             (3)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet {
    /// D(λ), Eq. (3) of the letter.
    pub value: Complex64,
    /// dD/dλ.
    pub first: Complex64,
    /// d²D/dλ².
    pub second: Complex64,
    /// E = e^(−λτ).
    pub delayed: Complex64,
    /// 1 − E, without cancellation where λτ is small.
    pub difference: Complex64,
    /// A(λ).
    pub feedback: Complex64,
}

impl Jet {
    /// Evaluates (1) to (3) at `lambda`; `tau` ≥ 0 in units of √(M/κ).
    ///
    /// Infinite or NaN only where |e^(−λτ)| overflows, far in the left half-plane.
    #[inline]
    #[must_use]
    pub fn at(groups: Groups, tau: f64, lambda: Complex64) -> Self {
        let Groups { b, a_v, .. } = groups;
        let difference = one_minus_exp(-tau * lambda);
        let delayed = 1.0 - difference;
        let feedback = Complex64::new(groups.feedback(b + lambda.re), a_v * lambda.im);
        let memory = feedback * delayed * tau;
        Self {
            value: open_loop(b, lambda) - feedback * difference,
            first: 2.0 * lambda + b - a_v * difference - memory,
            second: 2.0 - 2.0 * a_v * tau * delayed + memory * tau,
            delayed,
            difference,
            feedback,
        }
    }

    /// A bound on the rounding error of [`Jet::value`] at `lambda`, to within a small factor.
    ///
    /// Divided by |D′| it bounds what Newton's method can reach at a simple root.
    #[inline]
    #[must_use]
    pub(crate) fn rounding(&self, groups: Groups, tau: f64, lambda: Complex64) -> f64 {
        let Groups { b, a_v, a_n } = groups;
        // Sums of absolute parts bound absolute values without square roots.
        let size = lambda.l1_norm();
        let feedback = a_n.abs() + a_v.abs() * (b.abs() + size);
        let polynomial = 1.0 + size * (size + b.abs());
        // The argument λτ is rounded as well, and with it the phase of E.
        let delayed = self.delayed.l1_norm() * (1.0 + size * tau);
        4.0 * f64::EPSILON * (polynomial + feedback * (self.difference.l1_norm() + delayed))
    }
}

/// 1 − e^z with full relative accuracy near z = 0.
#[inline]
pub(crate) fn one_minus_exp(z: Complex64) -> Complex64 {
    let (sin, cos) = sincos(0.5 * z.im);
    let growth = expm1(z.re);
    // 1 − cos z.im, and from it e^x cos y − 1 = expm1(x) cos y − (1 − cos y).
    let versine = 2.0 * sin * sin;
    Complex64::new(
        versine - growth * (1.0 - versine),
        -(growth + 1.0) * (2.0 * sin * cos),
    )
}

/// e^(−λδ) for a delay or latency δ.
#[inline]
pub(crate) fn late(delta: f64, lambda: Complex64) -> Complex64 {
    1.0 - one_minus_exp(-delta * lambda)
}

/// D(λ) of the letter's Eq. (3), dimensionless; see [`Jet`].
#[must_use]
pub fn characteristic(groups: Groups, tau: f64, lambda: Complex64) -> Complex64 {
    Jet::at(groups, tau, lambda).value
}

/// The radius of a disc about 0 that holds every root with Re λ ≥ 0, for every delay.
///
/// For such a root |1 − e^(−λτ)| ≤ 2, so |λ|² ≤ (|b| + 2|a_v|)|λ| + 1 + 2|b a_v + a_n|. This is the
/// explicit form of the upper limits that the letter mentions below its Eq. (3).
#[must_use]
pub(crate) fn unstable_root_bound(groups: Groups) -> f64 {
    root_bound(groups, 0.0, 0.0)
}

/// The radius of a disc about 0 that holds every root with Re λ ≥ `line`, at the delay `tau` ≥ 0.
///
/// There |1 − e^(−λτ)| ≤ 1 + e^(−στ) with σ = `line`, so |λ|² ≤ (|b| + (1 + e^(−στ))|a_v|)|λ| + 1 +
/// (1 + e^(−στ))|b a_v + a_n|.
#[must_use]
pub(crate) fn root_bound(groups: Groups, tau: f64, line: f64) -> f64 {
    let Groups { b, a_v, a_n } = groups;
    let largest = 1.0 + exp(-line * tau);
    let linear = b.abs() + largest * a_v.abs();
    let constant = 1.0 + largest * feedback(a_n, a_v, b).abs();
    0.5 * (linear + (linear * linear + 4.0 * constant).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The letter's Eq. (3) as it stands there.
    fn as_printed(g: Groups, tau: f64, l: Complex64) -> Complex64 {
        let difference = 1.0 - (-l * tau).exp();
        l * l + (g.b - g.a_v * difference) * l + 1.0 - (g.b * g.a_v + g.a_n) * difference
    }

    #[test]
    fn the_jet_is_the_letters_equation_and_its_derivatives() {
        let groups = Groups::new(-0.4, 0.7, -1.3);
        let h = 1e-5;
        for (tau, lambda) in [
            (2.5, Complex64::new(0.1, 0.9)),
            (0.0, Complex64::new(-0.7, 2.0)),
            (9.0, Complex64::new(-0.3, 0.0)),
        ] {
            let jet = Jet::at(groups, tau, lambda);
            let [before, after] = [-h, h].map(|h| as_printed(groups, tau, lambda + h));
            let here = as_printed(groups, tau, lambda);
            assert!((jet.value - here).norm() < 1e-13);
            assert!((jet.first - (after - before) / (2.0 * h)).norm() < 1e-5);
            let curvature = (after - 2.0 * here + before) / (h * h);
            assert!(
                (jet.second - curvature).norm() < 1e-3,
                "{}",
                jet.second - curvature
            );
        }
    }

    #[test]
    fn small_delays_keep_their_digits() {
        let jet = Jet::at(Groups::new(0.0, 0.0, 1e9), 1e-9, Complex64::new(0.3, 0.4));
        // 1 − E ≈ λτ: the feedback is λ to nine digits and more.
        let exact = Complex64::new(0.3, 0.4) * (1.0 - 0.5e-9 * Complex64::new(0.3, 0.4));
        assert!((jet.feedback * jet.difference - exact).norm() < 1e-15);
    }

    #[test]
    fn zero_is_never_a_root() {
        for (b, a_v, a_n, tau) in [
            (-0.5, 1.0, -3.0, 2.0),
            (0.0, 0.0, 0.5, 0.0),
            (1.0, 4.0, 9.0, 50.0),
        ] {
            let at_zero = characteristic(Groups::new(b, a_v, a_n), tau, Complex64::new(0.0, 0.0));
            assert_eq!(at_zero, Complex64::new(1.0, 0.0));
        }
    }
}
