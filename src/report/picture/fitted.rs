//! Cuts cells along the exact boundary of stability, where they are large enough to look like a
//! staircase: each place shows the nearest cell on its own side.

use super::panels::Panel;
use super::stable_area::intervals;
use crate::linear::curves::CurvePiece;
use crate::report::known::Known;
use crate::store::map_file::Plane;

/// Cells smaller than this show no staircase, in units of the picture.
const SMALL: f64 = 3.0;
/// Approximate size of the parts of a cell.
const PART: f64 = 1.5;
/// The most parts of a cell along an axis.
const MOST_PARTS: usize = 40;
/// Relative distance from the end of an axis at which a curve is read there: its end is excluded.
const END: f64 = 1e-9;

/// The stable places of a plane, between its boundaries.
pub(super) struct Sides<'a> {
    /// The curves that bound the stable region.
    pub pieces: &'a [&'a CurvePiece],
    /// The smallest and the largest value of the x axis.
    pub reach: (f64, f64),
    /// Whether the plane is stable at a value of the x axis where no curve lies.
    pub without_crossing: &'a dyn Fn(f64) -> bool,
}

impl Sides<'_> {
    /// Whether each place of the y axis is stable at a value of the x axis. Curves end at the last
    /// value of the map, cells half a step beyond it; there the state at the end is continued.
    fn along(&self, panel: &Panel, x: f64, ys: &[f64]) -> Vec<bool> {
        let (from, to) = self.reach;
        let x = x.clamp(from, to - END * (to - from));
        let stable = intervals(panel, self.pieces, x, self.without_crossing);
        let holds = |y: f64| stable.iter().any(|&(low, high)| high <= y && y <= low);
        ys.iter().map(|&y| holds(panel.up(y))).collect()
    }
}

/// The cells of a plane, those along the boundary cut into parts. `u`: the unit of the picture.
pub(super) fn fitted(panel: &Panel, known: Known, sides: &Sides, u: f64) -> Known {
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
    let columns = divided(&panel.x.filling_edges(&plane.columns), across);
    let rows = divided(&panel.y.filling_edges(&plane.rows), up);
    let coarse = plane.columns.iter();
    let coarse: Vec<Vec<bool>> = coarse
        .map(|&x| sides.along(panel, x, &plane.rows))
        .collect();
    let fine: Vec<Vec<bool>> = columns
        .iter()
        .map(|&x| sides.along(panel, x, &rows))
        .collect();
    let grid = Grid {
        panel,
        plane,
        coarse: &coarse,
    };
    let of = |(row, column): (usize, usize)| {
        let at = panel.at(columns[column], rows[row]);
        grid.nearest((row / up, column / across), at, fine[column][row])
    };
    let places = (0..rows.len()).flat_map(|row| (0..columns.len()).map(move |c| (row, c)));
    let cells: Vec<usize> = places.map(of).collect();
    Known {
        gaps: cells.iter().map(|&cell| known.gaps[cell]).collect(),
        plane: Plane {
            cells: cells.iter().map(|&cell| plane.cells[cell]).collect(),
            rows,
            columns,
        },
    }
}

/// The middles of `parts` equal parts of every cell.
fn divided(edges: &[f64], parts: usize) -> Vec<f64> {
    let middle = |i: usize| (i as f64 + 0.5) / parts as f64;
    let cell = |pair: &[f64]| {
        let (from, to) = (pair[0], pair[1]);
        (0..parts).map(move |i| from + middle(i) * (to - from))
    };
    edges.windows(2).flat_map(cell).collect()
}

/// The cells of the map, with the side on which each centre lies.
struct Grid<'a> {
    panel: &'a Panel,
    plane: &'a Plane,
    /// By column, then row.
    coarse: &'a [Vec<bool>],
}

impl Grid<'_> {
    /// Among a cell and its neighbours, the one on this side whose centre is nearest to a place;
    /// the cell itself where there is none.
    fn nearest(&self, (row, column): (usize, usize), at: (f64, f64), side: bool) -> usize {
        let width = self.plane.columns.len();
        let own = row * width + column;
        if self.coarse[column][row] == side {
            return own;
        }
        let near = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
        let rows = near(row, self.plane.rows.len());
        let around = rows.flat_map(|row| near(column, width).map(move |column| (row, column)));
        let fitting = around.filter(|&(row, column)| self.coarse[column][row] == side);
        let distance = |&(row, column): &(usize, usize)| {
            let middle = self
                .panel
                .at(self.plane.columns[column], self.plane.rows[row]);
            (middle.0 - at.0).hypot(middle.1 - at.1)
        };
        let nearest = fitting.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or(own, |(row, column)| row * width + column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::Direction;
    use crate::linear::curves::{CurveKind, StableSide, Vertex};
    use crate::meaning::scale::Scale;
    use crate::report::picture::page::Area;

    /// Three by three cells, stable above a diagonal.
    #[test]
    fn cells_end_at_the_boundary() {
        let values = [0.5, 1.5, 2.5];
        let panel = Panel {
            area: Area {
                left: 0.0,
                top: 0.0,
                right: 300.0,
                bottom: 300.0,
            },
            x: Scale::around(&values),
            y: Scale::around(&values),
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
                rows: values.to_vec(),
                columns: values.to_vec(),
                cells: cells.collect(),
            },
            gaps: vec![None; 9],
        };
        let sides = Sides {
            pieces: &[&line],
            reach: (-1.0, 4.0),
            without_crossing: &|_| false,
        };
        let fine = fitted(&panel, known.clone(), &sides, 1.0).plane;
        assert_eq!(fine.columns.len(), 120);
        for (i, &value) in fine.cells.iter().enumerate() {
            let (x, y) = (fine.columns[i % 120], fine.rows[i / 120]);
            assert_eq!(value == 0.0, y > x + 0.207, "{x} {y}");
        }
        // Small cells show no staircase.
        assert_eq!(fitted(&panel, known.clone(), &sides, 50.0), known);
    }
}
