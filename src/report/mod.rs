//! What a person sees: progress, summaries, pictures.

pub mod log;
pub mod numbers;
pub mod picture;
pub mod preview;
pub mod progress;
pub mod visible;
