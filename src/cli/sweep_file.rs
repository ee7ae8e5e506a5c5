//! Reading a sweep file into a plan, with errors that point into it.

use std::path::Path;

use slipmap::sweep::{Plan, SweepSpec};

use super::failure::Failure;

/// A sweep file larger than this is none.
const MOST_BYTES: u64 = 64 << 20;

/// The plan of the sweep file at `path`.
pub fn read_plan(path: &Path) -> Result<Plan, Failure> {
    let name = path.display().to_string();
    let refuse = |why: String| Failure::bad_input(format!("cannot read {name}: {why}"));
    let metadata = std::fs::metadata(path).map_err(|e| refuse(e.to_string()))?;
    if !metadata.is_file() {
        return Err(refuse("it is no file".into()));
    }
    if metadata.len() > MOST_BYTES {
        return Err(refuse("it is too large for a sweep file".into()));
    }
    let bytes = std::fs::read(path).map_err(|e| refuse(e.to_string()))?;
    let text = String::from_utf8(bytes).map_err(|_| refuse("it is not UTF-8 text".into()))?;
    text.parse::<SweepSpec>()
        .and_then(Plan::new)
        .map_err(|error| Failure::in_file(error, &name, text))
}
