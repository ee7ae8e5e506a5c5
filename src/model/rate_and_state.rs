//! Rate-and-state friction: a coefficient that depends on the velocity and on a state θ.
//!
//! ```text
//! μ = μ₀ + A ln(v/v*) + B ln(v* θ/D),   θ̇ = 1 − v θ/D − c μ θ Ṅ/(B N)                       (1)
//! α = A N/(v₀ √(κM)),   β = B N/(v₀ √(κM)),   T = D √(κ/M)/v₀                                (2)
//! κ/κ_c = T/[(β − α)(1 + 1/(αT))]                                                            (3)
//! ```
//!
//! A is the direct effect, B the effect of evolution, D the slip distance. c says how much a change
//! of the load changes the state (Linker and Dieterich 1992); with c = 0 it does not. (1)
//! linearised about sliding at v₀ depends on α, β, T and c alone. κ_c is the stiffness below which
//! steady sliding without control and without dashpots is unstable.

use super::elementary::ln;
use super::law::{Form, Made};
use super::{ModelError, Oscillator, SlidingPoint};

/// The law, with its parameters as in (1).
///
/// ```
/// use slipmap::model::{Oscillator, RateAndState};
///
/// let law = RateAndState {
///     mu0: 0.6,
///     v_star: 1.0,
///     direct_effect: 0.01,
///     evolution_effect: 0.015,
///     slip_distance: 0.1,
///     load_memory: 0.0,
/// };
/// // Without control sliding is stable on springs stiffer than the critical one.
/// let block = Oscillator::new(1.0, 1.0, 1.0)?;
/// let groups = law.groups(&block, 1e-3);
/// assert!(groups.stiffness_ratio() > 1.0);
/// # Ok::<(), slipmap::model::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateAndState {
    /// μ₀, the coefficient of steady sliding at v*.
    pub mu0: f64,
    /// v* > 0.
    pub v_star: f64,
    /// A > 0.
    pub direct_effect: f64,
    /// B > 0.
    pub evolution_effect: f64,
    /// D > 0.
    pub slip_distance: f64,
    /// c ≥ 0.
    pub load_memory: f64,
}

/// Its dimensionless groups about steady sliding; the time unit is √(M/κ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateGroups {
    /// α.
    pub direct: f64,
    /// β.
    pub evolution: f64,
    /// T.
    pub state_time: f64,
    /// c.
    pub load_memory: f64,
}

impl RateAndState {
    /// Its row where laws are named.
    pub const FORM: Form = Form {
        name: "rate-and-state",
        formula: "μ = μ0 + A_f ln(v/v*) + B_f ln(v* θ/D_c)",
        parameters: &[
            "mu0",
            "v_star",
            "direct_effect",
            "evolution_effect",
            "slip_distance",
        ],
        needed: 5,
        optional: &["load_memory"],
        law: Made::WithState(|of| Self {
            mu0: of[0],
            v_star: of[1],
            direct_effect: of[2],
            evolution_effect: of[3],
            slip_distance: of[4],
            load_memory: of[5],
        }),
    };

    /// Value and slope of the coefficient of steady sliding, μ₀ + (A − B) ln(v/v*), at `v0` > 0.
    ///
    /// # Errors
    /// `v0` must be finite and positive, and so must the coefficient there.
    pub fn steady(&self, v0: f64) -> Result<SlidingPoint, ModelError> {
        let v0 = ModelError::positive("v0", v0)?;
        let effect = self.direct_effect - self.evolution_effect;
        let mu_k = self.mu0 + effect * ln(v0 / self.v_star);
        if mu_k > 0.0 && mu_k.is_finite() {
            Ok(SlidingPoint {
                mu_k,
                mu_prime: effect / v0,
            })
        } else {
            Err(ModelError {
                parameter: "mu0",
                value: self.mu0,
                allowed: "so large that mu0 + (direct_effect - evolution_effect) ln(v0/v_star), \
                    the coefficient of steady sliding, is greater than 0",
                at_speed: None,
            })
        }
    }

    /// The groups (2) at the sliding velocity `v0` > 0.
    #[must_use]
    pub fn groups(&self, oscillator: &Oscillator, v0: f64) -> StateGroups {
        let damping_unit = oscillator.mass() / oscillator.time_unit();
        let per_effect = oscillator.normal_load() / (v0 * damping_unit);
        StateGroups {
            direct: self.direct_effect * per_effect,
            evolution: self.evolution_effect * per_effect,
            state_time: self.slip_distance / (v0 * oscillator.time_unit()),
            load_memory: self.load_memory,
        }
    }
}

impl StateGroups {
    /// κ/κ_c, Eq. (3). Steady sliding without control is unstable where it is less than 1. Infinite
    /// where β ≤ α: sliding is then stable at every stiffness.
    #[must_use]
    pub fn stiffness_ratio(&self) -> f64 {
        let weakening = self.evolution - self.direct;
        if weakening <= 0.0 {
            return f64::INFINITY;
        }
        let (alpha, time) = (self.direct, self.state_time);
        alpha * time * time / (weakening * (1.0 + alpha * time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(direct_effect: f64, evolution_effect: f64) -> RateAndState {
        RateAndState {
            mu0: 0.6,
            v_star: 1e-6,
            direct_effect,
            evolution_effect,
            slip_distance: 1e-5,
            load_memory: 0.0,
        }
    }

    /// κ_c = (B − A)(N/D)[1 + M v₀²/(A N D)], in physical units.
    #[test]
    fn the_critical_stiffness_is_that_of_the_formula() {
        let (law, v0) = (law(0.01, 0.015), 2e-5);
        for (mass, stiffness, load) in [(10.0, 3e4, 50.0), (0.2, 1e3, 7.0), (3e4, 1e5, 1.0)] {
            let oscillator = Oscillator::new(mass, stiffness, load).unwrap();
            let per_length = load / law.slip_distance;
            let inertia = mass * v0 * v0 / (law.direct_effect * load * law.slip_distance);
            let critical = (0.015 - 0.01) * per_length * (1.0 + inertia);
            let found = law.groups(&oscillator, v0).stiffness_ratio();
            assert!(
                (found / (stiffness / critical) - 1.0).abs() < 1e-13,
                "{found}"
            );
        }
        let strengthening = super::RateAndState {
            ..self::law(0.02, 0.015)
        };
        let groups = strengthening.groups(&Oscillator::default(), v0);
        assert_eq!(groups.stiffness_ratio(), f64::INFINITY);
    }

    #[test]
    fn steady_sliding_has_the_coefficient_of_its_velocity() {
        let at = law(0.01, 0.015).steady(1e-5).unwrap();
        assert!((at.mu_k - (0.6 - 0.005 * 10.0_f64.ln())).abs() < 1e-15);
        assert!((at.mu_prime + 500.0).abs() < 1e-9);
        let slippery = RateAndState {
            mu0: 0.01,
            ..law(0.01, 0.015)
        };
        assert_eq!(slippery.steady(1.0).unwrap_err().parameter, "mu0");
    }
}
