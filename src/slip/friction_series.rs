//! The Taylor series of the friction coefficient along a motion.

use super::series::{Coefficients, MOST_ORDER, PER_NEXT, product, spread};
use super::table_series::TableSeries;
use crate::model::FrictionLaw;
use crate::model::elementary::{exp, ln, power};
use crate::model::friction::Kind;

/// Coefficients of the friction μ_K(|ẋ|) n along a motion, grown one by one as those of speed and
/// load become known.
pub(super) trait Series {
    /// Coefficient `k`; `speed` is coefficient k of |ẋ|, and the smaller ones were given before.
    /// `load` is known up to k.
    fn extend(&mut self, k: usize, speed: f64, load: &Coefficients) -> f64;
}

/// A law's series, with its speeds in the motion's units. One type for each law, so that a step
/// asks only once which it is.
#[allow(
    clippy::large_enum_variant,
    reason = "one for each motion, and never moved"
)]
#[derive(Debug, Clone)]
pub(super) enum FrictionSeries {
    Coulomb(Coulomb),
    Weakening(Weakening),
    Stribeck(Stribeck),
    Table(TableSeries),
}

impl FrictionSeries {
    /// For `law` at the speed 0, with ẋ in units of `velocity_unit`.
    pub(super) fn new(law: &FrictionLaw, velocity_unit: f64) -> Self {
        let zero = [0.0; MOST_ORDER + 1];
        match law.kind() {
            &Kind::Coulomb { mu0 } => Self::Coulomb(Coulomb { mu0 }),
            &Kind::Weakening { mu0, v_s } => Self::Weakening(Weakening {
                mu0,
                per_v_s: velocity_unit / v_s,
                friction: zero,
                q: zero,
                inverse: 1.0,
            }),
            &Kind::Stribeck { mu0, v_s, mu_s } => Self::Stribeck(Stribeck {
                mu0,
                fall: mu_s - mu0,
                per_v_s: velocity_unit / v_s,
                coefficients: zero,
                scaled: zero,
                slope: zero,
                gaussian: zero,
            }),
            Kind::Table(table) => Self::Table(TableSeries::new(table, velocity_unit)),
        }
    }

    /// Restarts at `speed`, whatever the speed was before.
    pub(super) fn restart(&mut self, speed: f64) {
        if let Self::Table(series) = self {
            series.restart(speed);
        }
    }

    /// The longest step, at most `length`, on which the series of the law is accurate to `error`,
    /// relative to the load. `speed` holds the coefficients of ẋ.
    ///
    /// Coulomb's law and a cubic of a table are polynomials of the speed. The pole of velocity
    /// weakening shows in the growth of its coefficients. Only Stribeck's Gaussian can be missed by
    /// them.
    pub(super) fn resolved(&self, speed: &[f64], length: f64, error: f64) -> f64 {
        match self {
            Self::Stribeck(series) => series.resolved(speed, length, error),
            Self::Coulomb(_) | Self::Weakening(_) | Self::Table(_) => length,
        }
    }

    /// Takes over the place of `other`, the series of the same law.
    pub(super) fn copy_place(&mut self, other: &Self) {
        if let (Self::Table(series), Self::Table(other)) = (self, other) {
            series.copy_place(other);
        }
    }
}

/// A law that is the same at all speeds.
#[derive(Debug, Clone)]
pub(super) struct Coulomb {
    mu0: f64,
}

impl Series for Coulomb {
    #[inline(always)]
    fn extend(&mut self, k: usize, _: f64, load: &Coefficients) -> f64 {
        self.mu0 * load[k]
    }
}

/// f with f q = μ0 n, q = 1 + |ẋ|/v_s.
#[derive(Debug, Clone)]
pub(super) struct Weakening {
    mu0: f64,
    per_v_s: f64,
    friction: Coefficients,
    /// q without its first coefficient, and the inverse of the first coefficient.
    q: Coefficients,
    inverse: f64,
}

impl Series for Weakening {
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
}

