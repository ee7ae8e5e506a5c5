//! The law by which points are described best: of the laws that are asked for, the one with the
//! lowest Bayesian information criterion.
//!
//! ```text
//! BIC = n ln(Σ r_i²/n) + k ln n                                                             (3)
//! ```
//!
//! with n points and k fitted numbers. G. Schwarz, Ann. Statist. 6 (1978) 461. A spline, which has
//! no shape of its own, is chosen only where it is better than every law by 6.

use nalgebra::DMatrix;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::candidate::{Candidate, LAWS, Seen, forms};
use super::error::FitError;
use super::least_squares::{Minimum, Weighted};
use super::rounding::{correlation, error, to_a_thousandth_of};
use super::weights::deviations;
use crate::model::elementary::{ln, power};
use crate::model::table::NEAREST;
use crate::setting::fit_errors::{FitErrors, FittedNumber};
use crate::setting::law_kind::LawKind;
use crate::setting::measured::MeasuredPoint;
use crate::setting::parameter::LARGEST;
use crate::setting::{Parameter, Setting};

/// Residuals below this part of the coefficients are rounding.
const ROUNDING: f64 = 1e-12;
/// A difference of criteria that is strong evidence: R. E. Kass and A. E. Raftery, J. Am. Stat.
/// Assoc. 90 (1995) 773.
const STRONG: f64 = 6.0;
/// The share of intervals that hold the true value.
const SHARE: f64 = 0.95;

/// What is to be fitted.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wanted {
    /// The law, of [`LAWS`]; of all of them where none is given.
    pub law: Option<&'static str>,
    /// μ_S, where it is known and not fitted.
    pub mu_s: Option<f64>,
}

/// A law that was fitted to points.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedLaw {
    /// Its name, of [`LAWS`].
    pub law: &'static str,
    /// A setting with the law and its errors: all else as it was given.
    pub setting: Setting,
    /// The laws that were fitted, the best one first.
    pub contenders: Vec<Contender>,
    /// The standard deviation of one reading about the law.
    pub noise: f64,
    /// Where the curve is known how well, over the velocities of the points.
    pub band: Vec<Band>,
}

impl FittedLaw {
    /// How many standard errors make an interval that holds the true value in 95 of 100 cases.
    #[must_use]
    pub fn errors_in_interval(&self) -> f64 {
        let errors = self.setting.fit_errors();
        errors.map_or(f64::NAN, FitErrors::coverage_factor)
    }

    /// The velocities of the points of a spline; none for other laws.
    #[must_use]
    pub fn speeds(&self) -> Option<&[f64]> {
        match self.setting.law() {
            Some(LawKind::Table(table)) => Some(table.speeds()),
            _ => None,
        }
    }
}

/// A law that was compared with others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contender {
    /// Its name.
    pub law: &'static str,
    /// The number of its fitted numbers.
    pub parameters: usize,
    /// (3); of a spline 6 more.
    pub bic: f64,
}

/// The fitted curve at a velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// The velocity.
    pub speed: f64,
    /// μ_K there.
    pub mu_k: f64,
    /// Its standard error.
    pub error: f64,
}

/// A candidate at its minimum.
struct Found {
    candidate: Candidate,
    minimum: Minimum,
    covariance: DMatrix<f64>,
    bic: f64,
}

/// Fits a law to measured points. The setting of the answer is `setting` with that law.
///
/// # Errors
/// Says why the points determine no law.
pub fn fit(
    points: &[MeasuredPoint],
    wanted: Wanted,
    setting: Setting,
) -> Result<FittedLaw, FitError> {
    let speeds: Vec<f64> = points.iter().map(|point| point.speed).collect();
    let mu_k: Vec<f64> = points.iter().map(|point| point.mu_k).collect();
    let deviations = deviations(points);
    let weighted = Weighted {
        seen: Seen {
            speeds: &speeds,
            mu_k: &mu_k,
        },
        deviations: &deviations,
    };
    let mut velocities = speeds.clone();
    velocities.dedup_by(|next, last| *next - *last <= NEAREST * *next);
    if velocities.len() < 2 {
        return Err(FitError::OneVelocity);
    }
    let mut all = candidates(wanted, weighted, velocities.len())?;
    let v0 = setting.get(Parameter::V0);
    all.retain(|found| found.tells_slope_at(v0, weighted.seen));
    all.sort_by(|one: &Found, other| one.rank().total_cmp(&other.rank()));
    if !falls(weighted, all.first()) {
        return Err(FitError::NoDescent);
    }
    let contenders = all.iter().map(Found::contender).collect();
    let between = between_laws(&all, v0);
    let law = wanted.law.unwrap_or(LAWS[0]);
    let best = all.into_iter().next();
    let best = best.ok_or(FitError::NotDetermined { law })?;
    Ok(best.fit(weighted, contenders, between, (wanted.mu_s, setting)))
}

