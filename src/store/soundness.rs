//! Checks that the file of a map is as it was written: its schema against its sweep, its checksums.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use hdf5::Dataset;
use sha2::{Digest, Sha256};

use super::attributes::text;
use super::error::StoreError;
use super::map_file::MapFile;
use super::seal::{self, Seal};
use super::values::Chunks;
use crate::sweep::cells::second_look::Question;
use crate::sweep::described::schema;
use crate::sweep::plan::Plan;
use crate::sweep::plan::tile::TileGrid;
use crate::text::in_hexadecimal;

/// The longest wait for the library's lock on a file. A child process that is being started shares
/// the lock until it runs its own program.
const FORKED: Duration = Duration::from_secs(2);

/// The result of checking a map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Everything that is wrong, in words; empty for a sound map.
    pub faults: Vec<String>,
    /// What could not be checked, and why.
    pub remarks: Vec<String>,
    /// Number of checksums that fit: one of each dataset of cells, one of everything else.
    pub checksums: u64,
    /// Number of cells checked by a second method.
    pub cells: u64,
    /// For each question: how many answers agree, differ, and stay open.
    pub answers: Vec<(Question, [u64; 3])>,
    /// Tiles that were computed again.
    pub tiles: u64,
    /// Tiles that were computed again with the same bytes.
    pub tiles_equal: u64,
    /// Tiles that were chosen for the check but are missing from a partial map.
    pub tiles_absent: u64,
}

/// Checks that a file without a seal is a sound map of `plan`, perhaps with cells missing; the
/// error is the first fault. Once `stop` is set, reading ends and the answer is meaningless.
pub(super) fn as_written(path: &Path, plan: &Plan, stop: &AtomicBool) -> Result<(), String> {
    let map = opened(path).map_err(|error| error.to_string())?;
    let mut report = Report::default();
    check_schema(&map, plan, &mut report, stop);
    check_checksums(&map, plan, &mut report, stop);
    // A remark on an old map is a fault of a new one.
    let wrong = report.faults.into_iter().chain(report.remarks).next();
    let all = map.names().count() as u64 + 1;
    match wrong {
        Some(fault) => Err(fault),
        None if report.checksums < all => Err("some of its checksums are missing".into()),
        None => Ok(()),
    }
}

/// Opens a map that this process has just closed.
fn opened(path: &Path) -> Result<MapFile, StoreError> {
    let begun = Instant::now();
    loop {
        match MapFile::open(path) {
            Err(StoreError::InUse { .. }) if begun.elapsed() < FORKED => {
                std::thread::sleep(Duration::from_millis(5));
            }
            opened => return opened,
        }
    }
}

/// Checks that the system and the parameters that are no axes are those of the sweep.
fn check_fixed(map: &MapFile, plan: &Plan, faults: &mut Vec<String>) {
    if map.system() != plan.spec.fixed.system() {
        faults.push("its system is not that of the sweep".into());
    }
    for (parameter, value) in map.scalars() {
        if value.to_bits() != plan.spec.fixed.value_of(&parameter).to_bits() {
            faults.push(format!("{} is not that of the sweep", parameter.name()));
        }
    }
}

/// Checks that axes, fields, dimensions and curves are those of `plan`. Once `stop` is set, the
/// check is incomplete.
pub(crate) fn check_schema(map: &MapFile, plan: &Plan, report: &mut Report, stop: &AtomicBool) {
    let faults = &mut report.faults;
    let axes = &plan.spec.axes;
    if map.axes().len() != axes.len() {
        faults.push(format!(
            "it has {} axes, its sweep {}",
            map.axes().len(),
            axes.len()
        ));
    }
    for (there, asked) in map.axes().iter().zip(axes) {
        let same = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
        };
        if there.parameter != asked.parameter || !same(&there.values, &asked.values) {
            faults.push(format!(
                "the axis {} is not that of the sweep",
                there.parameter.name()
            ));
        }
    }
    check_fixed(map, plan, faults);
    for field in plan
        .spec
        .fields
        .iter()
        .filter(|f| !map.fields().contains(f))
    {
        faults.push(format!("the field {} is missing", field.name()));
    }
    for name in map.names() {
        if stop.load(Ordering::Relaxed) {
            return;
        }
        match map
            .dataset(name)
            .map(|dataset| (dataset.chunk(), text(&dataset, "units")))
        {
            Ok((Some(_), Ok(_))) if !has_dimensions(map, name) => {
                faults.push(format!("{name} has lost its dimensions"));
            }
            Ok((Some(_), Ok(_))) => {}
            Ok((None, _)) => faults.push(format!("{name} is not stored in chunks")),
            Ok((_, Err(_))) => faults.push(format!("{name} has no units")),
            Err(error) => faults.push(error.to_string()),
        }
    }
    if stop.load(Ordering::Relaxed) {
        return;
    }
    let read = map.for_each_curve(|_| match stop.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    });
    if let Err(error) = read {
        faults.push(error.to_string());
    }
}

