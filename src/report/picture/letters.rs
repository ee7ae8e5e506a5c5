//! Where the texts and lines of a scene are.

use super::font;
use super::page::Area;
use super::scene::{Mark, Point, Scene};

/// Height of capital letters, and depth of a comma, relative to the font.
const CAPITALS: f64 = 0.62;
const DEPTH: f64 = 0.04;

/// What is written, with the area of its letters.
pub(super) fn texts(scene: &Scene) -> impl Iterator<Item = (&str, Area)> {
    scene.marks.iter().filter_map(|mark| match mark {
        &Mark::Text {
            at,
            size,
            ref text,
            upward,
            ..
        } => Some((text.as_str(), area_of(at, (text, size), upward))),
        _ => None,
    })
}

fn area_of((x, y): Point, (text, size): (&str, f64), upward: bool) -> Area {
    let (width, up, down) = (font::width(text, size), CAPITALS * size, DEPTH * size);
    match upward {
        true => Area {
            left: x - up,
            top: y - width,
            right: x + down,
            bottom: y,
        },
        false => Area {
            left: x,
            top: y - up,
            right: x + width,
            bottom: y + down,
        },
    }
}

/// The lines that are drawn, but rulers.
pub(super) fn paths(scene: &Scene) -> impl Iterator<Item = &[Point]> {
    scene.marks.iter().filter_map(|mark| match mark {
        Mark::Path { points, .. } => Some(&points[..]),
        _ => None,
    })
}
