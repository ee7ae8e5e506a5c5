//! The facts of an axis, printed alike for a sweep and for a map.

use crate::report::numbers::grouped;
use crate::setting::quantity::Quantity;
use crate::text::Shown;
use serde::Serialize;
use utoipa::ToSchema;

/// An axis by its parameter: its number of values, the first and the last.
#[derive(Serialize, ToSchema)]
pub(super) struct AxisFacts {
    pub name: String,
    points: u64,
    first: f64,
    last: f64,
}

impl AxisFacts {
    /// The facts of an axis with these values, at least one.
    pub(super) fn of(parameter: &Quantity, values: &[f64]) -> Self {
        Self {
            name: parameter.name().to_owned(),
            points: values.len() as u64,
            first: values[0],
            last: values[values.len() - 1],
        }
    }

    /// "tau   400 points, 0 to 12 s"; `unit` has a space before it, or is empty.
    pub(super) fn text(&self, unit: &str) -> String {
        let (name, points) = (&self.name, grouped(self.points));
        let plural = if self.points == 1 { "" } else { "s" };
        let (first, last) = (Shown(self.first), Shown(self.last));
        format!("{name:<12} {points:>10} point{plural}, {first} to {last}{unit}")
    }
}
