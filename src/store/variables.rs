//! The datasets of cells in a map that is being written.

use hdf5::{Dataset, Group, H5Type};

use super::attributes::{put_flags, put_numbers, put_text};
use super::codec::DEFLATE_LEVEL;
use super::describe::{put_basin, put_search};
use super::netcdf::{DimensionId, Dimensions, named};
use super::schema::STATUS;
use crate::linear::status::FLAGS;
use crate::sweep::engine::{FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL};
use crate::sweep::input::field::Storage;
use crate::sweep::{Field, Plan};

/// The attribute by which netCDF readers recognise cells without a value.
pub(super) const FILL_VALUE: &str = "_FillValue";

/// Writes the fill value of a dataset of integers. Datasets of reals already have theirs, NaN.
pub(super) fn put_fill(dataset: &Dataset, storage: Storage) -> hdf5::Result<()> {
    match storage {
        Storage::Count => put_numbers(dataset, FILL_VALUE, &[N_UNSTABLE_FILL]),
        Storage::Kind | Storage::Few => put_numbers(dataset, FILL_VALUE, &[FEW_FILL]),
        Storage::Real => Ok(()),
    }
}

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
            Storage::Real => {
                let dataset = self.variable(field.name(), f64::NAN)?;
                put_numbers(&dataset, FILL_VALUE, &[f64::NAN])?;
                dataset
            }
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
        if let Some(basin) = spec.basin.filter(|_| field.of_basin()) {
            put_basin(&dataset, &basin)?;
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

    /// A dataset with `fill` where there is no value. The attribute `_FillValue` of integers is
    /// written later, and only where cells are missing: with it, readers turn integers into floats.
    /// There is no `valid_max`: netCDF-3 has no unsigned type, and writers of it refuse 65534.
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
        if !self.scalars.is_empty() {
            put_text(&dataset, "coordinates", &self.scalars)?;
        }
        self.dimensions.attach(&dataset, &self.axes)?;
        Ok(dataset)
    }
}
