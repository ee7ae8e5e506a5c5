//! Numbers computed from a system's parameters, each with a bound on its error.

use super::tape::Function;
use crate::model::elementary::{cos, exp, expm1, ln, sin};

/// The relative rounding error of one operation: libm errs by less than a unit in the last place.
const UNIT: f64 = f64::EPSILON;

/// A number and a bound on its distance from the exact one. At least one of the two is not finite
/// where the exact number does not exist, as for 1/0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounded {
    pub value: f64,
    pub error: f64,
}

impl Bounded {
    const NONE: Self = Self {
        value: f64::NAN,
        error: f64::INFINITY,
    };

    /// A given number, without error.
    pub(super) const fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    pub(super) fn is_known(self) -> bool {
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

    pub(super) fn negated(self) -> Self {
        Self {
            value: -self.value,
            ..self
        }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        let sum = self.value + other.value;
        // The exact rounding error: sums such as 1 + 0.5 or a − a have none.
        let other_part = sum - self.value;
        let lost = (self.value - (sum - other_part)) + (other.value - other_part);
        Self::of(sum, self.error + other.error, lost.abs())
    }

    pub(super) fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    pub(super) fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.abs() * other.error
            + other.value.abs() * self.error
            + self.error * other.error;
        let exact = scales_exactly(self.value) || scales_exactly(other.value);
        Self::of(value, error, if exact { 0.0 } else { UNIT * value.abs() })
    }

    pub(super) fn over(self, other: Self) -> Self {
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
    pub(super) fn power(self, exponent: i32) -> Self {
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

    pub(super) fn smaller(self, other: Self) -> Self {
        self.negated().larger(other.negated()).negated()
    }

    pub(super) fn larger(self, other: Self) -> Self {
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

    pub(super) fn function(self, function: Function) -> Self {
        let Self { value: x, error } = self;
        let (value, error) = match function {
            Function::Sqrt => {
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
                (root, spread)
            }
            Function::Exp => (exp(x), exp(x) * expm1(error)),
            Function::Log => {
                let least = x - error;
                if least.is_nan() || least <= 0.0 {
                    return Self::NONE;
                }
                (ln(x), error / least)
            }
            Function::Sin => (sin(x), error),
            Function::Cos => (cos(x), error),
        };
        let exact = value == 0.0 || (value == 1.0 && x.abs() <= 1.0 && x == x.trunc());
        Self::of(value, error, if exact { 0.0 } else { UNIT * value.abs() })
    }
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

    /// A perturbed number with a bound on the perturbation, and the exact number.
    fn about() -> impl Strategy<Value = (Bounded, f64)> {
        (
            -8.0..8.0_f64,
            prop_oneof![Just(0.0), 1e-12..1e-3_f64],
            -1.0..1.0_f64,
        )
            .prop_map(|(exact, error, part)| {
                let value = exact + 0.9 * part * error;
                (Bounded { value, error }, exact)
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
                (a.function(Function::Sqrt), x.sqrt()),
                (a.function(Function::Exp), x.exp()),
                (a.function(Function::Log), x.ln()),
                (a.function(Function::Sin), x.sin()),
                (a.function(Function::Cos), x.cos()),
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
        let [one, half, odd] = [1.0, 0.5, 0.1].map(Bounded::exact);
        assert_eq!(one.plus(half), Bounded::exact(1.5));
        assert_eq!(odd.minus(odd), Bounded::exact(0.0));
        assert_eq!(odd.times(half), Bounded::exact(0.05));
        assert_eq!(Bounded::exact(2.0).power(10), Bounded::exact(1024.0));
        assert_eq!(Bounded::exact(0.0).function(Function::Exp).error, 0.0);
        assert!(odd.times(odd).error > 0.0 && odd.plus(one).error > 0.0);
    }

    #[test]
    fn what_there_is_not_is_not_known() {
        let [zero, minus] = [0.0, -1.0].map(Bounded::exact);
        let open = Bounded {
            value: 1e-9,
            error: 1e-8,
        };
        for none in [
            minus.over(zero),
            minus.over(open),
            minus.function(Function::Sqrt),
            minus.function(Function::Log),
            zero.function(Function::Log),
            open.function(Function::Log),
            zero.power(-1),
            Bounded::exact(1e200).power(2),
            Bounded::exact(1e3).function(Function::Exp),
        ] {
            assert!(!none.is_known(), "{none:?}");
        }
    }
}
