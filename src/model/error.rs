//! Errors of parameters out of range.

use crate::text::Shown;

/// What friction coefficients at rest are allowed to be.
pub(super) const AT_MOST_MU_S: &str =
    "at most mu_s, else release from stick would accelerate backwards";

/// A parameter outside the range in which the model has a meaning.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}", self.told())]
pub struct ModelError {
    /// Name of the parameter, the same word as in flags, sweep files and maps.
    pub parameter: &'static str,
    /// The value that was given.
    pub value: f64,
    /// The range allowed, in words.
    pub allowed: &'static str,
    /// The speed at which a friction law has this value, where that is to be told.
    pub at_speed: Option<f64>,
}

impl ModelError {
    /// The range allowed, with the value of μ_S where it is the default, which nobody wrote.
    #[must_use]
    pub fn allowed_by_default(&self, mu_s: Option<f64>) -> String {
        match mu_s {
            Some(mu_s) if self.allowed == AT_MOST_MU_S => {
                let default = format!("at most mu_s = {mu_s} (not given: the default)");
                self.allowed.replacen("at most mu_s", &default, 1)
            }
            _ => self.allowed.to_owned(),
        }
    }

    /// The error in words, with that range.
    #[must_use]
    pub fn with_default_mu_s(&self, mu_s: Option<f64>) -> String {
        let allowed = self.allowed_by_default(mu_s);
        self.to_string().replacen(self.allowed, &allowed, 1)
    }

    /// The error of a friction law that lacks a required property; `allowed` names the property.
    #[must_use]
    pub const fn of_law(allowed: &'static str) -> Self {
        Self {
            parameter: "friction",
            value: f64::NAN,
            allowed,
            at_speed: None,
        }
    }

    /// The error of a value that a friction law has at this speed.
    pub(crate) const fn at_speed(self, speed: f64) -> Self {
        Self {
            at_speed: Some(speed),
            ..self
        }
    }

    /// The speed at which a friction law has the value, for a message; empty where it has none.
    #[must_use]
    pub fn place(&self) -> String {
        let at = |speed: f64| format!(" at the speed {}", Shown(speed));
        self.at_speed.map_or_else(String::new, at)
    }

    fn told(&self) -> String {
        let Self {
            parameter,
            value,
            allowed,
            ..
        } = self;
        let at = self.place();
        match *parameter {
            // An error of the law has no value.
            "friction" => format!("friction: {allowed} is needed"),
            _ => format!(
                "{parameter} = {}{at} is outside its range: {allowed}",
                Shown(*value)
            ),
        }
    }

    /// `value` if it is finite and `allowed_when` holds, else an error that names the parameter.
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
                at_speed: None,
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
