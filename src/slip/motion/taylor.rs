//! Steps by Taylor's method: their coefficients, how many of them, and how long they hold.

use super::{LEAST_ORDER, Mode, Motion};
use crate::model::elementary::{rough_log2, rough_root};
use crate::model::law::with_series;
use crate::slip::history::SMOOTH;

/// Speeds below this, in units of N0/√(κM), need no relative accuracy.
const SLOWEST: f64 = 1e-3;

/// Steps shorter than this part of the length that their series allow get fewer terms, with some
/// terms to spare.
const SHORT: f64 = 0.5;
const SPARE_TERMS: usize = 2;

impl Motion {
    /// Works out the coefficients of the step, Eqs. (1) and (2) of the module.
    #[inline]
    pub(super) fn expand(&mut self, controlled: bool) {
        let control = self.control(controlled);
        self.step.pull = control.pull();
        let step = &mut self.step;
        step.u[0] = self.u;
        step.a[0] = self.a;
        let direction = match self.mode {
            Mode::Stick => return step.stick(control),
            Mode::Forwards => 1.0,
            Mode::Backwards => -1.0,
        };
        with_series!(&mut self.friction, series => step.slip(control, direction, series));
    }

    /// The order that a step no longer than `limit` needs. Where delays or kinks end steps long
    /// before the series does, a lower one suffices. It is estimated from the step before;
    /// [`Self::free_length`] bounds the error whatever the order.
    #[inline(always)]
    pub(super) fn order_within(&self, limit: f64) -> usize {
        let last = &self.step;
        let known = self.kink == SMOOTH && last.radius.is_finite();
        if !known || limit > SHORT * last.radius {
            return self.order;
        }
        // The terms of a series of radius R fall as (s/R)^k, and last.radius was where that is the
        // tolerance.
        let digits = rough_log2(self.tolerance);
        let fall = rough_log2(limit / last.radius) + digits / last.order as f64;
        ((digits / fall).ceil() as usize + SPARE_TERMS).clamp(LEAST_ORDER, self.order)
    }

    /// How long a step may be for its last terms to stay below the tolerance.
    #[inline(always)]
    pub(super) fn free_length(&self) -> f64 {
        let step = &self.step;
        let (u, a) = (&step.u, &step.a);
        let [speed, stretch] = self.sizes();
        // log₂ to 0.1: enough to tell which of the last two terms asks for the shorter step.
        let roughest_log2 = |x: f64| (x.to_bits() >> 42) as f64 / 1024.0 - 1023.0;
        let asked = [step.order - 1, step.order].map(|k| {
            // NaN ends the motion elsewhere.
            let ratio = (u[k].abs() / speed).max(a[k].abs() / stretch).max(0.0);
            let room = self.tolerance / ratio;
            (roughest_log2(room) / k as f64, room, k)
        });
        let shorter = usize::from(asked[0].0 >= asked[1].0);
        let (_, room, k) = asked[shorter];
        let length = rough_root(room, k);
        if self.mode == Mode::Stick {
            return length;
        }
        self.resolved_by_friction(length)
    }

    /// The sizes of u and a over which errors of a step count.
    #[inline(always)]
    pub(super) fn sizes(&self) -> [f64; 2] {
        let (u, a) = (self.step.u[0].abs(), self.step.a[0].abs());
        let speed = u.max(self.parameters.v0.abs()).max(SLOWEST);
        [speed, a.max(self.parameters.law.mu_s())]
    }

    /// How far the friction of a step in slip holds to the tolerance, at most `length`.
    #[inline(always)]
    pub(super) fn resolved_by_friction(&self, length: f64) -> f64 {
        let step = &self.step;
        let [speed, _] = self.sizes();
        let error = self.tolerance * speed / (length * step.n[0].abs());
        self.friction
            .resolved(&step.u[..=step.order], length, error)
    }
}