/// m n with m = μ0 + (μ_S − μ0) g and Stribeck's Gaussian g = exp(−y), y = (ẋ/v_s)², which obeys g′
/// = −y′g.
#[derive(Debug, Clone)]
pub(super) struct Stribeck {
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

impl Series for Stribeck {
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
}

/// Radii of the discs on which the Gaussian is bounded, in units of the length of a step. Low
/// orders need large ones.
const DISCS: [f64; 8] = [1.25, 2.0, 3.0, 4.5, 10.0, 30.0, 100.0, 300.0];
/// A step on which the series may be inaccurate is shortened by this factor, at most so many times.
const SHORTER: f64 = 0.8;
const MOST_TIMES: u32 = 60;

impl Stribeck {
    /// See [`FrictionSeries::resolved`].
    ///
    /// Coefficient k of the Gaussian about z = ẋ/v_s is a Hermite function. Up to z² = 2k these
    /// functions oscillate, and show how large those of higher order are. Beyond that the first
    /// ones are as small as exp(−z²) whatever the later ones are. There Cauchy's estimate is used:
    /// on a disc of radius ρ the rest of a series of order N is at most M(ρ) (s/ρ)^N/(1 − s/ρ),
    /// where M is the largest absolute value on that disc.
    fn resolved(&self, speed: &[f64], length: f64, error: f64) -> f64 {
        let order = (speed.len() - 1) as f64;
        let centre = self.scaled[0].abs();
        if centre * centre <= order || self.fall == 0.0 || !length.is_finite() {
            return length;
        }
        let allowed = ln(error / self.fall);
        let rest = |length: f64, disc: &f64| {
            let off = spread(speed, disc * length) * self.per_v_s;
            largest_exponent(centre, off) - order * ln(*disc) - ln(1.0 - 1.0 / disc)
        };
        let mut length = length;
        for _ in 0..MOST_TIMES {
            if DISCS.iter().any(|disc| rest(length, disc) <= allowed) {
                return length;
            }
            length *= SHORTER;
        }
        length
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
    use super::super::series::value;
    use super::*;
    use crate::model::Table;

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
        let law = FrictionLaw::stribeck(0.4, v_s, 1.0).unwrap();
        let mut load = [0.0; MOST_ORDER + 1];
        load[0] = 1.0;
        for from in [0.3, 0.5, 0.7, 1.0, 3.0, 10.0] {
            for order in [4, 8, 16, 20] {
                let FrictionSeries::Stribeck(mut series) = FrictionSeries::new(&law, 1.0) else {
                    panic!("another law");
                };
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

    #[test]
    fn the_series_is_the_law_along_a_motion() {
        let table = Table::new(vec![0.0, 0.25, 0.4, 1.0], vec![0.8, 0.5, 0.45, 0.6]).unwrap();
        let laws = [
            FrictionLaw::coulomb(0.4, 1.0).unwrap(),
            FrictionLaw::weakening(0.5, 0.7, 1.0).unwrap(),
            FrictionLaw::stribeck(0.3, 0.2, 0.9).unwrap(),
            FrictionLaw::table(table, 1.0).unwrap(),
        ];
        let mut load = [0.0; MOST_ORDER + 1];
        (load[0], load[1]) = (1.0, -0.5);
        // Speed 0.3 + 0.2 s − 0.1 s², in units of 2.
        let speed = [0.15, 0.1, -0.05];
        for law in laws {
            let mut coefficients = [0.0; MOST_ORDER + 1];
            let mut series = FrictionSeries::new(&law, 2.0);
            series.restart(0.15);
            for (k, c) in coefficients.iter_mut().enumerate() {
                let speed = speed.get(k).copied().unwrap_or(0.0);
                *c = match &mut series {
                    FrictionSeries::Coulomb(series) => series.extend(k, speed, &load),
                    FrictionSeries::Weakening(series) => series.extend(k, speed, &load),
                    FrictionSeries::Stribeck(series) => series.extend(k, speed, &load),
                    FrictionSeries::Table(series) => series.extend(k, speed, &load),
                };
            }
            for s in [0.0, 0.05, 0.1] {
                let exact = law.mu_k(0.3 + 0.2 * s - 0.1 * s * s) * (1.0 - 0.5 * s);
                assert!(
                    (value(&coefficients, s) - exact).abs() < 1e-13,
                    "{law:?} {s}"
                );
            }
        }
    }
}
