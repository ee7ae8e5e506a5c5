//! Whether a map is as it was written, and what other methods say of it.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use hdf5::Dataset;
use sha2::{Digest, Sha256};

use super::attributes::text;
use super::error::StoreError;
use super::map_file::MapFile;
use super::sample::sample;
use super::schema::{self, STATUS, root};
use super::seal::{self, Seal};
use super::tiles::RecordEncoder;
use super::tiles::record::Content;
use super::values::Chunks;
use crate::linear::status::{DISAGREE, FLAGS};
use crate::sweep::engine::{Computed, Encode, STATUS_FILL, Worker};
use crate::sweep::pieces::{Piece, spread};
use crate::sweep::plan::{Plan, in_hexadecimal};
use crate::sweep::second_look::{Answer, Question, Stored, second_look};
use crate::sweep::tile::index_of;
use crate::sweep::{Field, SweepSpec};

/// A child that is being started shares the library's lock on a file until it runs its own program: no longer than this.
const FORKED: Duration = Duration::from_secs(2);

/// What was found out about a map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Everything that is wrong, in words; empty for a sound map.
    pub faults: Vec<String>,
    /// What could not be checked, and why.
    pub remarks: Vec<String>,
    /// Checksums that fit: one of each dataset of cells, one of everything else.
    pub checksums: u64,
    /// Cells at which second methods looked.
    pub cells: u64,
    /// For each question: answers that agree, that differ, that stay open.
    pub answers: Vec<(Question, [u64; 3])>,
    /// Tiles that were computed again.
    pub tiles: u64,
    /// Those of them of which all bytes are equal.
    pub tiles_equal: u64,
}

/// How much of a map is computed again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Cells at which second methods look.
    pub cells: u64,
    /// Tiles that are computed again, bit by bit.
    pub tiles: u64,
}

/// Checks a map: its schema against its own sweep, its checksums, and samples of its cells; `program` is the version and revision
/// of the program that runs.
///
/// # Errors
/// When the map cannot be read at all.
pub fn check(map: &MapFile, program: (&str, &str), effort: Effort) -> Result<Report, StoreError> {
    let mut report = Report::default();
    let Some(plan) = planned(map, &mut report) else {
        return Ok(report);
    };
    check_seal(map, &mut report);
    check_schema(map, &plan, &mut report);
    check_checksums(map, &plan, &mut report, &AtomicBool::new(false));
    if map.is_partial() {
        let missing = map.cells_missing();
        report
            .remarks
            .push(format!("{missing} cells are not computed yet"));
    }
    // Values of a map whose bytes are wrong are not worth a look.
    if report.faults.is_empty() {
        check_statuses(map, &mut report)?;
        look_at_cells(map, &plan, effort.cells, &mut report)?;
        compute_tiles(map, &plan, program, effort.tiles, &mut report)?;
    }
    Ok(report)
}