/// Whether netCDF readers and xarray find the axes of a dataset.
fn has_dimensions(map: &MapFile, name: &str) -> bool {
    let list = map.dataset(name).ok();
    let list = list.and_then(|dataset| dataset.attr("DIMENSION_LIST").ok());
    list.is_some_and(|list| list.size() == map.axes().len())
}

/// Checks all bytes against the seal. Once `stop` is set, the answer is meaningless.
pub(crate) fn check_seal(map: &MapFile, report: &mut Report, stop: &AtomicBool) {
    match seal::check(map.path(), stop) {
        Ok(Seal::Whole) => report.checksums += 1,
        Ok(Seal::Broken) => {
            let fault = "the checksum of all bytes does not fit: bytes have changed";
            report.faults.push(fault.to_owned());
        }
        Ok(Seal::Missing) if map.format_version() < schema::SEALED_SINCE => {}
        Ok(Seal::Missing) => {
            let fault =
                "the checksum of all bytes is missing: another program has written to the map";
            report.faults.push(fault.to_owned());
        }
        Err(error) => report.faults.push(format!("cannot be read: {error}")),
    }
}

pub(crate) fn check_checksums(map: &MapFile, plan: &Plan, report: &mut Report, stop: &AtomicBool) {
    let mut without = 0;
    for name in map.names() {
        if stop.load(Ordering::Relaxed) {
            return;
        }
        let Ok(dataset) = map.dataset(name) else {
            continue;
        };
        let chunk = dataset.chunk().unwrap_or_default();
        let Some(tiles) = plan.cut_into(&chunk) else {
            let remark =
                format!("{name}: its chunks are not slipmap's, so its checksum says nothing");
            report.remarks.push(remark);
            continue;
        };
        let Ok(expected) = text(&dataset, schema::CHUNKS_SHA256) else {
            without += 1;
            continue;
        };
        match hash_of_chunks(&dataset, &tiles, stop) {
            Ok(found) if found == expected => report.checksums += 1,
            Ok(_) => report.faults.push(format!(
                "{name}: its checksum does not fit: bytes have changed"
            )),
            Err(error) => report
                .faults
                .push(format!("{name}: chunks cannot be read: {error}")),
        }
    }
    match (
        map.root_text(schema::CONTENTS_SHA256),
        map.contents_hash(stop),
    ) {
        // An earlier version wrote no checksum at all.
        (None, Ok(_)) if report.checksums == 0 => {}
        (None, Ok(_)) => {
            let fault = "the checksum of what is no cell is missing";
            report.faults.push(fault.to_owned());
        }
        (Some(expected), Ok(found)) if found == expected => report.checksums += 1,
        (_, Ok(_)) => {
            let fault = "the checksum of what is no cell does not fit: an axis, a curve, a best \
                setting or a description has changed";
            report.faults.push(fault.to_owned());
        }
        (_, Err(error)) => report
            .faults
            .push(format!("not everything in it can be read: {error}")),
    }
    if without > 0 {
        let missing = format!("{without} datasets have no checksum");
        match report.checksums {
            0 => report
                .remarks
                .push(format!("{missing}: an earlier version wrote them")),
            _ => report.faults.push(missing),
        }
    }
}

fn hash_of_chunks(dataset: &Dataset, tiles: &TileGrid, stop: &AtomicBool) -> hdf5::Result<String> {
    let chunks = Chunks::of(dataset)?.ok_or("it is not stored in chunks")?;
    let mut hash = Sha256::new();
    for number in 0..tiles.len() {
        if stop.load(Ordering::Relaxed) {
            return Err("stopped".into());
        }
        // A missing chunk has not been computed.
        if let Some(chunk) = chunks.stored(&tiles.tile(number).offset)? {
            hash.update(&chunk);
        }
    }
    Ok(in_hexadecimal(&hash.finalize()))
}
