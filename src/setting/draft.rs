//! Reads a sweep file.
//!
//! - `checks`: checks that the entries of a sweep file are consistent

mod checks;

use std::ops::Range;

use super::axis::{Axis, MOST_POINTS};
use super::basin::BasinKeys;
use super::field::Field;
use super::given::{GivenParameters, read_units};
use super::keys::{SWEEP, names};
use super::limit_spec;
use super::map_names::MOST_AXES;
use super::parameter::Parameter;
use super::quantity::Quantity;
use super::search::LIMIT;
use super::simulation::{DISTURBED, Simulation};
use super::spec::{SweepSpec, most};
use super::spec_values::{
    read_degrees, read_field, read_fields, read_list, read_range, read_tolerance,
};
use super::system_draft::SystemDraft;
use super::units::Units;
use super::vc_keys::VcKeys;
use crate::linear::MarginalTolerance;
use crate::text::toml_reader::{Entry, SpecError, entries, parse};

/// The most points on all axes but the last together: more would give too many cells.
const MOST_POINTS_TOGETHER: u64 = 2 * MOST_POINTS;

impl std::str::FromStr for SweepSpec {
    type Err = SpecError;

    /// Reads a sweep file.
    ///
    /// # Errors
    /// Points at the first place that is not understood, out of range or contradictory.
    fn from_str(text: &str) -> Result<Self, SpecError> {
        Self::read(text, MOST_POINTS)
    }
}

impl SweepSpec {
    /// Reads a sweep file whose axes have at most `most_points` points each, 10⁷ at the most.
    ///
    /// # Errors
    /// Points at the first place that is not understood, out of range or contradictory.
    pub fn read(text: &str, most_points: u64) -> Result<Self, SpecError> {
        let document = parse(text)?;
        let mut draft = Draft::default();
        let all = entries(document.get_ref(), "");
        // The meaning of other names depends on the system, so it is read first.
        if let Some(system) = all.iter().find(|entry| entry.key == "system") {
            draft.system = Some(SystemDraft::read(system, text)?);
        }
        for entry in all {
            if draft.foreign.is_none() && !limit_spec::KEYS.contains(&entry.key) {
                draft.foreign = Some((entry.key.to_owned(), entry.key_span.clone()));
            }
            if draft.system.is_some() {
                SystemDraft::check_key(&entry)?;
            }
            match entry.key {
                "system" => {}
                "title" => entry.line()?.clone_into(&mut draft.title),
                "protocol" if entry.string()? == LIMIT => {
                    draft.is_limit = true;
                }
                "picture" => draft.picture = Some((read_field(&entry)?, entry.span.clone())),
                "fields" => draft.read_fields(&entry)?,
                "boundaries" => {
                    draft.boundaries = Some(entry.boolean()?);
                }
                "degree_of_stability" => draft.read_degrees(&entry)?,
                "best" => draft.best = entry.boolean()?.then(|| entry.key_span.clone()),
                "axes" => draft.read_axes(&entry, most_points.min(MOST_POINTS))?,
                "fixed" => match &mut draft.system {
                    Some(system) => system.read_fixed(&entry)?,
                    None => draft.given.read_fixed(&entry, |_| true)?,
                },
                "friction" => draft.given.read_friction(&entry)?,
                "start" => draft.given.read_start(&entry)?,
                "simulation" => draft.read_simulation(&entry)?,
                "basin" => draft.basin.read(&entry)?,
                "units" => draft.units = read_units(&entry)?,
                "tolerance" => draft.tolerance = read_tolerance(&entry)?,
                _ if draft.vc.read(&entry)? => {}
                "switch_on" | "horizon" | "trace" | "steps" => {
                    return Err(entry.elsewhere(
                        "it is a key of a case file, of one motion: `slipmap simulate` takes it; \
                         in a sweep, [simulation] has the horizon and the steps",
                    ));
                }
                _ => return Err(entry.unknown(&names(&SWEEP))),
            }
        }
        draft.finish(text)
    }
}

/// The parts of a sweep file read so far, with their places, before they are known to be
/// consistent.
#[derive(Default)]
struct Draft {
    title: String,
    /// The field that pictures show, and its place.
    picture: Option<(Field, Range<usize>)>,
    is_limit: bool,
    /// The first key that is not allowed in the limit of a short delay.
    foreign: Option<(String, Range<usize>)>,
    /// The fields in the order of the file, and their places.
    asked: Vec<Field>,
    places: Vec<Range<usize>>,
    fields: Option<Vec<Field>>,
    basin: BasinKeys,
    vc: VcKeys,
    simulation: Simulation,
    simulation_place: Option<Range<usize>>,
    boundaries: Option<bool>,
    degrees: Vec<f64>,
    degrees_place: Option<Range<usize>>,
    /// The place of the request for best settings, if there is one.
    best: Option<Range<usize>>,
    /// The system, where it is not the letter's.
    system: Option<SystemDraft>,
    axes: Vec<Axis>,
    axes_place: Option<Range<usize>>,
    given: GivenParameters,
    units: Units,
    tolerance: MarginalTolerance,
}

