//! What the errors of a fitted friction law leave open of its coefficient and its slope where the
//! block slides.

use std::sync::Arc;

use super::fit_errors::{FitErrors, FittedNumber};
use super::law_kind::LawKind;
use super::values::Setting;
use crate::model::table::TableColumn;
use crate::model::{ModelError, SlidingPoint, Table};

/// The step of a difference quotient, in standard errors.
const STEP: f64 = 1e-2;

/// μ_K and μ_K′ at the sliding velocity, with what a fit leaves open of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedSliding {
    /// The values of the fitted law.
    pub at: SlidingPoint,
    /// The standard error of μ_K.
    pub mu_k_error: f64,
    /// The standard error of μ_K′, time/length.
    pub mu_prime_error: f64,
    /// The correlation of both.
    pub correlation: f64,
}

impl Setting {
    /// The setting with what a fit says of its friction law.
    #[must_use]
    pub fn with_fit(mut self, fitted: FitErrors) -> Self {
        self.fit_errors = Some(Arc::new(fitted));
        self
    }

    /// What a fit says of the friction law, if it was fitted.
    #[must_use]
    pub fn fit_errors(&self) -> Option<&FitErrors> {
        self.fit_errors.as_deref()
    }

    /// μ_K and μ_K′ at the sliding velocity with their errors, to first order in those of the
    /// fitted numbers; that of μ_K′ holds what the choice of the law adds. None where the law was
    /// not fitted.
    ///
    /// # Errors
    /// When the law is ill-posed.
    pub fn fitted_sliding(&self) -> Result<Option<FittedSliding>, ModelError> {
        let Some(fitted) = self.fit_errors() else {
            return Ok(None);
        };
        let at = self.sliding_point()?;
        let (mut of_mu_k, mut of_mu_prime) = (Vec::new(), Vec::new());
        for (number, error) in fitted.errors() {
            let [mu_k, mu_prime] = self.change_by(at, number, error)?;
            of_mu_k.push(mu_k);
            of_mu_prime.push(mu_prime);
        }
        let variance = |of: &[f64]| fitted.covariance(of, of).max(0.0);
        let between = fitted.between_laws() * fitted.between_laws();
        let mu_k_error = variance(&of_mu_k).sqrt();
        let mu_prime_error = (variance(&of_mu_prime) + between).sqrt();
        let covariance = fitted.covariance(&of_mu_k, &of_mu_prime);
        let sizes = mu_k_error * mu_prime_error;
        Ok(Some(FittedSliding {
            at,
            mu_k_error,
            mu_prime_error,
            correlation: match sizes > 0.0 {
                true => (covariance / sizes).clamp(-1.0, 1.0),
                false => 0.0,
            },
        }))
    }

    /// By how much μ_K and μ_K′ at the sliding velocity, which are `here`, change with a fitted
    /// number, for one standard error of it.
    fn change_by(
        &self,
        here: SlidingPoint,
        number: FittedNumber,
        error: f64,
    ) -> Result<[f64; 2], ModelError> {
        if error == 0.0 {
            return Ok([0.0; 2]);
        }
        let at = |steps: f64| self.moved(number, steps * error)?.sliding_point();
        let above = at(STEP)?;
        // At the end of its range a number moves to one side only.
        let (below, width) = match at(-STEP) {
            Ok(below) => (below, 2.0 * STEP),
            Err(_) => (here, STEP),
        };
        Ok([above.mu_k - below.mu_k, above.mu_prime - below.mu_prime].map(|d| d / width))
    }

    /// The setting with a fitted number so much larger.
    fn moved(&self, number: FittedNumber, by: f64) -> Result<Self, ModelError> {
        let mut moved = self.clone();
        match (number, self.law()) {
            (FittedNumber::Parameter(parameter), _) => {
                moved.set(parameter, parameter.check(self.get(parameter) + by)?);
            }
            (FittedNumber::Point(place), Some(LawKind::Table(table))) => {
                let mut mu_k = table.mu_k().to_vec();
                if let Some(mu) = mu_k.get_mut(place) {
                    *mu += by;
                }
                let made = Table::new(table.speeds().to_vec(), mu_k);
                let table = made.map_err(|_| ModelError {
                    parameter: TableColumn::MuK.name(),
                    value: by,
                    allowed: "greater than 0",
                    at_speed: None,
                })?;
                moved.take_law(Some(LawKind::Table(table)));
            }
            (FittedNumber::Point(_), _) => {}
        }
        Ok(moved)
    }
}
