//! The course of a job that a worker has begun: a process of this machine, or an array of Slurm.

use super::attempt::{Attempt, End};
use super::slurm::Array;
use crate::store::StoreError;

/// What computes a job.
#[derive(Debug)]
pub(super) enum Course {
    /// A process that ends with the worker.
    Here(Attempt),
    /// An array, which goes on without it.
    Array(Array),
}

impl Course {
    /// Whether it goes on when the worker ends.
    pub(super) fn goes_on_alone(&self) -> bool {
        matches!(self, Self::Array(_))
    }

    /// Tells it to stop.
    pub(super) fn stop(&mut self) {
        match self {
            Self::Here(attempt) => attempt.stop(),
            Self::Array(array) => array.stop(),
        }
    }

    /// How it has ended; none while it goes on.
    ///
    /// # Errors
    /// When that cannot be told now.
    pub(super) fn look(&mut self) -> Result<Option<End>, StoreError> {
        match self {
            Self::Here(attempt) => attempt.look(),
            Self::Array(array) => array.look(),
        }
    }
}
