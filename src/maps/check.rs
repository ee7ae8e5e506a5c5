//! Checks whether a map is as it was written, and what other methods give for samples of its cells.

use crate::linear::status::{DISAGREE, FLAGS};
use crate::model::stop::Stop;
use crate::setting::Field;
use crate::store::sample::sample;
use crate::store::soundness::{check_checksums, check_schema, check_seal};
use crate::store::tiles::RecordEncoder;
use crate::store::tiles::record::Content;
use crate::store::{MapFile, StoreError};
use crate::sweep::cells::second_look::{Answer, Question, Stored, second_look};
use crate::sweep::described::schema::{STATUS, root};
use crate::sweep::engine::{Computed, Encode, STATUS_FILL, Worker};
use crate::sweep::plan::Plan;
use crate::sweep::plan::pieces::{Piece, spread};
use crate::sweep::plan::tile::index_of;
use std::sync::atomic::AtomicBool;

pub use crate::store::soundness::Report;

/// How much of a map is computed again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Number of cells checked by a second method.
    pub cells: u64,
    /// Number of tiles that are computed again and compared bit by bit.
    pub tiles: u64,
}

/// The running program.
#[derive(Debug, Clone, Copy)]
pub struct Program<'a> {
    /// Its version.
    pub version: &'a str,
    /// Its git revision.
    pub revision: &'a str,
}

/// Checks a map: its schema against its own sweep, its checksums, and samples of its cells.
///
/// # Errors
/// When the map cannot be read at all.
pub fn check(map: &MapFile, program: Program, effort: Effort) -> Result<Report, StoreError> {
    let mut report = Report::default();
    let Some(plan) = planned(map, &mut report) else {
        return Ok(report);
    };
    let never = AtomicBool::new(false);
    check_seal(map, &mut report, &never);
    check_schema(map, &plan, &mut report, &never);
    check_checksums(map, &plan, &mut report, &never);
    if map.is_partial() {
        let missing = map.cells_missing();
        report
            .remarks
            .push(format!("{missing} cells are not computed yet"));
    }
    // If its bytes are wrong, there is no point in checking the values of a map.
    if report.faults.is_empty() {
        check_statuses(map, &mut report)?;
        check_summaries(map, &mut report)?;
        look_at_cells(map, &plan, effort.cells, &mut report)?;
        compute_tiles(map, &plan, program, effort.tiles, &mut report);
    }
    Ok(report)
}

fn planned(map: &MapFile, report: &mut Report) -> Option<Plan> {
    match map.sweep().and_then(Plan::new) {
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

fn check_statuses(map: &MapFile, report: &mut Report) -> Result<(), StoreError> {
    let found = map.statuses_of_cells()?;
    if found != map.status_counts()? {
        report.faults.push(told_wrongly(STATUS));
    }
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

/// Checks the summaries of the map's fields against their cells.
fn check_summaries(map: &MapFile, report: &mut Report) -> Result<(), StoreError> {
    for &field in map.fields() {
        if map.summary_of_cells(field)? != map.summary(field)? {
            report.faults.push(told_wrongly(map.name_of(field)));
        }
    }
    Ok(())
}

fn told_wrongly(name: &str) -> String {
    format!("{name}: the range or the numbers of cells that the map tells are not those it has")
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

fn compute_tiles(map: &MapFile, plan: &Plan, program: Program, tiles: u64, report: &mut Report) {
    let by = |name, this| map.root_text(name).as_deref() == Some(this);
    if !by(root::PROGRAM_VERSION, program.version) || !by(root::GIT_REVISION, program.revision) {
        let remark = "no tiles are compared bit by bit: another revision of slipmap computed them";
        report.remarks.push(remark.to_owned());
        return;
    }
    let mut worker = Worker::new(plan);
    let mut encoder = RecordEncoder::default();
    for sample in 0..tiles.min(plan.tiles.len() as u64) {
        let number = (spread(sample) * plan.tiles.len() as f64) as usize;
        let tile = plan.tiles.tile(number);
        // In a partial map the status shows whether it has the tile.
        if map.is_partial() && matches!(map.stored_chunk(STATUS, &tile.offset), Ok(None)) {
            report.tiles_absent += 1;
            continue;
        }
        worker.compute(&tile, &Stop::default());
        let piece = Piece::Tile(number as u64);
        let record = encoder.encode(piece, Computed::Tile(&worker.buffers));
        let Some(Content::Tile(computed)) = Content::read(piece, &record.payload) else {
            continue;
        };
        let mut equal = true;
        let held = plan
            .spec
            .fields
            .iter()
            .map(|&f| map.name_of(f))
            .chain([STATUS]);
        for (name, chunk) in held.zip(computed.chunks) {
            match map.stored_chunk(name, &tile.offset) {
                Ok(Some(stored)) if stored == chunk => {}
                Err(error) => {
                    equal = false;
                    let fault = format!("{name}: tile {number} cannot be read: {error}");
                    report.faults.push(fault);
                }
                Ok(_) => {
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
}
