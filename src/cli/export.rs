//! `slipmap export`: the contents of a map or a trace, as text.

use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use crate::report::numbers::grouped;
use crate::report::table::{TableError, write_cells, write_curves, write_events, write_samples};
use crate::setting::Field;
use crate::store::{MapFile, TraceFile, trace_reader};
use crate::sweep::described::trace::{QUANTITIES, Quantity};
use crate::text::nearest::did_you_mean;
use clap::ValueEnum;

use super::at::{At, Axes, parse_at};
use super::failure::Failure;
use super::open::{held_field, open};
use super::say;
use super::signals::Signals;
use super::text_output::To;

/// The message after a signal.
const NOT_EXPORTED: &str = "not everything is exported";

#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  slipmap export map.h5 --field abscissa --at mu_prime=-0.3 -o slice.csv
  slipmap export map.h5 --table boundaries | head
  slipmap export trace.h5 --table events")]
pub(super) struct Args {
    /// The map, or the trace of a motion
    #[arg(value_name = "FILE.h5")]
    file: PathBuf,
    /// The text to write, .csv; - for standard output [default: standard output]
    #[arg(short, long, value_name = "TABLE.csv")]
    output: Option<PathBuf>,
    /// Replace a file that is already there
    #[arg(long)]
    fresh: bool,
    /// Which table [default: the cells of a map, the samples of a trace]
    #[arg(long)]
    table: Option<TableName>,
    /// A field of the map, or a quantity of the trace; again for more [default: all]
    #[arg(long, value_name = "NAME")]
    field: Vec<String>,
    /// Hold an axis of the map at the value nearest to this; again for other axes
    #[arg(long, value_name = "AXIS=VALUE", value_parser = parse_at)]
    at: Vec<At>,
    /// Begin with lines of # that give title, parameters, units and meaning of the columns
    #[arg(long)]
    comments: bool,
}

/// Tables by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TableName {
    /// Of a map: a row for each cell
    Cells,
    /// Of a map: its crossing curves, a row for each vertex
    Boundaries,
    /// Of a trace: a row for each sample
    Samples,
    /// Of a trace: a row for each event
    Events,
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let to = To::named(args.output.as_deref(), Some(&args.file), args.fresh)?;
    let rows = match trace_reader::is_trace(&args.file) {
        true => of_trace(args, to, &signals)?,
        false => of_map(args, to, &signals)?,
    };
    match to {
        To::StandardOutput => Ok(()),
        To::File(path) => {
            let (path, rows) = (path.display(), grouped(rows));
            say::result(format_args!("{path}: {rows} rows"))
        }
    }
}

fn of_map(args: &Args, to: To, signals: &Signals) -> Result<u64, Failure> {
    let table = args.table.unwrap_or(TableName::Cells);
    if !matches!(table, TableName::Cells | TableName::Boundaries) {
        return Err(other_table(
            table,
            "a map",
            [TableName::Cells, TableName::Boundaries],
        ));
    }
    let map = open(&args.file, signals, NOT_EXPORTED)?;
    let held = Axes::from(&map).held(&args.at)?;
    if table == TableName::Cells {
        let fields = fields(&map, args)?;
        return to.write(signals, NOT_EXPORTED, |out, stop| {
            write_cells(&map, &fields, &held, args.comments, out, stop)
        });
    }
    refuse_fields(args, table)?;
    let Some((p, tau)) = map.boundary_plane() else {
        return Err(Failure::bad_input_with_help(
            "this map holds no crossing curves",
            "boundaries = true in a sweep file traces them",
        ));
    };
    if let Some(axis) = [p, tau].into_iter().find(|&axis| held[axis].is_some()) {
        let name = map.axes()[axis].parameter.name();
        return Err(Failure::bad_input_with_help(
            format!("--at: the curves go along {name}"),
            "an axis outside their planes can be held",
        ));
    }
    let rows = to.write(signals, NOT_EXPORTED, |out, stop| {
        write_curves(&map, &held, args.comments, out, stop)
    })?;
    Ok(rows.unwrap_or(0))
}

fn of_trace(args: &Args, to: To, signals: &Signals) -> Result<u64, Failure> {
    let table = args.table.unwrap_or(TableName::Samples);
    if !matches!(table, TableName::Samples | TableName::Events) {
        return Err(other_table(
            table,
            "a trace",
            [TableName::Samples, TableName::Events],
        ));
    }
    if let Some(at) = args.at.first() {
        return Err(Failure::bad_input_with_help(
            format!("--at {at} has no meaning for a trace of one motion"),
            "a trace has no axes; its table samples has a row for each time",
        ));
    }
    if table == TableName::Events {
        refuse_fields(args, table)?;
    }
    let quantities = quantities(args)?;
    let file = TraceFile::open(&args.file)?;
    let (spec, trace) = (&file.spec, &file.trace);
    let write = |out: &mut dyn Write, stop: &AtomicBool| -> Result<u64, TableError> {
        match table {
            TableName::Events => write_events(spec, trace, args.comments, out),
            _ => write_samples(spec, trace, &quantities, args.comments, out, stop),
        }
    };
    to.write(signals, NOT_EXPORTED, write)
}

fn other_table(table: TableName, kind: &str, tables: [TableName; 2]) -> Failure {
    let [first, second] = tables.map(name);
    Failure::bad_input_with_help(
        format!("--table {} is none of {kind}", name(table)),
        format!("its tables: {first}, {second}"),
    )
}

fn name(table: TableName) -> String {
    let value = table.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}

fn refuse_fields(args: &Args, table: TableName) -> Result<(), Failure> {
    if args.field.is_empty() {
        return Ok(());
    }
    let message = format!("--field has no meaning for --table {}", name(table));
    Err(Failure::bad_input(message))
}

/// The requested fields, in this order; all fields without a request.
fn fields(map: &MapFile, args: &Args) -> Result<Vec<Field>, Failure> {
    if args.field.is_empty() {
        return Ok(map.fields().to_vec());
    }
    let field = |name: &String| held_field(map, name);
    once(args)?.map(field).collect()
}

/// The requested quantities, in this order; all quantities without a request.
fn quantities(args: &Args) -> Result<Vec<&'static Quantity>, Failure> {
    if args.field.is_empty() {
        return Ok(QUANTITIES.iter().collect());
    }
    let quantity = |name: &String| {
        let found = QUANTITIES.iter().find(|quantity| quantity.name == name);
        found.ok_or_else(|| {
            let names = QUANTITIES.each_ref().map(|quantity| quantity.name);
            let meant = did_you_mean(name, names);
            let known = names.join(", ");
            Failure::bad_input(format!(
                "--field: a trace has no {name}; {meant}known: {known}"
            ))
        })
    };
    once(args)?.map(quantity).collect()
}

/// The names of the requested fields, checked to be different.
fn once(args: &Args) -> Result<impl Iterator<Item = &String>, Failure> {
    let names = &args.field;
    let twice = (1..names.len()).find(|&i| names[..i].contains(&names[i]));
    match twice {
        None => Ok(names.iter()),
        Some(i) => Err(Failure::bad_input(format!(
            "--field {} is given twice",
            names[i]
        ))),
    }
}
