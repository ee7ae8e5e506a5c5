//! Reads the crossing curves of a map.

use std::ops::Range;

use hdf5::{Dataset, SliceOrIndex};

use super::curve_rows::CurveRows;
use super::error::StoreError;
use super::map_file::MapFile;
use super::open;
use super::schema::{BOUNDARIES, DEGREE_OF_STABILITY};
use super::values::{self, Number};
use crate::linear::Direction;
use crate::linear::curves::{CurvePiece, StableSide, Vertex};

/// A curve of a map with the values of the axes outside its plane.
#[derive(Debug, Clone, PartialEq)]
pub struct MapCurve {
    /// Values of the axes outside the plane, in the order of the map's axes.
    pub outer: Vec<f64>,
    /// Degree of stability σ, 1/time: roots on the curve have Re λ = −σ. 0 for crossings of the
    /// imaginary axis.
    pub degree_of_stability: f64,
    /// The curve.
    pub piece: CurvePiece,
}

/// Curves whose rows are read at once, and vertices of them, about.
const CURVES_AT_ONCE: usize = 1 << 12;
const VERTICES_AT_ONCE: usize = 1 << 17;
/// No curve has more vertices than this.
const MOST_VERTICES: usize = 1 << 20;

impl MapFile {
    /// Hands over all curves of the map, one by one, in order; few of them are in memory at once.
    /// None where it holds none.
    ///
    /// # Errors
    /// When the file is damaged; some curves may have been handed over then.
    pub fn for_each_curve(&self, mut visit: impl FnMut(MapCurve)) -> Result<(), StoreError> {
        let Some(plane) = self.boundary_plane() else {
            return Ok(());
        };
        let read = |error| StoreError::hdf5("read the boundaries of", self.path())(error);
        let columns = CurveColumns::of(self, plane).map_err(read)?;
        let damaged = || {
            let why = "its boundaries are damaged: lengths do not fit together";
            StoreError::not_a_map(self.path(), why)
        };
        let mut from = (0, 0);
        while from.0 < columns.curves() {
            let (rows, outer) = columns.read(from).map_err(read)?.ok_or_else(damaged)?;
            from.0 += rows.curves();
            from.1 += rows.vertices[0].len();
            let curves = curves_of(&rows, &outer).ok_or_else(damaged)?;
            curves.into_iter().for_each(&mut visit);
        }
        if from == (columns.curves(), columns.vertices()) {
            Ok(())
        } else {
            Err(damaged())
        }
    }

    /// The curves in the planes whose values of the axes outside of them are `wanted`, in order.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn curves_where(
        &self,
        wanted: impl Fn(&[f64]) -> bool,
    ) -> Result<Vec<MapCurve>, StoreError> {
        let mut curves = Vec::new();
        self.for_each_curve(|curve| {
            if wanted(&curve.outer) {
                curves.push(curve);
            }
        })?;
        Ok(curves)
    }
}

/// The variables of the group that describe curves.
struct CurveColumns {
    vertex_count: Dataset,
    branch: Dataset,
    direction: Dataset,
    stable_side: Dataset,
    /// Absent in maps of the first versions: 0 in all rows.
    degree: Option<Dataset>,
    outer: Vec<Dataset>,
    vertices: [Dataset; 3],
}

impl CurveColumns {
    fn of(map: &MapFile, (p, tau): (usize, usize)) -> hdf5::Result<Self> {
        let group = map.group(BOUNDARIES)?;
        let column = |name: &str| -> hdf5::Result<Dataset> {
            let dataset = open::dataset(&group, name)?;
            match dataset.ndim() {
                1 => Ok(dataset),
                n => Err(format!("{name} has {n} dimensions").into()),
            }
        };
        let name = |axis: usize| map.axes()[axis].parameter.name();
        let outer = (0..map.axes().len()).filter(|&axis| axis != p && axis != tau);
        Ok(Self {
            vertex_count: column("vertex_count")?,
            branch: column("branch")?,
            direction: column("direction")?,
            stable_side: column("stable_side")?,
            degree: match group.link_exists(DEGREE_OF_STABILITY) {
                true => Some(column(DEGREE_OF_STABILITY)?),
                false => None,
            },
            outer: outer
                .map(|axis| column(name(axis)))
                .collect::<hdf5::Result<_>>()?,
            vertices: [column(name(p))?, column("tau")?, column("omega")?],
        })
    }

    fn curves(&self) -> usize {
        self.vertex_count.size()
    }

    fn vertices(&self) -> usize {
        self.vertices[0].size()
    }

    /// The rows of the curves from `first` on, a number of curves and of vertices, with the values
    /// of the axes outside their planes, but no corners; at least one curve. None where the columns
    /// do not fit together.
    fn read(&self, first: (usize, usize)) -> hdf5::Result<Option<(CurveRows, Vec<Vec<f64>>)>> {
        let most = self.curves().min(first.0 + CURVES_AT_ONCE);
        let mut vertex_count: Vec<i32> = part(&self.vertex_count, first.0..most)?;
        let mut vertices = 0;
        let mut fitting = 0;
        for &count in &vertex_count {
            let count = usize::try_from(count).unwrap_or(usize::MAX);
            if count > MOST_VERTICES {
                return Ok(None);
            }
            if fitting > 0 && vertices + count > VERTICES_AT_ONCE {
                break;
            }
            (fitting, vertices) = (fitting + 1, vertices + count);
        }
        vertex_count.truncate(fitting);
        let rows = first.0..first.0 + fitting;
        let of_vertices = first.1..first.1 + vertices;
        let mut columns = [&self.branch, &self.direction, &self.stable_side]
            .into_iter()
            .chain(&self.degree)
            .chain(&self.outer);
        if columns.any(|column| column.size() != self.curves())
            || self.vertices.iter().any(|v| v.size() < of_vertices.end)
        {
            return Ok(None);
        }
        let numbers = |column: &Dataset| part::<f64>(column, rows.clone());
        let [p, tau, omega] = &self.vertices;
        let along = |column: &Dataset| part::<f64>(column, of_vertices.clone());
        let rows_read = CurveRows {
            branch: part(&self.branch, rows.clone())?,
            direction: part(&self.direction, rows.clone())?,
            stable_side: part(&self.stable_side, rows.clone())?,
            degree: match &self.degree {
                Some(degree) => numbers(degree)?,
                None => vec![0.0; fitting],
            },
            vertex_count,
            vertices: [along(p)?, along(tau)?, along(omega)?],
            ..CurveRows::default()
        };
        let outer = self
            .outer
            .iter()
            .map(numbers)
            .collect::<hdf5::Result<_>>()?;
        Ok(Some((rows_read, outer)))
    }
}

/// Some values of a column.
fn part<T: Number>(column: &Dataset, rows: Range<usize>) -> hdf5::Result<Vec<T>> {
    let slab = SliceOrIndex::SliceCount {
        start: rows.start,
        step: 1,
        count: rows.len(),
        block: 1,
    };
    values::read(column, &[slab])
}

/// The curves that rows describe, with the values of the axes outside their planes column by
/// column; none where the columns do not fit together.
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
