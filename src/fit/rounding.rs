//! Numbers without the digits that the noise leaves open, so that they are the same on every
//! machine, whatever the last bits of a search are.

use std::f64::consts::LN_10;

use crate::model::elementary::ln;
use crate::text::to_digits;

/// Digits after the first one of a number without noise.
const MOST_DIGITS: usize = 11;
/// Digits after the first one of standard errors.
const OF_ERRORS: usize = 3;
/// Digits after the point of correlations.
const OF_CORRELATIONS: usize = 6;

/// `value` to a decimal place that is at most a thousandth of its standard error.
pub(super) fn to_a_thousandth_of(error: f64, value: f64) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let first = |x: f64| (ln(x.abs()) / LN_10).floor();
    let digits = match error > 0.0 {
        true => first(value) - first(error) + 3.0,
        false => MOST_DIGITS as f64,
    };
    match digits < 0.0 {
        true => 0.0,
        false => to_digits(value, (digits as usize).min(MOST_DIGITS)),
    }
}

/// A standard error with four digits.
pub(super) fn error(value: f64) -> f64 {
    to_digits(value, OF_ERRORS)
}

/// A correlation with six decimals.
pub(super) fn correlation(value: f64) -> f64 {
    let text = format!("{value:.OF_CORRELATIONS$}");
    text.parse().unwrap_or(value)
}
