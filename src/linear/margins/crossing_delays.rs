//! The delays at which a root lies on the line λ = −σ + iω, over boxes of frequencies, gains and
//! slopes or velocities.
//!
//! ```text
//! D = B − k A (1 − e^(−λτ)) = 0    ⇔    e^(−λτ) = 1 − B/(k A)                              (1)
//! τ_n = −(ln(1 − B/(k A)) + 2πi n)/λ,    which has to be real                              (2)
//! ```
//!
//! and beyond the letter, A holding e^(−λδ),
//!
//! ```text
//! D = B(1 − R e^(−λτ)) − k A (1 − e^(−λτ)) = 0    ⇔    e^(−λτ) = 1 − (1 − R) B/(k A − R B)  (3)
//! ```
//!
//! So the delay need not be searched for: in a box without it only the τ_n nearest to the delay of
//! a setting matter, and a long delay, which turns e^(−λτ) often, is no harder than a short one.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::affine::Affine;
use super::enclosure::{Parts, Point};
use crate::model::elementary::norm;

/// The delays (2) that are nearest to the one of a setting.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near<const V: usize> {
    /// The distance from the setting's delay within which no such delay lies.
    pub distance: f64,
    /// One such delay, in the middle of the box.
    pub tau: f64,
    /// How much each variable moves these delays.
    pub weights: [f64; V],
}

/// What is known of the delays of a box.
#[derive(Debug, Clone, Copy)]
pub(super) enum Delays<const V: usize> {
    /// The box is too wide for (2).
    Unknown,
    /// The delays at which a root may be on the line.
    Near(Near<V>),
}

/// How far a number is from its centre at most, along one direction.
fn reach<const V: usize>(z: &Affine<V>, along: impl Fn(Complex64) -> f64) -> f64 {
    let parts: f64 = z.part.iter().map(|g| along(*g).abs()).sum();
    parts * (1.0 + 1e-14) + z.rest
}

/// Between which values a number lies where it is real, of those that it may have.
///
/// Where Im z = 0, Re z is Re z + s Im z for any s: a good s makes one of the parts vanish.
fn where_real<const V: usize>(z: &Affine<V>) -> (f64, f64) {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut narrow = |s: f64| {
        let along = |g: Complex64| g.re + s * g.im;
        let size = (1.0 + s.abs()) * (z.centre.l1_norm() + z.spread());
        let rest = s.abs() * z.rest + 1e-14 * size;
        let (middle, off) = (along(z.centre), reach(z, along) + rest);
        low = low.max(middle - off);
        high = high.min(middle + off);
    };
    narrow(0.0);
    for g in z.part {
        if g.im != 0.0 {
            narrow(-g.re / g.im);
        }
    }
    (low, high)
}

impl<const V: usize> Point<V> {
    /// Whether e^(−λτ) by (1) or (3) may be at least this large.
    pub(super) fn reaches(&self, delayed: f64) -> bool {
        let Parts {
            open,
            feedback,
            memory,
            ..
        } = self.parts();
        let off = |z: &Affine<V>| z.spread() + z.rest;
        let delayed_part = feedback - open;
        let feedback = match memory {
            0.0 => feedback,
            memory => feedback - open.scaled(memory),
        };
        let most = norm(delayed_part.centre) + off(&delayed_part);
        let least = norm(feedback.centre) - off(&feedback);
        most * (1.0 + 1e-12) >= least * delayed
    }

    /// The delays (2) nearest to `tau`; those of the point do not matter.
    pub(super) fn crossing_delays(&self, tau: f64) -> Delays<V> {
        let Self {
            lambda, factor, b, ..
        } = *self;
        let one = Affine::constant(1.0.into());
        let Parts {
            mut open,
            mut feedback,
            memory,
            ..
        } = self.parts();
        if memory != 0.0 {
            feedback = feedback - open.scaled(memory);
            open = open.scaled(1.0 - memory);
        }
        let Some(inverse) = lambda.reciprocal() else {
            return Delays::Unknown;
        };
        let Some(weaker) = feedback.reciprocal() else {
            return Delays::Unknown;
        };
        let shifted = open * weaker;
        let Some(logarithm) = (one - shifted).logarithm() else {
            return Delays::Unknown;
        };
        let first = (logarithm * inverse).scaled(-1.0);
        let turn = inverse.turned().scaled(-TAU);
        let spacing = turn.centre.re;
        // Beyond the nearest ones they have to lie ever farther away.
        if reach(&turn, |z| z.re) >= spacing.abs() {
            return Delays::Unknown;
        }
        let nearest = ((tau - first.centre.re) / spacing).round();
        let mut near = Near {
            distance: f64::INFINITY,
            tau: first.centre.re + nearest * spacing,
            weights: [0.0; V],
        };
        for step in -2_i32..=2 {
            let number = nearest + f64::from(step);
            let delay = first + turn.scaled(number);
            let off = if step.abs() == 2 {
                // What lies beyond the last ones on either side is at least as far as they are.
                (delay.centre.re - tau).abs() - reach(&delay, |z| z.re)
            } else if delay.centre.im.abs() > reach(&delay, |z| z.im) {
                f64::INFINITY
            } else {
                let (low, high) = where_real(&delay);
                (low - tau).max(tau - high)
            };
            near.distance = near.distance.min(off.max(0.0));
            if step == 0 {
                near.weights = delay.part.map(|g| g.l1_norm());
            }
        }
        // A wide range of a law leaves no parts to judge by.
        if let Some(variable) = self.law {
            let size = |z: &Affine<V>| z.centre.l1_norm();
            let gains = factor.centre.re * (self.a_v.abs() * b.rest + self.a_n.rest);
            let by_law = size(&lambda) * b.rest + size(&shifted) * gains;
            near.weights[variable] += by_law * size(&weaker) * size(&inverse);
        }
        Delays::Near(near)
    }
}
