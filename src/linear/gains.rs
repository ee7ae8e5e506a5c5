//! The crossing curve with one gain given and the other expressed by the crossing frequency, as in
//! the letter.
//!
//! The letter's Eq. (4) is linear in both gains. With x = ω²,
//!
//! ```text
//! a_v = [(1 − x)² + b² x − 2 a_n (1 − x)] / (2b)                                           (1)
//! a_n = [(1 − x)² + b² x − 2 b a_v] / (2 (1 − x))                                          (2)
//! ```
//!
//! For pure control (the other gain zero) these are the letter's boundary curves of Fig. 2.

use super::crossing::{Crossing, Crossings};
use crate::model::Groups;

/// The velocity gain a_v at which a pair crosses at the frequency `omega`, for given `b` ≠ 0 and
/// a_n: equation (1).
///
/// At b = 0 the crossing frequency does not depend on a_v, and the result is infinite or NaN.
#[must_use]
pub fn velocity_gain(omega: f64, b: f64, a_n: f64) -> f64 {
    let x = omega * omega;
    ((1.0 - x) * (1.0 - x - 2.0 * a_n) + b * b * x) / (2.0 * b)
}

/// The load gain a_n at which a pair crosses at the frequency `omega` ≠ 1, for given `b` and a_v:
/// equation (2).
///
/// At ω = 1 the crossing condition does not depend on a_n, and the result is infinite or NaN.
#[must_use]
pub fn load_gain(omega: f64, b: f64, a_v: f64) -> f64 {
    let x = omega * omega;
    ((1.0 - x) * (1.0 - x) + b * b * x - 2.0 * b * a_v) / (2.0 * (1.0 - x))
}

/// The crossing of `groups` whose frequency is nearest to `omega`, or none where nothing crosses.
///
/// Together with [`velocity_gain`] or [`load_gain`] this gives the delays of the letter's Eq. (5)
/// along a curve.
#[must_use]
pub fn crossing_near(omega: f64, groups: Groups) -> Option<Crossing> {
    let crossings = Crossings::of(groups);
    let distance = |c: &Crossing| (c.omega - omega).abs();
    crossings
        .iter()
        .min_by(|p, q| distance(p).total_cmp(&distance(q)))
        .copied()
}

/// The velocity gains a_v at which the crossings change their number, for given `b` and a_n: the
/// fold ω₋ = ω₊, and ω₋ = 0. With a dashpot d = `damping` beside the spring, a_n is that before it
/// falls by d a_v.
///
/// At b = d = 0 the one such gain is a_v = 0, where control vanishes if a_n does.
#[must_use]
pub fn velocity_gain_breakpoints(b: f64, a_n: f64, damping: f64) -> Vec<f64> {
    if damping != 0.0 {
        return damped_breakpoints(b, a_n, damping);
    }
    if b == 0.0 {
        return vec![0.0];
    }
    let c = b.mul_add(b, 2.0 * a_n);
    vec![
        (2.0 * b - c) * (2.0 * b + c) / (8.0 * b),
        (1.0 - 2.0 * a_n) / (2.0 * b),
    ]
}

/// The gains (3) with a dashpot d > 0: the zeros of c² − 4e and of e, with
///
/// ```text
/// |P|² − |Q|² = x² + cx + e,   c = b² − 2 + 2 a_n − 2d a_v,   e = 1 − 2 a_n + 2(d − b) a_v  (3)
/// ```
fn damped_breakpoints(b: f64, a_n: f64, damping: f64) -> Vec<f64> {
    let [far, near] = damped_folds(b, a_n, damping);
    vec![(2.0 * a_n - 1.0) / (2.0 * (damping - b)), far, near]
}

/// The zeros of c² − 4e of (3), that of larger size first: it is infinite without a dashpot. NaN
/// where there are none.
fn damped_folds(b: f64, a_n: f64, damping: f64) -> [f64; 2] {
    let (c, e) = (b.mul_add(b, 2.0 * a_n - 2.0), 1.0 - 2.0 * a_n);
    // d² a_v² − 2h a_v + (c² − 4e)/4 = 0.
    let half = 0.5 * c * damping + damping - b;
    let constant = 0.25 * (c * c - 4.0 * e);
    let square = damping * damping;
    let large = half + (half * half - square * constant).sqrt().copysign(half);
    [large / square, constant / large]
}

/// The a_v at which the crossings of pure velocity control vanish as its gain becomes weaker, at
/// the slope `b` < 0, dashpots included, with a dashpot d = `damping` beside the spring.
#[must_use]
pub(crate) fn velocity_fold(b: f64, damping: f64) -> f64 {
    damped_folds(b, 0.0, damping)[1]
}

/// The load gains a_n at which the crossings change their number, for given `b` and a_v; see
/// [`velocity_gain_breakpoints`].
#[must_use]
pub fn load_gain_breakpoints(b: f64, a_v: f64) -> Vec<f64> {
    let mut points = vec![0.5 - b * a_v];
    let squared = b * (b - 2.0 * a_v);
    if squared >= 0.0 {
        let half_width = squared.sqrt();
        points.extend([-0.5 * b * b - half_width, -0.5 * b * b + half_width]);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::characteristic::characteristic;
    use num_complex::Complex64;

    /// Along each curve, pure and mixed, iω is a root at every delay of its branches.
    #[test]
    fn the_curves_lie_on_roots() {
        for b in [-1.3, -0.5, -0.05, 0.2] {
            for other in [0.0, -0.4, 0.7] {
                for step in 1..60 {
                    let omega = 0.035 * f64::from(step);
                    let groups = [
                        Groups::new(b, velocity_gain(omega, b, other), other),
                        Groups::new(b, other, load_gain(omega, b, other)),
                    ];
                    for g in groups {
                        if g.a_n.abs() > 1e3 || g.uncontrolled() {
                            continue;
                        }
                        let crossing = crossing_near(omega, g).expect("on the curve");
                        assert!((crossing.omega - omega).abs() < 1e-6, "{g:?} {omega}");
                        for k in [0, 1, 5] {
                            let tau = crossing.delay(k);
                            let residual =
                                characteristic(g, tau, Complex64::new(0.0, crossing.omega)).norm();
                            assert!(
                                residual < 1e-11 * (1.0 + tau) * (1.0 + g.a_n.abs()),
                                "{g:?} {residual}"
                            );
                        }
                    }
                }
            }
        }
    }
}
