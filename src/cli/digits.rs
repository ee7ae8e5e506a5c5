//! How many digits people are shown of a number.

use crate::report::numbers;

/// The flag.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(super) struct DigitsArgs {
    /// Significant digits of results, 1 to 17, but of shares with an error [default: 6]
    #[arg(long, value_name = "N", allow_hyphen_values = true, conflicts_with = "json",
          value_parser = parse_digits)]
    digits: Option<Digits>,
}

impl DigitsArgs {
    /// What the flag says.
    pub(super) fn get(self) -> Digits {
        self.digits.unwrap_or_default()
    }
}

/// Significant digits, at most.
#[derive(Debug, Clone, Copy)]
pub(super) struct Digits(usize);

impl Default for Digits {
    /// Six digits, which are the same on every machine and are read at a glance.
    fn default() -> Self {
        Self(6)
    }
}

fn parse_digits(text: &str) -> Result<Digits, String> {
    let digits = text.parse().ok().filter(|n| (1..=17).contains(n));
    digits
        .map(Digits)
        .ok_or_else(|| "expected a whole number from 1 to 17".to_owned())
}

impl Digits {
    /// A number, or why there is none; no zero has a sign.
    pub(super) fn of(self, value: f64) -> String {
        match value {
            f64::INFINITY => "infinity".into(),
            f64::NEG_INFINITY => "-infinity".into(),
            _ if value.is_nan() => "none".into(),
            _ => numbers::rounded(value, self.0 - 1),
        }
    }

    /// A bound, rounded outwards: it stays one.
    pub(super) fn of_bound(self, value: f64, up: bool) -> String {
        numbers::bound(value, self.0 - 1, up)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_as_many_digits_as_asked_for_and_zero_no_sign() {
        let six = Digits::default();
        let numbers = [0.344_466_666, 2.0, -0.0, -1e-300, 12_345_678.9];
        let texts = ["0.344467", "2", "0", "-1e-300", "12345700"];
        assert_eq!(numbers.map(|x| six.of(x)), texts);
        assert_eq!(six.of(f64::NEG_INFINITY), "-infinity");
        assert_eq!(six.of(f64::NAN), "none");
        let all = parse_digits("17").unwrap();
        let value = 0.041_061_556_194_306_2;
        assert_eq!(all.of(value).parse(), Ok(value));
        assert_eq!(parse_digits("2").unwrap().of_bound(0.123, true), "0.13");
        for wrong in ["0", "18", "-1", "six"] {
            assert!(parse_digits(wrong).is_err());
        }
    }
}
