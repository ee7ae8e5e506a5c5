//! Writes traces: a motion over time, with its events in a group of their own, and its outcome and
//! parameters as attributes and scalars.

use hdf5::plist::group_create::LinkCreationOrder;
use hdf5::types::OwnedDynValue;
use hdf5::{Dataset, File, Group, H5Type};

use super::attributes::{put_flags, put_numbers, put_text};
use super::codec::DEFLATE_LEVEL;
use super::describe::{Provenance, put_friction, put_provenance, put_scalars};
use super::error::StoreError;
use super::map_writer::create_file;
use super::netcdf::{DimensionId, Dimensions, named};
use super::output::Output;
use super::schema::{self, trace};
use super::variables::FILL_VALUE;
use crate::slip::case::Case;
use crate::sweep::Parameter;
use crate::sweep::cells::trace::{EVENTS, MODES, Sample, TraceEvent};
use crate::sweep::input::units::Units;
use crate::sweep::{CaseSpec, Trace};

/// Elements in a chunk.
const CHUNK: usize = 1 << 13;
/// The number of a mode or kind that stands for no value.
const FLAG_FILL: u8 = 255;

/// Bytes of a sample before compression: time, the quantities, the mode.
pub const BYTES_OF_A_SAMPLE: u64 = 8 * (1 + QUANTITIES.len() as u64) + 1;

/// A quantity of a motion, one for each sample.
pub struct Quantity {
    /// Name in files.
    pub name: &'static str,
    /// Its meaning, in words.
    pub long_name: &'static str,
    /// Powers of force, length and time in its unit.
    dimension: [i32; 3],
    /// Its value.
    of: fn(&Sample) -> f64,
}

impl Quantity {
    /// Its value at a sample.
    #[must_use]
    pub fn of(&self, sample: &Sample) -> f64 {
        (self.of)(sample)
    }

    /// Its unit, "1" where it has none.
    #[must_use]
    pub fn unit(&self, units: &Units) -> String {
        units.of(self.dimension)
    }
}

/// Time, over which the quantities are given.
pub const TIME: Quantity = Quantity {
    name: trace::TIME,
    long_name: "time",
    dimension: [0, 0, 1],
    of: |s| s.t,
};

/// The quantities in the order of the file.
pub const QUANTITIES: [Quantity; 5] = [
    Quantity {
        name: "x",
        long_name: "position of the block",
        dimension: [0, 1, 0],
        of: |s| s.x,
    },
    Quantity {
        name: "x_dot",
        long_name: "velocity of the block",
        dimension: [0, 1, -1],
        of: |s| s.x_dot,
    },
    Quantity {
        name: "a",
        long_name: "elongation of the spring",
        dimension: [0, 1, 0],
        of: |s| s.a,
    },
    Quantity {
        name: "v",
        long_name: "pulling velocity",
        dimension: [0, 1, -1],
        of: |s| s.v,
    },
    Quantity {
        name: "N",
        long_name: "normal load",
        dimension: [1, 0, 0],
        of: |s| s.n,
    },
];

/// Writes a trace under a temporary name and gives it its final one.
///
/// # Errors
/// When the system or the library refuses. The final name then has what it had before.
pub fn write(
    spec: &CaseSpec,
    trace: &Trace,
    output: Output,
    provenance: &Provenance,
) -> Result<(), StoreError> {
    let path = output.path().to_owned();
    let fill = || -> hdf5::Result<()> {
        let file = create_file(output.part())?;
        fill_file(&file, spec, trace, provenance)?;
        file.flush()?;
        file.close()
    };
    fill().map_err(StoreError::hdf5("write", &path))?;
    output.commit()
}

fn fill_file(
    file: &File,
    spec: &CaseSpec,
    trace: &Trace,
    provenance: &Provenance,
) -> hdf5::Result<()> {
    put_provenance(file, &spec.title, provenance)?;
    put_root(file, spec, trace)?;
    let setting = &spec.setting;
    let told = Parameter::ALL.into_iter();
    let told = told.filter(|&p| setting.uses(p) && !p.of_start());
    let told: Vec<_> = told.map(|p| (p.into(), setting.get(p))).collect();
    let scalars = put_scalars(file, &told, &spec.units)?;
    let mut dimensions = Dimensions::default();
    let time = named(file.new_dataset_builder())
        .with_data(&column(trace, TIME.of))
        .create(TIME.name)?;
    describe(&time, &TIME, &spec.units)?;
    let time = dimensions.add(time, None)?;
    let mut columns = Columns {
        group: file,
        dimensions: &mut dimensions,
        dimension: time,
        coordinates: &scalars,
    };
    for quantity in &QUANTITIES {
        let dataset = columns.make(quantity.name, &column(trace, quantity.of), f64::NAN)?;
        describe(&dataset, quantity, &spec.units)?;
    }
    let numbers: Vec<u8> = trace
        .samples
        .iter()
        .map(|s| number(&MODES, &s.mode))
        .collect();
    let mode = columns.make(trace::MODE, &numbers, FLAG_FILL)?;
    put_flags(&mode, "what the block does", &MODES.map(|(_, name)| name))?;
    put_events(file, &mut dimensions, spec, &trace.events)?;
    dimensions.finish()
}

