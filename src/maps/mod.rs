//! From a plan to its map, and checks of a map.
//!
//! - [`maker`]: computes what is missing and assembles the map; shards, and their merge
//! - [`assembly`]: assembles a map from pieces
//! - [`check`]: whether a map is as it was written, and what other methods give for its cells
//! - `check_trace`: whether a trace follows from its case
//! - `cost`: what a map costs, from a timed sample
//! - `look`: interactive display of a map, window by window
//! - `scan`: the files below a folder that may be maps, by their names alone

pub mod assembly;
pub mod check;
pub(crate) mod check_trace;
pub(crate) mod cost;
pub(crate) mod look;
pub mod maker;
pub(crate) mod scan;
