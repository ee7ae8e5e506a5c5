//! What B and A of the controlled oscillator are made of.

use super::polynomial::Precise;
use crate::model::groups::open_loop_coefficients;
use crate::model::{Groups, Lags};

/// The numbers that B and A come from:
///
/// ```text
/// B = (λ² + bλ + 1) L_a L_v L_s,   A = a_n L_v + a_v (b − d + λ) L_a,   L = 1 + Tλ
/// ```
///
/// The slope b of nearly flat friction is lost in the rounding of the coefficients of B, for
/// example in b + T_a. It decides how many roots are unstable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// b, a_v and a_n, the latter without what a dashpot takes off it.
    pub groups: Groups,
    /// d, the dashpot beside the spring.
    pub damping: f64,
    /// T_a, T_v and T_s.
    pub lags: Lags,
}

impl Source {
    /// The number of zeros of B right of the imaginary axis; none where some lie on it.
    pub(in super::super) fn open_loop_unstable(&self) -> Option<u64> {
        let b = self.groups.b;
        (b != 0.0).then_some(if b < 0.0 { 2 } else { 0 })
    }

    /// B and A.
    pub(super) fn polynomials(&self) -> [Precise; 2] {
        let Groups { b, a_v, a_n } = self.groups;
        let [load, velocity, sensor] = self.lags.times().map(|time| Precise::new([1.0, time]));
        let lags = load.product(&velocity).product(&sensor);
        let by_load = velocity.product(&Precise::new([a_n]));
        let by_velocity = load.product(&Precise::new([b - self.damping, 1.0]));
        [
            Precise::new(open_loop_coefficients(b)).product(&lags),
            by_velocity.product(&Precise::new([a_v])).plus(&by_load),
        ]
    }
}
