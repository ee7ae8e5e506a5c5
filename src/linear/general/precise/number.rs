//! Numbers of three doubles: 159 bits, where f64 loses what matters.
//!
//! Sums and products are made of sums and products without error (Knuth, Dekker), which are added
//! up from the smallest on until nothing overlaps (Ogita, Rump and Oishi 2005).

use std::ops::{Add, Mul, Neg, Sub};

/// A bound on the error of one operation, relative to the sizes of what goes into it.
pub(super) const UNIT: f64 = 1.0 / (1_u128 << 120) as f64 / (1_u64 << 25) as f64;

/// How often a sum is gone through; each time doubles the digits known of it.
const PASSES: usize = 4;
/// 2²⁷ + 1, which splits a double into halves.
const SPLITTER: f64 = 134_217_729.0;

/// The unevaluated sum of three doubles, the largest first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Number([f64; 3]);

/// a + b and what rounding lost.
#[inline]
fn sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// The upper and the lower half of a double.
#[inline]
fn halves(a: f64) -> (f64, f64) {
    let scaled = SPLITTER * a;
    let upper = scaled - (scaled - a);
    (upper, a - upper)
}

/// a b and what rounding lost.
#[inline]
fn product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a_upper, a_lower), (b_upper, b_lower)) = (halves(a), halves(b));
    let rest = a_upper * b_upper - product + a_upper * b_lower + a_lower * b_upper;
    (product, rest + a_lower * b_lower)
}

impl Number {
    pub(super) const ZERO: Self = Self([0.0; 3]);
    pub(super) const ONE: Self = Self([1.0, 0.0, 0.0]);

    /// The number itself: without error.
    pub(super) const fn of(value: f64) -> Self {
        Self([value, 0.0, 0.0])
    }

    /// The number whose first digits are `parts`, the largest first.
    pub(super) const fn of_parts(parts: [f64; 3]) -> Self {
        Self(parts)
    }

    /// The nearest double.
    pub(super) const fn value(self) -> f64 {
        self.0[0]
    }

    /// The sum of all `terms`.
    fn sum_of<const N: usize>(mut terms: [f64; N]) -> Self {
        for _ in 0..PASSES {
            for i in (1..N).rev() {
                (terms[i - 1], terms[i]) = sum(terms[i - 1], terms[i]);
            }
        }
        // What cancels leaves zeros in front.
        let (mut parts, mut count) = ([0.0; 3], 0);
        let mut carried = terms[0];
        for &term in &terms[1..] {
            let (whole, rest) = sum(carried, term);
            if rest == 0.0 {
                carried = whole;
                continue;
            }
            parts[count] = whole;
            count += 1;
            if count == parts.len() {
                return Self(parts);
            }
            carried = rest;
        }
        parts[count] = carried;
        Self(parts)
    }

    /// The product with a double.
    pub(super) fn times(self, by: f64) -> Self {
        let [a, b, c] = self.0;
        let ((p, p_rest), (q, q_rest)) = (product(a, by), product(b, by));
        Self::sum_of([p, p_rest, q, q_rest, c * by])
    }

    /// The quotient by a double.
    pub(super) fn over(self, by: f64) -> Self {
        let mut left = self;
        let digits = [(); 4].map(|()| {
            let digit = left.value() / by;
            left = left - Self::of(digit).times(by);
            digit
        });
        Self::sum_of(digits)
    }
}

impl Add for Number {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        Self::sum_of([a, d, b, e, c, f])
    }
}

impl Neg for Number {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.map(|part| -part))
    }
}

impl Sub for Number {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Number {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        let (first, first_rest) = product(a, d);
        let ((p, p_rest), (q, q_rest)) = (product(a, e), product(b, d));
        let small = a * f + (b * e + c * d);
        Self::sum_of([first, p, q, first_rest, small, p_rest, q_rest])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The whole number that all three parts come to.
    fn whole(number: Number) -> i128 {
        number.0.iter().map(|part| *part as i128).sum()
    }

    /// Against whole numbers, in which sums and products have no rounding.
    #[test]
    fn sums_and_products_are_those_of_whole_numbers() {
        let mut state = 7_i64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            state >> 14
        };
        for _ in 0..10_000 {
            let [upper, lower, other] = [next(), next(), next()];
            let by = other >> 24;
            let x = Number::of(upper as f64).times(2_f64.powi(50)) + Number::of(lower as f64);
            let y = Number::of(other as f64);
            let exact = (i128::from(upper) << 50) + i128::from(lower);
            assert_eq!(whole(x), exact);
            assert_eq!(whole(x + y), exact + i128::from(other));
            assert_eq!(whole(x - y - x), -i128::from(other));
            let scaled = x * Number::of(by as f64);
            assert_eq!(whole(scaled), exact * i128::from(by));
            assert_eq!(scaled, x.times(by as f64));
            let square = (x - Number::ONE) * (x - Number::ONE);
            let left = square - (x * x - x.times(2.0) + Number::ONE);
            assert!(left.value().abs() <= UNIT * square.value(), "{left:?}");
        }
    }

    /// 1/3 three times is 1, to the last of the digits.
    #[test]
    fn quotients_have_all_digits() {
        for by in [3.0, 7.0, 1e-3, -12345.678] {
            let third = Number::ONE.over(by);
            let left = third.times(by) - Number::ONE;
            assert!(left.value().abs() <= UNIT, "{by}: {left:?}");
        }
    }
}
