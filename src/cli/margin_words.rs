//! Margins in words: ranges, how far their ends are, and the frequencies of crossings.

use crate::explore::margin_range::{Margin, Range};
use crate::report::numbers::{rounded, unit_behind};
use crate::setting::field::Field;
use crate::setting::units::Units;
use crate::text::finite;

/// The end that is known of a margin whose other end is not decided.
pub(super) fn known((lower, upper): (f64, f64), unit: &str) -> String {
    match (finite(lower), finite(upper)) {
        (Some(lower), None) => format!(
            "from {}{unit} on; the upper end is not decided",
            rounded(lower, 9)
        ),
        (None, Some(upper)) => format!(
            "up to {}{unit}; the lower end is not decided",
            rounded(upper, 9)
        ),
        _ => "not decided".into(),
    }
}

/// Tells the frequencies of crossings behind the margins that come from them.
pub(super) struct Crossings<'u>(pub(super) &'u Units);

impl Crossings<'_> {
    pub(super) fn one(&self, omega: f64) -> String {
        self.both(Range {
            lower: omega,
            upper: f64::NAN,
        })
    }

    pub(super) fn both(&self, omegas: Range) -> String {
        let known = [omegas.lower, omegas.upper].map(finite);
        let known: Vec<String> = known.into_iter().flatten().map(|o| rounded(o, 5)).collect();
        if known.is_empty() {
            return String::new();
        }
        let unit = unit_behind(&Field::Frequency.unit(self.0));
        format!(", at omega {}{unit}", known.join(" and "))
    }
}

/// Up to where an end was looked for that was not found.
pub(super) fn up_to(last: f64, unit: &str) -> String {
    finite(last).map_or_else(String::new, |last| {
        format!("; looked at up to {}{unit}", rounded(last, 8))
    })
}

pub(super) fn between(lower: f64, upper: f64, unit: &str) -> String {
    let digits = |end| finite(end).map(|end| rounded(end, 8));
    match (digits(lower), digits(upper)) {
        (None, None) => "whatever it is".into(),
        (None, Some(upper)) => format!("up to {upper}{unit}"),
        (Some(lower), None) => format!("from {lower}{unit} on"),
        (Some(lower), Some(upper)) => format!("from {lower} to {upper}{unit}"),
    }
}

/// The range of a parameter, and how far its ends are.
pub(super) fn along(margin: &Margin, at: f64, unit: &str) -> String {
    let range = between(margin.from, margin.to, unit);
    let share = |distance: f64| match at {
        0.0 => String::new(),
        at => format!(", {:.1} %", 100.0 * (distance / at).abs()),
    };
    let away = |sign: &str, distance| {
        finite(distance).map(|d| format!("{sign}{}{unit}{}", rounded(d, 5), share(d)))
    };
    let ways: Vec<String> = [away("-", margin.lower), away("+", margin.upper)]
        .into_iter()
        .flatten()
        .collect();
    match ways.is_empty() {
        true => range,
        false => format!("{range} ({})", ways.join("; ")),
    }
}
