//! Reads a system, from a file of its own or as a table of a sweep file.

use std::ops::Range;
use std::sync::Arc;

use super::expression::{self, FUNCTIONS, VARIABLE};
use super::parameter::{OwnParameter, WIDEST};
use super::{Expression, Form, SpeedAxis, SpeedUnit, SystemModel};
use crate::setting::map_names;
use crate::setting::parameter::Parameter;
use crate::text::nearest::did_you_mean;
use crate::text::toml_reader::{Entry, SpecError, entries, parse};

/// The most parameters of a system.
const MOST_PARAMETERS: usize = 64;
/// The longest name, in characters.
const LONGEST_NAME: usize = 40;

/// The keys of a system.
const KEYS: [&str; 7] = ["title", "P", "Q", "B", "A", "parameters", "speed_axis"];

/// An expression as written in a text.
struct Written {
    name: &'static str,
    text: String,
    /// Where the string stands, with its quotes.
    span: Range<usize>,
    /// Where its first character stands; none where the written text differs from its value, as
    /// with escapes.
    from: Option<usize>,
}

impl Written {
    fn of(name: &'static str, entry: &Entry, whole: &str) -> Result<Self, SpecError> {
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
        })
    }

    fn read(&self, names: &[&str]) -> Result<Expression, SpecError> {
        let tape = expression::read(&self.text, names).map_err(|misread| {
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
        })?;
        Ok(Expression {
            text: self.text.clone(),
            tape,
        })
    }
}

/// The parts of a system read so far, before they are known to be consistent.
#[derive(Default)]
struct Draft {
    title: String,
    polynomials: Vec<(Written, Range<usize>)>,
    parameters: Vec<(OwnParameter, Range<usize>)>,
    speed_axis: Option<SpeedAxis>,
}

impl std::str::FromStr for SystemModel {
    type Err = SpecError;

    /// Reads a system file.
    ///
    /// # Errors
    /// Points at the first place that is not understood, out of range or contradictory.
    fn from_str(text: &str) -> Result<Self, SpecError> {
        let document = parse(text)?;
        Self::of_entries(entries(document.get_ref(), ""), text, None)
    }
}

impl SystemModel {
    /// Reads a system given as a table of the text `whole`.
    pub(in crate::setting) fn of_table(table: &Entry, whole: &str) -> Result<Self, SpecError> {
        Self::of_entries(table.table()?, whole, Some(&table.key_span))
    }

    fn of_entries(
        entries: Vec<Entry>,
        whole: &str,
        place: Option<&Range<usize>>,
    ) -> Result<Self, SpecError> {
        let mut draft = Draft::default();
        for entry in entries {
            let polynomial = match entry.key {
                "title" => {
                    entry.line()?.clone_into(&mut draft.title);
                    continue;
                }
                "parameters" => {
                    draft.read_parameters(&entry)?;
                    continue;
                }
                "speed_axis" => {
                    draft.speed_axis = Some(read_speed_axis(&entry)?);
                    continue;
                }
                "P" => "P",
                "Q" => "Q",
                "B" => "B",
                "A" => "A",
                _ => return Err(entry.unknown(&KEYS)),
            };
            let written = Written::of(polynomial, &entry, whole)?;
            draft.polynomials.push((written, entry.key_span.clone()));
        }
        draft.finish(place)
    }
}

impl Draft {
    fn read_parameters(&mut self, table: &Entry) -> Result<(), SpecError> {
        for entry in table.table()? {
            check_name(&entry)?;
            if self.parameters.len() == MOST_PARAMETERS {
                let message = format!("more than {MOST_PARAMETERS} parameters");
                return Err(SpecError::at(entry.key_span.clone(), message));
            }
            let own = OwnParameter {
                index: self.parameters.len(),
                ..read_parameter(&entry)?
            };
            self.parameters.push((own, entry.key_span.clone()));
        }
        Ok(())
    }

