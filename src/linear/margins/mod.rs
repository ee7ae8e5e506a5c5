//! How far a stable setting is from the boundary of stability, in every direction.
//!
//! A setting is stable while all roots are left of the line Re λ = −σ; σ = 0 is stability itself,
//! σ > 0 a decay rate that is required. Along one parameter the nearest change is the nearest
//! value at which a root lies on the line:
//!
//! | parameter | equation |
//! |---|---|
//! | gain: both gains k times as large | zeros in ω of `equations` (1) |
//! | delay τ | closed form of [`stable_delays`](super::stable_delays); for σ > 0 `nearest` |
//! | slope b | zeros in ω of `equations` (2) |
//! | sliding velocity, with a friction law | `nearest` |
//! | phase of the loop L, latency δ of the feedback | zeros in ω of `equations` (3) |
//!
//! ```text
//! phase margin   = min |arg(−L(iω))|,   latency margin = min arg(−L(iω))/ω, arg in (0, 2π],
//!                  over all ω > 0 with |L(iω)| = 1                                          (1)
//! ```
//!
//! and for σ > 0 the latency margin is the least δ with 1 + L(−σ + iω) e^(−(−σ + iω)δ) = 0. All
//! zeros are found, none is stepped over. The exact count decides whether stability changes there:
//! where a pair only touches the axis, the search goes on.
//!
//! What holds for several parameters at once tells the [`Radius`].
//!
//! - `affine`: complex affine arithmetic
//! - `along`: limits along the delay, the latency and the sliding velocity
//! - `crossing_delays`: the delays at which a root is on the line, over boxes of the other
//!   variables
//! - `enclosure`: D over boxes of frequency and parameters
//! - `nearest_change`: the nearest value of one parameter at which stability is lost, as the count
//!   has it
//! - `not_stable`: settings around one that are not stable
//! - `radius`: the stability radius, proved
//! - `surroundings`: the settings around a setting: what D depends on, which are stable
//! - `trig_polynomial`: all zeros of functions that are polynomials in ω, sin tω and cos tω

mod affine;
mod along;
mod crossing_delays;
mod enclosure;
mod equations;
mod nearest;
mod nearest_change;
mod not_stable;
mod radius;
mod surroundings;
mod trig_polynomial;

use std::f64::consts::TAU;

use self::along::latency_with_decay;
use self::equations::Line;
use self::nearest_change::{Search, Side};
use self::surroundings::{Surroundings, Third, is_stable, stability};
use self::trig_polynomial::{Intervals, TooMany};
use crate::model::Groups;
use crate::model::elementary::arg;

pub use self::along::{MOST_VELOCITIES, delay, velocity};
pub use self::enclosure::SlidingLaw;
pub use self::radius::Radius;
pub use self::surroundings::Changes;

/// Where stability is lost on both sides of a setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The value below; that of the parameter's range where it is not lost.
    pub lower: f64,
    /// The value above; infinite where it is not lost.
    pub upper: f64,
}

impl Limits {
    const UNDECIDED: Self = Self {
        lower: f64::NAN,
        upper: f64::NAN,
    };
}

/// Margins of the loop: (1) of the module.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopMargins {
    /// In radians; infinite where |L| is 1 nowhere.
    pub phase: f64,
    /// In units of √(M/κ); infinite where no latency matters.
    pub latency: f64,
}

/// A setting whose margins are asked for, in dimensionless numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// b, a_v and a_n.
    pub groups: Groups,
    /// τ ≥ 0, in units of √(M/κ).
    pub tau: f64,
    /// σ ≥ 0, the required decay rate, in their inverse.
    pub decay: f64,
}

/// Searches for margins, with the room that they share.
///
/// All answers are for settings that are stable; NaN where a search was given up.
#[derive(Debug, Default)]
pub struct Margins {
    intervals: Intervals,
    changes: Vec<f64>,
}

/// How many times as large gains are looked at, where no bound on them is known.
const MOST_GAINS: f64 = 1e12;

/// Up to where limits are looked for that are told as infinite; infinite where none lies beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Of the factor of both gains.
    pub gain: f64,
    /// Of the delay.
    pub delay: f64,
    /// Of a further latency.
    pub latency: f64,
}

impl Setting {
    /// Up to where upper limits are looked for.
    #[must_use]
    pub fn reach(&self) -> Reach {
        let endless = f64::INFINITY;
        let searched = |search: bool, to: f64| if search { to } else { endless };
        let bounded = self.idle() || highest_with_gain(self).is_finite();
        Reach {
            gain: searched(!bounded, MOST_GAINS),
            delay: searched(
                self.decay > 0.0 && !self.groups.uncontrolled(),
                along::longest_delay(self),
            ),
            latency: searched(
                self.decay > 0.0 && !self.idle(),
                along::longest_latency(self),
            ),
        }
    }

    /// Whether all roots are left of the line, beyond doubt.
    #[must_use]
    pub fn stable(&self) -> bool {
        is_stable(self.groups, self.tau, self.decay)
    }

    fn line(&self) -> Line {
        let Self { groups, tau, decay } = *self;
        Line { groups, tau, decay }
    }

    /// No control acts, whatever its gains and its phase are.
    fn idle(&self) -> bool {
        self.groups.uncontrolled() || self.tau == 0.0
    }

    /// Whether all roots are left of the line; none where one is on it within rounding.
    fn stability(&self) -> Option<bool> {
        stability(self.groups, self.tau, self.decay)
    }

    fn with_gains(&self, factor: f64) -> Self {
        let Groups { b, a_v, a_n } = self.groups;
        let groups = Groups::new(b, factor * a_v, factor * a_n);
        Self { groups, ..*self }
    }

