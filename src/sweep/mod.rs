//! From a sweep file to the cells of a map.
//!
//! ```text
//! TOML text → [input] what the user wrote → [plan] axes, tiles, pieces
//!           → [cells] one thread's work on a tile → [engine] pieces over threads → a sink
//! ```
//!
//! Each room uses only those before it. A case file describes one motion of the block:
//! [`input::case_file`] reads it, [`cells::trace`] follows and samples the motion.
//!
//! A **line** is the set of all delays at fixed other parameters: the closed form gives all
//! crossings of a line at once. A **tile** is a block of lines: the unit of parallel work and of
//! storage. Tiles do not exchange data, so a map does not depend on the number of threads.
//!
//! - `cells`: one thread's work: the third room
//! - `described`: what maps and traces say, as plain data
//! - `engine`: pieces over threads into a sink; the only file that imports rayon
//! - `evaluate`: fields at any points, which need not be a grid
//! - `events`: the events of a running sweep, for observers
//! - `grid`: a sweep computed into memory, for programs that want no file
//! - `input`: what the user wrote: the first of the rooms of a sweep
//! - `plan`: cells, tiles, planes of curves, the plan's hash
//! - `sink`: where the computed pieces of a sweep go

pub mod cells;
pub mod described;
pub mod engine;
pub mod evaluate;
pub mod events;
pub mod grid;
pub mod input;
pub mod plan;
mod sink;

pub use cells::root_columns::relaxation_time;
pub use cells::trace::Trace;
pub use engine::{RunError, Sink};
pub use events::{Event, Observer};
pub use input::axis::Axis;
pub use input::case_file::CaseSpec;
pub use input::field::Field;
pub use input::parameter::Parameter;
pub use input::setting::Setting;
pub use input::spec::SweepSpec;
pub use input::toml_reader::SpecError;
pub use plan::Plan;
pub use plan::memory::Memory;
pub use plan::pieces::{Order, Piece, Pieces, Shard, Todo};
