//! What a fit says of a friction law beside its parameters: their standard errors and correlations.

use super::parameter::{LARGEST, Parameter};

/// The key of `[friction]` under which a fit stands.
pub(crate) const FIT: &str = "fit";
/// The keys there.
pub(super) const PARAMETERS: &str = "parameters";
pub(super) const STANDARD_ERRORS: &str = "standard_errors";
pub(super) const CORRELATIONS: &str = "correlations";
pub(super) const COVERAGE_FACTOR: &str = "coverage_factor";
pub(super) const BETWEEN_LAWS: &str = "mu_prime_between_laws";

/// 95 % of the normal distribution lie within so many standard deviations.
pub const NORMAL_95: f64 = 1.959_963_984_540_054;

/// A number of a friction law that was fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FittedNumber {
    /// A parameter.
    Parameter(Parameter),
    /// μ_K at a point of a table, by its place from 0 on.
    Point(usize),
}

/// The standard errors and correlations of the fitted numbers of a friction law.
#[derive(Debug, Clone, PartialEq)]
pub struct FitErrors {
    numbers: Vec<FittedNumber>,
    /// In the units of the numbers.
    standard_errors: Vec<f64>,
    /// Row i has those of number i with all before.
    correlations: Vec<Vec<f64>>,
    coverage_factor: f64,
    between_laws: f64,
}

impl FitErrors {
    /// The errors of some numbers, as many of them as standard errors. Row i of the correlations
    /// has those of number i with all numbers before it, the first row none.
    ///
    /// # Errors
    /// Names the key that does not fit, and says why.
    pub fn new(
        numbers: Vec<FittedNumber>,
        standard_errors: Vec<f64>,
        correlations: Vec<Vec<f64>>,
    ) -> Result<Self, (&'static str, String)> {
        let count = numbers.len();
        if standard_errors.len() != count {
            let given = standard_errors.len();
            return Err((
                STANDARD_ERRORS,
                format!("{given} numbers for {count} that were fitted"),
            ));
        }
        if !standard_errors.iter().all(|e| (0.0..=LARGEST).contains(e)) {
            let why = "expected numbers of 0 or more, at most 1e12".to_owned();
            return Err((STANDARD_ERRORS, why));
        }
        let triangle = correlations
            .iter()
            .enumerate()
            .all(|(i, row)| row.len() == i);
        if correlations.len() != count || !triangle {
            let why = "row i has i numbers, from 0 on: [[], [0.9], [0.1, -0.4]]".to_owned();
            return Err((CORRELATIONS, why));
        }
        if !correlations.iter().flatten().all(|c| c.abs() <= 1.0) {
            return Err((CORRELATIONS, "expected numbers from -1 to 1".to_owned()));
        }
        Ok(Self {
            numbers,
            standard_errors,
            correlations,
            coverage_factor: NORMAL_95,
            between_laws: 0.0,
        })
    }

    /// The same with a coverage factor: within so many standard errors lies the true value in 95 of
    /// 100 cases, more than [`NORMAL_95`] after few points. `between_laws` is the standard
    /// deviation of μ′ at the sliding velocity by the choice of a law, time/length.
    ///
    /// # Errors
    /// Names the key whose value is out of its range, and says which that is.
    pub fn covering(
        mut self,
        coverage_factor: f64,
        between_laws: f64,
    ) -> Result<Self, (&'static str, String)> {
        if !(1.0..=1e3).contains(&coverage_factor) {
            return Err((
                COVERAGE_FACTOR,
                "expected a number from 1 to 1000".to_owned(),
            ));
        }
        if !(0.0..f64::INFINITY).contains(&between_laws) {
            let why = "expected a finite number of 0 or more".to_owned();
            return Err((BETWEEN_LAWS, why));
        }
        (self.coverage_factor, self.between_laws) = (coverage_factor, between_laws);
        Ok(self)
    }

    /// Row i has the correlations of number i with all before.
    pub(super) fn correlations(&self) -> &[Vec<f64>] {
        &self.correlations
    }

    /// The standard deviation of μ′ at the sliding velocity by the choice of a law, time/length.
    pub(super) fn between_laws(&self) -> f64 {
        self.between_laws
    }

    /// Within so many standard errors lies the true value in 95 of 100 cases.
    #[must_use]
    pub fn coverage_factor(&self) -> f64 {
        self.coverage_factor
    }

    /// How many times as far the errors reach as those of a normal distribution, of which 95 % lie
    /// within [`NORMAL_95`] of them: 1, and more after few points.
    #[must_use]
    pub fn wider(&self) -> f64 {
        self.coverage_factor / NORMAL_95
    }

    /// The fitted numbers with their standard errors.
    pub fn errors(&self) -> impl Iterator<Item = (FittedNumber, f64)> + '_ {
        let errors = self.standard_errors.iter().copied();
        self.numbers.iter().copied().zip(errors)
    }

    /// The variance of what changes by `by` with each number, in standard errors, and the
    /// covariance of two such.
    pub(super) fn covariance(&self, one: &[f64], other: &[f64]) -> f64 {
        let rows = self.correlations.iter().enumerate();
        rows.map(|(i, row)| {
            let before = row.iter().enumerate();
            let crossed = before.map(|(j, c)| c * (one[i] * other[j] + one[j] * other[i]));
            one[i] * other[i] + crossed.sum::<f64>()
        })
        .sum()
    }
}
