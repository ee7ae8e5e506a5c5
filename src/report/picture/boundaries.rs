//! The boundaries of stability in one plane, with a colour for each value of the axis outside it.

use super::choice;
use super::clip;
use super::curve_labels::{Curves, Place, places};
use super::degrees::Degrees;
use super::error::PictureError;
use super::inset::{self, Inset};
use super::kinds;
use super::legend::{Legend, Swatch};
use super::options::PictureOptions;
use super::page::{self, SMALL};
use super::panels::{Panel, Panels, Words, fitting_across, fitting_up};
use super::scene::{Align, Mark, Point, Scene};
use super::stable_area::{Region, regions, stable_throughout};
use super::symbols;
use super::text::{Rich, axis_title, number, suffix};
use super::view::View;
use crate::linear::curves::{CurvePiece, StableSide};
use crate::meaning::colour::{self, INK, PAPER, Rgb, SOFT_INK};
use crate::meaning::scale::Scale;
use crate::store::MapFile;
use crate::store::map_file::MapCurve;

const WIDTH: f64 = 3.0;
const THIN: f64 = 1.3;
const SHADE: f64 = 0.13;
/// Dashes of the lines that connect an inset, (length, gap).
const DASH: (f64, f64) = (6.0, 6.0);
/// The most cells per axis that are read to learn the stability where no curve lies.
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
    let title = choice::title(map, options);
    let title = title.unwrap_or_else(|| "Boundaries of stable sliding".into());
    let mut body = page::head(scene, &title, &options.subtitle(view.notes(map)));
    let u = scene.unit();
    let degrees = Degrees::of(map, curves);
    let symbols = symbols::of_view(map, view, y)?;
    let mut legend = legend(map, view, &families, &degrees);
    legend.entries.extend(symbols::entries(&symbols));
    let column = match options.no_legend {
        true => None,
        false => Some(body.cut_right(legend.width(u), 30.0 * u)),
    };
    let (x_axis, y_axis) = (&map.axes()[view.x], &map.axes()[y]);
    let scales = (
        Scale::between(&x_axis.values),
        Scale::between(&y_axis.values),
    );
    let headings = vec![None];
    let words = Words::of(axis_title(x_axis), axis_title(y_axis), headings);
    let panels = Panels::new(scene, body, scales, words);
    panels.check(scene)?;
    panels.draw_grid(scene);
    let Some(panel) = panels.list.first() else {
        return Ok(());
    };
    let mut areas = Vec::new();
    for family in &families {
        areas.push(stable_areas(map, view, y, family, panel)?);
    }
    draw_areas(&families, &areas, scene);
    draw_curves(&families, &degrees, panel, scene);
    let labels = label(&families, panel, scene);
    let regions: Vec<Region> = areas.iter().flatten().cloned().collect();
    if let Some(inset) = inset::of(panel, &regions, &labels, u) {
        link(&inset, scene);
        let panel = &inset.panel;
        let mut areas = Vec::new();
        for family in &families {
            areas.push(stable_areas(map, view, y, family, panel)?);
        }
        draw_areas(&families, &areas, scene);
        draw_curves(&families, &degrees, panel, scene);
        label(&families, panel, scene);
        panel.draw_frame(scene);
        let area = panel.area;
        panel.draw_x_ticks(scene, &fitting_across(&panel.x, area.width(), u), true);
        panel.draw_y_ticks(scene, &fitting_up(&panel.y, area.height(), u), true);
    }
    for symbols in &symbols {
        symbols::draw(panel, symbols, scene);
    }
    panels.draw_axes(scene);
    if let Some(column) = column {
        let top = panel.area.top;
        legend.draw(scene, page::Area { top, ..column });
    }
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
            // With several values, these would hide the boundaries of the stable regions.
            others: here().filter(|p| !several && !bounds(p)).collect(),
            decaying: of_family().filter(|c| !crossing(c)).collect(),
            index,
        }
    };
    view.panels.iter().enumerate().map(family).collect()
}

/// The parts of a curve within a panel.
fn traced(panel: &Panel, piece: &CurvePiece) -> Vec<Vec<Point>> {
    let vertices = piece.vertices.iter();
    let points: Vec<Point> = vertices.map(|v| panel.at(v.p, v.q)).collect();
    clip::within(&points, panel.area)
}

