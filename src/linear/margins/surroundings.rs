//! The settings around a setting: what D depends on there, and which of them are stable.

use super::affine::Affine;
use super::enclosure::{Point, SlidingLaw, Slope};
use super::equations::{OnLine, UpTo};
use super::setting::{Case, Setting};
use crate::model::Groups;

/// The relative changes of gain, delay and third parameter, in parts of the largest that each may
/// have: 0 where one stays as it is.
pub type Changes = [f64; 3];

/// What the third parameter is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Third<'a> {
    /// The slope of friction. Of b so much is not that slope, but dashpots.
    Slope(f64),
    /// The sliding velocity, and its law.
    Velocity(f64, SlidingLaw<'a>),
}

/// A setting and the settings around it.
pub(super) struct Surroundings<'a, L> {
    pub case: Case<L>,
    pub third: Third<'a>,
    /// The largest relative changes of gain, delay and third parameter, of which the radius is a
    /// part.
    pub extents: [f64; 3],
}

/// Number of the delay among ω, gain, delay and third parameter. Boxes have all delays.
pub(super) const DELAY: usize = 2;
/// Number of the slope of a law, which is a variable of its own where it jumps within a box.
pub(super) const JUMP: usize = 4;
/// The number of variables: ω, gain, delay, third parameter and slope.
pub(super) const ALL: usize = 5;
/// A box of ω, δ₁, δ₂, δ₃ and μ_K′.
pub(super) type Sides = [(f64, f64); ALL];
/// Any μ_K′.
pub(super) const ANY_SLOPE: (f64, f64) = (-1e300, 1e300);

/// The changes without ω.
pub(super) fn changes([_, gain, delay, third]: [f64; 4]) -> Changes {
    [gain, delay, third]
}

pub(super) fn largest(changes: Changes) -> f64 {
    changes.iter().fold(0.0, |most, d| most.max(d.abs()))
}

impl<L: OnLine> Surroundings<'_, L> {
    /// The groups and the delay of a changed setting.
    pub(super) fn changed(&self, changes: Changes) -> (Groups, f64) {
        let [gain, delay, third] = std::array::from_fn(|i| self.extents[i] * changes[i]);
        let Setting { groups, tau, .. } = self.case.setting;
        let Groups { b, a_n, .. } = match self.third {
            Third::Slope(still) => Groups {
                b: (groups.b - still) * (1.0 + third) + still,
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
    pub(super) fn stable(&self, changes: Changes) -> bool {
        let (groups, tau) = self.changed(changes);
        self.case.stability_at(groups, tau) == Some(true)
    }

    pub(super) fn fixed(&self) -> [bool; 3] {
        let Setting { groups, tau, .. } = self.case.setting;
        let third = match self.third {
            Third::Slope(still) => groups.b == still,
            Third::Velocity(v0, _) => v0 == 0.0,
        };
        let still = [groups.uncontrolled(), tau == 0.0, third];
        std::array::from_fn(|i| still[i] || self.extents[i] == 0.0)
    }

    /// What D depends on, over a box; none where that is empty.
    pub(super) fn point(&self, [omega, gain, delay, third, slope]: Sides) -> Option<Point<ALL>> {
        let Setting { groups, tau, decay } = self.case.setting;
        let factors = |(a, b): (f64, f64), extent: f64| (1.0 + extent * a, 1.0 + extent * b);
        let [of_gain, of_delay, of_third] = self.extents;
        let factor = Affine::between(factors(gain, of_gain), 1);
        let (b, a_n) = match self.third {
            Third::Slope(still) => {
                let slope = Affine::between(factors(third, of_third), 3).scaled(groups.b - still);
                let b = match still {
                    0.0 => slope,
                    still => slope + Affine::constant(still.into()),
                };
                (b, Affine::constant(groups.a_n.into()))
            }
            Third::Velocity(v0, law) => {
                let (low, high) = factors(third, of_third);
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
            tau: Affine::between(factors(delay, of_delay), 2).scaled(tau),
            b,
            a_n,
            a_v: groups.a_v,
            latency: None,
            law: matches!(self.third, Third::Velocity(..)).then_some(3),
            beyond: self.case.on_line.beyond(),
        })
    }

    /// The slopes of the law while all changes are at most `most`.
    pub(super) fn slopes(&self, most: f64) -> (f64, f64) {
        let Third::Velocity(v0, law) = self.third else {
            return (0.0, 0.0);
        };
        let most = self.extents[2] * most;
        let (low, high) = law.law.slopes_between(v0 * (1.0 - most), v0 * (1.0 + most));
        (low.max(ANY_SLOPE.0), high.min(ANY_SLOPE.1))
    }

    /// The ω beyond which no root is on the line while all changes are at most `most`.
    pub(super) fn highest(&self, most: f64) -> f64 {
        let Setting { groups, tau, .. } = self.case.setting;
        let [of_gain, _, of_third] = self.extents.map(|extent| extent * most);
        let (b, a_n) = match self.third {
            Third::Slope(still) => {
                let reach = (groups.b - still).abs() * (1.0 + of_third) + still;
                (reach, groups.a_n)
            }
            Third::Velocity(v0, law) => law.largest((v0 * (1.0 - of_third), v0 * (1.0 + of_third))),
        };
        self.case.on_line.highest(UpTo {
            groups: Groups { b, a_n, ..groups },
            tau,
            latency: self.case.channel().latency,
            factor: 1.0 + of_gain,
        })
    }
}
