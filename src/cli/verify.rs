//! `slipmap verify`: whether a map is as it was written, and what other methods say of a sample of
//! its cells.

use std::path::PathBuf;

use serde_json::{Value, json};
use slipmap::maps::check::{Effort, Program, Report, check};
use slipmap::report::numbers::grouped;
use slipmap::store::MapFile;

use super::failure::Failure;
use super::say::{self, Rows};

/// More cells or tiles than this are not computed again.
const MOST: u64 = 100_000_000;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The map
    #[arg(value_name = "MAP.h5")]
    map: PathBuf,
    /// Cells at which second methods look, spread over the map
    #[arg(long, value_name = "N", default_value_t = 100,
          value_parser = clap::value_parser!(u64).range(..=MOST))]
    cells: u64,
    /// Tiles that are computed again, to be equal bit by bit
    #[arg(long, value_name = "N", default_value_t = 2,
          value_parser = clap::value_parser!(u64).range(..=MOST))]
    tiles: u64,
    /// Print one JSON object instead
    #[arg(long)]
    json: bool,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let map = MapFile::open(&args.map)?;
    let effort = Effort {
        cells: args.cells,
        tiles: args.tiles,
    };
    let program = Program {
        version: env!("CARGO_PKG_VERSION"),
        revision: env!("SLIPMAP_GIT_REVISION"),
    };
    let report = check(&map, program, effort)?;
    let told = match args.json {
        true => say::json(&to_json(&report)),
        false => print(&report),
    };
    // Whether anybody reads on does not change what was found.
    match report.faults.len() {
        0 => told,
        1 => Err(Failure::failed(format!("{}: 1 fault", args.map.display()))),
        n => Err(Failure::failed(format!(
            "{}: {n} faults",
            args.map.display()
        ))),
    }
}

fn to_json(report: &Report) -> Value {
    let answers: Vec<Value> = report
        .answers
        .iter()
        .map(|(question, [agree, differ, open])| {
            json!({"question": question.name(), "agree": agree, "differ": differ, "open": open})
        })
        .collect();
    json!({
        "sound": report.faults.is_empty(), "faults": report.faults, "remarks": report.remarks,
        "checksums": report.checksums, "cells": report.cells, "answers": answers,
        "tiles": report.tiles, "tiles_equal": report.tiles_equal,
    })
}

fn print(report: &Report) -> Result<(), Failure> {
    let mut rows = Rows::begin();
    let checksums = report.checksums;
    rows.row("checksums", format!("{checksums} fit"))?;
    if report.cells > 0 {
        let cells = grouped(report.cells);
        rows.row("cells", format!("{cells} looked at by second methods"))?;
    }
    for (question, [agree, differ, open]) in &report.answers {
        let counts = format!("{agree} agree, {differ} differ, {open} open");
        rows.row("", format!("{:<38} {counts}", question.name()))?;
    }
    if report.tiles > 0 {
        let (equal, of) = (report.tiles_equal, report.tiles);
        rows.row(
            "tiles",
            format!("{equal} of {of} computed again are the same, bit by bit"),
        )?;
    }
    for remark in &report.remarks {
        rows.row("remark", remark)?;
    }
    for fault in &report.faults {
        rows.row("fault", fault)?;
    }
    Ok(())
}
