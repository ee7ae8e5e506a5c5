//! The font of all pictures: DejaVu Sans, part of the program, so that a picture is the same on
//! every machine.

use std::sync::OnceLock;

use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};

/// The families in CSS: where an SVG picture is opened without DejaVu Sans, a similar font is used.
const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";
/// Height from ascent to descent, in ems. Sizes of a scene count this height, as bitmaps do; SVG
/// and print count the em.
pub(super) const HEIGHT: f64 = 1.164;
/// The size at which texts are measured: widths come in whole pixels.
const MEASURED_AT: f64 = 1000.0;
/// Width of a letter relative to the font size, if the font cannot be used.
const TYPICAL_WIDTH: f64 = 0.55;

/// The font at a size in pixels; `None` if it cannot be used.
pub(super) fn sized(size: f64) -> Option<FontDesc<'static>> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let register = || register_font(FAMILY, FontStyle::Normal, dejavu::sans::regular()).is_ok();
    REGISTERED
        .get_or_init(register)
        .then(|| FontDesc::new(FontFamily::Name(FAMILY), size, FontStyle::Normal))
}

/// Width of a text in pixels.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let measured = sized(MEASURED_AT).and_then(|font| font.box_size(text).ok());
    match measured {
        Some((width, _)) => f64::from(width) * size / MEASURED_AT,
        None => TYPICAL_WIDTH * size * text.chars().count() as f64,
    }
}
