//! `slipmap plan`: the cost of a sweep, from a timed sample of its own pieces; and what `simulate`
//! would do with a case.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::maps::cost::MapCost;
use crate::model::stop::Stop;
use crate::report::numbers::{bytes, counted, grouped, seconds, unit_behind};
use crate::setting::axis::Axis;
use crate::sweep::described::schema::STATUS;
use crate::sweep::{Memory, Plan};
use serde::Serialize;
use utoipa::ToSchema;

use super::axis_facts::AxisFacts;
use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::memory::{self, Allowed};
use super::output::{warn_beyond_curve, warn_of_idle_delay};
use super::plan_case;
use super::run::{default_threads, parse_threads};
use super::say::Rows;
use super::sweep_file::{Described, read_sweep_or_case};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The sweep or case file; - for standard input
    #[arg(value_name = "SWEEP.toml")]
    sweep: PathBuf,
    /// Threads to plan a sweep for [default: as many as the machine offers]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    /// The most memory to plan for, such as 500MB or 2GiB: fewer threads are used if they would
    /// take more [default: half of what is free, at least 500MB]
    #[arg(long, value_name = "SIZE", value_parser = memory::parse)]
    memory: Option<u64>,
    /// One JSON object on standard output; bytes and seconds
    #[arg(long)]
    json: bool,
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("plan")
        .or::<Facts>()
        .or::<plan_case::Facts>()
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let plan = match read_sweep_or_case(&args.sweep)? {
        Described::Sweep(plan) => plan,
        Described::Case(_) if args.threads.is_some() => {
            let message = "--threads has no meaning for a case: one motion takes one thread";
            return Err(Failure::bad_input(message));
        }
        Described::Case(spec) => {
            warn_of_idle_delay(spec.setting.has_idle_delay());
            warn_beyond_curve(spec.setting.beyond_curve(&spec.units));
            return plan_case::tell(&args.sweep, &spec, args.json);
        }
    };
    warn_of_idle_delay(plan.spec.has_idle_delay());
    warn_beyond_curve(plan.spec.curve_remark());
    let asked = args.threads.unwrap_or_else(default_threads);
    let allowed = Allowed::of(args.memory, 1);
    let threads = allowed.threads(&plan, asked)?;
    let facts = Facts::of(&plan, threads, allowed.bytes);
    match args.json {
        true => {
            let inputs = Inputs::default().and("sweep", &args.sweep);
            let inputs = inputs.and("threads", threads).and("memory", allowed.bytes);
            json::print(&inputs, &facts)
        }
        false => facts.tell(),
    }
}

/// What there is to say of a plan.
#[derive(Serialize, ToSchema)]
#[schema(as = SweepFacts)]
struct Facts {
    kind: &'static str,
    axes: Vec<AxisFacts>,
    /// Units of the axes by name; `1` where there is none.
    #[schema(value_type = BTreeMap<String, String>)]
    units: BTreeMap<String, String>,
    dimensionless: bool,
    fields: Vec<&'static str>,
    /// What is said of the start of motions that no key gives, and of many starts; null where a key
    /// does, or no field is of motions.
    #[schema(required)]
    start: Option<String>,
    cells: u64,
    tiles: u64,
    cells_of_a_tile: u64,
    /// Planes in which boundaries are traced.
    boundary_planes: u64,
    /// The two axes of these planes; empty without any.
    boundaries_of: Vec<String>,
    /// Why there are none; null where there are.
    #[schema(required)]
    no_boundaries: Option<String>,
    /// Null where no best settings are asked for.
    #[schema(required)]
    best_planes: Option<u64>,
    /// Bytes of all cells in memory, and about those of the map on disk.
    bytes: u64,
    bytes_on_disk: u64,
    /// The most memory that these threads take, in bytes.
    memory: u64,
    /// The memory that a run may take, in bytes; more threads would take more.
    memory_allowed: u64,
    threads: usize,
    /// Seconds on these threads, at least, about and at most, from the cells that were timed.
    seconds: [f64; 3],
    /// Tiles that were timed, wholly or in part, and their timed cells.
    tiles_timed: usize,
    cells_timed: u64,
}

