//! The dimensional oscillator with its dashpots, the control law, and their dimensionless groups.

use super::{FrictionLaw, Groups, ModelError};

/// A block of mass M on a spring κ, pressed down by the unperturbed load N0.
///
/// ```
/// use slipmap::model::{Control, Oscillator, SlidingPoint};
///
/// let block = Oscillator::new(2.0, 8.0, 10.0)?; // kg, N/m, N
/// assert_eq!(block.time_unit(), 0.5);
/// let sliding = SlidingPoint { mu_k: 0.4, mu_prime: -0.1 }; // μ′ in s/m
/// let groups = block.groups(sliding, Control { alpha_v: -0.6, alpha_n: 0.0 });
/// assert_eq!((groups.b, groups.a_v), (-0.25, -0.3));
/// # Ok::<(), slipmap::model::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator {
    mass: f64,
    stiffness: f64,
    normal_load: f64,
    /// √(M/κ).
    time_unit: f64,
    /// √(κM), the unit of damping.
    damping_unit: f64,
    /// Physical, and in units of √(κM).
    dashpots: Dashpots,
    dashpot_ratios: Dashpots,
}

/// Dashpots beside the spring and to the ground, mass/time; or both in units of √(κM), see
/// [`Oscillator::dashpot_ratios`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dashpots {
    /// c ≥ 0, beside the spring: it pulls the block with c ȧ.
    pub damping: f64,
    /// c_g ≥ 0, to the ground, independent of the load: it holds the block with c_g ẋ.
    pub viscous: f64,
}

impl Dashpots {
    /// d + g, what both add to b.
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.damping + self.viscous
    }
}

impl Default for Oscillator {
    /// M = κ = N0 = 1: plain numbers are then the dimensionless groups.
    fn default() -> Self {
        Self {
            mass: 1.0,
            stiffness: 1.0,
            normal_load: 1.0,
            time_unit: 1.0,
            damping_unit: 1.0,
            dashpots: Dashpots::default(),
            dashpot_ratios: Dashpots::default(),
        }
    }
}

impl Oscillator {
    /// An oscillator of mass M, spring stiffness κ and normal load N0.
    ///
    /// # Errors
    /// Each of the three must be finite and greater than zero.
    pub fn new(mass: f64, stiffness: f64, normal_load: f64) -> Result<Self, ModelError> {
        let mass = ModelError::positive("mass", mass)?;
        let stiffness = ModelError::positive("stiffness", stiffness)?;
        Ok(Self {
            mass,
            stiffness,
            normal_load: ModelError::positive("normal_load", normal_load)?,
            time_unit: (mass / stiffness).sqrt(),
            damping_unit: (stiffness * mass).sqrt(),
            dashpots: Dashpots::default(),
            dashpot_ratios: Dashpots::default(),
        })
    }

    /// This oscillator with dashpots.
    ///
    /// # Errors
    /// Both must be finite and at least 0.
    pub fn damped(self, dashpots: Dashpots) -> Result<Self, ModelError> {
        let Dashpots { damping, viscous } = dashpots;
        for (name, value) in [("damping", damping), ("viscous", viscous)] {
            ModelError::check(name, value, "finite and at least 0", value >= 0.0)?;
        }
        let dashpot_ratios = Dashpots {
            damping: damping / self.damping_unit,
            viscous: viscous / self.damping_unit,
        };
        Ok(Self {
            dashpots,
            dashpot_ratios,
            ..self
        })
    }

    /// The dashpots, mass/time.
    #[must_use]
    pub fn dashpots(&self) -> Dashpots {
        self.dashpots
    }

    /// d = c/√(κM) and g = c_g/√(κM): twice their damping ratios.
    #[must_use]
    pub fn dashpot_ratios(&self) -> Dashpots {
        self.dashpot_ratios
    }

    /// M.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// κ.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// N0.
    #[must_use]
    pub fn normal_load(&self) -> f64 {
        self.normal_load
    }

    /// The unit of time √(M/κ): the inverse of the frictionless oscillator's angular frequency.
    #[must_use]
    pub fn time_unit(&self) -> f64 {
        self.time_unit
    }

    /// The unit of velocity N0/√(κM).
    #[must_use]
    pub fn velocity_unit(&self) -> f64 {
        self.normal_load / self.stiffness / self.time_unit
    }

