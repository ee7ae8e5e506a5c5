//! Reads a sweep file.
//!
//! - `checks`: checks that the entries of a sweep file are consistent

mod checks;

use std::ops::Range;

use super::amount::units_of;
use super::axis::{Axis, MOST_POINTS};
use super::basin::BasinKeys;
use super::field::Field;
use super::given::GivenParameters;
use super::given_key::GivenKey;
use super::given_system::GivenSystem;
use super::keys::{SIMULATION, SWEEP, names};
use super::map_names::MOST_AXES;
use super::search::{LIMIT, Protocol};
use super::simulation::{DISTURBED, Simulation};
use super::spec::SweepSpec;
use super::spec_values::{read_degrees, read_field, read_fields, read_tolerance};
use super::units::Units;
use super::vc_keys::VcKeys;
use crate::text::document::Document;
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
        let parsed = parse(text)?;
        let mut document = Document::of(entries(parsed.get_ref(), ""), names(&SWEEP));
        let system = GivenSystem::of(&mut document, text)?;
        document.refuse(
            &["switch_on", "horizon", "trace", "steps", "programme"],
            "it is a key of a case file, of one motion: `slipmap simulate` takes it; in a sweep, \
             [simulation] has the horizon and the steps",
        );
        document.refuse(
            &["feedback"],
            "it is a table of a case file: a map has delayed feedback, by the gains in [fixed] or \
             [axes]; control by the return map is for one motion, `slipmap simulate CASE.toml`, \
             and `slipmap compare CASE.toml` varies it",
        );
        let most = most_points.min(MOST_POINTS);
        let units = units_of(&mut document);
        let (system, given, axes) = read_parameters(&mut document, text, system, &units, most);
        let asked = document.take("fields", read_fields).unwrap_or_default();
        let simulation = document.take("simulation", |table| read_simulation(table, &units));
        let (simulation, horizon) = simulation.unwrap_or_default();
        let basin = document.take("basin", |table| BasinKeys::read(table, &units));
        let [follow, switch_on] = Protocol::NAMES;
        let vc = VcKeys::of(&mut document, &[follow, switch_on, LIMIT]);
        let degrees = document.take("degree_of_stability", |entry| read_degrees(entry, &units));
        let spec = Self {
            title: document
                .take("title", Entry::line)
                .unwrap_or_default()
                .to_owned(),
            picture: document.take("picture", read_field),
            limit: vc.of_limit(),
            axes,
            fixed: given.setting(),
            fields: Vec::new(),
            boundaries: document.take("boundaries", Entry::boolean),
            degrees_of_stability: degrees.unwrap_or_default(),
            best: document.take("best", Entry::boolean).unwrap_or_default(),
            tolerance: document
                .take("tolerance", read_tolerance)
                .unwrap_or_default(),
            simulation,
            basin: None,
            critical: None,
            units,
            text: text.to_owned(),
        };
        document.finish()?;
        let (asked, places) = asked.into_iter().unzip();
        let read = SweepFile {
            document,
            spec,
            system,
            given,
            asked,
            places,
            basin: basin.unwrap_or_default(),
            vc,
            horizon,
        };
        read.finish()
    }
}

/// A sweep file with the places of its keys, before it is known to be consistent.
struct SweepFile<'t> {
    document: Document<'t>,
    /// The sweep, without what follows from several keys.
    spec: SweepSpec,
    /// The system, where it is not the letter's.
    system: Option<GivenSystem>,
    given: GivenParameters,
    /// The fields in the order of the file, and their places.
    asked: Vec<Field>,
    places: Vec<Range<usize>>,
    basin: BasinKeys,
    vc: VcKeys,
    /// The place of the horizon, if it is given.
    horizon: Option<Range<usize>>,
}

/// Reads the table `[simulation]`, with the place of the horizon.
fn read_simulation(
    table: &Entry,
    units: &Units,
) -> Result<(Simulation, Option<Range<usize>>), SpecError> {
    let mut table = table.document(names(&SIMULATION))?;
    let simulation = Simulation::of(&mut table, units);
    table.finish()?;
    Ok((simulation, table.value("horizon").cloned()))
}

