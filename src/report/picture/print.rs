//! A picture as it is printed: how wide it is, how fine, and how large its text.

use super::font;

/// The font size of numbers and notes in units, see [`Print::unit`].
pub(super) const SMALL: f64 = 26.0;

/// Points of print in an inch, and millimetres.
const POINTS: f64 = 72.0;
const MILLIMETRES: f64 = 25.4;
/// How a picture is printed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Print {
    /// Its width in millimetres.
    pub width: f64,
    /// Pixels in an inch.
    pub dpi: f64,
    /// The size of its numbers and notes in points; titles are larger by a few parts in ten.
    pub font: f64,
}

impl Default for Print {
    /// A column of a journal.
    fn default() -> Self {
        Self {
            width: 86.0,
            dpi: 300.0,
            font: 7.0,
        }
    }
}

impl Print {
    /// Width and height in pixels, in the shape of `size`.
    pub(super) fn pixels(&self, size: (u32, u32)) -> (u32, u32) {
        let width = self.width / MILLIMETRES * self.dpi;
        let height = width * f64::from(size.1) / f64::from(size.0);
        (width.round() as u32, height.round() as u32)
    }

    /// Pixels of a unit of text.
    pub(super) fn unit(&self) -> f64 {
        self.font * font::HEIGHT * self.dpi / POINTS / SMALL
    }

    /// Width and height in millimetres of a picture of so many pixels.
    pub(super) fn millimetres(&self, (width, height): (u32, u32)) -> [f64; 2] {
        let ratio = f64::from(height) / f64::from(width);
        [self.width, self.width * ratio]
    }

    /// Points of a pixel of a picture that is so many wide.
    pub(super) fn points(&self, width: u32) -> f64 {
        self.width / MILLIMETRES * POINTS / f64::from(width)
    }

    /// Pixels in a metre.
    pub(super) fn per_metre(&self) -> u32 {
        (self.dpi / MILLIMETRES * 1000.0).round() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_as_wide_as_asked_and_its_text_as_large() {
        let print = Print::default();
        let size = print.pixels((1600, 1100));
        assert_eq!(size, (1016, 698));
        let [width, height] = print.millimetres(size);
        assert!(width == 86.0 && (height - 59.1).abs() < 0.1, "{height}");
        // Small text, in points.
        let text = print.unit() * SMALL * print.points(size.0) / font::HEIGHT;
        assert!((text - 7.0).abs() < 0.01, "{text}");
        assert_eq!(print.per_metre(), 11_811);
    }
}
