//! Crossing curves in a map, and curves of degrees of stability: CF contiguous ragged arrays,
//! appended plane by plane.
//!
//! Dimensions of the group: `curve` (one piece of a curve), `vertex` (all vertices of all pieces,
//! one piece after the other) and `corner` (points where two curves cross).

use hdf5::plist::group_create::LinkCreationOrder;
use hdf5::{Dataset, Group, H5Type};

use super::attributes::{put_numbers, put_text};
use super::curve_rows::CurveRows;
use super::netcdf::{DimensionId, Dimensions, named};
use super::schema::{BOUNDARIES, CORNER_DEGREE_OF_STABILITY, DEGREE_OF_STABILITY, PLANE};
use crate::sweep::{Parameter, Plan};

/// Elements in a chunk of the appended datasets.
const CHUNK: usize = 1 << 13;

/// A one-dimensional dataset that grows.
struct Column<T> {
    dataset: Dataset,
    waiting: Vec<T>,
}

impl<T: H5Type> Column<T> {
    fn flush(&mut self) -> hdf5::Result<()> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        let from = self.dataset.size();
        let to = from + self.waiting.len();
        self.dataset.resize(to)?;
        self.dataset.write_slice(&self.waiting, from..to)?;
        self.waiting.clear();
        Ok(())
    }
}

/// The group of crossing curves of a map that is being written.
pub(super) struct BoundaryWriter {
    curve: DimensionId,
    vertex: DimensionId,
    corner: DimensionId,
    vertex_columns: [Column<f64>; 3],
    vertex_count: Column<i32>,
    branch: Column<i64>,
    direction: Column<i8>,
    stable_side: Column<i8>,
    degree: Column<f64>,
    curve_outer: Vec<Column<f64>>,
    corner_columns: [Column<f64>; 4],
    corner_branches: [Column<i64>; 2],
    corner_stable: Column<i8>,
    corner_degree: Column<f64>,
    corner_outer: Vec<Column<f64>>,
}

/// Makes the columns of one dimension.
struct Columns<'a> {
    group: &'a Group,
    dimensions: &'a mut Dimensions,
    dimension: DimensionId,
}

impl Columns<'_> {
    fn make<T: H5Type>(
        &mut self,
        name: &str,
        long_name: &str,
        unit: &str,
    ) -> hdf5::Result<Column<T>> {
        let dataset = named(self.group.new_dataset_builder())
            .empty::<T>()
            .shape(0..)
            .chunk(CHUNK)
            .shuffle()
            .deflate(super::codec::DEFLATE_LEVEL)
            .create(name)?;
        put_text(&dataset, "long_name", long_name)?;
        put_text(&dataset, "units", unit)?;
        self.dimensions.attach(&dataset, &[self.dimension])?;
        Ok(Column {
            dataset,
            waiting: Vec::new(),
        })
    }

    fn of_parameter(
        &mut self,
        prefix: &str,
        parameter: Parameter,
        plan: &Plan,
    ) -> hdf5::Result<Column<f64>> {
        let name = format!("{prefix}{}", parameter.name());
        self.make(
            &name,
            parameter.long_name(),
            &plan.spec.units.of_parameter(parameter),
        )
    }
}

