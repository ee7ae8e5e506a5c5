//! The speed of a rotation whose period is the delay; here alone one is turned into the other.

use super::SystemModel;
use crate::setting::unit::Unit;
use crate::setting::units::Units;
use crate::text::{Shown, SpecError};

/// A speed derived from a delay that is a period.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpeedAxis {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: SpeedUnit,
}

/// A unit of speed, which determines the speed for a period τ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeedUnit {
    /// Revolutions per minute, 60/τ with τ in seconds.
    RevolutionsPerMinute,
    /// Revolutions per second, 1/τ with τ in seconds.
    Hertz,
    /// Radians per second, 2π/τ with τ in seconds.
    RadiansPerSecond,
}

/// What is said where a speed is given to a system that takes none.
pub(crate) const NO_SPEED: &str = "only a system with a speed_axis takes a speed";

/// The smallest and the largest speed that can be given, in its unit.
const SPEEDS: [f64; 2] = [1e-12, 1e12];

/// A period times its speed, in the units of both: by it either follows from the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn(f64);

impl Turn {
    /// An angular speed in one over the unit of time, for numbers without units: 2π/τ.
    pub(crate) const WITHOUT_UNITS: Self = Self(std::f64::consts::TAU);

    /// The speed of a period > 0, or the period of a speed > 0.
    #[must_use]
    pub fn over(self, of: f64) -> f64 {
        self.0 / of
    }
}

impl SpeedUnit {
    /// The units of speeds, by name.
    pub(crate) const ALL: [Self; 3] = [
        Self::RevolutionsPerMinute,
        Self::Hertz,
        Self::RadiansPerSecond,
    ];

    /// The unit of this name.
    #[must_use]
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.name() == name)
    }

    /// The name in files, tables and pictures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::RevolutionsPerMinute => "rpm",
            Self::Hertz => "Hz",
            Self::RadiansPerSecond => "rad/s",
        }
    }

    /// A speed that is in the range of those that can be given.
    ///
    /// # Errors
    /// Says the range.
    pub(crate) fn checked(self, speed: f64) -> Result<f64, SpecError> {
        let [least, most] = SPEEDS;
        match (least..=most).contains(&speed) {
            true => Ok(speed),
            false => Err(SpecError::whole(format!(
                "{} {} is outside its range: greater than 0, from {least:e} to {most:e}",
                Shown(speed),
                self.name()
            ))),
        }
    }

    /// What a speed in this unit times its period in `units` is.
    ///
    /// # Errors
    /// Where there is no known unit of time: all numbers are dimensionless, or it is a word that is
    /// not known.
    pub fn turn(self, units: &Units) -> Result<Turn, SpecError> {
        let name = self.name();
        let refused = |why: String| {
            SpecError::whole(format!("{name} needs the unit of time: {why}"))
                .help("declare units, SI or those of force, length and time; or give tau")
        };
        if units.dimensionless() {
            return Err(refused("all numbers here are dimensionless".into()));
        }
        let (seconds, factor) = match self {
            Self::RevolutionsPerMinute => ("60", 1.0),
            Self::Hertz => ("1", 1.0),
            Self::RadiansPerSecond => ("1", std::f64::consts::TAU),
        };
        let scale = Unit::read("s").and_then(|second| second.scale_in(units));
        let scale = scale.map_err(|error| refused(error.message))?;
        let turn = scale.of(seconds).map(|turn| Turn(turn * factor));
        turn.ok_or_else(|| refused(format!("a second is too many {}", units.time())))
    }
}

impl SpeedAxis {
    /// How periods in `units` are turned into this speed; none where there is no known unit of
    /// time, as of dimensionless numbers. The speed then has no unit and is not told.
    #[must_use]
    pub fn turn(&self, units: &Units) -> Option<Turn> {
        self.unit.turn(units).ok()
    }
}

impl SystemModel {
    /// The unit of this name, if the system takes a speed in it in the place of its delay.
    #[must_use]
    pub(crate) fn takes_speed(&self, name: &str) -> Option<SpeedUnit> {
        SpeedUnit::named(name).filter(|_| self.speed_axis.is_some())
    }

    /// The speed of its delay and how it is computed, where its numbers are in `units`; none
    /// without a speed or without a known unit of time.
    #[must_use]
    pub fn speed(&self, units: &Units) -> Option<(&SpeedAxis, Turn)> {
        let axis = self.speed_axis.as_ref()?;
        Some((axis, axis.turn(units)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_those_of_periods_in_the_unit_of_time() {
        use SpeedUnit::{Hertz, RadiansPerSecond, RevolutionsPerMinute};
        let si = Units::si();
        for (unit, period, speed) in [
            (RevolutionsPerMinute, 0.02, 3000.0),
            (RevolutionsPerMinute, 0.06, 1000.0),
            (Hertz, 0.02, 50.0),
            (RadiansPerSecond, 0.02, 100.0 * std::f64::consts::PI),
        ] {
            let turn = unit.turn(&si).unwrap();
            assert_eq!((turn.over(period), turn.over(speed)), (speed, period));
        }
        for (units, period) in [("N,mm,ms", 20.0), ("N,m,min", 20e-3 / 60.0)] {
            let units = Units::read(units).unwrap();
            let turn = RevolutionsPerMinute.turn(&units).unwrap();
            assert_eq!(turn.over(period), 3000.0, "{units:?}");
        }
    }

    #[test]
    fn without_a_unit_of_time_there_is_no_speed() {
        for (units, says) in [("dimensionless", "dimensionless"), ("N,m,beat", "beat")] {
            let units = Units::read(units).unwrap();
            let error = SpeedUnit::RevolutionsPerMinute.turn(&units).unwrap_err();
            assert!(error.message.contains(says), "{error}");
        }
        // The units of force and length do not matter.
        let units = Units::read("beat,beat,s").unwrap();
        let turn = SpeedUnit::RevolutionsPerMinute.turn(&units).unwrap();
        assert_eq!(turn.over(3000.0), 0.02);
    }
}
