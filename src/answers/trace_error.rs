//! Why there is no trace of a motion.

use crate::slip::case::CaseError;
use crate::slip::motion::MOST_KEPT;
use crate::text::{Shown, to_digits};

fn near(time: f64) -> Shown {
    const DIGITS: usize = 6;
    Shown(to_digits(time, DIGITS))
}

/// Why there is no trace.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TraceError {
    /// The model refuses the case.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// It would be too long.
    #[error("the trace would have more than {0} samples or events")]
    TooLong(usize),
    /// It has more events than allowed, its samples being thinned.
    #[error("the motion has more than {0} events")]
    TooManyEvents(usize),
    /// It takes more steps than allowed.
    #[error("what becomes of the motion is not known after {0} steps")]
    TooManySteps(u64),
    /// Two delays take more steps than are kept.
    #[error("two delays take more than {MOST_KEPT} steps, the most that are kept")]
    OutgrowsPast,
    /// The friction law has no coefficient where the block would be, after this time.
    #[error("friction has no coefficient above 0 at a speed of the block, at t = {}", near(*.0))]
    NoFriction(f64),
    /// It was stopped before it was complete.
    #[error("stopped")]
    Stopped,
}
