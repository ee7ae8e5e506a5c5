//! What a system is made of: its feedback form, e^(−στ) and 1 − e^(−στ), angles with their errors.

use num_complex::Complex64;

use super::polynomial::{At, Polynomial};
use crate::linear::rounded::Rounded;
use crate::model::Channel;
use crate::model::elementary::{arg, atan2, exp, expm1, sincos};

/// The feedback form D = B(1 − R E) − A e^(−λδ)(1 − E): without latency P = B − A and Q = A − R B.
#[derive(Debug, Clone, Copy)]
pub(super) struct FeedbackForm {
    /// B, the open loop.
    pub open: Polynomial,
    /// A, what is fed back.
    pub gain: Polynomial,
    /// R and δ.
    pub channel: Channel,
}

/// e^(−στ) and what is made of it without cancellation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Decay {
    /// κ = e^(−στ).
    pub kappa: Rounded,
    /// 1 − κ.
    pub lost: Rounded,
}

impl Decay {
    /// e^(−στ) on the imaginary axis, which is 1.
    pub(super) const NONE: Self = Self {
        kappa: Rounded {
            value: 1.0,
            error: 0.0,
        },
        lost: Rounded {
            value: 0.0,
            error: 0.0,
        },
    };

    /// κ = e^(−στ) for σ = `line`; none where it overflows.
    pub(super) fn new(line: f64, tau: f64) -> Option<Self> {
        if line == 0.0 || tau == 0.0 {
            return Some(Self::NONE);
        }
        let growth = expm1(-line * tau);
        let kappa = growth + 1.0;
        let error = f64::EPSILON * kappa * (1.0 + (line * tau).abs());
        kappa.is_finite().then_some(Self {
            kappa: Rounded {
                value: kappa,
                error: error + f64::EPSILON * kappa,
            },
            lost: Rounded {
                value: -growth,
                error: error.min(2.0 * f64::EPSILON * growth.abs() * (1.0 + (line * tau).abs()))
                    + f64::EPSILON * growth.abs(),
            },
        })
    }
}

/// 1 without error.
const ONE: Rounded = Rounded {
    value: 1.0,
    error: 0.0,
};

/// 1 − Rκ without cancellation: (1 − R) + R(1 − κ).
pub(super) fn remembered(memory: f64, decay: Decay) -> Rounded {
    if memory == 0.0 {
        return ONE;
    }
    Rounded::sum([1.0 - memory, memory * decay.lost.value])
        .plus_error(memory.abs() * decay.lost.error + f64::EPSILON)
}

/// An angle and a bound on its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Angle {
    /// The angle, in [−π, π].
    pub value: f64,
    pub error: f64,
}

impl Angle {
    /// The argument of −P Q* = |A|² + R|B|² − R A B* − B A* from the values of B and A: small
    /// angles keep their digits where A is large.
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

    /// The argument of `re` + i `im`, each with its error; none where the point may be the origin.
    pub(super) fn of(re: f64, im: f64, re_error: f64, im_error: f64) -> Option<Self> {
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

    /// The argument of −P Q* from the values of P and Q.
    pub(super) fn of_pair(p: At, q: At) -> Option<Self> {
        let relative = |at: At| at.error / (at.value.norm_sqr().sqrt() - at.error).max(0.0);
        let error = 2.0 * (relative(p) + relative(q)) + 4.0 * f64::EPSILON;
        (error < 1.0).then(|| Self {
            value: arg(-(p.value * q.value.conj())),
            error,
        })
    }
}

/// e^z.
pub(super) fn exponential(z: Complex64) -> Complex64 {
    let (sin, cos) = sincos(z.im);
    exp(z.re) * Complex64::new(cos, sin)
}

/// A e^(−λδ) with its derivatives from those of A.
pub(super) fn late(gain: [Complex64; 3], latency: f64, lambda: Complex64) -> [Complex64; 3] {
    if latency == 0.0 {
        return gain;
    }
    let [value, first, second] = gain;
    let by = exponential(-latency * lambda);
    [
        value * by,
        (first - latency * value) * by,
        (second + latency * (latency * value - 2.0 * first)) * by,
    ]
}
