//! Reads a system, from a file of its own or as a table of a sweep file.

use std::ops::Range;
use std::sync::Arc;

use super::forms::WrittenForm;
use super::parameter::{OwnParameter, WIDEST};
use super::{Form, IGNORED_ROOTS, SpeedAxis, SpeedUnit, SystemModel};
use crate::linear::general::MOST_DEGREE;
use crate::setting::expression::{NUMBER_PI, VARIABLE, functions};
use crate::setting::keys::names;
use crate::setting::map_names;
use crate::setting::parameter::Parameter;
use crate::setting::system_keys::{
    LONGEST_NAME, MOST_PARAMETERS, OWN_PARAMETER, SPEED_AXIS, SYSTEM,
};
use crate::text::document::Document;
use crate::text::nearest::did_you_mean;
use crate::text::toml_reader::{Entry, SpecError, entries, parse};
use crate::text::words;

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
        let mut document = Document::of(entries, names(&SYSTEM));
        let title = document.take("title", Entry::line).unwrap_or_default();
        let parameters = document
            .take("parameters", read_parameters)
            .unwrap_or_default();
        let speed_axis = document.take("speed_axis", read_speed_axis);
        let ignored_roots = document.take(IGNORED_ROOTS, read_ignored).unwrap_or(0);
        let written = WrittenForm::take(&mut document, whole);
        document.finish()?;
        check_speed_names(&parameters, speed_axis.as_ref())?;
        let names = parameters.iter().map(|(own, _)| &*own.name);
        let names: Vec<&str> = names.chain([Parameter::Tau.name()]).collect();
        let form = written.read(&names, &document, place)?;
        if matches!(form, Form::Feedback(_)) {
            check_feedback_names(&parameters)?;
        }
        check_names_of_form(&parameters, &written)?;
        let (parameters, places): (Vec<_>, Vec<_>) = parameters.into_iter().unzip();
        let model = Self {
            title: title.to_owned(),
            form,
            ignored_roots,
            parameters,
            speed_axis,
        };
        for (own, place) in model.parameters.iter().zip(places) {
            if !model.tapes().any(|of| of.uses(own.index)) {
                let message = format!("{} stands in no expression: it has no effect", own.name);
                return Err(SpecError::at(place, message).help("leave it out"));
            }
        }
        Ok(model)
    }
}

/// A parameter, with the place of its name.
type PlacedParameter = (Arc<OwnParameter>, Range<usize>);

fn read_parameters(table: &Entry) -> Result<Vec<PlacedParameter>, SpecError> {
    let mut parameters: Vec<PlacedParameter> = Vec::new();
    for entry in table.table()? {
        check_name(&entry)?;
        let before = parameters.iter().map(|(own, _)| &own.name);
        if let Some(other) = before.into_iter().find(|name| words::same(name, entry.key)) {
            let message = format!("{} and {other} are one name", entry.key);
            return Err(SpecError::at(entry.key_span.clone(), message).help("leave one out"));
        }
        if parameters.len() == MOST_PARAMETERS {
            let message = format!("more than {MOST_PARAMETERS} parameters");
            return Err(SpecError::at(entry.key_span.clone(), message));
        }
        let own = OwnParameter {
            index: parameters.len(),
            ..read_parameter(&entry)?
        };
        parameters.push((Arc::new(own), entry.key_span.clone()));
    }
    Ok(parameters)
}

