//! Heat maps of a field: a panel for each value of the axis outside the plane.

use super::colour::INK;
use super::degrees::Degrees;
use super::hatch;
use super::key::{BOUNDARY_WIDTH, Key};
use super::page::{self, Area};
use super::panels::{Panel, Panels, Words};
use super::scale::Scale;
use super::scene::{Mark, Scene};
use super::text::axis_title;
use super::view::View;
use super::{PictureError, PictureOptions};
use crate::linear::curves::StableSide;
use crate::report::known::Known;
use crate::store::MapFile;
use crate::store::map_file::MapCurve;
use crate::sweep::Field;

/// Space for the colours' meanings, to begin with.
const GAP: f64 = 34.0;

/// Draws a heat map of `field` with at most as many cells each way in all panels together as stand
/// beside the options, and the curves of `curves` that bound the stable region.
pub(super) fn draw(
    map: &MapFile,
    view: &View,
    y: usize,
    field: Field,
    curves: &[MapCurve],
    options: (&PictureOptions, usize),
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let (options, most) = options;
    let unit = map.field_unit(field);
    let (title, mut notes) = super::head(map, field, options);
    notes.extend(view.notes(map));
    let mut body = page::head(scene, &title, &notes);
    let across = (view.panels.len() as f64).sqrt().ceil() as usize;
    let most = (most / across).max(100);
    let planes: Vec<Known> = view
        .panels
        .iter()
        .map(|panel| Known::read(map, field, panel, (y, view.x), most))
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
    for ((panel, plane), index) in panels.list.iter().zip(&planes).zip(&view.panels) {
        draw_cells(panel, plane, &key, scene);
        let outer = view.outer_values(map, index);
        for curve in curves.iter().filter(|c| c.outer == outer) {
            draw_curve(panel, curve, &degrees, scene);
        }
    }
    panels.draw_axes(scene);
    if let (Some(first), Some(last)) = (panels.list.first(), panels.list.last()) {
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

fn draw_cells(panel: &Panel, known: &Known, key: &Key, scene: &mut Scene) {
    let columns = panel.x.filling_edges(&known.plane.columns).into_iter();
    let rows = panel.y.filling_edges(&known.plane.rows).into_iter();
    let columns: Vec<f64> = columns.map(|x| panel.across(x)).collect();
    let rows: Vec<f64> = rows.map(|y| panel.up(y)).collect();
    let cells = known.plane.cells.iter().zip(&known.gaps);
    let colours = cells.map(|(value, gap)| gap.map_or_else(|| key.colour(*value), hatch::ground));
    scene.marks.push(Mark::Cells {
        columns: columns.clone(),
        rows: rows.clone(),
        colours: colours.collect(),
    });
    hatch::draw(&columns, &rows, &known.gaps, scene);
}
