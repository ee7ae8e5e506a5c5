//! The words for the kinds of curves, of their crossings and of their sides.

use crate::setting::parameter::Parameter;
use crate::setting::quantity::Quantity;

/// How a pair of roots crosses, in the words of the map: for −1, 0, 1.
pub(crate) const DIRECTIONS: &str = "to_the_left touch to_the_right";
/// The side of a curve on which sliding is stable, in the words of the map, for −2 to 2, in planes
/// with the delay. −2 and 2 stand where the first parameter of the plane is constant along the
/// curve.
pub(super) const STABLE_SIDES: &str =
    "smaller_parameter shorter_delays neither longer_delays larger_parameter";

/// The side of a curve on which sliding is stable, in the words of a map with planes of these two
/// parameters, for −2 to 2. Without the delay the words name both of them.
#[must_use]
pub(crate) fn stable_sides([first, second]: [&Quantity; 2]) -> String {
    if *second == Parameter::Tau {
        return STABLE_SIDES.to_owned();
    }
    let (p, q) = (first.name(), second.name());
    format!("smaller_{p} smaller_{q} neither larger_{q} larger_{p}")
}

/// The meaning of the direction of a curve in planes with this second parameter.
#[must_use]
pub(crate) fn direction_along(second: &Quantity) -> String {
    let grows = match *second == Parameter::Tau {
        true => "delay",
        false => second.name(),
    };
    format!("how a pair of roots crosses with growing {grows}")
}

/// The columns whose words depend on the parameters of the plane.
pub(super) const DIRECTION: &str = "direction";
pub(super) const STABLE_SIDE: &str = "stable_side";

/// What lies on the line along a curve, in the words of the map: for 0, 1, 2.
pub(crate) const CURVE_KINDS: &str = "pair real_root leading_coefficient";
