//! `slipmap schema`: the JSON Schema of the output of another command.

use clap::builder::PossibleValuesParser;

use super::failure::Failure;
use super::{WITH_JSON, say};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The command whose --json is described
    #[arg(value_parser = PossibleValuesParser::new(names()))]
    command: String,
}

/// The commands with `--json`, by name.
fn names() -> Vec<&'static str> {
    let mut names: Vec<_> = WITH_JSON.iter().map(|(name, _)| *name).collect();
    names.sort_unstable();
    names
}

/// Prints the schema.
pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let mut all = WITH_JSON.iter();
    let described = all.find(|(name, _)| *name == args.command);
    let (_, described) = described.expect("the flag takes these names only");
    let text = serde_json::to_string_pretty(&described().schema());
    say::result(text.map_err(std::io::Error::from)?)
}
