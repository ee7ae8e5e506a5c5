//! A small picture of a map for the terminal.

use super::numbers::short;
use crate::store::map_file::{MapAxis, Plane};
use crate::store::{MapFile, StoreError};
use crate::sweep::input::field::Storage;
use crate::sweep::{Field, Parameter};

/// Lines of the picture itself; captions take three more.
const MOST_LINES: usize = 16;
/// Columns of the picture.
const COLUMNS: std::ops::RangeInclusive<usize> = 10..=160;
/// Cells are read at most this finely, and shown by the one nearest to each place.
const MOST_CELLS: usize = 640;

/// Stable, 2, 4 and more unstable roots, no value: colours of the 256-colour palette.
const COLOURS: [u8; 5] = [37, 230, 180, 136, 250];
/// The characters of a preview without colours.
const SHADES: [char; 5] = ['█', ' ', '░', '▒', '?'];

/// What the map looks like, in text of at most 19 lines and `width` columns; none where the map
/// tells neither regimes, outcomes nor what is stable, or has fewer than two axes with more than
/// one value. `colour`: with ANSI escapes, two rows of cells in each line.
///
/// Axes outside the plane are held at their middle value.
///
/// # Errors
/// When the map cannot be read.
pub fn preview(map: &MapFile, width: usize, colour: bool) -> Result<Option<String>, StoreError> {
    let held = |field: &Field| map.fields().contains(field);
    // How stick-slip ends is no matter of so few kinds.
    let of_motions =
        Some(Field::Outcome).filter(|f| held(f) && !map.fields().iter().any(|f| f.of_vc()));
    let kinds = Some(Field::Regime).filter(held).or(of_motions);
    let shown = kinds.or_else(|| map.stability_field());
    let (Some((x, y)), Some(field)) = (plane_axes(map), shown) else {
        return Ok(None);
    };
    let index: Vec<usize> = map.axes().iter().map(|a| a.values.len() / 2).collect();
    let mut plane = map.plane(field, &index, (y, x), MOST_CELLS)?;
    if field.storage() != Storage::Count {
        plane
            .cells
            .iter_mut()
            .for_each(|v| *v = as_count(field, *v));
    }
    let captions = Captions::new(map, (x, y), &index, field);
    let Some(columns) = width.checked_sub(captions.margin + 2) else {
        return Ok(None);
    };
    if columns < *COLUMNS.start() {
        return Ok(None);
    }
    let columns = columns.min(*COLUMNS.end());
    let picture = if colour {
        coloured(&plane, columns)
    } else {
        shaded(&plane, columns)
    };
    Ok(Some(captions.around(&picture, columns, colour)))
}

/// The least number of unstable roots that goes with a value. Outcomes and regimes are shown like
/// 0, 2, 4 and 6 roots.
fn as_count(field: Field, value: f64) -> f64 {
    if field.storage() == Storage::Kind {
        return if value <= 3.0 { 2.0 * value } else { f64::NAN };
    }
    match field.tells_stable(value) {
        Some(stable) if !value.is_nan() => f64::from(u8::from(!stable)),
        _ => f64::NAN,
    }
}

/// The axes from left to right and from bottom to top.
fn plane_axes(map: &MapFile) -> Option<(usize, usize)> {
    let long = |a: &usize| map.axes()[*a].values.len() > 1;
    let long: Vec<usize> = (0..map.axes().len()).filter(long).collect();
    match (map.boundary_plane(), long.as_slice()) {
        (Some((p, tau)), long) if long.contains(&p) && long.contains(&tau) => Some((p, tau)),
        (_, &[.., a, b]) if map.axes()[a].parameter == Parameter::Tau => Some((b, a)),
        (_, &[.., a, b]) => Some((a, b)),
        _ => None,
    }
}

/// The kind of the cell at parts of the way from left to right and from bottom to top: an index of
/// [`COLOURS`].
fn kind(plane: &Plane, across: f64, up: f64) -> usize {
    let (column, row) = (place(&plane.columns, across), place(&plane.rows, up));
    match plane.cells.get(row * plane.columns.len() + column) {
        Some(0.0) => 0,
        Some(&n) if n <= 2.0 => 1,
        Some(&n) if n <= 4.0 => 2,
        Some(n) if n.is_finite() => 3,
        _ => 4,
    }
}

/// The index of the value at a part of the way, whichever way the values run.
fn place(values: &[f64], part: f64) -> usize {
    let growing = values.first() <= values.last();
    let part = if growing { part } else { 1.0 - part };
    ((part * values.len() as f64) as usize).min(values.len().saturating_sub(1))
}

fn part(i: usize, n: usize) -> f64 {
    (i as f64 + 0.5) / n as f64
}

