//! Starts of motions with their outcomes, as rows.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{Column, Table, TableError};
use crate::answers::basin::Region;
use crate::explore::basin::Followed;
use crate::setting::units::Units;
use crate::setting::{Field, Parameter};

/// Writes starts, one row each: the number of the scrambling, ẋ and elongation or the phase of
/// switch-on, and the outcome as a word. Returns the number of rows.
///
/// # Errors
/// When the text cannot be written, and once `stop` is set.
pub fn write_starts(
    followed: &Followed,
    units: &Units,
    out: impl Write,
    stop: &AtomicBool,
) -> Result<u64, TableError> {
    let of: &[Parameter] = match followed.region() {
        Region::State { .. } => &[Parameter::XDot0, Parameter::A0],
        Region::Phase { .. } | Region::None => &[Parameter::SwitchOnPhase],
    };
    let scrambling = Column::of("scrambling", "", "which of the independent sequences");
    let starts = of
        .iter()
        .map(|p| Column::of_parameter(&(*p).into(), &units.of_parameter(*p)));
    let outcome = Column::of(Field::Outcome.name(), "", Field::Outcome.long_name());
    let columns: Vec<_> = [scrambling]
        .into_iter()
        .chain(starts)
        .chain([outcome])
        .collect();
    let mut table = Table::begin(out, None, &columns)?;
    for (place, start, outcome) in followed.starts() {
        if stop.load(Ordering::Relaxed) {
            return Err(TableError::Stopped);
        }
        table.whole(u64::from(place.scrambling))?;
        for value in &start[..of.len()] {
            table.number(*value)?;
        }
        table.text(outcome.name())?;
        table.end_row()?;
    }
    table.finish()
}
