//! Answers about a map's cells and curves, made in the process that reads the map.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::described::{CellValue, CurvesHead, MapCell, WindowAt, WindowAxis, WindowHead};
use super::description::unit;
use super::frames::{CellQuery, CurvesQuery, MOST_PIXELS, Refused, ScaleName, WindowQuery};
use crate::explore::chart::ChartCurve;
use crate::explore::chart_bytes::CurveHead;
use crate::explore::encoded::Arrays;
use crate::linear::status::FLAGS;
use crate::maps::look::as_text::CellTexts;
use crate::maps::look::{
    Asked, BEYOND, Facts, Look, Numbers, Scale, Shot, Shown, Stretch, UNREAD, changes,
};
use crate::meaning::gap::Rule;
use crate::meaning::shown::{Cells, Column};
use crate::setting::Field;
use crate::setting::field::Storage;
use crate::sweep::engine::{FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL};

/// How long an answer waits for a complete window; after that it has what was read so far.
const PATIENCE: Duration = Duration::from_millis(250);
/// The most bytes of the values of a window: half as many reals.
const MOST_BYTES: usize = MOST_PIXELS * MOST_PIXELS * 4;

/// The axis with this name.
fn axis_of(facts: &Facts, name: &str) -> Result<usize, Refused> {
    let found = facts
        .axes
        .iter()
        .position(|axis| axis.parameter.name() == name);
    found.ok_or_else(|| Refused::asked(format!("the map has no axis {}", shortened(name))))
}

/// A text shortened for a message.
fn shortened(text: &str) -> String {
    let short: String = text.chars().take(40).collect();
    format!("{short:?}")
}

/// The index along each axis that `at` names; none for the other axes.
fn indices(facts: &Facts, at: &str) -> Result<Vec<Option<usize>>, Refused> {
    let mut found = vec![None; facts.axes.len()];
    for part in at.split(',').filter(|part| !part.is_empty()) {
        let (name, index) = part
            .split_once(':')
            .ok_or_else(|| Refused::asked(format!("{} is not AXIS:INDEX", shortened(part))))?;
        let axis = axis_of(facts, name)?;
        let points = facts.axes[axis].values.len();
        let index: Option<usize> = index.parse().ok().filter(|&index| index < points);
        let index = index.ok_or_else(|| {
            Refused::asked(format!("an index along {name} is 0 to {}", points - 1))
        })?;
        if found[axis].replace(index).is_some() {
            return Err(Refused::asked(format!("{name} is given twice")));
        }
    }
    Ok(found)
}

fn pixels(asked: Option<usize>, points: usize) -> Result<usize, Refused> {
    let pixels = asked.unwrap_or(points.min(MOST_PIXELS));
    match (1..=MOST_PIXELS).contains(&pixels) {
        true => Ok(pixels),
        false => Err(Refused::asked(format!("w and h are 1 to {MOST_PIXELS}"))),
    }
}

/// The window described by a query.
fn asked(facts: &Facts, query: &WindowQuery) -> Result<Asked, Refused> {
    let held = Field::from_name(&query.field).filter(|field| facts.fields.contains(field));
    let field = held.ok_or_else(|| {
        Refused::asked(format!("the map has no field {}", shortened(&query.field)))
    })?;
    let x = axis_of(facts, &query.x)?;
    let y = query
        .y
        .as_deref()
        .map(|name| axis_of(facts, name))
        .transpose()?;
    if y == Some(x) {
        return Err(Refused::asked("x and y are the same axis"));
    }
    let stretch = |axis: usize, ends: [Option<f64>; 2], asked, scale| -> Result<_, Refused> {
        Ok(Stretch {
            from: ends[0],
            to: ends[1],
            pixels: pixels(asked, facts.axes[axis].values.len())?,
            scale: match scale {
                ScaleName::Linear => Scale::Linear,
                ScaleName::Log => Scale::Log,
            },
        })
    };
    let across = stretch(x, [query.x0, query.x1], query.w, query.xscale)?;
    let up = stretch(y.unwrap_or(x), [query.y0, query.y1], query.h, query.yscale)?;
    let pixels = across.pixels * y.map_or(1, |_| up.pixels);
    if pixels * field.bytes() > MOST_BYTES {
        let most = MOST_BYTES / field.bytes();
        let detail = format!("a window on {} has at most {most} pixels", field.name());
        return Err(Refused::asked(detail));
    }
    let at = indices(facts, &query.at)?;
    Ok(Asked {
        field,
        x,
        y,
        at: at.into_iter().map(Option::unwrap_or_default).collect(),
        across,
        up,
    })
}

