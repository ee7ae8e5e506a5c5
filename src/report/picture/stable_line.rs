//! Stable stretches along a line: between the boundaries in the map, or else between the edges of
//! its cells.

use super::error::PictureError;
use super::panels::Panel;
use super::scene::Scene;
use super::view::View;
use crate::linear::curves::{CurvePiece, Vertex};
use crate::meaning::colour::STABLE_TINT;
use crate::meaning::gap::Gap;
use crate::report::known::Known;
use crate::store::{MapFile, StoreError};

/// Relative distance from the end of an axis at which curves are read there: they end at its last
/// value.
const END: f64 = 1e-9;

/// Shades the stable stretches along the axis `view.x`, if the map has stability.
pub(super) fn shade(
    map: &MapFile,
    view: &View,
    most: usize,
    panel: &Panel,
    scene: &mut Scene,
) -> Result<(), PictureError> {
    let (Some(field), Some(index)) = (map.stability_field(), view.panels.first()) else {
        return Ok(());
    };
    let known = Known::read(map, field, index, (view.x, view.x), most)?;
    let cell = |(value, gap): (&f64, &Option<Gap>)| match gap {
        Some(Gap::Marginal) => Cell::OnBoundary,
        Some(_) => Cell::Unknown,
        None => match field.tells_stable(*value) {
            Some(true) => Cell::Stable,
            _ => Cell::Unstable,
        },
    };
    let line = Line {
        edges: panel.x.filling_edges(&known.plane.columns),
        cells: known
            .plane
            .cells
            .iter()
            .zip(&known.gaps)
            .map(cell)
            .collect(),
        at: known.plane.columns,
    };
    for (from, to) in line.stretches(&crossings(map, view.x, index)?) {
        let (from, to) = (panel.across(from), panel.across(to));
        let (from, to) = (from.min(to), from.max(to));
        let (top, bottom) = (panel.area.top, panel.area.bottom);
        scene.rect((from, top), (to, bottom), STABLE_TINT);
    }
    Ok(())
}

/// The stability of sliding in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cell {
    Stable,
    Unstable,
    /// Within rounding of the boundary.
    OnBoundary,
    Unknown,
}

/// Cells along an axis.
struct Line {
    at: Vec<f64>,
    /// One more than there are cells.
    edges: Vec<f64>,
    cells: Vec<Cell>,
}

impl Line {
    /// The stable stretches. Between two cells the `crossings` of the boundary decide, unless they
    /// contradict the cells; then the edges of the cells do.
    fn stretches(&self, crossings: &[f64]) -> Vec<(f64, f64)> {
        let known = |i: &usize| matches!(self.cells[*i], Cell::Stable | Cell::Unstable);
        let known: Vec<usize> = (0..self.cells.len()).filter(known).collect();
        let stable = |i: usize| self.cells[i] == Cell::Stable;
        let Some(&first) = known.first() else {
            return Vec::new();
        };
        let mut open = stable(first).then_some(self.edges[first]);
        let mut done = Vec::new();
        let mut turn = |open: &mut Option<f64>, at: f64| match open.take() {
            Some(from) => done.push((from, at)),
            None => *open = Some(at),
        };
        for pair in known.windows(2) {
            let (i, j) = (pair[0], pair[1]);
            let (a, b) = (self.at[i], self.at[j]);
            let inside = |c: &&f64| a.min(b) <= **c && **c < a.max(b);
            let mut between: Vec<f64> = crossings.iter().filter(inside).copied().collect();
            between.sort_by(|c, d| (c - a).abs().total_cmp(&(d - a).abs()));
            let through = self.cells[i + 1..j].iter().all(|c| *c == Cell::OnBoundary);
            if through && between.len() % 2 == usize::from(stable(i) != stable(j)) {
                for at in between {
                    turn(&mut open, at);
                }
                continue;
            }
            if stable(i) && !(stable(j) && j == i + 1) {
                turn(&mut open, self.edges[i + 1]);
            }
            if stable(j) && open.is_none() {
                turn(&mut open, self.edges[j]);
            }
        }
        if let (Some(_), Some(&last)) = (open, known.last()) {
            turn(&mut open, self.edges[last + 1]);
        }
        done
    }
}

/// Where the boundaries of stability in the map cross the line along the axis `x` at `index`.
pub(super) fn crossings(map: &MapFile, x: usize, index: &[usize]) -> Result<Vec<f64>, StoreError> {
    let Some((p, tau)) = map.boundary_plane().filter(|&(p, tau)| x == p || x == tau) else {
        return Ok(Vec::new());
    };
    let axes = map.axes();
    let outside = (0..axes.len()).filter(|&axis| axis != p && axis != tau);
    let outside: Vec<f64> = outside.map(|axis| axes[axis].values[index[axis]]).collect();
    let held = if x == tau { p } else { tau };
    let values = &axes[held].values;
    let from = values.iter().copied().fold(f64::INFINITY, f64::min);
    let to = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let held_at = values[index[held]].clamp(from, to - END * (to - from));
    let curves = map.curves_where(|outer| outer == outside)?;
    let pieces = curves
        .iter()
        .filter(|c| c.bounds_stability())
        .map(|curve| &curve.piece);
    Ok(pieces
        .flat_map(|piece| crossed(piece, held_at, x == tau))
        .collect())
}

/// Where a curve crosses a line: at this value of the parameter if `along_delay`, else at this
/// value of the delay.
fn crossed(piece: &CurvePiece, held_at: f64, along_delay: bool) -> impl Iterator<Item = f64> {
    let place = move |v: &Vertex| match along_delay {
        true => (v.p, v.q),
        false => (v.q, v.p),
    };
    piece.vertices.windows(2).filter_map(move |pair| {
        let ((a, from), (b, to)) = (place(&pair[0]), place(&pair[1]));
        // Half-open: where two parts meet, only one of them counts.
        let inside = a.min(b) <= held_at && held_at < a.max(b);
        inside.then(|| from + (held_at - a) / (b - a) * (to - from))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(cells: &[Cell]) -> Line {
        Line {
            at: (0..cells.len()).map(|i| i as f64).collect(),
            edges: (0..=cells.len()).map(|i| i as f64 - 0.5).collect(),
            cells: cells.to_vec(),
        }
    }

    #[test]
    fn the_boundary_tells_more_than_cells() {
        use Cell::{OnBoundary, Stable, Unknown, Unstable};
        let two = line(&[Unstable, Stable]);
        assert_eq!(two.stretches(&[0.9]), [(0.9, 1.5)]);
        assert_eq!(two.stretches(&[]), [(0.5, 1.5)]);
        // An island between two cells, and one with a cell of the other kind in it.
        assert_eq!(
            line(&[Unstable, Unstable]).stretches(&[0.3, 0.2]),
            [(0.2, 0.3)]
        );
        let stable = line(&[Stable, Stable, Stable]);
        assert_eq!(stable.stretches(&[]), [(-0.5, 2.5)]);
        // A cell on the boundary belongs to neither side; unknown cells are not shaded.
        let on = line(&[Unstable, OnBoundary, Stable]);
        assert_eq!(on.stretches(&[1.0]), [(1.0, 2.5)]);
        let unknown = line(&[Stable, Unknown, Stable]);
        assert_eq!(unknown.stretches(&[]), [(-0.5, 0.5), (1.5, 2.5)]);
        assert_eq!(line(&[Unknown]).stretches(&[0.0]), []);
    }
}
