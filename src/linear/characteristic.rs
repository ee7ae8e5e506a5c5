//! The characteristic function of continuous sliding and a bound on its unstable roots.

use num_complex::Complex64;

use crate::model::Groups;

/// D(λ) of the letter's Eq. (3), dimensionless:
///
/// ```text
/// D(λ) = B(λ) − A(λ) (1 − e^(−λτ)),   B = λ² + bλ + 1,   A = a_n + a_v (b + λ)
/// ```
///
/// `tau` ≥ 0 in units of √(M/κ). Overflows to infinities or NaN only where |e^(−λτ)| does, far in the left half-plane.
#[must_use]
pub fn characteristic(groups: Groups, tau: f64, lambda: Complex64) -> Complex64 {
    let Groups { b, a_v, a_n } = groups;
    let open_loop = lambda * lambda + b * lambda + 1.0;
    let feedback = a_n + a_v * (b + lambda);
    open_loop - feedback * (1.0 - (-lambda * tau).exp())
}

/// dD/dλ at `lambda`; arguments as for [`characteristic`].
#[must_use]
pub fn characteristic_derivative(groups: Groups, tau: f64, lambda: Complex64) -> Complex64 {
    let Groups { b, a_v, a_n } = groups;
    let delayed = (-lambda * tau).exp();
    let feedback = a_n + a_v * (b + lambda);
    2.0 * lambda + b - a_v * (1.0 - delayed) - feedback * tau * delayed
}

/// The radius of a disc about 0 that holds every root with Re λ ≥ 0, for every delay.
///
/// For such a root |1 − e^(−λτ)| ≤ 2, so |λ|² ≤ (|b| + 2|a_v|)|λ| + 1 + 2|b a_v + a_n|. This is the explicit form of the
/// upper limits that the letter mentions below its Eq. (3).
#[must_use]
pub fn unstable_root_bound(groups: Groups) -> f64 {
    let Groups { b, a_v, a_n } = groups;
    let linear = b.abs() + 2.0 * a_v.abs();
    let constant = 1.0 + 2.0 * (b * a_v + a_n).abs();
    0.5 * (linear + (linear * linear + 4.0 * constant).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivative_matches_a_difference_quotient() {
        let groups = Groups::new(-0.4, 0.7, -1.3);
        let (tau, lambda) = (2.5, Complex64::new(0.1, 0.9));
        let h = 1e-6;
        let numeric = (characteristic(groups, tau, lambda + h)
            - characteristic(groups, tau, lambda - h))
            / (2.0 * h);
        assert!((numeric - characteristic_derivative(groups, tau, lambda)).norm() < 1e-8);
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
