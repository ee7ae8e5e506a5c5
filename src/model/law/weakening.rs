//! The letter's velocity weakening, μ_K = μ0/(1 + v/v_s).

use super::{Form, FrictionLaw, Kind, Law, Made, Range, Series, checked_coefficients, hull};
use crate::model::ModelError;
use crate::model::elementary::power;
use crate::model::series::{Coefficients, MOST_ORDER, product};

/// How far below speed 0 the law is continued, in units of v_s; its pole is at −v_s.
const BELOW_REST: f64 = 0.5;

/// Velocity weakening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weakening {
    /// μ0.
    pub mu0: f64,
    /// v_s, length/time.
    pub v_s: f64,
}

impl FrictionLaw {
    /// The letter's velocity weakening, μ_K(v) = μ0 / (1 + v/v_s).
    ///
    /// # Errors
    /// μ0, v_s and μ_S must be finite and positive, and μ0 = μ_K(0⁺) ≤ μ_S.
    pub fn weakening(mu0: f64, v_s: f64, mu_s: f64) -> Result<Self, ModelError> {
        let (mu0, mu_s) = checked_coefficients(mu0, mu_s)?;
        let v_s = ModelError::positive("v_s", v_s)?;
        Ok(Self::new(Kind::Weakening(Weakening { mu0, v_s }), mu_s))
    }
}

/// μ0 and v_s: each as given, or from the other and the slope at rest, which comes third.
fn mu0_and_v_s(given: &[f64]) -> (f64, f64) {
    let (mu0, v_s, slope) = (given[0], given[1], given[2]);
    match (mu0.is_nan(), v_s.is_nan()) {
        (true, false) => (-slope * v_s, v_s),
        (false, true) => (mu0, -mu0 / slope),
        _ => (mu0, v_s),
    }
}

impl Law for Weakening {
    type Series = WeakeningSeries;

    const FORM: Option<&'static Form> = Some(&Form {
        name: "weakening",
        formula: "μ_K = μ0/(1 + v/v_s)",
        parameters: &["mu0", "v_s", "mu_prime_rest"],
        needed: 2,
        optional: &["mu_s"],
        law: Made::OfVelocity(|of| {
            let (mu0, v_s) = mu0_and_v_s(of);
            FrictionLaw::weakening(mu0, v_s, of[3])
        }),
    });

    fn mu_k(&self, speed: f64) -> f64 {
        self.mu0 / (1.0 + speed / self.v_s)
    }

    fn mu_prime(&self, speed: f64) -> f64 {
        let s = 1.0 + speed / self.v_s;
        -self.mu0 / (self.v_s * s * s)
    }

    fn speed_scale(&self, speed: f64) -> f64 {
        self.v_s + speed
    }

    fn least_speed(&self) -> f64 {
        -BELOW_REST * self.v_s
    }

    fn slopes_between(&self, from: f64, to: f64) -> Range {
        hull([from, to].map(|v| self.mu_prime(v)))
    }

    fn curvatures_between(&self, from: f64, to: f64) -> Range {
        let Self { mu0, v_s } = *self;
        hull([from, to].map(|v| 2.0 * mu0 / (v_s * v_s * power(1.0 + v / v_s, 3))))
    }

    fn series(&self, velocity_unit: f64) -> WeakeningSeries {
        WeakeningSeries {
            mu0: self.mu0,
            per_v_s: velocity_unit / self.v_s,
            friction: [0.0; MOST_ORDER + 1],
            q: [0.0; MOST_ORDER + 1],
            inverse: 1.0,
        }
    }
}

/// f with f q = μ0 n, q = 1 + |ẋ|/v_s.
#[derive(Debug, Clone)]
pub(crate) struct WeakeningSeries {
    mu0: f64,
    per_v_s: f64,
    friction: Coefficients,
    /// q without its first coefficient, and the inverse of the first coefficient.
    q: Coefficients,
    inverse: f64,
}

impl Series for WeakeningSeries {
    #[inline(always)]
    fn extend(&mut self, k: usize, speed: f64, load: &Coefficients) -> f64 {
        self.friction[k] = if k == 0 {
            self.inverse = 1.0 / (1.0 + speed * self.per_v_s);
            self.mu0 * load[0] * self.inverse
        } else {
            self.q[k - 1] = speed * self.per_v_s;
            (self.mu0 * load[k] - product(&self.q, &self.friction, k - 1)) * self.inverse
        };
        self.friction[k]
    }

    fn resolved(&self, _: &[f64], length: f64, _: f64) -> f64 {
        length
    }
}
