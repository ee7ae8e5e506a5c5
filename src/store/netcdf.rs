//! Dimension scales, as netCDF-4 and every reader built on it expects them.
//!
//! The binding has no calls for dimension scales, so their attributes are written one by one.

use hdf5::plist::dataset_create::AttrCreationOrder;
use hdf5::types::VarLenArray;
use hdf5::{Dataset, DatasetBuilder, Group, H5Type, ObjectReference1};

use super::attributes::{put_numbers, put_text};

/// One entry of a scale's list of the datasets that use it.
#[derive(Clone, Copy, H5Type)]
#[repr(C)]
struct ScaleUse {
    dataset: ObjectReference1,
    dimension: u32,
}

/// A dimension of the file: its scale, and the datasets that use it.
pub(super) struct Dimension {
    scale: Dataset,
    uses: Vec<(Dataset, u32)>,
}

/// All dimensions of a file, in the order in which they are described.
#[derive(Default)]
pub(super) struct Dimensions {
    list: Vec<Dimension>,
}

impl Dimensions {
    /// Makes `scale`, a one-dimensional dataset, the scale of a new dimension. `name` is none for a
    /// scale with coordinates.
    pub(super) fn add(&mut self, scale: Dataset, name: Option<&str>) -> hdf5::Result<()> {
        put_text(&scale, "CLASS", "DIMENSION_SCALE")?;
        let path = scale.name();
        let own = path.rsplit('/').next().unwrap_or(&path);
        put_text(&scale, "NAME", name.unwrap_or(own))?;
        put_numbers(&scale, "_Netcdf4Dimid", &[self.list.len() as i32])?;
        self.list.push(Dimension {
            scale,
            uses: Vec::new(),
        });
        Ok(())
    }

    /// Adds a dimension without coordinates, which can grow.
    pub(super) fn add_bare(
        &mut self,
        group: &Group,
        name: &str,
        length: usize,
    ) -> hdf5::Result<()> {
        let scale = named(group.new_dataset_builder())
            .empty::<f32>()
            .shape(0..)
            .chunk(1 << 16)
            .create(name)?;
        scale.resize(length)?;
        self.add(
            scale,
            Some("This is a netCDF dimension but not a netCDF variable.         0"),
        )
    }

    /// The scale of the dimension at this place.
    pub(super) fn scale(&self, place: usize) -> &Dataset {
        &self.list[place].scale
    }

    /// Attaches these dimensions to `dataset`, in order.
    pub(super) fn attach(&mut self, dataset: &Dataset, dimensions: &[usize]) -> hdf5::Result<()> {
        let mut lists = Vec::with_capacity(dimensions.len());
        for (place, &dimension) in dimensions.iter().enumerate() {
            let dimension = &mut self.list[dimension];
            let reference: ObjectReference1 = dimension.scale.reference(".")?;
            lists.push(VarLenArray::from_slice(&[reference]));
            dimension.uses.push((dataset.clone(), place as u32));
        }
        put_numbers(dataset, "DIMENSION_LIST", &lists)
    }

    /// Writes, for each scale, the datasets that use it. Called once, when all datasets are
    /// attached.
    pub(super) fn finish(&self) -> hdf5::Result<()> {
        for dimension in self.list.iter().filter(|d| !d.uses.is_empty()) {
            let uses: hdf5::Result<Vec<ScaleUse>> = dimension
                .uses
                .iter()
                .map(|(dataset, dimension)| {
                    Ok(ScaleUse {
                        dataset: dataset.reference(".")?,
                        dimension: *dimension,
                    })
                })
                .collect();
            put_numbers(&dimension.scale, "REFERENCE_LIST", &uses?)?;
        }
        Ok(())
    }
}

/// A builder with the settings of every dataset: no time stamps, and attributes in order of
/// creation, as netCDF requires.
pub(super) fn named(builder: DatasetBuilder) -> DatasetBuilder {
    builder
        .attr_creation_order(AttrCreationOrder::Indexed)
        .obj_track_times(false)
}
