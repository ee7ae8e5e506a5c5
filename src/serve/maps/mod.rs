//! Maps and traces from files: a list of those below a folder, windows on maps, motions of traces.
//!
//! ```text
//! maps::scan: names below the folder → ids → [list] what a process of each tells, remembered
//! [routes] request → [readers] → [places] the process that reads the map → [frames] → answer
//!          in that process: [child] → [description], [answers] → maps::look
//! ```
//!
//! The server itself opens no map, because a damaged one can end the process that reads it.
//!
//! - `answers`: windows, curves and cells as answers
//! - `child`: the side of the process that reads a map
//! - `described`: the types of answers about maps, with their descriptions
//! - `description`: the description of a map, besides its cells
//! - `file`: the file of a map, whole or in ranges
//! - `frames`: messages between the server and the process
//! - `handing`: the request that hands over a map
//! - `list`: the maps of a folder, each with the summary from a process of its own
//! - `places`: the processes that may run at a time
//! - `process`: the server's side of a process that reads a map
//! - `readers`: asks the processes that read maps
//! - `routes`: the addresses of requests about maps
//! - `test_reader`: a process for tests that can be held
//! - `traces`: the description and the motion of a trace as answers
//! - `visiting`: maps that are handed over to be looked at

mod answers;
mod child;
mod described;
mod description;
mod file;
mod frames;
mod handing;
mod list;
mod places;
mod process;
mod readers;
mod routes;
#[cfg(all(test, unix))]
mod test_reader;
mod traces;
mod visiting;

pub use child::read_map;
pub(super) use handing::is_visit;
pub use process::ReaderCommand;
pub(super) use readers::Maps;
pub(super) use routes::routes;
