//! The unit of measured speeds, and its conversion into the units of a setting.

use std::fmt;

use crate::setting::Parameter;
use crate::setting::unit::{Scale, Unit};
use crate::setting::units::Units;

/// What is understood.
const FORM: &str = "a length over a time, like mm/s or m/min";

/// A unit of speed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpeedUnit(Unit);

impl fmt::Display for SpeedUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl SpeedUnit {
    /// A unit such as `mm/s`, or `mm s-1`.
    ///
    /// # Errors
    /// Says what is expected.
    pub fn read(text: &str) -> Result<Self, String> {
        let unit = Unit::read(text).ok();
        let unit = unit.filter(|unit| unit.dimension() == Parameter::V0.dimension());
        let name = text.trim();
        unit.map(Self)
            .ok_or_else(|| format!("{name} is no known unit of speed: expected {FORM}"))
    }

    /// The factor from this unit to that of `units`.
    ///
    /// # Errors
    /// Says why there is none.
    pub(super) fn scale_in(&self, units: &Units) -> Result<Scale, String> {
        if units.dimensionless() {
            return Err(format!(
                "speeds in {self} need units of the setting, and it has none"
            ));
        }
        self.0.scale_in(units).map_err(|error| {
            let (to, why) = (units.of_parameter(Parameter::V0), error.message);
            format!("speeds in {self} cannot be turned into {to}: {why}")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_converted() {
        let turned = |number: &str, unit: &str, units: &str| {
            let scale = SpeedUnit::read(unit)?.scale_in(&Units::read(units).unwrap())?;
            Ok::<_, String>(scale.of(number).unwrap())
        };
        for (number, unit, units, expected) in [
            ("70", "mm/s", "SI", 0.07),
            ("1", "mm s-1", "N,m,s", 1.0 / 1000.0),
            ("1", "mm·s⁻¹", "N,mm,s", 1.0),
            ("1", "µm/s", "N,mm,s", 1.0 / 1000.0),
            ("1", "nm/us", "SI", 1.0 / 1000.0),
            ("1", "dm/sec", "SI", 0.1),
            ("1", "m/min", "SI", 1.0 / 60.0),
            ("1", "m/min", "N,m,min", 1.0),
            ("1", "km/h", "SI", 5.0 / 18.0),
            ("1", "m / s", "N,mm,ms", 1.0),
            ("1", "in/s", "N,mm,s", 127.0 / 5.0),
            ("1", "ft/s", "N,in,s", 12.0),
            ("1", "mm/s", "bar,mm,s", 1.0),
        ] {
            assert_eq!(turned(number, unit, units), Ok(expected), "{unit} {units}");
        }
        for (unit, units, why) in [
            ("rpm", "SI", "rpm is no known unit"),
            ("mm", "SI", "no known unit"),
            ("mm/s2", "SI", "no known unit"),
            ("mm/s", "dimensionless", "it has none"),
            ("mm/s", "N,furlong,s", "into furlong s-1: the declared"),
        ] {
            let error = turned("1", unit, units).unwrap_err();
            assert!(error.contains(why), "{unit}: {error}");
        }
    }
}
