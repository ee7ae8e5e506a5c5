//! Data in files of their own: the points of a friction law, `table = "curve.csv"` in a sweep or
//! case file, or a system, `system = "turning.toml"` in a sweep file. They are put into the text,
//! so that the text stored with a map or trace is complete.

use std::ops::Range;

use super::friction_table::{PAIRS, table_of_columns};
use super::system::{SystemModel, shipped};
use crate::text::toml_reader::{Entry, SpecError, entries, parse};

/// A text in which the names of other files are replaced by their contents.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Inlined {
    /// The text that is read and stored.
    pub text: String,
    /// The place of the name in the original text, and the place of the contents in the new one.
    places: Option<(Range<usize>, Range<usize>)>,
}

/// Why the contents of a named file could not be put into a text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum NotInlined {
    /// At a place of the text.
    Here(SpecError),
    /// At a place of a named file.
    There {
        /// The name of that file.
        name: String,
        /// Its text.
        text: String,
        /// What is wrong there.
        error: SpecError,
    },
}

impl From<SpecError> for NotInlined {
    fn from(error: SpecError) -> Self {
        Self::Here(error)
    }
}

impl Inlined {
    /// Puts the system that `system` names, or the points of the file that `friction.table` names,
    /// into `text`, if it names one. `read` returns the text of a file, or says why it cannot be
    /// read.
    ///
    /// # Errors
    /// At the name, when the file cannot be read or does not contain a table. Inside the named
    /// file, when it is not a valid system.
    /// system: in that file.
    pub(crate) fn new(
        text: &str,
        read: impl FnOnce(&str) -> Result<String, String>,
    ) -> Result<Self, NotInlined> {
        let unchanged = Self {
            text: text.to_owned(),
            places: None,
        };
        // Text that is no TOML is reported by its reader.
        let Ok(document) = parse(text) else {
            return Ok(unchanged);
        };
        let all = entries(document.get_ref(), "");
        let system = all.iter().find(|entry| entry.key == "system");
        if let Some((entry, Ok(name))) = system.map(|entry| (entry, entry.string())) {
            return Ok(Self::with(text, entry, &system_of(entry, name, read)?));
        }
        let friction = all.into_iter().filter(|entry| entry.key == "friction");
        let inside = friction.filter_map(|entry| entry.table().ok()).flatten();
        let mut tables = inside.filter(|entry| entry.key == PAIRS);
        let named = tables.find_map(|entry| Some((entry.string().ok()?, entry)));
        let Some((name, entry)) = named else {
            return Ok(unchanged);
        };
        Ok(Self::with(text, &entry, &points(&entry, name, read)?))
    }

    /// `text` with the value of an entry replaced.
    fn with(text: &str, entry: &Entry, value: &str) -> Self {
        let old = entry.span.clone();
        let new = old.start..old.start + value.len();
        Self {
            text: [&text[..old.start], value, &text[old.end..]].concat(),
            places: Some((old, new)),
        }
    }

    /// An error in [`Inlined::text`], moved to its place in the original text.
    #[must_use]
    pub(crate) fn in_original(&self, mut error: SpecError) -> SpecError {
        if let (Some((old, new)), Some(span)) = (&self.places, &mut error.span) {
            if span.start >= new.end {
                let shifted = |at: usize| at - new.end + old.end;
                *span = shifted(span.start)..shifted(span.end);
            } else if span.end > new.start {
                *span = old.clone();
            }
        }
        error
    }
}

/// The shipped system `name`, or the system of the file `name`, as a table.
fn system_of(
    entry: &Entry,
    name: &str,
    read: impl FnOnce(&str) -> Result<String, String>,
) -> Result<String, NotInlined> {
    if let Some(system) = shipped::system(name) {
        return Ok(system.to_inline_table());
    }
    let text = read(name).map_err(|why| {
        entry
            .error(format!("cannot read {name}: {why}"))
            .help(shipped::meant(name))
    })?;
    match text.parse::<SystemModel>() {
        Ok(system) => Ok(system.to_inline_table()),
        Err(error) => Err(NotInlined::There {
            name: name.to_owned(),
            text,
            error,
        }),
    }
}