fn column(trace: &Trace, of: fn(&Sample) -> f64) -> Vec<f64> {
    trace.samples.iter().map(of).collect()
}

/// The number of `value` among `all`.
fn number<T: PartialEq>(all: &[(T, &str)], value: &T) -> u8 {
    let place = all.iter().position(|(known, _)| known == value);
    place.map_or(FLAG_FILL, |place| place as u8)
}

/// The attributes of the root that describe a case, besides its parameters, by name.
#[must_use]
pub fn numbers_of_case(case: &Case) -> [(&'static str, f64); 5] {
    let (x_dot0, a0) = case.initial_state();
    [
        ("x_dot0", x_dot0),
        ("a0", a0),
        ("switch_on", case.switch_on),
        ("horizon", case.horizon),
        ("tolerance", case.accuracy.tolerance),
    ]
}

fn put_root(file: &File, spec: &CaseSpec, found: &Trace) -> hdf5::Result<()> {
    let version = schema::TRACE_FORMAT_VERSION;
    put_numbers(file, trace::FORMAT_VERSION, &[version])?;
    put_text(file, trace::CASE, &spec.text)?;
    put_friction(file, &spec.setting)?;
    let summary = &found.summary;
    for (name, value) in numbers_of_case(&spec.case) {
        put_numbers(file, name, &[value])?;
    }
    put_text(file, trace::OUTCOME, summary.outcome.name())?;
    for (name, value) in summary.numbers() {
        put_numbers(file, name, &[value])?;
    }
    put_numbers(file, trace::STEPS, &[summary.steps])
}

fn describe(dataset: &Dataset, quantity: &Quantity, units: &Units) -> hdf5::Result<()> {
    put_text(dataset, "long_name", quantity.long_name)?;
    put_text(dataset, "units", &quantity.unit(units))
}

/// Makes the variables of one dimension.
struct Columns<'a> {
    group: &'a Group,
    dimensions: &'a mut Dimensions,
    dimension: DimensionId,
    coordinates: &'a str,
}

impl Columns<'_> {
    fn make<T>(&mut self, name: &str, values: &[T], fill: T) -> hdf5::Result<Dataset>
    where
        T: H5Type + Copy + Into<OwnedDynValue>,
    {
        let builder = named(self.group.new_dataset_builder());
        let dataset = builder
            .shuffle()
            .deflate(DEFLATE_LEVEL)
            .fill_value(fill)
            .empty::<T>()
            .shape(values.len())
            .chunk(CHUNK.min(values.len().max(1)))
            .create(name)?;
        if !values.is_empty() {
            dataset.write_raw(values)?;
            // Data still in the cache when the dataset is closed are silently lost where the system
            // refuses to write them.
            self.group.file()?.flush()?;
        }
        put_numbers(&dataset, FILL_VALUE, &[fill])?;
        if !self.coordinates.is_empty() {
            put_text(&dataset, "coordinates", self.coordinates)?;
        }
        self.dimensions.attach(&dataset, &[self.dimension])?;
        Ok(dataset)
    }
}

fn put_events(
    file: &File,
    dimensions: &mut Dimensions,
    spec: &CaseSpec,
    events: &[TraceEvent],
) -> hdf5::Result<()> {
    let group = file
        .create_group_builder()
        .with_gcpl(|gcpl| {
            gcpl.obj_track_times(false)
                .link_creation_order(LinkCreationOrder::Indexed)
        })
        .create(trace::EVENT)?;
    put_text(
        &group,
        "title",
        "events of the motion until its outcome was known, and to the end of the trace",
    )?;
    let dimension = dimensions.add_bare(&group, trace::EVENT)?;
    dimensions.scale(dimension).resize(events.len())?;
    let mut columns = Columns {
        group: &group,
        dimensions,
        dimension,
        coordinates: "",
    };
    let times: Vec<f64> = events.iter().map(|e| e.t).collect();
    let dataset = columns.make(trace::TIME, &times, f64::NAN)?;
    put_text(&dataset, "long_name", "time of the event")?;
    put_text(&dataset, "units", &TIME.unit(&spec.units))?;
    let kinds: Vec<u8> = events.iter().map(|e| number(&EVENTS, &e.kind)).collect();
    let dataset = columns.make(trace::KIND, &kinds, FLAG_FILL)?;
    put_flags(&dataset, "what happens", &EVENTS.map(|(_, name)| name))?;
    let elongations: Vec<f64> = events.iter().map(|e| e.a).collect();
    let dataset = columns.make(trace::ELONGATION, &elongations, f64::NAN)?;
    put_text(&dataset, "long_name", "elongation of the spring then")?;
    put_text(&dataset, "units", &spec.units.of([0, 1, 0]))
}
