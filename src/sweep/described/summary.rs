//! Summaries of the columns of a map: the range of values, and the number of cells of each kind.
//! They are counted when a tile is computed and added up for the map, and are attributes there, so
//! that no reader has to go through all cells.

#[cfg(feature = "store")]
use serde::{Deserialize, Serialize};

use super::schema::summary::{
    ACTUAL_RANGE, FINITE_RANGE, FLAG_CELLS, INFINITE, UNFLAGGED, WITHOUT_VALUE,
};
use super::{Attribute, Value, attribute};
use crate::linear::status::FLAGS;
use crate::setting::field::{Field, Storage};
use crate::sweep::cells::buffers::{FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL, TileBuffers};

/// Summary of a field's values in some cells.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "store", derive(Serialize, Deserialize))]
pub struct FieldSummary {
    /// The smallest and largest finite value; none where there is no such value, and for fields
    /// with kinds.
    pub range: Option<(f64, f64)>,
    /// Number of cells with a finite value, or a kind.
    pub finite: u64,
    /// Number of values of −∞, and of +∞.
    pub infinite: [u64; 2],
    /// Number of cells of each kind, in the order of [`Field::kinds`]; empty for other fields.
    pub kinds: Vec<u64>,
}

impl FieldSummary {
    /// Counts real values; NaN stands for no value.
    #[must_use]
    pub fn of_reals(cells: &[f64]) -> Self {
        let finite = || cells.iter().copied().filter(|value| value.is_finite());
        let low = finite().fold(f64::INFINITY, f64::min);
        let high = finite().fold(f64::NEG_INFINITY, f64::max);
        Self {
            range: (low <= high).then_some((low, high)),
            finite: count(cells, f64::is_finite),
            infinite: [f64::NEG_INFINITY, f64::INFINITY]
                .map(|infinity| count(cells, |value| value == infinity)),
            kinds: Vec::new(),
        }
    }

    /// Counts whole numbers; `fill`, the largest number of the type, stands for no value.
    fn of_counts<T: Copy + Ord + Default + Into<f64>>(cells: &[T], fill: T) -> Self {
        let (low, mut high) = ends(cells, fill, |value| value);
        let mut finite = cells.len() as u64;
        // Most tiles have a value in every cell; one pass is then enough.
        if high == fill {
            let known = |value: T| if value == fill { T::default() } else { value };
            high = ends(cells, fill, known).1;
            finite = count(cells, |value| value != fill);
        }
        Self {
            range: (low < fill).then_some((low.into(), high.into())),
            finite,
            infinite: [0; 2],
            kinds: Vec::new(),
        }
    }

    /// Counts cells of `kinds` kinds.
    fn of_kinds(cells: &[u8], kinds: usize) -> Self {
        // Many tiles are all of one kind.
        let first = cells.first().copied();
        let only = first.filter(|first| cells.iter().all(|cell| cell == first));
        let of = |kind: usize| match only {
            Some(only) if usize::from(only) == kind => cells.len() as u64,
            Some(_) => 0,
            None => count(cells, |cell| usize::from(cell) == kind),
        };
        let kinds: Vec<u64> = (0..kinds).map(of).collect();
        Self {
            finite: kinds.iter().sum(),
            kinds,
            ..Self::default()
        }
    }

    /// Counts the cells of a field stored as u8.
    pub(crate) fn of_bytes(field: Field, cells: &[u8]) -> Self {
        match field.kinds() {
            Some(kinds) => Self::of_kinds(cells, kinds.len()),
            None => Self::of_counts(cells, FEW_FILL),
        }
    }

    /// Counts numbers of roots.
    pub(crate) fn of_roots(cells: &[u16]) -> Self {
        Self::of_counts(cells, N_UNSTABLE_FILL)
    }

    /// Adds the summary of other cells of the same field.
    pub fn add(&mut self, other: &Self) {
        self.range = match (self.range, other.range) {
            (Some((low, high)), Some((l, h))) => Some((low.min(l), high.max(h))),
            (one, another) => one.or(another),
        };
        self.finite += other.finite;
        for (count, more) in self.infinite.iter_mut().zip(other.infinite) {
            *count += more;
        }
        self.kinds
            .resize(self.kinds.len().max(other.kinds.len()), 0);
        for (count, more) in self.kinds.iter_mut().zip(&other.kinds) {
            *count += more;
        }
    }

