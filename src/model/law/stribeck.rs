//! Stribeck's law with a Gaussian transition, μ_K = μ0 + (μ_S − μ0) exp(−(v/v_s)²).

use super::discs::resolved;
use super::formula::Operand;
use super::hyperbolic::transition;
use super::{Form, FrictionLaw, Kind, Law, Made, Range, Series, checked_coefficients, hull};
use crate::model::ModelError;
use crate::model::elementary::{exp, ln, power};
use crate::model::series::{Coefficients, MOST_ORDER, PER_NEXT, product};

/// The Gaussian is below rounding beyond this, in units of v_s.
const FLANK: f64 = 6.0;

/// Stribeck's law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stribeck {
    /// μ0.
    pub mu0: f64,
    /// v_s, length/time.
    pub v_s: f64,
    /// μ_S.
    pub mu_s: f64,
}

impl FrictionLaw {
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
        Ok(Self::new(Kind::Stribeck(Stribeck { mu0, v_s, mu_s }), mu_s))
    }
}

impl FrictionLaw {
    /// Stribeck's law with any exponent δ and a viscous part,
    /// μ_K(v) = μ0 + (μ_S − μ0) exp(−(v/v_s)^δ) + σ v.
    ///
    /// # Errors
    /// As [`FrictionLaw::stribeck`]. `exponent` δ must be finite and positive, and
    /// `viscous_coefficient` σ, time/length, finite and at least 0.
    pub fn stribeck_with(
        mu0: f64,
        v_s: f64,
        mu_s: f64,
        (exponent, viscous_coefficient): (f64, f64),
    ) -> Result<Self, ModelError> {
        let exponent = ModelError::positive("exponent", exponent)?;
        transition(mu0, v_s, mu_s, viscous_coefficient, |make, s| {
            let power = make.power(s, Operand::Number(exponent));
            let negative = make.negative(power);
            make.exp(negative)
        })
    }
}

fn gaussian(s: f64) -> f64 {
    exp(-s * s)
}

impl Law for Stribeck {
    type Series = StribeckSeries;

    const FORM: Option<&'static Form> = Some(&Form {
        name: "stribeck",
        formula: "μ_K = μ0 + (μ_S − μ0) exp(−(v/v_s)^δ) + σ v, with δ = 2 and σ = 0 unless given",
        parameters: &["mu0", "v_s"],
        needed: 2,
        optional: &["mu_s", "exponent", "viscous_coefficient"],
        law: Made::OfVelocity(|of| match of[3..] {
            [2.0, 0.0] => FrictionLaw::stribeck(of[0], of[1], of[2]),
            _ => FrictionLaw::stribeck_with(of[0], of[1], of[2], (of[3], of[4])),
        }),
    });

    fn mu_k(&self, speed: f64) -> f64 {
        self.mu0 + (self.mu_s - self.mu0) * gaussian(speed / self.v_s)
    }

    fn mu_prime(&self, speed: f64) -> f64 {
        let s = speed / self.v_s;
        -2.0 * (self.mu_s - self.mu0) * s / self.v_s * gaussian(s)
    }

    /// Far above v_s nothing is left of the Gaussian until its flank comes near.
    fn speed_scale(&self, speed: f64) -> f64 {
        self.v_s.max(speed - FLANK * self.v_s)
    }

    /// Steepest at v_s/√2.
    fn slopes_between(&self, from: f64, to: f64) -> Range {
        let ends = [from, to].map(|v| self.mu_prime(v));
        let steepest = self.v_s * std::f64::consts::FRAC_1_SQRT_2;
        let inside = (from < steepest && steepest < to).then(|| self.mu_prime(steepest));
        hull(ends.into_iter().chain(inside))
    }

    /// Extreme at rest and at v_s √(3/2).
    fn curvatures_between(&self, from: f64, to: f64) -> Range {
        let Self { mu0, v_s, mu_s } = *self;
        let at = |s: f64| 2.0 * (mu_s - mu0) / (v_s * v_s) * (2.0 * s * s - 1.0) * exp(-s * s);
        let extreme = 1.5_f64.sqrt();
        let (low, high) = (from / v_s, to / v_s);
        let inside = (low < extreme && extreme < high).then(|| at(extreme));
        hull([at(low), at(high)].into_iter().chain(inside))
    }

    fn series(&self, velocity_unit: f64) -> StribeckSeries {
        let zero = [0.0; MOST_ORDER + 1];
        StribeckSeries {
            mu0: self.mu0,
            fall: self.mu_s - self.mu0,
            per_v_s: velocity_unit / self.v_s,
            coefficients: zero,
            scaled: zero,
            slope: zero,
            gaussian: zero,
        }
    }
}

