//! Elementary functions whose bits are the same on every processor.
//!
//! The methods of `f64` and `Complex64` call the C library, which picks its code by the processor
//! it runs on. Their last bits differ between machines, so a map would depend on where it was made.
//! The crate libm is plain Rust and rounds alike everywhere. `clippy.toml` refuses those methods in
//! all code whose numbers reach a map.
//!
//! Errors are below one unit in the last place of the result ([`power`]: one half for each of its
//! products).

use num_complex::Complex64;

pub(crate) use libm::{
    acos, atan, atan2, cbrt, cos, cosh, exp, expm1, hypot, log as ln, log1p as ln_1p, log10, pow,
    sin, sincos, sinh, tanh,
};

/// `base` to the power `exponent` by repeated squaring, always in the same order; a negative power
/// is the inverse of the positive one.
#[must_use]
pub(crate) fn power(base: f64, exponent: i32) -> f64 {
    let (mut square, mut left, mut product) = (base, exponent.unsigned_abs(), 1.0);
    while left > 0 {
        if left % 2 == 1 {
            product *= square;
        }
        square *= square;
        left /= 2;
    }
    if exponent < 0 { 1.0 / product } else { product }
}

/// log₂ of `x` to 1e-8, in a third of the time of the exact one.
#[inline]
#[must_use]
pub(crate) fn rough_log2(x: f64) -> f64 {
    const SQRT_HALF: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
    const ODD: [f64; 5] = [2.0, 2.0 / 3.0, 2.0 / 5.0, 2.0 / 7.0, 2.0 / 9.0];
    if !(x.is_normal() && x > 0.0) {
        return libm::log2(x);
    }
    // x = 2ⁿ m with m from √½ to √2, and ln m = 2 artanh s.
    let n = (x.to_bits().wrapping_sub(SQRT_HALF) as i64) >> 52;
    let m = f64::from_bits(x.to_bits().wrapping_sub((n as u64) << 52));
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    let ln = s * ((ODD[0] + q * ODD[1]) + q * q * (ODD[2] + q * (ODD[3] + q * ODD[4])));
    n as f64 + std::f64::consts::LOG2_E * ln
}

/// 2 to the power `y`, with a relative error of 2e-7.
#[inline]
#[must_use]
pub(crate) fn rough_exp2(y: f64) -> f64 {
    // Adding this to a small number rounds it to an integer.
    const ROUNDING: f64 = 1.5 / f64::EPSILON;
    if y.is_nan() || y.abs() > 1000.0 {
        return libm::exp2(y);
    }
    let whole = (y + ROUNDING) - ROUNDING;
    let t = (y - whole) * std::f64::consts::LN_2;
    let q = t * t;
    let even = 1.0 + q * (0.5 + q * (1.0 / 24.0 + q * (1.0 / 720.0)));
    let odd = 1.0 + q * (1.0 / 6.0 + q * (1.0 / 120.0));
    f64::from_bits(((1023 + whole as i64) as u64) << 52) * (even + t * odd)
}

/// The root of order `order` of `x` ≥ 0, with a relative error of 2e-7: enough for the length of a
/// step.
#[inline]
#[must_use]
pub(crate) fn rough_root(x: f64, order: usize) -> f64 {
    rough_exp2(rough_log2(x) / order as f64)
}

/// Two independent numbers of the standard normal distribution from two of the uniform one on
/// [0, 1), by the method of Box and Muller.
#[must_use]
pub(crate) fn normals([first, second]: [f64; 2]) -> [f64; 2] {
    let radius = (-2.0 * ln(1.0 - first)).sqrt();
    let angle = std::f64::consts::TAU * second;
    [radius * cos(angle), radius * sin(angle)]
}

/// |z|, without overflow on the way.
#[inline]
#[must_use]
pub(crate) fn norm(z: Complex64) -> f64 {
    hypot(z.re, z.im)
}

/// The argument of `z` in [−π, π].
#[inline]
#[must_use]
pub(crate) fn arg(z: Complex64) -> f64 {
    atan2(z.im, z.re)
}

