//! The best settings in a map: one value per plane (gain, delay), over the axes outside of it.
//!
//! The group shares the dimensions of the map. The axes outside the planes stand in it once more,
//! as variables of the same names, so that readers which open one group alone have coordinates.

use hdf5::plist::group_create::LinkCreationOrder;
use hdf5::types::OwnedDynValue;
use hdf5::{Dataset, Group, H5Type};
use serde::{Deserialize, Serialize};

use super::attributes::{put_numbers, put_text};
use super::boundary_writer::put_flags;
use super::describe::describe_parameter;
use super::netcdf::{DimensionId, Dimensions, named};
use super::schema::{BEST, BEST_FLAG_FILL, PLANE, best as names};
use super::variables::FILL_VALUE;
use crate::linear::best::Kind;
use crate::sweep::cells::best::BestSettings;
use crate::sweep::input::quantity::Quantity;
use crate::sweep::{Parameter, Plan};

/// The best setting of one plane as the values of the group's variables, in their order; fill
/// values where there is none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct BestRow {
    numbers: [f64; 5],
    flags: [i8; 2],
    regions: i32,
}

impl BestRow {
    pub(crate) fn of(found: Option<&BestSettings>) -> Self {
        let Some(found) = found else {
            return Self {
                numbers: [f64::NAN; 5],
                flags: [BEST_FLAG_FILL; 2],
                regions: i32::from(BEST_FLAG_FILL),
            };
        };
        let best = &found.overall;
        let kind = Kind::ALL.iter().position(|&kind| kind == best.kind);
        Self {
            numbers: [
                best.gain,
                best.tau,
                best.abscissa,
                best.frequency(),
                best.relaxation_time().unwrap_or(f64::NAN),
            ],
            flags: [
                kind.map_or(BEST_FLAG_FILL, |kind| kind as i8),
                i8::from(best.certified),
            ],
            regions: (found.regions.len() + found.regions_left_out) as i32,
        }
    }
}

/// A variable with the values of the planes so far.
struct Variable<T> {
    dataset: Dataset,
    fill: T,
    values: Vec<T>,
}

impl<T: H5Type + Copy + PartialEq> Variable<T> {
    /// Integers without a missing value get no `_FillValue`: readers would turn them into floats.
    fn write(&self) -> hdf5::Result<()> {
        let missing = |value: &T| *value == self.fill;
        let real = !missing(&self.fill);
        if real || self.values.iter().any(missing) {
            put_numbers(&self.dataset, FILL_VALUE, &[self.fill])?;
        }
        match self.values[..] {
            [value] if self.dataset.ndim() == 0 => self.dataset.write_scalar(&value),
            _ => self.dataset.write_raw(&self.values),
        }
    }
}

/// The group of best settings of a map that is being written.
pub(super) struct BestWriter {
    numbers: Vec<Variable<f64>>,
    flags: Vec<Variable<i8>>,
    regions: Variable<i32>,
}

/// Makes the variables of the group.
struct Variables<'a> {
    group: &'a Group,
    dimensions: &'a mut Dimensions,
    outer: &'a [DimensionId],
    shape: Vec<usize>,
}

