//! The cells of a tile in memory, a column for each field.

use std::ops::Range;

use crate::setting::field::{Field, Storage};
use crate::sweep::plan::Plan;

/// The cells of one tile, in memory in the order of its strides. Cells beyond the map hold fill
/// values.
#[derive(Debug, Clone)]
pub struct TileBuffers {
    /// Status of each cell, see [`crate::linear::status`].
    pub status: Vec<u8>,
    /// Number of unstable roots, if requested.
    pub n_unstable: Option<Vec<u16>>,
    /// The requested fields stored as u8, in their order: kinds and small counts.
    pub kinds: Vec<Column<u8>>,
    /// The other requested fields, in their order.
    pub columns: Vec<Column>,
}

/// The cells of one field.
#[derive(Debug, Clone)]
pub struct Column<T = f64> {
    /// The field.
    pub field: Field,
    /// Its value in each cell; NaN or [`FEW_FILL`] where there is none.
    pub cells: Vec<T>,
}

/// Value of `n_unstable` in cells that are not computed.
pub const N_UNSTABLE_FILL: u16 = u16::MAX;
/// Value of kinds and small counts in cells without a value.
pub const FEW_FILL: u8 = u8::MAX;
/// Value of `status` in cells that are not computed.
pub const STATUS_FILL: u8 = u8::MAX;

impl TileBuffers {
    /// Buffers for tiles of `plan`, all fill values.
    #[must_use]
    pub fn new(plan: &Plan) -> Self {
        Self::of_cells(&plan.spec.fields, plan.tiles.tile_cells())
    }

    /// Buffers for `cells` cells with these fields, all fill values.
    pub(in crate::sweep) fn of_cells(fields: &[Field], cells: usize) -> Self {
        Self {
            status: vec![STATUS_FILL; cells],
            n_unstable: fields
                .contains(&Field::NUnstable)
                .then(|| vec![N_UNSTABLE_FILL; cells]),
            kinds: columns(fields, &[Storage::Kind, Storage::Few], FEW_FILL, cells),
            columns: columns(fields, &[Storage::Real], f64::NAN, cells),
        }
    }

    /// Copies the cells at the places `there` of other buffers of the same fields to the places
    /// `at`.
    pub(in crate::sweep) fn take_cells(
        &mut self,
        at: Range<usize>,
        from: &Self,
        there: Range<usize>,
    ) {
        let places = (at, there);
        take(&mut self.status, &from.status, &places);
        if let (Some(to), Some(from)) = (&mut self.n_unstable, &from.n_unstable) {
            take(to, from, &places);
        }
        for (to, from) in self.kinds.iter_mut().zip(&from.kinds) {
            take(&mut to.cells, &from.cells, &places);
        }
        for (to, from) in self.columns.iter_mut().zip(&from.columns) {
            take(&mut to.cells, &from.cells, &places);
        }
    }

    /// Stores the result of `value` for each field but counts, in the cell at `place`; NaN is no
    /// value.
    pub(super) fn put(&mut self, place: usize, value: impl Fn(Field) -> Option<f64>) {
        for column in &mut self.kinds {
            if let Some(value) = value(column.field) {
                column.cells[place] = few(value);
            }
        }
        for column in &mut self.columns {
            if let Some(value) = value(column.field) {
                column.cells[place] = value;
            }
        }
    }

    pub(super) fn clear(&mut self) {
        self.status.fill(STATUS_FILL);
        if let Some(n) = &mut self.n_unstable {
            n.fill(N_UNSTABLE_FILL);
        }
        for column in &mut self.kinds {
            column.cells.fill(FEW_FILL);
        }
        for column in &mut self.columns {
            column.cells.fill(f64::NAN);
        }
    }
}

fn take<T: Copy>(to: &mut [T], from: &[T], (at, there): &(Range<usize>, Range<usize>)) {
    to[at.clone()].copy_from_slice(&from[there.clone()]);
}

/// A kind or a small count, saturating below [`FEW_FILL`], which stands for NaN.
fn few(value: f64) -> u8 {
    if value.is_nan() {
        FEW_FILL
    } else {
        value.min(f64::from(FEW_FILL - 1)) as u8
    }
}

/// Columns of `cells` cells for the fields with this storage.
fn columns<T: Clone>(
    fields: &[Field],
    stored: &[Storage],
    fill: T,
    cells: usize,
) -> Vec<Column<T>> {
    let stored = fields.iter().filter(|f| stored.contains(&f.storage()));
    let column = |&field: &Field| Column {
        field,
        cells: vec![fill.clone(); cells],
    };
    stored.map(column).collect()
}

/// Replaces all zeros by +0 and all NaNs by one NaN. Processors differ in the signs that they give
/// to 0/0, the larger of two zeros and the like.
pub(super) fn one_zero_and_one_nan(cells: &mut [f64]) {
    for cell in cells {
        *cell = if cell.is_nan() { f64::NAN } else { *cell + 0.0 };
    }
}
