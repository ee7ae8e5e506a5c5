//! Fields along the only remaining axis.

use super::areas;
use super::choice;
use super::clip::between;
use super::error::PictureError;
use super::hatch;
use super::legend::{Legend, Swatch};
use super::off_scale::{self, Along};
use super::options::PictureOptions;
use super::page::{self, SMALL};
use super::panels::{Panel, Panels, Words};
use super::rectangles::{Rectangle, rectangles};
use super::scene::{Align, Point, Scene};
use super::speed;
use super::stable_line;
use super::text::{Rich, field_name, field_title, number, suffix};
use super::value_scale;
use super::view::View;
use crate::meaning::colour::{self, Rgb, SOFT_INK, STABLE_TINT};
use crate::meaning::gap::Gap;
use crate::report::known::Known;
use crate::setting::Field;
use crate::setting::field::Storage;
use crate::store::map_file::MapAxis;
use crate::store::{MapFile, StoreError};

const WIDTH: f64 = 3.2;
/// Dashes of approximations, (length, gap).
const DASH: (f64, f64) = (9.0, 7.0);
/// Half the length of the line that stands for a single point.
const LONE: f64 = 5.0;

/// The cells along one line, with their style.
struct Graph {
    field: Field,
    at: Vec<f64>,
    values: Vec<f64>,
    /// Why a cell shows no value.
    gaps: Vec<Option<Gap>>,
    swatch: Swatch,
    colour: Rgb,
    /// What distinguishes the line from the others.
    name: Rich,
}

/// Draws `fields` along the axis `view.x`. A single field is drawn for the other axes' values of
/// every panel; several ones, with the same unit, only for those of the first panel. At most
/// `most` cells are drawn.
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
    let (title, mut notes) = choice::head(map, field, options);
    if fields.len() > 1 {
        notes.clear();
    }
    notes.extend(view.notes(map));
    let mut body = page::head(scene, &title, &options.subtitle(notes));
    let axis = &map.axes()[view.x];
    let scales = (
        speed::scale(map, axis),
        value_scale::asked(field, &finite(&lines).collect::<Vec<_>>(), options)?,
    );
    let u = scene.unit();
    let asked = options.range.is_some();
    let mut legend = legend(map, view, &lines);
    // What lies beyond the scale does not depend on the panel's place.
    let anywhere = Panel {
        area: body,
        x: scales.0,
        y: scales.1,
    };
    let entries = draw_off_scale(&anywhere, &lines, asked, &mut scene.like());
    legend.entries.extend(entries);
    let column = match options.no_legend {
        true => None,
        false => Some(body.cut_right(legend.width(u), 30.0 * u)),
    };
    let words = Words {
        x: speed::title(map, axis),
        y: ordinate(map, fields),
        headings: vec![None],
        names: field.kinds().unwrap_or_default(),
    };
    let panels = Panels::new(scene, body, scales, words);
    panels.check(scene)?;
    let Some(panel) = panels.list.first() else {
        return Ok(());
    };
    if lines.len() == 1 {
        stable_line::shade(map, view, most, panel, scene)?;
    }
    if let [line] = &lines[..] {
        draw_gaps(panel, line, scene);
    }
    panels.draw_grid(scene);
    draw_lines(panel, &lines, asked, scene);
    panels.draw_axes(scene);
    if let Some(column) = column {
        let top = panel.area.top;
        legend.draw(scene, page::Area { top, ..column });
    }
    Ok(())
}

/// Draws the lines, with a line at 0 below them.
fn draw_lines(panel: &Panel, lines: &[Graph], asked: bool, scene: &mut Scene) {
    let numbers = lines.iter().all(|line| line.field.kinds().is_none());
    if numbers && panel.y.holds(0.0) {
        let zero = panel.up(0.0);
        scene.ruler(
            (panel.area.left, zero),
            (panel.area.right, zero),
            SOFT_INK,
            scene.unit(),
        );
    }
    for line in lines {
        draw_line(panel, line, scene);
    }
    draw_off_scale(panel, lines, asked, scene);
    name_areas(panel, lines, scene);
}

/// Draws the values beyond the scale, whose ends may be `asked` for; returns entries for the
/// legend.
fn draw_off_scale(
    panel: &Panel,
    lines: &[Graph],
    asked: bool,
    scene: &mut Scene,
) -> Vec<(Swatch, Rich)> {
    let edges: Vec<Vec<f64>> = lines.iter().map(|l| panel.x.filling_edges(&l.at)).collect();
    let lines = lines.iter().zip(&edges);
    let along = lines.map(|(line, edges)| Along {
        field: line.field,
        values: &line.values,
        gaps: &line.gaps,
        edges,
        colour: line.colour,
    });
    off_scale::draw(panel, &along.collect::<Vec<_>>(), asked, scene)
}

