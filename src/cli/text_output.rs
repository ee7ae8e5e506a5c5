//! Where text for other programs goes: standard output, or a file that is there whole or not at
//! all.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipmap::report::table::TableError;
use slipmap::store::{Output, StoreError};

use super::failure::Failure;
use super::signals::Signals;

/// What stands for standard output in the place of a file.
pub(super) const STANDARD_OUTPUT: &str = "-";

/// Where a text goes.
#[derive(Debug, Clone, Copy)]
pub(super) enum To<'p> {
    /// Standard output, on which nothing else is told then.
    StandardOutput,
    /// A file.
    File(&'p Path),
}

impl<'p> To<'p> {
    /// Where `--output` says; without it, or where that is `-`: standard output. What is at that
    /// name already may be anybody's: only `fresh` replaces it.
    ///
    /// # Errors
    /// When the name promises another format than CSV, is that of the file that is `read`, or
    /// there is a file already.
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

    /// Writes the text that `write` makes, which looks at a flag now and then whether to stop.
    /// `message`: what a signal leaves.
    ///
    /// # Errors
    /// Those of `write`. A file is then as it was before.
    pub(super) fn write<T: Send>(
        self,
        signals: &Signals,
        message: &str,
        write: impl FnOnce(&mut dyn Write, &AtomicBool) -> Result<T, TableError>,
    ) -> Result<T, Failure> {
        let path = match self {
            // A reader that reads no further holds the writing up: a signal ends it all the same.
            Self::StandardOutput => {
                let mut out = std::io::stdout().lock();
                let never = AtomicBool::new(false);
                let written = signals.or_end(message, || write(&mut out, &never));
                return written.map_err(|error| match error {
                    TableError::Write(error) => error.into(),
                    other => failure(other, Path::new(STANDARD_OUTPUT), signals, message),
                });
            }
            Self::File(path) => path,
        };
        let output = Output::claim(path)?;
        let written = || -> Result<T, TableError> {
            let mut out = BufWriter::new(File::create_new(output.part())?);
            let written = write(&mut out, &signals.stop)?;
            out.flush()?;
            Ok(written)
        };
        let written = written().map_err(|error| failure(error, path, signals, message))?;
        output.commit()?;
        Ok(written)
    }
}

/// Whether a file has the name of a table as text.
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
