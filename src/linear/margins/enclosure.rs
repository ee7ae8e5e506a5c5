//! The characteristic function over boxes: all its values for frequencies, gains, delays, slopes
//! and latencies within intervals.
//!
//! ```text
//! D = λ² + bλ + 1 − k A (1 − e^(−λτ)) e^(−λδ),   A = a_n + a_v (b + λ),   λ = −σ + iω       (1)
//! ```
//!
//! Both gains are k times as large as at the centre, δ is a latency of the feedback. A friction
//! law makes b and a_n functions of the sliding velocity. Beyond the letter's own feedback
//!
//! ```text
//! D = B(1 − R e^(−λτ)) − k A (1 − e^(−λτ)) e^(−λδ),   B = (λ² + bλ + 1) L_a L_v L_s
//! A = (a_n + d a_v) L_v + a_v (b − d + λ) L_a                                              (2)
//! ```
//!
//! d being the dashpot beside the spring, which a_n feels.

use num_complex::Complex64;

use super::affine::Affine;
use super::beyond::Beyond;
use crate::model::groups::{feedback, open_loop};
use crate::model::{Control, FrictionLaw, Groups, Oscillator, SlidingPoint};

/// What (1) depends on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point<const V: usize> {
    pub lambda: Affine<V>,
    pub factor: Affine<V>,
    pub tau: Affine<V>,
    pub b: Affine<V>,
    pub a_n: Affine<V>,
    pub a_v: f64,
    /// δ, where it is not 0.
    pub latency: Option<Affine<V>>,
    /// The variable on which b and a_n depend by a law that is not straight.
    pub law: Option<usize>,
    /// Memory, latency, lags and a damped spring.
    pub beyond: Option<Beyond>,
}

/// What D is made of over a box, at any delay.
pub(super) struct Parts<const V: usize> {
    /// B.
    pub open: Affine<V>,
    /// k A, with e^(−λδ) beyond the letter.
    pub feedback: Affine<V>,
    /// R.
    pub memory: f64,
    /// λδ, where there is a latency.
    late: Option<Affine<V>>,
}

/// D over a box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Enclosed<const V: usize> {
    pub value: Affine<V>,
    /// How much each variable changes D: the box is halved along the one that changes it most.
    pub weights: [f64; V],
}

impl<const V: usize> Point<V> {
    /// What (1) or (2) is made of, without the latency of the former.
    #[inline]
    pub(super) fn parts(&self) -> Parts<V> {
        let Self {
            lambda, factor, b, ..
        } = *self;
        let one = Affine::constant(1.0.into());
        let mut open = open_loop(b, lambda);
        let Some(beyond) = &self.beyond else {
            return Parts {
                open,
                feedback: factor * feedback(self.a_n, self.a_v, b + lambda),
                memory: 0.0,
                late: None,
            };
        };
        let lag = |time: f64| one + lambda.scaled(time);
        let passing = |number: Affine<V>, time: f64| match time {
            0.0 => number,
            time => number * lag(time),
        };
        for time in beyond.lags.times() {
            open = passing(open, time);
        }
        let mut shares = [self.a_n, (b + lambda).scaled(self.a_v)];
        if beyond.damping != 0.0 {
            let coupled = Affine::constant((beyond.damping * self.a_v).into());
            shares = [shares[0] + coupled, shares[1] - coupled];
        }
        let load = passing(shares[0], beyond.lags.velocity);
        let velocity = passing(shares[1], beyond.lags.load);
        let feedback = factor * (load + velocity);
        let fixed = || match beyond.channel.latency {
            0.0 => None,
            latency => Some(lambda.scaled(latency)),
        };
        let late = self.latency.map_or_else(fixed, |l| Some(lambda * l));
        Parts {
            open,
            feedback: late.map_or(feedback, |l| feedback * l.scaled(-1.0).exponential()),
            memory: beyond.channel.memory,
            late,
        }
    }

    /// D, (1) or (2).
    pub(super) fn enclosed(&self) -> Enclosed<V> {
        let Self { lambda, .. } = *self;
        let one = Affine::constant(1.0.into());
        let angle = lambda * self.tau;
        let Parts {
            open,
            feedback,
            memory,
            late,
        } = self.parts();
        let delayed = angle.scaled(-1.0).exponential();
        let mut control = feedback * (one - delayed);
        let mut turns = angle;
        let mut strength = feedback.centre.l1_norm() + feedback.spread();
        let mut value = open;
        if self.beyond.is_none() {
            if let Some(latency) = self.latency {
                let late = lambda * latency;
                control = control * late.scaled(-1.0).exponential();
                turns = turns + late;
            }
        } else {
            if let Some(late) = late {
                turns = turns + late;
                strength += feedback.rest;
            }
            if memory != 0.0 {
                value = open * (one - delayed.scaled(memory));
                strength += memory.abs() * (open.centre.l1_norm() + open.spread());
            }
        }
        let value = value - control;
        // A wide angle leaves no parts to judge by.
        let mut weights = [0.0; V];
        for (i, weight) in weights.iter_mut().enumerate() {
            *weight = value.part[i].l1_norm() + strength * turns.part[i].l1_norm();
        }
        // Nor does a wide range of a law.
        if let Some(variable) = self.law {
            let by_b = lambda.centre.l1_norm() + lambda.spread() + 2.0 * self.a_v.abs();
            weights[variable] += self.b.rest * by_b + 2.0 * self.a_n.rest;
        }
        Enclosed { value, weights }
    }

