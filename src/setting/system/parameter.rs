//! A parameter of a system.

use crate::setting::parameter::LARGEST;
use crate::setting::unit::Unit;
use crate::text::Shown;

/// A parameter that a system file names.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnParameter {
    /// Its number in the system, from 0 on.
    pub index: usize,
    /// The name, one word everywhere.
    pub name: String,
    /// The meaning in words; the name where the file gives none.
    pub long_name: String,
    /// The value where none is given.
    pub default: f64,
    /// The smallest value.
    pub minimum: f64,
    /// The largest value.
    pub maximum: f64,
    /// Its unit, "1" where it has none.
    pub unit: String,
    /// Powers of force, length and time, where numbers with units are understood.
    pub dimension: [i32; 3],
}

/// The range of a parameter for which the file gives none.
pub(super) const WIDEST: [f64; 2] = [-LARGEST, LARGEST];

impl OwnParameter {
    /// The allowed range, in words.
    #[must_use]
    pub fn allowed(&self) -> String {
        match [self.minimum, self.maximum] {
            WIDEST => "a finite number of size at most 1e12".into(),
            [from, LARGEST] => format!("{} or more, at most 1e12", Shown(from)),
            [from, to] => format!("{} to {}", Shown(from), Shown(to)),
        }
    }

    /// This parameter with a unit that has these powers of force, length and time.
    pub(in crate::setting) fn measured(&self, unit: String, dimension: [i32; 3]) -> Self {
        Self {
            unit,
            dimension,
            ..self.clone()
        }
    }

    /// This parameter with another unit; one that is not understood has no dimension.
    pub(crate) fn in_unit(&self, unit: &str) -> Self {
        let known = Unit::read(unit).ok();
        let dimension = known.map_or([0; 3], |unit| unit.dimension());
        self.measured(unit.to_owned(), dimension)
    }

    /// The ends of its range, as far as it has any.
    #[must_use]
    pub fn ends(&self) -> (Option<f64>, Option<f64>) {
        let end = |end: f64| (end.abs() < LARGEST).then_some(end);
        (end(self.minimum), end(self.maximum))
    }

    /// `value` if it is in range.
    ///
    /// # Errors
    /// Names the parameter, the value and the allowed range.
    pub(crate) fn check(&self, value: f64) -> Result<f64, String> {
        if (self.minimum..=self.maximum).contains(&value) {
            return Ok(value);
        }
        Err(format!(
            "{} = {} is outside its range: {}",
            self.name,
            Shown(value),
            self.allowed()
        ))
    }
}
