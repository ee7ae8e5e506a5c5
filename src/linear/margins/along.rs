//! Limits along one parameter that enters D as more than a factor: the delay and the latency where
//! a decay rate is required, and the sliding velocity.

use super::affine::Affine;
use super::enclosure::{Enclosed, Point, SlidingLaw, root_bound};
use super::nearest::{Family, MOST_BOXES, Nearest, nearest};
use super::surroundings::is_stable;
use super::{Limits, Setting};
use crate::linear::Crossings;
use crate::model::Groups;
use crate::model::elementary::exp;
use crate::model::friction::Kind;

/// Decay rates above this are not told from infinity.
const LARGEST_EXPONENT: f64 = 300.0;
/// How many times as large a sliding velocity is looked at.
pub const MOST_VELOCITIES: f64 = 1024.0;

/// The delays at which stability is lost, 0 below where none is.
#[must_use]
pub fn delay(setting: &Setting) -> Limits {
    let Setting { groups, tau, decay } = *setting;
    if decay == 0.0 {
        let interval = Crossings::of(groups).stable_interval_at(tau);
        return interval.map_or(Limits::UNDECIDED, |found| Limits {
            lower: found.from,
            upper: found.to,
        });
    }
    if groups.uncontrolled() {
        return Limits {
            lower: 0.0,
            upper: f64::INFINITY,
        };
    }
    let family = Along::delay(setting);
    let longest = longest_delay(setting);
    Limits {
        lower: found_or(nearest(&family, (tau, 0.0), &mut { MOST_BOXES }), 0.0),
        upper: outwards(&family, tau, tau.max(1.0), longest),
    }
}

/// The sliding velocities at which stability is lost on the way from `v0`, physical; 0 below and ∞
/// above where it is not, up to 1024 times `v0`.
#[must_use]
pub fn velocity(setting: &Setting, law: &SlidingLaw<'_>, v0: f64) -> Limits {
    if matches!(law.law.kind(), Kind::Coulomb { .. }) {
        // No velocity changes D.
        return Limits {
            lower: 0.0,
            upper: f64::INFINITY,
        };
    }
    let family = Along {
        setting: *setting,
        what: Varied::Velocity(*law),
    };
    let change = |to: f64| {
        let (mut from, mut left) = (v0, MOST_BOXES);
        loop {
            match nearest(&family, (from, to), &mut left) {
                Nearest::At(v) => {
                    // Where a pair only touches the line, the search goes on beyond.
                    let beyond = v + 1e-6 * (to - v).clamp(-v, v);
                    let groups = law.groups(beyond);
                    if beyond == v || !is_stable(groups, setting.tau, setting.decay) {
                        return Nearest::At(v);
                    }
                    from = beyond;
                }
                other => return other,
            }
        }
    };
    Limits {
        lower: found_or(change(0.0), 0.0),
        upper: found_or(change(v0 * MOST_VELOCITIES), f64::INFINITY),
    }
}

/// The longest delay that is looked at where a decay rate is required.
pub(super) fn longest_delay(setting: &Setting) -> f64 {
    longest_latency(setting).max(2.0 * setting.tau)
}

/// The longest latency that is looked at there.
pub(super) fn longest_latency(setting: &Setting) -> f64 {
    LARGEST_EXPONENT / setting.decay
}

fn found_or(nearest: Nearest, none: f64) -> f64 {
    match nearest {
        Nearest::At(value) => value,
        Nearest::None => none,
        Nearest::Undecided => f64::NAN,
    }
}

/// The nearest value above `from`, looked for in steps that grow; infinite where there is none up
/// to `last`.
fn outwards(family: &Along<'_>, from: f64, step: f64, last: f64) -> f64 {
    let (mut start, mut step, mut left) = (from, step, MOST_BOXES);
    while start < last {
        let end = (start + step).min(last);
        match nearest(family, (start, end), &mut left) {
            Nearest::None => (start, step) = (end, 4.0 * step),
            found => return found_or(found, f64::INFINITY),
        }
    }
    f64::INFINITY
}

/// The latency margin where a decay rate is required.
pub(super) fn latency_with_decay(setting: &Setting) -> f64 {
    let family = Along {
        setting: *setting,
        what: Varied::Latency,
    };
    outwards(&family, 0.0, 1.0, longest_latency(setting))
}

/// Settings that differ in one parameter.
struct Along<'a> {
    setting: Setting,
    what: Varied<'a>,
}

enum Varied<'a> {
    Delay,
    Latency,
    Velocity(SlidingLaw<'a>),
}

impl Along<'_> {
    fn delay(setting: &Setting) -> Self {
        Self {
            setting: *setting,
            what: Varied::Delay,
        }
    }
}

impl Family for Along<'_> {
    fn enclosed(&self, omega: (f64, f64), parameter: (f64, f64)) -> Enclosed<2> {
        let Setting { groups, tau, decay } = self.setting;
        let constant = |value: f64| Affine::constant(value.into());
        let mut point = Point {
            lambda: Point::on_line(decay, omega),
            factor: constant(1.0),
            tau: constant(tau),
            b: constant(groups.b),
            a_n: constant(groups.a_n),
            a_v: groups.a_v,
            latency: None,
            law: matches!(self.what, Varied::Velocity(_)).then_some(1),
        };
        match &self.what {
            Varied::Delay => point.tau = Affine::between(parameter, 1),
            Varied::Latency => point.latency = Some(Affine::between(parameter, 1)),
            Varied::Velocity(law) => {
                if let Some(both) = law.enclosed(parameter, 1, None) {
                    [point.b, point.a_n] = both;
                }
            }
        }
        point.enclosed()
    }

    fn bound(&self, parameter: (f64, f64)) -> f64 {
        let Setting { groups, tau, decay } = self.setting;
        let Groups { b, a_v, a_n } = groups;
        let delayed = |tau: f64| 1.0 + exp(decay * tau);
        let bound = match &self.what {
            Varied::Delay => root_bound(b, a_v, a_n, delayed(parameter.1)),
            Varied::Latency => {
                let control = delayed(tau) * exp(decay * parameter.1);
                root_bound(b, a_v, a_n, control)
            }
            Varied::Velocity(law) => {
                let (b, a_n) = law.largest(parameter);
                root_bound(b, a_v, a_n, delayed(tau))
            }
        };
        bound * (1.0 + 1e-12)
    }
}
