//! Complex numbers that depend on a few variables, each known to an interval: affine arithmetic.
//!
//! ```text
//! z = c + Σ g_i ε_i + ρ,   −1 ≤ ε_i ≤ 1,   |ρ| ≤ r                                          (1)
//! ```
//!
//! Unlike intervals, numbers of this form know what they have in common, so a difference of equals
//! is small, and they err by the square of the widths. Rounding goes into r. No crate does this for
//! complex numbers; those for intervals bind to C or to some processors, and these files are plain
//! Rust that also runs in a browser.
//!
//! Source: J. Stolfi and L. H. de Figueiredo, *Self-validated numerical methods and applications*
//! (1997).

use std::ops::{Add, Mul, Sub};

use num_complex::Complex64;

use crate::model::elementary::{arg, exp, expm1, ln, sincos};
use crate::model::groups::Ring;

/// The rounding of one operation below, of its largest term: a generous count.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Numbers that differ by more than this part of their centre are too wide to divide by.
const NARROW: f64 = 0.75;

/// A number (1) of `V` variables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Affine<const V: usize> {
    /// c.
    pub centre: Complex64,
    /// g.
    pub part: [Complex64; V],
    /// r.
    pub rest: f64,
}

/// |z|, for numbers far from overflow.
#[inline(always)]
fn size(z: Complex64) -> f64 {
    z.norm_sqr().sqrt()
}

impl<const V: usize> Affine<V> {
    pub(super) const ZERO: Complex64 = Complex64::new(0.0, 0.0);

    /// A number that is known.
    #[inline]
    pub(super) fn constant(centre: Complex64) -> Self {
        Self {
            centre,
            part: [Self::ZERO; V],
            rest: 0.0,
        }
    }

    /// A real number between both, which is variable number `variable`.
    #[inline]
    pub(super) fn between((from, to): (f64, f64), variable: usize) -> Self {
        let middle = 0.5 * (from + to);
        let mut number = Self::constant(middle.into());
        number.part[variable] = (0.5 * (to - from)).into();
        number.rest = ROUNDING * (from.abs() + to.abs());
        number
    }

    /// i times this number.
    #[inline]
    pub(super) fn turned(self) -> Self {
        let turn = |z: Complex64| Complex64::new(-z.im, z.re);
        Self {
            centre: turn(self.centre),
            part: self.part.map(turn),
            rest: self.rest,
        }
    }

    #[inline]
    pub(super) fn scaled(self, by: f64) -> Self {
        Self {
            centre: by * self.centre,
            part: self.part.map(|g| by * g),
            rest: (1.0 + ROUNDING) * by.abs() * self.rest + ROUNDING * by.abs() * self.spread(),
        }
    }

    /// Σ|g|: how far it may be from its centre, but for r.
    #[inline]
    pub(super) fn spread(&self) -> f64 {
        self.part.iter().map(|g| size(*g)).sum()
    }

    /// e to the power of this number.
    #[inline]
    pub(super) fn exponential(self) -> Self {
        let change = self.spread() + self.rest;
        if change > 1.0 {
            // Too wide for a series: all that is known is its size.
            let real: f64 = self.part.iter().map(|g| g.re.abs()).sum();
            let rest = (1.0 + ROUNDING) * exp(self.centre.re + real + self.rest);
            return Self {
                rest,
                ..Self::constant(Self::ZERO)
            };
        }
        let growth = exp(self.centre.re);
        let (sin, cos) = sincos(self.centre.im);
        let centre = Complex64::new(growth * cos, growth * sin);
        // e^u − 1 − u for |u| up to `change`.
        let curved = expm1(change) - change;
        let rounding = ROUNDING * (1.0 + self.centre.im.abs() + self.centre.re.abs());
        Self {
            centre,
            part: self.part.map(|g| centre * g),
            rest: (1.0 + ROUNDING) * growth * (self.rest + curved.max(0.0) + rounding),
        }
    }

    /// 1 over this number; none where it may come near 0.
    pub(super) fn reciprocal(self) -> Option<Self> {
        let inverse = 1.0 / self.centre;
        let change = (self.spread() + self.rest) * size(inverse);
        // 1/(1 + u) − 1 + u is u²/(1 + u).
        let curved = change * change / (1.0 - change);
        let near = size(inverse);
        (change < NARROW).then(|| Self {
            centre: inverse,
            part: self.part.map(|g| -(g * inverse) * inverse),
            rest: (1.0 + ROUNDING) * near * (near * self.rest + curved + ROUNDING),
        })
    }

    /// A logarithm of this number, continuous over all of it; none where it may come near 0.
    pub(super) fn logarithm(self) -> Option<Self> {
        let inverse = 1.0 / self.centre;
        let change = (self.spread() + self.rest) * size(inverse);
        // |ln(1 + u) − u| is u²/(2(1 − |u|)) at most.
        let curved = 0.5 * change * change / (1.0 - change);
        let centre = Complex64::new(0.5 * ln(self.centre.norm_sqr()), arg(self.centre));
        (change < NARROW).then(|| Self {
            centre,
            part: self.part.map(|g| g * inverse),
            rest: (1.0 + ROUNDING) * (size(inverse) * self.rest + curved)
                + ROUNDING * (1.0 + centre.l1_norm()),
        })
    }

