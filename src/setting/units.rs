//! The units of a sweep, and the table `[units]` of a file.

use super::keys::{UNITS, names};
use super::parameter::Parameter;
use super::unit::{Unit, described};
use crate::text::nearest::did_you_mean;
use crate::text::toml_reader::{Entry, SpecError};

/// The units of a sweep; without any, all numbers are dimensionless.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Units {
    /// Names of the units of force, length and time, as UDUNITS writes them.
    pub force_length_time: Option<[String; 3]>,
    /// Whether they are the SI because some number has a unit and no units are declared.
    pub assumed: bool,
}

/// The most letters of a unit.
const LONGEST_NAME: usize = 20;
/// The units of force, length and time in the SI.
const SI: [&str; 3] = ["N", "m", "s"];
/// The powers of force, length and time in a mass.
const MASS: [i32; 3] = [1, -1, 2];

impl Units {
    /// The names of [`Units::preset`].
    pub const PRESETS: [&str; 2] = ["SI", "dimensionless"];

    /// Units by one name: `SI` (N, m, s) or `dimensionless`.
    #[must_use]
    pub fn preset(name: &str) -> Option<Self> {
        match name {
            "SI" => Some(Self::si()),
            "dimensionless" => Some(Self::default()),
            _ => None,
        }
    }

    /// N, m and s.
    pub(crate) fn si() -> Self {
        Self::named(SI.map(String::from))
    }

    /// The words force, length and time in the place of units.
    pub(crate) fn symbolic() -> Self {
        Self::named(["force", "length", "time"].map(String::from))
    }

    fn named(names: [String; 3]) -> Self {
        Self {
            force_length_time: Some(names),
            assumed: false,
        }
    }

    /// The SI, where no units are declared and some number has one.
    pub(crate) fn assumed_si() -> Self {
        Self {
            assumed: true,
            ..Self::si()
        }
    }

    /// A remark on units that are assumed.
    pub(crate) fn remark(&self) -> Option<&'static str> {
        self.assumed.then_some(
            "some numbers have units, and no units are declared: all others are in N, m, s and kg",
        )
    }

    /// Checks that the units of force, length and time are known ones.
    ///
    /// # Errors
    /// Says why numbers with units cannot be turned into these.
    pub(super) fn check_known(&self) -> Result<(), SpecError> {
        (0..3).try_for_each(|axis| self.base(axis).map(drop))
    }

    /// The unit of force (0), length (1) or time (2).
    ///
    /// # Errors
    /// When there is none, or it is not known.
    pub(super) fn base(&self, axis: usize) -> Result<Unit, SpecError> {
        let Some(names) = &self.force_length_time else {
            let message = "a number has a unit, but all numbers here are dimensionless";
            let help =
                "leave the unit out, or declare units: SI, or those of force, length and time";
            return Err(SpecError::whole(message).help(help));
        };
        let mut dimension = [0; 3];
        dimension[axis] = 1;
        let unit = Unit::read(&names[axis]).ok();
        let unit = unit.filter(|unit| unit.dimension() == dimension);
        unit.ok_or_else(|| {
            let (name, what) = (&names[axis], described(dimension));
            let message = format!("the declared unit \"{name}\" is not known as a unit of {what}");
            SpecError::whole(message)
                .help("leave the unit behind the number out, or declare units like N, mm and s")
        })
    }

    /// Units from a text: the name of a preset, or the units of force, length and time separated by
    /// commas, such as `N,mm,s`.
    ///
    /// # Errors
    /// Says what is expected.
    pub fn read(text: &str) -> Result<Self, String> {
        if let Some(preset) = Self::preset(text.trim()) {
            return Ok(preset);
        }
        let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
        let known = Self::PRESETS.join(", ");
        let expected = format!("expected {known}, or the units of force, length and time: N,mm,s");
        let names = <[String; 3]>::try_from(names).map_err(|_| expected)?;
        names.iter().try_for_each(|name| Self::check_name(name))?;
        Ok(Self::named(names))
    }

    /// Checks that a name can be that of a unit.
    ///
    /// # Errors
    /// Says what is expected.
    pub fn check_name(name: &str) -> Result<(), String> {
        let is_short = (1..=LONGEST_NAME).contains(&name.chars().count());
        match is_short && name.chars().all(|c| c.is_alphabetic() || c == '%') {
            true => Ok(()),
            false => Err(format!(
                "a unit is one word of 1 to {LONGEST_NAME} letters, like \"N\" or \"mm\""
            )),
        }
    }

    /// Whether there are no units: all numbers are dimensionless.
    #[must_use]
    pub fn dimensionless(&self) -> bool {
        self.force_length_time.is_none()
    }

    /// The unit of a quantity with these powers of force, length and time; "1" where it has none.
    #[must_use]
    pub fn of(&self, dimension: [i32; 3]) -> String {
        let Some(names) = &self.force_length_time else {
            return "1".into();
        };
        if dimension == MASS && *names == SI {
            return "kg".into();
        }
        let factors: Vec<String> = names
            .iter()
            .zip(dimension)
            .filter(|&(_, power)| power != 0)
            .map(|(name, power)| match power {
                1 => name.clone(),
                _ => format!("{name}{power}"),
            })
            .collect();
        if factors.is_empty() {
            "1".into()
        } else {
            factors.join(" ")
        }
    }

    /// The unit of a parameter.
    #[must_use]
    pub fn of_parameter(&self, parameter: Parameter) -> String {
        self.of(parameter.dimension())
    }

    /// The unit of time.
    #[must_use]
    pub fn time(&self) -> String {
        self.of([0, 0, 1])
    }

    /// The unit of a rate of decay, one over time.
    #[must_use]
    pub fn rate(&self) -> String {
        self.of([0, 0, -1])
    }

    /// The unit of an angular frequency.
    #[must_use]
    pub fn angular_frequency(&self) -> String {
        match &self.force_length_time {
            Some([_, _, time]) => format!("rad {time}-1"),
            None => "1".into(),
        }
    }
}

