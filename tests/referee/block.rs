//! The block itself: Runge–Kutta's classical steps of a length that is set beforehand, never by an
//! estimate of the error.
//!
//! M ẍ = κ a + c ȧ − c_g ẋ − sgn(ẋ) μ_K(|ẋ|) N in slip, ẋ = 0 while |κ a + c ȧ| < μ_S N in stick,
//! ȧ = v − ẋ, v = v0 + α_v S, N = N0 + α_N S, both clipped, S = a(t−δ) − a(t−δ−τ) + R S(t−τ). A
//! step ends at every kink of the delayed elongation and of its echoes, where the speed passes a
//! point of a table, and where a command passes a limit.
//!
//! With memory or latency V(t) = a(t) − a(t−τ) + R V(t−τ) is kept beside a, from one end of a step
//! to the next; then S = V(t−δ). With readings S is worked out at each of them from the past of
//! the elongation, and steps end there (`readings`).

use super::echoes::Echoes;
use super::past::Past;
use super::setting::Setting;
use super::steps::{Pace, first_below};

/// What the block does; a slip has the sign of ẋ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Mode {
    Stick,
    Slip(f64),
}

/// What happens to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Event {
    Release,
    Stick,
    Reversal,
    LiftOff,
    SwitchOn,
    /// v0 is at a corner of its programme.
    Programme,
}

/// What ends a mode, or the piece of the friction law that holds: each is a number that falls below
/// 0.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Guard {
    /// |ẋ|.
    Stop,
    /// N.
    LiftOff,
    /// The speed above the piece's lower end, and below its upper one.
    Slower,
    Faster,
    /// What holds a stuck block against a pull in this direction.
    Release(f64),
    /// The distance of a command from a limit of its actuator, on the side where it is: of v from
    /// below and above, of N likewise.
    Limit(usize),
}

const OF_LIMITS: [Guard; 4] = [
    Guard::Limit(0),
    Guard::Limit(1),
    Guard::Limit(2),
    Guard::Limit(3),
];
const IN_SLIP: [Guard; 4] = [Guard::LiftOff, Guard::Stop, Guard::Slower, Guard::Faster];
const IN_STICK: [Guard; 3] = [Guard::LiftOff, Guard::Release(1.0), Guard::Release(-1.0)];

/// The state at one time with all rates of change.
#[derive(Debug, Clone, Copy)]
struct Look {
    t: f64,
    u: f64,
    a: f64,
    u_rate: f64,
    a_rate: f64,
    n: f64,
    n_rate: f64,
    /// κ a + c ȧ.
    pull: f64,
    pull_rate: f64,
    /// S and its rate; 0 where no control acts.
    signal: f64,
    signal_rate: f64,
}

/// Where the speed passes a point of a table the elongation's kink is as smooth as a third echo.
const OF_A_TABLE: u32 = 3;

/// A moving block with its past.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    pub setting: Setting,
    pace: Pace,
    pub(super) past: Past,
    /// V, where there is memory or latency.
    signal: Past,
    echoes: Echoes,
    pub t: f64,
    pub u: f64,
    pub a: f64,
    pub mode: Mode,
    piece: usize,
    controlled: bool,
    stuck_since: f64,
    /// On which side of each limit its command is: 1 above, −1 below.
    sides: [f64; 4],
    /// The rate of the elongation at the end of the last step.
    arriving: f64,
    /// S as it is held, where there are readings, and what has been held before.
    pub(super) held: f64,
    pub(super) signals: Vec<f64>,
    /// The v0 for which the return map was made once; that of each reading where there is none.
    pub(super) map_of: Option<f64>,
    /// How many corners of the programme are behind.
    behind: usize,
}

impl Block {
    /// A block at t = 0 with the elongation `a`, which was `a` at all times before.
    pub(crate) fn at_rest_or_sliding(setting: Setting, pace: Pace, u: f64, a: f64) -> Self {
        let pull = setting.stiffness * a + setting.damping * (setting.v0 - u);
        let mode = match u == 0.0 {
            true if pull.abs() <= setting.friction.mu_s * setting.load => Mode::Stick,
            true => Mode::Slip(pull.signum()),
            false => Mode::Slip(u.signum()),
        };
        let pasts = [a, 0.0].map(|value| Past::rising(0.0, value, 0.0));
        Self::with_pasts(setting, pace, (u, a, mode), pasts)
    }