impl Facts {
    fn of(plan: &Plan, threads: usize, memory_allowed: u64) -> Self {
        let cost = MapCost::of(plan, &Stop::default());
        let axis = |axis: &Axis| AxisFacts::of(&axis.parameter, &axis.values);
        let name = |axis: &Axis| axis.parameter.name().to_owned();
        let unit = |axis: &Axis| {
            let parameter = &axis.parameter;
            (name(axis), parameter.unit(&plan.spec.units))
        };
        let fields = plan.spec.fields.iter().map(|field| field.name());
        Self {
            kind: "sweep",
            axes: plan.spec.axes.iter().map(axis).collect(),
            units: plan.spec.axes.iter().map(unit).collect(),
            dimensionless: plan.spec.units.dimensionless(),
            fields: fields.chain([STATUS]).collect(),
            start: plan.spec.said_of_starts(),
            cells: plan.cells(),
            tiles: plan.tiles.len() as u64,
            cells_of_a_tile: plan.tiles.tile_cells() as u64,
            boundary_planes: plan.boundary_planes(),
            boundaries_of: plan.boundary_plane.map_or_else(Vec::new, |(p, q)| {
                [p, q].map(|axis| name(&plan.spec.axes[axis])).to_vec()
            }),
            no_boundaries: plan.no_boundaries().map(|why| why.to_string()),
            best_planes: plan.best_plane().map(|_| plan.best_planes()),
            bytes: plan.cells() * plan.bytes_per_cell(),
            bytes_on_disk: cost.bytes_on_disk,
            memory: Memory::of(plan).on(threads),
            memory_allowed,
            threads,
            seconds: cost.seconds_on(threads),
            tiles_timed: cost.tiles_timed,
            cells_timed: cost.cells_timed,
        }
    }

    fn tell(&self) -> Result<(), Failure> {
        let mut rows = Rows::begin();
        for axis in &self.axes {
            let unit = self.units.get(&axis.name).map_or("", String::as_str);
            rows.row("axis", axis.text(&unit_behind(unit)))?;
        }
        if self.dimensionless {
            rows.row("units", "none: dimensionless")?;
        }
        rows.row("fields", self.fields.join(", "))?;
        if let Some(start) = &self.start {
            rows.row("start", start)?;
        }
        rows.row("cells", grouped(self.cells))?;
        let (tiles, cells) = (grouped(self.tiles), grouped(self.cells_of_a_tile));
        rows.row("tiles", format!("{tiles} of {cells} cells"))?;
        let boundaries = if let Some(why) = &self.no_boundaries {
            format!("none: {why}")
        } else {
            let planes = counted(self.boundary_planes, "plane");
            format!("in {planes} of {}", self.boundaries_of.join(" and "))
        };
        rows.row("boundaries", boundaries)?;
        if let Some(planes) = self.best_planes {
            rows.row("best", format!("in {}", counted(planes, "plane")))?;
        }
        let (size, stored) = (bytes(self.bytes), bytes(self.bytes_on_disk));
        let text = format!(
            "{size} before compression, about {stored} on disk, twice that for a moment at the end"
        );
        rows.row("bytes", text)?;
        let (memory, threads) = (bytes(self.memory), counted(self.threads as u64, "thread"));
        let allowed = bytes(self.memory_allowed);
        let text = format!("up to {memory} on {threads}; {allowed} are allowed");
        rows.row("memory", text)?;
        let (timed, cells) = (grouped(self.cells_timed), grouped(self.cells));
        let timed = format!("{timed} of {cells} cells timed");
        let [least, about, most] = self.seconds.map(seconds);
        let text = match self.seconds[2] < 0.01 {
            true => format!("under 0.01 s on {threads}: {timed}"),
            false => format!("about {about} on {threads}, {least} to {most}: {timed}"),
        };
        rows.row("time", text)
    }
}
