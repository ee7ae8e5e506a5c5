//! How far a stable digital loop is from the boundary: in phase, latency and delay.
//!
//! By (2) of `on_circle` |L| = 1 where 4 s² |q|² = |p|² |w|². All such angles are found, none is
//! stepped over.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::SampledLoop;
use super::on_circle::{OnCircle, ROUNDINGS, times};
use crate::linear::count::MarginalTolerance;
use crate::linear::line::Line;
use crate::linear::margins::{Limits, LoopMargins, Reach};
use crate::linear::real_zeros::{At, RealFunction, zeros};
use crate::linear::rounded::Rounded;
use crate::model::elementary::arg;

/// The longest further latency up to which the latency margin is looked for, in delays and in
/// samples.
const MOST_DELAYS: u64 = 1000;
const MOST_SAMPLES: u64 = 4096;

/// 4 s² |q|² − |p|² |w|²: 0 where |L| = 1.
struct UnitLoop<'l>(OnCircle<'l>);

impl UnitLoop<'_> {
    /// Bounds on the sizes of its two terms, and on their slopes.
    fn bounds(&self, angle: f64) -> [[f64; 3]; 2] {
        let on = &self.0;
        let square = |a: [f64; 3]| times(a, a);
        let held = square(on.bounds(on.of.step.held, angle));
        let open = times(on.open_bounds(angle), on.turn_bounds());
        // Of 4 s² = 2 − 2 cos mφ.
        let m = on.multiple;
        [times(held, [4.0, 2.0 * m, 2.0 * m * m]), square(open)]
    }
}

impl RealFunction for UnitLoop<'_> {
    fn at(&self, angle: f64) -> At {
        let on = &self.0;
        let parts = on.parts(angle);
        let square = |c: [Complex64; 2]| {
            let slope = 2.0 * (c[0].conj() * c[1]).re;
            [c[0].norm_sqr(), slope]
        };
        let held = square(on.value(on.of.step.held, angle));
        let (p, w) = (square(parts.open), square(parts.turn));
        let s = square(parts.twice_sine.map(Complex64::from));
        let [of_held, of_open] = self.bounds(angle);
        let rounding = ROUNDINGS * (1.0 + on.multiple * angle);
        let size = |k: usize| rounding * (of_held[k] + of_open[k]);
        At {
            omega: angle,
            value: Rounded::sum([s[0] * held[0], -p[0] * w[0]]).plus_error(size(0)),
            slope: Rounded::sum([s[1] * held[0], s[0] * held[1], -p[1] * w[0], -p[0] * w[1]])
                .plus_error(size(1)),
        }
    }

    fn bend(&self, angle: f64) -> f64 {
        let [of_held, of_open] = self.bounds(angle);
        of_held[2] + of_open[2]
    }
}

/// The longest latency, in samples, up to which a margin is looked for.
fn longest_latency(multiple: u64) -> u64 {
    MOST_DELAYS.saturating_mul(multiple).min(MOST_SAMPLES)
}

impl SampledLoop {
    /// The least phase, rad, of either sign by which the loop may turn at a delay of `multiple`
    /// samples; infinite where |L| is 1 nowhere, NaN where that is not known.
    #[must_use]
    pub fn phase_margin(&self, multiple: u64) -> f64 {
        let unit = UnitLoop(OnCircle::new(self, multiple));
        let mut least = f64::INFINITY;
        let found = zeros(&unit, PI, |angle, _| {
            let angle = angle.min(PI);
            let parts = unit.0.parts(angle);
            let [held, _] = unit.0.value(self.step.held, angle);
            // −L = 2 s q / (p z^l w).
            let turned = held * parts.twice_sine[0] / (parts.open[0] * parts.turn[0]);
            least = least.min(arg(turned).abs());
        });
        match found {
            Ok(()) => least,
            Err(_) => f64::NAN,
        }
    }

    /// The largest latency, in samples and counted from none, up to which the loop is stable at a
    /// delay of `multiple` samples: 0 where it is not without latency; none where it is up to a
    /// thousand delays or 4096 samples.
    #[must_use]
    pub fn latency_margin(&self, multiple: u64) -> Option<u64> {
        let lost = (0..=longest_latency(multiple)).find(|&late| {
            let with_latency = Self { late, ..*self };
            with_latency.n_unstable(multiple) != 0
        });
        lost.map(|late| late.saturating_sub(1))
    }

    /// How far upper limits are looked for; times in units of √(M/κ).
    #[must_use]
    pub fn reach(&self, multiple: u64) -> Reach {
        Reach {
            gain: f64::INFINITY,
            delay: f64::INFINITY,
            latency: longest_latency(multiple) as f64 * self.sample_time,
        }
    }

    /// The loop without its latency.
    fn without_latency(&self) -> Self {
        Self { late: 0, ..*self }
    }

    /// Whether the loop is stable at a delay of `multiple` samples, beyond doubt.
    #[must_use]
    pub fn is_stable(&self, multiple: u64) -> bool {
        let tau = multiple as f64 * self.sample_time;
        let count = self.line(1.0).count(tau, MarginalTolerance::default());
        count.is_some_and(|count| count.stable())
    }

    /// The nearest multiples of the sample time around a stable one at which the loop is not
    /// stable, in units of √(M/κ): 0 below where there is none.
    #[must_use]
    pub fn stable_delays_around(&self, multiple: u64) -> Limits {
        let (line, h) = (self.line(1.0), self.sample_time);
        let tau = multiple as f64 * h;
        let around = line
            .stable_intervals()
            .find(|inside| inside.from < tau + 0.5 * h && tau < inside.to + 0.5 * h);
        around.map_or(Limits::UNDECIDED, |inside| Limits {
            lower: (inside.from - h).max(0.0),
            upper: inside.to + h,
        })
    }

    /// Phase and latency margins; the latency in units of √(M/κ).
    #[must_use]
    pub fn loop_margins(&self, multiple: u64) -> LoopMargins {
        let phase = self.phase_margin(multiple);
        // Where |L| is 1 nowhere, no latency loses stability.
        let endless = phase == f64::INFINITY && self.without_latency().is_stable(multiple);
        let latency = match endless {
            true => None,
            false => self.latency_margin(multiple),
        };
        LoopMargins {
            phase,
            phase_omega: f64::NAN,
            latency: latency.map_or(f64::INFINITY, |samples| samples as f64 * self.sample_time),
        }
    }
}