    /// A block that is released at t = 0, after a stick that has gone on for ever; none where N ≤ 0
    /// before that.
    pub(crate) fn released(setting: Setting, pace: Pace) -> Option<Self> {
        let s = &setting;
        let load = s.n(s.even_signal());
        let rate = s.v(s.v0, s.even_signal());
        let a = (s.friction.mu_s * load - s.damping * rate) / s.stiffness;
        let pasts = [
            Past::rising(0.0, a, s.v0),
            Past::rising(0.0, s.even_signal(), 0.0),
        ];
        (load > 0.0).then(|| Self::with_pasts(setting, pace, (0.0, a, Mode::Slip(1.0)), pasts))
    }

    fn with_pasts(
        setting: Setting,
        pace: Pace,
        (u, a, mode): (f64, f64, Mode),
        [past, signal]: [Past; 2],
    ) -> Self {
        let mut block = Self {
            piece: setting.friction.piece(u.abs()),
            controlled: setting.switch_on <= 0.0,
            setting,
            pace,
            past,
            signal,
            echoes: Echoes::default(),
            t: 0.0,
            u,
            a,
            mode,
            stuck_since: 0.0,
            sides: [1.0; 4],
            arriving: 0.0,
            held: 0.0,
            signals: Vec::new(),
            map_of: None,
            behind: 0,
        };
        block.kink(1);
        block.look_at_limits();
        block
    }

    /// Notes on which sides of their limits the commands are.
    pub(super) fn look_at_limits(&mut self) {
        let now = self.look(self.t, self.u, self.a);
        self.sides = std::array::from_fn(|i| match self.beyond(i, &now).0 < 0.0 {
            true => -1.0,
            false => 1.0,
        });
    }

    /// A command less its limit of this number, and its rate.
    fn beyond(&self, limit: usize, at: &Look) -> (f64, f64) {
        let s = &self.setting;
        let ((rest, drift), gain, limits) = match limit < 2 {
            true => (self.unperturbed(at.t), s.alpha_v, s.of_v),
            false => ((s.load, 0.0), s.alpha_n, s.of_load),
        };
        let off = rest + gain * at.signal - limits[limit % 2];
        (off, drift + gain * at.signal_rate)
    }

    /// v0 at a time between the last corner and the next one, and its rate.
    pub(super) fn unperturbed(&self, t: f64) -> (f64, f64) {
        let (s, behind) = (&self.setting, self.behind);
        let (since, from) = match behind.checked_sub(1) {
            Some(last) => (s.programme[last].at, s.programme[last].v0),
            None => (0.0, s.v0),
        };
        match s.programme.get(behind).filter(|next| next.ramp) {
            Some(next) => {
                let (rise, time) = (next.v0 - from, next.at - since);
                (from + rise * ((t - since) / time), rise / time)
            }
            None => (from, 0.0),
        }
    }

    /// The time of the next corner.
    fn next_corner(&self) -> f64 {
        let next = self.setting.programme.get(self.behind);
        next.map_or(f64::INFINITY, |corner| corner.at)
    }

    /// Changes v0 from now on.
    pub(crate) fn set_v0(&mut self, v0: f64) {
        self.setting.v0 = v0;
        self.stuck_since = self.t;
        self.kink(1);
        self.look_at_limits();
    }

    /// Control acts from now on.
    pub(crate) fn switch_on(&mut self) {
        self.controlled = true;
        self.setting.switch_on = self.t;
        self.stuck_since = self.t;
        self.kink(1);
        self.look_at_limits();
    }

    /// One step, not beyond `until`, and the event that ends it, if one does.
    pub(crate) fn advance(&mut self, until: f64) -> Option<Event> {
        if !self.controlled && self.t >= self.setting.switch_on {
            self.switch_on();
            return Some(Event::SwitchOn);
        }
        if self.t >= self.next_corner() {
            self.behind += 1;
            self.stuck_since = self.t;
            self.kink(1);
            self.look_at_limits();
            return Some(Event::Programme);
        }
        if self.controlled && self.t >= self.next_reading() - self.nearly() {
            self.read();
        }
        self.echoes.pass(self.t, &self.setting, self.controlled);
        let from = self.look(self.t, self.u, self.a);
        self.past.leave(from.a_rate);
        if !self.setting.is_plain() {
            self.keep_signal([self.arriving, from.a_rate]);
        }
        if from.n <= 0.0 {
            return Some(Event::LiftOff);
        }
        if self.is_torn_off(&from) {
            return Some(self.release());
        }
        let h = self.step_length(&from, until);
        let to = self.rk(&from, h);
        let found = self.first_guard(&from, &to);
        let to = found.map_or(to, |(_, there)| there);
        self.go(&to);
        found.and_then(|(guard, _)| self.meet(guard, to.n))
    }