fn read_unit(entry: &Entry) -> Result<String, SpecError> {
    let name = entry.string()?;
    Units::check_name(name).map_err(|why| entry.error(why))?;
    Ok(name.to_owned())
}

/// Reads the table `[units]`.
pub(super) fn read_units(units: &Entry) -> Result<Units, SpecError> {
    if !units.is_table() {
        let name = units.string()?;
        return Units::preset(name).ok_or_else(|| {
            let meant = did_you_mean(name, Units::PRESETS);
            let known = Units::PRESETS.join(", ");
            units
                .error(format!("unknown units \"{name}\""))
                .help(format!(
                    "{meant}known: {known}; or a table of force, length and time"
                ))
        });
    }
    let mut table = units.document(names(&UNITS))?;
    let [force, length, time] = ["force", "length", "time"].map(|key| table.take(key, read_unit));
    table.finish()?;
    match (force, length, time) {
        (Some(force), Some(length), Some(time)) => Ok(Units::named([force, length, time])),
        _ => Err(SpecError::at(
            units.key_span.clone(),
            "units: force, length and time are needed, all three",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_have_units() {
        let [si, without] = Units::PRESETS.map(|name| Units::preset(name).unwrap());
        let of = |units: &Units| {
            [Parameter::Mass, Parameter::Stiffness, Parameter::Tau].map(|p| units.of_parameter(p))
        };
        assert_eq!(of(&si), ["kg", "N m-1", "s"]);
        assert_eq!(of(&without), ["1"; 3]);
        assert_eq!(Units::preset("si"), None);
        assert_eq!(Units::read("SI"), Ok(si));
        assert_eq!(Units::read(" dimensionless"), Ok(without));
        for text in [
            "", "si", "N", "N,mm", "N,mm,s,s", "N,mm,", "N,m m,s", "N,mm,s-1",
        ] {
            assert!(Units::read(text).is_err(), "{text}");
        }
        let mm = Units::named(["N", "mm", "s"].map(String::from));
        assert_eq!(of(&mm), ["N mm-1 s2", "N mm-1", "s"]);
        assert_eq!(Units::read("N, mm, s"), Ok(mm));
    }
}
