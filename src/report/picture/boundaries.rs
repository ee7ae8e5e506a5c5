//! The boundaries of stability in one plane, a colour for each value of the axis outside it.

use super::colour::{self, INK, PAPER, Rgb};
use super::curve_labels::{Curves, Place, places};
use super::degrees::Degrees;
use super::legend::{Legend, Swatch};
use super::page::{self, SMALL};
use super::panels::{Panel, Panels, Words};
use super::scale::Scale;
use super::scene::{Align, Mark, Point, Scene};
use super::stable_area::regions;
use super::text::{Rich, axis_title, number, suffix};
use super::view::View;
use super::{PictureError, PictureOptions};
use crate::linear::curves::{CurvePiece, StableSide};
use crate::store::MapFile;
use crate::store::map_file::{MapCurve, Plane};
use crate::sweep::Field;

const WIDTH: f64 = 3.0;
const THIN: f64 = 1.3;
const SHADE: f64 = 0.13;
/// More than this many cells along an axis are not read to learn what holds where no curve lies.
const MOST_CELLS: usize = 600;

/// The curves of one value of the outer axis.
struct Family<'a> {
    colour: Rgb,
    short: Option<Rich>,
    bounding: Vec<&'a CurvePiece>,
    others: Vec<&'a CurvePiece>,
    /// Curves of a degree of stability above zero.
    decaying: Vec<&'a MapCurve>,
    index: &'a [usize],
}

/// Draws the boundaries; `curves` are all curves of the map.
pub(super) fn draw(
    map: &MapFile,
    view: &View,
    y: usize,
    curves: &[MapCurve],
    options: &PictureOptions,
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let families = families(map, view, curves);
    let title = super::title(map, options);
    let title = title.unwrap_or_else(|| "Boundaries of stable sliding".into());
    let mut body = page::head(scene, &title, &view.notes(map));
    let u = scene.unit();
    let degrees = Degrees::of(map, curves);
    let legend = legend(map, view, &families, &degrees);
    let column = body.cut_right(legend.width(u), 30.0 * u);
    let (x_axis, y_axis) = (&map.axes()[view.x], &map.axes()[y]);
    let scales = (
        Scale::between(&x_axis.values),
        Scale::between(&y_axis.values),
    );
    let words = Words {
        x: axis_title(x_axis),
        y: axis_title(y_axis),
        headings: vec![None],
    };
    let panels = Panels::new(scene, body, scales, words);
    panels.draw_grid(scene);
    let Some(panel) = panels.list.first() else {
        return Ok(());
    };
    for family in &families {
        shade(map, view, y, family, panel, scene)?;
    }
    for family in &families {
        for piece in &family.others {
            let colour = colour::pale(family.colour, 0.45);
            scene.path(traced(panel, piece), colour, THIN * u);
        }
    }
    for family in &families {
        for curve in &family.decaying {
            let points = traced(panel, &curve.piece);
            degrees.draw(curve.degree_of_stability, &points, family.colour, scene);
        }
        for piece in &family.bounding {
            scene.path(traced(panel, piece), family.colour, WIDTH * u);
        }
    }
    label(&families, panel, scene);
    panels.draw_axes(scene);
    let top = panel.area.top;
    legend.draw(scene, page::Area { top, ..column });
    Ok(())
}

fn families<'a>(map: &MapFile, view: &'a View, curves: &'a [MapCurve]) -> Vec<Family<'a>> {
    let several = view.panels.len() > 1;
    let family = |(i, index): (usize, &'a Vec<usize>)| {
        let outer = view.outer_values(map, index);
        let of_family = || curves.iter().filter(|c| c.outer == outer);
        let crossing = |c: &&MapCurve| c.degree_of_stability == 0.0;
        let here = || of_family().filter(crossing).map(|c| &c.piece);
        let bounds = |piece: &&CurvePiece| piece.stable_side != StableSide::Neither;
        let value = view.along.map(|axis| &map.axes()[axis]);
        Family {
            colour: colour::of_line(i, view.panels.len()),
            short: view
                .along
                .zip(value)
                .map(|(axis, a)| Rich::plain(&number(a.values[index[axis]]))),
            bounding: here().filter(bounds).collect(),
            // With several values at once they would hide what bounds the stable regions.
            others: here().filter(|p| !several && !bounds(p)).collect(),
            decaying: of_family().filter(|c| !crossing(c)).collect(),
            index,
        }
    };
    view.panels.iter().enumerate().map(family).collect()
}

