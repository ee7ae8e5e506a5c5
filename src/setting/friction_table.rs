//! The points of a measured friction law, from a sweep file or a text with two columns.

use std::ops::Range;

use super::parameter::Parameter;
use super::units::Units;
use crate::model::table::{TableColumn, TableError};
use crate::model::{FrictionLaw, Table};
use crate::text::toml_reader::{Entry, SpecError};

/// The numbers of one column with their places in the text.
#[derive(Debug, Default)]
struct Numbers {
    values: Vec<f64>,
    places: Vec<Range<usize>>,
}

impl Numbers {
    fn push(&mut self, value: f64, place: Range<usize>) {
        self.values.push(value);
        self.places.push(place);
    }

    fn of_array(
        entry: &Entry,
        read: impl Fn(&Entry) -> Result<f64, SpecError>,
    ) -> Result<Self, SpecError> {
        let mut numbers = Self::default();
        for element in entry.array()? {
            numbers.push(read(&element)?, element.span.clone());
        }
        Ok(numbers)
    }
}

/// The key for all points as pairs, or for the file with the points.
pub(super) const PAIRS: &str = "table";

/// The columns of a table in a text.
#[derive(Debug, Default)]
pub(super) struct GivenTable {
    /// The place of the points if they are given as pairs.
    pairs: Option<Range<usize>>,
    speeds: Option<(Range<usize>, Numbers)>,
    mu_k: Option<(Range<usize>, Numbers)>,
}

impl GivenTable {
    /// Reads `entry` if it is a column. Returns whether it is one.
    pub(super) fn read(&mut self, entry: &Entry, units: &Units) -> Result<bool, SpecError> {
        let (column, of) = match entry.key {
            PAIRS => return self.read_pairs(entry, units).map(|()| true),
            key if key == TableColumn::Speeds.name() => (&mut self.speeds, Parameter::V0),
            key if key == TableColumn::MuK.name() => (&mut self.mu_k, Parameter::MuK),
            _ => return Ok(false),
        };
        let numbers = Numbers::of_array(entry, |of_one| units.number(of_one, of.dimension()))?;
        *column = Some((entry.key_span.clone(), numbers));
        self.given_twice().map(|()| true)
    }

    /// Reads points as pairs of a speed and a value of μ_K.
    fn read_pairs(&mut self, entry: &Entry, units: &Units) -> Result<(), SpecError> {
        if entry.string().is_ok() {
            let message = "it names a file, which only commands on a sweep or case file read";
            return Err(entry
                .error(message)
                .help("here the points are needed: table = [[0.0, 0.5], …]"));
        }
        let (mut speeds, mut mu_k) = (Numbers::default(), Numbers::default());
        for pair in entry.array()? {
            let [speed, mu] = &pair.array()?[..] else {
                return Err(pair.error("expected a speed and a value of mu_k"));
            };
            let [of_speed, of_mu] = [Parameter::V0, Parameter::MuK].map(Parameter::dimension);
            speeds.push(units.number(speed, of_speed)?, speed.span.clone());
            mu_k.push(units.number(mu, of_mu)?, mu.span.clone());
        }
        self.pairs = Some(entry.key_span.clone());
        self.given_twice()?;
        self.speeds = Some((entry.key_span.clone(), speeds));
        self.mu_k = Some((entry.key_span.clone(), mu_k));
        Ok(())
    }

    /// An error if points are given both as pairs and as columns.
    fn given_twice(&self) -> Result<(), SpecError> {
        match (&self.pairs, &self.speeds, &self.mu_k) {
            (Some(pairs), Some(_), _) | (Some(pairs), _, Some(_)) => {
                let message = "table: the points are given as speeds and mu_k as well";
                Err(SpecError::at(pairs.clone(), message).help("leave one of them out"))
            }
            _ => Ok(()),
        }
    }

    /// The place and name of a given column; none without columns.
    pub(super) fn any(&self) -> Option<(&Range<usize>, &'static str)> {
        let pairs = self.pairs.as_ref().map(|place| (place, PAIRS));
        let speeds = self
            .speeds
            .as_ref()
            .map(|c| (&c.0, TableColumn::Speeds.name()));
        let mu_k = self.mu_k.as_ref().map(|c| (&c.0, TableColumn::MuK.name()));
        pairs.or(speeds).or(mu_k)
    }

    /// The place of the first value of μ_K.
    pub(super) fn at_rest(&self) -> Option<&Range<usize>> {
        self.mu_k.as_ref()?.1.places.first()
    }

    /// The table; a missing column is reported at `law`.
    pub(super) fn table(&self, law: &Range<usize>) -> Result<Table, SpecError> {
        let missing = |column: TableColumn| {
            SpecError::at(law.clone(), format!("{} is not given", column.name())).help(
                "the table law goes through points: speeds = [0.0, …], mu_k = [0.5, …], or \
                     table = \"curve.csv\"",
            )
        };
        let speeds = self
            .speeds
            .as_ref()
            .ok_or_else(|| missing(TableColumn::Speeds));
        let mu_k = self.mu_k.as_ref().ok_or_else(|| missing(TableColumn::MuK));
        let ((_, speeds), (place, mu_k)) = (speeds?, mu_k?);
        built(speeds, mu_k, place)
    }
}