    fn guards(&self) -> impl Iterator<Item = Guard> {
        let of_mode: &[Guard] = match self.mode {
            Mode::Stick => &IN_STICK,
            Mode::Slip(_) => &IN_SLIP,
        };
        let s = &self.setting;
        let limits = [s.of_v, s.of_load].concat();
        let act = self.controlled;
        let of_limits = OF_LIMITS.into_iter().zip(limits);
        let finite = of_limits.filter(move |(_, limit)| act && limit.is_finite());
        of_mode
            .iter()
            .copied()
            .chain(finite.map(|(guard, _)| guard))
    }

    /// A guard's value and rate of change.
    fn value(&self, guard: Guard, at: &Look) -> (f64, f64) {
        let sign = match self.mode {
            Mode::Stick => 0.0,
            Mode::Slip(sign) => sign,
        };
        let (speed, gain) = (sign * at.u, sign * at.u_rate);
        let (lower, upper) = self.setting.friction.bounds(self.piece);
        let mu_s = self.setting.friction.mu_s;
        match guard {
            Guard::Stop => (speed, gain),
            Guard::LiftOff => (at.n, at.n_rate),
            Guard::Slower if lower <= 0.0 => (f64::INFINITY, 0.0),
            Guard::Slower => (speed - lower, gain),
            Guard::Faster if upper == f64::INFINITY => (upper, 0.0),
            Guard::Faster => (upper - speed, -gain),
            Guard::Limit(i) => {
                let (off, rate) = self.beyond(i, at);
                (self.sides[i] * off, self.sides[i] * rate)
            }
            Guard::Release(way) => (
                mu_s * at.n - way * at.pull,
                mu_s * at.n_rate - way * at.pull_rate,
            ),
        }
    }

    /// Whether a stuck block is pulled by more than holds it already now: control was just switched
    /// on.
    fn is_torn_off(&self, now: &Look) -> bool {
        let below = |guard: &Guard| self.value(*guard, now).0 < 0.0;
        self.mode == Mode::Stick && IN_STICK[1..].iter().any(below)
    }

    /// The state and its rates at a time.
    fn look(&self, t: f64, u: f64, a: f64) -> Look {
        let s = &self.setting;
        let (delayed, delayed_rate) = self.delayed(t);
        let (u_rate, a_rate) = self.rates(t, u, a, delayed);
        let mut look = Look {
            t,
            u,
            a,
            u_rate,
            a_rate,
            n: s.load,
            n_rate: 0.0,
            pull: s.stiffness * a + s.damping * a_rate,
            pull_rate: s.stiffness * a_rate - s.damping * u_rate,
            signal: 0.0,
            signal_rate: 0.0,
        };
        if self.controlled {
            look.signal = self.fed_back(a, delayed);
            look.signal_rate = self.fed_back(a_rate, delayed_rate);
            look.n = s.n(look.signal);
            let free = |i: usize| self.sides[2 * i] > 0.0 && self.sides[2 * i + 1] < 0.0;
            if free(1) {
                look.n_rate = s.alpha_n * look.signal_rate;
            }
            if free(0) {
                look.pull_rate += s.damping * s.alpha_v * look.signal_rate;
            }
        }
        if !self.controlled || self.sides[0] > 0.0 && self.sides[1] < 0.0 {
            look.pull_rate += s.damping * self.unperturbed(t).1;
        }
        look
    }

    /// S, or what it is less than a where there is no latency, and its rate; whatever, where no
    /// control acts.
    fn delayed(&self, t: f64) -> (f64, f64) {
        let s = &self.setting;
        match self.controlled {
            false => (0.0, 0.0),
            true if s.is_sampled() => (self.held, 0.0),
            true if s.latency > 0.0 => self.signal.at(t - s.latency),
            true => self.less_than_a(t),
        }
    }

    /// a − V = a(t−τ) − R V(t−τ), and its rate.
    fn less_than_a(&self, t: f64) -> (f64, f64) {
        let (then, memory) = (t - self.setting.tau, self.setting.memory);
        let (a, rate) = self.past.at(then);
        if memory == 0.0 {
            return (a, rate);
        }
        let (v, v_rate) = self.signal.at(then);
        (a - memory * v, rate - memory * v_rate)
    }

    /// S from what [`Self::delayed`] says, or its rate from the rate.
    fn fed_back(&self, a: f64, delayed: f64) -> f64 {
        match self.setting.latency > 0.0 || self.setting.is_sampled() {
            true => delayed,
            false => a - delayed,
        }
    }

