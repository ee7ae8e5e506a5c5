//! What ends a step: zeros of its polynomials, told apart from rounding.

use super::{Event, Mode, Motion, ROUNDING};
use crate::model::Feedback;
use crate::model::law::Crossing;
use crate::model::law::FrictionSeries;
use crate::model::series::{Coefficients, MOST_ORDER, first_zero};

/// A block that was just released does not accelerate backwards. Under a law with μ_K(0⁺) = μ_S its
/// acceleration begins at zero. The polynomials of its past before and after the release can then
/// differ by more than the error of one step: by up to this many times the noise of forces.
const RELEASED: f64 = 1e4;

impl Motion {
    /// The first event within `length`.
    #[inline(always)]
    pub(super) fn first_event(&self, length: f64) -> Option<(f64, Event)> {
        let step = &self.step;
        let range = ..=step.order;
        let mut first: Option<(f64, Event)> = None;
        let mut consider = |zero: Option<f64>, event: Event| {
            if let Some(s) = zero
                && first.is_none_or(|(earliest, _)| s < earliest)
            {
                first = Some((s, event));
            }
        };
        let Feedback { gains, limits, .. } = self.parameters.feedback;
        if gains.alpha_n != 0.0 && !limits.holds_load() {
            consider(first_zero(&step.n[range], length), Event::LiftOff);
        }
        if self.mode == Mode::Stick {
            for direction in [1.0, -1.0] {
                let hold = self.hold(direction);
                consider(first_zero(&hold[range], length), Event::Release);
            }
        } else if self.mode == Mode::Forwards && step.u[0] != 0.0 {
            consider(first_zero(&step.u[range], length), Event::Stick);
        } else {
            consider(first_zero(&self.speed()[range], length), Event::Stick);
        }
        first
    }

    /// The first point of a friction table that the speed crosses before `length`; the series goes
    /// on with the cubic beyond it.
    pub(super) fn friction_crossing(&mut self, length: f64) -> Option<Crossing> {
        if self.mode == Mode::Stick || !matches!(self.friction, FrictionSeries::Table(_)) {
            return None;
        }
        let speed = self.speed();
        let FrictionSeries::Table(series) = &mut self.friction else {
            return None;
        };
        let crossing = series.crossing(&speed[..=self.step.order], length, self.tolerance)?;
        series.enter(crossing.region);
        Some(crossing)
    }

    /// The force that holds a stuck block against a pull in `direction` = ±1:
    /// μ_S n − direction · (a + d ȧ).
    pub(super) fn hold(&self, direction: f64) -> Coefficients {
        let mu_s = self.parameters.law.mu_s();
        let mut hold = [0.0; MOST_ORDER + 1];
        let terms = self.step.n.iter().zip(&self.step.force);
        for (hold, (n, force)) in hold.iter_mut().zip(terms).take(self.step.order + 1) {
            *hold = mu_s * n - direction * force;
        }
        hold[0] = self.without_noise(hold[0]);
        hold
    }

    /// |ẋ| in slip. A block that was just released does not accelerate backwards: μ_K(0⁺) ≤ μ_S.
    pub(super) fn speed(&self) -> Coefficients {
        let mut speed = self.step.u;
        if self.mode == Mode::Backwards {
            for u in &mut speed {
                *u = -*u;
            }
        }
        if speed[0] == 0.0 {
            let backwards = -RELEASED * self.force_noise()..0.0;
            speed[1] = match backwards.contains(&speed[1]) {
                true => 0.0,
                false => self.without_noise(speed[1]),
            };
        }
        speed
    }

    /// `force` at the start of a mode, where it cannot be negative: zero if it is negative by noise
    /// or positive by rounding.
    pub(super) fn without_noise(&self, force: f64) -> f64 {
        let noise = self.force_noise();
        let rounding = noise * ROUNDING / (ROUNDING + self.tolerance);
        if (-noise..=rounding).contains(&force) {
            0.0
        } else {
            force
        }
    }

    /// Noise of forces: rounding, and the difference of two polynomials of the past, which agree to
    /// the tolerance. Without it a block with μ_K(0⁺) = μ_S would stick and slip again and again at
    /// the moment of its release.
    pub(super) fn force_noise(&self) -> f64 {
        let (a, delayed) = (self.step.a[0].abs(), self.step.delayed[0].abs());
        let p = &self.parameters;
        let load = 1.0 + p.feedback.gains.alpha_n.abs() * (a + delayed);
        let pull = p.v0.abs() + p.feedback.gains.alpha_v.abs() * (a + delayed);
        let dashpot = p.dashpots.damping * pull;
        (ROUNDING + self.tolerance) * (a + dashpot + p.law.mu_s() * load)
    }
}
