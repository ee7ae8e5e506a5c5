//! One step after the other.

use super::feedback::{DelayLimit, PastLimits};
use super::{Event, Integrator, LEAST_ORDER, Mode, Motion};
use crate::model::series::value;
use crate::slip::history::{History, SMOOTH};

/// Steps longer than the delay take this part of the range of a polynomial, since the next step
/// needs the polynomial beyond its end.
const BALANCED: f64 = 0.53;

/// How well a polynomial used beyond its end has to agree with the motion, in units of the
/// tolerance. A step for which it does not is shortened by this factor, at most so many times.
const FORESEEN: f64 = 2.0;
const SHORTER: f64 = 0.7;
const MOST_SHORTER: u32 = 12;

/// What acts on the block as a step begins.
#[derive(Debug, Clone, Copy)]
struct Now {
    controlled: bool,
    /// The feedback has memory or latency.
    echoes: bool,
    /// The block is stuck, and its elongation has grown evenly for a delay.
    evenly: bool,
}

/// What ends a step.
#[derive(Debug, Clone, Copy)]
enum End {
    /// How long it may be.
    OfLength,
    Event(Event),
    /// The elongation has a kink of this order.
    Kink(u32),
}

impl Motion {
    /// One step, not beyond `horizon`, and the event that ends it, if one does. A motion that is
    /// told to stop takes no step: its velocity is NaN from then on.
    pub fn advance(&mut self, horizon: f64) -> Option<Event> {
        if self.is_stopped() {
            self.end_here();
            return None;
        }
        if self.corner <= self.t {
            return Some(self.pass_corner_here());
        }
        let horizon = horizon.min(self.corner);
        if self.is_sampled() {
            return self.advance_sampled(horizon);
        }
        let controlled = self.t >= self.parameters.switch_on;
        let now = Now {
            controlled,
            echoes: self.parameters.feedback.echoes(),
            evenly: self.sticks_evenly(),
        };
        let past = self.read_delayed(now);
        self.hold_actuators(controlled, self.signal_at_start(now));
        let delay = past.first();
        let limit = self.limit(now, &delay, horizon);
        let radius = self.expand_within(now, limit);
        if self.step.n[0] <= 0.0 && !self.parameters.feedback.limits.holds_load() {
            self.step.length = 0.0;
            return Some(Event::LiftOff);
        }
        let length = self.length(radius, limit, &delay, now);
        let (length, end) = self.first_end(controlled, length);
        let until_switch = self.parameters.switch_on - self.t;
        let until_corner = self.corner - self.t;
        self.finish(length, radius);
        if self.slope != 0.0 {
            self.climb();
        }
        if self.mode == Mode::Stick {
            self.note_evenness();
        }
        let event = match end {
            End::OfLength if !controlled && length == until_switch => {
                self.t = self.parameters.switch_on;
                Some(Event::SwitchOn)
            }
            End::OfLength if length == until_corner && self.course.is_some() => {
                self.t = self.corner;
                Some(Event::Programme)
            }
            End::Event(event) => Some(event),
            _ => None,
        };
        self.kink = self.kink_at(end, event);
        if now.echoes {
            self.note_kinks(self.kink, &past, controlled);
        } else if self.kink == SMOOTH && length == delay.length && delay.kink != SMOOTH {
            self.kink = self.passed_on(delay.kink);
        }
        event.map(|event| self.change_mode(event))
    }

    /// The order of the kink of the elongation at the end of a step; passes a corner there.
    fn kink_at(&mut self, end: End, event: Option<Event>) -> u32 {
        match (end, event) {
            (End::Kink(kink), _) => kink,
            (_, Some(Event::SwitchOn)) if self.parameters.feedback.gains.alpha_v != 0.0 => 1,
            (_, Some(Event::Programme)) => self.pass_corner(),
            (_, Some(_)) => 2,
            (_, None) => SMOOTH,
        }
    }

    /// Where a step that may be this long ends, and by what.
    fn first_end(&mut self, controlled: bool, length: f64) -> (f64, End) {
        let (mut length, mut end) = match self.first_event(length) {
            Some((s, event)) => (s, End::Event(event)),
            None => (length, End::OfLength),
        };
        if let Some((s, kink)) = self.limit_crossing(controlled, length) {
            (length, end) = (s, End::Kink(kink));
        }
        if let Some(crossing) = self.friction_crossing(length) {
            (length, end) = (crossing.s, End::Kink(crossing.kink));
        }
        (length, end)
    }

