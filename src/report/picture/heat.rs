//! Heat maps of a field: a panel for each value of the axis outside the plane.

use super::choice;
use super::curve_lines::{self, Lines};
use super::degrees::Degrees;
use super::divisions::{self, Counts, Sides};
use super::error::PictureError;
use super::fitted::fitted;
use super::hatch;
use super::key::{BOUNDARY_WIDTH, Key};
use super::kinds;
use super::legend::Swatch;
use super::options::PictureOptions;
use super::page::{self, Area};
use super::panels::{Panel, Panels, Words};
use super::scene::{Mark, Scene};
use super::speed;
use super::stable_area::stable_throughout;
use super::symbols;
use super::text::{Rich, axis_title};
use super::traced::Curves;
use super::view::View;
use crate::linear::curves::{CurvePiece, StableSide};
use crate::meaning::colour::INK;
use crate::meaning::gap::Gap;
use crate::meaning::scale::Scale;
use crate::report::known::Known;
use crate::setting::Field;
use crate::setting::field::Storage;
use crate::store::MapFile;
use crate::store::map_file::MapCurve;

/// Initial space for the key.
const GAP: f64 = 34.0;
/// The most cells per axis that are read to learn the stability where no curve lies.
const MOST_TOLD: usize = 600;

/// The title and the lines below it.
fn head(
    map: &MapFile,
    view: &View,
    field: Field,
    found: &Curves,
    options: &PictureOptions,
) -> (String, Vec<Rich>) {
    let (title, mut notes) = choice::head(map, field, options);
    notes.extend(view.notes(map));
    let mut notes = options.subtitle(notes);
    // What lacks is told in any case.
    let missing = |why| Rich::plain(&format!("boundaries are missing: {why}"));
    notes.extend(found.missing.map(missing));
    (title, notes)
}

/// Draws a heat map of `field`, with those of `curves` that bound the stable region. The
/// number beside the options limits the cells each way in all panels together.
pub(super) fn draw(
    map: &MapFile,
    view: &View,
    y: usize,
    field: Field,
    found: &Curves,
    (options, most): (&PictureOptions, usize),
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let curves = &found.list;
    let unit = map.field_unit(field);
    let (title, notes) = head(map, view, field, found, options);
    let mut body = page::head(scene, &title, &notes);
    let u = scene.unit();
    let across = (view.panels.len() as f64).sqrt().ceil() as usize;
    let most = (most / across).max(100);
    let planes: Vec<Known> = view
        .panels
        .iter()
        .map(|panel| Known::read(map, field, panel, (y, view.x), most))
        .collect::<Result<_, _>>()?;
    let degrees = Degrees::of(map, curves);
    let symbols = symbols::of_view(map, view, y)?;
    let entries = [
        of_curves(curves, field, &degrees),
        symbols::entries(&symbols),
    ];
    let bounded = curves.iter().any(MapCurve::bounds_stability);
    let key = Key::new(field, &unit, &planes, bounded, options)?.with(entries.concat());
    let column = match options.no_legend {
        true => None,
        false => Some(body.cut_right(key.width(u), GAP * u)),
    };
    let (x_axis, y_axis) = (&map.axes()[view.x], &map.axes()[y]);
    let scales = (speed::scale(map, x_axis), Scale::between(&y_axis.values));
    let headings = view.panels.iter().map(|p| view.heading(map, p)).collect();
    let words = Words::of(speed::title(map, x_axis), axis_title(y_axis), headings);
    let panels = Panels::new(scene, body, scales, words);
    panels.check(scene)?;
    let parts = panels.list.iter().zip(planes).zip(&view.panels);
    for (((panel, plane), index), symbols) in parts.zip(&symbols) {
        let outer = view.outer_values(map, index);
        let here: Vec<&MapCurve> = curves.iter().filter(|c| c.outer == outer).collect();
        let shown = (index.as_slice(), field);
        let plane = cut(map, (view.x, y), shown, panel, plane, (&here, found), u)?;
        draw_cells(panel, &plane, &key, scene);
        let lines = Lines {
            curves: &here,
            turned: found.turned,
            others: field == Field::NUnstable,
        };
        lines.draw(panel, &degrees, scene);
        symbols::draw(panel, symbols, scene);
    }
    panels.draw_axes(scene);
    if let (Some(first), Some(last), Some(column)) =
        (panels.list.first(), panels.list.last(), column)
    {
        let beside = Area {
            top: first.area.top,
            bottom: last.area.bottom,
            ..column
        };
        key.draw(scene, beside, column.bottom)?;
    }
    Ok(())
}

