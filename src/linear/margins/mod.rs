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
//! The [`Radius`] tells what holds for several parameters at once.
//!
//! - `affine`: complex affine arithmetic
//! - `along`: limits along the delay, the latency and the sliding velocity
//! - `beyond`: the same with memory, latency, lags and a damped spring
//! - `crossing_delays`: the delays at which a root is on the line, over boxes of the other
//!   variables
//! - `enclosure`: D over boxes of frequency and parameters
//! - `equations`: where a root is on the line, as equations in ω
//! - `form`: quadratic forms of the two sides of a loop, as functions of ω
//! - `gain`: the gain margin of any loop
//! - `limits`: what margins are told as
//! - `modulus`: how near the loop comes to −1
//! - `nearest`: the nearest value of one parameter at which a root is on the line, by boxes
//! - `nearest_change`: the nearest value of one parameter at which stability is lost, as the count
//!   has it
//! - `not_stable`: settings around one that are not stable
//! - `of_system`: any system with one delay as a loop
//! - `radius`: the stability radius, proved
//! - `setting`: a setting, the letter's own or one beyond it
//! - `sum`: functions of ω that swing with several delays, as the left sides of these equations do
//! - `surroundings`: the settings around a setting: what D depends on, which are stable
//! - `turns`: the phase margin from the crossings of a line

mod affine;
mod along;
mod beyond;
mod crossing_delays;
mod enclosure;
mod equations;
mod form;
mod gain;
mod limits;
mod modulus;
mod nearest;
mod nearest_change;
mod not_stable;
mod of_system;
mod radius;
mod setting;
mod sum;
mod surroundings;
mod turns;

use std::f64::consts::TAU;

use self::gain::{Factors, MOST_GAINS};
use self::nearest_change::{Search, Side};
use self::surroundings::{Surroundings, Third};
use crate::linear::real_zeros::{TooMany, zeros};
use crate::model::elementary::arg;

pub use self::along::{MOST_VELOCITIES, delay, velocity};
pub use self::beyond::{Beyond, Equations};
pub use self::enclosure::SlidingLaw;
pub use self::equations::OnLine;
pub use self::gain::{GainLoop, GainMargin};
pub use self::limits::{Limits, LoopMargins};
pub use self::modulus::Modulus;
pub use self::of_system::SystemLoop;
pub use self::radius::Radius;
pub use self::setting::{AsCase, Case, Setting};
pub use self::surroundings::Changes;
pub use self::turns::PhaseMargin;
pub(crate) use self::turns::omega_at;

/// Searches for margins, with the room that they share.
///
/// All answers are for settings that are stable; NaN where a search was given up.
#[derive(Debug, Default)]
pub struct MarginSearch {
    changes: Vec<f64>,
    factors: Factors,
}

/// How far limits are looked for before they are told as infinite; infinite where none lies beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// The largest factor of both gains.
    pub gain: f64,
    /// The longest delay.
    pub delay: f64,
    /// The longest further latency.
    pub latency: f64,
}

impl<L: OnLine> Case<L> {
    /// How far upper limits are looked for.
    #[must_use]
    pub fn reach(&self) -> Reach {
        let (endless, setting) = (f64::INFINITY, &self.setting);
        let searched = |search: bool, to: f64| if search { to } else { endless };
        let highest = self.on_line.highest_with_gain();
        let bounded = setting.idle() || highest.is_finite();
        Reach {
            gain: searched(!bounded, MOST_GAINS),
            delay: searched(
                setting.decay > 0.0 && !setting.groups.uncontrolled(),
                along::longest_delay(self),
            ),
            latency: searched(
                setting.decay > 0.0 && !setting.idle(),
                along::longest_latency(setting.decay),
            ),
        }
    }
}

impl MarginSearch {
    /// The gain margin: the factors of both gains at which stability is lost. 0 below where any
    /// smaller gain is stable too.
    pub fn gain(&mut self, of: &impl AsCase) -> Limits {
        self.gain_margin(&of.case()).limits
    }

    /// The gain margin of any loop, with the frequencies it comes from.
    pub fn gain_margin(&mut self, of: &impl GainLoop) -> GainMargin {
        self.factors.gain_margin(of)
    }

