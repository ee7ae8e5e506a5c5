//! Reads the crossing curves of a map.

use std::ops::{ControlFlow, Range};

use hdf5::{Dataset, Group, SliceOrIndex};

use super::error::StoreError;
use super::map_file::MapFile;
use super::open;
use super::values::{self, Number};
use crate::linear::Direction;
use crate::linear::curves::{CurveKind, CurvePiece, StableSide, Vertex};
use crate::sweep::described::curve_column::{BoundaryColumn, ColumnMut, Named, Per};
use crate::sweep::described::curve_rows::CurveRows;
use crate::sweep::described::group_names::names_of_axes;
use crate::sweep::described::schema::BOUNDARIES;

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

impl MapCurve {
    /// Whether it bounds the region of stable sliding.
    #[must_use]
    pub(crate) fn bounds_stability(&self) -> bool {
        self.degree_of_stability == 0.0 && self.piece.stable_side != StableSide::Neither
    }
}

/// About this many curves, and this many vertices, are read at once.
const CURVES_AT_ONCE: usize = 1 << 12;
const VERTICES_AT_ONCE: usize = 1 << 17;
/// No curve has more vertices than this.
const MOST_VERTICES: usize = 1 << 20;

impl MapFile {
    /// Passes the curves of the map to `visit`, one by one in order, until it breaks off. Few
    /// curves are in memory at once. A map without curves gives none.
    ///
    /// # Errors
    /// When the file is damaged; `visit` may have seen some curves by then.
    pub fn for_each_curve(
        &self,
        mut visit: impl FnMut(MapCurve) -> ControlFlow<()>,
    ) -> Result<(), StoreError> {
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
            from.1 += rows.vertices();
            let curves = curves_of(&rows, &outer).ok_or_else(damaged)?;
            if curves.into_iter().try_for_each(&mut visit).is_break() {
                return Ok(());
            }
        }
        if from == (columns.curves(), columns.vertices) {
            Ok(())
        } else {
            Err(damaged())
        }
    }

    /// The names of the axes beside those of curves: in the group of curves, and in tables of them.
    #[must_use]
    pub fn names_in_curves(&self) -> Vec<String> {
        let axes: Vec<&str> = self
            .axes()
            .iter()
            .map(|axis| axis.parameter.name())
            .collect();
        names_of_axes(&axes)
    }

    /// The curves in the planes at the values `wanted` of the axes outside them, in order.
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
            ControlFlow::Continue(())
        })?;
        Ok(curves)
    }
}

/// The variables of the group that describe curves.
struct CurveColumns {
    vertex_count: Dataset,
    /// One for each column of the rows, in order; none for columns of corners, and for columns that
    /// maps of the first versions lack.
    columns: Vec<Option<Dataset>>,
    outer: Vec<Dataset>,
    vertices: usize,
}

/// Opens datasets in the group of curves.
struct Opening<'a> {
    group: Group,
    /// The parameters of the planes.
    parameter: &'a str,
    second: &'a str,
}

impl Opening<'_> {
    fn column(&self, name: &str) -> hdf5::Result<Dataset> {
        let dataset = open::dataset(&self.group, name)?;
        match dataset.ndim() {
            1 => Ok(dataset),
            n => Err(format!("{name} has {n} dimensions").into()),
        }
    }
}

impl Opening<'_> {
    /// The dataset of a column; none for those of corners, and for one that maps of the first
    /// versions lack.
    fn optional(&self, about: &BoundaryColumn) -> hdf5::Result<Option<Dataset>> {
        let name = match about.named {
            Named::Number(name, _) | Named::Frequency(name, _) | Named::Rate(name, _) => {
                name.to_owned()
            }
            Named::Parameter(prefix) => format!("{prefix}{}", self.parameter),
            Named::Second(prefix) => format!("{prefix}{}", self.second),
        };
        let absent = about.optional && !self.group.link_exists(&name);
        match about.per == Per::Corner || absent {
            true => Ok(None),
            false => self.column(&name).map(Some),
        }
    }
}

impl CurveColumns {
    fn of(map: &MapFile, (p, q): (usize, usize)) -> hdf5::Result<Self> {
        let names = map.names_in_curves();
        let name = |axis: usize| names[axis].as_str();
        let opening = Opening {
            group: map.group(BOUNDARIES)?,
            parameter: name(p),
            second: name(q),
        };
        let rows = CurveRows::default();
        let columns = rows.columns().into_iter();
        let columns = columns.map(|(about, _)| opening.optional(about));
        let outer = (0..map.axes().len()).filter(|&axis| axis != p && axis != q);
        Ok(Self {
            vertex_count: opening.column("vertex_count")?,
            vertices: opening.column("omega")?.size(),
            outer: outer
                .map(|axis| opening.column(name(axis)))
                .collect::<hdf5::Result<_>>()?,
            columns: columns.collect::<hdf5::Result<_>>()?,
        })
    }

