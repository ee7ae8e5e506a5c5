//! Complex numbers within a radius of a real one.

use super::number::Number;
use crate::model::ball::Ball;
use crate::model::elementary::{cos, expm1, ln_1p, sinh};

/// All complex numbers that differ from a real one by no more than a radius. Sums, products and
/// quotients are those of [`Ball`]; functions are bounded off the real line as well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Disc(pub Ball);

impl Disc {
    const NONE: Self = Self(Ball {
        value: f64::NAN,
        error: f64::INFINITY,
    });

    /// A function with this value in the middle, from which it differs by at most `error`.
    fn about(middle: Ball, error: f64) -> Self {
        Self(Ball {
            value: middle.value,
            error: middle.error + error,
        })
    }

    fn middle(self) -> Ball {
        Ball::exact(self.0.value)
    }

    /// The share of the radius in the distance from 0; none where the disc reaches 0 or lies about
    /// a number below it.
    fn share(self) -> Option<f64> {
        let share = self.0.error / self.0.value;
        (0.0..1.0).contains(&share).then_some(share)
    }

    /// sinh r and cosh r − 1.
    fn growth(self) -> (f64, f64) {
        let half = sinh(0.5 * self.0.error);
        (sinh(self.0.error), 2.0 * half * half)
    }

    /// The least of |cosh z|² = sinh²(Re z) + cos²(Im z), or less.
    fn least_cosh_square(self) -> f64 {
        let Ball { value, error } = self.0;
        let real = sinh((value.abs() - error).max(0.0));
        let imaginary = match error < std::f64::consts::FRAC_PI_2 {
            true => cos(error),
            false => 0.0,
        };
        real * real + imaginary * imaginary
    }

    /// A function whose derivative is another one, whose own is plus or minus the first: sin and
    /// cos, sinh and cosh.
    fn circular(self, value: Ball, slope: Ball) -> Self {
        let (far, near) = self.growth();
        Self::about(value, value.value.abs() * near + slope.value.abs() * far)
    }
}

impl Number for Disc {
    fn of(value: f64) -> Self {
        Self(Ball::exact(value))
    }

    fn plus(self, other: Self) -> Self {
        Self(self.0.plus(other.0))
    }

    fn minus(self, other: Self) -> Self {
        Self(self.0.minus(other.0))
    }

    fn times(self, other: Self) -> Self {
        Self(self.0.times(other.0))
    }

    fn over(self, other: Self) -> Self {
        Self(self.0.over(other.0))
    }

    fn negated(self) -> Self {
        Self(self.0.negated())
    }

    /// (1 + u)^p − 1 is at most (1 − |u|)^−|p| − 1, since its series has no larger terms.
    fn power(self, exponent: f64) -> Self {
        let Some(share) = self.share() else {
            return Self::NONE;
        };
        let middle = self.middle().raised(Ball::exact(exponent));
        let off = expm1(-exponent.abs() * ln_1p(-share));
        Self::about(middle, middle.value * off)
    }

    fn exp(self) -> Self {
        Self(self.0.exp())
    }

    fn ln(self) -> Self {
        match self.share() {
            Some(share) => Self::about(self.middle().ln(), -ln_1p(-share)),
            None => Self::NONE,
        }
    }

    fn sin(self) -> Self {
        self.circular(self.middle().sin(), self.middle().cos())
    }

    fn cos(self) -> Self {
        self.circular(self.middle().cos(), self.middle().sin())
    }

    fn sinh(self) -> Self {
        self.circular(self.middle().sinh(), self.middle().cosh())
    }

    fn cosh(self) -> Self {
        self.circular(self.middle().cosh(), self.middle().sinh())
    }

    /// The slope is 1/cosh².
    fn tanh(self) -> Self {
        Self::about(
            self.middle().tanh(),
            self.0.error / self.least_cosh_square(),
        )
    }

    /// It is no farther from its middle than both are from 0 together.
    fn sech(self) -> Self {
        let middle = self.middle().sech();
        Self::about(middle, middle.value + 1.0 / self.least_cosh_square().sqrt())
    }

    /// The slope is 1/((z − i)(z + i)).
    fn atan(self) -> Self {
        let Ball { value, error } = self.0;
        let least = (1.0 + value * value).sqrt() - error;
        match least > 0.0 {
            true => Self::about(self.middle().atan(), error / (least * least)),
            false => Self::NONE,
        }
    }

    fn is_zero(self) -> bool {
        self.0.is_zero()
    }
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Functions of complex numbers in a disc lie within the disc of the function.
        #[test]
        fn functions_of_discs_hold(centre in -4.0..6.0_f64, radius in 1e-6..2.0_f64,
                                   angle in 0.0..6.3_f64, part in 0.0..1.0_f64,
                                   exponent in -2.5..2.5_f64) {
            let z = Complex64::from_polar(part * radius, angle) + centre;
            let disc = Disc(Ball { value: centre, error: radius });
            let cases = [
                (disc.power(exponent), z.powf(exponent)),
                (disc.exp(), z.exp()),
                (disc.ln(), z.ln()),
                (disc.sin(), z.sin()),
                (disc.cos(), z.cos()),
                (disc.sinh(), z.sinh()),
                (disc.cosh(), z.cosh()),
                (disc.tanh(), z.tanh()),
                (disc.sech(), 1.0 / z.cosh()),
                (disc.atan(), z.atan()),
                (disc.times(disc), z * z),
                (Disc::of(1.0).over(disc), 1.0 / z),
            ];
            for (i, (Disc(found), exact)) in cases.into_iter().enumerate() {
                if found.is_known() {
                    let off = (exact - found.value).norm();
                    let allowed = found.error + 1e-13 * (1.0 + exact.norm());
                    prop_assert!(off <= allowed, "{i}: {off} {found:?}");
                }
            }
        }
    }
}
