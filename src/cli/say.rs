//! Telling the user things. A reader that has gone (`slipmap … | head`) or a closed stream is no
//! reason to fail or to panic.

use std::fmt::Display;
use std::io::{StdoutLock, Write};
use std::sync::atomic::{AtomicBool, Ordering};

pub(super) use slipmap::report::visible::{shortened, visible, visible_line};

use super::failure::Failure;

/// A line on standard output: a result. Fails where it cannot be written, a full disk for instance.
pub(super) fn result(line: impl Display) -> Result<(), Failure> {
    Ok(writeln!(
        std::io::stdout(),
        "{}",
        visible(&line.to_string())
    )?)
}

/// A whole text of slipmap's own on standard output: a result.
pub(super) fn text(text: &str) -> Result<(), Failure> {
    Ok(std::io::stdout().lock().write_all(text.as_bytes())?)
}

/// Lines of a name and a text on standard output, one below the other.
pub(super) struct Rows<'o>(StdoutLock<'o>);

impl Rows<'_> {
    /// Holds standard output: nothing else is written to it meanwhile.
    pub(super) fn begin() -> Self {
        Self(std::io::stdout().lock())
    }

    /// Tells one of them. Fails where it cannot be written.
    pub(super) fn row(&mut self, name: &str, text: impl AsRef<str>) -> Result<(), Failure> {
        let text = visible_line(text.as_ref());
        Ok(writeln!(self.0, "{name:<12} {text}")?)
    }
}

/// Whether the user asked for nothing on standard error but errors and warnings. It is set once,
/// before a command begins.
static QUIET: AtomicBool = AtomicBool::new(false);

/// From now on [`note`] says nothing where `quiet` is set.
pub(super) fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// Whether only errors and warnings are asked for.
pub(super) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// A line on standard error that `--quiet` leaves out: what is neither an error nor a warning.
pub(super) fn note(line: impl Display) {
    if !is_quiet() {
        remark(line);
    }
}

/// A line on standard error: an error, a warning, or what [`note`] lets through.
pub(super) fn remark(line: impl Display) {
    coloured(visible(&line.to_string()));
}

/// A line for people, of a text that holds no other control characters than slipmap's own.
pub(super) fn coloured(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{text}");
}
