//! What a person sees: progress, summaries, pictures, tables.

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
