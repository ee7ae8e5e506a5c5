//! Reads the crossing curves of a map.

use hdf5::{Group, H5Type};

use super::curve_rows::CurveRows;
use super::error::StoreError;
use super::map_file::MapFile;
use super::schema::{BOUNDARIES, DEGREE_OF_STABILITY};
use crate::linear::Direction;
use crate::linear::curves::{CurvePiece, StableSide, Vertex};

/// A curve of a map with the values of the axes outside its plane.
#[derive(Debug, Clone, PartialEq)]
pub struct MapCurve {
    /// Values of the axes outside the plane, in the order of the map's axes.
    pub outer: Vec<f64>,
    /// Degree of stability σ, 1/time: roots on the curve have Re λ = −σ. 0 for crossings of the imaginary axis.
    pub degree_of_stability: f64,
    /// The curve.
    pub piece: CurvePiece,
}

impl MapFile {
    /// All curves of the map, in order. Empty where it holds none.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn curves(&self) -> Result<Vec<MapCurve>, StoreError> {
        let Some((p, tau)) = self.boundary_plane() else {
            return Ok(Vec::new());
        };
        let read = || -> hdf5::Result<(CurveRows, Vec<Vec<f64>>)> {
            let group = self.group(BOUNDARIES)?;
            let rows = self.curve_rows(&group, self.axes()[p].parameter.name())?;
            let outer = (0..self.axes().len())
                .filter(|&axis| axis != p && axis != tau)
                .map(|axis| self.column(&group, self.axes()[axis].parameter.name()))
                .collect::<hdf5::Result<_>>()?;
            Ok((rows, outer))
        };
        let (rows, outer) =
            read().map_err(StoreError::hdf5("read the boundaries of", self.path()))?;
        curves_of(&rows, &outer).ok_or_else(|| {
            let why = "its boundaries are damaged: lengths do not fit together";
            StoreError::not_a_map(self.path(), why)
        })
    }

    /// The rows without the corners.
    fn curve_rows(&self, group: &Group, p: &str) -> hdf5::Result<CurveRows> {
        let vertex_count: Vec<i32> = self.column(group, "vertex_count")?;
        let degree = match group.link_exists(DEGREE_OF_STABILITY) {
            true => self.column(group, DEGREE_OF_STABILITY)?,
            false => vec![0.0; vertex_count.len()],
        };
        Ok(CurveRows {
            degree,
            vertex_count,
            branch: self.column(group, "branch")?,
            direction: self.column(group, "direction")?,
            stable_side: self.column(group, "stable_side")?,
            vertices: [
                self.column(group, p)?,
                self.column(group, "tau")?,
                self.column(group, "omega")?,
            ],
            ..CurveRows::default()
        })
    }

    fn column<T: H5Type + Copy + Default>(
        &self,
        group: &Group,
        name: &str,
    ) -> hdf5::Result<Vec<T>> {
        self.whole(&group.dataset(name)?)
    }
}

/// The curves that rows describe, with the values of the axes outside their planes column by column; none where the columns do not
/// fit together.
pub fn curves_of(rows: &CurveRows, outer: &[Vec<f64>]) -> Option<Vec<MapCurve>> {
    let curves = rows.curves();
    if !rows.is_consistent() || outer.iter().any(|column| column.len() != curves) {
        return None;
    }
    let mut from = 0;
    let curve = |i: usize| {
        // Not negative, and all together as many as there are: the rows are consistent.
        let to = from + rows.vertex_count[i] as usize;
        let [ps, taus, omegas] = rows.vertices.each_ref().map(|column| &column[from..to]);
        from = to;
        MapCurve {
            outer: outer.iter().map(|column| column[i]).collect(),
            degree_of_stability: rows.degree[i],
            piece: CurvePiece {
                branch: rows.branch[i].max(0) as u64,
                direction: match rows.direction[i] {
                    ..0 => Direction::Left,
                    0 => Direction::Touch,
                    1.. => Direction::Right,
                },
                stable_side: match rows.stable_side[i] {
                    ..0 => StableSide::Shorter,
                    0 => StableSide::Neither,
                    1.. => StableSide::Longer,
                },
                vertices: (ps.iter().zip(taus).zip(omegas))
                    .map(|((&p, &tau), &omega)| Vertex { p, tau, omega })
                    .collect(),
            },
        }
    };
    Some((0..curves).map(curve).collect())
}
