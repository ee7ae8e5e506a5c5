//! An enlarged part of a mostly empty panel, drawn in its largest empty place.
//!
//! Stable regions that are small in a panel may be the important ones, while most of the panel is
//! blank. Regions that are small in both directions are framed together, and drawn again in an
//! empty place if that makes them several times larger.

use super::page::{Area, SMALL};
use super::panels::Panel;
use super::stable_area::Region;
use crate::meaning::scale::Scale;

/// Side of the squares into which a panel is divided, in units of the picture.
const SQUARE: f64 = 10.0;
/// A region is small if it takes less than this share of a panel's width and of its height.
const SMALL_REGION: f64 = 0.25;
/// Room around the small regions, relative to their size.
const ROOM: f64 = 0.06;
/// An inset is drawn if it enlarges the area of the regions at least by the first factor, and each
/// axis at least by the second.
const WORTH: f64 = 3.0;
const LEAST: f64 = 1.0;
/// Empty squares around an inset.
const APART: usize = 2;
/// Room for numbers to the left of an inset and below it, relative to their font.
const LEFT: f64 = 2.4;
const BELOW: f64 = 1.5;

/// The enlarged part, and its place.
pub(super) struct Inset {
    /// The part of the panel.
    pub source: Area,
    /// The same part, larger.
    pub panel: Panel,
}

/// The inset of a panel with these regions, if it is worthwhile. `taken`: places that must not be
/// covered. `u`: the unit of the picture.
pub(super) fn of(panel: &Panel, regions: &[Region], taken: &[Area], u: f64) -> Option<Inset> {
    let mut squares = Squares::of(panel.area, SQUARE * u);
    for &(x, low, high) in regions.iter().flatten() {
        squares.take(x, high, low);
    }
    let small = squares.small_regions()?;
    for area in taken {
        let mut x = area.left;
        while x <= area.right {
            squares.take(x, area.top, area.bottom);
            x += 0.5 * squares.side;
        }
    }
    squares.take_area(small);
    let source = roomier(small, panel.area);
    let place = squares.largest_empty()?;
    let area = Area {
        left: place.left + LEFT * SMALL * u,
        bottom: place.bottom - BELOW * SMALL * u,
        ..place
    };
    let larger = [
        area.width() / source.width(),
        area.height() / source.height(),
    ];
    let worth = larger[0] * larger[1] >= WORTH && larger.iter().all(|by| *by >= LEAST);
    worth.then(|| Inset {
        source,
        panel: Panel {
            area,
            x: part_of(
                panel.x,
                |x| (x - panel.area.left) / panel.area.width(),
                source.left,
                source.right,
            ),
            y: part_of(
                panel.y,
                |y| (panel.area.bottom - y) / panel.area.height(),
                source.bottom,
                source.top,
            ),
        },
    })
}

/// The scale between two places of another scale.
fn part_of(scale: Scale, part: impl Fn(f64) -> f64, from: f64, to: f64) -> Scale {
    let [from, to] = [from, to].map(|place| scale.value(part(place)));
    match scale.is_logarithmic() {
        true => Scale::logarithmic(from, to),
        false => Scale::linear(from, to),
    }
}

/// An area with room around it, limited to another one.
fn roomier(area: Area, outside: Area) -> Area {
    let (across, up) = (ROOM * area.width(), ROOM * area.height());
    Area {
        left: (area.left - across).max(outside.left),
        top: (area.top - up).max(outside.top),
        right: (area.right + across).min(outside.right),
        bottom: (area.bottom + up).min(outside.bottom),
    }
}

/// A panel in squares, with the occupied ones.
struct Squares {
    area: Area,
    side: f64,
    columns: usize,
    rows: usize,
    taken: Vec<bool>,
}

impl Squares {
    fn of(area: Area, side: f64) -> Self {
        let (columns, rows) = (area.width() / side, area.height() / side);
        let (columns, rows) = (columns.ceil() as usize, rows.ceil() as usize);
        Self {
            area,
            side,
            columns,
            rows,
            taken: vec![false; columns * rows],
        }
    }

    fn row(&self, y: f64) -> usize {
        let row = (y - self.area.top) / self.side;
        (row.max(0.0) as usize).min(self.rows - 1)
    }

    fn column(&self, x: f64) -> usize {
        let column = (x - self.area.left) / self.side;
        (column.max(0.0) as usize).min(self.columns - 1)
    }

    /// Marks what a vertical line covers.
    fn take(&mut self, x: f64, top: f64, bottom: f64) {
        let column = self.column(x);
        for row in self.row(top)..=self.row(bottom) {
            self.taken[row * self.columns + column] = true;
        }
    }

    fn take_area(&mut self, area: Area) {
        for column in self.column(area.left)..=self.column(area.right) {
            for row in self.row(area.top)..=self.row(area.bottom) {
                self.taken[row * self.columns + column] = true;
            }
        }
    }

    /// The squares as an area.
    fn area(&self, columns: (usize, usize), rows: (usize, usize)) -> Area {
        let x = |column: usize| self.area.left + column as f64 * self.side;
        let y = |row: usize| self.area.top + row as f64 * self.side;
        Area {
            left: x(columns.0),
            top: y(rows.0),
            right: x(columns.1).min(self.area.right),
            bottom: y(rows.1).min(self.area.bottom),
        }
    }

