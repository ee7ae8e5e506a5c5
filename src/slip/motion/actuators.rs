//! Actuators at their limits: v and N are held where what is commanded leaves them.
//!
//! Both commands are linear in the signal S, so every limit is a value of S. Where S passes one, v
//! or N has a kink: a step ends there. An actuator counts as held, and as free again, where S is
//! past that value by more than its noise; so rounding does not tear a step into pieces.

use super::held::{Held, Span};
use super::{Motion, ROUNDING};
use crate::model::Control as Gains;
use crate::slip::step::Control;

impl Motion {
    /// Whether v or N was at a limit in the last step.
    #[must_use]
    pub fn is_at_limit(&self) -> bool {
        self.held.at_limit()
    }

    /// The spans of v and of N.
    fn spans(&self) -> [Span; 2] {
        let p = &self.parameters;
        let Gains { alpha_v, alpha_n } = p.feedback.gains;
        let limits = p.feedback.limits;
        let [_, most] = limits.load;
        let least = match limits.holds_load() {
            true => limits.load[0],
            false => f64::NEG_INFINITY,
        };
        [
            Span::of(p.v0, alpha_v, limits.velocity),
            Span::of(1.0, alpha_n, [least, most]),
        ]
    }

    /// The slope of v0 over α_v: that of S at which the command of v is constant.
    fn tilt(&self) -> f64 {
        let alpha_v = self.parameters.feedback.gains.alpha_v;
        match self.slope != 0.0 && alpha_v != 0.0 {
            true => self.slope / alpha_v,
            false => 0.0,
        }
    }

    /// The noise of S.
    fn signal_noise(&self) -> f64 {
        let past = match self.step.is_late {
            true => self.step.late[0],
            false => self.step.delayed[0],
        };
        (ROUNDING + self.tolerance) * (self.a.abs() + past.abs() + self.parameters.law.mu_s())
    }

    /// Finds which limits hold v and N in the next step, which begins with this S.
    pub(super) fn hold_actuators(&mut self, controlled: bool, signal: f64) {
        if !self.parameters.feedback.limits.act() {
            return;
        }
        if !controlled {
            self.held = Held::default();
            return;
        }
        let [velocity, load] = self.spans();
        let slack = 0.5 * self.signal_noise();
        self.held = Held {
            velocity: velocity.side(signal, self.held.velocity, slack),
            load: load.side(signal, self.held.load, slack),
        };
    }

    /// Where in the step v or N first reaches or leaves a limit, before `length`, and the order of
    /// the kink of the elongation there.
    pub(super) fn limit_crossing(&self, controlled: bool, length: f64) -> Option<(f64, u32)> {
        if !(controlled && self.parameters.feedback.limits.act()) {
            return None;
        }
        let [velocity, load] = self.spans();
        let mut signal = self.step.signal();
        let order = self.step.order;
        let slack = self.signal_noise();
        // The command v0 + α_v S is that of S + v0′ s/α_v with a constant v0.
        let (untilted, tilt) = (signal[1], self.tilt());
        signal[1] += tilt;
        let of_velocity = velocity.left(self.held.velocity, &signal[..=order], slack, length);
        signal[1] = untilted;
        let signal = &signal[..=order];
        let before = of_velocity.unwrap_or(length);
        let of_load = load.left(self.held.load, signal, slack, before);
        match (of_load, of_velocity) {
            (Some(s), Some(of_velocity)) if s >= of_velocity => Some((s, 2)),
            (Some(s), _) => Some((s, 3)),
            (None, of_velocity) => of_velocity.map(|s| (s, 2)),
        }
    }

    /// What acts in a step: an actuator at a limit stays there, whatever S is.
    pub(super) fn control(&self, controlled: bool) -> Control {
        let p = &self.parameters;
        let mut acting = Control {
            v0: p.v0,
            slope: self.slope,
            load: 1.0,
            alpha_v: 0.0,
            alpha_n: 0.0,
            dashpots: p.dashpots,
        };
        if !controlled {
            return acting;
        }
        if self.is_sampled() {
            return self.held_control();
        }
        (acting.alpha_v, acting.alpha_n) = (p.feedback.gains.alpha_v, p.feedback.gains.alpha_n);
        if self.held.at_limit() {
            let [velocity, load] = self.spans();
            if let Some(limit) = velocity.held_at(self.held.velocity) {
                (acting.v0, acting.slope, acting.alpha_v) = (limit, 0.0, 0.0);
            }
            if let Some(limit) = load.held_at(self.held.load) {
                (acting.load, acting.alpha_n) = (limit, 0.0);
            }
        }
        acting
    }
}
