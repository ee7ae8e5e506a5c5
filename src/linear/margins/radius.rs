//! The stability radius: the largest box of relative changes of gain, delay and slope (or sliding
//! velocity) in which every setting is stable.
//!
//! ```text
//! gains k = 1 + δ₁,  delay τ (1 + δ₂),  slope b (1 + δ₃) or velocity v0 (1 + δ₃)            (1)
//! radius = inf max |δ_i|  over all δ for which D(−σ + iω) = 0 at some ω ≥ 0                 (2)
//! ```
//!
//! The centre is stable and roots move continuously, so inside (2) no root comes to the line.
//! Boxes of ω, δ₁ and δ₃ are taken by their least max |δ_i|, δ₂ among them by the delays at which
//! a root may be on the line there. One on which D cannot vanish is dropped, another halved.
//! Settings that are not stable bound the radius from above; when the box that is next is nearly as
//! far away as the nearest of them, its distance is a radius that is proved.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use num_complex::Complex64;

use super::affine::Affine;
use super::crossing_delays::Delays;
use super::enclosure::{Point, SlidingLaw, Slope, root_bound};
use super::equations::Line;
use crate::linear::certificate::roots_right_of;
use crate::linear::{Crossings, MarginalTolerance};
use crate::model::Groups;
use crate::model::elementary::{exp, power};

/// Times that D is enclosed before the best proof so far has to do: a part of a second, and the
/// same proof on every machine.
const MOST_WORK: u32 = 1 << 19;
/// The proved radius is at least this part of the distance of a setting that is not stable.
const TIGHT: f64 = 0.995;
/// Steps of Newton's method: at a touch each halves the distance.
const MOST_STEPS: u32 = 48;
/// So many of these may lead away from a zero.
const MOST_ASTRAY: u32 = 3;
/// Steps along a direction when settings that are not stable are looked for.
const STEPS: u32 = 48;

/// The relative changes of gain, delay and third parameter: 0 where one stays as it is.
pub type Changes = [f64; 3];

/// A radius, proved, and what is not stable just beyond it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Radius {
    /// Every setting whose parameters differ by less than this part of them is stable. At most 1.
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

/// What the third parameter is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Third<'a> {
    Slope,
    /// The sliding velocity, and its law.
    Velocity(f64, SlidingLaw<'a>),
}

/// A setting and the settings around it.
pub(super) struct Surroundings<'a> {
    pub line: Line,
    pub third: Third<'a>,
}

/// Number of the delay among ω, gain, delay and third parameter. Boxes have all delays.
const DELAY: usize = 2;
/// Number of the slope of a law, which is a variable of its own where it jumps within a box.
const JUMP: usize = 4;
/// So many variables there are.
const ALL: usize = 5;
/// A box of ω, δ₁, δ₂, δ₃ and μ_K′.
type Sides = [(f64, f64); ALL];
/// Finding the crossings of a setting takes as long as enclosing D so many times.
const WORK_OF_CROSSINGS: u32 = 4;
/// A side of a box matters by its own width up to so many times what D's zeros move along it.
const MATTERS: f64 = 8.0;
/// Jumps of the slope lie within this part of their distance.
const CONFINED: f64 = 1e-3;
/// Any μ_K′.
const ANY_SLOPE: (f64, f64) = (-1e300, 1e300);

#[derive(Debug, Clone, Copy)]
struct Part {
    /// The least max |δ_i| at which D may vanish.
    distance: f64,
    sides: Sides,
    /// The variable along which it is to be halved.
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

/// Without ω.
fn changes([_, gain, delay, third]: [f64; 4]) -> Changes {
    [gain, delay, third]
}

fn largest(changes: Changes) -> f64 {
    changes.iter().fold(0.0, |most, d| most.max(d.abs()))
}

impl Surroundings<'_> {
    /// The groups and the delay of a changed setting.
    fn changed(&self, [gain, delay, third]: Changes) -> (Groups, f64) {
        let Line { groups, tau, .. } = self.line;
        let Groups { b, a_n, .. } = match self.third {
            Third::Slope => Groups {
                b: groups.b * (1.0 + third),
                ..groups
            },
            Third::Velocity(..) if third == 0.0 => groups,
            Third::Velocity(v0, law) => law.groups(v0 * (1.0 + third)),
        };
        let k = 1.0 + gain;
        let changed = Groups::new(b, k * groups.a_v, k * a_n);
        (changed, tau * (1.0 + delay))
    }

