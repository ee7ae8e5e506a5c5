//! A block on its spring whose gains, delay and slope of friction may be off.

use super::general::{MOST_STEPS, abscissa_of};
use super::letter::Letter;
use super::search::Place;
use crate::linear::general::RootCounter;
use crate::linear::margins::{AsCase, Beyond, Case, Changes, Radius, Setting, radius_within};
use crate::linear::spectrum::RootFinder;
use crate::model::Groups;
use crate::model::stop::Stop;

/// The settings among which a robust one is searched for; all numbers dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rig {
    /// Friction, dashpots and gains.
    pub letter: Letter,
    /// What the feedback has beyond the letter's own; none where that is nothing.
    pub beyond: Option<Beyond>,
}

impl From<Letter> for Rig {
    fn from(letter: Letter) -> Self {
        Self {
            letter,
            beyond: None,
        }
    }
}

impl Rig {
    /// The groups and the delay of a place with relative changes of both gains, the delay and the
    /// slope of friction.
    fn changed(&self, place: Place, changes: Changes) -> (Groups, f64) {
        let [k, delay, slope] = changes.map(|d| 1.0 + d);
        let Groups { a_v, a_n, .. } = self.letter.groups(place.p);
        let b = self.letter.slope() * slope + self.letter.dashpots.sum();
        (Groups::new(b, a_v * k, a_n * k), place.q * delay)
    }

    /// The spectral abscissa at a place with `changes`; infinite where it is not known. Where it is
    /// above `bound`, anything above that.
    pub(super) fn changed_abscissa(
        &self,
        finder: &mut RootFinder,
        (place, changes): (Place, Changes),
        bound: f64,
    ) -> f64 {
        let (groups, tau) = self.changed(place, changes);
        abscissa_at(self.beyond, finder, (groups, tau), bound)
    }

    /// The spectral abscissa at a place; infinite where it is not known.
    pub(super) fn abscissa(&self, finder: &mut RootFinder, place: Place) -> f64 {
        let groups = self.letter.groups(place.p);
        abscissa_at(self.beyond, finder, (groups, place.q), f64::INFINITY)
    }

    /// The stability radius at a place for the required decay rate `decay` ≥ 0, as a part of the
    /// relative changes `extents`; at most 1. Once `stop` is set it is told soon, and proves
    /// little.
    pub(super) fn radius(
        &self,
        place: Place,
        decay: f64,
        extents: [f64; 3],
        stop: &Stop,
    ) -> Radius {
        let setting = Setting {
            groups: self.letter.groups(place.p),
            tau: place.q,
            decay,
        };
        let still = self.letter.dashpots.sum();
        if let Some(beyond) = self.beyond {
            let mut case = Case::beyond(setting, beyond);
            case.heed(stop);
            return radius_within(&case, extents, still);
        }
        let mut case = setting.case();
        case.heed(stop);
        radius_within(&case, extents, still)
    }
}

/// The spectral abscissa of groups and a delay, with what the feedback has beyond the letter's own;
/// infinite where it is not known. Where it is above `bound`, anything above that.
pub(crate) fn abscissa_at(
    beyond: Option<Beyond>,
    finder: &mut RootFinder,
    (groups, tau): (Groups, f64),
    bound: f64,
) -> f64 {
    if let Some(beyond) = beyond {
        let system = beyond.of_groups(groups).system();
        let counter = RootCounter::new(&system).allowing(MOST_STEPS);
        return abscissa_of(&counter, finder, tau, bound);
    }
    let roots = finder.rightmost(groups, tau, 1, f64::NEG_INFINITY);
    let first = roots.ok().and_then(|roots| roots.first());
    first.map_or(f64::INFINITY, |root| root.lambda.re)
}
