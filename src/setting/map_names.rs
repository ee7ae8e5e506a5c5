//! The names in a map that are neither of a parameter nor of a field. No parameter of a system may
//! have one of them.

use super::field::Field;

/// Name of the status of each cell.
pub(crate) const STATUS: &str = "status";
/// Name of the group of crossing curves.
pub(crate) const BOUNDARIES: &str = "boundaries";
/// Name of the group of best settings.
pub(crate) const BEST: &str = "best";
/// The most axes: HDF5 has no datasets of more dimensions.
pub(crate) const MOST_AXES: usize = 32;

/// Every name that a parameter of a system cannot have, because it stands beside the axes in a map
/// or did in an earlier version.
pub fn taken() -> impl Iterator<Item = &'static str> {
    let fields = Field::ALL.into_iter();
    fields
        .flat_map(|field| [field.name(), field.first_name()])
        .chain([STATUS, BOUNDARIES, BEST])
}