    /// Whether it can be 0.
    #[inline]
    pub(super) fn may_vanish(&self) -> bool {
        let beyond = |direction: Complex64| {
            let along = |z: Complex64| (z.re * direction.re + z.im * direction.im).abs();
            let reach: f64 = self.part.iter().map(|g| along(*g)).sum();
            let far = along(self.centre);
            far > (reach + self.rest * size(direction)) * (1.0 + ROUNDING) + ROUNDING * far
        };
        // A zonotope's sides are along its parts: one of their normals tells, or the way to it.
        let normal = |g: &Complex64| Complex64::new(-g.im, g.re);
        !(beyond(self.centre) || self.part.iter().any(|g| beyond(normal(g))))
    }
}

impl<const V: usize> Ring for Affine<V> {
    #[inline]
    fn plus_one(self) -> Self {
        self + Self::constant(1.0.into())
    }

    #[inline]
    fn scaled(self, by: f64) -> Self {
        self.scaled(by)
    }
}

impl<const V: usize> Add for Affine<V> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let mut sum = self;
        sum.centre += other.centre;
        for (s, o) in sum.part.iter_mut().zip(other.part) {
            *s += o;
        }
        sum.rest = (1.0 + ROUNDING) * (self.rest + other.rest)
            + ROUNDING * (sum.centre.l1_norm() + self.spread() + other.spread());
        sum
    }
}

impl<const V: usize> Sub for Affine<V> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + Self {
            centre: -other.centre,
            part: other.part.map(|g| -g),
            rest: other.rest,
        }
    }
}

impl<const V: usize> Mul for Affine<V> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.centre, other.centre);
        let mut part = [Self::ZERO; V];
        for (i, p) in part.iter_mut().enumerate() {
            *p = a * other.part[i] + b * self.part[i];
        }
        let (near, far) = (self.spread() + self.rest, other.spread() + other.rest);
        let (size_a, size_b) = (size(a), size(b));
        let rounding = ROUNDING * (size_a + near) * (size_b + far);
        Self {
            centre: a * b,
            part,
            rest: (1.0 + ROUNDING)
                * (size_a * other.rest + size_b * self.rest + near * far + rounding),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    type Number = Affine<2>;

    fn at(z: &Number, e: [f64; 2]) -> Complex64 {
        z.centre + z.part[0] * e[0] + z.part[1] * e[1]
    }

    prop_compose! {
        fn numbers()(c in -2.0..2.0, d in -2.0..2.0, g in prop::array::uniform4(-0.2..0.2),
                     rest in 0.0..0.1) -> Number {
            Number {
                centre: Complex64::new(c, d),
                part: [Complex64::new(g[0], g[1]), Complex64::new(g[2], g[3])],
                rest,
            }
        }
    }

    proptest! {
        /// Whatever the variables and the rests are, the result of the numbers lies in that of the
        /// enclosures.
        #[test]
        fn results_are_enclosed(x in numbers(), y in numbers(),
                                e in prop::array::uniform2(-1.0..1.0),
                                turn in 0.0..6.3, part in 0.0..1.0) {
            let rest = |z: &Number| Complex64::from_polar(part * z.rest, turn);
            let (a, b) = (at(&x, e) + rest(&x), at(&y, e) + rest(&y));
            for (exact, enclosure) in [
                (a + b, x + y),
                (a - b, x - y),
                (a * b, x * y),
                (a.exp(), x.exponential()),
                ((3.0 * a).exp(), x.scaled(3.0).exponential()),
                (Complex64::i() * a, x.turned()),
            ]
            .into_iter()
            .chain(x.reciprocal().map(|found| (1.0 / a, found)))
            .chain(x.logarithm().map(|found| {
                // Of the logarithms, the one on the way from the centre.
                let from = found.centre.im;
                let turns = ((from - a.ln().im) / (2.0 * std::f64::consts::PI)).round();
                (a.ln() + Complex64::i() * (2.0 * std::f64::consts::PI * turns), found)
            })) {
                let off = (exact - at(&enclosure, e)).norm();
                prop_assert!(off <= enclosure.rest, "{off} {}", enclosure.rest);
            }
        }

        /// What contains 0 is never said to be free of it.
        #[test]
        fn zeros_are_never_excluded(x in numbers(), e in prop::array::uniform2(-1.0..1.0),
                                    turn in 0.0..6.3, part in 0.0..1.0) {
            let value = at(&x, e) + Complex64::from_polar(part * x.rest, turn);
            let through_zero = Number { centre: x.centre - value, ..x };
            prop_assert!(through_zero.may_vanish());
        }
    }

    #[test]
    fn what_is_far_from_zero_is_told_from_it() {
        // Long and thin, passing beside 0.
        let long = Number {
            centre: Complex64::new(0.0, 0.1),
            part: [Complex64::new(5.0, 0.0), Complex64::new(0.0, 0.05)],
            rest: 0.04,
        };
        assert!(!long.may_vanish());
        assert!(Number { rest: 0.06, ..long }.may_vanish());
        let same = long - long;
        assert!(same.spread() == 0.0 && same.rest > 0.08 && same.rest < 0.081);
    }
}
