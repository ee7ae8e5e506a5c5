//! The motion of the block: slip, stick and what lies between them.
//!
//! In units of √(M/κ) for times, N0/κ for lengths and N0 for forces the letter's Eqs. (1) and   (2)
//! read, with u = ẋ,
//!
//! ```text
//! u̇ = a − sgn(u) μ_K(|u|) n    in slip,      u = 0 while |a| < μ_S n    in stick,   (1)
//! ȧ = v − u,   v = v0 + α_v [a(t) − a(t−τ)],   n = 1 + α_n [a(t) − a(t−τ)]           (2)
//! ```
//!
//! A step is a Taylor series in the time since its start, whose coefficients follow from (1),   (2)
//! and the polynomial that the delayed elongation is there. So the solution between steps is known
//! to the order of the method at no cost, and events are zeros of polynomials. A step ends where
//! the delayed polynomial ends, if the next one is another by more than the tolerance: kinks are
//! stepped on, one delay after the other, until they are too smooth to be felt.

mod collocated;

use super::collocation::NODES;
use super::friction_series::FrictionSeries;
pub use super::history::{BYTES_OF_A_STEP, MOST_KEPT, Stretch};
use super::history::{History, SMOOTH};
use super::series::{Coefficients, MOST_ORDER, first_zero, spread, value};
use super::step::{Control, Step};
use super::table_series::Crossing;
use crate::model::FrictionLaw;
use crate::model::elementary::{ln, rough_log2, rough_root};

/// What the block does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// At rest.
    Stick,
    /// ẋ > 0.
    Forwards,
    /// ẋ < 0.
    Backwards,
}

/// What ends a mode, or changes the equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// From stick to slip.
    Release,
    /// From slip to stick.
    Stick,
    /// From slip to slip the other way.
    Reversal,
    /// N ≤ 0: the model ends.
    LiftOff,
    /// Control begins to act.
    SwitchOn,
}

/// The parameters of a motion, dimensionless as in the module.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// The friction law.
    pub law: FrictionLaw,
    /// N0/√(κM), the unit of velocity in which the law's speeds are given.
    pub velocity_unit: f64,
    /// α_v √(M/κ).
    pub alpha_v: f64,
    /// α_N/κ.
    pub alpha_n: f64,
    /// τ √(κ/M), greater than 0 where control acts.
    pub tau: f64,
    /// v0 √(κM)/N0.
    pub v0: f64,
    /// When control begins to act.
    pub switch_on: f64,
}

/// How steps are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrator {
    /// By Taylor series.
    Taylor,
    /// By collocation, from values of the friction law: a second opinion, some ten times slower.
    Collocation,
}

/// How exact a motion is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// How steps are made.
    pub integrator: Integrator,
    /// Error allowed in a step, relative to the size of the motion; 1e-15 to 1e-3.
    pub tolerance: f64,
}

impl Accuracy {
    /// Of this tolerance.
    #[must_use]
    pub fn of(tolerance: f64) -> Self {
        Self {
            tolerance,
            ..Self::default()
        }
    }
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            integrator: Integrator::Taylor,
            tolerance: 1e-12,
        }
    }
}

/// Speeds below this, in units of N0/√(κM), need no relative accuracy.
const SLOWEST: f64 = 1e-3;

/// Steps shorter than this, relative to what their series allow, have fewer terms; and how many
/// more than they seem to need.
const SHORT: f64 = 0.5;
const SPARE_TERMS: usize = 2;
const LEAST_ORDER: usize = 4;

/// The part of what a polynomial looks ahead that steps take where they outlast the delay: they
/// need the one before beyond its end.
const BALANCED: f64 = 0.53;

/// A block that was just released does not accelerate backwards. Under a law with μ_K(0⁺) = μ_S it
/// does not accelerate at all at first, and the polynomials of its past before and after the
/// release differ by more than one step's error: so many times the noise of forces.
const RELEASED: f64 = 1e4;

/// How well what was foreseen has to be what comes, in units of the tolerance; a step that goes on
/// for too long becomes shorter by this, so often at most.
const FORESEEN: f64 = 2.0;
const SHORTER: f64 = 0.7;
const MOST_SHORTER: u32 = 12;

