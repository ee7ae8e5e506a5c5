//! The motion of the block: slip, stick and what lies between them.
//!
//! In units of √(M/κ) for times, N0/κ for lengths and N0 for forces the letter's Eqs. (1) and (2)
//! read, with u = ẋ and the dashpots d and g, which the letter lacks,
//!
//! ```text
//! u̇ = a + d ȧ − g u − sgn(u) μ_K(|u|) n    in slip,                                     (1)
//! u = 0 while |a + d ȧ| < μ_S n            in stick,
//! ȧ = v − u,   v = v0 + α_v S(t),   n = 1 + α_n S(t),   S(t) = a(t) − a(t−τ)          (2)
//! ```
//!
//! with v and n clipped to the limits of the actuators.
//!
//! With memory R and latency δ (`feedback`)
//!
//! ```text
//! S(t) = a(t−δ) − a(t−δ−τ) + R S(t−τ)                                                 (3)
//! ```
//!
//! A step is a Taylor series in the time since its start, whose coefficients follow from (1), (2)
//! and the polynomial of the delayed elongation. So the solution between steps is known to the
//! order of the method at no cost, and events are zeros of polynomials. A step ends where the
//! delayed polynomial ends, if it differs from the next one by more than the tolerance. So steps
//! end on kinks, one delay after the other, until these are too smooth to matter.
//!
//! - `actuators`: v and N held at the limits of their actuators
//! - `advance`: one step after the other: its length and its end
//! - `collocated`: steps by collocation: how long they are, the rates there
//! - `continued`: a motion that goes on from others: copies, extrapolation
//! - `course`: the corners of a programme of v0, and which of them are behind
//! - `events`: zeros of a step's polynomials, told apart from rounding
//! - `held`: where a signal is beside the values at which actuators reach their limits
//! - `held_signal`: readings, and what is held from one of them to the next
//! - `sampled`: steps between readings of a digital loop
//! - `parameters`: what a motion is given: parameters, integrator, accuracy
//! - `programmed`: v0 that follows a programme
//! - `stick`: a stuck block whose elongation grows evenly
//! - `taylor`: steps by Taylor's method

mod actuators;
mod advance;
mod collocated;
mod continued;
mod course;
mod events;
mod feedback;
mod held;
mod held_signal;
pub(in crate::slip) mod parameters;
mod programmed;
mod sampled;
mod stick;
mod taylor;

use super::collocation::NODES;
use crate::model::law::FrictionSeries;
use course::Course;
use held::Held;
use held_signal::Sampled;
pub use parameters::{Accuracy, Event, Integrator, Mode, Parameters};

use super::history::History;
pub use super::history::{BYTES_OF_A_STEP, MOST_KEPT, Stretch};
use super::step::Step;
use crate::model::elementary::ln;
use crate::model::series::{MOST_ORDER, value};
use crate::model::stop::Stop;
use crate::model::{Channel, Feedback};

/// Rounding of a force, relative.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// The lowest order of Taylor's method.
const LEAST_ORDER: usize = 4;

/// The fixed order of collocation, or the order at which Taylor's method does least work per unit
/// of time (Jorba and Zou 2005).
fn order(integrator: Integrator, tolerance: f64) -> usize {
    if integrator == Integrator::Collocation {
        return NODES;
    }
    ((2.0 - 0.5 * ln(tolerance)).ceil() as usize).clamp(LEAST_ORDER, MOST_ORDER)
}