    /// How many of `cells` cells have no value.
    #[must_use]
    pub fn missing(&self, cells: u64) -> u64 {
        cells.saturating_sub(self.finite + self.infinite.iter().sum::<u64>())
    }

    /// The smallest and the largest value, including infinite ones.
    fn ends(&self) -> Option<(f64, f64)> {
        let [below, above] = self.infinite.map(|count| count > 0);
        let (low, high) = match self.range {
            Some(range) => range,
            None if below || above => (f64::INFINITY, f64::NEG_INFINITY),
            None => return None,
        };
        let low = if below { f64::NEG_INFINITY } else { low };
        Some((low, if above { f64::INFINITY } else { high }))
    }

    /// The summary as attributes of a field that is stored so, of a map with `cells` cells.
    #[must_use]
    pub(crate) fn attributes(&self, storage: Storage, cells: u64) -> Vec<Attribute> {
        let mut told = vec![attribute(WITHOUT_VALUE, [self.missing(cells)])];
        match storage {
            Storage::Kind => told.push(attribute(FLAG_CELLS, &self.kinds[..])),
            Storage::Few => told.extend(of_range(ACTUAL_RANGE, self.ends(), |value| value as u8)),
            Storage::Count => {
                told.extend(of_range(ACTUAL_RANGE, self.ends(), |value| value as u16));
            }
            Storage::Real => {
                told.push(attribute(INFINITE, self.infinite));
                told.extend(of_range(FINITE_RANGE, self.range, |value| value));
                told.extend(of_range(ACTUAL_RANGE, self.ends(), |value| value));
            }
        }
        told
    }
}

/// How many cells satisfy `holds`. Short runs are added up in bytes, so that the compiler can use
/// wide registers; the time is then negligible beside compression.
fn count<T: Copy>(cells: &[T], holds: impl Fn(T) -> bool) -> u64 {
    let of = |few: &[T]| few.iter().fold(0_u8, |n, &cell| n + u8::from(holds(cell)));
    let few = usize::from(u8::MAX);
    cells.chunks(few).map(|few| u64::from(of(few))).sum()
}

/// The smallest cell, at most `most`, and the largest value of `as_known` over the cells.
fn ends<T: Copy + Ord + Default>(cells: &[T], most: T, as_known: impl Fn(T) -> T) -> (T, T) {
    let ends = (most, T::default());
    cells.iter().fold(ends, |(low, high), &value| {
        (low.min(value), high.max(as_known(value)))
    })
}

/// A range as an attribute, in the type of the cells; none without one.
fn of_range<T>(
    name: &'static str,
    range: Option<(f64, f64)>,
    value: impl Fn(f64) -> T,
) -> Option<Attribute>
where
    Value: From<[T; 2]>,
{
    range.map(|(low, high)| attribute(name, [value(low), value(high)]))
}

/// Counts of the statuses of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "store", derive(Serialize, Deserialize))]
pub struct StatusCounts {
    /// Cells that are computed.
    pub computed: u64,
    /// Cells without any flag.
    pub unflagged: u64,
    /// Cells with each flag, in the order of [`FLAGS`].
    pub flagged: [u64; FLAGS.len()],
}

impl StatusCounts {
    /// Counts these statuses.
    #[must_use]
    pub fn of(cells: &[u8]) -> Self {
        // Most tiles have no flag at all; one pass is then enough.
        if cells.iter().fold(0, |any, status| any | status) == 0 {
            let all = cells.len() as u64;
            return Self {
                computed: all,
                unflagged: all,
                ..Self::default()
            };
        }
        let with = |mask: u8| count(cells, |s| s & mask != 0 && s != STATUS_FILL);
        Self {
            computed: count(cells, |status| status != STATUS_FILL),
            unflagged: count(cells, |status| status == 0),
            flagged: FLAGS.map(|(mask, _)| with(mask)),
        }
    }

    /// Adds the summary of other cells.
    pub(crate) fn add(&mut self, other: &Self) {
        self.computed += other.computed;
        self.unflagged += other.unflagged;
        for (count, more) in self.flagged.iter_mut().zip(other.flagged) {
            *count += more;
        }
    }

