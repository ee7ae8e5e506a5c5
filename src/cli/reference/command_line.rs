//! The command line, from the data of `--help`.

use std::fmt::Write;

use clap::builder::PossibleValue;
use clap::{Arg, Command, CommandFactory};

use super::super::Cli;
use super::markdown::{code, heading, paragraph, table};

/// The page.
pub(super) fn command_line(page: &mut String) {
    heading(page, 1, "Command line");
    let mut root = Cli::command();
    root.build();
    paragraph(
        page,
        &format!(
            "{}.",
            root.get_about()
                .map_or_else(String::new, ToString::to_string)
        ),
    );
    paragraph(
        page,
        &root
            .get_after_help()
            .map_or_else(String::new, ToString::to_string),
    );
    paragraph(page, "Flags of every command:");
    flags_of(page, root.get_arguments());
    for command in root.get_subcommands() {
        if command.is_hide_set() || command.get_name() == "help" {
            continue;
        }
        one_command(page, command, command.get_name());
    }
}

/// A command by its name, and those below it.
fn one_command(page: &mut String, command: &Command, name: &str) {
    heading(page, 2, &code(&format!("slipmap {name}")));
    let about = command.get_long_about().or(command.get_about());
    paragraph(
        page,
        &format!("{}.", about.map_or_else(String::new, ToString::to_string)),
    );
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ").lines();
    let usage: Vec<_> = usage.map(str::trim).collect();
    paragraph(page, &format!("```text\n{}\n```", usage.join("\n")));
    flags_of(
        page,
        command.get_arguments().filter(|arg| !arg.is_global_set()),
    );
    for below in command.get_subcommands() {
        if below.get_name() != "help" {
            one_command(page, below, &format!("{name} {}", below.get_name()));
        }
    }
}

fn flags_of<'a>(page: &mut String, arguments: impl Iterator<Item = &'a Arg>) {
    let rows = arguments
        .filter(|arg| !arg.is_hide_set() && !matches!(arg.get_id().as_str(), "help" | "version"))
        .map(|arg| [code(&spelled(arg)), about(arg)]);
    let rows: Vec<_> = rows.collect();
    if !rows.is_empty() {
        table(page, ["argument", "meaning"], rows);
    }
}

/// How an argument is written.
fn spelled(arg: &Arg) -> String {
    let names = arg.get_value_names().unwrap_or_default();
    let takes = arg.get_action().takes_values();
    let values: Vec<_> = names.iter().map(ToString::to_string).collect();
    let values = match takes {
        true => values.join(" "),
        false => String::new(),
    };
    if arg.is_positional() {
        return values;
    }
    let long = arg.get_long().map(|long| format!("--{long}"));
    let short = arg.get_short().map(|short| format!("-{short}"));
    let flag: Vec<_> = [short, long].into_iter().flatten().collect();
    format!("{} {values}", flag.join(", "))
        .trim_end()
        .to_owned()
}

/// The help of an argument, with its default and its possible values.
fn about(arg: &Arg) -> String {
    let help = arg.get_long_help().or(arg.get_help());
    let mut text = help.map_or_else(String::new, ToString::to_string);
    let defaults = arg.get_default_values().iter().map(|v| v.to_string_lossy());
    let defaults: Vec<_> = defaults.collect();
    if !defaults.is_empty() && arg.get_action().takes_values() {
        let _ = write!(text, " [default: {}]", defaults.join(", "));
    }
    let possible = arg.get_possible_values();
    if !possible.is_empty() && arg.get_action().takes_values() {
        let offered = possible.iter().filter(|value| !value.is_hide_set());
        let names: Vec<_> = offered.map(PossibleValue::get_name).collect();
        let _ = write!(text, " [values: {}]", names.join(", "));
    }
    text
}
