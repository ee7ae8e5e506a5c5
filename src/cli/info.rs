//! `slipmap info`: what a map holds.

use std::io::{IsTerminal, Write};
use std::path::PathBuf;

use slipmap::linear::curves::StableSide;
use slipmap::linear::status::FLAGS;
use slipmap::report::numbers::{bytes, grouped, short};
use slipmap::store::MapFile;
use slipmap::store::schema::root;
use slipmap::sweep::Field;

use super::failure::Failure;
use super::open::open;
use super::say::{visible, visible_line};
use super::signals::Signals;

/// What a signal leaves.
const NOT_TOLD: &str = "not everything is told";

#[derive(Debug, clap::Args)]
pub struct Args {
    /// The map
    #[arg(value_name = "MAP.h5")]
    map: PathBuf,
    /// Print the sweep file that made the map, and nothing else
    #[arg(long)]
    sweep: bool,
}

pub fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let map = open(&args.map, &signals, NOT_TOLD)?;
    signals.or_end(NOT_TOLD, || tell(&map, args))
}

fn tell(map: &MapFile, args: &Args) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    if args.sweep {
        let sweep = map.root_text(root::SWEEP).unwrap_or_default();
        // Elsewhere than on a terminal it is the file, byte by byte.
        match out.is_terminal() {
            true => write!(out, "{}", visible(&sweep))?,
            false => write!(out, "{sweep}")?,
        }
        return Ok(());
    }
    let mut row = |name: &str, text: String| writeln!(out, "{name:<12} {}", visible_line(&text));
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
            row(name, text)?;
        }
    }
    for axis in map.axes() {
        let (first, last) = (axis.values[0], axis.values[axis.values.len() - 1]);
        let (name, points) = (axis.parameter.name(), grouped(axis.values.len() as u64));
        row(
            "axis",
            format!("{name:<12} {points:>10} points, {first} to {last}"),
        )?;
    }
    for (parameter, value) in map.scalars() {
        row("fixed", format!("{:<12} {value}", parameter.name()))?;
    }
    row("cells", grouped(map.cells()))?;
    if map.is_partial() {
        row("missing", format!("{} cells", grouped(map.cells_missing())))?;
    }
    for (name, size, on_disk) in map.sizes()? {
        let values = match Field::from_name(name) {
            Some(field) => values(map, field)?,
            None => String::new(),
        };
        let sizes = format!("{}, {} on disk", bytes(size), bytes(on_disk));
        row("field", format!("{name:<22} {sizes}{values}"))?;
    }
    for ((_, name), count) in FLAGS.iter().zip(map.status_counts()?.flagged) {
        if count > 0 {
            row("status", format!("{name:<14} {} cells", grouped(count)))?;
        }
    }
    if map.boundary_plane().is_some() {
        let (mut crossing, mut bounding, mut decaying) = (0, 0, 0);
        map.for_each_curve(|curve| match curve.degree_of_stability {
            0.0 => {
                crossing += 1;
                bounding += u64::from(curve.piece.stable_side != StableSide::Neither);
            }
            _ => decaying += 1,
        })?;
        let of_crossing =
            format!("{crossing} crossing curves, {bounding} of them bound a stable region");
        row("boundaries", of_crossing)?;
        if decaying > 0 {
            row("", format!("{decaying} curves of degrees of stability"))?;
        }
    }
    let best = map.best()?;
    if let Some(fastest) = best
        .iter()
        .filter_map(|b| b.relaxation_time)
        .min_by(f64::total_cmp)
    {
        row(
            "best",
            format!(
                "settings of {} planes, the shortest relaxation time is {fastest:.4}",
                grouped(best.len() as u64)
            ),
        )?;
    } else if map.best_plane().is_some() {
        let planes = grouped(best.len() as u64);
        row(
            "best",
            format!("settings of {planes} planes, none of them stable"),
        )?;
    }
    Ok(())
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
