//! Opens a map for a command that reads it: the complete map, or the part computed so far.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use crate::maps::assembly::{Missing, assemble};
use crate::report::numbers::grouped;
use crate::setting::{Field, Parameter};
use crate::store::output::hidden_beside;
use crate::store::tiles::{TileReader, shards};
use crate::store::{MapFile, Output};
use crate::text::nearest::did_you_mean;

use super::failure::Failure;
use super::output::provenance;
use super::say;
use super::signals::Signals;

/// Opens the map at `path`. If it does not exist yet, a map is assembled from its tiles, in a
/// temporary file that is removed at once.
///
/// A signal ends it, with `message`.
pub(super) fn open(path: &Path, signals: &Signals, message: &str) -> Result<MapFile, Failure> {
    let opened = || signals.or_end(message, || MapFile::open(path));
    let held = path.exists().then(opened).transpose()?;
    let present = match held.as_ref().is_none_or(MapFile::is_partial) {
        true => shards::begun(path).unwrap_or_default(),
        false => Vec::new(),
    };
    if present.is_empty() {
        let map = held.map_or_else(opened, Ok)?;
        if map.is_partial() {
            tell_partial(path, map.cells_missing(), map.cells());
        }
        return Ok(map);
    }
    let folders: Vec<PathBuf> = present.into_iter().map(|(_, folder)| folder).collect();
    let so_far = so_far(path, &folders, &signals.stop);
    so_far.map_err(|failure| signals.or_stopped(failure, message))
}

/// The field of a map with this name.
pub(super) fn held_field(map: &MapFile, name: &str) -> Result<Field, Failure> {
    let field = Field::from_name(name).filter(|field| map.fields().contains(field));
    field.ok_or_else(|| {
        let held: Vec<&str> = map.fields().iter().map(|field| field.name()).collect();
        let meant = match (Field::from_name(name), Parameter::from_name(name)) {
            (Some(_), _) => String::new(),
            (None, Some(_)) => format!("{name} is a parameter, not a field; "),
            (None, None) => did_you_mean(name, held.iter().copied()),
        };
        Failure::bad_input_with_help(
            format!("--field: the map does not hold {name}"),
            format!("{meant}it holds {}", held.join(", ")),
        )
    })
}

/// A map of what the folders of shards contain.
fn so_far(path: &Path, folders: &[PathBuf], stop: &AtomicBool) -> Result<MapFile, Failure> {
    let (manifest, plan) = shards::plan(folders)?;
    let mut source = Vec::new();
    for folder in folders {
        source.push(TileReader::of(folder, manifest.layout(), plan.pieces(), stop)?.0);
    }
    let file = hidden_beside(path, "so-far");
    let output = Output::claim(&file)?;
    let (provenance, missing) = (provenance("merge", path), Missing::Leave);
    let assembled = assemble(&plan, output, &provenance, &mut source, missing, stop)?;
    tell_partial(path, assembled.cells_missing, plan.cells());
    let map = MapFile::open(&file);
    // The file stays open after its name is removed.
    std::fs::remove_file(&file)?;
    // A picture of it is one of the map that it becomes, and makes way for that one's.
    Ok(map?.known_as(path))
}

/// Reports how much of a map is computed.
pub(super) fn tell_partial(path: &Path, missing: u64, cells: u64) {
    let (path, done, cells) = (
        path.display(),
        grouped(cells - missing.min(cells)),
        grouped(cells),
    );
    say::remark(format_args!(
        "{path} is not complete: {done} of {cells} cells are there"
    ));
}