/// The table of two columns. Columns of different length are reported at `place`.
fn built(speeds: &Numbers, mu_k: &Numbers, place: &Range<usize>) -> Result<Table, SpecError> {
    Table::new(speeds.values.clone(), mu_k.values.clone()).map_err(|error| {
        let span = match error {
            TableError::Count { .. } => place,
            TableError::Value { column, index, .. } => match column {
                TableColumn::Speeds => &speeds.places[index],
                TableColumn::MuK => &mu_k.places[index],
            },
        };
        SpecError::at(span.clone(), error.to_string())
    })
}

/// What is wrong with a line that is no point.
const NOT_A_POINT: &str = "this line is not two numbers with decimal points, a speed and mu_k";
/// What lines are.
const COLUMNS: &str = "two columns, separated by a comma, a semicolon or blanks; only the first \
    line may be of titles";

/// Reads a table from a text with one line per point: the speed and μ_K, separated by a comma, a
/// semicolon or blanks. Empty lines, lines that begin with `#`, and one line of titles before the
/// first point are skipped.
///
/// # Errors
/// Points at the first line or number that is not understood or out of range, see [`Table::new`].
pub fn table_of_columns(text: &str) -> Result<Table, SpecError> {
    read_columns(text).map(|(table, _)| table)
}

/// Reads a table as [`table_of_columns`] does, for a friction law with the static coefficient
/// `mu_s`, its default if none is given.
///
/// # Errors
/// As there, and when the law is ill-posed, see [`FrictionLaw::table`].
pub(crate) fn table_of_law(text: &str, mu_s: Option<f64>) -> Result<Table, SpecError> {
    let (table, at_rest) = read_columns(text)?;
    let default = Parameter::MuS.default_value().filter(|_| mu_s.is_none());
    let posed = FrictionLaw::table(table.clone(), mu_s.or(default).unwrap_or(1.0));
    posed.map_err(|error| SpecError {
        span: at_rest,
        ..SpecError::whole(error.with_default_mu_s(default))
    })?;
    Ok(table)
}

/// The table, and the place of its first value of μ_K.
fn read_columns(text: &str) -> Result<(Table, Option<Range<usize>>), SpecError> {
    let (mut speeds, mut mu_k) = (Numbers::default(), Numbers::default());
    let mut titles = false;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let from = start;
        start += line.len();
        let content = line.trim();
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let fields = fields(line, from);
        let numbers = fields.iter().map(|f| text[f.clone()].parse::<f64>().ok());
        match numbers.collect::<Vec<_>>()[..] {
            [Some(speed), Some(mu)] => {
                speeds.push(speed, fields[0].clone());
                mu_k.push(mu, fields[1].clone());
            }
            [None, None] if speeds.values.is_empty() && !titles => titles = true,
            _ => {
                let place = from..from + line.trim_end().len();
                return Err(SpecError::at(place, NOT_A_POINT).help(COLUMNS));
            }
        }
    }
    let end = text.len();
    let table = built(&speeds, &mu_k, &(end..end)).map_err(|error| SpecError {
        span: error.span.filter(|span| !span.is_empty()),
        ..error
    })?;
    Ok((table, mu_k.places.into_iter().next()))
}

/// The places of the fields of a line that begins at `from`.
fn fields(line: &str, from: usize) -> Vec<Range<usize>> {
    let separated = |c: char| c == ',' || c == ';';
    // Some spreadsheets write a byte order mark at the beginning.
    let blank = |c: char| c.is_whitespace() || c == '\u{feff}';
    let place = |field: &str| {
        let at = from + (field.as_ptr() as usize - line.as_ptr() as usize);
        at..at + field.len()
    };
    match line.contains(separated) {
        true => line
            .split(separated)
            .map(|f| place(f.trim_matches(blank)))
            .collect(),
        false => line
            .split(blank)
            .filter(|f| !f.is_empty())
            .map(place)
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_read() {
        for text in [
            "0,0.5\n1,0.4\n",
            "speed; mu_k\n0; 0.5\n 1;0.4",
            "\u{feff}0,0.5\n\n1,0.4",
            "v mu\n# measured\n\n0\t0.5\r\n1  0.4\r\n",
        ] {
            let table = table_of_columns(text).unwrap();
            assert_eq!(table.speeds(), [0.0, 1.0], "{text}");
            assert_eq!(table.mu_k(), [0.5, 0.4], "{text}");
        }
    }

    #[test]
    fn mistakes_in_columns_are_pointed_at() {
        for (text, place, says) in [
            ("", "", "0 points: 2 to 4096 are needed"),
            ("0,0.5\n", "", "only 1 point: 2 to 4096 are needed"),
            ("0,0.5\n1\n", "1", "not two numbers"),
            ("0,0.5\n0.1;0,4\n", "0.1;0,4", "not two numbers"),
            ("0,0.5\n1,x\n", "1,x", "not two numbers"),
            ("v\nmu\n0,1\n", "v", "not two numbers"),
            ("a b\nc d\n", "c d", "not two numbers"),
            ("0,0.5\n2,0.4\n1,0.4", "1", "speeds = 1 is outside"),
            ("0,0.5\n1,-4\n", "-4", "mu_k = -4 is outside its range"),
            ("0,0.5\nnan,1\n", "nan", "speeds = NaN"),
            ("0 0.5 1\n", "0 0.5 1", "not two numbers"),
            (
                "0,1.5\n1,0.4\n",
                "1.5",
                "at most mu_s = 1 (not given: the default), else",
            ),
        ] {
            let error = table_of_law(text, None).unwrap_err();
            assert!(error.message.contains(says), "{text}: {error}");
            let found = error.span.clone().map_or("", |span| &text[span]);
            assert_eq!(found, place, "{text}: {error}");
        }
    }
}
