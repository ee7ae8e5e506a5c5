//! Reads TOML with the place of every key and value, so that each error can point at it.

use std::ops::{Range, RangeInclusive};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::nearest::did_you_mean;
use super::toml_size;
use super::words;
use crate::text::Shown;

/// The most characters of a text for display.
const LONGEST_LINE: usize = 200;

/// Why a text was refused, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct SpecError {
    /// The error, with the allowed range.
    pub message: String,
    /// The bytes of the text in question; none for the whole text.
    pub span: Option<Range<usize>>,
    /// A suggestion.
    pub help: Option<String>,
}

impl SpecError {
    pub(crate) fn at(span: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            span: Some(span),
            help: None,
        }
    }

    /// An error of the sweep as a whole.
    pub fn whole(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            span: None,
            help: None,
        }
    }

    /// The error with advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// An error about an unknown key with this path, with the known ones.
pub(crate) fn unknown_key(path: &str, key: &str, known: &[&str]) -> SpecError {
    let meant = did_you_mean(key, known.iter().copied());
    SpecError::whole(format!("unknown key `{path}`"))
        .help(format!("{meant}known here: {}", known.join(", ")))
}

/// A value with its key, its path in the text, and the places of both.
#[derive(Clone)]
pub(crate) struct Entry<'t> {
    pub key: &'t str,
    /// Dotted path, for messages.
    pub path: String,
    pub key_span: Range<usize>,
    pub span: Range<usize>,
    value: &'t DeValue<'t>,
}

/// Parses a whole document.
pub(crate) fn parse(text: &str) -> Result<Spanned<DeTable<'_>>, SpecError> {
    toml_size::check(text)?;
    DeTable::parse(text).map_err(|error| SpecError {
        message: error.message().to_owned(),
        help: error.span().and_then(|span| greek_key_at(text, span.start)),
        span: error.span(),
    })
}

/// What is said where TOML is not understood at a Greek letter outside quotes.
fn greek_key_at(text: &str, at: usize) -> Option<String> {
    let word = text.get(at..)?;
    let end = word.find(|c| !words::belongs(c)).unwrap_or(word.len());
    let found = &word[..end];
    (!found.is_ascii()).then(|| format!("a key with Greek letters stands in quotes: \"{found}\""))
}

/// A key as TOML has it, in quotes where it needs them.
pub(crate) fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    match !name.is_empty() && name.chars().all(bare) {
        true => name.to_owned(),
        false => quoted(name),
    }
}

/// A basic string of TOML.
pub(crate) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted += &format!("\\u{:04X}", u32::from(c)),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

/// The entries of a table in the order of the text.
pub(crate) fn entries<'t>(table: &'t DeTable<'t>, path: &str) -> Vec<Entry<'t>> {
    let mut entries: Vec<Entry> = table
        .iter()
        .map(|(key, value)| Entry {
            key: key.get_ref(),
            path: if path.is_empty() {
                key.get_ref().to_string()
            } else {
                format!("{path}.{}", key.get_ref())
            },
            key_span: key.span(),
            span: value.span(),
            value: value.get_ref(),
        })
        .collect();
    entries.sort_by_key(|entry| entry.key_span.start);
    entries
}

impl<'t> Entry<'t> {
    /// An error about the value.
    pub(crate) fn error(&self, message: impl Into<String>) -> SpecError {
        SpecError::at(
            self.span.clone(),
            format!("{}: {}", self.path, message.into()),
        )
    }

    /// An error about an unknown key, with the known ones.
    pub(crate) fn unknown(&self, known: &[&str]) -> SpecError {
        SpecError {
            span: Some(self.key_span.clone()),
            ..unknown_key(&self.path, self.key, known)
        }
    }

    /// An error about a key that is known, but not here; `help` says where it belongs.
    pub(crate) fn elsewhere(&self, help: &str) -> SpecError {
        let message = format!("`{}` does not belong here", self.path);
        SpecError::at(self.key_span.clone(), message).help(help)
    }

    pub(crate) fn expected(&self, what: &str) -> SpecError {
        self.error(format!("expected {what}, found {}", kind(self.value)))
    }

