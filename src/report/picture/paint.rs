//! Colours for the values of a field as options ask for them.

use super::error::PictureError;
use super::options::PictureOptions;
use crate::meaning::gradient::ColourMap;
use crate::meaning::paint::Paint;
use crate::meaning::scale::Scale;
use crate::setting::Field;

impl Paint {
    /// The colours of a field with these values, as requested.
    ///
    /// # Errors
    /// When an option does not suit the field or its values.
    pub(super) fn asked(
        field: Field,
        values: &[f64],
        options: &PictureOptions,
    ) -> Result<Self, PictureError> {
        let paint = Self::of(field, values);
        let paint = match options.colour_map {
            Some(map) => paint.with_map(map, field)?,
            None => paint,
        };
        let paint = match options.log {
            true => paint.logarithmic(field, values)?,
            false => paint,
        };
        match options.range {
            Some(range) => paint.within(range),
            None => Ok(paint),
        }
    }

    fn with_map(self, map: ColourMap, field: Field) -> Result<Self, PictureError> {
        let other = |why, two_sides| PictureError::OtherColourMap {
            map: map.name(),
            field: field.name(),
            why,
            fitting: ColourMap::names(two_sides),
        };
        match self {
            Self::TwoSided { .. } if !map.has_two_sides() => Err(other("has two sides", true)),
            Self::Sized { .. } if map.has_two_sides() => Err(other("has one side only", false)),
            Self::TwoSided {
                low, high, stable, ..
            } => Ok(Self::TwoSided {
                map,
                low,
                high,
                stable,
            }),
            Self::Sized { scale, zero, .. } => Ok(Self::Sized { map, scale, zero }),
            Self::Counts | Self::Kinds(_) => Err(no_scale("--colour-map")),
        }
    }

    fn logarithmic(self, field: Field, values: &[f64]) -> Result<Self, PictureError> {
        match self {
            Self::Counts | Self::Kinds(_) => Err(no_scale("--log")),
            Self::TwoSided { .. } => Err(PictureError::NotForThis {
                option: "--log",
                why: "its values have two sides, below and above 0",
            }),
            Self::Sized { map, zero, .. } => {
                let scale = logarithmic(field, zero, values)?;
                Ok(Self::Sized { map, scale, zero })
            }
        }
    }

    /// The same colours between two values.
    fn within(self, (low, high): (f64, f64)) -> Result<Self, PictureError> {
        match self {
            Self::Counts | Self::Kinds(_) => Err(no_scale("--range")),
            Self::TwoSided { map, stable, .. } => Ok(Self::TwoSided {
                map,
                low,
                high,
                stable,
            }),
            Self::Sized { map, scale, zero } => Ok(Self::Sized {
                map,
                scale: match scale.is_logarithmic() && low > 0.0 {
                    true => Scale::logarithmic(low, high),
                    false => Scale::linear(low, high),
                },
                zero,
            }),
        }
    }
}

fn no_scale(option: &'static str) -> PictureError {
    PictureError::NotForThis {
        option,
        why: "each of its values has a colour of its own",
    }
}

/// A logarithmic scale over all `values`. They may include 0 if `zero` has a colour of its own.
///
/// # Errors
/// When a value has no logarithm.
pub(super) fn logarithmic(field: Field, zero: bool, values: &[f64]) -> Result<Scale, PictureError> {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let has_none = |v: &f64| *v < 0.0 || (*v == 0.0 && !zero);
    if let Some(value) = finite().find(has_none) {
        let field = field.name();
        return Err(PictureError::NoLogarithm { field, value });
    }
    let positive = || finite().filter(|v| *v > 0.0);
    let (low, high) = (
        positive().fold(f64::INFINITY, f64::min),
        positive().fold(0.0, f64::max),
    );
    Ok(match low < high {
        true => Scale::logarithmic(low, high),
        // A single value, or none.
        false if high > 0.0 => Scale::logarithmic(0.5 * high, 2.0 * high),
        false => Scale::logarithmic(0.1, 1.0),
    })
}
