//! Telling the user things. A reader that has gone (`slipmap … | head`) or a closed stream is no reason to fail or to panic.

use std::fmt::Display;
use std::io::Write;

use super::failure::Failure;

/// A text from a file with its control characters, but for ends of lines, spelled out: none of them reaches the terminal.
pub fn visible(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' => shown.push(c),
            c if c.is_control() => shown.extend(c.escape_default()),
            c => shown.push(c),
        }
    }
    shown
}

/// A line on standard output: a result. Fails where it cannot be written, a full disk for instance.
pub fn result(line: impl Display) -> Result<(), Failure> {
    Ok(writeln!(std::io::stdout(), "{line}")?)
}

/// A line on standard error: a remark.
pub fn remark(line: impl Display) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
