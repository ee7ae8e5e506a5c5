//! An expression that stands in a file, with its place.

use std::ops::Range;

use super::part::Read;
use super::{Tape, coefficients, reader};
use crate::text::toml_reader::{Entry, SpecError};

/// An expression as written in a text.
pub(in crate::setting) struct Written {
    pub name: String,
    pub text: String,
    /// Where the string stands, with its quotes, or the list.
    pub span: Range<usize>,
    /// Where its first character stands; none where the written text differs from its value, as
    /// with escapes, or was made from a list.
    pub(super) from: Option<usize>,
    /// The coefficients of a list that are expressions.
    pub(super) coefficients: Vec<Self>,
}

impl Written {
    pub(in crate::setting) fn of(
        name: String,
        entry: &Entry,
        whole: &str,
    ) -> Result<Self, SpecError> {
        let text = entry.string()?.to_owned();
        let literal = whole.get(entry.span.clone()).unwrap_or_default();
        let unquoted = literal.trim_matches(['"', '\'']);
        let inside = literal.find(unquoted).filter(|_| !unquoted.is_empty());
        // TOML ignores a line break right after three quotes.
        let skipped = unquoted.len().saturating_sub(text.len());
        let same = unquoted.ends_with(&text) && unquoted[..skipped].trim().is_empty();
        Ok(Self {
            name,
            from: inside
                .filter(|_| same)
                .map(|at| entry.span.start + at + skipped),
            span: entry.span.clone(),
            text,
            coefficients: Vec::new(),
        })
    }

    /// The polynomial in s that is written here. Each of `names` stands for the value with its
    /// index.
    pub(in crate::setting) fn read_polynomial(&self, names: &[&str]) -> Result<Tape, SpecError> {
        for coefficient in &self.coefficients {
            coefficient.read(|text| coefficients::check(text, names))?;
        }
        self.read(|text| reader::read(text, names))
    }

    /// What `read` makes of the text. What it does not understand is reported in its place.
    pub(in crate::setting) fn read<T>(
        &self,
        read: impl FnOnce(&str) -> Read<T>,
    ) -> Result<T, SpecError> {
        read(&self.text).map_err(|misread| {
            let span = match self.from {
                // Something missing at the end is reported at the closing quote.
                Some(from) if misread.place.is_empty() => {
                    from + misread.place.start..from + misread.place.end + 1
                }
                Some(from) => from + misread.place.start..from + misread.place.end,
                None => self.span.clone(),
            };
            SpecError {
                span: Some(span),
                help: misread.help,
                ..SpecError::whole(format!("{}: {}", self.name, misread.message))
            }
        })
    }
}
