//! What a running sweep tells whoever watches it.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

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
        /// Cells that this run has to compute.
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

/// Who follows a run, and what stops it.
#[derive(Clone, Copy)]
pub struct Attended<'a> {
    /// Takes note of what happens.
    pub observer: &'a dyn Observer,
    /// Once it is set, the run ends as soon as it can.
    pub stop: &'a Arc<AtomicBool>,
}

impl<'a> Attended<'a> {
    /// A run that nobody takes note of.
    #[must_use]
    pub fn silently(stop: &'a Arc<AtomicBool>) -> Self {
        Self {
            observer: &Silent,
            stop,
        }
    }
}

/// An observer that takes no note.
pub struct Silent;

impl Observer for Silent {
    fn event(&self, _: &Event) {}
}