/// A moving block.
#[derive(Debug, Clone)]
pub struct Motion {
    parameters: Parameters,
    integrator: Integrator,
    tolerance: f64,
    order: usize,
    friction: FrictionSeries,
    history: History,
    /// V, which is fed back one latency later, where the feedback has a latency.
    signal: History,
    /// Where the feedback is read at equal times: its readings, in the place of both histories.
    sampled: Sampled,
    mode: Mode,
    /// Time.
    pub t: f64,
    /// ẋ.
    pub u: f64,
    /// Elongation.
    pub a: f64,
    /// Order of the lowest derivative that jumps now: of a or, with memory, of W.
    kink: u32,
    /// Order of the lowest derivative of V that jumps now, where the feedback has a latency.
    signal_kink: u32,
    /// Since when the block has stuck while its elongation has grown evenly, at the rate of
    /// [`Motion::even_rate`]; +∞ while it does not.
    even_since: f64,
    /// The limits at which v and N were in the last step.
    held: Held,
    /// The slope of v0, and the time of the next corner of its programme: 0 and +∞ without one.
    slope: f64,
    corner: f64,
    /// The programme of v0.
    course: Option<Box<Course>>,
    /// The last step's polynomials of u, a, n and the delayed elongation, and its length.
    step: Step,
    stop: Stop,
}

impl Motion {
    /// A block that slides or sticks at t = 0 with velocity `u` and elongation `a`, which was `a`
    /// at all times before.
    #[must_use]
    pub fn new(parameters: Parameters, accuracy: Accuracy, u: f64, a: f64) -> Self {
        Self::with_histories(parameters, accuracy, (u, a), Default::default())
    }

    /// Begins another motion, as [`Motion::new`] does, without allocating anew.
    pub fn restart(&mut self, parameters: Parameters, accuracy: Accuracy, u: f64, a: f64) {
        let histories = [&mut self.history, &mut self.signal].map(std::mem::take);
        let sampled = std::mem::take(&mut self.sampled);
        let stop = std::mem::take(&mut self.stop);
        let begun = Self::with_histories(parameters, accuracy, (u, a), (histories, sampled));
        *self = begun.heeding(stop);
    }

    fn with_histories(
        mut parameters: Parameters,
        accuracy: Accuracy,
        (u, a): (f64, f64),
        ([mut history, mut signal], mut sampled): ([History; 2], Sampled),
    ) -> Self {
        if !parameters.feedback.acts() {
            // Nothing is fed back, so memory and latency have no effect.
            parameters.feedback.channel = Channel::default();
        }
        sampled.restart(&mut parameters, 0.0, |_| a);
        let tolerance = accuracy.tolerance.clamp(1e-15, 1e-3);
        let order = order(accuracy.integrator, tolerance);
        let mut friction = FrictionSeries::new(&parameters.law, parameters.velocity_unit);
        friction.restart(u.abs());
        history.restart(a, 0.0, order as u32);
        signal.restart(0.0, 0.0, order as u32);
        let gain = parameters
            .feedback
            .gains
            .alpha_v
            .abs()
            .max(parameters.feedback.gains.alpha_n.abs());
        history.look_ahead(gain, order, tolerance);
        signal.look_ahead(gain, order, tolerance);
        let step = Step {
            is_late: parameters.feedback.channel.latency > 0.0 || sampled.acts(),
            ..Step::NONE
        };
        let mut motion = Self {
            parameters,
            integrator: accuracy.integrator,
            tolerance,
            order,
            friction,
            history,
            signal,
            sampled,
            mode: Mode::Stick,
            t: 0.0,
            u,
            a,
            kink: 1,
            signal_kink: 1,
            even_since: f64::INFINITY,
            held: Held::default(),
            slope: 0.0,
            corner: f64::INFINITY,
            course: None,
            step,
            stop: Stop::default(),
        };
        let pulled = motion.parameters.v0 - motion.u;
        let damping = motion.parameters.dashpots.damping;
        motion.mode = motion.mode_at(motion.a + damping * pulled, 1.0);
        if motion.mode == Mode::Stick {
            motion.even_since = 0.0;
        }
        motion
    }

    /// The same motion, but it ends once `stop` is set, as do all motions begun in its memory.
    #[must_use]
    pub fn heeding(self, stop: Stop) -> Self {
        Self { stop, ..self }
    }