    fn finish(self, place: Option<&Range<usize>>) -> Result<SystemModel, SpecError> {
        let missing = |message: &str| SpecError {
            span: place.cloned(),
            ..SpecError::whole(message)
                .help("either P and Q, or the open loop B and the feedback A: expressions in s")
        };
        let by_name = |name: &str| self.polynomials.iter().find(|(of, _)| of.name == name);
        let names = self.parameters.iter().map(|(own, _)| &*own.name);
        let names: Vec<&str> = names.chain([Parameter::Tau.name()]).collect();
        let form = match (by_name("P"), by_name("Q"), by_name("B"), by_name("A")) {
            (Some((p, _)), Some((q, _)), None, None) => {
                Form::Direct([p.read(&names)?, q.read(&names)?])
            }
            (None, None, Some((open, _)), Some((gain, _))) => {
                self.check_feedback_names()?;
                let (open, gain) = (open.read(&names)?, (gain.read(&names)?, &gain.span));
                check_degrees(&open, &gain.0, gain.1)?;
                Form::Feedback([open, gain.0])
            }
            (None, None, None, None) => return Err(missing("a system needs its polynomials")),
            (Some((one, _)), None, None, None)
            | (None, Some((one, _)), None, None)
            | (None, None, Some((one, _)), None)
            | (None, None, None, Some((one, _))) => {
                return Err(missing(&format!("{} alone makes no system", one.name)));
            }
            _ => {
                let place = self.polynomials.last().map(|(_, place)| place.clone());
                return Err(SpecError {
                    span: place,
                    ..missing("P and Q are one form, B and A another: not both")
                });
            }
        };
        let model = SystemModel {
            title: self.title,
            form,
            parameters: self
                .parameters
                .iter()
                .map(|(own, _)| Arc::new(own.clone()))
                .collect(),
            speed_axis: self.speed_axis,
        };
        for (index, (own, place)) in self.parameters.iter().enumerate() {
            if !model.polynomials().any(|(_, of)| of.tape.uses(index)) {
                let message = format!("{} stands in no polynomial: it has no effect", own.name);
                return Err(SpecError::at(place.clone(), message).help("leave it out"));
            }
        }
        Ok(model)
    }

    /// Refuses the names of memory and latency, which every system in feedback form has.
    fn check_feedback_names(&self) -> Result<(), SpecError> {
        let taken = |own: &OwnParameter| matches!(&*own.name, "memory" | "latency");
        match self.parameters.iter().find(|(own, _)| taken(own)) {
            Some((own, place)) => {
                let message = format!(
                    "{} is reserved: every system of B and A has it as a parameter",
                    own.name
                );
                Err(SpecError::at(place.clone(), message).help("leave it out"))
            }
            None => Ok(()),
        }
    }
}

fn check_degrees(
    open: &Expression,
    gain: &Expression,
    place: &Range<usize>,
) -> Result<(), SpecError> {
    let (m, n) = (gain.tape.degree(), open.tape.degree());
    if m < n {
        return Ok(());
    }
    let message = format!("A: its degree is {m} and that of B {n}: A must have the smaller one");
    Err(SpecError::at(place.clone(), message).help("write the system as P and Q"))
}

/// Checks that a name is valid for a parameter.
fn check_name(entry: &Entry) -> Result<(), SpecError> {
    let name = entry.key;
    let refuse = |message: String| Err(SpecError::at(entry.key_span.clone(), message));
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
    if !begins || !name.chars().all(word) || name.len() > LONGEST_NAME {
        let error = refuse(format!("`{name}` is no name of a parameter"));
        return error.map_err(|e| e.help("a letter, then letters, digits and _, 40 at most"));
    }
    let why = match name {
        VARIABLE => "it is the variable of the polynomials",
        _ if name == Parameter::Tau.name() => "it is the delay, which every system has",
        _ if FUNCTIONS.contains(&name) => "it is a function",
        _ if map_names::taken().any(|taken| taken == name) => "maps have a variable of that name",
        _ => return Ok(()),
    };
    let error = refuse(format!("{name} is reserved: {why}"));
    error.map_err(|e| e.help(format!("call it {name}_1, for example")))
}

