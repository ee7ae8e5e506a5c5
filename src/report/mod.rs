//! What a person sees: progress, summaries, pictures.

mod known;
#[cfg(feature = "cli")]
pub mod log;
pub mod numbers;
#[cfg(feature = "picture")]
pub mod picture;
pub mod preview;
#[cfg(feature = "cli")]
pub mod progress;
pub mod visible;
