//! Expressions of named numbers, in system files and friction laws.
//!
//! - `coefficients`: a polynomial that stands in a file as a list of its coefficients
//! - `part`: parts of an expression, and the operations on them
//! - `reader`: reads an expression
//! - `tape`: an expression as a list of operations, for evaluation
//! - `written`: an expression that stands in a file, with its place

mod coefficients;
mod part;
mod reader;
mod tape;
#[cfg(test)]
mod tests;
mod written;

pub(super) use part::{LARGEST_EXPONENT, Misread, Read};
pub(super) use reader::{DEEPEST, LONGEST, VARIABLE, functions, names_in, read_number};
pub(super) use tape::{Function, Op, Stacks, Tape};
pub(super) use written::Written;
