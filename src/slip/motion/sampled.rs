//! Steps of a motion whose feedback is read at equal times and held in between.
//!
//! v and N are constant from one reading to the next, so a step needs nothing of the past: it ends
//! at the next reading, at an event, or where its series does. At a reading both jump, and with a
//! dashpot beside the spring its pull as well. What the jump tears off, or lifts off, is told as an
//! event that ends a step of no length.

use super::held_signal::LEAST;
use super::{Event, Integrator, Mode, Motion, Parameters};
use crate::model::Feedback;
use crate::model::elementary::power;
use crate::model::series::spread;
use crate::slip::history::SMOOTH;
use crate::slip::step::Control;

/// Steps end long before their series do, so terms fall fast: the last one has to be below the
/// tolerance, and the one before it below so many times the tolerance.
const BEFORE_LAST: f64 = 10.0;
/// A step whose last terms are below this share of the tolerance would do with one fewer.
const SPARE: f64 = 0.1;
/// How many terms more a step gets whose last ones exceed the tolerance.
const MORE: usize = 2;

impl Motion {
    /// Whether the feedback is read at equal times and held in between.
    #[must_use]
    pub(crate) fn is_sampled(&self) -> bool {
        self.sampled.acts()
    }

    /// The feedback with its memory and latency.
    #[must_use]
    pub(crate) fn feedback(&self) -> Feedback {
        let of = self.parameters.feedback;
        match self.is_sampled() {
            true => of.through(self.sampled.sampler.channel),
            false => of,
        }
    }

    /// Makes the present t = 0, the end of an uncontrolled cycle of this `period` that has always
    /// gone on. Its feedback is read from now on, and acts from `switch_on` on.
    pub(in crate::slip) fn sample_cycle(
        &mut self,
        parameters: &Parameters,
        switch_on: f64,
        period: f64,
    ) {
        self.begin_here(switch_on);
        self.parameters.clone_from(parameters);
        self.parameters.switch_on = switch_on;
        let history = &self.history;
        let ago = |time: f64| history.at(-(-time % period));
        let begun = &mut self.parameters;
        self.sampled.restart(begun, f64::NEG_INFINITY, ago);
        self.step.is_late = self.sampled.acts();
        self.step.late.fill(0.0);
    }

    /// What acts from one reading to the next.
    pub(super) fn held_control(&self) -> Control {
        Control {
            v0: self.sampled.velocity,
            slope: self.sampled.slope,
            load: self.sampled.load,
            alpha_v: 0.0,
            alpha_n: 0.0,
            dashpots: self.parameters.dashpots,
        }
    }

    /// Works out v and N for the signal that is held.
    pub(super) fn hold_signal(&mut self) {
        let signal = self.sampled.signal;
        self.hold_actuators(true, signal);
        let p = &self.parameters;
        let Feedback { gains, limits, .. } = p.feedback;
        let commanded = p.v0 + gains.alpha_v * signal;
        self.sampled.velocity = limits.velocity_of(commanded);
        self.sampled.load = limits.load_of(1.0 + gains.alpha_n * signal);
        self.step.late[0] = signal;
        (self.sampled.slope, self.sampled.lasts) = match self.slope == 0.0 {
            true => (0.0, f64::INFINITY),
            false => self.held_ramp(commanded),
        };
    }

    /// The slope of v on a ramp of v0 where v is `commanded`, and how long it lasts: until v
    /// reaches a limit, or leaves the one that it is at.
    #[cold]
    fn held_ramp(&self, commanded: f64) -> (f64, f64) {
        let [least, most] = self.parameters.feedback.limits.velocity;
        let ahead = if self.slope > 0.0 { most } else { least };
        let behind = if self.slope > 0.0 { least } else { most };
        let until = |limit: f64| (limit - commanded) / self.slope;
        let soon = 4.0 * f64::EPSILON * self.t.abs().max(1.0);
        if until(behind) > soon {
            (0.0, until(behind))
        } else if until(ahead) > soon {
            (self.slope, until(ahead))
        } else {
            (0.0, f64::INFINITY)
        }
    }

