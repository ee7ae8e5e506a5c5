//! The speeds that a motion reaches, seen step by step.

use super::motion::{Event, Motion};
use super::outcome::Observer;

/// The smallest and the largest |ẋ| of motions that were watched, both in the same unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speeds {
    /// The smallest one, 0 where a block stops; infinite where nothing was watched.
    pub least: f64,
    /// The largest one; 0 where nothing was watched.
    pub most: f64,
}

impl Default for Speeds {
    /// Those of no motion.
    fn default() -> Self {
        Self {
            least: f64::INFINITY,
            most: 0.0,
        }
    }
}

impl Speeds {
    /// Those of both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            most: self.most.max(other.most),
        }
    }

    /// The same in another unit, by which the numbers grow `factor` times.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            least: self.least * factor,
            most: self.most * factor,
        }
    }
}

impl Observer for Speeds {
    fn step(&mut self, motion: &Motion, _: Option<Event>) {
        if motion.u.is_finite() {
            let [least, most] = motion.last_step().speeds([self.least, self.most]);
            *self = Self { least, most };
        }
    }
}
