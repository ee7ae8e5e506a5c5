//! The boundaries of stability in one plane, with a colour for each value of the axis outside it.

use super::chained::chained;
use super::choice;
use super::clip;
use super::curve_labels::{Curves, Place, cross_any, places};
use super::degrees::Degrees;
use super::error::PictureError;
use super::inset::{self, Inset};
use super::kinds;
use super::label::{Label, THIN};
use super::legend::{Legend, Swatch};
use super::letters;
use super::options::PictureOptions;
use super::page::{self, SMALL};
use super::panels::{Panel, Panels, Words, fitting_across, fitting_up};
use super::scene::{Mark, Point, Scene};
use super::stability::Stability;
use super::stable_area::{Region, regions};
use super::symbols;
use super::text::{Rich, axis_title, number, suffix};
use super::traced;
use super::view::View;
use crate::linear::curves::{CurvePiece, StableSide};
use crate::meaning::colour::{self, INK, PAPER, Rgb, SOFT_INK};
use crate::meaning::scale::Scale;
use crate::store::MapFile;
use crate::store::map_file::MapCurve;

const WIDTH: f64 = 3.0;
const SHADE: f64 = 0.13;
/// Dashes of the lines that connect an inset, (length, gap).
const DASH: (f64, f64) = (6.0, 6.0);

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
    let plane = Shown {
        map,
        view,
        y,
        degrees: &degrees,
    };
    let stability = families
        .iter()
        .map(|family| plane.stability(family, panel))
        .collect::<Result<Vec<_>, _>>()?;
    let inset = plane.draw_labelled((&families, &stability), curves, panel, scene);
    for symbols in &symbols {
        symbols::draw(panel, symbols, scene);
    }
    if let Some(inset) = &inset {
        link(inset, &drawn(&families, panel), scene);
    }
    panels.draw_axes(scene);
    if let Some(column) = column {
        let top = panel.area.top;
        legend.draw(scene, page::Area { top, ..column });
    }
    Ok(())
}

/// What the panel and its inset have in common.
struct Shown<'a> {
    map: &'a MapFile,
    view: &'a View,
    y: usize,
    degrees: &'a Degrees,
}

impl Shown<'_> {
    /// The stability of a family's plane.
    fn stability<'f>(
        &self,
        family: &'f Family,
        panel: &'f Panel,
    ) -> Result<Stability<'f>, PictureError> {
        let axes = (self.y, self.view.x);
        Stability::of(self.map, (family.index, axes), panel, &family.bounding)
    }

    /// Draws the families into a panel; returns their stable regions. `without_crossing` says
    /// whether a family is stable at a value of p where none of its curves lies.
    fn draw(
        &self,
        families: &[Family],
        panel: &Panel,
        without_crossing: &dyn Fn(usize, f64) -> bool,
        scene: &mut Scene,
    ) -> Vec<Region> {
        let areas = |(i, family): (usize, &Family)| {
            regions(panel, &family.bounding, |p| without_crossing(i, p))
        };
        let areas: Vec<Vec<Region>> = families.iter().enumerate().map(areas).collect();
        draw_areas(families, &areas, scene);
        draw_curves(families, self.degrees, panel, scene);
        areas.into_iter().flatten().collect()
    }

    /// Draws an inset, its curves traced anew; magnified where that is not possible. Returns the
    /// labels in it. Where no curve lies in the inset, those of the panel tell what is stable.
    fn draw_inset(
        &self,
        panel: &Panel,
        curves: &[MapCurve],
        stability: &[Stability],
        scene: &mut Scene,
    ) -> Vec<Rich> {
        let part = [panel.x.ends(), panel.y.ends()];
        let finer = traced::within(self.map, self.view, part);
        let curves = finer.as_deref().unwrap_or(curves);
        let families = families(self.map, self.view, curves);
        let middle = panel.y.value(0.5);
        self.draw(&families, panel, &|i, p| stability[i].at(p, middle), scene);
        let (area, u) = (panel.area, scene.unit());
        let labels = labels(&families, panel, u);
        for label in &labels {
            label.draw(scene);
        }
        panel.draw_frame(scene);
        panel.draw_x_ticks(scene, &fitting_across(&panel.x, area.width(), u), true);
        panel.draw_y_ticks(scene, &fitting_up(&panel.y, area.height(), u), true);
        labels.iter().map(|label| label.text.clone()).collect()
    }
}

impl Shown<'_> {
    /// Draws the families into a panel with their labels and, where it is worthwhile, an inset.
    fn draw_labelled(
        &self,
        (families, stability): (&[Family], &[Stability]),
        curves: &[MapCurve],
        panel: &Panel,
        scene: &mut Scene,
    ) -> Option<Inset> {
        let u = scene.unit();
        let areas = self.draw(families, panel, &|i, p| stability[i].throughout(p), scene);
        let labels = labels(families, panel, u);
        let taken: Vec<page::Area> = labels.iter().flat_map(Label::areas).collect();
        let inset = inset::of(panel, &areas, &taken, u);
        let mut named = Vec::new();
        if let Some(inset) = &inset {
            frame(inset, scene);
            named = self.draw_inset(&inset.panel, curves, stability, scene);
        }
        // What the frame of the part would cut is left out if it is named in the inset.
        let cut = |label: &Label| {
            let cuts = |inset: &Inset| label.is_cut(inset.source) && named.contains(label.text);
            inset.as_ref().is_some_and(cuts)
        };
        for label in labels.iter().filter(|label| !cut(label)) {
            label.draw(scene);
        }
        inset
    }
}