    /// The dimensionless groups at a sliding point under control (physics of the letter's Eq. 3).
    ///
    /// With dashpots the equation is the letter's too, with b + d + g in the place of b and
    /// a_n − d a_v in that of a_n: the dashpot beside the spring feels the pulling velocity.
    #[must_use]
    #[inline]
    pub fn groups(&self, sliding: SlidingPoint, control: Control) -> Groups {
        self.groups_without_coupling(sliding, control)
            .coupled(self.dashpot_ratios.damping)
    }

    /// The groups but for the last step: b includes the dashpots, a_n does not yet.
    #[must_use]
    #[inline]
    pub(crate) fn groups_without_coupling(
        &self,
        sliding: SlidingPoint,
        control: Control,
    ) -> Groups {
        Groups {
            b: self.damping_of(sliding.mu_prime) / self.damping_unit,
            a_v: control.alpha_v * self.time_unit,
            a_n: sliding.mu_k * control.alpha_n / self.stiffness,
        }
    }

    /// μ_K′ N0 + c + c_g, with the right sign however much of it cancels.
    #[inline]
    fn damping_of(&self, mu_prime: f64) -> f64 {
        let slope = mu_prime * self.normal_load;
        let Dashpots { damping, viscous } = self.dashpots;
        if damping == 0.0 && viscous == 0.0 {
            return slope;
        }
        let rounding = mu_prime.mul_add(self.normal_load, -slope);
        let (sum, first) = two_sum(slope, damping);
        let (sum, second) = two_sum(sum, viscous);
        sum + (rounding + first + second)
    }

    /// How the groups before that step grow with their parameters: b per μ_K′, a_v per α_v, a_n per
    /// α_N.
    #[must_use]
    pub(crate) fn groups_per_parameter(&self, sliding: SlidingPoint) -> Groups {
        Groups {
            b: self.normal_load / self.damping_unit,
            a_v: self.time_unit,
            a_n: sliding.mu_k / self.stiffness,
        }
    }
}

/// The sum of two numbers, and what it lacks by rounding (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// Gains of the delayed feedback (the letter's Eq. 2); both may act at once.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Control {
    /// α_v, 1/time: pulling velocity per elongation difference.
    pub alpha_v: f64,
    /// α_N, force/length: normal load per elongation difference.
    pub alpha_n: f64,
}

impl Control {
    /// Whether any gain acts.
    #[must_use]
    pub fn act(&self) -> bool {
        self.alpha_v != 0.0 || self.alpha_n != 0.0
    }
}

/// Value and slope of the kinetic friction coefficient at the sliding velocity v0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingPoint {
    /// μ_K(v0), dimensionless.
    pub mu_k: f64,
    /// μ_K′(v0), time/length.
    pub mu_prime: f64,
}

impl SlidingPoint {
    /// Value and slope of `law` at the sliding velocity `v0` > 0.
    ///
    /// # Errors
    /// `v0` must be finite and greater than zero: the model is linear only about steady forward
    /// sliding. So must μ_K be there.
    pub fn of_law(law: &FrictionLaw, v0: f64) -> Result<Self, ModelError> {
        let v0 = ModelError::positive("v0", v0)?;
        Ok(Self {
            mu_k: law.posed_at(v0)?,
            mu_prime: law.slope_at(v0)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slopes next to those that dashpots cancel: the sign is that of whole numbers.
    #[test]
    fn the_sign_of_the_damping_survives_cancellation() {
        let unit = 2.0_f64.powi(-30);
        // μ′ N0 + c + c_g in units of 2⁻⁶⁰, all factors being whole numbers below 2⁵³.
        for (slope, load, damping, viscous) in [
            (
                -999_999_937_i64,
                1_000_000_007_i64,
                500_000_000_i64,
                431_322_575_i64,
            ),
            (-836_448_598, 2_297_807_411, 998_580_000, 791_430_000),
            (-322_122_547, 1_073_741_824, 107_374_182, 214_748_365),
        ] {
            for off in -2..=2 {
                let exact = i128::from(slope) * i128::from(load)
                    + i128::from(damping + viscous + off) * (1 << 30);
                let block = Oscillator::new(1.3, 0.7, load as f64 * unit).unwrap();
                let dashpots = Dashpots {
                    damping: damping as f64 * unit,
                    viscous: (viscous + off) as f64 * unit,
                };
                let sliding = SlidingPoint {
                    mu_k: 0.5,
                    mu_prime: slope as f64 * unit,
                };
                let groups = block
                    .damped(dashpots)
                    .unwrap()
                    .groups(sliding, Control::default());
                let sign = groups.b.partial_cmp(&0.0).unwrap();
                assert_eq!(sign, exact.cmp(&0), "{slope} {load} {off} {}", groups.b);
            }
        }
    }
}