/// The part of the error of a step within which the elongation of a stuck block grows evenly.
const EVEN: f64 = 0.1;

/// Rounding of a force, relative.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The order of collocation; that at which Taylor's method does least work per unit of time (Jorba
/// and Zou 2005).
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
    mode: Mode,
    /// Time.
    pub t: f64,
    /// ẋ.
    pub u: f64,
    /// Elongation.
    pub a: f64,
    /// Order of the lowest derivative of a that jumps now.
    kink: u32,
    /// Since when the block has stuck while its elongation has grown evenly, at the rate of
    /// [`Motion::even_rate`]; +∞ while it does not.
    even_since: f64,
    /// The last step's polynomials of u, a, n and the delayed elongation, and its length.
    step: Step,
}

impl Motion {
    /// A block that slides or sticks at t = 0 with velocity `u` and elongation `a`, which was `a`
    /// at all times before.
    #[must_use]
    pub fn new(parameters: Parameters, accuracy: Accuracy, u: f64, a: f64) -> Self {
        Self::with_history(parameters, accuracy, (u, a), History::default())
    }

    /// Begins another motion, as [`Motion::new`] does, without allocating anew.
    pub fn restart(&mut self, parameters: Parameters, accuracy: Accuracy, u: f64, a: f64) {
        let history = std::mem::take(&mut self.history);
        *self = Self::with_history(parameters, accuracy, (u, a), history);
    }

    fn with_history(
        parameters: Parameters,
        accuracy: Accuracy,
        (u, a): (f64, f64),
        mut history: History,
    ) -> Self {
        let tolerance = accuracy.tolerance.clamp(1e-15, 1e-3);
        let order = order(accuracy.integrator, tolerance);
        let mut friction = FrictionSeries::new(&parameters.law, parameters.velocity_unit);
        friction.restart(u.abs());
        history.restart(a, 0.0, order as u32);
        let gain = parameters.alpha_v.abs().max(parameters.alpha_n.abs());
        history.look_ahead(gain, order, tolerance);
        let zero = [0.0; MOST_ORDER + 1];
        let mut motion = Self {
            parameters,
            integrator: accuracy.integrator,
            tolerance,
            order,
            friction,
            history,
            mode: Mode::Stick,
            t: 0.0,
            u,
            a,
            kink: 1,
            even_since: f64::INFINITY,
            step: Step {
                length: 0.0,
                radius: 0.0,
                order: 0,
                u: zero,
                a: zero,
                n: zero,
                delayed: zero,
            },
        };
        motion.mode = motion.mode_at(1.0);
        if motion.mode == Mode::Stick {
            motion.even_since = 0.0;
        }
        motion
    }

    /// Puts the block at the end of a stick that erased all memory: it is released at t = 0 to slip
    /// forwards from the elongation `a`, which has grown at the rate v0 for longer than a delay.
    pub fn release_from(&mut self, a: f64) {
        let v0 = self.parameters.v0;
        self.history.restart_rising(a, v0, self.parameters.tau);
        (self.t, self.u, self.a) = (0.0, 0.0, a);
        self.mode = Mode::Forwards;
        self.friction.restart(0.0);
        self.even_since = f64::INFINITY;
        self.kink = 2;
    }

    /// Changes v0 from now on.
    pub fn set_v0(&mut self, v0: f64) {
        self.parameters.v0 = v0;
        if self.mode == Mode::Stick {
            self.even_since = self.t;
        }
        self.kink = 1;
    }

    /// Changes the delay from now on, to less than twice what it was: the past is known for so
    /// long.
    pub fn set_delay(&mut self, tau: f64) {
        self.parameters.tau = tau;
        if self.mode == Mode::Stick {
            self.even_since = self.t;
        }
        self.kink = 1;
    }

    /// Goes on with another accuracy, by the same integrator.
    pub fn refine(&mut self, accuracy: Accuracy) {
        self.tolerance = accuracy.tolerance.clamp(1e-15, 1e-3);
        self.order = order(self.integrator, self.tolerance);
        self.history.feel(self.order as u32);
        let gain = self
            .parameters
            .alpha_v
            .abs()
            .max(self.parameters.alpha_n.abs());
        self.history.look_ahead(gain, self.order, self.tolerance);
    }

