//! Real numbers with a bound on their error, and intervals of numbers.

use super::elementary::{atan, cos, cosh, exp, expm1, ln, ln_1p, pow, sin, sinh, tanh};

/// The relative rounding error of one operation: libm errs by less than a unit in the last place.
const UNIT: f64 = f64::EPSILON;
/// Units in the last place by which hyperbolic functions, arcs and powers err at most.
const SEVERAL: f64 = 4.0;
/// From here on the least of an exponential over an interval is nothing to the greatest.
const WIDE: f64 = 30.0;
/// What rounding of an argument changes at most of an exponential that is finite.
const OF_ARGUMENT: f64 = 1e-12;

/// A number and a bound on its distance from the exact one. At least one of the two is not finite
/// where the exact number does not exist, as for 1/0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ball {
    pub value: f64,
    pub error: f64,
}

impl Ball {
    const NONE: Self = Self {
        value: f64::NAN,
        error: f64::INFINITY,
    };

    /// A given number, without error.
    pub(crate) const fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// All numbers from `from` to `to`.
    pub(crate) fn between(from: f64, to: f64) -> Self {
        let value = 0.5 * (from + to);
        let error = (to - value).max(value - from);
        Self::of(value, error, 0.0)
    }

    pub(crate) fn is_known(self) -> bool {
        self.value.is_finite() && self.error.is_finite()
    }

    /// `error` comes from the operands, `rounding` from the operation.
    fn of(value: f64, error: f64, rounding: f64) -> Self {
        // The bound itself is rounded as well.
        let error = if error + rounding == 0.0 {
            0.0
        } else {
            (error + rounding) * (1.0 + 4.0 * f64::EPSILON) + f64::MIN_POSITIVE
        };
        Self { value, error }
    }

    pub(crate) fn negated(self) -> Self {
        Self {
            value: -self.value,
            ..self
        }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        let sum = self.value + other.value;
        // The exact rounding error: sums such as 1 + 0.5 or a − a have none.
        let other_part = sum - self.value;
        let lost = (self.value - (sum - other_part)) + (other.value - other_part);
        Self::of(sum, self.error + other.error, lost.abs())
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    pub(crate) fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.abs() * other.error
            + other.value.abs() * self.error
            + self.error * other.error;
        let exact = scales_exactly(self.value) || scales_exactly(other.value);
        Self::of(value, error, if exact { 0.0 } else { UNIT * value.abs() })
    }

    pub(crate) fn over(self, other: Self) -> Self {
        let least = other.value.abs() - other.error;
        if least.is_nan() || least <= 0.0 {
            return Self::NONE;
        }
        let value = self.value / other.value;
        let error = (self.error + value.abs() * other.error) / least;
        let exact = scales_exactly(other.value) || self.value == 0.0;
        Self::of(value, error, if exact { 0.0 } else { UNIT * value.abs() })
    }

    /// A power by repeated multiplication; a negative one is the inverse of the positive one.
    pub(crate) fn power(self, exponent: i32) -> Self {
        let (mut square, mut left) = (self, exponent.unsigned_abs());
        let mut product = Self::exact(1.0);
        while left > 0 {
            if left % 2 == 1 {
                product = product.times(square);
            }
            left /= 2;
            if left > 0 {
                square = square.times(square);
            }
        }
        if exponent < 0 {
            Self::exact(1.0).over(product)
        } else {
            product
        }
    }

    pub(crate) fn smaller(self, other: Self) -> Self {
        self.negated().larger(other.negated()).negated()
    }

    pub(crate) fn larger(self, other: Self) -> Self {
        let apart = (self.value - other.value).abs() > self.error + other.error;
        let first = self.value >= other.value;
        match (apart, first) {
            (true, true) => self,
            (true, false) => other,
            // Either may be the larger one.
            (false, _) => Self {
                value: self.value.max(other.value),
                error: self.error.max(other.error),
            },
        }
    }

    /// The value of a function that is not exact; `error` comes from the argument.
    fn of_function(value: f64, error: f64) -> Self {
        Self::of(value, error, UNIT * value.abs())
    }

    /// The square root of a number from 0 on.
    pub(crate) fn sqrt(self) -> Self {
        let Self { value: x, error } = self;
        let least = x - error;
        if least.is_nan() || x < 0.0 {
            return Self::NONE;
        }
        let root = x.sqrt();
        // Near 0 only the root of the error bounds the result.
        let spread = match error {
            0.0 => 0.0,
            _ if least > 0.0 => error / (root + least.sqrt()),
            _ => (x + error).sqrt(),
        };
        let exact = root == 0.0 || (root == 1.0 && x == 1.0);
        Self::of(root, spread, if exact { 0.0 } else { UNIT * root })
    }

