//! The Taylor series of the friction coefficient along a motion.

use super::series::{Coefficients, MOST_ORDER, product};
use crate::model::FrictionLaw;
use crate::model::friction::Kind;

/// Coefficients of μ_K(|ẋ(s)|), grown one by one as those of the speed become known.
///
/// With q = 1 + |ẋ|/v_s weakening is m q = μ0; Stribeck's Gaussian g = exp(−y), y = (ẋ/v_s)², obeys g′ = −y′g.
#[derive(Debug, Clone)]
pub(super) struct FrictionSeries {
    kind: Kind,
    /// m.
    pub coefficients: Coefficients,
    /// q or ẋ/v_s.
    scaled: Coefficients,
    /// y and g of Stribeck's law.
    square: Coefficients,
    gaussian: Coefficients,
}

impl FrictionSeries {
    /// For `law`, with ẋ in units of `velocity_unit`.
    pub fn new(law: &FrictionLaw, velocity_unit: f64) -> Self {
        let kind = match law.kind() {
            Kind::Coulomb { mu0 } => Kind::Coulomb { mu0 },
            Kind::Weakening { mu0, v_s } => Kind::Weakening {
                mu0,
                v_s: v_s / velocity_unit,
            },
            Kind::Stribeck { mu0, v_s, mu_s } => Kind::Stribeck {
                mu0,
                v_s: v_s / velocity_unit,
                mu_s,
            },
        };
        let zero = [0.0; MOST_ORDER + 1];
        Self {
            kind,
            coefficients: zero,
            scaled: zero,
            square: zero,
            gaussian: zero,
        }
    }

    /// Whether the friction coefficient is the same at every speed.
    pub fn is_constant(&self) -> bool {
        matches!(self.kind, Kind::Coulomb { .. })
    }

    /// Coefficient `k`; `speed` is coefficient k of |ẋ|, and the smaller ones were given before.
    #[inline(always)]
    pub fn extend(&mut self, k: usize, speed: f64) {
        self.coefficients[k] = match self.kind {
            Kind::Coulomb { mu0 } => {
                if k == 0 {
                    mu0
                } else {
                    0.0
                }
            }
            Kind::Weakening { mu0, v_s } => {
                self.scaled[k] = speed / v_s;
                if k == 0 {
                    self.scaled[0] += 1.0;
                    mu0 / self.scaled[0]
                } else {
                    let rest = product(&self.scaled[1..], &self.coefficients, k - 1);
                    -rest / self.scaled[0]
                }
            }
            Kind::Stribeck { mu0, v_s, mu_s } => {
                self.scaled[k] = speed / v_s;
                self.square[k] = product(&self.scaled, &self.scaled, k);
                self.gaussian[k] = if k == 0 {
                    (-self.square[0]).exp()
                } else {
                    let terms = (1..=k).map(|j| j as f64 * self.square[j] * self.gaussian[k - j]);
                    -terms.sum::<f64>() / k as f64
                };
                (mu_s - mu0) * self.gaussian[k] + if k == 0 { mu0 } else { 0.0 }
            }
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::series::value;
    use super::*;

    #[test]
    fn the_series_is_the_law_along_a_motion() {
        let laws = [
            FrictionLaw::coulomb(0.4, 1.0).unwrap(),
            FrictionLaw::weakening(0.5, 0.7, 1.0).unwrap(),
            FrictionLaw::stribeck(0.3, 0.2, 0.9).unwrap(),
        ];
        // Speed 0.3 + 0.2 s − 0.1 s², in units of 2.
        let speed = [0.15, 0.1, -0.05];
        for law in laws {
            let mut series = FrictionSeries::new(&law, 2.0);
            for k in 0..=MOST_ORDER {
                series.extend(k, speed.get(k).copied().unwrap_or(0.0));
            }
            for s in [0.0, 0.05, 0.1] {
                let exact = law.mu_k(0.3 + 0.2 * s - 0.1 * s * s);
                assert!(
                    (value(&series.coefficients, s) - exact).abs() < 1e-13,
                    "{law:?} {s}"
                );
            }
        }
    }
}
