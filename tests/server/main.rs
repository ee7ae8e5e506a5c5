//! `slipmap serve` over real connections.

#[cfg(target_os = "linux")]
#[path = "../common/chance.rs"]
mod chance;
#[path = "../common/curve_files.rs"]
mod curve_files;
#[cfg(target_os = "linux")]
#[path = "../common/map.rs"]
mod map;
#[cfg(target_os = "linux")]
#[path = "../common/processes.rs"]
mod processes;
#[path = "../common/program.rs"]
mod program;
#[path = "../common/server.rs"]
mod server;

mod curves;
#[cfg(target_os = "linux")]
mod events;
#[cfg(target_os = "linux")]
mod jobs;
#[cfg(target_os = "linux")]
mod map_files;
mod openapi;
mod serve;
mod serve_maps;
mod systems;
mod traces;
#[cfg(target_os = "linux")]
mod visiting;

use std::sync::{Mutex, MutexGuard, PoisonError};

/// One test at a time that opens hundreds of connections: all tests together have as many files as
/// one process may open.
fn with_many_connections() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}