    /// Keeps V at the end of a step, where the rate of a is this just `before` it and just `after`.
    fn keep_signal(&mut self, [before, after]: [f64; 2]) {
        let s = &self.setting;
        let (then, beside) = (self.t - s.tau, 1e-11 * s.time().max(self.t));
        let v = self.a - self.less_than_a(self.t).0;
        let of_a = self.past.rates_beside(then, beside);
        let of_v = self.signal.rates_beside(then, beside);
        let rate = |own: f64, i: usize| own - of_a[i] + s.memory * of_v[i];
        let rates = [rate(before, 0), rate(after, 1)];
        if self.signal.last() < self.t {
            self.signal.arrive(self.t, v, rates[0]);
        }
        self.signal.leave(rates[1]);
    }

    /// ẍ and ȧ.
    fn rates(&self, t: f64, u: f64, a: f64, delayed: f64) -> (f64, f64) {
        let s = &self.setting;
        let difference = match self.controlled {
            true => self.fed_back(a, delayed),
            false => 0.0,
        };
        let v = s.v(self.unperturbed(t).0, difference);
        let Mode::Slip(sign) = self.mode else {
            return (0.0, v);
        };
        let n = s.n(difference);
        let friction = s.friction.coefficient(self.piece, sign * u) * n;
        let pull = s.stiffness * a + s.damping * (v - u);
        ((pull - s.viscous * u - sign * friction) / s.mass, v - u)
    }

    /// The state after a step.
    fn rk(&self, from: &Look, h: f64) -> Look {
        let (t, u, a) = (from.t, from.u, from.a);
        let middle = self.delayed(t + 0.5 * h).0;
        let end = self.delayed(t + h).0;
        let k1 = (from.u_rate, from.a_rate);
        let k2 = self.rates(t + 0.5 * h, u + 0.5 * h * k1.0, a + 0.5 * h * k1.1, middle);
        let k3 = self.rates(t + 0.5 * h, u + 0.5 * h * k2.0, a + 0.5 * h * k2.1, middle);
        let k4 = self.rates(t + h, u + h * k3.0, a + h * k3.1, end);
        self.look(
            t + h,
            u + h / 6.0 * (k1.0 + 2.0 * (k2.0 + k3.0) + k4.0),
            a + h / 6.0 * (k1.1 + 2.0 * (k2.1 + k3.1) + k4.1),
        )
    }

    /// The length of the next step: shares of the time in which each part of the equations changes,
    /// up to the next kink.
    fn step_length(&self, now: &Look, until: f64) -> f64 {
        let s = &self.setting;
        let mut end = until.min(self.next_corner());
        if self.controlled || !s.is_plain() {
            end = end.min(self.echoes.next());
        }
        match self.controlled {
            true => end = end.min(self.next_reading()),
            false => end = end.min(s.switch_on),
        }
        let room = end - self.t;
        if self.stretches_evenly() {
            return room.min(self.time_to_guards(now));
        }
        let mut h = match self.mode {
            Mode::Stick => self.pace.stuck(s.time(), self.feedback()),
            Mode::Slip(sign) => {
                let (law, speed) = (&s.friction, sign * now.u);
                let growth = (law.slope(self.piece, speed) * now.n / s.mass).abs();
                let growth = growth + (s.damping + s.viscous) / s.mass;
                let bend = (now.u_rate / law.reach(self.piece, speed)).abs();
                self.pace.slipping(s.time(), self.feedback() + growth, bend)
            }
        };
        if let Mode::Slip(_) = self.mode
            && s.friction.is_rough_at_rest()
        {
            // From rest the speed grows by its second derivative.
            let growth = (now.pull_rate / s.mass).abs();
            h = h.min((0.02 * s.friction.reach(self.piece, now.u) / growth).sqrt());
        }
        if s.is_sampled() {
            return part_of(room, h);
        }
        if self.controlled || !s.is_plain() {
            let then = self.t - s.tau;
            h = h.min(self.pace.delayed(s.tau));
            h = h.min(self.past.end_of_step(then, Pace::seen_at_once()) - then);
        }
        if s.latency > 0.0 {
            let then = self.t - s.latency;
            h = h.min(self.pace.delayed(s.latency));
            h = h.min(self.signal.end_of_step(then, Pace::seen_at_once()) - then);
        }
        part_of(room, h)
    }

    /// The rates at which control alone would move the block.
    fn feedback(&self) -> f64 {
        let s = &self.setting;
        match self.controlled {
            true => s.alpha_v.abs() + (s.alpha_n.abs() * s.friction.mu_s / s.mass).sqrt(),
            false => 0.0,
        }
    }

