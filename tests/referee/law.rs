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
    /// μ0 + (μ_S − μ0) f(v/v_s) + σ v.
    Formula {
        shape: Shape,
        mu0: f64,
        v_s: f64,
        sigma: f64,
    },
    /// A monotone cubic through measured points, constant outside of them.
    Table(Curve),
}

/// A fall f(q) from 1 at rest to 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Shape {
    /// exp(−q^δ).
    Exponential(f64),
    /// 1/cosh q.
    Hyperbolic,
    /// 1/(1 + q^δ).
    Rational(f64),
    /// 1 − tanh q.
    Tanh,
}

impl Shape {
    /// As slipmap writes it, with `v_s` and `delta`.
    pub(crate) fn text(self) -> &'static str {
        match self {
            Self::Exponential(_) => "exp(-(v/v_s)^delta)",
            Self::Hyperbolic => "1/cosh(v/v_s)",
            Self::Rational(_) => "1/(1 + (v/v_s)^delta)",
            Self::Tanh => "(1 - tanh(v/v_s))",
        }
    }

    /// δ, where there is one.
    pub(crate) fn exponent(self) -> Option<f64> {
        match self {
            Self::Exponential(delta) | Self::Rational(delta) => Some(delta),
            Self::Hyperbolic | Self::Tanh => None,
        }
    }

    /// f and its slope. With an exponent that is not whole it has no value below rest; there it is
    /// that at rest.
    fn value_and_slope(self, q: f64) -> (f64, f64) {
        let power = |delta: f64| {
            if delta.fract() == 0.0 {
                return (q.powi(delta as i32), delta * q.powi(delta as i32 - 1));
            }
            let q = q.max(0.0);
            (q.powf(delta), delta * q.powf(delta - 1.0).min(1e12))
        };
        match self {
            Self::Exponential(delta) => {
                let (y, slope) = power(delta);
                ((-y).exp(), -slope * (-y).exp())
            }
            Self::Hyperbolic => (1.0 / q.cosh(), -q.tanh() / q.cosh()),
            Self::Rational(delta) => {
                let (y, slope) = power(delta);
                (1.0 / (1.0 + y), -slope / (1.0 + y).powi(2))
            }
            Self::Tanh => (1.0 - q.tanh(), -1.0 / q.cosh().powi(2)),
        }
    }
}

/// Near rest a law whose exponent is not whole bends over this part of the speed, but over no less
/// than this part of v_s.
const NEAR_REST: f64 = 0.5;
const AT_REST: f64 = 1e-10;

/// A law with its coefficient of static friction.
#[derive(Debug, Clone)]
pub(crate) struct Friction {
    pub law: Law,
    pub mu_s: f64,
}

/// Beyond so many v_s the flank of Stribeck's law is below rounding.
const FLANK: f64 = 6.0;

impl Law {
    /// The letter's.
    pub(crate) const LETTERS: Self = Self::Weakening { mu0: 0.5, v_s: 0.5 };
}

impl Friction {
    /// The letter's law, with static friction of 1.
    pub(crate) const fn of_letter() -> Self {
        Self {
            law: Law::LETTERS,
            mu_s: 1.0,
        }
    }

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
        self.value_and_slope(piece, speed).0
    }

    /// dμ_K/dv.
    pub(crate) fn slope(&self, piece: usize, speed: f64) -> f64 {
        self.value_and_slope(piece, speed).1
    }

    #[inline]
    fn value_and_slope(&self, piece: usize, speed: f64) -> (f64, f64) {
        match &self.law {
            Law::Coulomb { mu0 } => (*mu0, 0.0),
            Law::Weakening { mu0, v_s } => {
                let q = 1.0 + speed / v_s;
                (mu0 / q, -mu0 / (v_s * q * q))
            }
            Law::Stribeck { mu0, v_s } => {
                let q = speed / v_s;
                let fall = (self.mu_s - mu0) * (-q * q).exp();
                (mu0 + fall, -2.0 * q / v_s * fall)
            }
            Law::Formula {
                shape,
                mu0,
                v_s,
                sigma,
            } => {
                let (fall, slope) = shape.value_and_slope(speed / v_s);
                let height = self.mu_s - mu0;
                (
                    mu0 + height * fall + sigma * speed,
                    height * slope / v_s + sigma,
                )
            }
            Law::Table(curve) => (curve.value(piece, speed), curve.slope(piece, speed)),
        }
    }

    /// Whether the law has no series at rest.
    pub(crate) fn is_rough_at_rest(&self) -> bool {
        match &self.law {
            Law::Formula { shape, .. } => shape.exponent().is_some_and(|d| d.fract() != 0.0),
            _ => false,
        }
    }

    /// The change of speed over which the law bends. A fast block may change its speed by half of
    /// what parts it from the flank of Stribeck's law besides: no step jumps over the flank.
    pub(crate) fn reach(&self, piece: usize, speed: f64) -> f64 {
        match &self.law {
            Law::Coulomb { .. } => f64::INFINITY,
            Law::Weakening { v_s, .. } => v_s + speed.abs(),
            Law::Formula { shape, v_s, .. } => {
                let far = v_s + 0.2 * (speed.abs() - v_s).max(0.0);
                match shape.exponent() {
                    Some(delta) if delta.fract() != 0.0 => {
                        far.min(NEAR_REST * speed.abs() + AT_REST * v_s)
                    }
                    _ => far,
                }
            }
            Law::Stribeck { v_s, .. } => v_s + 5.0 * (speed.abs() - FLANK * v_s).max(0.0),
            Law::Table(curve) => {
                let (from, to) = curve.bounds(piece);
                to - from
            }
        }
    }
}
