//! The types of answers about maps and traces. They are written and described by the same
//! definitions, and read where they come from a process.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::explore::chart_bytes::CurveHead;
use crate::explore::encoded::Array;
use crate::explore::known::{KnownField, KnownFlag};
use crate::meaning::shown::Shown;

/// What a window says before its numbers.
#[derive(Serialize, ToSchema)]
pub(super) struct WindowHead {
    /// Everything was read; else ask again.
    pub complete: bool,
    /// The part that was, 0 to 1.
    pub progress: f64,
    /// Changes when cells are added.
    pub version: u64,
    /// The field.
    pub field: &'static str,
    /// From left to right.
    pub x: WindowAxis,
    /// From bottom to top; none for a line.
    #[schema(required)]
    pub y: Option<WindowAxis>,
    /// Where it lies along the other axes.
    pub at: Vec<WindowAt>,
    /// The nearest cell's value, pixel by pixel, those of the first x first.
    pub values: Array,
    /// Its status.
    pub status: Array,
    /// For each pixel 0, or why its cell shows no value: a number of `shown`.
    pub gaps: Array,
    /// What the colours of its cells mean.
    pub shown: Shown,
    /// 1: the pixel hides cells of several values or, where nothing is amiss with its own cell,
    /// some with which something is; 2: it is not read yet; 4: not computed yet; 8: it lies beyond
    /// the axes.
    pub bits: Array,
    /// Why some cells could not be read.
    #[schema(required)]
    pub damage: Option<String>,
    /// How long it took.
    pub milliseconds: f64,
}

/// Pixels along an axis.
#[derive(Serialize, ToSchema)]
pub(super) struct WindowAxis {
    /// The axis.
    pub name: String,
    /// The index of the cell that each pixel shows.
    pub index: Array,
    /// Its value.
    pub values: Array,
}

/// Where a window lies along an axis that does not span it.
#[derive(Serialize, ToSchema)]
pub(super) struct WindowAt {
    /// The axis.
    pub name: String,
    /// The index.
    pub index: usize,
    /// Its value.
    pub value: f64,
}

/// What curves say before their numbers, x and y vertex by vertex.
#[derive(Serialize, ToSchema)]
pub(super) struct CurvesHead {
    /// Changes when cells are added.
    pub version: u64,
    /// The curves; none where they are of other planes.
    pub curves: Vec<CurveHead>,
}

/// The maps below the folder.
#[derive(Serialize, ToSchema)]
pub(super) struct MapList {
    /// The folder.
    pub folder: String,
    /// Its maps, by name.
    pub maps: Vec<MapEntry>,
    /// Folders that cannot be read, or lie too deep.
    pub folders_skipped: u64,
    /// Links that lead out of the folder, to folders, or nowhere.
    pub links_skipped: u64,
    /// There is more than is listed.
    pub truncated: bool,
}

/// A map in the list.
#[derive(Serialize, ToSchema)]
pub(super) struct MapEntry {
    /// 16 hexadecimal digits, the same for the same name.
    pub id: String,
    /// Where it is below the folder.
    pub name: String,
    /// `complete`, `running`, `interrupted`, `damaged`, `unread` where reading it failed for other
    /// reasons and is tried again, or, not known yet, `unknown`.
    pub state: &'static str,
    /// Why it is damaged, or unread.
    #[schema(required)]
    pub why: Option<String>,
    /// The size of its files.
    pub bytes: u64,
    /// When it was written last, in seconds since 1970.
    #[schema(required)]
    pub modified: Option<f64>,
    /// How long ago that was.
    #[schema(required)]
    pub age_seconds: Option<f64>,
    /// What its process told of it; none and nothing where it did not.
    #[serde(flatten)]
    pub summary: MapSummary,
}

/// What a process tells of a map for the list.
#[derive(Debug, Clone, Default, Serialize, Deserialize, ToSchema)]
pub(super) struct MapSummary {
    /// Its title; it may be empty.
    #[schema(required)]
    pub title: Option<String>,
    /// Its cells.
    #[schema(required)]
    pub cells: Option<u64>,
    /// How many of them are there.
    #[schema(required)]
    pub cells_done: Option<u64>,
    /// Its axes, the slowest one first.
    pub axes: Vec<MapAxisEnds>,
    /// The names of its fields.
    pub fields: Vec<String>,
    /// The hash of its plan: maps of one sweep have the same.
    #[schema(required)]
    pub plan_hash: Option<String>,
    /// Seconds until the slowest shard that is computed is done, as far as that is known.
    #[schema(required)]
    pub seconds_left: Option<f64>,
    /// The motion of a file that is a trace, and has no cells; null for a map.
    #[schema(required)]
    pub trace: Option<TraceSummary>,
}

/// What a trace says of its motion.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub(super) struct TraceSummary {
    /// Its samples.
    pub samples: u64,
    /// The time of the last one.
    pub until: f64,
    /// The unit of time; "1" where there is none.
    pub unit: String,
    /// How the motion ended up.
    pub outcome: String,
}

/// An axis.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub(super) struct MapAxisEnds {
    /// Its parameter.
    pub name: String,
    /// The symbol.
    pub symbol: String,
    /// The unit; "1" where there is none.
    pub unit: String,
    /// The first value.
    pub from: f64,
    /// The last one.
    pub to: f64,
    /// How many there are.
    pub points: usize,
}

