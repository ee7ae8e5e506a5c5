//! Writes the best settings of a map, when those of all planes are known.

use hdf5::{Dataset, Extents, Group};

use super::netcdf::Dimensions;
use super::variables::{Layout, create, create_group, describe, put_fill, write};
use crate::sweep::described::best::BestRow;
use crate::sweep::described::{self, Described, Variable};

/// A variable with the values of the planes so far.
struct Filling {
    dataset: Dataset,
    variable: Variable,
    values: Vec<f64>,
}

impl Filling {
    fn write(&self) -> hdf5::Result<()> {
        let (element, dataset) = (self.variable.element, &self.dataset);
        if let Some(fill) = self.variable.fill.filter(|fill| self.values.contains(fill)) {
            put_fill(dataset, element, fill)?;
        }
        write(dataset, element, &self.values)
    }
}

/// The group of best settings of a map that is being written.
pub(super) struct BestWriter(Vec<Filling>);

impl BestWriter {
    /// Creates the group.
    pub(super) fn create(
        parent: &Group,
        described: &Described,
        about: &described::Group,
        dimensions: &mut Dimensions,
    ) -> hdf5::Result<Self> {
        let group = create_group(parent, described, about, dimensions)?;
        let mut filling = Vec::new();
        for variable in &about.variables {
            let shape = described.shape(variable);
            let layout = Layout {
                shape: match shape[..] {
                    [] => Extents::Scalar,
                    _ => shape.into(),
                },
                chunk: None,
                shuffle_bytes: false,
            };
            let dataset = create(&group, variable, &layout)?;
            describe(&dataset, variable, dimensions)?;
            if variable.values.is_none() {
                filling.push(Filling {
                    dataset,
                    variable: variable.clone(),
                    values: Vec::new(),
                });
            }
        }
        Ok(Self(filling))
    }

    /// Takes the best setting of the next plane, in order.
    pub(super) fn append(&mut self, row: &BestRow) {
        for (column, value) in self.0.iter_mut().zip(row.values()) {
            column.values.push(value);
        }
    }

    /// Writes the collected values. Called once, after the last plane.
    pub(super) fn finish(&self) -> hdf5::Result<()> {
        self.0.iter().try_for_each(Filling::write)
    }
}
