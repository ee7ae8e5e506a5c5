//! Why a setting has no linear model, or no answer.

use std::borrow::Cow;

use crate::model::ModelError;

/// Why a setting has no linear model, or no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoAnswer {
    /// A parameter is outside the model's range.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// An expression has no value.
    #[error("{polynomial}: {what}")]
    Undefined {
        /// The name of the polynomial, or of the entry of a matrix.
        polynomial: Cow<'static, str>,
        /// What is wrong.
        what: String,
    },
    /// The model is of a kind that is not answered at any delay.
    #[error("this system is not answered: |P| = |Q| on all of the imaginary axis")]
    Refused,
    /// No best setting is searched.
    #[error("best settings are not searched of {0}")]
    Unsearched(&'static str),
    /// There is no equation.
    #[error("this system is not answered: P and Q are both 0")]
    Zero,
}

impl From<NoAnswer> for ModelError {
    fn from(why: NoAnswer) -> Self {
        let of = |parameter, allowed| Self {
            parameter,
            value: f64::NAN,
            allowed,
            at_speed: None,
        };
        match why {
            NoAnswer::Model(error) => error,
            NoAnswer::Undefined { polynomial, .. } => of(
                match polynomial {
                    Cow::Borrowed(name) => name,
                    Cow::Owned(_) => "entry",
                },
                "an expression that has a finite value, A of a smaller degree than B",
            ),
            NoAnswer::Refused | NoAnswer::Unsearched(_) | NoAnswer::Zero => {
                of("system", "one that is answered")
            }
        }
    }
}
