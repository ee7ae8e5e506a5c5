//! Where lobes of feedback with memory and latency end: the slope b below which no delay is stable.
//!
//! ```text
//! D = B (1 − R E) − g L e^(−λδ) (1 − E),   B = λ² + bλ + 1,   L = b − d + λ or 1             (1)
//! ```
//!
//! A lobe shrinks to a point in one of two ways: a pair of roots on the axis is double there, D =
//! D′ = 0 at iω, a cusp of the crossing curve; or two curves touch from opposite sides, D = 0 at
//! iω₁ and at iω₂. Where these conditions leave freedom (the touch, or a latency that is free), b
//! is the smallest under them: the gradient of b is a combination of theirs,
//!
//! ```text
//! C(y) = 0,   Σ_k μ_k ∂C_k/∂y = ∂b/∂y,   y = (b, g, τ[, δ], ω…)                               (2)
//! ```
//!
//! which Newton's method solves for y and μ. It starts from the lobe's end without memory and
//! latency and follows it along both.
//!
//! - `small`: a few equations in a few unknowns

mod small;

use num_complex::Complex64;
use small::{MOST, Values, differences, solve};

use super::polynomial::Polynomial;
use super::right_of::RootCounter;
use super::system::System;
use super::turning::RightOf;
use crate::linear::characteristic::{late, one_minus_exp};
use crate::linear::lobes::LobeControl;
use crate::model::Channel;
use crate::model::groups::{open_loop, open_loop_coefficients};

/// Longest steps along the memory and the latency.
const MEMORY_STEP: f64 = 0.01;
const LATENCY_STEP: f64 = 0.02;
/// A latency longer than this is not looked at for the best one.
const LONGEST_LATENCY: f64 = 20.0;
const MOST_ITERATIONS: u32 = 60;
/// A step of Newton's method changes no unknown by more than this.
const LONGEST: f64 = 0.1;
/// How far right of the axis another root is one that is unstable: a double root is blurred.
const BESIDE: f64 = 1e-3;
/// Distances from the frequency of a double pair at which two pairs are looked for.
const APART: [f64; 3] = [0.05, 0.2, 0.4];

/// The latency of the feedback.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Latency {
    /// δ ≥ 0.
    Given(f64),
    /// The one with which the lobe reaches farthest.
    Best,
}

/// How a lobe ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// A double pair lies on the axis.
    DoublePair,
    /// Two pairs lie on the axis, and their curves touch.
    TwoPairs,
}

/// The point to which a lobe of stable delays shrinks, dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LobeEnd {
    /// The slope b* < 0.
    pub b: f64,
    /// The gain a_v or a_n.
    pub gain: f64,
    /// The delay τ*.
    pub tau: f64,
    /// The latency δ.
    pub latency: f64,
    /// The frequencies on the axis, the smaller one first; both the same for a double pair.
    pub omega: [f64; 2],
    /// How it ends.
    pub touch: Touch,
}

/// What is solved for.
#[derive(Clone, Copy)]
struct Problem {
    control: LobeControl,
    memory: f64,
    /// δ where it is given.
    latency: Option<f64>,
    touch: Touch,
}

/// Where lobe number `lobe` of pure control ends (0 is the one at the shortest delays), with memory
/// −1 < R < 1 and latency; none where it is not followed as far, or where other roots are unstable
/// there.
///
/// # Examples
///
/// ```
/// use slipmap::linear::general::ends::{Latency, lobe_end};
/// use slipmap::linear::lobes::LobeControl;
///
/// // The latency with which velocity control reaches farthest.
/// let end = lobe_end(LobeControl::Velocity { damping: 0.0 }, 0, 0.0, Latency::Best)
///     .expect("it is followed");
/// assert!((end.b - -0.757_701_628_5).abs() < 1e-9);
/// assert!((end.latency - 0.535_990_8).abs() < 1e-6);
/// ```
#[must_use]
pub fn lobe_end(control: LobeControl, lobe: u32, memory: f64, latency: Latency) -> Option<LobeEnd> {
    let plain = control.lobe_end(lobe);
    let mut end = LobeEnd {
        b: plain.b,
        gain: plain.gain,
        tau: plain.tau,
        latency: 0.0,
        omega: [plain.omega; 2],
        touch: Touch::DoublePair,
    };
    let mut problem = Problem {
        control,
        memory: 0.0,
        latency: Some(0.0),
        touch: Touch::DoublePair,
    };
    match latency {
        Latency::Given(to) => {
            for latency in steps(to, LATENCY_STEP) {
                problem.latency = Some(latency);
                end = problem.solved(&end)?;
            }
        }
        Latency::Best => {
            end = problem.farthest(&end)?;
            if end.latency > 0.0 {
                problem.latency = None;
            }
        }
    }
    problem.along_memory(end, memory)
}

