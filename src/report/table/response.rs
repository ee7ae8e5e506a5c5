//! The samples of a response in time, as rows.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{Column, Table, TableError};
use crate::linear::response::Response;

/// Writes the samples of a response, one row each: time, in the unit `time`, and response. Returns
/// the number of rows.
///
/// # Errors
/// When the text cannot be written, and once `stop` is set.
pub fn write_response(
    response: &Response,
    time: &str,
    out: impl Write,
    stop: &AtomicBool,
) -> Result<u64, TableError> {
    let columns = [
        Column::of("t", time, "time"),
        Column::of("y", "", "response"),
    ];
    let mut table = Table::begin(out, None, &columns)?;
    for (t, y) in response.t.iter().zip(&response.y) {
        if stop.load(Ordering::Relaxed) {
            return Err(TableError::Stopped);
        }
        table.number(*t)?;
        table.number(*y)?;
        table.end_row()?;
    }
    table.finish()
}
