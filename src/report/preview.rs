//! A small picture of a map for the terminal.

use super::known::Known;
use super::numbers::short;
use crate::meaning::gap::Gap;
use crate::setting::field::Storage;
use crate::setting::{Field, Parameter};
use crate::store::map_file::MapAxis;
use crate::store::{MapFile, StoreError};

/// The most lines of the picture itself; captions take three more.
const MOST_LINES: usize = 16;
/// Columns of the picture.
const COLUMNS: std::ops::RangeInclusive<usize> = 10..=160;
/// The most cells that are read along an axis; each place shows the nearest one.
const MOST_CELLS: usize = 640;

/// Colours of the 256-colour palette: stable, 2, 4 and more unstable roots, other kinds or no
/// value, not known, not computed; 1, 3 and 5 unstable roots.
const COLOURS: [u8; 10] = [37, 230, 180, 136, 250, 255, 16, 189, 140, 97];
/// The characters of a preview without colours.
const SHADES: [char; 10] = ['█', ' ', '░', '▒', '?', '/', '.', '-', '+', '#'];
/// Place in both lists from which on cells have no value to show.
const OTHERS: usize = 4;
const UNKNOWN: usize = 5;
const NOT_COMPUTED: usize = 6;
/// Place in both lists of the first odd number of roots.
const ODD: usize = 7;
/// The colour of the hatching.
const HATCH: u8 = 240;

/// The map as text of at most 19 lines and `width` columns. None where the map has neither regimes,
/// outcomes nor stability, or fewer than two axes with more than one value. With `colour`, it has
/// ANSI escapes and two rows of cells in each line.
///
/// Axes outside the plane are held at their middle value.
///
/// # Errors
/// When the map cannot be read.
pub fn preview(map: &MapFile, width: usize, colour: bool) -> Result<Option<String>, StoreError> {
    let held = |field: &Field| map.fields().contains(field);
    // The ends of stick-slip have too many kinds for this.
    let of_motions =
        Some(Field::Outcome).filter(|f| held(f) && !map.fields().iter().any(|f| f.of_vc()));
    let kinds = Some(Field::Regime).filter(held).or(of_motions);
    let shown = kinds.or_else(|| map.stability_field());
    let (Some((x, y)), Some(field)) = (plane_axes(map), shown) else {
        return Ok(None);
    };
    let index: Vec<usize> = map.axes().iter().map(|a| a.values.len() / 2).collect();
    let mut known = Known::read(map, field, &index, (y, x), MOST_CELLS)?;
    if field.storage() != Storage::Count {
        let cells = known.plane.cells.iter_mut();
        cells.for_each(|v| *v = as_count(field, *v));
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
        coloured(&known, columns)
    } else {
        shaded(&known, columns)
    };
    let there = |of: fn(&Gap) -> bool| known.gaps.iter().flatten().any(of);
    let count = |n: usize| known.plane.cells.contains(&(n as f64));
    let captions = Captions {
        odd: [1, 3, 5].map(count),
        unknown: there(|gap| gap.is_unknown()),
        not_computed: there(|gap| *gap == Gap::NotComputed),
        ..captions
    };
    Ok(Some(captions.around(&picture, columns, colour)))
}