/// Values from a step above 0 up to `to`, evenly.
fn steps(to: f64, longest: f64) -> impl Iterator<Item = f64> {
    let count = (to.abs() / longest).ceil();
    (1..=count as u32).map(move |i| {
        if f64::from(i) == count {
            to
        } else {
            to * f64::from(i) / count
        }
    })
}

impl Problem {
    /// The end with the best latency, from the one without.
    fn farthest(mut self, plain: &LobeEnd) -> Option<LobeEnd> {
        let mut best = *plain;
        for latency in steps(LONGEST_LATENCY, LATENCY_STEP) {
            self.latency = Some(latency);
            let next = self.solved(&best)?;
            if next.b > best.b {
                break;
            }
            best = next;
        }
        if best.latency == 0.0 {
            return Some(best);
        }
        self.latency = None;
        self.solved(&best)
    }

    /// Follows the end from R = 0, where it is `end`, to R = `memory`.
    fn along_memory(mut self, end: LobeEnd, memory: f64) -> Option<LobeEnd> {
        let (mut double, mut two): (Option<LobeEnd>, Option<LobeEnd>) = (Some(end), None);
        for memory in steps(memory, MEMORY_STEP) {
            self.memory = memory;
            let as_double = Self {
                touch: Touch::DoublePair,
                ..self
            };
            let as_two = Self {
                touch: Touch::TwoPairs,
                ..self
            };
            let before = double;
            double = double.and_then(|end| as_double.solved(&end));
            let start = two.or_else(|| before.and_then(|end| as_two.split(&end)));
            two = start.and_then(|end| as_two.solved(&end)).filter(|end| {
                // Not the double pair once more.
                end.omega[1] - end.omega[0] > 1e-3
            });
        }
        let found = [double, two].into_iter().flatten();
        found
            .filter(|end| self.alone(end))
            .min_by(|a, b| a.b.total_cmp(&b.b))
    }

    /// Two pairs near a double one.
    fn split(&self, double: &LobeEnd) -> Option<LobeEnd> {
        APART.iter().find_map(|apart| {
            let omega = double.omega[0];
            let start = LobeEnd {
                omega: [omega - apart, omega + apart],
                touch: Touch::TwoPairs,
                ..*double
            };
            let end = self.solved(&start)?;
            (end.omega[0] > 0.0 && end.omega[1] - end.omega[0] > 1e-3).then_some(end)
        })
    }

    fn unknowns(&self, end: &LobeEnd) -> Values {
        let mut y = Values::NONE;
        for x in [end.b, end.gain, end.tau] {
            y.push(x);
        }
        if self.latency.is_none() {
            y.push(end.latency);
        }
        y.push(end.omega[0]);
        if self.touch == Touch::TwoPairs {
            y.push(end.omega[1]);
        }
        y
    }

    fn end(&self, y: &[f64]) -> LobeEnd {
        let frequencies = if self.latency.is_none() { 4 } else { 3 };
        let first = y[frequencies].abs();
        let second = match self.touch {
            Touch::DoublePair => first,
            Touch::TwoPairs => y[frequencies + 1].abs(),
        };
        LobeEnd {
            b: y[0],
            gain: y[1],
            tau: y[2],
            latency: self.latency.unwrap_or(y[3]),
            omega: [first.min(second), first.max(second)],
            touch: self.touch,
        }
    }

    /// D and D′ at iω.
    fn at(&self, y: &[f64], omega: f64) -> [Complex64; 2] {
        let (b, gain, tau) = (y[0], y[1], y[2]);
        let latency = self.latency.unwrap_or(y[3]);
        let lambda = Complex64::new(0.0, omega);
        let (shape, slope) = match self.control {
            LobeControl::Velocity { damping } => (b - damping + lambda, 1.0),
            LobeControl::PositiveLoad => (Complex64::new(1.0, 0.0), 0.0),
        };
        let (late, difference) = (late(latency, lambda), one_minus_exp(-tau * lambda));
        let echo = 1.0 - difference;
        let (open, open_slope) = (open_loop(b, lambda), 2.0 * lambda + b);
        let kept = 1.0 - self.memory * echo;
        let value = open * kept - gain * shape * late * difference;
        let fed = (slope - latency * shape) * difference + tau * shape * echo;
        let by_lambda = open_slope * kept + open * self.memory * tau * echo - gain * late * fed;
        [value, by_lambda]
    }

