//! The result of a search by simulation.

use super::regime::{Regime, Response};
use crate::slip::motion::Motion;

/// What part chance had in a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Chance {
    /// Chance had no part.
    None,
    /// Irregular stick-slip or a jump was on the way.
    OnTheWay,
    /// Stick-slip survived again and again where it had been lost: it is lost by chance.
    AtEnd,
}

/// How a search by simulation ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ramped {
    /// The largest v0 at which stick-slip persists; none where it was not found anywhere.
    pub last: Option<Response>,
    /// The smallest v0 above `last` at which stick-slip does not persist; none where it persists to
    /// the end of the range.
    pub lost: Option<Response>,
    /// Whether the search came to the end of the range, or to two v0 as near as required.
    pub complete: bool,
    /// What part chance had in the search.
    pub chance: Chance,
    /// Whether sticks shorten so fast that none is left just beyond the last v0.
    pub vanish: bool,
    /// The relative step beyond the last v0 at which the depth of the stops is predicted to vanish;
    /// infinite where it is not.
    pub graze_step: f64,
}

impl Ramped {
    /// A search that found no v0 at which stick-slip persists.
    pub(super) fn none(lost: Option<Response>) -> Self {
        Self {
            last: None,
            lost,
            complete: true,
            chance: Chance::None,
            vanish: false,
            graze_step: f64::INFINITY,
        }
    }
}

/// A search by simulation, and the motion that it left at the largest v0 at which stick-slip
/// persists; none where it was not found anywhere.
#[derive(Debug, Clone)]
pub(super) struct Search {
    pub ramped: Ramped,
    pub motion: Option<Motion>,
    /// The largest step of v0, relative.
    pub step: f64,
}

impl Search {
    /// The largest v0 at which stick-slip persists; 0 where there is none.
    pub(super) fn persists(&self) -> f64 {
        self.ramped.last.map_or(0.0, |last| last.v0)
    }

    /// The v0 at which stick-slip was lost, or is not known to persist.
    pub(super) fn lost(&self) -> f64 {
        let lost = self.ramped.lost.map_or(0.0, |lost| lost.v0);
        lost.max(self.persists())
    }

    /// Whether the search ended by N ≤ 0.
    pub(super) fn lifts_off(&self) -> bool {
        let lost = self.ramped.lost.as_ref();
        lost.is_some_and(|lost| lost.regime == Regime::LiftOff)
    }
}
