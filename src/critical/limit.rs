//! The critical velocity for Coulomb friction and load control in the limit of a short delay: the
//! letter's Fig. 4.
//!
//! With α_N τ finite as τ → 0 the control is a viscous friction. One slip starts from ẋ = 0 and
//! grazes ẋ = ẍ = 0 after the time T; with γ = −μ_K α_N τ/(2√(κM)), Ω = √(1−γ²), times in units of
//! √(M/κ), ṽ = (μ_S−μ_K)N0/√(κM) and r = μ_K/μ_S
//!
//! ```text
//! cos ΩT − (γ/Ω) sin ΩT = e^(−γT),   π < ΩT < 2π      (1)
//! v_c/ṽ = 1/(ρ + 2γ(1−r)/r),   ρ = −sin ΩT e^(γT)/Ω   (2)
//! ```
//!
//! for 0 < γ < 1. v_c = 0 from γ = 1 on, where a slip is damped so strongly that it never ends.
//!
//! Dashpots with the damping ratios ζ (beside the spring) and ζ_g (to the ground) damp a slip as
//! the control does, but leave the load alone: ρ is that of γ + ζ + ζ_g, and γ stays in the other
//! term.

use crate::model::ModelError;
use crate::model::elementary::{cos, exp, expm1, sin};

/// The limit at one γ and one μ_K/μ_S.
///
/// ```
/// use slipmap::critical::limit::CoulombLimit;
///
/// // Fig. 4 of the letter: from γ = 1 on there is no stick-slip.
/// assert_eq!(CoulombLimit::at(1.0, 0.5)?.vc_over_vtilde, 0.0);
/// assert!(CoulombLimit::at(0.1, 0.5)?.vc_over_vtilde > 0.0);
/// # Ok::<(), slipmap::model::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoulombLimit {
    /// v_c/ṽ; 0 for γ + ζ + ζ_g ≥ 1.
    pub vc_over_vtilde: f64,
    /// T, the duration of the grazing slip over √(M/κ); +∞ for γ + ζ + ζ_g ≥ 1.
    pub omega0_t: f64,
    /// v0/ṽ from which the block lifts off while it sticks: N0 = −α_N τ v0; +∞ without control.
    pub liftoff_over_vtilde: f64,
}

/// The limit at one γ and μ_K/μ_S, and the letter's approximations of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitCell {
    /// The closed form.
    pub exact: CoulombLimit,
    /// v_c/ṽ by [`weak`].
    pub weak: f64,
    /// v_c/ṽ by [`strong`].
    pub strong: f64,
}

impl LimitCell {
    /// The limit at γ, ζ + ζ_g = `damping_ratio` and μ_K/μ_S. The letter's approximations are taken
    /// at γ + ζ + ζ_g.
    ///
    /// # Errors
    /// As [`CoulombLimit::damped`].
    pub fn at(gamma: f64, damping_ratio: f64, mu_ratio: f64) -> Result<Self, ModelError> {
        let damped = gamma + damping_ratio;
        Ok(Self {
            exact: CoulombLimit::damped(gamma, damping_ratio, mu_ratio)?,
            weak: weak(damped),
            strong: strong(damped),
        })
    }

    /// The relative error of an approximation of v_c/ṽ; NaN where that is 0.
    #[must_use]
    pub fn error(&self, approximation: f64) -> f64 {
        match self.exact.vc_over_vtilde {
            0.0 => f64::NAN,
            vc => approximation / vc - 1.0,
        }
    }
}

/// The letter's approximation for γ → 0: 1/(2√(πγ)).
#[must_use]
pub fn weak(gamma: f64) -> f64 {
    0.5 / (std::f64::consts::PI * gamma).sqrt()
}

/// The letter's approximation for γ → 1: γ⁻¹ exp(−1 − πγ/Ω); 0 from γ = 1 on.
#[must_use]
pub fn strong(gamma: f64) -> f64 {
    if gamma >= 1.0 {
        return 0.0;
    }
    exp(-1.0 - std::f64::consts::PI * gamma / omega(gamma)) / gamma
}

/// Ω = √(1−γ²).
fn omega(gamma: f64) -> f64 {
    ((1.0 - gamma) * (1.0 + gamma)).sqrt()
}

impl CoulombLimit {
    /// The limit at γ > 0 and r = μ_K/μ_S in (0, 1].
    ///
    /// # Errors
    /// When γ is not finite and greater than 0, or r not in its range.
    pub fn at(gamma: f64, mu_ratio: f64) -> Result<Self, ModelError> {
        ModelError::positive("gamma", gamma)?;
        Self::damped(gamma, 0.0, mu_ratio)
    }

    /// The limit at γ ≥ 0, ζ + ζ_g = `damping_ratio` ≥ 0, not both 0, and r = μ_K/μ_S in (0, 1].
    ///
    /// # Errors
    /// When one of them is not in its range.
    pub fn damped(gamma: f64, damping_ratio: f64, mu_ratio: f64) -> Result<Self, ModelError> {
        let known = |value: f64| value.is_finite() && value >= 0.0;
        let range = "finite and at least 0";
        ModelError::check("damping_ratio", damping_ratio, range, known(damping_ratio))?;
        let acts = known(gamma) && gamma + damping_ratio > 0.0;
        ModelError::check("gamma", gamma, "at least 0; above 0 without damping", acts)?;
        let inside = mu_ratio > 0.0 && mu_ratio <= 1.0;
        ModelError::check("mu_ratio", mu_ratio, "greater than 0, at most 1", inside)?;
        let stretch = 2.0 * gamma * (1.0 - mu_ratio) / mu_ratio;
        let liftoff_over_vtilde = 1.0 / stretch;
        let damped = gamma + damping_ratio;
        if damped >= 1.0 {
            return Ok(Self {
                vc_over_vtilde: 0.0,
                omega0_t: f64::INFINITY,
                liftoff_over_vtilde,
            });
        }
        let omega = omega(damped);
        let before = phase_before_turn(damped, omega);
        let t = (std::f64::consts::TAU - before) / omega;
        let rho = sin(before) * exp(damped * t) / omega;
        Ok(Self {
            vc_over_vtilde: 1.0 / (rho + stretch),
            omega0_t: t,
            liftoff_over_vtilde,
        })
    }
}