impl Draft {
    fn read_fields(&mut self, fields: &Entry) -> Result<(), SpecError> {
        self.fields = Some(read_fields(fields)?);
        for element in fields.array()? {
            self.asked.push(read_field(&element)?);
            self.places.push(element.span);
        }
        Ok(())
    }

    fn read_simulation(&mut self, simulation: &Entry) -> Result<(), SpecError> {
        self.simulation_place = Some(simulation.key_span.clone());
        self.simulation.read_table(simulation)
    }

    fn read_degrees(&mut self, degrees: &Entry) -> Result<(), SpecError> {
        self.degrees = read_degrees(degrees)?;
        self.degrees_place = Some(degrees.key_span.clone());
        Ok(())
    }

    fn read_axes(&mut self, axes: &Entry, most_points: u64) -> Result<(), SpecError> {
        self.axes_place = Some(axes.key_span.clone());
        for entry in axes.table()? {
            if self.axes.len() == MOST_AXES {
                let message = format!(
                    "{} is one axis too many: a map has {MOST_AXES} at most",
                    entry.path
                );
                return Err(SpecError::at(entry.key_span.clone(), message)
                    .help("give it one value in [fixed], and make a sweep for each other value"));
            }
            let parameter = self.give_axis(&entry)?;
            let points: u64 = self.axes.iter().map(|axis| axis.len() as u64).sum();
            if points > MOST_POINTS_TOGETHER {
                let message = format!(
                    "the axes before it have {points} points together; at most \
                    {MOST_POINTS_TOGETHER} are allowed"
                );
                return Err(entry.error(message));
            }
            let values = if entry.is_table() {
                read_range(&entry, most_points)?
            } else {
                read_list(&entry, &parameter)?
            };
            let axis = Axis::new(parameter, values).map_err(|e| entry.error(e.0))?;
            self.axes.push(axis);
        }
        Ok(())
    }

    /// Reads the parameter of an axis.
    fn give_axis(&mut self, entry: &Entry) -> Result<Quantity, SpecError> {
        if let Some(system) = &mut self.system {
            return system.give(entry);
        }
        let parameter = Parameter::from_name(entry.key)
            .ok_or_else(|| entry.unknown(&Parameter::ALL.map(Parameter::name)))?;
        self.given.give(parameter, &entry.key_span)?;
        Ok(parameter.into())
    }

    fn finish(self, text: &str) -> Result<SweepSpec, SpecError> {
        if self.axes.is_empty() {
            let message = "a sweep needs at least one axis";
            return Err(SpecError {
                span: self.axes_place,
                ..SpecError::whole(message)
                    .help("for example: [axes] tau = { from = 0, to = 12, points = 1201 }")
            });
        }
        let (fixed, critical, default_fields) = if let Some(system) = &self.system {
            (self.check_system(system)?, None, vec![Field::NUnstable])
        } else if self.is_limit {
            (self.check_limit()?, None, Field::all_of_limit().collect())
        } else {
            let (fixed, critical) = self.check()?;
            (fixed, critical, vec![Field::NUnstable])
        };
        let basin = self.asks(Field::of_basin).then(|| self.basin.basin());
        let mut simulation = self.simulation.clone();
        if critical.is_none() && self.asks(Field::of_motion) && !self.given.has_start() {
            simulation.disturbance = DISTURBED;
        }
        let mut fields = self.fields.unwrap_or(default_fields);
        let beyond = !most(&fixed, &self.axes).is_of_letter();
        if beyond && fields.iter().any(|f| f.of_sliding()) && !fields.contains(&Field::Reason) {
            fields.push(Field::Reason);
            fields.sort_unstable();
        }
        Ok(SweepSpec {
            title: self.title,
            picture: picture(self.picture, &fields)?,
            limit: self.is_limit,
            axes: self.axes,
            fixed,
            fields,
            boundaries: self.boundaries,
            degrees_of_stability: self.degrees,
            best: self.best.is_some(),
            tolerance: self.tolerance,
            simulation,
            basin: basin.transpose()?,
            critical,
            units: self.units,
            text: text.to_owned(),
        })
    }
}

/// Checks that the field for pictures is a field of the sweep.
fn picture(
    asked: Option<(Field, Range<usize>)>,
    fields: &[Field],
) -> Result<Option<Field>, SpecError> {
    match asked {
        Some((field, place)) if !fields.contains(&field) => {
            let held: Vec<&str> = fields.iter().map(|field| field.name()).collect();
            let message = format!("picture: {} is not among the fields", field.name());
            Err(SpecError::at(place, message).help(format!("fields: {}", held.join(", "))))
        }
        asked => Ok(asked.map(|(field, _)| field)),
    }
}
