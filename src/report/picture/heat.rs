//! Heat maps of a field: a panel for each value of the axis outside the plane.

use super::PictureError;
use super::colour::{self, INK, NO_VALUE, Rgb, STABLE, UNSTABLE};
use super::degrees::Degrees;
use super::legend::{Bar, Legend, Swatch};
use super::page::{self, Area};
use super::panels::{Panel, Panels, Words};
use super::scale::Scale;
use super::scene::{Mark, Scene};
use super::text::{Rich, axis_title, decimal_exponent, field_note, number, suffix};
use super::view::View;
use crate::linear::curves::StableSide;
use crate::store::MapFile;
use crate::store::map_file::{MapCurve, Plane};
use crate::sweep::Field;

const BOUNDARY_WIDTH: f64 = 1.8;
/// Space for the colours' meanings, to begin with.
const GAP: f64 = 34.0;

/// Draws a heat map of `field` with at most `most` cells each way in all panels together, and the curves of `curves` that
/// bound the stable region.
pub fn draw(
    map: &MapFile,
    view: &View,
    y: usize,
    field: Field,
    curves: &[MapCurve],
    most: usize,
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let unit = map.field_unit(field);
    let title = super::title(map, "Stability of sliding");
    let mut notes = vec![field_note(field, &unit)];
    notes.extend(view.notes(map));
    let mut body = page::head(scene, &title, &notes);
    let across = (view.panels.len() as f64).sqrt().ceil() as usize;
    let most = (most / across).max(100);
    let planes: Vec<Plane> = view
        .panels
        .iter()
        .map(|panel| map.plane(field, panel, (y, view.x), most))
        .collect::<Result<_, _>>()?;
    let degrees = Degrees::of(map, curves);
    let key = Key::new(field, &unit, &planes, !curves.is_empty()).with(degrees.entries(INK));
    let column = body.cut_right(key.width(scene.unit()), GAP * scene.unit());
    let (x_axis, y_axis) = (&map.axes()[view.x], &map.axes()[y]);
    let scales = (Scale::around(&x_axis.values), Scale::around(&y_axis.values));
    let words = Words {
        x: axis_title(x_axis),
        y: axis_title(y_axis),
        headings: view.panels.iter().map(|p| view.heading(map, p)).collect(),
    };
    let panels = Panels::new(scene, body, scales, words);
    for ((panel, plane), index) in panels.panels.iter().zip(&planes).zip(&view.panels) {
        scene
            .marks
            .push(cells(panel, plane, |value| key.colour(value)));
        let outer = view.outer_values(map, index);
        for curve in curves.iter().filter(|c| c.outer == outer) {
            draw_curve(panel, curve, &degrees, scene);
        }
    }
    panels.draw_axes(scene);
    if let (Some(first), Some(last)) = (panels.panels.first(), panels.panels.last()) {
        let (top, bottom) = (first.area.top, last.area.bottom);
        key.draw(
            scene,
            Area {
                top,
                bottom,
                ..column
            },
        );
    }
    Ok(())
}

fn draw_curve(panel: &Panel, curve: &MapCurve, degrees: &Degrees, scene: &mut Scene) {
    if curve.piece.stable_side != StableSide::Neither {
        let vertices = curve.piece.vertices.iter();
        let points: Vec<_> = vertices.map(|v| panel.at(v.p, v.tau)).collect();
        if curve.degree_of_stability > 0.0 {
            degrees.draw(curve.degree_of_stability, &points, INK, scene);
        } else {
            scene.path(points, INK, BOUNDARY_WIDTH * scene.unit());
        }
    }
}

fn cells(panel: &Panel, plane: &Plane, colour: impl Fn(f64) -> Rgb) -> Mark {
    let columns = panel.x.filling_edges(&plane.columns);
    let rows = panel.y.filling_edges(&plane.rows);
    Mark::Cells {
        columns: columns.into_iter().map(|x| panel.across(x)).collect(),
        rows: rows.into_iter().map(|y| panel.up(y)).collect(),
        colours: plane.cells.iter().map(|&value| colour(value)).collect(),
    }
}

/// What the colours mean.
enum Key {
    Counts(Legend),
    Margins {
        heading: Vec<Rich>,
        range: f64,
        legend: Legend,
    },
}

