//! The setting whose slowest decay over a box of changes is fastest.
//!
//! ```text
//! minimise over gain and delay   W = max abscissa(k = 1 + δ₁, τ (1 + δ₂), b (1 + δ₃)),
//!                                |δ_i| ≤ spread_i                                          (1)
//! ```
//!
//! k is the factor of both gains. The maximum is taken over corners and middles of the box, and
//! over every place of it that a proof of W turned out to need: the stability radius at the decay
//! rate −W either is at least the spread, or names a place in the box that decays more slowly, and
//! the search goes on with it.

use super::descend::descend;
use super::rig::Rig;
use super::search::{MOST_STEPS, Place, Search};
use super::{Best, Start, far_apart, lattice};
use crate::linear::margins::Changes;
use crate::linear::spectrum::RootFinder;
use crate::model::stop::Stop;

/// The radius, in units of the frame, to which a descent goes.
const FINE: f64 = 1e-6;
/// Slower decay than this is told only where it is proved, dimensionless.
pub(crate) const UNPROVED: f64 = 1e-8;
/// Places that a proof may add.
const MOST_PLACES: usize = 24;
/// The relative gap allowed between the proved W and the largest sampled one; the second value
/// where the first proof takes too long.
const SLACK: [f64; 2] = [1e-3, 1e-2];

/// A setting with the slowest decay around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robust {
    /// The searched gain.
    pub gain: f64,
    /// The delay.
    pub tau: f64,
    /// The spectral abscissa of the setting itself.
    pub abscissa: f64,
    /// W of (1): no setting of the box has a larger one, where that is `certified`.
    pub worst_abscissa: f64,
    /// Where in the box it is taken, or nearly so.
    pub worst_at: Changes,
    /// Whether W is proved.
    pub certified: bool,
}

/// The abscissa over a box around a place.
struct Worst<'s> {
    search: &'s Search<Rig>,
    spread: Changes,
    /// Where the abscissa is looked at; the place that was worst last comes first.
    places: Vec<Looked>,
    stop: &'s Stop,
}

/// A place of the box, where the roots found last lead to those of the next setting.
struct Looked {
    /// Where it is, in units of the spread.
    changes: Changes,
    finder: RootFinder,
}

impl Looked {
    fn at(changes: Changes) -> Self {
        Self {
            changes,
            finder: RootFinder::default(),
        }
    }
}

impl<'s> Worst<'s> {
    fn new(search: &'s Search<Rig>, spread: Changes, stop: &'s Stop) -> Self {
        let places = (0..27).map(|i| [i / 9, i / 3 % 3, i % 3].map(|n| f64::from(n) - 1.0));
        // What cannot be off is looked at in the middle alone.
        let places = places.filter(|at| (0..3).all(|i| spread[i] != 0.0 || at[i] == 0.0));
        Self {
            search,
            spread,
            places: places.map(Looked::at).collect(),
            stop,
        }
    }

    /// W and where it is taken; as soon as it is above `bound`, anything above that.
    fn at(&mut self, place: Place, bound: f64) -> (f64, Changes) {
        if self.ended() {
            return (f64::INFINITY, [0.0; 3]);
        }
        let (rig, spread) = (&self.search.family, self.spread);
        let mut worst = (f64::NEG_INFINITY, 0);
        for (i, Looked { changes, finder }) in self.places.iter_mut().enumerate() {
            let changes = scaled(changes, spread);
            let abscissa = rig.changed_abscissa(finder, (place, changes), bound);
            if abscissa > worst.0 {
                worst = (abscissa, i);
            }
            if abscissa > bound {
                break;
            }
        }
        let changes = self.places[worst.1].changes;
        self.places[..=worst.1].rotate_right(1);
        (worst.0, scaled(&changes, spread))
    }

    /// Whether the search is to end: nobody waits for it any more, or its work has come to its
    /// bound. Nothing is known of any place then.
    fn ended(&self) -> bool {
        let steps = self.places.iter().map(|looked| looked.finder.steps);
        self.stop.is_set() || steps.sum::<u64>() > MOST_STEPS
    }

    /// Goes down from a start.
    fn descend(&mut self, Start { place, frame, .. }: &Start, largest: f64) -> (Place, f64) {
        let search = self.search;
        let value = |place: Place, bound: f64| self.at(place, bound).0;
        descend(value, search, *place, frame, (largest, FINE))
    }

