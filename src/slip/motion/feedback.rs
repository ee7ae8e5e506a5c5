//! Feedback with memory and latency, Eq. (3) of [`super`].
//!
//! Whatever the memory, the past enters through two functions of time alone,
//!
//! ```text
//! V(t) = a(t) − W(t−τ),   W(t) = a(t) − R V(t),   S(t) = V(t−δ)
//! ```
//!
//! W is needed over the last delay and, where there is a latency, V over the last δ. So the
//! infinite sum S costs no more than one delay: W is kept in place of a, and equals a without
//! memory. In a step both are polynomials, made of that of a and of those read from the past.
//!
//! A kink of a comes back through the memory at every further delay, R times as large and no
//! smoother. Steps end on it until the polynomials on its two sides agree to the tolerance.

use super::{Integrator, Mode, Motion};
use crate::model::elementary::rough_root;
use crate::model::series::{Coefficients, MOST_ORDER, shifted};
use crate::slip::collocation::fit;
use crate::slip::history::{History, Reach, SMOOTH};

/// A kink matters if the polynomials on its two sides differ by more than this, in units of the
/// tolerance.
const KINK_FELT: f64 = 0.1;

/// How long a step may use a polynomial of the past, and the order of the kink at its end.
#[derive(Debug, Clone, Copy)]
pub(super) struct DelayLimit {
    pub length: f64,
    pub kink: u32,
}

impl DelayLimit {
    /// No limit.
    pub(super) const NONE: Self = Self {
        length: f64::INFINITY,
        kink: SMOOTH,
    };

    fn of(reach: Reach, time: f64) -> Self {
        Self {
            length: reach.until - time,
            kink: reach.kink,
        }
    }
}

/// What a step reads of the past: W one delay ago, and V one latency ago.
#[derive(Debug, Clone, Copy)]
pub(super) struct PastLimits {
    pub delay: DelayLimit,
    pub latency: DelayLimit,
}

impl PastLimits {
    /// The shorter limit.
    pub(super) fn first(&self) -> DelayLimit {
        match self.latency.length < self.delay.length {
            true => self.latency,
            false => self.delay,
        }
    }
}

impl Motion {
    /// The larger one of the gains.
    pub(super) fn gain(&self) -> f64 {
        let p = &self.parameters;
        p.feedback
            .gains
            .alpha_v
            .abs()
            .max(p.feedback.gains.alpha_n.abs())
    }

    /// S where a has always grown at this `rate`.
    pub(super) fn even_signal(&self, rate: f64) -> f64 {
        rate * self.parameters.feedback.tau / (1.0 - self.parameters.feedback.channel.memory)
    }

    /// W = a − R V, with V = `fed_back`.
    pub(super) fn kept(&self, a: f64, fed_back: f64) -> f64 {
        a - self.parameters.feedback.channel.memory * fed_back
    }

    /// The order of the kink of W where V itself jumps.
    pub(super) fn kink_of_jump(&self) -> u32 {
        match self.parameters.feedback.channel.memory == 0.0 {
            true => 1,
            false => 0,
        }
    }

    /// Fills the polynomials of the past, where the feedback has memory or latency.
    pub(super) fn read_past(&mut self, controlled: bool) -> PastLimits {
        let time = self.t - self.parameters.feedback.tau;
        let integrator = self.integrator;
        let read = |history: &mut History, time: f64, kink: u32, out: &mut Coefficients| {
            let reach = history.read(time, kink, out);
            match integrator {
                Integrator::Taylor => DelayLimit::of(reach, time),
                // Collocation reads values, also across the ends of steps.
                Integrator::Collocation => DelayLimit::of(history.until_kink(kink), time),
            }
        };
        let delay = read(&mut self.history, time, self.kink, &mut self.step.delayed);
        let latency = match controlled && self.step.is_late {
            true => {
                let time = self.t - self.parameters.feedback.channel.latency;
                read(
                    &mut self.signal,
                    time,
                    self.signal_kink,
                    &mut self.step.late,
                )
            }
            false => DelayLimit::NONE,
        };
        PastLimits { delay, latency }
    }

    /// Fits the polynomials of the past over a step of `length` to values. False where the fit
    /// misses the tolerance.
    pub(super) fn fit_past(&mut self, length: f64, controlled: bool) -> bool {
        let p = &self.parameters;
        let allowed = self.tolerance * self.a.abs().max(p.law.mu_s());
        let (from, step) = (self.t - p.feedback.tau, &mut self.step);
        let (delayed, off) = fit(length, |s| self.history.at(from + s));
        step.delayed = delayed;
        let mut fits = off <= allowed;
        if controlled && step.is_late {
            let from = self.t - p.feedback.channel.latency;
            let (late, off) = fit(length, |s| self.signal.at(from + s));
            step.late = late;
            fits &= off <= allowed;
        }
        fits
    }

    /// V in the last step, and its order.
    pub(super) fn signal_of_step(&self) -> (Coefficients, usize) {
        let step = &self.step;
        let order = step.order.max(order_of(&step.delayed));
        let mut v = step.delayed.map(|c| -c);
        for (v, a) in v.iter_mut().zip(&step.a).take(step.order + 1) {
            *v += a;
        }
        (v, order)
    }