/// m n with m = μ0 + (μ_S − μ0) g and Stribeck's Gaussian g = exp(−y), y = (ẋ/v_s)², which obeys g′
/// = −y′g.
#[derive(Debug, Clone)]
pub(crate) struct StribeckSeries {
    mu0: f64,
    fall: f64,
    per_v_s: f64,
    coefficients: Coefficients,
    /// ẋ/v_s.
    scaled: Coefficients,
    /// y′.
    slope: Coefficients,
    gaussian: Coefficients,
}

impl Series for StribeckSeries {
    #[inline(always)]
    fn extend(&mut self, k: usize, speed: f64, load: &Coefficients) -> f64 {
        self.scaled[k] = speed * self.per_v_s;
        let square = product(&self.scaled, &self.scaled, k);
        self.coefficients[k] = if k == 0 {
            self.gaussian[0] = exp(-square);
            self.mu0 + self.fall * self.gaussian[0]
        } else {
            self.slope[k - 1] = k as f64 * square;
            self.gaussian[k] = -product(&self.slope, &self.gaussian, k - 1) * PER_NEXT[k - 1];
            self.fall * self.gaussian[k]
        };
        product(&self.coefficients, load, k)
    }

    /// Coefficient k of the Gaussian about z = ẋ/v_s is a Hermite function. Up to z² = 2k these
    /// functions oscillate, and show how large those of higher order are. Beyond that the first
    /// ones are as small as exp(−z²) whatever the later ones are. There bounds on discs are used.
    fn resolved(&self, speed: &[f64], length: f64, error: f64) -> f64 {
        let order = (speed.len() - 1) as f64;
        let centre = self.scaled[0].abs();
        if centre * centre <= order || self.fall == 0.0 || !length.is_finite() {
            return length;
        }
        let largest = |off: f64| largest_exponent(centre, off * self.per_v_s);
        resolved(speed, length, ln(error / self.fall), largest)
    }
}

/// The largest real part of −z² over a disc of radius `off` about `centre` ≥ 0.
fn largest_exponent(centre: f64, off: f64) -> f64 {
    if 2.0 * off < centre {
        -power(centre - off, 2)
    } else {
        off * off - 0.5 * centre * centre
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::series::value;

    #[test]
    fn the_gaussian_is_bounded_on_discs() {
        for (centre, off) in [(5.0, 1.0), (5.0, 2.4), (5.0, 2.6), (3.0, 9.0), (0.0, 2.0)] {
            let on_circle = (0..4000).map(|i| {
                let z = num_complex::Complex64::from_polar(off, f64::from(i) * 1e-3 * 1.6) + centre;
                (-z * z).re
            });
            let largest = on_circle.fold(f64::NEG_INFINITY, f64::max);
            let bound = largest_exponent(centre, off);
            assert!(
                (bound - largest).abs() < 1e-3 * bound.abs(),
                "{centre} {off}: {bound} {largest}"
            );
        }
    }

    /// A speed that falls onto the flank of the Gaussian from far above it: no step is longer than
    /// the series holds.
    #[test]
    fn no_step_passes_over_the_flank() {
        let (fall, v_s) = (0.6, 0.1);
        let law = Stribeck {
            mu0: 0.4,
            v_s,
            mu_s: 1.0,
        };
        let mut load = [0.0; MOST_ORDER + 1];
        load[0] = 1.0;
        for from in [0.3, 0.5, 0.7, 1.0, 3.0, 10.0] {
            for order in [4, 8, 16, 20] {
                let mut series = law.series(1.0);
                // ẋ falls as a parabola, and is 0 at s = 1.
                let mut speed = [0.0; MOST_ORDER + 1];
                (speed[0], speed[1], speed[2]) = (from, -0.5 * from, -0.5 * from);
                let mut coefficients = [0.0; MOST_ORDER + 1];
                for k in 0..order {
                    coefficients[k] = series.extend(k, speed[k], &load);
                }
                let error = 1e-10;
                let length = series.resolved(&speed[..=order], 1.0, error);
                if from * from <= order as f64 * v_s * v_s {
                    assert_eq!(length, 1.0);
                    continue;
                }
                let shortest = if order < 8 { 1e-4 } else { 0.01 };
                assert!(length > shortest, "{from} {order}: {length}");
                for part in [0.3, 0.7, 0.9, 1.0] {
                    let s = part * length;
                    let z = value(&speed[..=order], s) / v_s;
                    let off = value(&coefficients[..order], s) - 0.4 - fall * (-z * z).exp();
                    assert!(
                        off.abs() <= error,
                        "{from} {order}: {off:e} at {s} of {length}"
                    );
                }
            }
        }
    }
}
