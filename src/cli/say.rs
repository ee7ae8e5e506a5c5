//! Telling the user things. A reader that has gone (`slipmap … | head`) or a closed stream is no
//! reason to fail or to panic.

use std::fmt::Display;
use std::io::Write;

use serde::Serialize;
pub use slipmap::report::visible::{shortened, visible, visible_line};

use super::failure::Failure;

/// A line on standard output: a result. Fails where it cannot be written, a full disk for instance.
pub fn result(line: impl Display) -> Result<(), Failure> {
    Ok(writeln!(
        std::io::stdout(),
        "{}",
        visible(&line.to_string())
    )?)
}

/// One JSON object on standard output.
pub fn json(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string(value).map_err(std::io::Error::from)?;
    let text = slipmap::report::visible::visible_json(&text);
    Ok(writeln!(std::io::stdout(), "{text}")?)
}

/// A line on standard error: a remark.
pub fn remark(line: impl Display) {
    coloured(visible(&line.to_string()));
}

/// A line for people, of a text that holds no other control characters than slipmap's own.
pub fn coloured(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{text}");
}