    fn with_slope(&self, b: f64) -> Self {
        let groups = Groups { b, ..self.groups };
        Self { groups, ..*self }
    }
}

impl Margins {
    /// The gain margin: the factors of both gains at which stability is lost. 0 below where any
    /// smaller gain is stable too.
    pub fn gain(&mut self, setting: &Setting) -> Limits {
        let free = Limits {
            lower: 0.0,
            upper: f64::INFINITY,
        };
        if setting.idle() {
            return free;
        }
        self.gain_limits(setting)
    }

    fn gain_limits(&mut self, setting: &Setting) -> Limits {
        let line = setting.line();
        let highest = highest_with_gain(setting);
        let f = line.gain();
        // The greatest factor whose crossings are all among those found.
        let mut most = if highest.is_finite() {
            f64::INFINITY
        } else {
            2.0
        };
        let mut lower = None;
        loop {
            let end = line.gain_bound(most).min(highest);
            self.changes.clear();
            let changes = &mut self.changes;
            let mut keep = |omega| {
                let factor = line.gain_factor(omega);
                if factor > 0.0 && factor <= most {
                    changes.push(factor);
                }
            };
            if self.intervals.zeros(f, (0.0, end), &mut keep) == Err(TooMany) {
                return Limits {
                    lower: lower.unwrap_or(f64::NAN),
                    upper: f64::NAN,
                };
            }
            // A real root on the line; on the imaginary axis there is none.
            if setting.decay > 0.0 {
                keep(0.0);
            }
            let search = Search {
                changes: &self.changes,
                from: 1.0,
                stable: |factor: f64| setting.with_gains(factor).stability(),
                sure: setting.decay == 0.0,
            };
            let below = || search.nearest(Side::Below, 0.0).unwrap_or(0.0);
            let lower = *lower.get_or_insert_with(below);
            let above = search.nearest(Side::Above, most);
            // No crossing has a frequency beyond `highest`.
            let last = end >= highest || most >= MOST_GAINS;
            if above.is_some() || last {
                let upper = above.unwrap_or(f64::INFINITY);
                return Limits { lower, upper };
            }
            most *= 4.0;
        }
    }

    /// The slopes b at which stability is lost, μ_K fixed; −∞ below where it never is.
    pub fn slope(&mut self, setting: &Setting) -> Limits {
        let line = setting.line();
        let f = line.slope();
        self.changes.clear();
        let changes = &mut self.changes;
        let mut keep = |omega| {
            let slope = line.slope_at(omega);
            if slope.is_finite() {
                changes.push(slope);
            }
        };
        let end = line.slope_bound();
        if self.intervals.zeros(f, (0.0, end), &mut keep).is_err() {
            return Limits::UNDECIDED;
        }
        if setting.decay > 0.0 {
            keep(0.0);
        }
        let search = Search {
            changes: &self.changes,
            from: setting.groups.b,
            stable: |b: f64| setting.with_slope(b).stability(),
            sure: setting.decay == 0.0,
        };
        let nearest = |side, last: f64| search.nearest(side, last).unwrap_or(last);
        Limits {
            lower: nearest(Side::Below, f64::NEG_INFINITY),
            upper: nearest(Side::Above, f64::INFINITY),
        }
    }

    /// The phase margin and the latency margin.
    pub fn of_loop(&mut self, setting: &Setting) -> LoopMargins {
        let line = setting.line();
        let mut margins = LoopMargins {
            phase: f64::INFINITY,
            latency: f64::INFINITY,
        };
        if setting.idle() {
            return margins;
        }
        let end = line.unit_loop_bound();
        let searched = self.intervals.zeros(line.unit_loop(), (0.0, end), |omega| {
            let angle = arg(line.negative_loop(omega));
            margins.phase = margins.phase.min(angle.abs());
            let ahead = if angle > 0.0 { angle } else { angle + TAU };
            margins.latency = margins.latency.min(ahead / omega);
        });
        if setting.decay > 0.0 {
            margins.latency = latency_with_decay(setting);
        }
        if searched.is_err() {
            margins.phase = f64::NAN;
            margins.latency = f64::NAN;
        }
        margins
    }
}

/// The stability radius in gain, delay and slope.
#[must_use]
pub fn radius(setting: &Setting) -> Radius {
    let around = Surroundings {
        line: setting.line(),
        third: Third::Slope,
    };
    around.radius(1.0)
}

/// The stability radius in gain, delay and slope, or `most` < 1 where it is larger.
#[must_use]
pub fn radius_up_to(setting: &Setting, most: f64) -> Radius {
    let around = Surroundings {
        line: setting.line(),
        third: Third::Slope,
    };
    around.radius(most)
}

/// The stability radius in gain, delay and sliding velocity; `setting` is the one at `v0`.
#[must_use]
pub fn radius_with_law(setting: &Setting, law: &SlidingLaw<'_>, v0: f64) -> Radius {
    let around = Surroundings {
        line: setting.line(),
        third: Third::Velocity(v0, *law),
    };
    around.radius(1.0)
}

/// No crossing at any factor of the gains has a frequency beyond this: on the imaginary axis P_r =
/// c − a_n x has to be positive, c = a_n + a_v b.
fn highest_with_gain(setting: &Setting) -> f64 {
    let Groups { b, a_v, a_n } = setting.groups;
    let c = a_n + a_v * b;
    match setting.decay {
        0.0 if a_n > 0.0 => (c / a_n).max(0.0).sqrt(),
        0.0 if a_n == 0.0 && c <= 0.0 => 0.0,
        _ => f64::INFINITY,
    }
}
