//! Limits along one parameter that enters D as more than a factor: the delay and the latency where
//! a decay rate is required, and the sliding velocity.

use super::affine::Affine;
use super::beyond::Beyond;
use super::enclosure::{Enclosed, Point, SlidingLaw};
use super::equations::{OnLine, UpTo};
use super::limits::Limits;
use super::nearest::{Family, MOST_BOXES, Nearest, nearest};
use super::setting::{AsCase, Case, Setting};
use crate::model::law::Kind;
use crate::model::{Channel, Groups};

/// Decay rates above this are not told from infinity.
const LARGEST_EXPONENT: f64 = 300.0;
/// How many times as large a sliding velocity is looked at.
pub const MOST_VELOCITIES: f64 = 1024.0;
/// Limits are looked for up to this part of the delay at which infinitely many roots come to the
/// line: nearer to that delay there may be any number of them.
const BEFORE_ACCUMULATION: f64 = 1.0 - 1e-3;

/// The delays at which stability is lost, 0 below where none is.
#[must_use]
pub fn delay(of: &impl AsCase) -> Limits {
    let case = of.case();
    let Setting { groups, tau, decay } = case.setting;
    if decay == 0.0 {
        let (interval, _) = case.on_line.stable_interval_at(groups, tau);
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
    let what = Varied::Delay;
    let longest = longest_delay(&case);
    let family = Along { case, what };
    let upper = outwards(&family, tau, tau.max(1.0), longest);
    // Stability is lost where roots accumulate at the latest.
    let open = upper == f64::INFINITY && longest < longest_searched(&family.case.setting);
    Limits {
        lower: found_or(nearest(&family, (tau, 0.0), &mut { MOST_BOXES }), 0.0),
        upper: if open { f64::NAN } else { upper },
    }
}

/// The sliding velocities at which stability is lost on the way from `v0`, physical; 0 below and ∞
/// above where it is not, up to 1024 times `v0`.
#[must_use]
pub fn velocity(of: &impl AsCase, law: &SlidingLaw<'_>, v0: f64) -> Limits {
    if matches!(law.law.kind(), Kind::Coulomb(_)) {
        // No velocity changes D.
        return Limits {
            lower: 0.0,
            upper: f64::INFINITY,
        };
    }
    let family = Along {
        case: of.case(),
        what: Varied::Velocity(*law),
    };
    let case = &family.case;
    let change = |to: f64| {
        let (mut from, mut left) = (v0, MOST_BOXES);
        loop {
            match nearest(&family, (from, to), &mut left) {
                Nearest::At(v) => {
                    // Where a pair only touches the line, the search goes on beyond.
                    let beyond = v + 1e-6 * (to - v).clamp(-v, v);
                    let stable = || case.stability_at(law.groups(beyond), case.setting.tau);
                    if beyond == v || stable() != Some(true) {
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
pub(super) fn longest_delay(case: &Case<impl OnLine>) -> f64 {
    let last = BEFORE_ACCUMULATION * case.last_delay();
    longest_searched(&case.setting).min(last.max(case.setting.tau))
}

/// The longest delay that is searched, whether roots accumulate before it or not.
fn longest_searched(setting: &Setting) -> f64 {
    longest_latency(setting.decay).max(2.0 * setting.tau)
}

/// The longest latency that is looked at where a decay rate `decay` is required.
pub(super) fn longest_latency(decay: f64) -> f64 {
    LARGEST_EXPONENT / decay
}

fn found_or(nearest: Nearest, none: f64) -> f64 {
    match nearest {
        Nearest::At(value) => value,
        Nearest::None => none,
        Nearest::Undecided => f64::NAN,
    }
}

/// The nearest value above `from` at which a root is on the line, looked for in steps that grow;
/// infinite where there is none up to `last`.
fn outwards(family: &Along<'_, impl OnLine>, from: f64, step: f64, last: f64) -> f64 {
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
pub(super) fn latency_with_decay(case: &Case<impl OnLine>) -> f64 {
    let family = Along {
        case: case.clone(),
        what: Varied::Latency,
    };
    outwards(&family, 0.0, 1.0, longest_latency(case.setting.decay))
}

/// The latency margin beyond the letter, counted from no latency with all else as it is; 0 where
/// that is not stable.
pub(super) fn latency(case: &Case<impl OnLine>, beyond: &Beyond) -> f64 {
    let Setting { groups, tau, decay } = case.setting;
    if decay == 0.0 {
        let margin = beyond.of_groups(groups).system().latency_margin(tau);
        return margin.unwrap_or(f64::NAN);
    }
    let at_once = Beyond {
        channel: Channel {
            latency: 0.0,
            ..beyond.channel
        },
        ..*beyond
    };
    match at_once.stability(groups, tau, decay) {
        Some(true) if case.setting.idle() => f64::INFINITY,
        Some(true) => latency_with_decay(case),
        Some(false) => 0.0,
        None => f64::NAN,
    }
}

/// Settings that differ in one parameter.
struct Along<'a, L> {
    case: Case<L>,
    what: Varied<'a>,
}

enum Varied<'a> {
    Delay,
    Latency,
    Velocity(SlidingLaw<'a>),
}

impl<L: OnLine> Family for Along<'_, L> {
    fn stopped(&self) -> bool {
        self.case.stopped()
    }

    fn enclosed(&self, omega: (f64, f64), parameter: (f64, f64)) -> Enclosed<2> {
        let Setting { groups, tau, decay } = self.case.setting;
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
            beyond: self.case.on_line.beyond(),
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
        let Setting { groups, tau, .. } = self.case.setting;
        let here = UpTo {
            groups,
            tau,
            latency: self.case.channel().latency,
            factor: 1.0,
        };
        let (_, longest) = parameter;
        self.case.on_line.highest(match &self.what {
            Varied::Delay => UpTo {
                tau: longest,
                ..here
            },
            Varied::Latency => UpTo {
                latency: longest,
                ..here
            },
            Varied::Velocity(law) => {
                let (b, a_n) = law.largest(parameter);
                UpTo {
                    groups: Groups { b, a_n, ..groups },
                    ..here
                }
            }
        })
    }
}
