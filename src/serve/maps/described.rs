//! What is answered about maps, for the description of the interface: the shapes of what
//! [`super::answers`] and [`super::list`] tell.

#![allow(dead_code, reason = "only described")]

use std::collections::BTreeMap;

use utoipa::ToSchema;

use crate::explore::chart_bytes::CurveHead;
use crate::explore::encoded::Array;

/// The maps below the folder.
#[derive(ToSchema)]
pub(super) struct MapList {
    /// The folder.
    folder: String,
    /// Its maps, by name.
    maps: Vec<MapEntry>,
    /// Folders that cannot be read, or lie too deep.
    folders_skipped: u64,
    /// Links that lead out of the folder, to folders, or nowhere.
    links_skipped: u64,
    /// There is more than is listed.
    truncated: bool,
}

/// A map in the list.
#[derive(ToSchema)]
pub(super) struct MapEntry {
    /// 16 hexadecimal digits, the same for the same name.
    id: String,
    /// Where it is below the folder.
    name: String,
    /// `complete`, `running`, `interrupted`, `damaged` or, not known yet, `unknown`.
    state: String,
    /// Why it is damaged.
    #[schema(required)]
    why: Option<String>,
    /// The size of its files.
    bytes: u64,
    /// When it was written last, in seconds since 1970.
    #[schema(required)]
    modified: Option<f64>,
    /// How long ago that was.
    #[schema(required)]
    age_seconds: Option<f64>,
    /// Its title; it may be empty.
    #[schema(required)]
    title: Option<String>,
    /// Its cells.
    #[schema(required)]
    cells: Option<u64>,
    /// How many of them are there.
    #[schema(required)]
    cells_done: Option<u64>,
    /// Its axes, the slowest one first.
    axes: Vec<MapAxisEnds>,
    /// The names of its fields.
    fields: Vec<String>,
}

/// An axis.
#[derive(ToSchema)]
pub(super) struct MapAxisEnds {
    /// Its parameter.
    name: String,
    /// The symbol.
    symbol: String,
    /// The unit; "1" where there is none.
    unit: String,
    /// The first value.
    from: f64,
    /// The last one.
    to: f64,
    /// How many there are.
    points: u64,
}

/// An axis with its values.
#[derive(ToSchema)]
pub(super) struct MapAxis {
    #[serde(flatten)]
    ends: MapAxisEnds,
    /// What it is.
    long_name: String,
    /// Its values, if they are 4,096 at most.
    #[schema(required)]
    values: Option<Vec<f64>>,
}

/// What there is to know of a map besides its cells.
#[derive(ToSchema)]
pub(super) struct MapDescription {
    /// 16 hexadecimal digits, the same for the same name.
    id: String,
    /// Where it is below the folder.
    name: String,
    /// `complete`, `running` or `interrupted`.
    state: String,
    /// Its title; it may be empty.
    title: String,
    /// Its cells.
    cells: u64,
    /// How many of them are there.
    cells_done: u64,
    /// Another one when more cells are there.
    version: u64,
    /// Its axes, the slowest one first.
    axes: Vec<MapAxis>,
    /// Its fields.
    fields: Vec<MapField>,
    /// The parameters that are no axes.
    scalars: Vec<MapScalar>,
    /// The flags of a cell's status.
    flags: Vec<MapFlag>,
    /// The axes of the plane of its curves.
    #[schema(required)]
    curves_plane: Option<Vec<String>>,
    /// How critical velocities were looked for.
    #[schema(required)]
    protocol: Option<String>,
    /// The version of the program that made it.
    #[schema(required)]
    program_version: Option<String>,
    /// The sweep file's text.
    sweep: String,
}

/// A field of a map.
#[derive(ToSchema)]
pub(super) struct MapField {
    /// Its name.
    name: String,
    /// What it is.
    long_name: String,
    /// The same in a few words.
    short_name: String,
    /// The unit; "1" where there is none.
    unit: String,
    /// How it is stored: `count`, `kind`, `few` or `real`.
    storage: String,
    /// The names of its kinds, by their numbers.
    #[schema(required)]
    kinds: Option<Vec<String>>,
    /// How its values are spread, which tells what scale shows them.
    spread: String,
    /// The sign of values where sliding is stable, for values on both sides of 0.
    #[schema(required)]
    stable_sign: Option<f64>,
    /// What a reader should know besides.
    #[schema(required)]
    comment: Option<String>,
}

/// A parameter that is no axis.
#[derive(ToSchema)]
pub(super) struct MapScalar {
    /// Its name.
    name: String,
    /// The symbol.
    symbol: String,
    /// What it is.
    long_name: String,
    /// The unit; "1" where there is none.
    unit: String,
    /// Its value.
    value: f64,
}

/// A flag of a cell's status.
#[derive(ToSchema)]
pub(super) struct MapFlag {
    /// Its bit.
    mask: u8,
    /// Its name.
    name: String,
}

/// What a window says before its numbers.
#[derive(ToSchema)]
pub(super) struct WindowHead {
    /// Everything was read; else ask again.
    complete: bool,
    /// The part that was, 0 to 1.
    progress: f64,
    /// Another one when more cells are there.
    version: u64,
    /// The field.
    field: String,
    /// From left to right.
    x: WindowAxis,
    /// From bottom to top; none for a line.
    y: Option<WindowAxis>,
    /// Where it lies along the other axes.
    at: Vec<WindowAt>,
    /// The nearest cell's value, pixel by pixel, those of the first x first.
    values: Array,
    /// Its status.
    status: Array,
    /// 1: the pixel hides cells of several values; 2: it is not read yet; 4: not computed yet.
    bits: Array,
    /// Why some cells could not be read.
    #[schema(required)]
    damage: Option<String>,
    /// How long it took.
    milliseconds: f64,
}

/// Pixels along an axis.
#[derive(ToSchema)]
pub(super) struct WindowAxis {
    /// The axis.
    name: String,
    /// The index of the cell that each pixel shows.
    index: Array,
    /// Its value.
    values: Array,
}

/// Where a window lies along an axis that does not span it.
#[derive(ToSchema)]
pub(super) struct WindowAt {
    /// The axis.
    name: String,
    /// The index.
    index: u64,
    /// Its value.
    value: f64,
}

/// What curves say before their numbers, x and y vertex by vertex.
#[derive(ToSchema)]
pub(super) struct CurvesHead {
    /// Another one when more cells are there.
    version: u64,
    /// The curves; none where they are of other planes.
    curves: Vec<CurveHead>,
}

/// One cell.
#[derive(ToSchema)]
pub(super) struct MapCell {
    /// Its value along each axis.
    axes: BTreeMap<String, f64>,
    /// Its value of each field: a number, `inf`, `-inf`, or null where there is none.
    fields: BTreeMap<String, CellValue>,
    /// The names of its kinds, of fields that have such.
    kinds: BTreeMap<String, Option<String>>,
    /// The names of its flags.
    status: Vec<String>,
    /// It was computed.
    computed: bool,
    /// The text for `/api/v1/point`.
    #[schema(required)]
    point: Option<String>,
    /// The text for `/api/v1/vc`.
    #[schema(required)]
    vc: Option<String>,
    /// The text for `/api/v1/motion`.
    #[schema(required)]
    motion: Option<String>,
    /// The command line that says the same.
    #[schema(required)]
    command: Option<String>,
}

/// A value of a cell.
#[derive(ToSchema)]
#[serde(untagged)]
pub(super) enum CellValue {
    /// A number.
    Number(f64),
    /// `inf` or `-inf`.
    Infinite(String),
    /// None.
    None,
}
