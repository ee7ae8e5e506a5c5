//! Messages to the user. A closed stream, or a reader that has gone (`slipmap … | head`), is no
//! reason to fail or to panic.

use std::fmt::Display;
use std::io::{StdoutLock, Write};
use std::sync::atomic::{AtomicBool, Ordering};

pub(super) use crate::report::visible::{shortened, visible, visible_line};

use super::failure::Failure;

/// Prints a result as a line on standard output. Fails if it cannot be written, as on a full disk.
pub(super) fn result(line: impl Display) -> Result<(), Failure> {
    Ok(writeln!(
        std::io::stdout(),
        "{}",
        visible(&line.to_string())
    )?)
}

/// Prints a result as a whole text, made by slipmap, on standard output.
pub(super) fn text(text: &str) -> Result<(), Failure> {
    Ok(std::io::stdout().lock().write_all(text.as_bytes())?)
}

/// Standard output for people. What would move the cursor or turn the direction of writing is
/// spelled out, whatever texts from files are printed.
pub(super) struct ForPeople<'o>(StdoutLock<'o>);

impl ForPeople<'_> {
    /// Locks standard output: nothing else is written to it meanwhile.
    pub(super) fn begin() -> Self {
        Self(std::io::stdout().lock())
    }
}

impl Write for ForPeople<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        // Formatting writes whole characters.
        let text = String::from_utf8_lossy(bytes);
        self.0.write_all(visible(&text).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.0.flush()
    }
}

/// Rows of a name and a text on standard output.
pub(super) struct Rows<'o>(StdoutLock<'o>);

impl Rows<'_> {
    /// Locks standard output: nothing else is written to it meanwhile.
    pub(super) fn begin() -> Self {
        Self(std::io::stdout().lock())
    }

    /// Prints a row. Fails if it cannot be written.
    pub(super) fn row(&mut self, name: &str, text: impl AsRef<str>) -> Result<(), Failure> {
        let text = visible_line(text.as_ref());
        Ok(writeln!(self.0, "{name:<12} {text}")?)
    }
}

/// Whether only errors and warnings go to standard error. It is set once, before a command begins.
static QUIET: AtomicBool = AtomicBool::new(false);

/// If `quiet`, [`note`] prints nothing from now on.
pub(super) fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// Whether only errors and warnings go to standard error.
pub(super) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Prints a line on standard error, unless `--quiet`: anything but errors and warnings.
pub(super) fn note(line: impl Display) {
    if !is_quiet() {
        remark(line);
    }
}

/// Prints a line on standard error: an error, a warning, or a line of [`note`].
pub(super) fn remark(line: impl Display) {
    coloured(visible(&line.to_string()));
}

/// Prints a line for people, of a text without control characters other than slipmap's own.
pub(super) fn coloured(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{text}");
}
