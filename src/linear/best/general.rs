//! Any system with one delay over a plane of one of its parameters and the delay.

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
/// Delays at which a line without a closed form is counted, and halvings of its ends.
const SAMPLES: u32 = 256;
const MOST_HALVINGS: u32 = 60;

/// A system at every gain and delay.
#[derive(Clone, Copy)]
pub struct General<'a> {
    /// The system at a gain and a delay; none where it has none.
    pub system_at: &'a dyn Fn(f64, f64) -> Option<System>,
    /// P and Q do not depend on the delay: the stable delays of a gain are known in closed form.
    pub lines: bool,
    /// The width of the gains that are searched.
    pub width: f64,
}

impl General<'_> {
    /// The line of delays of a gain; none where it has none.
    fn line(&self, gain: f64) -> Option<DelayLine> {
        let system = (self.system_at)(gain, 0.0)?;
        Some(DelayLine::of(&system))
    }

    /// How many frequencies there are at which pairs cross.
    fn crossings(&self, gain: f64) -> Option<usize> {
        let line = self.line(gain)?;
        Some(crossings(&line).count())
    }

    /// Where the number of crossings changes between two gains; at the first one it is `before`.
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
    fn stable(&self, gain: f64, tau: f64) -> bool {
        let counter = self.setting(Place { gain, tau });
        counter.is_some_and(|counter| counter.right_of(tau, 0.0) == RightOf::Roots(0))
    }

    /// The stable delays of a gain by counts at single delays: what lies between two of them is
    /// missed.
    fn sampled(&self, gain: f64, (from, to): (f64, f64)) -> Vec<(f64, f64)> {
        let delay = |i: u32| from + (to - from) * (f64::from(i) / f64::from(SAMPLES));
        let end = |mut stable: f64, mut other: f64| {
            for _ in 0..MOST_HALVINGS {
                let middle = 0.5 * (stable + other);
                if self.stable(gain, middle) {
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
            let tau = delay(i);
            match (self.stable(gain, tau), begun) {
                (true, None) if i == 0 => begun = Some(tau),
                (true, None) => begun = Some(end(tau, before)),
                (false, Some(start)) => {
                    found.push((start, end(before, tau)));
                    begun = None;
                }
                _ => {}
            }
            before = tau;
        }
        found.extend(begun.map(|start| (start, to)));
        found
    }

    /// D and D′ at a place.
    fn slopes(&self, place: Place, lambda: Complex64) -> Option<[Complex64; 2]> {
        let jet = (self.system_at)(place.gain, place.tau)?.jet(place.tau, lambda);
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

    /// ∂D/∂τ and ∂D′/∂τ.
    fn by_delay(&self, place: Place, lambda: Complex64) -> Option<[Complex64; 2]> {
        let Place { gain, tau } = place;
        if self.lines {
            // D depends on τ by E = e^(−λτ) alone: −λ Q E, and what d/dλ makes of it.
            let system = (self.system_at)(gain, tau)?;
            let [_, _, q, q_slope] = system.pair(lambda);
            let delayed = system.jet(tau, lambda).delayed;
            let slope = q + lambda * (q_slope - tau * q);
            return Some([-lambda * q * delayed, -slope * delayed]);
        }
        let h = DIFFERENCE * tau.min(1.0 / norm(lambda));
        self.quotient(
            |by| Place {
                gain,
                tau: tau + by,
            },
            h,
            lambda,
        )
    }
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
    let middle = stretch.at(0.5).tau;
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
        let system = (self.system_at)(place.gain, place.tau)?;
        let known = !matches!(system.class(), Class::DegreeUnknown | Class::Refused);
        known.then(|| RootCounter::new(&system).allowing(MOST_STEPS))
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
        let Place { gain, tau } = place;
        let scale = gain.abs().max(LEAST_SCALE * self.width);
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let along_gain = |by| Place {
            gain: gain + by,
            tau,
        };
        let [by_gain, slope_gain] = self.quotient(along_gain, DIFFERENCE * scale, lambda)?;
        let [by_tau, slope_tau] = self.by_delay(place, lambda)?;
        Some(ByParameters {
            gain: by_gain,
            tau: by_tau,
            slope_gain,
            slope_tau,
        })
    }

    fn gradient(&self, place: Place, lambda: Complex64) -> Option<[f64; 2]> {
        let by = self.by_parameters(place, lambda)?;
        let [_, slope] = self.slopes(place, lambda)?;
        Some([(-by.gain / slope).re, (-by.tau / slope).re])
    }

    fn abscissa(&self, finder: &mut RootFinder, place: Place) -> f64 {
        let Some(counter) = self.setting(place) else {
            return f64::INFINITY;
        };
        abscissa_of(&counter, finder, place.tau, f64::INFINITY)
    }

    /// The gains between which the number of crossings changes, halved until they are one, and 0,
    /// where control may vanish.
    fn breakpoints(&self, gains: &[f64], stop: &Stop) -> Vec<f64> {
        let mut points = vec![0.0];
        if self.lines {
            let counted: Vec<_> = gains
                .iter()
                .take_while(|_| !stop.is_set())
                .map(|&gain| (gain, self.crossings(gain)))
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

    fn stretches(&self, gain: f64, delays: (f64, f64)) -> Vec<Stretch> {
        if !self.lines {
            let found = self.sampled(gain, delays).into_iter();
            let cut = |interval| Stretch::cut(gain, interval, delays, (None, None));
            return found.filter_map(cut).collect();
        }
        let Some(line) = self.line(gain) else {
            return Vec::new();
        };
        line.stable_intervals_until(delays.1)
            .filter(|interval| interval.to >= delays.0)
            .take(MOST_STRETCHES)
            .filter_map(|interval| {
                let bounds = (bound(&line, interval.from), bound(&line, interval.to));
                Stretch::cut(gain, (interval.from, interval.to), delays, bounds)
            })
            .filter(|stretch| !in_doubt(&line, stretch))
            .collect()
    }
}
