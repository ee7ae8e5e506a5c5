//! Numbers of twice the digits of an f64, as an unevaluated sum of two of them (Dekker 1971).
//!
//! Slow, and only for what the usual digits leave in doubt.

use num_complex::Complex64;

/// A bound on the relative error of a sum or a product here.
pub(super) const UNIT: f64 = 8.0 * f64::EPSILON * f64::EPSILON;

/// A bound on the relative error of an exponential.
pub(super) const EXPONENTIAL: f64 = 4096.0 * UNIT;

/// The exponent is halved so often before the series.
const HALVINGS: i32 = 8;
const PART: f64 = 1.0 / (1_u32 << HALVINGS) as f64;
const TERMS: u32 = 14;
const LN_2: Double = Double {
    high: std::f64::consts::LN_2,
    low: 2.319_046_813_846_299_6e-17,
};
/// π/2.
const QUARTER: Double = Double {
    high: std::f64::consts::FRAC_PI_2,
    low: 6.123_233_995_736_766e-17,
};

/// `high` + `low`, where `low` is less than the last digit of `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Double {
    pub high: f64,
    pub low: f64,
}

impl Double {
    pub(super) const ZERO: Self = Self {
        high: 0.0,
        low: 0.0,
    };

    /// `high` + `low`, where `high` is not the smaller one.
    #[inline]
    fn ordered(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self {
            high: sum,
            low: low - (sum - high),
        }
    }

    /// `a` + `b` without rounding.
    #[inline]
    pub(super) fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        Self {
            high,
            low: (a - (high - part)) + (b - part),
        }
    }

    /// `a` times `b` without rounding.
    #[inline]
    pub(super) fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self {
            high,
            low: a.mul_add(b, -high),
        }
    }

    #[inline]
    pub(super) fn plus(self, other: Self) -> Self {
        let high = Self::sum(self.high, other.high);
        let low = Self::sum(self.low, other.low);
        let once = Self::ordered(high.high, high.low + low.high);
        Self::ordered(once.high, once.low + low.low)
    }

    #[inline]
    pub(super) fn plus_number(self, other: f64) -> Self {
        let high = Self::sum(self.high, other);
        Self::ordered(high.high, high.low + self.low)
    }

    #[inline]
    pub(super) fn minus(self, other: Self) -> Self {
        self.plus(other.negative())
    }

    #[inline]
    pub(super) fn times(self, other: Self) -> Self {
        let high = Self::product(self.high, other.high);
        let cross = self.high.mul_add(other.low, self.low * other.high);
        Self::ordered(high.high, high.low + cross)
    }

    #[inline]
    pub(super) fn negative(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }

    /// The quotient by `other`, whose square neither overflows nor vanishes.
    pub(super) fn over(self, other: f64) -> Self {
        let first = self.high / other;
        let left = self.minus(Self::product(first, other));
        Self::ordered(first, left.value() / other)
    }

    /// The product with a power of two.
    #[inline]
    fn scaled(self, by: f64) -> Self {
        Self {
            high: by * self.high,
            low: by * self.low,
        }
    }

    /// The nearest f64.
    #[inline]
    pub(super) fn value(self) -> f64 {
        self.high + self.low
    }
}

impl From<f64> for Double {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

/// A complex number of twice the digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DoubleComplex {
    pub re: Double,
    pub im: Double,
}

impl DoubleComplex {
    pub(super) const ZERO: Self = Self {
        re: Double::ZERO,
        im: Double::ZERO,
    };

