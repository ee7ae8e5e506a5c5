//! Data in files of their own: the points of a friction law, `table = "curve.csv"` in a sweep or
//! case file, or a system, `system = "turning.toml"` in a sweep file. They are put into the text,
//! so that the text stored with a map or trace is complete.

use std::ops::Range;

use super::amount::units_of;
use super::friction_table::PAIRS;
use super::keys::{CURVE, names};
use super::measured::{Columns, CurveOptions, Measured, SpeedUnit, Spoken};
use super::parameter::Parameter;
use super::system::{SystemModel, shipped};
use super::units::Units;
use crate::text::document::Document;
use crate::text::toml_reader::{Entry, SpecError, entries, parse};

/// A text in which the names of other files are replaced by their contents.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Inlined {
    /// The text that is read and stored.
    pub text: String,
    /// What is told of the contents.
    pub remarks: Vec<String>,
    /// The place of the name in the original text, and the place of the contents in the new one.
    places: Option<(Range<usize>, Range<usize>)>,
}

/// What a named file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// A system, as TOML.
    System,
    /// The columns of a measured curve.
    Table,
}

/// Why the contents of a named file could not be put into a text.
#[derive(Debug, Clone, PartialEq)]
pub enum NotInlined {
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
    /// Puts the system that `system` names, or the points that `friction.table` names or holds as a
    /// text of columns, into `text`, if there are such. `read` returns the text of a file, or says
    /// why it cannot be read.
    ///
    /// # Errors
    /// At the name, when the file cannot be read. Inside the named file, when it is not a valid
    /// system or curve.
    pub fn new(
        text: &str,
        read: impl FnOnce(&str, Named) -> Result<String, String>,
    ) -> Result<Self, NotInlined> {
        // Text that is no TOML is reported by its reader.
        let Ok(document) = parse(text) else {
            return Ok(Self::unchanged(text));
        };
        let all = entries(document.get_ref(), "");
        let system = all.iter().find(|entry| entry.key == "system");
        if let Some((entry, Ok(name))) = system.map(|entry| (entry, entry.string())) {
            let system = system_of(entry, name, |name| read(name, Named::System))?;
            return Ok(Self::with(text, entry, &system));
        }
        let Some(entry) = curve(&all) else {
            return Ok(Self::unchanged(text));
        };
        refuse_spread(&entry, text)?;
        let keys = CurveKeys::of(&entry, &all)?;
        let name = match &keys.source {
            Source::Text(columns) => return Ok(Self::with_columns(text, &entry, columns, &keys)?),
            Source::File(name) => name,
        };
        let columns = read(name.string()?, Named::Table);
        let name = name.string()?;
        let columns = columns.map_err(|why| entry.error(format!("cannot read {name}: {why}")))?;
        match Self::with_points(text, &entry, &columns, &keys.options) {
            Ok(mut inlined) => {
                let named = |remark: &String| format!("{name}: {remark}");
                inlined.remarks = inlined.remarks.iter().map(named).collect();
                Ok(inlined)
            }
            Err(error) => Err(NotInlined::There {
                name: name.to_owned(),
                text: columns,
                error,
            }),
        }
    }

    /// Puts points that `friction.table` holds as a text of columns into `text`. Names of files are
    /// left alone.
    ///
    /// # Errors
    /// At the text of columns, when it is no valid curve.
    pub fn pasted(text: &str) -> Result<Self, SpecError> {
        let Ok(document) = parse(text) else {
            return Ok(Self::unchanged(text));
        };
        let all = entries(document.get_ref(), "");
        let Some(entry) = curve(&all).filter(Entry::is_table) else {
            return Ok(Self::unchanged(text));
        };
        refuse_spread(&entry, text)?;
        let keys = CurveKeys::of(&entry, &all)?;
        match &keys.source {
            Source::Text(columns) => Self::with_columns(text, &entry, columns, &keys),
            Source::File(_) => Ok(Self::unchanged(text)),
        }
    }

    fn unchanged(text: &str) -> Self {
        Self {
            text: text.to_owned(),
            remarks: Vec::new(),
            places: None,
        }
    }

    /// `text` with the value of an entry replaced.
    fn with(text: &str, entry: &Entry, value: &str) -> Self {
        let old = entry.span.clone();
        let new = old.start..old.start + value.len();
        Self {
            text: [&text[..old.start], value, &text[old.end..]].concat(),
            remarks: Vec::new(),
            places: Some((old, new)),
        }
    }

    /// `text` with the points of columns in the place of an entry; the columns are the value of
    /// another entry, at which errors are told.
    fn with_columns(
        text: &str,
        entry: &Entry,
        columns: &Entry,
        keys: &CurveKeys,
    ) -> Result<Self, SpecError> {
        let read = Self::with_points(text, entry, columns.string()?, &keys.options);
        read.map_err(|error| SpecError {
            span: Some(columns.span.clone()),
            ..error
        })
    }

