//! `slipmap schema`: the JSON Schema of the output of another command.

use clap::ValueEnum;

use super::failure::Failure;
use super::json::AnswerSchema;
use super::{
    basin, best, info, margins, plan, point, reproduce, say, simulate, status, vc, verify,
};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The command whose --json is described
    #[arg(value_enum)]
    command: Command,
}

/// Commands with `--json`.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Command {
    Basin,
    Best,
    Info,
    Margins,
    Plan,
    Point,
    Reproduce,
    Simulate,
    Status,
    Vc,
    Verify,
}

impl Command {
    fn described(self) -> AnswerSchema {
        match self {
            Self::Basin => basin::described(),
            Self::Best => best::described(),
            Self::Info => info::described(),
            Self::Margins => margins::described(),
            Self::Plan => plan::described(),
            Self::Point => point::described(),
            Self::Reproduce => reproduce::described(),
            Self::Simulate => simulate::described(),
            Self::Status => status::described(),
            Self::Vc => vc::described(),
            Self::Verify => verify::described(),
        }
    }
}

/// Prints the schema.
pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let schema = args.command.described().schema();
    let text = serde_json::to_string_pretty(&schema).map_err(std::io::Error::from)?;
    say::result(text)
}
