//! Maps from files: a list of those below a folder, and windows on them.
//!
//! ```text
//! [scan] names below the folder → ids → [list] what a process of each tells, remembered
//! [routes] request → [readers] → [places] the process that reads the map → [frames] → answer
//!          in that process: [child] → [description], [answers] → maps::look
//! ```
//!
//! This process opens no map: a damaged one can end who reads it.
//!
//! - `answers`: windows, curves and cells as answers
//! - `child`: its own side
//! - `described`: what is answered about maps, described where it is defined
//! - `description`: what a map tells of itself besides its cells
//! - `frames`: what passes between both
//! - `list`: what is known of each, told by a process of its own
//! - `places`: which processes there are at a time
//! - `process`: the server's side of such a process
//! - `readers`: what is asked of maps
//! - `routes`: what is answered about maps at which address
//! - `scan`: what may be a map below a folder, by names alone
//! - `test_reader`: a process for tests that can be held

mod answers;
mod child;
mod described;
mod description;
mod frames;
mod list;
mod places;
mod process;
mod readers;
mod routes;
mod scan;
#[cfg(all(test, unix))]
mod test_reader;

pub use child::read_map;
pub use process::ReaderCommand;
pub(super) use readers::Maps;
pub(super) use routes::routes;