    /// [`Motion::advance`] where readings are held.
    #[inline(never)]
    pub(super) fn advance_sampled(&mut self, horizon: f64) -> Option<Event> {
        let controlled = self.t >= self.parameters.switch_on;
        if controlled && self.t >= self.sampled.sampler.next {
            self.sampled.signal = self.read_now();
            self.hold_signal();
        } else if controlled && self.course.is_some() {
            self.hold_signal();
        }
        let end = match controlled {
            true => self.sampled.sampler.next,
            false => self.parameters.switch_on,
        };
        let (start, end) = (self.t, end.min(horizon));
        let lasts = match controlled {
            true => self.sampled.lasts,
            false => f64::INFINITY,
        };
        let limit = (end - start).min(lasts);
        let (length, radius, mut event) = match self.mode {
            Mode::Stick => self.stick_held(controlled, limit),
            Mode::Forwards | Mode::Backwards => self.slip_held(controlled, limit),
        };
        self.go_on(length, radius);
        if self.slope != 0.0 {
            self.climb();
        }
        if length == end - start && event.is_none() {
            self.t = end;
        }
        if !controlled {
            self.read_since(start);
            if event.is_none() && self.t >= self.parameters.switch_on {
                event = Some(Event::SwitchOn);
            }
        }
        if event.is_none() && self.t >= self.corner && self.course.is_some() {
            self.pass_corner();
            event = Some(Event::Programme);
        }
        self.kink = if event.is_none() { SMOOTH } else { 2 };
        event.map(|event| self.change_mode(event))
    }

    /// Reads the elongation of now. Returns the signal that is held from now on: under control by
    /// the return map the change of the load.
    fn read_now(&mut self) -> f64 {
        match &mut self.sampled.controller {
            Some(controller) => {
                let (number, y) = self.sampled.sampler.sense(self.a);
                controller.steer(number, y, &self.parameters)
            }
            None => self.sampled.sampler.read(self.a),
        }
    }

    /// The number of the next reading.
    pub(in crate::slip) fn reads(&self) -> i64 {
        self.sampled.sampler.number()
    }

    /// The last reading under control by the return map, and the change of the load since then.
    pub(in crate::slip) fn last_reading(&self) -> Option<[f64; 2]> {
        let controller = self.sampled.controller?;
        Some([controller.before?, controller.load])
    }

    /// By how much noise of a reading changes the load under control by the return map, at most;
    /// none under delayed feedback.
    pub(in crate::slip) fn load_of_noise(&self) -> Option<f64> {
        Some(self.sampled.controller?.of_noise())
    }

    /// By how much the load of sliding differs from N0 in the end, under control by a return map
    /// that is wrong about it.
    pub(super) fn load_in_the_end(&self) -> f64 {
        let controller = self.sampled.controller;
        controller.map_or(0.0, |of| of.load_at_rest(&self.parameters, self.last_v0()))
    }

    /// Takes the readings before switch-on of the last step, which began at `start`.
    fn read_since(&mut self, start: f64) {
        while self.sampled.sampler.is_due_before_switch_on(self.t) {
            let (_, a, _) = self.step.state(self.sampled.sampler.next - start);
            self.sampled.sampler.read(a);
        }
    }

    /// Whether the load that is held lifts the block off.
    fn is_lifted(&self, controlled: bool) -> bool {
        controlled && self.sampled.load <= 0.0 && !self.parameters.feedback.limits.holds_load()
    }

