//! How far a stable digital loop is from the boundary: in gain, phase and latency.
//!
//! On z = e^(iφ) a zero of (1) of the room with q times k lies where
//!
//! ```text
//! k = p z^l w / (2 s |q|²) q*,   w = (1 + R) s − i (1 − R) c,   s + ic = i e^(−imφ/2)        (2)
//! ```
//!
//! is real, and |L| = 1 where 4 s² |q|² = |p|² |w|². All such angles are found, none is stepped
//! over; the count decides which of them matter.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::SampledLoop;
use super::circle::{Circle, value};
use super::line::slope;
use crate::linear::count::MarginalTolerance;
use crate::linear::line::Line;
use crate::linear::margins::{Limits, LoopMargins, Reach};
use crate::linear::real_zeros::{At, RealFunction, zeros};
use crate::linear::rounded::Rounded;
use crate::model::elementary::{arg, sincos};

/// Rounding errors that the sums here gather.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;
/// The longest further latency up to which the latency margin is looked for, in delays and in
/// samples.
const MOST_DELAYS: u64 = 1000;
const MOST_SAMPLES: u64 = 4096;

/// p z^l, q and w at an angle, with their slopes.
struct Parts {
    open: [Complex64; 2],
    held: [Complex64; 2],
    turn: [Complex64; 2],
    half_sine: f64,
}

/// A loop at a delay of `multiple` samples, on |z| = 1.
struct OnCircle<'l> {
    of: &'l SampledLoop,
    circle: Circle,
    multiple: f64,
}

impl OnCircle<'_> {
    fn parts(&self, angle: f64) -> Parts {
        let zeta = self.circle.zeta(angle);
        let turning = Complex64::i() * (zeta + 1.0);
        let [p, q] = [self.of.step.open, self.of.step.held].map(|c| value(c, zeta));
        let [p_slope, q_slope] =
            [self.of.step.open, self.of.step.held].map(|c| slope(c, zeta) * turning);
        let late = self.of.late as f64;
        let (sine, cosine) = sincos(late * angle);
        let turned = Complex64::new(cosine, sine);
        let (s, c) = sincos(0.5 * self.multiple * angle);
        let (more, less) = (1.0 + self.of.memory, 1.0 - self.of.memory);
        Parts {
            open: [turned * p, turned * (p_slope + Complex64::i() * late * p)],
            held: [q, q_slope],
            turn: [
                Complex64::new(more * s, -less * c),
                Complex64::new(more * c, less * s) * (0.5 * self.multiple),
            ],
            half_sine: s,
        }
    }

    /// Bounds up to `angle` on the sizes of p z^l and q and of their first and second slopes.
    fn bounds(&self, angle: f64) -> [[f64; 3]; 2] {
        let late = self.of.late as f64;
        let [p, q] = [self.of.step.open, self.of.step.held].map(|[c0, c1, c2]| {
            let [c0, c1, c2] = [c0.abs(), c1.abs(), c2.abs()];
            let far = angle.min(PI);
            let slope = c1 + 2.0 * c2 * far;
            [c0 + c1 * far + c2 * far * far, slope, slope + 2.0 * c2]
        });
        let turned = [
            p[0],
            p[1] + late * p[0],
            p[2] + 2.0 * late * p[1] + late * late * p[0],
        ];
        [turned, q]
    }

    /// |w|, |w′| and |w″| at most.
    fn turn_bounds(&self) -> [f64; 3] {
        let size = 1.0 + self.of.memory.abs();
        let half = 0.5 * self.multiple;
        [size, size * half, size * half * half]
    }
}

/// Bounds on a product and its slopes, from those of its factors.
fn times(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[0] * b[0],
        a[1] * b[0] + a[0] * b[1],
        a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2],
    ]
}

/// Im(p z^l q* w): 0 where k of (2) is real.
struct RealGain<'l>(OnCircle<'l>);

impl RealFunction for RealGain<'_> {
    fn at(&self, angle: f64) -> At {
        let Parts {
            open, held, turn, ..
        } = self.0.parts(angle);
        let product = open[0] * held[0].conj();
        let value = product * turn[0];
        let slope =
            (open[1] * held[0].conj() + open[0] * held[1].conj()) * turn[0] + product * turn[1];
        let [p, q] = self.0.bounds(angle);
        let sizes = times(times(p, q), self.0.turn_bounds());
        let turns = (self.0.multiple + self.0.of.late as f64) * angle;
        let rounding = ROUNDINGS * (1.0 + turns);
        At {
            omega: angle,
            value: Rounded::sum([value.im]).plus_error(rounding * sizes[0]),
            slope: Rounded::sum([slope.im]).plus_error(rounding * sizes[1]),
        }
    }

    fn bend(&self, angle: f64) -> f64 {
        let [p, q] = self.0.bounds(angle);
        times(times(p, q), self.0.turn_bounds())[2]
    }
}

/// 4 s² |q|² − |p|² |w|²: 0 where |L| = 1.
struct UnitLoop<'l>(OnCircle<'l>);