    /// S as the step begins.
    fn signal_at_start(&self, now: Now) -> f64 {
        match self.even_rate() {
            Some(rate) if now.controlled && now.evenly => self.even_signal(rate),
            _ => self.step.fed_back_at_start(self.a),
        }
    }

    /// Ends the motion: a step of no length, after which ẋ is NaN.
    #[cold]
    fn end_here(&mut self) {
        self.u = f64::NAN;
        self.step.order = self.step.order.max(LEAST_ORDER);
        self.step.length = 0.0;
    }

    /// The longest step that delay, switch-on and `horizon` allow.
    fn limit(&self, now: Now, delay: &DelayLimit, horizon: f64) -> f64 {
        let mut limit = delay.length.min(horizon - self.t);
        let p = &self.parameters;
        if now.echoes && !(now.controlled && now.evenly) {
            limit = limit.min(self.unforeseen(now.controlled));
        }
        if !now.controlled {
            limit.min(p.switch_on - self.t)
        } else if self.mode == Mode::Stick && p.feedback.gains.alpha_v != 0.0 && !now.evenly {
            // While the block sticks nothing corrects errors of the last polynomial beyond its end.
            limit.min(p.feedback.tau)
        } else {
            limit
        }
    }

    /// Computes the polynomials of a step. Returns how long they hold.
    fn expand_within(&mut self, now: Now, limit: f64) -> f64 {
        let Now {
            controlled, evenly, ..
        } = now;
        match (self.even_rate(), self.integrator) {
            (Some(rate), _) if controlled && evenly => self.stick_evenly(rate),
            (_, Integrator::Taylor) => {
                self.step.order = self.order_within(limit);
                self.expand(controlled);
                self.free_length()
            }
            (_, Integrator::Collocation) => self.collocate(controlled, limit),
        }
    }

    /// How long a step of polynomials that hold for `radius` is, if no event ends it.
    fn length(&self, radius: f64, limit: f64, delay: &DelayLimit, now: Now) -> f64 {
        let reads = now.controlled || now.echoes;
        let foreseen = reads && self.integrator == Integrator::Taylor;
        let balanced = BALANCED * self.history.ahead() * radius;
        let shortest = match self.step.is_late {
            true => self
                .parameters
                .feedback
                .tau
                .min(self.parameters.feedback.channel.latency),
            false => self.parameters.feedback.tau,
        };
        let free = match foreseen && shortest < balanced {
            // The next step, one delay behind, uses the polynomial of this one beyond its end.
            true => balanced,
            false => radius,
        };
        // Two halves rather than a long and a tiny step.
        let length = match free / limit {
            r if r >= 1.0 => limit,
            r if r > 0.5 && delay.kink != SMOOTH => 0.5 * limit,
            _ => free,
        };
        match foreseen {
            true => self.as_foreseen(length),
            false => length,
        }
    }

    /// Fills the delayed polynomial. Returns how long a step may use it, and the kink at its end.
    fn read_delayed(&mut self, now: Now) -> PastLimits {
        // Also before control acts, so that memory does not grow with time.
        self.history
            .forget_before(self.t - 2.0 * self.parameters.feedback.tau);
        self.signal
            .forget_before(self.t - 2.0 * self.parameters.feedback.channel.latency);
        let of_delay = |delay: DelayLimit| PastLimits {
            delay,
            latency: DelayLimit::NONE,
        };
        if !now.controlled && !now.echoes {
            return of_delay(DelayLimit::NONE);
        }
        if now.evenly && now.controlled {
            return of_delay(DelayLimit {
                length: self.longest_stick(),
                kink: SMOOTH,
            });
        }
        if now.echoes {
            return self.read_past(now.controlled);
        }
        let time = self.t - self.parameters.feedback.tau;
        let reach = self.history.read(time, self.kink, &mut self.step.delayed);
        of_delay(DelayLimit {
            length: reach.until - time,
            kink: reach.kink,
        })
    }

