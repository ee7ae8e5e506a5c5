//! Maps from files: a list of those below a folder, and windows on them.
//!
//! ```text
//! [scan] names below the folder → ids → [list] what a process of each tells, remembered
//! [routes] request → [readers] → [places] the process that reads the map → [frames] → answer
//!          in that process: [child] → [description], [answers] → maps::look
//! ```
//!
//! This process opens no map: a damaged one can end who reads it.

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
