//! A stuck block whose elongation grows evenly: its steps have no end but release.

use super::{Motion, ROUNDING};
use crate::model::Feedback;
use crate::model::series::spread;
use crate::slip::step::Step;

/// How evenly the elongation of a stuck block has to grow, in units of the error of a step.
const EVEN: f64 = 0.1;

impl Motion {
    /// The rate v at which the elongation of a stuck block grows evenly: v = v0 + α_v v τ/(1 − R),
    /// or the limit of v that is next to it.
    /// Other modes of growth die out where α_v τ < 1; else the rate is None.
    ///
    /// With memory or latency they die out where |α_v| τ/(1 − |R|) < 1: a change of ȧ then comes
    /// back through S smaller than it was.
    pub(super) fn even_rate(&self) -> Option<f64> {
        let p = &self.parameters;
        let share = p.feedback.gains.alpha_v * p.feedback.tau / (1.0 - p.feedback.channel.memory);
        let least = match p.feedback.echoes() {
            true => {
                p.feedback.gains.alpha_v.abs() * p.feedback.tau
                    / (1.0 - p.feedback.channel.memory.abs())
            }
            false => share,
        };
        (least < 1.0).then(|| p.feedback.limits.velocity_of(p.v0 / (1.0 - share)))
    }

    /// Whether the elongation of a stuck block has grown evenly, and the signal been constant, for
    /// a delay and for a latency. Both then go on so until release.
    pub(super) fn sticks_evenly(&self) -> bool {
        let p = &self.parameters;
        self.even_since + p.feedback.tau.max(p.feedback.channel.latency) <= self.t
    }

    /// Fills the polynomials of a block that sticks evenly, which hold for ever.
    pub(super) fn stick_evenly(&mut self, rate: f64) -> f64 {
        let Feedback { gains, limits, .. } = self.parameters.feedback;
        let signal = self.even_signal(rate);
        let damping = self.parameters.dashpots.damping;
        let step = &mut self.step;
        let Step {
            u,
            a,
            n,
            force,
            delayed,
            ..
        } = step;
        for c in [u, a, n, force, delayed] {
            c.fill(0.0);
        }
        step.late.fill(0.0);
        step.late[0] = signal;
        step.order = 1;
        (step.a[0], step.a[1]) = (self.a, rate);
        (step.delayed[0], step.delayed[1]) = (self.a - signal, rate);
        let commanded = 1.0 + gains.alpha_n * (step.a[0] - step.delayed[0]);
        step.n[0] = limits.load_of(commanded);
        (step.force[0], step.force[1]) = (self.a + damping * rate, rate);
        f64::INFINITY
    }

    /// Notes whether the elongation of a stuck block has grown evenly in the last step. Over a
    /// delay the deviations allowed add up to less than the error of a step. The nearer α_v τ is to
    /// 1, the slower they die out, so the smaller they have to be.
    pub(super) fn note_evenness(&mut self) {
        let step = &self.step;
        let rate = self.even_rate().filter(|_| self.slope == 0.0);
        let even = rate.is_some_and(|rate| {
            let share = (step.length / self.parameters.feedback.tau).min(1.0);
            let dies_out = (self.parameters.v0 / rate).min(1.0);
            let allowed = (EVEN * self.tolerance * share * dies_out).max(ROUNDING);
            let a = &step.a[1..=step.order];
            let off = ((a[0] - rate).abs() + spread(a, step.length)) * step.length;
            let stretch = step.a[0].abs().max(self.parameters.law.mu_s());
            off <= allowed * stretch
                && (!self.parameters.feedback.echoes() || {
                    let allowed = EVEN * self.tolerance * dies_out / (1.0 + self.gain());
                    self.signal_is_even(rate, allowed.max(ROUNDING) * stretch)
                })
        });
        if !even {
            self.even_since = self.t;
        }
    }

    /// An upper bound of the time until release of a block whose elongation has grown evenly for a
    /// delay.
    pub(super) fn longest_stick(&self) -> f64 {
        let p = &self.parameters;
        let load = 1.0 + (p.feedback.gains.alpha_n * p.v0 * p.feedback.tau).abs();
        2.0 * (self.a.abs() + p.law.mu_s() * load) / p.v0.abs()
    }
}
