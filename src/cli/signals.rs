//! SIGINT, SIGTERM and SIGHUP: the first one stops a command in order, the second one at once.

use std::fmt::Display;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::{flag, low_level};

use super::failure::Failure;
use super::say;

/// Time between checks for a signal.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// The signals as flags.
pub(super) struct Signals {
    /// Whether a signal has come.
    pub stop: Arc<AtomicBool>,
    code: Arc<AtomicUsize>,
}

impl Signals {
    /// From now on signals do not end this process by themselves.
    ///
    /// # Errors
    /// When the system refuses.
    pub(super) fn catch() -> Result<Self, Failure> {
        let (stop, code) = (
            Arc::new(AtomicBool::new(false)),
            Arc::new(AtomicUsize::new(130)),
        );
        let refused = |error| {
            let message = format!("cannot catch signals: {error}");
            Failure::failed(message)
        };
        for (signal, exit_code) in [(SIGINT, 130), (SIGTERM, 143), (SIGHUP, 129)] {
            // `nohup` has the signal ignored; it stays so.
            if signal == SIGHUP && is_ignored(signal) {
                continue;
            }
            flag::register_conditional_shutdown(signal, exit_code, Arc::clone(&stop))
                .and_then(|_| flag::register_usize(signal, Arc::clone(&code), exit_code as usize))
                .and_then(|_| flag::register(signal, Arc::clone(&stop)))
                .map_err(refused)?;
        }
        Ok(Self { stop, code })
    }

    /// From now on the end of standard input stops this process as SIGTERM does. The signal that a
    /// system sends at the death of a parent would be a second one, which ends a run at once.
    ///
    /// # Errors
    /// When the system refuses.
    pub(super) fn stop_at_end_of_input(&self) -> Result<(), Failure> {
        let (stop, code) = (Arc::clone(&self.stop), Arc::clone(&self.code));
        let watch = move || {
            let _ = std::io::copy(&mut std::io::stdin().lock(), &mut std::io::sink());
            code.store(143, Ordering::Relaxed);
            stop.store(true, Ordering::Relaxed);
        };
        let refused = |error| Failure::failed(format!("cannot start a thread: {error}"));
        thread::Builder::new()
            .spawn(watch)
            .map(drop)
            .map_err(refused)
    }

    /// The end of a command that was stopped by a signal.
    pub(super) fn interrupted(&self, message: impl Display) -> Failure {
        Failure::Interrupted {
            message: format!("interrupted: {message}"),
            code: self.code.load(Ordering::Relaxed) as u8,
        }
    }

    /// [`Signals::interrupted`] if a signal has come, else `failure`.
    pub(super) fn or_stopped(&self, failure: Failure, message: impl Display) -> Failure {
        match self.stop.load(Ordering::Relaxed) {
            true => self.interrupted(message),
            false => failure,
        }
    }

    /// Does work that changes no file and cannot check a flag, such as a call of a library. A
    /// signal before or during the work ends the process with `message`.
    pub(super) fn or_end<T>(&self, message: impl Display, work: impl FnOnce() -> T) -> T {
        let busy = Arc::new(AtomicBool::new(true));
        let watch = Watch {
            stop: Arc::clone(&self.stop),
            code: Arc::clone(&self.code),
            busy: Arc::clone(&busy),
            message: format!("interrupted: {message}"),
        };
        watch.look();
        // Without a watcher, a signal is heeded once the work is done.
        let watcher = thread::Builder::new().spawn(move || watch.until_done());
        let done = work();
        if !busy.swap(false, Ordering::SeqCst) {
            // The process is ending, so the code after the work must not begin.
            loop {
                thread::park();
            }
        }
        if let Ok(watcher) = watcher {
            watcher.thread().unpark();
        }
        done
    }
}

/// Waits for a signal while other work is done.
struct Watch {
    stop: Arc<AtomicBool>,
    code: Arc<AtomicUsize>,
    /// The first to set it to false decides: the finished work, or the signal.
    busy: Arc<AtomicBool>,
    message: String,
}

impl Watch {
    fn until_done(&self) {
        while self.busy.load(Ordering::SeqCst) {
            self.look();
            thread::park_timeout(BETWEEN_LOOKS);
        }
    }

    fn look(&self) {
        if self.stop.load(Ordering::Relaxed) && self.busy.swap(false, Ordering::SeqCst) {
            say::remark(&self.message);
            // Exit without exit hooks: with them the HDF5 library would close files that the work
            // is reading.
            low_level::exit(self.code.load(Ordering::Relaxed) as i32);
        }
    }
}

/// Whether this process was started with a signal ignored.
fn is_ignored(signal: libc::c_int) -> bool {
    let mut action = std::mem::MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: with no new action sigaction only writes the present one, where it succeeds.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) == 0
            && action.assume_init().sa_sigaction == libc::SIG_IGN
    }
}
