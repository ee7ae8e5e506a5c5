//! The needs of commands that ask about a point, which determine their flags.

/// The needs of a command that asks about a point.
pub(super) trait Asks {
    /// Whether it needs a whole friction law.
    const LAW: bool;
}

/// Sliding, by a friction law or by the slope alone.
#[derive(Debug)]
pub(super) struct OfSliding;

impl Asks for OfSliding {
    const LAW: bool = false;
}

/// Stick and slip, which needs a friction law.
#[derive(Debug)]
pub(super) struct OfStickSlip;

impl Asks for OfStickSlip {
    const LAW: bool = true;
}