impl Key {
    fn new(field: Field, unit: &str, planes: &[Plane], curves: bool) -> Self {
        let values = || planes.iter().flat_map(|plane| plane.cells.iter().copied());
        let mut below = Vec::new();
        if values().any(f64::is_nan) {
            below.push((Swatch::Box(NO_VALUE), Rich::plain("no value")));
        }
        if curves {
            let swatch = Swatch::Line(INK, BOUNDARY_WIDTH, None);
            below.push((swatch, Rich::plain("boundary")));
        }
        match field {
            Field::NUnstable => {
                let most = values().filter(|v| v.is_finite()).fold(0.0, f64::max);
                let mut entries = vec![(Swatch::Box(STABLE), Rich::plain("0, stable"))];
                for (i, colour) in UNSTABLE.into_iter().enumerate() {
                    let n = 2 * (i + 1);
                    let open = i + 1 == UNSTABLE.len() && most > n as f64;
                    let text = if open {
                        format!("{n} or more")
                    } else {
                        n.to_string()
                    };
                    if n as f64 <= most {
                        entries.push((Swatch::Box(colour), Rich::plain(&text)));
                    }
                }
                entries.extend(below);
                let heading = vec![Rich::plain("unstable roots")];
                Self::Counts(Legend { heading, entries })
            }
            Field::DelayMargin => {
                let heading = vec![
                    Rich::plain("delay margin").and(&suffix(unit, " (", ")")),
                    Rich::plain("stable above 0"),
                ];
                let range = symmetric_range(values());
                for sign in [1.0, -1.0] {
                    if values().any(|v| sign * v > range) {
                        let swatch = Swatch::Box(colour::diverging(sign * range, range));
                        let [end, beyond] = [range, f64::INFINITY].map(|v| number(sign * v));
                        below.push((swatch, Rich::plain(&format!("{end} to {beyond}"))));
                    }
                }
                Self::Margins {
                    heading,
                    range,
                    legend: Legend {
                        heading: Vec::new(),
                        entries: below,
                    },
                }
            }
        }
    }

    /// The key with more entries at the end of its list.
    fn with(mut self, more: Vec<(Swatch, Rich)>) -> Self {
        match &mut self {
            Self::Counts(legend) | Self::Margins { legend, .. } => legend.entries.extend(more),
        }
        self
    }

    fn colour(&self, value: f64) -> Rgb {
        match self {
            Self::Counts(_) => colour::of_count(value),
            Self::Margins { range, .. } => colour::diverging(value, *range),
        }
    }

    fn width(&self, u: f64) -> f64 {
        match self {
            Self::Counts(legend) => legend.width(u),
            Self::Margins {
                heading,
                range,
                legend,
            } => {
                let colour = |value| colour::diverging(value, *range);
                bar(heading, *range, &colour).width(u).max(legend.width(u))
            }
        }
    }

    fn draw(&self, scene: &mut Scene, area: Area) {
        match self {
            Self::Counts(legend) => legend.draw(scene, area),
            Self::Margins {
                heading,
                range,
                legend,
            } => {
                let colour = |value| colour::diverging(value, *range);
                let below = legend.height(scene.unit());
                let (bottom, top) = (area.bottom - below, area.bottom - below);
                bar(heading, *range, &colour).draw(scene, Area { bottom, ..area });
                legend.draw(scene, Area { top, ..area });
            }
        }
    }
}

fn bar<'a>(heading: &[Rich], range: f64, colour: &'a dyn Fn(f64) -> Rgb) -> Bar<'a> {
    Bar {
        heading: heading.to_vec(),
        scale: Scale::linear(-range, range),
        colour,
    }
}

/// The range of colours: the largest finite margin of a stable cell, since far outside the stable region the distance to it
/// matters less; but not so small that most of the others lie beyond. 1 where no margin is finite.
fn symmetric_range(values: impl Iterator<Item = f64>) -> f64 {
    let (mut stable, mut largest) = (0.0, 0.0);
    for value in values.filter(|v| v.is_finite()) {
        stable = f64::max(stable, value);
        largest = f64::max(largest, value.abs());
    }
    match largest {
        0.0 => 1.0,
        largest => two_digits(f64::max(stable, 0.25 * largest)),
    }
}

/// `value` rounded up to two digits.
fn two_digits(value: f64) -> f64 {
    let unit = 10f64.powi(decimal_exponent(value) - 1);
    (value / unit - 1e-9).ceil() * unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn infinite_margins_do_not_stretch_the_range() {
        let values = [1.5, f64::INFINITY, -2.0, f64::NAN, f64::NEG_INFINITY];
        assert_eq!(symmetric_range(values.into_iter()), 1.5);
        assert_eq!(symmetric_range([0.001, -2.0].into_iter()), 0.5);
        assert!((two_digits(2.412) - 2.5).abs() < 1e-12);
        assert_eq!(symmetric_range([f64::INFINITY].into_iter()), 1.0);
    }

    #[test]
    fn the_legend_lists_what_is_there() {
        let plane = Plane {
            rows: vec![0.0],
            columns: vec![0.0, 1.0, 2.0],
            cells: vec![0.0, 4.0, f64::NAN],
        };
        let Key::Counts(legend) = Key::new(Field::NUnstable, "1", &[plane], true) else {
            unreachable!()
        };
        let texts: Vec<Rich> = legend.entries.into_iter().map(|e| e.1).collect();
        assert_eq!(
            texts,
            ["0, stable", "2", "4", "no value", "boundary"].map(Rich::plain)
        );
    }
}
