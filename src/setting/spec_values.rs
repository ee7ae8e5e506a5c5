//! The values of a sweep file's keys.

use std::ops::Range;

use super::axis::{Spacing, spaced};
use super::field::{Field, fields_meant, known_fields};
use super::keys::{RANGE, TOLERANCE, names};
use super::parameter::Parameter;
use super::units::Units;
use crate::linear::MarginalTolerance;
use crate::text::Shown;
use crate::text::toml_reader::{Entry, SpecError};

/// The most degrees of stability.
const MOST_DEGREES: usize = 16;
/// The largest degree of stability, in 1/time.
const LARGEST_DEGREE: f64 = 1e12;

/// The values of an axis of at most `most` points; `read` reads its ends.
pub(super) fn read_range(
    axis: &Entry,
    read: impl Fn(&Entry) -> Result<f64, SpecError>,
    most: u64,
) -> Result<Vec<f64>, SpecError> {
    let mut table = axis.document(names(&RANGE))?;
    let [from, to] = ["from", "to"].map(|end| table.take(end, &read));
    let points = table.take("points", Entry::whole);
    let spacing = table.take("spacing", read_spacing);
    table.finish()?;
    let missing = |name| axis.error(format!("{name} is missing"));
    let from = from.ok_or_else(|| missing("from"))?;
    let to = to.ok_or_else(|| missing("to"))?;
    let points = points.ok_or_else(|| missing("points"))?;
    if points > most {
        let message = format!("points = {points} is outside its range: 2 to {most}");
        return Err(axis.error(message));
    }
    spaced(from, to, points, spacing.unwrap_or(Spacing::Linear)).map_err(|e| axis.error(e.message))
}

fn read_spacing(entry: &Entry) -> Result<Spacing, SpecError> {
    match entry.string()? {
        "linear" => Ok(Spacing::Linear),
        "log" => Ok(Spacing::Log),
        other => Err(entry
            .error(format!("unknown spacing \"{other}\""))
            .help("known: linear, log")),
    }
}

/// The values of an axis that is a list; `read` reads one, in its range.
pub(super) fn read_list(
    axis: &Entry,
    read: impl Fn(&Entry) -> Result<f64, SpecError>,
) -> Result<Vec<f64>, SpecError> {
    let elements = axis
        .array()
        .map_err(|e| e.help("an axis is a list of values or { from = …, to = …, points = … }"))?;
    elements.iter().map(read).collect()
}

pub(super) fn read_degrees(entry: &Entry, units: &Units) -> Result<Vec<f64>, SpecError> {
    let elements = entry
        .array()
        .map_err(|e| e.help("for example: degree_of_stability = [0.05, 0.1]"))?;
    if elements.is_empty() || elements.len() > MOST_DEGREES {
        let message = format!("{} values; 1 to {MOST_DEGREES} are allowed", elements.len());
        return Err(entry.error(message));
    }
    let mut degrees: Vec<f64> = Vec::new();
    for element in &elements {
        let value = units.number(element, Parameter::AlphaV.dimension())?;
        if !(1.0 / LARGEST_DEGREE..=LARGEST_DEGREE).contains(&value) {
            return Err(element.error(format!(
                "{} is outside its range: greater than 0, between 1e-12 and 1e12",
                Shown(value)
            )));
        }
        if degrees.last().is_some_and(|last| *last >= value) {
            return Err(element.error("the values must be strictly increasing"));
        }
        degrees.push(value);
    }
    Ok(degrees)
}

pub(super) fn read_field(entry: &Entry) -> Result<Field, SpecError> {
    let name = entry.string()?;
    Field::from_name(name).ok_or_else(|| {
        entry
            .error(format!("unknown field \"{name}\""))
            .help(fields_meant(name))
    })
}

/// The fields in the order of the file, with their places.
pub(super) fn read_fields(entry: &Entry) -> Result<Vec<(Field, Range<usize>)>, SpecError> {
    let mut fields = Vec::new();
    for element in entry.array()? {
        let field = read_field(&element)?;
        if fields.iter().any(|(listed, _)| *listed == field) {
            return Err(element.error(format!("\"{}\" is listed twice", field.name())));
        }
        fields.push((field, element.span));
    }
    if fields.is_empty() {
        return Err(entry
            .error("the list is empty")
            .help(format!("known: {}", known_fields())));
    }
    Ok(fields)
}

pub(super) fn read_tolerance(tolerance: &Entry) -> Result<MarginalTolerance, SpecError> {
    let mut table = tolerance.document(names(&TOLERANCE))?;
    let marginal = table.take("marginal", |entry| entry.number_within(f64::EPSILON..=0.01));
    table.finish()?;
    Ok(marginal.map_or_else(MarginalTolerance::default, MarginalTolerance))
}