    /// C(y) of (2), the conditions on the end.
    fn conditions(&self, y: &[f64]) -> Values {
        let frequencies = if self.latency.is_none() { 4 } else { 3 };
        let mut values = Values::NONE;
        let [first, slope] = self.at(y, y[frequencies]);
        let second = match self.touch {
            Touch::DoublePair => slope,
            Touch::TwoPairs => self.at(y, y[frequencies + 1])[0],
        };
        for x in [first.re, first.im, second.re, second.im] {
            values.push(x);
        }
        values
    }

    /// What has to vanish in (2): C(y), and what is left of the gradient of b.
    fn equations(&self, z: &[f64], unknowns: usize) -> Values {
        let (y, multipliers) = z.split_at(unknowns);
        let mut values = self.conditions(y);
        let slopes = differences(&|y| self.conditions(y), y);
        for (i, column) in slopes[..unknowns].iter().enumerate() {
            let sum: f64 = column
                .all()
                .iter()
                .zip(multipliers)
                .map(|(a, b)| a * b)
                .sum();
            values.push(sum - if i == 0 { 1.0 } else { 0.0 });
        }
        values
    }

    /// The end that Newton's method reaches from `start`.
    fn solved(&self, start: &LobeEnd) -> Option<LobeEnd> {
        let mut z = self.unknowns(start);
        let unknowns = z.count;
        for multiplier in self.multipliers(z.all())? {
            z.push(multiplier);
        }
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let equations = |z: &[f64]| self.equations(z, unknowns);
            let slopes = differences(&equations, z.all());
            let values = equations(z.all());
            let step = solve(&slopes[..z.count], values.all())?;
            let relative = |i: usize| step[i].abs() / z.of[i].abs().max(1.0);
            let size = (0..unknowns).map(relative).fold(0.0, f64::max);
            if !size.is_finite() {
                return None;
            }
            let part = (LONGEST / size).min(1.0);
            for (x, by) in z.of.iter_mut().zip(step) {
                *x -= part * by;
            }
            // At the level of rounding steps no longer shrink.
            if size < 1e-14 || (size < 1e-7 && size >= 0.5 * last) {
                let end = self.end(z.all());
                let sound = end.latency >= 0.0 && end.tau > 0.0;
                return (sound && self.opposed(&z, unknowns)).then_some(end);
            }
            last = size;
        }
        None
    }

    /// μ of (2) by least squares.
    fn multipliers(&self, y: &[f64]) -> Option<Vec<f64>> {
        let slopes = differences(&|y| self.conditions(y), y);
        let slopes = &slopes[..y.len()];
        let count = slopes[0].count;
        let mut columns = [Values::NONE; MOST];
        let mut right = Values::NONE;
        for (j, column) in columns.iter_mut().enumerate().take(count) {
            for i in 0..count {
                let sum: f64 = slopes.iter().map(|of| of.of[i] * of.of[j]).sum();
                column.push(sum);
            }
            right.push(slopes[0].of[j]);
        }
        solve(&columns[..count], right.all()).map(|x| x[..count].to_vec())
    }

    /// Whether neither of two pairs can move left without the other moving right; only then is b
    /// the end.
    fn opposed(&self, z: &Values, unknowns: usize) -> bool {
        if self.touch == Touch::DoublePair {
            return true;
        }
        let (y, multipliers) = z.all().split_at(unknowns);
        let frequencies = &y[unknowns - 2..];
        // Σ μ_k δC_k = −Σ c_j δ(Re λ_j) with c_j of the sign of Re(μ* D′).
        let weights = [0, 1].map(|j| {
            let slope = self.at(y, frequencies[j])[1];
            multipliers[2 * j] * slope.re + multipliers[2 * j + 1] * slope.im
        });
        weights.iter().all(|weight| *weight > 0.0)
    }

    /// Whether no further root is unstable at `end`.
    fn alone(&self, end: &LobeEnd) -> bool {
        let shape = match self.control {
            LobeControl::Velocity { damping } => [end.gain * (end.b - damping), end.gain],
            LobeControl::PositiveLoad => [end.gain, 0.0],
        };
        let polynomials = [
            Polynomial::new(&open_loop_coefficients(end.b)),
            Polynomial::new(&shape),
        ];
        let [Ok(open), Ok(gain)] = polynomials else {
            return false;
        };
        let channel = Channel {
            memory: self.memory,
            latency: end.latency,
        };
        let system = System::feedback(open, gain, channel);
        RootCounter::new(&system).right_of(end.tau, BESIDE) == RightOf::Roots(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::general::DelayLine;

    fn velocity(memory: f64, latency: Latency) -> LobeEnd {
        lobe_end(LobeControl::Velocity { damping: 0.0 }, 0, memory, latency).unwrap()
    }

    /// Ends that were found by other means.
    #[test]
    fn ends_with_memory() {
        for (memory, b, touch) in [
            (0.0, -0.725_635_939_603, Touch::DoublePair),
            (0.2, -0.810_159_594_157, Touch::DoublePair),
            (0.406_023_622, -0.844_902_417_138, Touch::DoublePair),
            (0.6, -0.837_270_501_176, Touch::TwoPairs),
            (0.8, -0.862_781_983_912, Touch::TwoPairs),
            (0.9, -0.894_293_358_245, Touch::TwoPairs),
            (0.99, -0.962_243_077_923, Touch::TwoPairs),
        ] {
            let end = velocity(memory, Latency::Given(0.0));
            assert!((end.b - b).abs() < 2e-12, "{memory}: {end:?}");
            assert_eq!(end.touch, touch, "{memory}: {end:?}");
        }
        let fold = velocity(0.406_023_622, Latency::Given(0.0));
        assert!((fold.gain - -0.487_972_370).abs() < 1e-9, "{fold:?}");
        assert!((fold.tau - 5.603_338_849).abs() < 1e-9, "{fold:?}");
        for (memory, b) in [(0.4, -0.2592), (0.8, -0.0725)] {
            let end = lobe_end(LobeControl::PositiveLoad, 0, memory, Latency::Given(0.0)).unwrap();
            assert!((end.b - b).abs() < 5e-5, "{memory}: {end:?}");
        }
    }

    #[test]
    fn ends_with_the_best_latency() {
        let end = velocity(0.0, Latency::Best);
        for (found, known) in [
            (end.b, -0.757_701_628_504),
            (end.latency, 0.535_990_843),
            (end.gain, -0.298_893_907),
            (end.tau, 3.368_930_641),
        ] {
            assert!((found - known).abs() < 2e-9, "{end:?}");
        }
        assert!((end.b - -0.757_701_628_504).abs() < 2e-12, "{end:?}");
        // Scans gave −0.905, −1.05, −1.19 and −1.34 to within 0.005.
        for (memory, b, near) in [
            (0.2, -0.905_467_709_244, -0.905),
            (0.4, -1.050_528_351_167, -1.05),
            (0.6, -1.194_618_324_891, -1.19),
            (0.8, -1.344_049_148_323, -1.34),
        ] {
            let end = velocity(memory, Latency::Best);
            assert!((end.b - near).abs() < 0.005, "{memory}: {end:?}");
            assert!((end.b - b).abs() < 2e-12, "{memory}: {end:?}");
        }
        let limit = -(1.0 + std::f64::consts::SQRT_2).sqrt();
        let gaps = [0.9, 0.99, 0.999].map(|memory| velocity(memory, Latency::Best).b - limit);
        assert!(gaps.is_sorted_by(|a, b| *a > 2.0 * b), "{gaps:?}");
        assert!(gaps[2] > 0.0 && gaps[2] < 6e-3, "{gaps:?}");
    }

    /// A longest stable stretch of delays near an end, at `b`.
    fn stable_near(end: &LobeEnd, memory: f64, b: f64) -> bool {
        // The lobe is as wide in the gain as the root of what b is beside its end, or so.
        let gains = (-400..=400).map(|i| end.gain * (1.0 + 1e-4 * f64::from(i)));
        let shifts = [-0.01, -0.003, 0.0, 0.003, 0.01];
        gains.into_iter().any(|gain| {
            shifts.iter().any(|shift| {
                let latency = match end.latency {
                    0.0 if *shift == 0.0 => 0.0,
                    0.0 => return false,
                    latency => latency + shift,
                };
                let open = Polynomial::new(&[1.0, b, 1.0]).unwrap();
                let gain = Polynomial::new(&[gain * b, gain]).unwrap();
                let line =
                    DelayLine::of(&System::feedback(open, gain, Channel { memory, latency }));
                let mut stable = line.stable_intervals().take(8);
                stable.any(|s| s.from < end.tau + 0.2 && end.tau - 0.2 < s.to)
            })
        })
    }

    #[test]
    fn stable_above_an_end_and_not_below() {
        for (memory, latency) in [
            (0.0, Latency::Given(0.0)),
            (0.406_023_622, Latency::Given(0.0)),
            (0.8, Latency::Given(0.0)),
            (0.0, Latency::Best),
            (0.4, Latency::Best),
        ] {
            let end = velocity(memory, latency);
            assert!(stable_near(&end, memory, end.b + 1e-5), "{memory}: {end:?}");
            assert!(
                !stable_near(&end, memory, end.b - 1e-5),
                "{memory}: {end:?}"
            );
        }
    }
}
