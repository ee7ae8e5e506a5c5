//! The points of a measured friction law, as numbers in a sweep or case file.

use std::ops::Range;

use super::parameter::Parameter;
use super::units::Units;
use crate::model::Table;
use crate::model::table::{TableColumn, TableError};
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

/// The key for all points as pairs, or for the text with the points.
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
        if entry.string().is_ok() || entry.is_table() {
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
    fn any(&self) -> Option<(&Range<usize>, &'static str)> {
        let pairs = self.pairs.as_ref().map(|place| (place, PAIRS));
        let speeds = self
            .speeds
            .as_ref()
            .map(|c| (&c.0, TableColumn::Speeds.name()));
        let mu_k = self.mu_k.as_ref().map(|c| (&c.0, TableColumn::MuK.name()));
        pairs.or(speeds).or(mu_k)
    }

    /// An error if points are given although the law is no table.
    pub(super) fn check_none(&self, law: &str) -> Result<(), SpecError> {
        let Some((place, column)) = self.any() else {
            return Ok(());
        };
        let message = format!("{column} has no meaning with the {law} law");
        Err(SpecError::at(place.clone(), message).help("points are for law = \"table\""))
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
