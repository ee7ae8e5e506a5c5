//! What a person sees: progress, summaries, pictures, tables.
//!
//! - `known`: of each cell that a picture shows: its value, or why there is none to show
//! - `log`: the log of a run, one JSON object a line, beside the map
//! - `numbers`: numbers as people read them
//! - `picture`: pictures of maps (PNG, SVG, PDF) with a font of their own
//! - `preview`: a small map in the terminal
//! - `progress`: bar or plain lines; the only file that imports indicatif
//! - `table`: tables as text: names, numbers, comments; the only room that imports csv
//! - `visible`: control characters spelled out, before a text reaches a terminal

mod known;
#[cfg(feature = "cli")]
pub mod log;
pub mod numbers;
#[cfg(feature = "picture")]
pub mod picture;
pub mod preview;
#[cfg(feature = "cli")]
pub mod progress;
#[cfg(feature = "cli")]
pub mod table;
pub mod visible;
