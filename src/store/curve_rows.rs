//! The curves of a plane as rows of numbers: as they are kept between the computing and the map,
//! and as they stand in it.

use serde::{Deserialize, Serialize};

use crate::linear::Direction;
use crate::linear::curves::{Corner, CurvePiece, StableSide};
use crate::sweep::Plan;
use crate::sweep::cells::boundaries::BoundaryPlane;

/// The curves of one plane, column by column: one row per curve, per vertex and per corner.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CurveRows {
    /// Some curves are left out: too many cross the plane.
    pub left_out: bool,
    /// Per curve: number of vertices.
    pub vertex_count: Vec<i32>,
    /// Per curve: k.
    pub branch: Vec<i64>,
    /// Per curve: −1, 0, 1.
    pub direction: Vec<i8>,
    /// Per curve: −1 shorter delays, 0 neither, 1 longer ones.
    pub stable_side: Vec<i8>,
    /// Per curve: σ.
    pub degree: Vec<f64>,
    /// Per vertex: parameter, delay, frequency.
    pub vertices: [Vec<f64>; 3],
    /// Per corner: parameter, delay, larger and smaller frequency.
    pub corners: [Vec<f64>; 4],
    /// Per corner: the branches of the two.
    pub corner_branches: [Vec<i64>; 2],
    /// Per corner: 1 where the stable region has one.
    pub corner_stable: Vec<i8>,
    /// Per corner: σ.
    pub corner_degree: Vec<f64>,
}

impl CurveRows {
    pub fn of(plane: &BoundaryPlane) -> Self {
        let mut rows = Self::default();
        for of in &plane.curves {
            let Ok(curves) = &of.curves else {
                rows.left_out = true;
                continue;
            };
            for piece in &curves.pieces {
                rows.push_piece(piece, of.degree_of_stability);
            }
            for corner in &curves.corners {
                rows.push_corner(corner, of.degree_of_stability);
            }
        }
        rows
    }

    fn push_piece(&mut self, piece: &CurvePiece, degree: f64) {
        self.degree.push(degree);
        self.vertex_count.push(piece.vertices.len() as i32);
        self.branch.push(piece.branch as i64);
        self.direction.push(match piece.direction {
            Direction::Left => -1,
            Direction::Touch => 0,
            Direction::Right => 1,
        });
        self.stable_side.push(match piece.stable_side {
            StableSide::Shorter => -1,
            StableSide::Neither => 0,
            StableSide::Longer => 1,
        });
        for vertex in &piece.vertices {
            push_each(&mut self.vertices, [vertex.p, vertex.tau, vertex.omega]);
        }
    }

    fn push_corner(&mut self, corner: &Corner, degree: f64) {
        let (upper, lower) = (corner.upper, corner.lower);
        self.corner_degree.push(degree);
        push_each(&mut self.corners, [corner.p, corner.tau, upper.0, lower.0]);
        push_each(&mut self.corner_branches, [upper.1 as i64, lower.1 as i64]);
        self.corner_stable.push(i8::from(corner.bounds_stable));
    }

    /// Number of curves.
    pub fn curves(&self) -> usize {
        self.vertex_count.len()
    }

    /// Number of corners.
    pub fn corners(&self) -> usize {
        self.corner_stable.len()
    }

    /// Whether the columns have the same lengths, and the curves as many vertices as they say.
    pub fn is_consistent(&self) -> bool {
        let curves = self.curves();
        let vertices = self.vertex_count.iter().try_fold(0_usize, |sum, &n| {
            usize::try_from(n).ok().and_then(|n| sum.checked_add(n))
        });
        let corners = self.corners();
        [
            self.branch.len(),
            self.direction.len(),
            self.stable_side.len(),
            self.degree.len(),
        ]
        .iter()
        .all(|&n| n == curves)
            && self.vertices.iter().all(|v| Some(v.len()) == vertices)
            && self.corners.iter().all(|c| c.len() == corners)
            && self.corner_branches.iter().all(|c| c.len() == corners)
            && self.corner_degree.len() == corners
    }
}

/// The values of the axes outside the planes of curves, at the plane of number `number`; empty
/// where no curves are traced.
pub(super) fn outer_values(plan: &Plan, index: &[usize]) -> Vec<f64> {
    let (p, tau) = plan.boundary_plane.unwrap_or((usize::MAX, usize::MAX));
    let axes = plan.spec.axes.iter().zip(index).enumerate();
    axes.filter(|&(axis, _)| axis != p && axis != tau)
        .map(|(_, (axis, &i))| axis.values[i])
        .collect()
}

fn push_each<T, const N: usize>(columns: &mut [Vec<T>; N], values: [T; N]) {
    for (column, value) in columns.iter_mut().zip(values) {
        column.push(value);
    }
}
