//! The label of a curve.

use super::curve_labels::Place;
use super::page::Area;
use super::scene::{Align, Scene};
use super::text::Rich;
use crate::meaning::colour::Rgb;

/// Width of thin lines, such as one that leads to a label.
pub(super) const THIN: f64 = 1.3;

/// A label with its place.
pub(super) struct Label<'a> {
    /// What it says.
    pub text: &'a Rich,
    /// Its colour.
    pub colour: Rgb,
    /// Size of its font.
    pub size: f64,
    /// Where it stands.
    pub place: Place,
}

impl Label<'_> {
    /// The areas of its text and of the line that leads to it.
    pub(super) fn areas(&self) -> Vec<Area> {
        let line = self.place.line.map(|[a, b]| Area {
            left: a.0.min(b.0),
            top: a.1.min(b.1),
            right: a.0.max(b.0),
            bottom: a.1.max(b.1),
        });
        [self.area()].into_iter().chain(line).collect()
    }

    /// The area of its text, with a little room.
    fn area(&self) -> Area {
        let (x, y) = self.place.at;
        let (half, height) = (
            0.5 * self.text.width(self.size) + 0.2 * self.size,
            0.55 * self.size,
        );
        Area {
            left: x - half,
            top: y - height,
            right: x + half,
            bottom: y + height,
        }
    }

    /// Whether the frame around an area cuts it.
    pub(super) fn is_cut(&self, by: Area) -> bool {
        let text = self.area();
        let within = text.left > by.left && text.right < by.right;
        text.overlaps(&by) && !(within && text.top > by.top && text.bottom < by.bottom)
    }

    /// Draws it, with the line that leads to it.
    pub(super) fn draw(&self, scene: &mut Scene) {
        let (x, y) = self.place.at;
        if let Some(line) = self.place.line {
            scene.path(line.to_vec(), self.colour, THIN * scene.unit());
        }
        let at = (x, y + 0.34 * self.size);
        scene.text(at, Align::Middle, self.text, self.size, self.colour);
    }
}
