//! The command line: one file per subcommand, each thin.
//!
//! - `address_space`: limits on memory that the system sets
//! - `assumed_units`: the units of the numbers that flags give
//! - `asked`: the setting that a command is asked about: of the block, or of a system from a file
//! - `asks`: the needs of commands that ask about a point, which determine their flags
//! - `at`: a place on an axis of a map: `--at AXIS=VALUE`
//! - `axis_facts`: the facts of an axis, for a sweep and for a map
//! - `basin`: `slipmap basin`: its starts and its output
//! - `best`: `slipmap best`
//! - `best_ranges`: the flags of `slipmap best` for the ranges that are searched
//! - `best_text`: the output of `slipmap best` for people
//! - `case_facts`: the facts of a case, before it is simulated and from its trace
//! - `cell`: a cell of a map instead of flags or a case file
//! - `cgroup`: limits on memory of control groups
//! - `colours`: `--color`, for help, messages and previews
//! - `compare`: `slipmap compare`
//! - `compared_text`: the output of `slipmap compare` for people
//! - `completions`: `slipmap completions`
//! - `control`: controls by name
//! - `corners`: the flag `--programme`: the corners of v0 in time
//! - `digits`: how many digits people are shown of a number: `--digits`
//! - `excerpt`: what a message shows of a text with long lines
//! - `export`: `slipmap export`: the choice of a table and its contents
//! - `failure`: how a command fails
//! - `fit`: `slipmap fit`
//! - `fit_args`: the flags of `slipmap fit`: the rig, and how the file is to be read
//! - `formula_args`: the friction law of `--friction formula`
//! - `info`: `slipmap info`
//! - `info_trace`: `slipmap info` for a trace
//! - `inputs_line`: the line of inputs with which answers about a block begin
//! - `jobs`: `slipmap jobs`
//! - `json`: the output of commands with `--json`
//! - `kind`: the kind of a file of slipmap, for commands that take another kind
//! - `law_args`: the flags of a friction law besides its parameters
//! - `limit_args`: the flags for a point of the limit of a short delay
//! - `loop_args`: the flags of pictures of a loop
//! - `man`: `slipmap man`
//! - `margin_words`: margins in words: ranges, and the frequencies of crossings
//! - `margins`: `slipmap margins`
//! - `measure`: `slipmap measure`
//! - `measure_text`: the output of `slipmap measure` for people
//! - `memory`: the memory that a run may take, and the threads that stay within it
//! - `merge`: `slipmap merge`
//! - `motion_text`: the outcome of a motion, in words and numbers for people
//! - `open`: opens a map for a command that reads it
//! - `open_files`: raises the limit of open files: a merge has one of every shard open
//! - `output`: common to all commands that write a file
//! - `parameter_values`: the numbers that flags give, with their units, and values of parameters
//! - `parameters`: the flags for a point of parameter space, with the same words as sweep files
//! - `plan`: `slipmap plan`
//! - `plan_case`: `slipmap plan` for a case file
//! - `plot`: `slipmap plot`
//! - `point`: `slipmap point`
//! - `point_args`: the arguments for a point of sliding
//! - `point_text`: the output of `slipmap point` for people
//! - `print_args`: the flags for a picture in print
//! - `read_map`: `slipmap read-map`
//! - `reference`: `slipmap reference`
//! - `reproduce`: `slipmap reproduce`: the files that it may write, and its output
//! - `return_map_args`: the flags of control by the return map
//! - `run`: `slipmap run`
//! - `say`: messages to the user
//! - `schema`: `slipmap schema`
//! - `serve`: `slipmap serve`
//! - `sets`: the flag `--set`: values of parameters that a system or a formula names
//! - `setting`: a setting from a file instead of flags, and files of settings
//! - `show`: a complete map drawn beside it and on the terminal, after `run` and `merge`
//! - `signals`: signals that stop a command in order, even while it reads or draws
//! - `response`: `slipmap simulate --system`, the response of a system in time
//! - `simulate`: `slipmap simulate`
//! - `start_args`: the flags for the start and the end of a motion
//! - `status`: `slipmap status`
//! - `status_list`: `slipmap status` of several maps and of folders
//! - `sweep_file`: reads sweep files, case files and tables of friction, with errors that point
//!   into them
//! - `submit`: `slipmap submit`
//! - `system_args`: a system from a file, or a shipped one, instead of the letter's
//! - `text_output`: text on standard output, or in a file that is written completely or not at all
//! - `vc`: `slipmap vc`
//! - `vc_text`: the output of `slipmap vc` for people
//! - `verify`: `slipmap verify`
//! - `work`: `slipmap work`

mod address_space;
mod asked;
mod asks;
mod assumed_units;
mod at;
mod axis_facts;
mod basin;
mod best;
mod best_ranges;
mod best_text;
mod case_facts;
mod cell;
mod cgroup;
mod colours;
mod compare;
mod compared_text;
mod completions;
mod control;
mod corners;
mod digits;
mod excerpt;
mod export;
mod failure;
mod fit;
mod fit_args;
mod formula_args;
mod info;
mod info_trace;
mod inputs_line;
mod jobs;
mod json;
mod kind;
mod law_args;
mod limit_args;
mod loop_args;
mod man;
mod margin_words;
mod margins;
mod measure;
mod measure_text;
mod memory;
mod merge;
mod motion_text;
mod open;
mod open_files;
mod output;
mod parameter_values;
mod parameters;
mod plan;
mod plan_case;
mod plot;
mod point;
mod point_args;
mod point_text;
mod print_args;
mod read_map;
mod reference;
mod reproduce;
mod response;
mod return_map_args;
mod run;
mod say;
mod schema;
mod serve;
mod sets;
mod setting;
mod show;
mod signals;
mod simulate;
mod start_args;
mod status;
mod status_list;
mod submit;
mod sweep_file;
mod system_args;
mod text_output;
mod vc;
mod vc_text;
mod verify;
mod work;

