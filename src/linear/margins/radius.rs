//! The stability radius: the largest box of relative changes of gain, delay and slope (or sliding
//! velocity) in which every setting is stable.
//!
//! ```text
//! gains k = 1 + e₁δ₁,  delay τ (1 + e₂δ₂),  slope b (1 + e₃δ₃) or velocity v0 (1 + e₃δ₃)    (1)
//! radius = inf max |δ_i|  over all δ for which D(−σ + iω) = 0 at some ω ≥ 0                 (2)
//! ```
//!
//! The extents e_i are 1, or those of a box that is no cube; where one is 0, that parameter is
//! fixed.
//!
//! The centre is stable and roots move continuously, so inside (2) no root comes to the line.
//! Boxes of ω, δ₁ and δ₃ are taken by their least max |δ_i|, δ₂ among them by the delays at which
//! a root may be on the line there. One on which D cannot vanish is dropped, another halved.
//! Settings that are not stable bound the radius from above; when the box that is next is nearly as
//! far away as the nearest of them, its distance is a radius that is proved.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::crossing_delays::Delays;
use super::equations::OnLine;
use super::setting::Setting;
use super::surroundings::{ALL, Changes, DELAY, JUMP, Sides, Surroundings, largest};
use crate::model::elementary::exp;

/// How many times D is enclosed before the best proof so far has to do: a part of a second, and the
/// same proof on every machine.
const MOST_WORK: u32 = 1 << 19;
/// The proved radius is at least this part of the distance of a setting that is not stable.
const TIGHT: f64 = 0.995;
/// A radius, proved, and what is not stable just beyond it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Radius {
    /// Every setting whose parameters differ by less than this part of their extents is stable. At
    /// most 1.
    pub proved: f64,
    /// The changes to a setting that is not stable, or one of whose roots is on the line within
    /// rounding: at most one per cent farther away, unless the search was given up. None where
    /// there is none up to 1.
    pub unstable: Option<Changes>,
    /// Which of the three parameters are 0 and stay so.
    pub fixed: [bool; 3],
    /// Whether the radius is within one per cent of the largest there is.
    pub tight: bool,
}

impl Radius {
    /// A radius that is not known.
    pub(crate) const UNKNOWN: Self = Self {
        proved: f64::NAN,
        unstable: None,
        fixed: [false; 3],
        tight: false,
    };
}

/// The largest radius that is looked for.
const LARGEST: f64 = 1.0;
/// A side of a box matters by its own width up to so many times what D's zeros move along it.
const MATTERS: f64 = 8.0;
/// Boxes end at this part of a change of the delay at which roots accumulate at the line.
const BEFORE_ACCUMULATION: f64 = 1.0 - 1e-3;
/// Boxes end at this part of a change of the velocity to rest where slopes have no bound there.
const BEFORE_REST: f64 = 1.0 - 1e-3;
/// Jumps of the slope lie within this part of their distance.
const CONFINED: f64 = 1e-3;
#[derive(Debug, Clone, Copy)]
struct Part {
    /// The least max |δ_i| at which D may vanish.
    distance: f64,
    sides: Sides,
    /// The variable along which the box is to be halved.
    variable: usize,
    /// ω and changes at which D may be near 0.
    candidate: Option<[f64; 4]>,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    /// The nearest is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |part: &Self| part.sides.map(|side| side.0);
        let by_distance = other.distance.total_cmp(&self.distance);
        key(other)
            .into_iter()
            .zip(key(self))
            .fold(by_distance, |order, (o, s)| order.then(o.total_cmp(&s)))
    }
}