/// √z with a real part of at least 0, for numbers whose size does not overflow.
#[must_use]
pub(crate) fn sqrt(z: Complex64) -> Complex64 {
    // The larger part first, then the other from their product.
    let large = (0.5 * (z.re.abs() + norm(z))).sqrt();
    if large == 0.0 {
        return z;
    }
    let small = 0.5 * z.im.abs() / large;
    if z.re >= 0.0 {
        Complex64::new(large, small.copysign(z.im))
    } else {
        Complex64::new(small, large.copysign(z.im))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both err by less than a unit in the last place.
    #[test]
    fn results_are_those_of_the_c_library_but_for_rounding() {
        type Function = fn(f64) -> f64;
        let all: [(&str, [Function; 2], f64, f64); 15] = [
            ("sin", [sin, f64::sin], -1e4, 1e4),
            ("cos", [cos, f64::cos], -1e4, 1e4),
            ("sincos", [|x| sincos(x).0, f64::sin], -4.0, 4.0),
            ("exp", [exp, f64::exp], -700.0, 700.0),
            ("expm1", [expm1, f64::exp_m1], -1.0, 1.0),
            ("ln", [|x| ln(exp(x)), |x| exp(x).ln()], -700.0, 700.0),
            ("acos", [acos, f64::acos], -1.0, 1.0),
            ("cbrt", [cbrt, f64::cbrt], 0.0, 1e4),
            ("pow", [|x| pow(x, -0.07), |x| x.powf(-0.07)], 1e-9, 1e3),
            ("atan2", [|x| atan2(x, 0.7), |x| x.atan2(0.7)], -9.0, 9.0),
            ("atan", [atan, f64::atan], -9.0, 9.0),
            ("sinh", [sinh, f64::sinh], -9.0, 9.0),
            ("cosh", [cosh, f64::cosh], -9.0, 9.0),
            ("tanh", [tanh, f64::tanh], -9.0, 9.0),
            ("ln_1p", [ln_1p, f64::ln_1p], -0.9, 9.0),
        ];
        for (name, [ours, theirs], from, to) in all {
            for i in 0..20_000 {
                let x = from + (to - from) * (f64::from(i) + 0.123) / 20_000.0;
                let apart = (ours(x) - theirs(x)).abs() / (f64::EPSILON * theirs(x).abs());
                assert!(apart <= 2.0, "{name}({x}): {apart} ε");
            }
        }
    }

    #[test]
    fn rough_results_are_as_good_as_they_say() {
        for i in -40_000_i32..40_000 {
            let y = f64::from(i) * 0.0173;
            let x = exp(y);
            assert!(
                (rough_log2(x) - y / std::f64::consts::LN_2).abs() < 1e-8,
                "{x}"
            );
            let power = rough_exp2(y) / libm::exp2(y);
            assert!((power - 1.0).abs() < 2e-7, "{y}");
            let order = 4 + i.unsigned_abs() as usize % 30;
            let root = rough_root(x, order) / pow(x, 1.0 / order as f64);
            assert!((root - 1.0).abs() < 2e-7, "{x} {order}");
        }
        assert_eq!(rough_root(0.0, 7), 0.0);
        assert_eq!(rough_root(f64::INFINITY, 7), f64::INFINITY);
        assert!(rough_root(f64::NAN, 7).is_nan() && rough_root(-1.0, 7).is_nan());
        assert!((rough_root(1e-310, 31) / pow(1e-310, 1.0 / 31.0) - 1.0).abs() < 2e-7);
    }

    #[test]
    fn powers_are_products() {
        for base in [-1.7, 0.3, 2.0] {
            let product = |n: usize| std::iter::repeat_n(base, n).product::<f64>();
            for exponent in 0..12 {
                let expected = product(exponent);
                let found = power(base, exponent as i32);
                assert!((found - expected).abs() <= 8.0 * f64::EPSILON * expected.abs());
                assert_eq!(power(base, -(exponent as i32)), 1.0 / found);
            }
        }
        assert_eq!(power(2.0, -53), 2.0 * f64::EPSILON / 4.0);
    }

    #[test]
    fn square_roots_square_to_what_they_are_of() {
        for re in [-3.0, -1e-9, -0.0, 0.0, 1e-20, 2.5] {
            for im in [-7.0, -1e-12, -0.0, 0.0, 1e-9, 0.4] {
                let z = Complex64::new(re, im);
                let root = sqrt(z);
                assert!(root.re >= 0.0, "{z} {root}");
                let apart = root * root - z;
                let error = 8.0 * f64::EPSILON * norm(z);
                assert!(norm(apart) <= error, "{z} {root}");
            }
        }
    }
}