    /// A bound on W at `place` that is proved, or else a place of its box where W is larger.
    fn proved(&mut self, place: Place) -> Result<Option<f64>, Changes> {
        let (worst, _) = self.at(place, f64::INFINITY);
        for slack in SLACK.into_iter().filter(|_| worst < 0.0) {
            let line = worst * (1.0 - slack);
            let rig = &self.search.family;
            let radius = rig.radius(place, -line, self.spread, self.stop);
            if radius.proved >= 1.0 {
                return Ok(Some(line));
            }
            if let Some(changes) = radius.unstable {
                return Err(changes);
            }
        }
        Ok(None)
    }
}

/// Parts of a spread as relative changes.
fn scaled(parts: &Changes, spread: Changes) -> Changes {
    std::array::from_fn(|i| spread[i] * parts[i])
}

/// The largest abscissa over the box of changes around a setting, and whether that is proved;
/// infinite where it is not known. Once `stop` is set it means nothing.
#[must_use]
pub fn worst_around(
    search: &Search<Rig>,
    place: Place,
    spread: Changes,
    stop: &Stop,
) -> (f64, bool) {
    let mut worst = Worst::new(search, spread, stop);
    for _ in 0..MOST_PLACES {
        match worst.proved(place) {
            Ok(Some(bound)) => return (bound, true),
            Ok(None) => break,
            Err(changes) => worst.places.push(Looked::at(changes)),
        }
    }
    (worst.at(place, f64::INFINITY).0, false)
}

/// The most robust setting of the box of `search`, of those in the stable regions that `best` lists
/// for it; none where no setting stays stable. `spread` has the largest relative changes of gain,
/// delay and slope, those of gain and delay less than 1. Once `stop` is set, the answer comes soon
/// but is meaningless.
#[must_use]
pub fn robust(search: &Search<Rig>, best: &Best, spread: Changes, stop: &Stop) -> Option<Robust> {
    let mut worst = Worst::new(search, spread, stop);
    // No setting of a region is better than its best one.
    let mut regions: Vec<_> = best.regions.iter().collect();
    regions.sort_by(|p, q| p.best.abscissa.total_cmp(&q.best.abscissa));
    let mut found: Option<Start> = None;
    for region in regions {
        let lowest = found.as_ref().map_or(0.0, |start| start.value);
        if region.best.abscissa >= lowest {
            break;
        }
        let value = |place| worst.at(place, f64::INFINITY).0;
        for start in far_apart(lattice(&region.stretches, region.p, value)) {
            let (place, value) = worst.descend(&start, 1.0);
            if found.as_ref().is_none_or(|least| value < least.value) {
                found = Some(Start {
                    value,
                    place,
                    ..start
                });
            }
        }
    }
    let start = found.filter(|start| start.value < 0.0)?;
    let found = worst.refined(start);
    (found.certified || found.worst_abscissa < -UNPROVED).then_some(found)
}

impl Worst<'_> {
    /// Goes on from a start until W is proved there.
    fn refined(&mut self, mut start: Start) -> Robust {
        let mut proof = None;
        for _ in 0..MOST_PLACES {
            match self.proved(start.place) {
                Ok(bound) => {
                    proof = bound;
                    break;
                }
                Err(changes) => {
                    self.places.push(Looked::at(changes));
                    let (place, value) = self.descend(&start, 0.1);
                    start = Start {
                        value,
                        place,
                        ..start
                    };
                }
            }
        }
        let place = start.place;
        let (value, worst_at) = self.at(place, f64::INFINITY);
        Robust {
            gain: place.p,
            tau: place.q,
            abscissa: self.in_the_middle(place),
            worst_abscissa: proof.unwrap_or(value),
            worst_at,
            certified: proof.is_some(),
        }
    }

    /// The abscissa of a setting itself.
    fn in_the_middle(&mut self, place: Place) -> f64 {
        let middle = self.places.iter_mut().find(|at| at.changes == [0.0; 3]);
        let finder = middle.map(|looked| &mut looked.finder);
        finder.map_or(f64::INFINITY, |finder| {
            self.search.family.abscissa(finder, place)
        })
    }
}
