//! The colours of a scale: a step for each stretch of values, and what lies beyond.

use super::colour::{
    self, ABOVE, BELOW, INFINITE, MINUS_INFINITE, NO_VALUE, Rgb, SIZE_STEPS, STEPS, ZERO,
};
use super::gradient::ColourMap;
use super::scale::Scale;
use crate::model::elementary::power;

/// Relative rounding of the ends of a scale.
const ROUNDED: f64 = 1e-9;

/// Colours of numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Steps {
    /// Where the colour changes, in growing order: a value that is equal has the upper colour.
    pub ends: Vec<f64>,
    /// The colours below, between and above the ends, one more than these.
    pub colours: Vec<Rgb>,
    /// The colour of 0, if it has one of its own.
    pub zero: Option<Rgb>,
    /// The colour of ∞.
    pub infinite: Rgb,
    /// The colour of −∞.
    pub minus_infinite: Rgb,
}

impl Steps {
    /// From dark to light along a scale; a 0 apart where it has a meaning, or no place on it.
    pub(super) fn sized(map: ColourMap, scale: Scale, zero: bool) -> Self {
        let count = SIZE_STEPS as usize;
        let [low, high] = [0.0, 1.0].map(|part| scale.value(part));
        let inner = (0..count).map(|i| scale.value((i as f64 + 0.5) / SIZE_STEPS));
        let colours = (0..=count).map(|i| colour::of_size(map, i as f64 / SIZE_STEPS));
        let zero = zero || scale.is_logarithmic();
        Self {
            ends: [lower(low)]
                .into_iter()
                .chain(inner)
                .chain([upper(high)])
                .collect(),
            colours: [BELOW].into_iter().chain(colours).chain([ABOVE]).collect(),
            zero: zero.then_some(ZERO),
            infinite: INFINITE,
            minus_infinite: MINUS_INFINITE,
        }
    }

    /// Two colours that meet at 0, between `low` and `high`; `stable` is the sign of the better
    /// side.
    pub(super) fn two_sided(map: ColourMap, (low, high): (f64, f64), stable: f64) -> Self {
        let range = low.abs().max(high.abs());
        let count = STEPS as i32;
        // At ± n² parts of the range, since the strength grows with the square root.
        let end = |n: i32| f64::from(n.signum()) * power(f64::from(n) / STEPS, 2) * range;
        let ends: Vec<f64> = (1 - count..count).map(end).collect();
        let middle = |n: i32| 0.5 * (end(n) + end(n + 1));
        let shade = |n: i32| colour::two_sided(map, stable * middle(n), range);
        let colours: Vec<Rgb> = (-count..count).map(shade).collect();
        let (low, high) = (lower(low), upper(high));
        let first = ends.partition_point(|end| *end <= low);
        let last = ends.partition_point(|end| *end < high).max(first);
        let [below, above] = [-stable, stable].map(|side| colour::beyond(map, side));
        let endless = |value: f64| colour::beyond(map, stable * value);
        Self {
            ends: [&[low], &ends[first..last], &[high]].concat(),
            colours: [&[below], &colours[first..=last], &[above]].concat(),
            zero: (low <= 0.0 && 0.0 < high).then(|| map.on_side(0.0)),
            infinite: endless(f64::INFINITY),
            minus_infinite: endless(f64::NEG_INFINITY),
        }
    }

    /// The colour of a value.
    pub(crate) fn colour(&self, value: f64) -> Rgb {
        match (value, self.zero) {
            (0.0, Some(zero)) => zero,
            (f64::INFINITY, _) => self.infinite,
            (f64::NEG_INFINITY, _) => self.minus_infinite,
            (value, _) if value.is_nan() => NO_VALUE,
            _ => self.colours[self.ends.partition_point(|end| *end <= value)],
        }
    }
}

/// Whether a value lies beyond the upper end of a scale.
pub(super) fn above(value: f64, end: f64) -> bool {
    value >= upper(end)
}

/// Whether a value lies beyond the lower end of a scale.
pub(super) fn below(value: f64, end: f64) -> bool {
    value < lower(end)
}

/// The least value above the upper end of a scale.
fn upper(end: f64) -> f64 {
    (end + ROUNDED * end.abs()).next_up()
}

/// The least value that still lies on a scale with this lower end.
fn lower(end: f64) -> f64 {
    end - ROUNDED * end.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The steps are those of the functions of a part of the way.
    #[test]
    fn steps_are_colours_of_places() {
        let values = (-4000..=4000).map(|i| f64::from(i) * 5.3e-4);
        let (two, stable) = (Steps::two_sided(ColourMap::BrBG, (-2.0, 2.0), -1.0), -1.0);
        for value in values.filter(|v| v.abs() <= 2.0) {
            let at = colour::two_sided(ColourMap::BrBG, stable * value, 2.0);
            assert_eq!(two.colour(value), at, "{value}");
        }
        for scale in [Scale::linear(0.0, 3.0), Scale::logarithmic(0.01, 3.0)] {
            let sized = Steps::sized(ColourMap::Viridis, scale, false);
            for part in (0..=1000).map(|i| f64::from(i) / 1000.0) {
                let at = colour::of_size(ColourMap::Viridis, part);
                let value = scale.value(part);
                assert!(value == 0.0 || sized.colour(value) == at, "{value}");
            }
            assert_eq!(sized.colour(3.1), ABOVE);
            assert_eq!(sized.colour(-1.0), BELOW);
        }
    }

    #[test]
    fn ends_and_infinities_have_colours_of_their_own() {
        let steps = Steps::two_sided(ColourMap::BrBG, (-1.0, 0.5), 1.0);
        assert_eq!(steps.colours.len(), steps.ends.len() + 1);
        assert!(steps.ends.is_sorted());
        let beyond = [-2.0, 2.0].map(|v| colour::beyond(ColourMap::BrBG, v));
        assert_eq!([-1.1, 0.6].map(|v| steps.colour(v)), beyond);
        assert_eq!(
            steps.colour(0.5),
            colour::two_sided(ColourMap::BrBG, 0.5, 1.0)
        );
        assert_eq!(steps.colour(f64::NAN), NO_VALUE);
        assert_ne!(steps.colour(f64::INFINITY), steps.colour(2.0));
        // A range that leaves 0 out.
        let above = Steps::two_sided(ColourMap::BrBG, (0.2, 1.0), 1.0);
        assert_eq!(above.zero, None);
        assert_eq!(above.colour(0.0), colour::beyond(ColourMap::BrBG, -1.0));
    }
}
