//! What a running sweep tells whoever watches it.

/// A step of a running sweep.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// The sweep starts.
    Started {
        /// Cells to compute.
        cells: u64,
        /// Threads that compute them.
        threads: usize,
    },
    /// The crossing curves are traced.
    BoundariesTraced {
        /// Pieces of curves.
        pieces: u64,
        /// Points where they meet.
        corners: u64,
        /// Planes without the curves of one degree of stability or more, because too many cross them to be traced.
        planes_left_out: u64,
    },
    /// The best settings are found.
    BestFound {
        /// In so many planes.
        planes: u64,
    },
    /// A tile is computed and handed over.
    TileDone {
        /// Its cells.
        cells: u64,
    },
    /// All tiles are done.
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
