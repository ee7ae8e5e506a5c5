//! The kind of a file of slipmap. A command that does not take this kind names the commands that
//! do.

use std::path::Path;

use crate::setting::case_file::{TextKind, kind_of_text};
use crate::store::{MapFile, regular, trace_reader};

/// The first bytes of an HDF5 file.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Approximate size beyond which a text is not one of slipmap's.
const MOST_BYTES: u64 = 1 << 20;

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Map,
    Trace,
    Text(TextKind),
}

impl Kind {
    /// The kind of the file at `path`; none for files that are not slipmap's.
    pub(super) fn of(path: &Path) -> Option<Self> {
        let bytes = regular::head(path, MOST_BYTES).ok()?;
        if bytes.starts_with(HDF5) {
            return match trace_reader::is_trace(path) {
                true => Some(Self::Trace),
                false => MapFile::open(path).is_ok().then_some(Self::Map),
            };
        }
        kind_of_text(std::str::from_utf8(&bytes).ok()?).map(Self::Text)
    }

    /// A message that the file at `path` has this kind and not the `wanted` one, and which commands
    /// take it.
    pub(super) fn not(self, path: &Path, wanted: &str) -> (String, String) {
        let path = path.display();
        let (name, takers) = match self {
            Self::Map => (
                "a map",
                "`slipmap info`, `plot`, `export`, `verify` and `status` take it; `point`, \
                 `margins`, `vc`, `basin` and `simulate` take a cell of it, by --map MAP.h5 --at \
                 AXIS=VALUE",
            ),
            Self::Trace => (
                "the trace of one motion",
                "`slipmap info`, `plot`, `export` and `verify` take it",
            ),
            Self::Text(TextKind::Sweep) => ("a sweep file", "`slipmap plan` and `run` take it"),
            Self::Text(TextKind::Case) => ("a case file", "`slipmap plan` and `simulate` take it"),
            Self::Text(TextKind::Experiment) => ("an experiment", "`slipmap measure` takes it"),
            Self::Text(TextKind::Setting) => (
                "a file of a setting",
                "`slipmap point` and `margins` take it with --setting; with a friction law `vc`, \
                 `basin` and `simulate` do",
            ),
            Self::Text(TextKind::System) => (
                "a system file",
                "`slipmap point` and `best` take it with --system; a sweep file names it: \
                 system = \"FILE\"",
            ),
        };
        (format!("{path} is {name}, not {wanted}"), takers.to_owned())
    }
}
