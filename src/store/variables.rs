//! The datasets of cells in a map that is being written.

use hdf5::{Dataset, Group, H5Type};

use super::attributes::{put_flags, put_numbers, put_text};
use super::codec::DEFLATE_LEVEL;
use super::describe::put_search;
use super::netcdf::{DimensionId, Dimensions, named};
use super::schema::STATUS;
use crate::linear::status::FLAGS;
use crate::sweep::engine::{FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL};
use crate::sweep::input::field::Storage;
use crate::sweep::{Field, Plan};

/// Creates the datasets of the cells.
pub(super) struct Variables<'a> {
    pub file: &'a Group,
    pub plan: &'a Plan,
    pub dimensions: &'a mut Dimensions,
    pub axes: Vec<DimensionId>,
    pub scalars: String,
}

impl Variables<'_> {
    pub(super) fn field(&mut self, field: Field) -> hdf5::Result<Dataset> {
        let dataset = match field.storage() {
            Storage::Count => self.variable(field.name(), N_UNSTABLE_FILL)?,
            Storage::Kind | Storage::Few => self.variable(field.name(), FEW_FILL)?,
            Storage::Real => self.variable(field.name(), f64::NAN)?,
        };
        let spec = &self.plan.spec;
        let (long_name, comment) = match spec.critical {
            Some(_) => field.described_at_vc(),
            None => (field.long_name(), field.comment()),
        };
        match field.kinds() {
            Some(kinds) => put_flags(&dataset, long_name, &kinds)?,
            None => put_text(&dataset, "long_name", long_name)?,
        }
        put_text(&dataset, "units", &field.unit(&spec.units))?;
        if let Some(comment) = comment {
            put_text(&dataset, "comment", comment)?;
        }
        if let Some(search) = spec.critical.filter(|_| !field.of_sliding()) {
            put_search(&dataset, &search)?;
        }
        put_text(&dataset, "ancillary_variables", STATUS)?;
        Ok(dataset)
    }

    pub(super) fn status(&mut self) -> hdf5::Result<Dataset> {
        let dataset = self.variable(STATUS, STATUS_FILL)?;
        put_text(&dataset, "long_name", "status of the cell")?;
        put_text(&dataset, "units", "1")?;
        put_numbers(&dataset, "flag_masks", &FLAGS.map(|(mask, _)| mask))?;
        put_text(
            &dataset,
            "flag_meanings",
            &FLAGS.map(|(_, name)| name).join(" "),
        )?;
        Ok(dataset)
    }

    fn variable<T>(&mut self, name: &str, fill: T) -> hdf5::Result<Dataset>
    where
        T: H5Type + Copy + Into<hdf5::types::OwnedDynValue>,
    {
        let mut builder = named(self.file.new_dataset_builder());
        if size_of::<T>() > 1 {
            builder = builder.shuffle();
        }
        let dataset = builder
            .deflate(DEFLATE_LEVEL)
            .fill_value(fill)
            .empty::<T>()
            .shape(self.plan.shape())
            .chunk(self.plan.tiles.tile_shape())
            .create(name)?;
        put_numbers(&dataset, "_FillValue", &[fill])?;
        if !self.scalars.is_empty() {
            put_text(&dataset, "coordinates", &self.scalars)?;
        }
        self.dimensions.attach(&dataset, &self.axes)?;
        Ok(dataset)
    }
}
