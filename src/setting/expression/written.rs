//! An expression that stands in a file, with its place.

use std::ops::Range;

use super::part::Read;
use super::{Quotient, coefficients, reader};
use crate::text::toml_reader::{Entry, SpecError};
use crate::text::words;

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
    /// The dividends and divisors of a product of quotients, from which the text was made.
    pub(super) parts: Vec<Self>,
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
            parts: Vec::new(),
        })
    }

    /// A text that was made from what stands at `span`.
    pub(super) fn made(name: &str, text: String, span: &Range<usize>) -> Self {
        Self {
            name: name.to_owned(),
            text,
            span: span.clone(),
            from: None,
            coefficients: Vec::new(),
            parts: Vec::new(),
        }
    }

    /// A product of quotients at `span`, each a dividend and a divisor.
    pub(in crate::setting) fn product(
        name: &str,
        quotients: Vec<(Self, Option<Self>)>,
        span: &Range<usize>,
    ) -> Self {
        let text = quotients.iter().map(|(over, under)| match under {
            Some(under) => format!("{}/{}", over.grouped(), under.grouped()),
            None => over.grouped(),
        });
        let text = text.collect::<Vec<_>>().join(" * ");
        let parts = quotients.into_iter();
        let parts = parts.flat_map(|(over, under)| [Some(over), under]);
        Self {
            parts: parts.flatten().collect(),
            ..Self::made(name, text, span)
        }
    }

    /// Its text as an operand, in parentheses where it has operators.
    fn grouped(&self) -> String {
        let text = self.text.trim();
        if text.chars().all(|c| words::belongs(c) || c == '.') {
            return text.to_owned();
        }
        format!("({text})")
    }

    /// The quotient of polynomials in s that is written here. Each of `names` stands for the value
    /// with its index.
    pub(in crate::setting) fn read_quotient(&self, names: &[&str]) -> Result<Quotient, SpecError> {
        for coefficient in &self.coefficients {
            coefficient.read(|text| coefficients::check(text, names))?;
        }
        for part in &self.parts {
            part.read_quotient(names)?;
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