/// Names the areas on either side of the critical velocity of a short delay, and the one beyond
/// lift-off.
fn name_areas(panel: &Panel, lines: &[Graph], scene: &mut Scene) {
    let of = |field: Field| {
        let mut found = lines.iter().filter(|line| line.field == field);
        found.next().filter(|_| found.next().is_none())
    };
    let Some(critical) = of(Field::VcOverVtilde) else {
        return;
    };
    let traced: Vec<Vec<Point>> = lines
        .iter()
        .flat_map(|line| stretches(panel, line))
        .collect();
    let all: Vec<&[Point]> = traced.iter().map(Vec::as_slice).collect();
    let longest = |line: &Graph| {
        let parts = stretches(panel, line).into_iter();
        let mut longest = parts.max_by_key(Vec::len).unwrap_or_default();
        longest.sort_by(|a, b| a.0.total_cmp(&b.0));
        longest
    };
    let critical = longest(critical);
    let critical = Some(critical.as_slice());
    let lift_off = of(Field::LiftoffOverVtilde).map(longest);
    let lift_off = lift_off.as_deref();
    let size = SMALL * scene.unit();
    let areas = [
        ((None, critical), "stick-slip persists"),
        ((critical, lift_off), "no stick-slip"),
        ((lift_off.or(Some(&[])), None), "the block lifts off"),
    ];
    for ((lower, upper), name) in areas {
        let name = Rich::plain(name);
        let place = areas::between((lower, upper), &all, (name.width(size), size), panel.area);
        if let Some((x, y)) = place {
            scene.text((x, y + 0.34 * size), Align::Middle, &name, size, SOFT_INK);
        }
    }
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
                colour: colour::of_line(lines.len(), n),
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

/// The swatch of a field: dashed for approximations.
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

/// The values that a line can show.
fn finite(lines: &[Graph]) -> impl Iterator<Item = f64> {
    let cells = lines.iter().flat_map(|l| l.values.iter().zip(&l.gaps));
    let shown = cells.filter(|(value, gap)| value.is_finite() && gap.is_none());
    shown.map(|(value, _)| *value)
}

fn draw_line(panel: &Panel, line: &Graph, scene: &mut Scene) {
    let u = scene.unit();
    for mut stretch in stretches(panel, line) {
        // A single value between missing ones is drawn as a point.
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

/// The line in pixels, broken where there is no value on the scale: as steps for counts, as
/// straight lines otherwise.
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

/// Marks the cells along a line that show no value, over the height of the panel.
fn draw_gaps(panel: &Panel, line: &Graph, scene: &mut Scene) {
    let edges = panel.x.filling_edges(&line.at);
    for Rectangle { columns, key, .. } in rectangles(&line.gaps, line.gaps.len()) {
        let Some(gap) = key else { continue };
        let from = (panel.across(edges[columns.0]), panel.area.top);
        let to = (panel.across(edges[columns.1]), panel.area.bottom);
        let (from, to) = ((from.0.min(to.0), from.1), (from.0.max(to.0), to.1));
        scene.rect(from, to, gap.ground());
        hatch::fill(from, to, gap, scene);
    }
}

fn legend(map: &MapFile, view: &View, lines: &[Graph]) -> Legend {
    let mut legend = Legend::default();
    if let Some(axis) = view.along {
        let MapAxis {
            parameter, unit, ..
        } = &map.axes()[axis];
        let unit = suffix(unit, " (", ")");
        let heading = Rich::symbol(parameter).and(&unit).and(" =");
        legend.heading.push(heading);
    }
    if lines.len() > 1 {
        legend.entries = lines.iter().map(|l| (l.swatch, l.name.clone())).collect();
    } else if map.stability_field().is_some() {
        // A regime is called stable only where stick-slip is absent as well.
        let stable = Rich::plain("linearly stable");
        legend.entries = vec![(Swatch::Box(STABLE_TINT), stable)];
    }
    add_gaps(&mut legend, lines);
    legend
}

/// Adds entries for the gaps of a single line, or one for the breaks of several lines.
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
    use crate::meaning::colour::PAPER;
    use crate::meaning::scale::Scale;
    use crate::report::picture::scene::Mark;

    /// A number that is not known is no point of the line.
    #[test]
    fn a_line_is_broken_where_it_is_not_known() {
        let line = Graph {
            field: Field::Vc,
            at: vec![0.0, 1.0, 2.0, 3.0, 4.0],
            values: vec![1.0, 1.0, 0.0, 2.0, 2.0],
            gaps: vec![None, None, Some(Gap::NotConverged), None, None],
            swatch: swatch(Field::Vc, PAPER),
            colour: PAPER,
            name: Rich::default(),
        };
        let panel = Panel {
            area: page::Area {
                left: 0.0,
                top: 0.0,
                right: 5.0,
                bottom: 10.0,
            },
            x: Scale::linear(-0.5, 4.5),
            y: value_scale::by_default(Field::VLiftoff, &[1.0, 2.0]),
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
}
