//! Friction measured through control, a row for each v0, as `slipmap fit` reads it.

use std::io::Write;

use super::{Column, Table, TableError};
use crate::explore::measure::Measurement;
use crate::setting::Parameter;

/// Writes a row for every v0: v0, μ_K, its standard error, and whether it settled. Returns the
/// number of rows.
///
/// # Errors
/// When the text cannot be written.
pub fn write_measured(measured: &Measurement, out: impl Write) -> Result<u64, TableError> {
    let columns = [Parameter::V0.name(), "mu_k", "mu_k_error", "settled"];
    let columns = columns.map(|name| Column::of(name, "", ""));
    let mut table = Table::begin(out, None, &columns)?;
    for point in &measured.points {
        for value in [point.v0, point.mu_k, point.mu_k_error] {
            table.number(value)?;
        }
        table.text(if point.settled { "true" } else { "false" })?;
        table.end_row()?;
    }
    table.finish()
}
