//! The phase margin from the crossings of a line, and the crossing that a delay belongs to.
//!
//! At a crossing |L| = 1 and arg(−L) = θ − ωτ.

use std::f64::consts::TAU;

use crate::linear::crossing::Crossing;

/// Delays are known to this relative precision, or a real root passes.
const NEAR: f64 = 1e-9;

/// The phase margin of a loop, with the frequency it comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseMargin {
    /// The least angle, rad, of either sign; infinite where |L| is 1 nowhere, NaN where that is not
    /// known.
    pub angle: f64,
    /// ω of the crossing; NaN where there is none.
    pub omega: f64,
}

impl PhaseMargin {
    /// A margin of a loop of which |L| is 1 nowhere.
    pub(crate) const ENDLESS: Self = Self {
        angle: f64::INFINITY,
        omega: f64::NAN,
    };

    /// A margin that is not known.
    pub(crate) const UNKNOWN: Self = Self {
        angle: f64::NAN,
        omega: f64::NAN,
    };

    /// The least of the angles at all `crossings` of a line at the delay `tau`.
    pub(crate) fn of<'c>(crossings: impl Iterator<Item = &'c Crossing>, tau: f64) -> Self {
        let at = |crossing: &Crossing| {
            let turned = crossing.theta - crossing.omega * tau;
            Self {
                angle: (turned - TAU * (turned / TAU).round()).abs(),
                omega: crossing.omega,
            }
        };
        let least = crossings.map(at).min_by(|a, b| a.angle.total_cmp(&b.angle));
        least.unwrap_or(Self::ENDLESS)
    }
}

/// ω of the crossing of a line that has the delay `tau`, 0 where a real root passes there; NaN
/// where `tau` is not positive and finite.
pub(crate) fn omega_at<'c>(crossings: impl Iterator<Item = &'c Crossing>, tau: f64) -> f64 {
    if !(tau > 0.0 && tau.is_finite()) {
        return f64::NAN;
    }
    let apart = |crossing: &Crossing| {
        let next = crossing.branch_at(tau);
        let before = next.saturating_sub(1).max(crossing.first_branch);
        let apart = [next, before].map(|k| (crossing.delay(k) - tau).abs());
        apart[0].min(apart[1])
    };
    let nearest = crossings
        .map(|crossing| (apart(crossing), crossing.omega))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    nearest
        .filter(|(apart, _)| *apart <= NEAR * tau)
        .map_or(0.0, |(_, omega)| omega)
}