use std::process::ExitCode;
use std::sync::Arc;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

pub use address_space::Refusing;
use colours::Colours;
use failure::Failure;
use json::AnswerSchema;

use crate::setting::unit::Unit;

/// The order of flags that every command has: behind all others.
const LAST: usize = 1000;

/// Exact stability maps of delayed-feedback control of dry friction.
#[derive(Parser)]
#[command(
    version = format!("{} ({})", crate::VERSION, crate::REVISION)
)]
#[command(after_help = "Exit codes: 0 done, 1 failed, 2 bad input or usage, \
        3 another run works on this map, 129, 130 or 143 interrupted.")]
struct Cli {
    /// Colours in help, errors, warnings and previews
    #[arg(long, global = true, value_enum, default_value_t = Colours::Auto, value_name = "WHEN",
          display_order = LAST)]
    color: Colours,
    /// Nothing on standard error but errors and warnings: no progress, no remarks
    #[arg(short, long, global = true, display_order = LAST)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

/// What a command answers with `--json`.
type Described = fn() -> AnswerSchema;

/// Makes the enumeration of commands from a row for each: its name, its file, which has its `Args`
/// and its `main`, and `described` where the file has that function for the schema of its `--json`.
macro_rules! commands {
    ($($(#[$about:meta])* $name:ident($file:ident $(, $described:ident)?),)*) => {
        #[derive(Subcommand)]
        enum Command {
            $($(#[$about])* $name($file::Args),)*
        }

        impl Command {
            fn main(&self) -> Result<(), Failure> {
                match self {
                    $(Self::$name(args) => $file::main(args),)*
                }
            }
        }

        /// The commands with `--json`, and what they answer.
        const WITH_JSON: &[(&str, Described)] =
            &[$($((stringify!($file), $file::$described),)?)*];
    };
}

commands! {
    /// Compute a map: from a sweep file to HDF5 and a picture
    Run(run),
    /// Put the shards of a map together
    Merge(merge),
    /// Put sweeps into the queue of a folder
    Submit(submit),
    /// Compute the sweeps that wait in a folder, one after the other
    Work(work),
    /// Say what waits, runs, is held, failed and is done in a folder; hold, release, drop sweeps
    Jobs(jobs, described),
    /// Say how far a map is, or all maps of a folder, from another terminal
    Status(status, described),
    /// Check a map: its checksums, its schema, and a sample of its cells by other methods; or
    /// compute the motion of a trace again
    Verify(verify, described),
    /// Say what a sweep or a motion would cost, without computing it
    Plan(plan, described),
    /// Fit a friction law to measured points, with the error of its slope
    Fit(fit, described),
    /// Everything about one point of parameter space
    Point(point, described),
    /// How far one point is from the boundary of stability, in every direction
    Margins(margins, described),
    /// The gain and delay of fastest decay, for every stable region
    Best(best, described),
    /// Show charts in a browser, computed while you look
    Serve(serve),
    /// Read a map for `serve`
    #[command(hide = true)]
    ReadMap(read_map),
    /// The critical velocity at one point
    Vc(vc, described),
    /// The share of starts from which control ends in sliding, with its error
    Basin(basin, described),
    /// Control by the return map beside delayed feedback: shares of starts that reach sliding
    Compare(compare, described),
    /// Measure friction through control: means of the elongation at many v0, with their errors
    Measure(measure, described),
    /// One motion in time: from a case file to HDF5 and a picture, with its events and outcome
    Simulate(simulate, described),
    /// Draw a map or a trace as PNG, SVG or PDF
    Plot(plot),
    /// Write what a map or a trace holds as text (CSV)
    Export(export),
    /// Say what a map or a trace holds
    Info(info, described),
    /// Reproduce the letter: every claim with what is found, and a verdict
    Reproduce(reproduce, described),
    /// Print the JSON Schema of what another command prints with --json
    Schema(schema),
    /// Print the completions of a shell
    Completions(completions),
    /// Print the manual page of a command, or write those of all
    Man(man),
    /// Print a page of the guide's reference
    #[command(hide = true)]
    Reference(reference),
}

/// An error about arguments, with a tip where a blank divides a number from its unit.
fn with_tip(mut error: clap::Error) -> clap::Error {
    let divided = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(word)) => Unit::read(word).is_ok(),
        _ => false,
    };
    if divided && error.kind() == ErrorKind::UnknownArgument {
        let tip = "a number and its unit stand together, as in 3mm, or in quotes, as in \"3 mm\"";
        let tips = ContextValue::StyledStrs(vec![tip.into()]);
        error.insert(ContextKind::Suggested, tips);
    }
    error
}

/// Prints help, or what is wrong with the arguments. File names in them may contain control
/// characters, which are spelled out and not sent to the terminal.
fn say_usage(error: &clap::Error) -> ExitCode {
    let odd = |arg: std::ffi::OsString| {
        let arg = arg.to_string_lossy().into_owned();
        say::visible_line(&arg) != arg
    };
    if !std::env::args_os().any(odd) {
        error.exit();
    }
    say::remark(error.render());
    ExitCode::from(error.exit_code() as u8)
}

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    address_space::prepare();
    let colours = Colours::asked();
    colours.apply();
    let parsed = Cli::command().color(colours.choice()).try_get_matches();
    let command = match parsed.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => {
            say::set_quiet(cli.quiet);
            cli.command
        }
        Err(error) => return say_usage(&with_tip(error)),
    };
    // This signal is caught and ignored: exceeding a limit on file sizes then makes the write fail
    // instead of ending the process. If it cannot be caught, the process ends.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
    match command.main() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
