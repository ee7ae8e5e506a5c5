//! What a running sweep tells whoever watches it.

use std::path::PathBuf;

/// A step of a running sweep.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// A file beside finished tiles, or of them, is not as it was written. What of it is lost is
    /// made again.
    Damaged {
        /// The file.
        file: PathBuf,
        /// What is wrong, in words.
        why: String,
    },
    /// The sweep starts.
    Started {
        /// Cells of the map.
        cells: u64,
        /// Those of them that this run has to compute.
        left: u64,
        /// Threads that compute them.
        threads: usize,
    },
    /// A piece is computed and handed over.
    PieceDone {
        /// Its cells; 0 where it is a plane of curves or best settings.
        cells: u64,
    },
    /// Everything that this run had to compute is computed.
    Finished,
}

/// Receives the events of a sweep, on the thread that started it.
pub trait Observer {
    /// Takes note of an event.
    fn event(&self, event: &Event);
}

/// An observer that takes no note.
pub struct Silent;

impl Observer for Silent {
    fn event(&self, _: &Event) {}
}
