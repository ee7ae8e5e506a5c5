//! Writes crossing curves and curves of degrees of stability into a map: CF contiguous ragged
//! arrays, appended plane by plane.

use hdf5::plist::group_create::LinkCreationOrder;
use hdf5::{Dataset, Group, H5Type};

use super::attributes::{put_numbers, put_text};
use super::curve_rows::{BoundaryColumn, CORNER, CurveRows, EachColumn, Named, Per};
use super::curve_words::{DIRECTION, STABLE_SIDE, direction_along, stable_sides};
use super::group_names::names_of_axes;
use super::netcdf::{DimensionId, Dimensions, named};
use super::schema::{BOUNDARIES, PARAMETER, PLANE};
use crate::sweep::Plan;
use crate::sweep::input::quantity::Quantity;

/// Elements in a chunk of the appended datasets.
const CHUNK: usize = 1 << 13;

/// The dimensions, in the order of [`Per`].
type Ids = [DimensionId; 3];

/// The value of one axis outside the planes, for every curve or corner.
struct OuterColumn {
    dataset: Dataset,
    waiting: Vec<f64>,
}

/// The group of curves of a map that is being written.
pub(super) struct BoundaryWriter {
    ids: Ids,
    /// The lengths of the three dimensions.
    lengths: [usize; 3],
    /// One for each column of the rows.
    datasets: Vec<Dataset>,
    waiting: CurveRows,
    outer_of_curves: Vec<OuterColumn>,
    outer_of_corners: Vec<OuterColumn>,
}

/// A parameter and its name in the group.
#[derive(Clone)]
struct Held(Quantity, String);

/// Makes datasets in the group.
struct Maker<'a> {
    group: &'a Group,
    plan: &'a Plan,
    /// The first parameter of the planes.
    parameter: Held,
    /// The second one.
    second: Held,
    /// The parameters of the axes outside the planes.
    outer: Vec<Held>,
    dimensions: &'a mut Dimensions,
    ids: Ids,
}

impl Maker<'_> {
    /// An empty dataset that grows along the dimension of `per`.
    fn make<T: H5Type>(
        &mut self,
        per: Per,
        name: &str,
        (long_name, unit): (&str, &str),
    ) -> hdf5::Result<Dataset> {
        let dataset = named(self.group.new_dataset_builder())
            .empty::<T>()
            .shape(0..)
            .chunk(CHUNK)
            .shuffle()
            .deflate(super::codec::DEFLATE_LEVEL)
            .create(name)?;
        put_text(&dataset, "long_name", long_name)?;
        put_text(&dataset, "units", unit)?;
        self.dimensions
            .attach(&dataset, &[self.ids[per as usize]])?;
        Ok(dataset)
    }

    /// The dataset of a column.
    fn column<T: H5Type>(&mut self, about: &BoundaryColumn) -> hdf5::Result<Dataset> {
        let units = &self.plan.spec.units;
        let dataset = match about.named {
            Named::Number(name @ DIRECTION, _) => {
                let meaning = direction_along(&self.second.0);
                self.make::<T>(about.per, name, (&meaning, "1"))
            }
            Named::Number(name, meaning) => self.make::<T>(about.per, name, (meaning, "1")),
            Named::Frequency(name, meaning) => {
                self.make::<T>(about.per, name, (meaning, &units.angular_frequency()))
            }
            Named::Rate(name, meaning) => self.make::<T>(about.per, name, (meaning, &units.rate())),
            Named::Parameter(prefix) => {
                self.of_parameter(about.per, prefix, &self.parameter.clone())
            }
            Named::Second(prefix) => self.of_parameter(about.per, prefix, &self.second.clone()),
        }?;
        if let Some(counted) = about.counts {
            put_text(&dataset, "sample_dimension", counted)?;
        }
        if let Some((values, meanings)) = about.flags {
            let sides = stable_sides([&self.parameter.0, &self.second.0]);
            let of_side = matches!(about.named, Named::Number(STABLE_SIDE, _));
            put_flags(&dataset, values, if of_side { &sides } else { meanings })?;
        }
        Ok(dataset)
    }

    fn of_parameter(
        &mut self,
        per: Per,
        prefix: &str,
        Held(parameter, name): &Held,
    ) -> hdf5::Result<Dataset> {
        let unit = parameter.unit(&self.plan.spec.units);
        let about = (parameter.long_name(), &*unit);
        let dataset = self.make::<f64>(per, &format!("{prefix}{name}"), about)?;
        if name != parameter.name() {
            put_text(&dataset, PARAMETER, parameter.name())?;
        }
        Ok(dataset)
    }

    /// A column for each axis outside the planes.
    fn outer(&mut self, per: Per, prefix: &str) -> hdf5::Result<Vec<OuterColumn>> {
        let parameters = self.outer.clone().into_iter();
        parameters
            .map(|parameter| {
                Ok(OuterColumn {
                    dataset: self.of_parameter(per, prefix, &parameter)?,
                    waiting: Vec::new(),
                })
            })
            .collect()
    }
}

