//! The units in which a sweep is written.

use super::parameter::Parameter;

/// The units in which a sweep is written; none given means dimensionless.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Units {
    /// Names of the units of force, length and time, as UDUNITS writes them.
    pub force_length_time: Option<[String; 3]>,
}

impl Units {
    /// The unit of a quantity with these powers of force, length and time; "1" where it has none.
    #[must_use]
    pub fn of(&self, dimension: [i32; 3]) -> String {
        let Some(names) = &self.force_length_time else {
            return "1".into();
        };
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