/// Reads the tables of parameters: of the system, or of the block.
fn read_parameters(
    document: &mut Document,
    text: &str,
    mut system: Option<GivenSystem>,
    units: &Units,
    most_points: u64,
) -> (Option<GivenSystem>, GivenParameters, Vec<Axis>) {
    let given = GivenParameters::begin(document, text, units.clone());
    let (mut given, mut axes) = (given, Vec::new());
    let tables = ["axes", "fixed", "friction", "start"];
    document.each(&tables, |table| match (table.key, &mut system) {
        ("axes", system) => read_axes(table, units, most_points, &mut axes, |entry| match system {
            Some(system) => system.give(entry, units),
            None => given.give_axis(entry).map(GivenKey::from),
        }),
        ("fixed", Some(system)) => system.read_fixed(table, units),
        _ => given.read(table, |_| true),
    });
    (system, given, axes)
}

/// Reads the table `[axes]`; `give` records the parameter of an axis.
fn read_axes(
    table: &Entry,
    units: &Units,
    most_points: u64,
    axes: &mut Vec<Axis>,
    mut give: impl FnMut(&Entry) -> Result<GivenKey, SpecError>,
) -> Result<(), SpecError> {
    for entry in table.table()? {
        if axes.len() == MOST_AXES {
            let message = format!(
                "{} is one axis too many: a map has {MOST_AXES} at most",
                entry.path
            );
            return Err(SpecError::at(entry.key_span.clone(), message)
                .help("give it one value in [fixed], and make a sweep for each other value"));
        }
        let given = give(&entry)?;
        let points: u64 = axes.iter().map(|axis| axis.len() as u64).sum();
        if points > MOST_POINTS_TOGETHER {
            let message = format!(
                "the axes before it have {points} points together; at most \
                 {MOST_POINTS_TOGETHER} are allowed"
            );
            return Err(entry.error(message));
        }
        axes.push(given.axis(&entry, units, most_points)?);
    }
    Ok(())
}

impl SweepFile<'_> {
    fn finish(mut self) -> Result<SweepSpec, SpecError> {
        if self.spec.axes.is_empty() {
            let message = "a sweep needs at least one axis";
            return Err(SpecError {
                span: self.document.key("axes").cloned(),
                ..SpecError::whole(message)
                    .help("for example: [axes] tau = { from = 0, to = 12, points = 1201 }")
            });
        }
        if let Some(system) = &self.system {
            self.spec.fixed = self.check_system(system)?;
        } else if self.spec.limit {
            self.spec.fixed = self.check_limit()?;
        } else {
            self.spec.critical = self.check()?;
        }
        let critical = self.spec.critical.is_some();
        if !critical && self.asks(Field::of_motion) && !self.given.has_start() {
            self.spec.simulation.disturbance = DISTURBED;
        }
        if self.asks(Field::of_basin) {
            self.spec.basin = Some(self.basin.basin()?);
        }
        let mut fields = match (self.asked.is_empty(), self.spec.limit) {
            (false, _) => Field::with_bounds(self.asked),
            (true, true) => Field::all_of_limit().collect(),
            (true, false) => vec![Field::NUnstable],
        };
        let beyond = !self.spec.is_of_letter();
        if beyond && fields.iter().any(|f| f.of_sliding()) && !fields.contains(&Field::Reason) {
            fields.push(Field::Reason);
            fields.sort_unstable();
        }
        self.spec.fields = fields;
        check_picture(&self.spec, self.document.value("picture"))?;
        Ok(self.spec)
    }
}

/// Checks that the field for pictures is a field of the sweep.
fn check_picture(spec: &SweepSpec, place: Option<&Range<usize>>) -> Result<(), SpecError> {
    match (spec.picture, place) {
        (Some(field), Some(place)) if !spec.fields.contains(&field) => {
            let held: Vec<&str> = spec.fields.iter().map(|field| field.name()).collect();
            let message = format!("picture: {} is not among the fields", field.name());
            Err(SpecError::at(place.clone(), message).help(format!("fields: {}", held.join(", "))))
        }
        _ => Ok(()),
    }
}
