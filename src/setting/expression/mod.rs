//! Expressions of named numbers, in system files and friction laws.
//!
//! - `coefficients`: a polynomial that stands in a file as a list of its coefficients
//! - `fraction`: divisors with s in them
//! - `names`: the names in the text of an expression, before it is read
//! - `part`: parts of an expression, and the operations on them
//! - `reader`: reads an expression
//! - `tape`: an expression as a list of operations, for evaluation
//! - `written`: an expression that stands in a file, with its place

mod coefficients;
mod fraction;
mod names;
mod part;
mod reader;
mod tape;
#[cfg(test)]
mod tests;
mod written;

pub(super) use coefficients::Coefficient;
pub(super) use fraction::{Factor, Quotient, common, without};
pub(super) use names::names_in;
pub(super) use part::{LARGEST_EXPONENT, Misread, Read};
pub(super) use reader::{DEEPEST, LONGEST, NUMBER_PI, VARIABLE, functions, read_number};
pub(super) use tape::{Function, Op, Stacks, Tape};
pub(super) use written::Written;
