//! Long work on a thread of its own. The calling thread looks for signals, and for a callback to
//! call, twenty times a second.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use slipmap::sweep::events::{Event, Observer};

/// How often signals are looked for.
const LOOK: Duration = Duration::from_millis(50);

/// The cells that are done, of all.
#[derive(Default)]
pub(crate) struct Done {
    done: AtomicU64,
    all: AtomicU64,
}

impl Observer for Done {
    fn event(&self, event: &Event) {
        match event {
            Event::Started { cells, left, .. } => {
                self.all.store(*cells, Ordering::Relaxed);
                self.done.store(cells - left, Ordering::Relaxed);
            }
            Event::PieceDone { cells } => {
                self.done.fetch_add(*cells, Ordering::Relaxed);
            }
            Event::Damaged { .. } | Event::Finished => {}
        }
    }
}

/// The result of `work`, which stops soon once its flag is set: after a signal, or when `progress`,
/// which is called with the cells done and all cells, raises an exception.
///
/// # Errors
/// That of the signal or of `progress`; a fault of slipmap is a `RuntimeError`.
pub(crate) fn wait<T: Send>(
    py: Python,
    progress: Option<&Bound<PyAny>>,
    work: impl FnOnce(&Arc<AtomicBool>, &Done) -> T + Send,
) -> PyResult<T> {
    let (stop, done) = (Arc::new(AtomicBool::new(false)), Done::default());
    let (caller, ended) = (thread::current(), AtomicBool::new(false));
    let at_work = || !ended.load(Ordering::Acquire);
    let tell = || match progress {
        Some(progress) => {
            let [done, all] = [&done.done, &done.all].map(|of| of.load(Ordering::Relaxed));
            progress.call1((done, all)).map(drop)
        }
        None => Ok(()),
    };
    let (found, looked) = thread::scope(|scope| {
        let working = scope.spawn(|| {
            let _ends = Ends(&ended, &caller);
            work(&stop, &done)
        });
        let mut looked = Ok(());
        while looked.is_ok() && at_work() {
            py.detach(|| thread::park_timeout(LOOK));
            looked = py.check_signals();
            if looked.is_ok() && at_work() {
                looked = tell();
            }
        }
        if looked.is_err() {
            stop.store(true, Ordering::Relaxed);
        }
        (py.detach(|| working.join()), looked)
    });
    looked?;
    let found = found.map_err(|_| PyRuntimeError::new_err("this is a fault of slipmap"))?;
    tell()?;
    Ok(found)
}

/// Tells a thread that the work has ended, however it did, when it is dropped.
struct Ends<'t>(&'t AtomicBool, &'t thread::Thread);

impl Drop for Ends<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
        self.1.unpark();
    }
}
