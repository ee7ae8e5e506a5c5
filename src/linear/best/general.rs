//! Any system with one delay over a plane of one of its parameters and the delay, or of two of its
//! parameters.

use num_complex::Complex64;

use super::regions::{Bound, MOST_STRETCHES, Stretch};
use super::search::{ByParameters, Family, Place, beside_essential};
use crate::linear::MarginalTolerance;
use crate::linear::crossing::Direction;
use crate::linear::equation::Equation;
use crate::linear::general::rightmost::{beside_accumulation, nothing_beyond_accumulation};
use crate::linear::general::{Class, DelayLine, RightOf, RootCounter, System};
use crate::linear::spectrum::RootFinder;
use crate::model::elementary::norm;
use crate::model::stop::Stop;

/// Steps of difference quotients, over the scale on which D changes. They are of fourth order, so
/// that both their own error and rounding stay near 1e-12.
const DIFFERENCE: f64 = 1e-3;
/// The least scale of a gain, over the width of what is searched.
const LEAST_SCALE: f64 = 1e-2;
/// Steps of counts at one place: where they take more, nothing is known of it.
pub(super) const MOST_STEPS: u64 = 1 << 17;
/// Places at which a line without a closed form is counted, and halvings of its ends.
const SAMPLES: u32 = 256;
const MOST_HALVINGS: u32 = 60;

/// A system at every place of a plane.
#[derive(Clone, Copy)]
pub struct General<'a> {
    /// The system at p and q; none where it has none.
    pub system_at: &'a dyn Fn(f64, f64) -> Option<System>,
    /// What q is.
    pub across: Across,
    /// The width of the p that are searched.
    pub width: f64,
}

/// What the second parameter of a plane is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Across {
    /// The delay.
    Delay {
        /// P and Q do not depend on it: the stable delays of a p are known in closed form.
        lines: bool,
    },
    /// Another parameter.
    Parameter {
        /// The delay of all places, dimensionless.
        tau: f64,
        /// The width of the q that are searched.
        width: f64,
    },
}

