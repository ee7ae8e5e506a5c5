//! The real program in a folder of its own.

#![allow(dead_code, reason = "no test uses all of it")]

use std::path::Path;
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::sync::mpsc;
use std::time::Duration;

/// A command that is waited for takes at most these many seconds, on any machine.
pub(crate) const LONGEST: u32 = 1800;
/// What a test starts to stop it, or beside others, ends by itself after these many seconds.
const SOON: u32 = 120;

/// A folder of its own for one test.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        hand_down_no_ignored_signals();
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn with(files: &[(&str, &str)]) -> Self {
        let folder = Self::new();
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        folder
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_slipmap"));
        command
            .args(args)
            .current_dir(self.path())
            .env("NO_COLOR", "1")
            .env("COLUMNS", "100");
        command
    }

    pub(crate) fn run(&self, args: &[&str]) -> Output {
        output(&mut self.command(args))
    }

    /// Starts what is to be stopped, or to work beside something else.
    pub(crate) fn start(&self, args: &[&str]) -> Started {
        Started::of(&mut self.command(args))
    }

    /// The same of a line for the shell, in which `$slipmap` is the program. It is to end with
    /// `exec`, so that the shell becomes what is started.
    pub(crate) fn start_in_shell(&self, line: &str) -> Started {
        let mut shell = Command::new("sh");
        let program = env!("CARGO_BIN_EXE_slipmap");
        Started::of(
            shell
                .args(["-c", line])
                .env("slipmap", program)
                .current_dir(self.path()),
        )
    }

    /// Names of all files, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.path())
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

/// A command that was started. It ends with this, also where a test fails, and by itself where the
/// tests are killed.
pub(crate) struct Started(Option<Child>);

impl Started {
    /// What is soon stopped or done, with pipes for what it says.
    pub(crate) fn of(command: &mut Command) -> Self {
        Self::within(command, SOON)
    }

    /// What may take some seconds.
    pub(crate) fn within(command: &mut Command, seconds: u32) -> Self {
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        Self(Some(ends_within(command, seconds).spawn().unwrap()))
    }

    pub(crate) fn child(&mut self) -> &mut Child {
        self.0.as_mut().unwrap()
    }

    pub(crate) fn id(&self) -> u32 {
        self.0.as_ref().unwrap().id()
    }

    /// Whether it has not ended yet.
    pub(crate) fn goes_on(&mut self) -> bool {
        self.child().try_wait().unwrap().is_none()
    }

    /// Sends a signal, such as `-INT`.
    pub(crate) fn signal(&self, name: &str) {
        signal(self.id(), name);
    }

    /// Waits for its end.
    pub(crate) fn wait(&mut self) -> ExitStatus {
        self.child().wait().unwrap()
    }

    /// Waits for its end, and returns what it said.
    pub(crate) fn ended(mut self) -> Output {
        self.0.take().unwrap().wait_with_output().unwrap()
    }
}

impl Drop for Started {
    fn drop(&mut self) {
        if let Some(mut child) = self.0.take() {
            // It may have ended already.
            drop(child.kill());
            drop(child.wait());
        }
    }
}

/// Sends a signal, such as `-INT`, to a process.
pub(crate) fn signal(id: u32, name: &str) {
    // The shell's own kill: a bare machine has no other.
    let kill = format!("kill {name} {id}");
    let sent = Command::new("sh").args(["-c", &kill]).status().unwrap();
    assert!(sent.success(), "{kill}");
}

/// Has the system end a command after some seconds, even if nobody waits for it any more.
pub(crate) fn ends_within(command: &mut Command, seconds: u32) -> &mut Command {
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt;
        // SAFETY: between fork and exec nothing is called but these two, which may be called there.
        unsafe {
            command.pre_exec(move || {
                libc::signal(libc::SIGALRM, libc::SIG_DFL);
                libc::alarm(seconds);
                Ok(())
            });
        }
    }
    command
}

/// Runs a command to its end. One that takes longer than [`LONGEST`] is killed and fails the test.
pub(crate) fn output(command: &mut Command) -> Output {
    command.stdin(Stdio::null());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    let id = child.id();
    let (done, awaited) = mpsc::channel::<()>();
    let watch = std::thread::spawn(move || {
        let longest = Duration::from_secs(LONGEST.into());
        let late = awaited.recv_timeout(longest) == Err(mpsc::RecvTimeoutError::Timeout);
        if late {
            signal(id, "-KILL");
        }
        late
    });
    let output = child.wait_with_output().unwrap();
    drop(done);
    assert!(!watch.join().unwrap(), "{command:?} takes too long");
    output
}

/// From now on what this process starts has the usual action for every signal of a terminal.
/// `nohup` has SIGHUP ignored, and a shell's `&` SIGINT and SIGQUIT, which children take over. They
/// do not take over a handler, so those signals get one here that does nothing.
pub(crate) fn hand_down_no_ignored_signals() {
    #[cfg(unix)]
    {
        extern "C" fn nothing(_: libc::c_int) {}
        static ONCE: std::sync::Once = std::sync::Once::new();
        ONCE.call_once(|| {
            for name in [libc::SIGHUP, libc::SIGINT, libc::SIGQUIT, libc::SIGTERM] {
                let mut before = std::mem::MaybeUninit::<libc::sigaction>::zeroed();
                // SAFETY: the action before is asked for, and zeros are one; the handler does
                // nothing.
                unsafe {
                    libc::sigaction(name, std::ptr::null(), before.as_mut_ptr());
                    if before.assume_init().sa_sigaction == libc::SIG_IGN {
                        libc::signal(name, nothing as *const () as libc::sighandler_t);
                    }
                }
            }
        });
    }
}

/// Standard output.
pub(crate) fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// Standard error.
pub(crate) fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The JSON on standard output.
#[track_caller]
pub(crate) fn json(output: &Output) -> serde_json::Value {
    let read = serde_json::from_slice(&output.stdout);
    read.unwrap_or_else(|error| panic!("{error}: {}{}", out(output), err(output)))
}

/// It ended with this code and said this, on either stream, and did not panic.
#[track_caller]
pub(crate) fn expect(output: &Output, code: i32, says: &str) {
    let text = format!("{}{}", out(output), err(output));
    assert_eq!(output.status.code(), Some(code), "{text}");
    // Messages are wrapped to the terminal: compare words.
    let words = |text: &str| {
        text.split(|c: char| c.is_whitespace() || c == '│')
            .filter(|w| !w.is_empty())
            .collect::<Vec<_>>()
            .join(" ")
    };
    assert!(
        words(&text).contains(&words(says)),
        "expected {says:?} in\n{text}"
    );
    assert!(!text.contains("panicked"), "{text}");
}

/// The pixels of a picture, without the texts of its file.
pub(crate) fn pixels(png: &[u8]) -> Vec<u8> {
    let start = png.windows(4).position(|part| part == b"IDAT").unwrap();
    png[start..].to_vec()
}
