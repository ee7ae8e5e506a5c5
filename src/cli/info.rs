//! `slipmap info`: what a map holds.

use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::path::PathBuf;

use slipmap::linear::curves::StableSide;
use slipmap::linear::status::FLAGS;
use slipmap::report::numbers::{bytes, grouped, short};
use slipmap::store::MapFile;
use slipmap::store::schema::root;
use slipmap::sweep::Field;

use super::failure::Failure;
use super::open::open;
use super::say::{Rows, visible};
use super::signals::Signals;

/// What a signal leaves.
const NOT_TOLD: &str = "not everything is told";

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The map
    #[arg(value_name = "MAP.h5")]
    map: PathBuf,
    /// Print the sweep file that made the map, and nothing else
    #[arg(long)]
    sweep: bool,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let map = open(&args.map, &signals, NOT_TOLD)?;
    signals.or_end(NOT_TOLD, || tell(&map, args))
}

fn tell(map: &MapFile, args: &Args) -> Result<(), Failure> {
    if args.sweep {
        return tell_sweep(map);
    }
    let mut rows = Rows::begin();
    tell_origin(map, &mut rows)?;
    tell_parameters(map, &mut rows)?;
    tell_cells(map, &mut rows)?;
    tell_curves(map, &mut rows)?;
    tell_best(map, &mut rows)
}

fn tell_sweep(map: &MapFile) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let sweep = map.root_text(root::SWEEP).unwrap_or_default();
    // Elsewhere than on a terminal it is the file, byte by byte.
    match out.is_terminal() {
        true => write!(out, "{}", visible(&sweep))?,
        false => write!(out, "{sweep}")?,
    }
    Ok(())
}

fn tell_origin(map: &MapFile, rows: &mut Rows) -> Result<(), Failure> {
    for (name, attribute) in [
        ("title", root::TITLE),
        ("made by", root::SOURCE),
        ("revision", root::GIT_REVISION),
        ("history", root::HISTORY),
        ("plan", root::PLAN_HASH),
        ("protocol", root::PROTOCOL),
        ("friction", root::FRICTION_LAW),
    ] {
        if let Some(text) = map.root_text(attribute).filter(|t| !t.is_empty()) {
            rows.row(name, text)?;
        }
    }
    Ok(())
}

fn tell_parameters(map: &MapFile, rows: &mut Rows) -> Result<(), Failure> {
    for axis in map.axes() {
        let (first, last) = (axis.values[0], axis.values[axis.values.len() - 1]);
        let (name, points) = (axis.parameter.name(), grouped(axis.values.len() as u64));
        let text = format!("{name:<12} {points:>10} points, {first} to {last}");
        rows.row("axis", text)?;
    }
    for (parameter, value) in map.scalars() {
        rows.row("fixed", format!("{:<12} {value}", parameter.name()))?;
    }
    Ok(())
}

fn tell_cells(map: &MapFile, rows: &mut Rows) -> Result<(), Failure> {
    rows.row("cells", grouped(map.cells()))?;
    if map.is_partial() {
        rows.row("missing", format!("{} cells", grouped(map.cells_missing())))?;
    }
    for (name, size, on_disk) in map.sizes()? {
        let values = match Field::from_name(name) {
            Some(field) => values(map, field)?,
            None => String::new(),
        };
        let sizes = format!("{}, {} on disk", bytes(size), bytes(on_disk));
        rows.row("field", format!("{name:<22} {sizes}{values}"))?;
    }
    for ((_, name), count) in FLAGS.iter().zip(map.status_counts()?.flagged) {
        if count > 0 {
            rows.row("status", format!("{name:<14} {} cells", grouped(count)))?;
        }
    }
    Ok(())
}

fn tell_curves(map: &MapFile, rows: &mut Rows) -> Result<(), Failure> {
    if map.boundary_plane().is_none() {
        return Ok(());
    }
    let (mut crossing, mut bounding, mut decaying) = (0, 0, 0);
    map.for_each_curve(|curve| {
        match curve.degree_of_stability {
            0.0 => {
                crossing += 1;
                bounding += u64::from(curve.piece.stable_side != StableSide::Neither);
            }
            _ => decaying += 1,
        }
        ControlFlow::Continue(())
    })?;
    let text = format!("{crossing} crossing curves, {bounding} of them bound a stable region");
    rows.row("boundaries", text)?;
    if decaying > 0 {
        rows.row("", format!("{decaying} curves of degrees of stability"))?;
    }
    Ok(())
}

fn tell_best(map: &MapFile, rows: &mut Rows) -> Result<(), Failure> {
    if map.best_plane().is_none() {
        return Ok(());
    }
    let best = map.best()?;
    let times = best.iter().filter_map(|b| b.relaxation_time);
    let fastest = match times.min_by(f64::total_cmp) {
        Some(fastest) => format!("the shortest relaxation time is {fastest:.4}"),
        None => "none of them stable".to_owned(),
    };
    let planes = grouped(best.len() as u64);
    rows.row("best", format!("settings of {planes} planes, {fastest}"))
}

/// ", −0.3 to 1.2, 12 infinite, 3 without a value", or ", 12 sliding, 3 lift-off".
fn values(map: &MapFile, field: Field) -> Result<String, Failure> {
    let mut text = String::new();
    if let Some(kinds) = field.kinds() {
        let counts = kinds.into_iter().zip(map.kind_counts(field)?);
        for (kind, cells) in counts.filter(|(_, cells)| *cells > 0) {
            text += &format!(", {} {kind}", grouped(cells));
        }
        return Ok(text);
    }
    let summary = map.summary(field)?;
    if let Some((low, high)) = summary.range {
        text += &format!(", {} to {}", short(low), short(high));
    }
    for (cells, what) in [
        (summary.infinite, "infinite"),
        (summary.missing, "without a value"),
    ] {
        if cells > 0 {
            text += &format!(", {} {what}", grouped(cells));
        }
    }
    Ok(text)
}
