//! Opens a map for a command that looks at it: the map itself, or what is computed of it so far.

use std::path::Path;

use slipmap::report::numbers::grouped;
use slipmap::store::assembly::{Missing, assemble};
use slipmap::store::tiles::{TileReader, shards};
use slipmap::store::{MapFile, Output, StoreError};
use slipmap::sweep::Pieces;

use super::failure::Failure;
use super::output::provenance;
use super::say;

/// The map at `path`. Where there is none yet, what its tiles hold, put together in a file of its own that is gone afterwards.
pub fn open(path: &Path) -> Result<MapFile, Failure> {
    let present = match path.exists() {
        true => Vec::new(),
        false => shards::present(path).unwrap_or_default(),
    };
    let Some((_, first)) = present.first() else {
        return Ok(MapFile::open(path)?);
    };
    let manifest = shards::manifest(first)?;
    let plan = manifest.read_plan().map_err(|error| StoreError::Manifest {
        path: first.clone(),
        why: error.message,
    })?;
    let mut source = Vec::new();
    for (_, folder) in &present {
        let layout = shards::manifest(folder)?.layout();
        source.push(TileReader::of(folder, layout, Pieces::of(&plan))?.0);
    }
    let file = path.with_file_name(format!(
        ".{}.slipmap-so-far",
        path.file_name().unwrap_or_default().display()
    ));
    let output = Output::claim(&file)?;
    let assembled = assemble(
        &plan,
        output,
        &provenance("merge", path),
        &mut source,
        Missing::Leave,
    )?;
    say::remark(format_args!(
        "{} is not complete: {} of {} cells are there",
        path.display(),
        grouped(plan.cells() - assembled.cells_missing),
        grouped(plan.cells()),
    ));
    let map = MapFile::open(&file);
    // The open file outlives its name.
    std::fs::remove_file(&file)?;
    Ok(map?)
}
