//! The events of a running sweep, for observers.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A step of a running sweep.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// A tile file, or a file beside the tiles, is damaged. What is lost is computed again.
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
        /// Cells that this run has to compute.
        left: u64,
        /// Threads that compute them.
        threads: usize,
    },
    /// A piece is computed and handed over.
    PieceDone {
        /// Its cells; 0 for a plane of curves or of best settings.
        cells: u64,
    },
    /// Everything that this run had to do is computed.
    Finished,
}

/// Receives the events of a sweep, on the thread that started it.
pub trait Observer {
    /// Handles an event.
    fn event(&self, event: &Event);
}

/// Who observes a run, and what stops it.
#[derive(Clone, Copy)]
pub struct Attended<'a> {
    /// Receives the events.
    pub observer: &'a dyn Observer,
    /// Once it is set, the run ends as soon as possible.
    pub stop: &'a Arc<AtomicBool>,
}

impl<'a> Attended<'a> {
    /// A run without an observer.
    #[must_use]
    pub fn silently(stop: &'a Arc<AtomicBool>) -> Self {
        Self {
            observer: &Silent,
            stop,
        }
    }
}

/// An observer that ignores all events.
pub struct Silent;

impl Observer for Silent {
    fn event(&self, _: &Event) {}
}