/// The laws that are wanted, as far as the points determine them.
fn candidates(wanted: Wanted, points: Weighted, velocities: usize) -> Result<Vec<Found>, FitError> {
    let laws: Vec<&'static str> = match wanted.law {
        Some(law) => vec![law],
        None => LAWS.to_vec(),
    };
    let forms = |law: &&'static str| forms(law, wanted.mu_s, (points.seen, velocities));
    let chains: Vec<Vec<Candidate>> = laws.iter().flat_map(forms).collect();
    let least = chains
        .iter()
        .flatten()
        .min_by_key(|form| form.numbers().len());
    if let Some(form) = least.filter(|form| velocities <= form.numbers().len()) {
        return Err(FitError::TooFew {
            law: form.law,
            parameters: form.numbers().len(),
            velocities,
        });
    }
    let determined = |chain| first_determined(chain, velocities, points);
    Ok(chains.into_iter().filter_map(determined).collect())
}

/// The first of some forms of a law that the points determine; one with a negative viscous part is
/// passed over.
fn first_determined(chain: Vec<Candidate>, velocities: usize, points: Weighted) -> Option<Found> {
    chain.into_iter().find_map(|candidate| {
        let numbers = candidate.numbers();
        if numbers.len() >= velocities {
            return None;
        }
        let minimum = Minimum::of(&candidate, points)?;
        let mut viscous = numbers.iter().zip(&minimum.values);
        if viscous.any(|(of, value)| Candidate::is_viscous(*of) && *value < 0.0) {
            return None;
        }
        let covariance = minimum.covariance(&candidate, points)?;
        let told = |variance: &f64| variance.sqrt() <= LARGEST;
        if !covariance.diagonal().iter().all(told) {
            return None;
        }
        // A number that is 0 but for its error makes no law.
        candidate.curve(&rounded(&minimum.values, &covariance))?;
        let bic = criterion(minimum.sum, numbers.len(), points);
        Some(Found {
            candidate,
            minimum,
            covariance,
            bic,
        })
    })
}

/// Values to a thousandth of their standard errors.
fn rounded(values: &[f64], covariance: &DMatrix<f64>) -> Vec<f64> {
    let of =
        |(i, value): (usize, &f64)| to_a_thousandth_of(covariance[(i, i)].max(0.0).sqrt(), *value);
    values.iter().enumerate().map(of).collect()
}

/// (3).
fn criterion(sum: f64, numbers: usize, points: Weighted) -> f64 {
    let n = points.seen.speeds.len() as f64;
    let sizes = points.seen.mu_k.iter().zip(points.deviations);
    let least: f64 = sizes.map(|(mu, s)| power(ROUNDING * mu / s, 2)).sum();
    n * ln(sum.max(least) / n) + numbers as f64 * ln(n)
}

/// The standard deviation of the slope at `v0` by the choice of a law: where other laws are not
/// worse by strong evidence, as if the best one and the one that differs most were equally likely.
/// Splines count only beside a spline.
fn between_laws(all: &[Found], v0: f64) -> f64 {
    let Some(best) = all.first() else { return 0.0 };
    let slope = |found: &Found| {
        let curve = found.candidate.curve(&found.minimum.values);
        curve.map_or(f64::NAN, |curve| curve.slope(v0))
    };
    let alike = |of: &&Found| of.has_shape() || !best.has_shape();
    let rivals = all
        .iter()
        .filter(|of| of.bic < best.bic + STRONG)
        .filter(alike);
    let differences = rivals.map(|of| (slope(of) - slope(best)).abs());
    let largest = differences.filter(|d| d.is_finite()).fold(0.0, f64::max);
    std::f64::consts::FRAC_1_SQRT_2 * largest
}

