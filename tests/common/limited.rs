//! The real program with a limit on its memory and its time.

#![allow(dead_code, reason = "no test uses all of it")]

use std::fs::{self, File};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::program::{LONGEST, ends_within};

/// Virtual memory of a process, KiB.
const MEMORY: u64 = 2 << 20;
/// What takes longer hangs.
const PATIENCE: Duration = Duration::from_secs(10);

/// How a process ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum End {
    Code(i32),
    Signal(i32),
    Hung,
}

/// What a process left behind.
#[derive(Debug)]
pub(crate) struct Ended {
    pub end: End,
    /// Everything that it wrote, on either stream.
    pub said: Vec<u8>,
    /// The most memory that it had at a time, bytes, or what this process had when it started it if
    /// that is more; 0 where it hung.
    pub peak: u64,
}

impl Ended {
    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.said).into_owned()
    }
}

/// Runs the program with little memory; what it says goes to a file `said` in `folder`.
#[expect(
    clippy::zombie_processes,
    reason = "wait4 waits for it, and tells its memory"
)]
pub(crate) fn run(folder: &Path, args: &[&str], variables: &[(&str, &str)]) -> Ended {
    let said = folder.join("said");
    let out = File::create(&said).unwrap();
    let limited = format!("ulimit -v {MEMORY}; ulimit -c 0; exec \"$0\" \"$@\"");
    let mut command = Command::new("sh");
    command
        .args(["-c", &limited, env!("CARGO_BIN_EXE_slipmap")])
        .args(args)
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .envs(variables.iter().copied())
        .stdin(Stdio::null())
        .stderr(out.try_clone().unwrap())
        .stdout(out);
    let child = ends_within(&mut command, LONGEST).spawn().unwrap();
    let (end, peak) = wait(child.id() as libc::pid_t, PATIENCE);
    Ended {
        end,
        said: fs::read(&said).unwrap(),
        peak,
    }
}

/// Waits for a child, which is not waited for otherwise, and tells how it ended and its memory in
/// bytes.
pub(crate) fn wait(child: libc::pid_t, patience: Duration) -> (End, u64) {
    let begun = Instant::now();
    let mut pause = Duration::from_millis(1);
    loop {
        let (mut status, mut usage) = (0, std::mem::MaybeUninit::<libc::rusage>::zeroed());
        // SAFETY: both results are live, and zeros are a usage.
        let (ended, usage) = unsafe {
            let flags = libc::WNOHANG;
            let ended = libc::wait4(child, &raw mut status, flags, usage.as_mut_ptr());
            (ended, usage.assume_init())
        };
        if ended == child {
            let status = ExitStatus::from_raw(status);
            let end = match status.code() {
                Some(code) => End::Code(code),
                None => End::Signal(status.signal().unwrap_or(0)),
            };
            return (end, 1024 * usage.ru_maxrss as u64);
        }
        if begun.elapsed() > patience {
            // SAFETY: the child is this process's own, and not yet waited for.
            unsafe {
                libc::kill(child, libc::SIGKILL);
                libc::waitpid(child, std::ptr::null_mut(), 0);
            }
            return (End::Hung, 0);
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(20));
    }
}
