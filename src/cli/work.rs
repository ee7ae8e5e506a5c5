//! `slipmap work`: computes the sweeps that wait in a folder.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::queue::event::Event;
use crate::queue::folder::Folder;
use crate::queue::name::Name;
use crate::queue::room::KEEP_FREE;
use crate::queue::slurm::Slurm;
use crate::queue::work::{Options, Worker};
use crate::report::numbers::{counted, seconds};

use super::cgroup;
use super::failure::Failure;
use super::jobs::how_far;
use super::memory;
use super::run::{parse_seconds, parse_threads};
use super::say;
use super::signals::Signals;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example: slipmap work maps --until-empty --then \
    'mail -s \"$SLIPMAP_JOB $SLIPMAP_STATE\" me < /dev/null'")]
pub(super) struct Args {
    /// The folder of the queue and of its maps
    #[arg(value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    /// End when nothing waits that this worker may take; exit code 1 if a sweep failed
    #[arg(long)]
    until_empty: bool,
    /// Threads of a run [default: as many as the machine offers]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    /// The most memory of a run, such as 500MB or 2GiB [default: half of what is free, at least
    /// 500MB, shared by the workers that run]
    #[arg(long, value_name = "SIZE", value_parser = memory::parse)]
    memory: Option<u64>,
    /// A line for the shell after each sweep that is done or has failed; it has SLIPMAP_JOB,
    /// SLIPMAP_STATE (done or failed), SLIPMAP_MAP and SLIPMAP_WHY in its environment
    #[arg(long, value_name = "COMMAND")]
    then: Option<OsString>,
    /// Bytes of the disk that stay free; a sweep that may need them waits
    #[arg(long, value_name = "SIZE", default_value = KEEP_FREE, value_parser = memory::parse)]
    keep_free: u64,
    /// Hand each sweep to Slurm as an array of so many shards, instead of computing it here
    #[arg(long, value_name = "SHARDS", conflicts_with_all = ["threads", "memory"],
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    slurm: Option<u32>,
    /// Sweeps that Slurm has at a time
    #[arg(long, value_name = "N", requires = "slurm", default_value = "4",
          value_parser = clap::value_parser!(u16).range(1..=1000))]
    at_once: u16,
    /// Options of sbatch, behind --
    #[arg(last = true, value_name = "OPTIONS OF SBATCH", requires = "slurm")]
    options: Vec<OsString>,
    /// Seconds between two looks at an array
    #[arg(long, value_name = "SECONDS", hide = true, default_value = "10",
          value_parser = parse_seconds)]
    poll_every: Duration,
    /// Seconds after the first try without progress; they double with each
    #[arg(long, value_name = "SECONDS", hide = true, default_value = "1",
          value_parser = parse_seconds)]
    first_pause: Duration,
}

/// Options of sbatch that are not the user's.
const OURS: [&str; 12] = [
    "-a",
    "-d",
    "-J",
    "-o",
    "-W",
    "--array",
    "--dependency",
    "--job-name",
    "--output",
    "--parsable",
    "--wait",
    "--wrap",
];

impl Args {
    /// How sweeps are handed to Slurm, if they are.
    fn slurm(&self) -> Result<Option<Slurm>, Failure> {
        let Some(shards) = self.slurm else {
            return Ok(None);
        };
        for option in &self.options {
            let option = option.to_string_lossy();
            let name = option.split('=').next().unwrap_or_default();
            let is_ours = |ours: &&&str| match name.strip_prefix("--") {
                // sbatch takes long options by their beginnings too.
                Some(_) => name.len() > 2 && ours.starts_with(name),
                None => !ours.starts_with("--") && name.starts_with(**ours),
            };
            if let Some(ours) = OURS.iter().find(is_ours) {
                let message = format!("{option}: {ours} of sbatch is set by slipmap");
                return Err(Failure::bad_input(message));
            }
        }
        Ok(Some(Slurm {
            program: std::env::current_exe()?,
            shards,
            at_once: self.at_once.into(),
            options: self.options.clone(),
            every: self.poll_every,
        }))
    }
}

pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let folder = Folder::at(&args.folder);
    if ends_with_login() {
        say::remark(
            "warning: this worker ends with your last login; `loginctl enable-linger` keeps it",
        );
    }
    let options = Options {
        program: this_program()?,
        threads: args.threads,
        memory: args.memory,
        default_memory: &memory::default_memory,
        until_empty: args.until_empty,
        then: args.then.clone(),
        keep_free: args.keep_free,
        first_pause: args.first_pause,
        slurm: args.slurm()?,
    };
    let worker = Worker::new(&folder, options, &signals.stop, &tell);
    let brought = worker.work()?;
    if signals.stop.load(std::sync::atomic::Ordering::Relaxed) {
        let waits = "what waits, waits for the next worker; what was begun goes on";
        return Err(signals.interrupted(waits));
    }
    match brought.failed {
        0 => Ok(()),
        failed => Err(Failure::failed_with_help(
            format!("{} failed", counted(failed, "sweep")),
            format!(
                "`slipmap jobs {0}` says why; `slipmap jobs release NAME --in {0}` tries again",
                args.folder.display()
            ),
        )),
    }
}

/// The program of this process, also where another one has taken its name meanwhile.
fn this_program() -> std::io::Result<PathBuf> {
    let own = Path::new("/proc/self/exe");
    match own.exists() {
        true => Ok(own.to_owned()),
        false => std::env::current_exe(),
    }
}

/// Whether this process is a service of the user, which the system ends with the user's last login.
fn ends_with_login() -> bool {
    let groups = cgroup::text(Path::new("/proc/self/cgroup")).unwrap_or_default();
    let is_service = groups.contains("/user@") && groups.trim_end().ends_with(".service");
    let lingers = |user| Path::new("/var/lib/systemd/linger").join(user).exists();
    is_service && std::env::var_os("USER").is_some_and(|user| !lingers(user))
}

/// Tells what the worker does.
fn tell(name: Option<&Name>, event: &Event) {
    let name = name.map_or_else(String::new, |name| format!("{name}: "));
    match event {
        Event::Idle => {
            say::note("nothing waits; `slipmap submit` puts sweeps in, Ctrl-C ends this");
        }
        Event::Starts("") => say::note(format_args!("{name}starts")),
        Event::Starts(how) => say::note(format_args!("{name}starts {how}")),
        Event::Done(said) => drop(say::result(format_args!("{name}done; {said}"))),
        Event::Failed(why) => say::remark(format_args!("{name}failed\n{why}")),
        Event::Again(why, pause) => {
            let soon = match pause.is_zero() {
                true => "tried again at once".to_owned(),
                false => format!("tried again in {}", seconds(pause.as_secs_f64())),
            };
            say::remark(format_args!("{name}{soon}: {why}"));
        }
        Event::TakenOut => say::note(format_args!("{name}taken out of the queue")),
        Event::Goes(progress) => say::note(format_args!("{name}{}", how_far(progress))),
        Event::Waits(why) => say::remark(format_args!("{name}waits: {why}")),
        Event::Trouble(why) => say::remark(format_args!("{name}{why}")),
    }
}
