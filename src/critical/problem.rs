//! What is asked: the controlled oscillator whose critical velocity is looked for.

use crate::linear::rightmost::Rightmost;
use crate::linear::{Count, Crossings, MarginalTolerance};
use crate::model::friction::Kind;
use crate::model::{FrictionLaw, Groups};
use crate::slip::motion::{Accuracy, Motion, Parameters};
use crate::slip::stop::Stop;

/// A controlled oscillator whose critical velocity is asked for, in the units of
/// [`crate::slip::motion`].
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The friction law.
    pub law: FrictionLaw,
    /// N0/√(κM), the unit of velocity in which the law's speeds are given.
    pub velocity_unit: f64,
    /// α_v √(M/κ).
    pub alpha_v: f64,
    /// α_N/κ.
    pub alpha_n: f64,
    /// τ √(κ/M).
    pub tau: f64,
    /// What ends the search: its answer then means nothing.
    pub stop: Stop,
}

impl Problem {
    /// A motion's parameters at `v0`, with control from `switch_on` on.
    #[must_use]
    pub fn at(&self, v0: f64, switch_on: f64) -> Parameters {
        let controlled = self.alpha_v != 0.0 || self.alpha_n != 0.0;
        Parameters {
            law: self.law.clone(),
            velocity_unit: self.velocity_unit,
            alpha_v: self.alpha_v,
            alpha_n: self.alpha_n,
            tau: self.tau,
            v0,
            switch_on: if controlled { switch_on } else { f64::INFINITY },
        }
    }

    /// A block at rest at `v0`, under control from t = 0 on.
    pub(super) fn at_rest(&self, v0: f64, accuracy: Accuracy) -> Motion {
        Motion::new(self.at(v0, 0.0), accuracy, 0.0, 0.0).heeding(self.stop.clone())
    }

    /// How long to wait for a motion's outcome at `v0`: transients, many delays, and thirty of the
    /// longest cycles.
    pub(super) fn patience(&self, v0: f64) -> f64 {
        let longest_cycle = 2.0 * self.law.mu_s() / v0 + 10.0;
        600.0 + 20.0 * self.tau + 30.0 * longest_cycle
    }

    /// The groups of linear stability at `v0`.
    #[must_use]
    pub fn groups(&self, v0: f64) -> Groups {
        let speed = v0 * self.velocity_unit;
        Groups::new(
            self.law.mu_prime(speed) * self.velocity_unit,
            self.alpha_v,
            self.law.mu_k(speed) * self.alpha_n,
        )
    }

    /// The number of unstable roots of sliding at `v0`.
    #[must_use]
    pub fn count(&self, v0: f64) -> Count {
        Crossings::of(self.groups(v0)).count(self.tau, MarginalTolerance::default())
    }

    /// The spectral abscissa of sliding at `v0`, if it is stable.
    #[must_use]
    pub fn stable_abscissa(&self, v0: f64) -> Option<f64> {
        let count = self.count(v0);
        if !count.stable() {
            return None;
        }
        let rightmost = Rightmost::at(self.groups(v0), self.tau, 1, count);
        let root = rightmost.roots.first().filter(|_| rightmost.certified);
        root.map(|root| root.lambda.re)
            .filter(|abscissa| *abscissa < 0.0)
    }

    /// Without control, under Coulomb friction, stick-slip persists at every v0: a slip from a =
    /// μ_S goes half round the circle about sliding and comes to a stop at a = 2 μ_K − μ_S, where
    /// the block sticks.
    pub(super) fn persists_without_control(&self) -> bool {
        let uncontrolled = self.alpha_v == 0.0 && self.alpha_n == 0.0;
        let mu_s = self.law.mu_s();
        uncontrolled && matches!(self.law.kind(), Kind::Coulomb { mu0 } if *mu0 < mu_s)
    }
}