impl General<'_> {
    /// Whether each p is a line of delays with a closed form.
    fn has_lines(&self) -> bool {
        self.across == Across::Delay { lines: true }
    }

    /// The line of delays of a p; none where it has none.
    fn line(&self, p: f64) -> Option<DelayLine> {
        let system = (self.system_at)(p, 0.0)?;
        Some(DelayLine::of(&system))
    }

    /// How many frequencies there are at which pairs cross.
    fn crossings(&self, p: f64) -> Option<usize> {
        let line = self.line(p)?;
        Some(crossings(&line).count())
    }

    /// Where the number of crossings changes between two p; at the first one it is `before`.
    fn breakpoint(&self, (mut from, mut to): (f64, f64), before: Option<usize>) -> f64 {
        for _ in 0..MOST_HALVINGS {
            let middle = 0.5 * (from + to);
            if self.crossings(middle) == before {
                from = middle;
            } else {
                to = middle;
            }
        }
        0.5 * (from + to)
    }

    /// Whether no root is right of the axis.
    fn stable(&self, place: Place) -> bool {
        let counter = self.setting(place);
        let tau = self.delay(place);
        counter.is_some_and(|counter| counter.right_of(tau, 0.0) == RightOf::Roots(0))
    }

    /// The stable q of a p by counts at single places: what lies between two of them is missed.
    fn sampled(&self, p: f64, (from, to): (f64, f64)) -> Vec<(f64, f64)> {
        let stable_at = |q: f64| self.stable(Place { p, q });
        let value = |i: u32| from + (to - from) * (f64::from(i) / f64::from(SAMPLES));
        let end = |mut stable: f64, mut other: f64| {
            for _ in 0..MOST_HALVINGS {
                let middle = 0.5 * (stable + other);
                if stable_at(middle) {
                    stable = middle;
                } else {
                    other = middle;
                }
            }
            stable
        };
        let mut found: Vec<(f64, f64)> = Vec::new();
        let (mut before, mut begun) = (from, None);
        for i in 0..=SAMPLES {
            let q = value(i);
            match (stable_at(q), begun) {
                (true, None) if i == 0 => begun = Some(q),
                (true, None) => begun = Some(end(q, before)),
                (false, Some(start)) => {
                    found.push((start, end(before, q)));
                    begun = None;
                }
                _ => {}
            }
            before = q;
        }
        found.extend(begun.map(|start| (start, to)));
        found
    }

    /// D and D′ at a place.
    fn slopes(&self, place: Place, lambda: Complex64) -> Option<[Complex64; 2]> {
        let jet = (self.system_at)(place.p, place.q)?.jet(self.delay(place), lambda);
        Some([jet.value, jet.first])
    }

    /// The change of D and D′ with a shift of the place, by a step `h` of it.
    fn quotient(
        &self,
        shifted: impl Fn(f64) -> Place,
        h: f64,
        lambda: Complex64,
    ) -> Option<[Complex64; 2]> {
        let at = |steps: f64| self.slopes(shifted(steps * h), lambda);
        let [near, far] = [1.0, 2.0].map(|steps| Some((at(steps)?, at(-steps)?)));
        let (near, far) = (near?, far?);
        Some([0, 1].map(|i| (8.0 * (near.0[i] - near.1[i]) - (far.0[i] - far.1[i])) / (12.0 * h)))
    }

    /// ∂D/∂p and ∂D′/∂p.
    fn by_p(&self, place: Place, lambda: Complex64) -> Option<[Complex64; 2]> {
        let shifted = |by| Place {
            p: place.p + by,
            ..place
        };
        self.quotient(shifted, difference(place.p, self.width), lambda)
    }

    /// ∂D/∂q and ∂D′/∂q.
    fn by_q(&self, place: Place, lambda: Complex64) -> Option<[Complex64; 2]> {
        let tau = self.delay(place);
        if self.has_lines() {
            // D depends on τ by E = e^(−λτ) alone: −λ Q E, and what d/dλ makes of it.
            let system = (self.system_at)(place.p, tau)?;
            let [_, _, q, q_slope] = system.pair(lambda);
            let delayed = system.jet(tau, lambda).delayed;
            let slope = q + lambda * (q_slope - tau * q);
            return Some([-lambda * q * delayed, -slope * delayed]);
        }
        let h = match self.across {
            Across::Delay { .. } => DIFFERENCE * tau.min(1.0 / norm(lambda)),
            Across::Parameter { width, .. } => difference(place.q, width),
        };
        let shifted = |by| Place {
            q: place.q + by,
            ..place
        };
        self.quotient(shifted, h, lambda)
    }
}

/// The step of difference quotients along a parameter with this value, of which a range of this
/// width is searched.
fn difference(value: f64, width: f64) -> f64 {
    let scale = value.abs().max(LEAST_SCALE * width);
    DIFFERENCE * if scale > 0.0 { scale } else { 1.0 }
}

/// The spectral abscissa of the system of `counter` at the delay `tau`, or its supremum where roots
/// accumulate; infinite where it is not known. Where it is above `bound`, anything above that.
pub(super) fn abscissa_of(
    counter: &RootCounter,
    finder: &mut RootFinder,
    tau: f64,
    bound: f64,
) -> f64 {
    let system = counter.system();
    if tau > 0.0 && system.class() == Class::Infinite {
        return f64::INFINITY;
    }
    let found = finder.abscissa_up_to(counter, tau, bound);
    finder.steps += counter.steps();
    match found {
        Ok(found) => return found,
        Err(_) if tau == 0.0 => return f64::INFINITY,
        Err(_) => {}
    }
    // It may be that no root lies right of where they accumulate. This is asked last: so near
    // to that line a count takes long.
    let essential = system.essential_abscissa(tau);
    let close = |line: f64| beside_essential(line, essential);
    let close = beside_accumulation(system, tau).is_some_and(close);
    let before = counter.steps();
    let nothing = close && nothing_beyond_accumulation(counter, tau).is_some();
    finder.steps += counter.steps() - before;
    if nothing { essential } else { f64::INFINITY }
}

/// The crossings of a line by falling frequency, touches left aside.
fn crossings(line: &DelayLine) -> impl Iterator<Item = &crate::linear::Crossing> {
    let crossings = line.crossings.iter();
    crossings.filter(|c| c.direction != Direction::Touch)
}