/// The smallest number of unstable roots for a value. Outcomes and regimes are shown like 0, 2, 4
/// and 6 roots.
fn as_count(field: Field, value: f64) -> f64 {
    if field.storage() == Storage::Kind {
        return if value <= 3.0 { 2.0 * value } else { f64::NAN };
    }
    match field.tells_stable(value) {
        Some(true) if !value.is_nan() => 0.0,
        Some(false) if !value.is_nan() => 2.0,
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

/// The kind, an index of [`COLOURS`], of the cell at a position from left to right and from bottom
/// to top.
fn kind(known: &Known, across: f64, up: f64) -> usize {
    let plane = &known.plane;
    let (column, row) = (place(&plane.columns, across), place(&plane.rows, up));
    let cell = row * plane.columns.len() + column;
    match known.gaps.get(cell) {
        Some(Some(Gap::NotComputed)) => return NOT_COMPUTED,
        Some(Some(gap)) if gap.is_unknown() => return UNKNOWN,
        _ => {}
    }
    match plane.cells.get(cell) {
        Some(n) if n.is_finite() => of_count(*n as usize),
        _ => OTHERS,
    }
}

/// The kind of a number of unstable roots.
fn of_count(n: usize) -> usize {
    match n {
        6.. => 3,
        n if n.is_multiple_of(2) => n / 2,
        n => ODD + n / 2,
    }
}

/// The index of the value at a position, whether values increase or decrease.
fn place(values: &[f64], part: f64) -> usize {
    let growing = values.first() <= values.last();
    let part = if growing { part } else { 1.0 - part };
    ((part * values.len() as f64) as usize).min(values.len().saturating_sub(1))
}

fn part(i: usize, n: usize) -> f64 {
    (i as f64 + 0.5) / n as f64
}

fn coloured(known: &Known, columns: usize) -> Vec<String> {
    let rows = 2 * MOST_LINES;
    let line = |line: usize| {
        let mut text = String::new();
        let mut last = None;
        for column in 0..columns {
            let at = |row: usize| kind(known, part(column, columns), 1.0 - part(row, rows));
            let kinds = (at(2 * line), at(2 * line + 1));
            let hatched = kinds == (UNKNOWN, UNKNOWN);
            let above = if hatched { HATCH } else { COLOURS[kinds.0] };
            let pair = (above, COLOURS[kinds.1]);
            if last.replace(pair) != Some(pair) {
                text += &format!("\x1b[38;5;{};48;5;{}m", pair.0, pair.1);
            }
            text.push(if hatched { '/' } else { '▀' });
        }
        text + "\x1b[0m"
    };
    (0..MOST_LINES).map(line).collect()
}

fn shaded(known: &Known, columns: usize) -> Vec<String> {
    let line = |line: usize| {
        let up = 1.0 - part(line, MOST_LINES);
        let cell = |column| SHADES[kind(known, part(column, columns), up)];
        (0..columns).map(cell).collect()
    };
    (0..MOST_LINES).map(line).collect()
}

/// The texts around the picture.
struct Captions {
    top: String,
    bottom: String,
    x: String,
    ends: (String, String),
    margin: usize,
    /// The meanings of the first shades.
    kinds: &'static [&'static str],
    /// Whether 1, 3 and 5 unstable roots occur.
    odd: [bool; 3],
    /// Whether some cells are not known, or not computed.
    unknown: bool,
    not_computed: bool,
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
            odd: [false; 3],
            unknown: false,
            not_computed: false,
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
        text + &format!("{:margin$} {}\n", "", self.key(colour))
    }

    fn key(&self, colour: bool) -> String {
        let mut names: Vec<(usize, &str)> = Vec::new();
        for (kind, name) in self.kinds.iter().enumerate() {
            names.push((kind, name));
            // An odd number stands between its neighbours.
            if self.odd.get(kind) == Some(&true) {
                names.push((ODD + kind, ["1", "3", "5"][kind]));
            }
        }
        names.extend(self.unknown.then_some((UNKNOWN, "not known")));
        names.extend(self.not_computed.then_some((NOT_COMPUTED, "not computed")));
        let entry = |(place, name): (usize, &str)| match (colour, COLOURS[place]) {
            (true, code) if place == UNKNOWN => {
                format!("\x1b[38;5;{HATCH};48;5;{code}m//\x1b[0m {name}")
            }
            (true, code) => format!("\x1b[38;5;{code}m██\x1b[0m {name}"),
            (false, _) => format!("[{}] {name}", SHADES[place]),
        };
        names.into_iter().map(entry).collect::<Vec<_>>().join("   ")
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::map_file::Plane;

    fn plane() -> Known {
        // Stable above the diagonal; the values of the columns decrease, as those of mu_prime often
        // do.
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        let cell = |i: usize| if i / 100 > 99 - i % 100 { 0.0 } else { 4.0 };
        Known {
            plane: Plane {
                rows: values.clone(),
                columns: values.iter().rev().copied().collect(),
                cells: (0..10_000).map(cell).collect(),
            },
            gaps: vec![None; 10_000],
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

    /// Unknown cells are hatched, whatever their number is.
    #[test]
    fn the_unknown_is_hatched() {
        let mut known = plane();
        let upper = 5_000..10_000;
        known.gaps[upper].fill(Some(Gap::NotConverged));
        known.gaps[..1_000].fill(Some(Gap::NotComputed));
        let lines = shaded(&known, 40);
        assert_eq!(lines[0], "/".repeat(40));
        assert_eq!(lines[MOST_LINES - 1], ".".repeat(40));
        let line = &coloured(&known, 40)[0];
        assert_eq!(line.matches('/').count(), 40);
        assert!(!line.contains('▀'));
    }

    #[test]
    fn colours_end_with_each_line() {
        for line in coloured(&plane(), 30) {
            assert_eq!(line.matches('▀').count(), 30);
            assert!(line.ends_with("\x1b[0m"));
        }
    }
}
