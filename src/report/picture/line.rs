//! Fields along the one axis that is left.

use super::colour::{self, PAPER, Rgb, SOFT_INK, STABLE};
use super::hatch;
use super::key::DECADES;
use super::legend::{Legend, Swatch};
use super::page;
use super::panels::{Panel, Panels, Words};
use super::rectangles::{Rectangle, rectangles};
use super::scale::Scale;
use super::scene::{Mark, Point, Scene};
use super::text::{Rich, axis_title, field_name, field_title, number, suffix};
use super::view::View;
use super::{PictureError, PictureOptions};
use crate::report::known::{Gap, Known};
use crate::store::map_file::MapAxis;
use crate::store::{MapFile, StoreError};
use crate::sweep::Field;
use crate::sweep::input::field::{Spread, Storage};

const WIDTH: f64 = 3.2;
/// Dashes of approximations, (length, gap).
const DASH: (f64, f64) = (9.0, 7.0);
const SHADE: f64 = 0.25;
/// Half the length of a line of one point.
const LONE: f64 = 5.0;
/// Relative errors beyond this are not told apart.
const LARGEST_ERROR: f64 = 1.0;

/// The cells along one line, and how they are drawn.
struct Graph {
    field: Field,
    at: Vec<f64>,
    values: Vec<f64>,
    /// Why a cell shows no value.
    gaps: Vec<Option<Gap>>,
    swatch: Swatch,
    /// What tells the line from the others.
    name: Rich,
}