fn read_parameter(of: &Entry) -> Result<OwnParameter, SpecError> {
    let mut own = OwnParameter {
        index: 0,
        name: of.key.to_owned(),
        long_name: of.key.to_owned(),
        default: 0.0,
        minimum: WIDEST[0],
        maximum: WIDEST[1],
        unit: "1".to_owned(),
    };
    let widest = WIDEST[0]..=WIDEST[1];
    if !of.is_table() {
        own.default = of.number_within(widest).map_err(|error| {
            error.help(
                "a parameter is its default or { long_name, default, minimum, maximum, unit }",
            )
        })?;
        return Ok(own);
    }
    let mut place = None;
    for entry in of.table()? {
        match entry.key {
            "long_name" => entry.line()?.clone_into(&mut own.long_name),
            "unit" => read_unit(&entry)?.clone_into(&mut own.unit),
            "default" => {
                own.default = entry.number_within(widest.clone())?;
                place = Some(entry.span.clone());
            }
            "minimum" => own.minimum = entry.number_within(widest.clone())?,
            "maximum" => own.maximum = entry.number_within(widest.clone())?,
            _ => {
                let known = ["long_name", "default", "minimum", "maximum", "unit"];
                return Err(entry.unknown(&known));
            }
        }
    }
    if own.minimum > own.maximum {
        let (from, to) = (own.minimum, own.maximum);
        return Err(of.error(format!(
            "its minimum {from} is larger than its maximum {to}"
        )));
    }
    if own.check(own.default).is_err() {
        let span = place.unwrap_or_else(|| of.key_span.clone());
        let message = format!(
            "{}: its default {} is not among {}",
            of.path,
            own.default,
            own.allowed()
        );
        return Err(SpecError::at(span, message).help("give a default within its range"));
    }
    Ok(own)
}

fn read_unit<'t>(entry: &Entry<'t>) -> Result<&'t str, SpecError> {
    let unit = entry.string()?;
    let allowed =
        |c: char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '^' | '/' | '.' | '%' | '°');
    if (1..=20).contains(&unit.chars().count()) && unit.chars().all(allowed) {
        return Ok(unit);
    }
    Err(entry.error("expected a unit of 1 to 20 characters, such as \"N m-1\""))
}

fn read_speed_axis(table: &Entry) -> Result<SpeedAxis, SpecError> {
    let (mut name, mut unit) = (None, SpeedUnit::RevolutionsPerMinute);
    for entry in table.table()? {
        match entry.key {
            "name" => name = Some(entry.line()?.to_owned()),
            "period" => {
                let tau = Parameter::Tau.name();
                if entry.string()? != tau {
                    let message = format!("expected \"{tau}\": the period is the delay");
                    return Err(entry.error(message));
                }
            }
            "unit" => unit = read_speed_unit(&entry)?,
            _ => return Err(entry.unknown(&["name", "period", "unit"])),
        }
    }
    let name = name.ok_or_else(|| table.error("name is missing"))?;
    Ok(SpeedAxis { name, unit })
}

fn read_speed_unit(entry: &Entry) -> Result<SpeedUnit, SpecError> {
    let unit = entry.string()?;
    let known = || SpeedUnit::ALL.into_iter().map(SpeedUnit::name);
    let found = SpeedUnit::ALL
        .into_iter()
        .find(|known| known.name() == unit);
    found.ok_or_else(|| {
        let meant = did_you_mean(unit, known());
        let all = known().collect::<Vec<_>>().join(", ");
        entry
            .error(format!("unknown unit \"{unit}\""))
            .help(format!("{meant}known: {all}"))
    })
}
