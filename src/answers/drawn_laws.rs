//! What the errors of a fitted friction law leave open of a setting: for which share of the laws
//! that the points allow it is stable.
//!
//! μ_K and μ_K′ at the sliding velocity are drawn from the normal distribution with the errors and
//! the correlation that follow from the fit, to first order; after few points it is as much wider
//! as Student's distribution is at 95 %. The draws are points of a Sobol sequence, the same for
//! every setting.

use super::margins::beyond_letter;
use super::sobol::normal;
use crate::linear::best::{UNPROVED, abscissa_at};
use crate::linear::spectrum::RootFinder;
use crate::model::stop::Stop;
use crate::model::{ModelError, SlidingPoint};
use crate::setting::fit_errors::FitErrors;
use crate::setting::fitted_sliding::FittedSliding;
use crate::setting::{Parameter, Setting};

/// How many laws are drawn.
pub const DRAWS: u32 = 1000;
/// The scrambling of the sequence.
const SEED: u32 = 0;

/// What the laws that were drawn make of a setting, in its units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnLaws {
    /// μ_K and μ_K′ with their errors.
    pub sliding: FittedSliding,
    /// For how many of [`DRAWS`] laws all roots have the required decay rate.
    pub decay: u32,
    /// For how many that is not known; they do not count among those.
    pub unknown: u32,
    /// The law with the slowest decay, as far as it is known.
    pub worst: Drawn,
}

/// Friction that was drawn, and the spectral abscissa with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drawn {
    /// μ_K.
    pub mu_k: f64,
    /// μ_K′, time/length.
    pub mu_prime: f64,
    /// The spectral abscissa, 1/time; −∞ where none is known.
    pub abscissa: f64,
}

impl DrawnLaws {
    /// What the fit of a setting leaves open, for a required decay rate of `decay` ≥ 0; none where
    /// its law was not fitted. Once `stop` is set, the answer comes soon but is meaningless.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn at(setting: &Setting, decay: f64, stop: &Stop) -> Result<Option<Self>, ModelError> {
        let Some(sliding) = setting.fitted_sliding()? else {
            return Ok(None);
        };
        let oscillator = setting.oscillator()?;
        let unit = oscillator.time_unit();
        let beyond = beyond_letter(setting, &oscillator);
        let (control, tau) = (setting.control(), setting.get(Parameter::Tau) / unit);
        let mut found = Self {
            sliding,
            decay: 0,
            unknown: 0,
            worst: Drawn {
                mu_k: sliding.at.mu_k,
                mu_prime: sliding.at.mu_prime,
                abscissa: f64::NEG_INFINITY,
            },
        };
        let (mut finder, wider) = (
            RootFinder::default(),
            setting.fit_errors().map_or(1.0, FitErrors::wider),
        );
        for number in 0..DRAWS {
            if stop.is_set() {
                break;
            }
            let drawn = drawn(&sliding, wider, number);
            let groups = oscillator.groups(drawn, control);
            let abscissa = abscissa_at(beyond, &mut finder, (groups, tau), f64::INFINITY);
            if !abscissa.is_finite() {
                found.unknown += 1;
                continue;
            }
            found.decay += u32::from(abscissa < -decay * unit - UNPROVED);
            if abscissa / unit > found.worst.abscissa {
                found.worst = Drawn {
                    mu_k: drawn.mu_k,
                    mu_prime: drawn.mu_prime,
                    abscissa: abscissa / unit,
                };
            }
        }
        Ok(Some(found))
    }
}

/// The friction of a draw, with errors so many times as wide.
fn drawn(of: &FittedSliding, wider: f64, number: u32) -> SlidingPoint {
    let [first, second] = normal(number, SEED).map(|z| wider * z);
    let c = of.correlation;
    let other = c * first + (1.0 - c * c).max(0.0).sqrt() * second;
    SlidingPoint {
        mu_k: (of.at.mu_k + of.mu_k_error * first).max(0.0),
        mu_prime: of.at.mu_prime + of.mu_prime_error * other,
    }
}