    /// The counts as attributes of the status of a map with `cells` cells.
    #[must_use]
    pub(crate) fn attributes(&self, cells: u64) -> [Attribute; 3] {
        [
            attribute(WITHOUT_VALUE, [cells.saturating_sub(self.computed)]),
            attribute(UNFLAGGED, [self.unflagged]),
            attribute(FLAG_CELLS, self.flagged),
        ]
    }
}

/// Summary of the cells of one or several tiles.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "store", derive(Serialize, Deserialize))]
pub(crate) struct CellsSummary {
    /// One for each field, in the order of the map's datasets.
    pub fields: Vec<FieldSummary>,
    /// The counts of the statuses.
    pub status: StatusCounts,
}

impl CellsSummary {
    /// Summarises a tile. Cells beyond the map hold fill values, which do not count.
    pub(crate) fn of(tile: &TileBuffers) -> Self {
        let roots = tile.n_unstable.iter().map(|n| FieldSummary::of_roots(n));
        let bytes = tile.kinds.iter();
        let bytes = bytes.map(|column| FieldSummary::of_bytes(column.field, &column.cells));
        let reals = tile.columns.iter();
        let reals = reals.map(|column| FieldSummary::of_reals(&column.cells));
        Self {
            fields: roots.chain(bytes).chain(reals).collect(),
            status: StatusCounts::of(&tile.status),
        }
    }

    /// Adds the summary of other cells.
    pub(crate) fn add(&mut self, other: &Self) {
        let fields = self.fields.len().max(other.fields.len());
        self.fields.resize(fields, FieldSummary::default());
        for (field, more) in self.fields.iter_mut().zip(&other.fields) {
            field.add(more);
        }
        self.status.add(&other.status);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::status::{CERTIFIED, MARGINAL};

    #[test]
    fn values_are_counted_without_those_that_are_none() {
        let reals = [1.5, f64::NAN, -2.0, f64::INFINITY, f64::NEG_INFINITY];
        let found = FieldSummary::of_reals(&reals);
        assert_eq!(found.range, Some((-2.0, 1.5)));
        assert_eq!(
            (found.finite, found.infinite, found.missing(7)),
            (2, [1, 1], 3)
        );
        assert_eq!(found.ends(), Some((f64::NEG_INFINITY, f64::INFINITY)));
        let all = FieldSummary::of_reals(&[f64::INFINITY]);
        assert_eq!(
            (all.range, all.ends()),
            (None, Some((f64::INFINITY, f64::INFINITY)))
        );
        let found = FieldSummary::of_roots(&[N_UNSTABLE_FILL, 3, 8, N_UNSTABLE_FILL]);
        assert_eq!((found.range, found.finite), (Some((3.0, 8.0)), 2));
        let found = FieldSummary::of_roots(&[N_UNSTABLE_FILL; 3]);
        assert_eq!((found.range, found.missing(3)), (None, 3));
        let kinds = FieldSummary::of_bytes(Field::Outcome, &[0, 2, 2, FEW_FILL]);
        assert_eq!((&kinds.kinds[..3], kinds.finite), (&[1, 0, 2][..], 3));
    }

    #[test]
    fn statuses_are_counted_by_flag() {
        let both = CERTIFIED | MARGINAL;
        let found = StatusCounts::of(&[0, CERTIFIED, both, STATUS_FILL]);
        assert_eq!((found.computed, found.unflagged), (3, 1));
        assert_eq!(found.flagged[..3], [2, 1, 0]);
    }

    #[test]
    fn parts_add_up_to_the_whole() {
        let cells = [0.25, f64::NAN, 7.0, f64::INFINITY, -3.0, f64::NAN];
        let mut sum = FieldSummary::default();
        for part in cells.chunks(2) {
            sum.add(&FieldSummary::of_reals(part));
        }
        assert_eq!(sum, FieldSummary::of_reals(&cells));
        let statuses = [0, 1, 2, 3, STATUS_FILL, 32];
        let mut sum = StatusCounts::default();
        for part in statuses.chunks(2) {
            sum.add(&StatusCounts::of(part));
        }
        assert_eq!(sum, StatusCounts::of(&statuses));
    }
}
