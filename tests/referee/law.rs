//! Friction laws of the referee's own: μ_K over the sliding speed, in pieces on each of which it is
//! smooth.

use super::pchip::Curve;

/// μ_K(v), v ≥ 0; v_s and the speeds of a table in the units of the velocity.
#[derive(Debug, Clone)]
pub(crate) enum Law {
    /// μ0 at every speed.
    Coulomb { mu0: f64 },
    /// μ0/(1 + v/v_s).
    Weakening { mu0: f64, v_s: f64 },
    /// μ0 + (μ_S − μ0) exp(−(v/v_s)²).
    Stribeck { mu0: f64, v_s: f64 },
    /// A monotone cubic through measured points, constant outside of them.
    Table(Curve),
}

/// A law with its coefficient of static friction.
#[derive(Debug, Clone)]
pub(crate) struct Friction {
    pub law: Law,
    pub mu_s: f64,
}

/// Beyond so many v_s the flank of Stribeck's law is below rounding.
const FLANK: f64 = 6.0;

impl Friction {
    /// The piece that holds at `speed`, and above it where two of them meet.
    pub(crate) fn piece(&self, speed: f64) -> usize {
        match &self.law {
            Law::Table(curve) => curve.piece(speed),
            _ => 0,
        }
    }

    /// The speeds between which a piece holds.
    pub(crate) fn bounds(&self, piece: usize) -> (f64, f64) {
        match &self.law {
            Law::Table(curve) => curve.bounds(piece),
            _ => (f64::NEG_INFINITY, f64::INFINITY),
        }
    }

    /// μ_K, by a piece that goes on smoothly beyond its bounds.
    pub(crate) fn coefficient(&self, piece: usize, speed: f64) -> f64 {
        match &self.law {
            Law::Coulomb { mu0 } => *mu0,
            Law::Weakening { mu0, v_s } => mu0 / (1.0 + speed / v_s),
            Law::Stribeck { mu0, v_s } => {
                let q = speed / v_s;
                mu0 + (self.mu_s - mu0) * (-q * q).exp()
            }
            Law::Table(curve) => curve.value(piece, speed),
        }
    }

    /// dμ_K/dv.
    pub(crate) fn slope(&self, piece: usize, speed: f64) -> f64 {
        match &self.law {
            Law::Coulomb { .. } => 0.0,
            Law::Weakening { mu0, v_s } => {
                let q = 1.0 + speed / v_s;
                -mu0 / (v_s * q * q)
            }
            Law::Stribeck { mu0, v_s } => {
                let q = speed / v_s;
                -2.0 * (self.mu_s - mu0) * q / v_s * (-q * q).exp()
            }
            Law::Table(curve) => curve.slope(piece, speed),
        }
    }

    /// The change of speed over which the law bends. A fast block may change its speed by half of
    /// what parts it from the flank of Stribeck's law besides: no step jumps over the flank.
    pub(crate) fn reach(&self, piece: usize, speed: f64) -> f64 {
        match &self.law {
            Law::Coulomb { .. } => f64::INFINITY,
            Law::Weakening { v_s, .. } => v_s + speed.abs(),
            Law::Stribeck { v_s, .. } => v_s + 5.0 * (speed.abs() - FLANK * v_s).max(0.0),
            Law::Table(curve) => {
                let (from, to) = curve.bounds(piece);
                to - from
            }
        }
    }
}
