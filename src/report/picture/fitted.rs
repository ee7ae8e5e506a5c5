//! Cuts cells along exact boundaries, where they are large enough to look like a staircase: each
//! place shows the nearest cell in its own part of the plane.

use super::divisions::{Division, UNKNOWN_PART};
use super::panels::Panel;
use crate::meaning::gap::Gap;
use crate::meaning::scale::Scale;
use crate::report::known::Known;
use crate::store::map_file::Plane;

/// Cells smaller than this show no staircase, in units of the picture.
const SMALL: f64 = 3.0;
/// Approximate size of the parts of a cell.
const PART: f64 = 1.5;
/// The most parts of a cell along an axis.
const MOST_PARTS: usize = 40;

/// The cells of a plane, those along the boundary cut into parts. `turned`: whether q goes from
/// left to right. `u`: the unit of the picture.
pub(super) fn fitted(
    panel: &Panel,
    known: Known,
    (division, turned): (&impl Division, bool),
    u: f64,
) -> Known {
    let plane = &known.plane;
    let (width, height) = (plane.columns.len(), plane.rows.len());
    let parts = |length: f64, n: usize| {
        let size = length / n.max(1) as f64;
        match size > SMALL * u {
            true => ((size / (PART * u)).ceil() as usize).min(MOST_PARTS),
            false => 1,
        }
    };
    let across = parts(panel.area.width(), width);
    let up = parts(panel.area.height(), height);
    if (across, up) == (1, 1) {
        return known;
    }
    let columns = divided(&panel.x, &plane.columns, across);
    let rows = divided(&panel.y, &plane.rows, up);
    let fine = parts_of((&columns, &rows), (division, turned));
    let grid = Grid {
        panel,
        known: &known,
        coarse: &parts_of((&plane.columns, &plane.rows), (division, turned)),
        value: &|part| division.value(part),
    };
    let of = |(row, column): (usize, usize)| {
        let at = panel.at(columns[column], rows[row]);
        grid.shown((row / up, column / across), at, fine[column][row])
    };
    let places = (0..rows.len()).flat_map(|row| (0..columns.len()).map(move |c| (row, c)));
    let (cells, gaps) = places.map(of).unzip();
    Known {
        gaps,
        plane: Plane {
            rows,
            columns,
            cells,
        },
    }
}

/// The parts in which places lie, by column, then row.
fn parts_of(
    (columns, rows): (&[f64], &[f64]),
    (division, turned): (&impl Division, bool),
) -> Vec<Vec<i64>> {
    if !turned {
        return columns.iter().map(|&x| division.along(x, rows)).collect();
    }
    let by_row: Vec<Vec<i64>> = rows.iter().map(|&y| division.along(y, columns)).collect();
    let column = |c: usize| by_row.iter().map(|row| row[c]).collect();
    (0..columns.len()).map(column).collect()
}

/// The middles of `parts` parts of every cell, equal on the scale.
fn divided(scale: &Scale, values: &[f64], parts: usize) -> Vec<f64> {
    let edges = scale.filling_edges(values);
    let edges: Vec<f64> = edges.iter().map(|edge| scale.part(*edge)).collect();
    let middle = |i: usize| (i as f64 + 0.5) / parts as f64;
    let cell = |pair: &[f64]| {
        let (from, to) = (pair[0], pair[1]);
        (0..parts).map(move |i| scale.value(from + middle(i) * (to - from)))
    };
    edges.windows(2).flat_map(cell).collect()
}

/// The cells of the map, with the part of the plane in which each centre lies.
struct Grid<'a> {
    panel: &'a Panel,
    known: &'a Known,
    /// By column, then row.
    coarse: &'a [Vec<i64>],
    /// The value of a part, where it has one.
    value: &'a dyn Fn(i64) -> Option<f64>,
}