/// The stable areas of a family in a panel.
fn stable_areas(
    map: &MapFile,
    view: &View,
    y: usize,
    family: &Family,
    panel: &Panel,
) -> Result<Vec<Region>, PictureError> {
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
    Ok(regions(panel, &family.bounding, stable))
}

fn draw_areas(families: &[Family], areas: &[Vec<Region>], scene: &mut Scene) {
    for (family, regions) in families.iter().zip(areas) {
        for slices in regions {
            scene.marks.push(Mark::Band {
                slices: slices.clone(),
                colour: family.colour,
                opacity: SHADE,
            });
        }
    }
}

fn draw_curves(families: &[Family], degrees: &Degrees, panel: &Panel, scene: &mut Scene) {
    let u = scene.unit();
    for family in families {
        for points in family.others.iter().flat_map(|piece| traced(panel, piece)) {
            scene.path(points, colour::pale(family.colour, 0.45), THIN * u);
        }
    }
    for family in families {
        for curve in &family.decaying {
            for points in traced(panel, &curve.piece) {
                degrees.draw(curve.degree_of_stability, &points, family.colour, scene);
            }
        }
        for piece in &family.bounding {
            for points in traced(panel, piece) {
                match kinds::dash(piece.kind) {
                    Some(dash) => scene.dashed(&points, family.colour, WIDTH * u, dash),
                    None => scene.path(points, family.colour, WIDTH * u),
                }
            }
        }
    }
}

/// Frames the source of an inset, clears its place, and connects the two.
fn link(inset: &Inset, scene: &mut Scene) {
    let u = scene.unit();
    let (source, area) = (inset.source, inset.panel.area);
    let corners = |area: page::Area| {
        let (left, right) = (area.left, area.right);
        [
            (left, area.top),
            (right, area.top),
            (right, area.bottom),
            (left, area.bottom),
        ]
    };
    let (from, to) = (corners(source), corners(area));
    scene.outline(from[0], from[2], SOFT_INK, THIN * u);
    // The two corners of each that face the other one.
    let facing = match () {
        () if area.right <= source.left => [(0, 1), (3, 2)],
        () if area.left >= source.right => [(1, 0), (2, 3)],
        () if area.bottom <= source.top => [(0, 3), (1, 2)],
        () => [(3, 0), (2, 1)],
    };
    for (a, b) in facing {
        scene.dashed(&[from[a], to[b]], SOFT_INK, THIN * u, DASH);
    }
    scene.rect(to[0], to[2], PAPER);
}

/// Labels the curves of each family; returns the areas of the labels.
fn label(families: &[Family], panel: &Panel, scene: &mut Scene) -> Vec<page::Area> {
    let u = scene.unit();
    let size = 0.92 * SMALL * u;
    let labelled: Vec<(&Family, &Rich)> = families
        .iter()
        .filter_map(|family| Some((family, family.short.as_ref()?)))
        .collect();
    let sets: Vec<(Curves, (f64, f64))> = labelled
        .iter()
        .map(|(family, text)| {
            let curves = family
                .bounding
                .iter()
                .flat_map(|piece| traced(panel, piece));
            (curves.collect(), (text.width(size), 0.8 * size))
        })
        .collect();
    let mut taken = Vec::new();
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
        taken.push(page::Area {
            left: x - half,
            top: y - height,
            right: x + half,
            bottom: y + height,
        });
    }
    taken
}

fn legend(map: &MapFile, view: &View, families: &[Family], degrees: &Degrees) -> Legend {
    let tint = |family: &Family| Some(colour::pale(family.colour, 2.0 * SHADE));
    let mut entries: Vec<(Swatch, Rich)> = Vec::new();
    let mut heading = Vec::new();
    if let Some(axis) = view.along.map(|axis| &map.axes()[axis]) {
        heading = vec![
            Rich::plain("stable inside,"),
            Rich::plain("at ")
                .and_symbol(&axis.parameter)
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
    let bounding = families.iter().flat_map(|family| family.bounding.iter());
    entries.extend(kinds::entries(&bounding.copied(), colour, WIDTH));
    entries.extend(degrees.entries(colour));
    Legend { heading, entries }
}
