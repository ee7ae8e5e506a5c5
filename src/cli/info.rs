//! `slipmap info`: the contents of a map or a trace.

use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::path::PathBuf;

use crate::linear::curves::StableSide;
use crate::linear::status::FLAGS;
use crate::report::numbers::{bytes, counted, grouped, short, unit_behind};
use crate::setting::Field;
use crate::store::{MapAxis, MapFile, trace_reader};
use crate::sweep::described::schema::root;
use crate::text::Shown;
use serde::Serialize;
use utoipa::ToSchema;

use super::axis_facts::AxisFacts;
use super::failure::Failure;
use super::info_trace::{self, Told};
use super::json::{self, AnswerSchema, Inputs, as_object};
use super::open::open;
use super::say::{Rows, visible};
use super::signals::Signals;

/// The message after a signal.
const NOT_TOLD: &str = "not everything is told";

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The map, or the trace of a motion
    #[arg(value_name = "FILE.h5")]
    map: PathBuf,
    /// Print the sweep or case file that it was made from, and nothing else
    #[arg(long)]
    sweep: bool,
    /// One JSON object on standard output
    #[arg(long, conflicts_with = "sweep")]
    json: bool,
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("info")
        .or::<Facts>()
        .or::<info_trace::Facts>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    if trace_reader::is_trace(&args.map) {
        let what = match args.sweep {
            true => Told::Text,
            false if args.json => Told::Json,
            false => Told::Rows,
        };
        return signals.or_end(NOT_TOLD, || info_trace::tell(&args.map, what));
    }
    let map = open(&args.map, &signals, NOT_TOLD)?;
    signals.or_end(NOT_TOLD, || tell(&map, args))
}

fn tell(map: &MapFile, args: &Args) -> Result<(), Failure> {
    if args.sweep {
        return tell_text(&map.sweep_text());
    }
    let facts = Facts::of(map)?;
    if args.json {
        return json::print(&Inputs::default().and("file", &args.map), &facts);
    }
    let mut rows = Rows::begin();
    for (name, text) in &facts.origin {
        rows.row(name, text)?;
    }
    facts.tell_parameters(&mut rows)?;
    facts.tell_cells(&mut rows)?;
    facts.tell_curves(&mut rows)?;
    facts.tell_best(&mut rows)
}

/// Prints the text of the file from which a map or trace was made.
pub(super) fn tell_text(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    // If not on a terminal, the file is printed byte by byte.
    match out.is_terminal() {
        true => write!(out, "{}", visible(text))?,
        false => write!(out, "{text}")?,
    }
    Ok(())
}

