//! The corners of a programme of v0, and which of them are behind.

use crate::slip::programme::Corner;

/// Where v0 is on its way, in the units of a motion.
#[derive(Debug, Clone)]
pub(super) struct Course {
    pub corners: Box<[Corner]>,
    /// The index of the corner ahead.
    pub ahead: usize,
    /// The time of the last corner, or 0, and v0 from then on.
    pub from: (f64, f64),
}

impl Course {
    /// The time of the corner ahead; +∞ where there is none.
    pub(super) fn next(&self) -> f64 {
        self.corners.get(self.ahead).map_or(f64::INFINITY, |c| c.at)
    }

    /// The slope of v0 until the corner ahead.
    pub(super) fn slope(&self) -> f64 {
        let ahead = self.corners.get(self.ahead);
        ahead.map_or(0.0, |corner| corner.slope_from(self.from))
    }
}
