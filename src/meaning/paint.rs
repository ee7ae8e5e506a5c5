//! Colours for the values of a field.

use super::colour::{self, Rgb};
use super::gradient::ColourMap;
use super::legend::{Entry, Mark};
use super::numbers::{decimal_exponent, number};
use super::scale::Scale;
use super::steps::{Steps, above, below};
use crate::model::elementary::power;
use crate::setting::Field;
use crate::setting::field::{Spread, Storage};

/// The share of the values of slopes and further roots that lie on the scale. Near double roots
/// some slopes exceed any scale, and as the delay vanishes all roots but the rightmost go to −∞.
const TOLD_APART: f64 = 0.96;
/// Decades of a velocity that colours, and lines, show: it falls to zero faster than any power.
pub(crate) const DECADES: i32 = 5;
/// The longest relaxation time on the scale, in units of the shortest one.
const LONGEST_RELAXATION: f64 = 100.0;

/// The largest ratio of velocities, or of stick times, on the scale.
const LARGEST_RATIO: f64 = 1000.0;

/// The scale extends to the largest velocity if that is at most this many times its usual end.
const FEW_TIMES: f64 = 5.0;

/// The colours of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Paint {
    /// A colour for each number of unstable roots.
    Counts,
    /// A colour for each kind of this field, or each of its small counts.
    Kinds(Field),
    /// Two colours that meet at zero; `stable` is the sign of values on the stable side.
    TwoSided {
        map: ColourMap,
        low: f64,
        high: f64,
        stable: f64,
    },
    /// From dark to light along a scale. Values beyond its ends, infinite values and zeros (if the
    /// scale lacks them, or `zero` gives them a meaning) have other colours.
    Sized {
        map: ColourMap,
        scale: Scale,
        zero: bool,
    },
}

impl Paint {
    /// The colours of a field with these values, those of the cells that are shown.
    pub(crate) fn of(field: Field, values: &[f64]) -> Self {
        let finite = || values.iter().copied().filter(|v| v.is_finite());
        let largest = finite().fold(0.0, f64::max);
        match field.spread() {
            _ if matches!(field.storage(), Storage::Kind | Storage::Few) => Self::Kinds(field),
            Spread::Counts => Self::Counts,
            Spread::AboutZero { stable } => {
                Self::two_sided(symmetric_range(finite().map(|v| stable * v)), stable)
            }
            Spread::BetterBelow => {
                let range = rounded_up(quantile(finite().map(f64::abs), TOLD_APART));
                Self::two_sided(range, -1.0)
            }
            Spread::Relaxation => {
                let positive = finite().filter(|v| *v > 0.0);
                let shortest = positive.fold(f64::INFINITY, f64::min);
                if !shortest.is_finite() {
                    return Self::sized(Scale::linear(0.0, 1.0));
                }
                let longest = largest.clamp(1.5 * shortest, LONGEST_RELAXATION * shortest);
                Self::sized(Scale::logarithmic(shortest, rounded_up(longest)))
            }
            Spread::LongTail => {
                let longest = rounded_up(quantile(finite(), TOLD_APART));
                Self::sized(Scale::linear(0.0, longest))
            }
            Spread::Decades => {
                let scale = Scale::over_decades(finite(), DECADES);
                Self::from_above_zero(scale.unwrap_or(Scale::linear(0.0, 1.0)))
            }
            Spread::RelativeError => Self::two_sided(1.0, 1.0),
            Spread::Magnitudes => {
                let positive = || finite().filter(|v| *v > 0.0);
                let smallest = positive().fold(f64::INFINITY, f64::min);
                let most = match quantile(positive(), TOLD_APART) {
                    most if largest <= FEW_TIMES * most => largest,
                    most => most,
                };
                let most = rounded_up(most);
                Self::from_above_zero(match smallest.max(most / LARGEST_RATIO) {
                    least if least < 0.1 * most => Scale::logarithmic(least, most),
                    _ => Scale::linear(0.0, most),
                })
            }
            Spread::FromZero => Self::sized(Scale::linear(0.0, rounded_up(largest))),
        }
    }

    fn two_sided(range: f64, stable: f64) -> Self {
        Self::TwoSided {
            map: ColourMap::BrBG,
            low: -range,
            high: range,
            stable,
        }
    }

    fn sized(scale: Scale) -> Self {
        Self::Sized {
            map: ColourMap::Viridis,
            scale,
            zero: false,
        }
    }

    fn from_above_zero(scale: Scale) -> Self {
        Self::Sized {
            map: ColourMap::Viridis,
            scale,
            zero: true,
        }
    }

