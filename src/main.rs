//! The command line of slipmap.

use std::process::ExitCode;

use slipmap::cli::{self, Refusing};

#[global_allocator]
static ALLOCATOR: Refusing = Refusing;

fn main() -> ExitCode {
    cli::main()
}
