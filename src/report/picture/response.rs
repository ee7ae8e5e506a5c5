//! The response of a system in time, with the value at which it settles and the band around it.

use super::page;
use super::scene::Scene;
use super::stack::{Row, Stack};
use super::text::{Rich, suffix};
use crate::linear::response::{Response, SETTLED};
use crate::meaning::colour::{INK, SOFT_INK};
use crate::meaning::scale::Scale;

/// Widths of the response and of the lines of the band, and their dashes.
const WIDTH: f64 = 2.6;
const THIN: f64 = 1.2;
const DASH: (f64, f64) = (9.0, 7.0);
/// Space above and below the response, as a share of its range.
const ROOM: f64 = 0.06;

/// A response with what stands beside it.
#[derive(Debug, Clone, Copy)]
pub struct ResponsePicture<'a> {
    /// The response.
    pub of: &'a Response,
    /// The unit of times; empty for none.
    pub time: &'a str,
    /// What stands above the picture.
    pub title: &'a str,
}

/// Draws a response.
pub(super) fn draw(picture: &ResponsePicture, scene: &mut Scene) {
    let u = scene.unit();
    let Response { t, y, measures, .. } = picture.of;
    let body = page::head(scene, picture.title, &[]);
    let aim = measures.final_value;
    let all = y.iter().copied().chain([0.0, measures.peak]).chain(aim);
    let (from, to) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| {
        (a.min(value), b.max(value))
    });
    let room = ROOM * (to - from).max(f64::MIN_POSITIVE);
    let end = t.last().copied().unwrap_or(1.0);
    let row = Row {
        scale: Scale::linear(from - room, to + room),
        title: vec![Rich::plain("response y")],
    };
    let below = format!("time t{}", suffix(picture.time, "  (", ")"));
    let x = Scale::linear(0.0, end);
    let stack = Stack::new(scene, body, x, Rich::plain(&below), &[row]);
    stack.draw_grid(scene);
    if let Some(panel) = stack.panels.first() {
        if let Some(aim) = aim {
            let band = SETTLED * if aim == 0.0 { measures.peak } else { aim };
            for level in [aim - band, aim + band] {
                let ends = [panel.at(0.0, level), panel.at(end, level)];
                scene.dashed(&ends, SOFT_INK, THIN * u, DASH);
            }
        }
        let points = t.iter().zip(y).map(|(t, y)| panel.at(*t, *y)).collect();
        scene.path(points, INK, WIDTH * u);
    }
    stack.draw_axes(scene);
}
