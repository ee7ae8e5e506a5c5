//! The crossing curves of a map as rows, one for each vertex.

use std::io::Write;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use super::cells::{about, of_axis};
use super::speeds::SpeedColumn;
use super::{Column, Table, TableError};
use crate::linear::Direction;
use crate::store::MapFile;
use crate::store::map_file::MapCurve;
use crate::sweep::described::curve_words::{
    CURVE_KINDS, DIRECTIONS, direction_along, stable_sides,
};
use crate::sweep::described::schema::DEGREE_OF_STABILITY;

/// Writes the curves of a map, one row per vertex: the number of the curve, the axes outside its
/// plane, its degree of stability, branch, direction, stable side and kind, then the vertex, with
/// the speed behind a delay that is its period. Axes
/// outside the plane with an index in `held` are written at that index alone. Returns the number of
/// rows; none for a map without curves.
///
/// # Errors
/// When the map cannot be read or the text cannot be written, and once `stop` is set.
pub fn write_curves(
    map: &MapFile,
    held: &[Option<usize>],
    comments: bool,
    out: impl Write,
    stop: &AtomicBool,
) -> Result<Option<u64>, TableError> {
    let Some((p, tau)) = map.boundary_plane() else {
        return Ok(None);
    };
    let axes = map.axes();
    let outer: Vec<usize> = (0..axes.len())
        .filter(|&axis| axis != p && axis != tau)
        .collect();
    let about = comments.then(|| about(map));
    let speed = SpeedColumn::of(map).filter(|_| SpeedColumn::is_behind(&axes[tau]));
    let columns = columns(map, &outer, [p, tau], speed.as_ref());
    let mut table = Table::begin(out, about.as_ref(), &columns)?;
    let wanted: Vec<Option<f64>> = outer
        .iter()
        .map(|&axis| held[axis].map(|index| axes[axis].values[index]))
        .collect();
    let shown = |curve: &MapCurve| {
        let mut values = curve.outer.iter().zip(&wanted);
        values.all(|(value, wanted)| wanted.is_none_or(|wanted| wanted == *value))
    };
    let sides = stable_sides([&axes[p].parameter, &axes[tau].parameter]);
    let mut number = 0;
    let mut written = Ok(());
    map.for_each_curve(|curve| {
        if stop.load(Ordering::Relaxed) {
            written = Err(TableError::Stopped);
        } else if shown(&curve) {
            written = write_curve(&mut table, &sides, number, (&curve, speed.as_ref()));
        }
        number += 1;
        match written {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    })?;
    written?;
    table.finish().map(Some)
}

fn columns(
    map: &MapFile,
    outer: &[usize],
    plane: [usize; 2],
    speed: Option<&SpeedColumn>,
) -> Vec<Column> {
    let degree = "degree of stability: roots on the curve have this real part, negated";
    let omega = map.units().angular_frequency();
    let omega = Column::of("omega", omega, "crossing frequency");
    let direction = direction_along(&map.axes()[plane[1]].parameter);
    let of_curve = [
        Column::of(DEGREE_OF_STABILITY, map.degree_unit(), degree),
        Column::of("branch", "", "branch number k of the crossing delay"),
        Column::of("direction", "", &direction),
        Column::of(
            "stable_side",
            "",
            "side of the curve on which sliding is stable",
        ),
        Column::of("kind", "", "what lies on the line along the curve"),
    ];
    let number = Column::of("curve", "", "number of the curve, in the order of the map");
    let names = map.names_in_curves();
    let of_axis = |&axis: &usize| of_axis(&map.axes()[axis]).called(&names[axis]);
    let outer = outer.iter().map(of_axis);
    let vertex = plane.iter().map(of_axis);
    let vertex = vertex.chain(speed.map(SpeedColumn::column)).chain([omega]);
    [number]
        .into_iter()
        .chain(outer)
        .chain(of_curve)
        .chain(vertex)
        .collect()
}

/// A word of a list.
fn word(words: &str, place: usize) -> &str {
    words.split(' ').nth(place).unwrap_or("")
}

fn write_curve(
    table: &mut Table<impl Write>,
    sides: &str,
    number: u64,
    (curve, speed): (&MapCurve, Option<&SpeedColumn>),
) -> Result<(), TableError> {
    let piece = &curve.piece;
    let direction = match piece.direction {
        Direction::Left => 0,
        Direction::Touch => 1,
        Direction::Right => 2,
    };
    let side = (piece.stable_side.sign() + 2) as usize;
    let kind = usize::from(piece.kind.number().unsigned_abs());
    for vertex in &piece.vertices {
        table.whole(number)?;
        for &value in &curve.outer {
            table.number(value)?;
        }
        table.number(curve.degree_of_stability)?;
        table.whole(piece.branch)?;
        table.text(word(DIRECTIONS, direction))?;
        table.text(word(sides, side))?;
        table.text(word(CURVE_KINDS, kind))?;
        for value in [vertex.p, vertex.q] {
            table.number(value)?;
        }
        if let Some(speed) = speed {
            table.number(speed.at(vertex.q))?;
        }
        table.number(vertex.omega)?;
        table.end_row()?;
    }
    Ok(())
}