/// A window, as far as it was read, in two parts. `one` is locked while they are encoded.
pub(super) fn window(
    look: &Look,
    query: &WindowQuery,
    one: &Mutex<()>,
) -> Result<[Vec<u8>; 2], Refused> {
    let begun = Instant::now();
    let asked = asked(look.facts(), query)?;
    let read = |asked: &Asked| look.window(asked, PATIENCE).map_err(Refused::asked);
    let guard = || one.lock().unwrap_or_else(PoisonError::into_inner);
    let view = read(&asked)?;
    let held = guard();
    let shot = view.shot(look.facts());
    let rule = Rule::of(asked.field, &look.facts().fields);
    let Some(field) = rule.why().filter(|_| shot.complete && has_empty(&shot)) else {
        return encoded(look, &asked, (shot, None), begun).map_err(Refused::damaged);
    };
    // The other field is read without the lock.
    drop(held);
    let other = read(&Asked {
        field,
        ..asked.clone()
    })?;
    let _held = guard();
    let why = Some(other.shot(look.facts()));
    encoded(look, &asked, (shot, why), begun).map_err(Refused::damaged)
}

/// Whether some cell that was read has no value.
fn has_empty(shot: &Shot) -> bool {
    let values = column(&shot.values);
    let mut bits = shot.bits.iter().enumerate();
    bits.any(|(pixel, bits)| bits & (UNREAD | BEYOND) == 0 && values.value(pixel).is_nan())
}

fn column(numbers: &Numbers) -> Column<'_> {
    match numbers {
        Numbers::U8(values) => Column::U8(values),
        Numbers::U16(values) => Column::U16(values),
        Numbers::F64(values) => Column::F64(values),
    }
}

fn encoded(
    look: &Look,
    asked: &Asked,
    (shot, why): (Shot, Option<Shot>),
    begun: Instant,
) -> Result<[Vec<u8>; 2], serde_json::Error> {
    let facts = look.facts();
    let mut arrays = Arrays::default();
    let mut axis = |axis: usize, shown: &Shown| WindowAxis {
        name: facts.axes[axis].parameter.name().to_owned(),
        index: arrays.push(shown.index.iter().copied()),
        values: arrays.push(shown.values.iter().copied()),
    };
    let x = axis(asked.x, &shot.x);
    let y = shot
        .y
        .as_ref()
        .zip(asked.y)
        .map(|(shown, y)| axis(y, shown));
    let cells = Cells {
        field: asked.field,
        unit: &unit(look, asked.field),
        rule: Rule::of(asked.field, &facts.fields),
        values: column(&shot.values),
        status: &shot.status,
        why: why.as_ref().map(|why| column(&why.values)),
    };
    // Many pixels may show the same cell.
    let index = |column: usize| shot.x.index[column];
    let across: Vec<u32> = shot.columns.firsts().map(index).collect();
    let across: Vec<bool> = changes(&across).collect();
    let up = shot.y.as_ref().map_or(&[0][..], |y| &y.index);
    let up: Vec<bool> = changes(up).collect();
    let (columns, height) = (&shot.columns, shot.columns.height);
    let (shown, gaps) = cells.shown(
        |pixel| shot.bits[pixel] & (UNREAD | BEYOND) != 0,
        |pixel| !across[pixel / height] || !up[pixel % height],
    );
    let head = WindowHead {
        complete: shot.complete && why.as_ref().is_none_or(|why| why.complete),
        progress: shot.progress,
        version: shot.version,
        field: asked.field.name(),
        x,
        y,
        at: at(facts, &asked.at, &[Some(asked.x), asked.y]),
        status: arrays.push_runs(&columns.all(&shot.status)),
        gaps: arrays.push_runs(&columns.all(&gaps)),
        shown,
        bits: arrays.push_runs(&columns.all(&shot.bits)),
        values: match &shot.values {
            Numbers::U8(values) => arrays.push_runs(&columns.all(values)),
            Numbers::U16(values) => arrays.push_runs(&columns.all(values)),
            Numbers::F64(values) => arrays.push_runs(&columns.all(values)),
        },
        damage: shot.damage.or(why.and_then(|why| why.damage)),
        milliseconds: begun.elapsed().as_secs_f64() * 1e3,
    };
    arrays.parts(&head)
}

