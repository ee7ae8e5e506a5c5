//! What is timed, or killed and stopped amid its work: one test at a time, with nothing beside it.

#[cfg(unix)]
#[path = "../common/chance.rs"]
mod chance;
#[cfg(target_os = "linux")]
#[path = "../common/interposer.rs"]
mod interposer;
#[cfg(unix)]
#[path = "../common/map.rs"]
mod map;
#[cfg(target_os = "linux")]
#[path = "../common/processes.rs"]
mod processes;
#[cfg(unix)]
#[path = "../common/program.rs"]
mod program;
#[cfg(target_os = "linux")]
#[path = "../common/queue_files.rs"]
mod queue_files;
#[cfg(target_os = "linux")]
#[path = "../common/server.rs"]
mod server;

mod faults;
mod overnight;
#[cfg(target_os = "linux")]
mod queue;
mod serve_beside;
#[cfg(target_os = "linux")]
mod serve_busy;
mod shared_v0;
mod stops;

use std::sync::{Mutex, MutexGuard, PoisonError};

/// One test at a time: they are timed, and a child that is just being started would hold the locks
/// of another test's maps.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}