    /// The slopes b at which stability is lost, μ_K fixed; −∞ below where it never is.
    pub fn slope(&mut self, of: &impl AsCase) -> Limits {
        let case = of.case();
        let line = &case.on_line;
        let (f, end) = line.slope();
        self.changes.clear();
        let changes = &mut self.changes;
        let mut keep = |omega, _| {
            let slope = line.slope_at(omega);
            if slope.is_finite() {
                changes.push(slope);
            }
        };
        if zeros(&f, end, &mut keep).is_err() {
            return Limits::UNDECIDED;
        }
        if case.setting.decay > 0.0 {
            keep(0.0, true);
        }
        let search = Search {
            changes: &self.changes,
            from: case.setting.groups.b,
            stable: |b: f64| case.stability_with_slope(b),
            sure: case.setting.decay == 0.0,
        };
        let nearest = |side, last: f64| search.nearest(side, last).unwrap_or(last);
        Limits {
            lower: nearest(Side::Below, f64::NEG_INFINITY),
            upper: nearest(Side::Above, f64::INFINITY),
        }
    }

    /// The phase margin and the latency margin.
    pub fn of_loop(&mut self, of: &impl AsCase) -> LoopMargins {
        let case = of.case();
        let setting = &case.setting;
        let from_none = case.on_line.beyond().map(|of| along::latency(&case, &of));
        let mut margins = LoopMargins {
            phase: f64::INFINITY,
            phase_omega: f64::NAN,
            latency: from_none.unwrap_or(f64::INFINITY),
        };
        if setting.idle() {
            return margins;
        }
        let mut latency = f64::INFINITY;
        let searched = Self::unit_loop(&case.on_line, |omega, angle| {
            if angle.abs() < margins.phase {
                (margins.phase, margins.phase_omega) = (angle.abs(), omega);
            }
            let ahead = if angle > 0.0 { angle } else { angle + TAU };
            latency = latency.min(ahead / omega);
        });
        if setting.decay > 0.0 && from_none.is_none() {
            latency = along::latency_with_decay(&case);
        }
        if searched.is_err() {
            margins.phase = f64::NAN;
            latency = f64::NAN;
        }
        margins.latency = from_none.unwrap_or(latency);
        margins
    }

    /// The latency margin alone. Beyond the letter it counts from no latency, with all else as it
    /// is; it is 0 where the setting is not stable without latency.
    pub fn latency(&mut self, of: &impl AsCase) -> f64 {
        let case = of.case();
        match case.on_line.beyond() {
            Some(beyond) => along::latency(&case, &beyond),
            None => self.of_loop(&case).latency,
        }
    }

    /// The phase margin alone.
    pub fn phase(&mut self, of: &impl AsCase) -> f64 {
        let case = of.case();
        if case.setting.idle() {
            return f64::INFINITY;
        }
        let mut phase = f64::INFINITY;
        match Self::unit_loop(&case.on_line, |_, angle| phase = phase.min(angle.abs())) {
            Ok(()) => phase,
            Err(TooMany) => f64::NAN,
        }
    }

    /// Tells `each` the frequencies at which |L| = 1, and arg(−L) there. An error also where
    /// rounding leaves open whether |L| reaches 1.
    fn unit_loop(line: &impl OnLine, mut each: impl FnMut(f64, f64)) -> Result<(), TooMany> {
        let (end, mut known) = (line.unit_loop_bound(), true);
        zeros(&line.unit_loop(), end, |omega, crosses| {
            known &= crosses;
            each(omega, arg(line.negative_loop(omega)));
        })?;
        known.then_some(()).ok_or(TooMany)
    }
}

/// Relative changes of gain, delay and third parameter up to their own size.
const WHOLE: [f64; 3] = [1.0; 3];

/// The stability radius in gain, delay and slope.
#[must_use]
pub fn radius(of: &impl AsCase) -> Radius {
    radius_within(of, WHOLE, 0.0)
}

/// The stability radius in gain, delay and slope, as a part of the `extents` of their relative
/// changes; at most 1. `still` is d + g, what dashpots add to b: it does not change with the slope
/// of friction.
#[must_use]
pub fn radius_within(of: &impl AsCase, extents: [f64; 3], still: f64) -> Radius {
    let around = Surroundings {
        case: of.case(),
        third: Third::Slope(still),
        extents,
    };
    around.radius()
}

/// The stability radius in gain, delay and sliding velocity; the setting is the one at `v0`.
#[must_use]
pub fn radius_with_law(of: &impl AsCase, law: &SlidingLaw<'_>, v0: f64) -> Radius {
    let around = Surroundings {
        case: of.case(),
        third: Third::Velocity(v0, *law),
        extents: WHOLE,
    };
    around.radius()
}
