//! The table `[feedback]` of case files: control by the return map, in the place of gains.

use std::ops::Range;

use super::keys::{FEEDBACK, names};
use super::parameter::{LARGEST, Parameter};
use super::units::Units;
use crate::model::{MapModel, Record, ReturnMap};
use crate::text::Shown;
use crate::text::toml_reader::{Entry, SpecError};

/// The control that is told here.
pub(crate) const RETURN_MAP: &str = "return-map";
/// The names of the models.
pub(crate) const MODELS: [&str; 2] = ["exact", "reconstructed"];
/// Loads that a flag or key takes: all that are positive.
const LOADS: std::ops::RangeInclusive<f64> = 1.0 / LARGEST..=LARGEST;

/// Control by the return map with its places in a file.
pub(super) struct GivenFeedback {
    amplitude: f64,
    exact: bool,
    record: u32,
    pulse: Option<f64>,
    /// The keys, with the places of their values.
    places: Vec<(&'static str, Range<usize>)>,
}

impl GivenFeedback {
    /// Reads the table.
    pub(super) fn read(entry: &Entry, units: &Units) -> Result<Self, SpecError> {
        let mut table = entry.document(names(&FEEDBACK))?;
        let load =
            |entry: &Entry| units.number_within(entry, Parameter::NormalLoad.dimension(), LOADS);
        let control = table.take("control", read_control);
        let amplitude = table.take("amplitude", load);
        let exact = table.take("model", read_model).unwrap_or(true);
        let record = table.take("record", read_record);
        let pulse = table.take("pulse", load);
        table.finish()?;
        let places = FEEDBACK.iter().filter_map(|key| {
            let place = table.value(key.name)?;
            Some((key.name, place.clone()))
        });
        let places = places.collect();
        if control.is_none() {
            let error = entry.error("control is needed");
            return Err(error.help("the one there is: control = \"return-map\""));
        }
        for key in ["record", "pulse"] {
            if let (Some(place), true) = (table.value(key), exact) {
                let message = format!("{key} is of a reconstructed model, and this one is exact");
                let error = SpecError::at(place.clone(), message);
                return Err(error.help("give model = \"reconstructed\" as well"));
            }
        }
        let Some(amplitude) = amplitude else {
            let error = entry.error("amplitude is needed, the largest change of the load");
            return Err(error.help("for example: amplitude = 0.5, in the unit of normal_load"));
        };
        Ok(Self {
            amplitude,
            exact,
            record: record.unwrap_or(Record::READINGS),
            pulse,
            places,
        })
    }

    /// The control, where the load is N0 without it.
    pub(super) fn control(&self, normal_load: f64) -> ReturnMap {
        let record = Record {
            readings: self.record,
            pulse: self.pulse.unwrap_or(Record::PULSE * normal_load),
        };
        ReturnMap {
            amplitude: self.amplitude,
            model: match self.exact {
                true => MapModel::EXACT,
                false => MapModel::Reconstructed(record),
            },
        }
    }

    /// The place of the value of a key; that of `control` where it is not given.
    pub(super) fn place(&self, key: &str) -> Option<&Range<usize>> {
        let of = |key: &str| {
            let found = self.places.iter().find(|(name, _)| *name == key);
            found.map(|(_, place)| place)
        };
        of(key).or_else(|| of("control"))
    }
}

fn read_control(entry: &Entry) -> Result<(), SpecError> {
    match entry.string()? {
        RETURN_MAP => Ok(()),
        other => Err(entry
            .error(format!("unknown control {other:?}"))
            .help("the one there is: \"return-map\"; delayed feedback has its gains in [fixed]")),
    }
}

/// Whether the model is the exact one.
fn read_model(entry: &Entry) -> Result<bool, SpecError> {
    let name = entry.string()?;
    match MODELS.iter().position(|model| *model == name) {
        Some(place) => Ok(place == 0),
        None => Err(entry.error(format!("unknown model {name:?}")).help(format!(
            "one of {}",
            MODELS.map(|m| format!("{m:?}")).join(", ")
        ))),
    }
}

/// The most readings of a record.
pub(super) fn read_record(entry: &Entry) -> Result<u32, SpecError> {
    let (least, most) = (u64::from(Record::LEAST), u64::from(Record::MOST));
    match entry.whole()? {
        readings if (least..=most).contains(&readings) => Ok(readings as u32),
        readings => Err(entry
            .error(format!(
                "{} readings are outside their range: {least} to {most}",
                Shown(readings as f64)
            ))
            .help(format!(
                "five numbers are fitted, and two readings come before the first that tells of \
                 them: record = {least} or more"
            ))),
    }
}
