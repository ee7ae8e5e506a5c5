//! The system of a sweep or a point: its parameters, and the keys that it cannot have.

use std::ops::Range;
use std::sync::Arc;

use super::given_key::GivenKey;
use super::parameter::Parameter;
use super::quantity::Quantity;
use super::system::{NO_SPEED, SpeedUnit, SystemModel, shipped};
use super::units::Units;
use super::values::Setting;
use crate::text::document::Document;
use crate::text::nearest::did_you_mean;
use crate::text::toml_reader::{Entry, SpecError};

/// Keys of a sweep file that are about a block on its spring.
const OF_THE_BLOCK: [&str; 8] = [
    "friction",
    "start",
    "simulation",
    "basin",
    "protocol",
    "phase",
    "verify",
    "best",
];

/// The system of a sweep, and the values that the file gives its parameters.
pub(super) struct GivenSystem {
    pub model: Arc<SystemModel>,
    /// The values of parameters that are no axes.
    pub setting: Setting,
    /// The given parameters, with their places.
    pub given: Vec<(Quantity, Range<usize>)>,
}

impl GivenSystem {
    /// The system of a sweep file, the text `whole`, if it names one. The meaning of other keys
    /// depends on it: those about a block are refused beside it.
    pub(super) fn of(document: &mut Document, whole: &str) -> Result<Option<Self>, SpecError> {
        let Some(entry) = document.entry("system") else {
            return Ok(None);
        };
        document.refuse(
            &OF_THE_BLOCK,
            "it is about a block on its spring; a system from a file has counts, roots and delays \
             alone",
        );
        Self::read(&entry, whole).map(Some)
    }

    /// Reads the key `system` of the text `whole`: a table, or the name of a shipped system.
    fn read(entry: &Entry, whole: &str) -> Result<Self, SpecError> {
        let model = if entry.is_table() {
            SystemModel::of_table(entry, whole)?
        } else {
            let name = entry.string()?;
            shipped::system(name).ok_or_else(|| {
                entry
                    .error(format!("no system of the name \"{name}\""))
                    .help(shipped::meant(name))
            })?
        };
        let model = Arc::new(model);
        Ok(Self {
            setting: Setting::of_system(Arc::clone(&model)),
            model,
            given: Vec::new(),
        })
    }

    /// Checks that the delay is given; where it is not, that is told at `place`.
    pub(super) fn check_delay(&self, place: Option<&Range<usize>>) -> Result<(), SpecError> {
        let tau = Parameter::Tau;
        if self.given.iter().any(|(of, _)| *of == tau) {
            return Ok(());
        }
        let help = format!("tau: {}, {}", tau.long_name(), tau.allowed());
        Err(SpecError {
            span: place.cloned(),
            ..SpecError::whole("tau is not given").help(help)
        })
    }

    /// The parameter that a key gives, of a file with these units; it is recorded as given.
    pub(super) fn give(&mut self, entry: &Entry, units: &Units) -> Result<GivenKey, SpecError> {
        let found = self.key(entry, units)?;
        if self.given.iter().any(|(of, _)| *of == found.of) {
            let message = match found.of.name() {
                name if name == entry.key => format!("{name} is given twice"),
                name => format!("{name} is given twice: {} gives it as a speed", entry.key),
            };
            return Err(SpecError::at(entry.key_span.clone(), message)
                .help("a parameter is either an axis or a fixed value"));
        }
        self.given.push((found.of.clone(), entry.key_span.clone()));
        Ok(found)
    }

    /// What a key gives: a parameter by its name, or the delay as a speed by the unit of that.
    fn key(&self, entry: &Entry, units: &Units) -> Result<GivenKey, SpecError> {
        if let Some(of) = self.model.quantity(entry.key) {
            return Ok(of.into());
        }
        let at = |error: SpecError| SpecError {
            span: Some(entry.key_span.clone()),
            ..error
        };
        if let Some(unit) = self.model.takes_speed(entry.key) {
            return GivenKey::of_speed(unit, units).map_err(at);
        }
        let all = self.model.quantities();
        let names: Vec<&str> = all.iter().map(Quantity::name).collect();
        let meant = did_you_mean(entry.key, names.iter().copied());
        let speed = SpeedUnit::named(entry.key);
        let no_speed = speed.map_or(String::new(), |_| format!("; {NO_SPEED}"));
        let message = format!("the system has no parameter `{}`", entry.key);
        Err(at(SpecError::whole(message).help(format!(
            "{meant}its parameters: {}{no_speed}",
            names.join(", ")
        ))))
    }

    /// Reads the table `[fixed]`.
    pub(super) fn read_fixed(&mut self, fixed: &Entry, units: &Units) -> Result<(), SpecError> {
        for entry in fixed.table()? {
            let given = self.give(&entry, units)?;
            let value = given.value(&entry, units)?;
            self.setting.vary(&given.of, value);
        }
        Ok(())
    }
}
