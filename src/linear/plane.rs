//! A characteristic function over a plane of two parameters p and q, for code that follows curves
//! in it.
//!
//! One of the two, both or neither may be delays. λ is in the inverse of the plane's own unit of
//! time, in which delays are given too.

use num_complex::Complex64;

use super::curves::{Vertex, Window};
use crate::model::elementary;

/// D has vanished where |D| is within this many of its rounding bounds.
const ROUNDINGS: f64 = 64.0;

/// D at one λ, in the units of the plane.
#[derive(Debug, Clone, Copy)]
pub struct CharacteristicValue {
    /// D.
    pub value: Complex64,
    /// ∂D/∂λ.
    pub by_lambda: Complex64,
    /// ∂²D/∂λ².
    pub by_lambda_twice: Complex64,
    /// Bound on the rounding error of `value`.
    pub rounding: f64,
}

/// D and its derivatives at one point of the plane and one λ, in the units of the plane.
#[derive(Debug, Clone, Copy)]
pub struct Local {
    /// D.
    pub value: Complex64,
    /// ∂D/∂λ.
    pub by_lambda: Complex64,
    /// ∂²D/∂λ².
    pub by_lambda_twice: Complex64,
    /// ∂D/∂p.
    pub by_p: Complex64,
    /// ∂D/∂q.
    pub by_q: Complex64,
    /// Bound on the rounding error of `value`.
    pub rounding: f64,
}

impl Local {
    /// Whether D is 0 within rounding.
    #[must_use]
    pub fn vanishes(&self) -> bool {
        elementary::norm(self.value) <= ROUNDINGS * self.rounding
    }

    /// The rows of Re D and Im D over (p, q, ω).
    #[must_use]
    pub(crate) fn rows(&self) -> [[f64; 3]; 2] {
        let by_omega = Complex64::i() * self.by_lambda;
        [
            [self.by_p.re, self.by_q.re, by_omega.re],
            [self.by_p.im, self.by_q.im, by_omega.im],
        ]
    }
}

/// Bounds at one point for steps along q.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// The highest frequency that a root on the line can have; 0 where no root can lie there.
    pub highest: f64,
    /// Whether some root is right of the line here and at every larger q.
    pub enough: bool,
}

/// A characteristic function over the window of a plane. Points beyond the window are taken for
/// the nearest ones in it.
pub trait Plane {
    /// The window.
    fn window(&self) -> &Window;

    /// The unit of time √(M/κ) at a point, or another natural unit of time.
    fn unit(&self, p: f64, q: f64) -> f64;

    /// The sum of all delays at a point.
    fn delay(&self, p: f64, q: f64) -> f64;

    /// Which of p and q are delays.
    fn delays(&self) -> [bool; 2];

    /// D at λ.
    fn at(&self, p: f64, q: f64, lambda: Complex64) -> CharacteristicValue;

    /// D and its derivatives at `v`, on the line Re λ = −`sigma`. Beyond the window, where the
    /// model may not be valid, D is continued linearly.
    fn local(&self, v: Vertex, sigma: f64) -> Local;

    /// The number of roots right of the line `beside` units to the right of Re λ = −`sigma`; none
    /// where that is undecided or infinite.
    fn right_of(&self, p: f64, q: f64, sigma: f64, beside: f64) -> Option<u64>;

    /// The frequencies above 0 at which a root may lie on the line.
    fn frequencies(&self, p: f64, q: f64, sigma: f64) -> Vec<f64>;

    /// Bounds of the roots on the line, for steps along q.
    fn band(&self, p: f64, q: f64, sigma: f64) -> Band;

    /// Whether nobody waits for the curves any more: then following them ends soon, and what was
    /// found means nothing.
    fn stopped(&self) -> bool;
}
