//! Delays that are periods, shown as speeds: stability lobes in the form that engineers use. Where
//! numbers have no unit of time, the speed is 2π/τ, without a unit.

use super::text::{Rich, axis_title};
use crate::meaning::scale::Scale;
use crate::meaning::scale::has_speeds;
use crate::setting::Parameter;
use crate::setting::system::{SpeedAxis, Turn};
use crate::store::MapFile;
use crate::store::map_file::MapAxis;

/// The speed shown for an axis, if the map's system says that its delay is a period.
fn speed_of<'m>(map: &'m MapFile, axis: &MapAxis) -> Option<&'m SpeedAxis> {
    let speed = map.system()?.speed_axis.as_ref()?;
    let shown = axis.parameter == Parameter::Tau && has_speeds(&axis.values);
    shown.then_some(speed)
}

/// Whether the delay of a map is shown as a speed, and therefore from left to right.
pub(super) fn is_shown(map: &MapFile, axis: &MapAxis) -> bool {
    speed_of(map, axis).is_some()
}

/// The scale of an axis from left to right.
pub(super) fn scale(map: &MapFile, axis: &MapAxis) -> Scale {
    let speeds = speed_of(map, axis).and_then(|speed| {
        let turn = speed.turn(&map.units()).unwrap_or(Turn::WITHOUT_UNITS);
        Scale::of_speeds(&axis.values, turn)
    });
    speeds.unwrap_or_else(|| Scale::between(&axis.values))
}

/// "spindle speed  (rpm)", without a unit of time "spindle speed  2π/τ", or the title of the axis
/// itself.
pub(super) fn title(map: &MapFile, axis: &MapAxis) -> Rich {
    match speed_of(map, axis) {
        Some(speed) => Rich::plain(&match speed.turn(&map.units()) {
            Some(_) => format!("{}  ({})", speed.name, speed.unit.name()),
            None => format!("{}  2π/τ", speed.name),
        }),
        None => axis_title(axis),
    }
}