    /// The area that frames all small regions; none where there are none, or all are small.
    fn small_regions(&self) -> Option<Area> {
        let mut seen = vec![false; self.taken.len()];
        let mut all: Option<Area> = None;
        let mut others = false;
        for start in 0..self.taken.len() {
            if !self.taken[start] || seen[start] {
                continue;
            }
            let (columns, rows) = self.extent(start, &mut seen);
            let small = |(from, to): (usize, usize), of: usize| {
                ((to - from) as f64) < SMALL_REGION * of as f64
            };
            if !(small(columns, self.columns) && small(rows, self.rows)) {
                others = true;
                continue;
            }
            let here = self.area(columns, rows);
            all = Some(all.map_or(here, |all| Area {
                left: all.left.min(here.left),
                top: all.top.min(here.top),
                right: all.right.max(here.right),
                bottom: all.bottom.max(here.bottom),
            }));
        }
        all.filter(|_| others)
    }

    /// The extent in columns and rows of the squares connected with one square.
    fn extent(&self, start: usize, seen: &mut [bool]) -> ((usize, usize), (usize, usize)) {
        let (mut columns, mut rows) = ((usize::MAX, 0), (usize::MAX, 0));
        let mut open = vec![start];
        seen[start] = true;
        while let Some(square) = open.pop() {
            let (row, column) = (square / self.columns, square % self.columns);
            columns = (columns.0.min(column), columns.1.max(column + 1));
            rows = (rows.0.min(row), rows.1.max(row + 1));
            for row in row.saturating_sub(1)..(row + 2).min(self.rows) {
                for column in column.saturating_sub(1)..(column + 2).min(self.columns) {
                    let next = row * self.columns + column;
                    if self.taken[next] && !seen[next] {
                        seen[next] = true;
                        open.push(next);
                    }
                }
            }
        }
        (columns, rows)
    }

    /// The largest rectangle of empty squares, without those at its edges.
    fn largest_empty(&self) -> Option<Area> {
        let mut best: Option<(usize, Area)> = None;
        // The number of empty squares in each column, counted upwards from this row.
        let mut heights = vec![0usize; self.columns];
        for row in 0..self.rows {
            for (column, height) in heights.iter_mut().enumerate() {
                let taken = self.taken[row * self.columns + column];
                *height = if taken { 0 } else { *height + 1 };
            }
            for from in 0..self.columns {
                let mut height = usize::MAX;
                for (to, here) in heights.iter().enumerate().skip(from) {
                    height = height.min(*here);
                    let squares = height * (to + 1 - from);
                    let large = height > 2 * APART && to + 1 - from > 2 * APART;
                    if large && best.as_ref().is_none_or(|best| squares > best.0) {
                        let columns = (from + APART, to + 1 - APART);
                        let rows = (row + 1 - height + APART, row + 1 - APART);
                        best = Some((squares, self.area(columns, rows)));
                    }
                }
            }
        }
        best.map(|best| best.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel() -> Panel {
        Panel {
            area: Area {
                left: 0.0,
                top: 0.0,
                right: 800.0,
                bottom: 600.0,
            },
            x: Scale::linear(-8.0, 0.0),
            y: Scale::linear(0.0, 6.0),
        }
    }

    /// A region of rectangular shape.
    fn region(area: Area) -> Region {
        let columns = area.left as u32..area.right as u32;
        columns
            .map(|x| (f64::from(x), area.bottom, area.top))
            .collect()
    }

    const BAND: Area = Area {
        left: 0.0,
        top: 500.0,
        right: 780.0,
        bottom: 600.0,
    };
    const LOBE: Area = Area {
        left: 720.0,
        top: 100.0,
        right: 780.0,
        bottom: 200.0,
    };

    #[test]
    fn small_regions_are_drawn_larger_where_nothing_is() {
        let inset = of(&panel(), &[region(BAND), region(LOBE)], &[], 1.0).unwrap();
        let (source, area) = (inset.source, inset.panel.area);
        assert!(source.left <= LOBE.left && source.right >= LOBE.right);
        assert!(source.top <= LOBE.top && source.bottom >= LOBE.bottom);
        assert!(source.width() < 100.0 && source.height() < 140.0);
        assert!(area.right < LOBE.left && area.bottom < BAND.top && area.left > 0.0);
        assert!(area.width() > 5.0 * source.width());
        // The inset has the scales of its part.
        let left = -8.0 + source.left / 100.0;
        assert!((inset.panel.x.value(0.0) - left).abs() < 1e-9);
        let bottom = 6.0 - source.bottom / 100.0;
        assert!((inset.panel.y.value(0.0) - bottom).abs() < 1e-9);
    }

    #[test]
    fn no_inset_where_it_shows_no_more() {
        let none = |regions: &[Region], taken: &[Area]| of(&panel(), regions, taken, 1.0).is_none();
        assert!(none(&[region(BAND)], &[]));
        assert!(none(&[region(LOBE)], &[]), "nothing else is shown");
        let full = Area { top: 210.0, ..BAND };
        assert!(none(&[region(full), region(LOBE)], &[panel().area]));
    }
}