    /// Adds W of the last step, and V, to the histories; false where there is no room. The
    /// polynomial of a holds for `radius`.
    pub(super) fn keep(&mut self, radius: f64) -> bool {
        let (v, order) = self.signal_of_step();
        let radius = radius.min(self.radius_of_past());
        let memory = self.parameters.feedback.channel.memory;
        let has_room = if memory == 0.0 {
            let a = &self.step.a[..=self.step.order];
            self.history.push(self.t, radius, a, self.kink)
        } else {
            let mut w = v.map(|v| -memory * v);
            for (w, a) in w.iter_mut().zip(&self.step.a).take(self.step.order + 1) {
                *w += a;
            }
            self.history.push(self.t, radius, &w[..=order], self.kink)
        };
        let kink = self.signal_kink;
        has_room && (!self.step.is_late || self.signal.push(self.t, radius, &v[..=order], kink))
    }

    /// How long the last terms of the polynomial read from the past stay below the tolerance.
    fn radius_of_past(&self) -> f64 {
        let d = &self.step.delayed;
        let order = order_of(d);
        let stretch = self.a.abs().max(self.parameters.law.mu_s());
        let room = |k: usize| match k >= 2 && d[k] != 0.0 {
            true => rough_root(self.tolerance * stretch / d[k].abs(), k),
            false => f64::INFINITY,
        };
        room(order).min(room(order.saturating_sub(1)))
    }

    /// Notes the kinks with which the next step begins. `own` is the kink of a by an event. A kink
    /// of the past at the end of the last step passes on into a, W and V.
    pub(super) fn note_kinks(&mut self, own: u32, past: &PastLimits, controlled: bool) {
        let close = 8.0 * f64::EPSILON * self.t.abs().max(1.0);
        let length = self.step.length;
        let met = |limit: &DelayLimit| (length - limit.length).abs() <= close;
        let [memory, gain] = [self.parameters.feedback.channel.memory.abs(), self.gain()];
        let (mut of_a, mut of_v) = (own, SMOOTH);
        if met(&past.delay) && self.feels(past.delay, false, gain.max(memory)) {
            of_v = past.delay.kink;
            if controlled && !self.step.is_late {
                of_a = of_a.min(self.passed_on(of_v));
            }
        }
        if met(&past.latency) && self.feels(past.latency, true, gain) {
            of_a = of_a.min(self.passed_on(past.latency.kink));
        }
        self.signal_kink = of_a.min(of_v);
        self.kink = match self.parameters.feedback.channel.memory == 0.0 {
            true => of_a,
            false => self.signal_kink,
        };
    }

    /// Whether a kink at the end of the last step matters: of V if `late`, else of W. Differences
    /// count times `gain`.
    fn feels(&mut self, limit: DelayLimit, late: bool, gain: f64) -> bool {
        if limit.kink == SMOOTH {
            return false;
        }
        let p = &self.parameters;
        let (history, delay, last) = match late {
            true => (
                &mut self.signal,
                p.feedback.channel.latency,
                &self.step.late,
            ),
            false => (&mut self.history, p.feedback.tau, &self.step.delayed),
        };
        let before = shifted(&last[..=order_of(last)], self.step.length);
        let time = self.t - delay;
        let mut after = [0.0; MOST_ORDER + 1];
        let reach = history.read(time, SMOOTH, &mut after);
        let seen = match self.integrator {
            Integrator::Taylor => self.step.radius,
            Integrator::Collocation => self.step.length,
        };
        let seen = seen.min(reach.until - time).clamp(0.0, 1.0);
        let (mut off, mut power) = (0.0, 1.0);
        for (before, after) in before.iter().zip(&after) {
            off += (before - after).abs() * power;
            power *= seen;
        }
        let stretch = self.a.abs().max(self.parameters.law.mu_s());
        // NaN ends the motion elsewhere.
        off.is_nan() || off * gain > KINK_FELT * self.tolerance * stretch
    }

    /// The longest step that does not use a polynomial beyond its end where that is unsafe. Nothing
    /// in a step corrects errors of R S(t−τ), nor those of V while the block sticks.
    pub(super) fn unforeseen(&self, controlled: bool) -> f64 {
        let p = &self.parameters;
        let held = match p.feedback.channel.memory == 0.0 {
            true => f64::INFINITY,
            false => p.feedback.tau,
        };
        let stuck = self.mode == Mode::Stick && p.feedback.gains.alpha_v != 0.0;
        match controlled && stuck && self.step.is_late {
            true => held.min(p.feedback.channel.latency),
            false => held,
        }
    }

    /// Whether V was constant in the last step of a stuck block, to within `allowed`, at its value
    /// for an elongation that always grows at this `rate`.
    pub(super) fn signal_is_even(&self, rate: f64, allowed: f64) -> bool {
        let (v, order) = self.signal_of_step();
        let spread = crate::model::series::spread(&v[..=order], self.step.length);
        (v[0] - self.even_signal(rate)).abs() + spread <= allowed
    }
}

/// The order of a polynomial.
fn order_of(c: &Coefficients) -> usize {
    c.iter().rposition(|&c| c != 0.0).unwrap_or(0)
}
