//! How a characteristic root moves with the parameters: the implicit-function theorem.

use num_complex::Complex64;

use super::characteristic::Jet;
use super::feedback_loop::PerGroup;
use crate::model::Groups;

/// Derivatives of a root λ with respect to the dimensionless groups and the delay. Their real parts
/// are the derivatives of the abscissa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sensitivity {
    /// ∂λ/∂b.
    pub b: Complex64,
    /// ∂λ/∂a_v.
    pub a_v: Complex64,
    /// ∂λ/∂a_n.
    pub a_n: Complex64,
    /// ∂λ/∂τ.
    pub tau: Complex64,
}

impl Sensitivity {
    /// At the root `lambda`: ∂λ/∂q = −(∂D/∂q)/(∂D/∂λ), with
    ///
    /// ```text
    /// ∂D/∂b = λ − a_v (1 − E),   ∂D/∂a_v = −(b + λ)(1 − E),   ∂D/∂a_n = −(1 − E),   ∂D/∂τ = −A λ E
    /// ```
    ///
    /// Infinite or NaN at a double root, where the root is not differentiable.
    #[must_use]
    pub(crate) fn of(groups: Groups, tau: f64, lambda: Complex64) -> Self {
        let jet = Jet::at(groups, tau, lambda);
        let per = PerGroup {
            b: lambda - groups.a_v * jet.difference,
            a_v: -(groups.b + lambda) * jet.difference,
            a_n: -jet.difference,
        };
        Self::by_derivatives(&jet, per, lambda)
    }

    /// These derivatives where a_n falls by d a_v, as with a dashpot beside the spring: a_v is then
    /// ∂λ/∂a_v − d ∂λ/∂a_n.
    #[must_use]
    pub(crate) fn coupled(self, damping: f64) -> Self {
        if damping == 0.0 {
            return self;
        }
        Self {
            a_v: self.a_v - damping * self.a_n,
            ..self
        }
    }

    /// At the root `lambda` of an equation with the jet `jet` there, from the derivatives of D with
    /// respect to the groups.
    #[must_use]
    pub(crate) fn by_derivatives(jet: &Jet, per: PerGroup, lambda: Complex64) -> Self {
        let per_slope = -1.0 / jet.first;
        Self {
            b: per.b * per_slope,
            a_v: per.a_v * per_slope,
            a_n: per.a_n * per_slope,
            tau: -jet.feedback * lambda * jet.delayed * per_slope,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::newton::polish;

    #[test]
    fn derivatives_match_difference_quotients() {
        let at = [-0.4, 0.7, -1.3, 2.5];
        let root = |q: [f64; 4], near: Complex64| {
            polish(Groups::new(q[0], q[1], q[2]), q[3], near)
                .expect("near a root")
                .lambda
        };
        let lambda = root(at, Complex64::new(0.3, 1.1));
        let found = Sensitivity::of(Groups::new(at[0], at[1], at[2]), at[3], lambda);
        for (i, derivative) in [found.b, found.a_v, found.a_n, found.tau]
            .into_iter()
            .enumerate()
        {
            let h = 1e-6;
            let shifted = |by: f64| {
                let mut q = at;
                q[i] += by;
                root(q, lambda)
            };
            let numeric = (shifted(h) - shifted(-h)) / (2.0 * h);
            assert!(
                (numeric - derivative).norm() < 1e-8,
                "{i}: {numeric} {derivative}"
            );
        }
    }
}