    /// Becomes a copy of `other`, a motion with the same law and accuracy, in memory that is there.
    pub fn copy_from(&mut self, other: &Self) {
        self.parameters.clone_from(&other.parameters);
        self.history.copy_from(&other.history);
        self.friction.copy_place(&other.friction);
        self.mode = other.mode;
        (self.t, self.u, self.a) = (other.t, other.u, other.a);
        (self.kink, self.even_since) = (other.kink, other.even_since);
        self.step.clone_from(&other.step);
    }

    /// Becomes a block that is released at t = 0 at `v0` and with the delay `tau`, with a past that
    /// differs from that of `last` by `share` of the difference between `last` and `before`: two
    /// motions of the same law, gains and accuracy as they are released. Stretches of time that
    /// correspond to one another, the last one first, are slips and sticks; they are gone through
    /// again and again.
    ///
    /// `tau` is less than twice the delays of both, whose past is known for so long. False where
    /// the past has no room; the motion then means nothing.
    pub fn extrapolate(
        &mut self,
        (last, before): (&mut Self, &mut Self),
        share: f64,
        (v0, tau): (f64, f64),
        stretches: &[Stretch],
    ) -> bool {
        self.parameters.clone_from(&last.parameters);
        (self.parameters.v0, self.parameters.tau) = (v0, tau);
        let pasts = (&mut last.history, &mut before.history);
        let has_room = self
            .history
            .extrapolate(pasts, share, 1.01 * tau, stretches);
        self.friction.restart(0.0);
        self.mode = Mode::Forwards;
        self.a = last.a + share * (last.a - before.a);
        (self.t, self.u) = (0.0, 0.0);
        (self.kink, self.even_since) = (1, f64::INFINITY);
        has_room
    }

    /// Makes the present t = 0, with control acting from `switch_on` on. The past stays what it is.
    pub(super) fn begin_here(&mut self, switch_on: f64) {
        self.history.shift(-self.t);
        self.even_since -= self.t;
        self.t = 0.0;
        self.parameters.switch_on = switch_on;
        if switch_on <= 0.0 {
            self.kink = 1;
        }
    }

    /// Two delays take more steps than are kept: the motion ends here undecided, and its state is
    /// no number.
    #[must_use]
    pub fn outgrows_its_past(&self) -> bool {
        self.u.is_nan() && self.history.is_full()
    }

