//! What is searched: one gain and the delay within a box, everything else fixed.

use crate::linear::gains::{load_gain_breakpoints, velocity_gain_breakpoints};
use crate::linear::newton::Root;
use crate::linear::spectrum::RootFinder;
use crate::model::Groups;

/// The gain that is searched; the other one stays as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchedGain {
    /// a_v, velocity control.
    Velocity,
    /// a_n, load control.
    Load,
}

/// A search for the settings of fastest decay; all numbers dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// b and the gain that stays fixed; the searched gain in it is not looked at.
    pub fixed: Groups,
    /// Which gain is searched.
    pub gain: SearchedGain,
    /// The gains to search, from ≤ to.
    pub gains: (f64, f64),
    /// The delays to search, 0 ≤ from ≤ to, in units of √(M/κ).
    pub delays: (f64, f64),
}

/// A place in the box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub gain: f64,
    pub tau: f64,
}

impl Search {
    /// The groups at a value of the searched gain.
    #[must_use]
    pub fn groups(&self, gain: f64) -> Groups {
        match self.gain {
            SearchedGain::Velocity => Groups {
                a_v: gain,
                ..self.fixed
            },
            SearchedGain::Load => Groups {
                a_n: gain,
                ..self.fixed
            },
        }
    }

    /// The gains at which crossings change their number, and 0, where control may vanish; see
    /// [`crate::linear::gains`]. In no order, not all of them in the box.
    #[must_use]
    pub fn breakpoints(&self) -> Vec<f64> {
        let Groups { b, a_v, a_n } = self.fixed;
        let mut points = match self.gain {
            SearchedGain::Velocity => velocity_gain_breakpoints(b, a_n),
            SearchedGain::Load => load_gain_breakpoints(b, a_v),
        };
        points.push(0.0);
        points.retain(|p| p.is_finite());
        points
    }

    /// The nearest place of the box.
    pub(super) fn clamp(&self, place: Place) -> Place {
        Place {
            gain: place.gain.clamp(self.gains.0, self.gains.1),
            tau: place.tau.clamp(self.delays.0, self.delays.1),
        }
    }

    /// `place` moved onto the edges of the box from which it is no farther than a hundredth of
    /// `lengths`.
    pub(super) fn nearest_edge(&self, place: Place, lengths: (f64, f64)) -> Place {
        let snapped = |value: f64, (from, to): (f64, f64), length: f64| {
            let near = |edge: &f64| (value - edge).abs() <= 0.01 * length;
            [from, to].into_iter().find(near).unwrap_or(value)
        };
        Place {
            gain: snapped(place.gain, self.gains, lengths.0),
            tau: snapped(place.tau, self.delays, lengths.1),
        }
    }

    /// The gain, and the delay, lies on an edge of the box.
    pub(super) fn on_edge(&self, place: Place) -> (bool, bool) {
        let on = |value: f64, (from, to): (f64, f64)| value <= from || value >= to;
        (on(place.gain, self.gains), on(place.tau, self.delays))
    }
}

/// Evaluates the spectral abscissa, keeping its memory from place to place.
#[derive(Debug, Default)]
pub(super) struct Evaluator {
    finder: RootFinder,
}

impl Evaluator {
    /// The largest real part of a root, right of which none is missed; infinite where roots could
    /// not be found, so that no search goes there.
    pub(super) fn abscissa(&mut self, search: &Search, place: Place) -> f64 {
        let roots = self.roots(search, place, 1);
        roots.first().map_or(f64::INFINITY, |r| r.lambda.re)
    }

    /// The rightmost roots, at least `wanted` counted with their pairs where there are so many;
    /// empty where they could not be found.
    pub(super) fn roots(&mut self, search: &Search, place: Place, wanted: u64) -> &[Root] {
        let groups = search.groups(place.gain);
        self.finder
            .rightmost(groups, place.tau, wanted, f64::NEG_INFINITY)
            .unwrap_or_default()
    }
}
