//! One run of a sweep, as a process that ends with the worker.
//!
//! Its standard input is a pipe whose other end the worker keeps; the run stops in order when that
//! end is closed, also by the death of the worker. It shares the lock of the job, so nobody begins
//! the job again before it has ended.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::thread::JoinHandle;

use super::note::JobLock;
use crate::store::StoreError;

/// The hidden flag of `slipmap run` that names the lock of the job.
pub(crate) const FLAG: &str = "--job-lock";
/// The most bytes kept of what a run says, from the end.
const MOST_SAID: usize = 64 << 10;

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum End {
    /// Its map is complete; what it said of it.
    Done(String),
    /// The sweep cannot be computed as it is; why.
    BadInput(String),
    /// A signal stopped it, or the worker did.
    Stopped {
        /// Whether it was stopped before it could take back its try.
        at_once: bool,
    },
    /// Another run works on its map.
    Busy,
    /// It failed, or was killed; how.
    Broke(String),
}

/// A run that was started.
#[derive(Debug)]
pub(super) struct Attempt {
    child: Child,
    input: Option<ChildStdin>,
    result: Option<JoinHandle<String>>,
    said: Option<JoinHandle<String>>,
    program: PathBuf,
}

impl Attempt {
    /// Starts a run that shares the lock of its job.
    ///
    /// # Errors
    /// When the system refuses.
    pub(super) fn start(
        program: &Path,
        arguments: &[OsString],
        lock: &JobLock,
    ) -> io::Result<Self> {
        let mut command = Command::new(program);
        command.args(arguments).arg(FLAG).arg(lock.path());
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        hand_down(lock.shared(), true)?;
        let started = command.spawn();
        hand_down(lock.shared(), false)?;
        let mut child = started?;
        let (input, output, errors) =
            (child.stdin.take(), child.stdout.take(), child.stderr.take());
        Ok(Self {
            child,
            input,
            result: Some(kept(output)),
            said: Some(kept(errors)),
            program: program.to_owned(),
        })
    }

    /// Tells it to stop.
    pub(super) fn stop(&mut self) {
        self.input = None;
    }

    /// How it has ended; none while it goes on.
    ///
    /// # Errors
    /// When the system refuses.
    pub(super) fn look(&mut self) -> Result<Option<End>, StoreError> {
        let status = self.child.try_wait();
        let status = status.map_err(StoreError::io("wait for", &self.program))?;
        Ok(status.map(|status| self.end(status)))
    }

    fn end(&mut self, status: ExitStatus) -> End {
        let joined = |text: Option<JoinHandle<String>>| {
            let joined = text.map(JoinHandle::join);
            joined.and_then(Result::ok).unwrap_or_default()
        };
        let (result, said) = (joined(self.result.take()), joined(self.said.take()));
        let told = |otherwise: String| match said.trim_end() {
            "" => otherwise,
            said => format!("{said}\n{otherwise}"),
        };
        match status.code() {
            Some(0) => End::Done(result.trim_end().to_owned()),
            Some(2) => End::BadInput(said.trim_end().to_owned()),
            Some(3) => End::Busy,
            Some(129 | 130 | 143) => End::Stopped { at_once: false },
            Some(code) => End::Broke(told(format!("the run ended with exit code {code}"))),
            None => match signal(status) {
                Some(1 | 2 | 15) => End::Stopped { at_once: true },
                Some(9) => End::Broke(told(
                    "the run was killed, as the system does when memory runs out".into(),
                )),
                number => {
                    let number = number.unwrap_or_default();
                    End::Broke(told(format!("the run was ended by signal {number}")))
                }
            },
        }
    }
}

/// Whether processes that are started from now on share an open file.
fn hand_down(file: &File, shared: bool) -> io::Result<()> {
    #[cfg(unix)]
    {
        use rustix::io::{FdFlags, fcntl_setfd};
        let flags = if shared {
            FdFlags::empty()
        } else {
            FdFlags::CLOEXEC
        };
        Ok(fcntl_setfd(file, flags)?)
    }
    #[cfg(not(unix))]
    {
        let _ = (file, shared);
        Ok(())
    }
}

#[cfg(unix)]
fn signal(status: ExitStatus) -> Option<i32> {
    std::os::unix::process::ExitStatusExt::signal(&status)
}

#[cfg(not(unix))]
fn signal(_: ExitStatus) -> Option<i32> {
    None
}

/// Reads what a process says until it ends, and keeps the last of it.
fn kept(stream: Option<impl Read + Send + 'static>) -> JoinHandle<String> {
    std::thread::spawn(move || {
        let mut all: Vec<u8> = Vec::new();
        let Some(mut stream) = stream else {
            return String::new();
        };
        let mut piece = [0; 4096];
        while let Ok(read @ 1..) = stream.read(&mut piece) {
            all.extend_from_slice(&piece[..read]);
            if all.len() > 2 * MOST_SAID {
                all.drain(..all.len() - MOST_SAID);
            }
        }
        let last = all.len().saturating_sub(MOST_SAID);
        String::from_utf8_lossy(&all[last..]).into_owned()
    })
}
