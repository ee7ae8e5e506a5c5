//! The planes of a sweep in which the best setting is searched for.

use super::axis::Axis;
use super::parameter::Parameter;
use crate::linear::best::SearchedGain;

/// The gain that a parameter is; none for other parameters.
#[must_use]
pub(crate) fn searched_gain(parameter: Parameter) -> Option<SearchedGain> {
    match parameter {
        Parameter::AlphaV => Some(SearchedGain::Velocity),
        Parameter::AlphaN => Some(SearchedGain::Load),
        _ => None,
    }
}

/// The parameter that a gain is.
#[must_use]
pub(crate) const fn parameter_of(gain: SearchedGain) -> Parameter {
    match gain {
        SearchedGain::Velocity => Parameter::AlphaV,
        SearchedGain::Load => Parameter::AlphaN,
    }
}

/// The axes (gain, delay) of the planes in which the best setting is searched for: the last gain
/// axis and the delay, if both have more than one point.
#[must_use]
pub(crate) fn gain_plane(axes: &[Axis]) -> Option<(usize, usize)> {
    let gain = axes.iter().rposition(|axis| {
        axis.len() > 1 && axis.parameter.known().and_then(searched_gain).is_some()
    })?;
    let tau = axes
        .iter()
        .position(|axis| axis.len() > 1 && axis.parameter == Parameter::Tau)?;
    Some((gain, tau))
}