    /// `length`, or less where it outlasts the delay. Such a step has used the last polynomial
    /// beyond its end, and holds as long as that polynomial agrees with the step's own.
    ///
    /// The last terms of a series do not show this. Where polynomials are used far beyond their
    /// end, errors of their middle terms grow from step to step. In stick they do above all: it has
    /// no terms of its own that outweigh them.
    fn as_foreseen(&self, length: f64) -> f64 {
        let p = &self.parameters;
        // With memory no step outlasts the delay, so here `history` holds a, not W.
        let a = &self.step.a[..=self.step.order];
        let length = self.as_told(a, &self.history, p.feedback.tau, length);
        if !(self.step.is_late && length > p.feedback.channel.latency) {
            return length;
        }
        let (v, order) = self.signal_of_step();
        self.as_told(
            &v[..=order],
            &self.signal,
            p.feedback.channel.latency,
            length,
        )
    }

    /// `length`, or less where it outlasts this `delay` and the last polynomial of `history`,
    /// beyond its end, differs from the motion itself, the polynomial `c`.
    fn as_told(&self, c: &[f64], history: &History, delay: f64, length: f64) -> f64 {
        let mut beyond = length - delay;
        if beyond <= 0.0 {
            return length;
        }
        let stretch = self.step.a[0].abs().max(self.parameters.law.mu_s());
        let holds = |s: f64| {
            let off = value(c, s) - history.foreseen(self.t + s);
            // NaN ends the motion elsewhere.
            off.is_nan() || off.abs() <= FORESEEN * self.tolerance * stretch
        };
        if holds(beyond) {
            return length;
        }
        for _ in 0..MOST_SHORTER {
            beyond *= SHORTER;
            if holds(beyond) {
                return beyond + delay;
            }
        }
        delay
    }

    /// The order of the kink of the motion that a kink of the delayed elongation causes.
    pub(super) fn passed_on(&self, kink: u32) -> u32 {
        let smoother = match (self.mode, self.parameters.feedback.gains.alpha_v != 0.0) {
            (_, true) => 1,
            // A stuck block feels the load only when it is released.
            (Mode::Stick, false) => return SMOOTH,
            (_, false) => 2,
        };
        kink + smoother
    }

    /// Moves on by `length`; the polynomials hold for `radius`.
    #[inline(always)]
    pub(super) fn go_on(&mut self, length: f64, radius: f64) {
        let order = self.step.order;
        let (u, a) = (&self.step.u[..=order], &self.step.a[..=order]);
        self.u = value(u, length);
        self.a = value(a, length);
        self.t += length;
        self.step.length = length;
        self.step.radius = radius;
    }

    /// Moves on by `length`, and keeps the step; the polynomials hold for `radius`.
    fn finish(&mut self, length: f64, radius: f64) {
        self.go_on(length, radius);
        let a = &self.step.a[..=self.step.order];
        let around = match self.integrator {
            Integrator::Taylor => radius.max(length),
            // A polynomial through values does not hold outside its step.
            Integrator::Collocation => 0.0,
        };
        let has_room = match self.parameters.feedback.echoes() {
            true => self.keep(around),
            false => self.history.push(self.t, around, a, self.kink),
        };
        if !has_room {
            (self.u, self.a) = (f64::NAN, f64::NAN);
        }
    }

    /// The mode after `event`, which may turn out to be another one.
    pub(super) fn change_mode(&mut self, event: Event) -> Event {
        let n = value(&self.step.n[..=self.step.order], self.step.length);
        match event {
            Event::Release => {
                self.u = 0.0;
                self.even_since = f64::INFINITY;
                self.friction.restart(0.0);
                self.mode = if self.step.force_at_end() > 0.0 {
                    Mode::Forwards
                } else {
                    Mode::Backwards
                };
                Event::Release
            }
            Event::Stick => {
                let before = self.mode;
                self.u = 0.0;
                self.friction.restart(0.0);
                self.mode = self.mode_at(self.step.force_at_end(), n);
                if self.mode == Mode::Stick {
                    self.even_since = self.t;
                }
                if self.mode == Mode::Stick || self.mode == before {
                    Event::Stick
                } else {
                    Event::Reversal
                }
            }
            other => other,
        }
    }
}