impl RealFunction for UnitLoop<'_> {
    fn at(&self, angle: f64) -> At {
        let Parts {
            open,
            held,
            turn,
            half_sine,
        } = self.0.parts(angle);
        let m = self.0.multiple;
        let (sine, _) = sincos(m * angle);
        let square = |c: [Complex64; 2]| {
            let slope = 2.0 * (c[0].conj() * c[1]).re;
            [c[0].norm_sqr(), slope]
        };
        let (p, q, w) = (square(open), square(held), square(turn));
        let s = [4.0 * half_sine * half_sine, 2.0 * m * sine];
        let [of_p, of_q] = self.0.bounds(angle);
        let sizes = [times(of_p, of_p), times(of_q, of_q)];
        let rounding = ROUNDINGS * (1.0 + m * angle);
        let size = |k: usize| {
            4.0 * (sizes[0][k] + sizes[1][k]) + 4.0 * m * (sizes[0][0] + sizes[1][0]) * k as f64
        };
        At {
            omega: angle,
            value: Rounded::sum([s[0] * q[0], -p[0] * w[0]]).plus_error(rounding * size(0)),
            slope: Rounded::sum([s[1] * q[0], s[0] * q[1], -p[1] * w[0], -p[0] * w[1]])
                .plus_error(rounding * size(1)),
        }
    }

    fn bend(&self, angle: f64) -> f64 {
        let [p, q] = self.0.bounds(angle);
        let m = self.0.multiple;
        let of_feedback = times(times(q, q), [4.0, 2.0 * m, 2.0 * m * m]);
        let w = self.0.turn_bounds();
        let of_open = times(times(p, p), times(w, w));
        of_feedback[2] + of_open[2]
    }
}

/// The longest latency, in samples, up to which a margin is looked for.
fn longest_latency(multiple: u64) -> u64 {
    MOST_DELAYS.saturating_mul(multiple).min(MOST_SAMPLES)
}

impl SampledLoop {
    fn on_circle(&self, multiple: u64) -> OnCircle<'_> {
        OnCircle {
            of: self,
            circle: Circle::new(0.0),
            multiple: multiple as f64,
        }
    }

    /// The loop with both gains `factor` times as large.
    #[must_use]
    pub fn with_gains(&self, factor: f64) -> Self {
        let mut scaled = *self;
        scaled.groups.a_v *= factor;
        scaled.groups.a_n *= factor;
        scaled.step.held = self.step.held.map(|c| factor * c);
        scaled
    }

    /// The factors of both gains between which the loop stays stable at a delay of `multiple`
    /// samples, where it is stable; NaN where that is not known.
    #[must_use]
    pub fn gain_margin(&self, multiple: u64) -> Limits {
        let on_circle = self.on_circle(multiple);
        let mut factors = Vec::new();
        let mut take = |angle: f64| {
            let parts = on_circle.parts(angle);
            let along = (parts.open[0] * parts.held[0].conj() * parts.turn[0]).re;
            let factor = along / (2.0 * parts.half_sine * parts.held[0].norm_sqr());
            if factor.is_finite() && factor > 0.0 {
                factors.push(factor);
            }
        };
        let found = zeros(&RealGain(self.on_circle(multiple)), PI, |angle, _| {
            take(angle.min(PI));
        });
        if !multiple.is_multiple_of(2) {
            take(PI);
        }
        if found.is_err() {
            return Limits::UNDECIDED;
        }
        factors.sort_by(f64::total_cmp);
        let stable = |factor: f64| self.with_gains(factor).n_unstable(multiple) == 0;
        let above = factors.partition_point(|factor| *factor <= 1.0);
        let upper = (above..factors.len()).find(|&i| {
            let next = factors.get(i + 1).map_or(2.0 * factors[i], |next| *next);
            !stable(0.5 * (factors[i] + next))
        });
        let lower = (0..above).rev().find(|&i| {
            let before = i.checked_sub(1).map_or(0.0, |i| factors[i]);
            !stable(0.5 * (factors[i] + before))
        });
        Limits {
            lower: lower.map_or(0.0, |i| factors[i]),
            upper: upper.map_or(f64::INFINITY, |i| factors[i]),
        }
    }

    /// The least phase, rad, of either sign by which the loop may turn at a delay of `multiple`
    /// samples; infinite where |L| is 1 nowhere, NaN where that is not known.
    #[must_use]
    pub fn phase_margin(&self, multiple: u64) -> f64 {
        let on_circle = self.on_circle(multiple);
        let mut least = f64::INFINITY;
        let found = zeros(&UnitLoop(self.on_circle(multiple)), PI, |angle, _| {
            let parts = on_circle.parts(angle.min(PI));
            // −L = 2 s q / (p z^l w).
            let turned = parts.held[0] * parts.half_sine / (parts.open[0] * parts.turn[0]);
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
            latency: latency.map_or(f64::INFINITY, |samples| samples as f64 * self.sample_time),
        }
    }
}