/// An axis with its values.
#[derive(Serialize, ToSchema)]
pub(super) struct MapAxis {
    #[serde(flatten)]
    pub ends: MapAxisEnds,
    /// What it is.
    pub long_name: String,
    /// Its values, if they are 4,096 at most.
    #[schema(required)]
    pub values: Option<Vec<f64>>,
    /// The speed of the rotation whose period the delay is; null of all else, and where numbers
    /// have no unit of time.
    #[schema(required)]
    pub speed: Option<MapSpeed>,
}

/// A speed that follows from the values of an axis.
#[derive(Serialize, ToSchema)]
pub(super) struct MapSpeed {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// It is this over a value of the axis.
    pub turn: f64,
}

/// Description of a map, without its cells.
#[derive(Serialize, ToSchema)]
pub(super) struct MapDescription<T> {
    /// 16 hexadecimal digits, the same for the same name.
    pub id: String,
    /// Where it is below the folder.
    pub name: String,
    /// `complete`, `running` or `interrupted`.
    pub state: &'static str,
    /// What its process told of it.
    #[serde(flatten)]
    pub told: T,
}

/// What a process tells of a map.
#[derive(Serialize, ToSchema)]
pub(super) struct MapTold {
    /// Its title; it may be empty.
    pub title: String,
    /// Its cells.
    pub cells: u64,
    /// How many of them are there.
    pub cells_done: u64,
    /// Changes when cells are added.
    pub version: u64,
    /// Its axes, the slowest one first.
    pub axes: Vec<MapAxis>,
    /// Its fields.
    pub fields: Vec<MapField>,
    /// The parameters that are no axes.
    pub scalars: Vec<MapScalar>,
    /// The flags of a cell's status.
    pub flags: Vec<KnownFlag>,
    /// The axes of the plane of its curves.
    #[schema(required)]
    pub curves_plane: Option<[String; 2]>,
    /// What a picture of it shows where nobody says more.
    pub first: MapFirst,
    /// How critical velocities were looked for.
    #[schema(required)]
    pub protocol: Option<&'static str>,
    /// The version of the program that made it.
    #[schema(required)]
    pub program_version: Option<String>,
    /// The sweep file's text.
    pub sweep: String,
}

/// What a picture of a map shows first.
#[derive(Serialize, ToSchema)]
pub(super) struct MapFirst {
    /// The field, that of `picture` in the sweep if it says so.
    pub field: &'static str,
    /// The axis from left to right.
    pub x: String,
    /// The axis from bottom to top; none where only one has more than one value.
    #[schema(required)]
    pub y: Option<String>,
}

/// What a process tells of a trace.
#[derive(Serialize, ToSchema)]
pub(super) struct TraceTold {
    /// The title of its case; it may be empty.
    pub title: String,
    /// Its motion.
    pub trace: TraceSummary,
    /// The parameters of its case.
    pub scalars: Vec<MapScalar>,
    /// The version of the program that made it.
    #[schema(required)]
    pub program_version: Option<String>,
    /// The case file's text.
    pub case: String,
}

/// What is described: a map or a trace.
#[derive(ToSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only described")]
pub(super) enum AnyDescription {
    /// Of a map.
    Map(MapDescription<MapTold>),
    /// Of a trace.
    Trace(MapDescription<TraceTold>),
}

/// A field of a map.
#[derive(Serialize, ToSchema)]
pub(super) struct MapField {
    /// What is known of it.
    #[serde(flatten)]
    pub known: KnownField,
    /// The unit; "1" where there is none.
    pub unit: String,
}

/// A parameter that is no axis.
#[derive(Serialize, ToSchema)]
pub(super) struct MapScalar {
    /// Its name.
    pub name: String,
    /// The symbol.
    pub symbol: String,
    /// What it is.
    pub long_name: String,
    /// The unit; "1" where there is none.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// Whether pictures tell it: it is a gain, or not the default.
    pub told: bool,
}

/// One cell.
#[derive(Serialize, ToSchema)]
pub(super) struct MapCell {
    /// Its value along each axis.
    pub axes: BTreeMap<String, f64>,
    /// Its value of each field: a number, `inf`, `-inf`, or null where there is none.
    pub fields: BTreeMap<&'static str, CellValue>,
    /// The names of its kinds, of fields that have such.
    pub kinds: BTreeMap<&'static str, Option<&'static str>>,
    /// The names of its flags.
    pub status: Vec<&'static str>,
    /// It was computed.
    pub computed: bool,
    /// The text for `/api/v1/point`.
    #[schema(required)]
    pub point: Option<String>,
    /// The text for `/api/v1/vc`.
    #[schema(required)]
    pub vc: Option<String>,
    /// The text for `/api/v1/motion`.
    #[schema(required)]
    pub motion: Option<String>,
    /// The command line that says the same.
    #[schema(required)]
    pub command: Option<String>,
}

/// A value of a cell.
#[derive(Serialize, ToSchema)]
#[serde(untagged)]
pub(super) enum CellValue {
    /// A count, or the number of a kind.
    Count(u64),
    /// A number.
    Number(f64),
    /// `inf` or `-inf`.
    Infinite(&'static str),
    /// None.
    None,
}