impl Grid<'_> {
    /// What is shown at a place in a cell. A cell without a value stays whole, and so does one that
    /// has another value than its part.
    fn shown(
        &self,
        (row, column): (usize, usize),
        at: (f64, f64),
        part: i64,
    ) -> (f64, Option<Gap>) {
        let plane = &self.known.plane;
        let own = row * plane.columns.len() + column;
        let here = self.coarse[column][row];
        let of = |cell: usize| (plane.cells[cell], self.known.gaps[cell]);
        if part == here || part == UNKNOWN_PART || self.known.gaps[own].is_some() {
            return of(own);
        }
        match (self.value)(part) {
            Some(value) if (self.value)(here) == Some(plane.cells[own]) => (value, None),
            Some(_) => of(own),
            None => of(self.nearest((row, column), at, part)),
        }
    }

    /// Among a cell and its neighbours, the one in this part whose centre is nearest to a place;
    /// the cell itself where there is none.
    fn nearest(&self, (row, column): (usize, usize), at: (f64, f64), part: i64) -> usize {
        let plane = &self.known.plane;
        let width = plane.columns.len();
        let near = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
        let rows = near(row, plane.rows.len());
        let around = rows.flat_map(|row| near(column, width).map(move |column| (row, column)));
        let fitting = around.filter(|&(row, column)| self.coarse[column][row] == part);
        let distance = |&(row, column): &(usize, usize)| {
            let middle = self.panel.at(plane.columns[column], plane.rows[row]);
            (middle.0 - at.0).hypot(middle.1 - at.1)
        };
        let nearest = fitting.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let (row, column) = nearest.unwrap_or((row, column));
        row * width + column
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::Direction;
    use crate::linear::curves::{CurveKind, CurvePiece, StableSide, Vertex};
    use crate::report::picture::divisions::{Counts, Sides, turned};
    use crate::report::picture::page::Area;

    const VALUES: [f64; 3] = [0.5, 1.5, 2.5];

    /// Three by three cells, stable above a diagonal, which is a curve.
    fn diagonal() -> (Panel, CurvePiece, Known) {
        let panel = Panel {
            area: Area {
                left: 0.0,
                top: 0.0,
                right: 300.0,
                bottom: 300.0,
            },
            x: Scale::linear(0.0, 3.0),
            y: Scale::linear(0.0, 3.0),
        };
        let vertex = |p| Vertex {
            p,
            q: p + 0.207,
            omega: 1.0,
        };
        let line = CurvePiece {
            kind: CurveKind::Pair,
            branch: 0,
            direction: Direction::Left,
            stable_side: StableSide::Longer,
            vertices: vec![vertex(-1.0), vertex(4.0)],
        };
        let stable = |row: usize, column: usize| row > column;
        let cells = (0..9).map(|i| if stable(i / 3, i % 3) { 0.0 } else { 2.0 });
        let known = Known {
            plane: Plane {
                rows: VALUES.to_vec(),
                columns: VALUES.to_vec(),
                cells: cells.collect(),
            },
            gaps: vec![None; 9],
        };
        (panel, line, known)
    }

    #[test]
    fn cells_end_at_the_boundary() {
        let (panel, line, known) = diagonal();
        let pieces = [&line];
        let sides = Sides::of(&pieces, (&[-1.0, 4.0], &[0.0, 3.0]), &|_| false);
        let fine = fitted(&panel, known.clone(), (&sides, false), 1.0).plane;
        assert_eq!(fine.columns.len(), 120);
        for (i, &value) in fine.cells.iter().enumerate() {
            let (x, y) = (fine.columns[i % 120], fine.rows[i / 120]);
            assert_eq!(value == 0.0, y > x + 0.207, "{x} {y}");
        }
        let counts = Counts::of(&pieces, &known);
        assert_eq!(
            fitted(&panel, known.clone(), (&counts, false), 1.0).plane,
            fine
        );
        // Small cells show no staircase.
        assert_eq!(fitted(&panel, known.clone(), (&sides, false), 50.0), known);
    }

    #[test]
    fn counts_are_cut_either_way_round_and_only_where_they_are_known() {
        let (panel, line, known) = diagonal();
        let pieces = [&line];
        let counts = Counts::of(&pieces, &known);
        let fine = fitted(&panel, known.clone(), (&counts, false), 1.0).plane;
        // The same from left to right.
        let across = turned(&known);
        let fine_across = fitted(&panel, across, (&counts, true), 1.0);
        assert_eq!(turned(&fine_across).plane, fine);
        // A cell that is not known stays whole.
        let mut with_gap = known.clone();
        with_gap.gaps[4] = Some(Gap::NotConverged);
        let cut = fitted(&panel, with_gap, (&counts, false), 1.0);
        let gaps = cut.gaps.iter().filter(|gap| gap.is_some()).count();
        assert_eq!(gaps, 40 * 40);
        // So does one that is not what the curves say.
        let mut other = known.clone();
        other.plane.cells[4] = 6.0;
        let cut = fitted(
            &panel,
            other.clone(),
            (&Counts::of(&pieces, &other), false),
            1.0,
        );
        let others = cut.plane.cells.iter().filter(|value| **value == 6.0);
        assert_eq!(others.count(), 40 * 40);
    }
}