    /// λ = −σ + iω.
    pub(super) fn on_line(decay: f64, omega: (f64, f64)) -> Affine<V> {
        let lambda = Affine::between(omega, 0).turned();
        lambda - Affine::constant(decay.into())
    }
}

/// A bound on the size of any root with Re λ ≥ −σ, for groups up to these sizes: |1 − E| times the
/// size of a latency's factor is at most `control`. Infinite where a group has no bound.
pub(super) fn root_bound(b: f64, a_v: f64, a_n: f64, control: f64) -> f64 {
    let linear = b.abs() + control * a_v.abs();
    let constant = 1.0 + control * (b.abs() * a_v.abs() + a_n.abs());
    let bound = 0.5 * (linear + (linear * linear + 4.0 * constant).sqrt());
    if bound.is_nan() { f64::INFINITY } else { bound }
}

/// The slope μ_K′ of a law as a variable of its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slope {
    /// The number of that variable.
    pub variable: usize,
    /// Only slopes between these are asked for.
    pub between: (f64, f64),
}

/// How b and a_n depend on the sliding velocity.
#[derive(Debug, Clone, Copy)]
pub struct SlidingLaw<'a> {
    /// μ_K(v).
    pub law: &'a FrictionLaw,
    /// The block.
    pub oscillator: &'a Oscillator,
    /// The gains of the control.
    pub control: Control,
}

impl SlidingLaw<'_> {
    /// The largest |b| and |a_n| over velocities in `between`.
    pub(super) fn largest(&self, between: (f64, f64)) -> (f64, f64) {
        let all = self.enclosed::<1>(between, 0, None);
        let reach = |z: Affine<1>| z.centre.l1_norm() + z.spread() + z.rest;
        let [b, a_n] = all.map_or([f64::INFINITY; 2], |all| all.map(reach));
        (b, a_n)
    }

    /// The groups at the sliding velocity `v0` > 0.
    #[must_use]
    pub fn groups(&self, v0: f64) -> Groups {
        let sliding = SlidingPoint {
            mu_k: self.law.mu_k(v0),
            mu_prime: self.law.mu_prime(v0),
        };
        self.oscillator.groups(sliding, self.control)
    }

    /// b and a_n over velocities in `between`, the variable number `variable`, as far as the slope
    /// μ_K′ lies within that of `jump`; none where it nowhere does. Where the slope jumps in
    /// between, it is the variable of `jump`.
    pub(super) fn enclosed<const V: usize>(
        &self,
        between: (f64, f64),
        variable: usize,
        jump: Option<Slope>,
    ) -> Option<[Affine<V>; 2]> {
        let middle = 0.5 * (between.0 + between.1);
        let half = 0.5 * (between.1 - between.0);
        let at = self.groups(middle);
        // The groups grow evenly with μ_K and μ_K′.
        let unit = self.oscillator.groups_per_parameter(SlidingPoint {
            mu_k: self.control.alpha_n,
            mu_prime: 1.0,
        });
        let still = self.oscillator.dashpot_ratios().sum();
        let unbounded = |value: f64, unit: f64| Affine {
            rest: if unit == 0.0 { 0.0 } else { f64::INFINITY },
            ..Affine::constant(value.into())
        };
        let within = |unit: f64, (low, high): (f64, f64)| {
            if !(high - low).is_finite() {
                return unbounded(still, unit);
            }
            let mut number = Affine::constant((0.5 * unit * (low + high) + still).into());
            let half = 0.5 * unit.abs() * (high - low) * (1.0 + 1e-12);
            match jump {
                // Real, which the rest is not known to be.
                Some(jump) => number.part[jump.variable] = half.into(),
                None => number.rest = half,
            }
            number
        };
        // `shift` ≥ 0 is the part of the value that the law does not change.
        let along = |value: f64, shift: f64, unit: f64, (low, high): (f64, f64)| {
            if !(high - low).is_finite() {
                return unbounded(value, unit);
            }
            let mut number = Affine::constant(value.into());
            let (steep, spread) = (0.5 * (low + high), 0.5 * (high - low));
            number.part[variable] = Complex64::from(unit * steep * half);
            let size = (value - shift).abs() + shift + (unit * steep * half).abs();
            let rounding = 64.0 * f64::EPSILON * size;
            // The slope over the box may lie anywhere between both.
            number.rest = unit.abs() * spread * half * (1.0 + 1e-12) + rounding;
            number
        };
        let slopes = self.law.slopes_between(between.0, between.1);
        let allowed = jump.map_or(slopes, |jump| {
            (slopes.0.max(jump.between.0), slopes.1.min(jump.between.1))
        });
        if allowed.0 > allowed.1 {
            return None;
        }
        let bends = self.law.curvatures_between(between.0, between.1);
        let b = match bends.0.is_finite() {
            true => along(at.b, still, unit.b, bends),
            // The slope jumps: all that is known is its range.
            false => within(unit.b, allowed),
        };
        Some([b, along(at.a_n, 0.0, unit.a_n, slopes)])
    }
}