/// Makes the datasets of all columns; those of the outer axes follow the columns of curves.
struct Making<'a> {
    maker: Maker<'a>,
    datasets: Vec<Dataset>,
    outer_of_curves: Option<Vec<OuterColumn>>,
}

impl EachColumn for Making<'_> {
    fn see<T: H5Type>(&mut self, about: &'static BoundaryColumn, _: &[T]) -> hdf5::Result<()> {
        if about.per != Per::Curve && self.outer_of_curves.is_none() {
            self.outer_of_curves = Some(self.maker.outer(Per::Curve, "")?);
        }
        self.datasets.push(self.maker.column::<T>(about)?);
        Ok(())
    }
}

/// Appends all columns to their datasets.
struct Appending<'a>(std::slice::Iter<'a, Dataset>);

impl EachColumn for Appending<'_> {
    fn see<T: H5Type>(&mut self, _: &'static BoundaryColumn, values: &[T]) -> hdf5::Result<()> {
        match self.0.next() {
            Some(dataset) => append(dataset, values),
            None => Ok(()),
        }
    }
}

fn append<T: H5Type>(dataset: &Dataset, values: &[T]) -> hdf5::Result<()> {
    if values.is_empty() {
        return Ok(());
    }
    let from = dataset.size();
    let to = from + values.len();
    dataset.resize(to)?;
    dataset.write_slice(values, from..to)
}

impl BoundaryWriter {
    /// Creates the group, for the plane of `plan` spanned by the axes `p` and `q`.
    pub(super) fn create(
        parent: &Group,
        dimensions: &mut Dimensions,
        plan: &Plan,
        (p, q): (usize, usize),
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
        let [curve, vertex, corner] = Per::ALL.map(Per::name);
        let ids = [
            dimensions.add_bare(&group, curve)?,
            dimensions.add_bare(&group, vertex)?,
            dimensions.add_bare(&group, corner)?,
        ];
        let mut axes: Vec<Held> = held(plan);
        let (parameter, second) = (axes[p].clone(), axes[q].clone());
        let plane = format!("{} {}", parameter.0.name(), second.0.name());
        put_text(&group, PLANE, &plane)?;
        let (latest, first) = (p.max(q), p.min(q));
        axes.remove(latest);
        axes.remove(first);
        let mut making = Making {
            maker: Maker {
                group: &group,
                plan,
                parameter,
                second,
                outer: axes,
                dimensions,
                ids,
            },
            datasets: Vec::new(),
            outer_of_curves: None,
        };
        let waiting = CurveRows::default();
        waiting.each(&mut making)?;
        Ok(Self {
            ids,
            lengths: [0; 3],
            outer_of_corners: making.maker.outer(Per::Corner, CORNER)?,
            datasets: making.datasets,
            waiting,
            outer_of_curves: making.outer_of_curves.unwrap_or_default(),
        })
    }

