//! Reads the summaries of the columns of a map from their attributes.

use hdf5::Dataset;

use super::attributes::{numbers, one_number};
use super::values::Number;
use crate::linear::status::FLAGS;
use crate::setting::field::Storage;
use crate::sweep::described::schema::summary::{
    ACTUAL_RANGE, FINITE_RANGE, FLAG_CELLS, INFINITE, UNFLAGGED, WITHOUT_VALUE,
};
use crate::sweep::described::summary::{FieldSummary, StatusCounts};

impl FieldSummary {
    /// Reads the summary from the dataset of a field with `cells` cells; none for maps without it.
    pub(super) fn told(on: &Dataset, storage: Storage, cells: u64) -> Option<Self> {
        let known = cells.checked_sub(one_number(on, WITHOUT_VALUE)?)?;
        let mut told = Self {
            finite: known,
            ..Self::default()
        };
        match storage {
            Storage::Kind => told.kinds = several(on, FLAG_CELLS)?,
            Storage::Few => told.range = range::<u8>(on, ACTUAL_RANGE),
            Storage::Count => told.range = range::<u16>(on, ACTUAL_RANGE),
            Storage::Real => {
                told.infinite = several(on, INFINITE)?.try_into().ok()?;
                let [below, above] = told.infinite;
                told.finite = known.checked_sub(below.checked_add(above)?)?;
                told.range = range::<f64>(on, FINITE_RANGE);
            }
        }
        Some(told)
    }
}

impl StatusCounts {
    /// Reads the counts from the dataset of `cells` statuses; none for maps without them.
    pub(super) fn told(on: &Dataset, cells: u64) -> Option<Self> {
        Some(Self {
            computed: cells.checked_sub(one_number(on, WITHOUT_VALUE)?)?,
            unflagged: one_number(on, UNFLAGGED)?,
            flagged: flagged(several(on, FLAG_CELLS)?)?,
        })
    }
}

fn several<T: Number>(on: &Dataset, name: &str) -> Option<Vec<T>> {
    numbers(&on.attr(name).ok()?).ok()
}

fn range<T: Number + Into<f64>>(on: &Dataset, name: &str) -> Option<(f64, f64)> {
    match several::<T>(on, name)?[..] {
        [low, high] => Some((low.into(), high.into())),
        _ => None,
    }
}

/// The cells with each flag, as a map tells them. Older maps lack the last flags.
fn flagged(mut told: Vec<u64>) -> Option<[u64; FLAGS.len()]> {
    if told.len() < FLAGS.len() {
        told.resize(FLAGS.len(), 0);
    }
    told.try_into().ok()
}