    pub(crate) fn table(&self) -> Result<Vec<Entry<'t>>, SpecError> {
        match self.value {
            DeValue::Table(table) => Ok(entries(table, &self.path)),
            _ => Err(self.expected("a table")),
        }
    }

    pub(crate) fn is_table(&self) -> bool {
        matches!(self.value, DeValue::Table(_))
    }

    pub(crate) fn is_string(&self) -> bool {
        matches!(self.value, DeValue::String(_))
    }

    pub(crate) fn is_number(&self) -> bool {
        matches!(self.value, DeValue::Integer(_) | DeValue::Float(_))
    }

    pub(crate) fn is_array(&self) -> bool {
        matches!(self.value, DeValue::Array(_))
    }

    /// The elements of an array, each with its own place.
    pub(crate) fn array(&self) -> Result<Vec<Entry<'t>>, SpecError> {
        let DeValue::Array(array) = self.value else {
            return Err(self.expected("an array"));
        };
        let element = |(i, value): (usize, &'t Spanned<DeValue<'t>>)| Entry {
            key: self.key,
            path: format!("{}[{i}]", self.path),
            key_span: self.key_span.clone(),
            span: value.span(),
            value: value.get_ref(),
        };
        Ok(array.iter().enumerate().map(element).collect())
    }

    /// A finite number.
    pub(crate) fn number(&self) -> Result<f64, SpecError> {
        let value: f64 = match self.value {
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
                .ok()
                .map(|i| i as f64),
            _ => return Err(self.expected("a number")),
        }
        .ok_or_else(|| self.error("this number is too large"))?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.error("expected a finite number"))
        }
    }

    /// A number within a range.
    pub(crate) fn number_within(&self, range: RangeInclusive<f64>) -> Result<f64, SpecError> {
        self.within(self.number()?, range)
    }

    /// The number `value` of this entry, if it is within a range.
    pub(crate) fn within(&self, value: f64, range: RangeInclusive<f64>) -> Result<f64, SpecError> {
        if range.contains(&value) {
            return Ok(value);
        }
        let (from, to) = (range.start(), range.end());
        Err(self.error(format!(
            "{} is outside its range: {from:e} to {to:e}",
            Shown(value)
        )))
    }

    /// A whole number, not negative.
    pub(crate) fn whole(&self) -> Result<u64, SpecError> {
        if let DeValue::Integer(integer) = self.value {
            return u64::from_str_radix(integer.as_str(), integer.radix())
                .map_err(|_| self.error("expected a whole number between 0 and 2^64 − 1"));
        }
        let error = self.expected("a whole number");
        // 2^53: beyond it not all whole numbers are told from one another.
        let whole = |n: &f64| (0.0..=9_007_199_254_740_992.0).contains(n) && n.fract() == 0.0;
        Err(match self.number().ok().filter(whole) {
            Some(number) => error.help(format!("write {number}")),
            None => error,
        })
    }

    pub(crate) fn boolean(&self) -> Result<bool, SpecError> {
        match self.value {
            DeValue::Boolean(value) => Ok(*value),
            _ => Err(self.expected("true or false")),
        }
    }

    pub(crate) fn string(&self) -> Result<&'t str, SpecError> {
        match self.value {
            DeValue::String(value) => Ok(value),
            _ => Err(self.expected("a string")),
        }
    }

    /// What is found first in a string of the value: in the value itself, or in one within it.
    pub(crate) fn in_strings<T>(&self, find: &impl Fn(&str) -> Option<T>) -> Option<T> {
        in_strings(self.value, find)
    }

    /// A string on one line, no longer than pictures have room for.
    pub(crate) fn line(&self) -> Result<&'t str, SpecError> {
        let text = self.string()?;
        if text.chars().count() > LONGEST_LINE || text.chars().any(char::is_control) {
            return Err(self.error(format!(
                "expected one line of at most {LONGEST_LINE} characters, without control characters"
            )));
        }
        Ok(text)
    }
}

fn in_strings<T>(value: &DeValue, find: &impl Fn(&str) -> Option<T>) -> Option<T> {
    let within = |value: &Spanned<DeValue>| in_strings(value.get_ref(), find);
    match value {
        DeValue::String(text) => find(text),
        DeValue::Array(of) => of.iter().find_map(within),
        DeValue::Table(of) => of.values().find_map(within),
        _ => None,
    }
}

fn kind(value: &DeValue) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "an array",
        DeValue::Table(_) => "a table",
    }
}