    /// The colours of single values.
    pub(crate) fn shades(&self) -> Shades {
        match *self {
            Self::Counts => Shades::Counts,
            Self::Kinds(field) => Shades::Kinds(field),
            Self::TwoSided {
                map,
                low,
                high,
                stable,
            } => Shades::Steps(Steps::two_sided(map, (low, high), stable)),
            Self::Sized { map, scale, zero } => Shades::Steps(Steps::sized(map, scale, zero)),
        }
    }

    /// The scale of the bar; none where a list is enough.
    pub(crate) fn scale(&self) -> Option<Scale> {
        match *self {
            Self::Counts | Self::Kinds(_) => None,
            Self::TwoSided { low, high, .. } => Some(Scale::linear(low, high)),
            Self::Sized { scale, .. } => Some(scale),
        }
    }

    /// Entries for values beyond the ends of the bar.
    pub(crate) fn beyond(&self, field: Field, values: &[f64]) -> Vec<Entry> {
        let shades = self.shades();
        let mut entries = Vec::new();
        let mut entry = |value: f64, text: String| {
            entries.push(Entry {
                mark: Mark::Colour(shades.colour(value)),
                text,
                formula: true,
            });
        };
        let (low, high, apart) = match *self {
            Self::Counts | Self::Kinds(_) => return entries,
            Self::TwoSided { low, high, .. } => (low, high, false),
            Self::Sized { scale, zero, .. } => {
                let zero = zero || scale.is_logarithmic();
                (scale.value(0.0), scale.value(1.0), zero)
            }
        };
        let there = |which: &dyn Fn(f64) -> bool| values.iter().copied().find(|v| which(*v));
        let counted = |v: f64| v.is_finite() && !(apart && v == 0.0);
        if let Some(more) = there(&|v| above(v, high) && counted(v)) {
            entry(more, format!("above {}", number(high)));
        }
        if let Some(less) = there(&|v| below(v, low) && counted(v)) {
            entry(less, format!("below {}", number(low)));
        }
        if apart && there(&|v| v == 0.0).is_some() {
            entry(0.0, format!("0{}", at_zero(field)));
        }
        for infinite in [f64::INFINITY, f64::NEG_INFINITY] {
            if values.contains(&infinite) {
                let unstable = field.tells_stable(infinite) == Some(false);
                let meaning = match self {
                    Self::Sized { .. } if unstable => ", unstable",
                    _ => "",
                };
                entry(infinite, format!("{}{meaning}", number(infinite)));
            }
        }
        entries
    }
}

/// The colour of every value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Shades {
    /// Of numbers of unstable roots.
    Counts,
    /// Of kinds of a field, or of small counts.
    Kinds(Field),
    /// Of numbers on a scale.
    Steps(Steps),
}

impl Shades {
    /// The colour of a value.
    pub(crate) fn colour(&self, value: f64) -> Rgb {
        match self {
            Self::Counts => colour::of_count(value),
            Self::Kinds(field) => colour::of_kind(*field, value),
            Self::Steps(steps) => steps.colour(value),
        }
    }
}

/// The meaning of a velocity of 0.
pub(crate) fn at_zero(field: Field) -> &'static str {
    match field {
        Field::Vc | Field::VcUpper | Field::VcOverVtilde => ": stick-slip never lasts",
        Field::VSmooth => ": smooth at any v_0",
        _ => "",
    }
}

/// The range of two-sided colours: the largest value of a stable cell, where stable is positive.
/// Far outside the stable region the distance to it matters less. At least half of the largest
/// magnitude, so that most other values stay in range; 1 where there is no value.
fn symmetric_range(values: impl Iterator<Item = f64>) -> f64 {
    let (mut stable, mut largest) = (0.0, 0.0);
    for value in values {
        stable = f64::max(stable, value);
        largest = f64::max(largest, value.abs());
    }
    rounded_up(f64::max(stable, 0.5 * largest))
}

/// The value below which the share `part` of the values lies; 0 where there are none.
fn quantile(values: impl Iterator<Item = f64>, part: f64) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let place = (part * values.len() as f64) as usize;
    if place >= values.len() {
        return 0.0;
    }
    *values.select_nth_unstable_by(place, f64::total_cmp).1
}

/// A positive value rounded up to two digits; 1 for 0.
fn rounded_up(value: f64) -> f64 {
    if value == 0.0 {
        return 1.0;
    }
    let unit = power(10.0, decimal_exponent(value) - 1);
    (value / unit - 1e-9).ceil() * unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_values_do_not_stretch_the_range() {
        assert_eq!(symmetric_range([1.5, -2.0].into_iter()), 1.5);
        assert_eq!(symmetric_range([0.001, -2.0].into_iter()), 1.0);
        assert!((rounded_up(2.412) - 2.5).abs() < 1e-12);
        assert_eq!(symmetric_range(std::iter::empty()), 1.0);
        assert_eq!(quantile((0..100).map(f64::from), 0.96), 96.0);
        assert_eq!(quantile(std::iter::empty(), 0.96), 0.0);
    }
}
