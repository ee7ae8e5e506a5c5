//! From a sweep file to the cells of a map.
//!
//! ```text
//! TOML text → [spec] what the user wrote → [plan] axes, lines, tiles → [engine] lines analysed over threads → a sink
//! ```
//!
//! A case file is one motion of the block: [case_file] reads it, [trace] follows and samples it.
//!
//! A **line** is all delays at fixed other parameters: the closed form gives all crossings of a line at once. A **tile** is
//! a block of lines: the unit of parallel work and of storing. Nothing passes from tile to tile, so a map does not depend
//! on the number of threads.

pub mod axis;
pub mod best;
pub mod boundaries;
pub mod case_file;
pub mod engine;
pub mod events;
pub mod field;
pub mod friction_table;
mod given;
pub mod limit_columns;
mod limit_spec;
pub mod memory;
pub mod parameter;
pub mod pieces;
pub mod plan;
mod protocol;
mod root_columns;
pub mod second_look;
pub mod simulation;
mod slip_columns;
pub mod spec;
pub mod tile;
mod toml_reader;
pub mod trace;
pub mod vc;
mod vc_columns;
mod worker;

pub use axis::Axis;
pub use case_file::CaseSpec;
pub use engine::{RunError, Sink};
pub use events::{Event, Observer};
pub use field::Field;
pub use memory::Memory;
pub use parameter::{Parameter, Setting};
pub use pieces::{Order, Piece, Pieces, Shard, Todo};
pub use plan::Plan;
pub use protocol::Protocol;
pub use root_columns::relaxation_time;
pub use spec::{SpecError, SweepSpec};
pub use trace::Trace;
