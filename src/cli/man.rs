//! `slipmap man`: manual pages, made from the texts of `--help`.

use std::path::{Path, PathBuf};

use crate::store::Output;
use clap::{Command, CommandFactory};
use clap_mangen::Man;

use super::Cli;
use super::failure::Failure;
use super::say;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The command; without it, the page of slipmap itself
    #[arg(conflicts_with = "output")]
    command: Option<String>,
    /// Write the pages of all commands into this folder, which has to be there
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
}

/// The page of a command.
fn page(command: Command) -> Result<String, Failure> {
    let mut page = Vec::new();
    Man::new(command).render(&mut page)?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}

/// Writes a page completely, or leaves the earlier file in place.
fn write(path: &Path, page: &str) -> Result<(), Failure> {
    Ok(Output::claim(path)?.fill(page)?)
}

/// Prints a page, or writes all pages.
pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let mut root = Cli::command();
    root.build();
    let commands = root.get_subcommands().filter(|of| !of.is_hide_set());
    let commands: Vec<_> = commands.cloned().collect();
    if let Some(folder) = &args.output {
        for command in commands.into_iter().chain([root]) {
            let name = command.get_display_name().unwrap_or("slipmap").to_owned();
            write(&folder.join(format!("{name}.1")), &page(command)?)?;
        }
        return Ok(());
    }
    let Some(name) = &args.command else {
        return say::text(&page(root)?);
    };
    let named = commands.into_iter().find(|of| of.get_name() == name);
    let Some(command) = named else {
        return Err(Failure::bad_input_with_help(
            format!("there is no command {name}"),
            "slipmap --help lists them",
        ));
    };
    say::text(&page(command)?)
}
