//! What is to stay as it is while slipmap changes: the structure of its source, and how few lines
//! a field, a parameter or a law takes.

#[cfg(feature = "cli")]
mod growth;
mod structure;
