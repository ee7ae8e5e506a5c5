//! Friction measured through control, a row for each v0, as `slipmap fit` reads it.

use std::io::Write;

use super::{Column, Table, TableError, in_brackets};
use crate::explore::measure::Measurement;
use crate::setting::Parameter;
use crate::setting::measured::SpeedUnit;
use crate::setting::units::Units;

/// Writes a row for every v0: v0, μ_K, its standard error, and whether it settled. The title of v0
/// has its unit, from which a reader converts, where there is one that readers know. Returns the
/// number of rows.
///
/// # Errors
/// When the text cannot be written.
pub fn write_measured(
    measured: &Measurement,
    units: &Units,
    out: impl Write,
) -> Result<u64, TableError> {
    let unit = units.of_parameter(Parameter::V0);
    let known = SpeedUnit::read(&unit).is_ok();
    let v0 = Parameter::V0.name().to_owned() + &in_brackets(if known { &unit } else { "" });
    let columns = [&*v0, "mu_k", "mu_k_error", "settled"];
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