    /// Whether a changed setting is stable beyond doubt.
    fn stable(&self, changes: Changes) -> bool {
        let (groups, tau) = self.changed(changes);
        is_stable(groups, tau, self.line.decay)
    }

    fn fixed(&self) -> [bool; 3] {
        let Groups { b, .. } = self.line.groups;
        let third = match self.third {
            Third::Slope => b == 0.0,
            Third::Velocity(v0, _) => v0 == 0.0,
        };
        [self.line.groups.uncontrolled(), self.line.tau == 0.0, third]
    }

    /// The stability radius of a setting that is stable, at most `limit`.
    pub(super) fn radius(&self, limit: f64) -> Radius {
        let fixed = self.fixed();
        let mut unstable = self.nearest_along_directions(fixed, limit);
        let mut bound = unstable.map_or(limit, largest);
        let most = bound;
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
                proved = bound;
                break;
            };
            proved = part.distance.max(proved);
            // Where nothing is known not to be stable, all of the box is proved.
            if work > MOST_WORK || (unstable.is_some() && proved >= TIGHT * bound) {
                break;
            }
            let found = self.not_stable_near(&part, bound, &mut work);
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
        Radius {
            proved,
            unstable,
            fixed,
            tight: proved >= TIGHT * bound,
        }
    }

    /// A box, in which nothing is nearer than `at_least`; none where D cannot vanish on it.
    fn part(&self, sides: Sides, at_least: f64) -> Option<Part> {
        let point = self.point(sides)?;
        let over = point.enclosed();
        if !over.value.may_vanish() {
            return None;
        }
        let tau = self.line.tau;
        let known = match tau {
            0.0 => Delays::Unknown,
            tau => point.crossing_delays(tau),
        };
        if matches!(known, Delays::Unknown) {
            let shortest = self.line.tau * (1.0 + sides[DELAY].0);
            let least = exp(self.line.decay * shortest) * (1.0 - 1e-12);
            if !point.reaches(least) {
                return None;
            }
        }
        let half = sides.map(|(from, to)| 0.5 * (to - from));
        let (mut distance, mut candidate) = (at_least.max(least(&sides)), None);
        let mut weights = over.weights;
        if let Delays::Near(near) = known {
            distance = distance.max(near.distance / tau * (1.0 - 1e-12));
            let [omega, gain, delay, third, _] = sides;
            let mut at = [omega, gain, delay, third].map(|(from, to)| 0.5 * (from + to));
            at[DELAY] = near.tau / tau - 1.0;
            candidate = Some(at);
            // A side that is halved is itself nearer or farther.
            weights = std::array::from_fn(|i| match i {
                0 | JUMP => near.weights[i] / tau,
                // Unless hardly anything depends on it.
                _ => near.weights[i] / tau + half[i].min(MATTERS * near.weights[i] / tau),
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

    /// A setting near the middle of a box that is not stable, where one may be nearer than `bound`.
    fn not_stable_near(&self, part: &Part, bound: f64, work: &mut u32) -> Option<Changes> {
        let middle = |(from, to): (f64, f64)| 0.5 * (from + to);
        let here = [middle(part.sides[1]), 0.0, middle(part.sides[3])];
        if largest(here) >= bound {
            return None;
        }
        let lost = (self.line.decay == 0.0).then(|| {
            *work += WORK_OF_CROSSINGS;
            self.delay_lost(here)
        });
        let nearer = |found: &Changes| largest(*found) < bound;
        let on_line = lost.flatten().filter(nearer).or_else(|| {
            // Where roots only touch the line, no count tells.
            let near = part.candidate.filter(|at| nearer(&changes(*at)));
            self.newton(near?, work)
        })?;
        // Just beyond it, where that is not stable; where roots only touch the line, there.
        let beyond = on_line.map(|d| d * (1.0 + 1e-9));
        Some(if self.stable(beyond) { on_line } else { beyond })
    }

    /// These changes of gain and third parameter with the least change of the delay at which
    /// sliding is not stable.
    fn delay_lost(&self, [gain, _, third]: Changes) -> Option<Changes> {
        let (groups, tau) = self.changed([gain, 0.0, third]);
        let change = match Crossings::of(groups).stable_interval_at(tau) {
            None => 0.0,
            Some(_) if tau == 0.0 => return None,
            Some(found) => {
                let [below, above] = [found.from, found.to].map(|end| end / tau - 1.0);
                let nearest = if -below < above && found.from > 0.0 {
                    below
                } else {
                    above
                };
                nearest
            }
        };
        let found = [gain, change, third];
        match change {
            0.0 => Some(self.shortened(found)),
            _ => change.is_finite().then_some(found),
        }
    }

    /// The changes nearest to a place at which D vanishes: Newton's method by the shortest steps,
    /// which come nearer also where roots only touch the line.
    fn newton(&self, mut at: [f64; 4], work: &mut u32) -> Option<Changes> {
        let fixed = self.fixed();
        let (mut last, mut astray) = (f64::INFINITY, 0);
        for _ in 0..MOST_STEPS {
            *work += 1;
            // Over a narrow box the parts are the derivatives.
            let widths: [f64; 4] = std::array::from_fn(|i| match i {
                0 => 1e-7 * (1.0 + at[0]),
                i if fixed[i - 1] => 0.0,
                _ => 1e-7,
            });
            let around = |i: usize| (at[i] - widths[i], at[i] + widths[i]);
            let [omega, gain, delay, third] = [0, 1, 2, 3].map(around);
            let narrow = self.point([omega, gain, delay, third, ANY_SLOPE])?;
            let over = narrow.enclosed().value;
            let (value, omega) = (over.centre, at[0]);
            let size = value.norm_sqr();
            if size < 1e-26 * power(1.0 + omega * omega, 2) {
                return Some(changes(at));
            }
            astray += u32::from(size >= last);
            last = size;
            if astray > MOST_ASTRAY {
                return None;
            }
            let by: [Complex64; 4] = std::array::from_fn(|i| match widths[i] {
                0.0 => Affine::<ALL>::ZERO,
                width => over.part[i] / width,
            });
            // J Jᵀ y = −D, and the step is Jᵀ y; at a touch J has lost a rank.
            let sum = |f: &dyn Fn(Complex64) -> f64| by.iter().map(|z| f(*z)).sum::<f64>();
            let (rr, ii) = (sum(&|z| z.re * z.re), sum(&|z| z.im * z.im));
            let ri = sum(&|z| z.re * z.im);
            let least = 1e-14 * (rr + ii);
            let determinant = (rr + least) * (ii + least) - ri * ri;
            let y_re = (ri * value.im - (ii + least) * value.re) / determinant;
            let y_im = (ri * value.re - (rr + least) * value.im) / determinant;
            for (a, z) in at.iter_mut().zip(by) {
                *a += z.re * y_re + z.im * y_im;
            }
            if !(at[0] >= 0.0 && changes(at).iter().all(|d| d.abs() < 1.0)) {
                return None;
            }
        }
        None
    }

    /// What D depends on, over a box; none where that is empty.
    fn point(&self, [omega, gain, delay, third, slope]: Sides) -> Option<Point<ALL>> {
        let Line { groups, tau, decay } = self.line;
        let from_one = |(a, b): (f64, f64)| (1.0 + a, 1.0 + b);
        let factor = Affine::between(from_one(gain), 1);
        let (b, a_n) = match self.third {
            Third::Slope => (
                Affine::between(from_one(third), 3).scaled(groups.b),
                Affine::constant(groups.a_n.into()),
            ),
            Third::Velocity(v0, law) => {
                let (low, high) = from_one(third);
                let slope = Slope {
                    variable: JUMP,
                    between: slope,
                };
                let [b, a_n] = law.enclosed((v0 * low, v0 * high), 3, Some(slope))?;
                (b, a_n)
            }
        };
        Some(Point {
            lambda: Point::on_line(decay, omega),
            factor,
            tau: Affine::between(from_one(delay), 2).scaled(tau),
            b,
            a_n,
            a_v: groups.a_v,
            latency: None,
            law: matches!(self.third, Third::Velocity(..)).then_some(3),
        })
    }

    /// The slopes of the law while all changes are at most `most`.
    fn slopes(&self, most: f64) -> (f64, f64) {
        let Third::Velocity(v0, law) = self.third else {
            return (0.0, 0.0);
        };
        let (low, high) = law.law.slopes_between(v0 * (1.0 - most), v0 * (1.0 + most));
        (low.max(ANY_SLOPE.0), high.min(ANY_SLOPE.1))
    }

    /// No root is on the line beyond this ω while all changes are at most `most`.
    fn highest(&self, most: f64) -> f64 {
        let Line { groups, tau, decay } = self.line;
        let (b, a_n) = match self.third {
            Third::Slope => (groups.b * (1.0 + most), groups.a_n),
            Third::Velocity(v0, law) => law.largest((v0 * (1.0 - most), v0 * (1.0 + most))),
        };
        let control = (1.0 + most) * (1.0 + exp(decay * tau * (1.0 + most)));
        root_bound(b, groups.a_v, a_n, control) * (1.0 + 1e-12)
    }

    /// Of the settings in some directions, the nearest found that is not stable, up to `limit`.
    fn nearest_along_directions(&self, fixed: [bool; 3], limit: f64) -> Option<Changes> {
        let mut nearest: Option<Changes> = None;
        for number in 0..27 {
            let direction = [number / 9, number / 3 % 3, number % 3].map(|i| f64::from(i) - 1.0);
            let moves_fixed = (0..3).any(|i| fixed[i] && direction[i] != 0.0);
            if moves_fixed || number == 13 {
                continue;
            }
            let most = nearest.map_or(limit, largest);
            let along = |s: f64| direction.map(|d| s * d);
            let steps = (1..=STEPS).map(|i| most * f64::from(i) / f64::from(STEPS));
            if let Some(s) = steps.into_iter().find(|s| !self.stable(along(*s))) {
                let found = self.shortened(along(s));
                if nearest.is_none_or(|n| largest(found) < largest(n)) {
                    nearest = Some(found);
                }
            }
        }
        nearest
    }

    /// A setting that is not stable, on the way from the centre to another.
    fn shortened(&self, unstable: Changes) -> Changes {
        let (mut stable, mut not) = (0.0, 1.0);
        for _ in 0..40 {
            let middle = 0.5 * (stable + not);
            if self.stable(unstable.map(|d| middle * d)) {
                stable = middle;
            } else {
                not = middle;
            }
        }
        unstable.map(|d| not * d)
    }
}

/// The least max |δ_i| on a box.
fn least(sides: &Sides) -> f64 {
    let least = |(a, b): &(f64, f64)| a.max(-b).max(0.0);
    sides[1..JUMP].iter().map(least).fold(0.0, f64::max)
}

/// Whether a setting is stable beyond doubt, all its roots left of Re λ = −`decay`.
pub(super) fn is_stable(groups: Groups, tau: f64, decay: f64) -> bool {
    stability(groups, tau, decay) == Some(true)
}

/// Whether all roots are left of Re λ = −`decay`; none where one is on that line within rounding.
pub(super) fn stability(groups: Groups, tau: f64, decay: f64) -> Option<bool> {
    if decay == 0.0 {
        let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
        return (!count.marginal).then_some(count.n_unstable == 0);
    }
    roots_right_of(groups, tau, -decay).map(|roots| roots == 0)
}
