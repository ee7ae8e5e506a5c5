//! The modulus margin: how near the loop L = V/U comes to −1, the inverse of the largest
//! sensitivity 1/|1 + L|.
//!
//! ```text
//! m = min |1 + L| = min |U + V|/|U| over all ω ≥ 0, and as ω → ∞                            (1)
//! |U + V|² − γ²|U|² has no zero for γ just below m, and two about every dip below γ         (2)
//! |1 + L| ≥ 1 − |L| > γ where |U| > |V|/(1 − γ)                                             (3)
//! ```
//!
//! A level γ from the lowest value known is tried: all zeros of (2) up to the frequency of (3) are
//! found. Between two of them L comes nearer, and the middle gives a lower level: the levels
//! converge as the squares do. Where there is no zero the level is proved.

use std::f64::consts::TAU;

use super::gain::GainLoop;
use super::of_system::SystemLoop;
use crate::linear::real_zeros::{TooMany, zeros};
use crate::model::elementary::{norm, power};

/// What is tried is less than the lowest value known by this part of it: half the precision.
const LESS: f64 = 2e-10;
/// The most levels.
const MOST_LEVELS: u32 = 60;
/// Frequencies of a first look, up to where |L| stays below 1.
const LOOKS: i32 = 32;
/// Turns beyond it in which L is looked at as well.
const TURNS: f64 = 2.0;
/// How often the first look goes on where L comes nowhere nearer to −1 than at infinity, each time
/// to four times as high a frequency.
const FARTHER: u32 = 4;
/// A value so little below that at infinity is no dip.
const NO_DIP: f64 = 1e-7;

/// The modulus margin, with the frequency at which it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Modulus {
    /// min |1 + L|, to a relative 1e-9; NaN where that is not decided.
    pub margin: f64,
    /// ω there; infinite where |1 + L| comes to it as ω grows.
    pub omega: f64,
}

impl Modulus {
    pub(crate) const UNKNOWN: Self = Self {
        margin: f64::NAN,
        omega: f64::NAN,
    };
}

impl SystemLoop {
    /// How near the loop comes to −1.
    ///
    /// ```
    /// use slipmap::linear::general::System;
    /// use slipmap::linear::margins::SystemLoop;
    ///
    /// // (s + 1) + 0.5: |1 + L| falls from 1.5 to 1.
    /// let system = System::of_coefficients(&[1.0, 1.0], &[0.5])?;
    /// let of = SystemLoop::new(&system, 0.0).expect("a loop");
    /// assert_eq!(of.modulus().margin, 1.0);
    /// # Ok::<(), slipmap::model::ModelError>(())
    /// ```
    #[must_use]
    pub fn modulus(&self) -> Modulus {
        let mut lowest = Lowest {
            of: self,
            at_infinity: self.modulus_at_infinity(),
            value: f64::INFINITY,
            omega: f64::NAN,
        };
        lowest.value = lowest.at_infinity;
        lowest.omega = f64::INFINITY;
        if self.idle() {
            return lowest.told();
        }
        lowest.look();
        for _ in 0..MOST_LEVELS {
            if self.stopped() || lowest.value.is_nan() {
                break;
            }
            let before = lowest.value;
            if lowest.try_level(before * (1.0 - LESS)).is_err() {
                break;
            }
            if lowest.value >= before {
                return lowest.told();
            }
        }
        Modulus::UNKNOWN
    }

    /// The least that |1 + L| comes to as ω → ∞.
    fn modulus_at_infinity(&self) -> f64 {
        let ratio = self.system.loop_at_infinity();
        if self.undelayed() {
            return (1.0 + ratio).abs();
        }
        let size = 1.0 / self.system.accumulates_at(self.tau, self.line);
        (1.0 - size).abs()
    }

    /// |1 + L|.
    fn distance(&self, omega: f64) -> f64 {
        let [own, fed] = self.sides.at(omega);
        norm(own + fed) / norm(own)
    }
}

/// The lowest value known.
struct Lowest<'l> {
    of: &'l SystemLoop,
    at_infinity: f64,
    value: f64,
    omega: f64,
}

impl Lowest<'_> {
    fn told(&self) -> Modulus {
        Modulus {
            margin: self.value,
            omega: self.omega / self.of.unit,
        }
    }

    fn look_at(&mut self, omega: f64) {
        let value = self.of.distance(omega);
        if value < self.value {
            (self.value, self.omega) = (value, omega);
        }
    }

    /// A first look: at some frequencies, and where L is real.
    fn look(&mut self) {
        let of = self.of;
        let mut end = [1.0, 1e3].map(|factor| of.within(factor)).into_iter();
        let end = end.find(|end| *end > 0.0 && end.is_finite());
        let mut end = end.unwrap_or(1.0);
        self.look_at(0.0);
        for k in 0..LOOKS {
            self.look_at(end * power(0.75, k));
        }
        let longest = of.tau + of.system.latency();
        let turn = if longest > 0.0 { TAU / longest } else { 0.0 };
        for _ in 0..FARTHER {
            for k in 1..=LOOKS {
                self.look_at(end + TURNS * turn * f64::from(k) / f64::from(LOOKS));
            }
            end += TURNS * turn;
            let found = zeros(&of.left_side(), end, |omega, _| self.look_at(omega));
            if self.value < self.at_infinity * (1.0 - NO_DIP) || found.is_err() {
                break;
            }
            end *= 4.0;
        }
    }

    /// Looks between all zeros of (2) at the level `level`.
    fn try_level(&mut self, level: f64) -> Result<(), TooMany> {
        let of = self.of;
        let end = match of.undelayed() {
            true => of.system.undelayed_bound(level),
            false if level < 1.0 => of.within(1.0 / (1.0 - level)),
            false => f64::INFINITY,
        };
        if !end.is_finite() {
            return Err(TooMany);
        }
        let mut last = 0.0;
        zeros(&of.sides.above(level), end, |omega, _| {
            self.look_at(0.5 * (last + omega));
            self.look_at(omega);
            last = omega;
        })
    }
}