impl Variables<'_> {
    fn make<T>(
        &mut self,
        name: &str,
        (long_name, unit): (&str, &str),
        fill: T,
    ) -> hdf5::Result<Variable<T>>
    where
        T: H5Type + Copy + Into<OwnedDynValue>,
    {
        let builder = named(self.group.new_dataset_builder())
            .fill_value(fill)
            .empty::<T>();
        let dataset = if self.outer.is_empty() {
            builder.create(name)?
        } else {
            let dataset = builder.shape(self.shape.clone()).create(name)?;
            self.dimensions.attach(&dataset, self.outer)?;
            dataset
        };
        put_text(&dataset, "long_name", long_name)?;
        put_text(&dataset, "units", unit)?;
        Ok(Variable {
            dataset,
            fill,
            values: Vec::new(),
        })
    }

    fn numbers(&mut self, plan: &Plan, gain: &Quantity) -> hdf5::Result<Vec<Variable<f64>>> {
        let units = &plan.spec.units;
        let rate = units.of([0, 0, -1]);
        let (time, frequency) = (units.time(), units.angular_frequency());
        let of_gain = gain.unit(units);
        let tau = Parameter::Tau;
        let mut make = |name, about| self.make(name, about, f64::NAN);
        Ok(vec![
            make(gain.name(), (gain.long_name(), &of_gain))?,
            make(tau.name(), (tau.long_name(), &time))?,
            make(
                names::ABSCISSA,
                ("largest real part of a characteristic root", &rate),
            )?,
            make(
                names::FREQUENCY,
                ("lowest frequency among the rightmost roots", &frequency),
            )?,
            make(
                names::RELAXATION_TIME,
                ("relaxation time, where sliding is stable", &time),
            )?,
        ])
    }

    fn flags(&mut self) -> hdf5::Result<Vec<Variable<i8>>> {
        let kind = self.make(
            names::KIND,
            ("what makes the setting the best", "1"),
            BEST_FLAG_FILL,
        )?;
        let numbers: Vec<i8> = (0..).take(Kind::ALL.len()).collect();
        let meanings = Kind::ALL
            .map(|kind| kind.name().replace(' ', "_"))
            .join(" ");
        put_flags(&kind.dataset, &numbers, &meanings)?;
        let certified = self.make(
            names::CERTIFIED,
            ("the argument principle confirms the abscissa", "1"),
            BEST_FLAG_FILL,
        )?;
        put_flags(&certified.dataset, &[0, 1], "no yes")?;
        Ok(vec![kind, certified])
    }
}

impl BestWriter {
    /// Creates the group, for the planes of `plan` spanned by the axes `gain` and delay; `axes` are
    /// the map's dimensions.
    pub(super) fn create(
        parent: &Group,
        dimensions: &mut Dimensions,
        axes: &[DimensionId],
        plan: &Plan,
        (gain, tau): (usize, usize),
    ) -> hdf5::Result<Self> {
        let group = parent
            .create_group_builder()
            .with_gcpl(|gcpl| {
                gcpl.obj_track_times(false)
                    .link_creation_order(LinkCreationOrder::Indexed)
            })
            .create(BEST)?;
        let parameter = plan.spec.axes[gain].parameter.clone();
        let title = "settings of fastest decay within the ranges of the gain and the delay";
        put_text(&group, "title", title)?;
        let plane = format!("{} {}", parameter.name(), Parameter::Tau.name());
        put_text(&group, PLANE, &plane)?;
        let outer: Vec<usize> = (0..axes.len()).filter(|&a| a != gain && a != tau).collect();
        put_coordinates(&group, dimensions, axes, plan, &outer)?;
        let scales: Vec<DimensionId> = outer.iter().map(|&axis| axes[axis]).collect();
        let mut variables = Variables {
            group: &group,
            dimensions,
            outer: &scales,
            shape: outer.iter().map(|&axis| plan.shape()[axis]).collect(),
        };
        Ok(Self {
            numbers: variables.numbers(plan, &parameter)?,
            flags: variables.flags()?,
            regions: variables.make(
                names::REGIONS,
                ("number of stable regions", "1"),
                i32::from(BEST_FLAG_FILL),
            )?,
        })
    }

    /// Takes the best setting of the next plane, in order.
    pub(super) fn append(&mut self, row: &BestRow) {
        for (column, value) in self.numbers.iter_mut().zip(row.numbers) {
            column.values.push(value);
        }
        for (column, value) in self.flags.iter_mut().zip(row.flags) {
            column.values.push(value);
        }
        self.regions.values.push(row.regions);
    }

    /// Writes the collected values. Called once, after the last plane.
    pub(super) fn finish(&self) -> hdf5::Result<()> {
        self.numbers.iter().try_for_each(Variable::write)?;
        self.flags.iter().try_for_each(Variable::write)?;
        self.regions.write()
    }
}

/// Repeats the map's axes `outer` in `group`, on the map's dimensions.
fn put_coordinates(
    group: &Group,
    dimensions: &mut Dimensions,
    axes: &[DimensionId],
    plan: &Plan,
    outer: &[usize],
) -> hdf5::Result<()> {
    for &axis in outer {
        let values = &plan.spec.axes[axis];
        let dataset = named(group.new_dataset_builder())
            .with_data(&values.values)
            .create(values.parameter.name())?;
        describe_parameter(&dataset, &values.parameter, &plan.spec.units)?;
        dimensions.attach(&dataset, &[axes[axis]])?;
    }
    Ok(())
}
