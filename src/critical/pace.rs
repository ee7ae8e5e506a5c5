//! How stick-slip is followed while v0 is raised, and what it comes to.

use crate::slip::outcome::{Outcome, Summary};

/// How stick-slip is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// The first relative step of v0.
    pub first: f64,
    /// The largest one.
    pub largest: f64,
    /// The largest one where cycles do not show whether stick-slip is of the same kind.
    pub unseen: f64,
    /// The last relative step: v_c is known to it.
    pub last: f64,
    /// Up to this v0, in the units of a motion, v0 glides: it is held for a few cycles only, and
    /// what stick-slip comes to there is not waited for. 0 where every v0 is held.
    pub glide: f64,
    /// The most v0 that are tried.
    pub trials: u32,
    /// v0 up to which stick-slip is followed, in units of μ_S N0/√(κM).
    pub v_max: f64,
    /// How well cycles have to repeat near the end, relative.
    pub repeated: f64,
    /// The most steps of the integrator at one v0.
    pub steps: u64,
    /// The most at all v0 together: some seconds.
    pub total_steps: u64,
    /// Whether the search ends where stick-slip has come to repeat.
    pub until_periodic: bool,
    /// Whether every loss of stick-slip is waited for until the outcome of the motion is known.
    /// Else it counts once the minima of ẋ no longer fall, and only the last one is waited for
    /// longer.
    pub patient: bool,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            first: 0.6,
            largest: 0.6,
            unseen: 0.1,
            repeated: 1e-6,
            last: 1e-6,
            glide: 0.0,
            trials: 400,
            v_max: 100.0,
            steps: 50_000,
            total_steps: 3_000_000,
            until_periodic: false,
            patient: false,
        }
    }
}

/// What stick-slip came to at one v0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fate {
    /// Periodic stick-slip.
    Periodic,
    /// It sticks again and again, in cycles that did not come to repeat.
    Irregular,
    /// N ≤ 0.
    LiftOff,
    /// It slips on and on, and comes no nearer to a stop.
    Slips,
    /// It sticks no more, or something else became of it.
    Lost(Outcome),
}

/// Stick-slip at one v0, followed to its fate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sustained {
    /// v0.
    pub v0: f64,
    /// What it came to.
    pub fate: Fate,
    /// The motion's summary.
    pub summary: Summary,
    /// Time from the shallowest stop of the last period to where it would have gone, see
    /// [`crate::slip::step::Step::minimum_beyond_stop`].
    pub to_minimum: f64,
    /// Depth of that.
    pub depth: f64,
}

impl Sustained {
    /// Whether it and `other` are periodic with as many slips in a period.
    pub(super) fn alike(&self, other: &Self) -> bool {
        let periodic = |s: &Self| s.fate == Fate::Periodic;
        periodic(self) && periodic(other) && self.summary.slips == other.summary.slips
    }

    /// Whether stick-slip persists.
    #[must_use]
    pub fn persists(&self) -> bool {
        matches!(self.fate, Fate::Periodic | Fate::Irregular)
    }
}

/// How a search by simulation ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Followed {
    /// The largest v0 at which stick-slip persists; none where it was not found anywhere.
    pub last: Option<Sustained>,
    /// The smallest v0, above it, at which it does not; none where it persists to the end of the
    /// range.
    pub lost: Option<Sustained>,
    /// Whether the search came to its end: to the end of the range, or to two v0 as near as asked
    /// for.
    pub complete: bool,
    /// Whether stick-slip survived again and again where it had been lost: it is thrown off by
    /// chance.
    pub creeps: bool,
    /// Whether sticks become shorter such that none is left just beyond the last v0.
    pub vanish: bool,
    /// The relative way beyond the last v0 to where the depth of the stops is expected to vanish;
    /// infinite where it is not.
    pub graze_way: f64,
}