    /// `text` with the points of columns in the place of an entry.
    fn with_points(
        text: &str,
        entry: &Entry,
        columns: &str,
        options: &CurveOptions,
    ) -> Result<Self, SpecError> {
        let measured = Measured::read(columns, options)?;
        let table = measured.table()?;
        let pairs = table.speeds().iter().zip(table.mu_k());
        let pairs: Vec<String> = pairs
            .map(|(speed, mu)| format!("[{speed:?}, {mu:?}]"))
            .collect();
        Ok(Self {
            remarks: measured.remarks.iter().map(ToString::to_string).collect(),
            ..Self::with(text, entry, &format!("[{}]", pairs.join(", ")))
        })
    }

    /// A place in [`Inlined::text`] as a place of the original text.
    #[must_use]
    pub(crate) fn original(&self, place: Range<usize>) -> Range<usize> {
        match &self.places {
            Some((old, new)) if place.start >= new.end => {
                let shifted = |at: usize| at - new.end + old.end;
                shifted(place.start)..shifted(place.end)
            }
            Some((old, new)) if place.end > new.start => old.clone(),
            _ => place,
        }
    }

    /// An error in [`Inlined::text`], moved to its place in the original text.
    #[must_use]
    pub fn in_original(&self, error: SpecError) -> SpecError {
        SpecError {
            span: error.span.map(|span| self.original(span)),
            ..error
        }
    }
}

/// The entry of a friction law's points, where they are in a file or a text of columns.
fn curve<'t>(all: &[Entry<'t>]) -> Option<Entry<'t>> {
    let friction = all.iter().filter(|entry| entry.key == "friction");
    let inside = friction.filter_map(|entry| entry.table().ok()).flatten();
    let mut tables = inside.filter(|entry| entry.key == PAIRS);
    tables.find(|entry| entry.string().is_ok() || entry.is_table())
}

/// Refuses a table whose keys are spread over lines: its points take the place of one value.
fn refuse_spread(entry: &Entry, text: &str) -> Result<(), SpecError> {
    let is_one_value = !entry.is_table() || text[entry.span.clone()].starts_with('{');
    if is_one_value {
        return Ok(());
    }
    let message = "its keys stand in braces, as in table = { file = \"curve.csv\" }";
    Err(entry.error(message))
}

/// Where the columns of a curve are, as entries of strings.
enum Source<'t> {
    File(Entry<'t>),
    Text(Entry<'t>),
}

/// What is said of a curve beside a sweep or case file's own numbers.
struct CurveKeys<'t> {
    source: Source<'t>,
    options: CurveOptions,
}

impl<'t> CurveKeys<'t> {
    /// The keys of an entry: the name of a file, or a table. The load is that of `[fixed]` unless
    /// it is given.
    fn of(entry: &Entry<'t>, all: &[Entry<'t>]) -> Result<Self, SpecError> {
        let units = units_beside_curve(all);
        let mut options = CurveOptions {
            normal_load: fixed_load(all, &units),
            units: units.clone(),
            spoken: Spoken::Keys,
            ..CurveOptions::default()
        };
        if !entry.is_table() {
            let source = Source::File(entry.clone());
            return Ok(Self { source, options });
        }
        let mut keys = entry.document(names(&CURVE))?;
        let [file, text] = ["file", "text"].map(|key| keys.take(key, string));
        options.columns = keys
            .take("columns", |entry| read_as(entry, Columns::read))
            .unwrap_or_default();
        options.speed_unit = keys.take("speed_unit", |entry| read_as(entry, SpeedUnit::read));
        let load = keys.take("normal_load", |entry| {
            let load = Parameter::NormalLoad;
            let checked = load.check(units.number(entry, load.dimension())?);
            checked.map_err(|error| SpecError::at(entry.span.clone(), error.to_string()))
        });
        options.normal_load = load.or(options.normal_load);
        keys.finish()?;
        let source = match (file, text) {
            (Some(file), None) => Source::File(file),
            (None, Some(text)) => Source::Text(text),
            _ => {
                let message = "expected either the name of a file or its text";
                return Err(entry
                    .error(message)
                    .help("table = { file = \"curve.csv\", … }"));
            }
        };
        Ok(Self { source, options })
    }
}

/// The units of the file, whatever its curve says: nothing of that is left in what is read.
fn units_beside_curve(all: &[Entry]) -> Units {
    let others = all.iter().filter(|entry| entry.key != "friction");
    units_of(&mut Document::of(others.cloned().collect(), ["units"]))
}

/// The load in `[fixed]`, if it is there.
fn fixed_load(all: &[Entry], units: &Units) -> Option<f64> {
    let fixed = all
        .iter()
        .find(|entry| entry.key == "fixed")?
        .table()
        .ok()?;
    let load = Parameter::NormalLoad;
    let mut given = fixed.iter().filter(|entry| entry.key == load.name());
    units.number(given.next()?, load.dimension()).ok()
}

fn string<'t>(entry: &Entry<'t>) -> Result<Entry<'t>, SpecError> {
    entry.string().map(|_| entry.clone())
}

