//! Writes crossing curves and curves of degrees of stability into a map, appended plane by plane.

use hdf5::{Dataset, Group, H5Type};

use super::netcdf::Dimensions;
use super::variables::{Layout, create, create_group, describe};
use crate::sweep::Plan;
use crate::sweep::described::curve_column::Column;
use crate::sweep::described::curve_rows::CurveRows;
use crate::sweep::described::curves::CurveTable;
use crate::sweep::described::{self, Described};

/// Elements in a chunk of the appended datasets.
const CHUNK: usize = 1 << 13;

/// The group of curves of a map that is being written.
pub(super) struct BoundaryWriter {
    /// Places of the dimensions of curves, vertices and corners.
    dimensions: Vec<usize>,
    /// The lengths of these dimensions.
    lengths: [usize; 3],
    /// One for each column of the table.
    datasets: Vec<Dataset>,
    waiting: CurveTable,
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
    /// Creates the group of a map of `plan`.
    pub(super) fn create(
        parent: &Group,
        described: &Described,
        about: &described::Group,
        plan: &Plan,
        dimensions: &mut Dimensions,
    ) -> hdf5::Result<Self> {
        let group = create_group(parent, described, about, dimensions)?;
        let layout = Layout {
            shape: (0..).into(),
            chunk: Some(vec![CHUNK]),
            shuffle_bytes: true,
        };
        let mut datasets = Vec::new();
        for variable in &about.variables {
            let dataset = create(&group, variable, &layout)?;
            describe(&dataset, variable, dimensions)?;
            datasets.push(dataset);
        }
        let all = described.dimensions.iter().enumerate();
        let own = all.filter(|(_, dimension)| dimension.group == about.name);
        Ok(Self {
            dimensions: own.map(|(place, _)| place).collect(),
            lengths: [0; 3],
            datasets,
            waiting: CurveTable::new(plan),
        })
    }

    /// Appends the curves of the next plane, which lies at the values `outer` of the axes outside
    /// of it.
    pub(super) fn append(&mut self, rows: &CurveRows, outer: &[f64]) -> hdf5::Result<()> {
        self.waiting.append(rows, outer);
        let [_, vertices, _] = self.waiting.lengths();
        match vertices >= CHUNK {
            true => self.flush(),
            false => Ok(()),
        }
    }

    fn flush(&mut self) -> hdf5::Result<()> {
        for (dataset, column) in self.datasets.iter().zip(self.waiting.columns()) {
            match column {
                Column::I8(values) => append(dataset, values),
                Column::I32(values) => append(dataset, values),
                Column::I64(values) => append(dataset, values),
                Column::F64(values) => append(dataset, values),
            }?;
        }
        for (length, more) in self.lengths.iter_mut().zip(self.waiting.lengths()) {
            *length += more;
        }
        self.waiting.clear();
        Ok(())
    }

    /// Sets each dimension to the final length of its data.
    pub(super) fn finish(&mut self, dimensions: &Dimensions) -> hdf5::Result<()> {
        self.flush()?;
        for (&place, length) in self.dimensions.iter().zip(self.lengths) {
            dimensions.scale(place).resize(length)?;
        }
        Ok(())
    }
}
