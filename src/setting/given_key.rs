//! What a key of a file gives: a parameter in its own numbers, or the delay as a speed.

use super::axis::Axis;
use super::parameter::Parameter;
use super::quantity::Quantity;
use super::spec_values::{read_list, read_range};
use super::system::{SpeedUnit, Turn};
use super::units::Units;
use crate::text::toml_reader::{Entry, SpecError};

/// What a key gives: a parameter, and how its numbers are meant.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GivenKey {
    /// The parameter.
    pub of: Quantity,
    /// The unit of the speed in whose numbers the key gives the delay.
    speed: Option<(SpeedUnit, Turn)>,
}

impl From<Quantity> for GivenKey {
    fn from(of: Quantity) -> Self {
        Self { of, speed: None }
    }
}

impl GivenKey {
    /// The delay as a speed in `unit`, of a file with these units.
    ///
    /// # Errors
    /// Where there is no known unit of time.
    pub(super) fn of_speed(unit: SpeedUnit, units: &Units) -> Result<Self, SpecError> {
        let turn = unit.turn(units)?;
        Ok(Self {
            of: Parameter::Tau.into(),
            speed: Some((unit, turn)),
        })
    }

    /// The value of the parameter that an entry gives.
    pub(super) fn value(&self, entry: &Entry, units: &Units) -> Result<f64, SpecError> {
        let value = match self.speed {
            Some((unit, turn)) => turn.over(read_speed(entry, unit)?),
            None => units.value(entry, &self.of)?,
        };
        let checked = self.of.check(value);
        checked.map_err(|why| SpecError::at(entry.span.clone(), why))
    }

    /// The axis that an entry gives: a list, or a range of at most `most` points. Speeds in either
    /// order make an axis of increasing delays.
    pub(super) fn axis(&self, entry: &Entry, units: &Units, most: u64) -> Result<Axis, SpecError> {
        let values = match (self.speed, entry.is_table()) {
            (Some((unit, turn)), is_range) => {
                let speed = |entry: &Entry| read_speed(entry, unit);
                let speeds = match is_range {
                    true => read_range(entry, speed, most)?,
                    false => read_list(entry, speed)?,
                };
                periods(entry, &speeds, turn)?
            }
            (None, true) => read_range(entry, |entry| units.value(entry, &self.of), most)?,
            (None, false) => read_list(entry, |entry| self.value(entry, units))?,
        };
        Axis::new(self.of.clone(), values).map_err(|e| entry.error(e.message))
    }
}

/// A speed > 0 in its unit.
fn read_speed(entry: &Entry, unit: SpeedUnit) -> Result<f64, SpecError> {
    let speed = unit.checked(entry.number()?);
    speed.map_err(|error| entry.error(error.message))
}

/// The periods of speeds in either order, increasing.
fn periods(entry: &Entry, speeds: &[f64], turn: Turn) -> Result<Vec<f64>, SpecError> {
    let mut periods: Vec<f64> = speeds.iter().map(|speed| turn.over(*speed)).collect();
    if periods.first() > periods.last() {
        periods.reverse();
    }
    if periods.windows(2).any(|pair| pair[0] >= pair[1]) {
        let message = "the speeds must be strictly increasing or strictly decreasing, and their \
             periods different in double precision";
        return Err(entry.error(message));
    }
    Ok(periods)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::SweepSpec;

    const SPINDLE: &str = "system = { P = \"s^2 + 60*s + 4e5\", Q = \"-w\", \
        speed_axis = { name = \"spindle speed\", unit = \"Hz\" }, parameters = { w = 1e4 } }\n";

    fn read(axes: &str, units: &str) -> Result<SweepSpec, (String, Option<String>)> {
        let text = format!("{SPINDLE}{units}[axes]\n{axes}");
        let read = text.parse::<SweepSpec>();
        read.map_err(|error| (error.message, error.span.map(|span| text[span].to_owned())))
    }

    fn delays(axes: &str) -> Vec<f64> {
        let sweep = read(axes, "units = \"SI\"\n").unwrap();
        assert_eq!(sweep.axes[0].parameter, Parameter::Tau);
        sweep.axes[0].values.clone()
    }

    /// Whatever the unit of the system's own axis.
    #[test]
    fn speeds_make_an_axis_of_increasing_delays() {
        let range = "rpm = { from = 1000, to = 3000, points = 3 }\n";
        assert_eq!(delays(range), [0.02, 0.03, 0.06]);
        assert_eq!(delays("rpm = [3000, 2000, 1000]\n"), [0.02, 0.03, 0.06]);
        assert_eq!(delays("rpm = [1000, 3000]\n"), [0.02, 0.06]);
        assert_eq!(delays("Hz = [50]\n"), [0.02]);
        assert_eq!(
            delays("\"rad/s\" = [100]\n"),
            [std::f64::consts::TAU / 100.0]
        );
        let log = "rpm = { from = 100, to = 10000, points = 3, spacing = \"log\" }\n";
        let log = delays(log);
        assert_eq!((log[0], log[2]), (0.006, 0.6));
        assert!((log[1] - 0.06).abs() < 1e-15);
        let units = "units = { force = \"N\", length = \"mm\", time = \"ms\" }\n";
        let in_ms = read("w = [1, 2]\n[fixed]\nrpm = 3000\n", units).unwrap();
        assert_eq!(in_ms.fixed.get(Parameter::Tau), 20.0);
    }

    #[test]
    fn speeds_that_are_none_are_refused_in_their_place() {
        let si = "units = \"SI\"\n";
        for (axes, units, says, place) in [
            (
                "rpm = [1000]\n",
                "",
                "rpm needs the unit of time: all numbers",
                "rpm",
            ),
            (
                "tau = [1]\nrpm = [1000]\n",
                si,
                "tau is given twice: rpm gives",
                "rpm",
            ),
            ("rpm = [1000, 0]\n", si, "0 rpm is outside its range", "0"),
            ("Hz = [-1]\n", si, "-1 Hz is outside its range", "-1"),
            ("rpm = [1, 2, 2]\n", si, "strictly increasing", "[1, 2, 2]"),
            ("rpm = [1, 3, 2]\n", si, "strictly increasing", "[1, 3, 2]"),
            ("rpm = [\"50 Hz\"]\n", si, "expected a number", "\"50 Hz\""),
            ("rpn = [1]\n", si, "no parameter `rpn`", "rpn"),
        ] {
            let (message, span) = read(axes, units).unwrap_err();
            assert!(message.contains(says), "{axes}: {message}");
            assert_eq!(span.as_deref(), Some(place), "{axes}");
        }
        let other = "system = \"pd\"\nunits = \"SI\"\n[axes]\nrpm = [1000]\n";
        let error = other.parse::<SweepSpec>().unwrap_err();
        assert!(error.help.unwrap().contains("speed_axis"));
    }
}
