//! Laws that fall from μ_S at rest to μ0, and rise by a viscous part: by any transition, and by
//! 1/cosh.

use super::formula::{Builder, Node, Operand};
use super::{Form, FrictionLaw, Made, checked_coefficients};
use crate::model::ModelError;
use crate::model::elementary::cosh;

/// The row of the law with 1/cosh where laws are named.
pub(super) const FORM: Form = Form {
    name: "hyperbolic",
    formula: "μ_K = μ0 + (μ_S − μ0)/cosh(v/v_s) + σ v, with σ = 0 unless given",
    parameters: &["mu0", "v_s"],
    needed: 2,
    optional: &["mu_s", "viscous_coefficient"],
    law: Made::OfVelocity(|of| FrictionLaw::hyperbolic(of[0], of[1], of[2], of[3])),
};

impl FrictionLaw {
    /// A hyperbolic transition with a viscous part, μ_K(v) = μ0 + (μ_S − μ0)/cosh(v/v_s) + σ v.
    ///
    /// # Errors
    /// μ0, v_s and μ_S must be finite and positive, μ0 ≤ μ_S, and `viscous_coefficient` σ,
    /// time/length, finite and at least 0.
    pub fn hyperbolic(
        mu0: f64,
        v_s: f64,
        mu_s: f64,
        viscous_coefficient: f64,
    ) -> Result<Self, ModelError> {
        transition(mu0, v_s, mu_s, viscous_coefficient, |make, s| {
            let divisor = make.function(s, cosh, Node::Cosh);
            make.quotient(Operand::Number(1.0), divisor)
        })
    }
}

/// The law μ0 + (μ_S − μ0) f(v/v_s) + σ v, with f(0) = 1.
pub(super) fn transition(
    mu0: f64,
    v_s: f64,
    mu_s: f64,
    viscous_coefficient: f64,
    shape: impl FnOnce(&mut Builder, Operand) -> Operand,
) -> Result<FrictionLaw, ModelError> {
    let (mu0, mu_s) = checked_coefficients(mu0, mu_s)?;
    let v_s = ModelError::positive("v_s", v_s)?;
    let name = "viscous_coefficient";
    let allowed = "a finite number of 0 or more";
    let viscous = ModelError::check(
        name,
        viscous_coefficient,
        allowed,
        viscous_coefficient >= 0.0,
    )?;
    let mut make = Builder::default();
    let speed = make.speed();
    let scaled = make.quotient(speed, Operand::Number(v_s));
    let shape = shape(&mut make, scaled);
    let fall = make.product(Operand::Number(mu_s - mu0), shape);
    let dry = make.sum(Operand::Number(mu0), fall);
    let wet = make.product(Operand::Number(viscous), speed);
    let whole = match viscous {
        0.0 => dry,
        _ => make.sum(dry, wet),
    };
    let formula = make.finish(whole).expect("a law of ten nodes");
    FrictionLaw::formula(formula, mu_s)
}
