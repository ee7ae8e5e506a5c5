//! The quadratic (1) of [`super`]: its coefficients, its discriminant and its roots.

use wide::f64x2;

use crate::model::Groups;

/// Half an ulp of 1, the relative error of one rounded operation.
pub(super) const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;
/// How many rounding errors the closed form may gather; a generous count of its operations.
pub(super) const ROUNDINGS: f64 = 16.0;

/// `group`, or zero where its square would underflow.
#[inline]
pub(super) fn without_underflow(group: f64) -> f64 {
    if group.abs() < 1e-150 { 0.0 } else { group }
}

/// c and d of the quadratic (1).
#[inline]
pub(super) fn quadratic(groups: Groups) -> (f64, f64) {
    let Groups { b, a_v, a_n } = groups;
    (b.mul_add(b, 2.0 * a_n), b * (b - 2.0 * a_v))
}

/// The discriminant c² − 4d of (1): two crossing frequencies may exist only where it is positive.
#[inline]
#[must_use]
pub(crate) fn discriminant(groups: Groups) -> f64 {
    let (c, d) = quadratic(groups);
    c.mul_add(c, -4.0 * d)
}

/// x₊ x₋ = F(0) = 1 − 2(a_n + b a_v): where it changes sign, ω₋ reaches zero and its delays
/// infinity.
#[inline]
#[must_use]
pub(crate) fn frequency_product(groups: Groups) -> f64 {
    let Groups { b, a_v, a_n } = groups;
    let sum = 1.0 - 2.0 * a_n;
    // The rounding error of the sum (Knuth's two-sum), which matters where the rest cancels.
    let part = sum - 1.0;
    let lost = (1.0 - (sum - part)) + (-2.0 * a_n - part);
    (-2.0 * b).mul_add(a_v, sum) + lost
}

/// Both real roots y of (1), the upper one first, without cancellation, and bounds on their errors.
#[inline]
pub(super) fn roots(
    (c, c_error): (f64, f64),
    d: f64,
    root: f64,
    discriminant_error: f64,
) -> (f64x2, f64x2) {
    // The root of larger size first, then the other from the product d.
    let large = -0.5 * (c + root.copysign(c));
    let per_large = 1.0 / large;
    let small = d / large;
    let large_error = 0.25 * discriminant_error / root + 0.5 * c_error;
    let small_error =
        small.abs() * (large_error * per_large.abs() + 2.0 * ROUNDINGS * UNIT_ROUNDOFF);
    if c.is_sign_positive() {
        (
            f64x2::from([small, large]),
            f64x2::from([small_error, large_error]),
        )
    } else {
        (
            f64x2::from([large, small]),
            f64x2::from([large_error, small_error]),
        )
    }
}