impl<L: OnLine> Surroundings<'_, L> {
    /// The stability radius of a setting that is stable.
    pub(super) fn radius(&self) -> Radius {
        let fixed = self.fixed();
        let of_delay = self.extents[1];
        let last = self.accumulation().map(|change| change / of_delay);
        let last = last.filter(|last| *last <= LARGEST);
        let mut unstable = self
            .nearest_along_directions(fixed, last.unwrap_or(LARGEST))
            .or_else(|| last.map(|change| [0.0, change, 0.0]));
        let mut bound = unstable.map_or(LARGEST, largest);
        // At the delay where roots accumulate at the line none of them is the highest.
        let mut most = last.map_or(bound, |last| bound.min(BEFORE_ACCUMULATION * last));
        // Nor is one where friction is infinitely steep, at rest.
        if self.highest(most).is_infinite() {
            most *= BEFORE_REST;
        }
        let side = |fixed: bool| if fixed { (0.0, 0.0) } else { (-most, most) };
        let [gain, delay, third] = fixed.map(side);
        let whole = [
            (0.0, self.highest(most)),
            gain,
            delay,
            third,
            self.slopes(most),
        ];
        let mut parts: BinaryHeap<Part> = self.part(whole, 0.0).into_iter().collect();
        let (mut proved, mut work) = (0.0, 0);
        loop {
            let Some(part) = parts.pop().filter(|part| part.distance < bound) else {
                proved = bound.min(most);
                break;
            };
            proved = part.distance.max(proved);
            // Where nothing is known not to be stable, all of the box is proved.
            if work > MOST_WORK
                || self.case.stopped()
                || (unstable.is_some() && proved >= TIGHT * bound)
            {
                break;
            }
            let middle = |(from, to): (f64, f64)| 0.5 * (from + to);
            let here = [middle(part.sides[1]), 0.0, middle(part.sides[3])];
            let found = self.not_stable_near(here, part.candidate, bound, &mut work);
            if let Some(found) = found.filter(|found| largest(*found) < bound) {
                bound = largest(found);
                unstable = Some(found);
            }
            let (from, to) = part.sides[part.variable];
            let middle = 0.5 * (from + to);
            for side in [(from, middle), (middle, to)] {
                let mut sides = part.sides;
                sides[part.variable] = side;
                work += 1;
                parts.extend(self.part(sides, part.distance));
            }
        }
        let proved = f64::min(proved, bound);
        Radius {
            proved,
            unstable,
            fixed,
            tight: proved >= TIGHT * bound,
        }
    }

    /// The relative change of the delay at which infinitely many roots come to the line; none where
    /// they never do.
    fn accumulation(&self) -> Option<f64> {
        let Setting { groups, tau, decay } = self.case.setting;
        let remembers = self.case.channel().memory != 0.0;
        let varies = tau > 0.0 && self.extents[1] > 0.0;
        let acts = decay > 0.0 && varies && remembers && !groups.uncontrolled();
        acts.then(|| self.case.last_delay() / tau - 1.0)
    }

    /// A box, in which nothing is nearer than `at_least`; none where D cannot vanish on it.
    fn part(&self, sides: Sides, at_least: f64) -> Option<Part> {
        let point = self.point(sides)?;
        let over = point.enclosed();
        if !over.value.may_vanish() {
            return None;
        }
        let tau = self.case.setting.tau;
        let known = match tau {
            0.0 => Delays::Unknown,
            tau => point.crossing_delays(tau),
        };
        if matches!(known, Delays::Unknown) {
            let shortest = tau * (1.0 + self.extents[1] * sides[DELAY].0);
            let least = exp(self.case.setting.decay * shortest) * (1.0 - 1e-12);
            if !point.reaches(least) {
                return None;
            }
        }
        let half = sides.map(|(from, to)| 0.5 * (to - from));
        let (mut distance, mut candidate) = (at_least.max(least(&sides)), None);
        let mut weights = over.weights;
        if let Delays::Near(near) = known {
            let unit = match self.extents[1] {
                // The delay is fixed, and is none at which a root may be on the line.
                0.0 if near.distance > 0.0 => return None,
                0.0 => tau,
                extent => extent * tau,
            };
            distance = distance.max(near.distance / unit * (1.0 - 1e-12));
            let [omega, gain, delay, third, _] = sides;
            let mut at = [omega, gain, delay, third].map(|(from, to)| 0.5 * (from + to));
            at[DELAY] = match self.extents[1] {
                0.0 => 0.0,
                extent => (near.tau / tau - 1.0) / extent,
            };
            candidate = Some(at);
            // A side that is halved is itself nearer or farther.
            weights = std::array::from_fn(|i| match i {
                0 | JUMP => near.weights[i] / unit,
                // Unless hardly anything depends on it.
                _ => near.weights[i] / unit + half[i].min(MATTERS * near.weights[i] / unit),
            });
        }
        let wide = |i: &usize| *i != DELAY && half[*i] > 0.0;
        let heaviest = (0..ALL).filter(wide);
        let heaviest = heaviest.max_by(|i, j| weights[*i].total_cmp(&weights[*j]))?;
        // A jump of the slope is first confined to velocities that are all as far away.
        let confined = half[3] <= CONFINED * distance.max(CONFINED);
        let variable = if weights[JUMP] == 0.0 || confined {
            heaviest
        } else {
            3
        };
        Some(Part {
            distance,
            sides,
            variable,
            candidate,
        })
    }
}

/// The least max |δ_i| on a box.
fn least(sides: &Sides) -> f64 {
    let least = |(a, b): &(f64, f64)| a.max(-b).max(0.0);
    sides[1..JUMP].iter().map(least).fold(0.0, f64::max)
}
