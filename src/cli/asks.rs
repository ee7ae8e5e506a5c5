//! What commands ask of a point, and so which flags they can use.

/// What a command asks of a point, and so which flags it can use.
pub(super) trait Asks {
    /// Whether it needs a whole friction law.
    const LAW: bool;
    /// Whether it looks for the delay.
    const SEARCHES_DELAY: bool;
}

/// Sliding, by a friction law or by the slope alone.
#[derive(Debug)]
pub(super) struct OfSliding;

impl Asks for OfSliding {
    const LAW: bool = false;
    const SEARCHES_DELAY: bool = false;
}

/// Sliding, at a delay that is looked for.
#[derive(Debug)]
pub(super) struct AtAnyDelay;

impl Asks for AtAnyDelay {
    const LAW: bool = false;
    const SEARCHES_DELAY: bool = true;
}

/// Stick and slip, which a friction law says.
#[derive(Debug)]
pub(super) struct OfStickSlip;

impl Asks for OfStickSlip {
    const LAW: bool = true;
    const SEARCHES_DELAY: bool = false;
}
