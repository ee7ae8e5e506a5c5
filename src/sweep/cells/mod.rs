//! One thread's work: the cells of a tile, and the curves and best settings of planes.
//!
//! - `any_columns`: the cells of a line of a model without a kernel of its own, such as a digital
//!   loop: counts, margins in delay, roots
//! - `any_plane`: curves of a plane of any two parameters of any system
//! - `basin_columns`: fields from motions with many starts
//! - `best_planes`: best settings of a whole sweep, plane by plane
//! - `boundaries`: crossing curves of a whole sweep, plane by plane
//! - `buffers`: the cells of a tile in memory, a column for each field
//! - `families`: the families of fields whose cells take long
//! - `general_columns`: the cells of a line of a general system: counts, margins, roots, reasons
//! - `letter_columns`: the cells of a line of the letter's own model: counts, margins, roots
//! - `limit_columns`: the fields of the limit of a short delay: the closed form, approximations,
//!   errors
//! - `line`: a line of cells: its places, and the loop over slow cells
//! - `lines`: the linear models of lines, without computing again what does not change
//! - `margin_columns`: the fields of margins: how far a cell is from the boundary of stability
//! - `root_columns`: fields from roots: from dimensionless roots to physical values
//! - `second_look`: checks of a cell by methods that did not compute it
//! - `slip_columns`: fields from motions: every cell's block followed to its outcome
//! - `vc_columns`: fields of the critical velocity, for every cell, and the sample that is
//!   recomputed
//! - `worker`: one thread's work: the cells of a tile, line by line

mod any_columns;
mod any_plane;
mod basin_columns;
pub mod best_planes;
pub mod boundaries;
pub mod buffers;
mod families;
mod general_columns;
mod letter_columns;
mod limit_columns;
mod line;
mod lines;
mod margin_columns;
pub(crate) mod root_columns;
pub mod second_look;
mod slip_columns;
mod vc_columns;
pub(crate) mod worker;
