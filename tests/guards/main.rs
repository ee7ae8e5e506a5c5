//! What is to stay as it is while slipmap changes: the structure of its source, how few lines a
//! field, a parameter, a law or a command takes, and how much memory commands take.
//!
//! No test here takes much memory in this process: the system counts what a process held when it
//! started a command to that command.

#[cfg(all(feature = "cli", target_os = "linux"))]
#[path = "../common/limited.rs"]
mod limited;
#[cfg(all(feature = "cli", target_os = "linux"))]
#[path = "../common/program.rs"]
mod program;

#[cfg(feature = "cli")]
mod growth;
#[cfg(all(feature = "cli", target_os = "linux"))]
mod memory;
mod structure;