/// Draws `fields` along the axis `view.x` at no more than `most` cells: a single one at every
/// panel's values of the other axes, several ones, of the same unit, at those of the first.
pub(super) fn draw(
    map: &MapFile,
    view: &View,
    fields: &[Field],
    options: &PictureOptions,
    most: usize,
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let Some(&field) = fields.first() else {
        return Ok(());
    };
    let lines = read_lines(map, view, fields, most)?;
    let (title, mut notes) = super::head(map, field, options);
    if fields.len() > 1 {
        notes.clear();
    }
    notes.extend(view.notes(map));
    let mut body = page::head(scene, &title, &notes);
    let u = scene.unit();
    let legend = legend(map, view, &lines);
    let column = body.cut_right(legend.width(u), 30.0 * u);
    let axis = &map.axes()[view.x];
    let words = Words {
        x: axis_title(axis),
        y: ordinate(map, fields),
        headings: vec![None],
    };
    let scales = (Scale::around(&axis.values), value_scale(field, &lines));
    let panels = Panels::new(scene, body, scales, words);
    let Some(panel) = panels.list.first() else {
        return Ok(());
    };
    let stability = map.stability_field().filter(|_| lines.len() == 1);
    if let Some(stable) = stability {
        for line in read_lines(map, view, &[stable], most)? {
            shade(panel, &line, scene);
        }
    }
    if let [line] = &lines[..] {
        draw_gaps(panel, line, scene);
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
    for line in &lines {
        draw_line(panel, line, scene);
    }
    panels.draw_axes(scene);
    let top = panel.area.top;
    legend.draw(scene, page::Area { top, ..column });
    Ok(())
}

fn read_lines(
    map: &MapFile,
    view: &View,
    fields: &[Field],
    most: usize,
) -> Result<Vec<Graph>, StoreError> {
    let several = fields.len() > 1;
    let panels = if several { 1 } else { view.panels.len() };
    let n = fields.len() * panels;
    let mut lines = Vec::with_capacity(n);
    for &field in fields {
        for index in view.panels.iter().take(panels) {
            let known = Known::read(map, field, index, (view.x, view.x), most)?;
            lines.push(Graph {
                field,
                at: known.plane.columns,
                values: known.plane.cells,
                gaps: known.gaps,
                swatch: swatch(field, colour::of_line(lines.len(), n)),
                name: match view.along {
                    Some(axis) if !several => {
                        Rich::plain(&number(map.axes()[axis].values[index[axis]]))
                    }
                    _ => field_name(field),
                },
            });
        }
    }
    Ok(lines)
}

/// Approximations are dashed.
fn swatch(field: Field, colour: Rgb) -> Swatch {
    match field {
        Field::VcWeakControl | Field::VcStrongControl => Swatch::Dashed(colour, WIDTH, DASH),
        _ => Swatch::Line(colour, WIDTH, None),
    }
}

/// The title of the axis of values.
fn ordinate(map: &MapFile, fields: &[Field]) -> Rich {
    match fields {
        [first, _, ..] if first.of_limit() => {
            Rich::default().and_formula("pulling velocity  v_0/ṽ")
        }
        [field, ..] => field_title(*field, &map.field_unit(*field)),
        [] => Rich::default(),
    }
}

fn value_scale(field: Field, lines: &[Graph]) -> Scale {
    let finite = || {
        let cells = lines.iter().flat_map(|l| l.values.iter().zip(&l.gaps));
        let shown = cells.filter(|(value, gap)| value.is_finite() && gap.is_none());
        shown.map(|(value, _)| *value)
    };
    let (mut low, mut high) = (finite().fold(0.0, f64::min), finite().fold(0.0, f64::max));
    match field.spread() {
        Spread::Decades => {
            if let Some(scale) = Scale::over_decades(finite(), DECADES) {
                return scale;
            }
        }
        Spread::RelativeError => {
            (low, high) = (low.max(-LARGEST_ERROR), high.min(LARGEST_ERROR));
        }
        _ => {}
    }
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

fn draw_line(panel: &Panel, line: &Graph, scene: &mut Scene) {
    let u = scene.unit();
    for mut stretch in stretches(panel, line) {
        // A value alone between others that are not there is a point.
        if let [(x, y)] = stretch[..] {
            stretch = vec![(x - LONE * u, y), (x + LONE * u, y)];
        }
        for points in between(&stretch, panel.area.top, panel.area.bottom) {
            match line.swatch {
                Swatch::Dashed(colour, width, dash) => {
                    scene.dashed(&points, colour, width * u, dash);
                }
                Swatch::Line(colour, width, _) => scene.path(points, colour, width * u),
                _ => {}
            }
        }
    }
}

/// The line in pixels, broken where there is no value on the scale: steps for counts, straight
/// lines otherwise.
fn stretches(panel: &Panel, line: &Graph) -> Vec<Vec<Point>> {
    let edges = panel.x.filling_edges(&line.at);
    let mut done = Vec::new();
    let mut open: Vec<Point> = Vec::new();
    for (i, (&x, &value)) in line.at.iter().zip(&line.values).enumerate() {
        if line.gaps[i].is_some() || !panel.y.part(value).is_finite() {
            done.push(std::mem::take(&mut open));
            continue;
        }
        if line.field.storage() == Storage::Real {
            open.push(panel.at(x, value));
        } else {
            open.extend([panel.at(edges[i], value), panel.at(edges[i + 1], value)]);
        }
    }
    done.push(open);
    done
}

/// The parts of a polyline between two heights.
fn between(points: &[Point], top: f64, bottom: f64) -> Vec<Vec<Point>> {
    let mut done = Vec::new();
    let mut open: Vec<Point> = Vec::new();
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let part = |height: f64| (height - a.1) / (b.1 - a.1);
        let (mut from, mut to) = (0.0, 1.0);
        if a.1 != b.1 {
            let (s, t) = (part(top), part(bottom));
            (from, to) = (f64::max(from, s.min(t)), f64::min(to, s.max(t)));
        }
        let level = a.1 == b.1 && !(top..=bottom).contains(&a.1);
        if level || from >= to {
            done.push(std::mem::take(&mut open));
            continue;
        }
        let on = |part: f64| (a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1));
        if from > 0.0 || open.is_empty() {
            done.push(std::mem::take(&mut open));
            open.push(if from > 0.0 { on(from) } else { a });
        }
        open.push(if to < 1.0 { on(to) } else { b });
        if to < 1.0 {
            done.push(std::mem::take(&mut open));
        }
    }
    done.push(open);
    done.retain(|part| !part.is_empty());
    done
}

/// Marks the cells along a line that show no value, over the height of the panel.
fn draw_gaps(panel: &Panel, line: &Graph, scene: &mut Scene) {
    let edges = panel.x.filling_edges(&line.at);
    for Rectangle { columns, key, .. } in rectangles(&line.gaps, line.gaps.len()) {
        let Some(gap) = key else { continue };
        let from = (panel.across(edges[columns.0]), panel.area.top);
        let to = (panel.across(edges[columns.1]), panel.area.bottom);
        let (from, to) = ((from.0.min(to.0), from.1), (from.0.max(to.0), to.1));
        scene.rect(from, to, hatch::ground(gap));
        hatch::fill(from, to, gap, scene);
    }
}

