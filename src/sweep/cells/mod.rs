//! The cells of a tile, and what belongs to planes of cells: one thread's work.

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
