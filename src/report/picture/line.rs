//! A field along the one axis that is left.

use super::PictureError;
use super::colour::{self, PAPER, SOFT_INK, STABLE};
use super::legend::{Legend, Swatch};
use super::page;
use super::panels::{Panel, Panels, Words};
use super::scale::Scale;
use super::scene::{Mark, Point, Scene};
use super::text::{Rich, axis_title, field_title, number, suffix};
use super::view::View;
use crate::store::map_file::MapAxis;
use crate::store::{MapFile, StoreError};
use crate::sweep::Field;
use crate::sweep::field::Storage;

const WIDTH: f64 = 3.2;
const SHADE: f64 = 0.25;

/// The cells along one line.
struct Line {
    at: Vec<f64>,
    values: Vec<f64>,
}

/// Draws `field` along the axis `view.x` at no more than `most` cells.
pub fn draw(
    map: &MapFile,
    view: &View,
    field: Field,
    most: usize,
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let read = |field: Field| -> Result<Vec<Line>, StoreError> {
        let panels = view.panels.iter();
        panels
            .map(|index| read_line(map, view.x, index, field, most))
            .collect()
    };
    let lines = read(field)?;
    let title = super::title(map, super::untitled(field));
    let mut body = page::head(scene, &title, &view.notes(map));
    let u = scene.unit();
    let mut legend = legend(map, view);
    if let Some(kinds) = field.kinds() {
        // What the numbers on the axis mean.
        let meaning = |(i, kind): (usize, &str)| Rich::plain(&format!("{i}: {kind}"));
        let meanings = kinds.into_iter().enumerate().map(meaning);
        legend.heading = meanings.chain(legend.heading).collect();
    }
    let column = body.cut_right(legend.width(u), 30.0 * u);
    let axis = &map.axes()[view.x];
    let words = Words {
        x: axis_title(axis),
        y: field_title(field, &map.field_unit(field)),
        headings: vec![None],
    };
    let scales = (Scale::around(&axis.values), value_scale(field, &lines));
    let panels = Panels::new(scene, body, scales, words);
    let Some(panel) = panels.panels.first() else {
        return Ok(());
    };
    let shown = map.stability_field().filter(|_| view.panels.len() == 1);
    if let Some(stable) = shown {
        for line in read(stable)? {
            shade(panel, &line, stable, scene);
        }
    }
    panels.draw_grid(scene);
    if panel.y.holds(0.0) {
        let zero = panel.up(0.0);
        scene.ruler(
            (panel.area.left, zero),
            (panel.area.right, zero),
            SOFT_INK,
            u,
        );
    }
    for (i, line) in lines.iter().enumerate() {
        let colour = colour::of_line(i, lines.len());
        for stretch in stretches(panel, line, field) {
            scene.path(stretch, colour, WIDTH * u);
        }
    }
    panels.draw_axes(scene);
    let top = panel.area.top;
    legend.draw(scene, page::Area { top, ..column });
    Ok(())
}

fn read_line(
    map: &MapFile,
    axis: usize,
    index: &[usize],
    field: Field,
    most: usize,
) -> Result<Line, StoreError> {
    let line = map.plane(field, index, (axis, axis), most)?;
    Ok(Line {
        values: line.cells,
        at: line.columns,
    })
}

fn value_scale(field: Field, lines: &[Line]) -> Scale {
    let finite = || {
        lines
            .iter()
            .flat_map(|l| &l.values)
            .copied()
            .filter(|v| v.is_finite())
    };
    let low = finite().fold(0.0, f64::min);
    let high = finite().fold(0.0, f64::max);
    if let Some(kinds) = field.kinds() {
        let most = kinds.len() as f64;
        return Scale::linear(-0.5, most - 0.5).with_smallest_step(1.0);
    }
    if field.storage() == Storage::Few {
        return Scale::linear(-0.5, high + 0.5).with_smallest_step(1.0);
    }
    if field.storage() == Storage::Count {
        let high = f64::max(high, 2.0);
        return Scale::linear(-0.04 * high, 1.06 * high).with_smallest_step(2.0);
    }
    let span = if high > low { high - low } else { 1.0 };
    Scale::linear(low - 0.05 * span, high + 0.05 * span)
}

/// The line in pixels, broken where there is no finite value: steps for counts, straight lines otherwise.
fn stretches(panel: &Panel, line: &Line, field: Field) -> Vec<Vec<Point>> {
    let edges = panel.x.filling_edges(&line.at);
    let mut done = Vec::new();
    let mut open: Vec<Point> = Vec::new();
    for (i, (&x, &value)) in line.at.iter().zip(&line.values).enumerate() {
        if !value.is_finite() {
            done.push(std::mem::take(&mut open));
            continue;
        }
        if field.storage() != Storage::Real {
            open.extend([panel.at(edges[i], value), panel.at(edges[i + 1], value)]);
        } else {
            open.push(panel.at(x, value));
        }
    }
    done.push(open);
    done
}

/// Shades the cells in which sliding is stable.
fn shade(panel: &Panel, line: &Line, field: Field, scene: &mut Scene) {
    let tint = colour::pale(STABLE, 2.0 * SHADE);
    let colour = |&value: &f64| match field.tells_stable(value) {
        Some(true) => tint,
        _ => PAPER,
    };
    let edges = panel.x.filling_edges(&line.at);
    scene.marks.push(Mark::Cells {
        columns: edges.into_iter().map(|x| panel.across(x)).collect(),
        rows: vec![panel.area.bottom, panel.area.top],
        colours: line.values.iter().map(colour).collect(),
    });
}

fn legend(map: &MapFile, view: &View) -> Legend {
    let Some(axis) = view.along else {
        let tint = colour::pale(STABLE, 2.0 * SHADE);
        return Legend {
            heading: Vec::new(),
            entries: vec![(Swatch::Box(tint), Rich::plain("stable"))],
        };
    };
    let MapAxis {
        parameter,
        values,
        unit,
    } = &map.axes()[axis];
    let n = view.panels.len();
    let entry = |(i, panel): (usize, &Vec<usize>)| {
        let swatch = Swatch::Line(colour::of_line(i, n), WIDTH, None);
        (swatch, Rich::plain(&number(values[panel[axis]])))
    };
    Legend {
        heading: vec![
            Rich::symbol(*parameter)
                .and(&suffix(unit, " (", ")"))
                .and(" ="),
        ],
        entries: view.panels.iter().enumerate().map(entry).collect(),
    }
}
