//! Reading sweep and case files, with errors that point into them.

use std::path::Path;

use slipmap::sweep::{CaseSpec, Plan, SpecError, SweepSpec};

use super::failure::Failure;

/// A file larger than this is no sweep and no case.
const MOST_BYTES: u64 = 64 << 20;

/// The plan of the sweep file at `path`.
pub fn read_plan(path: &Path) -> Result<Plan, Failure> {
    read(path, "sweep", |text| {
        text.parse::<SweepSpec>().and_then(Plan::new)
    })
}

/// The case of the case file at `path`.
pub fn read_case(path: &Path) -> Result<CaseSpec, Failure> {
    read(path, "case", str::parse)
}

fn read<T>(
    path: &Path,
    kind: &str,
    parse: impl FnOnce(&str) -> Result<T, SpecError>,
) -> Result<T, Failure> {
    let name = path.display().to_string();
    let refuse = |why: String| Failure::bad_input(format!("cannot read {name}: {why}"));
    let metadata = std::fs::metadata(path).map_err(|e| refuse(e.to_string()))?;
    if !metadata.is_file() {
        return Err(refuse("it is no file".into()));
    }
    if metadata.len() > MOST_BYTES {
        return Err(refuse(format!("it is too large for a {kind} file")));
    }
    let bytes = std::fs::read(path).map_err(|e| refuse(e.to_string()))?;
    let text = String::from_utf8(bytes).map_err(|_| refuse("it is not UTF-8 text".into()))?;
    parse(&text).map_err(|error| Failure::in_file(error, &name, text))
}