/// The place of a plane along the axes that do not span it.
fn at(facts: &Facts, index: &[usize], spanned: &[Option<usize>]) -> Vec<WindowAt> {
    let axes = facts.axes.iter().zip(index).enumerate();
    axes.filter(|(axis, _)| !spanned.contains(&Some(*axis)))
        .map(|(_, (axis, &index))| WindowAt {
            name: axis.parameter.name().to_owned(),
            index,
            value: axis.values[index],
        })
        .collect()
}

/// The curves of a plane, x and y vertex by vertex; none where the map's curves are in other
/// planes.
pub(super) fn curves(look: &Look, query: &CurvesQuery) -> Result<Vec<u8>, Refused> {
    let facts = look.facts();
    let (x, y) = (axis_of(facts, &query.x)?, axis_of(facts, &query.y)?);
    let index = indices(facts, &query.at)?;
    let index: Vec<usize> = index.into_iter().map(Option::unwrap_or_default).collect();
    let plane = look.curves_plane();
    let found = match plane {
        Some(plane) if plane == (x, y) || plane == (y, x) => look.curves(&index),
        _ => Ok(Vec::new()),
    };
    let p_is_x = plane.is_some_and(|(p, _)| p == x);
    let mut arrays = Arrays::default();
    let found = found.map_err(Refused::damaged)?;
    let curves = found.iter().map(|curve| {
        let mut curve = ChartCurve::of(curve.degree_of_stability, &curve.piece);
        if !p_is_x {
            curve
                .vertices
                .iter_mut()
                .for_each(|vertex| vertex.reverse());
        }
        CurveHead::of(&curve, &mut arrays)
    });
    let head = CurvesHead {
        curves: curves.collect(),
        version: look.version().0,
    };
    arrays.behind(&head).map_err(Refused::damaged)
}

/// A number in a form that JSON allows.
fn number(value: f64) -> CellValue {
    match value {
        f64::INFINITY => CellValue::Infinite("inf"),
        f64::NEG_INFINITY => CellValue::Infinite("-inf"),
        _ if value.is_nan() => CellValue::None,
        _ => CellValue::Number(value),
    }
}

/// One cell: its values, and the requests about it.
pub(super) fn cell(look: &Look, query: &CellQuery) -> Result<MapCell, Refused> {
    let facts = look.facts();
    let index: Option<Vec<usize>> = indices(facts, &query.at)?.into_iter().collect();
    let index = index.ok_or_else(|| Refused::asked("a cell has an index along every axis"))?;
    let bits = |column: usize| look.cell(column, &index).map_err(Refused::damaged);
    let (mut fields, mut kinds) = (BTreeMap::new(), BTreeMap::new());
    for (column, field) in facts.fields.iter().enumerate() {
        let bits = bits(column)?;
        let value = match field.storage() {
            Storage::Real => number(f64::from_bits(bits)),
            Storage::Count if bits == u64::from(N_UNSTABLE_FILL) => CellValue::None,
            Storage::Kind | Storage::Few if bits == u64::from(FEW_FILL) => CellValue::None,
            _ => CellValue::Count(bits),
        };
        if let Some(names) = field.kinds() {
            kinds.insert(field.name(), names.get(bits as usize).copied());
        }
        fields.insert(field.name(), value);
    }
    let status = bits(facts.status())?;
    let computed = status != u64::from(STATUS_FILL);
    let flags = FLAGS
        .iter()
        .filter(|(mask, _)| computed && status & u64::from(*mask) != 0);
    let axes = facts.axes.iter().zip(&index);
    let texts = facts.plan.as_ref().map(|plan| CellTexts::of(plan, &index));
    let texts = texts.unwrap_or_default();
    Ok(MapCell {
        axes: axes
            .map(|(axis, &i)| (axis.parameter.name().to_owned(), axis.values[i]))
            .collect(),
        fields,
        kinds,
        status: flags.map(|(_, name)| *name).collect(),
        computed,
        point: texts.point,
        vc: texts.vc,
        motion: texts.motion,
        command: texts.command,
    })
}
