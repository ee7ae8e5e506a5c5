//! Telling the user things. A reader that has gone (`slipmap … | head`) or a closed stream is no reason to fail or to panic.

use std::fmt::Display;
use std::io::Write;

use super::failure::Failure;

/// A line on standard output: a result. Fails where it cannot be written, a full disk for instance.
pub fn result(line: impl Display) -> Result<(), Failure> {
    Ok(writeln!(std::io::stdout(), "{line}")?)
}

/// A line on standard error: a remark.
pub fn remark(line: impl Display) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