fn traced(panel: &Panel, piece: &CurvePiece) -> Vec<Point> {
    piece
        .vertices
        .iter()
        .map(|v| panel.at(v.p, v.tau))
        .collect()
}

fn shade(
    map: &MapFile,
    view: &View,
    y: usize,
    family: &Family,
    panel: &Panel,
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let told = match map.stability_field() {
        Some(field) => Some((
            field,
            map.plane(field, family.index, (y, view.x), MOST_CELLS)?,
        )),
        None => None,
    };
    let stable = |p: f64| {
        told.as_ref()
            .is_some_and(|(field, plane)| stable_throughout(plane, *field, p))
    };
    for slices in regions(panel, &family.bounding, stable) {
        scene.marks.push(Mark::Band {
            slices,
            colour: family.colour,
            opacity: SHADE,
        });
    }
    Ok(())
}

/// Whether the column of cells nearest to `p`, in which no curve lies, is stable: most of its cells
/// say so.
fn stable_throughout(plane: &Plane, field: Field, p: f64) -> bool {
    let distances = plane.columns.iter().map(|c| (c - p).abs()).enumerate();
    let Some((column, _)) = distances.min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return false;
    };
    let cells = plane.cells.iter().skip(column).step_by(plane.columns.len());
    let stable = cells
        .filter(|&&v| field.tells_stable(v) == Some(true))
        .count();
    2 * stable > plane.rows.len()
}

fn label(families: &[Family], panel: &Panel, scene: &mut Scene) {
    let u = scene.unit();
    let size = 0.92 * SMALL * u;
    let labelled: Vec<(&Family, &Rich)> = families
        .iter()
        .filter_map(|family| Some((family, family.short.as_ref()?)))
        .collect();
    let sets: Vec<(Curves, (f64, f64))> = labelled
        .iter()
        .map(|(family, text)| {
            let curves = family.bounding.iter().map(|piece| traced(panel, piece));
            (curves.collect(), (text.width(size), 0.8 * size))
        })
        .collect();
    for ((family, text), place) in labelled.iter().zip(places(&sets, panel.area)) {
        let Some(Place { at: (x, y), from }) = place else {
            continue;
        };
        let colour = colour::darker(family.colour);
        if let Some(from) = from {
            scene.path(vec![from, (x, y)], colour, THIN * u);
        }
        let (half, height) = (0.5 * text.width(size) + 4.0 * u, 0.55 * size);
        scene.marks.push(Mark::Rect {
            from: (x - half, y - height),
            to: (x + half, y + height),
            colour: PAPER,
            opacity: 0.85,
        });
        scene.text((x, y + 0.34 * size), Align::Middle, text, size, colour);
    }
}

fn legend(map: &MapFile, view: &View, families: &[Family], degrees: &Degrees) -> Legend {
    let tint = |family: &Family| Some(colour::pale(family.colour, 2.0 * SHADE));
    let mut entries: Vec<(Swatch, Rich)> = Vec::new();
    let mut heading = Vec::new();
    if let Some(axis) = view.along.map(|axis| &map.axes()[axis]) {
        heading = vec![
            Rich::plain("stable inside,"),
            Rich::plain("at ")
                .and_symbol(axis.parameter)
                .and(&suffix(&axis.unit, " (", ")"))
                .and(" ="),
        ];
        for family in families {
            let swatch = Swatch::Line(family.colour, WIDTH, tint(family));
            let mut text = family.short.clone().unwrap_or_default();
            if family.bounding.is_empty() {
                text = text.and("  (none)");
            }
            entries.push((swatch, text));
        }
    } else if let Some(family) = families.first() {
        let area = tint(family).unwrap_or(PAPER);
        entries.push((Swatch::Box(area), Rich::plain("stable")));
        let bound = Swatch::Line(family.colour, WIDTH, None);
        entries.push((bound, Rich::plain("its boundary")));
        if !family.others.is_empty() {
            let other = Swatch::Line(colour::pale(family.colour, 0.45), THIN, None);
            entries.push((other, Rich::plain("other crossings")));
        }
    }
    let colour = match families {
        [family] => family.colour,
        _ => INK,
    };
    entries.extend(degrees.entries(colour));
    Legend { heading, entries }
}