/// Whether the best law describes the points better than a straight line, or that line falls.
fn falls(points: Weighted, best: Option<&Found>) -> bool {
    let Seen { speeds, mu_k } = points.seen;
    let weight = |s: &f64| 1.0 / (s * s);
    let mean = |of: &dyn Fn(usize) -> f64| {
        let weights = points.deviations.iter().map(weight);
        let sum: f64 = weights.clone().enumerate().map(|(i, w)| w * of(i)).sum();
        sum / weights.sum::<f64>()
    };
    let (v, mu) = (mean(&|i| speeds[i]), mean(&|i| mu_k[i]));
    let slope = mean(&|i| (speeds[i] - v) * (mu_k[i] - mu)) / mean(&|i| power(speeds[i] - v, 2));
    let off = |i: usize| mu_k[i] - mu - slope * (speeds[i] - v);
    let all: f64 = points.deviations.iter().map(weight).sum();
    let sum = all * mean(&|i| power(off(i), 2));
    // A level line has one number less than a sloping one.
    let level = all * mean(&|i| power(mu_k[i] - mu, 2));
    let line = criterion(sum, 2, points);
    let flat = criterion(level, 1, points);
    let best = best.map_or(f64::INFINITY, |found| found.bic);
    best < line.min(flat) || (slope < 0.0 && line < flat)
}

impl Found {
    fn has_shape(&self) -> bool {
        self.candidate.has_shape()
    }

    /// Whether the slope at `v0` follows from points. That of a spline does between its own, unless
    /// two of them hold it at 0.
    fn tells_slope_at(&self, v0: f64, seen: Seen) -> bool {
        let within = seen.speeds.first() <= Some(&v0) && Some(&v0) <= seen.speeds.last();
        let curve = self.candidate.curve(&self.minimum.values);
        let flat = curve.is_none_or(|curve| curve.slope(v0) == 0.0);
        self.has_shape() || (within && !flat)
    }

    /// The criterion by which laws are ranked.
    fn rank(&self) -> f64 {
        match self.has_shape() {
            true => self.bic,
            false => self.bic + STRONG,
        }
    }

    fn contender(&self) -> Contender {
        Contender {
            law: self.candidate.law,
            parameters: self.minimum.values.len(),
            bic: self.rank(),
        }
    }

    fn fit(
        self,
        points: Weighted,
        contenders: Vec<Contender>,
        between: f64,
        (mu_s, setting): (Option<f64>, Setting),
    ) -> FittedLaw {
        let numbers = self.candidate.numbers();
        let count = numbers.len();
        let errors: Vec<f64> = (0..count)
            .map(|i| self.covariance[(i, i)].max(0.0).sqrt())
            .collect();
        let values = rounded(&self.minimum.values, &self.covariance);
        let freedom = (points.seen.speeds.len() - count) as f64;
        let student = StudentsT::new(0.0, 1.0, freedom);
        let coverage = student.map_or(f64::NAN, |t| error(t.inverse_cdf(0.5 + 0.5 * SHARE)));
        let fitted = self.fitted(numbers, &errors);
        let fitted = fitted.covering(coverage.min(1e3), error(between));
        let fitted = fitted.expect("a finite difference of slopes");
        let setting = self.candidate.setting(&values, mu_s, setting);
        let setting = setting.with_fit(fitted);
        FittedLaw {
            law: self.candidate.law,
            noise: error((self.minimum.sum / freedom).sqrt()),
            band: band(&setting, points.seen),
            setting,
            contenders,
        }
    }

    fn fitted(&self, numbers: Vec<FittedNumber>, errors: &[f64]) -> FitErrors {
        let variance = |i: usize| self.covariance[(i, i)];
        let of = |i: usize, j: usize| match (variance(i) * variance(j)).sqrt() {
            0.0 => 0.0,
            sizes => correlation((self.covariance[(i, j)] / sizes).clamp(-1.0, 1.0)),
        };
        let rows = (0..errors.len()).map(|i| (0..i).map(|j| of(i, j)).collect());
        let errors = errors.iter().copied().map(error).collect();
        FitErrors::new(numbers, errors, rows.collect()).expect("finite errors and correlations")
    }
}

/// The fitted curve over the velocities of the points.
fn band(setting: &Setting, seen: Seen) -> Vec<Band> {
    const PLACES: u32 = 200;
    let [Some(from), Some(to)] = [seen.speeds.first(), seen.speeds.last()] else {
        return Vec::new();
    };
    let at = |i: u32| from + (to - from) * f64::from(i) / f64::from(PLACES);
    let places = (0..=PLACES).map(at).filter(|v| *v > 0.0);
    places
        .filter_map(|speed| {
            let mut here = setting.clone();
            here.set(Parameter::V0, speed);
            let found = here.fitted_sliding().ok()??;
            Some(Band {
                speed,
                mu_k: found.at.mu_k,
                error: found.mu_k_error,
            })
        })
        .collect()
}
