//! A number as people write it, with the unit behind it if there is one: `2.4kg`, `-5.5 N/mm`.

use std::fmt;
use std::ops::RangeInclusive;

use super::quantity::Quantity;
use super::unit::{Unit, described, example};
use super::units::{Units, read_units};
use crate::text::document::Document;
use crate::text::toml_reader::Entry;
use crate::text::{Shown, SpecError};

/// A number, with a unit if it has one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Amount {
    /// The number in decimal digits.
    number: String,
    unit: Option<Box<Unit>>,
}

impl fmt::Display for Amount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.unit {
            Some(unit) => write!(f, "{} {unit}", self.number),
            None => f.write_str(&self.number),
        }
    }
}

impl Amount {
    /// Reads a number, and the unit behind it; none for a text that begins with no number.
    ///
    /// # Errors
    /// Says what is not understood of the unit.
    pub(crate) fn read(text: &str) -> Option<Result<Self, SpecError>> {
        let text = text.trim();
        let whole = text.parse::<f64>().is_ok();
        let (number, unit) = text.split_at(if whole { text.len() } else { length(text)? });
        let unit = match whole {
            true => Ok(None),
            false => Unit::read(unit).map(|unit| Some(Box::new(unit))),
        };
        Some(unit.map(|unit| Self {
            number: number.to_owned(),
            unit,
        }))
    }

    /// Whether the number itself is finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.number.parse().is_ok_and(f64::is_finite)
    }

    /// The powers of force, length and time of its unit; 0 without one.
    pub(crate) fn dimension(&self) -> [i32; 3] {
        let unit = self.unit.as_ref();
        unit.map_or([0; 3], |unit| unit.dimension())
    }

    /// Whether the number depends on the system of units: it has a unit other than % and the like.
    pub(crate) fn needs_units(&self) -> bool {
        self.dimension() != [0; 3]
    }

    /// Checks that the unit, if there is one, has these powers of force, length and time.
    ///
    /// # Errors
    /// Says of what it is a unit, and what to type.
    pub(crate) fn check(&self, dimension: [i32; 3]) -> Result<(), SpecError> {
        let Some(unit) = self.unit.as_ref().filter(|u| u.dimension() != dimension) else {
            return Ok(());
        };
        let number = &self.number;
        let needed = described(dimension);
        Err(match dimension {
            [0, 0, 0] => {
                let of = described(unit.dimension());
                let message = format!("{unit} is a unit of {of}, and this is a number without one");
                SpecError::whole(message).help(format!("type {number} alone"))
            }
            _ => SpecError::whole(format!("{unit} is no unit of {needed}")).help(format!(
                "type a number and its unit, such as {number} {}, or the number alone",
                example(dimension)
            )),
        })
    }

    /// The number in `units`.
    ///
    /// # Errors
    /// When `units` has no known units to turn it into.
    pub(crate) fn value(&self, units: &Units) -> Result<f64, SpecError> {
        match &self.unit {
            Some(unit) => unit.value(&self.number, units),
            None => Ok(self.number.parse().unwrap_or(f64::NAN)),
        }
    }
}

/// The length of the number at the beginning of a text.
fn length(text: &str) -> Option<usize> {
    let digits = |text: &str| {
        text.find(|c: char| !c.is_ascii_digit())
            .unwrap_or(text.len())
    };
    let sign = usize::from(text.starts_with(['-', '+']));
    let mut at = sign + digits(&text[sign..]);
    if text[at..].starts_with('.') {
        at += 1 + digits(&text[at + 1..]);
    }
    text[..at].parse::<f64>().ok()?;
    if text[at..].starts_with(['e', 'E']) {
        let signed = usize::from(text[at + 1..].starts_with(['-', '+']));
        let power = digits(&text[at + 1 + signed..]);
        if power > 0 {
            at += 1 + signed + power;
        }
    }
    Some(at)
}

impl Units {
    /// The number of an entry that has these powers of force, length and time: a number, or a
    /// string of a number and its unit.
    pub(super) fn number(&self, entry: &Entry, dimension: [i32; 3]) -> Result<f64, SpecError> {
        let Ok(text) = entry.string() else {
            return entry.number();
        };
        let at = |error: SpecError| SpecError {
            help: error.help,
            ..entry.error(error.message)
        };
        let amount = Amount::read(text).ok_or_else(|| not_a_number(entry, dimension))?;
        let amount = amount.map_err(at)?;
        if amount.unit.is_none() {
            let message = "a number without a unit stands without quotes";
            return Err(entry.error(message).help(format!("write {amount}")));
        }
        amount.check(dimension).map_err(at)?;
        amount.value(self).map_err(at)
    }

    /// The dimension of a unit that is made of these units.
    pub(super) fn dimension_of(&self, text: &str) -> Result<[i32; 3], SpecError> {
        let unit = Unit::read(text)?;
        match unit.value("1", self)? {
            1.0 => Ok(unit.dimension()),
            other => {
                let own = self.of(unit.dimension());
                let message = format!("1 {unit} is {} {own}", Shown(other));
                let help = format!("type \"{own}\": numbers of the file are in its units");
                Err(SpecError::whole(message).help(help))
            }
        }
    }

    /// The number of an entry within a range, as [`Units::number`] reads it.
    pub(super) fn number_within(
        &self,
        entry: &Entry,
        dimension: [i32; 3],
        range: RangeInclusive<f64>,
    ) -> Result<f64, SpecError> {
        entry.within(self.number(entry, dimension)?, range)
    }

    /// The value of a quantity in an entry.
    pub(super) fn value(&self, entry: &Entry, of: &Quantity) -> Result<f64, SpecError> {
        self.number(entry, of.dimension())
    }
}

fn not_a_number(entry: &Entry, dimension: [i32; 3]) -> SpecError {
    let error = entry.expected("a number");
    match dimension {
        [0, 0, 0] => error,
        _ => error.help(format!(
            "or a number and its unit, such as \"1.5 {}\"",
            example(dimension)
        )),
    }
}

/// The units of a file: those of its key `units`, or the SI where it has no such key but numbers
/// with units.
pub(super) fn units_of(document: &mut Document) -> Units {
    let declared = document.key("units").is_some();
    if let Some(units) = document.take("units", read_units) {
        return units;
    }
    if declared {
        // What is wrong with the key is reported; numbers with units are not to blame.
        return Units::si();
    }
    let has_unit = |text: &str| matches!(Amount::read(text), Some(Ok(of)) if of.needs_units());
    match document.any_string_but(&["title"], has_unit) {
        true => Units::assumed_si(),
        false => Units::default(),
    }
}