/// Whether a file without a seal is the sound map of `plan`, whose cells need not all be there; else what is wrong first. Once
/// `stop` is set, no more is read, and the answer means nothing.
pub(super) fn as_written(path: &Path, plan: &Plan, stop: &AtomicBool) -> Result<(), String> {
    let map = opened(path).map_err(|error| error.to_string())?;
    let mut report = Report::default();
    check_schema(&map, plan, &mut report);
    check_checksums(&map, plan, &mut report, stop);
    match report.faults.into_iter().next() {
        None => Ok(()),
        Some(fault) => Err(fault),
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

fn planned(map: &MapFile, report: &mut Report) -> Option<Plan> {
    let sweep = map.root_text(root::SWEEP).unwrap_or_default();
    match sweep.parse::<SweepSpec>().and_then(Plan::new) {
        Ok(plan) if map.root_text(root::PLAN_HASH).as_deref() == Some(&plan.hash()) => Some(plan),
        Ok(_) => {
            let fault = "the sweep in the map does not have the hash of its plan";
            report.faults.push(fault.to_owned());
            None
        }
        Err(error) => {
            report.faults.push(format!(
                "the sweep in the map cannot be read: {}",
                error.message
            ));
            None
        }
    }
}

fn check_schema(map: &MapFile, plan: &Plan, report: &mut Report) {
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
    for (parameter, value) in map.scalars() {
        if value.to_bits() != plan.spec.fixed.get(parameter).to_bits() {
            faults.push(format!("{} is not that of the sweep", parameter.name()));
        }
    }
    for field in plan
        .spec
        .fields
        .iter()
        .filter(|f| !map.fields().contains(f))
    {
        faults.push(format!("the field {} is missing", field.name()));
    }
    for name in names(map) {
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
    if let Err(error) = map.for_each_curve(drop) {
        faults.push(error.to_string());
    }
}

/// Whether netCDF readers and xarray find the axes of a dataset.
fn has_dimensions(map: &MapFile, name: &str) -> bool {
    let list = map.dataset(name).ok();
    let list = list.and_then(|dataset| dataset.attr("DIMENSION_LIST").ok());
    list.is_some_and(|list| list.size() == map.axes().len())
}

/// The datasets of cells.
fn names(map: &MapFile) -> impl Iterator<Item = &'static str> {
    map.fields().iter().map(|f| f.name()).chain([STATUS])
}

fn check_seal(map: &MapFile, report: &mut Report) {
    match seal::check(map.path()) {
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

fn check_checksums(map: &MapFile, plan: &Plan, report: &mut Report, stop: &AtomicBool) {
    let mut without = 0;
    for name in names(map) {
        let Ok(dataset) = map.dataset(name) else {
            continue;
        };
        if dataset.chunk().as_deref() != Some(plan.tiles.tile_shape()) {
            let remark =
                format!("{name}: its chunks are not slipmap's, so its checksum says nothing");
            report.remarks.push(remark);
            continue;
        }
        let Ok(expected) = text(&dataset, schema::CHUNKS_SHA256) else {
            without += 1;
            continue;
        };
        match hash_of_chunks(&dataset, plan, stop) {
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
            let fault = "the checksum of what is no cell does not fit: an axis, a curve, a best setting or a description has changed";
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

fn hash_of_chunks(dataset: &Dataset, plan: &Plan, stop: &AtomicBool) -> hdf5::Result<String> {
    let chunks = Chunks::of(dataset)?.ok_or("it is not stored in chunks")?;
    let mut hash = Sha256::new();
    for number in 0..plan.tiles.len() {
        if stop.load(Ordering::Relaxed) {
            return Err("stopped".into());
        }
        // A chunk that is not there has not been computed.
        if let Some(chunk) = chunks.stored(&plan.tiles.tile(number).offset)? {
            hash.update(&chunk);
        }
    }
    Ok(in_hexadecimal(&hash.finalize()))
}

fn check_statuses(map: &MapFile, report: &mut Report) -> Result<(), StoreError> {
    let found = map.status_counts()?;
    let computed = map.cells() - map.cells_missing().min(map.cells());
    if found.computed != computed {
        let (cells, of) = (found.computed, computed);
        report
            .faults
            .push(format!("{cells} cells have a status, {of} should"));
    }
    for (count, (mask, name)) in found.flagged.iter().zip(FLAGS) {
        if mask == DISAGREE && *count > 0 {
            report.remarks.push(format!(
                "{count} cells say themselves that two methods {name}"
            ));
        }
    }
    Ok(())
}

fn look_at_cells(
    map: &MapFile,
    plan: &Plan,
    cells: u64,
    report: &mut Report,
) -> Result<(), StoreError> {
    for number in sample(map, plan, cells)? {
        let index = index_of(number, plan.shape());
        let status = map.cell_status(&index)?;
        if status == STATUS_FILL {
            continue;
        }
        let mut values = Vec::new();
        for &field in &plan.spec.fields {
            values.push((field, map.cell(field, &index)?));
        }
        let value = |field: Field| {
            let found = values.iter().find(|(f, _)| *f == field);
            found.map_or(f64::NAN, |(_, value)| *value)
        };
        let stored = Stored {
            status,
            value: &value,
        };
        match second_look(plan, &index, &stored) {
            Ok(answers) if answers.is_empty() => {
                let remark = "no second method looks at the fields of this map";
                report.remarks.push(remark.to_owned());
                break;
            }
            Ok(answers) => tally(plan, &index, &answers, report),
            Err(error) => report.remarks.push(format!("cell {index:?}: {error}")),
        }
    }
    Ok(())
}

fn tally(plan: &Plan, index: &[usize], answers: &[(Question, Answer)], report: &mut Report) {
    report.cells += 1;
    for &(question, answer) in answers {
        let place = report.answers.iter().position(|(q, _)| *q == question);
        let place = place.unwrap_or_else(|| {
            report.answers.push((question, [0; 3]));
            report.answers.len() - 1
        });
        report.answers[place].1[answer as usize] += 1;
        if answer == Answer::Differs {
            let axes = plan.spec.axes.iter().zip(index);
            let at: Vec<String> = axes
                .map(|(axis, &i)| format!("{} = {}", axis.parameter.name(), axis.values[i]))
                .collect();
            report
                .faults
                .push(format!("{} differs at {}", question.name(), at.join(", ")));
        }
    }
}

fn compute_tiles(
    map: &MapFile,
    plan: &Plan,
    (version, revision): (&str, &str),
    tiles: u64,
    report: &mut Report,
) -> Result<(), StoreError> {
    let by = |name, this| map.root_text(name).as_deref() == Some(this);
    if !by(root::PROGRAM_VERSION, version) || !by(root::GIT_REVISION, revision) {
        let remark = "no tiles are compared bit by bit: another revision of slipmap computed them";
        report.remarks.push(remark.to_owned());
        return Ok(());
    }
    let mut worker = Worker::new(plan);
    let mut encoder = RecordEncoder::default();
    for sample in 0..tiles.min(plan.tiles.len() as u64) {
        let number = (spread(sample) * plan.tiles.len() as f64) as usize;
        let tile = plan.tiles.tile(number);
        worker.compute(&tile);
        let piece = Piece::Tile(number as u64);
        let record = encoder.encode(piece, Computed::Tile(&worker.buffers));
        let Some(Content::Tile(chunks)) = Content::read(piece, &record.payload) else {
            continue;
        };
        let mut equal = true;
        let held = plan.spec.fields.iter().map(|f| f.name()).chain([STATUS]);
        for (name, chunk) in held.zip(chunks) {
            let dataset = map.dataset(name)?;
            let chunks = Chunks::of(&dataset).ok().flatten();
            match chunks.map(|chunks| chunks.stored(&tile.offset)) {
                Some(Ok(Some(stored))) if stored == chunk => {}
                // Of a map that is not complete.
                Some(Ok(None)) if map.is_partial() => equal = false,
                _ => {
                    equal = false;
                    report
                        .faults
                        .push(format!("{name}: tile {number} comes out differently"));
                }
            }
        }
        report.tiles += 1;
        report.tiles_equal += u64::from(equal);
    }
    Ok(())
}