    pub(crate) fn exp(self) -> Self {
        let value = exp(self.value);
        let exact = value == 0.0 || (value == 1.0 && self.value == 0.0);
        let rounding = if exact { 0.0 } else { UNIT * value };
        // A wide interval about a number far below 0 is one exponential, lest 0 meet infinity.
        let error = match self.error > WIDE {
            true => exp(self.value + self.error) * (1.0 + OF_ARGUMENT),
            false => value * expm1(self.error),
        };
        Self::of(value, error, rounding)
    }

    /// The natural logarithm of a number above 0.
    pub(crate) fn ln(self) -> Self {
        let least = self.value - self.error;
        if least.is_nan() || least <= 0.0 {
            return Self::NONE;
        }
        let value = ln(self.value);
        if value == 0.0 {
            return Self::of(value, self.error / least, 0.0);
        }
        Self::of_function(value, self.error / least)
    }

    pub(crate) fn sin(self) -> Self {
        match sin(self.value) {
            0.0 => Self::of(0.0, self.error.min(2.0), 0.0),
            value => Self::of_function(value, self.error.min(2.0)),
        }
    }

    pub(crate) fn cos(self) -> Self {
        let value = cos(self.value);
        let exact = value == 1.0 && self.value == 0.0;
        let rounding = if exact { 0.0 } else { UNIT * value.abs() };
        Self::of(value, self.error.min(2.0), rounding)
    }

    pub(crate) fn sinh(self) -> Self {
        let [odd, _] = hyperbolic(self);
        Self::of(odd.0, odd.1, SEVERAL * UNIT * odd.0.abs())
    }

    pub(crate) fn cosh(self) -> Self {
        let [_, even] = hyperbolic(self);
        Self::of(even.0, even.1, SEVERAL * UNIT * even.0)
    }

    pub(crate) fn tanh(self) -> Self {
        let value = tanh(self.value);
        let least = cosh((self.value.abs() - self.error).max(0.0));
        let error = (self.error / (least * least)).min(2.0);
        Self::of(value, error, SEVERAL * UNIT * value.abs())
    }

    /// 1/cosh; its slope, tanh/cosh, is at most a half.
    pub(crate) fn sech(self) -> Self {
        let value = 1.0 / cosh(self.value);
        let least = cosh((self.value.abs() - self.error).max(0.0));
        let slope = (1.0 / least).min(0.5);
        Self::of(value, self.error * slope, SEVERAL * UNIT * value)
    }

    pub(crate) fn atan(self) -> Self {
        let value = atan(self.value);
        let least = (self.value.abs() - self.error).max(0.0);
        let error = self.error / (1.0 + least * least);
        Self::of(value, error, SEVERAL * UNIT * value.abs())
    }

    /// A number from 0 on to any power. Of an interval that reaches below 0 the part from 0 on
    /// counts.
    pub(crate) fn raised(self, exponent: Self) -> Self {
        let Self { value: x, error } = self;
        let least = x - error;
        let value = pow(x, exponent.value);
        if least > 0.0 {
            let (part, p) = (error / x, exponent.value);
            // The slope p·z^(p − 1) is largest where |z| is largest, or where it is least.
            let of_base = if p >= 1.0 {
                expm1(p * ln_1p(part))
            } else {
                expm1(p * ln_1p(-part)).abs()
            };
            let of_exponent = expm1(exponent.error * (ln(x).abs() - ln_1p(-part)));
            let relative = of_base + of_exponent + of_base * of_exponent;
            return Self::of(value, value * relative, SEVERAL * UNIT * value);
        }
        if x >= 0.0 && exponent.value > 0.0 && exponent.error == 0.0 {
            let most = pow(x + error, exponent.value);
            return Self::of(value, value.max(most - value), SEVERAL * UNIT * most);
        }
        Self::NONE
    }
}

/// sinh and cosh, each with the error that comes from that of the argument.
fn hyperbolic(x: Ball) -> [(f64, f64); 2] {
    let (odd, even) = (sinh(x.value), cosh(x.value));
    let half = sinh(0.5 * x.error);
    let (near, far) = (2.0 * half * half, sinh(x.error));
    let of = |value: f64, slope: f64| (value, value.abs() * near + slope.abs() * far);
    [of(odd, even), of(even, odd)]
}

