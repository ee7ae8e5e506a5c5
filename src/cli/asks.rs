//! The needs of commands that ask about a point, which determine their flags.

/// The needs of a command that asks about a point.
pub(super) trait Asks {
    /// Whether it needs a whole friction law.
    const LAW: bool;
    /// Whether it searches for the delay, so that none is given.
    const SEARCHES_DELAY: bool;
}

/// Sliding, by a friction law or by the slope alone.
#[derive(Debug)]
pub(super) struct OfSliding;

impl Asks for OfSliding {
    const LAW: bool = false;
    const SEARCHES_DELAY: bool = false;
}

/// Sliding, at a delay that the command searches for.
#[derive(Debug)]
pub(super) struct AtAnyDelay;

impl Asks for AtAnyDelay {
    const LAW: bool = false;
    const SEARCHES_DELAY: bool = true;
}

/// Stick and slip, which needs a friction law.
#[derive(Debug)]
pub(super) struct OfStickSlip;

impl Asks for OfStickSlip {
    const LAW: bool = true;
    const SEARCHES_DELAY: bool = false;
}