/// Shades the cells in which sliding is stable.
fn shade(panel: &Panel, line: &Graph, scene: &mut Scene) {
    let tint = colour::pale(STABLE, 2.0 * SHADE);
    let colour = |(&value, gap): (&f64, &Option<Gap>)| match line.field.tells_stable(value) {
        Some(true) if gap.is_none() => tint,
        _ => PAPER,
    };
    let edges = panel.x.filling_edges(&line.at);
    scene.marks.push(Mark::Cells {
        columns: edges.into_iter().map(|x| panel.across(x)).collect(),
        rows: vec![panel.area.bottom, panel.area.top],
        colours: line.values.iter().zip(&line.gaps).map(colour).collect(),
    });
}

fn legend(map: &MapFile, view: &View, lines: &[Graph]) -> Legend {
    let mut legend = Legend::default();
    if let Some(kinds) = lines.iter().find_map(|line| line.field.kinds()) {
        // What the numbers on the axis mean.
        let meaning = |(i, kind): (usize, &str)| Rich::plain(&format!("{i}: {kind}"));
        legend.heading = kinds.into_iter().enumerate().map(meaning).collect();
    }
    if let Some(axis) = view.along {
        let MapAxis {
            parameter, unit, ..
        } = &map.axes()[axis];
        let unit = suffix(unit, " (", ")");
        let heading = Rich::symbol(*parameter).and(&unit).and(" =");
        legend.heading.push(heading);
    }
    if lines.len() > 1 {
        legend.entries = lines.iter().map(|l| (l.swatch, l.name.clone())).collect();
    } else if map.stability_field().is_some() {
        let tint = colour::pale(STABLE, 2.0 * SHADE);
        legend.entries = vec![(Swatch::Box(tint), Rich::plain("stable"))];
    }
    add_gaps(&mut legend, lines);
    legend
}

/// What of a single line is no value, or what several ones are broken for.
fn add_gaps(legend: &mut Legend, lines: &[Graph]) {
    for gap in Gap::ALL {
        let mut there = lines.iter().filter(|line| line.gaps.contains(&Some(gap)));
        let Some(line) = there.next() else { continue };
        let words = gap.words(line.field);
        let entry = match lines {
            [_] => (Swatch::Gap(gap), Rich::plain(words)),
            _ => (Swatch::None, Rich::plain(&format!("broken: {words}"))),
        };
        legend.entries.push(entry);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number that is not known is no point of a line.
    #[test]
    fn a_line_is_broken_where_it_is_not_known() {
        let line = Graph {
            field: Field::Vc,
            at: vec![0.0, 1.0, 2.0, 3.0, 4.0],
            values: vec![1.0, 1.0, 0.0, 2.0, 2.0],
            gaps: vec![None, None, Some(Gap::NotConverged), None, None],
            swatch: swatch(Field::Vc, PAPER),
            name: Rich::default(),
        };
        let panel = Panel {
            area: page::Area {
                left: 0.0,
                top: 0.0,
                right: 5.0,
                bottom: 10.0,
            },
            x: Scale::around(&line.at),
            y: value_scale(Field::VLiftoff, std::slice::from_ref(&line)),
        };
        let parts = stretches(&panel, &line);
        assert_eq!(parts.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
        let mut scene = Scene::new((1600, 1100));
        draw_gaps(&panel, &line, &mut scene);
        let band = Mark::Rect {
            from: (2.0, 0.0),
            to: (3.0, 10.0),
            colour: colour::UNKNOWN,
            opacity: 1.0,
        };
        assert_eq!(scene.marks[0], band);
        let mut legend = Legend::default();
        add_gaps(&mut legend, &[line]);
        let expected = (Swatch::Gap(Gap::NotConverged), Rich::plain("not converged"));
        assert_eq!(legend.entries, [expected]);
    }

    #[test]
    fn a_line_ends_at_the_frame() {
        let line = [(0.0, -1.0), (1.0, 1.0), (2.0, 2.0), (3.0, 6.0), (4.0, 2.0)];
        let parts = between(&line, 0.0, 4.0);
        assert_eq!(
            parts,
            [
                vec![(0.5, 0.0), (1.0, 1.0), (2.0, 2.0), (2.5, 4.0)],
                vec![(3.5, 4.0), (4.0, 2.0)]
            ]
        );
        let inside = [(0.0, 1.0), (1.0, 1.0), (2.0, 3.0)];
        assert_eq!(between(&inside, 0.0, 4.0), [inside.to_vec()]);
        assert!(between(&[(0.0, 5.0), (1.0, 5.0)], 0.0, 4.0).is_empty());
    }
}
