//! What the model refuses.

/// A parameter outside the range in which the model has a meaning.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{parameter} = {value} is outside its range: {allowed}")]
pub struct ModelError {
    /// Name of the parameter, the same word as in flags, sweep files and maps.
    pub parameter: &'static str,
    /// The value that was given.
    pub value: f64,
    /// The range allowed, in words.
    pub allowed: &'static str,
}

impl ModelError {
    /// `value` if `allowed_when` holds and it is finite, else the error that names it.
    pub(crate) fn check(
        parameter: &'static str,
        value: f64,
        allowed: &'static str,
        allowed_when: bool,
    ) -> Result<f64, Self> {
        if value.is_finite() && allowed_when {
            Ok(value)
        } else {
            Err(Self {
                parameter,
                value,
                allowed,
            })
        }
    }

    /// `value` if it is finite and greater than zero.
    pub(crate) fn positive(parameter: &'static str, value: f64) -> Result<f64, Self> {
        Self::check(
            parameter,
            value,
            "a finite number greater than 0",
            value > 0.0,
        )
    }
}