/// What there is to say of a map.
#[derive(Serialize, ToSchema)]
#[schema(as = MapFacts)]
struct Facts {
    kind: &'static str,
    /// What the map says of where it comes from, by name.
    #[serde(serialize_with = "as_object")]
    #[schema(value_type = BTreeMap<String, String>)]
    origin: Vec<(&'static str, String)>,
    axes: Vec<AxisFacts>,
    /// Parameters that are no axes, by name.
    #[serde(serialize_with = "as_object")]
    #[schema(value_type = BTreeMap<String, f64>)]
    fixed: Vec<(String, f64)>,
    /// Units of axes, fixed parameters and fields, by name; `1` where there is none.
    #[serde(serialize_with = "as_object")]
    #[schema(value_type = BTreeMap<String, String>)]
    units: Vec<(String, String)>,
    cells: u64,
    cells_missing: u64,
    fields: Vec<FieldFacts>,
    /// Cells with each flag that any has, by its name.
    #[serde(serialize_with = "as_object")]
    #[schema(value_type = BTreeMap<String, u64>)]
    status: Vec<(&'static str, u64)>,
    /// Crossing curves; null where the map holds none.
    #[schema(required)]
    curves: Option<CurveFacts>,
    /// Best settings; null where the map holds none.
    #[schema(required)]
    best: Option<BestFacts>,
}

#[derive(Serialize, ToSchema)]
struct FieldFacts {
    name: &'static str,
    bytes: u64,
    bytes_on_disk: u64,
    /// The smallest and largest finite value; null where there is none, and of kinds.
    #[schema(value_type = Option<[f64; 2]>, required)]
    range: Option<(f64, f64)>,
    /// Cells of −∞ and +∞.
    infinite: u64,
    without_value: u64,
    /// Cells of each kind that any has, by its name.
    #[serde(serialize_with = "as_object")]
    #[schema(value_type = BTreeMap<String, u64>)]
    kinds: Vec<(&'static str, u64)>,
}

#[derive(Serialize, ToSchema)]
struct CurveFacts {
    crossing: u64,
    /// Crossing curves that bound a stable region.
    bounding: u64,
    degrees_of_stability: u64,
}

#[derive(Serialize, ToSchema)]
struct BestFacts {
    planes: u64,
    /// Null where no plane has a stable setting.
    #[schema(required)]
    shortest_relaxation_time: Option<f64>,
}

impl Facts {
    fn of(map: &MapFile) -> Result<Self, Failure> {
        let axis = |axis: &MapAxis| AxisFacts::of(&axis.parameter, &axis.values);
        let flags = FLAGS.iter().map(|(_, name)| *name);
        let flagged = flags.zip(map.status_counts()?.flagged);
        let scalars = map.scalars().into_iter();
        let mut told = origin(|name| map.root_text(name));
        told.extend(said_of_starts(map));
        told.extend(map.system().map(|system| ("system", system.in_one_line())));
        Ok(Self {
            kind: "map",
            origin: told,
            axes: map.axes().iter().map(axis).collect(),
            fixed: scalars
                .map(|(p, value)| (p.name().to_owned(), value))
                .collect(),
            cells: map.cells(),
            cells_missing: map.cells_missing(),
            units: units(map),
            fields: fields(map)?,
            status: flagged.filter(|(_, cells)| *cells > 0).collect(),
            curves: curves(map)?,
            best: best(map)?,
        })
    }

    fn tell_parameters(&self, rows: &mut Rows) -> Result<(), Failure> {
        for axis in &self.axes {
            rows.row("axis", axis.text(&self.unit(&axis.name)))?;
        }
        for (name, value) in &self.fixed {
            let unit = self.unit(name);
            rows.row("fixed", format!("{name:<12} {}{unit}", Shown(*value)))?;
        }
        Ok(())
    }

    /// The unit of the quantity `name`, after a space; empty where it has none.
    fn unit(&self, name: &str) -> String {
        let of = self.units.iter().find(|(of, _)| of == name);
        of.map_or_else(String::new, |(_, unit)| unit_behind(unit))
    }

    fn tell_cells(&self, rows: &mut Rows) -> Result<(), Failure> {
        rows.row("cells", grouped(self.cells))?;
        if self.cells_missing > 0 {
            rows.row("missing", format!("{} cells", grouped(self.cells_missing)))?;
        }
        for field in &self.fields {
            rows.row("field", field.text(&self.unit(field.name)))?;
        }
        for (name, cells) in &self.status {
            rows.row("status", format!("{name:<14} {} cells", grouped(*cells)))?;
        }
        Ok(())
    }

    fn tell_curves(&self, rows: &mut Rows) -> Result<(), Failure> {
        let Some(curves) = &self.curves else {
            return Ok(());
        };
        let (crossing, bounding) = (curves.crossing, curves.bounding);
        let text = format!("{crossing} crossing curves, {bounding} of them bound a stable region");
        rows.row("boundaries", text)?;
        if curves.degrees_of_stability > 0 {
            let decaying = curves.degrees_of_stability;
            rows.row("", format!("{decaying} curves of degrees of stability"))?;
        }
        Ok(())
    }

    fn tell_best(&self, rows: &mut Rows) -> Result<(), Failure> {
        let Some(best) = &self.best else {
            return Ok(());
        };
        let fastest = match best.shortest_relaxation_time {
            Some(fastest) => {
                let unit = self.unit(Field::RelaxationTime.name());
                format!("the shortest relaxation time is {fastest:.4}{unit}")
            }
            None => "none of them stable".to_owned(),
        };
        let planes = counted(best.planes, "plane");
        rows.row("best", format!("settings of {planes}, {fastest}"))
    }
}

impl FieldFacts {
    /// "vc  8 kB, 2 kB on disk, −0.3 to 1.2, 12 infinite, 3 without a value", or with its kinds.
    fn text(&self, unit: &str) -> String {
        let sizes = format!(
            "{}, {} on disk",
            bytes(self.bytes),
            bytes(self.bytes_on_disk)
        );
        let mut text = format!("{:<22} {sizes}", self.name);
        for (kind, cells) in &self.kinds {
            text += &format!(", {} {kind}", grouped(*cells));
        }
        if let Some((low, high)) = self.range {
            text += &format!(", {} to {}{unit}", short(low), short(high));
        }
        for (cells, what) in [
            (self.infinite, "infinite"),
            (self.without_value, "without a value"),
        ] {
            if cells > 0 {
                text += &format!(", {} {what}", grouped(cells));
            }
        }
        text
    }
}

/// Names of the facts about the origin of a file, with the attributes that hold them.
const ORIGIN: [(&str, &str); 8] = [
    ("title", root::TITLE),
    ("made by", root::SOURCE),
    ("revision", root::GIT_REVISION),
    ("history", root::HISTORY),
    ("plan", root::PLAN_HASH),
    ("protocol", root::PROTOCOL),
    ("friction", root::FRICTION_LAW),
    ("mu_k", root::FRICTION_FORMULA),
];

/// The facts about the origin of a file, by name, from its texts.
pub(super) fn origin(text: impl Fn(&str) -> Option<String>) -> Vec<(&'static str, String)> {
    let told = ORIGIN.into_iter().filter_map(|(name, attribute)| {
        let text = text(attribute).filter(|text| !text.is_empty())?;
        Some((name, text))
    });
    told.collect()
}

/// A remark on the start of a map's motions, if its sweep gives none, or on many starts.
fn said_of_starts(map: &MapFile) -> Option<(&'static str, String)> {
    let said = map.sweep().ok()?.said_of_starts()?;
    Some(("start", said))
}

/// Units by name; parameters have those of the sweep.
fn units(map: &MapFile) -> Vec<(String, String)> {
    let of_sweep = map.units();
    let axes = map.axes().iter().map(|axis| axis.parameter.clone());
    let scalars = map.scalars().into_iter().map(|(parameter, _)| parameter);
    let parameters = axes.chain(scalars);
    let of_parameters = parameters.map(|p| (p.name().to_owned(), p.unit(&of_sweep)));
    let fields = map
        .fields()
        .iter()
        .map(|&field| (field.name().to_owned(), map.field_unit(field)));
    let mut units: Vec<_> = of_parameters.chain(fields).collect();
    // Also the unit of the best settings.
    let time = Field::RelaxationTime.name();
    if map.best_plane().is_some() && units.iter().all(|(name, _)| name != time) {
        units.push((time.to_owned(), of_sweep.time()));
    }
    units
}

fn fields(map: &MapFile) -> Result<Vec<FieldFacts>, Failure> {
    let mut fields = Vec::new();
    for (name, bytes, bytes_on_disk) in map.sizes()? {
        let mut facts = FieldFacts {
            // Older maps use former names of some fields.
            name: Field::from_name(name).map_or(name, Field::name),
            bytes,
            bytes_on_disk,
            range: None,
            infinite: 0,
            without_value: 0,
            kinds: Vec::new(),
        };
        let field = Field::from_name(name);
        if let Some(field) = field {
            let summary = map.summary(field)?;
            (facts.range, facts.infinite) = (summary.range, summary.infinite.iter().sum());
            facts.without_value = summary.missing(map.cells());
            let kinds = field.kinds().into_iter().flatten();
            let counts = kinds.zip(summary.kinds);
            facts.kinds = counts.filter(|(_, cells)| *cells > 0).collect();
        }
        fields.push(facts);
    }
    Ok(fields)
}

fn curves(map: &MapFile) -> Result<Option<CurveFacts>, Failure> {
    if map.boundary_plane().is_none() {
        return Ok(None);
    }
    let mut facts = CurveFacts {
        crossing: 0,
        bounding: 0,
        degrees_of_stability: 0,
    };
    map.for_each_curve(|curve| {
        match curve.degree_of_stability {
            0.0 => {
                facts.crossing += 1;
                facts.bounding += u64::from(curve.piece.stable_side != StableSide::Neither);
            }
            _ => facts.degrees_of_stability += 1,
        }
        ControlFlow::Continue(())
    })?;
    Ok(Some(facts))
}

fn best(map: &MapFile) -> Result<Option<BestFacts>, Failure> {
    if map.best_plane().is_none() {
        return Ok(None);
    }
    let best = map.best()?;
    let times = best.iter().filter_map(|b| b.relaxation_time);
    Ok(Some(BestFacts {
        planes: best.len() as u64,
        shortest_relaxation_time: times.min_by(f64::total_cmp),
    }))
}