    /// Fills a step of a stuck block, whose elongation grows evenly, no longer than `limit`.
    /// Returns its length, how long it holds, and the event that ends it.
    fn stick_held(&mut self, controlled: bool, limit: f64) -> (f64, f64, Option<Event>) {
        let Control {
            v0,
            slope,
            load,
            dashpots: of,
            ..
        } = self.control(controlled);
        let step = &mut self.step;
        let force = self.a + of.damping * v0;
        step.order = 2;
        step.pull = (v0, slope, 0.0);
        step.u[..3].fill(0.0);
        step.a[..3].copy_from_slice(&[self.a, v0, 0.5 * slope]);
        step.n[..3].copy_from_slice(&[load, 0.0, 0.0]);
        step.force[..3].copy_from_slice(&[force, v0 + of.damping * slope, 0.5 * slope]);
        if self.is_lifted(controlled) {
            return (0.0, f64::INFINITY, Some(Event::LiftOff));
        }
        if slope != 0.0 {
            return match self.first_event(limit) {
                Some((s, event)) => (s, f64::INFINITY, Some(event)),
                None => (limit, f64::INFINITY, None),
            };
        }
        let held = self.parameters.law.mu_s() * load;
        let released = [1.0, -1.0].map(|direction| {
            let hold = self.without_noise(held - direction * force);
            let fall = direction * v0;
            if hold < 0.0 {
                Some(0.0)
            } else {
                (fall > 0.0 && hold <= fall * limit).then(|| (hold / fall).min(limit))
            }
        });
        let first = released.into_iter().flatten().reduce(f64::min);
        let event = first.map(|_| Event::Release);
        (first.unwrap_or(limit), f64::INFINITY, event)
    }

    /// Fills a step of a block in slip, no longer than `limit`. Returns its length, how long it
    /// holds, and the event that ends it.
    fn slip_held(&mut self, controlled: bool, limit: f64) -> (f64, f64, Option<Event>) {
        let radius = match self.integrator {
            Integrator::Collocation => self.collocate(controlled, limit),
            Integrator::Taylor if controlled => self.expand_held(limit),
            Integrator::Taylor => {
                self.step.order = self.order_within(limit);
                self.expand(controlled);
                self.free_length()
            }
        };
        if self.is_lifted(controlled) {
            return (0.0, radius, Some(Event::LiftOff));
        }
        // Two halves rather than a long and a tiny step.
        let length = match radius / limit {
            r if r >= 1.0 => limit,
            r if r > 0.5 => 0.5 * limit,
            _ => radius,
        };
        let u = &self.step.u[..=self.step.order];
        let goes_on = u[0].abs() > spread(u, length);
        let first = (!goes_on).then(|| self.first_event(length)).flatten();
        let (length, event) = match first {
            Some((s, event)) => (s, Some(event)),
            None => (length, None),
        };
        match self.friction_crossing(length) {
            Some(crossing) => (crossing.s, radius, None),
            None => (length, radius, event),
        }
    }

    /// Works out the coefficients of a step in slip between two readings, as many as a step of
    /// length `limit` needs. Returns how long they hold, at most `limit` where they do so long.
    fn expand_held(&mut self, limit: f64) -> f64 {
        let mut order = self.sampled.order.clamp(LEAST, self.order);
        loop {
            self.step.order = order;
            self.expand(true);
            let [before, last] = self.last_terms(limit);
            // NaN ends the motion elsewhere.
            if last <= self.tolerance || order >= self.order || last.is_nan() {
                let spare = before <= SPARE * self.tolerance;
                self.sampled.order = if spare { order - 1 } else { order };
                if last.is_nan() || last > self.tolerance {
                    return self.free_length();
                }
                // Near sliding a low order tells the motion, but does not bound the friction.
                let holds = self.resolved_by_friction(limit);
                if holds >= limit || order >= self.order {
                    return holds;
                }
            }
            order = (order + MORE).min(self.order);
        }
    }

    /// What counts of the terms before the last one, and of those up to it, at the end of a step of
    /// length `limit`: of u and of a, relative to their sizes.
    fn last_terms(&self, limit: f64) -> [f64; 2] {
        let (u, a, order) = (&self.step.u, &self.step.a, self.step.order);
        let [speed, stretch] = self.sizes();
        let term = |k: usize| (u[k].abs() / speed).max(a[k].abs() / stretch);
        let least = power(limit, order as i32 - 2);
        let terms = [
            least * term(order - 2),
            least * limit * term(order - 1),
            least * limit * limit * term(order),
        ];
        [0, 1].map(|k| (terms[k] / BEFORE_LAST).max(terms[k + 1]))
    }
}