    #[inline]
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            re: self.re.plus(other.re),
            im: self.im.plus(other.im),
        }
    }

    #[inline]
    pub(super) fn minus(self, other: Self) -> Self {
        Self {
            re: self.re.minus(other.re),
            im: self.im.minus(other.im),
        }
    }

    #[inline]
    pub(super) fn times(self, other: Self) -> Self {
        let Self { re, im } = self;
        Self {
            re: re.times(other.re).minus(im.times(other.im)),
            im: re.times(other.im).plus(im.times(other.re)),
        }
    }

    /// The product with a real number.
    #[inline]
    pub(super) fn by(self, factor: f64) -> Self {
        Self {
            re: self.re.times(factor.into()),
            im: self.im.times(factor.into()),
        }
    }

    /// e^self, to within [`EXPONENTIAL`] of its size where |self| is less than 1000.
    pub(super) fn exp(self) -> Self {
        let twos = (self.re.high / LN_2.high).round();
        let quarters = (self.im.high / QUARTER.high).round();
        let left = |x: Double, n: f64, of: Double| x.minus(of.times(n.into())).scaled(PART);
        let small = Self {
            re: left(self.re, twos, LN_2),
            im: left(self.im, quarters, QUARTER),
        };
        // e^z = 1 + z(1 + z/2(1 + z/3(…))).
        let one = Self::from(Complex64::ONE);
        let mut sum = one;
        for n in (1..=TERMS).rev() {
            let next = small.times(sum);
            sum = one.plus(Self {
                re: next.re.over(f64::from(n)),
                im: next.im.over(f64::from(n)),
            });
        }
        for _ in 0..HALVINGS {
            sum = sum.times(sum);
        }
        let turned = match (quarters as i64).rem_euclid(4) {
            0 => sum,
            1 => Self {
                re: sum.im.negative(),
                im: sum.re,
            },
            2 => Self {
                re: sum.re.negative(),
                im: sum.im.negative(),
            },
            _ => Self {
                re: sum.im,
                im: sum.re.negative(),
            },
        };
        // A power of two within the range of f64, or 0 or infinity beyond.
        let size = f64::from_bits(((twos as i64 + 1023).clamp(0, 2047) as u64) << 52);
        Self {
            re: turned.re.scaled(size),
            im: turned.im.scaled(size),
        }
    }

    /// The nearest number of the usual digits.
    #[inline]
    pub(super) fn value(self) -> Complex64 {
        Complex64::new(self.re.value(), self.im.value())
    }
}

impl From<Complex64> for DoubleComplex {
    fn from(z: Complex64) -> Self {
        Self {
            re: z.re.into(),
            im: z.im.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (1 + ε)² − 1 − 2ε = ε², which the usual digits lose.
    #[test]
    fn what_cancels_keeps_its_digits() {
        let near = Double::from(1.0).plus_number(f64::EPSILON);
        let square = near.times(near);
        let left = square.plus_number(-1.0).plus_number(-2.0 * f64::EPSILON);
        assert_eq!(left.value(), f64::EPSILON * f64::EPSILON);
        // A third, thrice.
        let third = Double {
            high: 1.0 / 3.0,
            low: f64::EPSILON / 12.0,
        };
        let error = third.times(3.0.into()).plus_number(-1.0).value();
        assert!(error.abs() < UNIT, "{error}");
        let turned = DoubleComplex::from(Complex64::new(1e-20, 1.0));
        let turned = turned.plus(DoubleComplex::from(Complex64::new(1.0, 0.0)));
        let square = turned.times(turned);
        let expected = Complex64::new(2e-20, 2.0);
        assert!((square.value() - expected).norm() < 1e-30);
    }
    #[test]
    fn exponentials_have_all_digits() {
        let e = DoubleComplex::from(Complex64::ONE).exp();
        let known = Double {
            high: std::f64::consts::E,
            low: 1.445_646_891_729_250_2e-16,
        };
        assert!(e.re.minus(known).value().abs() < EXPONENTIAL);
        for z in [(0.3, 1.2), (-5.0, 40.0), (12.5, -7.7), (-1e-3, 3.1)] {
            let z = DoubleComplex::from(Complex64::new(z.0, z.1));
            let there_and_back = z.exp().times(DoubleComplex::ZERO.minus(z).exp());
            let off = there_and_back.minus(Complex64::ONE.into()).value();
            assert!(off.norm() < EXPONENTIAL, "{z:?} {off}");
        }
    }
}