    /// Appends the curves of the next plane, which lies at the values `outer` of the axes outside
    /// of it.
    pub(super) fn append(&mut self, rows: &CurveRows, outer: &[f64]) -> hdf5::Result<()> {
        self.waiting.extend(rows);
        let more = [rows.curves(), rows.vertices(), rows.corners()];
        for (length, more) in self.lengths.iter_mut().zip(more) {
            *length += more;
        }
        repeat_each(&mut self.outer_of_curves, outer, rows.curves());
        repeat_each(&mut self.outer_of_corners, outer, rows.corners());
        if self.waiting.vertices() >= CHUNK {
            self.flush()?;
        }
        Ok(())
    }

    fn flush(&mut self) -> hdf5::Result<()> {
        self.waiting.each(&mut Appending(self.datasets.iter()))?;
        self.waiting.clear();
        for column in self
            .outer_of_curves
            .iter_mut()
            .chain(&mut self.outer_of_corners)
        {
            append(&column.dataset, &column.waiting)?;
            column.waiting.clear();
        }
        Ok(())
    }

    /// Sets each dimension to the final length of its data.
    pub(super) fn finish(&mut self, dimensions: &Dimensions) -> hdf5::Result<()> {
        self.flush()?;
        for (id, length) in self.ids.into_iter().zip(self.lengths) {
            dimensions.scale(id).resize(length)?;
        }
        Ok(())
    }
}

/// The parameters of all axes, with their names in the group.
fn held(plan: &Plan) -> Vec<Held> {
    let axes = plan.spec.axes.iter().map(|axis| &axis.parameter);
    let names: Vec<&str> = axes.clone().map(Quantity::name).collect();
    let names = names_of_axes(&names).into_iter();
    axes.zip(names)
        .map(|(parameter, name)| Held(parameter.clone(), name))
        .collect()
}

fn repeat_each(columns: &mut [OuterColumn], values: &[f64], times: usize) {
    for (column, &value) in columns.iter_mut().zip(values) {
        column.waiting.extend(std::iter::repeat_n(value, times));
    }
}

pub(super) fn put_flags(dataset: &Dataset, values: &[i8], meanings: &str) -> hdf5::Result<()> {
    put_numbers(dataset, "flag_values", values)?;
    put_text(dataset, "flag_meanings", meanings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::attributes::text;
    use crate::sweep::SweepSpec;

    /// Without the delay in the plane the words of the map name both parameters.
    #[test]
    fn sides_are_told_by_the_parameters_of_the_plane() {
        let folder = tempfile::tempdir().unwrap();
        for (axes, sides, grows) in [
            (
                "alpha_n = [-1, 0]\nalpha_v = [-1, 0]\n[fixed]\ntau = 1\nmu_prime = -0.3\n",
                "smaller_alpha_n smaller_alpha_v neither larger_alpha_v larger_alpha_n",
                "how a pair of roots crosses with growing alpha_v",
            ),
            (
                "alpha_n = [-1, 0]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.3\n",
                "smaller_parameter shorter_delays neither longer_delays larger_parameter",
                "how a pair of roots crosses with growing delay",
            ),
        ] {
            let sweep = format!("boundaries = true\n[axes]\n{axes}");
            let plan = Plan::new(sweep.parse::<SweepSpec>().unwrap()).unwrap();
            let file = hdf5::File::create(folder.path().join("curves.h5")).unwrap();
            let mut dimensions = Dimensions::default();
            let plane = plan.boundary_plane.unwrap();
            BoundaryWriter::create(&file, &mut dimensions, &plan, plane).unwrap();
            let said = |name: &str, attribute: &str| {
                let dataset = file.dataset(&format!("{BOUNDARIES}/{name}")).unwrap();
                text(&dataset, attribute).unwrap()
            };
            assert_eq!(said("stable_side", "flag_meanings"), sides);
            assert_eq!(said("direction", "long_name"), grows);
            assert_eq!(
                said("kind", "flag_meanings"),
                super::super::curve_words::CURVE_KINDS
            );
        }
    }
}
