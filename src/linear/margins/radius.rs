//! The stability radius: the largest box of relative changes of gain, delay and slope (or sliding
//! velocity) in which every setting is stable.
//!
//! ```text
//! gains k = 1 + δ₁,  delay τ (1 + δ₂),  slope b (1 + δ₃) or velocity v0 (1 + δ₃)            (1)
//! radius = inf max |δ_i|  over all δ for which D(−σ + iω) = 0 at some ω ≥ 0                 (2)
//! ```
//!
//! The centre is stable and roots move continuously, so inside (2) no root comes to the line.
//! Boxes of (ω, δ) are taken by their least max |δ_i|. One on which D cannot vanish is dropped,
//! another halved. Settings that are not stable bound the radius from above; when the box that is
//! next is nearly as far away as the nearest of them, its distance is a radius that is proved.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use num_complex::Complex64;

use super::affine::Affine;
use super::enclosure::{Enclosed, Point, SlidingLaw, root_bound};
use super::equations::Line;
use crate::linear::certificate::roots_right_of;
use crate::linear::{Crossings, MarginalTolerance};
use crate::model::Groups;
use crate::model::elementary::{exp, power};

/// Boxes that are looked at before the best proof so far has to do.
const MOST_BOXES: usize = 1 << 18;
/// The proved radius is at least this part of the distance of a setting that is not stable.
const TIGHT: f64 = 0.995;
/// Boxes less wide than this are near a zero of D, where there is one.
const SMALL: f64 = 0.02;
/// Steps of Newton's method: at a touch each halves the distance.
const MOST_STEPS: u32 = 48;
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

#[derive(Debug, Clone, Copy)]
struct Part {
    /// The least max |δ_i|.
    distance: f64,
    /// ω, δ₁, δ₂, δ₃.
    sides: [(f64, f64); 4],
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
        let mut parts = BinaryHeap::from([Part {
            distance: 0.0,
            sides: [(0.0, self.highest(most)), gain, delay, third],
        }]);
        let mut proved = 0.0;
        for _ in 0..MOST_BOXES {
            let Some(part) = parts.pop() else {
                proved = bound;
                break;
            };
            proved = part.distance.min(bound);
            // Where nothing is known not to be stable, all of the box is proved.
            if unstable.is_some() && proved >= TIGHT * bound {
                break;
            }
            let Some(variable) = self.to_halve(&part) else {
                continue;
            };
            let found = self.not_stable_near(&part, variable, bound);
            if let Some(found) = found.filter(|found| largest(*found) < bound) {
                bound = largest(found);
                unstable = Some(found);
            }
            let (from, to) = part.sides[variable];
            let middle = 0.5 * (from + to);
            for side in [(from, middle), (middle, to)] {
                let mut sides = part.sides;
                sides[variable] = side;
                parts.push(Part {
                    distance: least(&sides),
                    sides,
                });
            }
        }
        Radius {
            proved,
            unstable,
            fixed,
            tight: proved >= TIGHT * bound,
        }
    }

    /// The variable along which a box is halved; none where D cannot vanish on it.
    fn to_halve(&self, part: &Part) -> Option<usize> {
        let over = self.enclosed(part.sides);
        if !over.value.may_vanish() {
            return None;
        }
        let wide = |i: &usize| part.sides[*i].0 < part.sides[*i].1;
        let heaviest = (0..4).filter(wide);
        heaviest.max_by(|i, j| over.weights[*i].total_cmp(&over.weights[*j]))
    }

    /// A setting of a box, or one near it, that is not stable and nearer than `bound`. Of its
    /// sides that number `heaviest` matters most.
    fn not_stable_near(&self, part: &Part, heaviest: usize, bound: f64) -> Option<Changes> {
        let middles = part.sides.map(|(a, b)| 0.5 * (a + b));
        let [_, a, b, c] = middles;
        let here = [a, b, c];
        if largest(here) < bound && !self.stable(here) {
            return Some(self.shortened(here));
        }
        let (from, to) = part.sides[heaviest];
        if to - from > SMALL * (1.0 + to.abs()) {
            return None;
        }
        let on_line = self.newton(middles)?;
        // Just beyond it, where that is not stable; where roots only touch the line, there.
        let beyond = on_line.map(|d| d * (1.0 + 1e-9));
        Some(if self.stable(beyond) { on_line } else { beyond })
    }

    /// The changes nearest to a place at which D vanishes: Newton's method by the shortest steps,
    /// which come nearer also where roots only touch the line.
    fn newton(&self, mut at: [f64; 4]) -> Option<Changes> {
        let fixed = self.fixed();
        for _ in 0..MOST_STEPS {
            // Over a narrow box the parts are the derivatives.
            let widths: [f64; 4] = std::array::from_fn(|i| match i {
                0 => 1e-7 * (1.0 + at[0]),
                i if fixed[i - 1] => 0.0,
                _ => 1e-7,
            });
            let around = |i: usize| (at[i] - widths[i], at[i] + widths[i]);
            let over = self.enclosed(std::array::from_fn(around)).value;
            let (value, [omega, changes @ ..]) = (over.centre, at);
            if value.norm_sqr() < 1e-26 * power(1.0 + omega * omega, 2) {
                return Some(changes);
            }
            let by: [Complex64; 4] = std::array::from_fn(|i| match widths[i] {
                0.0 => Affine::<4>::ZERO,
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
            let [omega, changes @ ..] = at;
            if !(omega >= 0.0 && changes.iter().all(|d| d.abs() < 1.0)) {
                return None;
            }
        }
        None
    }

    /// D over a box of ω, δ₁, δ₂, δ₃.
    fn enclosed(&self, [omega, gain, delay, third]: [(f64, f64); 4]) -> Enclosed<4> {
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
                let [b, a_n] = law.enclosed((v0 * low, v0 * high), 3);
                (b, a_n)
            }
        };
        let point = Point::<4> {
            lambda: Point::on_line(decay, omega),
            factor,
            tau: Affine::between(from_one(delay), 2).scaled(tau),
            b,
            a_n,
            a_v: groups.a_v,
            latency: None,
            law: matches!(self.third, Third::Velocity(..)).then_some(3),
        };
        point.enclosed()
    }

    /// No root is on the line beyond this ω while all changes are at most `most`.
    fn highest(&self, most: f64) -> f64 {
        let Line { groups, tau, decay } = self.line;
        let (b, a_n) = match self.third {
            Third::Slope => (groups.b * (1.0 + most), groups.a_n),
            Third::Velocity(v0, law) => {
                let [b, a_n] = law.enclosed::<1>((v0 * (1.0 - most), v0 * (1.0 + most)), 0);
                let reach = |z: &Affine<1>| z.centre.l1_norm() + z.spread() + z.rest;
                (reach(&b), reach(&a_n))
            }
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
fn least(sides: &[(f64, f64); 4]) -> f64 {
    let least = |(a, b): &(f64, f64)| a.max(-b).max(0.0);
    sides[1..].iter().map(least).fold(0.0, f64::max)
}

/// Whether a setting is stable beyond doubt, all its roots left of Re λ = −`decay`.
pub(super) fn is_stable(groups: Groups, tau: f64, decay: f64) -> bool {
    if decay == 0.0 {
        let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
        return count.stable();
    }
    roots_right_of(groups, tau, -decay) == Some(0)
}