/// Whether a product with `x` is exact: 0 or a power of two, within the range of normal numbers.
fn scales_exactly(x: f64) -> bool {
    const MANTISSA: u64 = (1 << 52) - 1;
    x == 0.0 || (x.to_bits() & MANTISSA == 0 && (1e-30..1e30).contains(&x.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// What is between two numbers is within their interval, and so are functions of it.
        #[test]
        fn intervals_hold_what_is_between(from in -4.0..4.0_f64, width in 0.0..3.0_f64,
                                          part in 0.0..=1.0_f64, exponent in -2.5..2.5_f64) {
            let (wide, x) = (Ball::between(from, from + width), from + part * width);
            let cases = [
                (wide, x),
                (wide.times(wide), x * x),
                (wide.sqrt(), x.sqrt()),
                (wide.exp(), x.exp()),
                (wide.ln(), x.ln()),
                (wide.sin(), x.sin()),
                (wide.cos(), x.cos()),
                (wide.sinh(), x.sinh()),
                (wide.cosh(), x.cosh()),
                (wide.tanh(), x.tanh()),
                (wide.sech(), 1.0 / x.cosh()),
                (wide.atan(), x.atan()),
                (wide.raised(Ball::exact(exponent)), x.powf(exponent)),
            ];
            for (i, (found, exact)) in cases.into_iter().enumerate() {
                if found.is_known() && !exact.is_nan() {
                    let allowed = found.error + 8.0 * f64::EPSILON * exact.abs();
                    prop_assert!((found.value - exact).abs() <= allowed, "{i}: {found:?} {exact}");
                }
            }
        }
    }

    /// A perturbed number with a bound on the perturbation, and the exact number.
    fn about() -> impl Strategy<Value = (Ball, f64)> {
        (
            -8.0..8.0_f64,
            prop_oneof![Just(0.0), 1e-12..1e-3_f64],
            -1.0..1.0_f64,
        )
            .prop_map(|(exact, error, part)| {
                let value = exact + 0.9 * part * error;
                (Ball { value, error }, exact)
            })
    }

    proptest! {
        /// Results of the true numbers lie within the bounds of the results of nearby ones.
        #[test]
        fn bounds_hold((a, x) in about(), (b, y) in about(), n in -3..4_i32) {
            let cases = [
                (a.plus(b), x + y),
                (a.minus(b), x - y),
                (a.times(b), x * y),
                (a.over(b), x / y),
                (a.power(n), x.powi(n)),
                (a.larger(b), x.max(y)),
                (a.smaller(b), x.min(y)),
                (a.sqrt(), x.sqrt()),
                (a.exp(), x.exp()),
                (a.ln(), x.ln()),
                (a.sin(), x.sin()),
                (a.cos(), x.cos()),
                (a.sinh(), x.sinh()),
                (a.cosh(), x.cosh()),
                (a.tanh(), x.tanh()),
                (a.sech(), 1.0 / x.cosh()),
                (a.atan(), x.atan()),
                (a.raised(b), x.powf(y)),
                (a.raised(Ball::exact(y)), x.powf(y)),
            ];
            for (i, (found, exact)) in cases.into_iter().enumerate() {
                if found.is_known() {
                    // The comparison itself is rounded.
                    let allowed = found.error + 8.0 * f64::EPSILON * exact.abs();
                    prop_assert!((found.value - exact).abs() <= allowed, "{i}: {found:?} {exact}");
                }
            }
        }
    }

    #[test]
    fn what_is_exact_stays_so() {
        let [one, half, odd] = [1.0, 0.5, 0.1].map(Ball::exact);
        assert_eq!(one.plus(half), Ball::exact(1.5));
        assert_eq!(odd.minus(odd), Ball::exact(0.0));
        assert_eq!(odd.times(half), Ball::exact(0.05));
        assert_eq!(Ball::exact(2.0).power(10), Ball::exact(1024.0));
        assert_eq!(Ball::exact(0.0).exp().error, 0.0);
        assert!(odd.times(odd).error > 0.0 && odd.plus(one).error > 0.0);
    }

    #[test]
    fn exponentials_of_wide_intervals_are_known() {
        for (from, to) in [(-100.0, 0.0), (-7000.0, -100.0), (-7000.0, 1.0)] {
            let found = Ball::between(from, to).exp();
            assert!(found.is_known());
            for x in [from, 0.5 * (from + to), to] {
                assert!(
                    (f64::exp(x) - found.value).abs() <= found.error,
                    "{x} {found:?}"
                );
            }
            assert!(found.error <= 1.001 * f64::exp(to), "{found:?}");
        }
    }

    #[test]
    fn what_there_is_not_is_not_known() {
        let [zero, minus] = [0.0, -1.0].map(Ball::exact);
        let open = Ball {
            value: 1e-9,
            error: 1e-8,
        };
        for none in [
            minus.over(zero),
            minus.over(open),
            minus.sqrt(),
            minus.ln(),
            zero.ln(),
            open.ln(),
            zero.power(-1),
            Ball::exact(1e200).power(2),
            Ball::exact(1e3).exp(),
        ] {
            assert!(!none.is_known(), "{none:?}");
        }
    }
}
