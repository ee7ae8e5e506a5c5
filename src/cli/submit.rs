//! `slipmap submit`: puts sweeps into the queue of a folder.

use std::path::{Path, PathBuf};

use crate::queue::folder::Folder;
use crate::queue::states::State;
use crate::queue::submit::{Intake, Options, Submitted, done};
use crate::sweep::Plan;

use super::failure::Failure;
use super::output::{warn_beyond_curve, warn_of_idle_delay};
use super::say;
use super::sweep_file::{STANDARD_INPUT, read_plan};

#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: slipmap submit sweeps/vc_load.toml --to maps, and `slipmap work maps` \
    computes it"
)]
pub(super) struct Args {
    /// The sweep files; - for standard input
    #[arg(value_name = "SWEEP.toml", required = true)]
    sweeps: Vec<PathBuf>,
    /// The folder of the queue and of its maps; it is made where it is missing
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    to: PathBuf,
    /// Before all sweeps that wait
    #[arg(long)]
    first: bool,
    /// It does not begin until `slipmap jobs release`
    #[arg(long)]
    hold: bool,
    /// As a new job, though the same plan waits, failed or is done
    #[arg(long)]
    again: bool,
}

/// The name that a job is made of: that of the sweep file.
fn title(path: &Path) -> String {
    match path == Path::new(STANDARD_INPUT) {
        true => String::new(),
        false => path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
    }
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    // All are read before the first is put in.
    let read = |path: &PathBuf| Ok((title(path), read_plan(path)?));
    let plans: Vec<(String, Plan)> = args
        .sweeps
        .iter()
        .map(read)
        .collect::<Result<_, Failure>>()?;
    for (_, plan) in &plans {
        warn_of_idle_delay(plan.spec.has_idle_delay());
        warn_beyond_curve(plan.spec.curve_remark());
    }
    let folder = Folder::at(&args.to);
    let intake = Intake::open(&folder)?;
    let options = Options {
        first: args.first,
        hold: args.hold,
        again: args.again,
    };
    // Each that is put first stands before those before it.
    let order: Vec<_> = match args.first {
        true => plans.iter().rev().collect(),
        false => plans.iter().collect(),
    };
    for (title, plan) in order {
        let submitted = intake.put(plan, title, options, |hash| done(&folder, hash))?;
        say::result(told(&folder, &submitted))?;
    }
    Ok(())
}

/// What is said of a sweep that was put in, or was there.
fn told(folder: &Folder, submitted: &Submitted) -> String {
    let Submitted {
        name,
        state,
        is_new,
    } = submitted;
    let begun = match is_new {
        true => "",
        false => "the same sweep ",
    };
    let state = match state {
        State::Waiting => "waits".to_owned(),
        State::Running => "is running".to_owned(),
        State::Held => "is held; `slipmap jobs release` lets it begin".to_owned(),
        State::Failed => {
            "has failed; `slipmap jobs` says why, `slipmap jobs release` tries again".to_owned()
        }
        State::Done => format!("is done: {}", folder.map(name).display()),
    };
    format!("{name}: {begun}{state}")
}