/// A string that is read as something.
fn read_as<T>(entry: &Entry, read: fn(&str) -> Result<T, String>) -> Result<T, SpecError> {
    read(entry.string()?).map_err(|why| entry.error(why))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::law_kind::LawKind;
    use crate::setting::{CaseSpec, SweepSpec};

    const CURVE: &str = "speed,mu\n0,0.5\n0.25,0.30000000000000004\n";

    const BAD: &str = "speed,mu\n0,0.5\n\n0.25,-1\n";

    fn inlined(text: &str) -> Result<Inlined, SpecError> {
        Inlined::new(text, |name, _| match name {
            "curve.csv" => Ok(CURVE.to_owned()),
            "bad.csv" => Ok(BAD.to_owned()),
            "force.csv" => Ok("a b c\n1 1.5 20\n2 1 10\n".to_owned()),
            _ => Err("there is none".to_owned()),
        })
        .map_err(|error| match error {
            NotInlined::Here(error) | NotInlined::There { error, .. } => error,
        })
    }

    /// Keys of a table on lines of their own are no one value that points can take the place of.
    #[test]
    fn a_spread_table_is_refused_at_its_place() {
        let axes = "[axes]\nv0 = [0.1]\ntau = [1]\n";
        for friction in [
            "[friction]\nlaw = \"table\"\ntable.text = \"0 0.5\"\n",
            "[friction]\nlaw = \"table\"\n[friction.table]\nfile = \"curve.csv\"\n",
        ] {
            let text = format!("{friction}{axes}");
            let error = inlined(&text).unwrap_err();
            assert!(error.message.contains("stand in braces"), "{error}");
            assert!(error.span.is_some());
        }
        let pasted = Inlined::pasted("friction.table.text = \"0 0.5\"\n");
        assert!(pasted.unwrap_err().message.contains("stand in braces"));
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
    fn mistakes_are_told_at_their_place() {
        let place = |text: &str| {
            let error = inlined(text).unwrap_err();
            let span = error.span.unwrap();
            (text.get(span).unwrap_or_default().to_owned(), error.message)
        };
        let (at, message) = place("friction.table = \"none.csv\"");
        assert_eq!(at, "\"none.csv\"");
        assert_eq!(
            message,
            "friction.table: cannot read none.csv: there is none"
        );
        // In the named file.
        let error = inlined("friction.table = \"bad.csv\"").unwrap_err();
        assert_eq!(&BAD[error.span.unwrap()], "-1");
        for (table, at, says) in [
            ("text = '0;0.5'", "'0;0.5'", "only 1 point"),
            ("text = '0', columns = \"3\"", "\"3\"", "a list like"),
            (
                "file = 'none.csv', speed_unit = \"m\"",
                "\"m\"",
                "no known unit",
            ),
            (
                "text = '0', normal_load = -1",
                "-1",
                "normal_load = -1 is outside",
            ),
            ("text = '0', column = 1", "column", "unknown key"),
            (
                "columns = \"mu=2\"",
                "{ columns = \"mu=2\" }",
                "either the name",
            ),
        ] {
            let (found, message) = place(&format!("friction.table = {{ {table} }}"));
            assert!(found == at && message.contains(says), "{found}: {message}");
        }
    }

    /// The load of forces is that of the curve, else that of the setting.
    #[test]
    fn a_table_of_keys_says_how_columns_are_read() {
        let read = |keys: &str| {
            let text = "units = \"SI\"\nfixed.normal_load = 2\nfixed.v0 = 0.1\nfixed.tau = 1\n";
            let law = format!("friction.law = \"table\"\nfriction.table = {{ {keys} }}\n");
            let found = inlined(&format!("{text}{law}")).unwrap();
            let spec: CaseSpec = found.text.parse().unwrap();
            match spec.setting.law() {
                Some(LawKind::Table(table)) => (table.speeds().to_vec(), table.mu_k().to_vec()),
                _ => panic!("{keys}"),
            }
        };
        let text = r#"text = "n;F;v\n1;1,5;20\n2;1;10""#;
        let unit = r#"speed_unit = "mm/s""#;
        let expected = |load: f64| (vec![0.01, 0.02], vec![1.0 / load, 1.5 / load]);
        assert_eq!(read(&format!("{text}, {unit}")), expected(2.0));
        let load = format!("{text}, {unit}, normal_load = 4");
        assert_eq!(read(&load), expected(4.0));
        let file = format!("file = 'force.csv', {unit}, columns = \"speed=3,force=2\"");
        assert_eq!(read(&file), expected(2.0));
    }

    #[test]
    fn only_text_is_read_where_there_are_no_files() {
        let text = "friction = { law = \"table\", table = { text = \"0 0.5\\n1 0.4\\nx\" } }\n";
        let pasted = Inlined::pasted(text).unwrap();
        assert!(pasted.text.contains("table = [[0.0, 0.5], [1.0, 0.4]] }"));
        assert_eq!(pasted.remarks, ["line 3 is left out: it is no numbers"]);
        for text in ["friction.table = \"a.csv\"", "system = \"turning\"", "= 3"] {
            assert_eq!(Inlined::pasted(text).unwrap().text, text);
        }
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
