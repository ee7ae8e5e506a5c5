//! The angle by which P and Q differ at a point, with a bound on its error.

use super::polynomial::At;
use crate::model::elementary::{arg, atan2};

/// An angle and a bound on its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Angle {
    /// In [−π, π].
    pub value: f64,
    pub error: f64,
}

impl Angle {
    /// Of −P Q* = |A|² + R|B|² − R A B* − B A* from the values of B and A: small angles keep their
    /// digits where A is large.
    pub(super) fn of_feedback(b: At, a: At, memory: f64) -> Option<Self> {
        let both = a.value * b.value.conj();
        let (a_size, b_size) = (a.value.norm_sqr(), b.value.norm_sqr());
        let re = a_size + memory * b_size - (1.0 + memory) * both.re;
        let im = (1.0 - memory) * both.im;
        let size = (a_size * b_size).sqrt();
        let both_error = a_size.sqrt() * b.error
            + b_size.sqrt() * a.error
            + a.error * b.error
            + 4.0 * f64::EPSILON * size;
        let squares = 2.0 * a_size.sqrt() * a.error + a.error * a.error;
        let others = 2.0 * b_size.sqrt() * b.error + b.error * b.error;
        let re_error = squares
            + others
            + 2.0 * both_error
            + 4.0 * f64::EPSILON * (a_size + b_size + 2.0 * size);
        Self::of(re, im, re_error, 2.0 * both_error)
    }

    /// Of `re` + i `im`, each with its error; none where the point may be the origin.
    fn of(re: f64, im: f64, re_error: f64, im_error: f64) -> Option<Self> {
        let size = (re * re + im * im).sqrt();
        if re_error + im_error >= 0.5 * size {
            return None;
        }
        let aside = (re.abs() * im_error + im.abs() * re_error) / (size * size);
        let value = atan2(im, re);
        Some(Self {
            value,
            error: 4.0 * aside + 4.0 * f64::EPSILON * value.abs(),
        })
    }

    /// Of −P Q* from the values of P and Q.
    pub(super) fn of_pair(p: At, q: At) -> Option<Self> {
        let relative = |at: At| at.error / (at.value.norm_sqr().sqrt() - at.error).max(0.0);
        let error = 2.0 * (relative(p) + relative(q)) + 4.0 * f64::EPSILON;
        (error < 1.0).then(|| Self {
            value: arg(-(p.value * q.value.conj())),
            error,
        })
    }
}
