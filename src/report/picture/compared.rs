//! Shares of starts that reach sliding, by control by the return map and by delayed feedback: one
//! panel for each kind of starts.

use super::legend::{Legend, Swatch};
use super::page;
use super::scene::Scene;
use super::stack::{Row, Stack};
use super::text::{Rich, suffix};
use crate::explore::comparison::{Compared, Comparison, ReachedShare};
use crate::meaning::colour::{self, INK, Rgb};
use crate::meaning::scale::Scale;
use crate::text::Shown;

/// Widths of lines and of error bars, and the diameter of dots.
const WIDTH: f64 = 2.6;
const BAR: f64 = 1.6;
const DOT: f64 = 9.0;

/// A comparison with the unit of what varies.
#[derive(Debug, Clone, Copy)]
pub struct ComparedPicture<'a> {
    /// The shares.
    pub of: &'a Comparison,
    /// The unit of the values; empty for none.
    pub unit: &'a str,
    /// The unit of times; empty for none.
    pub time: &'a str,
    /// What stands above the picture.
    pub title: &'a str,
}

/// The kinds of starts, in words, with what they tell.
type Kind = (&'static str, fn(&Compared) -> &[ReachedShare]);
const KINDS: [Kind; 2] = [
    ("from near sliding", |of| &of.near),
    ("from stick-slip", |of| &of.stick_slip),
];

/// Draws a comparison.
pub(super) fn draw(picture: &ComparedPicture, scene: &mut Scene) {
    let u = scene.unit();
    let of = picture.of;
    let mut body = page::head(scene, picture.title, &[]);
    let legend = legend(picture);
    let column = body.cut_right(legend.width(u), 30.0 * u);
    let values = of.methods.iter().flat_map(|of| &of.near);
    let values: Vec<f64> = values.map(|share| share.value).collect();
    let (from, to) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(*x), b.max(*x))
        });
    let room = 0.03 * (to - from).max(1e-3 * to.abs()).max(f64::MIN_POSITIVE);
    let x = Scale::linear(from - room, to + room);
    let rows = KINDS.map(|(name, _)| Row {
        scale: Scale::linear(-4.0, 104.0),
        title: vec![Rich::plain(name), Rich::plain("%")],
    });
    let below = match of.over {
        "amplitude" => "largest change of the load",
        "slope" => "error of the model's slope of friction",
        _ => "noise of a reading",
    };
    let below = format!("{below}{}", suffix(picture.unit, "  (", ")"));
    let stack = Stack::new(scene, body, x, Rich::plain(&below), &rows);
    stack.draw_grid(scene);
    for (panel, (_, shares)) in stack.panels.iter().zip(KINDS) {
        for (i, method) in of.methods.iter().enumerate() {
            let colour = colour_of(i, of.methods.len());
            let known = shares(method).iter().filter(|of| of.share.is_finite());
            let points: Vec<_> = known
                .clone()
                .map(|of| panel.at(of.value, 100.0 * of.share))
                .collect();
            for of in known {
                let ends = [of.share - of.within(), of.share + of.within()];
                let ends = ends.map(|end| panel.at(of.value, 100.0 * end.clamp(0.0, 1.0)));
                scene.path(ends.to_vec(), colour, BAR * u);
                scene.dot(panel.at(of.value, 100.0 * of.share), colour, DOT * u);
            }
            scene.path(points, colour, WIDTH * u);
        }
    }
    if let Some(panel) = stack.panels.first() {
        let top = panel.area.top;
        legend.draw(scene, page::Area { top, ..column });
    }
    stack.draw_axes(scene);
}

/// Delayed feedback in ink, sample times from dark to light.
fn colour_of(method: usize, methods: usize) -> Rgb {
    match method {
        0 => INK,
        i => colour::of_line(i - 1, methods),
    }
}

fn legend(picture: &ComparedPicture) -> Legend {
    let methods = &picture.of.methods;
    let entry = |(i, of): (usize, &Compared)| {
        let name = match (of.method, of.sample_time) {
            ("return-map", Some(h)) => {
                format!(
                    "return map, h = {}{}",
                    Shown(h),
                    suffix(picture.time, " ", "")
                )
            }
            _ => "delayed feedback".to_owned(),
        };
        let line = Swatch::Line(colour_of(i, methods.len()), WIDTH, None);
        (line, Rich::plain(&name))
    };
    Legend {
        heading: vec![Rich::plain("starts that reach"), Rich::plain("sliding, by")],
        entries: methods.iter().enumerate().map(entry).collect(),
    }
}