/// Whether rounding leaves open what holds in the middle of a stretch: there roots may cross at
/// frequencies that are not told apart.
fn in_doubt(line: &DelayLine, stretch: &Stretch) -> bool {
    let middle = stretch.at(0.5).q;
    line.count(middle, MarginalTolerance::default()).marginal
}

/// The crossing at the delay `tau`, if one is there.
fn bound(line: &DelayLine, tau: f64) -> Option<Bound> {
    crossings(line).enumerate().find_map(|(i, crossing)| {
        let branch = crossing.branch_at(tau);
        // A phase of 0 or of 2π, which rounding does not tell apart, has the same passages.
        (crossing.delay(branch) == tau).then(|| (i, branch - crossing.first_branch))
    })
}

impl Family for General<'_> {
    type Setting = RootCounter;

    fn setting(&self, place: Place) -> Option<RootCounter> {
        let system = (self.system_at)(place.p, place.q)?;
        let known = !matches!(system.class(), Class::DegreeUnknown | Class::Refused);
        known.then(|| RootCounter::new(&system).allowing(MOST_STEPS))
    }

    fn delay(&self, place: Place) -> f64 {
        match self.across {
            Across::Delay { .. } => place.q,
            Across::Parameter { tau, .. } => tau,
        }
    }

    fn equation(setting: &RootCounter) -> impl Equation {
        setting
    }

    fn derivatives(setting: &RootCounter, tau: f64, lambda: Complex64) -> [Complex64; 4] {
        let system = setting.system();
        let jet = system.jet(tau, lambda);
        let h = DIFFERENCE / (tau + system.latency() + 1.0 / (1.0 + norm(lambda)));
        let bend = |by: f64| system.jet(tau, lambda + by).second;
        let third = (bend(h) - bend(-h)) / (2.0 * h);
        [jet.value, jet.first, jet.second, third]
    }

    fn by_parameters(&self, place: Place, lambda: Complex64) -> Option<ByParameters> {
        let [p, slope_p] = self.by_p(place, lambda)?;
        let [q, slope_q] = self.by_q(place, lambda)?;
        Some(ByParameters {
            p,
            q,
            slope_p,
            slope_q,
        })
    }

    fn gradient(&self, place: Place, lambda: Complex64) -> Option<[f64; 2]> {
        let by = self.by_parameters(place, lambda)?;
        let [_, slope] = self.slopes(place, lambda)?;
        Some([(-by.p / slope).re, (-by.q / slope).re])
    }

    fn abscissa(&self, finder: &mut RootFinder, place: Place) -> f64 {
        let Some(counter) = self.setting(place) else {
            return f64::INFINITY;
        };
        abscissa_of(&counter, finder, self.delay(place), f64::INFINITY)
    }

    /// The p between which the number of crossings changes, halved until they are one, and 0, where
    /// control may vanish.
    fn breakpoints(&self, values: &[f64], stop: &Stop) -> Vec<f64> {
        let mut points = vec![0.0];
        if self.has_lines() {
            let counted: Vec<_> = values
                .iter()
                .take_while(|_| !stop.is_set())
                .map(|&p| (p, self.crossings(p)))
                .collect();
            for pair in counted.windows(2).take_while(|_| !stop.is_set()) {
                let [(from, before), (to, after)] = [pair[0], pair[1]];
                if before != after {
                    points.push(self.breakpoint((from, to), before));
                }
            }
        }
        points
    }

    fn stretches(&self, p: f64, range: (f64, f64)) -> Vec<Stretch> {
        if !self.has_lines() {
            let found = self.sampled(p, range).into_iter();
            let cut = |interval| Stretch::cut(p, interval, range, (None, None));
            return found.filter_map(cut).collect();
        }
        let Some(line) = self.line(p) else {
            return Vec::new();
        };
        line.stable_intervals_until(range.1)
            .filter(|interval| interval.to >= range.0)
            .take(MOST_STRETCHES)
            .filter_map(|interval| {
                let bounds = (bound(&line, interval.from), bound(&line, interval.to));
                Stretch::cut(p, (interval.from, interval.to), range, bounds)
            })
            .filter(|stretch| !in_doubt(&line, stretch))
            .collect()
    }
}