    /// The parameters.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The elongation of continuous sliding at v0.
    #[must_use]
    pub fn sliding_elongation(&self) -> f64 {
        let p = &self.parameters;
        p.law.mu_k(p.v0 * p.velocity_unit)
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

    /// The force that is missing for a block to move that has just stopped.
    #[must_use]
    pub fn hold_now(&self) -> f64 {
        let n = value(&self.step.n[..=self.step.order], self.step.length);
        self.parameters.law.mu_s() * n - self.a.abs()
    }

    /// The mode of the present state under the load `n`.
    fn mode_at(&self, n: f64) -> Mode {
        let moving = if self.u != 0.0 {
            self.u
        } else if self.a.abs() <= self.parameters.law.mu_s() * n + self.force_noise() {
            // At the limit stick comes first: whether it lasts is seen from how the forces change.
            return Mode::Stick;
        } else {
            self.a
        };
        if moving > 0.0 {
            Mode::Forwards
        } else {
            Mode::Backwards
        }
    }

    /// One step, not beyond `horizon`, and the event that ends it, if one does.
    pub fn advance(&mut self, horizon: f64) -> Option<Event> {
        let controlled = self.t >= self.parameters.switch_on;
        let delay_limit = self.read_delayed(controlled);
        let mut limit = delay_limit.length.min(horizon - self.t);
        let until_switch = self.parameters.switch_on - self.t;
        if !controlled {
            limit = limit.min(until_switch);
        } else if self.mode == Mode::Stick
            && self.parameters.alpha_v != 0.0
            && !self.sticks_evenly()
        {
            // What the last polynomial foresees is not held by anything while the block does not
            // move.
            limit = limit.min(self.parameters.tau);
        }
        let mut free = match (self.even_rate(), self.integrator) {
            (Some(rate), _) if controlled && self.sticks_evenly() => self.stick_evenly(rate),
            (_, Integrator::Taylor) => {
                self.step.order = self.order_within(limit);
                self.expand(controlled);
                self.free_length()
            }
            (_, Integrator::Collocation) => self.collocate(controlled, limit),
        };
        if self.step.n[0] <= 0.0 {
            self.step.length = 0.0;
            return Some(Event::LiftOff);
        }
        let radius = free;
        let balanced = BALANCED * self.history.ahead() * free;
        if controlled && self.parameters.tau < balanced && self.integrator == Integrator::Taylor {
            // The next step, one delay behind, uses the polynomial of this one beyond its end.
            free = balanced;
        }
        // Two halves rather than a long and a tiny step.
        let length = match free / limit {
            r if r >= 1.0 => limit,
            r if r > 0.5 && delay_limit.kink != SMOOTH => 0.5 * limit,
            _ => free,
        };
        let length = match controlled && self.integrator == Integrator::Taylor {
            true => self.as_foreseen(length),
            false => length,
        };
        let found = self.first_event(length);
        let mut length = found.map_or(length, |(s, _)| s);
        let mut event = found.map(|(_, event)| event);
        let crossing = self.friction_crossing(length);
        if let Some(crossing) = crossing {
            length = crossing.s;
            event = None;
        }
        self.finish(length, radius);
        if self.mode == Mode::Stick {
            self.note_evenness();
        }
        self.kink = SMOOTH;
        if let Some(crossing) = crossing {
            self.kink = crossing.kink;
        } else if event.is_some() {
            self.kink = 2;
        } else if !controlled && length == until_switch {
            self.t = self.parameters.switch_on;
            self.kink = if self.parameters.alpha_v == 0.0 { 2 } else { 1 };
            event = Some(Event::SwitchOn);
        } else if length == delay_limit.length && delay_limit.kink != SMOOTH {
            self.kink = self.passed_on(delay_limit.kink);
        }
        match event {
            Some(Event::SwitchOn) | None => event,
            Some(event) => Some(self.change_mode(event)),
        }
    }

    /// Fills the delayed polynomial. Tells how long a step may be for it, and the kink there.
    fn read_delayed(&mut self, controlled: bool) -> DelayLimit {
        // Also before control acts, so that memory does not grow with time.
        self.history
            .forget_before(self.t - 2.0 * self.parameters.tau);
        if !controlled {
            return DelayLimit {
                length: f64::INFINITY,
                kink: SMOOTH,
            };
        }
        if self.sticks_evenly() {
            return DelayLimit {
                length: self.longest_stick(),
                kink: SMOOTH,
            };
        }
        let time = self.t - self.parameters.tau;
        let reach = self.history.read(time, self.kink, &mut self.step.delayed);
        DelayLimit {
            length: reach.until - time,
            kink: reach.kink,
        }
    }

    /// `length`, or less of it where it outlasts the delay: the polynomial of the last step stood
    /// in for what was yet to come, and the step may go on for as long as that is what has come.
    ///
    /// The last terms of a series do not tell this. Errors of the terms in its middle grow from
    /// step to step where a polynomial is used far beyond its end, as those of a stick do, which
    /// has no terms of its own to hold against them.
    fn as_foreseen(&self, length: f64) -> f64 {
        let mut beyond = length - self.parameters.tau;
        if beyond <= 0.0 {
            return length;
        }
        let a = &self.step.a[..=self.step.order];
        let stretch = a[0].abs().max(self.parameters.law.mu_s());
        let holds = |s: f64| {
            let off = value(a, s) - self.history.foreseen(self.t + s);
            // What is not a number ends the motion elsewhere, not here.
            off.is_nan() || off.abs() <= FORESEEN * self.tolerance * stretch
        };
        if holds(beyond) {
            return length;
        }
        for _ in 0..MOST_SHORTER {
            beyond *= SHORTER;
            if holds(beyond) {
                return beyond + self.parameters.tau;
            }
        }
        self.parameters.tau
    }

    /// The rate v at which the elongation of a stuck block grows evenly: v = v0 + α_v v τ. Other
    /// ways to grow die out where α_v τ < 1; else they do not, and there is none.
    fn even_rate(&self) -> Option<f64> {
        let p = &self.parameters;
        let share = p.alpha_v * p.tau;
        (share < 1.0).then(|| p.v0 / (1.0 - share))
    }

    /// A stuck block's elongation has grown evenly for a delay, and so it goes on until release.
    fn sticks_evenly(&self) -> bool {
        self.even_since + self.parameters.tau <= self.t
    }

    /// Works out the coefficients of a block that sticks evenly, which hold without end.
    fn stick_evenly(&mut self, rate: f64) -> f64 {
        let Parameters { alpha_n, tau, .. } = self.parameters;
        let step = &mut self.step;
        for c in [&mut step.u, &mut step.a, &mut step.n, &mut step.delayed] {
            c.fill(0.0);
        }
        step.order = 1;
        (step.a[0], step.a[1]) = (self.a, rate);
        (step.delayed[0], step.delayed[1]) = (self.a - rate * tau, rate);
        step.n[0] = 1.0 + alpha_n * (step.a[0] - step.delayed[0]);
        f64::INFINITY
    }

    /// Notes whether the elongation of a stuck block has grown evenly in the last step. What it may
    /// be off adds up to less than the error of a step in a delay, and the nearer α_v τ is to 1,
    /// the slower it dies out and the less it may be.
    fn note_evenness(&mut self) {
        let step = &self.step;
        let even = self.even_rate().is_some_and(|rate| {
            let share = (step.length / self.parameters.tau).min(1.0);
            let dies_out = (self.parameters.v0 / rate).min(1.0);
            let allowed = (EVEN * self.tolerance * share * dies_out).max(ROUNDING);
            let a = &step.a[1..=step.order];
            let off = ((a[0] - rate).abs() + spread(a, step.length)) * step.length;
            off <= allowed * step.a[0].abs().max(self.parameters.law.mu_s())
        });
        if !even {
            self.even_since = self.t;
        }
    }

    /// More than the time until release of a block whose elongation has grown evenly for a delay.
    fn longest_stick(&self) -> f64 {
        let p = &self.parameters;
        let load = 1.0 + (p.alpha_n * p.v0 * p.tau).abs();
        2.0 * (self.a.abs() + p.law.mu_s() * load) / p.v0.abs()
    }

    /// The order of a kink of the delayed elongation after it has passed into the motion.
    fn passed_on(&self, kink: u32) -> u32 {
        let smoother = match (self.mode, self.parameters.alpha_v != 0.0) {
            (_, true) => 1,
            // A stuck block feels the load only when it is released.
            (Mode::Stick, false) => return SMOOTH,
            (_, false) => 2,
        };
        kink + smoother
    }

    fn control(&self, controlled: bool) -> Control {
        let p = &self.parameters;
        Control {
            v0: p.v0,
            alpha_v: if controlled { p.alpha_v } else { 0.0 },
            alpha_n: if controlled { p.alpha_n } else { 0.0 },
        }
    }

    /// Works out the coefficients of the step, Eqs. (1) and (2) of the module.
    fn expand(&mut self, controlled: bool) {
        let control = self.control(controlled);
        let step = &mut self.step;
        step.u[0] = self.u;
        step.a[0] = self.a;
        let direction = match self.mode {
            Mode::Stick => return step.stick(control),
            Mode::Forwards => 1.0,
            Mode::Backwards => -1.0,
        };
        match &mut self.friction {
            FrictionSeries::Coulomb(series) => step.slip(control, direction, series),
            FrictionSeries::Weakening(series) => step.slip(control, direction, series),
            FrictionSeries::Stribeck(series) => step.slip(control, direction, series),
            FrictionSeries::Table(series) => step.slip(control, direction, series),
        }
    }

    /// The order that a step no longer than `limit` needs: where delays or kinks end steps long
    /// before the series does, a lower one will do. Told from the step before; the error is held by
    /// [`Self::free_length`], whatever the order.
    fn order_within(&self, limit: f64) -> usize {
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
    fn free_length(&self) -> f64 {
        let step = &self.step;
        let (u, a) = (&step.u, &step.a);
        let speed = u[0].abs().max(self.parameters.v0.abs()).max(SLOWEST);
        let stretch = a[0].abs().max(self.parameters.law.mu_s());
        // log₂ to 0.1: enough to tell which of the last two terms asks for the shorter step.
        let roughest_log2 = |x: f64| (x.to_bits() >> 42) as f64 / 1024.0 - 1023.0;
        let asked = [step.order - 1, step.order].map(|k| {
            // What is not a number ends the motion elsewhere, not here.
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
        let error = self.tolerance * speed / (length * step.n[0].abs());
        self.friction.resolved(&u[..=step.order], length, error)
    }

    /// The first event within `length`.
    fn first_event(&self, length: f64) -> Option<(f64, Event)> {
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
        if self.parameters.alpha_n != 0.0 {
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

    /// The first point of a table of friction that the speed crosses before `length`; the series
    /// goes on behind it.
    fn friction_crossing(&mut self, length: f64) -> Option<Crossing> {
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

    /// What holds the block against a pull in `direction`: μ_S n − a in stick.
    fn hold(&self, direction: f64) -> Coefficients {
        let mu_s = self.parameters.law.mu_s();
        let mut hold = [0.0; MOST_ORDER + 1];
        let terms = self.step.n.iter().zip(&self.step.a);
        for (hold, (n, a)) in hold.iter_mut().zip(terms).take(self.step.order + 1) {
            *hold = mu_s * n - direction * a;
        }
        hold[0] = self.without_noise(hold[0]);
        hold
    }

    /// |ẋ| in slip. A block that was just released does not accelerate backwards: μ_K(0⁺) ≤ μ_S.
    fn speed(&self) -> Coefficients {
        let mut speed = self.step.u;
        if self.mode == Mode::Backwards {
            for u in &mut *speed {
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

    /// `force` at the start of a mode, which cannot be negative there: zero where it is so by no
    /// more than noise.
    fn without_noise(&self, force: f64) -> f64 {
        let noise = self.force_noise();
        let rounding = noise * ROUNDING / (ROUNDING + self.tolerance);
        if (-noise..=rounding).contains(&force) {
            0.0
        } else {
            force
        }
    }

    /// Noise of forces: rounding, and two polynomials of the past, which agree to the tolerance,
    /// taking turns. Without it a block with μ_K(0⁺) = μ_S would stick and slip again and again at
    /// the moment of its release.
    fn force_noise(&self) -> f64 {
        let (a, delayed) = (self.step.a[0].abs(), self.step.delayed[0].abs());
        let load = 1.0 + self.parameters.alpha_n.abs() * (a + delayed);
        (ROUNDING + self.tolerance) * (a + self.parameters.law.mu_s() * load)
    }

    /// Moves on by `length`; the polynomials hold for `radius`.
    fn finish(&mut self, length: f64, radius: f64) {
        let order = self.step.order;
        let (u, a) = (&self.step.u[..=order], &self.step.a[..=order]);
        self.u = value(u, length);
        self.a = value(a, length);
        self.t += length;
        let around = match self.integrator {
            Integrator::Taylor => radius.max(length),
            // Nothing holds a polynomial by its values outside of its step.
            Integrator::Collocation => 0.0,
        };
        if !self.history.push(self.t, around, a, self.kink) {
            (self.u, self.a) = (f64::NAN, f64::NAN);
        }
        self.step.length = length;
        self.step.radius = radius;
    }

    /// The mode after `event`, which may turn out to be another one.
    fn change_mode(&mut self, event: Event) -> Event {
        let n = value(&self.step.n[..=self.step.order], self.step.length);
        match event {
            Event::Release => {
                self.u = 0.0;
                self.even_since = f64::INFINITY;
                self.friction.restart(0.0);
                self.mode = if self.a > 0.0 {
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
                self.mode = self.mode_at(n);
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

/// How long a step may be for the delayed elongation, and the order of the kink there.
#[derive(Debug, Clone, Copy)]
struct DelayLimit {
    length: f64,
    kink: u32,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Events of the letter's Fig. 3 (physics of the project, section 7): times of switch-on, and
    /// of what follows.
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
            alpha_v,
            alpha_n,
            tau,
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
