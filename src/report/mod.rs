//! Output for people: progress, summaries, pictures, tables.
//!
//! - `known`: for each cell of a picture its value, or why it shows none
//! - `log`: the log of a run, one JSON object per line, beside the map
//! - `numbers`: numbers in forms for people
//! - `picture`: pictures of maps (PNG, SVG, PDF) with a font of their own
//! - `preview`: a small map in the terminal
//! - `progress`: bar or plain lines; the only file that imports indicatif
//! - `table`: tables as text: names, numbers, comments; the only room that imports csv
//! - `visible`: makes control characters visible before a text reaches a terminal

mod known;
#[cfg(feature = "serve")]
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
