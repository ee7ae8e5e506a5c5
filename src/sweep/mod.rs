//! From a sweep as described by its file to the cells of a map.
//!
//! ```text
//! a `SweepSpec` → [plan] axes, tiles, pieces → [cells] one thread's work on a tile
//!               → [engine] pieces over threads → a sink
//! ```
//!
//! Each room uses only those before it.
//!
//! A **line** is the set of all delays at fixed other parameters: the closed form gives all
//! crossings of a line at once. A **tile** is a block of lines: the unit of parallel work and of
//! storage. Tiles do not exchange data, so a map does not depend on the number of threads.
//!
//! - `cells`: one thread's work on a tile or a plane
//! - `described`: what maps and traces say, as plain data
//! - `engine`: pieces over threads into a sink; the only file that imports rayon
//! - `estimate`: what a sweep costs, from a timed sample of its pieces
//! - `evaluate`: fields at any points, which need not be a grid
//! - `events`: the events of a running sweep, for observers
//! - `filled`: what a map or trace says with all its numbers, for programs that want no file
//! - `grid`: a sweep computed into memory, for programs that want no file
//! - `plan`: cells, tiles, planes of curves, the plan's hash
//! - `sink`: where the computed pieces of a sweep go

pub mod cells;
pub mod described;
pub mod engine;
pub mod estimate;
pub mod evaluate;
pub mod events;
pub mod filled;
pub mod grid;
pub mod plan;
mod sink;

pub use cells::root_columns::relaxation_time;
pub use engine::{RunError, Sink};
pub use events::{Event, Observer};
pub use plan::Plan;
pub use plan::memory::Memory;
pub use plan::pieces::{Order, Piece, Pieces, Shard, Todo};
