//! The user's line for the shell after each job, one at a time, beside the work.

use std::collections::VecDeque;
use std::ffi::OsStr;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::name::Name;
use super::states::State;

/// How long a line may go on after the worker was told to stop.
const PATIENCE: Duration = Duration::from_secs(2);
const MOMENT: Duration = Duration::from_millis(20);

/// The lines that run or are to run.
#[derive(Debug, Default)]
pub(super) struct Lines {
    waiting: VecDeque<(Name, Command)>,
    running: Option<(Name, Child)>,
}

impl Lines {
    /// Adds the line for a job that is done or has failed.
    pub(super) fn add(
        &mut self,
        line: &OsStr,
        (name, state): (&Name, State),
        map: &Path,
        why: &str,
    ) {
        let mut shell = Command::new("sh");
        shell.arg("-c").arg(line).stdin(Stdio::null());
        shell.env("SLIPMAP_JOB", name.to_string());
        shell.env("SLIPMAP_STATE", state.name());
        shell.env("SLIPMAP_MAP", map).env("SLIPMAP_WHY", why);
        // A line is ended with all that it has started.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut shell, 0);
        self.waiting.push_back((name.clone(), shell));
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty() && self.running.is_none()
    }

    /// Begins the next line once the one before has ended. What went wrong is told, with the job.
    pub(super) fn look(&mut self) -> Option<(Name, String)> {
        if let Some((name, mut child)) = self.running.take() {
            match child.try_wait() {
                Ok(None) => {
                    self.running = Some((name, child));
                    return None;
                }
                Ok(Some(status)) if ExitStatus::success(&status) => {}
                Ok(Some(status)) => {
                    return Some((name, format!("the line of --then ended with {status}")));
                }
                Err(error) => return Some((name, format!("the line of --then: {error}"))),
            }
        }
        let (name, mut shell) = self.waiting.pop_front()?;
        match shell.spawn() {
            Ok(child) => {
                self.running = Some((name, child));
                None
            }
            Err(error) => Some((
                name,
                format!("the line of --then could not be run: {error}"),
            )),
        }
    }

    /// Ends what runs, after some patience; lines that wait are not begun.
    pub(super) fn end(&mut self) {
        self.waiting.clear();
        let begun = Instant::now();
        while self.look().is_some() || (self.running.is_some() && begun.elapsed() < PATIENCE) {
            std::thread::sleep(MOMENT);
        }
        if let Some((_, child)) = self.running.take() {
            #[cfg(unix)]
            {
                use rustix::process::{Pid, Signal, kill_process_group};
                // It may just have ended.
                let _ = kill_process_group(Pid::from_child(&child), Signal::TERM);
            }
            #[cfg(not(unix))]
            drop(child);
        }
    }
}
