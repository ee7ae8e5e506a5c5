//! Kinetic friction laws μ_K(v), each with value and slope.

use super::error::AT_MOST_MU_S;
use super::{ModelError, Table};
use crate::model::elementary::exp;

/// A law of kinetic friction together with the static coefficient μ_S that goes with it.
///
/// Every law is a function of the sliding speed |ẋ| > 0; the force points against the motion.
/// A law with μ_K(0⁺) > μ_S is refused: release from stick would accelerate backwards.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionLaw {
    kind: Kind,
    mu_s: f64,
}

/// The form of a law, with its parameters in the symbols of the constructors of [`FrictionLaw`].
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// μ_K = μ0.
    Coulomb {
        /// μ0.
        mu0: f64,
    },
    /// μ_K = μ0/(1 + v/v_s).
    Weakening {
        /// μ0.
        mu0: f64,
        /// v_s, length/time.
        v_s: f64,
    },
    /// μ_K = μ0 + (μ_S − μ0) exp(−(v/v_s)²).
    Stribeck {
        /// μ0.
        mu0: f64,
        /// v_s, length/time.
        v_s: f64,
        /// μ_S.
        mu_s: f64,
    },
    /// A curve through measured points.
    Table(Table),
}

impl FrictionLaw {
    /// Coulomb's law, μ_K(v) = μ0.
    ///
    /// # Errors
    /// μ0 and μ_S must be finite and positive, and μ0 ≤ μ_S.
    pub fn coulomb(mu0: f64, mu_s: f64) -> Result<Self, ModelError> {
        let (mu0, mu_s) = checked_coefficients(mu0, mu_s)?;
        Ok(Self {
            kind: Kind::Coulomb { mu0 },
            mu_s,
        })
    }

    /// The letter's velocity weakening, μ_K(v) = μ0 / (1 + v/v_s).
    ///
    /// # Errors
    /// μ0, v_s and μ_S must be finite and positive, and μ0 = μ_K(0⁺) ≤ μ_S.
    pub fn weakening(mu0: f64, v_s: f64, mu_s: f64) -> Result<Self, ModelError> {
        let (mu0, mu_s) = checked_coefficients(mu0, mu_s)?;
        let v_s = ModelError::positive("v_s", v_s)?;
        Ok(Self {
            kind: Kind::Weakening { mu0, v_s },
            mu_s,
        })
    }

    /// Stribeck's law with a Gaussian transition, μ_K(v) = μ0 + (μ_S − μ0) exp(−(v/v_s)²):
    /// from μ_S at rest down to the Coulomb level μ0 at speeds well above v_s.
    ///
    /// Source: H. Olsson et al., *Friction models and friction compensation*, Eur. J. Control 4
    /// (1998), with exponent 2 and no viscous part.
    ///
    /// # Errors
    /// μ0, v_s and μ_S must be finite and positive, and μ0 ≤ μ_S.
    pub fn stribeck(mu0: f64, v_s: f64, mu_s: f64) -> Result<Self, ModelError> {
        let (mu0, mu_s) = checked_coefficients(mu0, mu_s)?;
        let v_s = ModelError::positive("v_s", v_s)?;
        Ok(Self {
            kind: Kind::Stribeck { mu0, v_s, mu_s },
            mu_s,
        })
    }

    /// A measured curve.
    ///
    /// # Errors
    /// μ_S must be finite and positive, and at least μ_K(0⁺), the first coefficient of the table.
    pub fn table(table: Table, mu_s: f64) -> Result<Self, ModelError> {
        let mu_s = ModelError::positive("mu_s", mu_s)?;
        checked_at_rest("mu_k", table.mu_k()[0], mu_s)?;
        Ok(Self {
            kind: Kind::Table(table),
            mu_s,
        })
    }

    /// The form of the law and its parameters.
    #[must_use]
    pub fn kind(&self) -> &Kind {
        &self.kind
    }

    /// μ_S.
    #[must_use]
    pub fn mu_s(&self) -> f64 {
        self.mu_s
    }

    /// μ_K(v), dimensionless, at the sliding speed `speed` ≥ 0 (at 0: the limit 0⁺).
    #[must_use]
    pub fn mu_k(&self, speed: f64) -> f64 {
        match &self.kind {
            &Kind::Coulomb { mu0 } => mu0,
            &Kind::Weakening { mu0, v_s } => mu0 / (1.0 + speed / v_s),
            &Kind::Stribeck { mu0, v_s, mu_s } => mu0 + (mu_s - mu0) * gaussian(speed / v_s),
            Kind::Table(table) => table.value(speed),
        }
    }

    /// μ_K′(v), time/length, at the sliding speed `speed` ≥ 0 (at 0: the limit 0⁺, the slope at
    /// rest).
    #[must_use]
    pub fn mu_prime(&self, speed: f64) -> f64 {
        match &self.kind {
            Kind::Coulomb { .. } => 0.0,
            &Kind::Weakening { mu0, v_s } => {
                let s = 1.0 + speed / v_s;
                -mu0 / (v_s * s * s)
            }
            &Kind::Stribeck { mu0, v_s, mu_s } => {
                let s = speed / v_s;
                -2.0 * (mu_s - mu0) * s / v_s * gaussian(s)
            }
            Kind::Table(table) => table.slope(speed),
        }
    }

