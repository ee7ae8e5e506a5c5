//! The column of a speed beside the delay that is its period.

use super::Column;
use crate::setting::Parameter;
use crate::setting::system::{SpeedAxis, Turn};
use crate::store::{MapAxis, MapFile};

/// A speed beside the delay, and how it follows from that.
#[derive(Debug, Clone)]
pub(super) struct SpeedColumn {
    axis: SpeedAxis,
    turn: Turn,
}

impl SpeedColumn {
    /// The speed of a map whose system has one and whose numbers have a known unit of time.
    pub(super) fn of(map: &MapFile) -> Option<Self> {
        let (axis, turn) = map.system()?.speed(&map.units())?;
        let axis = axis.clone();
        Some(Self { axis, turn })
    }

    /// Whether it stands behind the column of this axis: that of the delay.
    pub(super) fn is_behind(axis: &MapAxis) -> bool {
        axis.parameter == Parameter::Tau
    }

    /// Its column, of the name of its unit.
    pub(super) fn column(&self) -> Column {
        let unit = self.axis.unit.name();
        Column::of(unit, unit, &self.axis.name)
    }

    /// The speed of a delay, to 15 digits: one that a sweep gives in fewer is that number again.
    /// Infinite where there is no delay.
    pub(super) fn at(&self, delay: f64) -> f64 {
        let speed = self.turn.over(delay);
        format!("{speed:.14e}").parse().unwrap_or(speed)
    }
}
