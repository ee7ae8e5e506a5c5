//! The cells of a picture: each has a value, or a reason why it shows none.

use crate::meaning::gap::{Gap, Rule};
use crate::setting::Field;
use crate::store::map_file::Plane;
use crate::store::{MapFile, StoreError};

/// A plane of a field, with the cells that have no value to show.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Known {
    /// The numbers of the map.
    pub(super) plane: Plane,
    /// Why a cell is not shown; none where it is.
    pub(super) gaps: Vec<Option<Gap>>,
}

impl Known {
    /// The plane that [`MapFile::plane`] gives, with gaps from the statuses of its cells.
    ///
    /// # Errors
    /// When the map cannot be read.
    pub(super) fn read(
        map: &MapFile,
        field: Field,
        index: &[usize],
        axes: (usize, usize),
        most: usize,
    ) -> Result<Self, StoreError> {
        let plane = map.plane(field, index, axes, most)?;
        let statuses = map.status_plane(index, axes, most)?;
        let rule = Rule::of(field, map.fields());
        let told = match rule.why() {
            Some(other) if plane.cells.iter().any(|v| v.is_nan()) => {
                Some(map.plane(other, index, axes, most)?)
            }
            _ => None,
        };
        let gap = |(i, (&value, &status)): (usize, (&f64, &u8))| {
            let why = told.as_ref().and_then(|plane| plane.cells.get(i));
            rule.gap(value, status, why.copied())
        };
        let gaps = plane.cells.iter().zip(&statuses).enumerate();
        let gaps = gaps.map(gap).collect();
        Ok(Self { plane, gaps })
    }

    /// The values of the cells that are shown.
    #[cfg(feature = "picture")]
    pub(super) fn values(&self) -> impl Iterator<Item = f64> {
        let cells = self.plane.cells.iter().zip(&self.gaps);
        cells
            .filter(|(_, gap)| gap.is_none())
            .map(|(value, _)| *value)
    }
}