fn coloured(plane: &Plane, columns: usize) -> Vec<String> {
    let rows = 2 * MOST_LINES;
    let line = |line: usize| {
        let mut text = String::new();
        let mut last = None;
        for column in 0..columns {
            let at = |row: usize| kind(plane, part(column, columns), 1.0 - part(row, rows));
            let pair = (COLOURS[at(2 * line)], COLOURS[at(2 * line + 1)]);
            if last.replace(pair) != Some(pair) {
                text += &format!("\x1b[38;5;{};48;5;{}m", pair.0, pair.1);
            }
            text.push('▀');
        }
        text + "\x1b[0m"
    };
    (0..MOST_LINES).map(line).collect()
}

fn shaded(plane: &Plane, columns: usize) -> Vec<String> {
    let line = |line: usize| {
        let up = 1.0 - part(line, MOST_LINES);
        let cell = |column| SHADES[kind(plane, part(column, columns), up)];
        (0..columns).map(cell).collect()
    };
    (0..MOST_LINES).map(line).collect()
}

/// What is written around the picture.
struct Captions {
    top: String,
    bottom: String,
    x: String,
    ends: (String, String),
    margin: usize,
    /// What the shades mean.
    kinds: &'static [&'static str],
}

impl Captions {
    fn new(map: &MapFile, (x, y): (usize, usize), index: &[usize], field: Field) -> Self {
        let (x_axis, y_axis) = (&map.axes()[x], &map.axes()[y]);
        let (bottom, top) = ends(y_axis);
        let y_symbol = y_axis.parameter.symbol();
        let top = format!("{y_symbol} = {top}");
        let margin = [&top, &bottom].map(|t| t.chars().count());
        let held = (0..map.axes().len()).filter(|&a| a != x && a != y);
        let held: Vec<String> = held
            .map(|a| (&map.axes()[a], index[a]))
            .map(|(axis, i)| format!("{} = {}", axis.parameter.symbol(), axis.values[i]))
            .collect();
        Self {
            ends: ends(x_axis),
            x: [vec![x_axis.parameter.symbol().to_owned()], held]
                .concat()
                .join(", at "),
            margin: margin.into_iter().max().unwrap_or(0),
            top,
            bottom,
            kinds: match field.storage() {
                Storage::Count => &["stable", "2", "4", "6 or more unstable roots"],
                Storage::Kind if field == Field::Regime => {
                    &["stable", "bistable", "unstable", "lift-off", "others"]
                }
                Storage::Kind => &["sliding", "stick-slip", "oscillation", "lift-off", "others"],
                Storage::Real | Storage::Few => &["stable", "unstable"],
            },
        }
    }

    fn around(&self, picture: &[String], columns: usize, colour: bool) -> String {
        let margin = self.margin;
        let mut text = String::new();
        for (i, line) in picture.iter().enumerate() {
            let caption = match i {
                0 => &self.top,
                _ if i + 1 == picture.len() => &self.bottom,
                _ => "",
            };
            text += &format!("{caption:>margin$} {line}\n");
        }
        let (left, right) = &self.ends;
        let middle = columns.saturating_sub(left.chars().count() + right.chars().count());
        text += &format!("{:margin$} {left}{:^middle$}{right}\n", "", self.x);
        text + &format!("{:margin$} {}\n", "", key(self.kinds, colour))
    }
}

fn ends(axis: &MapAxis) -> (String, String) {
    let low = axis.values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = axis
        .values
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    (short(low), short(high))
}

fn key(names: &[&str], colour: bool) -> String {
    let entries = names.iter().zip(COLOURS).zip(SHADES);
    let entry = |((name, code), shade): ((&&str, u8), char)| match colour {
        true => format!("\x1b[38;5;{code}m██\x1b[0m {name}"),
        false => format!("[{shade}] {name}"),
    };
    entries.map(entry).collect::<Vec<_>>().join("   ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane() -> Plane {
        // Stable above the diagonal; the columns run downwards, as mu_prime often does.
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        let cell = |i: usize| if i / 100 > 99 - i % 100 { 0.0 } else { 4.0 };
        Plane {
            rows: values.clone(),
            columns: values.iter().rev().copied().collect(),
            cells: (0..10_000).map(cell).collect(),
        }
    }

    #[test]
    fn up_is_up_and_left_is_small() {
        let lines = shaded(&plane(), 40);
        assert_eq!(lines.len(), MOST_LINES);
        let corner = |line: usize, end: bool| {
            let mut characters = lines[line].chars();
            if end {
                characters.next_back()
            } else {
                characters.next()
            }
        };
        assert_eq!(corner(0, false), Some('█'));
        assert_eq!(corner(MOST_LINES - 1, true), Some('░'));
        assert!(lines.iter().all(|l| l.chars().count() == 40));
    }

    #[test]
    fn colours_end_with_each_line() {
        for line in coloured(&plane(), 30) {
            assert_eq!(line.matches('▀').count(), 30);
            assert!(line.ends_with("\x1b[0m"));
        }
    }
}
