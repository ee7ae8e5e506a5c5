//! A claim of the letter, the result of the program beside it, and the verdict.

use serde::Serialize;
use utoipa::ToSchema;

/// The largest relative distance at which a number that the letter gives without an error counts as
/// refined, not contradicted.
const REFINED: f64 = 0.1;

/// What a run says of a claim. The later, the worse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Verdict {
    /// It holds as it stands.
    Confirmed,
    /// It holds with another number, or within limits that it does not name.
    Refined,
    /// It does not hold.
    Contradicted,
}

impl Verdict {
    /// The verdict on a statement that holds or does not.
    #[must_use]
    pub(crate) fn of(holds: bool) -> Self {
        match holds {
            true => Self::Confirmed,
            false => Self::Contradicted,
        }
    }

    /// The verdict on a statement with several parts: `all` of them hold, or at least `most`.
    #[must_use]
    pub(crate) fn of_parts(all: bool, most: bool) -> Self {
        match (all, most) {
            (true, _) => Self::Confirmed,
            (false, true) => Self::Refined,
            (false, false) => Self::Contradicted,
        }
    }

    /// The verdict on a number that the letter rounds to a multiple of `unit`, compared with the
    /// number found.
    #[must_use]
    pub(crate) fn of_number(letter: f64, unit: f64, found: f64, error: f64) -> Self {
        let off = (found - letter).abs();
        Self::of_parts(
            off <= 0.5 * unit + error,
            off <= REFINED * letter.abs() + error,
        )
    }

    /// Its name.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Refined => "refined",
            Self::Contradicted => "contradicted",
        }
    }
}

/// A number that a claim is judged by.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
#[schema(as = Value)]
pub(crate) struct ClaimValue {
    /// Its name within the claim.
    pub name: String,
    /// What it is, and in which unit where it has one.
    pub meaning: String,
    /// The number; null where it is infinite or there is none.
    #[schema(required)]
    pub value: Option<f64>,
    /// How far off it is at most, or its standard error where `meaning` says so; null for a count,
    /// or a truth that has none.
    #[schema(required)]
    pub error: Option<f64>,
    /// What the letter says instead; null where it says nothing.
    #[schema(required)]
    pub letter: Option<f64>,
}

impl ClaimValue {
    /// A value without an error; infinite numbers and NaN become null.
    #[must_use]
    pub(crate) fn of(name: impl Into<String>, meaning: impl Into<String>, value: f64) -> Self {
        Self {
            name: name.into(),
            meaning: meaning.into(),
            value: Some(value).filter(|v| v.is_finite()),
            error: None,
            letter: None,
        }
    }

    /// The same value with an error.
    #[must_use]
    pub(crate) fn within(self, error: f64) -> Self {
        Self {
            error: Some(error).filter(|e| e.is_finite()),
            ..self
        }
    }

    /// The same value with the letter's number.
    #[must_use]
    pub(crate) fn beside(self, letter: f64) -> Self {
        Self {
            letter: Some(letter),
            ..self
        }
    }

    /// The number for display: as many digits as its error allows, at most eight.
    #[must_use]
    pub(crate) fn shown(&self) -> String {
        let Some(value) = self.value else {
            return "none".into();
        };
        if value == value.trunc() && value.abs() < 1e15 && self.error.is_none_or(|e| e == 0.0) {
            return format!("{value}");
        }
        let size = value.abs().log10().floor();
        let digits = match self.error.filter(|error| *error > 0.0 && value != 0.0) {
            Some(error) => (size - error.log10().floor() + 2.0).clamp(1.0, 13.0),
            None => 8.0,
        };
        let number = significant(value, digits as usize);
        if self.error.is_none() && number.contains('.') && !number.contains('e') {
            return number.trim_end_matches('0').to_owned();
        }
        match self.error.filter(|error| *error > 0.0) {
            Some(error) => format!("{number} ± {}", significant(error, 1)),
            None => number,
        }
    }
}

/// A number with `digits` digits, in the shorter of both notations.
fn significant(value: f64, digits: usize) -> String {
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let size = value.abs().log10().floor();
    if value == 0.0 {
        return "0".into();
    }
    if !(-4.0..digits.max(6) as f64).contains(&size) {
        return scientific;
    }
    let behind = (digits as f64 - 1.0 - size).max(0.0) as usize;
    format!("{value:.behind$}")
}

/// A claim with its verdict and all that it rests on.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub(crate) struct Claim {
    /// Its name here.
    pub name: &'static str,
    /// Where it stands: figure, equation or paragraph.
    pub place: &'static str,
    /// A few words of it.
    pub quotation: &'static str,
    /// What this run says of it.
    pub verdict: Verdict,
    /// Why, in words and in numbers of this run.
    pub because: String,
    /// What it is judged by; the first one says most.
    pub values: Vec<ClaimValue>,
    /// How they are computed.
    pub how: &'static str,
    /// Commands that repeat it.
    pub commands: Vec<String>,
    /// The maps and traces behind it, by the names under `figures`; some rest on closed forms
    /// alone.
    pub evidence: Vec<&'static str>,
}

impl Claim {
    /// A claim with its verdict; the numbers behind it are added later.
    pub(super) fn new(
        name: &'static str,
        (place, quotation): (&'static str, &'static str),
        verdict: Verdict,
        because: String,
        how: &'static str,
    ) -> Self {
        Self {
            name,
            place,
            quotation,
            verdict,
            because,
            values: Vec::new(),
            how,
            commands: Vec::new(),
            evidence: Vec::new(),
        }
    }

    /// Adds numbers.
    pub(super) fn by(mut self, values: impl IntoIterator<Item = ClaimValue>) -> Self {
        self.values.extend(values);
        self
    }

    /// Adds the maps or traces behind the claim. Their commands are added when they are made.
    pub(super) fn from(mut self, figures: &[&'static str]) -> Self {
        self.evidence.extend(figures);
        self
    }

    /// Adds a command that repeats a part of it.
    pub(super) fn repeat(mut self, command: &str) -> Self {
        self.commands.push(command.to_owned());
        self
    }

    /// Adds the command that repeats it, if there is one.
    pub(super) fn repeat_some(mut self, command: Option<String>) -> Self {
        self.commands.extend(command);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rounded_number_is_confirmed_refined_or_contradicted() {
        let of = |found| Verdict::of_number(-0.68, 0.01, found, 1e-9);
        assert_eq!(of(-0.684), Verdict::Confirmed);
        assert_eq!(of(-0.686), Verdict::Refined);
        assert_eq!(of(-0.725_6), Verdict::Refined);
        assert_eq!(of(-0.76), Verdict::Contradicted);
        assert_eq!(of(f64::NAN), Verdict::Contradicted);
    }

    #[test]
    fn numbers_have_the_digits_that_their_errors_leave() {
        let shown = |value: f64, error: f64| ClaimValue::of("", "", value).within(error).shown();
        assert_eq!(shown(-0.725_635_939_603, 1e-12), "-0.7256359396030 ± 1e-12");
        assert_eq!(shown(0.344_467, 3e-5), "0.344467 ± 3e-5");
        assert_eq!(shown(97.029, 0.2), "97.03 ± 0.2");
        assert_eq!(ClaimValue::of("", "", 12.0).shown(), "12");
        assert_eq!(shown(0.0, 0.0), "0");
        assert_eq!(ClaimValue::of("", "", f64::INFINITY).shown(), "none");
        assert_eq!(ClaimValue::of("", "", 1e-9).shown(), "1.0000000e-9");
        assert_eq!(ClaimValue::of("", "", 0.01).shown(), "0.01");
    }
}
