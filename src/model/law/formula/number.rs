//! What a formula is evaluated with: numbers, numbers with their first two derivatives, intervals
//! and discs have the same operations.

use crate::model::ball::Ball;
use crate::model::elementary::{atan, cos, cosh, exp, ln, pow, sin, sinh, tanh};

/// A number, or what stands for one or for many of them.
pub(super) trait Number: Copy {
    /// A known number.
    fn of(value: f64) -> Self;
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn over(self, other: Self) -> Self;
    fn negated(self) -> Self;
    /// To a power that is known and need not be whole.
    fn power(self, exponent: f64) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    fn sinh(self) -> Self;
    fn cosh(self) -> Self;
    fn tanh(self) -> Self;
    /// 1/cosh.
    fn sech(self) -> Self;
    fn atan(self) -> Self;
    /// Whether it is exactly 0.
    fn is_zero(self) -> bool;
}

impl Number for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn plus(self, other: Self) -> Self {
        self + other
    }

    fn minus(self, other: Self) -> Self {
        self - other
    }

    fn times(self, other: Self) -> Self {
        self * other
    }

    fn over(self, other: Self) -> Self {
        self / other
    }

    fn negated(self) -> Self {
        -self
    }

    fn power(self, exponent: f64) -> Self {
        pow(self, exponent)
    }

    fn exp(self) -> Self {
        exp(self)
    }

    fn ln(self) -> Self {
        ln(self)
    }

    fn sin(self) -> Self {
        sin(self)
    }

    fn cos(self) -> Self {
        cos(self)
    }

    fn sinh(self) -> Self {
        sinh(self)
    }

    fn cosh(self) -> Self {
        cosh(self)
    }

    fn tanh(self) -> Self {
        tanh(self)
    }

    fn sech(self) -> Self {
        1.0 / cosh(self)
    }

    fn atan(self) -> Self {
        atan(self)
    }

    fn is_zero(self) -> bool {
        self == 0.0
    }
}

/// A function of the speed at one place: its value and its first two derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet<T> {
    pub value: T,
    pub slope: T,
    pub bend: T,
}

impl<T: Number> Jet<T> {
    /// The speed itself.
    pub(super) fn speed(at: T) -> Self {
        Self {
            value: at,
            slope: T::of(1.0),
            bend: T::of(0.0),
        }
    }

    /// f(self) from the value and the first two derivatives of f there.
    fn through(self, [value, slope, bend]: [T; 3]) -> Self {
        let square = self.slope.times(self.slope);
        Self {
            value,
            slope: slope.times(self.slope),
            bend: bend.times(square).plus(slope.times(self.bend)),
        }
    }
}

impl<T: Number> Number for Jet<T> {
    fn of(value: f64) -> Self {
        Self {
            value: T::of(value),
            slope: T::of(0.0),
            bend: T::of(0.0),
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            value: self.value.plus(other.value),
            slope: self.slope.plus(other.slope),
            bend: self.bend.plus(other.bend),
        }
    }

    fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    fn times(self, other: Self) -> Self {
        let cross = self.slope.times(other.slope);
        Self {
            value: self.value.times(other.value),
            slope: self
                .slope
                .times(other.value)
                .plus(self.value.times(other.slope)),
            bend: self
                .bend
                .times(other.value)
                .plus(cross.plus(cross))
                .plus(self.value.times(other.bend)),
        }
    }

    fn over(self, other: Self) -> Self {
        let inverse = T::of(1.0).over(other.value);
        if inverse.is_zero() {
            // Beyond all numbers a divisor leaves nothing.
            return Self::of(0.0);
        }
        let square = inverse.times(inverse);
        let bend = T::of(2.0).times(square).times(inverse);
        self.times(other.through([inverse, square.negated(), bend]))
    }

    fn negated(self) -> Self {
        Self {
            value: self.value.negated(),
            slope: self.slope.negated(),
            bend: self.bend.negated(),
        }
    }

    fn power(self, exponent: f64) -> Self {
        let of = |lower: f64, factor: f64| match factor == 0.0 {
            true => T::of(0.0),
            false => T::of(factor).times(self.value.power(exponent - lower)),
        };
        let second = exponent * (exponent - 1.0);
        self.through([of(0.0, 1.0), of(1.0, exponent), of(2.0, second)])
    }

    fn exp(self) -> Self {
        let value = self.value.exp();
        self.through([value, value, value])
    }

    fn ln(self) -> Self {
        let inverse = T::of(1.0).over(self.value);
        let bend = inverse.times(inverse).negated();
        self.through([self.value.ln(), inverse, bend])
    }

    fn sin(self) -> Self {
        let (sin, cos) = (self.value.sin(), self.value.cos());
        self.through([sin, cos, sin.negated()])
    }

    fn cos(self) -> Self {
        let (sin, cos) = (self.value.sin(), self.value.cos());
        self.through([cos, sin.negated(), cos.negated()])
    }

    fn sinh(self) -> Self {
        let (sinh, cosh) = (self.value.sinh(), self.value.cosh());
        self.through([sinh, cosh, sinh])
    }

    fn cosh(self) -> Self {
        let (sinh, cosh) = (self.value.sinh(), self.value.cosh());
        self.through([cosh, sinh, cosh])
    }

    fn tanh(self) -> Self {
        let (tanh, sech) = (self.value.tanh(), self.value.sech());
        // 1/cosh², which rounding cannot make negative.
        let slope = sech.times(sech);
        let bend = T::of(-2.0).times(tanh).times(slope);
        self.through([tanh, slope, bend])
    }

    fn sech(self) -> Self {
        let (tanh, sech) = (self.value.tanh(), self.value.sech());
        let slope = sech.times(tanh).negated();
        let bend = sech.times(tanh.times(tanh).minus(sech.times(sech)));
        self.through([sech, slope, bend])
    }

    fn atan(self) -> Self {
        let slope = T::of(1.0).over(T::of(1.0).plus(self.value.times(self.value)));
        let bend = T::of(-2.0).times(self.value).times(slope).times(slope);
        self.through([self.value.atan(), slope, bend])
    }

    fn is_zero(self) -> bool {
        self.value.is_zero()
    }
}

/// Every real number of an interval.
impl Number for Ball {
    fn of(value: f64) -> Self {
        Self::exact(value)
    }

    fn plus(self, other: Self) -> Self {
        self.plus(other)
    }

    fn minus(self, other: Self) -> Self {
        self.minus(other)
    }

    fn times(self, other: Self) -> Self {
        self.times(other)
    }

    fn over(self, other: Self) -> Self {
        self.over(other)
    }

    fn negated(self) -> Self {
        self.negated()
    }

    fn power(self, exponent: f64) -> Self {
        self.raised(Self::exact(exponent))
    }

    fn exp(self) -> Self {
        self.exp()
    }

    fn ln(self) -> Self {
        self.ln()
    }

    fn sin(self) -> Self {
        self.sin()
    }

    fn cos(self) -> Self {
        self.cos()
    }

    fn sinh(self) -> Self {
        self.sinh()
    }

    fn cosh(self) -> Self {
        self.cosh()
    }

    fn tanh(self) -> Self {
        self.tanh()
    }

    fn sech(self) -> Self {
        self.sech()
    }

    fn atan(self) -> Self {
        self.atan()
    }

    fn is_zero(self) -> bool {
        self.value == 0.0 && self.error == 0.0
    }
}