    fn curves(&self) -> usize {
        self.vertex_count.size()
    }

    /// Whether every column has as many rows as there are curves or vertices.
    fn fit(&self) -> bool {
        let rows = CurveRows::default();
        let own = rows.columns().into_iter().zip(&self.columns);
        let mut own = own.filter_map(|((about, _), column)| Some((about.per, column.as_ref()?)));
        let fits = own.all(|(per, dataset)| match per {
            Per::Curve => dataset.size() == self.curves(),
            Per::Vertex => dataset.size() == self.vertices,
            Per::Corner => true,
        });
        fits && self
            .outer
            .iter()
            .all(|column| column.size() == self.curves())
    }

    /// How many curves, from `first` on, to read at once, and how many vertices they have: at least
    /// one curve. None where a curve claims more than `MOST_VERTICES`.
    fn next(&self, first: usize) -> hdf5::Result<Option<(usize, usize)>> {
        let most = self.curves().min(first + CURVES_AT_ONCE);
        let counts: Vec<i32> = part(&self.vertex_count, first..most)?;
        let (mut curves, mut vertices) = (0, 0);
        for count in counts {
            let count = usize::try_from(count).unwrap_or(usize::MAX);
            if count > MOST_VERTICES {
                return Ok(None);
            }
            if curves > 0 && vertices + count > VERTICES_AT_ONCE {
                break;
            }
            (curves, vertices) = (curves + 1, vertices + count);
        }
        Ok(Some((curves, vertices)))
    }

    /// Reads a batch of at least one curve, from the curve and vertex `first` on, without corners.
    /// Also gives the values of the axes outside their planes. None where the columns do not fit
    /// together.
    fn read(&self, first: (usize, usize)) -> hdf5::Result<Option<(CurveRows, Vec<Vec<f64>>)>> {
        let Some((curves, vertices)) = self.next(first.0)? else {
            return Ok(None);
        };
        let curves = first.0..first.0 + curves;
        let vertices = first.1..first.1 + vertices;
        if !self.fit() || vertices.end > self.vertices {
            return Ok(None);
        }
        let outer = self.outer.iter().map(|column| part(column, curves.clone()));
        let outer = outer.collect::<hdf5::Result<_>>()?;
        let mut rows = CurveRows::default();
        for ((about, column), dataset) in rows.columns_mut().into_iter().zip(&self.columns) {
            let rows = match about.per {
                Per::Curve => curves.clone(),
                Per::Vertex => vertices.clone(),
                Per::Corner => 0..0,
            };
            match column {
                ColumnMut::I8(values) => *values = some(dataset.as_ref(), rows)?,
                ColumnMut::I32(values) => *values = some(dataset.as_ref(), rows)?,
                ColumnMut::I64(values) => *values = some(dataset.as_ref(), rows)?,
                ColumnMut::F64(values) => *values = some(dataset.as_ref(), rows)?,
            }
        }
        Ok(Some((rows, outer)))
    }
}

/// Some values of a column; zeros where the map lacks it.
fn some<T: Number>(column: Option<&Dataset>, rows: Range<usize>) -> hdf5::Result<Vec<T>> {
    match column {
        Some(dataset) => part(dataset, rows),
        None => Ok(vec![T::default(); rows.len()]),
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

/// The curves described by `rows`. `outer` has one column of values for each axis outside the
/// planes. None where the columns do not fit together.
#[must_use]
pub fn curves_of(rows: &CurveRows, outer: &[Vec<f64>]) -> Option<Vec<MapCurve>> {
    let curves = rows.curves();
    if !rows.is_consistent() || outer.iter().any(|column| column.len() != curves) {
        return None;
    }
    let mut from = 0;
    let curve = |i: usize| {
        // The rows are consistent: counts are not negative and add up to the number of vertices.
        let to = from + rows.vertex_count[i] as usize;
        let [ps, qs, omegas] = [&rows.p, &rows.q, &rows.omega].map(|c| &c[from..to]);
        from = to;
        MapCurve {
            outer: outer.iter().map(|column| column[i]).collect(),
            degree_of_stability: rows.degree[i],
            piece: CurvePiece {
                kind: CurveKind::ALL
                    .get(usize::from(rows.kind[i].unsigned_abs()))
                    .copied()
                    .unwrap_or_default(),
                branch: rows.branch[i].max(0) as u64,
                direction: match rows.direction[i] {
                    ..0 => Direction::Left,
                    0 => Direction::Touch,
                    1.. => Direction::Right,
                },
                stable_side: StableSide::of_sign(rows.stable_side[i]),
                vertices: (ps.iter().zip(qs).zip(omegas))
                    .map(|((&p, &q), &omega)| Vertex { p, q, omega })
                    .collect(),
            },
        }
    };
    Some((0..curves).map(curve).collect())
}
