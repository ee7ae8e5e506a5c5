//! What a person sees: progress, summaries, pictures.

pub mod numbers;
pub mod progress;
