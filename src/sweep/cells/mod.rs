//! One thread's work: the cells of a tile, and the curves and best settings of planes.
//!
//! - `any_plane`: curves of a plane of any two parameters of any system
//! - `basin`: the share of starts that end in sliding, with its error: points of a scrambled Sobol
//!   sequence, followed and counted; the only file that imports sobol_burley
//! - `basin_columns`: fields from motions with many starts
//! - `best`: best settings in physical units, the ranges searched by default
//! - `boundaries`: crossing curves of a whole sweep, plane by plane
//! - `buffers`: the cells of a tile in memory, a column for each field
//! - `general_columns`: the cells of a line of a general system: counts, margins, roots, reasons
//! - `limit_columns`: the fields of the limit of a short delay: the closed form, approximations,
//!   errors
//! - `line`: a line of cells: its places, and the loop over slow cells
//! - `lines`: the linear models of lines, without computing again what does not change
//! - `margin_columns`: the fields of margins: how far a cell is from the boundary of stability
//! - `margins`: margins of a setting, in its own units
//! - `root_columns`: fields from roots: from dimensionless roots to physical values
//! - `samples`: the samples of a motion, refused or thinned where there are too many
//! - `second_look`: checks of a cell by methods that did not compute it
//! - `slip_columns`: fields from motions: every cell's block followed to its outcome
//! - `trace`: a motion sampled over time, with its events
//! - `vc`: the critical velocity of a setting by either protocol, the regime of a working velocity,
//!   and the check by simulation
//! - `vc_columns`: fields of the critical velocity, for every cell, and the sample that is
//!   recomputed
//! - `worker`: one thread's work: the cells of a tile, line by line

mod any_plane;
pub mod basin;
mod basin_columns;
pub mod best;
pub mod boundaries;
pub mod buffers;
mod general_columns;
mod limit_columns;
mod line;
mod lines;
mod margin_columns;
pub mod margins;
pub mod root_columns;
pub mod samples;
pub mod second_look;
mod slip_columns;
pub mod trace;
pub mod vc;
mod vc_columns;
pub mod worker;
