//! The scale of the values that lines show.

use super::error::PictureError;
use super::options::PictureOptions;
use super::paint::logarithmic;
use crate::meaning::paint::{DECADES, at_zero};
use crate::meaning::scale::Scale;
use crate::setting::Field;
use crate::setting::field::{Spread, Storage};

/// The largest relative error on the scale.
const LARGEST_ERROR: f64 = 1.0;
/// Factor by which a logarithmic scale extends beyond its values.
const BEYOND: f64 = 1.3;

/// The scale of the finite values of a field, as requested.
///
/// # Errors
/// When an option does not suit the field or its values.
pub(super) fn asked(
    field: Field,
    values: &[f64],
    options: &PictureOptions,
) -> Result<Scale, PictureError> {
    if options.colour_map.is_some() {
        return Err(PictureError::NotForThis {
            option: "--colour-map",
            why: "it shows lines, not cells",
        });
    }
    if field.storage() != Storage::Real {
        options.about_values("each of its values has a place of its own")?;
        return Ok(by_default(field, values));
    }
    let scale = match options.log {
        true => {
            let zero = !at_zero(field).is_empty();
            let scale = logarithmic(field, zero, values)?;
            Scale::logarithmic(scale.value(0.0) / BEYOND, scale.value(1.0) * BEYOND)
        }
        false => by_default(field, values),
    };
    Ok(match options.range {
        Some((low, high)) if low > 0.0 && scale.is_logarithmic() => Scale::logarithmic(low, high),
        Some((low, high)) => Scale::linear(low, high),
        None => scale,
    })
}

/// The default scale of these values, all of which are finite.
pub(super) fn by_default(field: Field, values: &[f64]) -> Scale {
    let finite = || values.iter().copied();
    let (mut low, mut high) = (finite().fold(0.0, f64::min), finite().fold(0.0, f64::max));
    match field.spread() {
        Spread::Decades => {
            if let Some(scale) = Scale::over_decades(finite(), DECADES) {
                return scale;
            }
        }
        Spread::RelativeError => {
            (low, high) = (low.max(-LARGEST_ERROR), high.min(LARGEST_ERROR));
        }
        _ => {}
    }
    if let Some(kinds) = field.kinds() {
        let most = kinds.len() as f64;
        return Scale::linear(-0.5, most - 0.5).with_smallest_step(1.0);
    }
    if field.storage() == Storage::Few {
        return Scale::linear(-0.5, high + 0.5).with_smallest_step(1.0);
    }
    if field.storage() == Storage::Count {
        let high = f64::max(high, 2.0);
        let step = smallest_step(finite());
        return Scale::linear(-0.04 * high, 1.06 * high).with_smallest_step(step);
    }
    let span = if high > low { high - low } else { 1.0 };
    Scale::linear(low - 0.05 * span, high + 0.05 * span)
}

/// The smallest step between ticks on a scale of these numbers of roots, which are even where roots
/// cross the axis in pairs only.
pub(super) fn smallest_step(counts: impl IntoIterator<Item = f64>) -> f64 {
    let odd = |n: f64| n % 2.0 != 0.0;
    if counts.into_iter().any(odd) {
        1.0
    } else {
        2.0
    }
}