    /// From now on it ends once `stop` is set, as in [`Motion::heeding`].
    pub fn heed(&mut self, stop: &Stop) {
        self.stop.clone_from(stop);
    }

    /// Whether it was told to stop; its state is then NaN.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.is_set()
    }

    /// Puts the block at the end of a stick that erased all memory: it is released at t = 0 to slip
    /// forwards from the elongation `a`, which has grown at the rate v0 for longer than a delay.
    pub fn release_from(&mut self, a: f64) {
        let Parameters {
            v0,
            feedback: Feedback { tau, .. },
            ..
        } = self.parameters;
        let fed_back = self.even_signal(v0);
        let kept = self.kept(a, fed_back);
        self.history.restart_rising(kept, v0, tau);
        self.signal.restart(fed_back, 0.0, self.order as u32);
        (self.t, self.u, self.a) = (0.0, 0.0, a);
        self.mode = Mode::Forwards;
        self.friction.restart(0.0);
        self.even_since = f64::INFINITY;
        self.held = Held::default();
        (self.kink, self.signal_kink) = (2, 2);
        if self.is_sampled() {
            self.parameters.feedback = self.feedback();
            let rising = |t: f64| a + v0 * t;
            self.sampled
                .restart(&mut self.parameters, f64::NEG_INFINITY, rising);
        }
    }

    /// Changes v0 from now on.
    pub fn set_v0(&mut self, v0: f64) {
        self.parameters.v0 = v0;
        if self.mode == Mode::Stick {
            self.even_since = self.t;
        }
        (self.kink, self.signal_kink) = (1, 1);
        if self.is_sampled() {
            self.hold_signal();
        }
    }

    /// Changes the delay from now on, to less than twice the present one: the past is known for two
    /// delays.
    pub fn set_delay(&mut self, tau: f64) {
        self.parameters.feedback.tau = tau;
        if self.mode == Mode::Stick {
            self.even_since = self.t;
        }
        self.kink = self.kink_of_jump();
        self.signal_kink = 0;
    }

    /// Goes on with another accuracy, by the same integrator.
    pub fn refine(&mut self, accuracy: Accuracy) {
        self.tolerance = accuracy.tolerance.clamp(1e-15, 1e-3);
        self.order = order(self.integrator, self.tolerance);
        let gain = self.gain();
        for history in [&mut self.history, &mut self.signal] {
            history.feel(self.order as u32);
            history.look_ahead(gain, self.order, self.tolerance);
        }
    }

    /// Makes the present t = 0, with control acting from `switch_on` on. The past stays what it is.
    pub(super) fn begin_here(&mut self, switch_on: f64) {
        for history in [&mut self.history, &mut self.signal] {
            history.shift(-self.t);
        }
        self.even_since -= self.t;
        self.t = 0.0;
        self.parameters.switch_on = switch_on;
        if switch_on <= 0.0 {
            (self.kink, self.signal_kink) = (1, 1);
        }
    }

    /// Whether its state is not known: two delays take more steps than are kept, or the friction
    /// law has no value where the block would be. The motion then ends undecided, and its state is
    /// no number.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        !(self.u.is_finite() && self.a.is_finite())
    }

    /// Whether it is lost because two delays take more steps than are kept.
    #[must_use]
    pub(crate) fn outgrows_its_past(&self) -> bool {
        self.is_lost() && (self.history.is_full() || self.signal.is_full())
    }

    /// The parameters, with v0 as it is now.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The elongation of continuous sliding at v0, as it is in the end.
    #[must_use]
    pub fn sliding_elongation(&self) -> f64 {
        let (p, v0) = (&self.parameters, self.last_v0());
        let load = 1.0 + self.load_in_the_end();
        p.law.mu_k(v0 * p.velocity_unit) * load + p.dashpots.viscous * v0
    }

    /// The elongation at which a stuck block without control is released forwards, pulled at v0.
    #[must_use]
    pub(crate) fn release_elongation(parameters: &Parameters) -> f64 {
        parameters.law.mu_s() - parameters.dashpots.damping * parameters.v0
    }

    /// What the block does now.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The last step.
    #[must_use]
    pub fn last_step(&self) -> &Step {
        &self.step
    }

    /// The smaller one of `known` and the smallest load of the last step. A limit is passed by the
    /// noise of a step, which does not count.
    pub(crate) fn smallest_load(&self, known: f64) -> f64 {
        let limits = self.parameters.feedback.limits;
        limits.load_of(self.step.smallest_load(known)).min(known)
    }

    /// The force that a block which has just stopped lacks to move, μ_S n − |a + d ȧ|.
    #[must_use]
    pub fn hold_now(&self) -> f64 {
        let n = value(&self.step.n[..=self.step.order], self.step.length);
        self.parameters.law.mu_s() * n - self.step.force_at_end().abs()
    }

    /// The mode of the present state under the `force` of spring and dashpot and the load `n`.
    fn mode_at(&self, force: f64, n: f64) -> Mode {
        let moving = if self.u != 0.0 {
            self.u
        } else if force.abs() <= self.parameters.law.mu_s() * n + self.force_noise() {
            // At the limit stick comes first: whether it lasts is seen from how the forces change.
            return Mode::Stick;
        } else {
            force
        };
        if moving > 0.0 {
            Mode::Forwards
        } else {
            Mode::Backwards
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Dashpots, FrictionLaw};

    /// Events of the letter's Fig. 3: times of switch-on, and of what follows.
    fn fig3(
        v0: f64,
        alpha_v: f64,
        alpha_n: f64,
        tau: f64,
        accuracy: Accuracy,
    ) -> Vec<(f64, Event, f64)> {
        let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
        let rest = law.mu_k(v0);
        let parameters = Parameters {
            law,
            velocity_unit: 1.0,
            dashpots: Dashpots::default(),
            feedback: Feedback::new(alpha_v, alpha_n, tau),
            v0,
            switch_on: 70.0,
        };
        let mut motion = Motion::new(parameters, accuracy, 1.01 * v0, rest);
        let mut events = Vec::new();
        while motion.t < 150.0 {
            if let Some(event) = motion.advance(150.0) {
                events.push((motion.t, event, motion.a));
            }
        }
        events
    }

    fn last_release(events: &[(f64, Event, f64)]) -> (f64, f64) {
        let last = events
            .iter()
            .rev()
            .find(|e| e.1 == Event::Release)
            .expect("released");
        (last.0, last.2)
    }

    #[test]
    fn the_events_of_the_letters_figure_3() {
        let accuracy = Accuracy::default();
        let a = fig3(0.35, -0.33, 0.0, 4.15, accuracy);
        let b = fig3(0.1, 0.0, -10.0, 0.5, accuracy);
        for (events, slip, stick) in [(&a, 3.97549563, 4.92001175), (&b, 3.44600138, 15.85555061)] {
            let before: Vec<_> = events.iter().filter(|e| e.0 < 70.0).collect();
            let last = before.iter().rposition(|e| e.1 == Event::Release);
            let Some([release, stop, again]) = last.and_then(|i| before.get(i - 2..=i)) else {
                panic!("a slip and a stick");
            };
            assert_eq!((release.1, stop.1), (Event::Release, Event::Stick));
            assert!(
                (stop.0 - release.0 - slip).abs() < 1e-8,
                "{}",
                stop.0 - release.0
            );
            assert!(
                (again.0 - stop.0 - stick).abs() < 1e-8,
                "{}",
                again.0 - stop.0
            );
        }
        assert!(
            (last_release(&a).0 - 97.029009396).abs() < 1e-8,
            "{:?}",
            last_release(&a)
        );
        let (t, elongation) = last_release(&b);
        assert!(
            (t - 76.277483031).abs() < 1e-8 && (elongation - 0.5).abs() < 1e-8,
            "{t} {elongation}"
        );
    }
}