/// All curves of some families that are drawn, whole even where they are dashed.
fn drawn(families: &[Family], panel: &Panel) -> Vec<Vec<Point>> {
    let of_family = |family: &Family| {
        let decaying = family.decaying.iter().map(|curve| &curve.piece);
        let all = family.bounding.iter().chain(&family.others).copied();
        let all: Vec<&CurvePiece> = all.chain(decaying).collect();
        let seen = all.into_iter().flat_map(|piece| seen(panel, piece));
        seen.collect::<Vec<_>>()
    };
    families.iter().flat_map(of_family).collect()
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
fn seen(panel: &Panel, piece: &CurvePiece) -> Vec<Vec<Point>> {
    let vertices = piece.vertices.iter();
    let points: Vec<Point> = vertices.map(|v| panel.at(v.p, v.q)).collect();
    clip::within(&points, panel.area)
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
        for points in family.others.iter().flat_map(|piece| seen(panel, piece)) {
            scene.path(points, colour::pale(family.colour, 0.45), THIN * u);
        }
    }
    for family in families {
        for &degree in degrees.values() {
            let here = family.decaying.iter();
            let here = here.filter(|curve| curve.degree_of_stability == degree);
            let pieces = here.flat_map(|curve| seen(panel, &curve.piece));
            for points in chained(pieces.collect()) {
                degrees.draw(degree, &points, family.colour, scene);
            }
        }
        for piece in &family.bounding {
            for points in seen(panel, piece) {
                match kinds::dash(piece.kind) {
                    Some(dash) => scene.dashed(&points, family.colour, WIDTH * u, dash),
                    None => scene.path(points, family.colour, WIDTH * u),
                }
            }
        }
    }
}

/// The corners of an area, clockwise from the upper left one.
fn corners(area: page::Area) -> [Point; 4] {
    let (left, right) = (area.left, area.right);
    [
        (left, area.top),
        (right, area.top),
        (right, area.bottom),
        (left, area.bottom),
    ]
}

/// Frames the source of an inset, and clears its place.
fn frame(inset: &Inset, scene: &mut Scene) {
    let [from, _, to, _] = corners(inset.source);
    scene.outline(from, to, SOFT_INK, THIN * scene.unit());
    let [from, _, to, _] = corners(inset.panel.area);
    scene.rect(from, to, PAPER);
}

/// Connects an inset with its source by lines that cross nothing.
fn link(inset: &Inset, curves: &[Vec<Point>], scene: &mut Scene) {
    let (source, area) = (inset.source, inset.panel.area);
    let (from, to) = (corners(source), corners(area));
    // The two corners of each that face the other one.
    let facing = match () {
        () if area.right <= source.left => [(0, 1), (3, 2)],
        () if area.left >= source.right => [(1, 0), (2, 3)],
        () if area.bottom <= source.top => [(0, 3), (1, 2)],
        () => [(3, 0), (2, 1)],
    };
    let crosses = |line: &[Point; 2]| {
        let through = |area| !clip::within(line, area).is_empty();
        letters::texts(scene).any(|(_, area)| through(area))
            || letters::paths(scene).any(|path| cross_any(line, path))
            || curves.iter().any(|path| cross_any(line, path))
    };
    let lines = facing.map(|(a, b)| [from[a], to[b]]);
    let clear: Vec<_> = lines.into_iter().filter(|line| !crosses(line)).collect();
    for line in clear {
        scene.dashed(&line, SOFT_INK, THIN * scene.unit(), DASH);
    }
}

/// The labels of the curves of each family. `u`: the unit of the picture.
fn labels<'a>(families: &'a [Family], panel: &Panel, u: f64) -> Vec<Label<'a>> {
    let size = 0.92 * SMALL * u;
    let labelled: Vec<(&Family, &'a Rich)> = families
        .iter()
        .filter_map(|family| Some((family, family.short.as_ref()?)))
        .collect();
    let sets: Vec<(Curves, (f64, f64))> = labelled
        .iter()
        .map(|(family, text)| {
            let curves = family.bounding.iter().flat_map(|piece| seen(panel, piece));
            (curves.collect(), (text.width(size), 0.8 * size))
        })
        .collect();
    let placed = labelled.iter().zip(places(&sets, panel.area, u));
    let label = |((family, text), place): (&(&Family, &'a Rich), Option<Place>)| {
        let place = place?;
        Some(Label {
            text,
            colour: colour::darker(family.colour),
            size,
            place,
        })
    };
    placed.filter_map(label).collect()
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
