//! From a plan to its map, and whether a map is true.
//!
//! - [`maker`]: computes what is missing, and puts the map together; shards, and their merge
//! - [`assembly`]: from pieces to a map
//! - [`check`]: whether a map is as it was written, and what other methods say of it
//! - [`check_trace`]: whether a trace is what its case comes to
//! - [`look`]: a map that is looked at, window by window

pub mod assembly;
pub mod check;
pub mod check_trace;
pub mod look;
pub mod maker;
