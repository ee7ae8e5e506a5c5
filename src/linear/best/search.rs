//! What is searched: an equation over a box of two parameters p and q, everything else fixed. One
//! of them may be the delay.

use num_complex::Complex64;

use super::regions::Stretch;
use crate::linear::equation::Equation;
use crate::linear::newton::Root;
use crate::linear::spectrum::RootFinder;
use crate::model::stop::Stop;

/// A characteristic equation over the plane of two parameters p and q, on which it depends
/// smoothly.
pub trait Family {
    /// The equation at one place, but for the delay.
    type Setting;

    /// The delay at a place.
    fn delay(&self, place: Place) -> f64;

    /// The equation at a place; none where it has none.
    fn setting(&self, place: Place) -> Option<Self::Setting>;

    /// What roots are found of.
    fn equation(setting: &Self::Setting) -> impl Equation;

    /// D, D′, D″ and D‴.
    fn derivatives(setting: &Self::Setting, tau: f64, lambda: Complex64) -> [Complex64; 4];

    /// How D and D′ change with p and q.
    fn by_parameters(&self, place: Place, lambda: Complex64) -> Option<ByParameters>;

    /// ∂Re λ/∂p and ∂Re λ/∂q at a simple root λ.
    fn gradient(&self, place: Place, lambda: Complex64) -> Option<[f64; 2]>;

    /// The spectral abscissa at a place, or its supremum where roots accumulate; infinite where it
    /// is not known.
    fn abscissa(&self, finder: &mut RootFinder, place: Place) -> f64 {
        let Some(setting) = self.setting(place) else {
            return f64::INFINITY;
        };
        let equation = Self::equation(&setting);
        let roots = finder.rightmost(equation, self.delay(place), 1, f64::NEG_INFINITY);
        let first = roots.ok().and_then(|roots| roots.first());
        first.map_or(f64::INFINITY, |root| root.lambda.re)
    }

    /// The p at which the stable q may begin or end all at once. In no order, not all of them
    /// between those of `values`; only some of them once `stop` is set.
    fn breakpoints(&self, values: &[f64], stop: &Stop) -> Vec<f64>;

    /// The stable q of a p between the ends of `range`, rising, without what the box only touches.
    fn stretches(&self, p: f64, range: (f64, f64)) -> Vec<Stretch>;
}

/// How near, relative, to the line at which roots accumulate a line is taken for it. Where ρ is
/// nearly 1 or the delay nearly 0, one right of which nothing lies may be too far to say anything.
const CLOSE: f64 = 1e-3;

/// Whether the line Re λ = `line` is next to the one at which roots accumulate; never where they do
/// not accumulate.
pub(super) fn beside_essential(line: f64, essential: f64) -> bool {
    essential.is_finite() && line - essential <= CLOSE * essential.abs()
}

/// Derivatives of D and D′ with respect to p and q, at fixed λ.
#[derive(Debug, Clone, Copy)]
pub struct ByParameters {
    /// ∂D/∂p.
    pub p: Complex64,
    /// ∂D/∂q.
    pub q: Complex64,
    /// ∂D′/∂p.
    pub slope_p: Complex64,
    /// ∂D′/∂q.
    pub slope_q: Complex64,
}

/// A search for the settings of fastest decay; a delay in the unit of time of the family.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search<F> {
    /// The equation.
    pub family: F,
    /// The p to search, from ≤ to.
    pub p: (f64, f64),
    /// The q to search, from ≤ to; from 0 on where it is the delay.
    pub q: (f64, f64),
}

/// A place in the box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// p, such as a gain.
    pub p: f64,
    /// q, such as the delay.
    pub q: f64,
}

impl<F> Search<F> {
    /// The nearest place of the box.
    pub(super) fn clamp(&self, place: Place) -> Place {
        Place {
            p: place.p.clamp(self.p.0, self.p.1),
            q: place.q.clamp(self.q.0, self.q.1),
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
            p: snapped(place.p, self.p, lengths.0),
            q: snapped(place.q, self.q, lengths.1),
        }
    }

    /// p, and q, lies on an edge of the box.
    pub(super) fn on_edge(&self, place: Place) -> (bool, bool) {
        let on = |value: f64, (from, to): (f64, f64)| value <= from || value >= to;
        (on(place.p, self.p), on(place.q, self.q))
    }
}

/// Steps of counts, with latency, after which a search ends: half a minute at the most.
pub(super) const MOST_STEPS: u64 = 1 << 26;

/// Evaluates the spectral abscissa, keeping its memory from place to place.
#[derive(Debug, Default)]
pub(super) struct Evaluator {
    finder: RootFinder,
    stop: Stop,
}

impl Evaluator {
    /// An evaluator that knows nothing of any place once `stop` is set, or once so much was counted
    /// that the search has to end with what it has.
    pub(super) fn heeding(stop: &Stop) -> Self {
        Self {
            finder: RootFinder::default(),
            stop: stop.clone(),
        }
    }

    /// Whether the search is to end: nobody waits for it any more, or its work has come to its
    /// bound.
    pub(super) fn ended(&self) -> bool {
        self.stop.is_set() || self.finder.steps > MOST_STEPS
    }

    /// The largest real part of a root, right of which none is missed; infinite where roots could
    /// not be found, so that no search goes there.
    pub(super) fn abscissa(&mut self, search: &Search<impl Family>, place: Place) -> f64 {
        if self.ended() {
            return f64::INFINITY;
        }
        search.family.abscissa(&mut self.finder, place)
    }

    /// The rightmost roots, at least `wanted` counted with their pairs where there are so many;
    /// empty where they could not be found.
    pub(super) fn roots<F: Family>(
        &mut self,
        search: &Search<F>,
        place: Place,
        wanted: u64,
    ) -> &[Root] {
        let setting = search.family.setting(place).filter(|_| !self.ended());
        let Some(setting) = setting else {
            return &[];
        };
        self.finder
            .rightmost(
                F::equation(&setting),
                search.family.delay(place),
                wanted,
                f64::NEG_INFINITY,
            )
            .unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_accumulation_nothing_is_beside_it() {
        assert!(beside_essential(-0.257_1, -0.257_2));
        assert!(!beside_essential(-0.2, -0.257_2));
        assert!(!beside_essential(-0.2, f64::NEG_INFINITY));
        assert!(!beside_essential(f64::INFINITY, -0.257_2));
    }
}
