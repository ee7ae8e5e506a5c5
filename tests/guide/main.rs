//! The guide and other texts about the program, against what the program prints.

#[path = "../common/program.rs"]
mod program;

mod book;
mod texts_for_shells;