/// The curves that bound the stable region.
fn bounding(curves: &[MapCurve]) -> impl Iterator<Item = &CurvePiece> + Clone {
    let bounding = curves.iter().filter(|curve| curve.bounds_stability());
    bounding.map(|curve| &curve.piece)
}

/// Entries for the curves that are drawn besides the boundary itself.
fn of_curves(curves: &[MapCurve], field: Field, degrees: &Degrees) -> Vec<(Swatch, Rich)> {
    let mut entries = kinds::entries(&bounding(curves), INK, BOUNDARY_WIDTH);
    entries.extend(degrees.entries(INK));
    let other = |curve: &MapCurve| curve.piece.stable_side == StableSide::Neither;
    // They lie between numbers of unstable roots.
    if field == Field::NUnstable && curves.iter().any(other) {
        let swatch = Swatch::Line(INK, curve_lines::OTHER_WIDTH, None);
        entries.push((swatch, Rich::plain("other crossings")));
    }
    entries
}

/// Whether the field jumps at the boundary of stability.
fn changes_at_boundary(field: Field) -> bool {
    field == Field::Regime || (field.of_sliding() && field.storage() == Storage::Count)
}

/// The cells of a panel, cut along the boundaries of the field: of stability, or of every number of
/// unstable roots.
pub(super) fn cut(
    map: &MapFile,
    (x, y): (usize, usize),
    (index, field): (&[usize], Field),
    panel: &Panel,
    known: Known,
    (curves, found): (&[&MapCurve], &Curves),
    u: f64,
) -> Result<Known, PictureError> {
    if !changes_at_boundary(field) || found.missing.is_some() {
        return Ok(known);
    }
    let turned = found.turned;
    if field == Field::NUnstable {
        let crossings = curves.iter().filter(|c| c.degree_of_stability == 0.0);
        let pieces: Vec<_> = crossings.map(|curve| &curve.piece).collect();
        let upright = turned.then(|| divisions::turned(&known));
        let counts = Counts::of(&pieces, upright.as_ref().unwrap_or(&known));
        return Ok(fitted(panel, known, (&counts, turned), u));
    }
    let bounding = curves.iter().filter(|curve| curve.bounds_stability());
    let pieces: Vec<_> = bounding.map(|curve| &curve.piece).collect();
    let Some(field) = map.stability_field().filter(|_| !pieces.is_empty()) else {
        return Ok(known);
    };
    let (p, q) = if turned { (y, x) } else { (x, y) };
    let told = map.plane(field, index, (q, p), MOST_TOLD)?;
    let [ps, qs] = [p, q].map(|axis| &map.axes()[axis].values[..]);
    let without_crossing = |p: f64| stable_throughout(&told, field, &pieces, p);
    let sides = Sides::of(&pieces, (ps, qs), &without_crossing);
    Ok(fitted(panel, known, (&sides, turned), u))
}

fn draw_cells(panel: &Panel, known: &Known, key: &Key, scene: &mut Scene) {
    let columns = panel.x.filling_edges(&known.plane.columns).into_iter();
    let rows = panel.y.filling_edges(&known.plane.rows).into_iter();
    let columns: Vec<f64> = columns.map(|x| panel.across(x)).collect();
    let rows: Vec<f64> = rows.map(|y| panel.up(y)).collect();
    let cells = known.plane.cells.iter().zip(&known.gaps);
    let colours = cells.map(|(value, gap)| gap.map_or_else(|| key.colour(*value), Gap::ground));
    scene.marks.push(Mark::Cells {
        columns: columns.clone(),
        rows: rows.clone(),
        colours: colours.collect(),
    });
    hatch::draw(&columns, &rows, &known.gaps, scene);
}