    /// The change of speed over which μ_K changes its form, length/time, at the sliding speed
    /// `speed` ≥ 0. Steps of a method that knows the law only by its values have to be short
    /// against it. Infinite for Coulomb's law, and for a table, where steps end at the ends of its
    /// cubics.
    #[must_use]
    pub fn speed_scale(&self, speed: f64) -> f64 {
        match &self.kind {
            Kind::Coulomb { .. } | Kind::Table(_) => f64::INFINITY,
            Kind::Weakening { v_s, .. } => v_s + speed,
            // Far above v_s nothing is left of the Gaussian until its flank comes near.
            Kind::Stribeck { v_s, .. } => v_s.max(speed - FLANK * v_s),
        }
    }
}

/// The Gaussian of Stribeck's law is below rounding beyond this, in units of v_s.
const FLANK: f64 = 6.0;

fn gaussian(s: f64) -> f64 {
    exp(-s * s)
}

fn checked_coefficients(mu0: f64, mu_s: f64) -> Result<(f64, f64), ModelError> {
    let mu_s = ModelError::positive("mu_s", mu_s)?;
    let mu0 = ModelError::positive("mu0", mu0)?;
    checked_at_rest("mu0", mu0, mu_s)?;
    Ok((mu0, mu_s))
}

/// μ_K(0⁺) ≤ μ_S.
fn checked_at_rest(parameter: &'static str, at_rest: f64, mu_s: f64) -> Result<(), ModelError> {
    ModelError::check(parameter, at_rest, AT_MOST_MU_S, at_rest <= mu_s).map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> [FrictionLaw; 4] {
        let table = Table::new(vec![0.0, 0.3, 1.5, 3.0], vec![0.8, 0.4, 0.5, 0.6]).unwrap();
        [
            FrictionLaw::table(table, 1.0).unwrap(),
            FrictionLaw::coulomb(0.4, 1.0).unwrap(),
            FrictionLaw::weakening(0.5, 0.7, 1.0).unwrap(),
            FrictionLaw::stribeck(0.3, 0.2, 0.9).unwrap(),
        ]
    }

    #[test]
    fn slopes_are_the_derivatives_of_the_values() {
        for law in laws() {
            for v in [0.01, 0.1, 0.35, 1.0, 4.0] {
                let h = 1e-5 * v;
                let numeric = (law.mu_k(v + h) - law.mu_k(v - h)) / (2.0 * h);
                assert!(
                    (numeric - law.mu_prime(v)).abs() < 1e-8,
                    "{law:?} at {v}: {numeric}"
                );
            }
        }
    }

    /// Over a quarter of its scale of speed every law is nearly a cubic: fourth differences are
    /// small.
    #[test]
    fn a_law_is_smooth_over_its_scale_of_speed() {
        for law in laws().into_iter().skip(1) {
            for v in [0.0, 0.05, 0.35, 1.0, 1.3, 4.0] {
                let h = 0.25 * law.speed_scale(v).min(1.0) / 4.0;
                let at = |i: f64| law.mu_k(v + i * h);
                let fourth = at(0.0) - 4.0 * at(1.0) + 6.0 * at(2.0) - 4.0 * at(3.0) + at(4.0);
                assert!(fourth.abs() < 1e-3, "{law:?} at {v}: {fourth}");
            }
        }
    }

    #[test]
    fn limits_at_rest_and_at_high_speed() {
        let [table, coulomb, weakening, stribeck] = laws();
        assert_eq!((table.mu_k(0.0), table.mu_k(10.0)), (0.8, 0.6));
        assert!(table.mu_prime(0.0) < 0.0 && table.mu_prime(10.0) == 0.0);
        assert_eq!(coulomb.mu_k(0.0), 0.4);
        assert_eq!(weakening.mu_k(0.0), 0.5);
        assert_eq!(weakening.mu_prime(0.0), -0.5 / 0.7);
        assert!((stribeck.mu_k(0.0) - 0.9).abs() < 1e-15);
        assert_eq!(stribeck.mu_prime(0.0), 0.0);
        assert!((stribeck.mu_k(10.0) - 0.3).abs() < 1e-15);
    }

    #[test]
    fn ill_posed_laws_are_refused_by_name() {
        let error = FrictionLaw::weakening(1.2, 0.5, 1.0).unwrap_err();
        assert_eq!(error.parameter, "mu0");
        assert_eq!(
            FrictionLaw::stribeck(0.3, 0.0, 1.0).unwrap_err().parameter,
            "v_s"
        );
        assert_eq!(
            FrictionLaw::coulomb(f64::NAN, 1.0).unwrap_err().parameter,
            "mu0"
        );
        assert_eq!(
            FrictionLaw::coulomb(0.5, -1.0).unwrap_err().parameter,
            "mu_s"
        );
        let table = Table::new(vec![0.1, 1.0], vec![0.8, 0.4]).unwrap();
        let error = FrictionLaw::table(table, 0.7).unwrap_err();
        assert_eq!((error.parameter, error.value), ("mu_k", 0.8));
    }
}
