//! Files that somebody made to do harm, and losses of power.
//!
//! No test here opens a map by slipmap's library: from then on HDF5 makes no external links in the
//! whole process, and the tests make some.

#[cfg(target_os = "linux")]
#[path = "../common/chance.rs"]
mod chance;
#[cfg(target_os = "linux")]
#[path = "../common/interposer.rs"]
mod interposer;
#[cfg(unix)]
#[path = "../common/limited.rs"]
mod limited;
#[path = "../common/map.rs"]
mod map;
#[path = "../common/program.rs"]
mod program;
#[cfg(unix)]
#[path = "../common/server.rs"]
mod server;

mod crash;
mod hostile;
