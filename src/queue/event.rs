//! What a worker tells of itself.

use std::time::Duration;

use super::progress::Progress;

/// What a worker does.
#[derive(Debug)]
pub(crate) enum Event<'a> {
    /// Nothing waits that it may take.
    Idle,
    /// A run starts; how, if not as a process of this worker.
    Starts(&'a str),
    /// The map is complete; what the run said of it.
    Done(&'a str),
    /// The sweep has failed.
    Failed(&'a str),
    /// The run broke off and is tried again after this time.
    Again(&'a str, Duration),
    /// The sweep was taken out of the queue.
    TakenOut,
    /// How far the map is, now and then.
    Goes(&'a Progress),
    /// The sweep waits, though nobody works on it.
    Waits(&'a str),
    /// Something else is in the way.
    Trouble(&'a str),
}

/// The sweeps that a worker has brought to an end.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Brought {
    /// Maps that are complete.
    pub done: u64,
    /// Sweeps that failed.
    pub failed: u64,
}
