//! Numbers as messages show them.

use std::fmt;

/// A number as messages show it: plain if its size is ordinary, else with a power of ten.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shown(pub f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = self;
        let plain = *value == 0.0 || (1e-5..1e15).contains(&value.abs()) || !value.is_finite();
        if plain {
            write!(f, "{value}")
        } else {
            write!(f, "{value:e}")
        }
    }
}

/// The value with at most `digits` digits after its first one.
#[must_use]
pub fn to_digits(value: f64, digits: usize) -> f64 {
    format!("{value:.digits$e}").parse().unwrap_or(value)
}

/// The value, if it is finite.
#[must_use]
pub fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::Shown;

    #[test]
    fn numbers_in_messages_are_short() {
        for (value, shown) in [
            (0.0, "0"),
            (-0.33, "-0.33"),
            (1e12, "1000000000000"),
            (-1e300, "-1e300"),
            (2.5e-9, "2.5e-9"),
            (9.9e-6, "9.9e-6"),
            (1e-5, "0.00001"),
            (1e-300, "1e-300"),
            (f64::INFINITY, "inf"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(Shown(value).to_string(), shown);
        }
        for digits in [f64::MAX, f64::MIN_POSITIVE, -123_456_789.123_456_78] {
            assert!(Shown(digits).to_string().len() <= 24);
        }
    }
}
