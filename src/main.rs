//! The command line of slipmap.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
