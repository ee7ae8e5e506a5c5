//! The cells of a map as rows: axes, fields, the status.

use std::borrow::Cow;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use super::speeds::SpeedColumn;
use super::{About, Column, Table, TableError, put_number};
use crate::linear::status::FLAGS;
use crate::setting::Field;
use crate::store::cell_blocks::CellBlock;
use crate::store::{MapAxis, MapFile};
use crate::sweep::described::schema::{STATUS, root};
use crate::sweep::engine::STATUS_FILL;

/// The most values of an axis whose texts are kept; for more, texts are made again for each cell.
const MOST_TEXTS: usize = 1 << 16;

/// Writes the cells of a map, one row each, the last axis fastest: all axes, with the speed behind
/// a delay that is its period, `fields`, the status. Axes with an index in `held` are written at
/// that index alone. Returns the number of rows. Few cells are in memory at once. Kinds are words;
/// counts and the status are whole numbers.
///
/// # Errors
/// When the map cannot be read or the text cannot be written, and once `stop` is set.
pub fn write_cells(
    map: &MapFile,
    fields: &[Field],
    held: &[Option<usize>],
    comments: bool,
    out: impl Write,
    stop: &AtomicBool,
) -> Result<u64, TableError> {
    let about = comments.then(|| about(map));
    let speed = SpeedColumn::of(map);
    let columns = columns(map, fields, speed.as_ref());
    let mut table = Table::begin(out, about.as_ref(), &columns)?;
    let axes = axis_texts(map, speed.as_ref());
    let kinds: Vec<Option<Vec<&str>>> = fields.iter().map(|field| field.kinds()).collect();
    map.for_each_block(fields, held, |block| {
        write_block(&mut table, block, &axes, &kinds, stop)
    })?;
    table.finish()
}

/// The description of a map for the comments.
pub(super) fn about(map: &MapFile) -> About {
    let held = |name| map.root_text(name);
    let start = map
        .sweep()
        .ok()
        .and_then(|of| of.simulation.assumed_start());
    let texts = [
        ("title", held(root::TITLE)),
        ("friction", held(root::FRICTION_LAW)),
        ("protocol", held(root::PROTOCOL)),
        ("start", start),
        ("made by", held(root::SOURCE)),
        ("revision", held(root::GIT_REVISION)),
    ];
    About::new(texts, map.scalars(), map.units())
}

/// The column of an axis.
pub(super) fn of_axis(axis: &MapAxis) -> Column {
    Column::of_parameter(&axis.parameter, &axis.unit)
}

/// The columns of an axis: its own and, behind the delay, that of the speed.
fn with_speed<'a>(
    axis: &'a MapAxis,
    speed: Option<&'a SpeedColumn>,
) -> impl Iterator<Item = Column> + 'a {
    let speed = speed.filter(|_| SpeedColumn::is_behind(axis));
    [of_axis(axis)]
        .into_iter()
        .chain(speed.map(SpeedColumn::column))
}

fn columns(map: &MapFile, fields: &[Field], speed: Option<&SpeedColumn>) -> Vec<Column> {
    let of_field =
        |field: &Field| Column::of(field.name(), map.field_unit(*field), map.long_name(*field));
    let flags = FLAGS
        .map(|(mask, name)| format!("{mask} {name}"))
        .join(", ");
    let status = Column::of(
        STATUS,
        "",
        format!("status of the cell, the sum of {flags}"),
    );
    let axes = map.axes().iter().flat_map(|axis| with_speed(axis, speed));
    axes.chain(fields.iter().map(of_field))
        .chain([status])
        .collect()
}

/// The values along an axis, as texts if there are few.
struct AxisTexts<'a> {
    axis: usize,
    values: Cow<'a, [f64]>,
    texts: Vec<String>,
}

/// The values along all axes, behind the delay those of its speed as well.
fn axis_texts<'a>(map: &'a MapFile, speed: Option<&SpeedColumn>) -> Vec<AxisTexts<'a>> {
    let mut all = Vec::new();
    for (number, axis) in map.axes().iter().enumerate() {
        all.push(AxisTexts::of(number, Cow::Borrowed(&*axis.values)));
        if let Some(speed) = speed.filter(|_| SpeedColumn::is_behind(axis)) {
            let speeds = axis.values.iter().map(|delay| speed.at(*delay)).collect();
            all.push(AxisTexts::of(number, Cow::Owned(speeds)));
        }
    }
    all
}

impl<'a> AxisTexts<'a> {
    fn of(axis: usize, values: Cow<'a, [f64]>) -> Self {
        let few = if values.len() <= MOST_TEXTS {
            &values[..]
        } else {
            &[]
        };
        let text = |value: &f64| {
            let mut text = String::new();
            put_number(&mut text, *value);
            text
        };
        let texts = few.iter().map(text).collect();
        Self {
            axis,
            values,
            texts,
        }
    }

    fn write(&self, index: &[usize], table: &mut Table<impl Write>) -> Result<(), TableError> {
        let index = index[self.axis];
        match self.texts.get(index) {
            Some(text) => table.text(text),
            None => table.number(self.values[index]),
        }
    }
}

fn write_block(
    table: &mut Table<impl Write>,
    block: &CellBlock,
    axes: &[AxisTexts],
    kinds: &[Option<Vec<&str>>],
    stop: &AtomicBool,
) -> Result<(), TableError> {
    let mut index = block.first.clone();
    for cell in 0..block.status.len() {
        // The flag is checked only now and then.
        if cell.is_multiple_of(1024) && stop.load(Ordering::Relaxed) {
            return Err(TableError::Stopped);
        }
        for axis in axes {
            axis.write(&index, table)?;
        }
        for (values, kinds) in block.fields.iter().zip(kinds) {
            let value = values[cell];
            match kinds {
                Some(names) if !value.is_nan() => {
                    table.text(names.get(value as usize).copied().unwrap_or(""))?;
                }
                _ => table.number(value)?,
            }
        }
        match block.status[cell] {
            STATUS_FILL => table.text("")?,
            status => table.whole(u64::from(status))?,
        }
        table.end_row()?;
        advance(&mut index, block);
    }
    Ok(())
}

/// The index of the next cell of a block, last axis fastest.
fn advance(index: &mut [usize], block: &CellBlock) {
    for axis in (0..index.len()).rev() {
        index[axis] += 1;
        if index[axis] < block.first[axis] + block.extent[axis] {
            return;
        }
        index[axis] = block.first[axis];
    }
}