/// Refuses the names of memory and latency, which every system in feedback form has.
fn check_feedback_names(parameters: &[PlacedParameter]) -> Result<(), SpecError> {
    let taken = |own: &OwnParameter| matches!(&*own.name, "memory" | "latency");
    match parameters.iter().find(|(own, _)| taken(own)) {
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

/// Refuses the names of the matrices of the form that is given.
fn check_names_of_form(
    parameters: &[PlacedParameter],
    written: &WrittenForm,
) -> Result<(), SpecError> {
    let reserved = written.reserved();
    let mut all = parameters.iter();
    match all.find(|(own, _)| reserved.contains(&&*own.name)) {
        Some((own, place)) => {
            let name = &own.name;
            let message = format!("{name} is reserved: the system has a matrix of that name");
            let error = SpecError::at(place.clone(), message);
            Err(error.help(format!("call it {name}_1, for example")))
        }
        None => Ok(()),
    }
}

/// Refuses the units of speeds as names where the delay can be given as a speed.
fn check_speed_names(
    parameters: &[PlacedParameter],
    speed_axis: Option<&SpeedAxis>,
) -> Result<(), SpecError> {
    let taken = |own: &OwnParameter| speed_axis.is_some() && SpeedUnit::named(&own.name).is_some();
    match parameters.iter().find(|(own, _)| taken(own)) {
        Some((own, place)) => {
            let name = &own.name;
            let message = format!("{name} is reserved: with a speed_axis it gives tau as a speed");
            let error = SpecError::at(place.clone(), message);
            Err(error.help(format!("call it {name}_1, for example")))
        }
        None => Ok(()),
    }
}

/// Checks that a name is valid for a parameter.
fn check_name(entry: &Entry) -> Result<(), SpecError> {
    let name = entry.key;
    let refuse = |message: String| Err(SpecError::at(entry.key_span.clone(), message));
    let known = name.starts_with(words::begins) && name.chars().all(words::belongs);
    if !known || name.chars().count() > LONGEST_NAME {
        let error = refuse(format!("`{name}` is no name of a parameter"));
        let greek = name.chars().find_map(words::greek_advice);
        let rule = "a letter, then letters, digits and _, 40 at most; letters are ASCII or Greek";
        return error.map_err(|e| e.help(greek.unwrap_or_else(|| rule.into())));
    }
    let why = match &*words::spelled(name) {
        VARIABLE => "it is the variable of the polynomials",
        NUMBER_PI => "it is the number pi",
        name if name == Parameter::Tau.name() => "it is the delay, which every system has",
        name if functions(true).any(|known| known == name) => "it is a function",
        name if map_names::taken().any(|taken| taken == name) => {
            "maps have a variable of that name"
        }
        _ => return Ok(()),
    };
    let error = refuse(format!("{name} is reserved: {why}"));
    error.map_err(|e| e.help(format!("call it {name}_1, for example")))
}

fn read_parameter(of: &Entry) -> Result<OwnParameter, SpecError> {
    let mut own = OwnParameter {
        index: 0,
        name: words::spelled(of.key).into_owned(),
        long_name: words::spelled(of.key).into_owned(),
        default: 0.0,
        minimum: WIDEST[0],
        maximum: WIDEST[1],
        unit: "1".to_owned(),
        dimension: [0; 3],
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
    let mut table = of.document(names(&OWN_PARAMETER))?;
    let number = |entry: &Entry| entry.number_within(widest.clone());
    if let Some(name) = table.take("long_name", Entry::line) {
        name.clone_into(&mut own.long_name);
    }
    if let Some(unit) = table.take("unit", read_unit) {
        unit.clone_into(&mut own.unit);
    }
    own.default = table.take("default", number).unwrap_or(own.default);
    own.minimum = table.take("minimum", number).unwrap_or(own.minimum);
    own.maximum = table.take("maximum", number).unwrap_or(own.maximum);
    table.finish()?;
    if own.minimum > own.maximum {
        let (from, to) = (own.minimum, own.maximum);
        return Err(of.error(format!(
            "its minimum {from} is larger than its maximum {to}"
        )));
    }
    if own.check(own.default).is_err() {
        let span = table.value("default").unwrap_or(&of.key_span).clone();
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

/// The number of roots at 0 that do not count.
fn read_ignored(entry: &Entry) -> Result<usize, SpecError> {
    match usize::try_from(entry.whole()?) {
        Ok(roots) if roots <= MOST_DEGREE => Ok(roots),
        _ => Err(entry.error(format!("expected a whole number from 0 to {MOST_DEGREE}"))),
    }
}

fn read_speed_axis(table: &Entry) -> Result<SpeedAxis, SpecError> {
    let mut keys = table.document(names(&SPEED_AXIS))?;
    let name = keys.take("name", Entry::line);
    keys.take("period", read_period);
    let unit = keys.take("unit", read_speed_unit);
    keys.finish()?;
    Ok(SpeedAxis {
        name: name
            .ok_or_else(|| table.error("name is missing"))?
            .to_owned(),
        unit: unit.unwrap_or(SpeedUnit::RevolutionsPerMinute),
    })
}

fn read_period(entry: &Entry) -> Result<(), SpecError> {
    let tau = Parameter::Tau.name();
    if entry.string()? == tau {
        return Ok(());
    }
    Err(entry.error(format!("expected \"{tau}\": the period is the delay")))
}

fn read_speed_unit(entry: &Entry) -> Result<SpeedUnit, SpecError> {
    let unit = entry.string()?;
    let known = || SpeedUnit::ALL.into_iter().map(SpeedUnit::name);
    SpeedUnit::named(unit).ok_or_else(|| {
        let meant = did_you_mean(unit, known());
        let all = known().collect::<Vec<_>>().join(", ");
        entry
            .error(format!("unknown unit \"{unit}\""))
            .help(format!("{meant}known: {all}"))
    })
}
