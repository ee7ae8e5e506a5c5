//! Tables as text (CSV): one row of names, then one row for each cell, vertex, sample or event.
//!
//! Numbers have the fewest digits from which the same bits are read. Infinities are `inf` and
//! `-inf`, a missing value is empty, kinds are words. Comments are written on request: lines that
//! begin with `#`, before the names.
//!
//! - `cells`: the cells of a map as rows
//! - `curves`: the crossing curves of a map as rows, one for each vertex
//! - `measured`: friction measured through control, a row for each v0
//! - `motion`: a motion as rows
//! - `response`: the samples of a response in time
//! - `speeds`: the column of a speed beside the delay that is its period
//! - `starts`: starts of motions with their outcomes, as rows

mod cells;
mod curves;
mod measured;
mod motion;
mod response;
mod speeds;
mod starts;

use std::fmt::Write as _;
use std::io::{self, Write};

pub use cells::write_cells;
pub use curves::write_curves;
pub use measured::write_measured;
pub use motion::{write_events, write_samples};
pub use response::write_response;
pub use starts::write_starts;

use super::visible::visible_line;
use crate::setting::quantity::Quantity;
use crate::setting::units::Units;
use crate::store::StoreError;

/// Why a table is not complete.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The map could not be read.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The text could not be written.
    #[error("cannot write: {0}")]
    Write(#[from] io::Error),
    /// It was stopped.
    #[error("stopped")]
    Stopped,
}

impl From<csv::Error> for TableError {
    fn from(error: csv::Error) -> Self {
        match error.into_kind() {
            csv::ErrorKind::Io(error) => Self::Write(error),
            other => Self::Write(io::Error::other(format!("{other:?}"))),
        }
    }
}

/// A column of a table.
struct Column {
    name: String,
    /// `1` where there is none; empty where a unit makes no sense.
    unit: String,
    about: String,
}

impl Column {
    fn of(name: impl Into<String>, unit: impl Into<String>, about: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            about: about.into(),
        }
    }

    fn of_parameter(parameter: &Quantity, unit: &str) -> Self {
        Self::of(parameter.name(), unit, parameter.long_name())
    }

    /// The column under another name.
    fn called(self, name: &str) -> Self {
        Self {
            name: name.into(),
            ..self
        }
    }
}

/// The comments besides the columns: texts, and values of parameters.
struct About {
    texts: Vec<(&'static str, String)>,
    fixed: Vec<(Quantity, f64)>,
    units: Units,
}

impl About {
    /// Keeps the texts that exist; used for maps and traces.
    fn new(
        texts: impl IntoIterator<Item = (&'static str, Option<String>)>,
        fixed: Vec<(Quantity, f64)>,
        units: Units,
    ) -> Self {
        let there = |(name, text): (&'static str, Option<String>)| {
            let text = text.filter(|text| !text.is_empty())?;
            Some((name, text))
        };
        Self {
            texts: texts.into_iter().filter_map(there).collect(),
            fixed,
            units,
        }
    }
}

/// A table that is being written.
struct Table<W: Write> {
    csv: csv::Writer<W>,
    text: String,
    rows: u64,
}

impl<W: Write> Table<W> {
    /// Writes the comments, if there are any, and the names of the columns.
    fn begin(mut out: W, about: Option<&About>, columns: &[Column]) -> Result<Self, TableError> {
        if let Some(about) = about {
            write_comments(&mut out, about, columns)?;
        }
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record(columns.iter().map(|column| &column.name))?;
        Ok(Self {
            csv,
            text: String::new(),
            rows: 0,
        })
    }

    fn text(&mut self, text: &str) -> Result<(), TableError> {
        Ok(self.csv.write_field(text)?)
    }

    fn number(&mut self, value: f64) -> Result<(), TableError> {
        self.text.clear();
        put_number(&mut self.text, value);
        Ok(self.csv.write_field(&self.text)?)
    }

    fn whole(&mut self, value: u64) -> Result<(), TableError> {
        self.text.clear();
        let _ = write!(self.text, "{value}");
        Ok(self.csv.write_field(&self.text)?)
    }

    fn end_row(&mut self) -> Result<(), TableError> {
        self.rows += 1;
        Ok(self.csv.write_record(None::<&[u8]>)?)
    }

    /// Completes the table; returns the number of rows.
    fn finish(mut self) -> Result<u64, TableError> {
        self.csv.flush()?;
        Ok(self.rows)
    }
}

/// Writes a number with the fewest digits that distinguish it from all others; nothing for NaN.
fn put_number(text: &mut String, value: f64) {
    // Writing to a string cannot fail.
    let _ = match value {
        f64::INFINITY => write!(text, "inf"),
        f64::NEG_INFINITY => write!(text, "-inf"),
        v if v.is_nan() => Ok(()),
        v if v == 0.0 || (1e-5..1e16).contains(&v.abs()) => write!(text, "{v}"),
        v => write!(text, "{v:e}"),
    };
}

fn write_comments(out: &mut impl Write, about: &About, columns: &[Column]) -> io::Result<()> {
    for (name, text) in &about.texts {
        writeln!(out, "# {name}: {}", visible_line(text))?;
    }
    for (parameter, value) in &about.fixed {
        let mut text = String::new();
        put_number(&mut text, *value);
        let unit = in_brackets(&parameter.unit(&about.units));
        writeln!(out, "# {} = {text}{unit}", parameter.name())?;
    }
    for column in columns {
        let unit = in_brackets(&visible_line(&column.unit));
        writeln!(
            out,
            "# {}{unit}: {}",
            column.name,
            visible_line(&column.about)
        )?;
    }
    Ok(())
}

fn in_brackets(unit: &str) -> String {
    match unit {
        "" | "1" => String::new(),
        unit => format!(" [{unit}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_were() {
        let shown = |value: f64| {
            let mut text = String::new();
            put_number(&mut text, value);
            text
        };
        for value in [
            0.1,
            -1.0 / 3.0,
            1e300,
            5e-324,
            f64::MAX,
            1e-5,
            9e15,
            f64::INFINITY,
            -0.0,
        ] {
            for value in [value, -value] {
                let read: f64 = shown(value).parse().unwrap();
                assert_eq!(read.to_bits(), value.to_bits(), "{value}");
                assert!(shown(value).len() < 26, "{value}");
            }
        }
        assert_eq!(
            [f64::NAN, 2.0, f64::NEG_INFINITY].map(shown),
            ["", "2", "-inf"]
        );
    }
}