/// The points of the file `name` as a list of pairs.
fn points(
    entry: &Entry,
    name: &str,
    read: impl FnOnce(&str) -> Result<String, String>,
) -> Result<String, SpecError> {
    let text = read(name).map_err(|why| entry.error(format!("cannot read {name}: {why}")))?;
    let table = table_of_columns(&text).map_err(|error| {
        let line = error
            .span
            .map(|span| 1 + text[..span.start].matches('\n').count());
        let line = line.map_or_else(String::new, |line| format!(":{line}"));
        SpecError {
            help: error.help,
            ..entry.error(format!("{name}{line}: {}", error.message))
        }
    })?;
    let pairs = table.speeds().iter().zip(table.mu_k());
    let pairs: Vec<String> = pairs
        .map(|(speed, mu)| format!("[{speed:?}, {mu:?}]"))
        .collect();
    Ok(format!("[{}]", pairs.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::law_kind::LawKind;
    use crate::setting::{CaseSpec, SweepSpec};

    const CURVE: &str = "speed,mu\n0,0.5\n0.25,0.30000000000000004\n";

    fn inlined(text: &str) -> Result<Inlined, SpecError> {
        Inlined::new(text, |name| match name {
            "curve.csv" => Ok(CURVE.to_owned()),
            "bad.csv" => Ok("speed,mu\n0,0.5\n\n0.25,x\n".to_owned()),
            _ => Err("there is none".to_owned()),
        })
        .map_err(|error| match error {
            NotInlined::Here(error) | NotInlined::There { error, .. } => error,
        })
    }

    #[test]
    fn points_take_the_place_of_the_name_however_it_is_written() {
        let axes = "[axes]\nv0 = [0.1]\ntau = [1]\n";
        for friction in [
            "[friction]\nlaw = \"table\"\ntable = \"curve.csv\"\n",
            "friction = { table = \"curve.csv\", law = \"table\" }\n",
            "friction.table = 'curve.csv'\nfriction.law = \"table\"\n",
        ] {
            let text = &format!("{friction}{axes}");
            let found = inlined(text).unwrap();
            let spec: SweepSpec = found.text.parse().unwrap();
            let Some(LawKind::Table(table)) = spec.fixed.law() else {
                panic!("{text}");
            };
            assert_eq!(table.speeds(), [0.0, 0.25]);
            assert_eq!(table.mu_k(), [0.5, 0.300_000_000_000_000_04]);
            assert_eq!(found.text.lines().count(), text.lines().count());
            let error = text.parse::<SweepSpec>().unwrap_err();
            assert!(error.message.contains("names a file"), "{error}");
        }
    }

    #[test]
    fn what_names_no_file_is_left_alone() {
        for text in ["", "friction = 3", "= 3", "[friction]\ntable = [[0, 1]]\n"] {
            assert_eq!(inlined(text).unwrap().text, text);
        }
    }

    #[test]
    fn mistakes_are_told_at_the_name_with_the_line_of_the_file() {
        let place = |text: &str| {
            let error = inlined(text).unwrap_err();
            (text[error.span.unwrap()].to_owned(), error.message)
        };
        let (at, message) = place("friction.table = \"none.csv\"");
        assert_eq!(at, "\"none.csv\"");
        assert_eq!(
            message,
            "friction.table: cannot read none.csv: there is none"
        );
        let (_, message) = place("friction.table = \"bad.csv\"");
        assert!(
            message.contains("bad.csv:4: this line is not two"),
            "{message}"
        );
    }

    /// Places before, inside and after the points are mapped to the original text.
    #[test]
    fn places_of_other_mistakes_are_those_of_the_text() {
        let friction = "[friction]\nlaw = \"table\"\ntable = \"curve.csv\"\n";
        for (text, expected) in [
            (format!("x = 1\n{friction}"), "x"),
            (
                format!("{friction}mu_s = 0.1\n[fixed]\nv0 = 1\n"),
                "\"curve.csv\"",
            ),
            (format!("{friction}[fixed]\nv0 = -1\n"), "-1"),
        ] {
            let found = inlined(&text).unwrap();
            let error = found.text.parse::<CaseSpec>().unwrap_err();
            let error = found.in_original(error);
            assert_eq!(&text[error.span.unwrap()], expected, "{}", error.message);
        }
    }
}