/// 2π − ΩT in (0, π), from Eq. (1) without its cancellations: with s = 2π − ΩT it reads
/// (γ/Ω) sin s − 2 sin²(s/2) = e^(−γ(2π−s)/Ω) − 1.
fn phase_before_turn(gamma: f64, omega: f64) -> f64 {
    let ratio = gamma / omega;
    let equation = |s: f64| {
        let half = sin(0.5 * s);
        let decay = -ratio * (std::f64::consts::TAU - s);
        (
            ratio * sin(s) - 2.0 * half * half - expm1(decay),
            ratio * cos(s) - sin(s) - ratio * exp(decay),
        )
    };
    // Positive at 0, negative at π: Newton's method within a bracket.
    let (mut low, mut high) = (0.0, std::f64::consts::PI);
    let mut s = 0.5 * (low + high);
    for _ in 0..200 {
        let (value, slope) = equation(s);
        if value > 0.0 {
            low = s;
        } else {
            high = s;
        }
        let newton = s - value / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - s).abs() <= 0.5 * f64::EPSILON * next {
            return next;
        }
        s = next;
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_reference_values_are_met() {
        let table = include_str!("../../tests/reference/fig4.csv");
        for line in table.lines().skip(1) {
            let row: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
            let [r, gamma, vc, t, liftoff] = row[..] else {
                panic!("five columns")
            };
            let found = CoulombLimit::at(gamma, r).unwrap();
            for (found, expected) in [
                (found.vc_over_vtilde, vc),
                (found.omega0_t, t),
                (found.liftoff_over_vtilde, liftoff),
            ] {
                assert!(
                    (found / expected - 1.0).abs() < 1e-12,
                    "{gamma}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn errors_are_relative_and_have_no_value_without_stick_slip() {
        let cell = LimitCell::at(0.25, 0.0, 0.5).unwrap();
        let [vc, error] = [cell.exact.vc_over_vtilde, cell.error(cell.weak)];
        assert!((vc * (1.0 + error) / weak(0.25) - 1.0).abs() < 1e-14);
        let beyond = LimitCell::at(1.5, 0.0, 0.5).unwrap();
        assert!(beyond.error(beyond.strong).is_nan());
        assert_eq!(beyond.exact.omega0_t, f64::INFINITY);
    }

    #[test]
    fn the_letters_approximations_are_its_limits() {
        let near = |gamma: f64| CoulombLimit::at(gamma, 0.5).unwrap().vc_over_vtilde;
        assert!((near(1e-8) / weak(1e-8) - 1.0).abs() < 1e-3);
        for gamma in [0.999, 0.9999] {
            let ratio = near(gamma) / strong(gamma);
            assert!((ratio - 1.0).abs() < 0.01, "{gamma}: {ratio}");
        }
    }

    #[test]
    fn beyond_critical_damping_nothing_is_left() {
        let found = CoulombLimit::at(1.0, 0.3).unwrap();
        assert_eq!((found.vc_over_vtilde, strong(1.5)), (0.0, 0.0));
        assert!(CoulombLimit::at(0.0, 0.5).is_err() && CoulombLimit::at(0.5, 1.2).is_err());
    }

    /// Values of another program, confirmed by ramps at short delays.
    #[test]
    fn dashpots_damp_a_slip_but_leave_the_load_alone() {
        for (gamma, damping_ratio, expected) in [
            (0.1, 0.05, 0.2215097306),
            (0.0, 0.05, 0.5490463121),
            (0.05, 0.2, 0.1382464635),
            (0.3, 0.1, 0.06358831592),
        ] {
            let found = CoulombLimit::damped(gamma, damping_ratio, 0.5).unwrap();
            // The table has v_c where ṽ = 0.5.
            let off = (0.5 * found.vc_over_vtilde / expected - 1.0).abs();
            assert!(off < 5e-10, "{found:?} {expected}");
        }
        assert_eq!(
            CoulombLimit::damped(0.4, 0.6, 0.5).unwrap().vc_over_vtilde,
            0.0
        );
        for (gamma, damping_ratio) in [(0.0, 0.0), (-0.1, 0.5), (0.5, -0.1), (0.5, f64::NAN)] {
            assert!(CoulombLimit::damped(gamma, damping_ratio, 0.5).is_err());
        }
    }

    proptest! {
        /// Lift-off lies above v_c everywhere, and T solves Eq. (1) as it stands.
        #[test]
        fn lift_off_lies_above(gamma in 1e-6..0.9999_f64, r in 0.01..1.0_f64) {
            let found = CoulombLimit::at(gamma, r).unwrap();
            prop_assert!(found.vc_over_vtilde < found.liftoff_over_vtilde);
            let (omega, t) = (omega(gamma), found.omega0_t);
            let angle = omega * t;
            prop_assert!(angle > std::f64::consts::PI && angle < std::f64::consts::TAU);
            let defect = angle.cos() - gamma / omega * angle.sin() - (-gamma * t).exp();
            prop_assert!(defect.abs() < 1e-12 * (1.0 + gamma / omega) * (1.0 + t), "{defect:e}");
        }
    }
}