impl BoundaryWriter {
    /// Creates the group, for the plane of `plan` spanned by the axes `p` and delay.
    pub fn create(
        parent: &Group,
        dimensions: &mut Dimensions,
        plan: &Plan,
        (p, tau): (usize, usize),
    ) -> hdf5::Result<Self> {
        let group = parent
            .create_group_builder()
            .with_gcpl(|gcpl| {
                gcpl.obj_track_times(false)
                    .link_creation_order(LinkCreationOrder::Indexed)
            })
            .create(BOUNDARIES)?;
        put_text(
            &group,
            "title",
            "exact crossing curves: where characteristic roots lie on the imaginary axis; and \
            boundaries of degrees of stability",
        )?;
        let curve = dimensions.add_bare(&group, "curve")?;
        let vertex = dimensions.add_bare(&group, "vertex")?;
        let corner = dimensions.add_bare(&group, "corner")?;
        let outer: Vec<usize> = (0..plan.spec.axes.len())
            .filter(|&a| a != p && a != tau)
            .collect();
        let parameter = plan.spec.axes[p].parameter;
        put_text(
            &group,
            PLANE,
            &format!("{} {}", parameter.name(), Parameter::Tau.name()),
        )?;
        let frequency = plan.spec.units.angular_frequency();
        let rate = plan.spec.units.rate();
        let outer_parameters = || outer.iter().map(|&axis| plan.spec.axes[axis].parameter);

        let mut columns = Columns {
            group: &group,
            dimensions,
            dimension: curve,
        };
        let vertex_count = columns.make("vertex_count", "number of vertices of the curve", "1")?;
        put_text(&vertex_count.dataset, "sample_dimension", "vertex")?;
        let branch = columns.make("branch", "branch number k of the crossing delay", "1")?;
        let direction = columns.make(
            "direction",
            "how a pair of roots crosses with growing delay",
            "1",
        )?;
        put_flags(
            &direction.dataset,
            &[-1, 0, 1],
            "to_the_left touch to_the_right",
        )?;
        let stable_side = columns.make(
            "stable_side",
            "side of the curve on which sliding is stable, to its degree of stability",
            "1",
        )?;
        put_flags(
            &stable_side.dataset,
            &[-1, 0, 1],
            "shorter_delays neither longer_delays",
        )?;
        let degree = columns.make(
            DEGREE_OF_STABILITY,
            "degree of stability: roots on the curve have this real part, negated",
            &rate,
        )?;
        let curve_outer = outer_parameters()
            .map(|parameter| columns.of_parameter("", parameter, plan))
            .collect::<hdf5::Result<_>>()?;

        columns.dimension = vertex;
        let vertex_columns = [
            columns.of_parameter("", parameter, plan)?,
            columns.of_parameter("", Parameter::Tau, plan)?,
            columns.make("omega", "crossing frequency", &frequency)?,
        ];

        columns.dimension = corner;
        let corner_columns = [
            columns.of_parameter("corner_", parameter, plan)?,
            columns.of_parameter("corner_", Parameter::Tau, plan)?,
            columns.make(
                "corner_omega_upper",
                "larger frequency; at degree of stability 0 the pair crosses to the right",
                &frequency,
            )?,
            columns.make(
                "corner_omega_lower",
                "smaller frequency; at degree of stability 0 the pair crosses to the left",
                &frequency,
            )?,
        ];
        let corner_branches = [
            columns.make(
                "corner_branch_upper",
                "branch of the pair with the larger frequency",
                "1",
            )?,
            columns.make(
                "corner_branch_lower",
                "branch of the pair with the smaller frequency",
                "1",
            )?,
        ];
        let corner_stable = columns.make(
            "corner_bounds_stable",
            "the stable region has a corner here",
            "1",
        )?;
        put_flags(&corner_stable.dataset, &[0, 1], "no yes")?;
        let corner_degree = columns.make(
            CORNER_DEGREE_OF_STABILITY,
            "degree of stability of the curves that meet",
            &rate,
        )?;
        let corner_outer = outer_parameters()
            .map(|parameter| columns.of_parameter("corner_", parameter, plan))
            .collect::<hdf5::Result<_>>()?;
        Ok(Self {
            curve,
            vertex,
            corner,
            vertex_columns,
            vertex_count,
            branch,
            direction,
            stable_side,
            degree,
            curve_outer,
            corner_columns,
            corner_branches,
            corner_stable,
            corner_degree,
            corner_outer,
        })
    }

    /// Appends the curves of the next plane, which lies at the values `outer` of the axes outside
    /// of it.
    pub fn append(&mut self, rows: &CurveRows, outer: &[f64]) -> hdf5::Result<()> {
        self.vertex_count.waiting.extend(&rows.vertex_count);
        self.branch.waiting.extend(&rows.branch);
        self.direction.waiting.extend(&rows.direction);
        self.stable_side.waiting.extend(&rows.stable_side);
        self.degree.waiting.extend(&rows.degree);
        repeat_each(&mut self.curve_outer, outer, rows.curves());
        extend_each(&mut self.vertex_columns, &rows.vertices);
        extend_each(&mut self.corner_columns, &rows.corners);
        extend_each(&mut self.corner_branches, &rows.corner_branches);
        self.corner_stable.waiting.extend(&rows.corner_stable);
        self.corner_degree.waiting.extend(&rows.corner_degree);
        repeat_each(&mut self.corner_outer, outer, rows.corners());
        if self.vertex_columns[0].waiting.len() >= CHUNK {
            self.flush()?;
        }
        Ok(())
    }

    fn flush(&mut self) -> hdf5::Result<()> {
        self.vertex_count.flush()?;
        self.branch.flush()?;
        self.direction.flush()?;
        self.stable_side.flush()?;
        self.corner_stable.flush()?;
        for column in self.corner_branches.iter_mut() {
            column.flush()?;
        }
        let columns = self.vertex_columns.iter_mut().chain(&mut self.curve_outer);
        for column in columns
            .chain(&mut self.corner_columns)
            .chain(&mut self.corner_outer)
            .chain([&mut self.degree, &mut self.corner_degree])
        {
            column.flush()?;
        }
        Ok(())
    }

    /// Gives the dimensions the lengths that their data have come to.
    pub fn finish(&mut self, dimensions: &Dimensions) -> hdf5::Result<()> {
        self.flush()?;
        for (id, length) in [
            (self.curve, self.branch.dataset.size()),
            (self.vertex, self.vertex_columns[0].dataset.size()),
            (self.corner, self.corner_stable.dataset.size()),
        ] {
            dimensions.scale(id).resize(length)?;
        }
        Ok(())
    }
}

fn extend_each<T: Copy>(columns: &mut [Column<T>], values: &[Vec<T>]) {
    for (column, values) in columns.iter_mut().zip(values) {
        column.waiting.extend(values);
    }
}

fn repeat_each(columns: &mut [Column<f64>], values: &[f64], times: usize) {
    for (column, &value) in columns.iter_mut().zip(values) {
        column.waiting.extend(std::iter::repeat_n(value, times));
    }
}

pub(super) fn put_flags(dataset: &Dataset, values: &[i8], meanings: &str) -> hdf5::Result<()> {
    put_numbers(dataset, "flag_values", values)?;
    put_text(dataset, "flag_meanings", meanings)
}
