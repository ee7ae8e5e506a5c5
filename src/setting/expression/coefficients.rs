//! A polynomial that stands in a file as a list of its coefficients, the highest power first.

use super::names::names_in;
use super::reader::{VARIABLE, read_number};
use super::{Misread, Read, Tape, Written};
use crate::text::Shown;
use crate::text::toml_reader::{Entry, SpecError};

/// A coefficient: the expression that was given, or a number that is written out.
pub(in crate::setting) enum Coefficient {
    Number(f64),
    Given(Written),
}

impl Coefficient {
    /// What an element of a list gives.
    pub(in crate::setting) fn of(
        name: String,
        element: &Entry,
        whole: &str,
    ) -> Result<Self, SpecError> {
        if element.is_string() {
            return Written::of(name, element, whole).map(Self::Given);
        }
        if element.is_number() {
            return element.number().map(Self::Number);
        }
        Err(element.expected("a number or a string with an expression"))
    }

    fn is_zero(&self) -> bool {
        matches!(self, Self::Number(value) if *value == 0.0)
    }

    /// Its sign as an operator, and its size times the power `n`, as a product of an expression.
    fn term(&self, n: usize) -> (char, String) {
        let (sign, size) = match self {
            Self::Number(value) if *value < 0.0 => ('-', Shown(-value).to_string()),
            Self::Number(value) => ('+', Shown(*value).to_string()),
            Self::Given(written) => ('+', operand(written.text.trim())),
        };
        let power = match n {
            0 => return (sign, size),
            1 => VARIABLE.to_owned(),
            n => format!("{VARIABLE}^{n}"),
        };
        let is_one = matches!(self, Self::Number(value) if value.abs() == 1.0);
        let term = if is_one {
            power
        } else {
            format!("{size}*{power}")
        };
        (sign, term)
    }
}

/// An expression as an operand of products and sums, in parentheses where it may be a sum.
fn operand(text: &str) -> String {
    if text.contains(['+', '-']) {
        format!("({text})")
    } else {
        text.to_owned()
    }
}

/// The polynomial with these coefficients, as an expression.
fn sum(coefficients: &[Coefficient]) -> String {
    if let [Coefficient::Given(only)] = coefficients {
        return only.text.clone();
    }
    let degrees = (0..coefficients.len()).rev();
    let terms = coefficients.iter().zip(degrees);
    let mut sum = String::new();
    for (of, n) in terms.filter(|(of, _)| !of.is_zero()) {
        match (of.term(n), sum.is_empty()) {
            (('+', term), true) => sum = term,
            ((sign, term), true) => sum = format!("{sign}{term}"),
            ((sign, term), false) => sum += &format!(" {sign} {term}"),
        }
    }
    if sum.is_empty() { "0".into() } else { sum }
}

impl Written {
    /// The number that is written here, of these names; one with s in it is told `with_variable`.
    pub(in crate::setting) fn read_without_variable(
        &self,
        names: &[&str],
        with_variable: [&str; 2],
    ) -> Result<Tape, SpecError> {
        self.read(|text| check_number(text, names, with_variable))?;
        Ok(self.read_quotient(names)?.over)
    }

    /// A number that stands in a text, or an expression without s as a string.
    pub(in crate::setting) fn number(
        name: &str,
        entry: &Entry,
        whole: &str,
    ) -> Result<Self, SpecError> {
        Ok(match Coefficient::of(name.to_owned(), entry, whole)? {
            Coefficient::Given(written) => written,
            Coefficient::Number(value) => Self::made(name, Shown(value).to_string(), &entry.span),
        })
    }

    /// A polynomial that may also be a number alone.
    pub(in crate::setting) fn term(
        name: &str,
        entry: &Entry,
        whole: &str,
    ) -> Result<Self, SpecError> {
        if !entry.is_number() {
            return Self::polynomial(name, entry, whole);
        }
        Self::number(name, entry, whole)
    }

    /// A polynomial as written in a text: an expression, or a list of coefficients, which is turned
    /// into one. Coefficients that are expressions are kept, to be read in their places.
    pub(in crate::setting) fn polynomial(
        name: &str,
        entry: &Entry,
        whole: &str,
    ) -> Result<Self, SpecError> {
        if entry.is_string() {
            return Self::of(name.to_owned(), entry, whole);
        }
        if !entry.is_array() {
            return Err(entry.expected("a string with an expression, or a list of coefficients"));
        }
        let mut coefficients = Vec::new();
        for (i, element) in entry.array()?.iter().enumerate() {
            coefficients.push(Coefficient::of(format!("{name}[{i}]"), element, whole)?);
        }
        if coefficients.is_empty() {
            let error = entry.error("an empty list is no polynomial");
            return Err(error.help("its coefficients, the highest power first; [0] is zero"));
        }
        let text = sum(&coefficients);
        let given = coefficients.into_iter().filter_map(|of| match of {
            Coefficient::Given(written) => Some(written),
            Coefficient::Number(_) => None,
        });
        Ok(Self {
            coefficients: given.collect(),
            ..Self::made(name, text, &entry.span)
        })
    }
}

/// What a coefficient with s in it is told.
const WITH_VARIABLE: [&str; 2] = [
    "a coefficient with s in it",
    "[a, b, c] is a*s^2 + b*s + c: the place in the list is the power, or write one expression \
     instead of the list",
];

/// Checks that `text` is a number of these names, as a coefficient is.
pub(super) fn check(text: &str, names: &[&str]) -> Read<()> {
    check_number(text, names, WITH_VARIABLE)
}

/// Checks that `text` is a number of these names; one with s in it is told `message` and `help`.
fn check_number(text: &str, names: &[&str], [message, help]: [&str; 2]) -> Read<()> {
    let read = read_number(text, names, true).map(|_| ());
    read.map_err(|misread| {
        let variable = text.get(misread.place.clone()) == Some(VARIABLE);
        if !variable || !names_in(text).contains(&VARIABLE) {
            return misread;
        }
        Misread::at(misread.place, message).help(help)
    })
}