    /// Whether the spring is stretched at the rate v0, and was one delay ago: then one step leads
    /// to the release.
    fn stretches_evenly(&self) -> bool {
        let s = &self.setting;
        let plain = s.is_plain();
        let long = self.t - self.stuck_since >= s.tau + s.latency;
        let evenly = s.alpha_v == 0.0 && s.memory == 0.0 && long;
        let evenly = evenly || s.is_sampled();
        let steady = self.unperturbed(self.t).1 == 0.0;
        steady && self.mode == Mode::Stick && ((!self.controlled && plain) || evenly)
    }

    /// A little more than the time until a guard falls below 0, if all go on as they do.
    fn time_to_guards(&self, now: &Look) -> f64 {
        let times = self.guards().map(|guard| {
            let (value, rate) = self.value(guard, now);
            match rate < 0.0 {
                true => value / -rate,
                false => f64::INFINITY,
            }
        });
        1.001 * times.fold(f64::INFINITY, f64::min) + 1e-9 * self.setting.time()
    }

    /// The first guard that falls below 0 in a step, and the state there.
    fn first_guard(&self, from: &Look, to: &Look) -> Option<(Guard, Look)> {
        let mut first: Option<(Guard, Look)> = None;
        for guard in self.guards() {
            let h = first.map_or(to.t, |(_, there)| there.t) - from.t;
            let end = first.map_or(*to, |(_, there)| there);
            let ends = (self.value(guard, from), self.value(guard, &end));
            let value = |s: f64| self.value(guard, &self.rk(from, s)).0;
            if let Some(s) = first_below(h, ends, from.t, value) {
                first = Some((guard, self.rk(from, s)));
            }
        }
        first
    }

    /// Moves on.
    fn go(&mut self, to: &Look) {
        (self.t, self.u, self.a) = (to.t, to.u, to.a);
        self.past.arrive(to.t, to.a, to.a_rate);
        let s = &self.setting;
        self.arriving = to.a_rate;
        if s.is_sampled() && !self.controlled {
            // The first reading looks at all that was before.
            return;
        }
        let remembered = 1.5
            * match s.is_sampled() {
                true => s.tau + s.latency,
                false => s.tau.max(s.latency),
            };
        self.past.forget_before(to.t - remembered);
        self.signal.forget_before(to.t - remembered);
    }

    /// A guard has fallen below 0.
    fn meet(&mut self, guard: Guard, n: f64) -> Option<Event> {
        match guard {
            Guard::LiftOff => Some(Event::LiftOff),
            Guard::Slower | Guard::Faster => {
                self.piece = match guard {
                    Guard::Faster => self.piece + 1,
                    _ => self.piece - 1,
                };
                self.kink(OF_A_TABLE);
                None
            }
            Guard::Limit(i) => {
                self.sides[i] = -self.sides[i];
                self.kink(1);
                None
            }
            Guard::Release(_) => Some(self.release()),
            Guard::Stop => Some(self.stop(n)),
        }
    }

    fn release(&mut self) -> Event {
        self.mode = Mode::Slip(self.pull().signum());
        self.begin();
        Event::Release
    }

    /// κ a + c ȧ of a block at rest now.
    fn pull(&self) -> f64 {
        let stuck = Self {
            mode: Mode::Stick,
            ..self.clone()
        };
        stuck.look(self.t, 0.0, self.a).pull
    }

    fn stop(&mut self, n: f64) -> Event {
        let pull = self.pull();
        let before = self.mode;
        self.mode = match pull.abs() < self.setting.friction.mu_s * n {
            true => Mode::Stick,
            false => Mode::Slip(pull.signum()),
        };
        self.begin();
        match self.mode != Mode::Stick && self.mode != before {
            true => Event::Reversal,
            false => Event::Stick,
        }
    }

    /// A mode begins, at rest.
    fn begin(&mut self) {
        self.u = 0.0;
        self.piece = self.setting.friction.piece(0.0);
        self.stuck_since = self.t;
        self.kink(1);
    }

    /// The elongation has a kink now, as smooth as an echo of this number.
    fn kink(&mut self, echo: u32) {
        if !self.setting.is_sampled() {
            self.echoes.of_kink(self.t, echo, &self.setting);
        }
    }
}

/// A step of length `h` where there is this `room` before an end, to which no tiny step is left.
fn part_of(room: f64, h: f64) -> f64 {
    match room < h {
        true => room,
        false => h.min(0.5 * room.max(h)),
    }
}
