//! Output of text for other programs: to standard output, or to a file that is written completely
//! or not at all.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::atomic::AtomicBool;

use crate::report::table::TableError;
use crate::store::{Output, StoreError};

use super::failure::Failure;
use super::signals::Signals;

/// The name that stands for standard output.
pub(super) const STANDARD_OUTPUT: &str = "-";

/// The destination of a text.
#[derive(Debug, Clone, Copy)]
pub(super) enum To<'p> {
    /// Standard output, which then has nothing else.
    StandardOutput,
    /// A file.
    File(&'p Path),
}

impl<'p> To<'p> {
    /// The destination given by `--output`; standard output if there is none, or it is `-`. An
    /// existing file may be anybody's, so only `fresh` replaces it.
    ///
    /// # Errors
    /// When the extension is not that of CSV, the name is that of the file being `read`, or the
    /// file already exists.
    pub(super) fn named(
        output: Option<&'p Path>,
        read: Option<&Path>,
        fresh: bool,
    ) -> Result<Self, Failure> {
        let Some(path) = output.filter(|path| *path != Path::new(STANDARD_OUTPUT)) else {
            return Ok(Self::StandardOutput);
        };
        if !is_csv(path) {
            return Err(Failure::bad_input_with_help(
                format!("--output {}: a table is written as CSV", path.display()),
                "name it like NAME.csv; - is standard output",
            ));
        }
        let read = read.and_then(|read| read.canonicalize().ok());
        let same = path.canonicalize().ok().zip(read);
        if same.is_some_and(|(a, b)| a == b) {
            return Err(Failure::bad_input(format!(
                "--output {} would replace the file that is read",
                path.display()
            )));
        }
        if path.symlink_metadata().is_ok() && !fresh {
            return Err(Failure::bad_input_with_help(
                format!("{} is already there", path.display()),
                "--fresh replaces it; -o writes elsewhere",
            ));
        }
        Ok(Self::File(path))
    }

    /// Claims the file, before work whose result it is to hold.
    ///
    /// # Errors
    /// When no file can be written there.
    pub(super) fn claim(self) -> Result<Claimed, Failure> {
        Ok(match self {
            Self::StandardOutput => Claimed::StandardOutput,
            Self::File(path) => Claimed::File(Output::claim(path)?),
        })
    }

    /// Claims the file, and writes it as [`Claimed::write`] does.
    ///
    /// # Errors
    /// As both.
    pub(super) fn write<T: Send>(
        self,
        signals: &Signals,
        message: &str,
        write: impl FnOnce(&mut dyn Write, &AtomicBool) -> Result<T, TableError>,
    ) -> Result<T, Failure> {
        self.claim()?.write(signals, message, write)
    }
}

/// A destination that is this process's own.
#[derive(Debug)]
pub(super) enum Claimed {
    StandardOutput,
    File(Output),
}

impl Claimed {
    /// Writes the text made by `write`, which checks a stop flag from time to time. `message`: the
    /// message after a signal.
    ///
    /// # Errors
    /// Those of `write`. An existing file then stays as it was.
    pub(super) fn write<T: Send>(
        self,
        signals: &Signals,
        message: &str,
        write: impl FnOnce(&mut dyn Write, &AtomicBool) -> Result<T, TableError>,
    ) -> Result<T, Failure> {
        let output = match self {
            // A reader that stops reading blocks the writing; a signal still ends it.
            Self::StandardOutput => {
                let mut out = std::io::stdout().lock();
                let never = AtomicBool::new(false);
                let written = signals.or_end(message, || write(&mut out, &never));
                return written.map_err(|error| match error {
                    TableError::Write(error) => error.into(),
                    other => failure(other, Path::new(STANDARD_OUTPUT), signals, message),
                });
            }
            Self::File(output) => output,
        };
        let written = || -> Result<T, TableError> {
            let mut out = BufWriter::new(File::create_new(output.part())?);
            let written = write(&mut out, &signals.stop)?;
            out.flush()?;
            Ok(written)
        };
        let written = written().map_err(|error| failure(error, output.path(), signals, message))?;
        output.commit()?;
        Ok(written)
    }
}

/// Whether a file has the extension of a table as text.
pub(super) fn is_csv(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("csv"))
}

fn failure(error: TableError, path: &Path, signals: &Signals, message: &str) -> Failure {
    match error {
        TableError::Stopped => signals.interrupted(message),
        TableError::Store(error) => error.into(),
        TableError::Write(source) => {
            let (action, path) = ("write", path.to_owned());
            StoreError::Io {
                action,
                path,
                source,
            }
            .into()
        }
    }
}
