//! Coulomb's law, μ_K = μ0: the same at all speeds.

use super::{Form, FrictionLaw, Kind, Law, Made, Range, Series, checked_coefficients};
use crate::model::ModelError;
use crate::model::series::Coefficients;

/// Coulomb's law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coulomb {
    /// μ0.
    pub mu0: f64,
}

impl FrictionLaw {
    /// Coulomb's law, μ_K(v) = μ0.
    ///
    /// # Errors
    /// μ0 and μ_S must be finite and positive, and μ0 ≤ μ_S.
    pub fn coulomb(mu0: f64, mu_s: f64) -> Result<Self, ModelError> {
        let (mu0, mu_s) = checked_coefficients(mu0, mu_s)?;
        Ok(Self::new(Kind::Coulomb(Coulomb { mu0 }), mu_s))
    }
}

impl Law for Coulomb {
    type Series = Self;

    const FORM: Option<&'static Form> = Some(&Form {
        name: "coulomb",
        formula: "μ_K = μ0",
        parameters: &["mu0"],
        needed: 1,
        optional: &["mu_s"],
        law: Made::OfVelocity(|of| FrictionLaw::coulomb(of[0], of[1])),
    });

    fn mu_k(&self, _: f64) -> f64 {
        self.mu0
    }

    fn mu_prime(&self, _: f64) -> f64 {
        0.0
    }

    fn speed_scale(&self, _: f64) -> f64 {
        f64::INFINITY
    }

    fn slopes_between(&self, _: f64, _: f64) -> Range {
        (0.0, 0.0)
    }

    fn curvatures_between(&self, _: f64, _: f64) -> Range {
        (0.0, 0.0)
    }

    fn series(&self, _: f64) -> Self {
        *self
    }
}

impl Series for Coulomb {
    #[inline(always)]
    fn extend(&mut self, k: usize, _: f64, load: &Coefficients) -> f64 {
        self.mu0 * load[k]
    }

    fn resolved(&self, _: &[f64], length: f64, _: f64) -> f64 {
        length
    }
}
